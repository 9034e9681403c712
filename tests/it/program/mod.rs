//! The program as users run it.

mod cli;
mod drafting;
mod drawings;
mod empty;
pub(crate) mod fill;
mod hatch;
mod hidden_levels;
mod many;
mod materials;
mod mistakes;
mod models;
mod parameters;
mod plotting;
mod preview;
mod settings;
mod surface;
mod view;

use std::path::Path;
use std::process::{Command, Output, Stdio};

/// A cube of two units around the origin, as OBJ.
const CUBE: &str = "\
v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8
";

/// The program in a folder, without standard input and without the settings of whoever runs the tests.
pub(crate) fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hiddenline"));
    command.args(arguments).current_dir(folder).stdin(Stdio::null());
    command.env("XDG_CONFIG_HOME", folder.join("user"));
    for (name, _) in std::env::vars_os() {
        if name.to_string_lossy().starts_with("HIDDENLINE_") {
            command.env_remove(name);
        }
    }
    command
}

/// Runs the program in a folder.
pub(crate) fn hiddenline(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().unwrap()
}

/// What the program wrote, as text.
pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Asserts that the program failed with an exit code and a message, and wrote nothing.
#[track_caller]
fn assert_fails(output: &Output, code: i32, message: &str) {
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{stderr}");
    assert!(stderr.contains(message), "{stderr}");
    assert!(output.stdout.is_empty());
}
