//! The arguments of `hiddenline surface`, and the job that they describe.

use clap::{Args, ValueEnum};
use hiddenline::stages::draw::surface::{
    DEFAULT_LABEL_HEIGHT_MM, LabelSide, Labels, Legend, Levels, SurfaceEngine, SurfaceLines,
};
use hiddenline::stages::engines::surface::CellOrder;
use hiddenline::stages::surface::{Aspect, DEFAULT_SAMPLES};
use hiddenline::stages::write::Format;

use super::Job;
use super::axes_args::AxesArgs;
use super::input::SurfaceSource;
use super::input_args::SurfaceInputArgs;
use super::legend_args::LegendArgs;
use crate::cli::camera::CameraArgs;
use crate::cli::choice::one_of;
use crate::cli::hatch::{HatchArgs, LightArgs};
use crate::cli::output::{OutputArgs, check_place};
use crate::cli::page::PageArgs;
use crate::cli::{Refused, values};

/// Level curves, unless given.
const DEFAULT_LEVELS: u16 = 12;

const EXAMPLES: &str = "\
Examples:
  hiddenline surface \"sin(r)/r\" --x=-12:12 --y=-12:12 --samples 100 -o hat.svg
      An even number of samples steps over the hole at the origin; sinc(r) has none.
  hiddenline surface \"-x^2 + y^2\" --samples 401 --every 10 -o saddle.svg
      Smooth curves: every tenth line of a fine grid.
  hiddenline surface \"sqrt(9-r^2)\" \"-sqrt(9-r^2)\" --where \"r<=3\" --aspect data -o ball.svg
      Two sheets over a disc.
  hiddenline surface --grid heights.csv --view isometric -o terrain.svg
      Rows of numbers; the first row is the one with the smallest y.
  hiddenline surface --points survey.xyz --lines levels --levels 20 -o map.svg
      Level curves of a surface through scattered points.
  hiddenline surface --parametric \"(3+cos(v))*cos(u)\" \"(3+cos(v))*sin(u)\" \"sin(v)\" \\
      --u 0:2*pi --v 0:2*pi -o torus.svg
      A surface in space.";

/// Draw a surface z = f(x, y) as grid lines or level curves, with hidden lines removed
///
/// The drawing is exact for the triangulated grid, from any viewpoint. Several formulas are drawn as
/// sheets that hide each other; samples without a value are holes. Formulas can use x, y, r and theta,
/// + - * / % ^, comparisons, && || !, c ? a : b, and functions such as sin, exp, sqrt, min.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct SurfaceArgs {
    #[command(flatten)]
    surface: ExprArgs,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    lines: LineArgs,
    #[command(flatten)]
    hatch: HatchArgs,
    #[command(flatten)]
    light: LightArgs,
    #[command(flatten)]
    axes: AxesArgs,
    #[command(flatten)]
    legend: LegendArgs,
    #[command(flatten)]
    page: PageArgs,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Args)]
#[command(next_help_heading = "Surface")]
struct ExprArgs {
    /// Formula in x, y, r and theta
    #[arg(value_name = "EXPR", allow_hyphen_values = true)]
    #[arg(required_unless_present_any = ["grid", "points", "parametric"])]
    expression: Option<String>,
    /// More formulas, one for each sheet
    #[arg(value_name = "EXPR")]
    more: Vec<String>,
    #[command(flatten)]
    sheets: SurfaceInputArgs,
}

#[derive(Args)]
#[command(next_help_heading = "Lines")]
struct LineArgs {
    /// Lines to draw, separated by commas [default: x,y,silhouette,border; mesh with --points]
    ///
    /// x: grid lines along x (or u); y: along y (or v); both: x,y; levels: curves of equal height;
    /// silhouette: where the surface folds away from the eye; border: its edges, where no grid line runs;
    /// intersection: where sheets cross; mesh: all edges of its triangles. By default, folds are drawn for
    /// formulas only, and with --exact only grid lines are drawn.
    #[arg(long, value_enum, value_delimiter = ',')]
    lines: Vec<LineName>,
    /// Level curves: how many, evenly spaced between the lowest and highest points; a list of heights (`5,`
    /// is the height 5); every:STEP; or no value for a round step
    ///
    /// every:5:2 draws them at 2, 7, 12 and so on.
    #[arg(long, value_name = "N|LIST|every:STEP[:OFFSET]", value_parser = levels)]
    #[arg(allow_hyphen_values = true)]
    levels: Option<Levels>,
    /// Draw every N-th level curve as an index line, twice as wide [default: 5 with every:STEP]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    index_every: Option<u16>,
    /// Also draw these lines on the base of the box, where the surface does not hide them
    #[arg(long, value_enum, value_name = "LINES")]
    project: Option<ProjectName>,
    /// Which level curves to label with their heights, in gaps [default: index or all from above]
    ///
    /// In views from above without grid lines the default is index, or all if there are no index lines;
    /// otherwise it is none.
    #[arg(long, value_enum)]
    labels: Option<LabelName>,
    /// Orientation of labels
    #[arg(long, value_enum, default_value = "upright")]
    label_side: LabelSideName,
    /// How to draw level curves below 0
    #[arg(long, value_enum, default_value = "solid")]
    negative: Negative,
    /// Draw only every K-th line of a family, and the last one
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = at_least_one)]
    every: usize,
    /// Maximum deviation of lines from the true curves, on paper; 0 draws the samples unchanged
    ///
    /// Formulas are sampled as finely as needed, which interval arithmetic proves, but only the lines of
    /// --samples are drawn. Surfaces are left open at jumps and poles; 0 draws across them. Not used with
    /// --engine floating-horizon or --lines mesh.
    #[arg(long, value_name = "MM", value_parser = values::length, default_value = "0.1")]
    smoothness: f64,
    /// Draw lines on the underside of the surface with their own pen and layer, `underside`
    #[arg(long)]
    underside: bool,
    /// Hidden-line algorithm
    #[arg(long, value_parser = one_of::<SurfaceEngine>())]
    #[arg(default_value = SurfaceEngine::Auto.name())]
    engine: SurfaceEngine,
    /// Order in which max-min visits the cells of a grid; the drawing is the same
    #[arg(long, value_parser = one_of::<CellOrder>())]
    order: Option<CellOrder>,
    /// Draw what is exactly visible, one stroke for each visible piece of each grid edge, with heights
    /// as given
    #[arg(long)]
    exact: bool,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum ProjectName {
    /// Level curves, with the pen level-base
    Levels,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum LabelName {
    /// Index lines
    Index,
    /// All level curves
    All,
    /// None
    None,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum LabelSideName {
    /// Read from the bottom or the right of the page
    Upright,
    /// Tops point uphill
    Uphill,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Negative {
    /// Like the others
    Solid,
    /// Dashed
    Dashed,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum LineName {
    X,
    Y,
    Both,
    Levels,
    Silhouette,
    Intersection,
    Border,
    Mesh,
}

fn levels(text: &str) -> Result<Levels, String> {
    if let Ok(count) = text.trim().parse() {
        return if count > 0 { Ok(Levels::Count(count)) } else { Err("at least 1 level".into()) };
    }
    if text.trim() == values::ROUND_STEP {
        return Ok(Levels::Round);
    }
    if let Some(step) = text.trim().strip_prefix("every:") {
        let (step, offset) = step.split_once(':').unwrap_or((step, "0"));
        return Ok(Levels::Every {
            step: values::positive(step)?,
            offset: values::number(offset)?,
        });
    }
    let list = text.strip_suffix(',').unwrap_or(text);
    list.split(',').map(values::number).collect::<Result<_, _>>().map(Levels::At)
}

fn at_least_one(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|k| *k > 0).ok_or_else(|| "expected a whole number above 0".to_owned())
}

impl SurfaceArgs {
    /// Checks what clap cannot; the error is a message about usage. `idle` warns about options
    /// without effect.
    pub(in crate::cli) fn job(self, idle: Vec<String>) -> Result<Job, Refused> {
        let Self { surface, camera, lines, hatch, light, axes, legend, page, output } = self;
        let texts = surface.expression.into_iter().chain(surface.more);
        let texts: Vec<String> = texts.map(|text| text.trim().to_owned()).collect();
        let sheets = surface.sheets.sheets(texts, DEFAULT_SAMPLES)?;
        let mut sheets = sheets.ok_or("a formula is missing")?;
        let default_line = match sheets.input {
            SurfaceSource::Points(_) => LineName::Mesh,
            _ => LineName::Both,
        };
        let edges = lines.lines.is_empty();
        let named = if edges { vec![default_line] } else { lines.lines };
        let has = |name| named.contains(&name);
        let both = has(LineName::Both);
        let along_x = both || has(LineName::X);
        let along_y = both || has(LineName::Y);
        let only_grid_lines =
            named.iter().all(|n| matches!(n, LineName::X | LineName::Y | LineName::Both));
        if matches!(sheets.input, SurfaceSource::Points(_)) && (along_x || along_y) {
            return Err("scattered points have no grid lines: use --lines mesh or levels".into());
        }
        if lines.levels.is_some() && !has(LineName::Levels) {
            return Err("--levels is for level curves: add levels to --lines".into());
        }
        if !has(LineName::Levels)
            && (lines.index_every.is_some()
                || lines.labels.is_some()
                || lines.project.is_some()
                || lines.negative == Negative::Dashed)
        {
            return Err(
                "--index-every, --project, --labels and --negative are for level curves: add \
                 levels to --lines"
                    .into(),
            );
        }
        let one_sheet = match &sheets.input {
            SurfaceSource::Formulas { sheets, .. } => sheets.len() == 1,
            SurfaceSource::File(_) | SurfaceSource::Points(_) => true,
            SurfaceSource::Parametric { .. } => false,
        };
        let two_sheets =
            matches!(&sheets.input, SurfaceSource::Formulas { sheets, .. } if sheets.len() == 2);
        let is_grid = match &sheets.input {
            SurfaceSource::Formulas { sheets, .. } => one_sheet && sheets[0].domain.is_none(),
            SurfaceSource::File(_) => true,
            SurfaceSource::Points(_) | SurfaceSource::Parametric { .. } => false,
        };
        match lines.engine {
            SurfaceEngine::FloatingHorizon if along_x == along_y || !only_grid_lines => {
                return Err(
                    "the floating horizon draws one family: use --lines x or --lines y".into()
                );
            }
            SurfaceEngine::FloatingHorizon if !is_grid => {
                return Err(
                    "the floating horizon draws one surface z = f(x, y) over a rectangle: \
                            use --engine roberts or auto"
                        .into(),
                );
            }
            SurfaceEngine::MaxMin if !one_sheet && !two_sheets => {
                return Err("max-min draws one surface z = f(x, y), or two that meet along their \
                            border: use --engine roberts or auto"
                    .into());
            }
            SurfaceEngine::FloatingHorizon | SurfaceEngine::Roberts | SurfaceEngine::Appel
                if lines.order.is_some() =>
            {
                return Err("--order is for --engine max-min or auto".into());
            }
            _ => {}
        }
        if lines.exact {
            sheets.aspect = Aspect::Data;
        }
        let view = camera.view_source();
        let mut output = output.options(lines.exact)?;
        output.warnings.extend(idle);
        output.warnings.extend(hatch.without_effect(false, &["--light", "--light-at"]));
        let hatch = hatch.options(light.source());
        let inputs = sheets.file().into_iter().chain(view.input()).chain(output.inputs.clone());
        check_place(output.path.as_deref(), inputs)?;
        let axes = axes.axes(page.pen_width_mm())?.filter(|_| !lines.exact);
        let legend = legend.legend(&mut sheets)?.filter(|_| !lines.exact);
        let pens = sheets.pens(&output.plotting, page.pen_width_mm(), legend.is_some());
        let has_pens_by_kind = pens.iter().any(|rule| rule.drawn.tells_kinds_apart());
        let pen_width_mm = page.pen_width_mm();
        let legend = legend.map(|legend| Legend { pens, pen_width_mm, ..legend });
        let levels = lines.levels.unwrap_or(Levels::Count(DEFAULT_LEVELS));
        let lines = SurfaceLines {
            along_x,
            along_y,
            every: lines.every,
            levels: has(LineName::Levels).then_some(levels),
            index_every: lines.index_every,
            project_levels: lines.project.is_some(),
            negative_dashed: lines.negative == Negative::Dashed,
            labels: lines.labels.map(|labels| match labels {
                LabelName::Index => Labels::Index,
                LabelName::All => Labels::All,
                LabelName::None => Labels::None,
            }),
            label_side: match lines.label_side {
                LabelSideName::Upright => LabelSide::Upright,
                LabelSideName::Uphill => LabelSide::Uphill,
            },
            // Thick pens close the loops of small digits.
            label_height_mm: DEFAULT_LABEL_HEIGHT_MM.max(6.0 * page.pen_width_mm()),
            silhouette: has(LineName::Silhouette),
            border: has(LineName::Border),
            edges,
            intersections: has(LineName::Intersection),
            mesh: has(LineName::Mesh),
            smoothness_mm: if lines.exact { 0.0 } else { lines.smoothness },
            underside: lines.underside,
            exact: lines.exact,
            engine: lines.engine,
            order: lines.order,
            axes,
            legend,
            keep_scene: hatch.is_some(),
            apart_by_kind: output.format == Format::Json
                || output.plotting.has_pens_by_kind()
                || has_pens_by_kind,
            ..SurfaceLines::default()
        };
        Ok(Job {
            sheets,
            view,
            lines,
            hatch,
            page: output.within_reach(page.options()),
            unit_mm: page.unit_mm(),
            dxf_scale: page.dxf_scale(),
            pen_width_mm: page.pen_width_mm(),
            output,
        })
    }
}
