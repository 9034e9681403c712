//! A torus by its circles; the lines at its folds close it.

mod lined_surface;
mod parameter_lines;
mod plots;
mod viewpoint;

use glam::DVec3;
use hiddenline::stages::plot::Plot;
use hiddenline::stages::surface::evenly;

use parameter_lines::parametric_plot;
use plots::{Result, save};
use viewpoint::seen_from;

pub(crate) fn plot() -> Result<Plot> {
    let point = |u: f64, v: f64| {
        let (around, across) = (u * std::f64::consts::TAU, v * std::f64::consts::TAU);
        let r = 3.0 + 1.2 * libm::cos(across);
        DVec3::new(r * libm::cos(around), r * libm::sin(around), 1.2 * libm::sin(across))
    };
    parametric_plot(
        "Torus",
        [217, 97].map(|n| evenly(0.0, 1.0, n)),
        3,
        seen_from(-60.0, 35.0),
        point,
    )
}

fn main() -> Result<()> {
    save("surface_torus", &plot()?)
}
