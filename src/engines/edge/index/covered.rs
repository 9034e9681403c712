//! Cells of an index that a single triangle, or one for each of their parts, covers wholly.
//!
//! ```text
//!        ╱╲            All that lies behind a covered cell (▓), as seen from the eye, is hidden
//!       ╱▓▓╲           there: W. R. Franklin, "A linear time exact hidden surface algorithm",
//!      ╱▓▓▓▓╲          SIGGRAPH 1980.
//!     ╱──────╲
//! ```

use super::{ImageIndex, Level, Placed};
use crate::classify::ViewedScene;
use glam::DVec2;
use rayon::prelude::*;

/// Triangles seen at a flatter angle than this sine are not used as covers of cells: the contact
/// tolerance, divided by it, becomes a distance along the sight line.
const MIN_COVER_SINE: f64 = 0.05;

impl ImageIndex {
    /// For each cell of every level the smallest depth behind which one triangle, or one for each
    /// of its parts, covers it wholly; infinite where none does.
    pub(super) fn find_covered_cells(
        &self,
        view: &ViewedScene,
        near: &[Vec<Placed>],
        contact_tolerance: f64,
    ) -> Vec<f64> {
        let parts: Vec<Vec<(u32, f64)>> = near
            .par_iter()
            .map(|near| {
                let mut covered = Vec::new();
                for placed in near.iter().filter(|placed| placed.level >= 2) {
                    let push = |cell, depth| covered.push((cell, depth));
                    self.cells_within(view, placed, contact_tolerance, push);
                }
                covered
            })
            .collect();
        let mut covered_from = vec![f64::INFINITY; self.starts.len() - 1];
        for &(cell, depth) in parts.iter().flatten() {
            let from = &mut covered_from[cell as usize];
            *from = from.min(depth);
        }
        // A cell is covered when its four parts are, and they are covered when it is.
        for pair in self.levels.windows(2) {
            for_parts(&pair[0], &pair[1], |cell, parts| {
                let behind_parts = parts
                    .iter()
                    .map(|part| part.map_or(f64::NEG_INFINITY, |p| covered_from[p as usize]))
                    .fold(f64::NEG_INFINITY, f64::max);
                let from = &mut covered_from[cell as usize];
                *from = from.min(behind_parts);
            });
        }
        for pair in self.levels.windows(2).rev() {
            for_parts(&pair[0], &pair[1], |cell, parts| {
                let whole = covered_from[cell as usize];
                for &part in parts.iter().flatten() {
                    let from = &mut covered_from[part as usize];
                    *from = from.min(whole);
                }
            });
        }
        covered_from
    }

    /// Calls `f` with cells that lie wholly within a triangle's image, of a level two finer than
    /// its own, and the depth behind which the triangle certainly covers.
    fn cells_within(
        &self,
        view: &ViewedScene,
        placed: &Placed,
        contact_tolerance: f64,
        mut f: impl FnMut(u32, f64),
    ) {
        let bounds = &placed.bounds;
        let corners = view.scene().triangles()[placed.item as usize];
        let Some(sine) = sine_of_sight(view, corners) else {
            return;
        };
        let depth = bounds.farthest + contact_tolerance / sine;
        let level = &self.levels[placed.level as usize - 2];
        let points = corners.map(|corner| view.image()[corner as usize].image());
        let margin =
            self.rounding.image_error(bounds.low.abs().max(bounds.high.abs()).element_sum());
        let (first_row, last_row) = (self.row(level, bounds.low.y), self.row(level, bounds.high.y));
        for row in first_row..=last_row {
            let low = self.origin.y + f64::from(row) * level.cell - margin;
            let high = low + level.cell + 2.0 * margin;
            let Some((left, right)) = chord(&points, low, margin)
                .zip(chord(&points, high, margin))
                .map(|(a, b)| (a.0.max(b.0) + margin, a.1.min(b.1) - margin))
            else {
                continue;
            };
            let first = ((left - self.origin.x) * level.inverse).ceil().max(0.0);
            let end = ((right - self.origin.x) * level.inverse).floor();
            // Border cells stand for all that lies further out: no triangle covers that.
            let border = if self.has_border_cells() { 1.0 } else { 0.0 };
            if f64::from(row) < border || f64::from(row) >= f64::from(level.rows) - border {
                continue;
            }
            let end = end.min(f64::from(level.columns) - border);
            let mut column = first.max(border);
            while column < end {
                f(level.first + row * level.columns + column as u32, depth);
                column += 1.0;
            }
        }
    }
}

/// The sine of the flattest angle between a triangle and the sight lines through it; `None` when
/// it is too flat to serve as a cover.
fn sine_of_sight(view: &ViewedScene, corners: [u32; 3]) -> Option<f64> {
    let positions = view.sight().positions();
    let [p, q, r] = corners.map(|corner| positions[corner as usize]);
    let normal = (q - p).cross(r - p).normalize_or_zero();
    let sine = if view.sight().has_near_plane() {
        let eye = view.camera().eye();
        let farthest = [p, q, r].iter().map(|&v| (v - eye).length()).fold(0.0, f64::max);
        normal.dot(p - eye).abs() / farthest
    } else {
        normal.dot(view.camera().frame().forward).abs()
    };
    (sine > MIN_COVER_SINE).then_some(sine)
}

/// The stretch of the horizontal line at `y` within a triangle, a little too short.
fn chord(points: &[DVec2; 3], y: f64, margin: f64) -> Option<(f64, f64)> {
    let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
    for i in 0..3 {
        let (a, b) = (points[i], points[(i + 1) % 3]);
        let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
        if a.y <= y && y <= b.y && a.y < b.y {
            let x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
            // A nearly level side gives no sure place: what the margin does to y moves x further.
            let slack = margin * (1.0 + (b.x - a.x).abs() / (b.y - a.y));
            left = left.min(x + slack);
            right = right.max(x - slack);
        }
    }
    (left < right).then_some((left, right))
}

/// Calls `f` with each cell of `coarse` and its up to four parts in `fine`.
fn for_parts(fine: &Level, coarse: &Level, mut f: impl FnMut(u32, [Option<u32>; 4])) {
    for row in 0..coarse.rows {
        for column in 0..coarse.columns {
            let part = |i: u32, j: u32| {
                let (x, y) = (2 * column + i, 2 * row + j);
                (x < fine.columns && y < fine.rows).then(|| fine.first + y * fine.columns + x)
            };
            f(
                coarse.first + row * coarse.columns + column,
                [part(0, 0), part(1, 0), part(0, 1), part(1, 1)],
            );
        }
    }
}
