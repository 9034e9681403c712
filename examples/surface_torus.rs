//! A torus by its circles; the lines at its folds close it.

use std::f64::consts::TAU;

use glam::dvec3;
use hiddenline::{Error, Paper, Sheet, Surface, SurfaceLines, View};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let torus = Surface::parametric_fn((0.0, 1.0), (0.0, 1.0), (217, 97), |u, v| {
        let (around, across) = (u * TAU, v * TAU);
        let r = 3.0 + 1.2 * libm::cos(across);
        dvec3(r * libm::cos(around), r * libm::sin(around), 1.2 * libm::sin(across))
    })?;
    let lines = SurfaceLines::default().every(3).silhouette().smoothness_mm(0.0).without_axes();
    torus.draw(&View::from_angles(-60.0, 35.0), &lines).title("Torus").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_torus.svg")?;
    sheet.save_png("plots/surface_torus.png", 1000)
}
