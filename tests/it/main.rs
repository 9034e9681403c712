//! All integration tests, in one binary.

mod cli;
mod closed_forms;
mod views;
mod writers;
