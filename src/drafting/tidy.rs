//! From exact pieces to clean strokes: pieces that belong together are joined, and pieces that nobody would
//! miss are left out.
//!
//! | step | does |
//! |---|---|
//! | stitch | joins ends that continue into each other; see [`stitch`](super::stitch) |
//! | corners | joins two ends that meet with no third one near |
//! | shadows | leaves out short strokes that lie beside longer ink |
//! | specks, spurs | leaves out small isolated figures, and short strokes with a loose end |
//!
//! The order matters: pieces that are not joined first would be dropped one by one. An outline is never
//! opened, and borders and closed figures stay.

use std::cmp::Reverse;

use glam::DVec2;
use rayon::prelude::*;

use crate::disjoint_sets::DisjointSets;
use crate::strokes::StrokeKind;
use crate::strokes::draft::{Draft, DraftPoint, extent, is_closed, length};

use super::Paper;
use super::background::BackgroundFinder;
use super::edits::{Edits, Ends, Tidied};
use super::inked::Inked;
use super::near::{Parts, ROUNDING, part_within};
use super::near_ends::SegmentsNearEnds;
use super::stitch::stitch;

/// Most rounds of stitching: what was joined may be joined again.
const ROUNDS: usize = 3;

/// A short stroke is no longer than this many times its greatest extent.
const MOST_CURLED: f64 = 3.0;

/// Strokes with more outline than this share of their length are not left out.
const MOST_OUTLINE: f64 = 0.3;

/// Loops at least this large are figures, not specks.
const LOOP_MM: f64 = 1.0;

/// After parts were left out, ends of hidden lines this near to each other are joined, in millimeters.
const JOINT_MM: f64 = 0.05;

/// Strokes smaller than this are left out where all of their middle lies under longer ones, in millimeters.
const COVERED_MM: f64 = 3.0;

/// Ends this near to each other close a loop.
const CLOSED_MM: f64 = 0.05;

/// Joins and cleans the strokes of a draft. Strokes whose extent is below `shortest` are left out last.
///
/// Without a background nothing is known of outlines. O(points), in parallel.
pub(super) fn tidy(
    draft: Draft,
    paper: &Paper,
    background: Option<&BackgroundFinder>,
    shortest: f64,
    tidied: &mut Tidied,
) -> Draft {
    let mut inked = Inked::new(draft, paper, paper.pen);
    join_ends(&mut inked, tidied);
    corners(&mut inked, tidied);
    shadows(&mut inked, &[(paper.figure, paper.pen)], tidied);
    join_ends(&mut inked, tidied);
    specks_and_spurs(&mut inked, background, tidied);
    corners(&mut inked, tidied);
    shadows(&mut inked, &[(paper.figure, paper.pen)], tidied);
    join_ends(&mut inked, tidied);
    leave_out_shorter(&mut inked, shortest, tidied);
    inked.into_draft()
}

/// Joins what continues into each other after parts were left out, around corners too, and leaves out
/// what is lost without being missed.
///
/// Of hidden lines only ends that touch are joined: to cross the gap where a part was left out is to draw it
/// again. Visible ones are joined as before: fewer strokes are worth a pen width drawn twice.
pub(super) fn rejoin(
    draft: Draft,
    paper: &Paper,
    background: &BackgroundFinder,
    shortest: f64,
    tidied: &mut Tidied,
) -> Draft {
    let mut joined = Tidied::default();
    let [visible, hidden] = draft.by_visibility();
    let mut visible = Inked::new(visible, paper, paper.pen);
    let mut hidden = Inked::new(hidden, paper, JOINT_MM * paper.mm);
    for inked in [&mut visible, &mut hidden] {
        join_ends(inked, &mut joined);
        corners(inked, &mut joined);
    }
    shadows(&mut visible, &[(paper.figure, paper.pen)], tidied);
    specks_and_spurs(&mut visible, Some(background), tidied);
    leave_out_shorter(&mut visible, shortest, tidied);
    let mut all = visible.into_draft();
    all.append(hidden.draft());
    let mut all = Inked::new(all, paper, paper.pen);
    let covered = (COVERED_MM * paper.mm, 0.5 * paper.pen);
    shadows(&mut all, &[(paper.figure, paper.pen), covered], tidied);
    all.into_draft()
}

/// Stitches until nothing joins.
fn join_ends(inked: &mut Inked, tidied: &mut Tidied) {
    let mut rounds = 0..ROUNDS;
    while rounds.next().is_some() && stitch(inked, tidied) {}
}

/// Joins two ends near each other, whatever the turn, if no third one is there.
fn corners(inked: &mut Inked, tidied: &mut Tidied) {
    let (draft, paper) = (inked.draft(), inked.paper());
    let ends = Ends::new(draft);
    let near_ends = inked.near_ends(&ends);
    let n_ends = 2 * draft.len() as u32;
    // The only other end near each, if there is one.
    let only: Vec<Option<u32>> = (0..n_ends)
        .into_par_iter()
        .with_min_len(64)
        .map(|end| {
            if !ends.has(end / 2) {
                return None;
            }
            let (mut found, mut is_only) = (None, true);
            for_each_end_near(end, draft, near_ends, &ends, inked.joint(), |other| {
                is_only &= found.is_none_or(|known| known == other);
                found = Some(other);
            });
            found.filter(|_| is_only)
        })
        .collect();
    let mut edits = Edits::new(draft);
    let mut n_joined = 0;
    for (end, other) in (0..n_ends).zip(&only) {
        if let Some(other) = other.filter(|&other| end < other && only[other as usize] == Some(end))
        {
            // A stroke this short would become a dot.
            let is_dot = other == end ^ 1 && ends.length(end / 2) <= 2.0 * paper.pen;
            if !is_dot {
                edits.join(end, other);
                n_joined += 1;
                tidied.farthest = tidied.farthest.max(ends.at(end).distance(ends.at(other)));
            }
        }
    }
    tidied.n_joined += n_joined;
    if n_joined > 0 {
        let joined = edits.apply(draft);
        inked.change(joined);
    }
}

/// Calls `f` with the ends within `reach` of an end, some more than once.
fn for_each_end_near(
    end: u32,
    draft: &Draft,
    near_ends: &SegmentsNearEnds,
    ends: &Ends,
    reach: f64,
    mut f: impl FnMut(u32),
) {
    let at = ends.at(end);
    for &segment in near_ends.of(end) {
        let stroke = near_ends.stroke(segment);
        for (side, point) in [(0, segment), (1, segment + 1)] {
            let other = 2 * stroke + side;
            if other != end
                && ends.point(other) == point
                && ends.has(stroke)
                && at.distance(draft.points()[point as usize].at) <= reach
            {
                f(other);
            }
        }
    }
}

/// Leaves out short strokes all of which lies beside longer ones that stay: strokes below an extent within
/// a reach. Visible strokes never make way for hidden ones.
fn shadows(inked: &mut Inked, extents: &[(f64, f64)], tidied: &mut Tidied) {
    let draft = inked.draft();
    let lengths: Vec<f64> = draft.iter().map(length).collect();
    let reach = |stroke: usize| {
        let extent = extent(draft.stroke(stroke));
        let is_below = |most: f64| extent < most && lengths[stroke] < MOST_CURLED * most;
        extents.iter().find(|&&(most, _)| is_below(most)).map(|&(_, reach)| reach)
    };
    if !(0..draft.len()).any(|stroke| reach(stroke).is_some()) {
        return;
    }
    let (points, grid) = (draft.points(), inked.grid());
    let is_visible = |stroke: usize| draft.stroke(stroke)[0].mark.qi == 0;
    let rank = |stroke: usize| (is_visible(stroke), lengths[stroke], Reverse(stroke));
    let is_covered = |stroke: usize, reach: f64, left_out: &[bool], parts: &mut Parts| {
        draft.range(stroke).skip(1).all(|i| {
            let segment = [points[i - 1].at, points[i].at];
            parts.clear();
            grid.near(segment[0], segment[1], reach, |other| {
                let of = grid.stroke(other) as usize;
                if rank(of) > rank(stroke) && !left_out[of] {
                    let other = [other, other + 1].map(|k| points[k as usize].at);
                    if let Some((t0, t1)) = part_within(segment, other, reach) {
                        parts.add(t0, t1);
                    }
                }
            });
            matches!(parts.join(ROUNDING), [(from, to)] if *from <= ROUNDING && *to >= 1.0 - ROUNDING)
        })
    };
    let mut left_out = vec![false; draft.len()];
    let mut covered: Vec<(usize, f64)> = (0..draft.len())
        .into_par_iter()
        .with_min_len(64)
        .map_init(Parts::default, |parts, stroke| {
            let reach = reach(stroke)?;
            is_covered(stroke, reach, &left_out, parts).then_some((stroke, reach))
        })
        .flatten_iter()
        .collect();
    // What is left out covers nothing: longest first.
    covered.sort_by(|a, b| lengths[b.0].total_cmp(&lengths[a.0]).then(a.0.cmp(&b.0)));
    let mut parts = Parts::default();
    for (stroke, reach) in covered {
        left_out[stroke] = is_covered(stroke, reach, &left_out, &mut parts);
    }
    leave_out(inked, &left_out, tidied);
}

/// Leaves out small isolated figures, and short strokes with a loose end. One pass: what a stroke hung
/// on is not left out next.
fn specks_and_spurs(inked: &mut Inked, background: Option<&BackgroundFinder>, tidied: &mut Tidied) {
    let (draft, paper) = (inked.draft(), inked.paper());
    // Only of what could be left out need be known what it is.
    let is_small = |points: &[DraftPoint]| {
        extent(points) < paper.figure && !is_border(points) && !is_loop(points, paper)
    };
    if !draft.iter().any(is_small) {
        return;
    }
    let small = draft.iter().filter(|points| is_small(points));
    let background = background.map(|background| background.beside(small));
    let ends = Ends::new(draft);
    let near_ends = inked.near_ends(&ends);
    // Strokes near each end; they may repeat.
    let near: Vec<Vec<u32>> = (0..2 * draft.len() as u32)
        .into_par_iter()
        .with_min_len(64)
        .map(|end| {
            let mut near = Vec::new();
            if ends.has(end / 2) {
                let at = ends.at(end);
                for &segment in near_ends.of(end) {
                    let other = near_ends.stroke(segment);
                    let ends = [segment, segment + 1].map(|k| draft.points()[k as usize].at);
                    let is_new = other != end / 2 && near.last() != Some(&other);
                    if is_new && part_within([at, at], ends, paper.pen).is_some() {
                        near.push(other);
                    }
                }
            }
            near
        })
        .collect();
    let mut figures = DisjointSets::new(draft.len());
    let mut is_loose: Vec<bool> = near.iter().map(Vec::is_empty).collect();
    for crowd in near_ends.crowds() {
        for &end in crowd {
            is_loose[end as usize] = false;
            figures.unite(crowd[0] / 2, end / 2);
        }
    }
    for (end, near) in near.iter().enumerate() {
        for &other in near {
            figures.unite(end as u32 / 2, other);
        }
    }
    let first = |stroke: usize| draft.stroke(stroke)[0].at;
    let mut boxes: Vec<(DVec2, DVec2)> = (0..draft.len()).map(|s| (first(s), first(s))).collect();
    for (stroke, points) in draft.iter().enumerate() {
        let (low, high) = &mut boxes[figures.of(stroke as u32) as usize];
        for point in points {
            (*low, *high) = (low.min(point.at), high.max(point.at));
        }
    }
    let holds: Vec<bool> = draft
        .iter()
        .collect::<Vec<_>>()
        .into_par_iter()
        .with_min_len(64)
        .map(|points| {
            !is_small(points)
                || background.as_ref().is_some_and(|b| b.share_beside(points) > MOST_OUTLINE)
        })
        .collect();
    let mut figure_holds = vec![false; draft.len()];
    for stroke in 0..draft.len() {
        figure_holds[figures.of(stroke as u32) as usize] |= holds[stroke];
    }
    let mut is_left_out = |stroke: usize| {
        let figure = figures.of(stroke as u32) as usize;
        let (low, high) = boxes[figure];
        let is_speck = low.distance(high) < paper.figure && !figure_holds[figure];
        let is_loose = is_loose[2 * stroke] || is_loose[2 * stroke + 1];
        let is_spur = !holds[stroke] && ends.has(stroke as u32) && is_loose;
        is_speck || is_spur
    };
    let left_out: Vec<bool> = (0..draft.len()).map(&mut is_left_out).collect();
    leave_out(inked, &left_out, tidied);
}

/// Whether a stroke has a part that ends a surface, or that the model has as a line of its own.
fn is_border(points: &[DraftPoint]) -> bool {
    let border = [StrokeKind::Boundary, StrokeKind::Nonmanifold, StrokeKind::Wire];
    points.iter().any(|point| border.contains(&point.mark.kind))
}

/// Whether a stroke goes around something that can be seen on paper.
fn is_loop(points: &[DraftPoint], paper: &Paper) -> bool {
    let [first, .., last] = points else { return false };
    let extent = extent(points);
    let gap = first.at.distance(last.at);
    let twice = |pair: &[DraftPoint]| (pair[0].at - first.at).perp_dot(pair[1].at - first.at);
    let area = 0.5 * points.windows(2).map(twice).sum::<f64>().abs();
    (is_closed(points) || gap <= CLOSED_MM * paper.mm)
        && extent >= LOOP_MM * paper.mm
        && area >= paper.pen * extent
}

/// Leaves out the strokes whose extent is below `shortest`.
fn leave_out_shorter(inked: &mut Inked, shortest: f64, tidied: &mut Tidied) {
    let is_short: Vec<bool> =
        inked.draft().iter().map(|points| extent(points) < shortest).collect();
    leave_out(inked, &is_short, tidied);
}

/// Leaves out the strokes of which `is_left_out` says so.
fn leave_out(inked: &mut Inked, is_left_out: &[bool], tidied: &mut Tidied) {
    if !is_left_out.contains(&true) {
        return;
    }
    let draft = inked.draft();
    let mut edits = Edits::new(draft);
    for (stroke, points) in draft.iter().enumerate().filter(|(stroke, _)| is_left_out[*stroke]) {
        edits.drop(stroke);
        tidied.n_dropped += 1;
        tidied.dropped += length(points);
    }
    let rest = edits.apply(draft);
    inked.change(rest);
}
