//! The shadow pyramid: which part of a segment one triangle covers.
//!
//! ```text
//!            p ●╲                 Seen from the eye, the triangle throws a shadow: a pyramid with
//!             ╱░░╲ ░░░░░          its apex in the eye, cut off by the triangle's plane. A segment
//!   A ●──────╱░░░░╲▒▒▒▒▒▒▒        is covered where it runs inside: three sides (turns) and the
//!           ╱░░░░░░╲░░░░░╲──● B   plane (depth), each an affine function of the parameter, so it
//!          ●────────●              is one interval.
//!          q        r
//! ```
//!
//! Roberts (1963) states this as linear inequalities; all of them here are signs of
//! [`crate::predicates`]. Where the near plane cuts the triangle there is a fourth side.

use super::segment::Segment;
use crate::classify::ViewedScene;
use crate::predicates::{Cut, CutPlane, Estimate, Kept, Sign};
use std::cmp::Ordering;

/// The sides of a segment, looking from its first end to its last, y up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sides {
    /// Left and right.
    Both,
    /// Left only: the segment's image runs along a border of the triangle.
    Left,
    /// Right only.
    Right,
}

impl Sides {
    /// One layer on each of these sides, left and right.
    pub(super) fn counts(self) -> [i32; 2] {
        match self {
            Self::Both => [1, 1],
            Self::Left => [1, 0],
            Self::Right => [0, 1],
        }
    }
}

/// The part of a segment that a triangle covers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cover {
    /// Where it begins.
    pub from: Cut,
    /// Where it ends, strictly after `from`.
    pub to: Cut,
    /// Which sides are covered.
    pub sides: Sides,
}

/// What one triangle does to a segment.
#[derive(Debug, Clone, Copy)]
pub(super) enum Shadow {
    /// It covers a part.
    Covers(Cover),
    /// It covers a part on one side, and its border edge between two vertices has the same image
    /// there and is nearer.
    AlongBorder(Cover, [u32; 2]),
    /// It lies in the segment's plane of sight and own plane: its border edge between two vertices
    /// has the same image and the same depth over a part.
    OnBorder(Cover, [u32; 2]),
    /// It would cover a part, but the segment lies in near contact with it.
    InContact,
}

/// The part of the parameter's range that is left between the cuts made so far.
struct Range {
    from: Cut,
    to: Cut,
}

impl Range {
    /// Keeps the part where a function with these signs at the ends is positive.
    ///
    /// Returns false when no interval is left.
    #[inline]
    fn keep(
        &mut self,
        view: &ViewedScene,
        ends: [u32; 2],
        signs: [Sign; 2],
        cut: impl FnOnce() -> Cut,
    ) -> bool {
        match signs {
            [Sign::Positive, Sign::Negative] => {
                let cut = cut();
                if view.sight().cut_order(ends, &cut, &self.to) == Ordering::Less {
                    self.to = cut;
                }
            }
            [Sign::Negative, Sign::Positive] => {
                let cut = cut();
                if view.sight().cut_order(ends, &cut, &self.from) == Ordering::Greater {
                    self.from = cut;
                }
            }
            [Sign::Negative, _] | [_, Sign::Negative] => return false,
            _ => return true,
        }
        view.sight().cut_order(ends, &self.from, &self.to) == Ordering::Less
    }
}

/// What `triangle` does to `segment`; `None` when it neither covers any of it nor shares its
/// image with it.
///
/// With `find_doubled`, triangles that only share a border's image with the segment are reported
/// too. Exact.
pub(super) fn shadow(
    view: &ViewedScene,
    segment: &Segment,
    triangle: u32,
    contact_tolerance: f64,
    find_doubled: bool,
) -> Option<Shadow> {
    let turn = view.triangle_turns()[triangle as usize];
    if turn == Sign::Zero {
        return None;
    }
    let corners = view.scene().triangles()[triangle as usize];
    let ends = segment.ends;
    if corners.contains(&ends[0]) && corners.contains(&ends[1]) {
        return None;
    }
    let sight = view.sight();
    let mut range = Range { from: segment.from, to: segment.to };
    // Depth first: it rules out all that lies behind.
    let in_plane = view.is_known_in_plane_of(segment.edge, triangle) || {
        let plane = sight.triangle_plane(corners);
        let [a, b] = ends.map(|end| sight.depth_at(&plane, corners, end));
        let signs = [a.1.times(turn), b.1.times(turn)];
        let cut = || sight.cut(ends, CutPlane::Triangle(corners), [a.0, b.0]);
        let in_plane = signs == [Sign::Zero; 2];
        if !in_plane && !range.keep(view, ends, signs, cut) {
            return None;
        }
        in_plane
    };
    if in_plane && !find_doubled {
        return None;
    }

    let (cover, border) = within_image(view, segment, triangle, range)?;
    if in_plane {
        // A segment in the triangle's plane shares its image with it only along a border.
        return border.map(|border| Shadow::OnBorder(cover, border));
    }
    if contact_tolerance > 0.0 && sight.in_contact(corners, ends, contact_tolerance) {
        return Some(Shadow::InContact);
    }
    Some(match border {
        Some(border) if find_doubled => Shadow::AlongBorder(cover, border),
        _ => Shadow::Covers(cover),
    })
}

/// The part of `segment` whose image lies in that of `triangle`, whichever of them is in front.
///
/// The triangle may have the segment as one of its sides; then it takes the whole of one side of
/// it. Exact.
pub(super) fn image_cover(view: &ViewedScene, segment: &Segment, triangle: u32) -> Option<Cover> {
    if view.triangle_turns()[triangle as usize] == Sign::Zero {
        return None;
    }
    let range = Range { from: segment.from, to: segment.to };
    within_image(view, segment, triangle, range).map(|(cover, _)| cover)
}

/// The part of `segment` that is strictly in front of `triangle` and has its image in that of it: what
/// throws a shadow on it, if this is the view of the light. `None` for the triangle's own sides. Exact.
pub(super) fn cover_of_front(
    view: &ViewedScene,
    segment: &Segment,
    triangle: u32,
) -> Option<Cover> {
    let turn = view.triangle_turns()[triangle as usize];
    let corners = view.scene().triangles()[triangle as usize];
    let ends = segment.ends;
    if turn == Sign::Zero || ends.iter().all(|end| corners.contains(end)) {
        return None;
    }
    let sight = view.sight();
    let mut range = Range { from: segment.from, to: segment.to };
    let plane = sight.triangle_plane(corners);
    let [a, b] = ends.map(|end| sight.depth_at(&plane, corners, end));
    let signs = [a.1, b.1].map(|sign| sign.times(turn).flipped());
    let cut = || sight.cut(ends, CutPlane::Triangle(corners), [a.0, b.0]);
    if signs == [Sign::Zero; 2] || !range.keep(view, ends, signs, cut) {
        return None;
    }
    within_image(view, segment, triangle, range).map(|(cover, _)| cover)
}

/// What is left of `range` within the image of what the near plane keeps of a triangle, and the
/// triangle's side whose image the segment's runs along.
#[inline]
fn within_image(
    view: &ViewedScene,
    segment: &Segment,
    triangle: u32,
    mut range: Range,
) -> Option<(Cover, Option<[u32; 2]>)> {
    let kept = view.kept(triangle);
    if kept == Kept::Nothing {
        return None;
    }
    let turn = view.triangle_turns()[triangle as usize];
    let corners = view.scene().triangles()[triangle as usize];
    let (ends, sight) = (segment.ends, view.sight());
    let mut along: Option<usize> = None;
    for side in 0..3 {
        let (p, q) = (corners[side], corners[(side + 1) % 3]);
        let plane = sight.sight_plane(p, q);
        let [a, b] = ends.map(|end| sight.turn_at(&plane, p, q, end));
        let signs = [a.1.times(turn), b.1.times(turn)];
        if signs == [Sign::Zero; 2] {
            along = Some(side);
        } else {
            let cut = || sight.cut(ends, CutPlane::Sight(p.min(q), p.max(q)), [a.0, b.0]);
            if !range.keep(view, ends, signs, cut) {
                return None;
            }
        }
    }

    let mut kept_beside_cut = None;
    if let Kept::Part(corner_signs) = kept {
        let signs = sight.near_cut(corners, ends).map(|sign| sign.times(turn.flipped()));
        if signs == [Sign::Zero; 2] {
            kept_beside_cut = corner_signs.iter().position(|&sign| sign == Sign::Positive);
        } else {
            // The exact path was needed for the signs, so there are no estimates to start from.
            let unknown = Estimate { value: 0.0, error: f64::INFINITY };
            let cut = || sight.cut(ends, CutPlane::NearCut(corners), [unknown; 2]);
            if !range.keep(view, ends, signs, cut) {
                return None;
            }
        }
    }

    let sides = match along.map(|side| (side + 2) % 3).or(kept_beside_cut) {
        Some(corner) => side_of(view, ends, corners[corner]),
        None => Sides::Both,
    };
    let cover = Cover { from: range.from, to: range.to, sides };
    Some((cover, along.map(|side| [corners[side], corners[(side + 1) % 3]])))
}

/// The side of the segment's image on which a vertex lies that is not on it.
pub(super) fn side_of(view: &ViewedScene, ends: [u32; 2], vertex: u32) -> Sides {
    match view.sight().turn(ends[0], ends[1], vertex) {
        Sign::Positive => Sides::Left,
        _ => Sides::Right,
    }
}
