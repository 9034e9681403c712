//! The machine to write for: what it understands, and how it moves.

use std::path::{Path, PathBuf};

use hiddenline::stages::optimize::estimate::Motion;
use hiddenline::stages::page::{Cropped, PageOptions};
use hiddenline::stages::write::{Format, gcode, hpgl};
use thiserror::Error;

use super::config;
use super::messages::counted;
use super::suggestion::suggestion;

/// The plotter that HPGL is for, unless set otherwise.
const DEFAULT_PLOTTER: &str = "hp7475a";
/// The profile of G-code, unless set otherwise.
const DEFAULT_GCODE: &str = "grbl-servo";

/// What a file is written for.
pub(super) struct Target {
    pub(super) device: Device,
    pub(super) motion: Motion,
}

/// A machine that has a say in what is written.
pub(super) enum Device {
    /// None: the format is the same for all.
    Any,
    Plotter(hpgl::Machine),
    Gcode(Box<gcode::Profile>),
}

/// Why there is no machine to write for.
#[derive(Debug, Error)]
pub(super) enum MachineError {
    #[error("there is no machine called `{name}`{suggestion}")]
    Unknown { name: String, suggestion: String },
    #[error("`{name}` is not a machine for {format}{suggestion}")]
    OtherFormat { name: String, format: &'static str, suggestion: String },
    #[error("cannot read {}: {error}", path.display())]
    Read { path: PathBuf, error: std::io::Error },
    #[error("{}: {error}", path.display())]
    Profile { path: PathBuf, error: gcode::Error },
    #[error(transparent)]
    Settings(#[from] config::ConfigError),
    #[error("{origin}: {error}")]
    Own { origin: String, error: Box<dyn std::error::Error + Send + Sync> },
    #[error(transparent)]
    Plotters(#[from] hpgl::Error),
    #[error(transparent)]
    Gcode(#[from] gcode::Error),
}

impl MachineError {
    /// Whether the name that was typed is wrong, rather than what it stands for.
    pub(super) fn is_usage(&self) -> bool {
        matches!(self, Self::Unknown { .. } | Self::OtherFormat { .. })
    }
}

impl Target {
    /// Finds the machine called `name`, or the usual one for `format`.
    pub(super) fn new(
        format: Format,
        name: Option<&str>,
        gcode_profile: Option<&Path>,
    ) -> Result<Self, MachineError> {
        if let Some(path) = gcode_profile {
            let profile = read_profile(path)?;
            let motion = profile.motion.clone();
            let device = match format {
                Format::Gcode => Device::Gcode(Box::new(profile)),
                _ => Self::new(format, None, None)?.device,
            };
            return Ok(Self { device, motion });
        }
        let plotters = hpgl::machines()?;
        let profiles = gcode::Profile::names()?;
        let plotter = |name: &str| plotters.iter().find(|p| p.name.eq_ignore_ascii_case(name));
        let profile = |name: &str| profiles.iter().find(|p| p.eq_ignore_ascii_case(name));
        let wanted = name.unwrap_or(match format {
            Format::Hpgl => DEFAULT_PLOTTER,
            Format::Gcode => DEFAULT_GCODE,
            _ => "saxi",
        });
        let own = name.map(config::machine).transpose()?.unwrap_or_default();
        let own_names = own.names;
        let own =
            own.found.map(|(table, origin)| own_machine(wanted, table, origin)).transpose()?;
        let found = match (own, plotter(wanted), profile(wanted)) {
            (Some(own), ..) => own,
            (None, Some(plotter), _) => {
                Self { device: Device::Plotter(plotter.clone()), motion: Motion::default() }
            }
            (None, None, Some(name)) => {
                let profile = gcode::Profile::named(name)?;
                let motion = profile.motion.clone();
                Self { device: Device::Gcode(Box::new(profile)), motion }
            }
            (None, None, None) => match Motion::named(&wanted.to_ascii_lowercase()) {
                Some(motion) => Self { device: Device::Any, motion },
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
        match (format, &found.device) {
            (Format::Hpgl, Device::Plotter(_)) | (Format::Gcode, Device::Gcode(_)) => Ok(found),
            (Format::Hpgl, _) => {
                Err(unfit(suggestion(wanted, plotters.iter().map(|p| p.name.as_str()))))
            }
            (Format::Gcode, _) => {
                Err(unfit(suggestion(wanted, profiles.iter().map(String::as_str))))
            }
            _ => Ok(Self { device: Device::Any, ..found }),
        }
    }
}

impl Target {
    /// The page with a margin wide enough that the pen reaches all of what lies within it.
    pub(super) fn within_reach(&self, options: PageOptions) -> PageOptions {
        let Device::Plotter(machine) = &self.device else { return options };
        let paper = options.paper;
        let border_mm = machine.unreachable_border_mm(paper.width_mm, paper.height_mm);
        let margin_mm = options.margin_mm.max(border_mm.unwrap_or(0.0));
        PageOptions { margin_mm, ..options }
    }
}

/// What was cut off, as the beginning of a message; `None` if nothing was.
pub(super) fn lost_ink(cropped: &Cropped) -> Option<String> {
    let dots = counted(cropped.lost_dots, "dot", "dots");
    match (cropped.lost_mm > 0.0, cropped.lost_dots > 0) {
        (false, false) => None,
        (true, false) => Some(format!("{:.1} mm of ink are", cropped.lost_mm)),
        (false, true) => Some(format!("{dots} are")),
        (true, true) => Some(format!("{:.1} mm of ink and {dots} are", cropped.lost_mm)),
    }
}

/// A machine of a configuration file: a plotter where papers are listed, a profile of G-code where
/// it has templates or is `like` a known one, and otherwise only how it moves.
fn own_machine(name: &str, mut table: toml::Table, origin: String) -> Result<Target, MachineError> {
    let failed = |error: Box<dyn std::error::Error + Send + Sync>| MachineError::Own {
        origin: origin.clone(),
        error,
    };
    if table.contains_key("paper") {
        let motion = match table.remove("motion") {
            Some(motion) => motion.try_into().map_err(|error| failed(error.into()))?,
            None => Motion::default(),
        };
        table.entry("name").or_insert_with(|| name.into());
        table.entry("title").or_insert_with(|| name.into());
        let plotter = table.try_into().map_err(|error| failed(error.into()))?;
        return Ok(Target { device: Device::Plotter(plotter), motion });
    }
    if let Some(like) = table.remove("like") {
        let like = like.as_str().unwrap_or_default();
        let known = gcode::Profile::table(like)?;
        let Some(mut known) = known else {
            let names = gcode::Profile::names()?;
            let suggestion = suggestion(like, names.iter().map(String::as_str));
            return Err(failed(format!("there is no profile called `{like}`{suggestion}").into()));
        };
        known.extend(table);
        table = known;
    } else if let (1, Some(motion)) = (table.len(), table.get("motion")) {
        let motion = motion.clone().try_into().map_err(|error| failed(error.into()))?;
        return Ok(Target { device: Device::Any, motion });
    }
    let text = toml::to_string(&table).map_err(|error| failed(error.into()))?;
    let profile = gcode::Profile::from_toml(&text).map_err(|error| failed(error.into()))?;
    let motion = profile.motion.clone();
    Ok(Target { device: Device::Gcode(Box::new(profile)), motion })
}

fn read_profile(path: &Path) -> Result<gcode::Profile, MachineError> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| MachineError::Read { path: path.to_owned(), error })?;
    gcode::Profile::from_toml(&text)
        .map_err(|error| MachineError::Profile { path: path.to_owned(), error })
}
