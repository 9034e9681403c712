//! Why a surface cannot be drawn, and notes on a drawing.

use thiserror::Error;

use super::certificate::Certificate;
use crate::camera::framing::ViewError;
use crate::engines::surface::HorizonError;
use crate::model::mesh::MeshError;
use crate::page::PageError;
use crate::surface::SamplingError;

/// Most triangles that an engine for meshes is given: about 3 GB of memory.
pub const MAX_TRIANGLES: u64 = 8_000_000;

/// Most level curves of a drawing.
pub(super) const MAX_LEVELS: usize = 65_535;

/// Why a surface cannot be drawn.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// The surface cannot be sampled.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    /// The view is not a valid camera.
    #[error(transparent)]
    View(#[from] ViewError),
    /// The drawing cannot be placed on the page.
    #[error(transparent)]
    Page(#[from] PageError),
    /// The samples make no mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The engine for grids cannot draw this surface.
    #[error(transparent)]
    Horizon(#[from] HorizonError),
    /// There are samples, but no triangle between them.
    #[error("no four neighboring samples have a height: nothing to draw")]
    NoCells,
    /// Too many for an engine for meshes.
    #[error(
        "the surface has {0} triangles, and its lines need a mesh engine, which takes at most \
         {MAX_TRIANGLES}"
    )]
    TooManyTriangles(u64),
    /// More level curves than can be distinguished.
    #[error("{0:.0} level curves exceed the limit of {MAX_LEVELS}")]
    TooManyLevels(f64),
    /// Level curves alone are to be drawn, and there are none.
    #[error(transparent)]
    NoLevels(#[from] NoLevels),
    /// The floating horizon needs one family of lines.
    #[error("the floating horizon draws one family of grid lines and nothing else")]
    OneFamily,
    /// The floating horizon needs one grid.
    #[error("the floating horizon draws one surface z = f(x, y) over a rectangle")]
    OneGrid,
    /// Max-min cannot draw this surface.
    #[error(
        "max-min draws one surface z = f(x, y) without holes over a convex part of the plane, or \
         two that meet along their border, seen from outside and not cut by the near plane"
    )]
    MaxMin,
    /// The near plane cuts the surface, and the engine cannot draw that.
    #[error("the near plane cuts the surface")]
    NearPlane,
    /// An order of cells was given for a surface that is not drawn cell by cell.
    #[error(
        "an order of cells needs one surface z = f(x, y) over a rectangle without holes, drawn \
         with grid lines only"
    )]
    Order,
    /// A frame was requested around a surface that is seen at an angle.
    #[error("a frame needs an orthographic view from straight above or below")]
    Frame,
}

/// Why a surface has no level curves.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum NoLevels {
    /// All points have the same height.
    #[error("the surface is flat at height {height}: it has no level curves")]
    Level {
        /// The height, rounded to six digits.
        height: f64,
    },
    /// None of the heights is one of the surface.
    #[error(
        "the surface has heights from {low} to {high}: none of the given levels is in this range"
    )]
    OutOfRange {
        /// The lowest height, rounded to six digits.
        low: f64,
        /// The highest height, rounded to six digits.
        high: f64,
    },
}

/// Something worth knowing about a drawing of a surface.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SurfaceNote {
    /// Lines may be farther from the function than requested, even with the finest samples.
    #[error("{0}")]
    Uncertified(Certificate),
    /// The formula grows without end somewhere, so that only usual heights are drawn.
    #[error("the formula is unbounded; heights from {low} to {high} are drawn")]
    Poles {
        /// The lowest, before any scaling, rounded to six digits.
        low: f64,
        /// The highest, before any scaling, rounded to six digits.
        high: f64,
    },
    /// Two sheets were joined at their common rim.
    #[error(
        "both sheets end at the same rim: {0} rim points were moved to the mean height of the two"
    )]
    RimsJoined(usize),
    /// There are no level curves; other lines are drawn.
    #[error(transparent)]
    NoLevels(NoLevels),
    /// Level curves of some length without a label.
    #[error("no room for labels on {} of the level curves: {}", .0.len(), .0.join(", "))]
    Unlabelled(Vec<String>),
    /// Letters of titles that the font does not have.
    #[error("the font lacks {}: drawn as question marks", list(.0))]
    MissingLetters(Vec<char>),
    /// Samples without a logarithm.
    #[error("{0} samples are left out: values on a logarithmic axis must be above 0")]
    NotPositive(usize),
    /// Text takes up so much room that the drawing is small.
    #[error("numbers and titles leave little room for the drawing on this page")]
    LittleRoom,
    /// Ticks at the requested steps would be too many.
    #[error("the given steps would make too many ticks: an axis uses other steps")]
    TooManyTicks,
    /// There are more sheets than dashes for pens that look alike.
    #[error("{0} sheets look like other sheets: their pens have the same color and width")]
    SheetsAlike(usize),
    /// The box around the surface reaches in front of the near plane.
    #[error("no axes are drawn, since the eye is too close to the box around the surface")]
    NoAxes,
}

fn list(letters: &[char]) -> String {
    let letters: Vec<String> = letters.iter().map(|letter| format!("`{letter}`")).collect();
    letters.join(", ")
}
