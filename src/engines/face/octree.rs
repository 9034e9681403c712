//! The painter's algorithm with an octree.
//!
//! ```text
//!      ┌───────┬───┬───┐          faces are cut where octants meet; an octant with few fragments
//!      │       │   ┊   │          is a leaf with its own tree of planes;
//!      │   2   ├───┼───┤  3       seen from below left, quarter 0 may hide 1 and 2, these may
//!      │       │   ┊   │          hide 3: the paint order is 3, 2, 1, 0, decided for each
//!      ├───────┼───┴───┤          octant by where the eye is relative to its center
//!      │   0   │   1   │
//!      └───────┴───────┘
//!   eye
//! ```
//!
//! Walked from near to far, hidden parts are left out ([`mask`](super::mask)): octants whose image is
//! covered are skipped with everything in them.
//!
//! Source: lecture notes on visibility (Slovak), section 3.3, and those on octree methods after Hearn
//! and Baker; the order of the leaves is that of [`bsp`](super::bsp).
//!
//! Good for: halls, towns and assemblies, where large faces hide much; the tree serves many views.
//! Cannot: cut as little as [`bsp`](super::bsp) does, since octants ignore where faces are.
//!
//! # Size and time
//!
//! Two threads, without leaving anything out:
//!
//! | model | triangles | fragments | built | painted |
//! |---|---|---|---|---|
//! | street of large faces | 2 014 | 3 741 | 0.2 s | 2 ms |
//! | bumpy sphere | 9 800 | 23 692 | 0.23 s | 21 ms |
//! | town | 36 271 | 87 936 | 1.7 s | 74 ms |
//! | statue | 70 000 | 166 077 | 1.7 s | 102 ms |
//! | 10 000 boxes | 120 000 | 188 174 | 5.1 s | 94 ms |
//! | turbine blade | 199 034 | 444 965 | 3.9 s | 398 ms |
//!
//! Fragments left after hiding by single faces, and after hiding by what faces cover together:
//!
//! | model | triangles | fragments | single | together |
//! |---|---|---|---|---|
//! | street of large faces | 2 014 | 3 756 | 3 426 | 3 223 |
//! | cow | 5 856 | 13 310 | 13 064 | 7 878 |
//! | statue | 70 000 | 166 506 | 165 253 | 83 025 |
//!
//! Half of the fragments of a closed body face away. Those that stay are behind a silhouette, or behind
//! faces that reach into an octant not painted yet.
//!
//! Coherence: object coherence (an octant on a covered square is skipped with everything in it) and picture
//! sequence coherence (one tree serves all views).

use super::bsp::{Forest, Link, TooManyFragments, WalkOrder, check_piercings};
use super::fragment::{Easel, Fragment, bounds};
use super::mask::{FragmentsOf, Mask, MaskCounts};
use super::painting::Painting;
use super::{FaceWork, FragmentCounts};
use crate::camera::Camera;
use crate::model::scene::Scene;
use crate::predicates::{PlaneName, Planes, Sign};
use glam::DVec3;
use rayon::prelude::*;

/// An octant of at most this many fragments is a leaf. Smaller leaves cut more faces; larger ones
/// are skipped more rarely and leave more to the trees of planes.
pub const LEAF_CAPACITY: usize = 48;

/// The most levels of octants; faces that meet in one point can never be separated.
pub const MAX_DEPTH: u32 = 12;

/// An octant whose division would multiply its fragments by more than this is a leaf, however many it
/// has: fans of long, thin faces would be cut again and again.
pub const MAX_GROWTH: f64 = 1.5;

/// No octant.
const NONE: u32 = u32::MAX;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Contents {
    /// Eight octants around a center. Bit k of an octant's number is set if it is on the positive side
    /// along axis k.
    Octants(DVec3, [u32; 8]),
    /// A tree of planes.
    Leaf(u32),
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Octant {
    contents: Contents,
    /// A box around its fragments.
    low: DVec3,
    high: DVec3,
}

/// A tree of octants over all faces of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Octree {
    octants: Vec<Octant>,
    forest: Forest,
    of: FragmentsOf,
    counts: FragmentCounts,
}

/// An octant to be built.
struct Task {
    /// The octant above, and the number below it.
    link: Option<(u32, usize)>,
    depth: u32,
    low: DVec3,
    high: DVec3,
    fragments: Vec<Fragment>,
}

impl Octree {
    /// Builds the tree, all octants of one depth in parallel; it is the same for any number of
    /// threads. O(n log n) on meshes of small triangles.
    ///
    /// # Errors
    /// There would be too many fragments, as for [`bsp::BspTree::new`](super::bsp::BspTree::new).
    pub fn new(scene: &Scene) -> Result<Self, TooManyFragments> {
        check_piercings(scene)?;
        let planes = Planes::new(scene.mesh().positions(), scene.triangles());
        let fragments = Fragment::all(scene, &planes);
        let (low, high) = bounds(&fragments);
        // A cube, so that flat scenes are not cut along their height.
        let high = low + (high - low).max_element();
        let mut tasks = vec![Task { link: None, depth: 0, low, high, fragments }];
        let mut octants: Vec<Octant> = Vec::new();
        let mut leaves = Vec::new();
        let mut counts = FragmentCounts::default();
        while !tasks.is_empty() {
            let grown: Vec<_> = tasks
                .into_par_iter()
                .map(|task| {
                    let mut counts = FragmentCounts::default();
                    let (low, high) = bounds(&task.fragments);
                    (low, high, task.link, part(&planes, task, &mut counts), counts)
                })
                .collect();
            tasks = Vec::new();
            for (low, high, link, parted, of_task) in grown {
                counts.add(of_task);
                let number = octants.len() as u32;
                let contents = match parted {
                    Parted::Leaf(fragments) => {
                        leaves.push(fragments);
                        Contents::Leaf(leaves.len() as u32 - 1)
                    }
                    Parted::Octants(center, below) => {
                        tasks.extend(below.into_iter().enumerate().filter_map(|(k, task)| {
                            Some(Task { link: Some((number, k)), ..task? })
                        }));
                        Contents::Octants(center, [NONE; 8])
                    }
                };
                octants.push(Octant { contents, low, high });
                if let Some((above, k)) = link
                    && let Contents::Octants(_, numbers) = &mut octants[above as usize].contents
                {
                    numbers[k] = number;
                }
            }
        }
        let mut forest = Forest::default();
        let leaves = leaves.into_iter().enumerate().map(|(k, set)| (Link::Root(k), set)).collect();
        let roots = forest.grow(scene, &planes, leaves, &mut counts)?;
        for octant in &mut octants {
            if let Contents::Leaf(leaf) = &mut octant.contents {
                *leaf = roots[*leaf as usize];
            }
        }
        let of = FragmentsOf::new(scene, forest.fragments());
        counts.fragments = forest.fragments().len() as u64;
        Ok(Self { octants, forest, of, counts })
    }

    /// All fragments, in no order.
    pub fn fragments(&self) -> &[Fragment] {
        self.forest.fragments()
    }

    /// What building took.
    pub fn counts(&self) -> FragmentCounts {
        self.counts
    }

    /// The same with the size of the tree and what a view left out.
    pub fn work(&self, hidden: MaskCounts) -> FaceWork {
        let (octants, nodes) = (self.octants.len() as u64, self.forest.n_nodes() as u64);
        let hidden_octants = hidden.hidden_boxes;
        FaceWork::Octree { counts: self.counts, octants, nodes, hidden_octants, hidden }
    }

    /// Number of octants, leaves included.
    pub fn n_octants(&self) -> usize {
        self.octants.len()
    }

    /// All fragments from far to near, cut at the near plane. `scene` must be that of the tree.
    pub fn paint(&self, scene: &Scene, camera: &Camera) -> Painting {
        let planes = Planes::new(scene.mesh().positions(), scene.triangles()).seen_by(camera);
        let easel = Easel::new(scene, camera);
        let near = planes.has_near_plane().then(|| planes.plane(PlaneName::Near));
        let mut painting = Painting::new(false);
        let mut leaves = Leaves::new(self, &planes, WalkOrder::FarToNear);
        while let Some(root) = leaves.next(|_| true) {
            for (fragment, facing) in self.forest.walk(&planes, root, WalkOrder::FarToNear) {
                if facing == Sign::Zero {
                    continue;
                }
                if let Some(kept) = fragment.kept(&planes, near.as_ref()) {
                    easel.paint(&mut painting, &kept, facing);
                }
            }
        }
        painting
    }

    /// The fragments from far to near, cut at the near plane, without most of those that nearer ones
    /// hide. `scene` must be that of the tree.
    ///
    /// What is left out is surely hidden; what is left may be.
    pub fn paint_seen(&self, scene: &Scene, camera: &Camera) -> (Painting, MaskCounts) {
        let planes = Planes::new(scene.mesh().positions(), scene.triangles()).seen_by(camera);
        let mut mask = Mask::new(scene, camera, &planes, &self.of, self.fragments().len());
        let mut leaves = Leaves::new(self, &planes, WalkOrder::NearToFar);
        while let Some(root) = leaves.next(|octant| !mask.hides(octant.low, octant.high)) {
            for (fragment, facing) in self.forest.walk(&planes, root, WalkOrder::NearToFar) {
                mask.add(fragment, facing);
            }
        }
        mask.painting()
    }
}

/// The leaves in order of sight.
struct Leaves<'a> {
    tree: &'a Octree,
    planes: &'a Planes<'a>,
    order: WalkOrder,
    waiting: Vec<u32>,
}

impl<'a> Leaves<'a> {
    fn new(tree: &'a Octree, planes: &'a Planes<'a>, order: WalkOrder) -> Self {
        Self { tree, planes, order, waiting: vec![0] }
    }

    /// The tree of planes of the next leaf, leaving out octants that are not `wanted`.
    fn next(&mut self, mut wanted: impl FnMut(&Octant) -> bool) -> Option<u32> {
        loop {
            let number = self.waiting.pop()?;
            let Some(octant) = self.tree.octants.get(number as usize) else { continue };
            if !wanted(octant) {
                continue;
            }
            match octant.contents {
                Contents::Leaf(root) => return Some(root),
                Contents::Octants(center, numbers) => {
                    let is_above = |axis: u8| {
                        let at = center[usize::from(axis)];
                        let side = self.planes.side_of_eye(PlaneName::Across { axis, at });
                        usize::from(side == Sign::Positive) << axis
                    };
                    let nearest = is_above(0) | is_above(1) | is_above(2);
                    // Numbers that differ from the nearest in fewer axes come earlier: 0, 1, 2, …
                    let nth = |k: usize| numbers[nearest ^ k];
                    match self.order {
                        WalkOrder::NearToFar => self.waiting.extend((0..8).rev().map(nth)),
                        WalkOrder::FarToNear => self.waiting.extend((0..8).map(nth)),
                    }
                }
            }
        }
    }
}

enum Parted {
    Leaf(Vec<Fragment>),
    Octants(DVec3, Box<[Option<Task>; 8]>),
}

/// Cuts fragments at the three planes through the center of an octant.
fn part(planes: &Planes, task: Task, counts: &mut FragmentCounts) -> Parted {
    let center = task.low + (task.high - task.low) / 2.0;
    if task.fragments.len() <= LEAF_CAPACITY || task.depth >= MAX_DEPTH || !center.is_finite() {
        return Parted::Leaf(task.fragments);
    }
    let across = [0u8, 1, 2]
        .map(|axis| planes.plane(PlaneName::Across { axis, at: center[usize::from(axis)] }));
    let n = task.fragments.len();
    let mut of_parts = FragmentCounts::default();
    let mut parts: [Vec<Fragment>; 8] = Default::default();
    parts[0] = task.fragments.clone();
    for (axis, plane) in across.iter().enumerate() {
        for k in 0..1 << axis {
            for fragment in std::mem::take(&mut parts[k]) {
                let (front, back) = fragment.parted(planes, plane, &mut of_parts);
                parts[k | 1 << axis].extend(front);
                parts[k].extend(back);
            }
        }
    }
    counts.tests += of_parts.tests;
    if (n as u64 + of_parts.splits) as f64 > MAX_GROWTH * n as f64 {
        return Parted::Leaf(task.fragments);
    }
    counts.splits += of_parts.splits;
    let mut k = 0;
    let below = parts.map(|fragments| {
        let is_above = [0, 1, 2].map(|axis| k >> axis & 1 == 1);
        k += 1;
        let low = DVec3::from_array(std::array::from_fn(|i| {
            if is_above[i] { center[i] } else { task.low[i] }
        }));
        let high = DVec3::from_array(std::array::from_fn(|i| {
            if is_above[i] { task.high[i] } else { center[i] }
        }));
        let depth = task.depth + 1;
        (!fragments.is_empty()).then_some(Task { link: None, depth, low, high, fragments })
    });
    Parted::Octants(center, Box::new(below))
}

/// Builds a tree and paints one view, leaving out what it finds hidden: see [`Octree::paint_seen`].
///
/// # Errors
/// As [`Octree::new`].
pub fn solve(
    scene: &Scene,
    camera: &Camera,
) -> Result<(Painting, FragmentCounts), TooManyFragments> {
    let tree = Octree::new(scene)?;
    let (painting, _) = tree.paint_seen(scene, camera);
    Ok((painting, tree.counts()))
}
