//! Surfaces z = f(x, y): where their samples come from, and the mesh that they form.

pub mod formula;

mod axis_scale;
mod cells;
mod crossings;
mod domain;
mod fold_cuts;
mod fold_lines;
mod folds;
mod grid;
mod grid_cuts;
mod grid_folds;
mod height_cut;
mod height_function;
mod heights;
mod lattice_extent;
mod level_curves;
mod levels;
mod lined_mesh;
mod names;
mod places;
#[cfg(feature = "points")]
mod points;
mod proportions;
mod root;
mod sampled;
mod sampled_mesh;
mod sampling;
mod sampling_error;
mod sheet_jets;
mod source;
mod split_cells;
mod tears;

pub use axis_scale::AxisScale;
pub use domain::TrimmedGrid;
pub use folds::FoldView;
pub use grid::{Grid, GridError, Holes, MAX_SAMPLES, evenly};
pub use grid_cuts::{CutGrid, GridCuts};
pub use height_function::HeightFunction;
pub use heights::{HeightError, HeightField, HeightNote, HeightOptions, read_heights};
pub use lattice_extent::lattice_extent;
pub use level_curves::LevelCurve;
pub use lined_mesh::{LatticeLines, LinedMesh, LinedScene, SEAM_TOLERANCE, close_seams};
pub use names::{name_of_values, typeset};
pub use places::Places;
#[cfg(feature = "points")]
pub use points::{Duplicates, PointsError, ScatteredPoints, delaunay};
pub use sampled::{Lattice, SampledSurface};
pub use sampling_error::SamplingError;
pub use sheet_jets::SheetJets;
pub use source::{
    Aspect, DEFAULT_RANGE, DEFAULT_SAMPLES, FamilyError, FormulaSheet, Outside, Surface,
};
