//! Cutting edges that segments may pass behind.
//!
//! Their boxes in the image find those that may cross; then depths, and on which side of the segment the
//! ends of the cutting edge are, rule out most of the rest.

use super::super::rounding::{Rounding, Separation};
use super::super::segment::Segment;
use super::box_join::{LatticeBox, grouped, meeting_pairs};
use super::cutting::CuttingEdge;
use super::places::Places;
use crate::classify::ViewedScene;
use crate::groups::Groups;

/// The cutting edges that may cross each segment in front of it, or pass over one of its ends.
///
/// `boxes` are those of the segments. Expected cost: segments and cutting edges, once, and pairs
/// whose boxes in the image share a point.
pub(super) fn cutting_edges_ahead(
    view: &ViewedScene,
    rounding: &Rounding,
    places: &Places,
    segments: &[Option<Segment>],
    boxes: &[LatticeBox],
    cutting: &[CuttingEdge],
) -> Groups {
    let mut farthest = vec![0; segments.len()];
    for b in boxes {
        farthest[b.number() as usize] = b.farthest();
    }
    let flat: Vec<LatticeBox> = boxes.iter().map(|b| b.flat()).collect();
    let second = |edge: u32| places.around(cutting[edge as usize].ends).flat().of(edge);
    let pairs = meeting_pairs(&flat, cutting.len(), second, |edge, meeting, found| {
        let ends = cutting[edge as usize].ends;
        let nearest = places.around(ends).nearest();
        let points = ends.map(|end| view.image()[end as usize]);
        for &i in meeting.iter().filter(|&&i| nearest <= farthest[i as usize]) {
            if let Some(segment) = &segments[i as usize]
                && !Separation::new(rounding, segment).apart(ends, points)
            {
                found.push((i, edge));
            }
        }
    });
    grouped(segments.len(), pairs)
}
