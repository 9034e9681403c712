//! Folds that are too narrow to be drawn: edges whose bend is undone on both sides.
//!
//! A fillet of very narrow strips that are bent to and fro would become a bar of lines. Both walks from an edge
//! between its strips soon come to a face that lies as the strip does on the other side of the edge:
//!
//! ```text
//!                edge
//!     ─────╲╱╲╱╲╱╲─────
//!             ◄─►
//! ```
//!
//! A single step, as of a curb, is undone on one side only and keeps its line.

use rayon::prelude::*;

use crate::model::scene::Scene;
use crate::model::topology::EdgeUse;

use super::surroundings::{MAX_FACES, Walk, is_turned};
use super::{CreaseAngle, SHARP_DEG};

/// An edge above the crease angle that is bent back on both sides within a distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NarrowFold {
    pub(super) edge: u32,
    /// How far the longer one of the two walks goes, in model units.
    pub(super) distance: f64,
}

/// Those of some edges that are above the crease angle and whose bend is undone within few faces on both sides.
/// Sharp ones never count. O(edges).
pub(super) fn folds(
    scene: &Scene,
    crease: CreaseAngle,
    edges: impl IndexedParallelIterator<Item = u32>,
) -> Vec<NarrowFold> {
    let sharp = CreaseAngle::from_degrees(SHARP_DEG);
    let fold = |edge: u32| {
        let &[first, second] = scene.topology().uses(edge) else { return None };
        if !crease.is_exceeded(scene, edge) || sharp.is_exceeded(scene, edge) {
            return None;
        }
        let ways = [(first, second), (second, first)];
        let [one, other] = ways.map(|(from, over)| undone_after(scene, edge, from, over, crease));
        Some(NarrowFold { edge, distance: one?.max(other?) })
    };
    edges.with_min_len(4096).filter_map(fold).collect()
}

/// How far a walk from an edge goes over a face until it comes to one that lies as `from` does, by less
/// than the crease angle.
fn undone_after(
    scene: &Scene,
    edge: u32,
    from: EdgeUse,
    over: EdgeUse,
    crease: CreaseAngle,
) -> Option<f64> {
    let normal = |used: EdgeUse| scene.normals()[used.face() as usize];
    let start = normal(from);
    let mut walk = Walk::new(scene, edge, over, is_turned(from, over));
    let mut walked = 0.0;
    for _ in 0..MAX_FACES {
        let (next, distance, _) = walk.step(scene)?;
        walked += distance;
        let reached = normal(next.face_use());
        let reached = if next.sense() { -reached } else { reached };
        if !crease.is_exceeded_by(start, reached, || 0.0) {
            return Some(walked);
        }
        if start.dot(reached) <= 0.0 {
            // Around a body, a walk comes back to where it began.
            return None;
        }
        walk = next;
    }
    None
}
