//! Roberts: every drawn edge is clipped by every triangle that may be in front of it.
//!
//! L. G. Roberts, "Machine perception of three-dimensional solids" (1963). A triangle's shadow is
//! a pyramid of sight planes cut off by the triangle's own plane; an edge is hidden where it runs
//! inside one. Each triangle gives at most one interval, and the hidden parts are their union:
//!
//! ```text
//!   triangle 1      ├──────────┤
//!   triangle 2             ├─────────────┤
//!   hidden          ├────────────────────┤
//!   visible    ●────┤                    ├──────●
//! ```
//!
//! Differs from the paper in:
//! * bodies need not be convex or closed: polygons are covered by their triangles;
//! * instead of all pairs, an index over the images offers the triangles near an edge, and cells
//!   that one triangle covers wholly drop all that lies behind it (W. R. Franklin, "A linear time
//!   exact hidden surface algorithm", SIGGRAPH 1980);
//! * a line is covered on each of its two sides apart, so that symmetric views come out right.
//!
//! Exact, and so simple that the other engines are measured against it.
//!
//! Coherence: none carried from edge to edge; the index of images uses object coherence (boxes stand
//! for faces).

use super::index::{ImageIndex, Visitor};
use super::segment::Segment;
use super::shadow::{Shadow, Sides, shadow};
use super::sweep::Sweep;
use super::{Counts, Settings};
use crate::classify::ViewedScene;
use crate::engines::visibility::{Span, Visibility};
use crate::predicates::CutPlane;
use rayon::prelude::*;
use std::sync::Mutex;

/// How many segments make one piece of parallel work.
const CHUNK: usize = 512;

/// Finds the spans of all drawn edges of `view`, in their order.
///
/// Expected cost: the triangles, once, for the index, and for each edge the triangles near its
/// image that no single nearer triangle hides.
pub fn solve(view: &ViewedScene, settings: &Settings) -> (Visibility, Counts) {
    solve_segments(view, settings, &segments(view))
}

/// Finds the spans of some segments of `view`, in their order.
pub(super) fn solve_segments(
    view: &ViewedScene,
    settings: &Settings,
    segments: &[Option<Segment>],
) -> (Visibility, Counts) {
    let index = ImageIndex::new(view, segments.iter().flatten(), settings);
    run(view, settings, segments, Some(&index))
}

/// Finds the same spans by testing every edge against every triangle. O(edges × triangles).
pub fn solve_all_pairs(view: &ViewedScene, settings: &Settings) -> (Visibility, Counts) {
    run(view, settings, &segments(view), None)
}

/// The drawn edges as segments.
pub(super) fn segments(view: &ViewedScene) -> Vec<Option<Segment>> {
    view.selected().par_iter().map(|drawn| Segment::new(view, drawn.edge)).collect()
}

fn run(
    view: &ViewedScene,
    settings: &Settings,
    segments: &[Option<Segment>],
    index: Option<&ImageIndex>,
) -> (Visibility, Counts) {
    let clippers: Mutex<Vec<Clipper>> = Mutex::new(Vec::new());
    let parts: Vec<(Visibility, Counts)> = segments
        .par_chunks(CHUNK)
        .map(|chunk| {
            let idle = clippers.lock().ok().and_then(|mut idle| idle.pop());
            let mut clipper = idle.unwrap_or_else(|| Clipper::new(index));
            let mut counts = Counts::default();
            let mut visibility = Visibility::default();
            for segment in chunk {
                match segment {
                    Some(segment) => {
                        visibility.push(clipper.clip(view, settings, segment, index, &mut counts))
                    }
                    None => visibility.push(&[]),
                }
            }
            if let Ok(mut idle) = clippers.lock() {
                idle.push(clipper);
            }
            (visibility, counts)
        })
        .collect();
    let mut visibility = Visibility::default();
    let mut counts = Counts::default();
    for (part, part_counts) in &parts {
        visibility.append(part);
        counts.candidate_pairs += part_counts.candidate_pairs;
    }
    (visibility, counts)
}

/// Work space of one thread.
struct Clipper {
    sweep: Sweep,
    visitor: Visitor,
}

impl Clipper {
    fn new(index: Option<&ImageIndex>) -> Self {
        Self { sweep: Sweep::default(), visitor: Visitor::new(index) }
    }

    fn clip(
        &mut self,
        view: &ViewedScene,
        settings: &Settings,
        segment: &Segment,
        index: Option<&ImageIndex>,
        counts: &mut Counts,
    ) -> &[Span] {
        let sweep = &mut self.sweep;
        sweep.clear();
        let mut test = |triangle| {
            counts.candidate_pairs += 1;
            clip_by(view, settings, segment, triangle, sweep)
        };
        let wholly_hidden = match index {
            Some(index) => {
                index.hides(segment) || self.visitor.any(index, view, segment, &mut test)
            }
            None => (0..view.scene().triangles().len() as u32).any(test),
        };
        if wholly_hidden {
            let span = Span { t0: segment.from.t, t1: segment.to.t, qi: 1, doubled: false };
            return sweep.only(span);
        }
        sweep.spans(view.sight(), segment, settings.count_layers)
    }
}

/// Adds what one triangle does to a segment; true when it hides the whole of it and that is all
/// that is asked.
fn clip_by(
    view: &ViewedScene,
    settings: &Settings,
    segment: &Segment,
    triangle: u32,
    sweep: &mut Sweep,
) -> bool {
    let (cover, border) =
        match shadow(view, segment, triangle, settings.contact_tolerance, settings.find_doubled) {
            None => return false,
            Some(Shadow::Covers(cover)) => (Some(cover), None),
            Some(Shadow::AlongBorder(cover, border)) => (Some(cover), Some((cover, border, false))),
            Some(Shadow::OnBorder(cover, border)) => (None, Some((cover, border, true))),
        };
    if let Some((cover, [p, q], same_depth)) = border
        && let Some(other) = view.scene().topology().find_edge(p, q)
        && other != segment.edge
        && view.is_selected(other)
        && (!same_depth || other < segment.edge)
    {
        sweep.add_doubled(&cover);
    }
    let Some(cover) = cover else { return false };
    let is_whole = |plane| plane == CutPlane::End || plane == CutPlane::Near;
    if !settings.count_layers
        && cover.sides == Sides::Both
        && is_whole(cover.from.plane)
        && is_whole(cover.to.plane)
    {
        return true;
    }
    sweep.add_cover(&cover);
    false
}
