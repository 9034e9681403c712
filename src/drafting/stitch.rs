//! Joins ends that a drafter would draw through.
//!
//! ```text
//!   (a)  ──────╴ ╶──────        two ends near each other that continue into each other
//!
//!            ╱ stub
//!   (b)  ───●───────            a stroke ends on another one (●), which ends a little farther on,
//!          ╱                    and run back from there the other one continues the first: the
//!         ╱ E                   stub is cut off, and the rest is joined to E
//! ```
//!
//! The silhouette of a mesh zigzags along facets and hides itself at every other fold, which breaks it into
//! such pieces.

use glam::DVec2;
use rayon::prelude::*;

use super::Paper;
use super::edits::{Edits, Ends, Tidied};
use super::inked::{Inked, ON_STROKE_MM};
use super::near_ends::SegmentsNearEnds;

/// Strokes continue into each other when they turn less than this.
const MAX_TURN_DEG: f64 = 60.0;

/// The direction at an end is that of the last stretch of this length.
const DIRECTION_MM: f64 = 0.5;

/// Stubs are no longer than this many pen widths, whatever is beside them.
const SHORT_STUB: f64 = 2.0;

/// Stubs that run beside the stroke which ends on them may have this many.
const LONG_STUB: f64 = 10.0;

/// A full turn makes a joint as bad as a gap of twice this.
const TURN_MM: f64 = 0.1;

/// A joint of two ends, and what is cut off for it.
struct Joint {
    /// The gap or the stub, and something for the turn: the smallest is made first.
    badness: f64,
    has_stub: bool,
    ends: [u32; 2],
    /// Cut off at the second end.
    stub: f64,
    gap: f64,
}

/// Joins what can be joined, and says whether that was anything. Each end is joined once.
/// O(points near ends), in parallel.
pub(super) fn stitch(inked: &mut Inked, tidied: &mut Tidied) -> bool {
    let draft = inked.draft();
    let ends = Ends::new(draft);
    let near_ends = inked.near_ends(&ends);
    let mut joints: Vec<Joint> = (0..2 * draft.len() as u32)
        .into_par_iter()
        .with_min_len(64)
        .filter(|&end| ends.has(end / 2))
        .flat_map_iter(|end| joints_at(end, inked, near_ends, &ends))
        .collect();
    let key = |joint: &Joint| (joint.has_stub, joint.ends);
    joints.sort_unstable_by(|a, b| a.badness.total_cmp(&b.badness).then(key(a).cmp(&key(b))));
    let mut edits = Edits::new(draft);
    let mut n_joined = 0;
    for joint in &joints {
        let [a, b] = joint.ends;
        if edits.is_joined(a) || edits.is_joined(b) {
            continue;
        }
        edits.join(a, b);
        if joint.has_stub {
            edits.cut(b, joint.stub);
        }
        n_joined += 1;
        tidied.farthest = tidied.farthest.max(joint.gap);
    }
    tidied.n_joined += n_joined;
    if n_joined > 0 {
        let joined = edits.apply(draft);
        inked.change(joined);
    }
    n_joined > 0
}

fn joints_at(end: u32, inked: &Inked, near_ends: &SegmentsNearEnds, ends: &Ends) -> Vec<Joint> {
    let paper = inked.paper();
    let at = ends.at(end);
    let out = ends.outward(end, DIRECTION_MM * paper.mm);
    let cos_turn = libm::cos(MAX_TURN_DEG.to_radians());
    let badness = |length: f64, cos: f64| length + TURN_MM * paper.mm * (1.0 - cos);
    let mut joints: Vec<Joint> = Vec::new();
    let points = inked.draft().points();
    for &segment in near_ends.of(end) {
        let other = near_ends.stroke(segment);
        if !ends.has(other) {
            continue;
        }
        // Two ends, found from the one with the smaller number.
        for (side, point) in [(0, segment), (1, segment + 1)] {
            let other_end = 2 * other + side;
            if other_end > end && ends.point(other_end) == point {
                let gap = at.distance(points[point as usize].at);
                let cos = -out.dot(ends.outward(other_end, DIRECTION_MM * paper.mm));
                if gap <= inked.joint() && cos >= cos_turn {
                    let badness = badness(gap, cos);
                    let ends = [end, other_end];
                    joints.push(Joint { badness, has_stub: false, ends, stub: 0.0, gap });
                }
            }
        }
        if other == end / 2 {
            continue;
        }
        let (from, to) = (points[segment as usize].at, points[segment as usize + 1].at);
        let along = to - from;
        let t = ((at - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let foot = from.lerp(to, t);
        if at.distance(foot) > ON_STROKE_MM * paper.mm {
            continue;
        }
        let before = ends.along(segment) + t * along.length();
        let whole = ends.length(other);
        for (side, stub) in [(0, before), (1, whole - before)] {
            let away = if side == 0 { along } else { -along };
            let cos = out.dot(away.normalize_or_zero());
            let is_short = stub <= SHORT_STUB * paper.pen;
            let is_stub = stub > 0.0
                && stub < 0.5 * whole
                && cos >= cos_turn
                && (is_short || stub <= LONG_STUB * paper.pen)
                && (is_short || runs_beside(end, 2 * other + side, stub, ends, paper));
            if is_stub {
                let badness = badness(stub, cos);
                let ends = [end, 2 * other + side];
                joints.push(Joint { badness, has_stub: true, ends, stub, gap: at.distance(foot) });
            }
        }
    }
    joints
}

/// Whether the last `stub` of the stroke at `other` lies within a pen width of the last part of the
/// stroke at `end`.
fn runs_beside(end: u32, other: u32, stub: f64, ends: &Ends, paper: &Paper) -> bool {
    let reach = 2.0 * stub + paper.pen;
    let near = || ends.inward(end).take_while(|&(_, along)| along <= reach).map(|(at, _)| at);
    let is_near = |p: DVec2| {
        let mut segments = near().zip(near().skip(1));
        segments.any(|(a, b)| distance(p, a, b) <= paper.pen)
    };
    ends.inward(other).take_while(|&(_, along)| along <= stub).all(|(at, _)| is_near(at))
}

fn distance(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    p.distance(if t.is_nan() { a } else { a.lerp(b, t) })
}
