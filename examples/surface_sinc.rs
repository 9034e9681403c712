//! A hat: sin r / r.

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
    let formula = Formula::parse("sinc(r)", Variables::Plane)?;
    let range = (-12.0, 12.0);
    // Sampled finely for smooth curves.
    let mut grid = Grid::sample(&formula, range, range, (241, 241))?;
    grid.scale_heights(8.0);
    let mut mesh = LinedMesh::default();
    mesh.push_grid(&grid, &net(4));
    lined_plot("Sinc hat", mesh, seen_from(-60.0, 28.0))
}

fn main() -> Result<()> {
    save("surface_sinc", &plot()?)
}
