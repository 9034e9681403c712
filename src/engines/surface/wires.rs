//! Lines behind a surface, hidden by the final horizons.
//!
//! ```text
//!     ┊  ╱╲  ┊ wire      All of the surface between the horizons at some u is covered. What lies on the
//!   ──┊─╱  ╲─┊──         back of the box around it is behind all of it, so that it is visible exactly
//!     ┊╱    ╲┊           beyond the final horizons. On the base, seen from above, cells farther than a
//!                        point are above its line of sight: if none hides it, it is below all.
//! ```
//!
//! Wires hide nothing: each is compared with the horizons as they are after the last cell. A wire within
//! a level part of the surface counts as behind it.

use std::cmp::Ordering;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

use glam::DVec3;

use super::horizon::Horizon;
use super::ordered_grid::OrderedGrid;
use super::pieces::HIDDEN;
use super::plan_predicates::PlanSight;
use super::segment::{HorizonPlane, Samples};
use super::strip::HorizonStrip;
use crate::surface::Grid;

/// The vertices of a grid, and then the ends of wires, two for each.
struct WithWires<'a> {
    grid: &'a OrderedGrid<'a>,
    n_vertices: u32,
    wires: &'a [[DVec3; 2]],
}

impl Samples for WithWires<'_> {
    fn point(&self, sample: u32) -> DVec3 {
        match sample.checked_sub(self.n_vertices) {
            None => self.grid.point(sample),
            Some(end) => self.wires[end as usize / 2][end as usize % 2],
        }
    }
}

/// A visible part of a wire, from 0 at its first end to 1 at the other.
pub(super) type WirePart = (u32, [f64; 2]);

/// The parts of wires that are visible in a strip of a part of the domain, after its last cell.
/// `size` bounds |x|, |y| and |z| of samples and wires minus the sight's center.
pub(super) fn visible_in_strip(
    (grid, wires): (&OrderedGrid, &[[DVec3; 2]]),
    sight: PlanSight,
    size: DVec3,
    range: (f64, f64),
    horizons: &[Option<Horizon>; 2],
) -> Vec<WirePart> {
    let n_vertices = grid.n_vertices() as u32;
    let samples = WithWires { grid, n_vertices, wires };
    let mut parts = Vec::new();
    for wire in 0..wires.len() as u32 {
        let [a, b] = [0, 1].map(|end| n_vertices + 2 * wire + end);
        let status = [AtomicU8::new(HIDDEN)];
        let plane = HorizonPlane::new(&samples, sight, size);
        let order = sight.order(plane.point(a), plane.point(b));
        if is_beside(grid.grid(), &sight, wires[wire as usize]) {
            parts.push((wire, [0.0, 1.0]));
            continue;
        }
        if order == Ordering::Equal {
            let mut strip = HorizonStrip::with_horizons(plane, range, horizons.clone(), &status);
            parts.extend(strip.beyond_at(a, b).into_iter().map(|part| (wire, part)));
            continue;
        }
        let mut strip = HorizonStrip::with_horizons(plane, range, [None, None], &status);
        let segment = if sight.forward.is_none() {
            strip.clipped(a, b)
        } else {
            let (left, right) = if order == Ordering::Less { (a, b) } else { (b, a) };
            let [left, right] = [left, right].map(|id| strip.plane.vertex(id));
            strip.segment(left, right)
        };
        let Some(segment) = segment else { continue };
        strip.set_horizons(horizons.clone());
        strip.draw(&segment, 0);
        if status[0].load(Relaxed) == HIDDEN {
            parts.extend(strip.found.iter().map(|piece| (wire, [piece.t0, piece.t1])));
        } else {
            parts.push((wire, [0.0, 1.0]));
        }
    }
    parts
}

/// Whether a wire and the eye are in one plane with a side of the domain: nothing is on its other side.
fn is_beside(grid: &Grid, sight: &PlanSight, [a, b]: [DVec3; 2]) -> bool {
    let is_at = |k: usize, side: f64| [a[k], b[k], sight.center[k]] == [side; 3];
    let sides = [(0, grid.xs()), (1, grid.ys())];
    let is_at_end = |(k, at): &(usize, &[f64])| is_at(*k, at[0]) || is_at(*k, at[at.len() - 1]);
    sight.forward.is_none() && sides.iter().any(is_at_end)
}

/// The parts of each of `n` wires in order, joined where they meet.
pub(super) fn joined(n: usize, mut parts: Vec<WirePart>) -> Vec<Vec<[f64; 2]>> {
    parts.sort_by(|a, b| a.0.cmp(&b.0).then(a.1[0].total_cmp(&b.1[0])));
    let mut joined: Vec<Vec<[f64; 2]>> = vec![Vec::new(); n];
    for (wire, [from, to]) in parts {
        let of_wire = &mut joined[wire as usize];
        match of_wire.last_mut() {
            Some(last) if from <= last[1] => last[1] = last[1].max(to),
            _ => of_wire.push([from, to]),
        }
    }
    joined
}
