//! The walk of a tree of planes in depth order, without recursion: trees may be deep.

use super::{Forest, NONE};
use crate::engines::face::fragment::Fragment;
use crate::predicates::{PlaneName, Planes, Sign};

/// Which end of the order comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WalkOrder {
    /// What may be hidden first: the paint order.
    FarToNear,
    /// What may hide first: for masks of what is drawn.
    NearToFar,
}

/// The fragments of a tree in depth order; see [`BspTree::walk`](super::BspTree::walk).
#[derive(Debug)]
pub struct BspWalk<'a> {
    forest: &'a Forest,
    planes: &'a Planes<'a>,
    order: WalkOrder,
    waiting: Vec<Visit>,
    /// What is left of the fragments of one node, which lie in one plane.
    here: &'a [Fragment],
}

#[derive(Debug, Clone, Copy)]
enum Visit {
    Node(u32),
    Plane(u32),
}

impl Forest {
    /// Walks one tree.
    pub(in crate::stages::engines::face) fn walk<'a>(
        &'a self,
        planes: &'a Planes<'a>,
        root: u32,
        order: WalkOrder,
    ) -> BspWalk<'a> {
        let waiting = vec![Visit::Node(root)];
        BspWalk { forest: self, planes, order, waiting, here: &[] }
    }
}

impl<'a> Iterator for BspWalk<'a> {
    type Item = (&'a Fragment, Sign);

    fn next(&mut self) -> Option<Self::Item> {
        self.next_wanted(|_| true)
    }
}

impl<'a> BspWalk<'a> {
    /// The next fragment, skipping unwanted nodes with everything below them.
    pub(super) fn next_wanted(
        &mut self,
        mut is_wanted: impl FnMut(u32) -> bool,
    ) -> Option<(&'a Fragment, Sign)> {
        loop {
            let next = match self.order {
                WalkOrder::FarToNear => self.here.split_first(),
                WalkOrder::NearToFar => self.here.split_last(),
            };
            if let Some((fragment, rest)) = next {
                self.here = rest;
                // Its triangle may be wound opposite to the one that gave the plane.
                let own = PlaneName::Triangle(fragment.triangle());
                return Some((fragment, self.planes.side_of_eye(own)));
            }
            match self.waiting.pop()? {
                Visit::Node(NONE) => {}
                Visit::Node(number) if !is_wanted(number) => {}
                Visit::Node(number) => {
                    let node = &self.forest.nodes[number as usize];
                    let facing = self.planes.side_of_eye(node.plane);
                    // With the eye in the plane, neither side hides anything on the other.
                    let (near, far) = if facing == Sign::Negative {
                        (node.back, node.front)
                    } else {
                        (node.front, node.back)
                    };
                    let (first, last) = match self.order {
                        WalkOrder::FarToNear => (far, near),
                        WalkOrder::NearToFar => (near, far),
                    };
                    let plane = Visit::Plane(number);
                    self.waiting.extend([Visit::Node(last), plane, Visit::Node(first)]);
                }
                Visit::Plane(number) => {
                    let node = &self.forest.nodes[number as usize];
                    self.here = &self.forest.fragments[node.first as usize..node.last as usize];
                }
            }
        }
    }
}
