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
//! when the near plane opens a body.
//!
//! With a contact tolerance a front face does not hide an edge that it nearly touches, and the back
//! face behind it may. So back faces wait: they are tested against the edges that nearly touch a front
//! face before them, and against no others. Edges between two back faces are tested like all others.
//!
//! Where coincident edges are looked for, a back face tells that its border is nearer than an edge
//! behind it. The front face beside that border tells the same. So back faces beside an edge-on face
//! are not left out then. A border between two back faces lies behind front faces, and so does all
//! that it could coincide with.
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
    /// Whether they are tested after all against segments in contact with a front face.
    waits: bool,
}

impl BackFaces {
    /// Finds the triangles that need not be tested. O(triangles log triangles), in parallel.
    pub(super) fn new(view: &ViewedScene, options: &VisibilityOptions) -> Self {
        let in_bodies = view.scene().intersections().in_bodies();
        let is_wanted = !options.count_layers && !view.near_plane_cuts();
        if !is_wanted || in_bodies.is_empty() {
            return Self::default();
        }
        let turns = view.triangle_turns().par_iter();
        let turn_in_body = |(&turn, &in_body): (&Sign, &bool)| in_body.then_some(turn);
        let turns: Vec<Option<Sign>> = turns.zip(in_bodies).map(turn_in_body).collect();
        let sides_of = |sign| {
            let triangles = view.scene().triangles().par_iter().zip(&turns);
            let mut sides: Vec<[u32; 2]> = triangles
                .filter(|&(_, &turn)| turn == Some(sign))
                .flat_map_iter(|(&corners, _)| sides(corners))
                .collect();
            sides.par_sort_unstable();
            sides
        };
        let beside = if options.find_doubled { sides_of(Sign::Zero) } else { Vec::new() };
        let is_kept = |corners| sides(corners).iter().any(|s| beside.binary_search(s).is_ok());
        let is_back: Vec<bool> = (view.scene().triangles().par_iter().zip(&turns))
            .map(|(&corners, &turn)| turn == Some(Sign::Negative) && !is_kept(corners))
            .collect();
        let n_faces = is_back.iter().filter(|&&is_back| is_back).count() as u64;
        let waits = options.contact_tolerance > 0.0;
        let edges = if waits {
            Vec::new()
        } else {
            let sides = sides_of(Sign::Negative);
            let twice = sides.chunk_by(|a, b| a == b).filter(|uses| uses.len() == 2);
            twice.map(|uses| uses[0]).collect()
        };
        Self { is_back, edges, n_faces, waits }
    }

    /// Whether a triangle is never tested.
    pub(super) fn leaves_out(&self, triangle: u32) -> bool {
        !self.waits && self.holds(triangle)
    }

    /// Whether a triangle need not be tested, but against segments in contact with a front face.
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

/// The sides of a triangle, each with its lower vertex first.
fn sides([p, q, r]: [u32; 3]) -> [[u32; 2]; 3] {
    [[p, q], [q, r], [r, p]].map(|[p, q]| [p.min(q), p.max(q)])
}
