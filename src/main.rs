//! The command line program `hiddenline`; what it does is in the library.

mod cli;

fn main() -> std::process::ExitCode {
    cli::run()
}
