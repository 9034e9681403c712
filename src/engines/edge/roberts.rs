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
//! * instead of all pairs, an index over the image finds the triangles near an edge, and covered
//!   cells drop everything behind them (W. R. Franklin, "A linear time
//!   exact hidden surface algorithm", SIGGRAPH 1980);
//! * his first step, to leave out what faces away from the eye, is taken only where it is safe (module
//!   `back_faces`);
//! * each side of a line is covered separately, so that symmetric views come out right.
//!
//! Exact, and simple enough to check the other engines.
//!
//! Coherence: object coherence, in the index over the image (boxes stand for faces) and in the first
//! step (a body's front faces stand for its back faces); area coherence, in covered cells. Nothing is
//! carried from one edge to the next.

use super::back_faces::BackFaces;
use super::index::{ImageIndex, Visitor};
use super::segment::Segment;
use super::shadow::{Shadow, Sides, shadow};
use super::sweep::Sweep;
use super::{LineCounts, VisibilityOptions};
use crate::classify::{SelectedLine, ViewedScene};
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
pub fn solve(view: &ViewedScene, options: &VisibilityOptions) -> (Visibility, LineCounts) {
    let back_faces = BackFaces::new(view, options);
    solve_without(&back_faces, view, options, &segments(view, None))
}

/// Finds the spans of some segments of `view`, in their order.
pub(super) fn solve_segments(
    view: &ViewedScene,
    options: &VisibilityOptions,
    segments: &[Option<Segment>],
) -> (Visibility, LineCounts) {
    solve_without(&BackFaces::default(), view, options, segments)
}

fn solve_without(
    back_faces: &BackFaces,
    view: &ViewedScene,
    options: &VisibilityOptions,
    segments: &[Option<Segment>],
) -> (Visibility, LineCounts) {
    let index = ImageIndex::new(view, segments.iter().flatten(), options, back_faces);
    let (visibility, counts) =
        run(view, options, segments, Some((&index, back_faces)), Asked::Layers);
    (visibility, LineCounts { back_faces: back_faces.n_faces(), ..counts })
}

/// Finds the same spans by testing every edge against every triangle. O(edges × triangles).
pub fn solve_all_pairs(
    view: &ViewedScene,
    options: &VisibilityOptions,
) -> (Visibility, LineCounts) {
    run(view, options, &segments(view, None), None, Asked::Layers)
}

/// Finds where each drawn line of `view` is hidden on one of its sides and not on the other: there spans
/// have `qi` 0, and 1 elsewhere.
///
/// In the light's view these are the borders of shadows.
pub fn solve_borders(view: &ViewedScene, options: &VisibilityOptions) -> Visibility {
    let (back_faces, segments) = (BackFaces::default(), segments(view, None));
    let index = ImageIndex::new(view, segments.iter().flatten(), options, &back_faces);
    run(view, options, &segments, Some((&index, &back_faces)), Asked::Borders).0
}

/// What spans tell.
#[derive(Debug, Clone, Copy)]
enum Asked {
    /// Quantitative invisibility.
    Layers,
    /// 0 where one side is hidden and the other is not, else 1.
    Borders,
}

/// The drawn lines as segments; all of them, or those at some places of the list.
pub(super) fn segments(view: &ViewedScene, wanted: Option<&[u32]>) -> Vec<Option<Segment>> {
    let drawn = view.selected();
    let segment = |line: &SelectedLine| Segment::new(view, line.edge);
    match wanted {
        None => drawn.par_iter().map(segment).collect(),
        Some(wanted) => wanted.par_iter().map(|&i| segment(&drawn[i as usize])).collect(),
    }
}

fn run(
    view: &ViewedScene,
    options: &VisibilityOptions,
    segments: &[Option<Segment>],
    shortcuts: Option<(&ImageIndex, &BackFaces)>,
    asked: Asked,
) -> (Visibility, LineCounts) {
    let (index, back_faces) = shortcuts.unzip();
    let clippers: Mutex<Vec<Clipper>> = Mutex::new(Vec::new());
    let parts: Vec<(Visibility, LineCounts)> = segments
        .par_chunks(CHUNK)
        .map(|chunk| {
            let idle = clippers.lock().ok().and_then(|mut idle| idle.pop());
            let mut clipper = idle.unwrap_or_else(|| Clipper::new(index));
            let mut counts = LineCounts::default();
            let mut visibility = Visibility::default();
            for segment in chunk {
                match segment {
                    Some(segment) if back_faces.is_some_and(|faces| faces.hides(segment)) => {
                        counts.back_edges += 1;
                        visibility.push(&[hidden(segment)]);
                    }
                    Some(segment) => {
                        let spans =
                            clipper.clip(view, options, segment, shortcuts, asked, &mut counts);
                        visibility.push(spans);
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
    let mut counts = LineCounts::default();
    for (part, part_counts) in &parts {
        visibility.append(part);
        counts.candidate_pairs += part_counts.candidate_pairs;
        counts.back_edges += part_counts.back_edges;
    }
    (visibility, counts)
}

/// All of a segment, hidden.
fn hidden(segment: &Segment) -> Span {
    Span { t0: segment.from.t, t1: segment.to.t, qi: 1, doubled: false }
}

/// Work space of one thread.
struct Clipper {
    sweep: Sweep,
    visitor: Visitor,
    /// Back faces to be tested if the segment is in contact with a front face.
    waiting: Vec<u32>,
}

impl Clipper {
    fn new(index: Option<&ImageIndex>) -> Self {
        Self { sweep: Sweep::default(), visitor: Visitor::new(index), waiting: Vec::new() }
    }

    fn clip(
        &mut self,
        view: &ViewedScene,
        options: &VisibilityOptions,
        segment: &Segment,
        shortcuts: Option<(&ImageIndex, &BackFaces)>,
        asked: Asked,
        counts: &mut LineCounts,
    ) -> &[Span] {
        let Self { sweep, visitor, waiting } = self;
        sweep.clear();
        waiting.clear();
        let mut is_in_contact = false;
        let mut test = |triangle, sweep: &mut Sweep| {
            counts.candidate_pairs += 1;
            let effect = clip_by(view, options, segment, triangle, sweep);
            is_in_contact |= effect == Effect::InContact;
            effect == Effect::HidesAll
        };
        let mut wholly_hidden = match shortcuts {
            Some((index, back_faces)) => {
                let test = |triangle| {
                    if back_faces.holds(triangle) {
                        waiting.push(triangle);
                        false
                    } else {
                        test(triangle, sweep)
                    }
                };
                index.hides(segment) || visitor.any(index, view, segment, test)
            }
            None => {
                (0..view.scene().triangles().len() as u32).any(|triangle| test(triangle, sweep))
            }
        };
        if is_in_contact && !wholly_hidden {
            wholly_hidden = waiting.iter().any(|&triangle| {
                counts.candidate_pairs += 1;
                clip_by(view, options, segment, triangle, sweep) == Effect::HidesAll
            });
        }
        if wholly_hidden {
            return sweep.only(hidden(segment));
        }
        match asked {
            Asked::Layers => sweep.spans(view.sight(), segment, options.count_layers),
            Asked::Borders => sweep.spans_by(view.sight(), segment, |[left, right]| {
                u32::from((left > 0) == (right > 0))
            }),
        }
    }
}

/// What one triangle did to a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Effect {
    /// It hides all of it, and layers are not counted.
    HidesAll,
    /// It would hide some, but is in contact with it.
    InContact,
    /// Any other, in the sweep.
    Added,
}

/// Adds the effect of one triangle on a segment.
fn clip_by(
    view: &ViewedScene,
    options: &VisibilityOptions,
    segment: &Segment,
    triangle: u32,
    sweep: &mut Sweep,
) -> Effect {
    let (cover, border) =
        match shadow(view, segment, triangle, options.contact_tolerance, options.find_doubled) {
            None => return Effect::Added,
            Some(Shadow::InContact) => return Effect::InContact,
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
    let Some(cover) = cover else { return Effect::Added };
    let is_whole = |plane| plane == CutPlane::End || plane == CutPlane::Near;
    if !options.count_layers
        && cover.sides == Sides::Both
        && is_whole(cover.from.plane)
        && is_whole(cover.to.plane)
    {
        return Effect::HidesAll;
    }
    sweep.add_cover(&cover);
    Effect::Added
}
