//! The command line: typed arguments to a validated job, and the job to a file.

mod camera;
mod choice;
mod completions;
mod config;
mod draw;
mod file;
mod fill;
mod formulas;
mod hatch;
mod idle;
mod input;
mod machine;
mod messages;
mod models;
mod naming;
mod optimize;
mod output;
mod page;
mod paper;
mod paths;
mod plotting;
mod preview;
mod progress;
mod scene;
mod smooth;
mod source;
mod stats;
mod suggestion;
mod surface;
mod usage;
mod values;
#[cfg(feature = "view")]
mod view;

use std::error::Error;
use std::io;
use std::process::ExitCode;

use clap::{FromArgMatches, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

use self::config::ConfigError;
use self::draw::DrawArgs;
use self::fill::FillArgs;
use self::optimize::OptimizeArgs;
use self::preview::PreviewArgs;
use self::surface::SurfaceArgs;
#[cfg(feature = "view")]
use self::view::ViewArgs;

/// Exact hidden-line drawings of 3D models, for print and pen plotters
#[derive(Parser)]
#[command(name = "hiddenline", version, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// When to color messages; NO_COLOR and CLICOLOR_FORCE are respected
    #[arg(long, global = true, value_enum, default_value = "auto")]
    color: Color,
}

#[derive(Clone, Copy, ValueEnum)]
enum Color {
    /// On a terminal
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

#[derive(Subcommand)]
enum Command {
    /// Draw models as lines, with hidden lines removed
    Draw(Box<DrawArgs>),
    Surface(Box<SurfaceArgs>),
    /// Fill the visible faces of models with color, for print
    Fill(Box<FillArgs>),
    /// Render a shaded picture of models
    Preview(Box<PreviewArgs>),
    /// Turn a model in the browser, with hidden lines removed as you drag
    #[cfg(feature = "view")]
    View(ViewArgs),
    /// Join and order the strokes of any line SVG for a plotter
    Optimize(Box<OptimizeArgs>),
    /// Show settings from configuration files and the environment
    Config {
        #[command(subcommand)]
        command: ConfigCommand,
    },
    /// Print a shell completion script
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the manual page in troff format
    Man {
        /// Print the manual page of this command instead
        command: Option<String>,
    },
}

#[derive(Subcommand)]
enum ConfigCommand {
    /// Print the configuration files and the resulting settings
    Show {
        /// Include the settings of this preset
        #[arg(long, value_name = "NAME")]
        preset: Option<String>,
    },
}

/// Why a command does not start.
enum Refused {
    /// Arguments do not go together.
    Usage(String),
    /// Something that they name is missing or invalid.
    Failed(Box<dyn Error>),
}

impl From<String> for Refused {
    fn from(message: String) -> Self {
        Self::Usage(message)
    }
}

impl From<&str> for Refused {
    fn from(message: &str) -> Self {
        Self::Usage(message.to_owned())
    }
}

impl From<machine::MachineError> for Refused {
    fn from(error: machine::MachineError) -> Self {
        if error.is_usage() { Self::Usage(error.to_string()) } else { Self::Failed(error.into()) }
    }
}

/// Runs the command that was typed.
pub(crate) fn run() -> ExitCode {
    let matches = match config::with_settings(usage::command()) {
        Ok(matches) => matches,
        Err(error) => match error.downcast_ref() {
            Some(no_preset @ ConfigError::NoPreset { command, .. }) => {
                usage::exit_with(command, &no_preset.to_string())
            }
            _ => return failed(error.as_ref()),
        },
    };
    let typed = Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    let chosen = matches.subcommand();
    let idle = chosen.map_or(Vec::new(), |(name, chosen)| idle::warnings(name, chosen));
    match typed.color {
        Color::Auto => {}
        Color::Always => anstream::ColorChoice::Always.write_global(),
        Color::Never => anstream::ColorChoice::Never.write_global(),
    }
    #[cfg(feature = "view")]
    if let Command::View(_) = typed.command {
        config::unknown_variables().iter().for_each(|warning| messages::warning(warning));
    }
    let result = match typed.command {
        Command::Draw(args) => started("draw", args.job(idle), |job| draw::run(&job)),
        Command::Surface(args) => started("surface", args.job(idle), |job| surface::run(&job)),
        Command::Fill(args) => started("fill", args.job(idle), |job| fill::run(&job)),
        Command::Preview(args) => started("preview", args.job(idle), |job| preview::run(&job)),
        #[cfg(feature = "view")]
        Command::View(args) => match matches.subcommand_matches("view") {
            Some(matches) => started("view", args.job(usage::command(), matches), view::run),
            None => Ok(()),
        },
        Command::Optimize(args) => started("optimize", args.job(idle), |job| optimize::run(&job)),
        Command::Config { command: ConfigCommand::Show { preset } } => {
            config::show(preset.as_deref())
        }
        Command::Completions { shell } => completions::print(shell),
        Command::Man { command } => man(command.as_deref()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if is_broken_pipe(error.as_ref()) => ExitCode::SUCCESS,
        Err(error) => failed(error.as_ref()),
    }
}

fn failed(error: &dyn Error) -> ExitCode {
    messages::error(&error.to_string());
    ExitCode::FAILURE
}

/// Runs a job, or says what is wrong with it.
fn started<J>(
    name: &str,
    job: Result<J, Refused>,
    run: impl FnOnce(J) -> Result<(), Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    match job {
        Ok(job) => run(job),
        Err(Refused::Usage(message)) => usage::exit_with(name, &message),
        Err(Refused::Failed(error)) => Err(error),
    }
}

fn man(name: Option<&str>) -> Result<(), Box<dyn Error>> {
    let mut command = usage::command();
    command.build();
    let chosen = match name {
        None => command,
        Some(name) => command
            .find_subcommand(name)
            .cloned()
            .ok_or_else(|| format!("unknown command `{name}`; see hiddenline --help"))?,
    };
    let mut page = Vec::new();
    clap_mangen::Man::new(chosen).render(&mut page)?;
    file::write_to_stdout(|out| out.write_all(&page)).map_err(Into::into)
}

/// Whether the reader of our output has closed it, which is not a failure.
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
