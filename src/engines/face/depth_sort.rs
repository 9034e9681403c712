//! The painter's algorithm with a sorted list: Newell, Newell and Sancha's depth sort, for one view.
//!
//! ```text
//!    eye ◁    Q ╲   P            sorted by the farthest point, P comes first. It may be painted if
//!              ╲ ╲  │            it hides no part of any Q not painted yet; if it does hide one, Q is
//!               ╲ ╲ │            moved before it, marked, and tested in its turn. Moving a marked one
//!                  ╲│            again would close a cycle, so one of them is split
//! ```
//!
//! Each pair goes through tests of rising cost until one passes. P hides nothing of Q when
//!
//! 1. the nearest point of P is no nearer than the farthest point of Q,
//! 2. the boxes of their images are disjoint in x or in y,
//! 3. P lies behind the plane of Q,
//! 4. Q lies in front of the plane of P,
//! 5. their images do not overlap: a side of one separates them,
//! 6. where they do overlap, Q is nearer at each corner of the common part.
//!
//! The first two use rounded numbers with safe bounds, the others exact predicates, so the order is
//! never wrong. The last test is not in the paper, which splits pairs that fail the others although
//! few of them pierce each other. Of faces in one plane, the one with the lowest number is nearest.
//!
//! # Why it ends
//!
//! In a cycle some member crosses the plane of another, since otherwise the planes would order them
//! all. It is split there, and its parts never cross that plane again. So the number of splits is
//! finite, and small in practice; [`MAX_SPLITS`] and [`MAX_TESTS`] stop what would take too long.
//!
//! Source: M. Newell, R. Newell, T. Sancha, "A solution to the hidden surface problem" (1972); lecture
//! notes on visibility (Slovak), section 3.1, and the tests T1 to T4 of those on depth sort; the same
//! tests are 1, 2a to 2d in the German ones.
//!
//! Good for: single views of large models, with hardly any splits: a mesh of 70 000 triangles takes
//! seconds. A tree of image boxes finds the pairs, so the cost is about n log n plus the number of pairs
//! whose boxes overlap. Cannot: reuse anything for the next view. Many large faces behind each other
//! make n² pairs; their number is estimated first, see [`MAX_PAIRS`].
//!
//! Coherence: object coherence (boxes stand for faces).
//!
//! # Time
//!
//! Two threads, of which one sorts:
//!
//! | model | triangles | splits | tests of pairs | time |
//! |---|---|---|---|---|
//! | bumpy sphere | 9 800 | 0 | 77 000 | 0.08 s |
//! | statue | 70 000 | 0 | 457 000 | 0.6 s |
//! | bumpy sphere | 101 760 | 0 | 713 000 | 1.5 s |
//! | 10 000 boxes | 120 000 | 0 | 1 127 000 | 1.1 s |
//! | turbine blade | 199 034 | 0 | 1 304 000 | 2.4 s |
//! | spacecraft of parts that pierce each other | 20 390 | 62 646 | 28 334 000 | 8.8 s |

mod boxes;
mod list;
mod relation;

pub use self::relation::Settled;

use super::fragment::{Easel, Fragment};
use super::painting::Painting;
use super::piercing;
use crate::camera::Camera;
use crate::model::scene::Scene;
use crate::predicates::{PlaneName, Planes, Sign};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde::Serialize;
use thiserror::Error;

/// The most splits for each face, beyond a few thousand in all; usual models need far less than one.
pub const MAX_SPLITS: u64 = 64;

/// The most pairs of triangles that pierce each other, for each triangle. More are refused at once: that
/// many splits, each of which makes new pairs, would take minutes.
pub const MAX_PIERCINGS: u64 = 8;

/// The most tests of pairs: about a minute's worth.
pub const MAX_TESTS: u64 = 200_000_000;

/// The most pairs of faces with overlapping boxes: a minute or two. Their number is estimated from a
/// sample of faces first.
pub const MAX_PAIRS: u64 = 200_000_000;

/// Faces in the sample for the estimate.
const N_SAMPLES: usize = 1024;

/// Why a scene is not sorted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum DepthSortError {
    /// Found before sorting starts.
    #[error("about {0} pairs of faces overlap in the image and in depth, which would take minutes")]
    TooManyPairs(u64),
    /// Found before sorting starts.
    #[error("about {0} pairs of triangles pierce each other, too many to sort")]
    TooManyPiercings(u64),
    /// Found while sorting.
    #[error("the faces had to be split {0} times and are still not in order")]
    TooManySplits(u64),
    /// Found while sorting.
    #[error("the faces were compared {0} times and are still not in order")]
    TooManyTests(u64),
}

/// What sorting took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct DepthSortCounts {
    /// Pieces that are painted.
    pub fragments: u64,
    /// How often a fragment was cut in two, not counting cuts at the near plane.
    pub splits: u64,
    /// How often a pair was tested.
    pub tests: u64,
    /// How often a fragment was moved before another.
    pub moves: u64,
    /// Which test passed.
    pub settled: Settled,
}

/// A fragment with the data used most. Boxes and depth ranges are slightly too large.
#[derive(Debug, Clone)]
struct SortedFragment {
    fragment: Fragment,
    face: u32,
    /// The side of its plane that the eye is on.
    facing: Sign,
    low: DVec2,
    high: DVec2,
    near: f64,
    far: f64,
    /// The number of the original item that this one is part of.
    origin: u32,
}

impl SortedFragment {
    fn new(easel: &Easel, fragment: Fragment, facing: Sign, origin: u32) -> Self {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for corner in fragment.corners() {
            let (image, error) = easel.image_within(corner.point, corner.error);
            let (depth, depth_error) = easel.depth_within(corner);
            let (at, around) = (image.extend(depth), DVec2::splat(error).extend(depth_error));
            if at.is_finite() {
                (low, high) = (low.min(at - around), high.max(at + around));
            } else {
                (low, high) = (DVec3::NEG_INFINITY, DVec3::INFINITY);
            }
        }
        let face = easel.face(&fragment);
        let (near, far) = (low.z, high.z);
        Self {
            fragment,
            face,
            facing,
            low: low.truncate(),
            high: high.truncate(),
            near,
            far,
            origin,
        }
    }

    /// The first tests: whether another may hide part of this one, or this one part of the other.
    #[inline]
    fn may_meet(&self, other: &Self) -> bool {
        self.low.cmplt(other.high).all() && other.low.cmplt(self.high).all()
    }
}

/// Paints one view.
///
/// # Errors
/// See [`enum@DepthSortError`].
pub fn solve(
    scene: &Scene,
    camera: &Camera,
) -> Result<(Painting, DepthSortCounts), DepthSortError> {
    let (fragments, mut counts) = order(scene, camera)?;
    let planes = Planes::new(scene.mesh().positions(), scene.triangles()).seen_by(camera);
    let easel = Easel::new(scene, camera);
    let mut painting = Painting::new(false);
    for fragment in &fragments {
        let facing = planes.side_of_eye(PlaneName::Triangle(fragment.triangle()));
        easel.paint(&mut painting, fragment, facing);
    }
    counts.fragments = painting.len() as u64;
    Ok((painting, counts))
}

/// The fragments of one view from far to near, clipped at the near plane, without edge-on ones.
///
/// # Errors
/// See [`enum@DepthSortError`].
pub fn order(
    scene: &Scene,
    camera: &Camera,
) -> Result<(Vec<Fragment>, DepthSortCounts), DepthSortError> {
    let n_piercings = piercing::estimate(scene);
    if n_piercings > MAX_PIERCINGS * scene.triangles().len() as u64 {
        return Err(DepthSortError::TooManyPiercings(n_piercings));
    }
    let planes = Planes::new(scene.mesh().positions(), scene.triangles()).seen_by(camera);
    let easel = Easel::new(scene, camera);
    let near = planes.has_near_plane().then(|| planes.plane(PlaneName::Near));
    let items: Vec<SortedFragment> = (0..scene.triangles().len() as u32)
        .into_par_iter()
        .filter_map(|triangle| {
            let whole = Fragment::new(scene, &planes, triangle)?;
            let facing = planes.side_of_eye(PlaneName::Triangle(triangle));
            let kept = whole.kept(&planes, near.as_ref()).filter(|_| facing != Sign::Zero)?;
            Some(SortedFragment::new(&easel, kept.into_owned(), facing, 0))
        })
        .collect();
    let mut list = list::List::new(&planes, easel, items);
    let n_pairs = list.estimated_pairs(N_SAMPLES);
    if n_pairs > MAX_PAIRS {
        return Err(DepthSortError::TooManyPairs(n_pairs));
    }
    let mut counts = DepthSortCounts::default();
    let order = list.sorted(&mut counts)?;
    let fragments = order.iter().map(|&number| list.item(number).fragment.clone()).collect();
    Ok((fragments, counts))
}
