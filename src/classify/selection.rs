//! Which kinds of lines are drawn.

use crate::strokes::StrokeKind;

/// The outline's place among the bits of the kinds.
const OUTLINE: u32 = 1 << 31;

/// Which kinds of lines are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LineSelection {
    kinds: u32,
}

impl LineSelection {
    /// No lines.
    pub const NONE: Self = Self { kinds: 0 };

    /// Adds a kind.
    #[must_use]
    pub const fn with(self, kind: StrokeKind) -> Self {
        Self { kinds: self.kinds | 1 << kind as u32 }
    }

    /// Every edge of the mesh, but no other lines.
    pub const fn all_edges() -> Self {
        Self::NONE
            .with(StrokeKind::Silhouette)
            .with(StrokeKind::Crease)
            .with(StrokeKind::Boundary)
            .with(StrokeKind::Nonmanifold)
            .with(StrokeKind::Mesh)
    }

    /// The kinds of both.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self { kinds: self.kinds | other.kinds }
    }

    /// Adds the outline: the parts of silhouette, boundary, and non-manifold edges that are seen
    /// against the background only (see [`crate::engines::edge::outline`]).
    #[must_use]
    pub const fn with_outline(self) -> Self {
        Self { kinds: self.kinds | OUTLINE }
    }

    /// Whether the outline is drawn.
    pub const fn has_outline(self) -> bool {
        self.kinds & OUTLINE != 0
    }

    /// Whether anything other than the outline is drawn.
    pub const fn has_more_than_outline(self) -> bool {
        self.kinds & !OUTLINE != 0
    }

    /// Whether a kind is drawn.
    pub const fn contains(self, kind: StrokeKind) -> bool {
        self.kinds & 1 << kind as u32 != 0
    }
}

impl Default for LineSelection {
    /// Silhouette, crease, boundary, non-manifold and intersection lines, and wires.
    fn default() -> Self {
        Self::NONE
            .with(StrokeKind::Silhouette)
            .with(StrokeKind::Crease)
            .with(StrokeKind::Boundary)
            .with(StrokeKind::Nonmanifold)
            .with(StrokeKind::Intersection)
            .with(StrokeKind::Wire)
    }
}
