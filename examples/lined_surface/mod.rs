//! A surface by its lines, closed by its folds, on a sheet of the usual size.

use hiddenline::stages::camera::framing::View;
use hiddenline::stages::draw::DEFAULT_SHORTEST_STROKE_MM;
use hiddenline::stages::draw::meshed::{MeshedOptions, draw};
use hiddenline::stages::engines::edge::LineEngine;
use hiddenline::stages::page::{Page, PageOptions};
use hiddenline::stages::plot::Plot;
use hiddenline::stages::surface::{LatticeLines, LinedMesh};

use super::plots::{Result, plot_options};

/// Each `every`-th line of both families.
pub(crate) fn net(every: usize) -> LatticeLines {
    LatticeLines { along_rows: true, along_columns: true, every, triangles: false }
}

/// The page with nothing around the surface.
pub(crate) fn lined_plot(title: &str, mesh: LinedMesh, framing: View) -> Result<Plot> {
    let surface = mesh.into_scene()?;
    let camera = framing.camera(surface.scene.mesh().bounds().unwrap_or_default())?;
    let extent = surface.scene.extent(&camera);
    let page = Page::place(&extent, &camera, &PageOptions::default())?;
    let options = MeshedOptions {
        engine: LineEngine::Auto,
        folds: true,
        border: false,
        intersections: false,
        exact: false,
        underside: false,
        apart_by_kind: false,
        shortest_stroke_mm: DEFAULT_SHORTEST_STROKE_MM,
    };
    let drawing = draw(&surface, &camera, &options, page.mm_per_image_unit()).drawing;
    Ok(page.plot(&drawing, plot_options(title)).plot)
}
