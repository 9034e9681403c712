//! All integration tests, in one binary.

mod cli;
mod closed_forms;
mod drawings;
mod engines;
mod formula;
mod laws;
mod oracle;
mod readers;
mod scenes;
mod surface;
mod truth;
mod views;
mod writers;
