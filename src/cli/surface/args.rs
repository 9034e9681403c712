//! What is typed after `hiddenline surface`, and what it means.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use hiddenline::dressing::Titles;
use hiddenline::engines::surface::Lines;
use hiddenline::formula::{Formula, Variables};
use hiddenline::surface::{MAX_SAMPLES, Placement};

use super::Job;
use super::sheets::Input;
use crate::cli::camera::CameraArgs;
use crate::cli::formulas::in_formula;
use crate::cli::output::{OutputArgs, check_place};
use crate::cli::page::PageArgs;
use crate::cli::{Refused, values};

/// Samples along each axis, unless given.
const DEFAULT_SAMPLES: usize = 81;

/// Level curves, unless given.
const DEFAULT_LEVELS: u16 = 12;

const EXAMPLES: &str = "\
Examples:
  hiddenline surface \"sin(r)/r\" --x=-12:12 --y=-12:12 --samples 100 -o hat.svg
      An even number of samples steps over the hole at the origin; sinc(r) has none.
  hiddenline surface \"-x^2 + y^2\" --samples 401 --every 10 -o saddle.svg
      Smooth curves: every tenth line of a fine grid.
  hiddenline surface \"sqrt(9-r^2)\" \"(-sqrt(9-r^2))\" --where \"r<=3\" --aspect data -o ball.svg
      Two sheets over a disc.
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
pub(in crate::cli) struct SurfaceArgs {
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
    /// Rows of numbers, ESRI ASCII grid, NPY, or a gray PNG or TIFF, by the file's content.
    #[arg(long, value_name = "FILE", conflicts_with = "expression")]
    grid: Option<PathBuf>,
    /// Scattered points from a file with x, y and z on each line; `-` is standard input
    #[arg(long, value_name = "FILE", conflicts_with_all = ["expression", "grid", "x", "y"])]
    points: Option<PathBuf>,
    /// Three formulas of u and v, for x, y and z
    #[arg(long, value_names = ["X", "Y", "Z"], num_args = 3, allow_hyphen_values = true)]
    #[arg(value_parser = parametric)]
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
    /// Where the surface is, as a formula of x and y that is true there, such as x^2+y^2<=9
    ///
    /// The surface is cut along the border of this domain, which is drawn.
    #[arg(long = "where", value_name = "EXPR", requires = "expression")]
    domain: Option<String>,
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
    /// How far lines may be from the curves they stand for, on paper; 0 draws them as sampled
    ///
    /// Formulas are sampled up to eight times as finely as --samples says, and only the lines of
    /// --samples are drawn.
    #[arg(long, value_name = "MM", value_parser = values::length, default_value = "0.1")]
    smoothness: f64,
    /// Give lines on the underside of the surface a pen and a layer of their own, `underside`
    #[arg(long)]
    underside: bool,
    /// How hidden lines are found
    ///
    /// auto: max-min where it can, otherwise roberts or appel; max-min: grid lines by a surface
    /// without holes; roberts, appel: any lines by any surface; floating-horizon: one family by its
    /// own nearer lines.
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
pub(super) enum Aspect {
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
pub(super) enum EngineName {
    Auto,
    MaxMin,
    FloatingHorizon,
    Roberts,
    Appel,
}

/// Which level curves, heights as in the formula or file.
#[derive(Clone)]
pub(super) enum Levels {
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
    let parsed = Formula::parse(text, Variables::Plane);
    let formula = parsed.map_err(|error| in_formula(&format!("`{text}`"), text, &error))?;
    let value = formula.value(f64::NAN, f64::NAN);
    if value.is_finite() { Ok(value) } else { Err(format!("`{text}` is not a finite number")) }
}

/// Two numbers, the smaller first, with a colon between them.
pub(in crate::cli) fn range(text: &str) -> Result<(f64, f64), String> {
    let (from, to) = text.split_once(':').ok_or("give two numbers, as in -2:2")?;
    let (from, to) = (constant(from)?, constant(to)?);
    if from < to { Ok((from, to)) } else { Err("the first number must be the smaller one".into()) }
}

/// Numbers of samples along x and y.
pub(in crate::cli) fn samples(text: &str) -> Result<(usize, usize), String> {
    let number = |text: &str| {
        let n = text.trim().parse::<usize>().map_err(|_| "give a number, as in 80 or 80x60")?;
        if n < 2 { Err("at least 2 samples are needed") } else { Ok(n) }
    };
    let (x, y) = text.split_once('x').unwrap_or((text, text));
    let (x, y) = (number(x)?, number(y)?);
    if x.checked_mul(y).is_none_or(|n| n > MAX_SAMPLES) {
        return Err(format!("{x} × {y} samples are more than {MAX_SAMPLES}"));
    }
    Ok((x, y))
}

/// One of the formulas of --parametric. Since formulas may begin with a minus, clap takes the options
/// after too few of them for more.
fn parametric(text: &str) -> Result<String, String> {
    let is_option = |rest: &str| rest.starts_with(|c: char| c.is_ascii_alphabetic());
    let is_option =
        text.strip_prefix("--").is_some_and(is_option) || ["-o", "-q", "-h", "-V"].contains(&text);
    if is_option {
        return Err("three formulas are needed, for x, y and z".into());
    }
    Ok(text.to_owned())
}

fn at_least_one(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|k| *k > 0).ok_or_else(|| "give a whole number above 0".to_owned())
}

impl SurfaceArgs {
    /// Checks what clap cannot; the error is a message about usage.
    pub(in crate::cli) fn job(self) -> Result<Job, Refused> {
        let Self { surface, camera, lines, dressing, page, output } = self;
        let samples = surface.samples.unwrap_or((DEFAULT_SAMPLES, DEFAULT_SAMPLES));
        let parse = |texts: &[String], variables| {
            let parse = |(k, text): (usize, &String)| {
                let which = match texts.len() {
                    1 => "the formula".to_owned(),
                    n => format!("formula {} of {n}", k + 1),
                };
                Formula::parse(text, variables).map_err(|error| in_formula(&which, text, &error))
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
            let domain = surface.domain.map(|text| {
                let parsed = Formula::parse(&text, Variables::Plane);
                let parsed = parsed.map_err(|error| in_formula("--where", &text, &error));
                parsed.map(|formula| (formula, text))
            });
            Input::Formulas { texts, formulas, domain: domain.transpose()?, samples }
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
            Input::Formulas { formulas, domain, .. } => formulas.len() == 1 && domain.is_none(),
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
        let view = camera.view_source();
        let output = output.options(lines.exact)?;
        let file = match &input {
            Input::File(path) | Input::Points(path) => Some(path.clone()),
            _ => None,
        };
        let inputs = file.into_iter().chain(view.input()).chain(output.inputs.clone());
        check_place(output.path.as_deref(), inputs)?;
        let aspect = surface.aspect.unwrap_or(default_aspect);
        Ok(Job {
            input,
            placement: Placement { x: surface.x, y: surface.y, flip_y: surface.flip_y },
            z_scale: surface.z_scale,
            aspect: if lines.exact { Aspect::Data } else { aspect },
            view,
            lines: along,
            levels: has(LineName::Levels)
                .then(|| lines.levels.unwrap_or(Levels::Count(DEFAULT_LEVELS))),
            folds: has(LineName::Silhouette),
            border: has(LineName::Border),
            all_edges: has(LineName::Mesh),
            engine: lines.engine,
            smoothness_mm: if lines.exact { 0.0 } else { lines.smoothness },
            underside: lines.underside,
            titles: if dressing.no_axes || lines.exact { None } else { Some(dressing.titles()?) },
            page: page.options(),
            unit_mm: page.unit_mm(),
            pen_width_mm: page.pen_width_mm(),
            output,
        })
    }
}
