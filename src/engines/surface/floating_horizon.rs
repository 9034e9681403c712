//! Floating horizon (Wright 1973): one family of grid lines, hidden by its own nearer lines.
//!
//! Lines are taken nearest first. A point of a line is visible when its height in the auxiliary
//! vertical plane (see [`super::max_min`]) is at least the highest, or at most the lowest, of all
//! nearer lines of the family at the same u. Nothing else hides: the surface between the lines counts as
//! transparent, so the picture of a rough surface differs from that of [`super::max_min`], and two
//! families drawn this way do not match.
//!
//! ```text
//!   v ▲   ╱╲      third line: seen above the upper and below the lower horizon
//!     │ ─╱┄┄╲──   second
//!     │ ╱    ╲    first
//!     └─────────► u
//! ```
//!
//! Differs from the textbook method in three points. The horizons are exact piecewise linear functions,
//! not arrays of pixels. A line is cut where it crosses a horizon, not judged by its ends. The domain is
//! split at the eye's x and y, so the eye may be above it. O(samples + crossings).
//!
//! Coherence: scan-line coherence, where a line of the family is the scan line (a horizon changes next to
//! its last change), and edge coherence (visibility changes only where a line crosses a horizon).

use std::sync::atomic::AtomicU8;

use rayon::prelude::*;

use super::HorizonError;
use super::cells::{First, GridPart};
use super::max_min::parts;
use super::pieces::{GridPieces, HIDDEN, UPPER};
use super::plan_predicates::PlanSight;
use super::segment::HorizonPlane;
use super::strip::HorizonStrip;
use crate::camera::{Camera, Projection};
use crate::surface::{Grid, Holes};

/// A family of grid lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Lines along x: y is constant.
    AlongX,
    /// Lines along y: x is constant.
    AlongY,
}

/// Finds the visible parts of one family of lines; the edges of the other count as hidden.
///
/// A line in the vertical plane of the eye has no nearer line at its u, so it is visible, and so is
/// everything in a vertical view.
///
/// # Errors
/// Holes.
pub fn solve(grid: &Grid, camera: &Camera, family: Family) -> Result<GridPieces, HorizonError> {
    if grid.holes() != Holes::None {
        return Err(HorizonError::Holes);
    }
    let (nx, ny) = (grid.xs().len(), grid.ys().len());
    let (n_x_edges, n_y_edges) = (ny * (nx - 1), nx * (ny - 1));
    let forward = camera.forward();
    let perspective = matches!(camera.projection(), Projection::Perspective { .. });
    if !perspective && forward.x == 0.0 && forward.y == 0.0 {
        let (x_seen, y_seen) =
            if family == Family::AlongX { (UPPER, HIDDEN) } else { (HIDDEN, UPPER) };
        let status = [vec![x_seen; n_x_edges], vec![y_seen; n_y_edges]].concat();
        return Ok(GridPieces::join(nx, ny, status, Vec::new()));
    }
    let status: Vec<AtomicU8> = (0..n_x_edges + n_y_edges).map(|_| AtomicU8::new(HIDDEN)).collect();
    let (low, high) = grid.bounds();
    let center = if perspective { camera.eye() } else { low + 0.5 * (high - low) };
    let size = (high - center).abs().max((low - center).abs());
    let done: Vec<_> = parts(grid, camera)
        .par_iter()
        .map(|part| {
            let sight = PlanSight::new(camera, part.sx, part.sy, center);
            let plane = HorizonPlane::new(grid, sight, size);
            let reach = 4.0 * plane.reach();
            let range = if perspective { (-1.0, 1.0) } else { (-reach, reach) };
            let mut strip = HorizonStrip::new(plane, range, (true, true), &status);
            match family {
                Family::AlongX => lines_along_x(part, grid, &mut strip),
                Family::AlongY => lines_along_y(part, grid, &mut strip),
            }
            (strip.work(), strip.found)
        })
        .collect();
    Ok(GridPieces::of_strips(nx, ny, status, done))
}

fn lines_along_x(part: &GridPart, grid: &Grid, strip: &mut HorizonStrip<Grid>) {
    for r in usize::from(part.first_row == First::Behind)..part.rows.len() {
        let radial = part.radial_rows || (r == 0 && is_radial(part.first_row));
        for c in 0..part.columns.len() - 1 {
            let edge = part.x_edge(grid, c, r);
            let (left, right) = (part.sample(grid, c, r), part.sample(grid, c + 1, r));
            // u grows away from the eye's x.
            draw(strip, (left, right), edge, radial, c == 0 && part.first_column == First::Behind);
        }
    }
}

fn lines_along_y(part: &GridPart, grid: &Grid, strip: &mut HorizonStrip<Grid>) {
    for c in usize::from(part.first_column == First::Behind)..part.columns.len() {
        let radial = part.radial_columns || (c == 0 && is_radial(part.first_column));
        for r in 0..part.rows.len() - 1 {
            let edge = part.y_edge(grid, c, r);
            let (left, right) = (part.sample(grid, c, r + 1), part.sample(grid, c, r));
            draw(strip, (left, right), edge, radial, r == 0 && part.first_row == First::Behind);
        }
    }
}

fn is_radial(first: First) -> bool {
    matches!(first, First::RadialOnBorder | First::RadialInside)
}

fn draw(
    strip: &mut HorizonStrip<Grid>,
    (left, right): (u32, u32),
    edge: u32,
    radial: bool,
    cut: bool,
) {
    if radial {
        strip.draw_whole(edge);
    } else if cut {
        strip.draw_clipped(left, right, edge);
    } else {
        let (left, right) = (strip.plane.vertex(left), strip.plane.vertex(right));
        if let Some(segment) = strip.segment(left, right) {
            strip.draw(&segment, edge);
        }
    }
}
