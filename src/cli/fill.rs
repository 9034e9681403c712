//! `hiddenline fill`: from model files to filled areas on a page.

mod areas;

use std::error::Error;
use std::path::{Path, PathBuf};

use clap::Args;
use hiddenline::stages::axes::{Axes, AxesBox};
use hiddenline::stages::camera::Camera;
use hiddenline::stages::classify::{DEFAULT_CREASE_DEG, LineSelection};
use hiddenline::stages::draw::surface::{Surroundings, surround};
use hiddenline::stages::draw::{DrawOptions, MeshSize, draw};
use hiddenline::stages::engines::face::{FaceEngine, FaceError, Prepared};
use hiddenline::stages::extent::Extent;
use hiddenline::stages::hatch::{HatchOptions, HatchPage, hatch};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::optimize::OptimizeOptions;
use hiddenline::stages::page::{PageOptions, PlotOptions, with_hatch_pen};
use hiddenline::stages::plot::Layer;
use hiddenline::stages::read::material_colors;
use hiddenline::stages::shading::fill::{FillError, FillOptions, Filled, fill_prepared_watched};
use hiddenline::stages::shading::white::paint_over;
use hiddenline::stages::strokes::Strokes;
use hiddenline::stages::surface::DEFAULT_SAMPLES;
use hiddenline::stages::timing::timed;
use hiddenline::stages::write::NoFills;

use self::areas::AreaArgs;
use super::camera::{CameraArgs, ViewSource};
use super::hatch::{self as hatching, HatchArgs};
use super::input::{Input, InputArgs};
use super::messages::counted;
use super::output::{OutputArgs, OutputOptions, check_place};
use super::page::{self, PageArgs};
use super::paper::{Run, placed};
use super::progress::Progress;
use super::scene::Subject;
use super::smooth::{SmoothArgs, Smoothing};
use super::surface::{AxesArgs, axes_error, noted};
use super::{Refused, config, source, values};

const EXAMPLES: &str = "\
Examples:
  hiddenline fill part.stl -o part.svg
      Shaded faces with the visible edges on top.
  hiddenline fill house.obj --palette 4 -o house.pdf
      In four grays, each on its own layer.
  hiddenline fill spot.obj --up-axis y --palette navy,orange,ivory --light 1,-1,2 -o spot.svg
      In three inks, lit from the right.
  hiddenline fill shapes.stl --engine weiler-atherton --seam 0 --no-edges -o cut.svg
      Exact regions side by side, for a cutter.
  hiddenline fill part.stl --depth-cue 0.6 --no-edges -o part.png
      Distant faces fade.
  hiddenline fill house.obj --white -o house.pdf
      The lines of `draw`, hidden ones painted over in white.
  hiddenline fill part.stl --turntable 24 -o turn.svg
      turn-001.svg to turn-024.svg, once around.
  hiddenline fill --expr \"sinc(r)\" --x=-9:9 --y=-9:9 --palette 5 -o hat.svg
      A surface z = f(x, y) in five grays.";

// Only these formats have filled areas.
const OUTPUT_HELP: &str = "\
File to write, in the format given by its extension; `-` is standard output

.svg; .pdf; .png";
const FORMAT_HELP: &str =
    "Format of the output: svg, pdf or png [default: by extension; svg on standard output]";

/// Fill the visible faces of models with color
///
/// Takes the same models and the same camera as `draw`, and writes filled areas for print as SVG, PDF or
/// PNG, with the lines of `draw` on top, on their own layer.
#[derive(Args)]
#[command(
    after_help = EXAMPLES,
    mut_arg("output", |arg| arg.long_help(OUTPUT_HELP)),
    mut_arg("format", |arg| arg.help(FORMAT_HELP).hide_possible_values(true)),
)]
pub(super) struct FillArgs {
    #[command(flatten)]
    input: InputArgs,
    #[command(flatten)]
    smooth: SmoothArgs,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    areas: AreaArgs,
    #[command(flatten)]
    edges: EdgeArgs,
    #[command(flatten)]
    hatch: HatchArgs,
    #[command(flatten)]
    axes: AxesArgs,
    #[command(flatten)]
    page: PageArgs,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Args)]
#[command(next_help_heading = "Edges")]
struct EdgeArgs {
    /// Draw the visible edges on top; this is the default
    #[arg(long, overrides_with = "no_edges")]
    edges: bool,
    /// Draw areas only
    #[arg(long, overrides_with = "edges")]
    no_edges: bool,
    /// Kinds of lines to draw on top, as for `draw`
    #[arg(long, value_name = "KINDS", value_parser = values::KindsOfLine, hide_possible_values = true)]
    #[arg(default_value = "silhouette,crease,boundary,nonmanifold,intersection,wire")]
    lines: LineSelection,
    /// Faces that meet at more than this angle form a crease
    #[arg(long, value_name = "DEG", value_parser = values::crease)]
    #[arg(default_value_t = DEFAULT_CREASE_DEG)]
    crease: f64,
}

/// What is to be done.
pub(super) struct Job {
    input: Input,
    smoothing: Option<Smoothing>,
    view: ViewSource,
    fill: FillOptions,
    leaf_mm: f64,
    seam_mm: f64,
    turntable: Option<u16>,
    /// `None` for areas only.
    edges: Option<DrawOptions>,
    /// What is hatched on top.
    hatch: Option<HatchOptions>,
    /// What is drawn around a surface.
    axes: Option<Axes>,
    /// Whether hidden edges are painted over instead of left out.
    paints_over: bool,
    page: PageOptions,
    pen_width_mm: f64,
    output: OutputOptions,
}

impl FillArgs {
    /// Checks what clap cannot; the error is a message about usage. `idle` warns about options
    /// without effect.
    pub(super) fn job(self, idle: Vec<String>) -> Result<Job, Refused> {
        let Self { input, smooth, camera, areas, edges, hatch, axes, page, output } = self;
        let input = input.input(DEFAULT_SAMPLES)?.in_unit(page.given_unit_mm());
        let mut output = output.options(false)?;
        output.warnings.extend(hatch.without_effect(false, &[]));
        output.warnings.extend(idle);
        if !output.format.has_fills() && (edges.no_edges || areas.white) {
            let error = NoFills(output.format);
            return Err(format!(
                "{error}; use another --format, or draw lines with `hiddenline draw`"
            )
            .into());
        }
        if areas.turntable.is_some() && output.path.is_none() {
            return Err("--turntable makes several files; use -o FILE".into());
        }
        let view = camera.view_source();
        let inputs = input.inputs().chain(view.input()).chain(output.inputs.clone());
        let inputs: Vec<PathBuf> = inputs.collect();
        check_place(output.path.as_deref(), &inputs)?;
        for number in 1..=areas.turntable.map_or(0, u32::from) {
            let path = output.path.as_deref().map(|path| numbered(path, number));
            check_place(path.as_deref(), &inputs)?;
        }
        let pen_width_mm = page.pen_width_mm();
        let page_options = output.within_reach(page.options());
        let lines = DrawOptions {
            lines: edges.lines,
            crease_deg: edges.crease,
            pen_width_mm,
            ..Default::default()
        };
        if areas.white && edges.lines.has_outline() {
            return Err("--white draws whole edges; leave outline out of --lines".into());
        }
        let fill = areas.options();
        let hatch = hatch.options(fill.light);
        if areas.white && !paints_over(fill.engine) {
            let name = fill.engine.name();
            return Err(format!(
                "{name} does not paint faces over each other; with --white use --engine bsp, \
                 depth-sort or octree"
            )
            .into());
        }
        fill.check().map_err(|error| error.to_string())?;
        Ok(Job {
            input,
            smoothing: smooth.smoothing(page_options, pen_width_mm),
            view,
            fill,
            leaf_mm: areas.leaf.unwrap_or(pen_width_mm),
            seam_mm: areas.seam,
            turntable: areas.turntable,
            edges: (!edges.no_edges).then_some(lines),
            hatch,
            axes: axes.axes(pen_width_mm)?.filter(|_| areas.turntable.is_none()),
            paints_over: areas.white,
            page: page_options,
            pen_width_mm,
            output,
        })
    }
}

/// Does the job; the error is a message for the user.
pub(super) fn run(job: &Job) -> Result<(), Box<dyn Error>> {
    let mut run = Run::start(&job.output)?;
    let read = |progress: &Progress| job.input.mesh(progress);
    let lines = job.edges.map(|edges| edges.lines);
    let Subject { scene, camera, notes } = Subject::read(
        read,
        &job.view,
        lines,
        lines.is_some(),
        job.smoothing.as_ref(),
        &run.progress,
        &mut run.stats,
    )?;
    // Without --unit the page was made for millimeters.
    let page = page::in_unit(job.page, notes.unit_mm.unwrap_or(1.0));
    let bounds = notes.axes_box;
    run.notes.add(notes);
    let mut fill = job.fill.clone();
    for path in job.input.models() {
        let found = material_colors(path);
        fill.materials.push(found.colors);
        run.notes.warnings.extend(found.warnings);
    }
    run.progress.stage("preparing");
    let prepared = timed(&mut run.stats.seconds.visibility, || Prepared::new(&scene, fill.engine))
        .map_err(|error| with_remedy(&error.into(), job))?;
    run.stats.engine = prepared.engine().name().into();
    run.stats.count(MeshSize::of(&scene));
    let Some(n) = job.turntable else {
        let picture =
            Picture { job, page, scene: &scene, prepared: &prepared, fill, frame: None, bounds };
        return picture.write(&camera, run, job.output.path.as_deref());
    };
    let Run {
        output, start, progress, stats, mut notes, unit_mm, empty_because, dxf_scale, ..
    } = run;
    drop(progress);
    let cameras = camera.turntable(n.into())?;
    let frame = Some(scene.extent_of_views(&cameras));
    let picture = Picture { job, page, scene: &scene, prepared: &prepared, fill, frame, bounds };
    for (number, camera) in (1..).zip(&cameras) {
        let notes = std::mem::take(&mut notes);
        let progress = Progress::new(output.quiet);
        let empty_because = empty_because.clone();
        let run = Run {
            output,
            start,
            progress,
            stats: stats.clone(),
            notes,
            unit_mm,
            empty_because,
            dxf_scale,
            kept: None,
        };
        let path = output.path.as_deref().map(|path| numbered(path, number));
        picture.write(camera, run, path.as_deref())?;
    }
    Ok(())
}

/// What all pictures of a turntable have in common.
struct Picture<'a> {
    job: &'a Job,
    page: PageOptions,
    scene: &'a Scene,
    prepared: &'a Prepared<'a>,
    fill: FillOptions,
    /// What is fitted to the page; `None` for what the camera sees.
    frame: Option<Extent>,
    /// What axes go around.
    bounds: Option<AxesBox>,
}

impl Picture<'_> {
    fn write(
        &self,
        camera: &Camera,
        mut run: Run,
        path: Option<&Path>,
    ) -> Result<(), Box<dyn Error>> {
        let Self { job, page, scene, .. } = self;
        run.progress.stage("filling");
        let mut options = self.fill.clone();
        let extent = self.frame.unwrap_or_else(|| scene.extent(camera));
        let around = match job.axes.as_ref().zip(self.bounds.as_ref()) {
            Some((axes, bounds)) => {
                let wanted = Surroundings { axes: Some(axes), legend: None };
                let around = surround(bounds, extent, camera, wanted, page);
                let (around, _, page) = around.map_err(|error| axes_error(&error))?;
                run.notes.warnings.extend(around.notes.iter().map(noted));
                Some((around, page))
            }
            None => None,
        };
        let page = match &around {
            Some((_, page)) => *page,
            None => placed(&extent, camera, page)?,
        };
        options.settings.leaf = Some(job.leaf_mm / page.mm_per_image_unit());
        let filled: Filled = timed(&mut run.stats.seconds.visibility, || match &job.edges {
            Some(edges) if job.paints_over => {
                let DrawOptions { lines, crease_deg, .. } = *edges;
                let (prepared, settings) = (self.prepared, &options.settings);
                let picture = paint_over(prepared, camera, settings, lines, crease_deg)?;
                run.notes.warnings.extend(left_out(picture.n_left_out));
                Ok(picture.filled)
            }
            _ => {
                let watch = &mut |share| run.progress.share(share);
                fill_prepared_watched(self.prepared, camera, &options, watch)
            }
        })
        .map_err(|error| with_remedy(&error, job))?;
        run.progress.stage("drawing");
        let mut edges = Strokes::default();
        if let Some(options) = job.edges.as_ref().filter(|_| !job.paints_over) {
            let drawn = draw(scene, camera, options, page.mm_per_image_unit());
            run.stats.add(&drawn);
            edges = drawn.drawing;
        }
        if let Some(options) = &job.hatch {
            run.progress.stage("hatching");
            let width_mm = job.output.plotting.hatch_width_mm(job.pen_width_mm);
            let paper = HatchPage::new(&page, width_mm);
            let lines = job.edges.unwrap_or_default();
            let hatched = timed(&mut run.stats.seconds.visibility, || {
                hatch(scene, camera, options, &lines, &paper)
            });
            edges.append(&hatched.map_err(|error| hatching::with_remedy(&error))?);
        }
        if !edges.is_empty() {
            run.notes.warnings.extend(job.output.plotting.idle_pens(&edges, true));
        }
        if let Some((around, _)) = around {
            edges.append(&around.with_wires(scene, camera));
        }
        run.stats.counts.fill = filled.work;
        run.stats.engine = filled.engine.name().into();
        let pens = job.output.plotting.pens(job.pen_width_mm);
        let pens = match job.hatch {
            Some(_) => with_hatch_pen(pens, job.pen_width_mm),
            None => pens,
        };
        let options = PlotOptions {
            pen_width_mm: job.pen_width_mm,
            pens,
            hidden: Default::default(),
            dash: Default::default(),
            keep_dashes_whole: false,
            title: job.input.title(),
            source: source::source(config::arguments()),
        };
        let format = job.output.format;
        let layers = if format.has_fills() { &filled.layers[..] } else { &[] };
        if !format.has_fills() {
            let n = filled.layers.iter().map(|layer| layer.fills.len()).sum();
            let areas = counted(n, "area is", "areas are");
            run.notes
                .warnings
                .push(format!("{} holds lines only: {areas} left out", format.name()));
        }
        let mut placed = page.plot(&edges, options).with_fills(&page, layers, job.seam_mm);
        if job.edges.is_none() || job.paints_over {
            let is_drawn = |layer: &Layer| !layer.fills.is_empty() || !layer.lines.is_empty();
            placed.plot.layers.retain(is_drawn);
        }
        if placed.cropped {
            run.empty_because = "all of it lies beyond the margins".to_owned();
            run.notes.warnings.push("the picture was cut off at the margins".into());
        }
        run.plot_to(path, &page.paper.description(), placed.plot, &OptimizeOptions::for_drawings())
    }
}

/// What to say of lines that no painted face carries.
fn left_out(n: usize) -> Option<String> {
    let lines = counted(n, "line is on", "lines are on");
    (n > 0).then(|| {
        format!(
            "{lines} no painted face (where faces cross, wires, faces seen edge-on) and left out; \
             `hiddenline draw` draws them"
        )
    })
}

/// What went wrong and how to mend it.
fn with_remedy(error: &FillError, job: &Job) -> String {
    let FillError::Engine(cause) = error else { return error.to_string() };
    if matches!(cause, FaceError::TooManyLeaves { .. }) {
        return format!("{error}; use a larger --leaf");
    }
    let is_possible = |engine: &&FaceEngine| {
        **engine != job.fill.engine && (!job.paints_over || paints_over(**engine))
    };
    let names: Vec<&str> =
        cause.instead().iter().filter(is_possible).map(|engine| engine.name()).collect();
    match names[..] {
        [] => format!("{error}; use a simpler model, or draw lines with `hiddenline draw`"),
        _ => format!("{error}; use --engine {}", names.join(" or ")),
    }
}

/// Whether an engine paints faces over each other, from far to near.
fn paints_over(engine: FaceEngine) -> bool {
    matches!(engine, FaceEngine::DepthSort | FaceEngine::Bsp | FaceEngine::Octree)
}

/// `NAME.svg` to `NAME-001.svg`.
fn numbered(path: &Path, number: u32) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let name = match path.extension() {
        Some(extension) => format!("{stem}-{number:03}.{}", extension.to_string_lossy()),
        None => format!("{stem}-{number:03}"),
    };
    path.with_file_name(name)
}
