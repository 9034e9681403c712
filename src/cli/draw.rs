//! `hiddenline draw`: from model files to a drawing in a file.

mod lines;
#[cfg(feature = "view")]
mod live;
mod many;

use std::error::Error;
use std::path::PathBuf;

use clap::Args;
use glam::DVec2;
use hiddenline::stages::camera::Camera;
use hiddenline::stages::drafting::{CROWDED_SHARE, Drafted};
use hiddenline::stages::draw::{DrawOptions, MeshSize, draw, draw_watched};
use hiddenline::stages::extent::Extent;
use hiddenline::stages::hatch::{Ground, HatchOptions, HatchPage, hatch, shadow_outlines};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::optimize::OptimizeOptions;
use hiddenline::stages::page::{
    Dash, LineWeights, PageOptions, PlotOptions, with_hatch_pen, with_line_pens,
};
use hiddenline::stages::shading::light::LightSource;
use hiddenline::stages::strokes::{StrokeKind, Strokes};
use hiddenline::stages::timing::timed;
use hiddenline::stages::write::Format;
use hiddenline::stages::write::dxf::DxfScale;

use self::lines::LineArgs;
#[cfg(feature = "view")]
pub(super) use self::live::{Live, Turned};
use self::many::{Many, ManyArgs};
use super::camera::{CameraArgs, ViewSource};
use super::hatch::{HatchArgs, LightArgs, with_remedy};
use super::messages::counted;
use super::models::{ModelArgs, ModelFiles};
use super::output::{OutputArgs, OutputOptions, check_place};
use super::page::{self, PageArgs};
use super::paper::{Notes, PlacedPage, Run};
use super::progress::Progress;
use super::scene::Subject;
use super::smooth::{SmoothArgs, Smoothing};
use super::{Refused, config, source};

const EXAMPLES: &str = "\
Examples:
  hiddenline draw bunny.stl -o bunny.svg
      A three-quarter view, fitted to a sheet of A4.
  hiddenline draw part.stl --view isometric --hidden dashed --page a3 -o part.svg
      An isometric drawing with hidden lines dashed, on their own layer.
  hiddenline draw house.obj --up-axis y --eye=-30,-40,12 --fov 50 -o house.png
      A PNG, seen from a given point. Numbers may be negative.
  hiddenline draw gear.stl --view top --drawing-scale 1:2 -o gear.svg
      True to scale, for a model in millimeters.
  hiddenline draw spot.obj --up-axis y --hatch --ground --light 1,-1,2 -o spot.svg
      Hatched, with its shadow on the ground.
  hiddenline draw box.stl lid.stl --move 0,0,0 --move 0,0,40 -o open.svg
      Two models, the second one lifted.
  cat part.stl | hiddenline draw - --input-format stl > part.svg
      From standard input to standard output.
  hiddenline draw cow.obj --turntable 36 -o 'frames/{stem}-{index:03}.svg'
      Frames of an animation, all at the same scale.
  hiddenline draw --each parts/*.stl -o 'out/{stem}.svg'
      A drawing of each model.";

/// Draw models as lines, with hidden lines removed
///
/// Reads OBJ, STL (text or binary), PLY, OFF, glTF (.gltf, .glb) and 3MF, and writes SVG for print
/// and pen plotters, PNG, or the strokes as JSON. Several models are drawn together as one scene. The
/// drawing is exact: what hides what is decided without rounding and without tolerances.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct DrawArgs {
    #[command(flatten)]
    model: ModelArgs,
    #[command(flatten)]
    smooth: SmoothArgs,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    lines: LineArgs,
    #[command(flatten)]
    hatch: HatchArgs,
    #[command(flatten)]
    light: LightArgs,
    #[command(flatten)]
    page: PageArgs,
    #[command(flatten)]
    many: ManyArgs,
    #[command(flatten)]
    output: OutputArgs,
}

/// What is to be done, with nothing left to check but what depends on the files.
pub(super) struct Job {
    files: ModelFiles,
    smoothing: Option<Smoothing>,
    view: ViewSource,
    /// Many drawings in place of one.
    many: Option<Many>,
    draw: DrawOptions,
    hatch: Option<HatchOptions>,
    light: LightSource,
    ground: Option<Ground>,
    page: PageOptions,
    unit_mm: f64,
    dxf_scale: DxfScale,
    pen_width_mm: f64,
    dash: Option<Dash>,
    weights: LineWeights,
    output: OutputOptions,
}

impl DrawArgs {
    /// Checks what clap cannot; the error is a message about usage. `idle` warns about options
    /// without effect.
    pub(super) fn job(self, idle: Vec<String>) -> Result<Job, Refused> {
        let Self { model, smooth, camera, lines, hatch, light, page, many, output } = self;
        let files = model.with(many.listed_models()?).files()?;
        let files = if lines.exact { files.with_equal_faces() } else { files };
        let files = files.in_unit(page.given_unit_mm());
        let mut output = output.options(lines.exact)?;
        output.warnings.extend(idle);
        output.warnings.extend(lines.without_effect(&output.plotting));
        let has_outlines = lines.lines.contains(StrokeKind::Shadow);
        output.warnings.extend(hatch.without_effect(has_outlines, &["--light", "--light-at"]));
        let inputs = files.inputs().chain(camera.input()).chain(many.inputs());
        let inputs: Vec<PathBuf> = inputs.chain(output.inputs.clone()).collect();
        let many = if many.are_used(output.path.as_deref()) {
            let path = output.path.as_deref();
            Some(many.drawings(files.clone(), camera.clone(), path, &inputs)?)
        } else {
            check_place(output.path.as_deref(), &inputs)?;
            None
        };
        let view = camera.view_source();
        let weights = lines.style.weights();
        let apart_by_kind = output.format == Format::Json
            || output.plotting.has_pens_by_kind()
            || weights.tells_kinds_apart();
        let (pen_width_mm, overlap_mm) = (page.pen_width_mm(), output.plotting.overlap_mm());
        let page_options = output.within_reach(page.options());
        let smoothing = smooth.smoothing(page_options, pen_width_mm).filter(|_| !lines.exact);
        Ok(Job {
            files,
            view,
            many,
            smoothing,
            page: page_options,
            unit_mm: page.unit_mm(),
            dxf_scale: page.dxf_scale(),
            pen_width_mm,
            dash: lines.dash,
            weights,
            draw: DrawOptions { apart_by_kind, ..lines.options(pen_width_mm, overlap_mm) },
            light: light.source(),
            ground: hatch.ground(),
            hatch: hatch.options(light.source()),
            output,
        })
    }
}

/// Does the job; the error is a message for the user.
pub(super) fn run(job: &Job) -> Result<(), Box<dyn Error>> {
    if let Some(many) = &job.many {
        return many::run(job, many);
    }
    let mut run = Run::start(&job.output)?;
    let read = |progress: &Progress| job.files.read(progress);
    let lines = Some(job.draw.lines);
    let Subject { scene, camera, notes } = Subject::read(
        read,
        &job.view,
        lines,
        !job.draw.exact,
        job.smoothing.as_ref(),
        &run.progress,
        &mut run.stats,
    )?;
    let extent = scene.extent(&camera);
    let (drawing, sheet) = strokes(job, &scene, camera, extent, notes, &mut run)?;
    drop(scene);
    run.draw(&drawing, &sheet, plot_options(job), &OptimizeOptions::for_drawings())
}

/// Draws the scene for a page that shows `extent`.
fn strokes(
    job: &Job,
    scene: &Scene,
    camera: Camera,
    extent: Extent,
    notes: Notes,
    run: &mut Run,
) -> Result<(Strokes, PlacedPage), Box<dyn Error>> {
    // Without --unit the page was made for millimeters.
    let unit_mm = notes.unit_mm.unwrap_or(1.0);
    let page = page::in_unit(job.page, unit_mm);
    run.notes.add(notes);
    run.unit_mm = job.unit_mm * unit_mm;
    run.dxf_scale = page::dxf_in_unit(job.dxf_scale, &page, unit_mm);
    run.progress.stage("drawing");
    let sheet = PlacedPage::new(extent, camera, &page)?;
    let mm_per_unit = sheet.page.mm_per_image_unit();
    let mut drawn = draw_watched(scene, &camera, &job.draw, mm_per_unit, &mut |share| {
        run.progress.share(share);
    });
    if job.draw.lines.contains(StrokeKind::Shadow) {
        run.progress.stage("finding shadows");
        let mm_per_unit = sheet.page.mm_per_image_unit();
        let outlines = timed(&mut drawn.seconds.visibility, || {
            shadow_outlines(scene, &camera, job.light, job.ground, &job.draw, mm_per_unit)
        });
        drawn.drawing.append(&outlines.map_err(|error| with_remedy(&error))?);
    }
    if let Some(options) = &job.hatch {
        run.progress.stage("hatching");
        let page =
            HatchPage::new(&sheet.page, job.output.plotting.hatch_width_mm(job.pen_width_mm));
        let hatched = timed(&mut drawn.seconds.visibility, || {
            hatch(scene, &camera, options, &job.draw, &page)
        });
        drawn.drawing.append(&hatched.map_err(|error| with_remedy(&error))?);
    }
    run.stats.count(MeshSize::of(scene));
    run.stats.add(&drawn);
    run.stats.drafted = (!job.draw.exact).then(|| drawn.drafted.into());
    run.notes.add(drafting_notes(&drawn.drafted, job.draw.thin_mm.is_some()));
    if drawn.drawing.is_empty() {
        run.empty_because = why_empty(job, scene, &sheet, drawn.n_lines);
    }
    Ok((drawn.drawing, sheet))
}

/// What finishing the lines on paper did, and what would help.
fn drafting_notes(drafted: &Drafted, is_thinned: bool) -> Notes {
    let mm = |length: f64| format!("{length:.0} mm");
    let done = [
        (
            drafted.n_joined > 0,
            format!(
                "{} joined across gaps up to {:.2} mm",
                counted(drafted.n_joined, "end", "ends"),
                drafted.farthest_mm
            ),
        ),
        (
            drafted.n_dropped > 0,
            format!(
                "{} ({}) left out",
                counted(drafted.n_dropped, "short stroke", "short strokes"),
                mm(drafted.dropped_mm)
            ),
        ),
        (
            drafted.overlap_mm >= 0.5,
            format!("{} of overlapping ink left out", mm(drafted.overlap_mm)),
        ),
        (drafted.thinned_mm >= 0.5, format!("{} thinned out", mm(drafted.thinned_mm))),
    ];
    let done: Vec<String> =
        done.into_iter().filter(|(is_told, _)| *is_told).map(|(_, text)| text).collect();
    let mut notes = Notes::default();
    if !done.is_empty() {
        notes.summary = format!("\nlines: {}", done.join(", "));
    }
    if !is_thinned && drafted.crowded_share > CROWDED_SHARE {
        let saved = drafted.thinnable_mm.map(|length| format!(" and saves {} of ink", mm(length)));
        notes.hints.push(format!(
            "{:.0} % of the ink is within a pen width of other ink; --thin leaves room between \
             lines{}",
            100.0 * drafted.crowded_share,
            saved.unwrap_or_default(),
        ));
    }
    notes
}

/// Why a drawing has no strokes, and what helps.
fn why_empty(job: &Job, scene: &Scene, sheet: &PlacedPage, n_lines: usize) -> String {
    let mm_per_unit = sheet.page.mm_per_image_unit();
    let all = DrawOptions { shortest_stroke_mm: 0.0, ..job.draw };
    let with_all = draw(scene, &sheet.camera, &all, mm_per_unit).drawing;
    if !with_all.is_empty() {
        let length = |points: &[DVec2]| points.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>();
        let longest = with_all.iter().map(|stroke| length(stroke.points)).fold(0.0, f64::max);
        return format!(
            "every stroke is shorter than --shortest-stroke {} mm, the longest {} mm; use a \
             larger --drawing-scale, the model's unit, as in --unit m, or a smaller \
             --shortest-stroke",
            job.draw.shortest_stroke_mm,
            brief(longest * mm_per_unit)
        );
    }
    if n_lines == 0 && sheet.extent.corners().is_some() {
        return "the model has no lines of the kinds selected; use other --lines".to_owned();
    }
    "nothing is in view".to_owned()
}

/// A number with at most three significant digits.
fn brief(number: f64) -> f64 {
    format!("{number:.2e}").parse().unwrap_or(number)
}

fn plot_options(job: &Job) -> PlotOptions {
    let pens = with_line_pens(
        job.weights.with_pens(job.output.plotting.pens(job.pen_width_mm), job.pen_width_mm),
        job.draw.lines,
        job.draw.hidden_levels,
        job.pen_width_mm,
    );
    let pens = if job.hatch.is_some() { with_hatch_pen(pens, job.pen_width_mm) } else { pens };
    PlotOptions {
        pen_width_mm: job.pen_width_mm,
        hidden: job.draw.hidden,
        dash: job.dash,
        keep_dashes_whole: job.output.keeps_dashes_whole,
        title: job.files.title(),
        pens: job.output.plotting.with_kinds_apart(pens, job.pen_width_mm),
        source: source::source(config::arguments()),
    }
}
