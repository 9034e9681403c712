//! A volcano with a crater and gullies down its slopes.

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
    let formula = Formula::parse(
        "exp(-(r/3.2)^1.5)*(1 + 0.07*sin(13*theta + 2*sin(r))*min(1, r/2)) - 0.75*exp(-(r/0.85)^2)",
        Variables::Plane,
    )?;
    let range = (-6.0, 6.0);
    // Sampled finely for smooth curves.
    let mut grid = Grid::sample(&formula, range, range, (301, 301))?;
    grid.scale_heights(4.2);
    let mut mesh = LinedMesh::default();
    mesh.push_grid(&grid, &net(5));
    lined_plot("Volcano", mesh, seen_from(-50.0, 32.0))
}

fn main() -> Result<()> {
    save("surface_volcano", &plot()?)
}
