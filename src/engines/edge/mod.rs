//! Line engines: which spans of each drawn edge are hidden, and by how many triangles (quantitative
//! invisibility).
//!
//! | engine | tests each edge against | cost |
//! |---|---|---|
//! | [`roberts`] | every triangle whose image is near | edges × triangles near them |
//! | [`appel`] | cutting edges in front, triangles near in space | edges × cutting edges near them |
//!
//! All engines answer the same question and find the same intervals:
//!
//! A triangle *covers* a point of a segment when the point's image lies in the closed image of the
//! triangle and the triangle is strictly in front. It covers both sides of the segment, except
//! where the segment's image runs along one of its borders; there it covers only the side on which
//! its third vertex lies. A point is hidden when both its sides are covered.
//!
//! Where only visible lines are wanted and many are drawn, [`appel`] first culls lines and triangles
//! that certainly lie behind a surface (module `occlusion`), so that its cost follows what is visible.

pub mod appel;
pub mod lifted;
pub mod outline;
pub mod roberts;

mod back_faces;
mod index;
mod occluders;
mod occlusion;
mod rounding;
mod segment;
mod shadow;
mod sides;
mod sweep;

use crate::classify::ViewedScene;
use crate::engines::visibility::Visibility;

/// Options that every line engine obeys.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VisibilityOptions {
    /// A triangle does not cover a segment if both ends lie within this distance of its plane, in model
    /// units. Zero: contact is exact.
    pub contact_tolerance: f64,
    /// Whether `qi` is counted in full. Otherwise it is 1 wherever any triangle hides the point, which lets
    /// an engine stop at the first one.
    pub count_layers: bool,
    /// Whether to find the parts that a nearer drawn edge with the same image already draws.
    pub find_doubled: bool,
    /// When [`appel`] culls lines and triangles that certainly lie behind a surface. The visible parts are
    /// the same either way.
    pub occlusion_culling: OcclusionCulling,
}

impl VisibilityOptions {
    /// The default: contact is exact, layers are not counted, and doubled parts are not searched for.
    pub const EXACT: Self = Self {
        contact_tolerance: 0.0,
        count_layers: false,
        find_doubled: false,
        occlusion_culling: OcclusionCulling::Auto,
    };
}

/// When occlusion culling is tried. It is never used where layers are counted or the near plane cuts the
/// scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OcclusionCulling {
    /// Where it is likely to save time: in large scenes of which many edges are drawn.
    #[default]
    Auto,
    /// Always, for tests.
    Always,
    /// Never.
    Never,
}

/// The line engines by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LineEngine {
    /// Roberts for small scenes with few drawn edges, otherwise Appel.
    #[default]
    Auto,
    /// Every edge against the triangles near its image.
    Roberts,
    /// Quantitative invisibility carried along edges, changed at cutting edges: fast where many edges are
    /// drawn.
    Appel,
    /// Every edge against every triangle: slow, but simple enough to check the others.
    AllPairs,
}

impl LineEngine {
    /// The engines to choose from; all pairs are for tests.
    pub const ALL: [Self; 3] = [Self::Auto, Self::Roberts, Self::Appel];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Roberts => "roberts",
            Self::Appel => "appel",
            Self::AllPairs => "all-pairs",
        }
    }
}

/// Finds the spans of all drawn edges of `view`, in their order.
///
/// Also returns the name of the engine on the command line, and how much work it did.
pub fn solve(
    view: &ViewedScene,
    engine: LineEngine,
    options: &VisibilityOptions,
) -> (Visibility, LineCounts, &'static str) {
    let engine = if engine == LineEngine::Auto { fastest(view) } else { engine };
    let (name, (visibility, counts)) = match engine {
        LineEngine::Roberts => ("roberts", roberts::solve(view, options)),
        LineEngine::Auto | LineEngine::Appel => ("appel", appel::solve(view, options)),
        LineEngine::AllPairs => ("all-pairs", roberts::solve_all_pairs(view, options)),
    };
    (visibility, counts, name)
}

/// The engine that [`LineEngine::Auto`] chooses.
///
/// Appel, except for scenes with fewer than [`SMALL_SCENE`] triangles and fewer drawn edges than
/// triangles: there, finding cutting edges and nearby triangles would be most of Appel's work.
fn fastest(view: &ViewedScene) -> LineEngine {
    let n_triangles = view.scene().triangles().len();
    let is_small = n_triangles < SMALL_SCENE && view.selected().len() < n_triangles;
    if is_small { LineEngine::Roberts } else { LineEngine::Appel }
}

/// Scenes with fewer triangles are small. Measured: at 3,700 triangles Roberts takes half of Appel's time, at
/// 60,000 both take the same, at a million Appel takes four fifths of Roberts' time for silhouettes and two
/// fifths of it for all edges.
const SMALL_SCENE: usize = 1 << 14;

/// How much work an engine did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LineCounts {
    /// Pairs of an edge and a triangle (or cutting edge) that were tested.
    pub candidate_pairs: u64,
    /// Pairs of an edge and a cutting edge among them.
    pub contour_crossings: u64,
    /// Edges passed to [`roberts`].
    pub fallback_edges: u64,
    /// Edges whose counts contradict others. Always zero unless the program has a bug.
    pub checksum_failures: u64,
    /// Sight lines along which all layers were counted.
    pub sight_lines: u64,
    /// Triangles that were not tested, since they face away from the eye.
    pub back_faces: u64,
    /// Edges between two such triangles: hidden without a test.
    pub back_edges: u64,
    /// Triangles that were not tested, since they hide nothing visible.
    pub culled_triangles: u64,
    /// Drawn edges that were not tested, since they certainly lie behind a surface.
    pub culled_edges: u64,
}
