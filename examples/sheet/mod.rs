//! What all pictures have in common: from a mesh and its settings to `plots/NAME.svg` and `.png`.

use std::error::Error;
use std::fs::{File, create_dir_all};
use std::io::BufWriter;
use std::path::Path;

use glam::DVec3;
use hiddenline::draw::{DEFAULT_SHORTEST_STROKE_MM, DrawOptions, HiddenLines, draw};
use hiddenline::engines::edge::Engine;
use hiddenline::engines::surface::meshed::{self, MeshedOptions};
use hiddenline::engines::surface::{Lines, Order, max_min, strokes};
use hiddenline::framing::{Framing, Standpoint};
use hiddenline::mesh::Mesh;
use hiddenline::page::{Dash, Page, PageOptions, PlotOptions};
use hiddenline::plot::Plot;
use hiddenline::scene::Scene;
use hiddenline::stats::Stats;
use hiddenline::strokes::Drawing;
use hiddenline::surface::{Grid, LatticeLines, LinedMesh, close_seams, evenly};
use hiddenline::view::Camera;
use hiddenline::writers::png::{self, Resolution};
use hiddenline::writers::svg::{self, StrokeElement};

pub(crate) type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// A mesh, from where it is seen, how it is drawn, and on what paper.
#[allow(dead_code, reason = "surfaces are drawn without a mesh")]
pub(crate) struct Sheet {
    pub(crate) title: &'static str,
    pub(crate) mesh: Mesh,
    pub(crate) framing: Framing,
    pub(crate) draw: DrawOptions,
    pub(crate) page: PageOptions,
}

#[allow(dead_code, reason = "surfaces are drawn without a mesh")]
impl Sheet {
    /// The finished page.
    pub(crate) fn plot(self) -> Result<Plot> {
        let camera = self.framing.camera(self.mesh.bounds().unwrap_or_default())?;
        let scene = Scene::new(self.mesh);
        let mm_per_unit = |drawing: &Drawing| {
            Page::new(drawing, &camera, &self.page).map_or(1.0, |page| page.mm_per_image_unit())
        };
        let drawing = draw(&scene, &camera, &self.draw, mm_per_unit, &mut Stats::default());
        let options = PlotOptions {
            pen_width_mm: 0.3,
            pens: Vec::new(),
            hidden: self.draw.hidden,
            dash: Dash::default(),
            title: self.title.into(),
            source: String::new(),
        };
        Ok(Page::new(&drawing, &camera, &self.page)?.plot(&drawing, options).plot)
    }
}

/// A surface over a grid, by each `every`-th line of both families, with nothing around it.
#[allow(dead_code, reason = "meshes are drawn without a grid")]
pub(crate) fn grid_plot(title: &str, grid: &Grid, every: usize, framing: Framing) -> Result<Plot> {
    let (xs, ys) = (grid.xs(), grid.ys());
    let (low, high) = grid.heights().unwrap_or_default();
    let corner = |i: usize, j: usize, z: f64| DVec3::new(xs[i], ys[j], z);
    let bounds = (corner(0, 0, low), corner(xs.len() - 1, ys.len() - 1, high));
    let camera = framing.camera(bounds)?;
    let pieces = max_min::solve(grid, &camera, Order::Rows)?;
    let drawing = strokes(grid, &pieces, &camera, &Lines { every, ..Lines::default() });
    paper(title, &drawing, &camera)
}

/// A surface in space over `n` = (u, v) samples of each unit interval, by each `every`-th line of
/// both parameters.
#[allow(dead_code, reason = "meshes are drawn without parameters")]
pub(crate) fn parametric_plot(
    title: &str,
    n: (usize, usize),
    every: usize,
    framing: Framing,
    point: impl Fn(f64, f64) -> DVec3,
) -> Result<Plot> {
    let us = evenly(0.0, 1.0, n.0);
    let rows = evenly(0.0, 1.0, n.1);
    let mut points: Vec<DVec3> = rows
        .iter()
        .flat_map(|&v| us.iter().map(move |&u| (u, v)))
        .map(|(u, v)| point(u, v))
        .collect();
    close_seams(n.0, &mut points);
    let mut mesh = LinedMesh::default();
    let lines = LatticeLines { along_rows: true, along_columns: true, every, triangles: false };
    mesh.push_lattice(n.0, &points, &lines);
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
    let drawing = meshed::draw(&surface, &camera, &options, mm_per_unit, &mut Stats::default());
    paper(title, &drawing, &camera)
}

/// Puts a drawing on a sheet of the usual size.
#[allow(dead_code, reason = "meshes have settings of their own")]
fn paper(title: &str, drawing: &Drawing, camera: &Camera) -> Result<Plot> {
    let options = PlotOptions {
        pen_width_mm: 0.3,
        pens: Vec::new(),
        hidden: HiddenLines::None,
        dash: Dash::default(),
        title: title.into(),
        source: String::new(),
    };
    Ok(Page::new(drawing, camera, &PageOptions::default())?.plot(drawing, options).plot)
}

/// Seen from an azimuth and an elevation in degrees.
#[allow(dead_code, reason = "some pictures are seen as usual")]
pub(crate) fn seen_from(azimuth_deg: f64, elevation_deg: f64) -> Framing {
    Framing {
        standpoint: Standpoint::Angles { azimuth_deg, elevation_deg, distance: None },
        ..Framing::default()
    }
}

/// Writes `plots/NAME.svg` and `plots/NAME.png`.
pub(crate) fn save(name: &str, plot: &Plot) -> Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("plots");
    create_dir_all(&folder)?;
    let create = |extension| File::create(folder.join(name).with_extension(extension));
    svg::write(plot, StrokeElement::Path, &mut BufWriter::new(create("svg")?))?;
    png::write(plot, Resolution::WidthPx(1000), &mut BufWriter::new(create("png")?))?;
    Ok(())
}
