//! All integration tests, in one binary.

mod closed_forms;
mod line_svg;
mod optimize;
mod plotter_formats;
