//! Settings from configuration files and the environment.
//!
//! A setting stands for the option of its name; every option of every command can be set. Options on
//! the command line take precedence, then the chosen preset, then the environment (`HIDDENLINE_PAGE`
//! for `--page`), then `./hiddenline.toml`, then the user's file. A setting is dropped if its option,
//! or one that conflicts with it, is set with higher precedence.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::error::Error;
use std::ffi::OsString;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock};

use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command};
use serde::Deserialize;
use thiserror::Error;
use toml::de::{DeTable, DeValue};
use toml::{Table, Value};

use super::suggestion::{near, suggestion};
use super::{file, messages, usage};

/// Settings of the folder.
const PROJECT_FILE: &str = "hiddenline.toml";
/// Settings of the user, in the folder for configurations.
const USER_FILE: &str = "hiddenline/config.toml";
/// How the names of environment variables begin.
const PREFIX: &str = "HIDDENLINE_";
/// Commands that settings apply to.
const COMMANDS: [&str; 6] = ["draw", "surface", "fill", "preview", "view", "optimize"];
/// Settings for pens, which do not apply to filled areas.
const FOR_PENS: [&str; 3] = ["format", "machine", "gcode-profile"];

/// The arguments with all settings, without the program's name.
static ARGUMENTS: OnceLock<Vec<OsString>> = OnceLock::new();

/// About environment variables that are no settings, for the command to say.
static UNKNOWN: Mutex<Vec<String>> = Mutex::new(Vec::new());

thread_local! {
    /// What this thread draws as if it had been typed: the viewer draws many command lines.
    static INSTEAD: RefCell<Option<Vec<OsString>>> = const { RefCell::new(None) };
}

/// A configuration file.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    /// Settings by the names of their options.
    #[serde(default)]
    defaults: Table,
    #[serde(default)]
    preset: BTreeMap<String, Table>,
    /// Machines that the file describes.
    #[serde(default)]
    machine: BTreeMap<String, Table>,
}

/// Why settings cannot be used.
#[derive(Debug, Error)]
pub(super) enum ConfigError {
    #[error("cannot read {}: {error}", path.display())]
    Read { path: PathBuf, error: std::io::Error },
    #[error("{}: {error}", path.display())]
    Toml { path: PathBuf, error: toml::de::Error },
    #[error("{origin}: {name} must be true or false, not {value:?}")]
    NoFlag { origin: String, name: String, value: String },
    #[error("{origin}: {name} takes one value, or several if its option may be repeated")]
    NoValue { origin: String, name: String },
    #[error("{}:{line}: unknown setting `{name}`{suggestion}", path.display())]
    Unknown { path: PathBuf, line: usize, name: String, suggestion: String },
    #[error("unknown preset `{name}`{suggestion}")]
    NoPreset { name: String, suggestion: String, command: String },
}

/// Settings of one origin.
struct Layer {
    origin: String,
    settings: Vec<Setting>,
}

/// An option and its values: none for a flag, several for an option that takes several at once.
struct Setting {
    name: String,
    values: Vec<String>,
}

impl Setting {
    /// The option as it would be typed.
    fn arguments(&self) -> Vec<OsString> {
        match self.values.as_slice() {
            [value] => vec![format!("--{}={value}", self.name).into()],
            values => {
                let option = std::iter::once(format!("--{}", self.name));
                option.chain(values.iter().cloned()).map(OsString::from).collect()
            }
        }
    }

    /// Whether a command's option takes the values.
    fn suits(&self, command: &Command) -> bool {
        let name = OsString::from(command.get_name());
        let typed = std::iter::once(name).chain(self.arguments());
        let refused = |error: clap::Error| {
            matches!(error.kind(), ErrorKind::InvalidValue | ErrorKind::ValueValidation)
        };
        !command.clone().try_get_matches_from(typed).is_err_and(refused)
    }
}

/// The resulting arguments, without the program's name.
pub(super) fn arguments() -> impl Iterator<Item = OsString> {
    let instead = INSTEAD.with_borrow(Clone::clone);
    let arguments = instead.or_else(|| ARGUMENTS.get().cloned());
    arguments.unwrap_or_else(|| std::env::args_os().skip(1).collect()).into_iter()
}

/// From now on, this thread works as if these arguments had been typed after the program's name.
#[cfg(feature = "view")]
pub(super) fn type_instead(arguments: Vec<OsString>) {
    INSTEAD.set(Some(arguments));
}

/// Whether an option, as in `--page`, was typed rather than set in a file or in the environment.
pub(super) fn is_typed(option: &str) -> bool {
    let is_it = |argument: OsString| {
        let argument = argument.to_string_lossy();
        argument.strip_prefix(option).is_some_and(|rest| rest.is_empty() || rest.starts_with('='))
    };
    match INSTEAD.with_borrow(Clone::clone) {
        Some(arguments) => arguments.into_iter().any(is_it),
        None => std::env::args_os().skip(1).any(is_it),
    }
}

/// Parses what was typed together with the settings. Bad usage ends the program.
pub(super) fn with_settings(mut command: Command) -> Result<ArgMatches, Box<dyn Error>> {
    command.build();
    let typed = usage::spelled_out(&command, std::env::args_os().collect());
    let matches = usage::parse_in_part(&command, &typed);
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
    for layer in layers(preset, name, &command)? {
        let mut used = Vec::new();
        for setting in &layer.settings {
            if options.get_name() == "fill" && FOR_PENS.contains(&setting.name.as_str()) {
                continue;
            }
            let Some(arg) = option(options, &setting.name) else { continue };
            // Commands share names: the lines of a model are not those of a surface. A value that another
            // command takes is meant for that one; a value that none takes is refused below.
            let other = |other: &&Command| option(other, &setting.name).is_some();
            let mut others = commands(&command).filter(other);
            if !setting.suits(options) && others.any(|other| setting.suits(other)) {
                continue;
            }
            let conflicts = |a: &clap::Arg, b: &clap::Arg| {
                options.get_arg_conflicts_with(a).iter().any(|other| other.get_id() == b.get_id())
            };
            let is_taken = taken.iter().any(|other| {
                other.get_id() == arg.get_id() || conflicts(arg, other) || conflicts(other, arg)
            });
            if !is_taken {
                used.push(arg);
                added.extend(setting.arguments());
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
    let _ = ARGUMENTS.set(all.split_off(1).into_iter().map(usage::as_typed).collect());
    result.map_err(|error| {
        if origins.is_empty() {
            error.exit();
        }
        format!("with settings from {}:\n{error}", origins.join(" and ")).trim_end().into()
    })
}

/// The commands that settings apply to.
fn commands(program: &Command) -> impl Iterator<Item = &Command> {
    COMMANDS.iter().filter_map(|name| program.find_subcommand(name))
}

/// A command's option of this name.
fn option<'a>(command: &'a Command, name: &str) -> Option<&'a Arg> {
    command.get_arguments().find(|arg| arg.get_long() == Some(name))
}

/// All options that can be set, by name.
fn known(program: &Command) -> BTreeMap<&str, &Arg> {
    let options = commands(program).flat_map(Command::get_arguments);
    let named = options.filter_map(|arg| Some((arg.get_long()?, arg)));
    named.filter(|(name, _)| !["help", "version", "preset"].contains(name)).collect()
}

/// Settings by origin, the highest precedence first; `command` is for messages.
fn layers(
    preset: Option<String>,
    command: &str,
    program: &Command,
) -> Result<Vec<Layer>, ConfigError> {
    let known = known(program);
    let preset = preset.or_else(|| std::env::var("HIDDENLINE_PRESET").ok());
    let preset = preset.filter(|name| !name.is_empty());
    let mut files = Vec::new();
    for path in paths() {
        if let Some(file) = read(&path)? {
            for settings in std::iter::once(&file.defaults).chain(file.preset.values()) {
                refuse_unknown(settings, &known, &path)?;
            }
            files.push((path, file));
        }
    }
    let mut layers = Vec::new();
    if let Some(name) = preset {
        let found = files.iter().find_map(|(path, file)| Some((path, file.preset.get(&name)?)));
        let Some((path, settings)) = found else {
            let known: Vec<&str> = preset_names(&files);
            let suggestion = match known.as_slice() {
                [] => "; no configuration file defines any".to_owned(),
                known => suggestion(&name, known.iter().copied()),
            };
            return Err(ConfigError::NoPreset { name, suggestion, command: command.to_owned() });
        };
        let origin = format!("preset {name} in {}", path.display());
        layers.push(Layer { settings: settings_of(settings, &known, &origin)?, origin });
    }
    layers.push(environment(&known)?);
    for (path, file) in &files {
        let origin = path.display().to_string();
        layers.push(Layer { settings: settings_of(&file.defaults, &known, &origin)?, origin });
    }
    Ok(layers)
}

/// Machines of the configuration files.
#[derive(Default)]
pub(super) struct OwnMachines {
    /// The one requested, and the name of its origin.
    pub(super) found: Option<(Table, String)>,
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

/// The names of all presets.
pub(super) fn presets() -> Result<Vec<String>, ConfigError> {
    let files: Result<Vec<_>, ConfigError> = paths()
        .into_iter()
        .filter_map(|path| Some(read(&path).transpose()?.map(|file| (path, file))))
        .collect();
    Ok(preset_names(&files?).into_iter().map(str::to_owned).collect())
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

/// Refuses a table with a setting that is not the name of any option.
fn refuse_unknown(
    settings: &Table,
    known: &BTreeMap<&str, &Arg>,
    path: &Path,
) -> Result<(), ConfigError> {
    let Some(name) = settings.keys().find(|name| !known.contains_key(name.as_str())) else {
        return Ok(());
    };
    // Only now is the line needed.
    let text = std::fs::read_to_string(path).unwrap_or_default();
    Err(ConfigError::Unknown {
        path: path.to_owned(),
        line: line_of(&text, name),
        name: name.clone(),
        suggestion: did_you_mean(name, known),
    })
}

/// The line of the first setting called `name`, counted from 1.
fn line_of(text: &str, name: &str) -> usize {
    fn place(table: &DeTable, name: &str) -> Option<usize> {
        table.iter().find_map(|(key, value)| match value.get_ref() {
            _ if key.get_ref() == name => Some(key.span().start),
            DeValue::Table(inner) => place(inner, name),
            _ => None,
        })
    }
    let table = DeTable::parse(text).ok();
    let place = table.and_then(|table| place(table.get_ref(), name)).unwrap_or(0);
    1 + text[..place].matches('\n').count()
}

fn did_you_mean(name: &str, known: &BTreeMap<&str, &Arg>) -> String {
    let known: Vec<&str> = known.keys().copied().collect();
    match near(name, &known).as_slice() {
        [] => "; settings have the names of options, see --help".to_owned(),
        near => format!("; did you mean {}?", near.join(" or ")),
    }
}

/// Settings of a table whose names are all known.
fn settings_of(
    table: &Table,
    known: &BTreeMap<&str, &Arg>,
    origin: &str,
) -> Result<Vec<Setting>, ConfigError> {
    let mut settings = Vec::new();
    for (name, value) in table {
        let Some(arg) = known.get(name.as_str()) else { continue };
        let values: Option<Vec<String>> = match value {
            Value::Array(values) => values.iter().map(plain).collect(),
            value => plain(value).map(|value| vec![value]),
        };
        let no_value = || ConfigError::NoValue { origin: origin.to_owned(), name: name.clone() };
        let values = values.ok_or_else(no_value)?;
        if values.len() != 1 && !takes_several(arg) && !is_repeated(arg) {
            return Err(no_value());
        }
        settings.extend(set(name, values, arg, origin)?);
    }
    Ok(settings)
}

/// A plain value as it would be typed.
fn plain(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.clone()),
        Value::Integer(_) | Value::Float(_) | Value::Boolean(_) => Some(value.to_string()),
        Value::Datetime(_) | Value::Array(_) | Value::Table(_) => None,
    }
}

/// Whether an option takes several values each time.
fn takes_several(arg: &Arg) -> bool {
    arg.get_num_args().is_some_and(|range| range.max_values() > 1)
}

/// Whether an option can be given more than once.
fn is_repeated(arg: &Arg) -> bool {
    matches!(arg.get_action(), clap::ArgAction::Append)
}

/// The values of one setting as options: a flag or nothing, one with all values, or one for each.
fn set(
    name: &str,
    values: Vec<String>,
    arg: &Arg,
    origin: &str,
) -> Result<Vec<Setting>, ConfigError> {
    let setting = |values| Setting { name: name.to_owned(), values };
    if arg.get_action().takes_values() {
        return Ok(if takes_several(arg) {
            vec![setting(values)]
        } else {
            values.into_iter().map(|value| setting(vec![value])).collect()
        });
    }
    match values.first().map(String::as_str) {
        Some("1" | "true") => Ok(vec![setting(Vec::new())]),
        Some("0" | "false") => Ok(Vec::new()),
        value => Err(ConfigError::NoFlag {
            origin: origin.to_owned(),
            name: name.to_owned(),
            value: value.unwrap_or_default().to_owned(),
        }),
    }
}

/// Warnings about environment variables that begin like settings and are none.
pub(super) fn unknown_variables() -> Vec<String> {
    UNKNOWN.lock().map(|unknown| unknown.clone()).unwrap_or_default()
}

/// Settings from environment variables, with a warning about each that is not the name of an option.
///
/// Several pens are separated by blanks, as are the values of options that take several.
fn environment(known: &BTreeMap<&str, &Arg>) -> Result<Layer, ConfigError> {
    let mut variables: Vec<(String, String)> = std::env::vars_os()
        .filter_map(|(name, value)| {
            let name = name.to_str()?.strip_prefix(PREFIX)?.to_owned();
            Some((name, value.to_string_lossy().into_owned()))
        })
        .filter(|(name, value)| name != "PRESET" && !value.is_empty())
        .collect();
    variables.sort();
    let mut settings = Vec::new();
    for (variable, value) in variables {
        let name = variable.replace('_', "-").to_ascii_lowercase();
        let Some(arg) = known.get(name.as_str()) else {
            let hint = did_you_mean(&name, known);
            let warning = format!("{PREFIX}{variable} is not a setting{hint}");
            if let Ok(mut unknown) = UNKNOWN.lock()
                && !unknown.contains(&warning)
            {
                unknown.push(warning);
            }
            continue;
        };
        let values = if name == "pen" || takes_several(arg) {
            value.split_whitespace().map(str::to_owned).collect()
        } else {
            vec![value]
        };
        settings.extend(set(&name, values, arg, &format!("{PREFIX}{variable}"))?);
    }
    Ok(Layer { origin: "the environment (HIDDENLINE_…)".into(), settings })
}

/// Prints which files are read, their presets and machines, and the settings in effect.
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
    let mut program = usage::command();
    program.build();
    let mut seen: Vec<String> = Vec::new();
    for layer in layers(preset.map(str::to_owned), "config", &program)? {
        let mut names = Vec::new();
        for Setting { name, values } in layer.settings {
            if seen.contains(&name) {
                continue;
            }
            let value = match values.as_slice() {
                [] => "true".to_owned(),
                [value] => format!("{value:?}"),
                values => format!("{values:?}"),
            };
            writeln!(text, "{name} = {value}  # {}", layer.origin)?;
            names.push(name);
        }
        seen.extend(names);
    }
    unknown_variables().iter().for_each(|warning| messages::warning(warning));
    file::write_to_stdout(|out| out.write_all(text.as_bytes())).map_err(Into::into)
}
