//! `hiddenline optimize`: from the lines of any SVG to a file for a plotter.

use std::error::Error;
use std::io::{self, IsTerminal, Read};
use std::path::{Path, PathBuf};

use clap::Args;
use hiddenline::optimize::Options;
use hiddenline::page::Drawn;
use hiddenline::read_svg;
use hiddenline::timing::timed;
use hiddenline::write::Format;

use super::messages::counted;
use super::output::{OutputArgs, OutputOptions, check_place};
use super::paper::{Notes, Run};
use super::paths::{is_dash, title};
use super::{Refused, config, source, values};

const EXAMPLES: &str = "\
Examples:
  hiddenline optimize drawing.svg -o ready.svg
      The same lines, joined into fewer strokes, in an order with short ways between them.
  hiddenline optimize drawing.svg --optimize best --machine hp7475a -o drawing.plt
      For a pen plotter.
  vpype read a.svg linesimplify write - | hiddenline optimize - -o ready.gcode
      From standard input to a machine with GRBL and a servo.";

/// Join and order the strokes of any line SVG for a plotter
///
/// Reads paths, lines, polygons, circles and the like with transforms, units and layers; curves
/// become chords. Each Inkscape layer and each color in it is a pen. Ink that lies on other ink of
/// its pen is drawn once. The output may be the file that is read: it is replaced when all is done.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct OptimizeArgs {
    /// SVG file to read; `-` is standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// How far chords may be from the curves they stand for
    #[arg(long, value_name = "MM", value_parser = values::positive_length, default_value = "0.02")]
    tolerance: f64,
    /// Drop strokes shorter than this, and close those whose ends are this close
    #[arg(long, value_name = "MM", value_parser = values::length, default_value = "0")]
    shortest_stroke: f64,
    #[command(flatten)]
    output: OutputArgs,
}

/// What is to be done.
pub(super) struct Job {
    file: PathBuf,
    tolerance_mm: f64,
    shortest_mm: f64,
    output: OutputOptions,
}

impl OptimizeArgs {
    /// Checks what clap cannot.
    pub(super) fn job(self) -> Result<Job, Refused> {
        let output = self.output.options(false)?;
        if output.format == Format::Json {
            return Err("JSON is for drawings of models; choose another format".into());
        }
        let pens = output.plotting.pens(hiddenline::page::DEFAULT_PEN_WIDTH_MM);
        if pens.iter().any(|rule| rule.drawn != Drawn::Visible) {
            return Err("an SVG has its pens already; --pen can only be given for `visible`, \
                        which puts all lines on one"
                .into());
        }
        check_place(output.path.as_deref(), &output.inputs)?;
        // An SVG may be replaced by itself in a better order: it is read before, and as a whole.
        if output.format != Format::Svg {
            check_place(output.path.as_deref(), [&self.file])?;
        }
        Ok(Job {
            file: self.file,
            tolerance_mm: self.tolerance,
            shortest_mm: self.shortest_stroke,
            output,
        })
    }
}

/// Does the job; the error is a message for the user.
pub(super) fn run(job: &Job) -> Result<(), Box<dyn Error>> {
    let mut run = Run::start(&job.output)?;
    if is_dash(&job.file) && io::stdin().is_terminal() {
        return Err("standard input is the terminal; give a file, or send an SVG to it".into());
    }
    run.progress.stage("reading");
    let name = title(&job.file);
    let read = timed(&mut run.stats.seconds.read, || -> Result<_, Box<dyn Error>> {
        let text = read_text(&job.file).map_err(|error| format!("{name}: {error}"))?;
        let options =
            read_svg::Options { tolerance_mm: job.tolerance_mm, ..read_svg::Options::default() };
        Ok(read_svg::read(&text, &options).map_err(|error| format!("{name}: {error}"))?)
    })?;
    let mut plot = read.plot;
    for rule in job.output.plotting.pens(hiddenline::page::DEFAULT_PEN_WIDTH_MM) {
        let mut lines = hiddenline::plot::Polylines::default();
        for line in plot.layers.iter().flat_map(|layer| layer.lines.iter()) {
            lines.push(line.iter().copied());
        }
        let name = rule.drawn.name().into_owned();
        plot.layers = vec![hiddenline::plot::Layer {
            number: rule.number,
            name,
            pen: rule.pen,
            lines,
            ..Default::default()
        }];
    }
    if plot.title.is_empty() {
        plot.title = name.clone();
    }
    plot.source = source::source(config::arguments());
    run.stats.strokes = plot.layers.iter().map(|layer| layer.lines.len()).sum();
    run.stats.points = plot.layers.iter().map(|layer| layer.lines.n_points()).sum();
    run.notes.add(Notes {
        warnings: read.warnings.into_iter().collect(),
        summary: format!(
            "{name}: {}, {}",
            counted(run.stats.strokes, "stroke", "strokes"),
            counted(run.stats.points, "point", "points")
        ),
    });
    let paper = format!("{} x {} mm", tenths(plot.width_mm), tenths(plot.height_mm));
    let usual = Options { shortest_mm: job.shortest_mm, ..Options::default() };
    run.plot(&paper, plot, &usual)
}

fn tenths(mm: f64) -> f64 {
    (mm * 10.0).round() / 10.0
}

fn read_text(path: &Path) -> Result<String, Box<dyn Error>> {
    let mut bytes = Vec::new();
    if is_dash(path) {
        io::stdin().lock().read_to_end(&mut bytes)?;
    } else {
        bytes = std::fs::read(path)?;
    }
    Ok(String::from_utf8(bytes).map_err(|_| "not a readable SVG: the text is not UTF-8")?)
}
