//! Tone and color: the light, filled areas for print, and the shaded preview.

pub mod light;

pub mod normals;

pub mod fill;

pub mod white;

#[cfg(feature = "png")]
pub mod preview;
