//! The camera: the direction of view, and the map from world to image.
//!
//! ```text
//!            upward (image y)                 world: right-handed, z up
//!              ▲                              forward = target − eye
//!              │   ╱ forward                  right   = forward × up
//!              │  ╱                           upward  = right × forward
//!              │ ╱
//!         eye  ●──────► right (image x)       image: x to the right, y upward
//! ```
//!
//! With `d = P − eye` and the three directions normalized as `r`, `u`, `f`, the image of `P` is
//! `((d·r)/(d·f), (d·u)/(d·f))` in perspective and `(d·r, d·u)` in orthographic projection. The image is for
//! drawing only: visibility is decided on the points of the scene.

pub mod framing;

mod image_error;
mod image_point;
mod turntable;

use glam::{DVec2, DVec3};
use thiserror::Error;

pub use self::image_error::ImageError;
pub use self::image_point::ImagePoint;

/// The projection: perspective or parallel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// All lines of sight meet at the eye.
    Perspective {
        /// Vertical field of view of the page, in degrees; it does not affect visibility.
        fov_deg: f64,
        /// A point is kept when `(P − eye)·forward ≥ near · forward·forward`.
        near: f64,
    },
    /// All lines of sight are parallel to `forward`; there is no near plane.
    Orthographic,
}

/// The default distance of the near plane, as a fraction of the distance from eye to target.
pub const DEFAULT_NEAR: f64 = 1e-6;

/// The vertical field of view, in degrees, by default.
pub const DEFAULT_FOV_DEG: f64 = 30.0;

/// A point of view: finite, with `up` not parallel to the direction of view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    eye: DVec3,
    target: DVec3,
    up: DVec3,
    projection: Projection,
}

/// Why a camera is not valid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum CameraError {
    /// A number is infinite or not a number.
    #[error("camera values must be finite")]
    NotFinite,
    /// Eye and target coincide.
    #[error("eye and target are the same point")]
    NoDirection,
    /// The distance from the eye to the target is too large for a number.
    #[error("eye and target are too far apart for double precision")]
    TooFarApart,
    /// `up` is parallel to the direction of view.
    #[error("the up direction is parallel to the direction of view")]
    UpParallel,
    /// The field of view is not between 0 and 180 degrees.
    #[error("the field of view must be above 0 and below 180 degrees")]
    FieldOfView,
    /// The near plane is not in front of the eye.
    #[error("near must be above 0")]
    Near,
}

impl Camera {
    /// A camera at `eye` looking at `target`.
    ///
    /// # Errors
    /// See [`CameraError`].
    pub fn new(
        eye: DVec3,
        target: DVec3,
        up: DVec3,
        projection: Projection,
    ) -> Result<Self, CameraError> {
        let camera = Self { eye, target, up, projection };
        let forward = camera.forward();
        if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
            return Err(CameraError::NotFinite);
        }
        if !forward.is_finite() {
            return Err(CameraError::TooFarApart);
        }
        if forward == DVec3::ZERO {
            return Err(CameraError::NoDirection);
        }
        if let Projection::Perspective { fov_deg, near } = projection {
            if !(fov_deg > 0.0 && fov_deg < 180.0) {
                return Err(CameraError::FieldOfView);
            }
            if !(near > 0.0 && near.is_finite()) {
                return Err(CameraError::Near);
            }
        }
        let frame = camera.frame();
        if !(frame.right.is_finite() && frame.upward.is_finite())
            || frame.right == DVec3::ZERO
            || frame.upward == DVec3::ZERO
        {
            return Err(CameraError::UpParallel);
        }
        Ok(camera)
    }

    /// The position of the eye.
    pub fn eye(&self) -> DVec3 {
        self.eye
    }

    /// The point looked at.
    pub fn target(&self) -> DVec3 {
        self.target
    }

    /// The direction that is up on the page.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// Perspective or orthographic.
    pub fn projection(&self) -> Projection {
        self.projection
    }

    /// Distance of the near plane from the eye along the direction of view, in model units, rounded; none
    /// in orthographic projection.
    ///
    /// Whether a point is beyond the near plane is decided exactly by
    /// [`Sight::near_distance`](crate::predicates::Sight::near_distance).
    pub fn near_distance(&self) -> Option<f64> {
        match self.projection {
            Projection::Perspective { near, .. } => Some(near * self.forward().length()),
            Projection::Orthographic => None,
        }
    }

    /// `target − eye`, subtracted once per component; decisions take it as exact.
    pub fn forward(&self) -> DVec3 {
        self.target - self.eye
    }

    /// The three image directions, normalized.
    pub fn frame(&self) -> Frame {
        // Lengths are scaled to about one first, so that no product over- or underflows.
        let forward = scaled_to_one(self.forward());
        let up = scaled_to_one(self.up);
        let right = scaled_to_one(forward.cross(up));
        let upward = scaled_to_one(right.cross(forward));
        Frame {
            right: right.normalize_or_zero(),
            upward: upward.normalize_or_zero(),
            forward: forward.normalize_or_zero(),
        }
    }

    /// Whether it sees the upper side of a horizontal plane at `z`.
    pub fn is_above(&self, z: f64) -> bool {
        match self.projection {
            Projection::Perspective { .. } => self.eye.z > z,
            Projection::Orthographic => self.forward().z < 0.0,
        }
    }

    /// Image coordinates of a world point, y upward. Behind the eye they mean nothing.
    pub fn image(&self, point: DVec3) -> DVec2 {
        let frame = self.frame();
        let d = point - self.eye;
        let image = DVec2::new(d.dot(frame.right), d.dot(frame.upward));
        match self.projection {
            Projection::Perspective { .. } => image / d.dot(frame.forward),
            Projection::Orthographic => image,
        }
    }
}

/// The camera's directions, normalized and at right angles to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// To the right on the page.
    pub right: DVec3,
    /// Upwards on the page.
    pub upward: DVec3,
    /// Away from the observer.
    pub forward: DVec3,
}

fn scaled_to_one(v: DVec3) -> DVec3 {
    let size = v.abs().max_element();
    if size > 0.0 { v / size } else { DVec3::ZERO }
}
