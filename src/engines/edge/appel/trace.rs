//! What changes the number of layers between the ends of one segment.
//!
//! A point just beside the segment, say on its left, moves along with it. The layers over that
//! point change where its image crosses a nearer cutting edge and where the segment pierces a
//! triangle:
//!
//! ```text
//!            q                    A vertex whose image is on the segment's counts as being to
//!      ┄┄┄┄┄┄┼┄┄┄┄► left          the right of the left path and to the left of the right path,
//!   A ●──────┼──────────● B       so that every edge either crosses a path or does not, whatever
//!      ┄┄┄┄┄┄┼┄┄┄┄► right         coincides in the image.
//!            p
//! ```
//!
//! Where a cutting edge *touches* the segment its triangles have planes through that point; they
//! cover on one side of it or neither, which is what the rule for piercing says.

use super::super::rounding::{Bounds, Rounding};
use super::super::segment::Segment;
use super::super::shadow::{Shadow, Sides, shadow, side_of};
use super::cutting::CuttingEdge;
use super::start::add;
use crate::camera::ImagePoint;
use crate::classify::ViewedScene;
use crate::groups::Groups;
use crate::predicates::{Cut, CutPlane, Estimate, Sign};
use std::cmp::Ordering;

/// A change of the number of layers on the left and right.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    /// Where.
    pub at: Cut,
    /// By how much, on the left and right.
    pub by: [i32; 2],
}

/// What is looked up to trace segments.
#[derive(Debug, Clone, Copy)]
pub(super) struct Surroundings<'s> {
    /// The cutting edges.
    pub cutting: &'s [CuttingEdge],
    /// Those that each segment may pass behind.
    pub ahead: &'s Groups,
    /// The triangles near each segment in space.
    pub near: &'s Groups,
    /// How images are rounded.
    pub rounding: &'s Rounding,
    /// The triangles that the near plane cuts.
    pub cut_by_near_plane: &'s [u32],
    /// See [`super::super::VisibilityOptions`].
    pub contact_tolerance: f64,
}

/// What was found along one segment.
#[derive(Debug, Default)]
pub(super) struct Trace {
    /// All changes of all segments so far.
    pub changes: Vec<Change>,
    /// Vertices over which some cutting edge lies, or which lie on a triangle.
    pub irregular: Vec<u32>,
    /// Cutting edges tested.
    pub crossings_tested: u64,
    /// Triangles tested.
    pub triangles_tested: u64,
}

impl Trace {
    /// Appends what changes the number of layers along `segment`; returns the change of the layers
    /// that are carried along, from its first end to its last. `number` is the segment's own.
    pub(super) fn follow(
        &mut self,
        view: &ViewedScene,
        around: &Surroundings,
        number: usize,
        segment: &Segment,
    ) -> [i32; 2] {
        let mut total = [0; 2];
        for &edge in around.ahead.of(number) {
            self.crossings_tested += 1;
            let edge = &around.cutting[edge as usize];
            if let Some(change) =
                crossing(view, around.rounding, segment, edge, &mut self.irregular)
            {
                add(&mut total, change.by);
                self.changes.push(change);
            }
        }

        for &triangle in around.near.of(number) {
            self.triangles_tested += 1;
            if let Some(change) = meeting(view, around, segment, triangle, self) {
                add(&mut total, change.by);
                self.changes.push(change);
            }
        }

        for &triangle in around.cut_by_near_plane {
            self.triangles_tested += 1;
            let tolerance = around.contact_tolerance;
            if let Some(Shadow::Covers(cover)) = shadow(view, segment, triangle, tolerance, false) {
                let by = cover.sides.counts();
                self.changes.push(Change { at: cover.from, by });
                self.changes.push(Change { at: cover.to, by: by.map(|n| -n) });
            }
        }
        total
    }
}

/// Whether a cut lies strictly within the part of the segment that the near plane keeps.
fn is_kept(view: &ViewedScene, segment: &Segment, cut: &Cut) -> bool {
    let order = |a, b| view.sight().cut_order(segment.ends, a, b);
    (segment.from.plane == CutPlane::End || order(&segment.from, cut) == Ordering::Less)
        && (segment.to.plane == CutPlane::End || order(cut, &segment.to) == Ordering::Less)
}

/// The change where the segment passes behind a cutting edge.
///
/// Also notes an end of the segment whose image lies on a nearer cutting edge's.
fn crossing(
    view: &ViewedScene,
    rounding: &Rounding,
    segment: &Segment,
    edge: &CuttingEdge,
    irregular: &mut Vec<u32>,
) -> Option<Change> {
    let sight = view.sight();
    let ([a, b], [p, q]) = (segment.ends, edge.ends);
    let plane = sight.sight_plane(p, q);
    let [at_a, at_b] = [a, b].map(|x| sight.turn_at(&plane, p, q, x));
    for (x, at_x) in [(a, at_a), (b, at_b)] {
        if at_x.1 == Sign::Zero && x != p && x != q && lies_over(view, rounding, edge, x) {
            irregular.push(x);
        }
    }
    if at_a.1.times(at_b.1) != Sign::Negative {
        return None;
    }
    let plane = sight.sight_plane(a, b);
    let [side_p, side_q] = [p, q].map(|x| sight.turn_at(&plane, a, b, x).1);
    // A vertex on the segment's own line lies to the right of its left path and vice versa.
    let left = (side_p == Sign::Positive) != (side_q == Sign::Positive);
    let right = (side_p == Sign::Negative) != (side_q == Sign::Negative);
    if !left && !right {
        return None;
    }
    // The line through p and q meets the segment's plane of sight in front of the segment when q
    // is in front of the plane through the segment and p, which lies on its other side.
    let nearer = if side_p != Sign::Zero {
        sight.depth([a, b, p], q).times(side_p)
    } else {
        sight.depth([a, b, q], p).times(side_q)
    };
    if nearer != Sign::Negative {
        return None;
    }
    let at = sight.cut([a, b], CutPlane::Sight(p, q), [at_a.0, at_b.0]);
    let step = if at_b.1 == Sign::Positive { edge.step } else { -edge.step };
    let by = [left, right].map(|crossed| if crossed { step } else { 0 });
    is_kept(view, segment, &at).then_some(Change { at, by })
}

/// Whether an edge lies strictly in front of a vertex on its plane of sight; in doubt, yes.
fn lies_over(view: &ViewedScene, rounding: &Rounding, edge: &CuttingEdge, vertex: u32) -> bool {
    let bounds = |vertices: &[u32]| -> Option<Bounds> {
        let [first, last] =
            [*vertices.first()?, *vertices.last()?].map(|v| view.image()[v as usize]);
        Some(rounding.bounds([first, last].map(ImagePoint::image), [first.depth, last.depth]))
    };
    let apart = match (bounds(&edge.ends), bounds(&[vertex])) {
        (Some(edge), Some(vertex)) => !edge.overlaps(&vertex),
        _ => false,
    };
    let turn = view.triangle_turns()[edge.triangle as usize];
    let corners = view.scene().triangles()[edge.triangle as usize];
    !apart && view.sight().depth(corners, vertex).times(turn) == Sign::Positive
}

/// The change where the segment pierces a triangle.
///
/// Also notes ends that lie on the triangle, and takes away what it would cover in near contact.
fn meeting(
    view: &ViewedScene,
    around: &Surroundings,
    segment: &Segment,
    triangle: u32,
    trace: &mut Trace,
) -> Option<Change> {
    let corners = view.scene().triangles()[triangle as usize];
    let is_corner = segment.ends.map(|end| corners.contains(&end));
    if is_corner == [true; 2] {
        return None;
    }
    let sight = view.sight();
    let turn = view.triangle_turns()[triangle as usize];
    let plane = sight.triangle_plane(corners);
    let depths = segment.ends.map(|end| sight.depth_at(&plane, corners, end));
    let tolerance = around.contact_tolerance;
    if tolerance > 0.0
        && depths.iter().all(|(depth, _)| sight.may_be_within(&plane, depth, tolerance))
        && sight.in_contact(corners, segment.ends, tolerance)
        && let Some(Shadow::Covers(cover)) = shadow(view, segment, triangle, 0.0, false)
    {
        let by = cover.sides.counts();
        trace.changes.push(Change { at: cover.from, by: by.map(|n| -n) });
        trace.changes.push(Change { at: cover.to, by });
    }
    for (i, &end) in segment.ends.iter().enumerate() {
        if depths[i].1 == Sign::Zero && !is_corner[i] && is_within(view, triangle, end) {
            trace.irregular.push(end);
        }
    }
    if depths[0].1.times(depths[1].1) != Sign::Negative {
        return None;
    }
    let at = || {
        let [a, b] = depths;
        sight.cut(segment.ends, CutPlane::Triangle(corners), [a.0, b.0])
    };
    let goes_behind = depths[1].1 == turn;
    let change = piercing(view, segment.ends, triangle, goes_behind, at)?;
    is_kept(view, segment, &change.at).then_some(change)
}

/// Whether a vertex's image lies in the closed image of a triangle.
fn is_within(view: &ViewedScene, triangle: u32, vertex: u32) -> bool {
    let corners = view.scene().triangles()[triangle as usize];
    let turn = view.triangle_turns()[triangle as usize];
    (0..3).all(|side| {
        let (p, q) = (corners[side], corners[(side + 1) % 3]);
        view.sight().turn(p, q, vertex).times(turn) != Sign::Negative
    })
}

/// The change where a segment whose ends lie on both sides of a triangle's plane passes it.
fn piercing(
    view: &ViewedScene,
    ends: [u32; 2],
    triangle: u32,
    goes_behind: bool,
    at: impl Fn() -> Cut,
) -> Option<Change> {
    let corners = view.scene().triangles()[triangle as usize];
    let turn = view.triangle_turns()[triangle as usize];
    let sight = view.sight();
    let mut cut = None;
    // Whether the image just before and just after the cut lies in the triangle's.
    let (mut before, mut after) = (true, true);
    let mut along = None;
    for side in 0..3 {
        let (p, q) = (corners[side], corners[(side + 1) % 3]);
        let plane = sight.sight_plane(p, q);
        let values: [(Estimate, Sign); 2] = ends.map(|end| sight.turn_at(&plane, p, q, end));
        match values.map(|(_, sign)| sign.times(turn)) {
            [Sign::Zero, Sign::Zero] => along = Some(side),
            [Sign::Negative, Sign::Negative | Sign::Zero] | [Sign::Zero, Sign::Negative] => {
                return None;
            }
            [first @ (Sign::Negative | Sign::Positive), second] if second == first.flipped() => {
                let border = CutPlane::Sight(p.min(q), p.max(q));
                let border = sight.cut(ends, border, [values[0].0, values[1].0]);
                let order = sight.cut_order(ends, cut.get_or_insert_with(&at), &border);
                // Entering: inside after the border's cut; leaving: inside before it.
                let enters = first == Sign::Negative;
                before &=
                    if enters { order == Ordering::Greater } else { order != Ordering::Greater };
                after &= if enters { order != Ordering::Less } else { order == Ordering::Less };
                if !before && !after {
                    return None;
                }
            }
            _ => {}
        }
    }
    let counts = match along {
        Some(side) => side_of(view, ends, corners[(side + 2) % 3]),
        None => Sides::Both,
    }
    .counts();
    let step = i32::from(after && goes_behind) - i32::from(before && !goes_behind);
    let at = cut.unwrap_or_else(at);
    (step != 0).then_some(Change { at, by: counts.map(|n| n * step) })
}
