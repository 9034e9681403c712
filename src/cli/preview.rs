//! `hiddenline preview`: from model files to a shaded picture.

mod picture;

use std::error::Error;
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use hiddenline::stages::camera::Projection;
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::shading::preview::{self, PreviewError, PreviewOptions};
use hiddenline::stages::write::Format;

use self::picture::PictureArgs;
use super::camera::{CameraArgs, ViewSource};
use super::input::{Input, InputArgs};
use super::output::check_place;
use super::paper::start_threads;
use super::paths::is_dash;
use super::progress::Progress;
use super::scene::Subject;
use super::stats::peak_bytes;
use super::{Refused, file, messages};

const EXAMPLES: &str = "\
Examples:
  hiddenline preview bunny.stl -o bunny.png
      A shaded picture from where `draw` looks, too.
  hiddenline preview house.obj --up-axis y --edges --size 1600x1200 -o house.png
      With the visible lines on it.
  hiddenline preview spot.obj --shading smooth --engine a-buffer -o spot.png
      Curved surfaces, smooth borders.
  hiddenline preview engine.stl --engine a-buffer --opacity 0.4 -o glass.png
      As if made of glass.
  hiddenline preview part.stl --view top --show depth -o heights.png
      What is nearer is lighter.
  hiddenline preview part.stl --tone -o tone.png
      How light each point is, as gray, for hatching.
  hiddenline preview --expr \"sin(r)/r\" --x=-9:9 --y=-9:9 -o hat.png
      A surface z = f(x, y).
  hiddenline preview --grid heights.tif --view isometric -o terrain.png
      Heights from a file.";

/// Samples of a surface along each axis, unless given: more than lines need, since faces are seen.
const DEFAULT_SAMPLES: usize = 200;

/// Make a shaded picture of models
///
/// Reads what `draw` reads, looks from where `draw` looks, and writes a PNG, for a look before a pen
/// begins. All engines decide each pixel alike.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct PreviewArgs {
    #[command(flatten)]
    input: InputArgs,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    picture: PictureArgs,
    /// File to write, a PNG; `-` is standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    output: Option<PathBuf>,
    /// Threads to work with [default: all]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    #[arg(help_heading = "Output")]
    threads: Option<u16>,
    /// Print counts and times as JSON, the last line on standard error
    #[arg(long, help_heading = "Output")]
    stats: bool,
    /// Print nothing but errors
    #[arg(short, long, help_heading = "Output")]
    quiet: bool,
    /// Take the settings called NAME in the configuration files
    #[arg(long, value_name = "NAME", help_heading = "Output")]
    preset: Option<String>,
}

/// What is to be done.
pub(super) struct Job {
    input: Input,
    view: ViewSource,
    options: PreviewOptions,
    edges: Option<LineSelection>,
    /// `None` is standard output.
    path: Option<PathBuf>,
    threads: Option<usize>,
    engine: String,
    stats: bool,
    quiet: bool,
}

impl PreviewArgs {
    /// Checks what clap cannot; the error is a message about usage.
    pub(super) fn job(self) -> Result<Job, Refused> {
        let Self { input, camera, picture, output, threads, stats, quiet, preset: _ } = self;
        let input = input.input(DEFAULT_SAMPLES)?;
        let path = output.filter(|path| !is_dash(path));
        let view = camera.view_source();
        check_place(path.as_deref(), input.inputs().chain(view.input()))?;
        check_picture(path.as_deref())?;
        Ok(Job {
            input,
            view,
            options: picture.options()?,
            edges: picture.edges.then_some(picture.lines),
            path,
            threads: threads.map(usize::from),
            engine: picture.engine_name(),
            stats,
            quiet,
        })
    }
}

/// Refuses the name of another kind of file than a PNG; what is no file may be called anything.
fn check_picture(path: Option<&Path>) -> Result<(), Refused> {
    let Some(path) = path else { return Ok(()) };
    let is_device = path.metadata().is_ok_and(|found| !found.is_file());
    if is_device || Format::from_path(path) == Some(Format::Png) {
        return Ok(());
    }
    let path = path.display();
    Err(format!("`{path}` does not end in .png; a picture is written as PNG only").into())
}

/// Does the job; the error is a message for the user.
pub(super) fn run(job: &Job) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    if job.path.is_none() && io::stdout().is_terminal() {
        return Err("a picture is not for the terminal; give -o FILE".into());
    }
    let mut stats = start_threads(job.threads)?;
    let progress = Progress::new(job.quiet);
    let read = || job.input.mesh();
    let Subject { scene, camera, notes } =
        Subject::read(read, &job.view, job.edges, job.edges.is_some(), &progress, &mut stats)?;
    if job.options.fit_fov && camera.projection() == Projection::Orthographic {
        return Err(
            format!("{}; give --projection perspective", PreviewError::NoFieldOfView).into()
        );
    }
    progress.stage("drawing");
    let edges = job.edges.map(|lines| {
        let options = DrawOptions { lines, ..DrawOptions::default() };
        let scale = job.options.pixel_map(&scene, &camera).scale;
        // What is a millimeter on paper is about four pixels here.
        let drawn = draw(&scene, &camera, &options, scale / 4.0);
        stats.add(&drawn);
        drawn.drawing
    });
    progress.stage("shading");
    let mut seconds = stats.seconds;
    let write = |out: &mut dyn io::Write| -> Result<(), PreviewError> {
        seconds += preview::write(&scene, &camera, &job.options, edges.as_ref(), out)?;
        Ok(())
    };
    match &job.path {
        Some(path) => file::write_to_file(path, write)
            .map_err(|error| format!("{}: {error}", path.display()))?,
        None => file::write_to_stdout(write)?,
    }
    drop(progress);
    seconds.total = start.elapsed().as_secs_f64();
    stats.seconds = seconds;
    if !job.quiet {
        notes.warnings.iter().for_each(|warning| messages::warning(warning));
        let (width, height) = job.options.size;
        messages::plain(&notes.summary);
        let name = job.path.as_deref().map_or("<stdout>".into(), Path::to_string_lossy);
        messages::plain(format_args!(
            "{name}  {width} x {height} pixels by {}, {:.2} s",
            job.engine, seconds.total
        ));
    }
    if job.stats {
        stats.count(&scene);
        stats.peak_bytes = peak_bytes();
        let mut stats = serde_json::to_value(&stats)?;
        stats["engine"] = job.engine.clone().into();
        messages::plain(stats);
    }
    Ok(())
}
