//! Spikes that stand in front of each other.

mod lined_surface;
mod plots;
mod viewpoint;

use hiddenline::stages::plot::Plot;
use hiddenline::stages::surface::formula::{Formula, Variables};
use hiddenline::stages::surface::{Grid, LinedMesh};

use lined_surface::{lined_plot, net};
use plots::{Result, save};
use viewpoint::seen_from;

pub(crate) fn plot() -> Result<Plot> {
    let formula =
        Formula::parse("max(0, sin(x)*sin(y))^12 + max(0, -sin(x)*sin(y))^3/4", Variables::Plane)?;
    let range = (-9.42477796076938, 9.42477796076938);
    // Sampled finely for smooth curves.
    let mut grid = Grid::sample(&formula, range, range, (301, 301))?;
    grid.scale_heights(5.0);
    let mut mesh = LinedMesh::default();
    mesh.push_grid(&grid, &net(5));
    lined_plot("Spikes", mesh, seen_from(-65.0, 22.0))
}

fn main() -> Result<()> {
    save("surface_spikes", &plot()?)
}
