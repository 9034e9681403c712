//! Surfaces z = f(x, y): where their samples come from, and the mesh they make.

mod csv;
mod grid;
mod levels;
mod lined_mesh;

pub use csv::{CsvError, Placement, read_csv};
pub use grid::{Grid, GridError, Holes, MAX_SAMPLES, evenly};
pub use lined_mesh::{LatticeLines, LinedMesh, LinedScene, SEAM_TOLERANCE, close_seams};
