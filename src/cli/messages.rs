//! Messages on standard error, colored where it is a terminal and NO_COLOR is not set.

use std::fmt::Display;
use std::io::Write;

use clap::builder::styling::{AnsiColor, Style};

pub(super) fn error(message: &str) {
    labeled(AnsiColor::Red.on_default().bold(), "error", message);
}

pub(super) fn warning(message: &str) {
    labeled(AnsiColor::Yellow.on_default().bold(), "warning", message);
}

pub(super) fn hint(message: &str) {
    labeled(AnsiColor::Cyan.on_default().bold(), "hint", message);
}

/// A line without label. If nobody listens, nothing is lost.
pub(super) fn plain(message: impl Display) {
    let _ = writeln!(anstream::stderr(), "{message}");
}

/// How many of something there are, in words: `1 face`, `2 faces`.
pub(super) fn counted(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

fn labeled(style: Style, label: &str, message: &str) {
    let _ = writeln!(anstream::stderr(), "{style}{label}:{style:#} {message}");
}
