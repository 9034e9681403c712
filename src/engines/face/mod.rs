//! Face engines: which region of each face is visible, as polygons.
//!
//! ```text
//!  scene, camera ─► depth_sort, bsp, octree ──► pieces from far to near ──┐
//!                   warnock, weiler_atherton ─► pieces beside each other ─┴─► Painting
//! ```
//!
//! | engine | cuts faces at | serves | wants |
//! |---|---|---|---|
//! | [`depth_sort`] | planes of others, where there is no order without | one view | few piercings |
//! | [`bsp`] | planes of others | all views | few piercings |
//! | [`octree`] | octants, then as bsp | all views | large faces that hide much |
//!
//! These three order [`fragment`]s exactly, however often they are cut; [`piercing`] tells beforehand
//! when that would be too often.

pub mod bsp;
pub mod depth_sort;
pub mod fragment;
pub mod octree;
pub mod painting;
pub mod piercing;

pub mod occupancy;

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

/// What an engine did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Fragments of faces that there are at the end.
    pub fragments: u64,
    /// Times that a fragment was cut in two, not counting cuts at the near plane.
    pub splits: u64,
    /// Times that a fragment was compared with a plane or with another fragment.
    pub tests: u64,
}

impl Counts {
    fn add(&mut self, other: Self) {
        self.fragments += other.fragments;
        self.splits += other.splits;
        self.tests += other.tests;
    }
}
