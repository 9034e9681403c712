//! Many drawings at once: frames of a turntable, views of a table, a drawing of each model.
//!
//! A scene is built once for all its views, and views are drawn in parallel. Frames share one scale, so they
//! can be overlaid; models are fitted to their pages one by one. Messages come in the order of the drawings.

mod shard;
mod views;

use std::collections::HashSet;
use std::error::Error;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use clap::Args;
use hiddenline::stages::camera::Camera;
use hiddenline::stages::extent::Extent;
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::optimize::OptimizeOptions;
use hiddenline::stages::page::PlotOptions;
use rayon::prelude::*;

use self::shard::{Shard, ShardName};
use super::{Job, plot_options, strokes};
use crate::cli::camera::{CameraArgs, ViewSource};
use crate::cli::models::ModelFiles;
use crate::cli::naming::NameTemplate;
use crate::cli::output::check_place;
use crate::cli::paper::{Notes, Report, Run, check_terminal, start_threads};
use crate::cli::paths::is_dash;
use crate::cli::progress::Progress;
use crate::cli::scene::Subject;
use crate::cli::stats::Stats;
use crate::cli::{Refused, messages};

#[derive(Args)]
#[command(next_help_heading = "Many drawings")]
pub(super) struct ManyArgs {
    /// Draw N frames of one turn around the model, all at the same scale
    ///
    /// Each frame is a file. In the output name, {index} is the number of the frame, from 1, and {index:03}
    /// writes it with three digits. Without {index}, -001 and so on are added before the extension.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    turntable: Option<u32>,
    /// Draw a view for each row of a CSV file, all at the same scale
    ///
    /// The first row names camera options, as in azimuth,elevation. Empty fields and missing columns use the
    /// value from the command line. Vectors need quotes, as in "4,-3,2".
    #[arg(long, value_name = "FILE", conflicts_with_all = ["turntable", "camera"])]
    views: Option<PathBuf>,
    /// Make a separate drawing of each model
    ///
    /// In the output name, {stem} is the model's file name without extension, {dir} its folder, and {index}
    /// its number, unless there are several views.
    #[arg(long)]
    each: bool,
    /// Read more model names from a file, one per line or separated by NUL; `-` is standard input
    #[arg(long, value_name = "FILE")]
    list: Option<PathBuf>,
    /// Make only every N-th drawing, starting with the K-th; `slurm` takes K and N from a Slurm job array
    ///
    /// With --each, it counts models, otherwise views. Together, the shards make all drawings.
    #[arg(long, value_name = "K/N")]
    shard: Option<ShardName>,
    /// Skip drawings whose output file exists
    #[arg(long)]
    skip_existing: bool,
    /// Continue after a drawing fails, and exit with status 1 at the end
    #[arg(long)]
    keep_going: bool,
}

/// The views of each scene.
enum Views {
    One(ViewSource),
    Turntable(ViewSource, u32),
    Table(Vec<ViewSource>),
}

/// A drawing to make.
struct Task {
    /// The number of its view among those of the scene.
    view: usize,
    path: Option<PathBuf>,
}

/// A scene with the drawings to make of it.
struct Group {
    files: ModelFiles,
    tasks: Vec<Task>,
    n_skipped: usize,
}

/// All drawings to make.
pub(super) struct Many {
    groups: Vec<Group>,
    views: Views,
    keeps_going: bool,
}

impl ManyArgs {
    /// Whether there may be more or less than one drawing, or its name is to be made up.
    pub(super) fn are_used(&self, output: Option<&Path>) -> bool {
        let has_frames = self.turntable.is_some() || self.views.is_some();
        let has_options =
            self.each || self.shard.is_some() || self.skip_existing || self.keep_going;
        has_frames || has_options || output.is_some_and(|path| NameTemplate::new(path).has_places())
    }

    /// Names of models in the list.
    pub(super) fn listed_models(&self) -> Result<Vec<PathBuf>, Refused> {
        let Some(path) = &self.list else { return Ok(Vec::new()) };
        let failed = |error: io::Error| {
            Refused::Failed(format!("--list {}: {error}", path.display()).into())
        };
        let mut bytes = Vec::new();
        if is_dash(path) {
            io::stdin().lock().read_to_end(&mut bytes).map_err(failed)?;
        } else {
            bytes = fs::read(path).map_err(failed)?;
        }
        let separator = if bytes.contains(&0) { 0 } else { b'\n' };
        let names = bytes.split(|&byte| byte == separator);
        let names = names.map(|name| String::from_utf8_lossy(name).into_owned());
        let names = names.map(|name| match separator {
            0 => name,
            _ => name.trim_end_matches('\r').to_owned(),
        });
        let models: Vec<PathBuf> =
            names.filter(|name| !name.is_empty()).map(PathBuf::from).collect();
        if models.is_empty() {
            return Err(Refused::Failed(format!("--list {}: no names", path.display()).into()));
        }
        Ok(models)
    }

    /// The files that are read, beside models.
    pub(super) fn inputs(&self) -> impl Iterator<Item = PathBuf> {
        self.list.iter().chain(&self.views).cloned()
    }

    /// The drawings to make, named after `output`.
    pub(super) fn drawings(
        self,
        files: ModelFiles,
        camera: CameraArgs,
        output: Option<&Path>,
        inputs: &[PathBuf],
    ) -> Result<Many, Refused> {
        let (views, n_views) = match (self.turntable, &self.views) {
            (Some(n), _) => (Views::Turntable(camera.view_source(), n), n as usize),
            (None, Some(path)) => {
                let table = views::read(path, &camera)?;
                let n = table.len();
                (Views::Table(table), n)
            }
            (None, None) => (Views::One(camera.view_source()), 1),
        };
        let has_frames = !matches!(views, Views::One(_));
        let shard = self.shard.map(ShardName::shard).transpose()?.unwrap_or(Shard::ALL);
        let scenes = if self.each { files.each() } else { vec![files] };
        let n_all = scenes.len() * n_views;
        let template = output.map(NameTemplate::new);
        let template = if has_frames { template.map(NameTemplate::numbered) } else { template };
        if n_all > 1 && template.is_none() {
            return Err(
                "several drawings need names; use -o, as in -o 'out/{stem}-{index:03}.svg'".into(),
            );
        }
        let inputs: HashSet<PathBuf> =
            inputs.iter().filter_map(|input| fs::canonicalize(input).ok()).collect();
        let is_input = |path: &PathBuf| fs::canonicalize(path).is_ok_and(|p| inputs.contains(&p));
        let mut names = HashSet::new();
        let mut groups = Vec::new();
        for (i, files) in scenes.into_iter().enumerate() {
            let mut group = Group { files, tasks: Vec::new(), n_skipped: 0 };
            for view in 0..n_views {
                let index = if has_frames { view } else { i } + 1;
                let model = group.files.models.first().map(PathBuf::as_path);
                let path = template.as_ref().map(|t| t.name(model.unwrap_or(Path::new("")), index));
                if let Some(path) = path.as_ref().filter(|path| !names.insert((*path).clone())) {
                    return Err(format!(
                        "several drawings would be written to {}; use a name with {{stem}}, \
                         {{dir}} or {{index}}, as in -o 'out/{{stem}}-{{index:03}}.svg'",
                        path.display()
                    )
                    .into());
                }
                if !shard.contains(if self.each { i } else { view }) {
                    continue;
                }
                check_place(path.as_deref(), std::iter::empty::<&Path>())?;
                if let Some(path) = path.as_ref().filter(|path| is_input(path)) {
                    return Err(Refused::Failed(
                        format!(
                            "cannot write {}: it is an input file and would be replaced; use \
                             another -o",
                            path.display()
                        )
                        .into(),
                    ));
                }
                if self.skip_existing && path.as_ref().is_some_and(|path| path.exists()) {
                    group.n_skipped += 1;
                } else {
                    group.tasks.push(Task { view, path });
                }
            }
            groups.push(group);
        }
        Ok(Many { groups, views, keeps_going: self.keep_going })
    }
}

impl Views {
    /// The cameras for a scene: that which reading it gave, or those that go with it.
    fn cameras(&self, scene: &Scene, first: Camera) -> Result<Vec<Camera>, Box<dyn Error>> {
        let bounds = scene.mesh().bounds().unwrap_or_default();
        match self {
            Self::One(_) => Ok(vec![first]),
            Self::Turntable(_, n) => Ok(first.turntable(*n)?),
            Self::Table(views) => views.iter().map(|view| view.camera(bounds)).collect(),
        }
    }

    fn first(&self) -> &ViewSource {
        match self {
            Self::One(view) | Self::Turntable(view, _) => view,
            Self::Table(views) => &views[0],
        }
    }
}

/// What became of a drawing.
enum Outcome {
    Drawn(Report),
    Failed(String),
    /// Another one failed before.
    Left,
}

/// Makes all drawings; the error is a message for the user.
pub(super) fn run(job: &Job, many: &Many) -> Result<(), Box<dyn Error>> {
    if many.groups.iter().flat_map(|group| &group.tasks).any(|task| task.path.is_none()) {
        check_terminal(&job.output)?;
    }
    let stats = start_threads(job.output.threads)?;
    let progress = Progress::new(job.output.quiet);
    progress.stage("drawing");
    let n_tasks = many.groups.iter().map(|group| group.tasks.len()).sum::<usize>();
    let work = Work {
        job,
        many,
        stats: &stats,
        first: many.groups.iter().find(|group| !group.tasks.is_empty()),
        has_failed: AtomicBool::new(false),
    };
    let mut n_done = 0;
    let mut tally = Tally { is_only: n_tasks == 1, ..Tally::default() };
    // A few models at a time, so that messages do not pile up.
    for groups in many.groups.chunks(4 * stats.threads.max(1)) {
        let outcomes: Vec<Vec<Outcome>> = groups.par_iter().map(|group| work.draw(group)).collect();
        for (group, outcomes) in groups.iter().zip(outcomes) {
            tally.n_skipped += group.n_skipped;
            n_done += group.tasks.len();
            outcomes.into_iter().for_each(|outcome| tally.add(outcome));
        }
        progress.share(n_done as f64 / n_tasks.max(1) as f64);
    }
    drop(progress);
    tally.finish(many, job.output.quiet)
}

/// How many drawings there are of each outcome.
#[derive(Default)]
struct Tally {
    /// Whether there is one drawing only.
    is_only: bool,
    n_drawn: usize,
    n_failed: usize,
    n_skipped: usize,
    last_failure: Option<String>,
}

impl Tally {
    /// Counts an outcome and tells about it; a failure that all drawings of a model share only once.
    fn add(&mut self, outcome: Outcome) {
        match outcome {
            Outcome::Drawn(report) => {
                self.n_drawn += 1;
                report.tell();
            }
            Outcome::Failed(message) => {
                self.n_failed += 1;
                if !self.is_only && self.last_failure.as_ref() != Some(&message) {
                    messages::error(&message);
                }
                self.last_failure = Some(message);
            }
            Outcome::Left => {}
        }
    }

    fn finish(self, many: &Many, quiet: bool) -> Result<(), Box<dyn Error>> {
        let Self { is_only, n_drawn, n_failed, n_skipped, last_failure } = self;
        if let Some(failure) = last_failure.filter(|_| is_only) {
            return Err(failure.into());
        }
        let skipped = match n_skipped {
            0 => String::new(),
            n => format!(", {n} skipped"),
        };
        match n_failed {
            0 => {
                if !quiet {
                    messages::plain(format_args!("{n_drawn} drawn{skipped}"));
                }
                Ok(())
            }
            n if many.keeps_going => Err(format!("{n_drawn} drawn, {n} failed{skipped}").into()),
            n => Err(format!(
                "{n_drawn} drawn, {n} failed{skipped}; --keep-going draws the rest anyway"
            )
            .into()),
        }
    }
}

/// What all drawings have in common.
struct Work<'w> {
    job: &'w Job,
    many: &'w Many,
    stats: &'w Stats,
    /// The group that comes with warnings about options.
    first: Option<&'w Group>,
    has_failed: AtomicBool,
}

impl Work<'_> {
    /// Whether to begin nothing more.
    fn is_over(&self) -> bool {
        !self.many.keeps_going && self.has_failed.load(Relaxed)
    }

    /// Makes the drawings of one scene.
    fn draw(&self, group: &Group) -> Vec<Outcome> {
        if group.tasks.is_empty() {
            return Vec::new();
        }
        if self.is_over() {
            return group.tasks.iter().map(|_| Outcome::Left).collect();
        }
        match self.frames(group) {
            Ok(frames) => {
                let (first, rest) = (&frames.tasks[..1], &frames.tasks[1..]);
                let one = |task: &Task, notes: Notes| self.draw_one(&frames, task, notes);
                // What reading has to tell comes with the first.
                let notes = |task| one(task, frames.notes.clone());
                let mut outcomes: Vec<Outcome> = Vec::with_capacity(frames.tasks.len());
                outcomes.extend(first.iter().map(notes));
                outcomes.par_extend(rest.par_iter().map(|task| one(task, Notes::default())));
                outcomes
            }
            Err(error) => {
                self.has_failed.store(true, Relaxed);
                let message = error.to_string();
                group.tasks.iter().map(|_| Outcome::Failed(message.clone())).collect()
            }
        }
    }

    /// Reads a scene and finds its cameras.
    fn frames<'g>(&self, group: &'g Group) -> Result<Frames<'g>, Box<dyn Error>> {
        let (job, views) = (self.job, &self.many.views);
        let mut stats = self.stats.clone();
        let read = |progress: &Progress| group.files.read(progress);
        let (lines, is_tidied) = (Some(job.draw.lines), !job.draw.exact);
        let silent = Progress::new(true);
        let Subject { scene, camera, notes } = Subject::read(
            read,
            views.first(),
            lines,
            is_tidied,
            job.smoothing.as_ref(),
            &silent,
            &mut stats,
        )?;
        let cameras = views.cameras(&scene, camera)?;
        let extent = scene.extent_of_views(&cameras);
        let (files, tasks) = (&group.files, &group.tasks[..]);
        let mut notes = notes;
        if self.first.is_some_and(|first| std::ptr::eq(first, group)) {
            notes.warnings.splice(0..0, job.output.warnings.iter().cloned());
        }
        Ok(Frames { files, tasks, scene, cameras, extent, notes, stats })
    }

    fn draw_one(&self, frames: &Frames, task: &Task, notes: Notes) -> Outcome {
        if self.is_over() {
            return Outcome::Left;
        }
        match self.drawn(frames, task, notes) {
            Ok(report) => Outcome::Drawn(report),
            Err(error) => {
                self.has_failed.store(true, Relaxed);
                let name = task.path.as_deref().map_or("<stdout>".into(), Path::to_string_lossy);
                Outcome::Failed(format!("{name}: {error}"))
            }
        }
    }

    fn drawn(&self, frames: &Frames, task: &Task, notes: Notes) -> Result<Report, Box<dyn Error>> {
        let job = self.job;
        let mut run = Run::silent(&job.output, frames.stats.clone());
        let notes = Notes { unit_mm: frames.notes.unit_mm, ..notes };
        let camera = frames.cameras[task.view];
        let (drawing, sheet) = strokes(job, &frames.scene, camera, frames.extent, notes, &mut run)?;
        let options = PlotOptions { title: frames.files.title(), ..plot_options(job) };
        let usual = OptimizeOptions::for_drawings();
        run.draw_to(task.path.as_deref(), &drawing, &sheet, options, &usual)
    }
}

/// A scene with its views.
struct Frames<'g> {
    files: &'g ModelFiles,
    tasks: &'g [Task],
    scene: Scene,
    cameras: Vec<Camera>,
    /// What all views together take up, so that they have one scale.
    extent: Extent,
    notes: Notes,
    stats: Stats,
}
