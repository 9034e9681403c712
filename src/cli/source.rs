//! The command that made a file, for its metadata.

use std::ffi::OsString;

/// The command as typed, but for what does not change the drawing: the same drawing has the same
/// bytes, wherever it is written to and however many threads made it.
pub(super) fn source(arguments: impl Iterator<Item = OsString>) -> String {
    let mut command = "hiddenline".to_owned();
    let mut arguments = arguments.map(|argument| argument.to_string_lossy().into_owned());
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "-o" | "--output" | "--threads" | "--color" | "--preset" | "--shard" => {
                arguments.next();
            }
            "-q" | "--quiet" | "-v" | "--verbose" | "--stats" | "--strict" | "--skip-existing"
            | "--keep-going" => {}
            other
                if ["-o", "-q", "--output=", "--threads=", "--color=", "--preset=", "--shard="]
                    .iter()
                    .any(|prefix| other.starts_with(prefix)) => {}
            other => {
                command.push(' ');
                command.push_str(&quoted(other));
            }
        }
    }
    command
}

/// The argument as a shell takes it.
pub(super) fn quoted(argument: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,:=+@%".contains(c);
    if !argument.is_empty() && argument.chars().all(plain) {
        argument.to_owned()
    } else {
        format!("'{}'", argument.replace('\'', "'\\''"))
    }
}
