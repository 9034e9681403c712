//! Creases: edges at which a model is bent enough for a line.
//!
//! In a constructed model (CAD, cities, spacecraft) creases bound faces, and every edge above the crease
//! angle is one. In an organic model (scans, sculptures, terrain) edges bend by chance, and a crease is
//! a chain of edges that stands out from its surroundings:
//!
//! ```text
//!   scene ─► looseness: constructed or organic? ─► chains of edges, with length and strength
//!                                                        │ millimeters on paper
//!                                                        ▼
//!                                              creases of a view
//! ```
//!
//! Nothing here decides what is visible.

mod chains;
mod looseness;
mod narrow;
mod surroundings;

use glam::DVec3;

pub use self::chains::CreaseChains;
use super::looseness::Looseness;
use super::scene::Scene;
use super::topology::EdgeUse;

/// Whether the models of a scene are constructed or organic, by their creases. Measured when first asked
/// for; O(edges).
pub fn looseness(scene: &Scene) -> &Looseness {
    scene.looseness_or(looseness::measure)
}

/// Edges bent more than this, in degrees, are creases whatever is around them.
const SHARP_DEG: f64 = 60.0;

/// Angles may be this much above the threshold, at most, and still count as equal to it.
const MOST_ANGLE_TOLERANCE_DEG: f64 = 0.5;

/// An angle between faces, for comparisons that treat equal angles alike.
///
/// Angles that differ only because corners were rounded are on the same side of it, so the sides of a
/// regular prism are all above it or none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CreaseAngle {
    /// In radians.
    angle: f64,
    /// Its cosine.
    cosine: f64,
    /// The cosine of the largest angle that may count as equal to it.
    sure_cosine: f64,
}

impl CreaseAngle {
    /// An angle in degrees, 0 to 180.
    pub fn from_degrees(degrees: f64) -> Self {
        let angle = degrees.clamp(0.0, 180.0).to_radians();
        let sure = (angle + MOST_ANGLE_TOLERANCE_DEG.to_radians()).min(std::f64::consts::PI);
        Self { angle, cosine: libm::cos(angle), sure_cosine: libm::cos(sure) }
    }

    /// Whether two faces with these normals meet at more than this angle, by more than rounding can
    /// cause; `tolerance` says how uncertain the angle is, in radians, when asked.
    pub fn is_exceeded_by(&self, a: DVec3, b: DVec3, tolerance: impl FnOnce() -> f64) -> bool {
        let (dot, lengths) = (a.dot(b), a.length() * b.length());
        lengths > 0.0
            && dot < self.cosine * lengths
            && (dot < self.sure_cosine * lengths
                || libm::atan2(a.cross(b).length(), dot)
                    > self.angle + tolerance().min(MOST_ANGLE_TOLERANCE_DEG.to_radians()))
    }

    /// Whether the two faces along an edge meet at more than this angle, by more than rounding of the
    /// corners can cause. False for edges of more or fewer faces.
    ///
    /// Computes the scene's angles when first asked.
    pub fn is_exceeded(&self, scene: &Scene, edge: u32) -> bool {
        let dihedral = scene.dihedrals()[edge as usize];
        dihedral.is_above(self.cosine)
            && (dihedral.is_above(self.sure_cosine)
                || angle(scene, edge) > self.angle + tolerance(scene, edge))
    }
}

/// The angle between the normals of the two faces along an edge, in radians; of the second one turned
/// over if they are wound against each other. Zero for edges of more or fewer faces.
fn angle(scene: &Scene, edge: u32) -> f64 {
    let &[first, second] = scene.topology().uses(edge) else { return 0.0 };
    let [a, b] = [first, second].map(|along| scene.normals()[along.face() as usize]);
    let against = first.runs_upwards() == second.runs_upwards();
    libm::atan2(a.cross(b).length(), if against { -a.dot(b) } else { a.dot(b) })
}

/// By how much the angle at an edge is uncertain, in radians: the uncertainty of the corners over the
/// height of each face above the edge.
fn tolerance(scene: &Scene, edge: u32) -> f64 {
    let mesh = scene.mesh();
    let at = |vertex: u32| mesh.positions()[vertex as usize];
    let [from, to] = scene.topology().edge(edge).map(at);
    let along = (to - from).normalize_or_zero();
    let height = |used: &EdgeUse| {
        let above = |&corner: &u32| (at(corner) - from).cross(along).length();
        mesh.face(used.face()).iter().map(above).fold(0.0, f64::max)
    };
    let per_height = scene.topology().uses(edge).iter().map(|used| 1.0 / height(used)).sum::<f64>();
    (mesh.coordinate_error() * per_height).min(MOST_ANGLE_TOLERANCE_DEG.to_radians())
}

/// Length of an edge in model units.
fn length(scene: &Scene, edge: u32) -> f64 {
    along(scene, edge).length()
}

/// From the lower to the higher vertex of an edge.
fn along(scene: &Scene, edge: u32) -> DVec3 {
    let [from, to] = scene.topology().edge(edge);
    let positions = scene.mesh().positions();
    positions[to as usize] - positions[from as usize]
}
