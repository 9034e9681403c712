//! Face engines: which region of each face is visible, as polygons.
//!
//! ```text
//!  scene, camera ─► depth_sort, bsp, octree ──► pieces from far to near ──┐
//!                   warnock, weiler_atherton ─► pieces beside each other ─┴─► Painting
//! ```

pub mod painting;

pub use self::painting::{Painting, Piece};

/// The face engines by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Engine {
    /// One that suits the scene.
    #[default]
    Auto,
    /// Faces sorted by distance, with tests in rising cost and splits where the order has a cycle.
    DepthSort,
    /// A tree of planes, built once for all views.
    Bsp,
    /// A tree of octants, each walked from far to near.
    Octree,
    /// Windows of the image, quartered until each is simple.
    Warnock,
    /// Faces clipped by nearer faces: exact regions beside each other.
    WeilerAtherton,
}
