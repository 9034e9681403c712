//! All integration tests, in one binary.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

// What the tests need: scenes made for the purpose, models of others, and the truth about both.
mod models;
mod oracle;
mod scenes;

// The library: what every engine and stage must obey, and what readers accept and refuse.
mod laws;
pub(crate) mod readers;

// The program as users run it, and the pictures in `plots/`.
mod golden;
mod program;
