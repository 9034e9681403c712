//! Triangles of a surface as the eye sees them in plan: they are tested against the horizons, and hide.
//!
//! ```text
//!          far ╱╲ far        What is beyond its far sides is behind a triangle. A near side is the far
//!             ╱  ╲           one of an earlier triangle, except on the border of the domain. A radial
//!            ╱____╲          side is in a vertical plane with the eye: it hides nothing.
//!             near
//!              ● the eye's foot
//! ```

use std::cmp::Ordering;

use glam::DVec3;

use super::plan_predicates::PlanSight;
use super::segment::{HorizonVertex, Samples};
use super::strip::HorizonStrip;
use crate::camera::Camera;
use crate::predicates::{Sign, orient2d};

/// Where the eye is relative to a side of a triangle, in plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Facing {
    /// Beyond it: the triangle is behind this side.
    Near,
    /// On the triangle's side of it.
    Far,
    /// On its line.
    Radial,
}

/// The signs that reflect the only part of an orthographic view.
pub(super) fn signs(camera: &Camera) -> (f64, f64) {
    let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
    (sign(camera.forward().x), sign(camera.forward().y))
}

/// Where the eye is relative to a side of a triangle to its left, in plan. Exact. In orthographic
/// projection the sight is that of the only part.
pub(super) fn facing(sight: &PlanSight, [a, b]: [DVec3; 2]) -> Facing {
    let left = if sight.forward.is_none() {
        orient2d(a.truncate(), b.truncate(), sight.center.truncate())
    } else {
        let order = Sign::from(sight.order(a, b));
        if sight.sx * sight.sy > 0.0 { order } else { order.flipped() }
    };
    match left {
        Sign::Positive => Facing::Far,
        Sign::Zero => Facing::Radial,
        Sign::Negative => Facing::Near,
    }
}

/// A side of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Side {
    /// The number of its edge; none if it only hides.
    pub(super) edge: Option<u32>,
    pub(super) facing: Facing,
    /// Whether it is on the border of the domain.
    pub(super) is_border: bool,
}

/// A triangle with its sides, from its first corner on. Triangles are to the left of their sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlanTriangle {
    pub(super) corners: [u32; 3],
    pub(super) sides: [Side; 3],
}

impl PlanTriangle {
    /// The ends of its sides.
    pub(super) fn ends(&self) -> [[u32; 2]; 3] {
        let [a, b, c] = self.corners;
        [[a, b], [b, c], [c, a]]
    }

    /// Tests what the triangle adds in a strip and lets it hide. The vertices are its corners; only those
    /// within the part have to be right.
    pub(super) fn visit<S: Samples>(
        &self,
        vertices: [HorizonVertex; 3],
        strip: &mut HorizonStrip<S>,
    ) {
        for (k, (ends, side)) in self.ends().into_iter().zip(self.sides).enumerate() {
            if let (Facing::Radial, Some(edge)) = (side.facing, side.edge) {
                radial(ends, edge, side.is_border, self.corners[(k + 2) % 3], strip);
            }
        }
        let is_outside = self.corners.map(|v| is_outside(strip, v));
        if is_outside == [false; 3] {
            let us = vertices.map(|vertex| vertex.u);
            let range = (us[0].min(us[1]).min(us[2]), us[0].max(us[1]).max(us[2]));
            if !strip.visit(vertices, range) {
                strip.leave();
                return;
            }
        }
        for wanted in [Facing::Near, Facing::Far] {
            for (k, side) in self.sides.into_iter().enumerate() {
                let is_first = side.facing == Facing::Far || side.is_border;
                if side.facing == wanted && is_first {
                    let next = (k + 1) % 3;
                    let is_inside = !is_outside[k] && !is_outside[next];
                    draw([vertices[k], vertices[next]], is_inside, side.edge, strip);
                }
            }
        }
        strip.leave();
    }
}

/// Whether a point lies beyond the borders of the part.
fn is_outside<S: Samples>(strip: &HorizonStrip<S>, vertex: u32) -> bool {
    strip.plane.sight.is_outside(strip.plane.point(vertex)) != (false, false)
}

fn draw<S: Samples>(
    [a, b]: [HorizonVertex; 2],
    is_inside: bool,
    edge: Option<u32>,
    strip: &mut HorizonStrip<S>,
) {
    let segment = if is_inside {
        match strip.plane.order(a, b) {
            Ordering::Less => strip.segment(a, b),
            Ordering::Equal => None,
            Ordering::Greater => strip.segment(b, a),
        }
    } else {
        strip.clipped(a.id, b.id)
    };
    match (segment, edge) {
        (Some(segment), Some(edge)) => strip.draw(&segment, edge),
        (Some(segment), None) => strip.hide(&segment),
        (None, _) => {}
    }
}

/// Tests an edge in the vertical plane of the eye, beside the triangle with the given apex. On
/// the border of the domain nothing is beside it on the outer side, so it is wholly visible.
fn radial<S: Samples>(
    [a, b]: [u32; 2],
    edge: u32,
    is_border: bool,
    apex: u32,
    strip: &mut HorizonStrip<S>,
) {
    if is_border {
        strip.draw_whole(edge);
        return;
    }
    let PlanSight { center, sx, sy, forward } = strip.plane.sight;
    let place = |v: u32| {
        let p = strip.plane.point(v);
        (p.x * sx, p.y * sy)
    };
    let (near, far) = if place(a) < place(b) { (a, b) } else { (b, a) };
    let foot = (center.x * sx, center.y * sy);
    let (from, to) = (place(near), place(far));
    let mut t_foot = None;
    if forward.is_none() {
        if to == foot || is_outside(strip, far) {
            return;
        }
        if is_outside(strip, near) {
            let along = |from: f64, to: f64, foot: f64| (foot - from) / (to - from);
            let is_steep = (to.1 - from.1).abs() > (to.0 - from.0).abs();
            t_foot = Some(if is_steep {
                along(from.1, to.1, foot.1)
            } else {
                along(from.0, to.0, foot.0)
            });
        }
    }
    let [near_at, far_at, apex_at] = [near, far, apex].map(|v| strip.plane.point(v).truncate());
    // u grows clockwise around the eye, the other way where one axis is reflected.
    let is_right = (orient2d(near_at, far_at, apex_at) == Sign::Negative) == (sx * sy > 0.0);
    strip.draw_radial((near, far), edge, is_right, t_foot);
}
