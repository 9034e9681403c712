//! Cells for long thin triangles.
//!
//! ```text
//!   ┌─────────────┐      ┌──┬──┬──┬──┐
//!   │          ／／│      │  │  │▒▒│▒▒│     The box of a sliver that lies askew is nearly empty.
//!   │      ／／／  │      ├──┼──┼──┼──┤     Cells of finer levels along the sliver hold it better:
//!   │  ／／／      │      │▒▒│▒▒│▒▒│  │     few segments pass through those.
//!   │／／          │      │▒▒│  │  │  │
//!   └─────────────┘      └──┴──┴──┴──┘
//! ```
//!
//! The sides of cylinders, extrusions and fans are such triangles.

use glam::DVec2;

use super::{ImageIndex, Level, Placed};
use crate::engines::edge::rounding::Bounds;

/// A sliver goes this many levels finer than its box at most.
const MOST_FINER: u32 = 6;

/// Triangles go into finer cells when these would be half as large at least.
const LEAST_FINER: u32 = 2;

/// Cells for slivers: so many for each item of an index, with some more for few items.
const CELLS_PER_ITEM: usize = 4;
const SPARE_CELLS: usize = 1 << 16;

/// How many levels finer than its box's a triangle's cells may be, not to be much wider than it.
pub(super) fn finer_levels(cell: f64, level: usize, [a, b, c]: [DVec2; 3]) -> u32 {
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let width = (b - a).perp_dot(c - a).abs() / longest;
    let doublings = (cell / (2.0 * width)).log2();
    // Not a number counts as none.
    let finer = (doublings.max(0.0) as u32).min(MOST_FINER).min(level as u32);
    if finer < LEAST_FINER { 0 } else { finer }
}

/// The most by which slivers may go finer, so that all their cells together are not too many.
pub(super) fn most_finer(near: &[Vec<Placed>], n_items: usize) -> u32 {
    let mut slivers = [0; MOST_FINER as usize + 1];
    near.iter().flatten().for_each(|placed| slivers[placed.finer as usize] += 1);
    let most_cells = CELLS_PER_ITEM * n_items + SPARE_CELLS;
    let n_cells = |most: u32| -> usize {
        (LEAST_FINER..=MOST_FINER)
            .map(|finer| slivers[finer as usize] << (finer.min(most) + 1))
            .sum()
    };
    (LEAST_FINER..=MOST_FINER).rev().find(|&most| n_cells(most) <= most_cells).unwrap_or(0)
}

impl ImageIndex {
    /// Calls `f` with the cells of a level that a triangle's image may touch.
    pub(super) fn for_triangle(
        &self,
        level: &Level,
        bounds: &Bounds,
        image: [DVec2; 3],
        mut f: impl FnMut(u32),
    ) {
        let (first_row, last_row) = (self.row(level, bounds.low.y), self.row(level, bounds.high.y));
        let margin =
            self.rounding.image_error(bounds.low.abs().max(bounds.high.abs()).element_sum());
        for row in first_row..=last_row {
            // The outermost rows reach as far as there is anything.
            let low = self.origin.y + f64::from(row) * level.cell - margin;
            let low = if row == first_row { f64::NEG_INFINITY } else { low };
            let high = self.origin.y + f64::from(row + 1) * level.cell + margin;
            let high = if row == last_row { f64::INFINITY } else { high };
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            for [a, b] in [[0, 1], [1, 2], [2, 0]].map(|side| side.map(|k: usize| image[k])) {
                let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
                if b.y < low || a.y > high {
                    continue;
                }
                let at = |y: f64| a.x + ((y - a.y) / (b.y - a.y)) * (b.x - a.x);
                let from = if a.y >= low { a.x } else { at(low) };
                let to = if b.y <= high { b.x } else { at(high) };
                left = left.min(from).min(to);
                right = right.max(from).max(to);
            }
            if left > right {
                continue;
            }
            let first = level.first + row * level.columns;
            for column in self.column(level, left - margin)..=self.column(level, right + margin) {
                f(first + column);
            }
        }
    }
}
