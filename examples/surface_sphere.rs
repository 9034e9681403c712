//! A sphere by meridians and circles of latitude.

use std::f64::consts::{PI, TAU};

use glam::dvec3;
use hiddenline::{Error, Paper, Sheet, Surface, SurfaceLines, View};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let globe = Surface::parametric_fn((0.0, 1.0), (0.0, 1.0), (193, 97), |u, v| {
        let (longitude, latitude) = (u * TAU, (v - 0.5) * PI);
        let r = libm::cos(latitude);
        dvec3(r * libm::cos(longitude), r * libm::sin(longitude), libm::sin(latitude))
    })?;
    let lines = SurfaceLines::default().every(4).silhouette().smoothness_mm(0.0).without_axes();
    globe.draw(&View::from_angles(-60.0, 25.0), &lines).title("Sphere").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_sphere.svg")?;
    sheet.save_png("plots/surface_sphere.png", 1000)
}
