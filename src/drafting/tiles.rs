//! A grid of bits of which only some parts exist.

use rayon::prelude::*;

/// Cells on a side of a tile: its bits are one number, row by row.
const SIDE: usize = 8;

/// The cells of a grid in square tiles. Cells of tiles that were not requested are not set.
pub(super) struct Tiles {
    /// Tiles in a row.
    columns: usize,
    rows: usize,
    /// Words of 64 tiles in a row.
    words: usize,
    /// For each tile whether it exists.
    is_asked: Vec<u64>,
    /// For each word how many tiles exist before it.
    ranks: Vec<u32>,
    /// The column and the row of each tile that exists.
    places: Vec<[u32; 2]>,
    bits: Vec<u64>,
    /// The tiles that were added last: strokes stay in them for some cells.
    last: [usize; 4],
}

impl Tiles {
    /// None yet, for a grid of this many cells.
    pub(super) fn new(columns: usize, rows: usize) -> Self {
        let (columns, rows) = (columns.div_ceil(SIDE), rows.div_ceil(SIDE));
        let words = columns.div_ceil(64);
        Self {
            columns,
            rows,
            words,
            is_asked: vec![0; words * rows],
            ranks: Vec::new(),
            places: Vec::new(),
            bits: Vec::new(),
            last: [usize::MAX; 4],
        }
    }

    /// Asks for the tiles within `reach` cells of one.
    pub(super) fn add(&mut self, [column, row]: [usize; 2], reach: usize) {
        let low = |at: usize| at.saturating_sub(reach) / SIDE;
        let high = |at: usize, n: usize| ((at + reach) / SIDE).min(n - 1);
        let [left, right] = [low(column), high(column, self.columns)];
        let [top, bottom] = [low(row), high(row, self.rows)];
        let these = [left, right, top, bottom];
        if self.last == these {
            return;
        }
        self.last = these;
        for row in top..=bottom {
            for column in left..=right {
                self.is_asked[row * self.words + column / 64] |= 1 << (column % 64);
            }
        }
    }

    /// Gives every tile that was requested its number, and bits that are not set.
    pub(super) fn number(&mut self) {
        let mut n = 0;
        self.ranks = Vec::with_capacity(self.is_asked.len());
        for (i, &word) in self.is_asked.iter().enumerate() {
            self.ranks.push(n);
            n += word.count_ones();
            let (row, first) = (i / self.words, i % self.words * 64);
            self.places.extend(ones(word).map(|k| [(first + k) as u32, row as u32]));
        }
        self.bits = vec![0; n as usize];
    }

    /// Whether a cell is set.
    pub(super) fn has(&self, [column, row]: [usize; 2]) -> bool {
        self.tile(column / SIDE, row / SIDE)
            .is_some_and(|tile| self.bits[tile] >> (row % SIDE * SIDE + column % SIDE) & 1 == 1)
    }

    /// Whether any tile exists in the box from one cell to another.
    pub(super) fn has_any_in(&self, [left, top]: [usize; 2], [right, bottom]: [usize; 2]) -> bool {
        let (left, right) = (left / SIDE, right / SIDE);
        (top / SIDE..=bottom / SIDE).any(|row| {
            (left / 64..=right / 64)
                .any(|word| self.is_asked[row * self.words + word] & span(word, left, right) != 0)
        })
    }

    /// Calls `f` with the number of each tile that exists on a stretch of a row of cells, and the bits of
    /// the stretch that lie in it.
    pub(super) fn for_each_in_row(
        &self,
        row: usize,
        left: usize,
        right: usize,
        mut f: impl FnMut(usize, u64),
    ) {
        let (first, last) = (left / SIDE, right / SIDE);
        for word in first / 64..=last / 64 {
            let at = row / SIDE * self.words + word;
            for k in ones(self.is_asked[at] & span(word, first, last)) {
                let column = word * 64 + k;
                let from = if column == first { left % SIDE } else { 0 };
                let to = if column == last { right % SIDE } else { SIDE - 1 };
                let cells = (0xff_u64 << from) & (0xff >> (SIDE - 1 - to));
                f(self.rank(at, k), cells << (row % SIDE * SIDE));
            }
        }
    }

    /// The bits of the tiles, to be set elsewhere.
    pub(super) fn take_bits(&mut self) -> Vec<u64> {
        std::mem::take(&mut self.bits)
    }

    /// Puts back the bits of the tiles.
    pub(super) fn set_bits(&mut self, bits: Vec<u64>) {
        self.bits = bits;
    }

    /// Sets the cells that are not set, and no others.
    pub(super) fn inverted(mut self) -> Self {
        self.bits.iter_mut().for_each(|bits| *bits = !*bits);
        self
    }

    /// All cells no farther than `radius` cells, below a tile's side, from one that is set.
    pub(super) fn grown(mut self, radius: f64) -> Self {
        let reach = (radius as usize).min(SIDE - 1);
        let across = |up: usize| (radius * radius - (up * up) as f64).max(0.0).sqrt() as usize;
        let widths: Vec<usize> = (0..=reach).map(|up| across(up).min(SIDE - 1)).collect();
        let grow = |&[column, row]: &[u32; 2]| {
            let rows = self.rows_around(column as usize, row as usize);
            (0..SIDE).fold(0, |bits, y| {
                let grown = (SIDE + y - reach..=SIDE + y + reach).fold(0, |grown, other| {
                    grown | widened(rows[other], widths[other.abs_diff(SIDE + y)])
                });
                bits | u64::from(grown >> SIDE & 0xff) << (y * SIDE)
            })
        };
        self.bits = self.places.par_iter().with_min_len(256).map(grow).collect();
        self
    }

    /// The rows of cells of a tile and of the eight around it.
    fn rows_around(&self, column: usize, row: usize) -> [u32; 3 * SIDE] {
        let mut rows = [0; 3 * SIDE];
        for (down, rows) in rows.chunks_exact_mut(SIDE).enumerate() {
            for across in 0..3 {
                let place = (column + across).checked_sub(1).zip((row + down).checked_sub(1));
                let bits = place.and_then(|(column, row)| self.tile(column, row));
                let bits = bits.map_or(0, |tile| self.bits[tile]);
                for (y, row) in rows.iter_mut().enumerate() {
                    *row |= ((bits >> (y * SIDE) & 0xff) as u32) << (across * SIDE);
                }
            }
        }
        rows
    }

    /// The number of a tile, if it exists.
    fn tile(&self, column: usize, row: usize) -> Option<usize> {
        let at = row * self.words + column / 64;
        let exists =
            column < self.columns && row < self.rows && self.is_asked[at] >> (column % 64) & 1 == 1;
        exists.then(|| self.rank(at, column % 64))
    }

    fn rank(&self, word: usize, bit: usize) -> usize {
        let before = self.is_asked[word] & ((1 << bit) - 1);
        (self.ranks[word] + before.count_ones()) as usize
    }
}

/// The bits that are set, as numbers.
fn ones(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let next = (word != 0).then(|| word.trailing_zeros() as usize);
        word &= word.wrapping_sub(1);
        next
    })
}

/// The bits of a word between two numbers of bits.
fn span(word: usize, first: usize, last: usize) -> u64 {
    let from = if word == first / 64 { first % 64 } else { 0 };
    let to = if word == last / 64 { last % 64 } else { 63 };
    (u64::MAX << from) & (u64::MAX >> (63 - to))
}

/// A row of cells with every one that is set spread to both sides.
fn widened(row: u32, width: usize) -> u32 {
    (1..=width).fold(row, |wide, by| wide | row << by | row >> by)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers below `n`.
    fn numbers() -> impl FnMut(usize) -> usize {
        let mut state = 11_u64;
        move |n| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) as usize % n
        }
    }

    #[test]
    fn discs_grow_as_all_distances_say() {
        let mut next = numbers();
        for (columns, rows, radius) in [(700, 40, 1.5), (37, 90, 3.0), (8, 8, 0.4), (64, 65, 2.0)] {
            let reach = 2 * (radius as usize + 1);
            let asked: Vec<[usize; 2]> = (0..12).map(|_| [next(columns), next(rows)]).collect();
            let mut tiles = Tiles::new(columns, rows);
            asked.iter().for_each(|&cell| tiles.add(cell, reach));
            tiles.number();
            let mut is_set = vec![vec![false; rows]; columns];
            let mut bits = tiles.take_bits();
            for _ in 0..columns * rows / 12 {
                let (row, left) = (next(rows), next(columns));
                let right = (left + next(12)).min(columns - 1);
                is_set[left..=right].iter_mut().for_each(|column| column[row] = true);
                tiles.for_each_in_row(row, left, right, |tile, mask| bits[tile] |= mask);
                assert!(tiles.has_any_in([0, 0], [columns - 1, rows - 1]));
            }
            tiles.set_bits(bits);
            for (column, is_set) in is_set.iter().enumerate() {
                for (row, &is_set) in is_set.iter().enumerate() {
                    let exists = tiles.has_any_in([column, row], [column, row]);
                    assert_eq!(tiles.has([column, row]), exists && is_set);
                }
            }
            let grown = tiles.grown(radius).inverted().grown(radius);
            let within = |a: [usize; 2], b: [usize; 2]| {
                let square = |k: usize| a[k].abs_diff(b[k]).pow(2) as f64;
                square(0) + square(1) <= radius * radius
            };
            let around = |[column, row]: [usize; 2]| {
                let range = |at: usize, n: usize| at.saturating_sub(3)..(at + 4).min(n);
                range(column, columns)
                    .flat_map(move |x| range(row, rows).map(move |y| [x, y]))
                    .filter(move |&other| within([column, row], other))
                    .collect::<Vec<_>>()
            };
            for &cell in &asked {
                let has_room =
                    |&place: &[usize; 2]| !around(place).iter().any(|[x, y]| is_set[*x][*y]);
                // Outside the grid is no room, nor material: compare where all of it is inside.
                let is_inner = |at: usize, n: usize| at >= reach && at + reach < n;
                if is_inner(cell[0], columns) && is_inner(cell[1], rows) {
                    assert_eq!(grown.has(cell), around(cell).iter().any(has_room), "{cell:?}");
                }
            }
        }
    }
}
