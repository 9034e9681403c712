//! `hiddenline surface`: from a formula or a grid of heights to a drawing's file.

mod args;
mod engine;
mod sheet_args;
mod sheets;
mod smoothness;

use std::error::Error;

use glam::{DVec2, DVec3};
use hiddenline::stages::axes::{Titles, axes, missing};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::chain::grid_lines::{Lines, strokes};
use hiddenline::stages::draw::{DEFAULT_SHORTEST_STROKE_MM, HiddenLines, meshed};
use hiddenline::stages::engines::edge::LineEngine;
use hiddenline::stages::engines::surface::floating_horizon::Family;
use hiddenline::stages::engines::surface::{
    CellOrder, GridPieces, SurfaceError, SurfaceSide, floating_horizon, max_min,
};
use hiddenline::stages::optimize::{Effort, Options};
use hiddenline::stages::page::{Dash, Page, PageOptions, PlotOptions};
use hiddenline::stages::strokes::Strokes;
use hiddenline::stages::surface::{Grid, LatticeLines, LinedScene};
use hiddenline::stages::timing::timed;
use hiddenline::stages::write::Format;

use self::args::Levels;
pub(super) use self::args::SurfaceArgs;
use self::engine::{EngineName, only_grid};
pub(super) use self::sheet_args::{DEFAULT_SAMPLES, SheetArgs};
pub(super) use self::sheets::Sheets;
use self::sheets::{NO_CELLS, Surface};
use self::smoothness::Sampled;
use super::camera::ViewSource;
use super::output::OutputOptions;
use super::paper::{Run, Sheet};
use super::stats::Stats;
use super::{config, source};

/// Most triangles that a mesh engine is given: about 3 GB of memory.
const MOST_TRIANGLES: u64 = 8_000_000;

/// More of the paper covered with lines than this looks like a sheet of ink.
const CROWDED: f64 = 0.5;

/// How much of the paper lines cover that are easily told apart.
const WELL_COVERED: f64 = 0.25;

/// Drawings with at most so many points are joined again in a moment.
const FEW_POINTS: usize = 12_000;

/// What is to be done.
pub(super) struct Job {
    sheets: Sheets,
    view: ViewSource,
    lines: Lines,
    levels: Option<Levels>,
    folds: bool,
    intersections: bool,
    border: bool,
    all_edges: bool,
    engine: EngineName,
    order: Option<CellOrder>,
    /// Zero for lines as sampled.
    smoothness_mm: f64,
    underside: bool,
    /// `None` for no axes.
    titles: Option<Titles>,
    page: PageOptions,
    unit_mm: f64,
    pen_width_mm: f64,
    output: OutputOptions,
}

/// Does the job; the error is a message for the user.
pub(super) fn run(job: &Job) -> Result<(), Box<dyn Error>> {
    let mut run = Run::start(&job.output)?;
    run.unit_mm = job.unit_mm;
    let stats = &mut run.stats;
    run.progress.stage("sampling");
    let Sampled { surface, factor, camera, refined, deviation_mm, warnings } =
        timed(&mut stats.seconds.read, || smoothness::sample(job))?;
    run.notes.warnings.extend(warnings);
    if deviation_mm > job.smoothness_mm {
        run.notes.warnings.push(format!(
            "lines are up to {deviation_mm:.1} mm off the function, at kinks, jumps or where it \
             is steep; more --samples draw it more closely"
        ));
    }
    let bounds = surface.bounds();
    run.notes.warnings.extend(surface.note());
    run.notes.warnings.extend(without_levels(job, bounds, factor)?);
    let lines = Lines { every: job.lines.every.saturating_mul(refined), ..job.lines };
    run.progress.stage("drawing");
    let grid = only_grid(&surface, job, &camera)?;
    if grid.is_none() && job.order.is_some() {
        return Err("--order needs one surface z = f(x, y) over a rectangle without holes, drawn \
                    with grid lines only: leave --order out"
            .into());
    }
    let scene = match grid {
        Some(_) => None,
        None => Some(timed(&mut stats.seconds.topology, || lined(job, &surface, factor, &lines))?),
    };
    let extent = match &scene {
        Some(lined) => lined.scene.extent(&camera),
        None => surface.extent(&camera),
    };
    let around = job.titles.as_ref().map(|titles| axes(&extent, bounds, factor, &camera, titles));
    let around = around.unwrap_or_default();
    let sheet = Sheet::new(extent.union(around.extent(&camera)), camera, &job.page)?;
    let mut drawing = match (grid, &scene) {
        (Some(grid), _) => draw_by_grid(job, grid, &lines, &camera, stats)?,
        (None, Some(scene)) => draw_by_mesh(job, scene, &sheet, stats)?,
        (None, None) => Strokes::default(),
    };
    if drawing.is_empty() && extent.corners().is_some() {
        run.empty_because = format!(
            "every line of the kinds selected is hidden or shorter than {DEFAULT_SHORTEST_STROKE_MM} \
             mm; give other --lines or a larger --drawing-scale"
        );
    }
    run.notes.warnings.extend(crowding(job, &drawing, &sheet.page));
    if let Some(titles) = job.titles.as_ref().filter(|_| !drawing.is_empty()) {
        drawing.append(&around);
        run.notes.warnings.extend(unknown_letters(titles));
    }
    let usual = joining(&drawing, grid.is_some(), &camera);
    stats.strokes = drawing.len();
    stats.points = drawing.n_points();
    run.notes.summary = format!("{}: {}", job.sheets.title(), surface.described());
    run.draw(&drawing, &sheet, plot_options(job), &usual)
}

/// A warning when lines are so close that they flow into each other.
fn crowding(job: &Job, drawing: &Strokes, page: &Page) -> Option<String> {
    let has_families = job.lines.along_x || job.lines.along_y;
    if job.lines.separate || !has_families || job.output.format == Format::Json {
        return None;
    }
    let (low, high) = drawing.bounds()?;
    let size_mm = (high - low) * page.mm_per_image_unit();
    let pairs = |points: &[DVec2]| points.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>();
    let length: f64 = drawing.iter().map(|stroke| pairs(stroke.points)).sum();
    let ink = length * page.mm_per_image_unit() * job.pen_width_mm;
    let covered = ink / (size_mm.x * size_mm.y);
    // A flat surface seen edge-on is a line; there is nothing to tell apart.
    let is_area = size_mm.min_element() > job.pen_width_mm;
    (is_area && covered > CROWDED).then(|| {
        let every = (job.lines.every as f64 * covered / WELL_COVERED).ceil();
        format!("lines flow into each other; --every {every} draws fewer")
    })
}

/// Says which letters of the titles cannot be drawn.
fn unknown_letters(titles: &Titles) -> Option<String> {
    let letters = missing(&[titles.axes.join(""), titles.drawing.clone()].concat());
    let letters: Vec<String> = letters.iter().map(|letter| format!("`{letter}`")).collect();
    let letters = letters.join(", ");
    (!letters.is_empty()).then(|| format!("the font has no {letters}: drawn as question marks"))
}

/// Says so if there are no level curves; an error if nothing else is to be drawn.
fn without_levels(
    job: &Job,
    (low, high): (DVec3, DVec3),
    factor: f64,
) -> Result<Option<String>, String> {
    let Some(levels) = &job.levels else { return Ok(None) };
    let (one, other) = match factor {
        0.0 => (0.0, 0.0),
        _ => (low.z / factor + 0.0, high.z / factor + 0.0),
    };
    let range = one.min(other)..=one.max(other);
    let (least, most) = (brief(*range.start()), brief(*range.end()));
    let message = match levels {
        _ if low.z == high.z => {
            format!("the surface is level, {least} high everywhere: it has no level curves")
        }
        Levels::At(heights) if heights.iter().all(|z| !range.contains(z)) => {
            format!("the surface has heights from {least} to {most}: none of --levels is there")
        }
        _ => return Ok(None),
    };
    let draws_more = job.lines.along_x || job.lines.along_y;
    if draws_more || job.folds || job.border || job.intersections || job.all_edges {
        Ok(Some(message))
    } else {
        Err(format!("{message}; --lines both draws grid lines"))
    }
}

/// A number with at most six digits that count.
fn brief(number: f64) -> f64 {
    format!("{number:.5e}").parse().unwrap_or(number)
}

/// What to do with the strokes. Those of a grid run along its lines already, in a short way from
/// line to line, and no line lies on another unless the surface is seen edge-on: joining and
/// ordering many of them again would take several times as long as all the rest.
fn joining(drawing: &Strokes, is_by_grid: bool, camera: &Camera) -> Options {
    let usual = Options::for_drawings();
    let is_edge_on = camera.projection() == Projection::Orthographic && camera.forward().z == 0.0;
    if is_by_grid && !is_edge_on && drawing.n_points() > FEW_POINTS {
        Options { join_tolerance_mm: None, effort: Effort::None, ..usual }
    } else {
        usual
    }
}

fn draw_by_grid(
    job: &Job,
    grid: &Grid,
    lines: &Lines,
    camera: &Camera,
    stats: &mut Stats,
) -> Result<Strokes, SurfaceError> {
    let mut seconds = stats.seconds;
    let (engine, pieces) = timed(&mut seconds.visibility, || -> Result<_, SurfaceError> {
        Ok(match job.engine {
            EngineName::FloatingHorizon => {
                let family = if job.lines.along_x { Family::AlongX } else { Family::AlongY };
                ("floating-horizon", floating_horizon::solve(grid, camera, family)?)
            }
            _ => (max_min::NAME, max_min::solve(grid, camera, job.order.unwrap_or_default())?),
        })
    })?;
    stats.engine = engine;
    let drawing = timed(&mut seconds.strokes, || {
        if !job.underside {
            return strokes(grid, &pieces, camera, lines);
        }
        let of = |side| strokes(grid, &pieces, camera, &Lines { side: Some(side), ..*lines });
        let mut drawing = of(SurfaceSide::Upper);
        drawing.append_undersides(&of(SurfaceSide::Lower));
        drawing
    });
    stats.seconds = seconds;
    count(stats, grid, &pieces);
    Ok(drawing)
}

/// The surface as a scene, with its grid lines and level curves.
fn lined(
    job: &Job,
    surface: &Surface,
    factor: f64,
    lines: &Lines,
) -> Result<LinedScene, Box<dyn Error>> {
    let lattice = LatticeLines {
        along_rows: lines.along_x,
        along_columns: lines.along_y,
        every: lines.every,
        triangles: job.all_edges,
    };
    let too_many = |n: u64| {
        (n > MOST_TRIANGLES).then(|| {
            format!(
                "the surface has {n} triangles, and its lines need an engine for meshes, which \
                 takes {MOST_TRIANGLES}; give fewer --samples or --levels"
            )
        })
    };
    let cells = |(n_columns, n, _): &sheets::Lattice| {
        (n_columns - 1) as u64 * (n / n_columns).saturating_sub(1) as u64
    };
    let n_triangles = 2 * surface.lattices().iter().map(cells).sum::<u64>();
    too_many(n_triangles).map_or(Ok(()), Err)?;
    let heights = job.levels.as_ref().map(|levels| heights(levels, surface, factor));
    let split_at = heights.as_deref().filter(|_| !job.lines.separate).unwrap_or_default();
    let mut mesh = surface.lined(&lattice, split_at);
    if mesh.n_triangles() == 0 {
        return Err(NO_CELLS.into());
    }
    if let Some(heights) = &heights {
        too_many(mesh.n_pieces_with_levels(heights)).map_or(Ok(()), Err)?;
        mesh.add_levels(heights);
    }
    let LinedScene { scene, lines } = mesh.into_scene()?;
    let scene = if job.intersections { scene.with_intersections() } else { scene };
    Ok(LinedScene { scene, lines })
}

fn draw_by_mesh(
    job: &Job,
    scene: &LinedScene,
    sheet: &Sheet,
    stats: &mut Stats,
) -> Result<Strokes, String> {
    let options = meshed::MeshedOptions {
        engine: match job.engine {
            EngineName::Roberts => LineEngine::Roberts,
            EngineName::Appel => LineEngine::Appel,
            EngineName::Auto | EngineName::MaxMin | EngineName::FloatingHorizon => LineEngine::Auto,
        },
        folds: job.folds,
        intersections: job.intersections,
        border: job.border,
        exact: job.lines.separate,
        underside: job.underside,
        apart_by_kind: job.output.format == Format::Json,
        shortest_stroke_mm: DEFAULT_SHORTEST_STROKE_MM,
    };
    let scale = sheet.page.mm_per_image_unit();
    let drawn = meshed::draw(scene, &sheet.camera, &options, scale);
    stats.count(&scene.scene);
    stats.add(&drawn);
    if job.engine == EngineName::MaxMin && drawn.engine != max_min::NAME {
        return Err("max-min draws one surface z = f(x, y) without holes over a convex part of \
                    the plane, or two that meet along its border, seen from outside and not cut by \
                    the near plane: give --engine auto"
            .into());
    }
    Ok(drawn.drawing)
}

/// The heights of level curves as they are drawn.
fn heights(levels: &Levels, surface: &Surface, factor: f64) -> Vec<f64> {
    let (low, high) = surface.bounds();
    match levels {
        Levels::Count(count) => {
            let n = f64::from(*count) + 1.0;
            (1..=*count).map(|k| low.z + (high.z - low.z) * f64::from(k) / n).collect()
        }
        Levels::At(heights) => heights.iter().map(|z| z * factor).collect(),
    }
}

fn count(stats: &mut Stats, grid: &Grid, pieces: &GridPieces) {
    let cells = (grid.xs().len() - 1) * (grid.ys().len() - 1);
    stats.vertices = grid.zs().len();
    stats.faces = 2 * cells;
    stats.triangles = 2 * cells;
    stats.edges = pieces.n_edges() + cells;
    stats.drawn_edges = pieces.n_edges();
    stats.counts.candidate_pairs = pieces.work().comparisons;
    stats.counts.exact_predicates = pieces.work().exact;
}

fn plot_options(job: &Job) -> PlotOptions {
    PlotOptions {
        pen_width_mm: job.pen_width_mm,
        hidden: HiddenLines::None,
        dash: Dash { dash_mm: 2.5, gap_mm: 1.25 },
        title: job.sheets.title(),
        pens: job.output.plotting.pens_for_surface(job.underside, job.pen_width_mm),
        source: source::source(config::arguments()),
    }
}
