//! What the page can set, from the declarations of the command line.

use clap::builder::StyledStr;
use clap::{Arg, ArgAction, Command};
use serde::Serialize;

use super::composed::{is_optional, takes_several};
use super::declared::is_on_page;

/// One option as the page shows it.
#[derive(Debug, Serialize)]
pub(super) struct Control {
    name: String,
    /// The group in `--help`.
    group: String,
    /// The first line of its help.
    help: String,
    /// All of its help.
    more: String,
    kind: Kind,
    /// It may also stand without a value, just switched on.
    optional: bool,
    /// What a value is called in `--help`.
    value_name: String,
    choices: Vec<Choice>,
    /// The value in effect unless one is set.
    default: String,
}

#[derive(Debug, Clone, Copy, Serialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    /// On or off.
    Flag,
    /// One of the choices.
    Choice,
    /// Some of the choices, with commas between them.
    Choices,
    Number,
    Text,
    /// Texts, one a line.
    Texts,
    /// This many texts together.
    Several(usize),
}

#[derive(Debug, Serialize)]
struct Choice {
    name: String,
    help: String,
}

/// The controls of a command in the order and the groups of its `--help`.
/// Those that cannot go with what is shown, given by the names of its options, are left out.
pub(super) fn controls(command: &Command, shown: &[&str]) -> Vec<Control> {
    let is_shown = |arg: &&Arg| shown.contains(&arg.get_id().as_str());
    let suits = |arg: &&Arg| {
        let conflicts = |other: &Arg| {
            command.get_arg_conflicts_with(other).iter().any(|with| with.get_id() == arg.get_id())
        };
        let excluded = command.get_arg_conflicts_with(arg);
        !excluded.iter().any(is_shown) && !command.get_arguments().filter(is_shown).any(conflicts)
    };
    let on_page = command.get_arguments().filter(|arg| is_on_page(arg));
    on_page.filter(suits).map(control).collect()
}

fn control(arg: &Arg) -> Control {
    let text = |text: Option<&StyledStr>| text.map(StyledStr::to_string).unwrap_or_default();
    let help = text(arg.get_help());
    let choices: Vec<Choice> = arg
        .get_possible_values()
        .iter()
        .filter(|value| !value.is_hide_set() && arg.get_action().takes_values())
        .map(|value| Choice { name: value.get_name().to_owned(), help: text(value.get_help()) })
        .collect();
    let defaults = arg.get_default_values().iter();
    let defaults: Vec<_> = defaults.map(|value| value.to_string_lossy()).collect();
    Control {
        name: arg.get_long().unwrap_or_default().to_owned(),
        group: arg.get_help_heading().unwrap_or("Options").to_owned(),
        more: arg.get_long_help().map_or_else(|| help.clone(), StyledStr::to_string),
        help,
        kind: kind(arg, !choices.is_empty()),
        optional: arg.get_action().takes_values() && is_optional(arg),
        value_name: arg.get_value_names().unwrap_or_default().join(" "),
        choices,
        default: if arg.get_action().takes_values() { defaults.join(",") } else { String::new() },
    }
}

fn kind(arg: &Arg, has_choices: bool) -> Kind {
    if !arg.get_action().takes_values() {
        return Kind::Flag;
    }
    if takes_several(arg) {
        return Kind::Several(arg.get_num_args().map_or(1, |range| range.max_values()));
    }
    let lists = arg.get_value_delimiter().is_some()
        || arg.get_default_values().iter().any(|value| value.to_string_lossy().contains(','));
    if has_choices {
        return if lists { Kind::Choices } else { Kind::Choice };
    }
    if matches!(arg.get_action(), ArgAction::Append) && arg.get_value_delimiter().is_none() {
        return Kind::Texts;
    }
    let parser = arg.get_value_parser().type_id();
    let is = |id: std::any::TypeId| parser == id;
    let is_number = is(std::any::TypeId::of::<f64>())
        || is(std::any::TypeId::of::<u16>())
        || is(std::any::TypeId::of::<u32>())
        || is(std::any::TypeId::of::<usize>());
    if is_number { Kind::Number } else { Kind::Text }
}
