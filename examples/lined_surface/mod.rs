//! A surface by its lines, closed by its folds, on a sheet of the usual size.

use hiddenline::camera::framing::Framing;
use hiddenline::draw::DEFAULT_SHORTEST_STROKE_MM;
use hiddenline::engines::edge::Engine;
use hiddenline::engines::surface::meshed::{MeshedOptions, draw};
use hiddenline::page::{Page, PageOptions};
use hiddenline::plot::Plot;
use hiddenline::stats::Stats;
use hiddenline::strokes::Drawing;
use hiddenline::surface::{LatticeLines, LinedMesh};

use super::plots::{Result, plot_options};

/// Each `every`-th line of both families.
pub(crate) fn net(every: usize) -> LatticeLines {
    LatticeLines { along_rows: true, along_columns: true, every, triangles: false }
}

/// The page with nothing around the surface.
pub(crate) fn lined_plot(title: &str, mesh: LinedMesh, framing: Framing) -> Result<Plot> {
    let surface = mesh.into_scene()?;
    let camera = framing.camera(surface.scene.mesh().bounds().unwrap_or_default())?;
    let page = PageOptions::default();
    let mm_per_unit = |drawing: &Drawing| {
        Page::new(drawing, &camera, &page).map_or(1.0, |page| page.mm_per_image_unit())
    };
    let options = MeshedOptions {
        engine: Engine::Auto,
        folds: true,
        border: false,
        intersections: false,
        exact: false,
        underside: false,
        apart_by_kind: false,
        shortest_stroke_mm: DEFAULT_SHORTEST_STROKE_MM,
    };
    let drawing = draw(&surface, &camera, &options, mm_per_unit, &mut Stats::default());
    Ok(Page::new(&drawing, &camera, &page)?.plot(&drawing, plot_options(title)).plot)
}
