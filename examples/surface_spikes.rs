//! Spikes that stand in front of each other.

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
    let formula =
        Formula::parse("max(0, sin(x)*sin(y))^12 + max(0, -sin(x)*sin(y))^3/4", Variables::Plane)?;
    let range = (-9.42477796076938, 9.42477796076938);
    // Sampled finely for smooth curves.
    let mut grid = Grid::sample(&formula, range, range, (301, 301))?;
    grid.scale_heights(5.0);
    grid_plot("Spikes", &grid, 5, seen_from(-65.0, 22.0))
}

fn main() -> Result<()> {
    save("surface_spikes", &plot()?)
}
