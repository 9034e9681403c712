//! Views around the vertical axis, as of a model on a turntable.

use glam::DVec3;

use super::framing::sin_cos_deg;
use super::{Camera, CameraError};

impl Camera {
    /// The camera rotated by an angle in degrees around the vertical through its target, counter-
    /// clockwise seen from above. Exact for quarter turns.
    ///
    /// # Errors
    /// The rotated camera is not valid: its numbers overflow, or up and forward round to one direction.
    pub fn turned(&self, angle_deg: f64) -> Result<Self, CameraError> {
        let (sin, cos) = sin_cos_deg(angle_deg);
        let turn = |v: DVec3| DVec3::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y, v.z);
        let eye = self.target + turn(self.eye - self.target);
        Self::new(eye, self.target, turn(self.up), self.projection)
    }

    /// `n` cameras at equal angles on one turn around the target, starting with this one.
    ///
    /// # Errors
    /// As for [`turned`](Self::turned).
    pub fn turntable(&self, n: u32) -> Result<Vec<Self>, CameraError> {
        (0..n).map(|k| self.turned(360.0 * f64::from(k) / f64::from(n))).collect()
    }
}
