//! Engines for function surfaces z = f(x, y). They differ in what hides lines.
//!
//! | engine | draws | hides by | cost |
//! |---|---|---|---|
//! | [`floating_horizon`] | grid lines | the nearer lines of the same family | samples + crossings |
//! | [`max_min`] | both families of grid lines | the triangulated surface | samples + crossings |
//! | [`tin`] | any edges of a triangulated surface over a convex domain | the triangulated surface | triangles + crossings |

mod cells;
pub mod floating_horizon;
mod horizon;
pub mod max_min;
mod ordered_grid;
pub(crate) mod pieces;
mod plan_predicates;
mod plan_triangle;
mod segment;
mod steps;
mod strip;
pub mod tin;
mod wires;

pub use horizon::HorizonCounts;
pub use pieces::{GridPieces, SurfaceSide, VisiblePiece};

use thiserror::Error;

/// The order in which cells are visited; both give the same drawing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum CellOrder {
    /// Row after row, away from the eye.
    #[default]
    Rows,
    /// Diagonal after diagonal, away from the corner nearest to the eye (Cantor's order).
    Diagonals,
}

impl CellOrder {
    /// Both orders.
    pub const ALL: [Self; 2] = [Self::Rows, Self::Diagonals];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rows => "rows",
            Self::Diagonals => "cantor",
        }
    }
}

/// Why a surface cannot be drawn by the engines of this folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum HorizonError {
    /// The eye is on the surface.
    #[error("the eye is on the surface; move it up or down")]
    EyeOnSurface,
    /// Some samples have no height: the eye may look through the hole.
    #[error("the surface has holes; use a mesh engine")]
    Holes,
}
