//! Boundary edges that do not look like a boundary, since a coplanar face continues beyond them.
//!
//! ```text
//!   ┌────────┬────────┐
//!   │        │   B    │      A's long side and the sides of B and C have one face each,
//!   │   A    ├────────┤      but the three lie in one plane: no line is seen there
//!   │        │   C    │
//!   └────────┴────────┘
//! ```
//!
//! Where such a face lies along part of an edge only, the edge is split at vertices: each part is flush
//! or boundary. A part that ends where no vertex is, as when coplanar faces overlap, counts as
//! boundary as far as the next vertex.
//!
//! Everything is decided exactly on the positions as given. Where the face beyond is out of plane
//! by the last bit, the edge stays a boundary.

use std::cmp::Ordering;

use dashu_int::IBig;
use glam::DVec3;
use rayon::prelude::*;

use crate::model::mesh::Mesh;
use crate::model::topology::Topology;
use crate::predicates::{Sign, Solid, exact};

/// Triangles that look for edges as one piece of parallel work.
const CHUNK: usize = 1024;

/// Boundary edges in a leaf of the tree.
const LEAF: usize = 8;

/// Boundary edges along which coplanar faces lie on the other side.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct FlushEdges {
    /// Edges that are flush from end to end, in ascending order.
    pub(super) whole: Vec<u32>,
    /// The parts of all other such edges, edge after edge in ascending order.
    pub(super) parts: Vec<BoundaryPart>,
}

/// Part of a boundary edge, from vertex to vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoundaryPart {
    /// The edge.
    pub edge: u32,
    /// Its ends, vertices on the edge, in the direction of the edge.
    pub ends: [u32; 2],
    /// Whether coplanar faces lie on the other side all along it.
    pub is_flush: bool,
}

/// Finds the boundary edges that are flush, and splits those that are flush in part.
///
/// `triangles` cover the faces of the mesh, as listed in `triangle_faces`. Expected cost
/// O((edges + triangles) log edges), where edges are those of the boundary; nothing without any.
pub(super) fn flush_edges(
    mesh: &Mesh,
    topology: &Topology,
    triangles: &[[u32; 3]],
    triangle_faces: &[u32],
) -> FlushEdges {
    let rims = rims(topology, triangles, triangle_faces);
    if rims.is_empty() {
        return FlushEdges::default();
    }
    let positions = mesh.positions();
    let tree = RimTree::new(positions, &rims);
    let solid = Solid::new(positions);
    let found: Vec<(u32, Cover)> = triangles
        .par_chunks(CHUNK)
        .zip(triangle_faces.par_chunks(CHUNK))
        .map(|(triangles, faces)| {
            let mut found = Vec::new();
            for (triangle, &face) in triangles.iter().zip(faces) {
                tree.visit(bounds(triangle.map(|v| positions[v as usize])), &mut |number| {
                    let rim = &rims[number as usize];
                    if rim.face != face
                        && let Some(cover) = cover(&solid, rim, *triangle)
                    {
                        found.push((number, cover));
                    }
                });
            }
            found
        })
        .flatten_iter()
        .collect();
    let mut covers_of: Vec<Vec<Cover>> = vec![Vec::new(); rims.len()];
    for (number, cover) in found {
        covers_of[number as usize].push(cover);
    }
    let mut flush = FlushEdges::default();
    for (rim, covers) in rims.iter().zip(covers_of) {
        let parts = parts(rim, covers);
        if parts.iter().all(|part| part.is_flush) {
            flush.whole.push(rim.edge);
        } else if parts.len() > 1 {
            flush.parts.extend(parts);
        }
    }
    flush
}

/// A boundary edge, its face, and the triangle of the face along it.
struct Rim {
    edge: u32,
    ends: [u32; 2],
    face: u32,
    /// The third corner of that triangle.
    apex: u32,
}

fn rims(topology: &Topology, triangles: &[[u32; 3]], triangle_faces: &[u32]) -> Vec<Rim> {
    let n_edges = topology.edges().len() as u32;
    let rim = |edge: u32| {
        let &[only] = topology.uses(edge) else { return None };
        let (ends, face) = (topology.edge(edge), only.face());
        let first = triangle_faces.partition_point(|&of| of < face);
        let of_face = (first..triangles.len()).take_while(|&t| triangle_faces[t] == face);
        let along = of_face.map(|t| triangles[t]).find(|t| ends.iter().all(|e| t.contains(e)))?;
        let apex = along.into_iter().find(|corner| !ends.contains(corner))?;
        Some(Rim { edge, ends, face, apex })
    };
    (0..n_edges).into_par_iter().with_min_len(4096).filter_map(rim).collect()
}

/// The part of an edge beyond which one coplanar triangle lies.
#[derive(Debug, Clone)]
struct Cover {
    /// Where it begins and ends, from 0 to 1.
    interval: [Ratio; 2],
    /// The triangle's corners on the line of the edge, and where they are.
    corners: Vec<(Ratio, u32)>,
}

fn cover(solid: &Solid<'_>, rim: &Rim, triangle: [u32; 3]) -> Option<Cover> {
    let in_plane = |vertex: u32| solid.side_of(triangle, vertex) == Sign::Zero;
    if !(in_plane(rim.ends[0]) && in_plane(rim.ends[1]) && in_plane(rim.apex)) {
        return None;
    }
    let at = |vertex: u32| solid.positions()[vertex as usize];
    let ([from, to], apex) = (rim.ends.map(at), at(rim.apex));
    let mut corners = triangle.map(at);
    // Seen along an axis that the plane does not contain, everything is in two dimensions.
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let axis = DVec3::AXES[normal.abs().max_position()];
    let turns = |a: DVec3, b: DVec3, x: [DVec3; 2]| exact::direction_volumes(axis, a, b, x);
    match exact::sign(&turns(corners[0], corners[1], [corners[2]; 2])[0]) {
        Sign::Zero => return None,
        Sign::Negative => corners.swap(1, 2),
        Sign::Positive => {}
    }
    let side_of = |x: DVec3| exact::sign(&turns(from, to, [x; 2])[0]);
    let beyond = side_of(apex).flipped();
    if beyond == Sign::Zero || !corners.iter().any(|&corner| side_of(corner) == beyond) {
        return None;
    }
    let mut interval = [Ratio::zero(), Ratio::one()];
    for side in 0..3 {
        let [first, last] = turns(corners[side], corners[(side + 1) % 3], [from, to]);
        let crossing = || Ratio::new(first.clone(), first.clone() - last.clone());
        match (exact::sign(&first), exact::sign(&last)) {
            (Sign::Negative, Sign::Positive) => {
                let crossing = crossing();
                if crossing > interval[0] {
                    interval[0] = crossing;
                }
            }
            (Sign::Positive, Sign::Negative) => {
                let crossing = crossing();
                if crossing < interval[1] {
                    interval[1] = crossing;
                }
            }
            (Sign::Negative, _) | (_, Sign::Negative) => return None,
            _ => {}
        }
    }
    if interval[0] >= interval[1] {
        return None;
    }
    let on_line = triangle.into_iter().filter(|&corner| side_of(at(corner)) == Sign::Zero);
    let placed = on_line.map(|corner| {
        let [of_corner, of_end] = turns(apex, from, [at(corner), to]);
        (Ratio::new(of_corner, of_end), corner)
    });
    Some(Cover { interval, corners: placed.collect() })
}

/// Splits a boundary edge at the vertices where covers begin or end. Neighboring boundary parts are
/// joined; flush ones are not, since each may be an edge of the face beyond.
fn parts(rim: &Rim, mut covers: Vec<Cover>) -> Vec<BoundaryPart> {
    let whole = |is_flush| vec![BoundaryPart { edge: rim.edge, ends: rim.ends, is_flush }];
    if covers.is_empty() {
        return whole(false);
    }
    let mut vertices: Vec<(Ratio, u32)> =
        covers.iter_mut().flat_map(|cover| std::mem::take(&mut cover.corners)).collect();
    vertices.retain(|(t, _)| *t > Ratio::zero() && *t < Ratio::one());
    vertices.extend([(Ratio::zero(), rim.ends[0]), (Ratio::one(), rim.ends[1])]);
    vertices.sort();
    vertices.dedup_by_key(|(_, vertex)| *vertex);
    let mut intervals: Vec<[Ratio; 2]> = covers.into_iter().map(|cover| cover.interval).collect();
    intervals.sort();
    let mut joined: Vec<[Ratio; 2]> = Vec::new();
    for [start, end] in intervals {
        match joined.last_mut() {
            Some(last) if start <= last[1] => last[1] = end.max(last[1].clone()),
            _ => joined.push([start, end]),
        }
    }
    let mut parts: Vec<BoundaryPart> = Vec::new();
    let mut at = 0;
    for pair in vertices.windows(2) {
        let [(start, first), (end, last)] = pair else { continue };
        while joined.get(at).is_some_and(|interval| interval[1] < *end) {
            at += 1;
        }
        let is_flush = joined.get(at).is_some_and(|interval| interval[0] <= *start);
        match parts.last_mut() {
            Some(part) if !part.is_flush && !is_flush => part.ends[1] = *last,
            _ => parts.push(BoundaryPart { edge: rim.edge, ends: [*first, *last], is_flush }),
        }
    }
    parts
}

/// A fraction with a positive denominator.
#[derive(Debug, Clone)]
struct Ratio {
    numerator: IBig,
    denominator: IBig,
}

impl Ratio {
    fn new(numerator: IBig, denominator: IBig) -> Self {
        if denominator < IBig::ZERO {
            Self { numerator: -numerator, denominator: -denominator }
        } else {
            Self { numerator, denominator }
        }
    }

    fn zero() -> Self {
        Self::new(IBig::ZERO, IBig::ONE)
    }

    fn one() -> Self {
        Self::new(IBig::ONE, IBig::ONE)
    }
}

impl Ord for Ratio {
    fn cmp(&self, other: &Self) -> Ordering {
        (&self.numerator * &other.denominator).cmp(&(&other.numerator * &self.denominator))
    }
}

impl PartialOrd for Ratio {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Ratio {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Ratio {}

/// A box as its lowest and highest corner.
type Bounds = (DVec3, DVec3);

fn bounds<const N: usize>(points: [DVec3; N]) -> Bounds {
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    points.into_iter().fold(start, |(low, high), p| (low.min(p), high.max(p)))
}

fn touch(a: Bounds, b: Bounds) -> bool {
    a.0.cmple(b.1).all() && b.0.cmple(a.1).all()
}

/// A tree of boxes around edges, halved along the longest side.
struct RimTree {
    nodes: Vec<RimNode>,
    order: Vec<u32>,
    boxes: Vec<Bounds>,
}

struct RimNode {
    bounds: Bounds,
    start: u32,
    end: u32,
    /// The second half's node; the first half's is the next one. `None` in a leaf.
    second: Option<u32>,
}

impl RimTree {
    fn new(positions: &[DVec3], rims: &[Rim]) -> Self {
        let boxes = rims.iter().map(|rim| bounds(rim.ends.map(|v| positions[v as usize])));
        let mut tree = Self { nodes: Vec::new(), order: Vec::new(), boxes: boxes.collect() };
        let mut order: Vec<u32> = (0..rims.len() as u32).collect();
        tree.build(&mut order, 0);
        tree.order = order;
        tree
    }

    fn build(&mut self, order: &mut [u32], start: u32) {
        let around = order.iter().map(|&i| self.boxes[i as usize]);
        let around = around.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default();
        let node = self.nodes.len();
        let end = start + order.len() as u32;
        self.nodes.push(RimNode { bounds: around, start, end, second: None });
        if order.len() <= LEAF {
            return;
        }
        let axis = (around.1 / 2.0 - around.0 / 2.0).max_position();
        let middle = order.len() / 2;
        let key = |i: u32| {
            let (low, high) = self.boxes[i as usize];
            low[axis] / 2.0 + high[axis] / 2.0
        };
        order.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
        let (first, second) = order.split_at_mut(middle);
        self.build(first, start);
        self.nodes[node].second = Some(self.nodes.len() as u32);
        self.build(second, start + middle as u32);
    }

    /// Calls `found` with each edge whose box touches `bounds`.
    fn visit(&self, bounds: Bounds, found: &mut impl FnMut(u32)) {
        let mut stack = vec![0_u32];
        while let Some(number) = stack.pop() {
            let node = &self.nodes[number as usize];
            if !touch(node.bounds, bounds) {
                continue;
            }
            match node.second {
                Some(second) => stack.extend([second, number + 1]),
                None => {
                    let edges = &self.order[node.start as usize..node.end as usize];
                    let near = edges.iter().filter(|&&i| touch(self.boxes[i as usize], bounds));
                    near.for_each(|&edge| found(edge));
                }
            }
        }
    }
}
