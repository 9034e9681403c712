//! All integration tests, in one binary.

#![allow(clippy::unwrap_used)]

mod closed_forms;
mod line_svg;
mod optimize;
mod plotter_formats;
