//! The upper part of a tree: planes that keep whole objects apart.
//!
//! ```text
//!      ┌──┐   ┆                      an object is a set of faces connected by vertices; where a
//!      │ a│   ┆   ╱╲ c               plane leaves all objects whole, the tree divides by it first,
//!      └──┘   ┆  ╱  ╲                and no face is cut
//!     ┌────┐  ┆  ╲  ╱   across an axis, where boxes leave a gap,
//!     │  b │  ┆   ╲╱    or the plane of a face, with convex objects behind it
//! ```
//!
//! Objects that no such plane separates are left to the tree of faces, as one set.

use super::build::{Link, in_painting_order};
use super::{Forest, NONE};
use crate::disjoint_sets::DisjointSets;
use crate::engines::face::FragmentCounts;
use crate::engines::face::fragment::{Fragment, Position, bounds};
use crate::model::scene::Scene;
use crate::predicates::{PlaneName, Planes};
use glam::DVec3;

/// Faces whose planes are tried where no gap between boxes separates objects.
const N_OBJECT_CANDIDATES: usize = 24;

/// How often each fragment is visited to separate objects, on average; the rest goes to trees of faces.
/// Even divisions need as many visits as the number of objects has binary digits; taking one object after
/// another off a large heap would need as many as there are objects.
const MAX_LOOKS: usize = 64;

/// Connected fragments.
pub(super) struct Object {
    fragments: Vec<Fragment>,
    low: DVec3,
    high: DVec3,
}

/// The objects of a scene in the order of their first triangles: faces that share a vertex are connected.
pub(super) fn all(scene: &Scene, planes: &Planes) -> Vec<Object> {
    let n_vertices = scene.mesh().positions().len();
    let mut connected = DisjointSets::new(n_vertices);
    for &[a, b, c] in scene.triangles() {
        connected.unite(a, b);
        connected.unite(a, c);
    }
    let mut number_of = vec![NONE; n_vertices];
    let mut sets: Vec<Vec<Fragment>> = Vec::new();
    for fragment in Fragment::all(scene, planes) {
        let [vertex, ..] = scene.triangles()[fragment.triangle() as usize];
        let number = &mut number_of[connected.of(vertex) as usize];
        if *number == NONE {
            *number = sets.len() as u32;
            sets.push(Vec::new());
        }
        sets[*number as usize].push(fragment);
    }
    sets.into_iter().map(Object::new).collect()
}

impl Object {
    fn new(fragments: Vec<Fragment>) -> Self {
        let (low, high) = bounds(&fragments);
        Self { fragments, low, high }
    }

    /// Its fragments in the plane, and on which side of it all others lie: [`Position::Within`] if there
    /// are no others.
    fn position(&self, planes: &Planes, name: PlaneName, n_tests: &mut u64) -> Position {
        let plane = planes.plane(name);
        let mut found = Position::Within;
        for fragment in &self.fragments {
            *n_tests += 1;
            match (fragment.position(planes, &plane), found) {
                (Position::Within, _) => {}
                (position, Position::Within) if position != Position::Across => found = position,
                (position, _) if position == found => {}
                _ => return Position::Across,
            }
        }
        found
    }
}

fn n_fragments(objects: &[Object]) -> usize {
    objects.iter().map(|object| object.fragments.len()).sum()
}

/// A plane and where it leaves each object.
struct Separation {
    plane: PlaneName,
    positions: Vec<Position>,
}

impl Forest {
    /// Makes a node of each plane that separates objects. Returns the root, and the sets left for trees of
    /// faces, each with its place in the tree.
    pub(super) fn part_objects(
        &mut self,
        scene: &Scene,
        planes: &Planes,
        objects: Vec<Object>,
        counts: &mut FragmentCounts,
    ) -> (u32, Vec<(Link, Vec<Fragment>)>) {
        let mut left = Vec::new();
        let mut n_looks = MAX_LOOKS * n_fragments(&objects);
        let mut waiting = vec![(Link::Root(0), objects)];
        while let Some((link, objects)) = waiting.pop() {
            if objects.is_empty() {
                continue;
            }
            let n = n_fragments(&objects);
            let is_enough = n > n_looks;
            n_looks = n_looks.saturating_sub(n);
            let separation = (!is_enough).then(|| separation(planes, &objects, &mut counts.tests));
            let Some(separation) = separation.flatten() else {
                left.push((
                    link,
                    objects.into_iter().flat_map(|object| object.fragments).collect(),
                ));
                continue;
            };
            let (mut within, front, back) = separation.apply(planes, objects);
            let number = self.n_nodes() as u32;
            self.link(link, number);
            in_painting_order(scene, &mut within);
            self.push(separation.plane, within);
            waiting.push((Link::Front(number), front));
            waiting.push((Link::Back(number), back));
        }
        (if self.n_nodes() == 0 { NONE } else { 0 }, left)
    }
}

/// The plane that separates objects most evenly, if any is found.
fn separation(planes: &Planes, objects: &[Object], n_tests: &mut u64) -> Option<Separation> {
    if objects.len() < 2 {
        return None;
    }
    gap(objects).or_else(|| plane_of_a_face(planes, objects, n_tests))
}

/// The plane across an axis that divides the fragments most evenly without touching boxes behind it.
///
/// Boxes that touch are not separated: both may have faces in one plane, of which the one with the lowest
/// number is in front.
fn gap(objects: &[Object]) -> Option<Separation> {
    let n_fragments = n_fragments(objects);
    let mut best: Option<(usize, usize, f64)> = None;
    let mut order: Vec<&Object> = objects.iter().collect();
    for axis in 0..3 {
        order.sort_by(|a, b| a.low[axis].total_cmp(&b.low[axis]));
        let (mut reached, mut n_before) = (f64::NEG_INFINITY, 0);
        for object in &order {
            let imbalance = n_fragments.abs_diff(2 * n_before);
            let is_gap = n_before > 0 && reached < object.low[axis];
            if is_gap && best.is_none_or(|(least, ..)| imbalance < least) {
                best = Some((imbalance, axis, object.low[axis]));
            }
            reached = reached.max(object.high[axis]);
            n_before += object.fragments.len();
        }
    }
    let (_, axis, at) = best?;
    let side = |object: &Object| {
        if object.low[axis] >= at { Position::Front } else { Position::Back }
    };
    let positions = objects.iter().map(side).collect();
    Some(Separation { plane: PlaneName::Across { axis: axis as u8, at }, positions })
}

/// A plane of a face that leaves all objects whole, with some on both sides.
fn plane_of_a_face(planes: &Planes, objects: &[Object], n_tests: &mut u64) -> Option<Separation> {
    let n_fragments = n_fragments(objects);
    let n = n_fragments.min(N_OBJECT_CANDIDATES);
    // Spread by a multiple of the golden ratio, so that no side of equal objects is always missed.
    let spread = |k: u64| u128::from(k.wrapping_mul(0x9e37_79b9_7f4a_7c15)) * n_fragments as u128;
    let mut candidates: Vec<usize> = (0..n as u64).map(|k| (spread(k) >> 64) as usize).collect();
    candidates.sort_unstable();
    candidates.dedup();
    let mut candidates = candidates.into_iter().peekable();
    let mut best: Option<(usize, Separation)> = None;
    for (number, fragment) in objects.iter().flat_map(|object| &object.fragments).enumerate() {
        if candidates.next_if_eq(&number).is_none() {
            continue;
        }
        let plane = PlaneName::Triangle(fragment.triangle());
        let mut positions = Vec::with_capacity(objects.len());
        let mut sizes = [0; 2];
        for object in objects {
            let position = object.position(planes, plane, n_tests);
            let side = match position {
                Position::Front => 0,
                Position::Back => 1,
                Position::Within => {
                    positions.push(position);
                    continue;
                }
                Position::Across => break,
            };
            sizes[side] += object.fragments.len();
            positions.push(position);
        }
        let imbalance = sizes[0].abs_diff(sizes[1]);
        if positions.len() == objects.len()
            && sizes.iter().all(|&size| size > 0)
            && best.as_ref().is_none_or(|(least, _)| imbalance < *least)
        {
            best = Some((imbalance, Separation { plane, positions }));
        }
    }
    best.map(|(_, separation)| separation)
}

impl Separation {
    /// The fragments in the plane, and the objects on both sides of it.
    fn apply(
        &self,
        planes: &Planes,
        objects: Vec<Object>,
    ) -> (Vec<Fragment>, Vec<Object>, Vec<Object>) {
        let (mut within, mut front, mut back) = (Vec::new(), Vec::new(), Vec::new());
        let plane = planes.plane(self.plane);
        let is_face = matches!(self.plane, PlaneName::Triangle(_));
        for (object, position) in objects.into_iter().zip(&self.positions) {
            let (here, aside): (Vec<_>, Vec<_>) =
                object.fragments.into_iter().partition(|fragment| {
                    is_face && fragment.position(planes, &plane) == Position::Within
                });
            within.extend(here);
            if aside.is_empty() {
                continue;
            }
            // Its box stays the same: it only has to contain the object.
            let object = Object { fragments: aside, ..object };
            match position {
                Position::Front => front.push(object),
                _ => back.push(object),
            }
        }
        (within, front, back)
    }
}
