//! All integration tests, in one binary.

mod cli;
mod closed_forms;
mod drawings;
mod engines;
mod laws;
mod oracle;
mod readers;
mod scenes;
mod truth;
mod views;
mod writers;
mod formula;
mod surface;
