//! Settings of clap for all options at once, and friendlier messages for its errors.

use std::ffi::OsString;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{ArgMatches, Command, CommandFactory};

use super::Cli;
use super::values::{ROUND_STEP, USUAL_PLACE};

/// Options of other programs for the size of a picture.
const SIZES: [&str; 5] = ["--width", "--height", "--size", "--resolution", "--pixels"];

/// The command line, with what applies to every option.
pub(super) fn command() -> Command {
    let program = Cli::command();
    #[cfg(feature = "view")]
    let program = super::view::with_options_of_drawings(program);
    program.mut_subcommands(|command| {
        let takes_list = command.get_arguments().any(|arg| arg.get_id() == "list");
        command.mut_args(|arg| {
            if takes_list && arg.get_id() == "models" {
                return arg.required(false).required_unless_present("list");
            }
            // So that the parser of the value says what it expects, not clap that -5 is not an option.
            let is_option = arg.get_long().is_some() && arg.get_action().takes_values();
            if is_option && !arg.is_allow_hyphen_values_set() {
                arg.allow_negative_numbers(true)
            } else {
                arg
            }
        })
    })
}

/// What was typed for `surface`, in a form that clap takes: formulas may begin with a minus wherever they
/// stand, and `--levels` and `--legend` need no value.
pub(super) fn spelled_out(program: &Command, mut typed: Vec<OsString>) -> Vec<OsString> {
    let is_command = |word: &OsString| word == "surface";
    let (Some(first), Some(command)) =
        (typed.iter().position(is_command), program.find_subcommand("surface"))
    else {
        return typed;
    };
    let takes_value = |word: &str| {
        let of = |arg: &&clap::Arg| {
            let long = arg.get_long().is_some_and(|long| word.strip_prefix("--") == Some(long));
            let short = arg.get_short().is_some_and(|short| word == format!("-{short}"));
            long || short
        };
        command.get_arguments().find(of).is_some_and(|arg| arg.get_action().takes_values())
    };
    let is_short = |word: &str| {
        let short = word.strip_prefix('-').and_then(|rest| rest.chars().next());
        if short.is_none() {
            return false;
        }
        let known = command.get_arguments().find(|arg| arg.get_short() == short);
        // A value may follow at once, as in -oball.svg.
        known.is_some_and(|arg| word.len() == 2 || arg.get_action().takes_values())
            || ["-h", "-V"].contains(&word)
    };
    let is_place = |word: &str| {
        let legend = command.get_arguments().find(|arg| arg.get_id() == "legend");
        let places = legend.map(clap::Arg::get_possible_values).unwrap_or_default();
        places.iter().any(|place| place.matches(word, false))
    };
    for k in first + 1..typed.len() {
        let words = [k.checked_sub(1), Some(k), Some(k + 1)].map(|k| {
            k.and_then(|k| typed.get(k)).and_then(|word| word.to_str()).map(str::to_owned)
        });
        let [before, Some(word), after] = words else { continue };
        let is_value = before.is_some_and(|word| takes_value(&word));
        if is_value {
            continue;
        }
        if word == "--" {
            break;
        }
        let is_alone = after.as_deref().is_none_or(|word| word.starts_with("--") || is_short(word));
        if word == "--levels" && is_alone {
            typed[k] = format!("--levels={ROUND_STEP}").into();
        } else if word == "--legend" && !after.as_deref().is_some_and(is_place) {
            typed[k] = format!("--legend={USUAL_PLACE}").into();
        } else if word.starts_with('-')
            && word.len() > 1
            && !word.starts_with("--")
            && !is_short(&word)
        {
            typed[k] = format!(" {word}").into();
        }
    }
    typed
}

/// A word as it was before [`spelled_out`] put a blank before a formula.
pub(super) fn as_typed(word: OsString) -> OsString {
    match word.to_str().and_then(|word| word.strip_prefix(' ')) {
        Some(formula) if formula.starts_with('-') => formula.into(),
        _ => word,
    }
}

/// Parses what was typed. Bad usage ends the program, except for missing arguments, which settings may
/// provide.
pub(super) fn parse_in_part(command: &Command, typed: &[OsString]) -> ArgMatches {
    let parse = |command: Command| command.try_get_matches_from(typed);
    let parsed = parse(command.clone()).or_else(|error| match error.kind() {
        ErrorKind::MissingRequiredArgument => parse(command.clone().ignore_errors(true)),
        _ => Err(error),
    });
    parsed.unwrap_or_else(|error| with_hints(error, command, typed).exit())
}

/// Ends the program as clap does for invalid arguments.
pub(super) fn exit_with(name: &str, message: &str) -> ! {
    let mut command = command();
    command.build();
    let mut command = command.find_subcommand(name).cloned().unwrap_or(command);
    command.error(ErrorKind::ValueValidation, message).exit()
}

/// Suggests an option instead of an unknown one, where clap only suggests to take it for a file name.
fn with_hints(mut error: clap::Error, command: &Command, typed: &[OsString]) -> clap::Error {
    if error.kind() != ErrorKind::UnknownArgument {
        return error;
    }
    let Some(ContextValue::String(unknown)) = error.get(ContextKind::InvalidArg) else {
        return error;
    };
    let mut words = typed.iter().filter_map(|word| word.to_str());
    let command = words.find_map(|word| command.find_subcommand(word));
    let has = |long: &str| {
        command.is_some_and(|c| c.get_arguments().any(|arg| arg.get_long() == Some(long)))
    };
    let hint = match unknown.split('=').next().unwrap_or_default() {
        size if SIZES.contains(&size) && has("png-width") => Some(
            "the paper size is set by '--page WIDTHxHEIGHT', the width of a PNG by '--png-width'",
        ),
        size if SIZES.contains(&size) && has("size") => {
            Some("the size in pixels is set by '--size WIDTHxHEIGHT'")
        }
        _ => None,
    };
    error.remove(ContextKind::Suggested);
    if let Some(hint) = hint {
        error.remove(ContextKind::SuggestedArg);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![hint.into()]));
    }
    error
}
