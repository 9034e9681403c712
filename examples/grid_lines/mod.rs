//! A surface over a grid on a sheet of the usual size.

use glam::DVec3;
use hiddenline::engines::surface::{Lines, Order, max_min, strokes};
use hiddenline::framing::Framing;
use hiddenline::page::{Page, PageOptions};
use hiddenline::plot::Plot;
use hiddenline::surface::Grid;

use super::plots::{Result, plot_options};

/// A surface over a grid, by each `every`-th line of both families, with nothing around it.
pub(crate) fn grid_plot(title: &str, grid: &Grid, every: usize, framing: Framing) -> Result<Plot> {
    let (xs, ys) = (grid.xs(), grid.ys());
    let (low, high) = grid.heights().unwrap_or_default();
    let corner = |i: usize, j: usize, z: f64| DVec3::new(xs[i], ys[j], z);
    let bounds = (corner(0, 0, low), corner(xs.len() - 1, ys.len() - 1, high));
    let camera = framing.camera(bounds)?;
    let pieces = max_min::solve(grid, &camera, Order::Rows)?;
    let drawing = strokes(grid, &pieces, &camera, &Lines { every, ..Lines::default() });
    Ok(Page::new(&drawing, &camera, &PageOptions::default())?
        .plot(&drawing, plot_options(title))
        .plot)
}
