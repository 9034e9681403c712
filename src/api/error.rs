//! What can go wrong between a file and a sheet of paper.

use std::path::PathBuf;
use std::{fmt, io};

use thiserror::Error as ThisError;

use crate::camera::framing::ViewError;
use crate::draw::surface::SurfaceError;
use crate::hatch::HatchError;
use crate::model::mesh::MeshError;
use crate::page::PageError;
use crate::read::ReadError;
use crate::shading::fill::FillError;
#[cfg(feature = "points")]
use crate::surface::PointsError;
use crate::surface::formula::{FormulaError, ParameterError};
use crate::surface::{FamilyError, GridError, HeightError};
use crate::write::WriteError;

/// Why a drawing failed.
///
/// Its `Debug` is its message, so that a `main` that returns it ends with a sentence:
///
/// ```
/// use hiddenline::Scene;
///
/// let error = Scene::open("missing.obj").unwrap_err();
/// assert_eq!(format!("{error:?}"), error.to_string());
/// ```
#[derive(ThisError)]
#[non_exhaustive]
pub enum Error {
    /// A model file cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The faces do not form a valid mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A text is not a valid formula.
    #[error(transparent)]
    Formula(#[from] FormulaError),
    /// A name or a value cannot be a parameter of formulas.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// Sheets cannot be made for the values of parameters.
    #[error(transparent)]
    Family(#[from] FamilyError),
    /// The samples of a surface do not form a grid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// No surface goes through the points.
    #[cfg(feature = "points")]
    #[error(transparent)]
    Points(#[from] PointsError),
    /// A file of heights cannot be read.
    #[error("{}: {error}", path.display())]
    Heights {
        /// The file.
        path: PathBuf,
        /// Why.
        error: Box<HeightError>,
    },
    /// The surface cannot be drawn.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The view is not a valid camera.
    #[error(transparent)]
    View(#[from] ViewError),
    /// The drawing cannot be placed on the page.
    #[error(transparent)]
    Page(#[from] PageError),
    /// The faces cannot be filled as requested.
    #[error(transparent)]
    Fill(#[from] FillError),
    /// The faces cannot be hatched as requested.
    #[error(transparent)]
    Hatch(#[from] HatchError),
    /// The extension of the output file does not name a format that can be written.
    #[error("{}: the extension names no format; use one of {}", .0.display(), crate::write::known_extensions())]
    UnknownFormat(PathBuf),
    /// The format cannot hold this sheet, or its machine is unknown.
    #[error("{}: {error}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        error: WriteError,
    },
    /// The file cannot be opened.
    #[error("cannot read {}: {error}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// The file cannot be written.
    #[error("cannot write {}: {error}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
