//! A saddle: the plane curves up along y and down along x.

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
    let formula = Formula::parse("y^2 - x^2", Variables::Plane)?;
    let range = (-1.0, 1.0);
    // Sampled finely for smooth curves.
    let mut grid = Grid::sample(&formula, range, range, (161, 161))?;
    grid.scale_heights(0.45);
    let mut mesh = LinedMesh::default();
    mesh.push_grid(&grid, &net(8));
    lined_plot("Saddle", mesh, seen_from(-55.0, 24.0))
}

fn main() -> Result<()> {
    save("surface_saddle", &plot()?)
}
