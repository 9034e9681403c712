//! Light on faces, and colors that distinguish faces or show an order.
//!
//! ```text
//!            light         tone = ambient + (1 − ambient) · max(0, n · l)
//!          ╲   ↑ n         n is turned to the viewer, so both sides of a sheet are lit
//!         l ╲  │
//!            ●─┴────
//! ```
//!
//! Lambert's law. The light is far away, like the sun, or a lamp at a point. It reaches whatever a camera in
//! its place sees: [`Light::camera`].

use glam::DVec3;
use thiserror::Error;

use crate::camera::{Camera, DEFAULT_FOV_DEG, Projection};

/// The default tone of faces turned away from the light.
pub const AMBIENT: f64 = 0.25;

/// The default light: to the left of the viewer, above, and behind, along right, up and forward.
const LEFT_SHOULDER: DVec3 = DVec3::new(-0.45, 0.65, -0.85);

/// The default color of faces: paper.
pub const DEFAULT_PAINT: [u8; 3] = [0xd8, 0xd4, 0xc8];

/// How light the farthest point is in a depth picture; the nearest is white.
pub const FARTHEST: f64 = 0.1;

/// Where the light comes from.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum LightSource {
    /// From over the viewer's left shoulder, from far away.
    #[default]
    Shoulder,
    /// From this direction of the world, from far away, like sunlight.
    From(DVec3),
    /// From this point of the world, like a lamp.
    At(DVec3),
}

/// Why a light cannot cast shadows.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum LightError {
    /// A lamp within the box around the scene would need to look all around.
    #[error("the light at {0} is inside the box around the model, which reaches from {1} to {2}")]
    Inside(DVec3, DVec3, DVec3),
    /// Its numbers are out of range.
    #[error("the light is too far away, or not at a finite place")]
    OutOfRange,
}

/// The light of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Light {
    /// The sun.
    Sun {
        /// Toward it, of any length, as given: shadows fall exactly along it.
        from: DVec3,
        /// The same, of length one.
        towards: DVec3,
    },
    /// The place of the lamp.
    Lamp(DVec3),
}

impl Light {
    /// The light for a view by `camera`. A zero direction means light over the shoulder.
    pub fn new(source: LightSource, camera: &Camera) -> Self {
        let frame = camera.frame();
        let DVec3 { x, y, z } = LEFT_SHOULDER;
        let shoulder = frame.right * x + frame.upward * y + frame.forward * z;
        let from = match source {
            LightSource::At(place) => return Self::Lamp(place),
            LightSource::From(direction) if direction != DVec3::ZERO => direction,
            _ => shoulder,
        };
        let towards = (from / from.abs().max_element()).normalize_or_zero();
        Self::Sun { from, towards }
    }

    /// The direction toward the light, of length one, from a point of the world.
    #[inline]
    pub fn towards(&self, from: DVec3) -> DVec3 {
        match self {
            Self::Sun { towards, .. } => *towards,
            Self::Lamp(place) => (place - from).normalize_or_zero(),
        }
    }

    /// Whether it shines from above on a horizontal plane at `z`.
    pub fn is_above(&self, z: f64) -> bool {
        match self {
            Self::Sun { from, .. } => from.z > 0.0,
            Self::Lamp(place) => place.z > z,
        }
    }

    /// How light a point of a face is, from 0 to 1, by its normal of length one on the side of the
    /// viewer.
    pub fn tone(&self, normal: DVec3, at: DVec3) -> f64 {
        AMBIENT + (1.0 - AMBIENT) * normal.dot(self.towards(at)).max(0.0)
    }

    /// A camera in the place of the light: the parts of a scene within `bounds` that it sees are lit. All of
    /// that box lies in front of it.
    ///
    /// # Errors
    /// See [`LightError`].
    pub fn camera(&self, (low, high): (DVec3, DVec3)) -> Result<Camera, LightError> {
        let (eye, target, projection) = match *self {
            Self::Sun { from, .. } => {
                // As far away as the scene is large; a power of two keeps the direction as it is.
                let size = low.abs().max(high.abs()).max_element();
                let ratio = size / from.abs().max_element();
                let scale = libm::exp2(libm::floor(libm::log2(ratio)));
                let scale = if scale > 0.0 && scale.is_finite() { scale } else { 1.0 };
                (from * scale, DVec3::ZERO, Projection::Orthographic)
            }
            Self::Lamp(place) => {
                let nearest = place.clamp(low, high);
                if nearest == place {
                    return Err(LightError::Inside(place, low, high));
                }
                // Nothing of the box is nearer than this point, whatever it is seen from.
                let near = NEAR_OF_LAMP;
                (place, nearest, Projection::Perspective { fov_deg: DEFAULT_FOV_DEG, near })
            }
        };
        let up = (target - eye).any_orthogonal_vector();
        Camera::new(eye, target, up, projection).map_err(|_| LightError::OutOfRange)
    }
}

/// The near plane of a lamp's camera, as a part of its distance from the scene.
const NEAR_OF_LAMP: f64 = 1e-6;

/// A color as parts from 0 to 1.
pub fn parts(color: [u8; 3]) -> DVec3 {
    DVec3::from(color.map(f64::from)) / 255.0
}

/// A color with parts from 0 to 1 as bytes.
pub fn to_bytes(color: DVec3) -> [u8; 3] {
    // The cast truncates and saturates.
    (color * 255.0 + 0.5).to_array().map(|part| part as u8)
}

/// A color for a number, such as that of a face; no two of the first 16 million have the same, and
/// none is black.
pub fn number_color(number: u32) -> DVec3 {
    /// Odd, so that multiples are all different modulo 2²⁴, and near the golden section, so that
    /// neighbors differ.
    const STEP: u32 = 0x9e_3779;
    let number = number.wrapping_add(1).wrapping_mul(STEP);
    let part = |shift: u32| f64::from(number >> shift & 0xff) / 255.0;
    DVec3::new(part(16), part(8), part(0))
}

/// The color of a position in an order, from 0 (first) to 1 (last): from blue through green to red.
pub fn order_color(place: f64) -> [u8; 3] {
    let of = |near: f64| (208.0 * (1.0 - (2.0 * place - near).abs()).clamp(0.0, 1.0)) as u8;
    [of(2.0), of(1.0), of(0.0)]
}
