//! Which engine draws a surface.

use clap::ValueEnum;
use hiddenline::stages::camera::Camera;
use hiddenline::stages::engines::surface::max_min;
use hiddenline::stages::surface::{Grid, Holes};

use super::Job;
use super::sheets::Surface;

/// The engines by name.
#[derive(Clone, Copy, PartialEq, ValueEnum)]
pub(super) enum EngineName {
    Auto,
    MaxMin,
    FloatingHorizon,
    Roberts,
    Appel,
}

/// The grid, if it is all there is and an engine for grids is to draw it.
///
/// Fails when that engine was asked for but cannot draw what the near plane leaves of it.
pub(super) fn only_grid<'a>(
    surface: &'a Surface,
    job: &Job,
    camera: &Camera,
) -> Result<Option<&'a Grid>, String> {
    let Some(grid) = candidate(surface, job) else {
        return Ok(None);
    };
    if max_min::is_clear_of_near_plane(grid, camera) {
        return Ok(Some(grid));
    }
    match job.engine {
        EngineName::Auto => Ok(None),
        _ => Err("the near plane cuts the surface: give --engine auto".into()),
    }
}

fn candidate<'a>(surface: &'a Surface, job: &Job) -> Option<&'a Grid> {
    let has_grid_lines = job.lines.along_x || job.lines.along_y;
    let needs_mesh = job.levels.is_some()
        || job.folds
        || job.border
        || job.intersections
        || job.all_edges
        || !has_grid_lines;
    match (surface, job.engine) {
        (_, EngineName::Roberts | EngineName::Appel) => None,
        (Surface::Grids(grids), EngineName::Auto | EngineName::MaxMin) => {
            let grid = grids.first().filter(|_| grids.len() == 1 && !needs_mesh)?;
            (grid.holes() == Holes::None).then_some(grid)
        }
        (Surface::Grids(grids), EngineName::FloatingHorizon) => grids.first(),
        _ => None,
    }
}
