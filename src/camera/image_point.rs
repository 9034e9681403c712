//! Points of the image before the division by the distance.

use glam::{DVec2, DVec3};

use super::{Camera, Frame, Projection};

/// A point in homogeneous image coordinates: the image is `(x / w, y / w)`.
///
/// `w` is the distance along the direction of view in perspective and 1 in orthographic
/// projection; `depth` is that distance in both. Rounded: for drawing and for spatial indexes,
/// never for decisions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImagePoint {
    /// To the right, times `w`.
    pub x: f64,
    /// Upwards, times `w`.
    pub y: f64,
    /// The divisor.
    pub w: f64,
    /// Distance from the eye (or its plane) along the direction of view, in model units.
    pub depth: f64,
}

impl ImagePoint {
    /// The image of the point at `d` from the eye.
    pub(crate) fn new(d: DVec3, camera: &Camera, frame: &Frame) -> Self {
        let depth = d.dot(frame.forward);
        let w = match camera.projection() {
            Projection::Perspective { .. } => depth,
            Projection::Orthographic => 1.0,
        };
        Self { x: d.dot(frame.right), y: d.dot(frame.upward), w, depth }
    }

    /// The image coordinates.
    pub fn image(self) -> DVec2 {
        DVec2::new(self.x / self.w, self.y / self.w)
    }

    /// The point a fraction `t` of the way, in space, to `other`.
    #[must_use]
    pub fn towards(self, other: Self, t: f64) -> Self {
        let mix = |a: f64, b: f64| a * (1.0 - t) + b * t;
        Self {
            x: mix(self.x, other.x),
            y: mix(self.y, other.y),
            w: mix(self.w, other.w),
            depth: mix(self.depth, other.depth),
        }
    }
}
