//! A pyramid of grids over the image that offers the triangles near a segment.
//!
//! Each triangle lies in the finest level whose cells are at least as large as its image's box, so
//! in four cells at most, whatever its size. A segment visits the cells along its image on every
//! level that holds anything:
//!
//! ```text
//!   level 2   ┌───────────────┐   large triangles
//!   level 1   ├───────┬───────┤
//!   level 0   ├───┬───┼───┬───┤   small triangles; 2^k × 2^k of these make a cell of level k
//! ```
//!
//! Long thin triangles lie in finer cells, along them; see [`slivers`].
//!
//! A cell that triangles cover without a gap has a depth behind which everything is hidden there
//! (W. R. Franklin, SIGGRAPH 1980; see [`covered`]). Triangles and segments behind it are dropped, so
//! that the cost does not grow with the number of layers behind a wall.
//!
//! Nothing here decides visibility: boxes and depths are rounded outwards, so the worst that can
//! happen is a test that finds nothing.

mod covered;
mod levels;
mod slivers;

use self::levels::{Level, levels};
use self::slivers::{finer_levels, most_finer};
use super::VisibilityOptions;
use super::back_faces::BackFaces;
use super::rounding::{Bounds, Place, Rounding, Separation, rounded_down, rounded_up};
use super::segment::Segment;
use crate::classify::ViewedScene;
use glam::{DVec2, dvec2};
use rayon::prelude::*;

/// An item in a cell, with its box rounded outwards. Most items are rejected by the box alone.
#[derive(Debug, Clone, Copy, Default)]
struct Entry {
    item: u32,
    low: [f32; 2],
    high: [f32; 2],
    nearest: f32,
    farthest: f32,
}

impl Entry {
    fn new(item: u32, bounds: &Bounds) -> Self {
        Self {
            item,
            low: bounds.low.to_array().map(rounded_down),
            high: bounds.high.to_array().map(rounded_up),
            nearest: rounded_down(bounds.nearest),
            farthest: rounded_up(bounds.farthest),
        }
    }

    #[inline]
    fn is_apart(&self, segment: &Self) -> bool {
        self.low[0] > segment.high[0]
            || self.low[1] > segment.high[1]
            || self.high[0] < segment.low[0]
            || self.high[1] < segment.low[1]
            || self.nearest > segment.farthest
            || self.farthest < segment.nearest
    }
}

/// How many items make one piece of parallel work.
const CHUNK: usize = 1 << 14;

/// An item on its way into the cells of a level.
#[derive(Debug, Clone, Copy)]
struct Placed {
    item: u32,
    level: u32,
    bounds: Bounds,
    /// The image of a triangle; empty for others.
    image: [DVec2; 3],
    /// How many levels finer the cells of a sliver may be.
    finer: u32,
}

/// The pyramid of grids; see the module docs.
#[derive(Debug)]
pub(super) struct ImageIndex {
    rounding: Rounding,
    origin: DVec2,
    /// The far corner of the coarsest level.
    end: DVec2,
    levels: Vec<Level>,
    /// Where the triangles of each cell begin in `entries`.
    starts: Vec<u32>,
    entries: Vec<Entry>,
    /// Depth behind which all is hidden, for each cell of all levels; empty when layers count.
    covered_from: Vec<f64>,
    /// Items to test against every segment: triangles that the near plane cuts.
    everywhere: Vec<u32>,
    n_items: usize,
}

impl ImageIndex {
    /// An index of the triangles that may cover some of `segments`, without `back_faces`.
    pub(super) fn new<'s>(
        view: &ViewedScene,
        segments: impl Iterator<Item = &'s Segment> + Clone,
        options: &VisibilityOptions,
        back_faces: &BackFaces,
    ) -> Self {
        let rounding = Rounding::new(view);
        let place = |triangle| match back_faces.leaves_out(triangle) {
            true => Place::Nowhere,
            false => rounding.place(view, triangle),
        };
        let n_triangles = view.scene().triangles().len();
        let covers = (!options.count_layers).then_some(options.contact_tolerance);
        Self::of_items(view, segments, n_triangles, covers, place)
    }

    /// An index of the items numbered below `n_items` that may lie near or in front of some of
    /// `segments`.
    ///
    /// With `covers`, a contact tolerance, items behind covered cells are left out; they must then be
    /// the triangles of the scene.
    pub(super) fn of_items<'s>(
        view: &ViewedScene,
        segments: impl Iterator<Item = &'s Segment> + Clone,
        n_items: usize,
        covers: Option<f64>,
        place: impl Fn(u32) -> Place + Sync,
    ) -> Self {
        let rounding = Rounding::new(view);
        let n_segments = segments.clone().count();
        let (origin, levels) = levels(&rounding, segments.clone(), n_items.max(n_segments));
        let n_cells = levels.last().map_or(0, |level| level.first + level.columns * level.rows);
        let coarsest = levels[levels.len() - 1];
        let size = dvec2(f64::from(coarsest.columns), f64::from(coarsest.rows)) * coarsest.cell;
        let mut index = Self {
            rounding,
            origin,
            end: origin + size,
            levels,
            starts: vec![0; n_cells as usize + 1],
            entries: Vec::new(),
            covered_from: Vec::new(),
            everywhere: Vec::new(),
            n_items,
        };
        if n_segments == 0 {
            return index;
        }
        // Marking pays when few segments are drawn: most items then lie far from all of them.
        let marks = (n_segments < n_items / 4).then(|| index.mark(segments));
        let near = index.near_segments(marks.as_deref(), place);
        if let Some(contact_tolerance) = covers {
            index.covered_from = index.find_covered_cells(view, &near, contact_tolerance);
        }
        index.insert(&near, marks.as_deref());
        index
    }

    /// The box of a segment's image.
    pub(super) fn bounds_of(&self, segment: &Segment) -> Bounds {
        self.rounding.bounds(segment.image, segment.depth)
    }

    /// Whether every cell along the segment is covered in front of all of it.
    pub(super) fn hides(&self, segment: &Segment) -> bool {
        if self.covered_from.is_empty() {
            return false;
        }
        let bounds = self.rounding.bounds(segment.image, segment.depth);
        let finest = &self.levels[0];
        let last = dvec2(f64::from(finest.columns), f64::from(finest.rows)) * finest.cell;
        let inside =
            bounds.low.cmpgt(self.origin).all() && bounds.high.cmplt(self.origin + last).all();
        inside
            && !self.any_cell(finest, segment, &bounds, |cell| {
                self.covered_from[cell as usize] >= bounds.nearest
            })
    }

    /// For each cell the largest depth of a segment in it.
    fn mark<'s>(&self, segments: impl Iterator<Item = &'s Segment>) -> Vec<f64> {
        let mut marks = vec![f64::NEG_INFINITY; self.starts.len() - 1];
        for segment in segments {
            let bounds = self.rounding.bounds(segment.image, segment.depth);
            for level in &self.levels {
                self.any_cell(level, segment, &bounds, |cell| {
                    let mark = &mut marks[cell as usize];
                    *mark = mark.max(bounds.farthest);
                    false
                });
            }
        }
        marks
    }

    /// The items that share a cell with a segment, in order; records those to test everywhere.
    fn near_segments(
        &mut self,
        marks: Option<&[f64]>,
        place: impl Fn(u32) -> Place + Sync,
    ) -> Vec<Vec<Placed>> {
        let this = &*self;
        type Part = (Vec<Placed>, Vec<u32>);
        let parts: Vec<Part> = (0..this.n_items.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let (mut near, mut everywhere) = (Vec::new(), Vec::new());
                let last = ((chunk + 1) * CHUNK).min(this.n_items);
                for item in (chunk * CHUNK) as u32..last as u32 {
                    let (bounds, image) = match place(item) {
                        Place::Nowhere => continue,
                        Place::Everywhere => {
                            everywhere.push(item);
                            continue;
                        }
                        Place::Within(bounds) => (bounds, None),
                        Place::Triangle(bounds, image) => (bounds, Some(image)),
                    };
                    let Some(level) = this.level_of(&bounds) else { continue };
                    let mut is_near = false;
                    this.for_box(&this.levels[level], &bounds, |cell| {
                        is_near |= marks.is_none_or(|m| bounds.nearest <= m[cell as usize]);
                    });
                    if is_near {
                        let cell = this.levels[level].cell;
                        let finer = image.map_or(0, |image| finer_levels(cell, level, image));
                        let (level, image) = (level as u32, image.unwrap_or_default());
                        near.push(Placed { item, level, bounds, image, finer });
                    }
                }
                (near, everywhere)
            })
            .collect();
        let (near, everywhere): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
        self.everywhere = everywhere.concat();
        near
    }

    /// Puts the items into their cells, except in cells that are covered in front of them.
    fn insert(&mut self, near: &[Vec<Placed>], marks: Option<&[f64]>) {
        let this = &*self;
        let most_finer = most_finer(near, self.n_items);
        let parts: Vec<Vec<(u32, Entry)>> = near
            .par_iter()
            .map(|near| {
                let mut entries = Vec::with_capacity(2 * near.len());
                for Placed { item, level, bounds, image, finer } in near {
                    let entry = Entry::new(*item, bounds);
                    let mut add = |cell: u32| {
                        let wanted = marks.is_none_or(|m| bounds.nearest <= m[cell as usize]);
                        let covered_from = this.covered_from.get(cell as usize);
                        if wanted && covered_from.is_none_or(|&depth| bounds.nearest <= depth) {
                            entries.push((cell, entry));
                        }
                    };
                    match finer.min(&most_finer) {
                        0 => this.for_box(&this.levels[*level as usize], bounds, add),
                        finer => {
                            let level = &this.levels[(level - finer) as usize];
                            this.for_triangle(level, bounds, *image, &mut add);
                        }
                    }
                }
                entries
            })
            .collect();

        for entries in &parts {
            for &(cell, _) in entries {
                self.starts[cell as usize + 1] += 1;
            }
        }
        for cell in 0..self.starts.len() - 1 {
            self.starts[cell + 1] += self.starts[cell];
        }
        self.entries = vec![Entry::default(); self.starts.last().map_or(0, |&n| n as usize)];
        let mut next = self.starts.clone();
        for &(cell, entry) in parts.iter().flatten() {
            let slot = &mut next[cell as usize];
            self.entries[*slot as usize] = entry;
            *slot += 1;
        }
        for level in &mut self.levels {
            let end = level.first + level.columns * level.rows;
            level.used = self.starts[level.first as usize] < self.starts[end as usize];
        }
    }

    /// The finest level whose cells are at least as large as the box; `None` for an empty box or
    /// one outside the grid.
    fn level_of(&self, bounds: &Bounds) -> Option<usize> {
        if bounds.low.x > bounds.high.x {
            return None;
        }
        let beside = bounds.high.cmplt(self.origin).any() || bounds.low.cmpgt(self.end).any();
        if beside && !self.has_border_cells() {
            return None;
        }
        let size = (bounds.high - bounds.low).max_element();
        let doublings = (size * self.levels[0].inverse).log2().ceil();
        Some((doublings.max(0.0) as usize).min(self.levels.len() - 1))
    }

    /// Whether border cells stand for all that lies further out.
    fn has_border_cells(&self) -> bool {
        self.rounding.is_unbounded()
    }

    fn column(&self, level: &Level, x: f64) -> u32 {
        (((x - self.origin.x) * level.inverse) as u32).min(level.columns - 1)
    }

    fn row(&self, level: &Level, y: f64) -> u32 {
        (((y - self.origin.y) * level.inverse) as u32).min(level.rows - 1)
    }

    fn for_box(&self, level: &Level, bounds: &Bounds, mut f: impl FnMut(u32)) {
        for row in self.row(level, bounds.low.y)..=self.row(level, bounds.high.y) {
            let first = level.first + row * level.columns;
            for column in self.column(level, bounds.low.x)..=self.column(level, bounds.high.x) {
                f(first + column);
            }
        }
    }

    /// Whether `f` holds for any of the cells along a segment, in the order of the rows.
    fn any_cell(
        &self,
        level: &Level,
        segment: &Segment,
        bounds: &Bounds,
        mut f: impl FnMut(u32) -> bool,
    ) -> bool {
        let (first_row, last_row) = (self.row(level, bounds.low.y), self.row(level, bounds.high.y));
        if first_row == last_row {
            let first = level.first + first_row * level.columns;
            let columns = self.column(level, bounds.low.x)..=self.column(level, bounds.high.x);
            return columns.into_iter().any(|column| f(first + column));
        }
        let margin =
            self.rounding.image_error(bounds.low.abs().max(bounds.high.abs()).element_sum());
        let [a, b] = segment.image;
        let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
        let is_level = a.y == b.y;
        let at = |y: f64| {
            let t = (y - a.y) / (b.y - a.y);
            if t <= 0.0 {
                a.x
            } else if t >= 1.0 {
                b.x
            } else {
                a.x + t * (b.x - a.x)
            }
        };
        for row in first_row..=last_row {
            let low = self.origin.y + f64::from(row) * level.cell - margin;
            let high = self.origin.y + f64::from(row + 1) * level.cell + margin;
            // The outermost rows reach as far as there is anything.
            let from = if row == first_row || is_level { a.x } else { at(low) };
            let to = if row == last_row || is_level { b.x } else { at(high) };
            let (left, right) = (from.min(to) - margin, from.max(to) + margin);
            let first = level.first + row * level.columns;
            for column in self.column(level, left)..=self.column(level, right) {
                if f(first + column) {
                    return true;
                }
            }
        }
        false
    }
}

/// Visits each item near a segment once; work space of one thread.
#[derive(Debug)]
pub(super) struct Visitor {
    /// The number of the last segment that was offered each item.
    seen: Vec<u32>,
    segment: u32,
}

impl Visitor {
    /// Work space for queries of `index`.
    pub(super) fn new(index: Option<&ImageIndex>) -> Self {
        Self { seen: vec![0; index.map_or(0, |index| index.n_items)], segment: 0 }
    }

    /// Whether `test` holds for any triangle that may cover some of `segment`.
    ///
    /// Large triangles come first, since they are the likeliest to hide all of it.
    pub(super) fn any(
        &mut self,
        index: &ImageIndex,
        view: &ViewedScene,
        segment: &Segment,
        mut test: impl FnMut(u32) -> bool,
    ) -> bool {
        if index.everywhere.iter().any(|&triangle| test(triangle)) {
            return true;
        }
        // Whatever lies in front may cover it, however far in front.
        let bounds = index.bounds_of(segment).with_all_nearer();
        let corners = |triangle: u32| view.scene().triangles()[triangle as usize];
        self.any_within(index, view, segment, &bounds, corners, test)
    }

    /// Whether `test` holds for any item of the cells whose box meets `bounds`, the segment's or a
    /// part of it, and whose `corners` are not all on one side of the segment.
    pub(super) fn any_within<const N: usize>(
        &mut self,
        index: &ImageIndex,
        view: &ViewedScene,
        segment: &Segment,
        bounds: &Bounds,
        corners: impl Fn(u32) -> [u32; N],
        mut test: impl FnMut(u32) -> bool,
    ) -> bool {
        self.segment = self.segment.wrapping_add(1);
        if self.segment == 0 {
            self.seen.fill(0);
            self.segment = 1;
        }
        let separation = Separation::new(&index.rounding, segment);
        let own = Entry::new(0, bounds);
        let (seen, number) = (&mut self.seen, self.segment);
        index.levels.iter().rev().filter(|level| level.used).any(|level| {
            index.any_cell(level, segment, bounds, |cell| {
                let cell = cell as usize;
                let (start, end) = (index.starts[cell], index.starts[cell + 1]);
                index.entries[start as usize..end as usize].iter().any(|entry| {
                    if entry.is_apart(&own) {
                        return false;
                    }
                    let last = &mut seen[entry.item as usize];
                    if *last == number {
                        return false;
                    }
                    *last = number;
                    let corners = corners(entry.item);
                    let points = corners.map(|corner| view.image()[corner as usize]);
                    !separation.apart(corners, points) && test(entry.item)
                })
            })
        })
    }
}
