//! How much work an engine did, each in its own terms.

use serde::Serialize;

use super::mask::MaskCounts;
use super::{FaceEngine, depth_sort, warnock, weiler_atherton};

/// How often fragments were cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct FragmentCounts {
    /// Fragments of faces at the end.
    pub fragments: u64,
    /// How often a fragment was cut in two, not counting cuts at the near plane.
    pub splits: u64,
    /// How often a fragment was compared with a plane or with another fragment.
    pub tests: u64,
}

impl FragmentCounts {
    pub(super) fn add(&mut self, other: Self) {
        self.fragments += other.fragments;
        self.splits += other.splits;
        self.tests += other.tests;
    }
}

/// What an engine did for one view. Serialized, it is the counts alone, without the engine's name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum FaceWork {
    /// Of [`depth_sort`].
    DepthSort(depth_sort::DepthSortCounts),
    /// Of [`bsp`](super::bsp).
    Bsp {
        /// Of building.
        #[serde(flatten)]
        counts: FragmentCounts,
        /// Nodes of the tree.
        nodes: u64,
        /// Objects that planes keep apart from all others; see [`bsp`](super::bsp).
        objects: u64,
        /// Nodes that were found hidden in the view, not counting those below them.
        hidden_nodes: u64,
        /// What the view left out.
        #[serde(flatten)]
        hidden: MaskCounts,
    },
    /// Of [`octree`](super::octree).
    Octree {
        /// Of building.
        #[serde(flatten)]
        counts: FragmentCounts,
        /// Octants, leaves included.
        octants: u64,
        /// Nodes of the leaves' trees of planes.
        nodes: u64,
        /// Octants that were found hidden in the view, not counting those in them.
        hidden_octants: u64,
        /// What the view left out.
        #[serde(flatten)]
        hidden: MaskCounts,
    },
    /// Of [`warnock`].
    Warnock(warnock::WarnockCounts),
    /// Of [`weiler_atherton`].
    WeilerAtherton(weiler_atherton::WeilerAthertonCounts),
}

impl FaceWork {
    /// The engine that did it.
    pub fn engine(&self) -> FaceEngine {
        match self {
            Self::DepthSort(_) => FaceEngine::DepthSort,
            Self::Bsp { .. } => FaceEngine::Bsp,
            Self::Octree { .. } => FaceEngine::Octree,
            Self::Warnock(_) => FaceEngine::Warnock,
            Self::WeilerAtherton(_) => FaceEngine::WeilerAtherton,
        }
    }
}
