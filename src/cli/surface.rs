//! `hiddenline surface`: from formulas, heights or points to a drawing in a file.

mod args;
mod axes_args;
mod input;
mod input_args;
mod legend_args;
#[cfg(feature = "view")]
mod live;

use std::error::Error;

use hiddenline::stages::draw::DEFAULT_SHORTEST_STROKE_MM;
use hiddenline::stages::draw::surface::{
    NoLevels, SurfaceError, SurfaceLines, SurfaceNote, draw_surface_watched,
};
use hiddenline::stages::hatch::{HatchOptions, hatch_surface};
use hiddenline::stages::optimize::{Effort, OptimizeOptions};
use hiddenline::stages::page::{
    PageOptions, PlotOptions, with_hatch_pen, with_index_pen, with_underside_pen,
};
use hiddenline::stages::strokes::HiddenLines;
use hiddenline::stages::surface::Surface;
use hiddenline::stages::timing::timed;
use hiddenline::stages::write::Format;

pub(super) use self::args::SurfaceArgs;
pub(super) use self::axes_args::AxesArgs;
pub(super) use self::input::SurfaceInput;
use self::input::with_samples;
pub(super) use self::input_args::SurfaceInputArgs;
#[cfg(feature = "view")]
pub(super) use self::live::LiveSurface;
use super::camera::{ViewSource, with_remedy};
use super::output::OutputOptions;
use super::paper::{PlacedPage, Run, page_error};
use super::{config, hatch as hatching, source};
use hiddenline::stages::write::dxf::DxfScale;

/// What is to be done.
pub(super) struct Job {
    sheets: SurfaceInput,
    view: ViewSource,
    lines: SurfaceLines,
    hatch: Option<HatchOptions>,
    page: PageOptions,
    unit_mm: f64,
    dxf_scale: DxfScale,
    pen_width_mm: f64,
    output: OutputOptions,
}

/// Does the job; the error is a message for the user.
pub(super) fn run(job: &Job) -> Result<(), Box<dyn Error>> {
    let mut run = Run::start(&job.output)?;
    run.unit_mm = job.unit_mm;
    run.dxf_scale = job.dxf_scale;
    run.progress.stage("reading");
    let warnings = &mut run.notes.warnings;
    let surface = timed(&mut run.stats.seconds.read, || job.sheets.read(warnings))?;
    draw(job, &surface, run)
}

/// Draws the surface and ends the run.
fn draw(job: &Job, surface: &Surface, mut run: Run) -> Result<(), Box<dyn Error>> {
    let warnings = &mut run.notes.warnings;
    let view = job.view.framing()?;
    run.progress.stage("drawing");
    let watch = &mut |share| run.progress.share(share);
    let drawing = draw_surface_watched(surface, &view, &job.lines, &job.page, watch);
    let mut drawing = drawing.map_err(|error| failed(job, &error))?;
    if let Some(options) = &job.hatch {
        run.progress.stage("hatching");
        let width_mm = job.output.plotting.hatch_width_mm(job.pen_width_mm);
        let mut seconds = 0.0;
        let hatched =
            timed(&mut seconds, || hatch_surface(&drawing, options, job.lines.exact, width_mm));
        drawing.drawn.seconds.visibility += seconds;
        drawing.drawn.drawing.append(&hatched.map_err(|error| hatching::with_remedy(&error))?);
        (drawing.scene, drawing.is_ordered) = (None, false);
    }
    warnings.extend(drawing.notes.iter().map(noted));
    let is_json = job.output.format == Format::Json;
    if let Some(every) = drawing.crowded(job.pen_width_mm).filter(|_| !is_json) {
        warnings.push(format!("lines run into each other; --every {every} draws fewer"));
    }
    if drawing.drawn.drawing.is_empty() && drawing.extent.corners().is_some() {
        run.empty_because = format!(
            "every line of the kinds selected is hidden or shorter than \
             {DEFAULT_SHORTEST_STROKE_MM} mm; use other --lines or a larger --drawing-scale"
        );
    }
    run.stats.count(drawing.size);
    run.stats.add(&drawing.drawn);
    run.notes.summary = format!("{}: {}", job.sheets.title(), drawing.samples);
    if let Some(certificate) = drawing.certificate {
        run.stats.certified = Some(certificate.into());
        if certificate.holds() {
            run.notes.summary.push_str(&format!("; {certificate}"));
        }
    }
    let usual = OptimizeOptions::for_drawings();
    let usual = if drawing.is_ordered {
        OptimizeOptions { join_tolerance_mm: None, effort: Effort::None, ..usual }
    } else {
        usual
    };
    let sheet = PlacedPage {
        camera: drawing.camera,
        page: drawing.page,
        extent: drawing.extent,
        options: job.page,
    };
    let plot = plot_options(job, drawing.has_index_levels);
    run.draw(drawing.drawn.drawing, &sheet, plot, &usual)
}

/// Why the surface cannot be drawn, with the options that mend it.
fn failed(job: &Job, error: &SurfaceError) -> String {
    match error {
        SurfaceError::Sampling(error) => job.sheets.sampling_error(error),
        SurfaceError::View(error) => with_remedy(error),
        SurfaceError::NoCells => with_samples(error),
        SurfaceError::TooManyLevels(_) => format!("{error}; use a larger step for --levels"),
        SurfaceError::TooManyTriangles(_) => format!("{error}; use fewer --samples or --levels"),
        SurfaceError::NoLevels(none) => {
            format!("{}; --lines both draws grid lines", without_levels(none))
        }
        SurfaceError::OneFamily => format!("{error}: use --lines x or --lines y"),
        SurfaceError::OneGrid => format!("{error}: use --engine roberts or auto"),
        SurfaceError::MaxMin | SurfaceError::NearPlane => format!("{error}: use --engine auto"),
        SurfaceError::Page(_) | SurfaceError::Frame => axes_error(error),
        SurfaceError::Order => "--order needs one surface z = f(x, y) over a rectangle without \
                                holes, drawn with grid lines only: leave --order out"
            .to_owned(),
        _ => error.to_string(),
    }
}

/// Why axes cannot be drawn, with the options that mend it.
pub(super) fn axes_error(error: &SurfaceError) -> String {
    match error {
        SurfaceError::Page(error) => page_error(error),
        SurfaceError::Frame => format!("{error}: use --view top or other --axes"),
        _ => error.to_string(),
    }
}

/// What is worth knowing about a drawing, with the options that help.
pub(super) fn noted(note: &SurfaceNote) -> String {
    match note {
        SurfaceNote::Uncertified(_) => format!("{note}: more --samples"),
        SurfaceNote::NoLevels(none) => without_levels(none),
        SurfaceNote::LittleRoom => {
            format!(
                "{note}; a larger --page, a smaller --text-height or shorter --axis-titles help"
            )
        }
        SurfaceNote::TooManyTicks => format!("{note}; use a larger --tick-step"),
        _ => note.to_string(),
    }
}

fn without_levels(none: &NoLevels) -> String {
    match none {
        NoLevels::OutOfRange { low, high } => {
            format!(
                "the surface has heights from {low} to {high}: none of the --levels is in this \
                 range"
            )
        }
        NoLevels::Level { .. } => none.to_string(),
    }
}

fn plot_options(job: &Job, has_index: bool) -> PlotOptions {
    let has_legend = job.lines.legend.is_some();
    let pens = job.sheets.pens(&job.output.plotting, job.pen_width_mm, has_legend);
    let pens = if job.lines.underside { with_underside_pen(pens, job.pen_width_mm) } else { pens };
    let pens = if has_index { with_index_pen(pens, job.pen_width_mm) } else { pens };
    let pens = if job.hatch.is_some() { with_hatch_pen(pens, job.pen_width_mm) } else { pens };
    PlotOptions {
        pen_width_mm: job.pen_width_mm,
        hidden: HiddenLines::None,
        dash: None,
        keep_dashes_whole: false,
        title: job.sheets.title(),
        pens: job.output.plotting.with_kinds_apart(pens, job.pen_width_mm),
        source: source::source(config::arguments()),
    }
}
