//! From a drawing to a file: placed on the page, joined and ordered, written, and reported.

use std::borrow::Borrow;
use std::error::Error;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::time::Instant;

use hiddenline::stages::axes::AxesBox;
use hiddenline::stages::camera::Camera;
use hiddenline::stages::extent::Extent;
use hiddenline::stages::optimize::estimate::PenWork;
use hiddenline::stages::optimize::{Effort, OptimizeOptions};
use hiddenline::stages::page::{Page, PageError, PageOptions, Placement, PlotOptions, crop_to};
use hiddenline::stages::plot::Plot;
use hiddenline::stages::strokes::{HiddenLines, Strokes};
use hiddenline::stages::timing::{Seconds, timed};
use hiddenline::stages::write::dxf::DxfScale;
use hiddenline::stages::write::png::PngError;
use hiddenline::stages::write::{Format, Target, WriteError, hpgl, json, write};

use super::messages::counted;
use super::output::OutputOptions;
use super::plotting::Finished;
use super::progress::Progress;
use super::stats::{PlotStats, SmoothedStats, Stats, peak_bytes};
use super::{file, machine, messages};

/// What there is to report once all went well.
#[derive(Clone, Default)]
pub(super) struct Notes {
    pub(super) warnings: Vec<String>,
    /// What may help; unlike warnings, --strict lets them pass.
    pub(super) hints: Vec<String>,
    pub(super) summary: String,
    /// Millimeters in a model unit, where a model says so and --unit does not.
    pub(super) unit_mm: Option<f64>,
    /// What refining curved parts did.
    pub(super) smoothed: Option<SmoothedStats>,
    /// What axes go around, if a surface was read.
    pub(super) axes_box: Option<AxesBox>,
}

impl Notes {
    /// Adds more to report.
    pub(super) fn add(&mut self, other: Self) {
        self.warnings.extend(other.warnings);
        self.hints.extend(other.hints);
        self.summary.push_str(&other.summary);
        self.smoothed = other.smoothed.or(self.smoothed);
    }
}

/// A run of a command, from its start to its summary.
pub(super) struct Run<'a> {
    pub(super) output: &'a OutputOptions,
    pub(super) start: Instant,
    pub(super) progress: Progress,
    pub(super) stats: Stats,
    pub(super) notes: Notes,
    /// Millimeters of a model unit, for scales in messages.
    pub(super) unit_mm: f64,
    /// What coordinates in DXF mean.
    pub(super) dxf_scale: DxfScale,
    /// Why there are no strokes, in case there are none.
    pub(super) empty_because: String,
    /// Where the result goes instead of a file, and what there is to tell instead of the terminal.
    pub(super) kept: Option<&'a mut Kept>,
}

/// The result of a run in memory.
#[derive(Default)]
pub(super) struct Kept {
    /// Whether the file's content is wanted, rather than the plot.
    pub(super) wants_bytes: bool,
    /// The file's content, if wanted.
    pub(super) bytes: Vec<u8>,
    /// The plot as it would be written.
    pub(super) plot: Option<Plot>,
    /// The page that it is on.
    pub(super) sheet: Option<PlacedPage>,
    pub(super) notes: Notes,
    pub(super) stats: Stats,
}

/// A page, and what it shows from where.
#[derive(Clone)]
pub(super) struct PlacedPage {
    pub(super) camera: Camera,
    pub(super) page: Page,
    pub(super) extent: Extent,
    pub(super) options: PageOptions,
}

impl PlacedPage {
    /// The page for what takes up `extent` of the image.
    pub(super) fn new(
        extent: Extent,
        camera: Camera,
        options: &PageOptions,
    ) -> Result<Self, String> {
        let page = placed(&extent, &camera, options)?;
        Ok(Self { camera, page, extent, options: *options })
    }

    /// The largest scale at which nothing is cut off, as typed on the command line, if a scale was
    /// given.
    fn largest_scale(&self, unit_mm: f64) -> Option<String> {
        let Placement::Scale { mm_per_unit } = self.options.placement else { return None };
        let fit = PageOptions { placement: Placement::Fit, ..self.options };
        let fit = Page::place(&self.extent, &self.camera, &fit).ok()?.mm_per_image_unit();
        let scale = fit / self.page.mm_per_image_unit() * mm_per_unit / unit_mm;
        // Rounded down to three digits, so that it does fit.
        let rounded = |x: f64, up: bool| {
            let power = libm::pow(10.0, libm::floor(libm::log10(x)) - 2.0);
            let digits = if up { (x / power).ceil() } else { (x / power).floor() };
            // Dividing by a whole number rounds once.
            if power < 1.0 { digits / libm::round(1.0 / power) } else { digits * power }
        };
        if !(scale > 0.0 && scale.is_finite()) {
            return None;
        }
        let (large, small) = (rounded(scale, false), rounded(1.0 / scale, true));
        Some(if scale >= 1.0 { format!("{large}:1") } else { format!("1:{small}") })
    }
}

/// Places a page; errors come with the options that mend them.
pub(super) fn placed(
    extent: &Extent,
    camera: &Camera,
    options: &PageOptions,
) -> Result<Page, String> {
    Page::place(extent, camera, options).map_err(|error| page_error(&error))
}

/// An error about the page, with the options that mend it.
pub(super) fn page_error(error: &PageError) -> String {
    match error {
        PageError::Margins { .. } => {
            format!("{error}; use a smaller --margin or a larger --page")
        }
        PageError::NoFieldOfView => format!("{error}; use --projection perspective"),
        PageError::NegativeMargin(_) | PageError::Scale => error.to_string(),
    }
}

/// Refuses to send a picture to a terminal.
pub(super) fn check_terminal(output: &OutputOptions) -> Result<(), Box<dyn Error>> {
    if output.path.is_some() || !io::stdout().is_terminal() {
        return Ok(());
    }
    if output.format.is_binary() {
        return Err("this format cannot be written to the terminal; use -o FILE".into());
    }
    if !output.is_dash {
        return Err("standard output is the terminal; use -o FILE, or -o - to see the text".into());
    }
    Ok(())
}

/// Sets how many threads work; `None` is one for each core.
pub(super) fn start_threads(threads: Option<usize>) -> Result<Stats, Box<dyn Error>> {
    if let Some(threads) = threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    }
    Ok(Stats { threads: rayon::current_num_threads(), ..Stats::default() })
}

impl<'a> Run<'a> {
    /// A run with nothing done yet.
    pub(super) fn start(output: &'a OutputOptions) -> Result<Self, Box<dyn Error>> {
        check_terminal(output)?;
        let stats = start_threads(output.threads)?;
        let notes = Notes { warnings: output.warnings.clone(), ..Notes::default() };
        Ok(Self { progress: Progress::new(output.quiet), notes, ..Self::silent(output, stats) })
    }

    /// One of many runs at once, which does not show its progress.
    pub(super) fn silent(output: &'a OutputOptions, stats: Stats) -> Self {
        Self {
            output,
            start: Instant::now(),
            progress: Progress::new(true),
            stats,
            notes: Notes::default(),
            unit_mm: 1.0,
            empty_because: "nothing is in view".to_owned(),
            dxf_scale: DxfScale::default(),
            kept: None,
        }
    }

    /// A run that writes no file, prints nothing, and leaves its result in `kept`.
    #[cfg(feature = "view")]
    pub(super) fn in_memory(
        output: &'a OutputOptions,
        progress: Progress,
        kept: &'a mut Kept,
    ) -> Self {
        Self {
            output,
            start: Instant::now(),
            progress,
            stats: Stats { threads: rayon::current_num_threads(), ..Stats::default() },
            notes: Notes { warnings: output.warnings.clone(), ..Notes::default() },
            unit_mm: 1.0,
            dxf_scale: DxfScale::default(),
            empty_because: "nothing is in view".to_owned(),
            kept: Some(kept),
        }
    }

    /// Puts `drawing` on paper, or writes its strokes as JSON, and ends the run. Strokes that are given away
    /// are dropped as soon as they are on paper.
    pub(super) fn draw(
        self,
        drawing: impl Borrow<Strokes>,
        sheet: &PlacedPage,
        plot: PlotOptions,
        usual: &OptimizeOptions,
    ) -> Result<(), Box<dyn Error>> {
        let path = self.output.path.as_deref();
        self.draw_to(path, drawing, sheet, plot, usual).map(Report::tell)
    }

    /// The same to another file than the output's; what there is to report is returned.
    pub(super) fn draw_to(
        mut self,
        path: Option<&Path>,
        drawing: impl Borrow<Strokes>,
        sheet: &PlacedPage,
        plot: PlotOptions,
        usual: &OptimizeOptions,
    ) -> Result<Report, Box<dyn Error>> {
        if let Some(kept) = &mut self.kept {
            kept.sheet = Some(sheet.clone());
        }
        let given = drawing;
        let drawing = given.borrow();
        let PlacedPage { camera, page, .. } = sheet;
        let paper = page.paper.description();
        if self.output.format == Format::Json {
            let what = Written { paper: &paper, contents: drawing_described(drawing) };
            return self.report(path, what, drawing.is_empty(), None, |out| {
                json::write(drawing, camera, page.page_from_image, out).map(|()| Seconds::default())
            });
        }
        if !drawing.is_empty() {
            let has_hidden = plot.hidden != HiddenLines::None;
            let idle = self.output.plotting.idle_pens(drawing, has_hidden);
            self.notes.warnings.extend(idle);
        }
        self.progress.stage("placing");
        let seconds = &mut self.stats.seconds.write;
        let placed = timed(seconds, || page.plot(drawing, plot));
        drop(given);
        if placed.cropped {
            let fitting = sheet.largest_scale(self.unit_mm);
            let hint = fitting.map(|scale| format!("; the largest scale that fits is {scale}"));
            let hint = hint.unwrap_or_default();
            self.notes.warnings.push(format!("lines were cut off at the margins{hint}"));
        }
        if placed.cropped {
            self.empty_because = "all of it lies beyond the margins".to_owned();
        }
        self.report_plot(path, &paper, placed.plot, usual)
    }

    /// Joins, orders and writes a page, and ends the run.
    pub(super) fn plot(
        self,
        paper: &str,
        plot: Plot,
        usual: &OptimizeOptions,
    ) -> Result<(), Box<dyn Error>> {
        let path = self.output.path.as_deref();
        self.plot_to(path, paper, plot, usual)
    }

    /// The same to another file than the output's.
    pub(super) fn plot_to(
        self,
        path: Option<&Path>,
        paper: &str,
        plot: Plot,
        usual: &OptimizeOptions,
    ) -> Result<(), Box<dyn Error>> {
        self.report_plot(path, paper, plot, usual).map(Report::tell)
    }

    fn report_plot(
        mut self,
        path: Option<&Path>,
        paper: &str,
        plot: Plot,
        usual: &OptimizeOptions,
    ) -> Result<Report, Box<dyn Error>> {
        let output = self.output;
        let plot = match output.plotter() {
            Some(plotter) => {
                let reach = hpgl::LoadedPlotter::on(&plot, plotter.clone(), None)?.reach(&plot);
                let cropped = crop_to(plot, reach);
                let lost = machine::lost_ink(&cropped);
                self.notes.warnings.extend(lost.map(|lost| {
                    format!(
                        "{lost} cut off: {} does not reach that far; make the drawing smaller \
                         or the margin wider",
                        plotter.title
                    )
                }));
                self.notes.warnings.extend(machine::unkept_controls(&cropped.plot, plotter));
                cropped.plot
            }
            None => plot,
        };
        self.progress.stage("ordering strokes");
        let mut order_seconds = 0.0;
        let Finished { plot, stats, n_changes } = timed(&mut order_seconds, || {
            let progress = &self.progress;
            output.plotting.finish(plot, &output.motion, usual, &mut |share| progress.share(share))
        });
        self.stats.seconds.order += order_seconds;
        self.stats.plot = Some(stats);
        let done = Done { stats, n_changes, order_seconds };
        self.notes.warnings.extend(alike_pens(&plot));
        let mut plot = plot;
        if output.format == Format::Dxf {
            plot.layers.retain(|layer| !layer.lines.is_empty());
        }
        let is_empty =
            plot.layers.iter().all(|layer| layer.lines.is_empty() && layer.fills.is_empty());
        let what = Written { paper, contents: described(&plot, &done) };
        if let Some(kept) = self.kept.take_if(|kept| !kept.wants_bytes) {
            if is_empty {
                self.notes.warnings.push(format!("the drawing is empty: {}", self.empty_because));
            }
            self.stats.seconds.total = self.start.elapsed().as_secs_f64();
            kept.plot = Some(plot);
            (kept.notes, kept.stats) = (self.notes, self.stats);
            return Ok(Report::default());
        }
        let target = match &output.target {
            Some(Target::Dxf(_)) => Target::Dxf(self.dxf_scale),
            Some(target) => target.clone(),
            None => return Err(WriteError::OnlyStrokes.into()),
        };
        let written = &plot;
        self.report(path, what, is_empty, Some(done), |out| -> Result<Seconds, OutputError> {
            write(written, &target, out)?;
            Ok(Seconds::default())
        })
    }

    /// Writes a file and ends the run. What `write` spent on other stages than writing it returns.
    pub(super) fn write<E: From<io::Error> + Error + 'static>(
        self,
        path: Option<&Path>,
        what: Written,
        is_empty: bool,
        done: Option<Done>,
        write: impl FnOnce(&mut dyn Write) -> Result<Seconds, E>,
    ) -> Result<(), Box<dyn Error>> {
        self.report(path, what, is_empty, done, write).map(Report::tell)
    }

    fn report<E: From<io::Error> + Error + 'static>(
        mut self,
        path: Option<&Path>,
        what: Written,
        is_empty: bool,
        done: Option<Done>,
        write: impl FnOnce(&mut dyn Write) -> Result<Seconds, E>,
    ) -> Result<Report, Box<dyn Error>> {
        if is_empty {
            self.notes.warnings.push(format!("the drawing is empty: {}", self.empty_because));
        }
        if self.output.strict && !self.notes.warnings.is_empty() {
            drop(self.progress);
            self.notes.warnings.iter().for_each(|warning| messages::warning(warning));
            return Err("--strict treats warnings as errors; nothing was written".into());
        }
        self.progress.stage("writing");
        let mut write_seconds = 0.0;
        let mut spent = Seconds::default();
        let write = |out: &mut dyn Write| -> Result<(), E> {
            spent = write(out)?;
            Ok(())
        };
        timed(&mut write_seconds, || -> Result<(), Box<dyn Error>> {
            match (path, &mut self.kept) {
                (_, Some(kept)) => Ok(write(&mut kept.bytes)?),
                (None, None) => Ok(file::write_to_stdout(write)?),
                (Some(path), None) => file::write_to_file(path, write)
                    .map_err(|error| format!("cannot write {}: {error}", path.display()).into()),
            }
        })?;
        drop(self.progress);
        let (output, stats) = (self.output, &mut self.stats);
        let elsewhere = Seconds { write: 0.0, ..spent };
        stats.seconds += elsewhere;
        stats.seconds.write += (write_seconds - elsewhere.sum()).max(0.0);
        stats.seconds.total = self.start.elapsed().as_secs_f64();
        if let Some(kept) = self.kept {
            (kept.notes, kept.stats) = (self.notes, self.stats);
            return Ok(Report::default());
        }
        stats.peak_bytes = peak_bytes();
        let mut report = Report::default();
        if !output.quiet {
            report.warnings = self.notes.warnings;
            report.hints = self.notes.hints;
            report.lines.extend(Some(self.notes.summary).filter(|summary| !summary.is_empty()));
            let name = path.map_or("<stdout>".into(), Path::to_string_lossy);
            report.lines.push(format!("{name}  {}{}", what.paper, what.contents));
            if output.verbose {
                tell_more(output, stats, done.as_ref(), &mut report.lines);
            }
        }
        stats.smoothed = self.notes.smoothed;
        if output.stats {
            report.lines.push(serde_json::to_string(stats)?);
        }
        Ok(report)
    }
}

/// What a run has to tell when all went well.
#[derive(Default)]
pub(super) struct Report {
    warnings: Vec<String>,
    hints: Vec<String>,
    lines: Vec<String>,
}

impl Report {
    /// Tells it.
    pub(super) fn tell(self) {
        self.warnings.iter().for_each(|warning| messages::warning(warning));
        self.hints.iter().for_each(|hint| messages::hint(hint));
        self.lines.iter().for_each(messages::plain);
    }
}

/// Why a plot is not written, with the options that mend it.
#[derive(Debug, thiserror::Error)]
enum OutputError {
    #[error("{0}")]
    Io(#[from] io::Error),
    #[error("{}", with_remedy(.0))]
    Write(#[source] WriteError),
}

impl From<WriteError> for OutputError {
    fn from(error: WriteError) -> Self {
        match error {
            WriteError::Io(error) => Self::Io(error),
            error => Self::Write(error),
        }
    }
}

fn with_remedy(error: &WriteError) -> String {
    match error {
        WriteError::Png(PngError::Size { .. }) => {
            format!("{error}; use another --dpi or --png-width")
        }
        _ => error.to_string(),
    }
}

/// What a file holds, for the message about it.
pub(super) struct Written<'a> {
    /// The size of the paper or picture.
    pub(super) paper: &'a str,
    pub(super) contents: String,
}

/// What joining and ordering did.
pub(super) struct Done {
    stats: PlotStats,
    n_changes: u64,
    order_seconds: f64,
}

/// What each pen draws and how long it all takes.
fn described(plot: &Plot, done: &Done) -> String {
    let mut text: String = plot
        .plotted_layers()
        .map(|layer| {
            if !layer.fills.is_empty() {
                let areas = counted(layer.fills.len(), "area", "areas");
                return format!("  {} {areas}", layer.name);
            }
            let meters = layer.lines.length_mm() / 1000.0;
            let strokes = counted(layer.lines.len(), "stroke", "strokes");
            format!("  {} {strokes} {meters:.1} m", layer.name)
        })
        .collect();
    let has_lines = plot.layers.iter().any(|layer| !layer.lines.is_empty());
    let PlotStats { before, after } = &done.stats;
    if has_lines {
        text.push_str(&format!(", {}", brief(after)));
        if before != after {
            text.push_str(&format!(
                "  (before: {} {:.1} m, {})",
                counted(before.strokes, "stroke", "strokes"),
                before.down_m,
                brief(before)
            ));
        }
    }
    text
}

/// How many strokes there are.
fn drawing_described(drawing: &Strokes) -> String {
    let n_hidden = drawing.iter().filter(|stroke| stroke.qi > 0).count();
    let visible = counted(drawing.len() - n_hidden, "stroke", "strokes");
    match n_hidden {
        0 => format!("  visible {visible}"),
        _ => format!("  visible {visible}  hidden {}", counted(n_hidden, "stroke", "strokes")),
    }
}

fn brief(work: &PenWork) -> String {
    let lifts = counted(work.lifts, "lift", "lifts");
    format!("pen-up {:.2} m, {lifts}, about {}", work.up_m, duration(work.minutes))
}

/// Minutes as people say them: `2.5 min`, `45 min`, `2 h 23 min`.
fn duration(minutes: f64) -> String {
    let whole = minutes.round();
    if minutes < 9.95 {
        format!("{minutes:.1} min")
    } else if whole < 60.0 {
        format!("{whole} min")
    } else {
        format!("{} h {} min", (whole / 60.0).floor(), whole % 60.0)
    }
}

/// What `--verbose` adds.
fn tell_more(output: &OutputOptions, stats: &Stats, done: Option<&Done>, lines: &mut Vec<String>) {
    let seconds = &stats.seconds;
    if !stats.engine.is_empty() {
        lines.push(format!(
            "engine {}, {}, {}, {} of {} edges drawn",
            stats.engine,
            counted(stats.threads, "thread", "threads"),
            counted(stats.triangles, "triangle", "triangles"),
            stats.drawn_edges,
            stats.edges
        ));
    }
    lines.push(format!(
        "read {:.3} s, topology {:.3} s, classify {:.3} s, visibility {:.3} s, strokes {:.3} s, \
         order {:.3} s, write {:.3} s, total {:.3} s",
        seconds.read,
        seconds.topology,
        seconds.classify,
        seconds.visibility,
        seconds.strokes,
        seconds.order,
        seconds.write,
        seconds.total
    ));
    if let (Some(done), Some(Effort::Within(limit))) = (done, output.plotting.effort()) {
        lines.push(format!(
            "ordering tried {} changes in {:.1} of {:.1} s",
            done.n_changes,
            done.order_seconds,
            limit.as_secs_f64()
        ));
    }
}

/// Pens that programs which distinguish pens by color would take for one.
fn alike_pens(plot: &Plot) -> Option<String> {
    let layers = plot.plotted_layers().enumerate();
    let mut pairs =
        layers.flat_map(|(i, a)| plot.plotted_layers().skip(i + 1).map(move |b| (a, b)));
    pairs.find(|(a, b)| a.pen.color == b.pen.color && a.pen.width_mm != b.pen.width_mm).map(
        |(a, b)| {
            format!(
                "pens {} and {} have the same color; software that sorts by color treats them as \
                 one pen",
                a.number, b.number
            )
        },
    )
}
