//! Roberts' first step: faces of a body that face away from the eye need not be tested.
//!
//! ```text
//!            front ╱╲ back            A line of sight that starts outside a closed body enters it
//!   eye ◁ ────────●──●─────── ● X     through a front face before it leaves through a back face.
//!                ╱____╲               So X is hidden by the front face alone.
//! ```
//!
//! Two savings follow:
//!
//! * Back faces cover nothing that front faces of the same body do not cover.
//! * An edge between two back faces is hidden, since just in front of it lies the inside of the body.
//!
//! Both concern *whether* something hides a point. So neither is used when layers are counted, nor
//! when the near plane opens a body. With a contact tolerance the front face may be in contact with
//! what it hides, and the back face not; and back faces tell which coincident edges are nearer. So
//! neither is used then, either.
//!
//! Bodies are known only where intersections were looked for; see [`Intersections::in_bodies`].
//!
//! [`Intersections::in_bodies`]: crate::model::intersections::Intersections::in_bodies

use super::VisibilityOptions;
use super::segment::Segment;
use crate::classify::ViewedScene;
use crate::predicates::Sign;
use rayon::prelude::*;

/// What of a view's bodies faces away from the eye.
#[derive(Debug, Default)]
pub(super) struct BackFaces {
    /// For each triangle whether it is one; empty when none is known.
    is_back: Vec<bool>,
    /// Vertices of edges between two of them, the lower first, in order.
    edges: Vec<[u32; 2]>,
    n_faces: u64,
}

impl BackFaces {
    /// Finds the triangles that need not be tested. O(triangles log triangles), in parallel.
    pub(super) fn new(view: &ViewedScene, options: &VisibilityOptions) -> Self {
        let in_bodies = view.scene().intersections().in_bodies();
        let is_wanted = !options.count_layers
            && !options.find_doubled
            && options.contact_tolerance == 0.0
            && !view.near_plane_cuts();
        if !is_wanted || in_bodies.is_empty() {
            return Self::default();
        }
        let triangles = view.scene().triangles();
        let turns = view.triangle_turns().par_iter();
        let is_back: Vec<bool> = turns
            .zip(in_bodies)
            .map(|(&turn, &in_body)| in_body && turn == Sign::Negative)
            .collect();
        let back = triangles.par_iter().zip(&is_back).filter(|&(_, &is_back)| is_back);
        let mut sides: Vec<[u32; 2]> = back
            .flat_map_iter(|(&[p, q, r], _)| [[p, q], [q, r], [r, p]])
            .map(|[p, q]| [p.min(q), p.max(q)])
            .collect();
        let n_faces = (sides.len() / 3) as u64;
        sides.par_sort_unstable();
        let edges =
            sides.chunk_by(|a, b| a == b).filter(|uses| uses.len() == 2).map(|uses| uses[0]);
        Self { edges: edges.collect(), is_back, n_faces }
    }

    /// Whether a triangle need not be tested.
    #[inline]
    pub(super) fn holds(&self, triangle: u32) -> bool {
        self.is_back.get(triangle as usize).copied().unwrap_or(false)
    }

    /// Whether a segment lies between two of the triangles.
    pub(super) fn hides(&self, segment: &Segment) -> bool {
        let [a, b] = segment.ends;
        self.edges.binary_search(&[a.min(b), a.max(b)]).is_ok()
    }

    /// How many triangles need not be tested.
    pub(super) fn n_faces(&self) -> u64 {
        self.n_faces
    }
}
