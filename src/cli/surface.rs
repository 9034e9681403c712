//! `hiddenline surface`: from a formula or a grid of heights to a drawing's file.

use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, ValueEnum};
use glam::DVec3;
use hiddenline::draw::HiddenLines;
use hiddenline::engines::surface::floating_horizon::Family;
use hiddenline::engines::surface::{
    GridPieces, Lines, Order, SurfaceError, floating_horizon, max_min, strokes,
};
use hiddenline::formula::{Formula, Variables};
use hiddenline::page::{Dash, PageOptions, PlotOptions};
use hiddenline::stats::{Stats, timed};
use hiddenline::strokes::Drawing;
use hiddenline::surface::{Grid, Holes, Placement, read_csv};

use super::args::{CameraArgs, OutputArgs, OutputOptions, PageArgs, ViewSource};
use super::draw::read_camera;
use super::paper::{Notes, Run};
use super::progress::Progress;
use super::{Refused, config, source, values};

/// Height of the drawn box as a part of the longer side of its base, with `--aspect box`.
const BOX_HEIGHT: f64 = 0.4;

/// Samples along each axis, unless given.
const DEFAULT_SAMPLES: usize = 81;

/// The range of x and y that a formula is drawn over, unless given.
const DEFAULT_RANGE: (f64, f64) = (-5.0, 5.0);

const EXAMPLES: &str = "\
Examples:
  hiddenline surface \"sin(r)/r\" --x=-12:12 --y=-12:12 --samples 100 -o hat.svg
      An even number of samples steps over the hole at the origin; sinc(r) has none.
  hiddenline surface \"-x^2 + y^2\" --samples 401 --every 10 -o saddle.svg
      Smooth curves: every tenth line of a fine grid.
  hiddenline surface --grid heights.csv --view isometric -o terrain.svg
      Rows of numbers; the first row is the one with the smallest y.";

/// Draw a surface z = f(x, y) by its grid lines, the hidden parts removed
///
/// The drawing is exact for the triangulated grid, from any viewpoint. Formulas know x, y, r and
/// theta, + - * / % ^, comparisons, && || !, c ? a : b, and functions such as sin, exp, sqrt, min.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct SurfaceArgs {
    #[command(flatten)]
    surface: InputArgs,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    lines: LineArgs,
    #[command(flatten)]
    page: PageArgs,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Args)]
#[command(next_help_heading = "Surface")]
struct InputArgs {
    /// Formula of x, y, r and theta
    #[arg(value_name = "EXPR", allow_hyphen_values = true, required_unless_present = "grid")]
    expression: Option<String>,
    /// Heights from a file with rows of numbers; `-` is standard input
    #[arg(long, value_name = "FILE", conflicts_with = "expression")]
    grid: Option<PathBuf>,
    /// Range of x [default: -5:5, for a file 0 to columns - 1]
    #[arg(long, value_name = "A:B", value_parser = range, allow_hyphen_values = true)]
    x: Option<(f64, f64)>,
    /// Range of y [default: -5:5, for a file 0 to rows - 1]
    #[arg(long, value_name = "A:B", value_parser = range, allow_hyphen_values = true)]
    y: Option<(f64, f64)>,
    /// Samples along both axes, or along x and along y
    #[arg(long, value_name = "N|NxM", value_parser = samples, conflicts_with = "grid")]
    samples: Option<(usize, usize)>,
    /// The first row of the file is the one with the largest y
    #[arg(long, requires = "grid")]
    flip_y: bool,
    /// Factor for all heights
    #[arg(long, value_name = "FACTOR", value_parser = values::number, allow_hyphen_values = true)]
    #[arg(default_value_t = 1.0)]
    z_scale: f64,
    /// Whether heights are drawn to the scale of x and y
    ///
    /// box: heights are scaled so that the box around the surface is 0.4 times as high as the longer
    /// side of its base, then by --z-scale.
    #[arg(long, value_enum, default_value = "box")]
    aspect: Aspect,
}

#[derive(Args)]
#[command(next_help_heading = "Lines")]
struct LineArgs {
    /// Which grid lines: along x, along y, or both
    #[arg(long, value_enum, default_value = "both")]
    lines: Families,
    /// Draw only each K-th line of a family, and the last one
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = at_least_one)]
    every: usize,
    /// How hidden lines are found
    ///
    /// auto, max-min: by the surface; floating-horizon: one family by its own nearer lines.
    #[arg(long, value_enum, default_value = "auto")]
    engine: EngineName,
    /// Draw what is exactly visible, one stroke for each visible piece of each grid edge, with heights
    /// as given
    #[arg(long)]
    exact: bool,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Aspect {
    Box,
    Data,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Families {
    X,
    Y,
    Both,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum EngineName {
    Auto,
    MaxMin,
    FloatingHorizon,
}

fn range(text: &str) -> Result<(f64, f64), String> {
    let (from, to) = text.split_once(':').ok_or("give two numbers, as in -2:2")?;
    let (from, to) = (values::number(from)?, values::number(to)?);
    if from < to { Ok((from, to)) } else { Err("the first number must be the smaller one".into()) }
}

fn samples(text: &str) -> Result<(usize, usize), String> {
    let number = |text: &str| {
        let n = text.trim().parse::<usize>().map_err(|_| "give a number, as in 80 or 80x60")?;
        if n < 2 { Err("at least 2 samples are needed") } else { Ok(n) }
    };
    match text.split_once('x') {
        Some((x, y)) => Ok((number(x)?, number(y)?)),
        None => number(text).map(|n| (n, n)),
    }
    .map_err(|error: &str| error.to_owned())
}

fn at_least_one(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|k| *k > 0).ok_or_else(|| "give a whole number above 0".to_owned())
}

/// Where the heights come from.
enum Input {
    Formula { text: String, formula: Formula, samples: (usize, usize) },
    File(PathBuf),
}

/// What is to be done.
pub(super) struct Job {
    input: Input,
    placement: Placement,
    z_scale: f64,
    aspect: Aspect,
    view: ViewSource,
    lines: Lines,
    engine: EngineName,
    page: PageOptions,
    pen_width_mm: f64,
    output: OutputOptions,
}

impl SurfaceArgs {
    /// Checks what clap cannot; the error is a message about usage.
    pub(super) fn job(self) -> Result<Job, Refused> {
        let Self { surface, camera, lines, page, output } = self;
        let input = match (surface.expression, surface.grid) {
            (Some(text), None) => {
                let formula = Formula::parse(&text, Variables::Plane)
                    .map_err(|error| format!("in the formula, {error}"))?;
                let samples = surface.samples.unwrap_or((DEFAULT_SAMPLES, DEFAULT_SAMPLES));
                Input::Formula { text, formula, samples }
            }
            (_, Some(path)) => Input::File(path),
            (None, None) => return Err("give a formula or --grid FILE".into()),
        };
        if lines.engine == EngineName::FloatingHorizon && lines.lines == Families::Both {
            return Err("the floating horizon draws one family: give --lines x or --lines y".into());
        }
        Ok(Job {
            input,
            placement: Placement { x: surface.x, y: surface.y, flip_y: surface.flip_y },
            z_scale: surface.z_scale,
            aspect: if lines.exact { Aspect::Data } else { surface.aspect },
            view: camera.view_source(),
            lines: Lines {
                along_x: lines.lines != Families::Y,
                along_y: lines.lines != Families::X,
                every: lines.every,
                side: None,
                separate: lines.exact,
            },
            engine: lines.engine,
            page: page.options(),
            pen_width_mm: page.pen_width_mm(),
            output: output.options(lines.exact)?,
        })
    }
}

/// Does the job; the error is a message for the user.
pub(super) fn run(job: &Job) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    if let Some(threads) = job.output.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    }
    let mut stats = Stats { threads: rayon::current_num_threads(), ..Stats::default() };
    let mut seconds = stats.seconds;
    let progress = Progress::new(job.output.quiet);
    progress.stage("sampling");
    let grid = timed(&mut seconds.read, || read(job))?;
    let (xs, ys) = (grid.xs(), grid.ys());
    let (low, high) = grid.heights().unwrap_or_default();
    let bounds =
        (DVec3::new(xs[0], ys[0], low), DVec3::new(xs[xs.len() - 1], ys[ys.len() - 1], high));
    let camera = match &job.view {
        ViewSource::Framing(framing) => framing.camera(bounds)?,
        ViewSource::File(path) => read_camera(path)?,
    };
    progress.stage("drawing");
    let (engine, pieces) = timed(&mut seconds.visibility, || -> Result<_, SurfaceError> {
        Ok(match job.engine {
            EngineName::Auto | EngineName::MaxMin => {
                ("max-min", max_min::solve(&grid, &camera, Order::Rows)?)
            }
            EngineName::FloatingHorizon => {
                let family = if job.lines.along_x { Family::AlongX } else { Family::AlongY };
                ("floating-horizon", floating_horizon::solve(&grid, &camera, family)?)
            }
        })
    })?;
    stats.engine = engine;
    let drawing = timed(&mut seconds.strokes, || strokes(&grid, &pieces, &camera, &job.lines));
    count(&mut stats, &grid, &pieces, &drawing);
    drop(pieces);

    stats.seconds = seconds;
    let summary = format!("{}: {} × {} samples", title(job), xs.len(), ys.len());
    let notes = Notes { warnings: Vec::new(), summary };
    Run { output: &job.output, start, progress, stats, notes }.draw(
        &drawing,
        &camera,
        &job.page,
        plot_options(job),
    )
}

fn read(job: &Job) -> Result<Grid, Box<dyn Error>> {
    let mut grid = match &job.input {
        Input::Formula { formula, samples, .. } => {
            let x = job.placement.x.unwrap_or(DEFAULT_RANGE);
            let y = job.placement.y.unwrap_or(DEFAULT_RANGE);
            Grid::sample(formula, x, y, *samples)?
        }
        Input::File(path) => {
            let text = if path.as_os_str() == "-" {
                io::read_to_string(io::stdin().lock())
            } else {
                std::fs::read_to_string(path)
            };
            let failed = |error: &dyn Error| format!("{}: {error}", path.display());
            let text = text.map_err(|error| failed(&error))?;
            read_csv(&text, job.placement).map_err(|error| failed(&error))?
        }
    };
    let heights = grid.heights();
    match (grid.holes(), heights) {
        (Holes::All, _) | (_, None) => {
            return Err("no sample has a height: nothing to draw".into());
        }
        (Holes::Some, _) => {
            return Err("some samples have no height; surfaces with holes cannot be drawn yet. \
                        Change the range or the number of samples, or fill the holes"
                .into());
        }
        (Holes::None, Some((low, high))) => {
            let (xs, ys) = (grid.xs(), grid.ys());
            let base = (xs[xs.len() - 1] - xs[0]).max(ys[ys.len() - 1] - ys[0]);
            let fitted = BOX_HEIGHT * base / (high - low);
            let factor = if job.aspect == Aspect::Box && fitted.is_finite() { fitted } else { 1.0 };
            grid.scale_heights(factor * job.z_scale);
        }
    }
    Ok(grid)
}

fn count(stats: &mut Stats, grid: &Grid, pieces: &GridPieces, drawing: &Drawing) {
    let cells = (grid.xs().len() - 1) * (grid.ys().len() - 1);
    stats.vertices = grid.zs().len();
    stats.faces = 2 * cells;
    stats.triangles = 2 * cells;
    stats.edges = pieces.n_edges() + cells;
    stats.drawn_edges = pieces.n_edges();
    stats.strokes = drawing.len();
    stats.points = drawing.n_points();
    stats.counts.candidate_pairs = pieces.work().comparisons;
    stats.counts.exact_predicates = pieces.work().exact;
}

fn plot_options(job: &Job) -> PlotOptions {
    PlotOptions {
        pen_width_mm: job.pen_width_mm,
        hidden: HiddenLines::None,
        dash: Dash { dash_mm: 2.5, gap_mm: 1.25 },
        title: title(job),
        pens: job.output.plotting.pens(job.pen_width_mm),
        source: source::source(config::arguments()),
    }
}

fn title(job: &Job) -> String {
    match &job.input {
        Input::Formula { text, .. } => format!("z = {}", text.trim()),
        Input::File(path) => {
            let name = path.file_name().unwrap_or(path.as_os_str());
            Path::new(name).display().to_string()
        }
    }
}
