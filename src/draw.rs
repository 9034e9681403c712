//! From a scene and a camera to strokes: the stages between, in order.

use glam::DVec3;

use crate::scene::Scene;
use crate::stats::{Stats, timed};
use crate::strokes::{Drawing, StrokeKind};
use crate::view::{Camera, Projection};

/// Faces that meet at more than this angle, in degrees, make a crease unless set otherwise.
pub const DEFAULT_CREASE_DEG: f64 = 30.0;

/// Which kinds of line are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LineSelection {
    kinds: u32,
}

impl LineSelection {
    /// No line.
    pub const NONE: Self = Self { kinds: 0 };

    /// Adds a kind.
    #[must_use]
    pub const fn with(self, kind: StrokeKind) -> Self {
        Self {
            kinds: self.kinds | 1 << kind as u32,
        }
    }

    /// Every edge of the mesh, but no line that is not one of its edges.
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
        Self {
            kinds: self.kinds | other.kinds,
        }
    }

    /// Whether a kind is drawn.
    pub const fn contains(self, kind: StrokeKind) -> bool {
        self.kinds & 1 << kind as u32 != 0
    }
}

impl Default for LineSelection {
    /// Silhouette, crease, boundary, non-manifold and intersection lines.
    fn default() -> Self {
        Self::NONE
            .with(StrokeKind::Silhouette)
            .with(StrokeKind::Crease)
            .with(StrokeKind::Boundary)
            .with(StrokeKind::Nonmanifold)
            .with(StrokeKind::Intersection)
    }
}

/// What becomes of hidden lines.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum HiddenLines {
    /// They are left out.
    #[default]
    None,
    /// They are drawn dashed, on their own layer.
    Dashed,
    /// They are drawn solid, on their own layer.
    Solid,
}

/// How hidden lines are found; all engines give the same answer.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Engine {
    /// The fastest that can draw the scene.
    #[default]
    Auto,
    /// Every segment against the triangles that may cover it.
    Roberts,
}

/// What to draw, and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawOptions {
    /// Which kinds of line.
    pub lines: LineSelection,
    /// Faces that meet at more than this angle, in degrees, make a crease.
    pub crease_deg: f64,
    /// Hidden lines: left out, or kept with their quantitative invisibility.
    pub hidden: HiddenLines,
    /// One two-point stroke for each maximal visible interval of each edge; nothing is joined,
    /// dropped or de-duplicated, and contact tolerance and shortest stroke are zero.
    pub exact: bool,
    /// How hidden lines are found.
    pub engine: Engine,
    /// A triangle does not cover a segment both of whose ends lie within this distance of its
    /// plane, in model units; `None` for the default, which depends on the size of the coordinates.
    pub contact_tolerance: Option<f64>,
}

impl Default for DrawOptions {
    fn default() -> Self {
        Self {
            lines: LineSelection::default(),
            crease_deg: DEFAULT_CREASE_DEG,
            hidden: HiddenLines::default(),
            exact: false,
            engine: Engine::default(),
            contact_tolerance: None,
        }
    }
}

/// Draws `scene` as `camera` sees it; counts and times go to `stats`.
pub fn draw(scene: &Scene, camera: &Camera, options: &DrawOptions, stats: &mut Stats) -> Drawing {
    let _ = options;
    stats.engine = "roberts";
    stats.drawn_edges = scene.topology().edges().len();
    let in_front = |p: DVec3| match camera.projection() {
        Projection::Perspective { near, .. } => {
            let forward = camera.forward();
            (p - camera.eye()).dot(forward) >= near * forward.length_squared()
        }
        Projection::Orthographic => true,
    };
    let mut seconds = 0.0;
    let drawing = timed(&mut seconds, || {
        let mut drawing = Drawing::default();
        for &[a, b] in scene.topology().edges() {
            let positions = scene.mesh().positions();
            let (a, b) = (positions[a as usize], positions[b as usize]);
            if in_front(a) && in_front(b) {
                drawing.push(StrokeKind::Mesh, 0, [camera.image(a), camera.image(b)]);
            }
        }
        drawing
    });
    stats.seconds.strokes += seconds;
    drawing
}
