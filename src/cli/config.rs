//! Settings from configuration files and the environment, under those that are typed.
//!
//! Each becomes the option of its name, unless that option or one that conflicts with it was set
//! by something that goes first: typed options, then the preset that was asked for, then the
//! environment (`HIDDENLINE_PAGE` for `--page`), then `./hiddenline.toml`, then the user's file.

use std::collections::BTreeMap;
use std::error::Error;
use std::ffi::OsString;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use clap::parser::ValueSource;
use clap::{ArgMatches, Command};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::suggestion::suggestion;
use super::{file, usage};

/// Settings of the folder.
const PROJECT_FILE: &str = "hiddenline.toml";
/// Settings of the user, in the folder for configurations.
const USER_FILE: &str = "hiddenline/config.toml";
/// Commands that settings apply to.
const COMMANDS: [&str; 5] = ["draw", "surface", "fill", "preview", "optimize"];
/// Settings for pens, which a picture of filled areas has no use for.
const FOR_PENS: [&str; 3] = ["format", "machine", "gcode-profile"];

/// The arguments with all settings, without the program's name.
static ARGUMENTS: OnceLock<Vec<OsString>> = OnceLock::new();

/// A configuration file.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    defaults: Settings,
    #[serde(default)]
    preset: BTreeMap<String, Settings>,
    /// Machines of one's own.
    #[serde(default)]
    machine: BTreeMap<String, toml::Table>,
}

/// Options that can be set; each is named as on the command line.
#[derive(Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Settings {
    page: Option<String>,
    landscape: Option<bool>,
    portrait: Option<bool>,
    margin: Option<Scalar>,
    pen_width: Option<Scalar>,
    pen: Option<Vec<String>>,
    view: Option<String>,
    azimuth: Option<f64>,
    elevation: Option<f64>,
    projection: Option<String>,
    fov: Option<f64>,
    up_axis: Option<String>,
    crease: Option<f64>,
    lines: Option<String>,
    hidden: Option<String>,
    hidden_levels: Option<u32>,
    dash: Option<String>,
    shortest_stroke: Option<Scalar>,
    format: Option<String>,
    dpi: Option<f64>,
    threads: Option<u16>,
    optimize: Option<String>,
    simplify: Option<Scalar>,
    join_tolerance: Option<Scalar>,
    split_distance: Option<Scalar>,
    machine: Option<String>,
    gcode_profile: Option<String>,
    strict: Option<bool>,
    color: Option<String>,
}

/// Names in [`Settings`], which the environment can give too.
const NAMES: [&str; 29] = [
    "page",
    "landscape",
    "portrait",
    "margin",
    "pen-width",
    "pen",
    "view",
    "azimuth",
    "elevation",
    "projection",
    "fov",
    "up-axis",
    "crease",
    "lines",
    "hidden",
    "hidden-levels",
    "dash",
    "shortest-stroke",
    "format",
    "dpi",
    "threads",
    "optimize",
    "simplify",
    "join-tolerance",
    "split-distance",
    "machine",
    "gcode-profile",
    "strict",
    "color",
];

/// A length: millimeters, or text with a unit.
#[derive(Debug, Deserialize, Serialize)]
#[serde(untagged)]
enum Scalar {
    Number(f64),
    Text(String),
}

/// Why settings cannot be used.
#[derive(Debug, Error)]
pub(super) enum ConfigError {
    #[error("cannot read {}: {error}", path.display())]
    Read { path: PathBuf, error: std::io::Error },
    #[error("{}: {error}", path.display())]
    Toml { path: PathBuf, error: toml::de::Error },
    #[error("{origin}: {name} is true or false, not {value:?}")]
    NoFlag { origin: String, name: String, value: String },
    #[error("{origin}: a setting cannot be used: {error}")]
    Unusable { origin: String, error: toml::ser::Error },
    #[error("there is no preset called `{name}`{suggestion}")]
    NoPreset { name: String, suggestion: String, command: String },
}

/// Settings of one origin, as options with values; flags have none.
struct Layer {
    origin: String,
    options: Vec<(String, Option<String>)>,
}

/// The arguments that hold, without the program's name.
pub(super) fn arguments() -> impl Iterator<Item = OsString> {
    let arguments = ARGUMENTS.get().cloned();
    arguments.unwrap_or_else(|| std::env::args_os().skip(1).collect()).into_iter()
}

/// Whether an option, as in `--page`, was typed rather than set in a file or in the environment.
pub(super) fn is_typed(option: &str) -> bool {
    let is_it = |argument: OsString| {
        let argument = argument.to_string_lossy();
        argument.strip_prefix(option).is_some_and(|rest| rest.is_empty() || rest.starts_with('='))
    };
    std::env::args_os().skip(1).any(is_it)
}

/// Parses what was typed together with the settings. Bad usage ends the program.
pub(super) fn with_settings(mut command: Command) -> Result<ArgMatches, Box<dyn Error>> {
    command.build();
    let typed: Vec<OsString> = std::env::args_os().collect();
    let matches = usage::parse(&command, &typed);
    let Some((name, chosen)) = matches.subcommand().filter(|(name, _)| COMMANDS.contains(name))
    else {
        return Ok(matches);
    };
    let Some(options) = command.find_subcommand(name) else { return Ok(matches) };
    let preset = chosen.try_get_one::<String>("preset").ok().flatten().cloned();
    let is_typed = |id: &str| {
        chosen.try_contains_id(id).unwrap_or(false)
            && chosen.value_source(id) == Some(ValueSource::CommandLine)
    };
    let mut taken: Vec<&clap::Arg> =
        options.get_arguments().filter(|arg| is_typed(arg.get_id().as_str())).collect();
    let mut added = Vec::new();
    let mut origins = Vec::new();
    for layer in layers(preset, name)? {
        let mut used = Vec::new();
        for (name, value) in &layer.options {
            let by_name = |arg: &&clap::Arg| arg.get_long() == Some(name.as_str());
            // Settings for other commands are none for this one: kinds of line are those of models.
            if name == "lines"
                && !options.get_arguments().any(|arg| arg.get_long() == Some("crease"))
            {
                continue;
            }
            if options.get_name() == "fill" && FOR_PENS.contains(&name.as_str()) {
                continue;
            }
            let Some(arg) = options.get_arguments().find(by_name) else { continue };
            let conflicts = |a: &clap::Arg, b: &clap::Arg| {
                options.get_arg_conflicts_with(a).iter().any(|other| other.get_id() == b.get_id())
            };
            let is_taken = taken.iter().any(|other| {
                other.get_id() == arg.get_id() || conflicts(arg, other) || conflicts(other, arg)
            });
            if !is_taken {
                used.push(arg);
                added.push(OsString::from(match value {
                    Some(value) => format!("--{name}={value}"),
                    None => format!("--{name}"),
                }));
            }
        }
        if !used.is_empty() {
            origins.push(layer.origin);
        }
        taken.extend(used);
    }
    let mut all = typed.clone();
    let place = typed.iter().position(|argument| argument.to_str() == Some(name));
    let place = place.map_or(all.len(), |place| place + 1);
    all.splice(place..place, added);
    let result = command.clone().try_get_matches_from(&all);
    let _ = ARGUMENTS.set(all.split_off(1));
    result.map_err(|error| {
        format!("with settings from {}:\n{error}", origins.join(" and ")).trim_end().into()
    })
}

/// Settings by origin, those that go first before the others; `command` is for messages.
fn layers(preset: Option<String>, command: &str) -> Result<Vec<Layer>, ConfigError> {
    let preset = preset.or_else(|| std::env::var("HIDDENLINE_PRESET").ok());
    let preset = preset.filter(|name| !name.is_empty());
    let mut files = Vec::new();
    for path in paths() {
        if let Some(file) = read(&path)? {
            files.push((path, file));
        }
    }
    let mut layers = Vec::new();
    if let Some(name) = preset {
        let found = files.iter().find_map(|(path, file)| Some((path, file.preset.get(&name)?)));
        let Some((path, settings)) = found else {
            let known: Vec<&str> = preset_names(&files);
            let suggestion = match known.as_slice() {
                [] => "; no configuration file has any".to_owned(),
                known => suggestion(&name, known.iter().copied()),
            };
            return Err(ConfigError::NoPreset { name, suggestion, command: command.to_owned() });
        };
        let origin = format!("preset {name} in {}", path.display());
        layers.push(Layer { options: options(settings, &origin)?, origin });
    }
    layers.push(environment()?);
    for (path, file) in &files {
        let origin = path.display().to_string();
        layers.push(Layer { options: options(&file.defaults, &origin)?, origin });
    }
    Ok(layers)
}

/// Machines of the configuration files.
#[derive(Default)]
pub(super) struct OwnMachines {
    /// The one that was asked for, and what to call its place.
    pub(super) found: Option<(toml::Table, String)>,
    /// The names of all.
    pub(super) names: Vec<String>,
}

/// The machine called `name` in the first file that has one.
pub(super) fn machine(name: &str) -> Result<OwnMachines, ConfigError> {
    let mut machines = OwnMachines::default();
    for path in paths() {
        let file = read(&path)?.unwrap_or_default();
        for (own, table) in file.machine {
            if machines.found.is_none() && own.eq_ignore_ascii_case(name) {
                machines.found = Some((table, format!("machine {own} in {}", path.display())));
            }
            machines.names.push(own);
        }
    }
    Ok(machines)
}

fn preset_names(files: &[(PathBuf, File)]) -> Vec<&str> {
    let names = files.iter().flat_map(|(_, file)| file.preset.keys().map(String::as_str));
    let mut names: Vec<&str> = names.collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// The project's file, then the user's.
fn paths() -> Vec<PathBuf> {
    let folder = std::env::var_os("XDG_CONFIG_HOME").filter(|folder| !folder.is_empty());
    let home = || std::env::var_os("HOME").map(|home| Path::new(&home).join(".config"));
    let user = folder.map(PathBuf::from).or_else(home).map(|folder| folder.join(USER_FILE));
    std::iter::once(PathBuf::from(PROJECT_FILE)).chain(user).collect()
}

fn read(path: &Path) -> Result<Option<File>, ConfigError> {
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(ConfigError::Read { path: path.to_owned(), error }),
    };
    let file = toml::from_str(&text);
    file.map(Some).map_err(|error| ConfigError::Toml { path: path.to_owned(), error })
}

/// Settings as options.
fn options(
    settings: &Settings,
    origin: &str,
) -> Result<Vec<(String, Option<String>)>, ConfigError> {
    let table = toml::Table::try_from(settings)
        .map_err(|error| ConfigError::Unusable { origin: origin.to_owned(), error })?;
    let mut options = Vec::new();
    for (name, value) in table {
        match value {
            toml::Value::Boolean(true) => options.push((name, None)),
            toml::Value::Boolean(false) => {}
            toml::Value::Array(values) => {
                options.extend(values.iter().map(|value| (name.clone(), Some(plain(value)))));
            }
            value => options.push((name, Some(plain(&value)))),
        }
    }
    Ok(options)
}

fn plain(value: &toml::Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Settings from environment variables; several pens have blanks between them.
fn environment() -> Result<Layer, ConfigError> {
    let mut options = Vec::new();
    for name in NAMES {
        let variable = format!("HIDDENLINE_{}", name.replace('-', "_").to_ascii_uppercase());
        let Some(value) = std::env::var(&variable).ok().filter(|value| !value.is_empty()) else {
            continue;
        };
        match name {
            "landscape" | "portrait" | "strict" => match value.as_str() {
                "1" | "true" => options.push((name.to_owned(), None)),
                "0" | "false" => {}
                _ => {
                    return Err(ConfigError::NoFlag {
                        origin: variable,
                        name: name.to_owned(),
                        value,
                    });
                }
            },
            "pen" => {
                let pens = value.split_whitespace();
                options.extend(pens.map(|pen| (name.to_owned(), Some(pen.to_owned()))));
            }
            _ => options.push((name.to_owned(), Some(value))),
        }
    }
    Ok(Layer { origin: "the environment (HIDDENLINE_…)".into(), options })
}

/// Prints which files are read, which presets there are, and the settings that hold.
pub(super) fn show(preset: Option<&str>) -> Result<(), Box<dyn Error>> {
    let mut text = String::new();
    for path in paths() {
        let there = if path.exists() { "" } else { " (not there)" };
        writeln!(text, "# {}{there}", path.display())?;
        if let Some(file) = read(&path)? {
            for name in file.preset.keys() {
                writeln!(text, "#   preset {name}")?;
            }
            for name in file.machine.keys() {
                writeln!(text, "#   machine {name}")?;
            }
        }
    }
    let mut seen: Vec<String> = Vec::new();
    for layer in layers(preset.map(str::to_owned), "config")? {
        let mut names = Vec::new();
        for (name, value) in layer.options.into_iter().filter(|(name, _)| !seen.contains(name)) {
            let value = value.map_or_else(|| "true".to_owned(), |value| format!("{value:?}"));
            writeln!(text, "{name} = {value}  # {}", layer.origin)?;
            names.push(name);
        }
        seen.extend(names);
    }
    file::write_to_stdout(|out| out.write_all(text.as_bytes())).map_err(Into::into)
}
