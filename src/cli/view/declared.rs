//! The options of `view`: those of `draw` and of `surface`, from their own declarations.

use clap::builder::{StyledStr, ValueParser};
use clap::{Arg, Command};

/// Options that say where a drawing goes and what is printed about it: the page does that.
const OF_FILES: [&str; 15] = [
    "output",
    "format",
    "stats",
    "quiet",
    "verbose",
    "strict",
    "preset",
    "help",
    "turntable",
    "views",
    "each",
    "list",
    "shard",
    "skip-existing",
    "keep-going",
];
/// Options that stay as they were typed.
const FIXED: [&str; 2] = ["threads", "color"];
/// The commands that the viewer draws by.
pub(super) const DRAW: &str = "draw";
pub(super) const SURFACE: &str = "surface";

/// Gives the command `view` every option of `draw` and of `surface`. Where the two have one of the same
/// name, the value must suit one of them.
pub(in crate::cli) fn with_options_of_drawings(program: Command) -> Command {
    let of = |name: &str| program.find_subcommand(name).cloned().unwrap_or_default();
    let (draw, surface, fill) = (of(DRAW), of(SURFACE), of("fill"));
    let is_input = |arg: &&Arg| matches!(arg.get_help_heading(), Some("Model" | "Surface"));
    program.mut_subcommand("view", |view| {
        // Inputs as `fill` has them, which takes models and surfaces alike.
        let inputs = fill.get_arguments().filter(is_input).cloned();
        let mut view = view.args(inputs);
        for arg in draw.get_arguments().chain(surface.get_arguments()) {
            let Some(name) = arg.get_long() else { continue };
            if OF_FILES.contains(&name) || option(&view, name).is_some() {
                continue;
            }
            let arg = match (option(&draw, name), option(&surface, name)) {
                (Some(of_models), Some(of_surfaces)) if differ(of_models, of_surfaces) => {
                    of_both(of_models, of_surfaces)
                }
                _ => arg.clone(),
            };
            view = view.arg(arg);
        }
        view.arg(preset(&draw))
    })
}

fn preset(draw: &Command) -> Arg {
    option(draw, "preset").cloned().unwrap_or_else(|| Arg::new("preset").long("preset"))
}

/// A command's option of this name.
pub(super) fn option<'a>(command: &'a Command, name: &str) -> Option<&'a Arg> {
    command.get_arguments().find(|arg| arg.get_long() == Some(name))
}

/// Whether an option is one that the page may set: it changes the drawing, and names no file.
pub(super) fn is_on_page(arg: &Arg) -> bool {
    let is_path = arg.get_value_parser().type_id() == std::any::TypeId::of::<std::path::PathBuf>();
    arg.get_long().is_some_and(|name| !OF_FILES.contains(&name) && !FIXED.contains(&name))
        && !is_path
        && !arg.is_hide_set()
}

/// Whether two options of one name mean different things.
fn differ(a: &Arg, b: &Arg) -> bool {
    let help = |arg: &Arg| arg.get_help().map(StyledStr::to_string);
    help(a) != help(b) || a.get_default_values() != b.get_default_values()
}

/// One option for two, which takes what either takes.
fn of_both(of_models: &Arg, of_surfaces: &Arg) -> Arg {
    let help = |arg: &Arg| {
        let text = arg.get_long_help().or(arg.get_help()).map(StyledStr::to_string);
        text.unwrap_or_default()
    };
    let short = |arg: &Arg| arg.get_help().map(StyledStr::to_string).unwrap_or_default();
    let both = format!("{}\n\nFor surfaces: {}", help(of_models), help(of_surfaces));
    let arg = of_models.clone().help(short(of_models)).long_help(both);
    if !arg.get_action().takes_values() {
        return arg;
    }
    let alone = [of_models, of_surfaces].map(|arg| {
        let arg = arg.clone().id("value").long("value").required(false);
        Command::new("value").no_binary_name(true).disable_help_flag(true).arg(alone(arg))
    });
    let arg = arg.hide_possible_values(true).value_delimiter(None);
    arg.value_parser(ValueParser::new(move |text: &str| {
        let parse = |command: &Command| {
            command.clone().try_get_matches_from([format!("--value={text}")]).map(|_| ())
        };
        let error = match (parse(&alone[0]), parse(&alone[1])) {
            (Err(error), Err(_)) => error,
            _ => return Ok(text.to_owned()),
        };
        Err(super::message(&error))
    }))
}

/// The option without what ties it to others.
fn alone(arg: Arg) -> Arg {
    let action = arg.get_action().clone();
    let delimiter = arg.get_value_delimiter();
    let parser = arg.get_value_parser().clone();
    Arg::new("value").long("value").action(action).value_delimiter(delimiter).value_parser(parser)
}
