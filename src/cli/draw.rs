//! `hiddenline draw`: the stages from model files to a drawing's file.

use std::error::Error;
use std::io;
use std::path::Path;
use std::time::Instant;

use hiddenline::draw::draw;
use hiddenline::mesh::{Mesh, Repairs};
use hiddenline::optimize::Options;
use hiddenline::page::{Page, PlotOptions};
use hiddenline::read::read_file;
use hiddenline::scene::Scene;
use hiddenline::stats::{Stats, timed};
use hiddenline::strokes::{Drawing, StrokeKind};
use hiddenline::view::Camera;
use hiddenline::writers::json;

use super::args::{Job, ModelFiles, ViewSource};
use super::paper::{Notes, Run, check_terminal};
use super::progress::Progress;
use super::{config, source};

/// Does the job; the error is a message for the user.
pub(super) fn run(job: &Job) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    check_terminal(&job.output)?;
    if let Some(threads) = job.output.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    }
    let mut stats = Stats { threads: rayon::current_num_threads(), ..Stats::default() };
    let mut seconds = stats.seconds;

    let progress = Progress::new(job.output.quiet);
    progress.stage("reading");
    let (mesh, notes) = timed(&mut seconds.read, || read_models(&job.files))?;
    let bounds = mesh.bounds().unwrap_or_default();
    let camera = match &job.view {
        ViewSource::Framing(framing) => framing.camera(bounds)?,
        ViewSource::File(path) => read_camera(path)?,
    };
    progress.stage("finding edges");
    let asks_for_intersections = job.draw.lines.contains(StrokeKind::Intersection);
    let scene = timed(&mut seconds.topology, || {
        let scene = Scene::new(mesh);
        if asks_for_intersections { scene.with_intersections() } else { scene }
    });
    stats.seconds = seconds;
    progress.stage("drawing");
    // A page that cannot be made is reported when the drawing is placed on it.
    let mm_per_unit = |drawing: &Drawing| {
        Page::new(drawing, &camera, &job.page).map_or(1.0, |page| page.mm_per_image_unit())
    };
    let drawing = draw(&scene, &camera, &job.draw, mm_per_unit, &mut stats);
    count(&mut stats, &scene, &drawing);
    drop(scene);

    Run { output: &job.output, start, progress, stats, notes }.draw(
        &drawing,
        &camera,
        &job.page,
        plot_options(job),
        &Options::for_drawings(),
    )
}

pub(super) fn read_models(files: &ModelFiles) -> Result<(Mesh, Notes), Box<dyn Error>> {
    let mut notes = Notes::default();
    let mut models = Vec::with_capacity(files.models.len());
    let mut repairs = Repairs::default();
    for (path, &pose) in files.models.iter().zip(&files.poses) {
        let model = read_file(path, files.input_format)?;
        notes.warnings.extend(model.warnings.iter().map(ToString::to_string));
        repairs += model.repairs;
        models.push((model.mesh, pose));
    }
    let (mesh, arranged) = files.arrangement.arrange(models)?;
    repairs += arranged;
    if mesh.n_faces() == 0 {
        return Err("no face is left; give a smaller --weld".into());
    }
    notes.summary = format!(
        "{}: {} vertices, {} faces{}",
        title(files),
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
    stats.intersections = scene.intersections().lines().len();
    stats.counts.intersection_pairs = scene.intersections().n_pairs();
    stats.strokes = drawing.len();
    stats.points = drawing.n_points();
}

fn plot_options(job: &Job) -> PlotOptions {
    PlotOptions {
        pen_width_mm: job.pen_width_mm,
        hidden: job.draw.hidden,
        dash: job.dash,
        title: title(&job.files),
        pens: job.output.plotting.pens_for(&job.draw, job.pen_width_mm),
        source: source::source(config::arguments()),
    }
}

/// The names of the models, without folders.
pub(super) fn title(files: &ModelFiles) -> String {
    let name = |path: &Path| {
        if path.as_os_str() == "-" {
            return "standard input".to_owned();
        }
        path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
    };
    files.models.iter().map(|path| name(path)).collect::<Vec<_>>().join(", ")
}
