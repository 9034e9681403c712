//! `hiddenline optimize`: turns the lines of any SVG into a file for a plotter.

use std::error::Error;
use std::io::{self, IsTerminal, Read};
use std::path::{Path, PathBuf};

use clap::Args;
use hiddenline::stages::optimize::{OptimizeOptions, near_overlap};
use hiddenline::stages::page::{Crop, PenRole, RefitOptions, refit};
use hiddenline::stages::plot::Plot;
use hiddenline::stages::read_svg::{self, SvgOptions};
use hiddenline::stages::timing::timed;
use hiddenline::stages::write::Format;

use super::choice::one_of;
use super::machine;
use super::messages::counted;
use super::output::{OutputArgs, OutputOptions, check_place};
use super::page::PaperArgs;
use super::paper::{Notes, Run};
use super::paths::{is_dash, title};
use super::{Refused, config, source, values};

const EXAMPLES: &str = "\
Examples:
  hiddenline optimize drawing.svg -o ready.svg
      The same lines, joined into fewer strokes and ordered for short pen-up travel.
  hiddenline optimize drawing.svg --optimize best --machine hp7475a -o drawing.plt
      For a pen plotter.
  vpype read a.svg linesimplify write - | hiddenline optimize - -o ready.gcode
      From standard input to a GRBL machine with a pen servo.";

/// Join and order the strokes of any line SVG for a plotter
///
/// Reads paths, lines, polygons, circles and so on, with transforms, units and layers; curves become
/// chords. Each layer, and each color in it, is a pen. Ink that lies on other ink of the same pen is
/// drawn once. The output may be the input file: it is replaced once everything is done.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct OptimizeArgs {
    /// SVG file to read; `-` is standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Maximum distance between a curve and its chords
    #[arg(long, value_name = "MM", value_parser = values::positive_length, default_value = "0.02")]
    tolerance: f64,
    /// Drop strokes shorter than this, and close strokes whose ends are closer than this
    #[arg(long, value_name = "MM", value_parser = values::length, default_value = "0")]
    shortest_stroke: f64,
    /// Let opaque fills hide the ink below them; a filled shape without a stroke only hides
    #[arg(long)]
    occlude: bool,
    #[command(flatten)]
    sheet: PlacingArgs,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Args)]
#[command(next_help_heading = "Page")]
struct PlacingArgs {
    #[command(flatten)]
    paper: PaperArgs,
    /// Scale the drawing to fill the space between the margins, centered
    #[arg(long)]
    fit: bool,
    /// Center the drawing on the sheet
    #[arg(long)]
    center: bool,
    /// Where to crop ink; --margin applies to this and to --fit
    #[arg(long, value_name = "WHERE", value_parser = one_of::<Crop>())]
    #[arg(default_value = Crop::Page.name())]
    crop: Crop,
}

impl PlacingArgs {
    fn options(&self) -> RefitOptions {
        RefitOptions {
            paper: self.paper.paper(),
            orientation: self.paper.orientation(),
            margin_mm: self.paper.margin_mm().unwrap_or(0.0),
            fit: self.fit,
            center: self.center,
            crop: self.crop,
        }
    }
}

/// Checked options.
pub(super) struct Job {
    file: PathBuf,
    svg: SvgOptions,
    sheet: RefitOptions,
    shortest_mm: f64,
    output: OutputOptions,
}

impl OptimizeArgs {
    /// Checks what clap cannot; `idle` warns about options without effect.
    pub(super) fn job(self, idle: Vec<String>) -> Result<Job, Refused> {
        let mut output = self.output.options(false)?;
        output.warnings.extend(idle);
        if output.format == Format::Json {
            return Err("JSON is for drawings of models; choose another format".into());
        }
        let pens = output.plotting.pens(hiddenline::stages::page::DEFAULT_PEN_WIDTH_MM);
        if pens.iter().any(|rule| rule.drawn != PenRole::Visible) {
            return Err(
                "an SVG already has its pens; --pen only accepts `visible`, which puts all \
             lines on one pen"
                    .into(),
            );
        }
        check_place(output.path.as_deref(), &output.inputs)?;
        // An SVG may be replaced by its own optimized version: it is read completely before that.
        if output.format != Format::Svg {
            check_place(output.path.as_deref(), [&self.file])?;
        }
        Ok(Job {
            file: self.file,
            svg: SvgOptions {
                tolerance_mm: self.tolerance,
                occlude: self.occlude,
                ..SvgOptions::default()
            },
            sheet: self.sheet.options(),
            shortest_mm: self.shortest_stroke,
            output,
        })
    }
}

/// Runs the command; the error is a message for the user.
pub(super) fn run(job: &Job) -> Result<(), Box<dyn Error>> {
    let mut run = Run::start(&job.output)?;
    if is_dash(&job.file) && io::stdin().is_terminal() {
        return Err("standard input is the terminal; name a file, or pipe an SVG into it".into());
    }
    run.progress.stage("reading");
    let name = title(&job.file);
    let read = timed(&mut run.stats.seconds.read, || -> Result<_, Box<dyn Error>> {
        let bytes = read_bytes(&job.file).map_err(|error| format!("{name}: {error}"))?;
        Ok(read_svg::read_bytes(&bytes, &job.svg).map_err(|error| format!("{name}: {error}"))?)
    })?;
    let mut plot = read.plot;
    for rule in job.output.plotting.pens(hiddenline::stages::page::DEFAULT_PEN_WIDTH_MM) {
        let mut lines = hiddenline::stages::plot::Polylines::default();
        for line in plot.layers.iter().flat_map(|layer| layer.lines.iter()) {
            lines.push(line.iter().copied());
        }
        let name = rule.drawn.name().into_owned();
        plot.layers = vec![hiddenline::stages::plot::Layer {
            number: rule.number,
            label: rule.controls.label(rule.number, &name),
            name,
            pen: rule.pen,
            lines,
            ..Default::default()
        }];
    }
    let n_read = n_strokes(&plot);
    let mut warnings: Vec<String> =
        read.warnings.iter().map(|warning| in_file(&name, warning)).collect();
    let sheet = match job.output.plotter() {
        // `--fit` fits the drawing into what the pen can reach.
        Some(machine) if job.sheet.fit => {
            let paper = job
                .sheet
                .paper
                .map_or([plot.width_mm, plot.height_mm], |paper| [paper.width_mm, paper.height_mm]);
            let border_mm = machine.unreachable_border_mm(paper[0], paper[1]).unwrap_or(0.0);
            RefitOptions { margin_mm: job.sheet.margin_mm.max(border_mm), ..job.sheet }
        }
        _ => job.sheet,
    };
    let cropped = refit(plot, &sheet)?;
    warnings.extend(machine::lost_ink(&cropped).map(|lost| {
        let border = if job.sheet.crop == Crop::Margin { "margins" } else { "page" };
        format!(
            "{lost} cut off outside of the {border}; --fit brings all of it onto the page, \
             --crop none keeps it where it is"
        )
    }));
    let mut plot = cropped.plot;
    if let Some(machine) = job.output.plotter()
        && !job.output.plotting.has_pens()
    {
        machine.assign_pens(&mut plot).map_err(|error| {
            format!(
                "{name}: {error}; use --pen visible=1 to draw everything with one pen, or hide \
                 layers by labels that begin with %"
            )
        })?;
    }
    let hint = match job.output.plotting.overlap_mm() {
        None => near_overlap(&plot).map(|found| {
            format!(
                "\nhint: {:.1} mm of ink lie within {} mm of other ink; --overlap-tolerance {1} \
                 leaves them out",
                found.saved_mm, found.tolerance_mm
            )
        }),
        Some(_) => None,
    };
    if plot.title.is_empty() {
        plot.title = name.clone();
    }
    plot.source = source::source(config::arguments());
    run.stats.strokes = n_strokes(&plot);
    run.empty_because = why_empty(job, n_read, run.stats.strokes);
    run.stats.points = plot.layers.iter().map(|layer| layer.lines.n_points()).sum();
    run.notes.add(Notes {
        warnings,
        summary: format!(
            "{name}: {}, {}{}",
            counted(run.stats.strokes, "stroke", "strokes"),
            counted(run.stats.points, "point", "points"),
            hint.unwrap_or_default()
        ),
        ..Notes::default()
    });
    let paper = format!("{} x {} mm", tenths(plot.width_mm), tenths(plot.height_mm));
    let usual = OptimizeOptions { shortest_mm: job.shortest_mm, ..OptimizeOptions::default() };
    run.plot(&paper, plot, &usual)
}

fn n_strokes(plot: &Plot) -> usize {
    plot.layers.iter().map(|layer| layer.lines.len()).sum()
}

/// Why nothing is left to draw, if that happens: `n_read` strokes were read and `n_kept` of them lie on
/// the page.
fn why_empty(job: &Job, n_read: usize, n_kept: usize) -> String {
    match (n_read, n_kept, job.sheet.crop) {
        (0, ..) => "the SVG has no visible strokes".to_owned(),
        (_, 0, Crop::Margin) => "every stroke lies outside of the margins".to_owned(),
        (_, 0, _) => "every stroke lies outside of the page".to_owned(),
        _ => format!("every stroke is shorter than --shortest-stroke {} mm", job.shortest_mm),
    }
}

fn tenths(mm: f64) -> f64 {
    (mm * 10.0).round() / 10.0
}

fn read_bytes(path: &Path) -> io::Result<Vec<u8>> {
    if !is_dash(path) {
        return std::fs::read(path);
    }
    let mut bytes = Vec::new();
    io::stdin().lock().read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// A message about a file, with the line, if it begins with one.
fn in_file(name: &str, message: &str) -> String {
    match message.strip_prefix("line ").and_then(|rest| rest.split_once(": ")) {
        Some((line, message)) => format!("{name}:{line}: {message}"),
        None => format!("{name}: {message}"),
    }
}
