//! Boxes in the image, rounded outwards, and a quick test for what lies to one side of a segment.
//!
//! Nothing here decides visibility: in doubt, an item counts as near.

use super::segment::Segment;
use crate::camera::{ImageError, ImagePoint};
use crate::classify::ViewedScene;
use crate::predicates::{Kept, Sign};
use glam::{DVec2, DVec3};

/// A box in the image and the range of depths in it, rounded outwards.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    /// The lowest corner in the image.
    pub low: DVec2,
    /// The highest corner in the image.
    pub high: DVec2,
    /// The smallest depth.
    pub nearest: f64,
    /// The largest depth.
    pub farthest: f64,
}

impl Bounds {
    /// The same box with depths up to `farthest`.
    #[must_use]
    pub(super) fn reaching(self, farthest: f64) -> Self {
        Self { farthest, ..self }
    }

    /// The same box with all depths up to its farthest.
    #[must_use]
    pub(super) fn with_all_nearer(self) -> Self {
        Self { nearest: f64::NEG_INFINITY, ..self }
    }

    /// The lowest and the highest corner, with depths as third coordinates.
    pub(super) fn corners(&self) -> [DVec3; 2] {
        [self.low.extend(self.nearest), self.high.extend(self.farthest)]
    }

    /// Whether the boxes share a point of the image.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }
}

/// The largest single-precision number not above `x`.
pub(super) fn rounded_down(x: f64) -> f32 {
    let rounded = x as f32;
    if f64::from(rounded) > x { rounded.next_down() } else { rounded }
}

/// The smallest single-precision number not below `x`.
pub(super) fn rounded_up(x: f64) -> f32 {
    let rounded = x as f32;
    if f64::from(rounded) < x { rounded.next_up() } else { rounded }
}

/// Where an item goes in an index.
#[derive(Debug, Clone, Copy)]
pub(super) enum Place {
    /// It can be ignored.
    Nowhere,
    /// It is tested against every segment: see [`ImageIndex::everywhere`].
    Everywhere,
    /// Into the cells that its box touches.
    Within(Bounds),
    /// Into the cells that a triangle with this box and these corners touches.
    Triangle(Bounds, [DVec2; 3]),
}

/// The error bounds of a view.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rounding {
    error: ImageError,
}

impl Rounding {
    pub(super) fn new(view: &ViewedScene) -> Self {
        Self { error: view.image_error() }
    }

    /// How far a depth may be off.
    pub(super) fn depth_error(&self) -> f64 {
        self.error.of_depth()
    }

    /// Whether images are unbounded, as they are in perspective near the eye's plane.
    pub(super) fn is_unbounded(&self) -> bool {
        self.error.is_unbounded()
    }

    /// How far an image coordinate up to `size` in absolute value may be off.
    pub(super) fn image_error(&self, size: f64) -> f64 {
        self.error.of_coordinate(size)
    }

    /// The box of some points of the image with their depths.
    pub(super) fn bounds<const N: usize>(&self, points: [DVec2; N], depths: [f64; N]) -> Bounds {
        let low = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let error = self.image_error(low.abs().max(high.abs()).element_sum());
        Bounds {
            low: low - error,
            high: high + error,
            nearest: depths.iter().copied().fold(f64::INFINITY, f64::min) - self.depth_error(),
            farthest: depths.iter().copied().fold(f64::NEG_INFINITY, f64::max) + self.depth_error(),
        }
    }

    /// Where a triangle goes by its image: nowhere when it covers nothing, everywhere when the near
    /// plane cuts it.
    pub(super) fn place(&self, view: &ViewedScene, triangle: u32) -> Place {
        if view.triangle_turns()[triangle as usize] == Sign::Zero {
            return Place::Nowhere;
        }
        let corners = view.scene().triangles()[triangle as usize];
        match view.kept(triangle) {
            Kept::All => {}
            Kept::Part(_) => return Place::Everywhere,
            Kept::Nothing => return Place::Nowhere,
        }
        let points = corners.map(|corner| view.image()[corner as usize]);
        let image = points.map(ImagePoint::image);
        Place::Triangle(self.bounds(image, points.map(|p| p.depth)), image)
    }
}

/// A quick test that an item's image lies to one side of a segment's line.
///
/// A corner that is one of the segment's own ends lies on the line and does not count: an item
/// that meets the line there only covers no more than a point.
pub(super) struct Separation<'i> {
    rounding: &'i Rounding,
    ends: [u32; 2],
    start: DVec2,
    along: DVec2,
    size: f64,
}

impl<'i> Separation<'i> {
    pub(super) fn new(rounding: &'i Rounding, segment: &Segment) -> Self {
        let [a, b] = segment.image;
        let size = a.abs().max(b.abs()).element_sum();
        Self { rounding, ends: segment.ends, start: a, along: b - a, size }
    }

    /// Whether an item with these corners is certainly to one side.
    #[inline]
    pub(super) fn apart<const N: usize>(&self, corners: [u32; N], points: [ImagePoint; N]) -> bool {
        let points = points.map(ImagePoint::image);
        let offsets = points.map(|p| p - self.start);
        let farthest = points.iter().fold(DVec2::ZERO, |far, p| far.max(p.abs()));
        let error = self.rounding.image_error(farthest.element_sum().max(self.size));
        let reach = offsets.iter().fold(self.along.abs(), |reach, d| reach.max(d.abs()));
        // Each factor of the area is off by two errors at most.
        let slack = 8.0 * error * (reach.element_sum() + error);
        let (mut left, mut right) = (true, true);
        for (corner, offset) in corners.into_iter().zip(offsets) {
            if corner != self.ends[0] && corner != self.ends[1] {
                let side = self.along.perp_dot(offset);
                left &= side > slack;
                right &= side < -slack;
            }
        }
        (left || right) && N > 0
    }
}
