//! A surface in space on a sheet of the usual size.

use glam::DVec3;
use hiddenline::draw::DEFAULT_SHORTEST_STROKE_MM;
use hiddenline::engines::edge::Engine;
use hiddenline::engines::surface::meshed::{MeshedOptions, draw};
use hiddenline::framing::Framing;
use hiddenline::page::{Page, PageOptions};
use hiddenline::plot::Plot;
use hiddenline::stats::Stats;
use hiddenline::strokes::Drawing;
use hiddenline::surface::{LatticeLines, LinedMesh, close_seams};

use super::plots::{Result, plot_options};

/// A surface in space over all pairs of u and v, by each `every`-th line of
/// both parameters.
pub(crate) fn parametric_plot(
    title: &str,
    [us, vs]: [Vec<f64>; 2],
    every: usize,
    framing: Framing,
    point: impl Fn(f64, f64) -> DVec3,
) -> Result<Plot> {
    let mut points: Vec<DVec3> = vs
        .iter()
        .flat_map(|&v| us.iter().map(move |&u| (u, v)))
        .map(|(u, v)| point(u, v))
        .collect();
    close_seams(us.len(), &mut points);
    let mut mesh = LinedMesh::default();
    let lines = LatticeLines { along_rows: true, along_columns: true, every, triangles: false };
    mesh.push_lattice(us.len(), &points, &lines);
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
        exact: false,
        underside: false,
        apart_by_kind: false,
        shortest_stroke_mm: DEFAULT_SHORTEST_STROKE_MM,
    };
    let drawing = draw(&surface, &camera, &options, mm_per_unit, &mut Stats::default());
    Ok(Page::new(&drawing, &camera, &page)?.plot(&drawing, plot_options(title)).plot)
}
