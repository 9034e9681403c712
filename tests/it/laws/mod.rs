//! What must hold for the library: laws, closed forms, and agreement with the oracle and between engines.

// Lines of meshes.
mod appel;
mod bends;
mod closed_forms;
mod drawings;
mod extent;
pub(crate) mod engines;
mod intersections;
mod invariance;
mod materials;
mod outline;
mod strokes;
mod views;

// Other engines.
mod face;
mod fill;
mod image;
mod surface;

// Paper, pens and files.
pub(crate) mod optimize;
mod plotter_formats;
mod writers;
