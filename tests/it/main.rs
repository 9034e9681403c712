//! All integration tests, in one binary.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod appel;
mod bends;
mod cli;
mod closed_forms;
mod drawings;
mod engines;
mod face;
mod fill;
mod formula;
mod gallery;
mod hidden_levels;
mod image;
mod intersections;
mod laws;
mod materials;
mod mistakes;
mod optimize;
mod oracle;
mod outline;
mod plotter_formats;
mod plotting;
mod read_svg;
mod readers;
mod scenes;
mod strokes;
mod surface;
mod truth;
mod views;
mod writers;
