//! Where the background is visible, on a grid with cells of the pen width.
//!
//! ```text
//!      ░░░░░░░░░░░░░░        The background counts where a disc as wide as the pen finds room in
//!      ░░░┌──────┐░░░        it: cracks between faces do not, nor does the space between the two
//!      ░░░│      ││░░        walls of a hairline gap. A line beside such a disc is outline.
//!      ░░░└──────┘░░░
//! ```
//!
//! These decisions only affect how lines look on paper, so a raster is good enough, and infinitely thin faces
//! do no harm.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec2, dvec2};
use rayon::prelude::*;

use crate::camera::{ImagePoint, Projection};
use crate::classify::ViewedScene;
use crate::strokes::draft::DraftPoint;

use super::tiles::Tiles;

/// Cells across a pen width, for most pages.
const CELLS_PER_PEN: f64 = 3.0;

/// Most cells of the grid. Larger pages get larger ones.
const MAX_CELLS: f64 = (1u64 << 28) as f64;

/// Most samples on a segment.
const MAX_SAMPLES: f64 = 1e6;

/// What is known of a cell depends on the material no farther away than this many cells: three times the
/// radius of a disc, which is half a pen.
const REACH: usize = (1.5 * CELLS_PER_PEN) as usize + 1;

/// Looks for the background in a view.
pub(super) struct BackgroundFinder<'a> {
    view: &'a ViewedScene<'a>,
    grid: Grid,
    /// Of a disc as wide as the pen, in cells.
    radius: f64,
}

/// The places along some strokes beside which the background is seen.
pub(super) struct Background {
    grid: Grid,
    /// The cells beside discs that find room.
    beside: Tiles,
}

/// A box of the image, cut into square cells.
#[derive(Clone, Copy)]
struct Grid {
    low: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
}

impl<'a> BackgroundFinder<'a> {
    /// Looks in a box of the image.
    pub(super) fn new(view: &'a ViewedScene, (low, high): (DVec2, DVec2), pen: f64) -> Self {
        // A disc needs room outside the box too.
        let (low, high) = (low - 3.0 * pen, high + 3.0 * pen);
        let size = high - low;
        let cell = (pen / CELLS_PER_PEN).max((size.x * size.y / MAX_CELLS).sqrt());
        let cell = cell.max(size.max_element() / MAX_CELLS.sqrt() / 64.0).max(f64::MIN_POSITIVE);
        let [columns, rows] = [size.x, size.y].map(|length| (length / cell) as usize + 1);
        let grid = Grid { low, cell, columns, rows };
        Self { view, grid, radius: 0.5 * pen / cell }
    }

    /// Finds the background beside some strokes. O(cells along them + triangles), in parallel.
    pub(super) fn beside<'p>(&self, strokes: impl Iterator<Item = &'p [DraftPoint]>) -> Background {
        let grid = self.grid;
        let mut material = Tiles::new(grid.columns, grid.rows);
        for pair in strokes.flat_map(|points| points.windows(2)) {
            grid.for_each_sample(pair[0].at, pair[1].at, |_, cell| {
                if let Some(cell) = cell {
                    material.add(cell, REACH);
                }
            });
        }
        material.number();
        self.cover(&mut material);
        let rooms = material.grown(self.radius).inverted();
        Background { grid, beside: rooms.grown(2.0 * self.radius) }
    }

    /// Sets the cells whose middle lies in the image of a triangle.
    fn cover(&self, material: &mut Tiles) {
        let near = match self.view.camera().projection() {
            Projection::Perspective { near, .. } => near * self.view.camera().forward().length(),
            Projection::Orthographic => f64::NEG_INFINITY,
        };
        let bits: Vec<AtomicU64> = material.take_bits().into_iter().map(AtomicU64::new).collect();
        self.view.scene().triangles().par_iter().with_min_len(1024).for_each(|triangle| {
            let corners = triangle.map(|vertex| self.view.image()[vertex as usize]);
            self.grid.fill(corners, near, material, &bits);
        });
        material.set_bits(bits.into_iter().map(AtomicU64::into_inner).collect());
    }
}

impl Background {
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
    /// way, and whether the background is seen beside it. The segment is one of the strokes asked about.
    pub(super) fn for_each_sample(&self, a: DVec2, b: DVec2, mut f: impl FnMut(f64, bool)) {
        self.grid.for_each_sample(a, b, |t, cell| {
            f(t, cell.is_some_and(|cell| self.beside.has(cell)));
        });
    }
}

impl Grid {
    /// Calls `f` for each part of a segment as long as a cell with where it begins, as a fraction of the
    /// way, and the cell in its middle, if that is one.
    fn for_each_sample(&self, a: DVec2, b: DVec2, mut f: impl FnMut(f64, Option<[usize; 2]>)) {
        let n = (a.distance(b) / self.cell).ceil().clamp(1.0, MAX_SAMPLES) as usize;
        for k in 0..n {
            let at = (a.lerp(b, (k as f64 + 0.5) / n as f64) - self.low) / self.cell;
            let cell = [at.x as usize, at.y as usize];
            let is_inside = at.cmpge(DVec2::ZERO).all();
            let is_inside = is_inside && cell[0] < self.columns && cell[1] < self.rows;
            f(k as f64 / n as f64, is_inside.then_some(cell));
        }
    }

    /// Sets the cells of one triangle, cut at the near plane.
    fn fill(&self, corners: [ImagePoint; 3], near: f64, tiles: &Tiles, bits: &[AtomicU64]) {
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
        let first = polygon[0];
        let (low, high) = polygon.iter().fold((first, first), |(l, h), &p| (l.min(p), h.max(p)));
        let low = low.ceil().max(DVec2::ZERO);
        let last = dvec2(self.columns as f64 - 1.0, self.rows as f64 - 1.0);
        let high = high.floor().min(last);
        let is_empty = low.cmpgt(high).any();
        let [left_top, right_bottom] = [low, high].map(|p| [p.x as usize, p.y as usize]);
        if is_empty || !tiles.has_any_in(left_top, right_bottom) {
            return;
        }
        let (mut row, last_row) = (low.y, high.y);
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
                let (left, right) = (left as usize, right as usize);
                tiles.for_each_in_row(row as usize, left, right, |tile, mask| {
                    // Most cells are covered more than once, and reading is cheap.
                    if bits[tile].load(Ordering::Relaxed) & mask != mask {
                        bits[tile].fetch_or(mask, Ordering::Relaxed);
                    }
                });
            }
            row += 1.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat3, DVec3, dvec3};

    /// Numbers between -1 and 1.
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 5_u64;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) as f64 / f64::from(1 << 30) - 1.0
        }
    }

    #[test]
    fn cells_are_covered_when_their_middle_is_in_front_of_the_near_plane_in_a_triangle() {
        let mut next = numbers();
        let grid = Grid { low: dvec2(-1.3, -1.1), cell: 0.1, columns: 27, rows: 23 };
        let (mut n_covered, mut n_cut) = (0, 0);
        for _ in 0..400 {
            let near = 0.7;
            let corners: [ImagePoint; 3] = std::array::from_fn(|_| {
                let depth = 1.3 + next();
                ImagePoint { x: 2.0 * next(), y: 2.0 * next(), w: depth, depth }
            });
            n_cut += usize::from(corners.iter().any(|p| p.depth < near));
            let mut tiles = Tiles::new(grid.columns, grid.rows);
            tiles.add([13, 11], 30);
            tiles.number();
            let bits: Vec<AtomicU64> = tiles.take_bits().into_iter().map(AtomicU64::new).collect();
            grid.fill(corners, near, &tiles, &bits);
            tiles.set_bits(bits.into_iter().map(AtomicU64::into_inner).collect());
            // The sight line through the middle of a cell is a sum of the corners.
            let sum = DMat3::from_cols_array_2d(&corners.map(|p| [p.x, p.y, p.w])).inverse();
            let depths = DVec3::from(corners.map(|p| p.depth));
            for (column, row) in
                (0..grid.columns).flat_map(|column| (0..grid.rows).map(move |row| (column, row)))
            {
                let middle = grid.low + grid.cell * (dvec2(column as f64, row as f64) + 0.5);
                let weights = sum * dvec3(middle.x, middle.y, 1.0);
                let in_front = weights.dot(depths) / weights.element_sum() - near;
                let doubt = 1e-9 * weights.abs().element_sum();
                if weights.abs().min_element() < doubt || in_front.abs() < 1e-9 {
                    continue;
                }
                let is_covered = weights.min_element() > 0.0 && in_front > 0.0;
                assert_eq!(tiles.has([column, row]), is_covered, "{corners:?} {column} {row}");
                n_covered += usize::from(is_covered);
            }
        }
        assert!(n_covered > 10_000 && n_cut > 100, "{n_covered} {n_cut}");
    }
}
