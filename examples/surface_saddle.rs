//! A saddle: the plane curves up along y and down along x.

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
    let formula = Formula::parse("y^2 - x^2", Variables::Plane)?;
    let range = (-1.0, 1.0);
    // Sampled finely for smooth curves.
    let mut grid = Grid::sample(&formula, range, range, (161, 161))?;
    grid.scale_heights(0.45);
    grid_plot("Saddle", &grid, 8, seen_from(-55.0, 24.0))
}

fn main() -> Result<()> {
    save("surface_saddle", &plot()?)
}
