//! HPGL for real pen plotters: whole units, y up, nothing beyond the machine's hard clip limits.
//!
//! Positions are rounded before they are subtracted, so errors do not add up along a stroke.
//! Instructions are short, since plotters of that age have buffers of a few hundred bytes. Of the
//! controls in a layer's label, `!` becomes the machine's pause and `+S` a pen speed, where the machine
//! has them. No crate writes HPGL.

use std::collections::{BTreeMap, BTreeSet};
use std::io;

use glam::{DVec2, dvec2};
use serde::Deserialize;

use super::clip::clip;
use super::{Format, only_lines};
use crate::plot::{Layer, Plot};

/// Points in one `PD` instruction.
const MAX_POINTS: usize = 16;
/// Millimeters by which a page may differ from the paper it is drawn on.
const SIZE_TOLERANCE_MM: f64 = 1.0;

/// Plotter units by which a point may lie beyond the hard clip limits: it is rounded to the limit.
const AT_LIMIT: f64 = 0.49;

/// A plotter.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plotter {
    /// Name on the command line.
    pub name: String,
    /// Name on the machine.
    pub title: String,
    /// Plotter unit in millimeters.
    pub unit: f64,
    /// Where unit, limits and pens are documented.
    #[serde(default)]
    pub manual: String,
    /// Pens it holds.
    pub pens: u32,
    /// Value of `VS`, the pen speed in cm/s; `None` leaves it to the machine.
    #[serde(default)]
    pub speed: Option<u32>,
    /// Value of `FS`, the pen force in steps of the machine; `None` leaves it to the machine.
    #[serde(default)]
    pub force: Option<u32>,
    /// Slowest and fastest speed that `VS` takes, in cm/s; `None` if there is no `VS`.
    #[serde(default)]
    pub speeds: Option<[u32; 2]>,
    /// Lowest and highest force that `FS` takes; `None` if there is no `FS`.
    #[serde(default)]
    pub forces: Option<[u32; 2]>,
    /// Instruction that stops the machine until someone presses a button, with its semicolon.
    #[serde(default)]
    pub pause: Option<String>,
    /// Paper sizes that it takes.
    pub paper: Vec<PlotterPaper>,
}

/// A paper in a plotter.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlotterPaper {
    /// Names, the most common one first.
    pub names: Vec<String>,
    /// Notes on setup and use.
    #[serde(default)]
    pub note: String,
    /// Width and height in millimeters.
    pub size: [f64; 2],
    /// Hard clip limits along x in plotter units.
    pub x: [i32; 2],
    /// Hard clip limits along y in plotter units.
    pub y: [i32; 2],
    /// Where plotter position (0, 0) is, in millimeters from the top left corner.
    pub origin: [f64; 2],
    /// Whether the page is drawn upside down.
    #[serde(default)]
    pub turned: bool,
    /// Argument of `PS`.
    #[serde(default)]
    pub ps: Option<u32>,
    /// Where the pen is left, in plotter units.
    pub park: [i32; 2],
}

/// The default plotter for HPGL.
pub const DEFAULT_MACHINE: &str = "hp7475a";

/// A plotter with a paper in it: what [`write()`] draws on.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedPlotter {
    /// The plotter.
    pub machine: Plotter,
    /// The paper.
    pub paper: PlotterPaper,
}

/// Why a page cannot be drawn on a plotter.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlotterError {
    /// No such plotter.
    #[error("unknown plotter {name:?}; choose from {known}")]
    UnknownMachine {
        /// The requested name.
        name: String,
        /// All names.
        known: String,
    },
    /// No such paper.
    #[error("{machine} has no paper called {name:?}; choose from {known}")]
    UnknownPaper {
        /// The plotter.
        machine: String,
        /// The requested name.
        name: String,
        /// All names.
        known: String,
    },
    /// No paper as large as the page.
    #[error(
        "{machine} does not take paper of {} × {} mm; choose from {known}",
        (1e3 * width_mm).round() / 1e3,
        (1e3 * height_mm).round() / 1e3
    )]
    NoPaperOfSize {
        /// The plotter.
        machine: String,
        /// The page's width.
        width_mm: f64,
        /// The page's height.
        height_mm: f64,
        /// All names.
        known: String,
    },
    /// A layer's number is beyond the plotter's pens.
    #[error("layer {layer} needs a pen that {machine} does not have: it holds {pens}")]
    NoSuchPen {
        /// The plotter.
        machine: String,
        /// The layer's number.
        layer: u32,
        /// How many pens there are.
        pens: u32,
    },
    /// A drawing has more layers and colors than the plotter has pens.
    #[error("the drawing needs {needed} pens and {machine} holds {pens}")]
    TooManyPens {
        /// The plotter.
        machine: String,
        /// How many pens the drawing needs.
        needed: usize,
        /// How many pens there are.
        pens: u32,
    },
    /// The machine does not take this pen speed or force.
    #[error("{machine} takes a pen {what} of {low} to {high}, not {value}")]
    OutOfRange {
        /// The plotter.
        machine: String,
        /// `speed` or `force`.
        what: &'static str,
        /// The value requested.
        value: u32,
        /// The lowest value it takes.
        low: u32,
        /// The highest value it takes.
        high: u32,
    },
    /// A list of plotters is not valid TOML.
    #[error("plotter profiles: {0}")]
    Toml(#[from] toml::de::Error),
}

/// The built-in plotters.
///
/// # Errors
/// Only for a defect in the list itself.
pub fn machines() -> Result<Vec<Plotter>, PlotterError> {
    machines_from(include_str!("hpgl_machines.toml"))
}

/// Reads plotters from TOML: an array of tables `machine`, each with an array `paper`.
///
/// # Errors
/// [`PlotterError::Toml`] with the line.
pub fn machines_from(text: &str) -> Result<Vec<Plotter>, PlotterError> {
    #[derive(Deserialize)]
    struct List {
        machine: Vec<Plotter>,
    }
    Ok(toml::from_str::<List>(text)?.machine)
}

impl Plotter {
    /// A built-in plotter.
    ///
    /// # Errors
    /// [`PlotterError::UnknownMachine`].
    pub fn named(name: &str) -> Result<Self, PlotterError> {
        let mut machines = machines()?;
        let known = machines.iter().map(|m| m.name.as_str()).collect::<Vec<_>>().join(", ");
        let index = machines
            .iter()
            .position(|m| m.name.eq_ignore_ascii_case(name))
            .ok_or(PlotterError::UnknownMachine { name: name.to_owned(), known })?;
        Ok(machines.swap_remove(index))
    }

    /// The entry of a built-in plotter, for machines that differ from it in a few values.
    ///
    /// # Errors
    /// Only for a defect in the list itself.
    pub fn table(name: &str) -> Result<Option<toml::Table>, PlotterError> {
        let mut list: toml::Table = toml::from_str(include_str!("hpgl_machines.toml"))?;
        let Some(toml::Value::Array(machines)) = list.remove("machine") else { return Ok(None) };
        let is_it = |table: &toml::Table| {
            let known = table.get("name").and_then(toml::Value::as_str);
            known.is_some_and(|known| known.eq_ignore_ascii_case(name))
        };
        let mut tables = machines.into_iter().filter_map(|machine| match machine {
            toml::Value::Table(table) => Some(table),
            _ => None,
        });
        Ok(tables.find(is_it))
    }

    /// Checks that the machine takes its own speed and force. Machines that do not list their limits are not
    /// checked.
    ///
    /// # Errors
    /// [`PlotterError::OutOfRange`].
    pub fn check(&self) -> Result<(), PlotterError> {
        let values = [("speed", self.speed, self.speeds), ("force", self.force, self.forces)];
        for (what, value, range) in values {
            if let (Some(value), Some([low, high])) = (value, range)
                && !(low..=high).contains(&value)
            {
                let machine = self.title.clone();
                return Err(PlotterError::OutOfRange { machine, what, value, low, high });
            }
        }
        Ok(())
    }

    /// Value of `VS` for a layer: the share of the highest speed that its label requests, or else the
    /// machine's setting.
    fn layer_speed(&self, layer: &Layer) -> Option<u32> {
        match (layer.speed_percent(), self.speeds) {
            (Some(percent), Some([slowest, fastest])) => {
                Some((fastest * percent).div_ceil(100).clamp(slowest, fastest))
            }
            _ => self.speed,
        }
    }
}

impl LoadedPlotter {
    /// The plotter `machine` with the named paper, or the one of the page's size, either way up.
    ///
    /// # Errors
    /// Unknown names, no paper of that size, and layers whose number is beyond the pens.
    pub fn new(plot: &Plot, machine: &str, paper: Option<&str>) -> Result<Self, PlotterError> {
        Self::on(plot, Plotter::named(machine)?, paper)
    }

    /// As [`LoadedPlotter::new`], for a plotter that is not built in.
    ///
    /// # Errors
    /// As there.
    pub fn on(plot: &Plot, machine: Plotter, paper: Option<&str>) -> Result<Self, PlotterError> {
        let known = || {
            let names = machine.paper.iter().filter_map(|paper| paper.names.first());
            names.map(String::as_str).collect::<Vec<_>>().join(", ")
        };
        let paper = match paper {
            Some(name) => machine
                .paper
                .iter()
                .find(|paper| paper.names.iter().any(|n| n.eq_ignore_ascii_case(name)))
                .ok_or_else(|| PlotterError::UnknownPaper {
                    machine: machine.title.clone(),
                    name: name.to_owned(),
                    known: known(),
                })?,
            None => machine
                .paper
                .iter()
                .find(|paper| fits(plot, paper, false) || fits(plot, paper, true))
                .ok_or_else(|| PlotterError::NoPaperOfSize {
                    machine: machine.title.clone(),
                    width_mm: plot.width_mm,
                    height_mm: plot.height_mm,
                    known: known(),
                })?,
        };
        let beyond =
            plot.plotted_layers().find(|layer| !(1..=machine.pens).contains(&layer.number));
        if let Some(layer) = beyond {
            return Err(PlotterError::NoSuchPen {
                machine: machine.title.clone(),
                layer: layer.number,
                pens: machine.pens,
            });
        }
        Ok(Self { paper: paper.clone(), machine })
    }
}

impl LoadedPlotter {
    /// The part of the page that the pen can reach: lowest and highest corner in page millimeters.
    pub fn reach(&self, plot: &Plot) -> [DVec2; 2] {
        let Self { machine, paper } = self;
        let corner = |x: i32, y: i32| {
            let units = dvec2(f64::from(x), f64::from(y)) * machine.unit;
            let mut p = dvec2(paper.origin[0] + units.x, paper.origin[1] - units.y);
            if paper.turned {
                p = dvec2(paper.size[0] - p.x, paper.size[1] - p.y);
            }
            if is_sideways(plot, paper) { dvec2(plot.width_mm - p.y, p.x) } else { p }
        };
        let (a, b) = (corner(paper.x[0], paper.y[0]), corner(paper.x[1], paper.y[1]));
        let sheet = dvec2(plot.width_mm, plot.height_mm);
        [a.min(b).clamp(DVec2::ZERO, sheet), a.max(b).clamp(DVec2::ZERO, sheet)]
    }
}

impl Plotter {
    /// The widest border of a sheet of this size that the pen cannot reach, in millimeters; `None` if
    /// the machine does not take the sheet. Either side may be the longer one.
    pub fn unreachable_border_mm(&self, width_mm: f64, height_mm: f64) -> Option<f64> {
        let page = Plot { width_mm, height_mm, ..Plot::default() };
        let [low, high] = LoadedPlotter::on(&page, self.clone(), None).ok()?.reach(&page);
        let beyond = dvec2(width_mm, height_mm) - high;
        Some(low.max_element().max(beyond.max_element()))
    }

    /// Assigns the machine's pens to the layers of a drawing from a file: numbers that the machine has are
    /// kept, and other layers get the lowest free ones, in order.
    ///
    /// # Errors
    /// [`PlotterError::TooManyPens`] if layers of more numbers have ink than the machine has pens.
    pub fn assign_pens(&self, plot: &mut Plot) -> Result<(), PlotterError> {
        plot.layers.retain(|layer| !layer.lines.is_empty() && layer.is_plotted());
        let numbers: BTreeSet<u32> = plot.layers.iter().map(|layer| layer.number).collect();
        if numbers.len() > self.pens as usize {
            let (machine, needed) = (self.title.clone(), numbers.len());
            return Err(PlotterError::TooManyPens { machine, needed, pens: self.pens });
        }
        let is_there = |number: u32| (1..=self.pens).contains(&number);
        let (known, other): (BTreeSet<u32>, BTreeSet<u32>) =
            numbers.into_iter().partition(|n| is_there(*n));
        let free = (1..=self.pens).filter(|number| !known.contains(number));
        let pens: BTreeMap<u32, u32> = other.into_iter().zip(free).collect();
        for layer in &mut plot.layers {
            layer.number = pens.get(&layer.number).copied().unwrap_or(layer.number);
        }
        Ok(())
    }
}

/// Whether the page fits the paper only when it is turned a quarter to the left.
fn is_sideways(plot: &Plot, paper: &PlotterPaper) -> bool {
    !fits(plot, paper, false) && fits(plot, paper, true)
}

fn fits(plot: &Plot, paper: &PlotterPaper, sideways: bool) -> bool {
    let [width, height] = if sideways { [paper.size[1], paper.size[0]] } else { paper.size };
    (plot.width_mm - width).abs() <= SIZE_TOLERANCE_MM
        && (plot.height_mm - height).abs() <= SIZE_TOLERANCE_MM
}

/// Writes `plot` for the plotter. Pages upright are turned a quarter to the left if only that fits
/// the paper; anything outside [`LoadedPlotter::reach`] is cut off.
///
/// # Errors
/// Those of `out`.
pub fn write(plot: &Plot, profile: &LoadedPlotter, out: &mut dyn io::Write) -> io::Result<()> {
    only_lines(plot, Format::Hpgl)?;
    let LoadedPlotter { machine, paper } = profile;
    write!(out, "IN;DF;")?;
    if let Some(ps) = paper.ps {
        write!(out, "PS{ps};")?;
    }
    let low = dvec2(f64::from(paper.x[0]), f64::from(paper.y[0])) - AT_LIMIT;
    let high = dvec2(f64::from(paper.x[1]), f64::from(paper.y[1])) + AT_LIMIT;
    let mut has_own_speed = false;
    for layer in plot.plotted_layers() {
        if layer.lines.is_empty() {
            continue;
        }
        if let Some(pause) = &machine.pause
            && layer.pauses()
        {
            write!(out, "\n{pause}")?;
        }
        write!(out, "\nSP{};", layer.number)?;
        if let Some(speed) = machine.layer_speed(layer) {
            write!(out, "VS{speed};")?;
        } else if has_own_speed {
            // Without a number, the speed that the machine starts with.
            write!(out, "VS;")?;
        }
        has_own_speed = layer.speed_percent().is_some() && machine.speeds.is_some();
        if let Some(force) = machine.force {
            write!(out, "FS{force};")?;
        }
        for line in layer.lines.iter() {
            let units: Vec<DVec2> = line.iter().map(|&p| to_units(p, plot, profile)).collect();
            for piece in clip(&units, low, high) {
                // What is left of a line that was cut may be less than a unit.
                if piece == units || rounded(&piece).len() > 1 {
                    write_stroke(&piece, out)?;
                }
            }
        }
    }
    writeln!(out, "\nPA;PU{},{};SP0;IN;", paper.park[0], paper.park[1])
}

/// Page millimeters to plotter units, not yet rounded.
fn to_units(p: DVec2, plot: &Plot, profile: &LoadedPlotter) -> DVec2 {
    let LoadedPlotter { machine, paper } = profile;
    let mut p = p;
    if is_sideways(plot, paper) {
        p = dvec2(p.y, plot.width_mm - p.x);
    }
    if paper.turned {
        p = dvec2(paper.size[0] - p.x, paper.size[1] - p.y);
    }
    dvec2(p.x - paper.origin[0], paper.origin[1] - p.y) / machine.unit
}

/// Points in whole units, each once in a row.
fn rounded(piece: &[DVec2]) -> Vec<[i64; 2]> {
    let mut points: Vec<[i64; 2]> =
        piece.iter().map(|p| [p.x.round() as i64, p.y.round() as i64]).collect();
    points.dedup();
    points
}

fn write_stroke(piece: &[DVec2], out: &mut dyn io::Write) -> io::Result<()> {
    let points = rounded(piece);
    let Some((&[x, y], rest)) = points.split_first() else { return Ok(()) };
    write!(out, "\nPA;PU{x},{y};")?;
    if rest.is_empty() {
        return write!(out, "PD;PU;");
    }
    write!(out, "PR;")?;
    let mut last = [x, y];
    for run in rest.chunks(MAX_POINTS) {
        for (i, &point) in run.iter().enumerate() {
            let lead = if i == 0 { "PD" } else { "," };
            write!(out, "{lead}{},{}", point[0] - last[0], point[1] - last[1])?;
            last = point;
        }
        write!(out, ";")?;
    }
    write!(out, "PU;")
}
