//! A drawing as a graph: where strokes meet, and each piece of ink between two such points once.

use glam::DVec2;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::groups::Groups;
use crate::plot::Polylines;

/// Ink as vertices and straight edges, without duplicates.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Graph {
    /// Page positions in millimeters, approximately sorted by x, then y.
    pub positions: Vec<DVec2>,
    /// Pairs of different vertices, the lower one first, in ascending order, each pair once.
    pub edges: Vec<[u32; 2]>,
    /// Vertices at which the pen is only set down: dots where no edge ends.
    pub dots: Vec<u32>,
}

/// How the points at which strokes meet are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Joints<'a> {
    /// Points within this distance, in millimeters, are joined; zero joins equal points only.
    ///
    /// Points are visited in ascending order of x, then y. Each joins the nearest group whose first point
    /// is within the distance, provided that the diagonal of the group's box stays within it too;
    /// otherwise it starts a group. A group's joint is the center of its box. So no point moves farther
    /// than half of the distance, however long the chains of near points are, and the order of the
    /// strokes does not matter.
    Near(f64),
    /// Numbers for every point of every polyline, in order: points with equal numbers are one, the first
    /// of them. Equal points are joined as well. Points without a number are ignored.
    Numbered(&'a [u32]),
}

impl Graph {
    /// Builds the graph of `lines`; points that are not finite are left out with their segments.
    ///
    /// O(n log n) time, about 60 bytes per point.
    pub fn new(lines: &Polylines, joints: Joints<'_>) -> Self {
        let points = joined_points(lines, joints);
        let tolerance = match joints {
            Joints::Near(tolerance) => tolerance.max(0.0),
            Joints::Numbered(_) => 0.0,
        };
        let (positions, vertex_of) = weld(&points, tolerance);
        let mut keys = Vec::with_capacity(points.len());
        let mut dots = Vec::new();
        let mut start = 0;
        for line in lines.iter() {
            let vertices = &vertex_of[start..start + line.len()];
            start += line.len();
            let first = vertices.first().copied().unwrap_or(NONE);
            if first != NONE && vertices.iter().all(|&v| v == first) {
                dots.push(first);
                continue;
            }
            for pair in vertices.windows(2) {
                if pair[0] != pair[1] && pair[0] != NONE && pair[1] != NONE {
                    keys.push(edge_key(pair[0], pair[1]));
                }
            }
        }
        let mut graph = Self { positions, edges: unique_edges(keys), dots };
        graph.drop_covered_dots();
        graph
    }

    /// Removes repeated dots and those at the end of an edge.
    fn drop_covered_dots(&mut self) {
        let mut inked = vec![false; self.positions.len()];
        for edge in &self.edges {
            for &v in edge {
                inked[v as usize] = true;
            }
        }
        self.dots.sort_unstable();
        self.dots.dedup();
        self.dots.retain(|&v| !inked[v as usize]);
    }

    /// Total length of the edges in millimeters.
    pub fn length_mm(&self) -> f64 {
        self.edges.iter().map(|&[a, b]| self.position(a).distance(self.position(b))).sum()
    }

    /// Position of a vertex.
    pub(super) fn position(&self, vertex: u32) -> DVec2 {
        self.positions[vertex as usize]
    }
}

/// Stands for no vertex or no half-edge.
pub(super) const NONE: u32 = u32::MAX;

/// An edge as one number, the lower vertex in the upper half.
pub(super) fn edge_key(a: u32, b: u32) -> u64 {
    (u64::from(a.min(b)) << 32) | u64::from(a.max(b))
}

/// Sorts edges and removes repeated ones.
pub(super) fn unique_edges(mut keys: Vec<u64>) -> Vec<[u32; 2]> {
    keys.par_sort_unstable();
    keys.dedup();
    keys.into_iter().map(|key| [(key >> 32) as u32, key as u32]).collect()
}

/// All points in order, with those of equal number moved to the first of them.
fn joined_points(lines: &Polylines, joints: Joints<'_>) -> Vec<DVec2> {
    // Adding zero turns −0 into 0, so that equal points have equal bits.
    let mut points: Vec<DVec2> = lines.iter().flatten().map(|&p| p + DVec2::ZERO).collect();
    if let Joints::Numbered(numbers) = joints {
        let mut first_of = FxHashMap::default();
        for (point, &number) in points.iter_mut().zip(numbers) {
            if point.is_finite() {
                *point = *first_of.entry(number).or_insert(*point);
            }
        }
    }
    points
}

/// Positions of the joints, and for every point the number of its joint.
fn weld(points: &[DVec2], tolerance: f64) -> (Vec<DVec2>, Vec<u32>) {
    let mut order: Vec<u32> =
        (0..points.len() as u32).filter(|&i| points[i as usize].is_finite()).collect();
    let key = |i: u32| points[i as usize];
    order.par_sort_unstable_by(|&i, &j| {
        let (a, b) = (key(i), key(j));
        a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(i.cmp(&j))
    });
    let mut groups: Vec<Group> = Vec::new();
    let mut vertex_of = vec![NONE; points.len()];
    let mut cells = WeldCells::new(tolerance);
    let mut last: Option<(DVec2, u32)> = None;
    for &i in &order {
        let p = key(i);
        let vertex = match last {
            Some((q, vertex)) if q == p => vertex,
            _ => match cells.nearest(&groups, p) {
                Some(vertex) => {
                    let group = &mut groups[vertex as usize];
                    (group.low, group.high) = (group.low.min(p), group.high.max(p));
                    vertex
                }
                None => {
                    groups.push(Group { first: p, low: p, high: p });
                    let vertex = groups.len() as u32 - 1;
                    cells.insert(p, vertex);
                    vertex
                }
            },
        };
        last = Some((p, vertex));
        vertex_of[i as usize] = vertex;
    }
    (groups.iter().map(Group::middle).collect(), vertex_of)
}

/// Points that are one joint.
struct Group {
    first: DVec2,
    low: DVec2,
    high: DVec2,
}

impl Group {
    /// Exactly the point if all are equal.
    fn middle(&self) -> DVec2 {
        if self.low == self.high { self.first } else { self.low.midpoint(self.high) }
    }

    fn has_room(&self, p: DVec2, tolerance: f64) -> bool {
        self.low.min(p).distance_squared(self.high.max(p)) <= tolerance * tolerance
    }
}

/// First points of groups, in square cells as wide as the tolerance, so near ones are within nine cells.
struct WeldCells {
    size: f64,
    heads: FxHashMap<(i64, i64), u32>,
    next: Vec<u32>,
}

impl WeldCells {
    fn new(size: f64) -> Self {
        Self { size, heads: FxHashMap::default(), next: Vec::new() }
    }

    fn cell(&self, p: DVec2) -> (i64, i64) {
        let cell = (p / self.size).floor();
        (cell.x as i64, cell.y as i64)
    }

    fn insert(&mut self, p: DVec2, vertex: u32) {
        if self.size > 0.0 {
            let head = self.heads.insert(self.cell(p), vertex).unwrap_or(NONE);
            self.next.push(head);
        }
    }

    /// The group with room for `p` whose first point is nearest to it within the cell size, the
    /// earlier one of two as near.
    fn nearest(&self, groups: &[Group], p: DVec2) -> Option<u32> {
        if self.size <= 0.0 {
            return None;
        }
        let (x, y) = self.cell(p);
        let mut best: Option<(f64, u32)> = None;
        // Points come in ascending order of x: none so far is in a column to the right.
        for column in [x.saturating_sub(1), x] {
            for row in [y.saturating_sub(1), y, y.saturating_add(1)] {
                let mut vertex = self.heads.get(&(column, row)).copied().unwrap_or(NONE);
                while vertex != NONE {
                    let group = &groups[vertex as usize];
                    let distance = group.first.distance_squared(p);
                    if distance <= self.size * self.size
                        && group.has_room(p, self.size)
                        && best.is_none_or(|(d, v)| distance < d || (distance == d && vertex < v))
                    {
                        best = Some((distance, vertex));
                    }
                    vertex = self.next[vertex as usize];
                }
            }
        }
        best.map(|(_, vertex)| vertex)
    }
}

/// The half-edges that leave each vertex. Half-edge `2e + s` leaves vertex `s` of edge `e`.
pub(super) struct IncidentEdges(Groups);

impl IncidentEdges {
    pub(super) fn new(graph: &Graph) -> Self {
        Self(Groups::new(graph.positions.len(), |sorter| {
            let ends = graph.edges.iter().flatten();
            for (half_edge, &vertex) in (0..).zip(ends) {
                sorter.put(vertex as usize, half_edge);
            }
        }))
    }

    /// Half-edges that leave `vertex`, in ascending order.
    pub(super) fn of(&self, vertex: u32) -> &[u32] {
        self.0.of(vertex as usize)
    }
}

/// Vertex at the far end of a half-edge.
pub(super) fn target(graph: &Graph, half_edge: u32) -> u32 {
    graph.edges[half_edge as usize / 2][1 - (half_edge as usize & 1)]
}
