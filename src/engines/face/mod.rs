//! Face engines: which region of each face is visible, as polygons.
//!
//! ```text
//!  scene, camera ─► depth_sort, bsp, octree ──► pieces from far to near ──┐
//!                   warnock, weiler_atherton ─► pieces beside each other ─┴─► Painting
//! ```

pub mod painting;

pub mod region;

pub mod images;

mod boxes;

pub mod merge;

pub mod warnock;

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
    /// The leaves are too small.
    #[error("{n:.0} leaves are too many; give a larger --leaf, {most:.0} are the most")]
    TooManyLeaves {
        /// How many there are.
        n: f64,
        /// How many there may be.
        most: f64,
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
    /// Width of a leaf in image units, for [`Engine::Warnock`]; `None` for one that suits the image.
    pub leaf: Option<f64>,
    /// How [`Engine::Warnock`] divides windows.
    pub subdivision: warnock::Subdivision,
}

/// Up to so many triangles [`Engine::Auto`] takes the engine with exact regions.
pub const FEW_TRIANGLES: usize = 5000;

/// A scene made ready for an engine, once for any number of views.
#[derive(Debug)]
pub struct Prepared<'a> {
    scene: &'a Scene,
    engine: Engine,
}

impl<'a> Prepared<'a> {
    /// Chooses the engine and does what does not depend on the view.
    pub fn new(scene: &'a Scene, engine: Engine, settings: &Settings) -> Self {
        let is_small = scene.triangles().len() <= FEW_TRIANGLES;
        let engine = match engine {
            Engine::Auto if is_small || settings.disjoint => Engine::WeilerAtherton,
            Engine::Auto => Engine::WeilerAtherton,
            named => named,
        };
        Self { scene, engine }
    }

    /// The engine that was chosen.
    pub fn engine(&self) -> Engine {
        self.engine
    }

    /// The scene.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// The visible regions as a camera sees them.
    ///
    /// # Errors
    /// See [`FaceError`]; all are told before any work is done but counting.
    pub fn solve(&self, camera: &Camera, settings: &Settings) -> Result<Painting, FaceError> {
        let scene = self.scene;
        match self.engine {
            Engine::Auto | Engine::WeilerAtherton => weiler_atherton::solve(scene, camera),
            Engine::Warnock => {
                let Settings { leaf, subdivision, .. } = *settings;
                let options = warnock::Options { leaf, subdivision, window: None };
                warnock::solve(scene, camera, &options)
            }
            Engine::DepthSort | Engine::Bsp | Engine::Octree => {
                Err(FaceError::NotAvailable(self.engine.name()))
            }
        }
    }
}
