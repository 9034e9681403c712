//! Surfaces that are one grid: when they are drawn as such, and how.

use glam::DVec3;

use super::error::SurfaceError;
use super::options::{SurfaceEngine, SurfaceLines};
use crate::axes::Wire;
use crate::camera::Camera;
use crate::chain::grid_lines::{GridLines, strokes};
use crate::drafting::Drafted;
use crate::draw::{DrawOutput, MeshSize};
use crate::engines::edge::LineCounts;
use crate::engines::surface::floating_horizon::Family;
use crate::engines::surface::max_min::OrderedGrid;
use crate::engines::surface::{SurfaceSide, floating_horizon, max_min};
use crate::surface::{Grid, Holes, Places, SampledSurface};
use crate::timing::{Seconds, timed};

/// The grid, if it is all there is and an engine for grids is to draw it.
///
/// # Errors
/// That engine was requested by name but cannot draw what the near plane leaves of the grid.
pub(super) fn grid_to_draw<'a>(
    surface: &'a SampledSurface,
    lines: &SurfaceLines,
    camera: &Camera,
) -> Result<Option<&'a Grid>, SurfaceError> {
    // A border along which both families have lines has no ink of its own.
    let needs_mesh = lines.levels.is_some()
        || lines.intersections
        || lines.mesh
        || lines.silhouette && (lines.exact || !surface.has_fold_functions())
        || lines.border && !(lines.along_x && lines.along_y)
        || !lines.has_grid_lines();
    let grid = match (surface.grids(), lines.engine) {
        ([grid], SurfaceEngine::Auto | SurfaceEngine::MaxMin) => {
            (!needs_mesh && grid.holes() == Holes::None).then_some(grid)
        }
        (grids, SurfaceEngine::FloatingHorizon) => {
            if needs_mesh || lines.has_mesh_lines() || lines.along_x == lines.along_y {
                return Err(SurfaceError::OneFamily);
            }
            let [grid] = grids else { return Err(SurfaceError::OneGrid) };
            Some(grid)
        }
        _ => None,
    };
    let Some(grid) = grid else { return Ok(None) };
    if max_min::is_clear_of_near_plane(grid, camera) {
        return Ok(Some(grid));
    }
    match lines.engine {
        SurfaceEngine::Auto => Ok(None),
        _ => Err(SurfaceError::NearPlane),
    }
}

/// What an engine for grids draws.
pub(super) struct DrawnGrid {
    pub(super) drawn: DrawOutput,
    pub(super) size: MeshSize,
    /// The visible parts of each wire, from 0 at its first end to 1 at the other, if the engine finds
    /// them.
    pub(super) wires: Option<Vec<Vec<[f64; 2]>>>,
}

/// Draws grid lines of `grid`, and the lines that its cells are cut along; `places` says which of its lines
/// count, if not all do.
///
/// # Errors
/// The engine cannot draw the grid.
pub(super) fn draw_grid(
    ordered: &OrderedGrid,
    places: Option<&Places>,
    camera: &Camera,
    options: &SurfaceLines,
    wires: &[Wire],
    mm_per_image_unit: f64,
) -> Result<DrawnGrid, SurfaceError> {
    let cut = ordered.cut();
    let grid = cut.grid;
    let mut seconds = Seconds::default();
    let wires: Vec<[DVec3; 2]> = wires.iter().map(|wire| wire.ends).collect();
    let (engine, (pieces, parts)) =
        timed(&mut seconds.visibility, || -> Result<_, SurfaceError> {
            Ok(match options.engine {
                SurfaceEngine::FloatingHorizon => {
                    let family = if options.along_x { Family::AlongX } else { Family::AlongY };
                    ("floating-horizon", (floating_horizon::solve(grid, camera, family)?, None))
                }
                _ => {
                    let order = options.order.unwrap_or_default();
                    let (pieces, parts) = max_min::solve_cut(ordered, camera, order, &wires)?;
                    (max_min::NAME, (pieces, Some(parts)))
                }
            })
        })?;
    let drawing = timed(&mut seconds.strokes, || {
        let SurfaceLines { along_x, along_y, every, exact: separate, .. } = *options;
        let shortest = options.shortest_stroke_mm / mm_per_image_unit;
        let lines = GridLines { along_x, along_y, every, places, side: None, separate, shortest };
        if !options.underside {
            return strokes(&cut, &pieces, camera, &lines);
        }
        let of = |side| strokes(&cut, &pieces, camera, &GridLines { side: Some(side), ..lines });
        let mut drawing = of(SurfaceSide::Upper);
        drawing.append_undersides(&of(SurfaceSide::Lower));
        drawing
    });
    let cells = (grid.xs().len() - 1) * (grid.ys().len() - 1);
    let size = MeshSize {
        vertices: grid.zs().len(),
        faces: 2 * cells,
        triangles: 2 * cells,
        edges: pieces.n_edges() + cells,
        ..MeshSize::default()
    };
    let drawn = DrawOutput {
        drawing,
        engine,
        n_lines: pieces.n_edges(),
        counts: LineCounts { candidate_pairs: pieces.work().comparisons, ..LineCounts::default() },
        n_exact: pieces.work().exact,
        drafted: Drafted::default(),
        seconds,
    };
    Ok(DrawnGrid { drawn, size, wires: parts })
}
