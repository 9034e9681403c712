//! `hiddenline draw`: the stages from model files to a drawing's file.

use std::error::Error;
use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::time::Instant;

use hiddenline::draw::draw;
use hiddenline::mesh::{Mesh, Repairs};
use hiddenline::page::{Page, PlacedPlot, PlotOptions};
use hiddenline::plot::Plot;
use hiddenline::read::read_file;
use hiddenline::scene::Scene;
use hiddenline::stats::{Stats, peak_bytes, timed};
use hiddenline::strokes::Drawing;
use hiddenline::view::Camera;
use hiddenline::writers::png::PngError;
use hiddenline::writers::{Format, json, png, svg};

use super::args::{Job, OutputOptions, ViewSource};
use super::progress::Progress;
use super::{messages, output};

/// Does the job; the error is a message for the user.
pub(super) fn run(job: &Job) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    if job.output.path.is_none() && job.output.format.is_binary() && io::stdout().is_terminal() {
        return Err("a picture is not for the terminal; give -o FILE".into());
    }
    if let Some(threads) = job.output.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    }
    let mut stats = Stats { threads: rayon::current_num_threads(), ..Stats::default() };
    let mut seconds = stats.seconds;

    let progress = Progress::new(job.output.quiet);
    progress.stage("reading");
    let (mesh, notes) = timed(&mut seconds.read, || read_models(job))?;
    let bounds = mesh.bounds().unwrap_or_default();
    let camera = match &job.view {
        ViewSource::Framing(framing) => framing.camera(bounds)?,
        ViewSource::File(path) => read_camera(path)?,
    };
    progress.stage("finding edges");
    let scene = timed(&mut seconds.topology, || Scene::new(mesh));
    stats.seconds = seconds;
    progress.stage("drawing");
    // A page that cannot be made is reported when the drawing is placed on it.
    let mm_per_unit = |drawing: &Drawing| {
        Page::new(drawing, &camera, &job.page).map_or(1.0, |page| page.mm_per_image_unit())
    };
    let drawing = draw(&scene, &camera, &job.draw, mm_per_unit, &mut stats);
    count(&mut stats, &scene, &drawing);
    drop(scene);

    progress.stage("writing");
    let mut write_seconds = 0.0;
    let (page, placed) = timed(&mut write_seconds, || -> Result<_, Box<dyn Error>> {
        let page = Page::new(&drawing, &camera, &job.page)?;
        let placed = page.plot(&drawing, plot_options(job));
        write(&job.output, &drawing, &camera, &page, &placed.plot)?;
        Ok((page, placed))
    })?;
    drop(progress);
    stats.seconds.write += write_seconds;
    stats.seconds.total = start.elapsed().as_secs_f64();
    stats.peak_bytes = peak_bytes();
    if !job.output.quiet {
        report(&job.output, &notes, &page, &placed);
    }
    if job.output.stats {
        messages::plain(serde_json::to_string(&stats)?);
    }
    Ok(())
}

/// What reading has to tell, for when all went well.
#[derive(Default)]
pub(super) struct Notes {
    pub(super) warnings: Vec<String>,
    pub(super) summary: String,
}

fn read_models(job: &Job) -> Result<(Mesh, Notes), Box<dyn Error>> {
    let mut notes = Notes::default();
    let mut meshes = Vec::with_capacity(job.models.len());
    let mut repairs = Repairs::default();
    for path in &job.models {
        let model = read_file(path, job.input_format)?;
        notes.warnings.extend(model.warnings.iter().map(ToString::to_string));
        repairs += model.repairs;
        meshes.push(model.mesh);
    }
    let (mesh, arranged) = job.arrangement.arrange(meshes)?;
    repairs += arranged;
    if mesh.n_faces() == 0 {
        return Err("no face is left; give a smaller --weld".into());
    }
    notes.summary = format!(
        "{}: {} vertices, {} faces{}",
        title(job),
        mesh.positions().len(),
        mesh.n_faces(),
        described(repairs)
    );
    Ok((mesh, notes))
}

fn described(repairs: Repairs) -> String {
    [
        (repairs.welded_vertices, "equal vertices made one"),
        (repairs.unused_vertices, "unused vertices left out"),
        (repairs.degenerate_faces, "degenerate faces left out"),
        (repairs.repeated_corners, "repeated corners left out"),
    ]
    .iter()
    .filter(|(count, _)| *count > 0)
    .map(|(count, what)| format!(", {count} {what}"))
    .collect()
}

pub(super) fn read_camera(path: &Path) -> Result<Camera, Box<dyn Error>> {
    let failed = |error: &dyn Error| format!("{}: {error}", path.display());
    let text = if path.as_os_str() == "-" {
        io::read_to_string(io::stdin().lock())
    } else {
        std::fs::read_to_string(path)
    };
    let text = text.map_err(|error| failed(&error))?;
    Ok(json::read_camera(&text).map_err(|error| failed(&error))?)
}

fn count(stats: &mut Stats, scene: &Scene, drawing: &Drawing) {
    stats.vertices = scene.mesh().positions().len();
    stats.faces = scene.mesh().n_faces();
    stats.triangles = scene.triangles().len();
    stats.edges = scene.topology().edges().len();
    stats.strokes = drawing.len();
    stats.points = drawing.n_points();
}

fn plot_options(job: &Job) -> PlotOptions {
    PlotOptions {
        pen_width_mm: job.pen_width_mm,
        hidden: job.draw.hidden,
        dash: job.dash,
        title: title(job),
        source: source(std::env::args_os().skip(1)),
    }
}

/// The names of the models, without folders.
fn title(job: &Job) -> String {
    let name = |path: &Path| {
        if path.as_os_str() == "-" {
            return "standard input".to_owned();
        }
        path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
    };
    job.models.iter().map(|path| name(path)).collect::<Vec<_>>().join(", ")
}

/// The command as typed, but for what does not change the drawing: the same drawing has the same
/// bytes, wherever it is written to and however many threads made it.
pub(super) fn source(arguments: impl Iterator<Item = OsString>) -> String {
    let mut command = "hiddenline".to_owned();
    let mut arguments = arguments.map(|argument| argument.to_string_lossy().into_owned());
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "-o" | "--output" | "--threads" => {
                arguments.next();
            }
            "-q" | "--quiet" | "--stats" => {}
            other
                if ["-o", "-q", "--output=", "--threads="].iter().any(|p| other.starts_with(p)) => {
            }
            other => {
                command.push(' ');
                command.push_str(&quoted(other));
            }
        }
    }
    command
}

/// The argument as a shell takes it.
fn quoted(argument: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,:=+@%".contains(c);
    if !argument.is_empty() && argument.chars().all(plain) {
        argument.to_owned()
    } else {
        format!("'{}'", argument.replace('\'', "'\\''"))
    }
}

pub(super) fn write(
    options: &OutputOptions,
    drawing: &Drawing,
    camera: &Camera,
    page: &Page,
    plot: &Plot,
) -> Result<(), Box<dyn Error>> {
    let write = |out: &mut dyn Write| -> Result<(), PngError> {
        match options.format {
            Format::Svg => Ok(svg::write(plot, options.svg_element, out)?),
            Format::Json => Ok(json::write(drawing, camera, page.page_from_image, out)?),
            Format::Png => png::write(plot, options.resolution, out),
        }
    };
    match &options.path {
        None => Ok(output::write_to_stdout(write)?),
        Some(path) => output::write_to_file(path, write)
            .map_err(|error| format!("cannot write {}: {error}", path.display()).into()),
    }
}

pub(super) fn report(
    options: &OutputOptions,
    notes: &Notes,
    page: &Page,
    PlacedPlot { plot, cropped }: &PlacedPlot,
) {
    for warning in &notes.warnings {
        messages::warning(warning);
    }
    messages::plain(&notes.summary);
    if plot.layers.iter().all(|layer| layer.lines.is_empty()) {
        messages::warning("the drawing is empty: nothing is in view");
    }
    if *cropped && options.format != Format::Json {
        messages::warning("lines were cut off at the margins");
    }
    let name = options.path.as_deref().map_or("<stdout>".into(), Path::to_string_lossy);
    let pens: String = plot
        .layers
        .iter()
        .map(|layer| {
            let metres = layer.lines.length_mm() / 1000.0;
            format!("  {} {} strokes {metres:.1} m", layer.name, layer.lines.len())
        })
        .collect();
    messages::plain(format_args!("{name}  {}{pens}", page.paper.description()));
}
