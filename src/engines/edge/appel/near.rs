//! Triangles that segments may pierce, touch or be in near contact with.
//!
//! The boxes of both, in the image and in depth, find those that are near each other; then the plane of
//! the triangle rules out most of the rest, since the ends of nearly all edges are well on one side of it.
//!
//! Points in near contact are behind the triangle on a sight line through it, so its box has to be enlarged
//! in depth only, though by much where the triangle is nearly edge-on.

use super::super::occluders::Occluders;
use super::super::segment::Segment;
use super::box_join::{LatticeBox, grouped, meeting_pairs};
use super::places::Places;
use crate::classify::ViewedScene;
use crate::groups::Groups;
use crate::predicates::{Sign, Viewpoint};
use rayon::prelude::*;

/// The occluders near each segment.
///
/// `boxes` are those of the segments. Expected cost: segments and occluders, once.
pub(super) fn near_triangles(
    view: &ViewedScene,
    occluders: &Occluders,
    places: &Places,
    segments: &[Option<Segment>],
    boxes: &[LatticeBox],
    contact_tolerance: f64,
) -> Groups {
    let ends: Vec<[u32; 2]> = segments
        .par_iter()
        .map(|segment| segment.as_ref().map_or([0; 2], |segment| segment.ends))
        .collect();
    let near = Near { view, contact_tolerance, ends, places };
    let list = occluders.list();
    let second = |i: u32| near.box_of_triangle(list[i as usize]);
    let pairs = meeting_pairs(boxes, list.len(), second, |triangle, meeting, found| {
        near.push_meetings(triangle, meeting, found);
    });
    grouped(segments.len(), pairs)
}

struct Near<'n, 'a> {
    view: &'n ViewedScene<'a>,
    contact_tolerance: f64,
    /// The vertices of each segment.
    ends: Vec<[u32; 2]>,
    places: &'n Places,
}

impl Near<'_, '_> {
    /// The box of a triangle with all points behind it that are in near contact with its plane; `None`
    /// when it lies beside all segments.
    #[inline]
    fn box_of_triangle(&self, triangle: u32) -> Option<LatticeBox> {
        let corners = self.view.scene().triangles()[triangle as usize];
        let mut place = self.places.around(corners);
        if self.contact_tolerance > 0.0 {
            let reach = self.view.sight().contact_reach(corners, self.contact_tolerance);
            let depths = corners.map(|corner| self.view.image()[corner as usize].depth);
            let farthest = depths.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let length = match self.view.sight().viewpoint() {
                Viewpoint::Eye(_) => farthest,
                Viewpoint::Direction(forward) => forward.length(),
            };
            let farthest = self.places.lattice.z_place(farthest + reach * length);
            place.high[2] = place.high[2].max(farthest);
        }
        place.of(triangle)
    }

    /// Pushes those of some segments that may pierce a triangle, touch it or be in near contact
    /// with it.
    fn push_meetings(&self, triangle: u32, segments: &[u32], found: &mut Vec<(u32, u32)>) {
        let corners = self.view.scene().triangles()[triangle as usize];
        let slab = self.view.sight().slab(corners, self.contact_tolerance);
        // Zero for a corner, `None` when that is in doubt.
        let side = |end: u32| match corners.contains(&end) {
            true => Some(Sign::Zero),
            false => self.view.sight().side_of_slab(&slab, end),
        };
        let may_meet = |[a, b]: [u32; 2]| match side(a) {
            None => true,
            // Of a segment that ends in a corner only the other end matters; a side has none.
            Some(Sign::Zero) => side(b).is_none(),
            Some(from) => side(b).is_none_or(|to| from.times(to) == Sign::Negative),
        };
        let meeting = segments.iter().filter(|&&i| may_meet(self.ends[i as usize]));
        found.extend(meeting.map(|&i| (i, triangle)));
    }
}
