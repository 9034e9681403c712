//! Pairs of boxes, one from each of two sets, that share a point.
//!
//! Boxes are rounded outward to a lattice and sorted into the cells of a grid. Where many share a cell,
//! the cell gets its own grid:
//!
//! ```text
//!   ┌───────┬───────┐       A pair is found in every cell that both boxes touch. It counts in the
//!   │   ┌───┼───┐   │       one with the lowest corner of their common part (●), so it counts
//!   │   │   ●───┼─┐ │       once.
//!   ├───┼───┼───┤ │ │
//!   │   └───┼───┘ │ │
//!   └───────┴───────┘
//! ```
//!
//! Cost: the boxes, once, and the pairs in each cell; grids adapt to the sizes of the boxes, so
//! that a few large ones among many small ones do no harm.

use glam::DVec3;
use rayon::prelude::*;

use crate::groups::Groups;

/// The lattice has 2 to this power places along each axis.
const LATTICE_BITS: u32 = 30;

/// The last place of the lattice along each axis; nothing that is looked for touches it, nor place 0.
const LAST_PLACE: u32 = (1 << LATTICE_BITS) - 1;

/// A grid has at most 2 to this power cells along each axis.
const GRID_BITS: u32 = 7;

/// By how many bits a grid is finer than its boxes ask for.
const FINER_BITS: u32 = 2;

/// A cell with no more pairs than this is not divided.
const FEW_PAIRS: usize = 2048;

/// A cell is divided only when that makes pairs fewer by this factor: boxes as large as the cell stay
/// in all of its parts.
const WORTHWHILE: usize = 8;

/// A grid is not so fine that its boxes touch more cells than this, on average.
const CELLS_PER_BOX: u64 = 4;

/// How many boxes make one piece of parallel work.
const CHUNK: usize = 1 << 13;

/// How many cells make one piece of parallel work.
const CELLS_CHUNK: usize = 1 << 8;

/// A box on the lattice, with the number of what it is the box of.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LatticeBox {
    low: [u32; 3],
    high: [u32; 3],
    number: u32,
}

impl LatticeBox {
    /// The same with all depths made one.
    #[must_use]
    pub(super) fn flat(self) -> Self {
        let LatticeRange { low, high } = LatticeRange { low: self.low, high: self.high }.flat();
        Self { low, high, ..self }
    }

    /// The farthest place in depth.
    pub(super) fn farthest(&self) -> u32 {
        self.high[2]
    }

    /// The number of what it is the box of.
    pub(super) fn number(&self) -> u32 {
        self.number
    }

    #[inline]
    fn meets(&self, other: &Self) -> bool {
        self.low[0] <= other.high[0]
            && other.low[0] <= self.high[0]
            && self.low[1] <= other.high[1]
            && other.low[1] <= self.high[1]
            && self.low[2] <= other.high[2]
            && other.low[2] <= self.high[2]
    }
}

/// Where the places of a lattice lie.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lattice {
    origin: DVec3,
    places_per_unit: DVec3,
}

impl Lattice {
    /// A lattice over a box, with places of the same length along x and y and at least `z_scale`
    /// times that along z; `None` when the box is not finite or only a point.
    pub(super) fn over([low, high]: [DVec3; 2], z_scale: f64) -> Option<Self> {
        // A few places at each end are left for rounding.
        let n_places = f64::from((1u32 << LATTICE_BITS) - 8);
        let size = high - low;
        let xy = size.x.max(size.y).max(size.z / z_scale);
        let places_per_unit = n_places / DVec3::new(xy, xy, xy * z_scale);
        let fits = xy > 0.0 && places_per_unit.is_finite() && places_per_unit.min_element() > 0.0;
        fits.then_some(Self { origin: low, places_per_unit })
    }

    /// The place of a box, rounded outwards; what lies beside the lattice is moved to its border.
    #[inline]
    pub(super) fn place(&self, [low, high]: [DVec3; 2]) -> LatticeRange {
        // Differences and products are off by far less than a place, and so is cutting off
        // fractions of places.
        let low = (low - self.origin) * self.places_per_unit + 1.0;
        let high = (high - self.origin) * self.places_per_unit + 3.0;
        let last = f64::from(LAST_PLACE);
        let to_places = |v: DVec3| v.to_array().map(|x| x.clamp(0.0, last) as u32);
        LatticeRange { low: to_places(low), high: to_places(high) }
    }

    /// The highest place along z of points up to `z`.
    #[inline]
    pub(super) fn z_place(&self, z: f64) -> u32 {
        self.place([DVec3::ZERO.with_z(z); 2]).high[2]
    }
}

/// A closed box on the lattice.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LatticeRange {
    pub low: [u32; 3],
    pub high: [u32; 3],
}

impl LatticeRange {
    /// The smallest box that holds all of the boxes.
    #[inline]
    pub(super) fn around<const N: usize>(places: [&Self; N]) -> Self {
        let mut all = Self { low: [u32::MAX; 3], high: [0; 3] };
        for place in places {
            for axis in 0..3 {
                all.low[axis] = all.low[axis].min(place.low[axis]);
                all.high[axis] = all.high[axis].max(place.high[axis]);
            }
        }
        all
    }

    /// The nearest place in depth.
    pub(super) fn nearest(&self) -> u32 {
        self.low[2]
    }

    /// The same with all depths made one.
    #[must_use]
    pub(super) fn flat(self) -> Self {
        let flat = |[x, y, _]: [u32; 3]| [x, y, 1];
        Self { low: flat(self.low), high: flat(self.high) }
    }

    /// The box of what has this number; `None` when it lies beside the lattice.
    #[inline]
    pub(super) fn of(self, number: u32) -> Option<LatticeBox> {
        let Self { low, high } = self;
        let is_beside = (0..3).any(|axis| high[axis] == 0 || low[axis] == LAST_PLACE);
        (!is_beside).then_some(LatticeBox { low, high, number })
    }
}

/// The smallest box that holds all of the boxes.
pub(super) fn box_of_all(boxes: impl Iterator<Item = [DVec3; 2]>) -> [DVec3; 2] {
    boxes.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], b| {
        [low.min(b[0]), high.max(b[1])]
    })
}

/// Calls `visit` with the number of a box of the second set and the numbers of boxes of the first
/// that share a point with it, until each such pair was visited once; returns what it pushes.
///
/// Parallel; the order of the results does not depend on the number of threads. `second` makes the
/// boxes of the second set from numbers below `n_second`: those far from the first are not stored.
pub(super) fn meeting_pairs<R: Send>(
    first: &[LatticeBox],
    n_second: usize,
    second: impl Fn(u32) -> Option<LatticeBox> + Sync,
    visit: impl Fn(u32, &[u32], &mut Vec<R>) + Sync,
) -> Vec<R> {
    let grid = Grid::fit(Region { corner: [0; 3], bits: LATTICE_BITS }, &[first]);
    let touched: Vec<Vec<Touch>> = first
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, boxes)| grid.touched_by(boxes, chunk * CHUNK, |_| true))
        .collect();
    let occupied = Occupied::by(&grid, &touched);
    let first = Cells::sort(&occupied, &touched, first);
    drop(touched);
    let (second, mut touched): (Vec<Vec<LatticeBox>>, Vec<Vec<Touch>>) = (0..n_second)
        .into_par_iter()
        .step_by(CHUNK)
        .map(|start| {
            let numbers = start as u32..(start + CHUNK).min(n_second) as u32;
            let mut boxes = Vec::new();
            let mut touched = Vec::new();
            for b in numbers.filter_map(&second) {
                let before = touched.len();
                grid.for_cells(&b, |cell| {
                    if occupied.contains(cell) {
                        touched.push((cell, boxes.len() as u32));
                    }
                });
                if touched.len() > before {
                    boxes.push(b);
                }
            }
            (boxes, touched)
        })
        .unzip();
    let mut n_before = 0;
    for (boxes, touched) in second.iter().zip(&mut touched) {
        touched.iter_mut().for_each(|(_, index)| *index += n_before);
        n_before += boxes.len() as u32;
    }
    let second = second.concat();
    let second = Cells::sort(&occupied, &touched, &second);
    drop(touched);
    let parts: Vec<Vec<R>> = occupied
        .cells
        .par_chunks(CELLS_CHUNK)
        .enumerate()
        .map(|(chunk, cells)| {
            let (mut found, mut meeting) = (Vec::new(), Vec::new());
            let (mut first_here, mut second_here) = (Vec::new(), Vec::new());
            for (i, &cell) in cells.iter().enumerate() {
                let rank = chunk * CELLS_CHUNK + i;
                second.gather(rank, &mut second_here);
                if second_here.is_empty() {
                    continue;
                }
                first.gather(rank, &mut first_here);
                let region = grid.region(cell);
                let mut visit = |b, a: &[u32]| visit(b, a, &mut found);
                join(region, &first_here, &second_here, &mut meeting, &mut visit);
            }
            found
        })
        .collect();
    parts.into_iter().flatten().collect()
}

/// For each item of the first set items of the second, in rising order: sorts pairs of which the first
/// numbers are below `n_first`.
pub(super) fn grouped(n_first: usize, mut pairs: Vec<(u32, u32)>) -> Groups {
    pairs.par_sort_unstable();
    Groups::of_sorted(n_first, pairs)
}

/// A cube of the lattice: its lowest corner in units of its size, 2 to the power of `bits`.
#[derive(Debug, Clone, Copy)]
struct Region {
    corner: [u32; 3],
    bits: u32,
}

/// The cells of a region: 2 to the power of `bits` along each axis.
#[derive(Debug, Clone, Copy)]
struct Grid {
    region: Region,
    bits: u32,
}

impl Grid {
    /// The finest grid that suits the number and the sizes of the boxes.
    fn fit(region: Region, sets: &[&[LatticeBox]]) -> Self {
        let n = sets.iter().map(|set| set.len() as u64).sum::<u64>();
        // Boxes on a surface fill as many cells as the square of the cells along an axis. Finer
        // grids keep more of the second set apart from the first.
        let enough = (n.max(1).ilog2() / 2 + FINER_BITS).min(GRID_BITS).min(region.bits);
        let is_fine = |bits: u32| {
            let grid = Self { region, bits };
            let touched = |b: &LatticeBox| {
                let [low, high] = grid.range(b);
                (0..3).map(|axis| u64::from(high[axis] - low[axis] + 1)).product::<u64>()
            };
            let all = |set: &&[LatticeBox]| -> u64 {
                set.par_iter().with_min_len(CHUNK).map(touched).sum()
            };
            sets.iter().map(all).sum::<u64>() <= CELLS_PER_BOX * n
        };
        let bits = (0..=enough).rev().find(|&bits| bits == 0 || is_fine(bits)).unwrap_or(0);
        Self { region, bits }
    }

    /// The first and last cell along each axis that a box touches within the region.
    #[inline]
    fn range(&self, b: &LatticeBox) -> [[u32; 3]; 2] {
        let shift = self.region.bits - self.bits;
        let last = (1 << self.bits) - 1;
        let index = |x: u32, axis: usize| {
            let first = self.region.corner[axis] << self.bits;
            (x >> shift).saturating_sub(first).min(last)
        };
        [
            [index(b.low[0], 0), index(b.low[1], 1), index(b.low[2], 2)],
            [index(b.high[0], 0), index(b.high[1], 1), index(b.high[2], 2)],
        ]
    }

    fn region(&self, cell: u32) -> Region {
        let mask = (1 << self.bits) - 1;
        let at = [0, 1, 2].map(|axis| cell >> (axis * self.bits) & mask);
        let corner = [0, 1, 2].map(|axis| (self.region.corner[axis] << self.bits) + at[axis]);
        Region { corner, bits: self.region.bits - self.bits }
    }

    /// Calls `f` with the cells that a box touches.
    #[inline]
    fn for_cells(&self, b: &LatticeBox, mut f: impl FnMut(u32)) {
        let [low, high] = self.range(b);
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                let row = (z << (2 * self.bits)) + (y << self.bits);
                for x in low[0]..=high[0] {
                    f(row + x);
                }
            }
        }
    }

    /// The `wanted` cells that some boxes touch; the first box has number `first`.
    fn touched_by(
        &self,
        boxes: &[LatticeBox],
        first: usize,
        wanted: impl Fn(u32) -> bool,
    ) -> Vec<Touch> {
        let mut touched = Vec::with_capacity(2 * boxes.len());
        for (index, b) in (first as u32..).zip(boxes) {
            self.for_cells(b, |cell| {
                if wanted(cell) {
                    touched.push((cell, index));
                }
            });
        }
        touched
    }
}

/// A cell and the place, among the boxes of its set, of a box that touches it.
type Touch = (u32, u32);

/// The cells of a grid that hold boxes of the first set: a bit for each cell, and how many bits are
/// set before each word.
struct Occupied {
    words: Vec<u64>,
    ranks: Vec<u32>,
    /// The cells in rising order.
    cells: Vec<u32>,
}

impl Occupied {
    fn by(grid: &Grid, touched: &[Vec<Touch>]) -> Self {
        let n_words = (1usize << (3 * grid.bits)).div_ceil(64);
        let mut words = vec![0u64; n_words];
        for &(cell, _) in touched.iter().flatten() {
            words[cell as usize / 64] |= 1 << (cell % 64);
        }
        let mut ranks = Vec::with_capacity(n_words);
        let mut cells = Vec::new();
        for (i, &word) in words.iter().enumerate() {
            ranks.push(cells.len() as u32);
            let mut left = word;
            while left != 0 {
                cells.push(64 * i as u32 + left.trailing_zeros());
                left &= left - 1;
            }
        }
        Self { words, ranks, cells }
    }

    #[inline]
    fn contains(&self, cell: u32) -> bool {
        self.words[cell as usize / 64] >> (cell % 64) & 1 == 1
    }

    /// How many occupied cells come before a cell.
    #[inline]
    fn rank(&self, cell: u32) -> usize {
        let before = self.words[cell as usize / 64] & ((1 << (cell % 64)) - 1);
        (self.ranks[cell as usize / 64] + before.count_ones()) as usize
    }
}

/// Boxes sorted by the occupied cells that they touch.
struct Cells<'b> {
    boxes: &'b [LatticeBox],
    /// Their places, by cell.
    by_cell: Groups,
}

impl<'b> Cells<'b> {
    fn sort(occupied: &Occupied, touched: &[Vec<Touch>], boxes: &'b [LatticeBox]) -> Self {
        let by_cell = Groups::new(occupied.cells.len(), |sorter| {
            for &(cell, index) in touched.iter().flatten() {
                sorter.put(occupied.rank(cell), index);
            }
        });
        Self { boxes, by_cell }
    }

    /// The places among the boxes of those in one cell.
    fn of(&self, rank: usize) -> &[u32] {
        self.by_cell.of(rank)
    }

    /// Puts the boxes of one cell into `here`.
    fn gather(&self, rank: usize, here: &mut Vec<LatticeBox>) {
        here.clear();
        here.extend(self.of(rank).iter().map(|&index| self.boxes[index as usize]));
    }
}

/// Finds the pairs that count in one region; `meeting` is work space.
fn join(
    region: Region,
    first: &[LatticeBox],
    second: &[LatticeBox],
    meeting: &mut Vec<u32>,
    visit: &mut impl FnMut(u32, &[u32]),
) {
    if first.len() * second.len() > FEW_PAIRS {
        let grid = Grid::fit(region, &[first, second]);
        let touched = [grid.touched_by(first, 0, |_| true)];
        let occupied = Occupied::by(&grid, &touched);
        let first_cells = Cells::sort(&occupied, &touched, first);
        let touched = [grid.touched_by(second, 0, |cell| occupied.contains(cell))];
        let second_cells = Cells::sort(&occupied, &touched, second);
        let ranks = 0..occupied.cells.len();
        let n_pairs: usize =
            ranks.map(|rank| first_cells.of(rank).len() * second_cells.of(rank).len()).sum();
        if n_pairs * WORTHWHILE <= first.len() * second.len() {
            let (mut first_here, mut second_here) = (Vec::new(), Vec::new());
            for (rank, &cell) in occupied.cells.iter().enumerate() {
                first_cells.gather(rank, &mut first_here);
                second_cells.gather(rank, &mut second_here);
                join(grid.region(cell), &first_here, &second_here, meeting, visit);
            }
            return;
        }
    }
    for b in second {
        meeting.clear();
        for a in first.iter().filter(|a| a.meets(b)) {
            let counts = (0..3)
                .all(|axis| a.low[axis].max(b.low[axis]) >> region.bits == region.corner[axis]);
            if counts {
                meeting.push(a.number);
            }
        }
        if !meeting.is_empty() {
            visit(b.number, meeting);
        }
    }
}
