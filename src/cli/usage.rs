//! Settings of clap for all options at once, and friendlier messages for its errors.

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{ArgMatches, Command, CommandFactory};

use super::Cli;

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

/// Parses what was typed. Bad usage ends the program, except for missing arguments, which settings may
/// provide.
pub(super) fn parse_in_part(command: &Command, typed: &[std::ffi::OsString]) -> ArgMatches {
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
fn with_hints(
    mut error: clap::Error,
    command: &Command,
    typed: &[std::ffi::OsString],
) -> clap::Error {
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
        size if SIZES.contains(&size) && has("png-width") => {
            Some("the paper is set by '--page WIDTHxHEIGHT', the pixels of a PNG by '--png-width'")
        }
        size if SIZES.contains(&size) && has("size") => {
            Some("the pixels are set by '--size WIDTHxHEIGHT'")
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
