//! How far a curve is from its chord on paper, from how far it is in space.
//!
//! ```text
//!        ╭─ P + δ ─╮      A point of the curve is a point P of the chord moved by at most δ along each
//!      A ──── P ──── B    axis. Q, the image of P, lies on the segment between those of A and B, and
//!                         I(P + δe) − I(P) = δ·g(Q)/W(P + δe) with g(Q) = (r·e, u·e) − Q·(F·e).
//! ```
//!
//! |g| is convex along the segment, so it is greatest at an end; W, the depth, is linear. The result is
//! thus a bound on the distance from the segment itself.

use glam::{DVec2, DVec3};

use crate::camera::{Camera, Frame, Projection};
use crate::surface::formula::{Class, Jet};

/// A camera and the scale of the page.
#[derive(Debug, Clone)]
pub(super) struct PaperBound {
    eye: DVec3,
    frame: Frame,
    /// Distance of the near plane; none in orthographic projection.
    near: Option<f64>,
    mm_per_unit: f64,
}

/// A point as far as bounds depend on it.
#[derive(Debug, Clone, Copy)]
pub(super) struct SeenPoint {
    /// Its depth; 1 in orthographic projection.
    w: f64,
    /// How fast its image moves with it along x, y and z, times its depth.
    g: DVec3,
}

impl PaperBound {
    pub(super) fn new(camera: &Camera, mm_per_unit: f64) -> Self {
        let is_perspective = matches!(camera.projection(), Projection::Perspective { .. });
        let near = if is_perspective { camera.near_distance() } else { None };
        Self { eye: camera.eye(), frame: camera.frame(), near, mm_per_unit }
    }

    /// A point as it is seen; none for a hole and for what the near plane cuts off.
    pub(super) fn see(&self, p: DVec3) -> Option<SeenPoint> {
        if !p.is_finite() {
            return None;
        }
        let Frame { right, upward, forward } = self.frame;
        let across = |axis: usize, q: DVec2| {
            (DVec2::new(right[axis], upward[axis]) - q * forward[axis]).length()
        };
        let (w, q) = match self.near {
            None => (1.0, None),
            Some(near) => {
                let d = p - self.eye;
                let w = d.dot(forward);
                if w <= near {
                    return None;
                }
                (w, Some(DVec2::new(d.dot(right), d.dot(upward)) / w))
            }
        };
        let g = match q {
            Some(q) => DVec3::new(across(0, q), across(1, q), across(2, q)),
            None => {
                let size = |axis: usize| DVec2::new(right[axis], upward[axis]).length();
                DVec3::new(size(0), size(1), size(2))
            }
        };
        Some(SeenPoint { w, g })
    }

    /// A height, in model units, that is nowhere in a box longer than `length_mm` on paper.
    pub(super) fn height_of(&self, length_mm: f64, (low, high): (DVec3, DVec3)) -> f64 {
        let corner = |k: usize| {
            let of = |axis: usize| if k >> axis & 1 == 0 { low[axis] } else { high[axis] };
            self.see(DVec3::new(of(0), of(1), of(2)))
        };
        let largest = (0..8)
            .filter_map(corner)
            .map(|seen| self.mm_per_unit * seen.g.z / seen.w)
            .fold(0.0, f64::max);
        if largest > 0.0 { (length_mm / largest).min(high.z - low.z) } else { 0.0 }
    }

    /// The greatest distance on paper, in millimeters, of a curve from its chord that is within `off` of
    /// it along each axis. Infinite if it may pass the near plane.
    pub(super) fn on_paper(&self, ends: &[SeenPoint], off: DVec3) -> f64 {
        let g = ends.iter().fold(DVec3::ZERO, |g, end| g.max(end.g));
        let w = ends.iter().fold(f64::INFINITY, |w, end| w.min(end.w));
        // What cannot be seen from here may be infinite.
        let times = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let moved: f64 = (0..3).map(|axis| times(off[axis], g[axis])).sum();
        let nearer: f64 = match self.near {
            Some(_) => (0..3).map(|axis| times(off[axis], self.frame.forward[axis].abs())).sum(),
            None => 0.0,
        };
        let depth = w - nearer;
        if depth > self.near.unwrap_or(0.0) {
            self.mm_per_unit * moved / depth
        } else {
            f64::INFINITY
        }
    }
}

/// How far a function with this jet is from its chord over a step `h`, with the values `from` and `to` at
/// its ends.
pub(super) fn off_chord(jet: &Jet, h: f64, from: f64, to: f64) -> f64 {
    let mut off = f64::INFINITY;
    if jet.class >= Class::Continuous {
        let (low, high) = (from.min(to), from.max(to));
        off = (jet.value.high - low).max(high - jet.value.low);
    }
    if jet.class >= Class::Lipschitz {
        let (least, most) = (jet.first.low, jet.first.high);
        let slope = ((to - from) / h).clamp(least, most);
        let spread = most - least;
        off =
            off.min(if spread > 0.0 { h * (most - slope) * (slope - least) / spread } else { 0.0 });
    }
    off = off.min(off_bent(jet, h));
    // Rounding here is far below what matters on paper, and covered by this.
    if off.is_nan() { f64::INFINITY } else { off * (1.0 + 1e-12) }
}

/// The same by the second derivative alone.
pub(super) fn off_bent(jet: &Jet, h: f64) -> f64 {
    if jet.class == Class::Smooth { h * h / 8.0 * jet.second.largest() } else { f64::INFINITY }
}
