//! The machine that the output is for: its format, and how it moves.

use std::path::{Path, PathBuf};

use hiddenline::stages::optimize::estimate::Motion;
use hiddenline::stages::page::Cropped;
use hiddenline::stages::plot::{Layer, Plot};
use hiddenline::stages::write::hpgl::Plotter;
use hiddenline::stages::write::{Format, Target, gcode, hpgl};
use thiserror::Error;

use super::config;
use super::messages::counted;
use super::suggestion::suggestion;

/// The machine that a file is written for.
pub(super) struct Machine {
    /// What HPGL and G-code are written as; `None` for formats that are the same for all machines.
    pub(super) target: Option<Target>,
    /// How it moves.
    pub(super) motion: Motion,
}

/// Why a machine cannot be used.
#[derive(Debug, Error)]
pub(super) enum MachineError {
    #[error("unknown machine `{name}`{suggestion}")]
    Unknown { name: String, suggestion: String },
    #[error("`{name}` is not a machine for {format}{suggestion}")]
    OtherFormat { name: String, format: &'static str, suggestion: String },
    #[error("cannot read {}: {error}", path.display())]
    Read { path: PathBuf, error: std::io::Error },
    #[error("{}: {error}", path.display())]
    Profile { path: PathBuf, error: gcode::GcodeError },
    #[error(transparent)]
    Settings(#[from] config::ConfigError),
    #[error("{origin}: {error}")]
    Own { origin: String, error: Box<dyn std::error::Error + Send + Sync> },
    #[error(transparent)]
    Plotters(#[from] hpgl::PlotterError),
    #[error(transparent)]
    Gcode(#[from] gcode::GcodeError),
}

impl MachineError {
    /// Whether the name on the command line is wrong, rather than the machine's own settings.
    pub(super) fn is_usage(&self) -> bool {
        matches!(self, Self::Unknown { .. } | Self::OtherFormat { .. })
    }
}

impl Machine {
    /// Finds the machine called `name`, or the default for `format`.
    pub(super) fn new(
        format: Format,
        name: Option<&str>,
        gcode_profile: Option<&Path>,
    ) -> Result<Self, MachineError> {
        if let Some(path) = gcode_profile {
            let profile = read_profile(path)?;
            let motion = profile.motion.clone();
            let target = match format {
                Format::Gcode => Some(Target::Gcode(Box::new(profile))),
                _ => Self::new(format, None, None)?.target,
            };
            return Ok(Self { target, motion });
        }
        let plotters = hpgl::machines()?;
        let profiles = gcode::GcodeProfile::names()?;
        let plotter = |name: &str| plotters.iter().find(|p| p.name.eq_ignore_ascii_case(name));
        let profile = |name: &str| profiles.iter().find(|p| p.eq_ignore_ascii_case(name));
        let wanted = name.unwrap_or(match format {
            Format::Hpgl => hpgl::DEFAULT_MACHINE,
            Format::Gcode => gcode::DEFAULT_PROFILE,
            _ => "saxi",
        });
        let own = name.map(config::machine).transpose()?.unwrap_or_default();
        let own_names = own.names;
        let own =
            own.found.map(|(table, origin)| own_machine(wanted, table, origin)).transpose()?;
        let found = match (own, plotter(wanted), profile(wanted)) {
            (Some(own), ..) => own,
            (None, Some(plotter), _) => {
                let target = Some(Target::Hpgl(Box::new(plotter.clone())));
                Self { target, motion: Motion::default() }
            }
            (None, None, Some(name)) => {
                let profile = gcode::GcodeProfile::named(name)?;
                let motion = profile.motion.clone();
                Self { target: Some(Target::Gcode(Box::new(profile))), motion }
            }
            (None, None, None) => match Motion::named(&wanted.to_ascii_lowercase()) {
                Some(motion) => Self { target: None, motion },
                None => {
                    let plotters = plotters.iter().map(|p| p.name.as_str());
                    let known = Motion::NAMES.into_iter().chain(plotters);
                    let known = known.chain(profiles.iter().map(String::as_str));
                    let known = known.chain(own_names.iter().map(String::as_str));
                    return Err(MachineError::Unknown {
                        suggestion: suggestion(wanted, known),
                        name: wanted.to_owned(),
                    });
                }
            },
        };
        let unfit = |suggestion| MachineError::OtherFormat {
            name: wanted.to_owned(),
            format: format.name(),
            suggestion,
        };
        match (format, &found.target) {
            (Format::Hpgl, Some(Target::Hpgl(_))) | (Format::Gcode, Some(Target::Gcode(_))) => {
                Ok(found)
            }
            (Format::Hpgl, _) => {
                Err(unfit(suggestion(wanted, plotters.iter().map(|p| p.name.as_str()))))
            }
            (Format::Gcode, _) => {
                Err(unfit(suggestion(wanted, profiles.iter().map(String::as_str))))
            }
            _ => Ok(Self { target: None, ..found }),
        }
    }
}

/// The names of all machines, those of the configuration files among them.
pub(super) fn names() -> Result<Vec<String>, MachineError> {
    let mut names: Vec<String> = Motion::NAMES.into_iter().map(str::to_owned).collect();
    names.extend(hpgl::machines()?.iter().map(|plotter| plotter.name.clone()));
    names.extend(gcode::GcodeProfile::names()?);
    names.extend(config::machine("")?.names);
    Ok(names)
}

/// How much ink was cut off, as the start of a message; `None` if all of it is there.
pub(super) fn lost_ink(cropped: &Cropped) -> Option<String> {
    let dots = counted(cropped.lost_dots, "dot", "dots");
    match (cropped.lost_mm > 0.0, cropped.lost_dots > 0) {
        (false, false) => None,
        (true, false) => Some(format!("{:.1} mm of ink are", cropped.lost_mm)),
        (false, true) => Some(format!("{dots} are")),
        (true, true) => Some(format!("{:.1} mm of ink and {dots} are", cropped.lost_mm)),
    }
}

/// Warnings about what layers ask for but the plotter cannot do.
pub(super) fn unkept_controls(plot: &Plot, machine: &Plotter) -> Vec<String> {
    let numbers = |asks: fn(&Layer) -> bool| {
        let layers = plot.plotted_layers().filter(|layer| asks(layer) && !layer.lines.is_empty());
        let numbers: Vec<String> = layers.map(|layer| layer.number.to_string()).collect();
        (!numbers.is_empty()).then(|| numbers.join(", "))
    };
    let title = &machine.title;
    let pauses = match machine.pause {
        Some(_) => None,
        None => numbers(Layer::pauses).map(|layers| {
            format!(
                "{title} cannot pause before layer {layers}, as `!` requests; give each pen its \
                 own place in the machine, or write the layers to separate files"
            )
        }),
    };
    let speeds = match machine.speeds {
        Some(_) => None,
        None => numbers(|layer| layer.speed_percent().is_some()).map(|layers| {
            format!("no pen speeds are known for {title}; `+S` of layer {layers} has no effect")
        }),
    };
    pauses.into_iter().chain(speeds).collect()
}

/// A machine from a configuration file: a plotter if it lists papers or is `like` a known plotter, a
/// G-code profile if it has templates or is `like` a known profile, and otherwise only how it moves.
fn own_machine(
    name: &str,
    mut table: toml::Table,
    origin: String,
) -> Result<Machine, MachineError> {
    let failed = |error: Box<dyn std::error::Error + Send + Sync>| MachineError::Own {
        origin: origin.clone(),
        error,
    };
    let like = table.get("like").and_then(toml::Value::as_str);
    if let Some(mut known) = like.map(Plotter::table).transpose()?.flatten() {
        table.remove("like");
        known.extend(table);
        table = known;
    }
    if table.contains_key("paper") {
        let motion = match table.remove("motion") {
            Some(motion) => motion.try_into().map_err(|error| failed(error.into()))?,
            None => Motion::default(),
        };
        table.entry("name").or_insert_with(|| name.into());
        table.entry("title").or_insert_with(|| name.into());
        let plotter: Plotter = table.try_into().map_err(|error| failed(error.into()))?;
        plotter.check().map_err(|error| failed(error.into()))?;
        return Ok(Machine { target: Some(Target::Hpgl(Box::new(plotter))), motion });
    }
    if let Some(like) = table.remove("like") {
        let like = like.as_str().unwrap_or_default();
        let known = gcode::GcodeProfile::table(like)?;
        let Some(mut known) = known else {
            let (names, plotters) = (gcode::GcodeProfile::names()?, hpgl::machines()?);
            let plotters = plotters.iter().map(|plotter| plotter.name.as_str());
            let known = names.iter().map(String::as_str).chain(plotters);
            let suggestion = suggestion(like, known);
            return Err(failed(format!("unknown machine `{like}`{suggestion}").into()));
        };
        known.extend(table);
        table = known;
    } else if let (1, Some(motion)) = (table.len(), table.get("motion")) {
        let motion = motion.clone().try_into().map_err(|error| failed(error.into()))?;
        return Ok(Machine { target: None, motion });
    }
    let text = toml::to_string(&table).map_err(|error| failed(error.into()))?;
    let profile = gcode::GcodeProfile::from_toml(&text).map_err(|error| failed(error.into()))?;
    let motion = profile.motion.clone();
    Ok(Machine { target: Some(Target::Gcode(Box::new(profile))), motion })
}

fn read_profile(path: &Path) -> Result<gcode::GcodeProfile, MachineError> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| MachineError::Read { path: path.to_owned(), error })?;
    gcode::GcodeProfile::from_toml(&text)
        .map_err(|error| MachineError::Profile { path: path.to_owned(), error })
}
