//! Stroke order: which stroke comes next, at which end it begins, and where closed strokes begin.
//!
//! A nearest-neighbor route first gives each closed stroke a seam, the point nearest to the stroke
//! before it. `greedy` then builds the real route and `tour` shortens it; with better seams it is
//! shortened once more.

use std::time::Instant;

use glam::DVec2;
use rayon::prelude::*;

use super::graph::NONE;
use super::greedy::greedy;
use super::nearest::NearestPoints;
use super::tour::Tour;
use super::{Effort, Watch};
use crate::plot::Polylines;

/// Ends each end may be linked to in the search.
const N_NEIGHBORS: usize = 10;
/// Points of a closed stroke that the nearest-neighbor route tries as its seam. All of them are tried
/// later.
const N_SEAMS: usize = 16;
/// How often the route is shortened if there are closed strokes, each time with better seams.
const ROUNDS: usize = 2;
/// Longest runs of strokes that a move may reverse, one pass each: cheap moves come first, and no move
/// takes longer than a millisecond on any drawing.
const MAX_TURNS: [usize; 3] = [1_000, 10_000, 100_000];
/// The same for random changes, which act within a small neighborhood.
const MAX_TURN_ITERATED: usize = 1_000;

/// Strokes in drawing order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ordered {
    /// The strokes, turned around and with seams moved as needed.
    pub lines: Polylines,
    /// Random changes tried by the search.
    pub n_changes: u64,
}

/// Orders `lines` for short pen-up travel. Of the route's two ends, the one nearer to the page's origin
/// comes first.
///
/// Deterministic unless `effort` is [`Effort::Within`]. O(n log n) plus the search that [`Effort`]
/// describes; about 200 bytes for each stroke.
pub fn order(lines: &Polylines, effort: Effort) -> Ordered {
    order_watched(lines.clone(), effort, &mut |_| ())
}

/// As [`order`], and reports the share of the work that is done.
pub(super) fn order_watched(lines: Polylines, effort: Effort, watch: &mut Watch<'_>) -> Ordered {
    if effort == Effort::None || lines.len() < 2 {
        return Ordered { lines, n_changes: 0 };
    }
    let begun = Instant::now();
    let strokes: Vec<&[DVec2]> = lines.iter().collect();
    let any_closed = strokes.iter().any(|stroke| is_closed(stroke));
    let mut route = if any_closed { nearest_first(&strokes) } else { as_given(&strokes) };
    let mut n_changes = 0;
    let n_rounds = if any_closed { ROUNDS } else { 1 };
    // Random changes, where many are tried, take most of the time.
    let wanted_changes = effort.n_changes(strokes.len());
    let routed = if wanted_changes > strokes.len() as u64 { 0.3 } else { 1.0 };
    for round in 0..n_rounds {
        let at = |pass: f64| {
            let passes = MAX_TURNS.len() as f64 + 1.0;
            routed * (round as f64 + pass / passes) / n_rounds as f64
        };
        watch(at(0.0));
        let ends = Ends::new(&strokes, &route);
        let entries = match round {
            0 => greedy(&ends.points, &ends.neighbors, N_NEIGHBORS),
            _ => route.iter().map(|visit| 2 * visit.stroke + u32::from(visit.turned)).collect(),
        };
        let mut tour = Tour::new(&ends.points, &entries, &ends.neighbors, N_NEIGHBORS);
        for (pass, max_turn) in MAX_TURNS.into_iter().enumerate() {
            tour.improve_all(max_turn, &mut |share| watch(at(1.0 + pass as f64 + share)));
        }
        // The first round only finds good seams.
        if round + 1 == n_rounds {
            let go_on = |n_tried: u64| {
                let share = match effort {
                    Effort::Within(time) => begun.elapsed().as_secs_f64() / time.as_secs_f64(),
                    _ => n_tried as f64 / wanted_changes as f64,
                };
                watch(routed + (1.0 - routed) * share.min(1.0));
                !matches!(effort, Effort::Within(time) if begun.elapsed() >= time)
            };
            n_changes = tour.iterate(wanted_changes, MAX_TURN_ITERATED, go_on);
        }
        for (visit, entry) in route.iter_mut().zip(tour.entries()) {
            let seam = ends.seams[entry as usize / 2];
            *visit = StrokeVisit { stroke: entry / 2, turned: entry % 2 == 1, seam };
        }
        choose_seams(&strokes, &mut route);
    }
    watch(1.0);
    turn_toward_origin(&strokes, &mut route);
    let mut ordered = Polylines::default();
    for visit in &route {
        ordered.push(visit.points(strokes[visit.stroke as usize]));
    }
    Ordered { lines: ordered, n_changes }
}

/// A stroke on the route.
#[derive(Debug, Clone, Copy, PartialEq)]
struct StrokeVisit {
    stroke: u32,
    turned: bool,
    /// For a closed stroke, the point it begins and ends at.
    seam: u32,
}

impl StrokeVisit {
    fn entry(&self, stroke: &[DVec2]) -> DVec2 {
        match stroke {
            _ if is_closed(stroke) => stroke[self.seam as usize],
            [.., last] if self.turned => *last,
            [first, ..] => *first,
            [] => DVec2::ZERO,
        }
    }

    fn exit(&self, stroke: &[DVec2]) -> DVec2 {
        Self { turned: !self.turned, ..*self }.entry(stroke)
    }

    fn points<'a>(&self, stroke: &'a [DVec2]) -> Box<dyn Iterator<Item = DVec2> + 'a> {
        let seam = self.seam as usize;
        if is_closed(stroke) && seam > 0 {
            Box::new(stroke[seam..].iter().chain(&stroke[1..=seam]).copied())
        } else if self.turned {
            Box::new(stroke.iter().rev().copied())
        } else {
            Box::new(stroke.iter().copied())
        }
    }
}

/// Whether a stroke ends where it begins and goes somewhere between.
fn is_closed(stroke: &[DVec2]) -> bool {
    stroke.len() > 2 && stroke.first() == stroke.last()
}

/// The strokes in the order given.
fn as_given(strokes: &[&[DVec2]]) -> Vec<StrokeVisit> {
    (0..strokes.len() as u32).map(|stroke| StrokeVisit { stroke, turned: false, seam: 0 }).collect()
}

/// Starts at the page's origin and always continues to the nearest end that is left.
fn nearest_first(strokes: &[&[DVec2]]) -> Vec<StrokeVisit> {
    let mut points = Vec::new();
    let mut visits = Vec::new();
    let mut starts = Vec::with_capacity(strokes.len() + 1);
    for (s, stroke) in strokes.iter().enumerate() {
        starts.push(points.len());
        let first = StrokeVisit { stroke: s as u32, turned: false, seam: 0 };
        if is_closed(stroke) {
            let step = (stroke.len() - 1).div_ceil(N_SEAMS);
            for seam in (0..stroke.len() - 1).step_by(step) {
                visits.push(StrokeVisit { seam: seam as u32, ..first });
                points.push(stroke[seam]);
            }
        } else {
            for turned in [false, true] {
                let visit = StrokeVisit { turned, ..first };
                visits.push(visit);
                points.push(visit.entry(stroke));
            }
        }
    }
    starts.push(points.len());
    let mut left = NearestPoints::new(&points);
    let mut route = Vec::with_capacity(strokes.len());
    let mut here = DVec2::ZERO;
    while let Some(next) = left.nearest(here) {
        let visit = visits[next as usize];
        let s = visit.stroke as usize;
        for point in starts[s]..starts[s + 1] {
            left.remove(point as u32);
        }
        here = visit.exit(strokes[s]);
        route.push(visit);
    }
    route
}

/// The strokes' ends with the seams as they are.
struct Ends {
    /// First and last point of every stroke.
    points: Vec<DVec2>,
    neighbors: Vec<u32>,
    /// Seam of every stroke.
    seams: Vec<u32>,
}

impl Ends {
    fn new(strokes: &[&[DVec2]], route: &[StrokeVisit]) -> Self {
        let mut points = vec![DVec2::ZERO; strokes.len() * 2];
        let mut seams = vec![0; strokes.len()];
        for visit in route {
            let (s, stroke) = (visit.stroke as usize, strokes[visit.stroke as usize]);
            let forward = StrokeVisit { turned: false, ..*visit };
            points[2 * s] = forward.entry(stroke);
            points[2 * s + 1] = forward.exit(stroke);
            seams[s] = visit.seam;
        }
        let neighbors = neighbors(&points);
        Self { points, neighbors, seams }
    }
}

/// The nearest ends of other strokes for each end, nearest first, filled up with `NONE`.
fn neighbors(ends: &[DVec2]) -> Vec<u32> {
    let tree = NearestPoints::new(ends);
    let mut neighbors = vec![NONE; ends.len() * N_NEIGHBORS];
    neighbors.par_chunks_mut(N_NEIGHBORS).enumerate().for_each_init(
        Vec::new,
        |found, (i, near)| {
            tree.nearest_k(ends[i], N_NEIGHBORS, |j| j as usize / 2 != i / 2, found);
            for (slot, &(_, j)) in near.iter_mut().zip(found.iter()) {
                *slot = j;
            }
        },
    );
    neighbors
}

/// Moves the seam of each closed stroke to where the travel from the previous stroke and to the next
/// one is shortest.
fn choose_seams(strokes: &[&[DVec2]], route: &mut [StrokeVisit]) {
    for i in 0..route.len() {
        let stroke = strokes[route[i].stroke as usize];
        if !is_closed(stroke) {
            continue;
        }
        let neighbor = |visit: &StrokeVisit| strokes[visit.stroke as usize];
        let before =
            i.checked_sub(1).and_then(|j| route.get(j)).map(|visit| visit.exit(neighbor(visit)));
        let after = route.get(i + 1).map(|visit| visit.entry(neighbor(visit)));
        let way =
            |p: DVec2| before.map_or(0.0, |q| q.distance(p)) + after.map_or(0.0, |q| q.distance(p));
        let mut best = (way(stroke[route[i].seam as usize]), route[i].seam);
        for (seam, &p) in stroke[1..].iter().enumerate() {
            if way(p) < best.0 {
                best = (way(p), seam as u32 + 1);
            }
        }
        route[i].seam = best.1 % (stroke.len() as u32 - 1);
    }
}

/// Reverses the route if its last end is nearer to the page's origin than its first.
fn turn_toward_origin(strokes: &[&[DVec2]], route: &mut [StrokeVisit]) {
    let (Some(first), Some(last)) = (route.first(), route.last()) else {
        return;
    };
    let start = first.entry(strokes[first.stroke as usize]);
    let end = last.exit(strokes[last.stroke as usize]);
    if end.length_squared() < start.length_squared() {
        route.reverse();
        for visit in route {
            visit.turned = !visit.turned;
        }
    }
}
