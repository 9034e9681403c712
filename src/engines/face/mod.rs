//! Face engines: which region of each face is visible, as polygons.
//!
//! ```text
//!  scene, camera ─► depth_sort, bsp, octree ──► pieces from far to near ──┐
//!                   warnock, weiler_atherton ─► pieces side by side     ─┴─► Painting
//! ```
//!
//! | engine | cuts faces at | serves | suits |
//! |---|---|---|---|
//! | [`depth_sort`] | planes of others, where no order exists otherwise | one view | few piercings |
//! | [`bsp`] | planes of others | all views | few piercings |
//! | [`octree`] | octants, then as bsp | all views | large faces that hide much |
//!
//! These three sort [`fragment`]s exactly, however often they are cut; [`piercing`] estimates in advance
//! whether that would be too often.

pub mod bsp;
pub mod depth_sort;
pub mod fragment;
pub mod octree;
pub mod painting;
pub mod piercing;

pub mod occupancy;

mod seams;

pub mod mask;

pub mod region;

pub mod images;

pub(crate) mod boxes;

pub mod merge;

pub mod warnock;

pub mod weiler_atherton;

pub mod work;

use thiserror::Error;

pub use self::bsp::TooManyFragments;
pub use self::painting::{PaintedPiece, Painting};
pub use self::work::{FaceWork, FragmentCounts};
use crate::camera::Camera;
use crate::model::scene::Scene;

/// The face engines by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FaceEngine {
    /// Chosen to suit the scene.
    #[default]
    Auto,
    /// Faces sorted by distance, by tests of rising cost, with splits where the order has a cycle.
    DepthSort,
    /// A tree of planes, built once for all views.
    Bsp,
    /// A tree of octants, each walked from far to near.
    Octree,
    /// Windows of the image, quartered until each is simple.
    Warnock,
    /// Faces clipped by nearer faces: exact regions side by side.
    WeilerAtherton,
}

impl FaceEngine {
    /// All of them, in the order of the documentation.
    pub const ALL: [Self; 6] =
        [Self::Auto, Self::DepthSort, Self::Bsp, Self::Octree, Self::Warnock, Self::WeilerAtherton];

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

/// Why an engine does not run.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FaceError {
    /// It would take too long.
    #[error("{engine} takes at most {most} faces, and {n} are in view")]
    TooManyFaces {
        /// The engine.
        engine: &'static str,
        /// How many there are.
        n: usize,
        /// How many it takes at most.
        most: usize,
    },
    /// It would take too long.
    #[error(
        "{engine} takes at most {most} pairs of faces that overlap in the image, and there are more"
    )]
    TooManyPairs {
        /// The engine.
        engine: &'static str,
        /// How many it takes at most.
        most: u64,
    },
    /// The leaves are too small.
    #[error("{n:.0} leaves are too many; the limit is {most:.0}")]
    TooManyLeaves {
        /// How many there are.
        n: f64,
        /// How many there may be.
        most: f64,
    },
    /// The faces are cut into too many fragments.
    #[error(transparent)]
    TooManyFragments(#[from] TooManyFragments),
    /// Sorting would take too long, or finds no order.
    #[error(transparent)]
    NoOrder(#[from] depth_sort::DepthSortError),
}

impl FaceError {
    /// Engines that can handle such a scene, the best first; none where a setting should be changed instead.
    pub fn instead(&self) -> &'static [FaceEngine] {
        use depth_sort::DepthSortError;
        match self {
            Self::TooManyLeaves { .. } => &[],
            Self::TooManyFaces { .. } | Self::NoOrder(DepthSortError::TooManyPairs(_)) => {
                &[FaceEngine::Bsp, FaceEngine::Octree]
            }
            Self::NoOrder(DepthSortError::TooManySplits(_) | DepthSortError::TooManyTests(_)) => {
                &[FaceEngine::Bsp, FaceEngine::Warnock]
            }
            Self::TooManyPairs { .. }
            | Self::TooManyFragments(_)
            | Self::NoOrder(DepthSortError::TooManyPiercings(_)) => &[FaceEngine::Warnock],
        }
    }
}

/// Options for individual engines.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FaceOptions {
    /// Width of a leaf in image units, for [`FaceEngine::Warnock`]; `None` to suit the image.
    pub leaf: Option<f64>,
    /// How [`FaceEngine::Warnock`] divides windows.
    pub subdivision: warnock::Subdivision,
}

/// Up to this many triangles, [`FaceEngine::Auto`] means [`FaceEngine::WeilerAtherton`], with exact regions
/// and the smallest files; beyond, [`FaceEngine::Bsp`] is faster.
pub const MOST_EXACT: usize = 6_000;

/// A scene prepared for an engine, once for any number of views.
#[derive(Debug)]
pub struct Prepared<'a> {
    scene: &'a Scene,
    engine: FaceEngine,
    /// Whether another engine may replace this one if it would take too long.
    is_free: bool,
    trees: Trees,
}

/// What an engine keeps from view to view.
#[derive(Debug)]
enum Trees {
    None,
    Planes(bsp::BspTree),
    Octants(octree::Octree),
}

impl<'a> Prepared<'a> {
    /// Chooses the engine and does all work that does not depend on the view.
    ///
    /// [`FaceEngine::Auto`] means [`FaceEngine::Warnock`] for many faces that pierce each other, which the
    /// others would cut into millions of fragments; otherwise see [`MOST_EXACT`].
    ///
    /// # Errors
    /// [`FaceError::TooManyFragments`].
    pub fn new(scene: &'a Scene, engine: FaceEngine) -> Result<Self, FaceError> {
        let is_free = engine == FaceEngine::Auto;
        let engine = match engine {
            FaceEngine::Auto if bsp::check_piercings(scene).is_err() => FaceEngine::Warnock,
            FaceEngine::Auto if scene.triangles().len() <= MOST_EXACT => FaceEngine::WeilerAtherton,
            FaceEngine::Auto => FaceEngine::Bsp,
            named => named,
        };
        let trees = match engine {
            FaceEngine::Bsp => Trees::Planes(bsp::BspTree::new(scene)?),
            FaceEngine::Octree => Trees::Octants(octree::Octree::new(scene)?),
            _ => Trees::None,
        };
        Ok(Self { scene, engine, is_free, trees })
    }

    /// The engine chosen; where it would take too long for a view, [`FaceWork::engine`] says which one
    /// replaced it.
    pub fn engine(&self) -> FaceEngine {
        self.engine
    }

    /// The scene.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// The visible regions as a camera sees them, and the work of finding them; the work of building a tree
    /// is counted in each view.
    ///
    /// # Errors
    /// See [`FaceError`]; all are found before the work begins, except those of [`depth_sort`] that say
    /// otherwise.
    pub fn solve(
        &self,
        camera: &Camera,
        settings: &FaceOptions,
    ) -> Result<(Painting, FaceWork), FaceError> {
        let scene = self.scene;
        match (self.engine, &self.trees) {
            (_, Trees::Planes(tree)) => {
                let (painting, hidden) = tree.paint_seen(scene, camera);
                Ok((painting, tree.work(hidden)))
            }
            (_, Trees::Octants(tree)) => {
                let (painting, hidden) = tree.paint_seen(scene, camera);
                Ok((painting, tree.work(hidden)))
            }
            (FaceEngine::DepthSort, _) => {
                let (painting, counts) = depth_sort::solve(scene, camera)?;
                Ok((painting, FaceWork::DepthSort(counts)))
            }
            (FaceEngine::Warnock, _) => self.by_windows(camera, settings),
            (
                FaceEngine::Auto
                | FaceEngine::WeilerAtherton
                | FaceEngine::Bsp
                | FaceEngine::Octree,
                _,
            ) => match weiler_atherton::solve(scene, camera) {
                Ok((painting, counts)) => Ok((painting, FaceWork::WeilerAtherton(counts))),
                Err(FaceError::TooManyPairs { .. }) if self.is_free => {
                    self.by_windows(camera, settings)
                }
                Err(error) => Err(error),
            },
        }
    }

    fn by_windows(
        &self,
        camera: &Camera,
        settings: &FaceOptions,
    ) -> Result<(Painting, FaceWork), FaceError> {
        let FaceOptions { leaf, subdivision } = *settings;
        let options = warnock::WarnockOptions { leaf, subdivision, window: None };
        let (painting, counts) = warnock::solve(self.scene, camera, &options)?;
        Ok((painting, FaceWork::Warnock(counts)))
    }
}
