//! `hiddenline surface`: from a formula or a grid of heights to a drawing's file.

use std::error::Error;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, ValueEnum};
use glam::DVec3;
use hiddenline::draw::{DEFAULT_SHORTEST_STROKE_MM, HiddenLines};
use hiddenline::dressing::{Titles, dress};
use hiddenline::engines::edge::Engine;
use hiddenline::engines::surface::floating_horizon::Family;
use hiddenline::engines::surface::{
    GridPieces, Lines, Order, SurfaceError, floating_horizon, max_min, meshed, strokes,
};
use hiddenline::formula::{Formula, Variables};
use hiddenline::page::{Dash, Page, PageOptions, PlotOptions};
use hiddenline::stats::{Stats, timed};
use hiddenline::strokes::Drawing;
use hiddenline::surface::{
    Grid, Holes, LatticeLines, LinedMesh, MAX_SAMPLES, Placement, close_seams, delaunay, evenly,
    read_heights, read_points,
};
use hiddenline::view::Camera;
use hiddenline::writers::Format;

use super::args::{CameraArgs, OutputArgs, OutputOptions, PageArgs, ViewSource};
use super::draw::read_camera;
use super::paper::{Notes, Run};
use super::progress::Progress;
use super::{Refused, config, source, values};

/// Height of the drawn box as a part of the longer side of its base, with `--aspect box`.
const BOX_HEIGHT: f64 = 0.4;

/// Samples along each axis, unless given.
const DEFAULT_SAMPLES: usize = 81;

/// Level curves, unless given.
const DEFAULT_LEVELS: u16 = 12;

/// The range of x and y that a formula is drawn over, unless given.
const DEFAULT_RANGE: (f64, f64) = (-5.0, 5.0);

const EXAMPLES: &str = "\
Examples:
  hiddenline surface \"sin(r)/r\" --x=-12:12 --y=-12:12 --samples 100 -o hat.svg
      An even number of samples steps over the hole at the origin; sinc(r) has none.
  hiddenline surface \"-x^2 + y^2\" --samples 401 --every 10 -o saddle.svg
      Smooth curves: every tenth line of a fine grid.
  hiddenline surface --grid heights.csv --view isometric -o terrain.svg
      Rows of numbers; the first row is the one with the smallest y.
  hiddenline surface --points survey.xyz --lines levels --levels 20 -o map.svg
      Level curves of a surface through scattered points.
  hiddenline surface --parametric \"(3+cos(v))*cos(u)\" \"(3+cos(v))*sin(u)\" \"sin(v)\" \\
      --u 0:2*pi --v 0:2*pi -o torus.svg
      A surface in space.";

/// Draw a surface z = f(x, y) by grid lines or level curves, the hidden parts removed
///
/// The drawing is exact for the triangulated grid, from any viewpoint. Several formulas are drawn as
/// sheets that hide each other; samples without a value are holes. Formulas know x, y, r and theta,
/// + - * / % ^, comparisons, && || !, c ? a : b, and functions such as sin, exp, sqrt, min.
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
    dressing: DressingArgs,
    #[command(flatten)]
    page: PageArgs,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Args)]
#[command(next_help_heading = "Surface")]
struct InputArgs {
    /// Formula of x, y, r and theta
    #[arg(value_name = "EXPR", allow_hyphen_values = true)]
    #[arg(required_unless_present_any = ["grid", "points", "parametric"])]
    expression: Option<String>,
    /// Further formulas, one for each sheet; put one that begins with a minus into parentheses
    #[arg(value_name = "EXPR")]
    more: Vec<String>,
    /// Heights from a file; `-` is standard input
    ///
    /// Rows of numbers, ESRI ASCII grid, NPY, or a gray PNG, by the file's content.
    #[arg(long, value_name = "FILE", conflicts_with = "expression")]
    grid: Option<PathBuf>,
    /// Scattered points from a file with x, y and z on each line; `-` is standard input
    #[arg(long, value_name = "FILE", conflicts_with_all = ["expression", "grid", "x", "y"])]
    points: Option<PathBuf>,
    /// Three formulas of u and v, for x, y and z
    #[arg(long, value_names = ["X", "Y", "Z"], num_args = 3, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["expression", "grid", "points", "x", "y"])]
    parametric: Option<Vec<String>>,
    /// Range of u; its ends may be formulas such as 2*pi [default: 0:1]
    #[arg(long, value_name = "A:B", value_parser = range, allow_hyphen_values = true)]
    #[arg(requires = "parametric")]
    u: Option<(f64, f64)>,
    /// Range of v [default: 0:1]
    #[arg(long, value_name = "A:B", value_parser = range, allow_hyphen_values = true)]
    #[arg(requires = "parametric")]
    v: Option<(f64, f64)>,
    /// Range of x [default: -5:5, for a file 0 to columns - 1]
    #[arg(long, value_name = "A:B", value_parser = range, allow_hyphen_values = true)]
    x: Option<(f64, f64)>,
    /// Range of y [default: -5:5, for a file 0 to rows - 1]
    #[arg(long, value_name = "A:B", value_parser = range, allow_hyphen_values = true)]
    y: Option<(f64, f64)>,
    /// Samples along both axes, or along x and along y
    #[arg(long, value_name = "N|NxM", value_parser = samples, conflicts_with_all = ["grid", "points"])]
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
    /// side of its base, then by --z-scale. The default is box, but data with --parametric.
    #[arg(long, value_enum)]
    aspect: Option<Aspect>,
}

#[derive(Args)]
#[command(next_help_heading = "Lines")]
struct LineArgs {
    /// Lines to draw, with commas between them [default: both, but mesh with --points]
    ///
    /// x: grid lines along x (or u); y: along y (or v); both; levels: curves of equal height;
    /// silhouette: where the surface folds away from the eye; border: its edges; mesh: all edges of
    /// its triangles.
    #[arg(long, value_enum, value_delimiter = ',')]
    lines: Vec<LineName>,
    /// Level curves: how many, evenly spaced between the lowest and the highest point, or their
    /// heights with commas between them (`5,` is the height 5)
    #[arg(long, value_name = "N|LIST", value_parser = levels, allow_hyphen_values = true)]
    levels: Option<Levels>,
    /// Draw only each K-th line of a family, and the last one
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = at_least_one)]
    every: usize,
    /// How hidden lines are found
    ///
    /// auto: max-min where it can, otherwise roberts; max-min: grid lines by a surface without holes;
    /// roberts: any lines by any surface; floating-horizon: one family by its own nearer lines.
    #[arg(long, value_enum, default_value = "auto")]
    engine: EngineName,
    /// Draw what is exactly visible, one stroke for each visible piece of each grid edge, with heights
    /// as given
    #[arg(long)]
    exact: bool,
}

#[derive(Args)]
#[command(next_help_heading = "Axes")]
struct DressingArgs {
    /// Draw nothing but the surface; --exact implies it
    #[arg(long, conflicts_with_all = ["title", "axis_titles"])]
    no_axes: bool,
    /// What is written above the drawing
    #[arg(long, value_name = "TEXT", allow_hyphen_values = true)]
    title: Option<String>,
    /// What is written beside the axes
    #[arg(long, value_name = "X,Y,Z", value_delimiter = ',', default_value = "x,y,z")]
    axis_titles: Vec<String>,
}

impl DressingArgs {
    fn titles(self) -> Result<Titles, String> {
        let axes = self.axis_titles.try_into();
        let axes = axes.map_err(|_| "give three titles of axes with commas between them")?;
        Ok(Titles { axes, drawing: self.title.unwrap_or_default() })
    }
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Aspect {
    Box,
    Data,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum LineName {
    X,
    Y,
    Both,
    Levels,
    Silhouette,
    Border,
    Mesh,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum EngineName {
    Auto,
    MaxMin,
    FloatingHorizon,
    Roberts,
}

/// Which level curves, heights as in the formula or file.
#[derive(Clone)]
enum Levels {
    Count(u16),
    At(Vec<f64>),
}

fn levels(text: &str) -> Result<Levels, String> {
    if let Ok(count) = text.trim().parse() {
        return if count > 0 { Ok(Levels::Count(count)) } else { Err("at least 1 level".into()) };
    }
    let list = text.strip_suffix(',').unwrap_or(text);
    list.split(',').map(values::number).collect::<Result<_, _>>().map(Levels::At)
}

/// A number or a formula without variables, such as `2*pi`.
fn constant(text: &str) -> Result<f64, String> {
    let formula = Formula::parse(text, Variables::Plane).map_err(|error| error.to_string())?;
    let value = formula.value(f64::NAN, f64::NAN);
    if value.is_finite() { Ok(value) } else { Err(format!("`{text}` is not a finite number")) }
}

/// Two numbers, the smaller first, with a colon between them.
pub(super) fn range(text: &str) -> Result<(f64, f64), String> {
    let (from, to) = text.split_once(':').ok_or("give two numbers, as in -2:2")?;
    let (from, to) = (constant(from)?, constant(to)?);
    if from < to { Ok((from, to)) } else { Err("the first number must be the smaller one".into()) }
}

/// Numbers of samples along x and y.
pub(super) fn samples(text: &str) -> Result<(usize, usize), String> {
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

/// Where the surface comes from.
enum Input {
    Formulas { texts: Vec<String>, formulas: Vec<Formula>, samples: (usize, usize) },
    File(PathBuf),
    Points(PathBuf),
    Parametric { formulas: Vec<Formula>, u: (f64, f64), v: (f64, f64), samples: (usize, usize) },
}

/// What is to be done.
pub(super) struct Job {
    input: Input,
    placement: Placement,
    z_scale: f64,
    aspect: Aspect,
    view: ViewSource,
    lines: Lines,
    levels: Option<Levels>,
    folds: bool,
    border: bool,
    all_edges: bool,
    engine: EngineName,
    /// `None` for no axes.
    titles: Option<Titles>,
    page: PageOptions,
    pen_width_mm: f64,
    output: OutputOptions,
}

impl SurfaceArgs {
    /// Checks what clap cannot; the error is a message about usage.
    pub(super) fn job(self) -> Result<Job, Refused> {
        let Self { surface, camera, lines, dressing, page, output } = self;
        let samples = surface.samples.unwrap_or((DEFAULT_SAMPLES, DEFAULT_SAMPLES));
        let parse = |texts: &[String], variables| {
            let parse = |(k, text): (usize, &String)| {
                let which = if texts.len() > 1 { format!("{}", k + 1) } else { String::new() };
                Formula::parse(text, variables).map_err(|error| match which.as_str() {
                    "" => format!("in the formula, {error}"),
                    which => format!("in formula {which}, {error}"),
                })
            };
            texts.iter().enumerate().map(parse).collect::<Result<Vec<_>, _>>()
        };
        let (mut default_line, mut default_aspect) = (LineName::Both, Aspect::Box);
        let input = if let Some(path) = surface.grid {
            Input::File(path)
        } else if let Some(path) = surface.points {
            default_line = LineName::Mesh;
            Input::Points(path)
        } else if let Some(texts) = surface.parametric {
            default_aspect = Aspect::Data;
            let formulas = parse(&texts, Variables::Parameters)?;
            let (u, v) = (surface.u.unwrap_or((0.0, 1.0)), surface.v.unwrap_or((0.0, 1.0)));
            Input::Parametric { formulas, u, v, samples }
        } else {
            let texts: Vec<String> = surface.expression.into_iter().chain(surface.more).collect();
            let formulas = parse(&texts, Variables::Plane)?;
            Input::Formulas { texts, formulas, samples }
        };
        let named = if lines.lines.is_empty() { vec![default_line] } else { lines.lines };
        let has = |name| named.contains(&name);
        let both = has(LineName::Both);
        let along = Lines {
            along_x: both || has(LineName::X),
            along_y: both || has(LineName::Y),
            every: lines.every,
            side: None,
            separate: lines.exact,
        };
        let only_grid_lines =
            named.iter().all(|n| matches!(n, LineName::X | LineName::Y | LineName::Both));
        if matches!(input, Input::Points(_)) && (along.along_x || along.along_y) {
            return Err("scattered points have no grid lines: give --lines mesh or levels".into());
        }
        if lines.levels.is_some() && !has(LineName::Levels) {
            return Err("--levels is for level curves: give --lines levels, too".into());
        }
        let one_sheet = match &input {
            Input::Formulas { formulas, .. } => formulas.len() == 1,
            Input::File(_) => true,
            _ => false,
        };
        match lines.engine {
            EngineName::FloatingHorizon if along.along_x == along.along_y || !only_grid_lines => {
                return Err(
                    "the floating horizon draws one family: give --lines x or --lines y".into()
                );
            }
            EngineName::FloatingHorizon | EngineName::MaxMin if !one_sheet || !only_grid_lines => {
                return Err("this engine draws only grid lines of one surface z = f(x, y): give \
                            --engine roberts or auto"
                    .into());
            }
            _ => {}
        }
        let aspect = surface.aspect.unwrap_or(default_aspect);
        Ok(Job {
            input,
            placement: Placement { x: surface.x, y: surface.y, flip_y: surface.flip_y },
            z_scale: surface.z_scale,
            aspect: if lines.exact { Aspect::Data } else { aspect },
            view: camera.view_source(),
            lines: along,
            levels: has(LineName::Levels)
                .then(|| lines.levels.unwrap_or(Levels::Count(DEFAULT_LEVELS))),
            folds: has(LineName::Silhouette),
            border: has(LineName::Border),
            all_edges: has(LineName::Mesh),
            engine: lines.engine,
            titles: if dressing.no_axes || lines.exact { None } else { Some(dressing.titles()?) },
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
    let (surface, factor) = timed(&mut seconds.read, || read(job))?;
    let bounds = surface.bounds();
    let camera = match &job.view {
        ViewSource::Framing(framing) => framing.camera(bounds)?,
        ViewSource::File(path) => read_camera(path)?,
    };
    progress.stage("drawing");
    stats.seconds = seconds;
    let mut drawing = match surface.only_grid(job) {
        Some(grid) => draw_by_grid(job, grid, &camera, &mut stats)?,
        None => draw_by_mesh(job, &surface, factor, &camera, &mut stats)?,
    };
    if let Some(titles) = job.titles.as_ref().filter(|_| !drawing.is_empty()) {
        dress(&mut drawing, bounds, factor, &camera, titles);
    }
    stats.strokes = drawing.len();
    stats.points = drawing.n_points();
    let notes =
        Notes { warnings: Vec::new(), summary: format!("{}: {}", title(job), surface.described()) };
    Run { output: &job.output, start, progress, stats, notes }.draw(
        &drawing,
        &camera,
        &job.page,
        plot_options(job),
    )
}

/// The surface that is drawn.
enum Surface {
    /// One or more, over the same x and y.
    Grids(Vec<Grid>),
    Points {
        points: Vec<DVec3>,
        triangles: Vec<[u32; 3]>,
    },
    Lattice {
        n_columns: usize,
        points: Vec<DVec3>,
    },
}

impl Surface {
    /// Box around all points; holes do not count.
    fn bounds(&self) -> (DVec3, DVec3) {
        let mut bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut add = |p: DVec3| bounds = (bounds.0.min(p), bounds.1.max(p));
        match self {
            Self::Grids(grids) => {
                for grid in grids {
                    let (xs, ys) = (grid.xs(), grid.ys());
                    if let Some((low, high)) = grid.heights() {
                        add(DVec3::new(xs[0], ys[0], low));
                        add(DVec3::new(xs[xs.len() - 1], ys[ys.len() - 1], high));
                    }
                }
            }
            Self::Points { points, .. } | Self::Lattice { points, .. } => {
                points.iter().filter(|p| p.is_finite()).for_each(|p| add(*p));
            }
        }
        bounds
    }

    fn scale_heights(&mut self, factor: f64) {
        match self {
            Self::Grids(grids) => grids.iter_mut().for_each(|grid| grid.scale_heights(factor)),
            Self::Points { points, .. } | Self::Lattice { points, .. } => {
                points.iter_mut().for_each(|p| p.z *= factor);
            }
        }
    }

    /// The grid, if it is all there is and an engine for grids is to draw it.
    fn only_grid(&self, job: &Job) -> Option<&Grid> {
        let needs_mesh = job.levels.is_some() || job.folds || job.border || job.all_edges;
        match (self, job.engine) {
            (_, EngineName::Roberts) => None,
            (Self::Grids(grids), EngineName::Auto) => {
                let grid = grids.first().filter(|_| grids.len() == 1 && !needs_mesh)?;
                (grid.holes() == Holes::None).then_some(grid)
            }
            (Self::Grids(grids), _) => grids.first(),
            _ => None,
        }
    }

    fn described(&self) -> String {
        match self {
            Self::Grids(grids) => grids.first().map_or_else(String::new, |grid| {
                format!("{} × {} samples", grid.xs().len(), grid.ys().len())
            }),
            Self::Points { points, triangles } => {
                format!("{} points, {} triangles", points.len(), triangles.len())
            }
            Self::Lattice { n_columns, points } => {
                format!("{} × {} samples", n_columns, points.len() / n_columns)
            }
        }
    }
}

fn read_bytes(path: &Path) -> io::Result<Vec<u8>> {
    if path.as_os_str() == "-" {
        let mut bytes = Vec::new();
        io::stdin().lock().read_to_end(&mut bytes)?;
        Ok(bytes)
    } else {
        std::fs::read(path)
    }
}

/// The surface, and the factor that its heights were multiplied by.
fn read(job: &Job) -> Result<(Surface, f64), Box<dyn Error>> {
    let failed = |path: &Path, error: &dyn Error| format!("{}: {error}", path.display());
    let mut surface = match &job.input {
        Input::Formulas { formulas, samples, .. } => {
            let x = job.placement.x.unwrap_or(DEFAULT_RANGE);
            let y = job.placement.y.unwrap_or(DEFAULT_RANGE);
            let sample = |formula| Grid::sample(formula, x, y, *samples);
            Surface::Grids(formulas.iter().map(sample).collect::<Result<_, _>>()?)
        }
        Input::File(path) => {
            let bytes = read_bytes(path).map_err(|error| failed(path, &error))?;
            let grid = read_heights(&bytes, job.placement);
            Surface::Grids(vec![grid.map_err(|error| failed(path, &error))?])
        }
        Input::Points(path) => {
            let bytes = read_bytes(path).map_err(|error| failed(path, &error))?;
            let points = read_points(&String::from_utf8_lossy(&bytes));
            let points = points.map_err(|error| failed(path, &error))?;
            let triangles = delaunay(&points).map_err(|error| failed(path, &error))?;
            Surface::Points { points, triangles }
        }
        Input::Parametric { formulas, u, v, samples } => {
            if samples.0.checked_mul(samples.1).is_none_or(|n| n > MAX_SAMPLES) {
                let (u, v) = samples;
                return Err(format!("{u} × {v} samples are more than {MAX_SAMPLES}").into());
            }
            let us = evenly(u.0, u.1, samples.0);
            let mut points = Vec::with_capacity(samples.0 * samples.1);
            for v in evenly(v.0, v.1, samples.1) {
                let mut rows = [(); 3].map(|()| vec![0.0; us.len()]);
                for (formula, row) in formulas.iter().zip(&mut rows) {
                    formula.values(&us, &vec![v; us.len()], row);
                }
                points
                    .extend((0..us.len()).map(|i| DVec3::new(rows[0][i], rows[1][i], rows[2][i])));
            }
            close_seams(us.len(), &mut points);
            Surface::Lattice { n_columns: us.len(), points }
        }
    };
    let (low, high) = surface.bounds();
    if low.x > high.x {
        return Err("no sample has a height: nothing to draw".into());
    }
    let size = high - low;
    let fitted = BOX_HEIGHT * size.x.max(size.y) / size.z;
    let fits = job.aspect == Aspect::Box && fitted.is_finite() && fitted > 0.0;
    let factor = if fits { fitted } else { 1.0 } * job.z_scale;
    surface.scale_heights(factor);
    Ok((surface, factor))
}

fn draw_by_grid(
    job: &Job,
    grid: &Grid,
    camera: &Camera,
    stats: &mut Stats,
) -> Result<Drawing, SurfaceError> {
    let mut seconds = stats.seconds;
    let (engine, pieces) = timed(&mut seconds.visibility, || -> Result<_, SurfaceError> {
        Ok(match job.engine {
            EngineName::FloatingHorizon => {
                let family = if job.lines.along_x { Family::AlongX } else { Family::AlongY };
                ("floating-horizon", floating_horizon::solve(grid, camera, family)?)
            }
            _ => ("max-min", max_min::solve(grid, camera, Order::Rows)?),
        })
    })?;
    stats.engine = engine;
    let drawing = timed(&mut seconds.strokes, || strokes(grid, &pieces, camera, &job.lines));
    stats.seconds = seconds;
    count(stats, grid, &pieces);
    Ok(drawing)
}

fn draw_by_mesh(
    job: &Job,
    surface: &Surface,
    factor: f64,
    camera: &Camera,
    stats: &mut Stats,
) -> Result<Drawing, Box<dyn Error>> {
    let mut seconds = stats.seconds;
    let lattice = LatticeLines {
        along_rows: job.lines.along_x,
        along_columns: job.lines.along_y,
        every: job.lines.every,
        triangles: job.all_edges,
    };
    let scene = timed(&mut seconds.topology, || -> Result<_, Box<dyn Error>> {
        let mut mesh = LinedMesh::default();
        match surface {
            Surface::Grids(grids) => grids.iter().for_each(|grid| mesh.push_grid(grid, &lattice)),
            Surface::Points { points, triangles } => {
                mesh.push_triangles(points, triangles, job.all_edges);
            }
            Surface::Lattice { n_columns, points } => {
                mesh.push_lattice(*n_columns, points, &lattice);
            }
        }
        if mesh.n_triangles() == 0 {
            return Err("no four neighboring samples have a height: nothing to draw".into());
        }
        if let Some(levels) = &job.levels {
            let (low, high) = surface.bounds();
            let n = |count: u16| f64::from(count) + 1.0;
            mesh.add_levels(&match levels {
                Levels::Count(count) => (1..=*count)
                    .map(|k| low.z + (high.z - low.z) * f64::from(k) / n(*count))
                    .collect(),
                Levels::At(heights) => heights.iter().map(|z| z * factor).collect::<Vec<_>>(),
            });
        }
        Ok(mesh.into_scene()?)
    })?;
    stats.seconds = seconds;
    let options = meshed::MeshedOptions {
        engine: Engine::Roberts,
        folds: job.folds,
        border: job.border,
        exact: job.lines.separate,
        apart_by_kind: job.output.format == Format::Json,
        shortest_stroke_mm: DEFAULT_SHORTEST_STROKE_MM,
    };
    let mm_per_unit = |drawing: &Drawing| {
        Page::new(drawing, camera, &job.page).map_or(1.0, |page| page.mm_per_image_unit())
    };
    Ok(meshed::draw(&scene, camera, &options, mm_per_unit, stats))
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
        title: title(job),
        pens: job.output.plotting.pens(job.pen_width_mm),
        source: source::source(config::arguments()),
    }
}

fn title(job: &Job) -> String {
    match &job.input {
        Input::Formulas { texts, .. } => {
            format!("z = {}", texts.iter().map(|text| text.trim()).collect::<Vec<_>>().join(", "))
        }
        Input::Parametric { .. } => "parametric surface".to_owned(),
        Input::File(path) | Input::Points(path) => {
            let name = path.file_name().unwrap_or(path.as_os_str());
            Path::new(name).display().to_string()
        }
    }
}
