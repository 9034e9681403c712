//! The painter with a tree of planes: built once, walked for every view.
//!
//! ```text
//!           plane a                    a            each node divides what is left by a plane and
//!     ╲        │                      ╱ ╲           keeps the fragments in that plane; seen from
//!      ╲ b     │    c              b     c          the + side of a:
//!       ╲      │   ╱              ╱ ╲   ╱ ╲
//!        ╲   − │ + ╱                                all behind a, all in a, all in front of a
//! ```
//!
//! What lies on the far side of a plane cannot hide what lies on the near side, so one walk in order
//! gives the painting, from far to near or from near to far. The tree does not depend on the eye.
//!
//! Source: H. Fuchs, Z. Kedem, B. Naylor, "On visible surface generation by a priori tree structures"
//! (1980); lecture notes on visibility (Slovak), section 3.2, and those on the painter's algorithm
//! with a BSP tree. Their rule for choosing a face maximizes a sum in which split faces count in its
//! favor; here they count against it. For large sets, planes across an axis are candidates too, since
//! faces alone would turn any convex body into a list of n nodes, with n² tests. What rules make of the
//! models in `examples/models`, where `hiddenline fill MODEL --engine bsp --stats` counts this one:
//!
//! | plane of each node | fragments of spot | tests | fragments of benchy_wheel | tests |
//! |---|---|---|---|---|
//! | this rule | 12,467 | 1,273,928 | 3,612 | 365,548 |
//! | this rule, faces only | 11,909 | 1,498,203 | 4,252 | 476,579 |
//! | a random face | 20,177 | 497,020 | 8,555 | 177,085 |
//! | the first face | 22,274 | 681,626 | 27,340 | 302,577 |
//!
//! Good for: many views of one model, such as a turntable. The walk costs one exact test per node.
//! Cannot: avoid splits that a view does not need, or handle large faces that all cross: they make n²
//! fragments or more. 300 random triangles in a cube make 104 000, in 2.5 s; a thousand are refused
//! (see [`MAX_PIERCINGS`]).
//!
//! Coherence: picture sequence coherence (one tree serves all views) and object coherence (what lies on
//! one side of a plane is ordered as a whole).
//!
//! # Size and time
//!
//! Two threads; the walk paints all fragments of one view. Both times are about proportional to the
//! number of triangles:
//!
//! | model | triangles | nodes | fragments | built | walked |
//! |---|---|---|---|---|---|
//! | bumpy sphere | 9 800 | 22 257 | 21 859 | 0.22 s | 16 ms |
//! | town | 36 271 | 64 755 | 73 497 | 1.3 s | 43 ms |
//! | statue | 70 000 | 155 851 | 152 941 | 1.8 s | 112 ms |
//! | bumpy sphere | 101 760 | 241 065 | 235 403 | 2.6 s | 148 ms |
//! | 10 000 boxes | 120 000 | 55 183 | 125 711 | 1.0 s | 53 ms |
//! | turbine blade | 199 034 | 426 995 | 416 896 | 5.3 s | 342 ms |

mod build;
mod objects;
mod walk;

pub use self::build::{
    AXES_FROM, MAX_FRAGMENTS, MAX_PIERCINGS, N_CANDIDATES, N_SAMPLES, SPLIT_WEIGHT,
    TooManyFragments,
};
pub(super) use self::build::{Link, check_piercings};
pub use self::walk::{BspWalk, WalkOrder};

use std::borrow::Cow;

use super::fragment::{Easel, Fragment, bounds};
use super::mask::{FragmentsOf, Mask, MaskCounts};
use super::painting::Painting;
use super::{FaceWork, FragmentCounts};
use crate::camera::Camera;
use crate::model::scene::Scene;
use crate::predicates::{PlaneName, Planes, Sign};
use glam::DVec3;

/// No node.
const NONE: u32 = u32::MAX;

/// A plane that divides what is left of the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
struct PlaneNode {
    plane: PlaneName,
    /// The fragments in the plane.
    first: u32,
    last: u32,
    front: u32,
    back: u32,
}

/// Nodes and the fragments that they keep; holds one tree or several.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Forest {
    nodes: Vec<PlaneNode>,
    fragments: Vec<Fragment>,
}

impl Forest {
    /// All fragments, in no order.
    pub(super) fn fragments(&self) -> &[Fragment] {
        &self.fragments
    }

    /// For each node a box around all fragments at and below it.
    fn boxes(&self) -> Vec<(DVec3, DVec3)> {
        let mut boxes = vec![(DVec3::INFINITY, DVec3::NEG_INFINITY); self.nodes.len()];
        // Nodes have higher numbers than the ones above them.
        for (number, node) in self.nodes.iter().enumerate().rev() {
            let here = &self.fragments[node.first as usize..node.last as usize];
            let below = [node.front, node.back].map(|below| boxes.get(below as usize).copied());
            let (low, high) = below
                .into_iter()
                .flatten()
                .fold(bounds(here), |around, other| (around.0.min(other.0), around.1.max(other.1)));
            boxes[number] = (low, high);
        }
        boxes
    }

    /// Number of nodes of all trees.
    pub(super) fn n_nodes(&self) -> usize {
        self.nodes.len()
    }
}

/// A tree of planes over all faces of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct BspTree {
    forest: Forest,
    root: u32,
    /// For each node a box around all fragments at and below it.
    boxes: Vec<(DVec3, DVec3)>,
    of: FragmentsOf,
    n_objects: u64,
    counts: FragmentCounts,
}

impl BspTree {
    /// Builds the tree. About O(n log n) on meshes of small triangles, in parallel; the tree is the
    /// same for any number of threads.
    ///
    /// # Errors
    /// There would be too many fragments, by an estimate before anything is built
    /// ([`MAX_PIERCINGS`]) or in fact ([`MAX_FRAGMENTS`]).
    pub fn new(scene: &Scene) -> Result<Self, TooManyFragments> {
        check_piercings(scene)?;
        let planes = Planes::new(scene.mesh().positions(), scene.triangles());
        let mut counts = FragmentCounts::default();
        let mut forest = Forest::default();
        let objects = objects::all(scene, &planes);
        let (root, sets) = forest.part_objects(scene, &planes, objects, &mut counts);
        let n_objects = sets.len() as u64;
        let root = forest.grow(scene, &planes, sets, &mut counts)?.first().copied().unwrap_or(root);
        counts.fragments = forest.fragments.len() as u64;
        let (boxes, of) = (forest.boxes(), FragmentsOf::new(scene, &forest.fragments));
        Ok(Self { forest, root, boxes, of, n_objects, counts })
    }

    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.forest.n_nodes()
    }

    /// All fragments, in no order.
    pub fn fragments(&self) -> &[Fragment] {
        &self.forest.fragments
    }

    /// What building took.
    pub fn counts(&self) -> FragmentCounts {
        self.counts
    }

    /// The same with the size of the tree and what a view left out.
    pub fn work(&self, hidden: MaskCounts) -> FaceWork {
        FaceWork::Bsp {
            counts: self.counts,
            nodes: self.n_nodes() as u64,
            objects: self.n_objects,
            hidden_nodes: hidden.hidden_boxes,
            hidden,
        }
    }

    /// The fragments in the order in which the camera of `planes` sees them, with the side of their
    /// plane that the eye is on. In one plane those of the lowest face are the nearest.
    pub fn walk<'a>(&'a self, planes: &'a Planes<'a>, order: WalkOrder) -> BspWalk<'a> {
        self.forest.walk(planes, self.root, order)
    }

    /// The fragments from far to near, cut at the near plane. `scene` must be that of the tree.
    /// O(nodes + fragments).
    pub fn paint(&self, scene: &Scene, camera: &Camera) -> Painting {
        let easel = Easel::new(scene, camera);
        let mut painting = Painting::new(false);
        self.for_each(scene, camera, |fragment, facing| {
            easel.paint(&mut painting, &fragment, facing);
        });
        painting
    }

    /// The fragments from far to near, cut at the near plane, without most of those that nearer ones
    /// hide. `scene` must be that of the tree.
    ///
    /// What is left out is surely hidden; what is left may be.
    pub fn paint_seen(&self, scene: &Scene, camera: &Camera) -> (Painting, MaskCounts) {
        let planes = Planes::new(scene.mesh().positions(), scene.triangles()).seen_by(camera);
        let mut mask = Mask::new(scene, camera, &planes, &self.of, self.fragments().len());
        let mut walk = self.walk(&planes, WalkOrder::NearToFar);
        loop {
            let is_wanted = |node: u32| {
                let (low, high) = self.boxes[node as usize];
                !mask.hides(low, high)
            };
            let Some((fragment, facing)) = walk.next_wanted(is_wanted) else { break };
            mask.add(fragment, facing);
        }
        mask.painting()
    }

    /// The same fragments as [`paint`](Self::paint), without painting them.
    pub fn order(&self, scene: &Scene, camera: &Camera) -> Vec<Fragment> {
        let mut fragments = Vec::with_capacity(self.fragments().len());
        self.for_each(scene, camera, |fragment, _| fragments.push(fragment.into_owned()));
        fragments
    }

    /// What a view shows of the fragments, from far to near, and the side that faces the eye.
    fn for_each(&self, scene: &Scene, camera: &Camera, mut show: impl FnMut(Cow<Fragment>, Sign)) {
        let planes = Planes::new(scene.mesh().positions(), scene.triangles()).seen_by(camera);
        let near = planes.has_near_plane().then(|| planes.plane(PlaneName::Near));
        for (fragment, facing) in self.walk(&planes, WalkOrder::FarToNear) {
            if facing == Sign::Zero {
                continue;
            }
            if let Some(kept) = fragment.kept(&planes, near.as_ref()) {
                show(kept, facing);
            }
        }
    }
}

/// Builds a tree and paints one view.
///
/// # Errors
/// As [`BspTree::new`].
pub fn solve(
    scene: &Scene,
    camera: &Camera,
) -> Result<(Painting, FragmentCounts), TooManyFragments> {
    let tree = BspTree::new(scene)?;
    let painting = tree.paint(scene, camera);
    Ok((painting, tree.counts()))
}
