//! How far rounded images may be from the truth.

/// Image coordinates are within this, times the square of their distance from the center plus one,
/// of the truth: they take about a dozen roundings of numbers that large.
const COORDINATE_ERROR: f64 = 32.0 * f64::EPSILON;

/// Depths are within this part of the largest number that goes into them.
const DEPTH_ERROR: f64 = 32.0 * f64::EPSILON;

/// Bounds of the errors of the images of some points; see [`ImagePoint`](super::ImagePoint).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImageError {
    /// In orthographic projection the error does not depend on the place.
    flat: Option<f64>,
    depth: f64,
}

impl ImageError {
    /// The bounds for points with numbers up to `size`, distances from the eye and from the origin added
    /// up.
    pub fn new(is_perspective: bool, size: f64) -> Self {
        Self {
            flat: (!is_perspective).then_some(COORDINATE_ERROR * size),
            depth: DEPTH_ERROR * size,
        }
    }

    /// How far an image coordinate up to `size` in absolute value may be off.
    #[inline]
    pub fn of_coordinate(&self, size: f64) -> f64 {
        self.flat.unwrap_or(COORDINATE_ERROR * (1.0 + size) * (1.0 + size))
    }

    /// How far a depth may be off.
    pub fn of_depth(&self) -> f64 {
        self.depth
    }

    /// Whether images are unbounded, as they are in perspective near the eye's plane.
    pub fn is_unbounded(&self) -> bool {
        self.flat.is_none()
    }
}
