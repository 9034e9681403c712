//! A volcano with a crater and gullies down its slopes.

mod grid_lines;
mod plots;
mod viewpoint;

use hiddenline::formula::{Formula, Variables};
use hiddenline::plot::Plot;
use hiddenline::surface::Grid;

use grid_lines::grid_plot;
use plots::{Result, save};
use viewpoint::seen_from;

pub(crate) fn plot() -> Result<Plot> {
    let formula = Formula::parse(
        "exp(-(r/3.2)^1.5)*(1 + 0.07*sin(13*theta + 2*sin(r))*min(1, r/2)) - 0.75*exp(-(r/0.85)^2)",
        Variables::Plane,
    )?;
    let range = (-6.0, 6.0);
    // Sampled finely for smooth curves.
    let mut grid = Grid::sample(&formula, range, range, (301, 301))?;
    grid.scale_heights(4.2);
    grid_plot("Volcano", &grid, 5, seen_from(-50.0, 32.0))
}

fn main() -> Result<()> {
    save("surface_volcano", &plot()?)
}
