//! The order in which strokes are drawn, which end each begins at, and where closed ones begin.
//!
//! The nearest unused end comes next (a closed stroke may begin at any of its points); then the
//! search of `tour` shortens the way. Seams of closed strokes are chosen again
//! between the rounds of that search.

use std::time::Instant;

use glam::DVec2;
use rayon::prelude::*;

use super::Effort;
use super::graph::NONE;
use super::nearest::NearestPoints;
use super::tour::Tour;
use crate::plot::Polylines;

/// Ends each end may be linked to in the search.
const N_NEIGHBORS: usize = 8;
/// Points of a closed stroke tried as its seam when the nearest one is looked for; all of them
/// are tried later.
const N_SEAMS: usize = 16;
/// Longest run of strokes turned around, so that one move takes microseconds on any drawing.
const MAX_TURN: usize = 50_000;
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
        return Ordered {
            lines: lines.clone(),
            n_changes: 0,
        };
    }
    let begun = Instant::now();
    let strokes: Vec<&[DVec2]> = lines.iter().collect();
    let mut route = nearest_first(&strokes);
    let any_closed = strokes.iter().any(|stroke| is_closed(stroke));
    let mut n_changes = 0;
    let rounds: &[bool] = match (any_closed, effort) {
        (false, _) => &[true],
        (true, Effort::Fast) => &[false, true],
        (true, _) => &[false, true, true],
    };
    for &iterated in rounds {
        if any_closed {
            choose_seams(&strokes, &mut route);
        }
        let share = rounds.iter().filter(|&&r| r).count() as u64;
        let changes = if iterated {
            effort.n_changes(strokes.len()) / share
        } else {
            0
        };
        n_changes += shorten(&strokes, &mut route, changes, || match effort {
            Effort::Within(time) => begun.elapsed() < time,
            _ => true,
        });
    }
    if any_closed {
        choose_seams(&strokes, &mut route);
    }
    turn_toward_origin(&strokes, &mut route);
    let mut ordered = Polylines::default();
    for visit in &route {
        ordered.push(visit.points(strokes[visit.stroke as usize]));
    }
    Ordered {
        lines: ordered,
        n_changes,
    }
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
        Self {
            turned: !self.turned,
            ..*self
        }
        .entry(stroke)
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

/// From the page's origin always on to the nearest end that is left.
fn nearest_first(strokes: &[&[DVec2]]) -> Vec<Visit> {
    let mut points = Vec::new();
    let mut visits = Vec::new();
    let mut starts = Vec::with_capacity(strokes.len() + 1);
    for (s, stroke) in strokes.iter().enumerate() {
        starts.push(points.len());
        let first = Visit {
            stroke: s as u32,
            turned: false,
            seam: 0,
        };
        if is_closed(stroke) {
            let step = (stroke.len() - 1).div_ceil(N_SEAMS);
            for seam in (0..stroke.len() - 1).step_by(step) {
                visits.push(Visit {
                    seam: seam as u32,
                    ..first
                });
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

/// Searches for a shorter route with the seams as they are; returns the random changes tried.
fn shorten(
    strokes: &[&[DVec2]],
    route: &mut [Visit],
    n_changes: u64,
    go_on: impl FnMut() -> bool,
) -> u64 {
    let mut ends = vec![DVec2::ZERO; strokes.len() * 2];
    let mut entries = Vec::with_capacity(route.len());
    let mut seams = vec![0; strokes.len()];
    for visit in route.iter() {
        let (s, stroke) = (visit.stroke as usize, strokes[visit.stroke as usize]);
        let forward = Visit {
            turned: false,
            ..*visit
        };
        ends[2 * s] = forward.entry(stroke);
        ends[2 * s + 1] = forward.exit(stroke);
        entries.push(2 * visit.stroke + u32::from(visit.turned));
        seams[s] = visit.seam;
    }
    let neighbors = neighbors(&ends);
    let mut tour = Tour::new(&ends, &entries, &neighbors, N_NEIGHBORS);
    tour.improve_all(MAX_TURN);
    let done = tour.iterate(n_changes, MAX_TURN_ITERATED, go_on);
    for (visit, entry) in route.iter_mut().zip(tour.entries()) {
        let stroke = entry / 2;
        *visit = Visit {
            stroke,
            turned: entry % 2 == 1,
            seam: seams[stroke as usize],
        };
    }
    done
}

/// The nearest ends of other strokes for each end, nearest first, filled up with `NONE`.
fn neighbors(ends: &[DVec2]) -> Vec<u32> {
    let tree = NearestPoints::new(ends);
    let mut neighbors = vec![NONE; ends.len() * N_NEIGHBORS];
    neighbors
        .par_chunks_mut(N_NEIGHBORS)
        .enumerate()
        .for_each_init(Vec::new, |found, (i, near)| {
            tree.nearest_k(ends[i], N_NEIGHBORS, |j| j as usize / 2 != i / 2, found);
            for (slot, &(_, j)) in near.iter_mut().zip(found.iter()) {
                *slot = j;
            }
        });
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
        let before = i
            .checked_sub(1)
            .and_then(|j| route.get(j))
            .map(|visit| visit.exit(neighbor(visit)));
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
