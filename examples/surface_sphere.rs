//! A sphere by meridians and circles of latitude.

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
        let (longitude, latitude) = (u * std::f64::consts::TAU, (v - 0.5) * std::f64::consts::PI);
        let r = libm::cos(latitude);
        DVec3::new(r * libm::cos(longitude), r * libm::sin(longitude), libm::sin(latitude))
    };
    parametric_plot(
        "Sphere",
        [193, 97].map(|n| evenly(0.0, 1.0, n)),
        4,
        seen_from(-60.0, 25.0),
        point,
    )
}

fn main() -> Result<()> {
    save("surface_sphere", &plot()?)
}
