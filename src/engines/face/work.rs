//! What engines count of their work, each in its own terms.

use serde::Serialize;

use super::{Engine, depth_sort, octree, warnock, weiler_atherton};

/// How often fragments were cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Counts {
    /// Fragments of faces that there are at the end.
    pub fragments: u64,
    /// Times that a fragment was cut in two, not counting cuts at the near plane.
    pub splits: u64,
    /// Times that a fragment was compared with a plane or with another fragment.
    pub tests: u64,
}

impl Counts {
    pub(super) fn add(&mut self, other: Self) {
        self.fragments += other.fragments;
        self.splits += other.splits;
        self.tests += other.tests;
    }
}

/// What an engine did for one view. Serialized, it is the counts alone: which engine they are of is
/// said elsewhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum Work {
    /// Of [`depth_sort`].
    DepthSort(depth_sort::Counts),
    /// Of [`bsp`](super::bsp).
    Bsp {
        /// Of building.
        #[serde(flatten)]
        counts: Counts,
        /// Nodes of the tree.
        nodes: u64,
    },
    /// Of [`octree`].
    Octree {
        /// Of building.
        #[serde(flatten)]
        counts: Counts,
        /// Octants, leaves included.
        octants: u64,
        /// Nodes of the leaves' trees of planes.
        nodes: u64,
        /// What the view left out.
        #[serde(flatten)]
        hidden: octree::Hidden,
    },
    /// Of [`warnock`].
    Warnock(warnock::Counts),
    /// Of [`weiler_atherton`].
    WeilerAtherton(weiler_atherton::Counts),
}

impl Work {
    /// The engine that did it.
    pub fn engine(&self) -> Engine {
        match self {
            Self::DepthSort(_) => Engine::DepthSort,
            Self::Bsp { .. } => Engine::Bsp,
            Self::Octree { .. } => Engine::Octree,
            Self::Warnock(_) => Engine::Warnock,
            Self::WeilerAtherton(_) => Engine::WeilerAtherton,
        }
    }
}
