//! From the pieces of pairs of triangles to whole lines.
//!
//! Two planar faces meet in one line, whatever triangles they are made of. Pieces between the same
//! two planes lie on one line, so what touches or overlaps there is joined:
//!
//! ```text
//!   triangles    ├─────┤├──┤├───────┤    ├────┤
//!   line         ├──────────────────┤    ├────┤
//! ```
//!
//! That two triangles lie in one plane is decided exactly.

use super::pair::{End, Piece, Site};
use super::tree::BoxTree;
use super::{Intersection, Intersections};
use crate::disjoint_sets::root;
use crate::model::topology::Topology;
use crate::predicates::{PiercePoint, Sign, Solid};
use rayon::prelude::*;
use std::cmp::Ordering;

/// Joins pieces that lie on one line and touch, and constructs their ends.
pub(super) fn joined(
    pieces: Vec<Piece>,
    solid: &Solid,
    triangles: &[[u32; 3]],
    topology: &Topology,
) -> Intersections {
    if pieces.is_empty() {
        return Intersections::default();
    }
    let plane_of = planes(&pieces, solid, triangles);
    let (ends, points) = points(&pieces, solid, triangles);
    let number = |end: End| ends.partition_point(|&(known, _)| known < end) as u32;
    let mut parts: Vec<Part> = pieces
        .par_iter()
        .map(|piece| {
            let along = piece.along.map(|along| {
                let edge = along.and_then(|a| topology.find_edge(a.side[0], a.side[1]));
                edge.unwrap_or(Intersection::NO_EDGE)
            });
            let [from, to] = piece.ends.map(number);
            let is_ahead = order(&points, from, to) == Ordering::Less;
            Part {
                planes: sorted(piece.triangles.map(|t| plane_of[t as usize])),
                edges: sorted(along),
                ends: if is_ahead { [from, to] } else { [to, from] },
            }
        })
        .collect();
    parts.par_sort_unstable_by(|a, b| {
        (a.planes, a.edges)
            .cmp(&(b.planes, b.edges))
            .then_with(|| order(&points, a.ends[0], b.ends[0]))
            .then_with(|| order(&points, a.ends[1], b.ends[1]))
            .then_with(|| a.ends.cmp(&b.ends))
    });
    parts.dedup_by(|next, last| {
        let touch = (next.planes, next.edges) == (last.planes, last.edges)
            && order(&points, next.ends[0], last.ends[1]) != Ordering::Greater;
        if touch && order(&points, next.ends[1], last.ends[1]) == Ordering::Greater {
            last.ends[1] = next.ends[1];
        }
        touch
    });
    named(&parts, ends, points, solid.positions().len() as u32, plane_of)
}

/// A part of a line, by numbers of points.
#[derive(Debug, Clone, Copy)]
struct Part {
    planes: [u32; 2],
    edges: [u32; 2],
    ends: [u32; 2],
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    if a < b { [a, b] } else { [b, a] }
}

fn order(points: &[PiercePoint], a: u32, b: u32) -> Ordering {
    if a == b {
        return Ordering::Equal;
    }
    points[a as usize].order(&points[b as usize])
}

/// A name for the plane of each triangle that meets another, the same for all in one plane whose
/// boxes touch in a chain.
fn planes(pieces: &[Piece], solid: &Solid, triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut meeting: Vec<u32> = pieces.iter().flat_map(|piece| piece.triangles).collect();
    meeting.par_sort_unstable();
    meeting.dedup();
    let tree = BoxTree::new(solid.positions(), triangles, meeting.clone());
    let pairs: Vec<Vec<[u32; 2]>> = tree.touching_pairs(
        |triangle| solid.plane(triangles[triangle as usize]),
        |pairs: &mut Vec<[u32; 2]>, plane, a, b| {
            let corners = triangles[a as usize];
            let in_plane =
                |&x: &u32| corners.contains(&x) || solid.side(plane, corners, x) == Sign::Zero;
            if triangles[b as usize].iter().all(in_plane) {
                pairs.push([a, b]);
            }
        },
    );
    let mut plane_of = vec![u32::MAX; triangles.len()];
    for &triangle in &meeting {
        plane_of[triangle as usize] = triangle;
    }
    for &pair in pairs.iter().flatten() {
        let [a, b] = sorted(pair.map(|triangle| root(&mut plane_of, triangle)));
        plane_of[b as usize] = a;
    }
    for &triangle in &meeting {
        plane_of[triangle as usize] = root(&mut plane_of, triangle);
    }
    plane_of
}

/// All ends in order, each once, and their points.
fn points(
    pieces: &[Piece],
    solid: &Solid,
    triangles: &[[u32; 3]],
) -> (Vec<(End, Site)>, Vec<PiercePoint>) {
    let mut ends: Vec<(End, Site)> =
        pieces.iter().flat_map(|piece| piece.ends.into_iter().zip(piece.sites)).collect();
    ends.par_sort_unstable();
    ends.dedup_by_key(|&mut (end, _)| end);
    let points = ends
        .par_iter()
        .with_min_len(64)
        .map(|&(end, (side, triangle))| {
            let pierced = |other| {
                let triangle = triangles[triangle as usize];
                PiercePoint::new(solid.positions(), side, triangle, other)
            };
            match end {
                End::Vertex(vertex) => PiercePoint::vertex(solid.positions()[vertex as usize]),
                End::Inside(..) => pierced(None),
                End::Sides(a, b) => pierced(Some(if a == side { b } else { a })),
            }
        })
        .collect();
    (ends, points)
}

/// The lines with the numbers that their ends have in the scene; other points are dropped.
fn named(
    parts: &[Part],
    ends: Vec<(End, Site)>,
    points: Vec<PiercePoint>,
    n_vertices: u32,
    plane_of: Vec<u32>,
) -> Intersections {
    let mut names = vec![None; points.len()];
    for &end in parts.iter().flat_map(|part| &part.ends) {
        names[end as usize] = Some(0);
    }
    let mut kept = Vec::new();
    for ((name, (end, _)), point) in names.iter_mut().zip(ends).zip(points) {
        match (end, &name) {
            (End::Vertex(vertex), _) => *name = Some(vertex),
            (_, Some(_)) => {
                *name = Some(n_vertices + kept.len() as u32);
                kept.push(point);
            }
            (_, None) => {}
        }
    }
    let lines = parts
        .iter()
        .filter_map(|part| {
            let [Some(a), Some(b)] = part.ends.map(|end| names[end as usize]) else { return None };
            Some(Intersection { ends: [a, b], planes: part.planes, edges: part.edges })
        })
        .collect();
    Intersections { lines, points: kept, plane_of, ..Intersections::default() }
}
