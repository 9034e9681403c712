//! Stroke order: which stroke comes next, at which end it begins, and where closed strokes begin.
//!
//! Closed strokes first get the seam nearest to the stroke before, when always the nearest one comes
//! next; the route itself is made by `greedy` and shortened by `tour`, and then better seams are
//! chosen and it is shortened again.

use std::time::Instant;

use glam::DVec2;
use rayon::prelude::*;

use super::Effort;
use super::graph::NONE;
use super::greedy::greedy;
use super::nearest::NearestPoints;
use super::tour::Tour;
use crate::plot::Polylines;

/// Ends each end may be linked to in the search.
const N_NEIGHBORS: usize = 10;
/// Points of a closed stroke tried as its seam when the nearest one is looked for; all of them
/// are tried later.
const N_SEAMS: usize = 16;
/// Times the route is shortened when there are closed strokes, with better seams each time.
const ROUNDS: usize = 2;
/// Longest runs of strokes turned around, one pass each: cheap moves come first, and no move takes
/// longer than a millisecond on any drawing.
const MAX_TURNS: [usize; 3] = [1_000, 10_000, 100_000];
/// The same while random changes are tried: those act within a small neighborhood.
const MAX_TURN_ITERATED: usize = 1_000;

/// Strokes in drawing order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ordered {
    /// The strokes, turned around and with seams moved as needed.
    pub lines: Polylines,
    /// Random changes tried by the search.
    pub n_changes: u64,
}

/// Orders `lines` for a short way with the pen up. The path begins at that one of its two ends
/// which is nearer to the page's origin.
///
/// Deterministic unless `effort` is [`Effort::Within`]. O(n log n) with the effort that is stated
/// at [`Effort`]; about 200 bytes a stroke.
pub fn order(lines: &Polylines, effort: Effort) -> Ordered {
    if effort == Effort::None || lines.len() < 2 {
        return Ordered { lines: lines.clone(), n_changes: 0 };
    }
    let begun = Instant::now();
    let strokes: Vec<&[DVec2]> = lines.iter().collect();
    let any_closed = strokes.iter().any(|stroke| is_closed(stroke));
    let mut route = if any_closed { nearest_first(&strokes) } else { as_given(&strokes) };
    let mut n_changes = 0;
    let n_rounds = if any_closed { ROUNDS } else { 1 };
    for round in 0..n_rounds {
        let ends = Ends::new(&strokes, &route);
        let entries = match round {
            0 => greedy(&ends.points, &ends.neighbors, N_NEIGHBORS),
            _ => route.iter().map(|visit| 2 * visit.stroke + u32::from(visit.turned)).collect(),
        };
        let mut tour = Tour::new(&ends.points, &entries, &ends.neighbors, N_NEIGHBORS);
        for max_turn in MAX_TURNS {
            tour.improve_all(max_turn);
        }
        // The first round only finds good seams.
        if round + 1 == n_rounds {
            let in_time = || match effort {
                Effort::Within(time) => begun.elapsed() < time,
                _ => true,
            };
            n_changes = tour.iterate(effort.n_changes(strokes.len()), MAX_TURN_ITERATED, in_time);
        }
        for (visit, entry) in route.iter_mut().zip(tour.entries()) {
            let seam = ends.seams[entry as usize / 2];
            *visit = Visit { stroke: entry / 2, turned: entry % 2 == 1, seam };
        }
        choose_seams(&strokes, &mut route);
    }
    turn_toward_origin(&strokes, &mut route);
    let mut ordered = Polylines::default();
    for visit in &route {
        ordered.push(visit.points(strokes[visit.stroke as usize]));
    }
    Ordered { lines: ordered, n_changes }
}

/// A stroke in its place on the route.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Visit {
    stroke: u32,
    turned: bool,
    /// For a closed stroke, the point it begins and ends at.
    seam: u32,
}

impl Visit {
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

/// Every stroke as it comes.
fn as_given(strokes: &[&[DVec2]]) -> Vec<Visit> {
    (0..strokes.len() as u32).map(|stroke| Visit { stroke, turned: false, seam: 0 }).collect()
}

/// From the page's origin always on to the nearest end that is left.
fn nearest_first(strokes: &[&[DVec2]]) -> Vec<Visit> {
    let mut points = Vec::new();
    let mut visits = Vec::new();
    let mut starts = Vec::with_capacity(strokes.len() + 1);
    for (s, stroke) in strokes.iter().enumerate() {
        starts.push(points.len());
        let first = Visit { stroke: s as u32, turned: false, seam: 0 };
        if is_closed(stroke) {
            let step = (stroke.len() - 1).div_ceil(N_SEAMS);
            for seam in (0..stroke.len() - 1).step_by(step) {
                visits.push(Visit { seam: seam as u32, ..first });
                points.push(stroke[seam]);
            }
        } else {
            for turned in [false, true] {
                let visit = Visit { turned, ..first };
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
    fn new(strokes: &[&[DVec2]], route: &[Visit]) -> Self {
        let mut points = vec![DVec2::ZERO; strokes.len() * 2];
        let mut seams = vec![0; strokes.len()];
        for visit in route {
            let (s, stroke) = (visit.stroke as usize, strokes[visit.stroke as usize]);
            let forward = Visit { turned: false, ..*visit };
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

/// Moves the seam of each closed stroke to where the way from the stroke before and to the one
/// after is shortest.
fn choose_seams(strokes: &[&[DVec2]], route: &mut [Visit]) {
    for i in 0..route.len() {
        let stroke = strokes[route[i].stroke as usize];
        if !is_closed(stroke) {
            continue;
        }
        let neighbor = |visit: &Visit| strokes[visit.stroke as usize];
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

/// Draws the route the other way if its last end is nearer to the page's origin than its first.
fn turn_toward_origin(strokes: &[&[DVec2]], route: &mut [Visit]) {
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
