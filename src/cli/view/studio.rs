//! The current subject, kept between drawings, and how requests of the page become drawings.

use std::error::Error;
use std::ffi::OsString;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use clap::{ArgMatches, Command, FromArgMatches};
use glam::DVec3;
use hiddenline::stages::write::Format;
use serde_json::{Value, json};

use super::composed::{Composed, Options};
use super::controls::controls;
use super::declared::{DRAW, is_on_page, option};
use super::facts::{PenFacts, Placed, extend, facts, pens_by_kind, pens_of};
use super::fault::Fault;
use super::pick::nearest_hit;
use super::wire;
use crate::cli::draw::{DrawArgs, Live, Turned};
use crate::cli::models::HeldFiles;
use crate::cli::output::OutputOptions;
use crate::cli::paper::{Kept, Run};
use crate::cli::progress::{Listener, Progress};
use crate::cli::surface::{LiveSurface, SurfaceArgs};
use crate::cli::{Refused, config, draw, source, surface};

/// Options that the mesh of a model depends on besides those of its group.
const OF_MESH: [&str; 2] = ["unit", "exact"];
/// The groups of options that say what is shown.
const OF_SUBJECT: [&str; 2] = ["Model", "Surface"];
/// Most warnings and hints sent with a drawing, and characters of each.
const MOST_NOTES: usize = 12;
const LONGEST_NOTE: usize = 400;

/// What the server shows.
pub(super) struct Studio {
    /// The commands `draw` and `surface`.
    commands: [Command; 2],
    /// What was typed, or dropped on the page since.
    typed: Composed,
    held: HeldFiles,
    subject: Subject,
    /// What `subject` was made from.
    key: String,
    /// Grows when a file that is shown has changed.
    revision: Arc<AtomicU64>,
}

enum Subject {
    None,
    Scene(Box<Live>),
    Surface(Box<LiveSurface>),
}

/// A command ready to be done.
enum Job {
    Draw(Box<draw::Job>),
    Surface(Box<surface::Job>),
}

/// What a page requests.
pub(super) struct Asked {
    pub(super) seq: u32,
    /// The options of the camera; `None` for those that were typed.
    pub(super) camera: Option<Value>,
    pub(super) options: Option<Value>,
    /// A place on the page whose point on the surface is to become the target, in millimeters.
    pub(super) pick_mm: Option<[f64; 2]>,
}

/// Octets with the facts about them.
pub(super) struct Answer {
    pub(super) octets: Vec<u8>,
    pub(super) facts: Value,
}

impl Studio {
    /// A studio for what was typed. `revision` grows when files have changed.
    pub(super) fn new(
        program: &Command,
        matches: &ArgMatches,
        held: HeldFiles,
        revision: Arc<AtomicU64>,
    ) -> Result<Self, String> {
        let typed = Composed::typed(program, matches)?;
        let command =
            |name: &str| program.find_subcommand(name).cloned().ok_or_else(|| name.to_owned());
        let commands = [command("draw")?, command("surface")?];
        Ok(Self { commands, typed, held, subject: Subject::None, key: String::new(), revision })
    }

    /// Reads what is shown, as far as errors of its files can be found.
    pub(super) fn open(&mut self) -> Result<(), Fault> {
        let typed = self.typed.clone();
        let (job, _) = self.job(&typed, Format::Svg)?;
        let mut kept = Kept::default();
        self.ready(&typed, &job, &mut kept, Box::new(|_, _| ()))
    }

    /// What a page must know before it requests a drawing.
    pub(super) fn description(&self) -> Value {
        let command = self.command(self.typed.name);
        let on_page = |name: &str| option(command, name).is_some_and(is_on_page);
        let options = self.typed.options.iter().filter(|(name, _)| on_page(name));
        let options: serde_json::Map<String, Value> =
            options.map(|(name, values)| (name.clone(), described(values))).collect();
        let subjects: Vec<_> = self.typed.subjects.iter().map(|s| s.to_string_lossy()).collect();
        json!({
            "command": self.typed.name,
            "subjects": subjects,
            "formulas": self.typed.name != DRAW && !self.typed.options.contains_key("grid")
                && !self.typed.options.contains_key("points")
                && !self.typed.options.contains_key("parametric"),
            "options": options,
            "camera_file": self.typed.options.contains_key("camera"),
            "controls": controls(command, &self.shown_by()),
            "formats": Format::ALL.map(Format::name),
            "stem": self.typed.file_stem(),
        })
    }

    /// The arguments that say what is shown.
    fn shown_by(&self) -> Vec<&'static str> {
        let mut named = ["grid", "points", "parametric"].into_iter();
        let named = named.find(|name| self.typed.options.contains_key(*name));
        vec![if self.typed.name == DRAW { "models" } else { named.unwrap_or("expression") }]
    }

    /// Files to watch.
    pub(super) fn files(&self) -> Vec<std::path::PathBuf> {
        let named = ["grid", "points"].iter().filter_map(|name| self.typed.options.get(*name));
        let mut files: Vec<std::path::PathBuf> = named.flatten().map(Into::into).collect();
        if self.typed.name == DRAW {
            for model in self.typed.subjects.iter().map(std::path::PathBuf::from) {
                files.extend(hiddenline::stages::read::material_files(&model));
                files.push(model);
            }
        }
        files.retain(|path| !self.held.contains_key(path));
        files
    }

    /// Shows a model that was dropped on the page instead of what was typed. If it cannot be read, all
    /// stays as it is.
    pub(super) fn show(&mut self, name: String, bytes: Vec<u8>) -> Result<(), Fault> {
        let is_turned = |name: &str| ["up-axis", "input-format"].contains(&name);
        let options: Options = match self.typed.name {
            DRAW => self.typed.options.clone(),
            _ => Options::new(),
        };
        let of_model = |name: &str| {
            let arg = option(self.command(DRAW), name);
            arg.is_some_and(|arg| arg.get_help_heading() == Some("Model"))
        };
        let options = options.into_iter().filter(|(name, _)| !of_model(name) || is_turned(name));
        let mut options: Options = options.collect();
        options.remove("input-format");
        options.remove("camera");
        let held = HeldFiles::new([(name.clone().into(), bytes)].into());
        let typed = Composed { name: DRAW, subjects: vec![name.into()], options };
        let before = (self.typed.clone(), self.held.clone(), std::mem::take(&mut self.key));
        let subject = std::mem::replace(&mut self.subject, Subject::None);
        (self.typed, self.held) = (typed, held);
        let opened = self.open();
        if opened.is_err() {
            (self.typed, self.held, self.key) = before;
            self.subject = subject;
        }
        opened
    }

    /// The exact drawing, as it would be saved.
    pub(super) fn exact(&mut self, asked: &Asked, listener: Listener) -> Result<Answer, Fault> {
        let composed = self.composed(asked)?;
        let (job, output) = self.job(&composed, Format::Svg)?;
        let mut kept = Kept::default();
        self.ready(&composed, &job, &mut kept, Box::new(|_, _| ()))?;
        let read = std::mem::take(&mut kept.stats.seconds);
        self.run(&job, &mut kept, listener)?;
        let Kept { plot, sheet, notes, mut stats, .. } = kept;
        stats.seconds += read;
        let (Some(plot), Some(sheet)) = (plot, sheet) else {
            return Err(Fault::of("nothing is drawn"));
        };
        let placed = Placed { camera: sheet.camera, page: sheet.options, sheet: sheet.page };
        let work = stats.plot.map(|plot| plot.after).unwrap_or_default();
        let mut facts = facts(asked.seq, &placed, &pens_of(&plot));
        let shortened = |texts: &[String]| -> Vec<String> {
            let short = |text: &String| text.chars().take(LONGEST_NOTE).collect();
            texts.iter().take(MOST_NOTES).map(short).collect()
        };
        let more = json!({
            "exact": true,
            "command": self.shown(&composed, &output),
            "strokes": work.strokes,
            "meters": work.down_m,
            "travel": work.up_m,
            "lifts": work.lifts,
            "minutes": work.minutes,
            "seconds": stats.seconds.sum(),
            "warnings": shortened(&notes.warnings),
            "hints": shortened(&notes.hints),
            "summary": notes.summary,
        });
        extend(&mut facts, more);
        if let Some(place) = asked.pick_mm {
            extend(
                &mut facts,
                json!({ "picked": self.picked(&placed, place).map(|p| p.to_array()) }),
            );
        }
        Ok(Answer { octets: wire::plot(&plot, asked.seq), facts })
    }

    /// A draft of the drawing, quickly.
    pub(super) fn drag(&mut self, asked: &Asked) -> Result<Answer, Fault> {
        let composed = self.composed(asked)?;
        let (job, _) = self.job(&composed, Format::Svg)?;
        if self.key != self.key_of(&composed) {
            self.ready(&composed, &job, &mut Kept::default(), Box::new(|_, _| ()))?;
        }
        let Turned { lines, camera, page, sheet, plot } = match (&job, &mut self.subject) {
            (Job::Draw(job), Subject::Scene(live)) => job.turned(live)?,
            (Job::Surface(job), Subject::Surface(live)) => job.turned(live)?,
            _ => return Err(Fault::of("nothing is shown")),
        };
        let (pens, by_kind) = pens_by_kind(&plot.pens, plot.pen_width_mm);
        let pens: Vec<PenFacts> = pens
            .iter()
            .map(|rule| PenFacts {
                number: rule.number,
                name: "visible",
                width: rule.pen.width_mm,
                color: &rule.pen.color,
            })
            .collect();
        let facts = facts(asked.seq, &Placed { camera, page, sheet }, &pens);
        let pen = |kind: u32| by_kind.get(kind as usize).copied().unwrap_or(0);
        Ok(Answer { octets: wire::draft(&lines, asked.seq, pen), facts })
    }

    /// The content of a file: what the command that is shown would write.
    pub(super) fn file(
        &mut self,
        asked: &Asked,
        format: Format,
        listener: Listener,
    ) -> Result<(String, Vec<u8>), Fault> {
        let composed = self.composed(asked)?;
        let (job, output) = self.job(&composed, format)?;
        let mut kept = Kept { wants_bytes: true, ..Kept::default() };
        self.ready(&composed, &job, &mut kept, Box::new(|_, _| ()))?;
        self.run(&job, &mut kept, listener)?;
        Ok((output, kept.bytes))
    }

    fn command(&self, name: &str) -> &Command {
        let [draw, surface] = &self.commands;
        if name == DRAW { draw } else { surface }
    }

    /// What the page requests as a command.
    fn composed(&self, asked: &Asked) -> Result<Composed, Fault> {
        let command = self.command(self.typed.name);
        let mut composed = self.typed.clone();
        let mut all = serde_json::Map::new();
        let is_of_camera = |name: &str| {
            option(command, name).is_some_and(|arg| arg.get_help_heading() == Some("Camera"))
        };
        let typed = self.typed.options.iter();
        let typed = typed.filter(|(name, _)| option(command, name).is_some_and(is_on_page));
        let typed = typed.map(|(name, values)| (name.clone(), described(values)));
        let (of_camera, others): (Vec<_>, Vec<_>) = typed.partition(|(name, _)| is_of_camera(name));
        for (given, typed) in [(&asked.camera, of_camera), (&asked.options, others)] {
            match given {
                None => all.extend(typed),
                Some(Value::Object(given)) => all.extend(given.clone()),
                Some(_) => return Err(Fault::of("`camera` and `options` must be objects")),
            }
        }
        if asked.camera.is_some() {
            // A camera from a file is the one that was looked from first.
            composed.options.remove("camera");
        }
        composed.with(command, &Value::Object(all)).map_err(Fault::of)
    }

    /// The command as a checked job, and the name of the file that it writes.
    fn job(&self, composed: &Composed, format: Format) -> Result<(Job, String), Fault> {
        super::fault::check_formulas(composed)?;
        let extension = format.extensions().first().copied().unwrap_or("svg");
        let output = format!("{}.{extension}", composed.file_stem());
        let command = self.command(composed.name);
        let mut arguments = composed.arguments(command);
        config::type_instead(arguments.clone());
        // The format alone: where the file goes does not matter.
        arguments.push(format!("--format={}", format.name()).into());
        let matches = command.clone().try_get_matches_from(arguments)?;
        let refused = |refused: Refused| match refused {
            Refused::Usage(message) => Fault::of(message),
            Refused::Failed(error) => Fault::of(error.to_string()),
        };
        let job = if composed.name == DRAW {
            let job = DrawArgs::from_arg_matches(&matches)?.job(Vec::new()).map_err(refused)?;
            Job::Draw(Box::new(job.holding(self.held.clone())))
        } else {
            let job = SurfaceArgs::from_arg_matches(&matches)?.job(Vec::new()).map_err(refused)?;
            Job::Surface(Box::new(job))
        };
        Ok((job, output))
    }

    /// The command as it is shown.
    fn shown(&self, composed: &Composed, output: &str) -> String {
        let arguments = composed.arguments(self.command(composed.name));
        format!("{} -o {}", source::source(arguments.into_iter()), source::quoted(output))
    }

    /// Everything that says what is shown.
    fn key_of(&self, composed: &Composed) -> String {
        let command = self.command(composed.name);
        let of_subject = |name: &str| {
            let group = option(command, name).and_then(|arg| arg.get_help_heading());
            OF_MESH.contains(&name) || group.is_some_and(|group| OF_SUBJECT.contains(&group))
        };
        let options: Vec<_> =
            composed.options.iter().filter(|(name, _)| of_subject(name)).collect();
        let revision = self.revision.load(Ordering::Acquire);
        format!("{revision} {} {:?} {options:?}", composed.name, composed.subjects)
    }

    /// Makes what is shown ready for a job: read, if it is not yet.
    fn ready(
        &mut self,
        composed: &Composed,
        job: &Job,
        kept: &mut Kept,
        listener: Listener,
    ) -> Result<(), Fault> {
        let key = self.key_of(composed);
        let known = std::mem::replace(&mut self.subject, Subject::None);
        let known = if std::mem::take(&mut self.key) == key { known } else { Subject::None };
        let mut run = Run::in_memory(job.output(), Progress::heard_by(listener), kept);
        let subject = match (job, known) {
            (Job::Draw(job), known) => {
                let known = if let Subject::Scene(live) = known { Some(*live) } else { None };
                Subject::Scene(Box::new(job.live(known, &mut run)?))
            }
            (Job::Surface(job), known) => {
                let known = if let Subject::Surface(live) = known { Some(*live) } else { None };
                Subject::Surface(Box::new(job.live(known, &mut run)?))
            }
        };
        let seconds = run.stats.seconds;
        drop(run);
        kept.stats.seconds = seconds;
        (self.subject, self.key) = (subject, key);
        Ok(())
    }

    fn run(&self, job: &Job, kept: &mut Kept, listener: Listener) -> Result<(), Fault> {
        let run = Run::in_memory(job.output(), Progress::heard_by(listener), kept);
        match (job, &self.subject) {
            (Job::Draw(job), Subject::Scene(live)) => job.draw_live(live, run)?,
            (Job::Surface(job), Subject::Surface(live)) => job.draw_live(live, run)?,
            _ => return Err(Fault::of("nothing is shown")),
        }
        Ok(())
    }

    /// The point of the surface that is seen at a place on the page.
    fn picked(&self, placed: &Placed, [x_mm, y_mm]: [f64; 2]) -> Option<DVec3> {
        let image = placed.sheet.page_from_image.inverse().transform_point2((x_mm, y_mm).into());
        let scene = match &self.subject {
            Subject::Scene(live) => live.scene(),
            Subject::Surface(live) => live.scene()?,
            Subject::None => return None,
        };
        nearest_hit(scene, &placed.camera, image)
    }
}

impl Job {
    fn output(&self) -> &OutputOptions {
        match self {
            Self::Draw(job) => job.output(),
            Self::Surface(job) => job.output(),
        }
    }
}

impl From<Box<dyn Error>> for Fault {
    fn from(error: Box<dyn Error>) -> Self {
        Self::of(error.to_string())
    }
}

/// The values of an option as the page takes them.
fn described(values: &[OsString]) -> Value {
    match values {
        [] => Value::Bool(true),
        [value] => Value::String(value.to_string_lossy().into_owned()),
        values => values.iter().map(|value| value.to_string_lossy()).collect(),
    }
}
