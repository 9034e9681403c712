//! How bent a surface is around an edge.
//!
//! The lines between the facets of a rounded body have neighbors that are bent as much as they are; a crease
//! does not. So this walks straight over the surface, at right angles to the edge, and looks at the edges
//! along the way:
//!
//! ```text
//!        ╲     │ edge ╱
//!    ◄────╲────┼─────╱────►      as far as one and a half times the width of the first face
//!          ╲   │    ╱
//! ```

use glam::DVec3;

use crate::model::scene::Scene;
use crate::model::topology::EdgeUse;

use super::angle;

/// The walk goes as far as this many times the width of the first face.
const REACH: f64 = 1.5;

/// Most faces on a walk.
pub(super) const MAX_FACES: usize = 12;

/// The mean over both sides of the largest angle, in radians, at edges near `edge` that are bent in the
/// same sense, outwards or inwards. O(1).
pub(super) fn bend_nearby(scene: &Scene, edge: u32) -> f64 {
    let &[first, second] = scene.topology().uses(edge) else { return 0.0 };
    let Some(sense) = sense(scene, first, second) else { return 0.0 };
    let largest = |used| largest_on_walk(scene, edge, used, sense ^ is_turned(first, used));
    0.5 * (largest(first) + largest(second))
}

/// Whether the two uses' faces are wound against each other.
pub(super) fn is_turned(first: EdgeUse, second: EdgeUse) -> bool {
    first != second && first.runs_upwards() == second.runs_upwards()
}

/// Whether the second face falls behind the first one's plane (outward bend), as that is wound; `None`
/// if it lies in it.
fn sense(scene: &Scene, first: EdgeUse, second: EdgeUse) -> Option<bool> {
    let normal = scene.normals()[first.face() as usize];
    let positions = scene.mesh().positions();
    let corner =
        |used: EdgeUse| scene.mesh().face(used.face()).iter().map(|&v| positions[v as usize]);
    let base = corner(first).next()?;
    let farthest = corner(second).map(|p| normal.dot(p - base));
    let height = farthest.fold(0.0, |most: f64, h| if h.abs() > most.abs() { h } else { most });
    (height != 0.0).then_some(height < 0.0)
}

/// The largest angle in a sense on a walk that begins at `edge` and goes over the face of `used`.
fn largest_on_walk(scene: &Scene, edge: u32, used: EdgeUse, sense: bool) -> f64 {
    let positions = scene.mesh().positions();
    let at = |vertex: u32| positions[vertex as usize];
    let [from, _] = scene.topology().edge(edge).map(at);
    let mut walk = Walk::new(scene, edge, used, sense);
    let height = |&corner: &u32| (at(corner) - from).cross(unit(scene, edge)).length();
    let width = scene.mesh().face(used.face()).iter().map(height).fold(0.0, f64::max);
    let reach = REACH * width;
    let (mut largest, mut walked) = (0.0f64, 0.0);
    for _ in 0..MAX_FACES {
        let Some((next, distance, bend)) = walk.step(scene) else { break };
        walked += distance;
        if walked > reach {
            break;
        }
        largest = largest.max(bend);
        walk = next;
    }
    largest
}

/// A point on an edge and a direction into one of its faces.
pub(super) struct Walk {
    edge: u32,
    used: EdgeUse,
    /// The bend that is looked for, as the face is wound.
    sense: bool,
    at: DVec3,
    /// The direction's parts at right angles to the edge, into the face, and along the edge.
    across: f64,
    along: f64,
}

impl Walk {
    /// From the middle of an edge over one of its faces, at right angles to the edge.
    pub(super) fn new(scene: &Scene, edge: u32, used: EdgeUse, sense: bool) -> Self {
        let [from, to] =
            scene.topology().edge(edge).map(|vertex| scene.mesh().positions()[vertex as usize]);
        Self { edge, used, sense, at: 0.5 * (from + to), across: 1.0, along: 0.0 }
    }

    /// The use of the face that the walk is about to cross.
    pub(super) fn face_use(&self) -> EdgeUse {
        self.used
    }

    /// The sense that is looked for, which changes where faces are wound against each other.
    pub(super) fn sense(&self) -> bool {
        self.sense
    }

    /// Over the face to its other side: where the walk continues, how far that is, and the angle there,
    /// or zero if the bend is in the other sense. `None` at the end of the surface.
    pub(super) fn step(&self, scene: &Scene) -> Option<(Self, f64, f64)> {
        let (topology, mesh) = (scene.topology(), scene.mesh());
        let at = |vertex: u32| mesh.positions()[vertex as usize];
        let face = self.used.face();
        let normal = scene.normals()[face as usize].normalize_or_zero();
        let direction =
            self.across * into(scene, self.edge, self.used) + self.along * unit(scene, self.edge);
        // To the nearest border of the face ahead, other than the edge it comes from.
        let corners = mesh.face(face);
        let mut nearest: Option<(f64, u32)> = None;
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            let side = normal.cross(at(b) - at(a));
            let speed = side.dot(direction);
            let distance = side.dot(at(a) - self.at) / speed;
            let ends = [a.min(b), a.max(b)];
            if speed < 0.0
                && ends != topology.edge(self.edge)
                && nearest.is_none_or(|(least, _)| distance < least)
            {
                nearest = Some((distance.max(0.0), topology.find_edge(a, b)?));
            }
        }
        let (distance, edge) = nearest?;
        let &[first, second] = topology.uses(edge) else { return None };
        let (here, there) = if first.face() == face { (first, second) } else { (second, first) };
        let is_sense = sense(scene, here, there) == Some(self.sense);
        let bend = if is_sense { angle(scene, edge) } else { 0.0 };
        let next = Self {
            edge,
            used: there,
            sense: self.sense ^ is_turned(here, there),
            at: self.at + distance * direction,
            across: -direction.dot(into(scene, edge, here)),
            along: direction.dot(unit(scene, edge)),
        };
        Some((next, distance, bend))
    }
}

/// The direction of an edge from its lower to its higher vertex.
fn unit(scene: &Scene, edge: u32) -> DVec3 {
    super::along(scene, edge).normalize_or_zero()
}

/// The direction in a face's plane at right angles to one of its edges, into the face.
fn into(scene: &Scene, edge: u32, used: EdgeUse) -> DVec3 {
    let inward = scene.normals()[used.face() as usize].cross(unit(scene, edge)).normalize_or_zero();
    if used.runs_upwards() { inward } else { -inward }
}
