//! The command line: typed arguments to a validated job, and the job to a file.

mod args;
mod draw;
mod messages;
mod output;
mod progress;
mod surface;
mod values;

use std::error::Error;
use std::io;
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser, Subcommand};
use clap_complete::Shell;

use self::args::DrawArgs;
use self::surface::SurfaceArgs;

/// Exact hidden-line drawings of 3D models, for print and pen plotters
#[derive(Parser)]
#[command(name = "hiddenline", version, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Draw models as lines, the hidden ones removed
    Draw(Box<DrawArgs>),
    /// Draw a surface z = f(x, y) by its grid lines, the hidden parts removed
    Surface(Box<SurfaceArgs>),
    /// Print a script that completes commands in a shell
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the manual page in troff format
    Man {
        /// Print the page of this command instead
        command: Option<String>,
    },
}

/// Runs the command that was typed.
pub(crate) fn run() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Draw(args) => match args.job() {
            Ok(job) => draw::run(&job),
            Err(message) => bad_usage("draw", message),
        },
        Command::Surface(args) => match args.job() {
            Ok(job) => surface::run(&job),
            Err(message) => bad_usage("surface", message),
        },
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "hiddenline", &mut script);
            output::write_to_stdout(|out| out.write_all(&script)).map_err(Into::into)
        }
        Command::Man { command } => man(command.as_deref()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if is_broken_pipe(error.as_ref()) => ExitCode::SUCCESS,
        Err(error) => {
            messages::error(&error.to_string());
            ExitCode::FAILURE
        }
    }
}

/// Says what is wrong with the arguments of a command, and ends the program as clap does.
fn bad_usage(name: &str, message: String) -> ! {
    let mut command = Cli::command();
    command.build();
    let mut command = command.find_subcommand(name).cloned().unwrap_or_else(Cli::command);
    command.error(ErrorKind::ValueValidation, message).exit()
}

fn man(name: Option<&str>) -> Result<(), Box<dyn Error>> {
    let mut command = Cli::command();
    command.build();
    let chosen = match name {
        None => command,
        Some(name) => command
            .find_subcommand(name)
            .cloned()
            .ok_or_else(|| format!("there is no command `{name}`; see hiddenline --help"))?,
    };
    let mut page = Vec::new();
    clap_mangen::Man::new(chosen).render(&mut page)?;
    output::write_to_stdout(|out| out.write_all(&page)).map_err(Into::into)
}

/// Whether whoever reads our output has closed it: no failure of ours.
fn is_broken_pipe(error: &(dyn Error + 'static)) -> bool {
    let mut cause = Some(error);
    while let Some(error) = cause {
        if error.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe)
        {
            return true;
        }
        cause = error.source();
    }
    false
}
