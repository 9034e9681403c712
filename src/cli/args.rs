//! What can be typed after `hiddenline draw`, and what it means.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use glam::DVec3;
use hiddenline::arrange::{Arrangement, Pose, UpAxis};
use hiddenline::classify::{DEFAULT_CREASE_DEG, LineSelection};
use hiddenline::draw::{DEFAULT_SHORTEST_STROKE_MM, DrawOptions, HiddenLines};
use hiddenline::engines::edge::Engine;
use hiddenline::framing::{
    DEFAULT_AZIMUTH_DEG, DEFAULT_ELEVATION_DEG, Framing, NamedView, ProjectionKind, Standpoint,
};
use hiddenline::page::{
    DEFAULT_MARGIN_MM, DEFAULT_PEN_WIDTH_MM, Dash, Orientation, PageOptions, Paper, Placement,
};
use hiddenline::read::ModelFormat;
use hiddenline::view::{DEFAULT_FOV_DEG, DEFAULT_NEAR};
use hiddenline::writers::Format;
use hiddenline::writers::png::{Marks, Resolution};
use hiddenline::writers::svg::StrokeElement;

use super::machine::Target;
use super::plotting::{PlotArgs, Plotting};
use super::{Refused, values};

const EXAMPLES: &str = "\
Examples:
  hiddenline draw bunny.stl -o bunny.svg
      A three-quarter view, fitted to a sheet of A4.
  hiddenline draw part.stl --view isometric --hidden dashed --page a3 -o part.svg
      An isometric drawing with hidden lines dashed on a layer of their own.
  hiddenline draw house.obj --up-axis y --eye=-30,-40,12 --fov 50 -o house.png
      A picture of what is seen from a point. Numbers may be negative.
  hiddenline draw gear.stl --view top --drawing-scale 1:2 -o gear.svg
      True to scale, for a model in millimetres.
  hiddenline draw box.stl lid.stl --move 0,0,0 --move 0,0,40 -o open.svg
      Two models, the second one lifted.
  cat part.stl | hiddenline draw - --input-format stl > part.svg
      From standard input to standard output.";

/// Draw models as lines, the hidden ones removed
///
/// Reads OBJ, STL (text or binary), PLY and OFF, and writes SVG for print and pen plotters, PNG, or
/// the strokes as JSON. Several models are drawn together as one scene. The drawing is exact: what
/// hides what is decided without rounding and without tolerances.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct DrawArgs {
    #[command(flatten)]
    model: ModelArgs,
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
#[command(next_help_heading = "Model")]
pub(super) struct ModelArgs {
    /// Files to draw: .obj, .stl, .ply, .off; `-` is standard input
    #[arg(value_name = "MODEL", required = true)]
    models: Vec<PathBuf>,
    /// Format of the models, whatever they are named
    ///
    /// Without it the name's extension decides, and where that says nothing, the content.
    #[arg(long, value_name = "FORMAT", value_enum)]
    input_format: Option<InputFormat>,
    /// Axis that points up in the models
    #[arg(long, value_name = "AXIS", value_enum, default_value = "z")]
    up_axis: Axis,
    /// Factor for all coordinates; once for all models, or once for each in their order
    #[arg(long, value_name = "FACTOR", value_parser = values::positive)]
    scale: Vec<f64>,
    /// Turn by angles in degrees around x, then y, then z; once for all models, or once for each
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    rotate: Vec<DVec3>,
    /// Move by so much, after scaling and turning; once for all models, or once for each
    #[arg(long = "move", value_name = "X,Y,Z", value_parser = values::vector)]
    #[arg(allow_hyphen_values = true)]
    move_by: Vec<DVec3>,
    /// Make one vertex of those closer together than this, in model units
    #[arg(long, value_name = "D", value_parser = values::not_negative, default_value_t = 0.0)]
    weld: f64,
}

#[derive(Args)]
#[command(next_help_heading = "Camera")]
pub(super) struct CameraArgs {
    /// Where the observer stands
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    eye: Option<DVec3>,
    /// The point looked at [default: the middle of the bounding box]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    target: Option<DVec3>,
    /// What is up on the page [default: 0,0,1, or 0,1,0 when looking along z]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    up: Option<DVec3>,
    /// Degrees around the vertical: 0 from the front, 90 from the right [default: 30]
    #[arg(long, value_name = "DEG", value_parser = values::number, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["eye", "view"])]
    azimuth: Option<f64>,
    /// Degrees above the horizontal [default: 25]
    #[arg(long, value_name = "DEG", value_parser = values::number, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["eye", "view"])]
    elevation: Option<f64>,
    /// Distance from target to eye [default: the whole scene in view]
    #[arg(long, value_name = "D", value_parser = values::positive, conflicts_with = "eye")]
    distance: Option<f64>,
    /// A view with a name, orthographic unless --projection says otherwise
    #[arg(long, value_enum, conflicts_with = "eye")]
    view: Option<View>,
    /// How rays of sight run [default: perspective, but orthographic with --view]
    #[arg(long, value_enum)]
    projection: Option<ProjectionName>,
    /// Vertical field of view in degrees
    ///
    /// It says how far away an automatic camera stands and what --fit-fov shows, nothing else.
    #[arg(long, value_name = "DEG", value_parser = values::field_of_view)]
    #[arg(default_value_t = DEFAULT_FOV_DEG)]
    fov: f64,
    /// Place of the near plane, as a part of the way from eye to target
    #[arg(long, value_name = "PART", value_parser = values::positive)]
    #[arg(default_value_t = DEFAULT_NEAR)]
    near: f64,
    /// Take the camera of a strokes file (--format json)
    #[arg(long, value_name = "FILE")]
    #[arg(conflicts_with_all = ["eye", "target", "up", "azimuth", "elevation", "distance", "view",
        "projection", "fov", "near"])]
    camera: Option<PathBuf>,
}

#[derive(Args)]
#[command(next_help_heading = "Lines")]
struct LineArgs {
    /// Kinds of line to draw, with commas between them
    ///
    /// silhouette: between a front and a back face; crease: where faces meet at more than --crease;
    /// boundary: on one face only; nonmanifold: on three faces or more; intersection: where faces
    /// pierce each other; material: where groups or materials change; mesh, all: every edge of the
    /// mesh. An edge to which several kinds apply is drawn when any of them is named.
    /// outline: the parts of silhouette, boundary and nonmanifold edges beside which nothing but the
    /// background is seen; named with other kinds it has a pen of its own, twice as wide.
    #[arg(long, value_name = "KINDS", value_parser = values::lines, verbatim_doc_comment)]
    #[arg(default_value = "silhouette,crease,boundary,nonmanifold,intersection")]
    lines: LineSelection,
    /// Faces that meet at more than this angle make a crease
    #[arg(long, value_name = "DEG", value_parser = values::crease)]
    #[arg(default_value_t = DEFAULT_CREASE_DEG)]
    crease: f64,
    /// What becomes of hidden lines; if drawn, they are on their own layer [default: none]
    #[arg(long, value_enum)]
    hidden: Option<Hidden>,
    /// Draw hidden lines that are covered at most N times, each number on its own layer
    ///
    /// Every triangle in front of a line counts, so a solid body counts twice: its front and its
    /// back. The lines are dashed unless --hidden solid is given; --pen hidden1=…, hidden2=… are
    /// their pens.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=99))]
    hidden_levels: Option<u32>,
    /// Lengths of dashes and gaps of hidden lines
    #[arg(long, value_name = "DASH,GAP", value_parser = values::dash, default_value = "2.5,1.25")]
    dash: Dash,
    /// How hidden lines are found; all engines give the same drawing
    #[arg(long, value_enum, default_value = "auto")]
    engine: EngineName,
    /// Faces do not hide lines that lie this close to their plane, in model units
    ///
    /// Meant for parts that touch, but not exactly. The default is about what single precision
    /// makes of the largest coordinate; 0 turns it off.
    #[arg(long, value_name = "D", value_parser = values::not_negative)]
    contact_tolerance: Option<f64>,
    /// Visible strokes shorter than this on paper are dropped, such gaps in a line are closed
    #[arg(long, value_name = "MM", value_parser = values::not_negative)]
    #[arg(default_value_t = DEFAULT_SHORTEST_STROKE_MM)]
    shortest_stroke: f64,
    /// Draw what is exactly visible: one stroke for each visible interval of each edge
    ///
    /// Nothing is joined, dropped, dashed or drawn once for two: for comparisons, not for pens.
    #[arg(long, conflicts_with = "contact_tolerance")]
    exact: bool,
}

#[derive(Args)]
#[command(next_help_heading = "Page")]
pub(super) struct PageArgs {
    /// a0 to a6, letter, legal, tabloid, or WIDTHxHEIGHT in mm
    ///
    /// A named size is turned to suit the drawing. Numbers may have a unit, as in 8x10in.
    #[arg(long, value_name = "SIZE", default_value = "a4")]
    page: Paper,
    /// Wide rather than high
    #[arg(long, conflicts_with = "portrait")]
    landscape: bool,
    /// High rather than wide
    #[arg(long)]
    portrait: bool,
    /// Empty border; nothing is drawn outside
    #[arg(long, value_name = "MM", value_parser = values::length)]
    #[arg(default_value_t = DEFAULT_MARGIN_MM)]
    margin: f64,
    /// Scale, as in 1:10, instead of fitting the drawing to the page
    ///
    /// In perspective it holds at the distance of the target.
    #[arg(long, value_name = "1:N", value_parser = values::scale, conflicts_with = "fit_fov")]
    drawing_scale: Option<f64>,
    /// What a model unit is, for --drawing-scale
    #[arg(long, value_enum, default_value = "mm")]
    unit: LengthUnit,
    /// Show exactly the field of view between the upper and the lower margin
    #[arg(long)]
    fit_fov: bool,
    /// Width of the pen's line
    #[arg(long, value_name = "MM", value_parser = values::positive_length)]
    #[arg(default_value_t = DEFAULT_PEN_WIDTH_MM)]
    pen_width: f64,
}

#[derive(Args)]
#[command(next_help_heading = "Output")]
pub(super) struct OutputArgs {
    /// File to write, its format given by the extension; `-` is standard output
    ///
    /// .svg; .hpgl, .plt; .gcode, .nc, .ngc; .pdf; .dxf; .png; .json
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Format of the output [default: by extension; svg on standard output]
    #[arg(long, value_enum)]
    format: Option<FormatName>,
    /// Element that a stroke is written as in SVG
    #[arg(long, value_name = "ELEMENT", value_enum, default_value = "path")]
    svg_element: SvgElement,
    /// Pixels per inch of a PNG [default: 150]
    #[arg(long, value_parser = values::positive, conflicts_with = "png_width")]
    dpi: Option<f64>,
    /// Pixels from left to right of a PNG
    #[arg(long, value_name = "PX", value_parser = clap::value_parser!(u32).range(1..))]
    png_width: Option<u32>,
    /// Show in a PNG how the pens go: travel, order, or both with a comma between them
    ///
    /// travel: the ways with the pen up, as thin red lines; order: strokes from blue for the first by
    /// green to red for the last.
    #[arg(long, value_name = "WHAT", value_enum, value_delimiter = ',')]
    png_show: Vec<PngMark>,
    /// Threads to work with [default: all]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print counts and times as JSON, the last line on standard error
    #[arg(long)]
    stats: bool,
    /// Print nothing but errors
    #[arg(short, long, conflicts_with = "verbose")]
    quiet: bool,
    /// Print what was done in more detail
    #[arg(short, long)]
    verbose: bool,
    /// Take warnings for errors: exit with 1 and write nothing
    #[arg(long)]
    strict: bool,
    /// Take the settings called NAME in the configuration files
    #[arg(long, value_name = "NAME")]
    preset: Option<String>,
    #[command(flatten)]
    plotting: PlotArgs,
}

#[derive(Clone, Copy, ValueEnum)]
enum InputFormat {
    Obj,
    Stl,
    Ply,
    Off,
}

#[derive(Clone, Copy, ValueEnum)]
enum Axis {
    Y,
    Z,
}

#[derive(Clone, Copy)]
struct View(NamedView);

impl ValueEnum for View {
    fn value_variants<'a>() -> &'a [Self] {
        const VIEWS: [View; 9] = {
            let mut views = [View(NamedView::Front); 9];
            let mut i = 0;
            while i < views.len() {
                views[i] = View(NamedView::ALL[i]);
                i += 1;
            }
            views
        };
        &VIEWS
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        Some(clap::builder::PossibleValue::new(self.0.name()))
    }
}

#[derive(Clone, Copy, ValueEnum)]
enum ProjectionName {
    Perspective,
    Orthographic,
}

#[derive(Clone, Copy, ValueEnum)]
enum Hidden {
    None,
    Dashed,
    Solid,
}

#[derive(Clone, Copy, ValueEnum)]
enum EngineName {
    Auto,
    Roberts,
    Appel,
}

#[derive(Clone, Copy, ValueEnum)]
enum LengthUnit {
    Mm,
    Cm,
    M,
    In,
}

#[derive(Clone, Copy, ValueEnum)]
enum FormatName {
    Svg,
    Hpgl,
    Gcode,
    Pdf,
    Dxf,
    Png,
    Json,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum PngMark {
    Travel,
    Order,
}

#[derive(Clone, Copy, ValueEnum)]
enum SvgElement {
    Path,
    Polyline,
}

/// What is to be done, with nothing left to check but what depends on the files.
pub(super) struct Job {
    pub(super) files: ModelFiles,
    pub(super) view: ViewSource,
    pub(super) draw: DrawOptions,
    pub(super) page: PageOptions,
    pub(super) pen_width_mm: f64,
    pub(super) dash: Dash,
    pub(super) output: OutputOptions,
}

/// The models, and how they become one scene.
pub(super) struct ModelFiles {
    pub(super) models: Vec<PathBuf>,
    /// One for each model.
    pub(super) poses: Vec<Pose>,
    pub(super) input_format: Option<ModelFormat>,
    pub(super) arrangement: Arrangement,
}

/// Where the drawing goes, and what is told on the way.
pub(super) struct OutputOptions {
    /// `None` is standard output.
    pub(super) path: Option<PathBuf>,
    pub(super) format: Format,
    pub(super) svg_element: StrokeElement,
    pub(super) resolution: Resolution,
    pub(super) marks: Marks,
    pub(super) threads: Option<usize>,
    pub(super) stats: bool,
    pub(super) quiet: bool,
    pub(super) verbose: bool,
    pub(super) strict: bool,
    pub(super) plotting: Plotting,
    pub(super) target: Target,
}

/// Where the camera comes from.
pub(super) enum ViewSource {
    /// A strokes file.
    File(PathBuf),
    /// Options.
    Framing(Framing),
}

impl DrawArgs {
    /// Checks what clap cannot; the error is a message about usage.
    pub(super) fn job(self) -> Result<Job, Refused> {
        let Self { model, camera, lines, page, output } = self;
        let files = model.files()?;
        let output = output.options(lines.exact)?;
        let apart_by_kind = output.format == Format::Json || output.plotting.has_pens_by_kind();
        Ok(Job {
            files,
            view: camera.view_source(),
            page: page.options(),
            pen_width_mm: page.pen_width,
            dash: lines.dash,
            draw: DrawOptions { apart_by_kind, ..lines.options() },
            output,
        })
    }
}

impl ModelArgs {
    /// Checks what clap cannot; the error is a message about usage.
    pub(super) fn files(self) -> Result<ModelFiles, String> {
        if self.models.iter().filter(|path| is_dash(path)).count() > 1 {
            return Err("standard input (-) can be read only once".into());
        }
        Ok(ModelFiles {
            poses: self.poses()?,
            input_format: self.input_format.map(InputFormat::format),
            arrangement: Arrangement {
                up_axis: match self.up_axis {
                    Axis::Y => UpAxis::Y,
                    Axis::Z => UpAxis::Z,
                },
                weld_distance: self.weld,
            },
            models: self.models,
        })
    }

    /// Where each model goes; the error is a message about usage.
    fn poses(&self) -> Result<Vec<Pose>, String> {
        let n_models = self.models.len();
        let scales = for_each_model("--scale", &self.scale, 1.0, n_models)?;
        let turns = for_each_model("--rotate", &self.rotate, DVec3::ZERO, n_models)?;
        let moves = for_each_model("--move", &self.move_by, DVec3::ZERO, n_models)?;
        let placed = scales.into_iter().zip(turns).zip(moves);
        Ok(placed
            .map(|((scale, rotate_deg), move_by)| Pose { scale, rotate_deg, move_by })
            .collect())
    }
}

/// The values of an option that is given not at all, once for all models, or once for each.
fn for_each_model<T: Copy>(
    name: &str,
    given: &[T],
    default: T,
    n_models: usize,
) -> Result<Vec<T>, String> {
    match *given {
        [] => Ok(vec![default; n_models]),
        [one] => Ok(vec![one; n_models]),
        _ if given.len() == n_models => Ok(given.to_vec()),
        _ => Err(format!(
            "{name} is given {} times for {n_models} models; give it once for all, or once for each",
            given.len()
        )),
    }
}

pub(super) fn is_dash(path: &Path) -> bool {
    path.as_os_str() == "-"
}

fn output_format(typed: Option<FormatName>, path: Option<&Path>) -> Result<Format, String> {
    match (typed, path) {
        (Some(name), _) => Ok(name.format()),
        (None, None) => Ok(Format::Svg),
        (None, Some(path)) => Format::from_path(path).ok_or_else(|| {
            let known = Format::ALL.iter().flat_map(|format| format.extensions());
            let known: Vec<String> = known.map(|extension| format!(".{extension}")).collect();
            let known = known.join(", ");
            format!("`{}` has none of the extensions {known}; give --format", path.display())
        }),
    }
}

impl FormatName {
    fn format(self) -> Format {
        match self {
            Self::Svg => Format::Svg,
            Self::Hpgl => Format::Hpgl,
            Self::Gcode => Format::Gcode,
            Self::Pdf => Format::Pdf,
            Self::Dxf => Format::Dxf,
            Self::Png => Format::Png,
            Self::Json => Format::Json,
        }
    }
}

impl CameraArgs {
    pub(super) fn view_source(self) -> ViewSource {
        if let Some(path) = self.camera {
            return ViewSource::File(path);
        }
        let standpoint = match (self.eye, self.view) {
            (Some(eye), _) => Standpoint::Eye(eye),
            (None, Some(View(view))) => Standpoint::Named { view, distance: self.distance },
            (None, None) => Standpoint::Angles {
                azimuth_deg: self.azimuth.unwrap_or(DEFAULT_AZIMUTH_DEG),
                elevation_deg: self.elevation.unwrap_or(DEFAULT_ELEVATION_DEG),
                distance: self.distance,
            },
        };
        ViewSource::Framing(Framing {
            standpoint,
            target: self.target,
            up: self.up,
            projection: self.projection.map(|name| match name {
                ProjectionName::Perspective => ProjectionKind::Perspective,
                ProjectionName::Orthographic => ProjectionKind::Orthographic,
            }),
            fov_deg: self.fov,
            near: self.near,
        })
    }
}

impl LineArgs {
    fn options(&self) -> DrawOptions {
        DrawOptions {
            lines: self.lines,
            crease_deg: self.crease,
            hidden: match self.hidden {
                None | Some(Hidden::None) if self.hidden_levels.is_none() => HiddenLines::None,
                Some(Hidden::Solid) => HiddenLines::Solid,
                _ if self.exact => HiddenLines::Solid,
                _ => HiddenLines::Dashed,
            },
            hidden_levels: self.hidden_levels,
            exact: self.exact,
            engine: match self.engine {
                EngineName::Auto => Engine::Auto,
                EngineName::Roberts => Engine::Roberts,
                EngineName::Appel => Engine::Appel,
            },
            contact_tolerance: self.contact_tolerance,
            shortest_stroke_mm: self.shortest_stroke,
            apart_by_kind: false,
        }
    }
}

impl OutputArgs {
    /// Checks what clap cannot; the error is a message about usage.
    ///
    /// With `exact`, strokes are to be left as they are.
    pub(super) fn options(self, exact: bool) -> Result<OutputOptions, Refused> {
        let path = self.output.filter(|path| !is_dash(path));
        let format = output_format(self.format, path.as_deref())?;
        let target = self.plotting.target(format)?;
        Ok(OutputOptions {
            plotting: self.plotting.options(exact)?,
            target,
            format,
            path,
            svg_element: match self.svg_element {
                SvgElement::Path => StrokeElement::Path,
                SvgElement::Polyline => StrokeElement::Polyline,
            },
            marks: Marks {
                travel: self.png_show.contains(&PngMark::Travel),
                order: self.png_show.contains(&PngMark::Order),
            },
            resolution: match (self.dpi, self.png_width) {
                (_, Some(width)) => Resolution::WidthPx(width),
                (Some(dpi), None) => Resolution::Dpi(dpi),
                (None, None) => Resolution::default(),
            },
            threads: self.threads.map(usize::from),
            stats: self.stats,
            quiet: self.quiet,
            verbose: self.verbose,
            strict: self.strict,
        })
    }
}

impl PageArgs {
    pub(super) fn pen_width_mm(&self) -> f64 {
        self.pen_width
    }

    pub(super) fn options(&self) -> PageOptions {
        let unit_mm = match self.unit {
            LengthUnit::Mm => 1.0,
            LengthUnit::Cm => 10.0,
            LengthUnit::M => 1000.0,
            LengthUnit::In => 25.4,
        };
        PageOptions {
            paper: self.page,
            orientation: match (self.landscape, self.portrait) {
                (true, _) => Some(Orientation::Landscape),
                (_, true) => Some(Orientation::Portrait),
                _ => None,
            },
            margin_mm: self.margin,
            placement: match (self.drawing_scale, self.fit_fov) {
                (Some(scale), _) => Placement::Scale { mm_per_unit: scale * unit_mm },
                (None, true) => Placement::FieldOfView,
                (None, false) => Placement::Fit,
            },
        }
    }
}

impl InputFormat {
    fn format(self) -> ModelFormat {
        match self {
            Self::Obj => ModelFormat::Obj,
            Self::Stl => ModelFormat::Stl,
            Self::Ply => ModelFormat::Ply,
            Self::Off => ModelFormat::Off,
        }
    }
}
