//! Light on faces, and colors that distinguish faces or show an order.
//!
//! ```text
//!            light         tone = ambient + (1 − ambient) · max(0, n · l)
//!          ╲   ↑ n         n is turned to the viewer, so both sides of a sheet are lit
//!         l ╲  │
//!            ●─┴────
//! ```
//!
//! Lambert's law.

use glam::DVec3;

use crate::camera::Camera;

/// The tone of faces turned away from the light.
const AMBIENT: f64 = 0.25;

/// The default light: to the left of the viewer, above, and behind, along right, up and forward.
const LEFT_SHOULDER: DVec3 = DVec3::new(-0.45, 0.65, -0.85);

/// The color of faces, unless set otherwise: paper.
pub const DEFAULT_PAINT: [u8; 3] = [0xd8, 0xd4, 0xc8];

/// How light the farthest point is in a picture of depth; the nearest is white.
pub const FARTHEST: f64 = 0.1;

/// Light from one direction, as from the sun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Unit vector toward the light.
    towards: DVec3,
}

impl Light {
    /// Light from a direction in the world; `None`, or a zero vector, is light over the viewer's left
    /// shoulder.
    pub fn new(from: Option<DVec3>, camera: &Camera) -> Self {
        let frame = camera.frame();
        let DVec3 { x, y, z } = LEFT_SHOULDER;
        let shoulder = frame.right * x + frame.upward * y + frame.forward * z;
        let towards = from.and_then(DVec3::try_normalize);
        Self { towards: towards.unwrap_or_else(|| shoulder.normalize_or_zero()) }
    }

    /// How light a face is, from 0 to 1, by its normal of length one on the side of the viewer.
    pub fn tone(&self, normal: DVec3) -> f64 {
        AMBIENT + (1.0 - AMBIENT) * normal.dot(self.towards).max(0.0)
    }
}

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
