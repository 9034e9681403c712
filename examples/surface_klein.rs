//! A Klein bottle, the surface with one side, by the lines of its two parameters.

mod lined_surface;
mod parameter_lines;
mod plots;
mod viewpoint;

use glam::DVec3;
use hiddenline::stages::plot::Plot;
use hiddenline::stages::surface::evenly;
use hiddenline::stages::surface::formula::{Formula, Variables};

use parameter_lines::parametric_plot;
use plots::{Result, save};
use viewpoint::seen_from;

/// An eight turned by half while it goes around.
const KLEIN: [&str; 3] = [
    "(3 + cos(u/2)*sin(v) - sin(u/2)*sin(2*v))*cos(u)",
    "(3 + cos(u/2)*sin(v) - sin(u/2)*sin(2*v))*sin(u)",
    "sin(u/2)*sin(v) + cos(u/2)*sin(2*v)",
];

pub(crate) fn plot() -> Result<Plot> {
    let [x, y, z] = KLEIN.map(|text| Formula::parse(text, Variables::Parameters));
    let (x, y, z) = (x?, y?, z?);
    let point = |u: f64, v: f64| DVec3::new(x.value(u, v), y.value(u, v), z.value(u, v));
    let samples = [145, 73].map(|n| evenly(0.0, std::f64::consts::TAU, n));
    parametric_plot("A Klein bottle", samples, 2, seen_from(20.0, 40.0), point)
}

fn main() -> Result<()> {
    save("surface_klein", &plot()?)
}
