//! G-code from templates: complete profiles for GRBL and Marlin, and templates for other machines.
//!
//! Millimeters or inches, absolute positions; the origin is the page's bottom left corner with y
//! up, unless the profile keeps the page's top left. No crate writes G-code for pens.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io;

use serde::Deserialize;

use super::decimal::Decimal;
use super::{Format, only_lines};
use crate::optimize::estimate::Motion;
use crate::plot::{Layer, Plot};

/// Templates and settings of a machine.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GcodeProfile {
    /// What it is for.
    #[serde(default)]
    pub title: String,
    /// Unit of positions and speeds.
    #[serde(default)]
    pub unit: Unit,
    /// Whether y runs up from the bottom of the page; true by default.
    #[serde(default = "yes")]
    pub flip_y: bool,
    /// Decimals of positions, 9 at most.
    pub decimals: u32,
    /// Drawing speed in units per minute.
    pub feed: f64,
    /// At the start of the file.
    pub start: String,
    /// Raises the pen.
    pub pen_up: String,
    /// Lowers the pen.
    pub pen_down: String,
    /// Goes to a point with the pen up.
    #[serde(rename = "move")]
    pub go: String,
    /// Draws to a point.
    pub line: String,
    /// Before each layer.
    #[serde(default)]
    pub layer_start: String,
    /// After each layer.
    #[serde(default)]
    pub layer_end: String,
    /// Between two layers of different pens, before the start of the second one; also before a layer that
    /// requests a pause.
    #[serde(default)]
    pub pen_change: String,
    /// At the end of the file.
    pub end: String,
    /// How the machine moves, to estimate the time.
    #[serde(default)]
    pub motion: Motion,
}

fn yes() -> bool {
    true
}

/// Unit of G-code positions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// Millimeters, `G21`.
    #[default]
    Mm,
    /// Inches, `G20`.
    In,
}

impl Unit {
    fn per_mm(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::In => 1.0 / 25.4,
        }
    }
}

/// Why a profile cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GcodeError {
    /// No such profile.
    #[error("unknown G-code profile {name:?}; choose from {known}")]
    UnknownProfile {
        /// The requested name.
        name: String,
        /// All names.
        known: String,
    },
    /// A template has a placeholder that does not exist.
    #[error("template {template}: unknown placeholder {{{placeholder}}}; choose from {known}")]
    UnknownPlaceholder {
        /// The template's name.
        template: &'static str,
        /// The name between the braces.
        placeholder: String,
        /// All placeholders.
        known: String,
    },
    /// The drawing speed is not a positive number.
    #[error("feed must be positive")]
    Feed,
    /// The profiles are not valid TOML.
    #[error("G-code profile: {0}")]
    Toml(#[from] toml::de::Error),
}

/// The default G-code profile.
pub const DEFAULT_PROFILE: &str = "grbl-servo";

const PLACEHOLDERS: [&str; 10] =
    ["x", "y", "feed", "layer", "name", "color", "pen_width", "width", "height", "title"];

impl GcodeProfile {
    /// A built-in profile: `grbl-servo`, `grbl-z`, `grbl-laser` or `marlin`.
    ///
    /// # Errors
    /// [`GcodeError::UnknownProfile`].
    pub fn named(name: &str) -> Result<Self, GcodeError> {
        let mut profiles = profiles_from(include_str!("gcode_profiles.toml"))?;
        let known = profiles.keys().cloned().collect::<Vec<_>>().join(", ");
        profiles.remove(name).ok_or(GcodeError::UnknownProfile { name: name.to_owned(), known })
    }

    /// Names of the built-in profiles.
    ///
    /// # Errors
    /// Only for a defect in the profiles themselves.
    pub fn names() -> Result<Vec<String>, GcodeError> {
        let profiles = profiles_from(include_str!("gcode_profiles.toml"))?;
        Ok(profiles.into_keys().collect())
    }

    /// A built-in profile as TOML, to start from; `None` if no profile has that name.
    ///
    /// # Errors
    /// Only for a defect in the profiles themselves.
    pub fn table(name: &str) -> Result<Option<toml::Table>, GcodeError> {
        let mut all: toml::Table = toml::from_str(include_str!("gcode_profiles.toml"))?;
        Ok(all.remove(name).and_then(|profile| profile.as_table().cloned()))
    }

    /// Reads one profile from TOML.
    ///
    /// # Errors
    /// A setting is missing or unknown (with its line), or a placeholder is unknown.
    pub fn from_toml(text: &str) -> Result<Self, GcodeError> {
        let profile: Self = toml::from_str(text)?;
        profile.check()?;
        Ok(profile)
    }

    fn check(&self) -> Result<(), GcodeError> {
        if !(self.feed.is_finite() && self.feed > 0.0) {
            return Err(GcodeError::Feed);
        }
        for (template, text) in [
            ("start", &self.start),
            ("pen_up", &self.pen_up),
            ("pen_down", &self.pen_down),
            ("move", &self.go),
            ("line", &self.line),
            ("layer_start", &self.layer_start),
            ("layer_end", &self.layer_end),
            ("pen_change", &self.pen_change),
            ("end", &self.end),
        ] {
            let unknown = placeholders(text).find(|&(_, name, _)| !PLACEHOLDERS.contains(&name));
            if let Some((_, name, _)) = unknown {
                return Err(GcodeError::UnknownPlaceholder {
                    template,
                    placeholder: name.to_owned(),
                    known: PLACEHOLDERS.join(", "),
                });
            }
        }
        Ok(())
    }
}

/// Reads named profiles from TOML: one table each.
///
/// # Errors
/// As [`GcodeProfile::from_toml`].
pub fn profiles_from(text: &str) -> Result<BTreeMap<String, GcodeProfile>, GcodeError> {
    let profiles: BTreeMap<String, GcodeProfile> = toml::from_str(text)?;
    profiles.values().try_for_each(GcodeProfile::check)?;
    Ok(profiles)
}

/// Each placeholder of a template: the text before it, its name, and the text after it.
fn placeholders(text: &str) -> impl Iterator<Item = (&str, &str, &str)> {
    let mut rest = text;
    std::iter::from_fn(move || {
        let (before, tail) = rest.split_once('{')?;
        let (name, after) = tail.split_once('}')?;
        rest = after;
        Some((before, name, after))
    })
}

/// Writes `plot` by the profile's templates.
///
/// # Errors
/// Those of `out`.
pub fn write(plot: &Plot, profile: &GcodeProfile, out: &mut dyn io::Write) -> io::Result<()> {
    only_lines(plot, Format::Gcode)?;
    let mut writer = Writer { plot, profile, layer: None, text: String::new() };
    writer.expand(&profile.start, 0.0, 0.0);
    let mut last_pen = None;
    for layer in plot.plotted_layers().filter(|layer| !layer.lines.is_empty()) {
        writer.layer = Some(layer);
        if last_pen.is_some_and(|number| number != layer.number) || layer.pauses() {
            writer.expand(&profile.pen_change, 0.0, 0.0);
        }
        last_pen = Some(layer.number);
        writer.expand(&profile.layer_start, 0.0, 0.0);
        for line in layer.lines.iter().filter(|line| line.iter().all(|p| p.is_finite())) {
            for (i, p) in line.iter().enumerate() {
                let y = if profile.flip_y { plot.height_mm - p.y } else { p.y };
                if i == 0 {
                    writer.expand(&profile.go, p.x, y);
                    writer.expand(&profile.pen_down, p.x, y);
                } else {
                    writer.expand(&profile.line, p.x, y);
                }
            }
            writer.expand(&profile.pen_up, 0.0, 0.0);
            out.write_all(writer.text.as_bytes())?;
            writer.text.clear();
        }
        writer.expand(&profile.layer_end, 0.0, 0.0);
    }
    writer.expand(&profile.end, 0.0, 0.0);
    out.write_all(writer.text.as_bytes())
}

struct Writer<'a> {
    plot: &'a Plot,
    profile: &'a GcodeProfile,
    layer: Option<&'a Layer>,
    text: String,
}

impl Writer<'_> {
    fn expand(&mut self, template: &str, x: f64, y: f64) {
        let mut rest = template;
        for (before, name, after) in placeholders(template) {
            self.text.push_str(before);
            self.value(name, x, y);
            rest = after;
        }
        self.text.push_str(rest);
    }

    fn value(&mut self, name: &str, x: f64, y: f64) {
        let decimals = self.profile.decimals;
        let length = |mm: f64| Decimal::new(mm * self.profile.unit.per_mm(), decimals);
        let text = &mut self.text;
        // Writing to a string does not fail.
        let _ = match name {
            "x" => write!(text, "{}", length(x)),
            "y" => write!(text, "{}", length(y)),
            "feed" => write!(text, "{}", Decimal::new(self.profile.feed, decimals)),
            "width" => write!(text, "{}", length(self.plot.width_mm)),
            "height" => write!(text, "{}", length(self.plot.height_mm)),
            "title" => write!(text, "{}", comment(&self.plot.title)),
            "layer" => write!(text, "{}", self.layer.map_or(0, |layer| layer.number)),
            "name" => write!(text, "{}", self.layer.map_or_else(String::new, |l| comment(&l.name))),
            "color" => {
                write!(text, "{}", self.layer.map_or_else(String::new, |l| comment(&l.pen.color)))
            }
            "pen_width" => {
                write!(text, "{}", length(self.layer.map_or(0.0, |layer| layer.pen.width_mm)))
            }
            _ => Ok(()),
        };
    }
}

/// Text that is valid in a comment of any dialect: printable ASCII without characters that end one.
fn comment(text: &str) -> String {
    text.chars()
        .map(|c| if (c.is_ascii_graphic() || c == ' ') && !"();%".contains(c) { c } else { '_' })
        .collect()
}
