//! A hill and a hollow over a square, by grid lines, with axes.

mod plots;

use glam::dvec3;

use hiddenline::stages::axes::{Titles, axes};
use hiddenline::stages::camera::framing::View;
use hiddenline::stages::chain::grid_lines::{Lines, strokes};
use hiddenline::stages::engines::surface::{CellOrder, max_min};
use hiddenline::stages::page::{Page, PageOptions};
use hiddenline::stages::plot::Plot;
use hiddenline::stages::surface::formula::{Formula, Variables};
use hiddenline::stages::surface::{Grid, lattice_extent};

use plots::{Result, plot_options, save};

const PEAKS: &str =
    "3*(1-x)^2*exp(-x^2-(y+1)^2) - 10*(x/5-x^3-y^5)*exp(-x^2-y^2) - exp(-(x+1)^2-y^2)/3";

/// Heights are drawn at this scale.
const Z_FACTOR: f64 = 0.22;

pub(crate) fn plot() -> Result<Plot> {
    let formula = Formula::parse(PEAKS, Variables::Plane)?;
    // Sampled finely for smooth curves, of which every fifth is drawn.
    let mut grid = Grid::sample(&formula, (-3.0, 3.0), (-3.0, 3.0), (241, 241))?;
    grid.scale_heights(Z_FACTOR);
    let (low, high) = grid.heights().unwrap_or_default();
    let bounds = (dvec3(-3.0, -3.0, low), dvec3(3.0, 3.0, high));
    let camera = View::default().camera(bounds)?;
    let pieces = max_min::solve(&grid, &camera, CellOrder::Rows)?;
    let mut drawing = strokes(&grid, &pieces, &camera, &Lines { every: 5, ..Lines::default() });
    let titles = Titles { drawing: "Peaks".into(), ..Titles::default() };
    let extent = lattice_extent(241, 241 * 241, |k| grid.point(k as u32), &camera);
    drawing.append(&axes(&extent, bounds, Z_FACTOR, &camera, &titles));
    let page = Page::place(&drawing.extent(&camera), &camera, &PageOptions::default())?;
    Ok(page.plot(&drawing, plot_options("Peaks")).plot)
}

fn main() -> Result<()> {
    save("surface_peaks", &plot()?)
}
