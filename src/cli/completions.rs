//! Completion scripts for shells.
//!
//! A script knows the machines and presets in the configuration files at the time it is generated.

use std::error::Error;

use clap::builder::PossibleValuesParser;
use clap_complete::Shell;

use super::{config, file, machine, usage, values};

/// Prints a script that completes commands in a shell.
pub(super) fn print(shell: Shell) -> Result<(), Box<dyn Error>> {
    let known = [
        ("machine", machine::names()?),
        ("preset", config::presets()?),
        ("pen", values::pen_roles().map(|role| format!("{}=", role.name())).collect()),
    ];
    // The options take other values, too: only completions list the known ones.
    let mut command = usage::command().mut_subcommands(|command| {
        command.mut_args(|arg| {
            let names = known.iter().find(|(option, _)| arg.get_long() == Some(option));
            match names {
                Some((_, names)) => arg.value_parser(PossibleValuesParser::new(names.clone())),
                None => arg,
            }
        })
    });
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, "hiddenline", &mut script);
    file::write_to_stdout(|out| out.write_all(&script)).map_err(Into::into)
}
