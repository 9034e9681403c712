//! Building a tree of planes: in rounds, each of which divides all remaining sets of fragments.
//!
//! Large sets are divided in parallel, by one plane per round; small ones are finished at once by one
//! thread. Nothing depends on the number of threads, and nothing is recursive.

use super::{Forest, NONE, PlaneNode};
use crate::engines::face::fragment::{Fragment, Position};
use crate::engines::face::{FragmentCounts, piercing};
use crate::model::scene::Scene;
use crate::predicates::{PlaneName, Planes};
use rayon::prelude::*;
use thiserror::Error;

/// Faces whose planes are tried for each node. More make smaller trees, more slowly.
pub const N_CANDIDATES: usize = 8;

/// Fragments that a candidate is tested on. With fewer, bad planes look good.
pub const N_SAMPLES: usize = 48;

/// A split fragment weighs as much as this many fragments of imbalance. Splits enlarge the tree for good,
/// imbalance only makes it deeper.
pub const SPLIT_WEIGHT: i64 = 6;

/// Sets of at least this many fragments may be divided by a plane across an axis. Smaller sets are
/// finished sooner without; larger ones, of a convex body, would cost the square of their size.
pub const AXES_FROM: usize = 24;

/// The most fragments of a tree: about two gigabytes.
pub const MAX_FRAGMENTS: usize = 4_000_000;

/// The most pairs of triangles that pierce each other, for each triangle. More are refused: a thousand
/// large faces in a heap would take a minute.
pub const MAX_PIERCINGS: u64 = 32;

/// Sets of at most this many fragments are left to one thread.
const ALONE: usize = 512;

/// Faces cross too often for a tree of planes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "the faces of the model pierce each other too often and would be cut into millions of fragments"
)]
pub struct TooManyFragments;

/// Whether a tree may be started, estimated from a sample of the faces.
pub(in crate::stages::engines::face) fn check_piercings(
    scene: &Scene,
) -> Result<(), TooManyFragments> {
    let n_triangles = scene.triangles().len() as u64;
    if piercing::estimate(scene) > MAX_PIERCINGS * n_triangles {
        return Err(TooManyFragments);
    }
    Ok(())
}

/// Where the number of a node is stored.
#[derive(Debug, Clone, Copy)]
pub(in crate::stages::engines::face) enum Link {
    /// The root of a tree, by its place among the roots.
    Root(usize),
    /// Below a node.
    Front(u32),
    Back(u32),
}

/// One node with its fragments, and what is left on both sides.
struct Parted {
    plane: PlaneName,
    within: Vec<Fragment>,
    front: Vec<Fragment>,
    back: Vec<Fragment>,
}

/// What a round turns one set into.
enum Grown {
    /// A node; the rest is for the next round.
    Node(Parted),
    /// A whole tree with its own numbering; the root is the first node.
    Tree(Forest),
    Nothing,
}

impl Forest {
    /// Grows a tree from each set of fragments; returns the roots of those that are below no node.
    pub(in crate::stages::engines::face) fn grow(
        &mut self,
        scene: &Scene,
        planes: &Planes,
        sets: Vec<(Link, Vec<Fragment>)>,
        counts: &mut FragmentCounts,
    ) -> Result<Vec<u32>, TooManyFragments> {
        let n_roots = sets.iter().filter(|(link, _)| matches!(link, Link::Root(_))).count();
        let mut roots = vec![NONE; n_roots];
        let mut waiting = sets;
        while !waiting.is_empty() {
            let grown: Vec<(Link, Grown, FragmentCounts)> = waiting
                .into_par_iter()
                .map(|(link, set)| {
                    let mut counts = FragmentCounts::default();
                    let grown = match set.len() {
                        0 => Grown::Nothing,
                        1..=ALONE => Grown::Tree(alone(scene, planes, set, &mut counts)),
                        _ => Grown::Node(part(scene, planes, set, &mut counts)),
                    };
                    (link, grown, counts)
                })
                .collect();
            waiting = Vec::new();
            for (link, grown, of_set) in grown {
                counts.add(of_set);
                let number = self.nodes.len() as u32;
                match grown {
                    Grown::Nothing => continue,
                    Grown::Node(parted) => {
                        let (front, back) = (parted.front, parted.back);
                        self.push(parted.plane, parted.within);
                        waiting.push((Link::Front(number), front));
                        waiting.push((Link::Back(number), back));
                    }
                    Grown::Tree(tree) => self.append(tree),
                }
                match link {
                    Link::Root(root) => roots[root] = number,
                    link => self.link(link, number),
                }
            }
            let n_waiting: usize = waiting.iter().map(|(_, set)| set.len()).sum();
            if self.fragments.len() + n_waiting > MAX_FRAGMENTS {
                return Err(TooManyFragments);
            }
        }
        Ok(roots)
    }

    /// Links a node to the one above it.
    pub(super) fn link(&mut self, link: Link, number: u32) {
        match link {
            Link::Root(_) => {}
            Link::Front(parent) => self.nodes[parent as usize].front = number,
            Link::Back(parent) => self.nodes[parent as usize].back = number,
        }
    }

    /// Adds a node without any below it.
    pub(super) fn push(&mut self, plane: PlaneName, within: Vec<Fragment>) {
        let first = self.fragments.len() as u32;
        self.fragments.extend(within);
        let last = self.fragments.len() as u32;
        self.nodes.push(PlaneNode { plane, first, last, front: NONE, back: NONE });
    }

    fn append(&mut self, other: Self) {
        let (nodes, fragments) = (self.nodes.len() as u32, self.fragments.len() as u32);
        let moved = |node: u32| if node == NONE { NONE } else { node + nodes };
        self.nodes.extend(other.nodes.into_iter().map(|node| PlaneNode {
            first: node.first + fragments,
            last: node.last + fragments,
            front: moved(node.front),
            back: moved(node.back),
            ..node
        }));
        self.fragments.extend(other.fragments);
    }
}

/// The tree of a small set.
fn alone(
    scene: &Scene,
    planes: &Planes,
    set: Vec<Fragment>,
    counts: &mut FragmentCounts,
) -> Forest {
    let mut forest = Forest::default();
    let mut waiting = vec![(Link::Root(0), set)];
    while let Some((link, set)) = waiting.pop() {
        if set.is_empty() {
            continue;
        }
        let number = forest.nodes.len() as u32;
        forest.link(link, number);
        let Parted { plane, within, front, back } = part(scene, planes, set, counts);
        forest.push(plane, within);
        waiting.push((Link::Front(number), front));
        waiting.push((Link::Back(number), back));
    }
    forest
}

/// Divides a set of at least one fragment by the plane that seems best.
///
/// This terminates: a plane of a face removes that face from the set for good, and a plane across an axis
/// is taken only if both sides are clearly smaller.
fn part(scene: &Scene, planes: &Planes, set: Vec<Fragment>, counts: &mut FragmentCounts) -> Parted {
    let n = set.len();
    for name in ranked(planes, &set, counts) {
        let plane = planes.plane(name);
        counts.tests += n as u64;
        let positions: Vec<Position> =
            set.iter().map(|fragment| fragment.position(planes, &plane)).collect();
        if let PlaneName::Across { .. } = name {
            let n_back = positions.iter().filter(|&&p| p == Position::Back).count();
            let n_across = positions.iter().filter(|&&p| p == Position::Across).count();
            if (n - n_back).max(n_back + n_across) * 4 > n * 3 {
                continue;
            }
        }
        let is_face = matches!(name, PlaneName::Triangle(_));
        let (mut within, mut front, mut back) = (Vec::new(), Vec::new(), Vec::new());
        for (fragment, position) in set.into_iter().zip(positions) {
            match position {
                Position::Front => front.push(fragment),
                Position::Back => back.push(fragment),
                Position::Within if is_face => within.push(fragment),
                Position::Within => front.push(fragment),
                Position::Across => {
                    counts.splits += 1;
                    let (in_front, behind) = fragment.split(planes, &plane);
                    front.push(in_front);
                    back.push(behind);
                }
            }
        }
        in_painting_order(scene, &mut within);
        return Parted { plane: name, within, front, back };
    }
    // Unreachable: there is always a face among the candidates.
    Parted { plane: PlaneName::Near, within: set, front: Vec::new(), back: Vec::new() }
}

/// Sorts fragments in one plane: the nearest, that of the lowest face, is painted last.
pub(super) fn in_painting_order(scene: &Scene, within: &mut [Fragment]) {
    let face = |f: &Fragment| scene.triangle_faces()[f.triangle() as usize];
    within.sort_by_key(|f| std::cmp::Reverse((face(f), f.triangle())));
}

/// The candidates, the best first.
fn ranked(planes: &Planes, set: &[Fragment], counts: &mut FragmentCounts) -> Vec<PlaneName> {
    let n = set.len();
    let spaced = |count: usize| (0..count.min(n)).map(move |k| &set[k * n / count.min(n)]);
    let mut names: Vec<PlaneName> =
        spaced(N_CANDIDATES).map(|f| PlaneName::Triangle(f.triangle())).collect();
    if n >= AXES_FROM {
        for axis in 0..3u8 {
            let mut middles: Vec<f64> = spaced(N_SAMPLES)
                .map(|fragment| {
                    let at = |i: usize| fragment.sides()[i].corner.point[usize::from(axis)];
                    (at(0) + at(1) + at(2)) / 3.0
                })
                .collect();
            let half = middles.len() / 2;
            let (_, &mut at, _) = middles.select_nth_unstable_by(half, f64::total_cmp);
            if at.is_finite() {
                names.push(PlaneName::Across { axis, at });
            }
        }
    }
    if names.len() == 1 {
        return names;
    }
    let mut scored: Vec<(i64, usize)> = names
        .iter()
        .enumerate()
        .map(|(i, &name)| {
            let plane = planes.plane(name);
            let (mut splits, mut balance) = (0, 0i64);
            for fragment in spaced(N_SAMPLES) {
                counts.tests += 1;
                match fragment.position(planes, &plane) {
                    Position::Front => balance += 1,
                    Position::Back => balance -= 1,
                    Position::Within => {}
                    Position::Across => splits += 1,
                }
            }
            (SPLIT_WEIGHT * splits + balance.abs(), i)
        })
        .collect();
    scored.sort_unstable();
    scored.into_iter().map(|(_, i)| names[i]).collect()
}
