//! What must hold for the library: laws, closed forms, and agreement with the oracle and between engines.

// Lines of meshes.
mod appel;
mod back_faces;
mod bends;
mod closed_forms;
mod coincidences;
mod covered_cells;
mod creases;
mod drafting;
mod drawings;
mod dxf;
pub(crate) mod engines;
mod extent;
mod flush;
mod framing;
mod front_door;
mod hatch;
mod intersections;
mod invariance;
mod layers;
mod materials;
mod occlusion;
mod outline;
mod predicates;
mod short_strokes;
mod smooth;
mod strokes;
mod turntable;
mod views;
mod wires;

// Other engines.
mod face;
mod fill;
mod image;
mod surface;

// Paper, pens and files.
pub(crate) mod optimize;
mod plotter_formats;
mod read_back;
mod writers;
