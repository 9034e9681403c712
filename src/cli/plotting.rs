//! Pens, joining and stroke order, for all commands.

use std::path::PathBuf;

use clap::Args;
use hiddenline::stages::optimize::estimate::{self, Motion, PenWork};
use hiddenline::stages::optimize::{
    Effort, OptimizeOptions, Watch, optimize_watched, split_by_distance,
};
use hiddenline::stages::page::{
    LayerControls, PenRole, PenRule, default_pen_color, hatch_width_mm, idle_pens,
};
use hiddenline::stages::plot::{Pen, Plot};
use hiddenline::stages::strokes::{StrokeKind, Strokes};
use hiddenline::stages::write::Format;

use super::config;
use super::machine::{Machine, MachineError};
use super::stats::PlotStats;
use super::values::{self, PenText};

#[derive(Args)]
#[command(next_help_heading = "Pens and plotter")]
pub(super) struct PlotArgs {
    /// Effort spent reducing pen-up travel: none, fast, best, or a time limit such as 10s
    ///
    /// The strokes of each pen are joined into as few as possible, overlapping ink is drawn once, and then
    /// the stroke order is chosen. Except with a time limit, the result is always the same. The default is
    /// fast; large function surfaces are already drawn line by line.
    #[arg(long, value_name = "EFFORT", value_parser = values::effort)]
    optimize: Option<Effort>,
    /// Remove points closer than this to the simplified line; joints are kept
    #[arg(long, value_name = "MM", value_parser = values::length, default_value = "0")]
    simplify: f64,
    /// Join strokes whose ends are this close
    ///
    /// By default, drawings of models join equal ends only, and drawings read from SVG join ends that
    /// are equal within the rounding of the file.
    #[arg(long, value_name = "MM", value_parser = values::length)]
    join_tolerance: Option<f64>,
    /// Leave out ink this close to other ink in the same direction
    ///
    /// The default is half the pen width for drawings of models. For drawings read from SVG it is
    /// 0: only exactly collinear ink is left out.
    #[arg(long, value_name = "MM", value_parser = values::length)]
    overlap_tolerance: Option<f64>,
    /// Start a new layer, between strokes, once the pen has drawn this far; 10m is ten meters
    #[arg(long, value_name = "LENGTH", value_parser = values::distance)]
    split_distance: Option<f64>,
    /// Also cut strokes at --split-distance, and start the next layer this far before the cut
    #[arg(long, value_name = "MM", value_parser = values::length, requires = "split_distance")]
    split_overlap: Option<f64>,
    /// Machine to write HPGL or G-code for, and to estimate plotting time for
    ///
    /// HPGL: hp7475a (default), hp7440a, hp7550, designmate, artisan, dmp-161, dxy, sketchmate. G-code:
    /// grbl-servo (default), grbl-z, grbl-laser, marlin. For estimates only: saxi (default), axidraw, grbl.
    /// Configuration files can define more: [machine.NAME].
    #[arg(long, value_name = "NAME", conflicts_with = "gcode_profile")]
    machine: Option<String>,
    /// Templates for your own G-code machine, as TOML
    #[arg(long, value_name = "FILE")]
    gcode_profile: Option<PathBuf>,
    /// The pen for visible or hidden lines, or for one kind of them: WHAT=NUMBER[:WIDTH[:COLOR]]
    ///
    /// As in visible=1:0.3mm:black; may be repeated. Each number is a layer. For AxiDraw, speed=PERCENT,
    /// height=PERCENT, delay=MS and pause may follow, as in visible=1:0.3mm:black:speed=30:pause; they are
    /// written into the layer's label in SVG. WHAT is visible, hidden, outline, hidden1, hidden2 … for lines
    /// behind that many faces, or a kind of line. For surfaces it can also be x, y, sheet2 for all lines of
    /// the second sheet, or both, as in sheet2.level. The most specific rule applies.
    #[arg(long = "pen", value_name = "PEN", value_parser = values::pen)]
    pens: Vec<PenText>,
}

/// How strokes are joined, ordered and given to pens.
#[derive(Default)]
pub(super) struct Plotting {
    /// Whether they are to be left as they are.
    exact: bool,
    /// Whether each kind of visible line has a layer, as CAD programs expect.
    apart_by_kind: bool,
    /// Effort spent reducing pen-up travel; `None` for the default.
    effort: Option<Effort>,
    simplify_mm: f64,
    join_tolerance_mm: Option<f64>,
    overlap_mm: Option<f64>,
    split_distance_mm: Option<f64>,
    split_overlap_mm: Option<f64>,
    pens: Vec<PenText>,
}

impl PlotArgs {
    /// The machine to write for.
    pub(super) fn machine(&self, format: Format) -> Result<Machine, MachineError> {
        Machine::new(format, self.machine.as_deref(), self.gcode_profile.as_deref())
    }

    /// Files that these options name.
    pub(super) fn inputs(&self) -> Vec<PathBuf> {
        self.gcode_profile.iter().cloned().collect()
    }

    /// What to say of an overlap that is too long for the distance.
    pub(super) fn shortened_overlap(&self) -> Option<String> {
        let (distance, overlap) = (self.split_distance?, self.split_overlap?);
        (2.0 * overlap > distance).then(|| {
            format!(
                "--split-overlap {overlap} is more than half of --split-distance: {} mm are used",
                distance / 2.0
            )
        })
    }

    /// What to say of controls of `--pen` that `format` has no place for.
    pub(super) fn idle_controls(&self, format: Format) -> Vec<String> {
        if !config::is_typed("--pen") {
            return Vec::new();
        }
        let is_hpgl = format == Format::Hpgl;
        let has =
            |is_set: fn(&LayerControls) -> bool| self.pens.iter().any(|p| is_set(&p.controls));
        let controls = [
            ("speed", is_hpgl, has(|controls| controls.speed.is_some())),
            ("height", false, has(|controls| controls.height.is_some())),
            ("delay", false, has(|controls| controls.delay_ms.is_some())),
            ("pause", is_hpgl || format == Format::Gcode, has(|controls| controls.pause)),
        ];
        let idle = controls.iter().filter(|(_, is_kept, is_set)| *is_set && !is_kept);
        let idle = idle.filter(|_| format != Format::Svg);
        idle.map(|(name, ..)| format!("{name} of --pen has no effect on {}", format.name()))
            .collect()
    }

    /// Checks what clap cannot; the error is a message about usage. With `exact`, strokes are to be left
    /// as they are.
    pub(super) fn options(self, exact: bool, format: Format) -> Result<Plotting, String> {
        for (i, pen) in self.pens.iter().enumerate() {
            let earlier = self.pens.iter().take(i).find(|other| other.number == pen.number);
            if let Some(other) = earlier {
                let differs = |a: bool, b: bool| a && b;
                if differs(pen.width_mm.is_some(), pen.width_mm != other.width_mm)
                    || differs(pen.color.is_some(), pen.color != other.color)
                {
                    let number = pen.number;
                    return Err(format!("pen {number} is given with different widths or colors"));
                }
            }
        }
        Ok(Plotting {
            exact,
            apart_by_kind: format == Format::Dxf,
            effort: self.optimize,
            simplify_mm: self.simplify,
            join_tolerance_mm: self.join_tolerance,
            overlap_mm: self.overlap_tolerance,
            split_distance_mm: self.split_distance,
            split_overlap_mm: self.split_overlap,
            pens: self.pens,
        })
    }
}

/// A page ready to be written.
pub(super) struct Finished {
    pub(super) plot: Plot,
    pub(super) stats: PlotStats,
    /// Random changes to the order that were tried.
    pub(super) n_changes: u64,
}

impl Plotting {
    /// Whether kinds of line or hidden levels have their own pens.
    pub(super) fn has_pens_by_kind(&self) -> bool {
        self.apart_by_kind || self.pens.iter().any(|pen| pen.drawn.tells_kinds_apart())
    }

    /// How close ink must be to other ink to be left out, if that was set.
    pub(super) fn overlap_mm(&self) -> Option<f64> {
        self.overlap_mm
    }

    /// Whether pens are given.
    pub(super) fn has_pens(&self) -> bool {
        !self.pens.is_empty()
    }

    /// The width of the pen that hatches; `width_mm` if it has none of its own.
    pub(super) fn hatch_width_mm(&self, width_mm: f64) -> f64 {
        hatch_width_mm(&self.pens(width_mm), width_mm)
    }

    /// Whether hidden lines have pens.
    pub(super) fn has_hidden_pens(&self) -> bool {
        self.pens.iter().any(|pen| pen.drawn.is_hidden())
    }

    /// Warnings about pens that were typed and draw none of the strokes.
    ///
    /// Without hidden lines in the drawing, a warning about `--pen hidden=…` is given elsewhere.
    pub(super) fn idle_pens(&self, strokes: &Strokes, has_hidden: bool) -> Vec<String> {
        if !config::is_typed("--pen") {
            return Vec::new();
        }
        let roles: Vec<PenRole> = self.pens.iter().map(|pen| pen.drawn).collect();
        let idle = idle_pens(&roles, strokes).into_iter();
        let idle = idle.filter(|role| has_hidden || !role.is_hidden());
        idle.map(|role| format!("--pen {}=… draws nothing: no strokes use it", role.name()))
            .collect()
    }

    /// Adds a pen like that of the visible lines for each kind of line that has none, if kinds are to
    /// be apart.
    pub(super) fn with_kinds_apart(&self, pens: Vec<PenRule>, width_mm: f64) -> Vec<PenRule> {
        let mut rules = pens;
        if !self.apart_by_kind {
            return rules;
        }
        let visible = rules.iter().find(|rule| rule.drawn == PenRole::Visible);
        let pen = visible.map_or(Pen { width_mm, ..Pen::default() }, |rule| rule.pen.clone());
        for drawn in StrokeKind::ALL.map(PenRole::Kind) {
            if rules.iter().all(|rule| rule.drawn != drawn) {
                let is_free = |number: &u32| rules.iter().all(|rule| rule.number != *number);
                let number = (1..).find(is_free).unwrap_or(1);
                let (pen, controls) = (pen.clone(), LayerControls::default());
                rules.push(PenRule { drawn, number, pen, controls });
            }
        }
        rules
    }

    /// Effort spent reducing pen-up travel, if it was given.
    pub(super) fn effort(&self) -> Option<Effort> {
        self.effort
    }

    /// The pens; `width_mm` is the width of those given without one.
    pub(super) fn pens(&self, width_mm: f64) -> Vec<PenRule> {
        let rule = |pen: &PenText| PenRule {
            drawn: pen.drawn,
            number: pen.number,
            controls: pen.controls,
            pen: Pen {
                width_mm: pen.width_mm.unwrap_or(width_mm),
                color: pen.color.clone().unwrap_or_else(|| default_pen_color(pen.number).into()),
            },
        };
        self.pens.iter().map(rule).collect()
    }

    /// Joins, simplifies, orders and splits the strokes; `usual` holds the defaults.
    pub(super) fn finish(
        &self,
        plot: Plot,
        motion: &Motion,
        usual: &OptimizeOptions,
        watch: &mut Watch<'_>,
    ) -> Finished {
        let work = |plot: &Plot| -> PenWork { estimate::estimate(plot, motion).work() };
        let options = OptimizeOptions {
            join_tolerance_mm: self.join_tolerance_mm.or(usual.join_tolerance_mm),
            overlap_mm: self.overlap_mm.unwrap_or(usual.overlap_mm),
            simplify_mm: self.simplify_mm,
            effort: self.effort.unwrap_or(usual.effort),
            ..*usual
        };
        let before = work(&plot);
        let (mut plot, after, n_changes) = if self.exact || options.is_idle() {
            (plot, before, 0)
        } else {
            let (plot, n_changes) = optimize_watched(&plot, &options, watch);
            let after = work(&plot);
            (plot, after, n_changes)
        };
        if let Some(distance_mm) = self.split_distance_mm {
            plot = split_by_distance(&plot, distance_mm, self.split_overlap_mm);
        }
        Finished { plot, stats: PlotStats { before, after }, n_changes }
    }
}
