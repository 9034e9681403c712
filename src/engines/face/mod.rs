//! Face engines: which region of each face is visible, as polygons.
//!
//! ```text
//!  scene, camera ─► depth_sort, bsp, octree ──► pieces from far to near ──┐
//!                   warnock, weiler_atherton ─► pieces beside each other ─┴─► Painting
//! ```

pub mod painting;

pub mod region;

pub mod images;

pub mod merge;

pub mod weiler_atherton;

use thiserror::Error;

pub use self::painting::{Painting, Piece};
use crate::scene::Scene;
use crate::view::Camera;

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

impl Engine {
    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::DepthSort => "depth-sort",
            Self::Bsp => "bsp",
            Self::Octree => "octree",
            Self::Warnock => "warnock",
            Self::WeilerAtherton => "weiler-atherton",
        }
    }
}

/// Why an engine does not begin.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FaceError {
    /// It would take too long.
    #[error(
        "{engine} takes at most {most} faces, and {n} are in view; \
         take --engine {instead}, or a simpler model"
    )]
    TooManyFaces {
        /// The engine.
        engine: &'static str,
        /// How many there are.
        n: usize,
        /// How many it takes.
        most: usize,
        /// The engine that takes more.
        instead: &'static str,
    },
    /// The program was made without it.
    #[error("the engine {0} is not available")]
    NotAvailable(&'static str),
}

/// What engines can be told.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Settings {
    /// The pieces are to lie beside each other: [`Engine::Auto`] takes an engine that finds them so.
    pub disjoint: bool,
}

/// The visible regions of a scene's faces, and the engine that found them.
///
/// # Errors
/// See [`FaceError`]; all are told before any work is done but counting.
pub fn solve(
    scene: &Scene,
    camera: &Camera,
    engine: Engine,
    settings: &Settings,
) -> Result<(Painting, Engine), FaceError> {
    let engine = match engine {
        Engine::Auto if settings.disjoint || scene.triangles().len() <= FEW_TRIANGLES => {
            Engine::WeilerAtherton
        }
        Engine::Auto => Engine::WeilerAtherton,
        named => named,
    };
    let painting = match engine {
        Engine::Auto | Engine::WeilerAtherton => weiler_atherton::solve(scene, camera)?,
        Engine::DepthSort | Engine::Bsp | Engine::Octree | Engine::Warnock => {
            return Err(FaceError::NotAvailable(engine.name()));
        }
    };
    Ok((painting, engine))
}

/// Up to so many triangles [`Engine::Auto`] takes the engine with exact regions.
const FEW_TRIANGLES: usize = 5000;
