//! The extent of something in the image. A page is fitted to this box before any line is chosen.
//!
//! ```text
//!         y                           In perspective, points near the eye's own plane have images
//!         ▲   ┌╌╌╌╌╌╌╌╌╌┐             arbitrarily far out. So only what lies within 60° of the
//!         │   ╎ ╱╲___   ╎ high        direction of view counts, across and up; segments that leave
//!         │   ╎ ╲    ╲  ╎             that window are clipped there. When nothing lies within it,
//!     low └───┴──╲────╲─┴──► x        everything counts.
//! ```
//!
//! Segments are cut at the near plane by the same exact decision as everywhere else.

pub(crate) mod window;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use self::window::Window;
use crate::camera::{Camera, ImagePoint, Projection};
use crate::predicates::Sight;

/// In perspective, only what lies within this angle of the direction of view, across and up, is
/// fitted to a page. Otherwise a point beside the eye would shrink everything else to a dot.
pub const WIDEST_FITTED_ANGLE_DEG: f64 = 60.0;

/// A box in image coordinates, or nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Extent {
    corners: Option<(DVec2, DVec2)>,
}

impl Extent {
    /// Nothing.
    pub const EMPTY: Self = Self { corners: None };

    /// The extent of lists of segments between `points`, all finite, as `camera` sees them; each point
    /// belongs to a segment. O(points + segments), in parallel; usually the points alone decide.
    pub fn new(points: &[DVec3], segments: &[&[[u32; 2]]], camera: &Camera) -> Self {
        Self::of_points(points.par_iter().copied(), camera)
            .unwrap_or_else(|| Self::of_segments(points, segments, camera))
    }

    /// The extent of points alone. Points that are not finite do not count. `None` when a point may
    /// lie before the near plane or outside the window of the widest fitted angle: then it matters
    /// which segments there are. O(points), in parallel.
    pub fn of_points(
        points: impl IndexedParallelIterator<Item = DVec3>,
        camera: &Camera,
    ) -> Option<Self> {
        let (eye, frame) = (camera.eye(), camera.frame());
        let (nearest, widest) = match camera.near_distance() {
            // Twice as far as the near plane: rounding cannot move a point that is cut beyond that.
            Some(near) => (2.0 * near, widest()),
            None => (f64::NEG_INFINITY, DVec2::INFINITY),
        };
        let extents = points.with_min_len(1 << 12).filter(|p| p.is_finite()).map(|p| {
            let point = ImagePoint::new(p - eye, camera, &frame);
            let image = point.image();
            (point.depth > nearest && image.abs().cmple(widest).all()).then(|| Self::at(image))
        });
        extents.try_reduce(|| Self::EMPTY, |a, b| Some(a.union(b)))
    }

    /// The extent of segments, clipped one by one.
    fn of_segments(points: &[DVec3], segments: &[&[[u32; 2]]], camera: &Camera) -> Self {
        let sight = Sight::new(points, camera);
        let (eye, frame) = (camera.eye(), camera.frame());
        let kept = |&ends: &[u32; 2]| -> Option<[DVec2; 2]> {
            let [from, to] = sight.kept_of_segment(ends)?;
            let [a, b] = ends.map(|p| ImagePoint::new(points[p as usize] - eye, camera, &frame));
            Some([from.t, to.t].map(|t| a.towards(b, t).image()))
        };
        let all = |clip: &(dyn Fn([DVec2; 2]) -> Self + Sync)| {
            let segments = segments.par_iter().flat_map(|list| list.par_iter());
            let extents = segments.filter_map(kept).map(clip);
            extents.reduce(|| Self::EMPTY, Self::union)
        };
        let whole = |[a, b]: [DVec2; 2]| Self::at(a).union(Self::at(b));
        if camera.projection() == Projection::Orthographic {
            return all(&whole);
        }
        let within = all(&clipped);
        // Looking past everything: there is nothing to fit but what lies far out.
        if within == Self::EMPTY { all(&whole) } else { within }
    }

    /// The extent of polylines in the image.
    pub fn of_polylines<'a>(
        polylines: impl Iterator<Item = &'a [DVec2]> + Clone,
        camera: &Camera,
    ) -> Self {
        let whole = polylines.clone().flatten().map(|&p| Self::at(p));
        let whole = whole.fold(Self::EMPTY, Self::union);
        let Some((low, high)) = whole.corners else { return whole };
        let is_within = low.cmpge(-widest()).all() && high.cmple(widest()).all();
        if camera.projection() == Projection::Orthographic || is_within {
            return whole;
        }
        let segments = polylines.flat_map(|points| points.windows(2));
        let within = segments.map(|pair| clipped([pair[0], pair[1]]));
        let within = within.fold(Self::EMPTY, Self::union);
        if within == Self::EMPTY { whole } else { within }
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let corners = match (self.corners, other.corners) {
            (Some(a), Some(b)) => Some((a.0.min(b.0), a.1.max(b.1))),
            (one, None) | (None, one) => one,
        };
        Self { corners }
    }

    /// The lowest and the highest corner; `None` when nothing is in view.
    pub fn corners(&self) -> Option<(DVec2, DVec2)> {
        self.corners
    }

    fn at(point: DVec2) -> Self {
        Self { corners: point.is_finite().then_some((point, point)) }
    }
}

/// The widest part of the image that is fitted, to each side of the direction of view.
fn widest() -> DVec2 {
    DVec2::splat(libm::tan(WIDEST_FITTED_ANGLE_DEG.to_radians()))
}

/// The extent of the part of a segment that lies within the widest fitted angle.
fn clipped([a, b]: [DVec2; 2]) -> Extent {
    let window = Window { low: -widest(), high: widest(), slack: 0.0 };
    let Some((t0, t1)) = window.part_inside(a, b) else { return Extent::EMPTY };
    let at = |t: f64, whole: f64, end: DVec2| {
        let p = if t == whole { end } else { a + (b - a) * t };
        Extent::at(p.clamp(window.low, window.high))
    };
    at(t0, 0.0, a).union(at(t1, 1.0, b))
}
