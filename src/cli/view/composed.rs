//! Drawings as commands: the page requests what could have been typed, and it is drawn as such.

use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};

use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command};
use serde_json::Value;

use super::declared::{DRAW, SURFACE, is_on_page, option};

/// Options by name: no value for a flag, several for one that is given several times.
pub(super) type Options = BTreeMap<String, Vec<OsString>>;

/// A command that draws: `draw` with models, or `surface` with formulas.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Composed {
    /// `draw` or `surface`.
    pub(super) name: &'static str,
    /// Models, or formulas of sheets.
    pub(super) subjects: Vec<OsString>,
    pub(super) options: Options,
}

impl Composed {
    /// What was typed after `view`; the error is a message about usage.
    pub(super) fn typed(program: &Command, matches: &ArgMatches) -> Result<Self, String> {
        let is_typed = |id: &str| {
            matches.try_contains_id(id).unwrap_or(false)
                && matches.value_source(id) == Some(ValueSource::CommandLine)
        };
        let values = |id: &str| -> Vec<OsString> {
            let raw = matches.try_get_raw(id).ok().flatten();
            raw.into_iter().flatten().map(OsStr::to_owned).collect()
        };
        let is_surface =
            ["expression", "grid", "points", "parametric"].iter().any(|id| is_typed(id));
        let name = if is_surface { SURFACE } else { DRAW };
        let subjects = values(if is_surface { "expression" } else { "models" });
        if !is_surface && subjects.is_empty() {
            return Err(
                "specify models, or a surface with --expr, --grid, --points or --parametric".into(),
            );
        }
        let view = program.find_subcommand("view");
        let command = program.find_subcommand(name);
        let (Some(view), Some(command)) = (view, command) else {
            return Err(format!("unknown command {name}"));
        };
        let mut options = Options::new();
        for arg in view.get_arguments().filter(|arg| is_typed(arg.get_id().as_str())) {
            let Some(long) = arg.get_long().filter(|long| !OWN.contains(long)) else { continue };
            let Some(known) = option(command, long) else {
                let of = if is_surface { "models" } else { "surfaces" };
                return Err(format!("--{long} is for {of}"));
            };
            let given = match known.get_action() {
                ArgAction::SetTrue => Vec::new(),
                _ => values(arg.get_id().as_str()),
            };
            options.insert(long.to_owned(), rejoined(known, given));
        }
        Ok(Self { name, subjects, options })
    }

    /// The same with the options that a page requests in place of its own: an object with texts, numbers,
    /// `true`, or lists of texts. Options that the page may not set stay as they are.
    pub(super) fn with(&self, command: &Command, asked: &Value) -> Result<Self, String> {
        let Some(asked) = asked.as_object() else {
            return Err("`options` must be an object".into());
        };
        let stays = |name: &str| option(command, name).is_some_and(|arg| !is_on_page(arg));
        let mut composed = self.clone();
        composed.options.retain(|name, _| stays(name));
        for (name, value) in asked {
            if let ("expr", SURFACE) = (name.as_str(), self.name) {
                let formulas = texts(name, value)?.unwrap_or_default();
                composed.subjects = formulas.into_iter().map(OsString::from).collect();
                continue;
            }
            let arg = option(command, name).filter(|arg| is_on_page(arg));
            let arg =
                arg.ok_or_else(|| format!("`{name}` is not an option that the page can set"))?;
            let Some(values) = texts(name, value)? else { continue };
            let (takes, needs) = (arg.get_action().takes_values(), !is_optional(arg));
            if values.is_empty() && takes && needs || !values.is_empty() && !takes {
                return Err(format!("`{name}` lacks a value, or has one but takes none"));
            }
            composed.options.insert(name.clone(), values.into_iter().map(OsString::from).collect());
        }
        Ok(composed)
    }

    /// The arguments after the program's name. Options with their default values are left out.
    pub(super) fn arguments(&self, command: &Command) -> Vec<OsString> {
        let mut arguments: Vec<OsString> = vec![self.name.into()];
        for (number, subject) in self.subjects.iter().enumerate() {
            let text = subject.to_string_lossy();
            // Only the first formula may begin with a minus.
            let is_like_option = self.name == SURFACE && number > 0 && text.starts_with('-');
            arguments.push(if is_like_option {
                format!("({text})").into()
            } else {
                subject.clone()
            });
        }
        for arg in command.get_arguments() {
            let Some(name) = arg.get_long() else { continue };
            let Some(values) = self.options.get(name) else { continue };
            let default = arg.get_default_values();
            if !values.is_empty() && values.iter().eq(default.iter()) {
                continue;
            }
            if values.is_empty() {
                arguments.push(format!("--{name}").into());
            } else if takes_several(arg) {
                arguments.push(format!("--{name}").into());
                arguments.extend(values.iter().cloned());
            } else {
                arguments.extend(values.iter().map(|value| {
                    let mut argument = OsString::from(format!("--{name}="));
                    argument.push(value);
                    argument
                }));
            }
        }
        arguments
    }

    /// What a file of the drawing is called, without extension.
    pub(super) fn file_stem(&self) -> String {
        let files = ["grid", "points"].iter().find_map(|name| self.options.get(*name));
        let named = match (self.name, files) {
            (_, Some(values)) => values.first(),
            (DRAW, _) => self.subjects.first(),
            _ => None,
        };
        let stem = named.and_then(|name| std::path::Path::new(name).file_stem());
        let stem = stem.map(|stem| stem.to_string_lossy().into_owned());
        stem.filter(|stem| stem != "-").unwrap_or_else(|| match self.name {
            SURFACE => "surface".to_owned(),
            _ => "drawing".to_owned(),
        })
    }

    /// The values of one option as text.
    pub(super) fn texts(&self, name: &str) -> Vec<String> {
        let values = self.options.get(name).into_iter().flatten();
        values.map(|value| value.to_string_lossy().into_owned()).collect()
    }
}

/// Options of `view` alone.
const OWN: [&str; 7] = ["port", "no-open", "watch", "once", "color", "expr", "preset"];

/// Values that one comma-separated value was split into, as that one again.
fn rejoined(arg: &Arg, values: Vec<OsString>) -> Vec<OsString> {
    match arg.get_value_delimiter() {
        Some(delimiter) if values.len() > 1 => {
            vec![values.join(OsStr::new(delimiter.to_string().as_str()))]
        }
        _ => values,
    }
}

/// Whether an option takes several values each time.
pub(super) fn takes_several(arg: &Arg) -> bool {
    arg.get_num_args().is_some_and(|range| range.max_values() > 1)
}

/// Whether an option may stand without a value.
pub(super) fn is_optional(arg: &Arg) -> bool {
    arg.get_num_args().is_some_and(|range| range.min_values() == 0)
}

/// What a page says of one option; `None` if it is not given.
fn texts(name: &str, value: &Value) -> Result<Option<Vec<String>>, String> {
    let text = |value: &Value| match value {
        Value::String(text) => Ok(text.clone()),
        Value::Number(number) => Ok(number.to_string()),
        _ => Err(format!("`{name}` must be a string, a number, true, or a list of strings")),
    };
    Ok(match value {
        Value::Null | Value::Bool(false) => None,
        Value::Bool(true) => Some(Vec::new()),
        Value::String(empty) if empty.trim().is_empty() => None,
        Value::Array(values) => {
            let values = values.iter().map(text).collect::<Result<Vec<_>, _>>()?;
            let values: Vec<String> =
                values.into_iter().filter(|value| !value.trim().is_empty()).collect();
            (!values.is_empty()).then_some(values)
        }
        value => Some(vec![text(value)?]),
    })
}
