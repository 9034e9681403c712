//! A Klein bottle, the surface with one side, by the lines of its two parameters.

mod sheet;

use glam::DVec3;

use hiddenline::draw::{DEFAULT_SHORTEST_STROKE_MM, HiddenLines};
use hiddenline::engines::edge::Engine;
use hiddenline::engines::surface::meshed::{MeshedOptions, draw};
use hiddenline::formula::{Formula, Variables};
use hiddenline::framing::{Framing, Standpoint};
use hiddenline::page::{Dash, Page, PageOptions, PlotOptions};
use hiddenline::plot::Plot;
use hiddenline::stats::Stats;
use hiddenline::strokes::Drawing;
use hiddenline::surface::{LatticeLines, LinedMesh, close_seams, evenly};

use sheet::{Result, save};

/// An eight turned by half while it goes around.
const KLEIN: [&str; 3] = [
    "(3 + cos(u/2)*sin(v) - sin(u/2)*sin(2*v))*cos(u)",
    "(3 + cos(u/2)*sin(v) - sin(u/2)*sin(2*v))*sin(u)",
    "sin(u/2)*sin(v) + cos(u/2)*sin(2*v)",
];

pub(crate) fn plot() -> Result<Plot> {
    let (n_u, n_v) = (145, 73);
    let us = evenly(0.0, std::f64::consts::TAU, n_u);
    let formulas = KLEIN.map(|text| Formula::parse(text, Variables::Parameters));
    let [x, y, z] = formulas;
    let (x, y, z) = (x?, y?, z?);
    let mut points: Vec<DVec3> = Vec::with_capacity(n_u * n_v);
    for v in evenly(0.0, std::f64::consts::TAU, n_v) {
        let point = |u: &f64| DVec3::new(x.value(*u, v), y.value(*u, v), z.value(*u, v));
        points.extend(us.iter().map(point));
    }
    close_seams(n_u, &mut points);
    let mut mesh = LinedMesh::default();
    let lines = LatticeLines { along_rows: true, along_columns: true, every: 2, triangles: false };
    mesh.push_lattice(n_u, &points, &lines);
    let surface = mesh.into_scene()?;
    let framing = Framing {
        standpoint: Standpoint::Angles { azimuth_deg: 20.0, elevation_deg: 40.0, distance: None },
        ..Framing::default()
    };
    let camera = framing.camera(surface.scene.mesh().bounds().unwrap_or_default())?;
    let page = PageOptions::default();
    let mm_per_unit = |drawing: &Drawing| {
        Page::new(drawing, &camera, &page).map_or(1.0, |page| page.mm_per_image_unit())
    };
    let options = MeshedOptions {
        engine: Engine::Roberts,
        folds: true,
        border: false,
        exact: false,
        underside: false,
        apart_by_kind: false,
        shortest_stroke_mm: DEFAULT_SHORTEST_STROKE_MM,
    };
    let drawing = draw(&surface, &camera, &options, mm_per_unit, &mut Stats::default());
    let options = PlotOptions {
        pen_width_mm: 0.3,
        pens: Vec::new(),
        hidden: HiddenLines::None,
        dash: Dash::default(),
        title: "A Klein bottle".into(),
        source: String::new(),
    };
    Ok(Page::new(&drawing, &camera, &page)?.plot(&drawing, options).plot)
}

fn main() -> Result<()> {
    save("surface_klein", &plot()?)
}
