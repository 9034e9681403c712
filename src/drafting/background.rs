//! Where the background is seen, on a grid of the pen's size.
//!
//! ```text
//!      ░░░░░░░░░░░░░░        The background counts where a disc as wide as the pen finds room in
//!      ░░░┌──────┐░░░        it: cracks between faces do not, nor does the space between the two
//!      ░░░│      ││░░        walls of a hairline gap. A line beside such a disc is outline.
//!      ░░░└──────┘░░░
//! ```
//!
//! What is decided here is how lines look on paper. So a raster will do, and faces of no thickness
//! do no harm.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec2;
use rayon::prelude::*;

use crate::camera::{ImagePoint, Projection};
use crate::classify::ViewedScene;
use crate::strokes::draft::DraftPoint;

/// Cells across a pen's width, for most pages.
const CELLS_PER_PEN: f64 = 3.0;

/// Most cells of the grid: 32 MB. Larger pages get larger ones.
const MAX_CELLS: f64 = (1u64 << 28) as f64;

/// The places beside which the background is seen.
pub(super) struct Background {
    low: DVec2,
    cell: f64,
    bits: Bits,
}

/// The background, looked at when first asked for.
pub(super) struct LazyBackground<'a> {
    view: &'a ViewedScene<'a>,
    bounds: (DVec2, DVec2),
    pen: f64,
    known: Option<Background>,
}

impl<'a> LazyBackground<'a> {
    pub(super) fn new(view: &'a ViewedScene<'a>, bounds: (DVec2, DVec2), pen: f64) -> Self {
        Self { view, bounds, pen, known: None }
    }

    pub(super) fn get(&mut self) -> &Background {
        let Self { view, bounds, pen, known } = self;
        known.get_or_insert_with(|| Background::new(view, *bounds, *pen))
    }
}

impl Background {
    /// Looks at a box of the image. O(area over cells / 64 + triangles), in parallel.
    fn new(view: &ViewedScene, (low, high): (DVec2, DVec2), pen: f64) -> Self {
        // A disc needs room outside the box too.
        let (low, high) = (low - 3.0 * pen, high + 3.0 * pen);
        let size = high - low;
        let cell = (pen / CELLS_PER_PEN).max((size.x * size.y / MAX_CELLS).sqrt());
        let cell = cell.max(size.max_element() / MAX_CELLS.sqrt() / 64.0).max(f64::MIN_POSITIVE);
        let [columns, rows] = [size.x, size.y].map(|length| (length / cell) as usize + 1);
        let material = Raster { low, cell, columns, rows }.cover(view);
        let radius = 0.5 * pen / cell;
        let rooms = material.grown(radius).inverted();
        Self { low, cell, bits: rooms.grown(2.0 * radius) }
    }

    /// Whether the background is seen beside a point.
    pub(super) fn is_beside(&self, point: DVec2) -> bool {
        let at = (point - self.low) / self.cell;
        at.cmpge(DVec2::ZERO).all() && self.bits.get(at.x as usize, at.y as usize)
    }

    /// The share of a stroke beside which the background is seen.
    pub(super) fn share_beside(&self, points: &[DraftPoint]) -> f64 {
        let (mut beside, mut all) = (0usize, 0usize);
        for pair in points.windows(2) {
            self.for_each_sample(pair[0].at, pair[1].at, |_, is_beside| {
                all += 1;
                beside += usize::from(is_beside);
            });
        }
        beside as f64 / all.max(1) as f64
    }

    /// Calls `f` for each part of a segment as long as a cell with where it begins, as a fraction of the
    /// way, and whether the background is seen beside it.
    pub(super) fn for_each_sample(&self, a: DVec2, b: DVec2, mut f: impl FnMut(f64, bool)) {
        let n = (a.distance(b) / self.cell).ceil().clamp(1.0, MAX_SAMPLES) as usize;
        for k in 0..n {
            let at = a.lerp(b, (k as f64 + 0.5) / n as f64);
            f(k as f64 / n as f64, self.is_beside(at));
        }
    }
}

/// Most samples on a segment.
const MAX_SAMPLES: f64 = 1e6;

/// The grid while it is filled.
struct Raster {
    low: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
}

impl Raster {
    /// Cells whose middle lies in the image of a triangle.
    fn cover(&self, view: &ViewedScene) -> Bits {
        let words = self.columns.div_ceil(64);
        let bits: Vec<AtomicU64> = (0..words * self.rows).map(|_| AtomicU64::new(0)).collect();
        let near = match view.camera().projection() {
            Projection::Perspective { near, .. } => near * view.camera().forward().length(),
            Projection::Orthographic => f64::NEG_INFINITY,
        };
        view.scene().triangles().par_iter().with_min_len(1024).for_each(|triangle| {
            let corners = triangle.map(|vertex| view.image()[vertex as usize]);
            self.fill(corners, near, &bits);
        });
        let bits = bits.into_iter().map(AtomicU64::into_inner).collect();
        Bits { columns: self.columns, words, bits }
    }

    /// Sets the cells of one triangle, cut at the near plane.
    fn fill(&self, corners: [ImagePoint; 3], near: f64, bits: &[AtomicU64]) {
        let mut polygon = [DVec2::ZERO; 4];
        let mut n = 0;
        for i in 0..3 {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            let mut push = |p: ImagePoint| {
                polygon[n] = (p.image() - self.low) / self.cell - 0.5;
                n += 1;
            };
            if a.depth >= near {
                push(a);
            }
            if (a.depth >= near) != (b.depth >= near) {
                push(a.towards(b, (near - a.depth) / (b.depth - a.depth)));
            }
        }
        let polygon = &polygon[..n];
        if n < 3 || !polygon.iter().all(|p| p.is_finite()) {
            return;
        }
        let (low, high) = polygon
            .iter()
            .fold((polygon[0].y, polygon[0].y), |(low, high), p| (low.min(p.y), high.max(p.y)));
        let words = self.columns.div_ceil(64);
        let last_row = high.floor().min(self.rows as f64 - 1.0);
        let mut row = low.ceil().max(0.0);
        while row <= last_row {
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            for i in 0..n {
                let (a, b) = (polygon[i], polygon[(i + 1) % n]);
                if a.y.min(b.y) <= row && row <= a.y.max(b.y) {
                    let xs = if a.y == b.y {
                        [a.x, b.x]
                    } else {
                        [a.x + (row - a.y) / (b.y - a.y) * (b.x - a.x); 2]
                    };
                    left = left.min(xs[0]).min(xs[1]);
                    right = right.max(xs[0]).max(xs[1]);
                }
            }
            let (left, right) =
                (left.ceil().max(0.0), right.floor().min(self.columns as f64 - 1.0));
            if left <= right {
                let start = row as usize * words;
                set(&bits[start..start + words], left as usize, right as usize);
            }
            row += 1.0;
        }
    }
}

/// Sets the bits from `left` to `right` of a row.
fn set(row: &[AtomicU64], left: usize, right: usize) {
    let (first, last) = (left / 64, right / 64);
    for (word, bits) in (first..).zip(&row[first..=last]) {
        let from = if word == first { left % 64 } else { 0 };
        let to = if word == last { right % 64 } else { 63 };
        let mask = (u64::MAX >> (63 - to)) & (u64::MAX << from);
        // Most cells are covered more than once, and reading is cheap.
        if bits.load(Ordering::Relaxed) & mask != mask {
            bits.fetch_or(mask, Ordering::Relaxed);
        }
    }
}

/// A bit for each cell, row by row.
struct Bits {
    columns: usize,
    words: usize,
    bits: Vec<u64>,
}

impl Bits {
    fn get(&self, column: usize, row: usize) -> bool {
        let word = self.bits.get(row * self.words + column / 64);
        column < self.columns && word.is_some_and(|word| word >> (column % 64) & 1 == 1)
    }

    fn inverted(mut self) -> Self {
        self.bits.par_iter_mut().for_each(|word| *word = !*word);
        self
    }

    /// All cells no farther than `radius` cells from one that is set.
    fn grown(&self, radius: f64) -> Self {
        let reach = radius.floor() as usize;
        let n_rows = self.bits.len() / self.words.max(1);
        let mut bits = vec![0; self.bits.len()];
        bits.par_chunks_mut(self.words.max(1)).enumerate().for_each_init(
            || vec![0; self.words],
            |wide, (row, grown)| {
                for other in row.saturating_sub(reach)..(row + reach + 1).min(n_rows) {
                    let up = row.abs_diff(other) as f64;
                    let across = (radius * radius - up * up).max(0.0).sqrt().floor() as usize;
                    let source = &self.bits[other * self.words..(other + 1) * self.words];
                    widen(source, across, wide);
                    grown.iter_mut().zip(&*wide).for_each(|(grown, wide)| *grown |= wide);
                }
            },
        );
        Self { columns: self.columns, words: self.words, bits }
    }
}

/// A row with every set bit spread by `reach`, below 64, to both sides.
fn widen(row: &[u64], reach: usize, wide: &mut [u64]) {
    for (i, wide) in wide.iter_mut().enumerate() {
        let before = if i > 0 { row[i - 1] } else { 0 };
        let (here, after) = (row[i], row.get(i + 1).copied().unwrap_or(0));
        *wide = here;
        for shift in 1..=reach.min(63) {
            *wide |= here << shift | before >> (64 - shift) | here >> shift | after << (64 - shift);
        }
    }
}
