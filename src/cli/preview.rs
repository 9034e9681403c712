//! `hiddenline preview`: from model files to a shaded picture.

mod picture;

use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

use clap::Args;
use hiddenline::stages::camera::Projection;
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::draw::{DrawOptions, MeshSize, draw};
use hiddenline::stages::shading::light::LightError;
use hiddenline::stages::shading::preview::{self, PreviewError, PreviewOptions};
use hiddenline::stages::write::Format;

use self::picture::PictureArgs;
use super::Refused;
use super::camera::{CameraArgs, ViewSource};
use super::config;
use super::input::{Input, InputArgs};
use super::output::{OutputOptions, check_place};
use super::paper::{Run, Written};
use super::paths::is_dash;
use super::progress::Progress;
use super::scene::Subject;
use super::smooth::{SmoothArgs, Smoothing};

const EXAMPLES: &str = "\
Examples:
  hiddenline preview bunny.stl -o bunny.png
      A shaded picture, from the same view as `draw`.
  hiddenline preview house.obj --up-axis y --edges --size 1600x1200 -o house.png
      With the visible lines on top.
  hiddenline preview spot.obj --shading smooth --engine a-buffer -o spot.png
      Curved surfaces, smooth borders.
  hiddenline preview engine.stl --engine a-buffer --opacity 0.4 -o glass.png
      As if made of glass.
  hiddenline preview part.stl --view top --show depth -o heights.png
      Nearer is lighter.
  hiddenline preview part.stl --tone -o tone.png
      The tone of each point as gray, for hatching.
  hiddenline preview --expr \"sin(r)/r\" --x=-9:9 --y=-9:9 -o hat.png
      A surface z = f(x, y).
  hiddenline preview --grid heights.tif --view isometric -o terrain.png
      Heights from a file.";

/// Samples of a surface along each axis, unless given: more than lines need, since faces are seen.
const DEFAULT_SAMPLES: usize = 200;

/// Render a shaded picture of models
///
/// Takes the same models and the same camera as `draw`, and writes a PNG: a look before you plot. All
/// engines show the same faces.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct PreviewArgs {
    #[command(flatten)]
    input: InputArgs,
    #[command(flatten)]
    smooth: SmoothArgs,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    picture: PictureArgs,
    /// File to write, a PNG; `-` is standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    output: Option<PathBuf>,
    /// Number of threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    #[arg(help_heading = "Output")]
    threads: Option<u16>,
    /// Print counts and times as JSON, on the last line of standard error
    #[arg(long, help_heading = "Output")]
    stats: bool,
    /// Print nothing but errors
    #[arg(short, long, help_heading = "Output")]
    quiet: bool,
    /// Use the preset NAME from the configuration files
    #[arg(long, value_name = "NAME", help_heading = "Output")]
    preset: Option<String>,
}

/// What is to be done.
pub(super) struct Job {
    input: Input,
    smoothing: Option<Smoothing>,
    view: ViewSource,
    options: PreviewOptions,
    edges: Option<LineSelection>,
    engine: String,
    output: OutputOptions,
}

impl PreviewArgs {
    /// Checks what clap cannot; the error is a message about usage. `idle` warns about options
    /// without effect.
    pub(super) fn job(self, idle: Vec<String>) -> Result<Job, Refused> {
        let Self { input, smooth, camera, picture, output, threads, stats, quiet, preset: _ } =
            self;
        let input = input.input(DEFAULT_SAMPLES)?;
        let path = output.filter(|path| !is_dash(path));
        let view = camera.view_source();
        check_place(path.as_deref(), input.inputs().chain(view.input()))?;
        check_picture(path.as_deref())?;
        Ok(Job {
            input,
            smoothing: smooth.of_picture(),
            view,
            options: picture.options()?,
            edges: picture.edges.then_some(picture.lines),
            engine: picture.engine_name(),
            output: OutputOptions {
                warnings: [idle, config::unknown_variables()].concat(),
                ..OutputOptions::picture(path, threads.map(usize::from), stats, quiet)
            },
        })
    }
}

/// Refuses names of files other than PNG; devices may have any name.
fn check_picture(path: Option<&Path>) -> Result<(), Refused> {
    let Some(path) = path else { return Ok(()) };
    let is_device = path.metadata().is_ok_and(|found| !found.is_file());
    if is_device || Format::from_path(path) == Some(Format::Png) {
        return Ok(());
    }
    let path = path.display();
    Err(format!("`{path}` does not end in .png; pictures are written only as PNG").into())
}

/// Does the job; the error is a message for the user.
pub(super) fn run(job: &Job) -> Result<(), Box<dyn Error>> {
    let mut run = Run::start(&job.output)?;
    let read = |progress: &Progress| job.input.mesh(progress);
    let finds_bends = job.edges.is_some();
    let Subject { scene, camera, notes } = Subject::read(
        read,
        &job.view,
        job.edges,
        finds_bends,
        job.smoothing.as_ref(),
        &run.progress,
        &mut run.stats,
    )?;
    run.notes.add(notes);
    if job.options.fit_fov && camera.projection() == Projection::Orthographic {
        return Err(with_remedy(&PreviewError::NoFieldOfView).into());
    }
    run.progress.stage("drawing");
    let edges = job.edges.map(|lines| {
        let options = DrawOptions { lines, ..DrawOptions::default() };
        let scale = job.options.pixel_map(&scene, &camera).scale;
        // What is a millimeter on paper is about four pixels here.
        let drawn = draw(&scene, &camera, &options, scale / 4.0);
        run.stats.add(&drawn);
        drawn.drawing
    });
    run.stats.count(MeshSize::of(&scene));
    run.stats.engine = job.engine.clone().into();
    let (width, height) = job.options.size;
    let contents = format!(" by {}", job.engine);
    let what = Written { paper: &format!("{width} x {height} pixels"), contents };
    run.write(job.output.path.as_deref(), what, false, None, |out| {
        Ok::<_, PictureError>(preview::write(&scene, &camera, &job.options, edges.as_ref(), out)?)
    })
}

/// Why a picture cannot be made, with the remedy.
#[derive(Debug, thiserror::Error)]
#[error("{}", with_remedy(.0))]
struct PictureError(#[from] PreviewError);

impl From<io::Error> for PictureError {
    fn from(error: io::Error) -> Self {
        Self(error.into())
    }
}

/// What went wrong and how to mend it.
fn with_remedy(error: &PreviewError) -> String {
    match error {
        PreviewError::NoOrder(_) => format!("{error}; use --engine z-buffer"),
        PreviewError::NoFieldOfView => format!("{error}; use --projection perspective"),
        PreviewError::Light(LightError::Inside(..)) => {
            format!("{error}; use --light-at with a point outside, or --light with a direction")
        }
        PreviewError::Size(..) | PreviewError::Light(_) | PreviewError::Write(_) => {
            error.to_string()
        }
    }
}
