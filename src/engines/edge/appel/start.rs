//! How many layers lie over a segment where it leaves one of its ends.

use super::super::occluders::Occluders;
use super::super::rounding::Rounding;
use super::super::segment::Segment;
use super::super::shadow::{Sides, side_of};
use super::box_join::{LatticeBox, LatticeRange, meeting_pairs};
use super::cutting::Stars;
use super::places::Places;
use crate::classify::ViewedScene;
use crate::predicates::Sign;

/// Whether a triangle covers the segment just beyond `ends[end]`: one for each side it covers, left
/// and right as seen from the segment's first end to its last.
///
/// The triangle must not be edge-on. Exact.
pub(super) fn covers_beyond(
    view: &ViewedScene,
    ends: [u32; 2],
    end: usize,
    triangle: u32,
) -> [i32; 2] {
    let beyond = Beyond::new(view, ends, end, triangle);
    if beyond.is_behind() { beyond.sides() } else { NONE }
}

/// On neither side.
const NONE: [i32; 2] = [0; 2];

/// A segment just beyond its end `here`, on the way `there`, and a triangle.
struct Beyond<'v> {
    view: &'v ViewedScene<'v>,
    ends: [u32; 2],
    here: u32,
    there: u32,
    corners: [u32; 3],
    turn: Sign,
    /// Whether `here` is one of the triangle's corners.
    is_corner: bool,
}

impl<'v> Beyond<'v> {
    fn new(view: &'v ViewedScene, ends: [u32; 2], end: usize, triangle: u32) -> Self {
        let corners = view.scene().triangles()[triangle as usize];
        let here = ends[end];
        Self {
            view,
            ends,
            here,
            there: ends[1 - end],
            corners,
            turn: view.triangle_turns()[triangle as usize],
            is_corner: corners.contains(&here),
        }
    }

    /// Whether the segment is behind the triangle's plane there.
    fn is_behind(&self) -> bool {
        let Self { here, there, corners, turn, is_corner, .. } = *self;
        if is_corner && corners.contains(&there) {
            return false;
        }
        let sight = self.view.sight();
        let plane = sight.triangle_plane(corners);
        let behind = |x| sight.depth_at(&plane, corners, x).1.times(turn);
        match if is_corner { Sign::Zero } else { behind(here) } {
            Sign::Negative => false,
            Sign::Zero => behind(there) == Sign::Positive,
            Sign::Positive => true,
        }
    }

    /// Whether the segment's image lies in the triangle's there: one for each side.
    fn sides(&self) -> [i32; 2] {
        let Self { view, ends, here, there, corners, turn, is_corner } = *self;
        let sight = view.sight();
        let mut along = None;
        for side in 0..3 {
            let (p, q) = (corners[side], corners[(side + 1) % 3]);
            if is_corner && p != here && q != here {
                continue; // The vertex lies on the inner side of the one opposite.
            }
            let plane = sight.sight_plane(p, q);
            let inside = |x| sight.turn_at(&plane, p, q, x).1.times(turn);
            match inside(here) {
                Sign::Negative => return NONE,
                Sign::Positive => {}
                Sign::Zero => match inside(there) {
                    Sign::Negative => return NONE,
                    Sign::Positive => {}
                    Sign::Zero => along = Some(side),
                },
            }
        }
        match along {
            Some(side) => side_of(view, ends, corners[(side + 2) % 3]).counts(),
            None => Sides::Both.counts(),
        }
    }
}

/// Whether the triangles around a vertex lie side by side in the image, once around.
///
/// There no triangle covers an edge that leaves the vertex between two others:
///
/// ```text
///      ╲  │  ╱        The number of triangles over a direction is the same for all directions,
///       ╲ │ ╱         when each edge has one triangle on its left and one on its right (the
///   ─────[v]─────     vertex is even); so one direction shows whether it is one everywhere.
///       ╱ │ ╲
/// ```
pub(super) fn is_plain(view: &ViewedScene, stars: &Stars, vertex: u32) -> bool {
    let around = stars.around(vertex);
    let Some(&first) = around.first() else { return false };
    let corners = view.scene().triangles()[first as usize];
    let Some(other) = corners.into_iter().find(|&corner| corner != vertex) else { return false };
    let mut layers = [0; 2];
    for &triangle in around {
        add(&mut layers, Beyond::new(view, [vertex, other], 0, triangle).sides());
    }
    layers == [1; 2]
}

/// How many of the triangles that have `ends[end]` as a corner cover the segment just beyond it.
pub(super) fn local_layers(
    view: &ViewedScene,
    stars: &Stars,
    ends: [u32; 2],
    end: usize,
) -> [i32; 2] {
    let mut layers = [0; 2];
    for &triangle in stars.around(ends[end]) {
        add(&mut layers, covers_beyond(view, ends, end, triangle));
    }
    layers
}

/// How many occluders cover each of some segments just beyond one of its ends, by sight lines.
///
/// O(occluders), and the occluders whose image's box holds an end's image.
pub(super) fn layers_beyond<'s>(
    view: &ViewedScene,
    occluders: &Occluders,
    rounding: &Rounding,
    places: &Places,
    ends: impl Iterator<Item = (Option<&'s Segment>, usize)>,
) -> Vec<[i32; 2]> {
    let questions: Vec<(Option<&Segment>, usize)> = ends.collect();
    let mut layers = vec![[0; 2]; questions.len()];
    // Each triangle is tested for being in front, so depths are not needed here.
    let flat = |place: LatticeRange, number: u32| place.flat().of(number);
    let first: Vec<LatticeBox> = (0..)
        .zip(&questions)
        .filter_map(|(i, &(segment, end))| {
            let segment = segment?;
            let bounds = rounding.bounds([segment.image[end]], [segment.depth[end]]);
            flat(places.lattice.place(bounds.corners()), i)
        })
        .collect();
    let list = occluders.list();
    let second = |i: u32| {
        let triangle = list[i as usize];
        flat(places.around(view.scene().triangles()[triangle as usize]), triangle)
    };
    let found = meeting_pairs(&first, list.len(), second, |triangle, meeting, found| {
        for &i in meeting {
            if let (Some(segment), end) = questions[i as usize] {
                found.push((i, covers_beyond(view, segment.ends, end, triangle)));
            }
        }
    });
    for (i, more) in found {
        add(&mut layers[i as usize], more);
    }
    layers
}

/// Adds to both sides.
pub(super) fn add(layers: &mut [i32; 2], more: [i32; 2]) {
    layers[0] += more[0];
    layers[1] += more[1];
}
