//! Doubled ink: edges that overlap are cut where either one ends, and the pieces they share are kept
//! once.
//!
//! ```text
//!   A ────────────────── B             A ──── C ────────── B
//!          C ─────────────── D    ─►          C ────────── B ─── D
//! ```
//!
//! A vertex cuts an edge only if another edge continues from it along the cut one. So lines that merely
//! touch or cross stay as they are.

use glam::DVec2;
use rayon::prelude::*;

use crate::groups::Groups;

use super::graph::{Graph, IncidentEdges, edge_key, target, unique_edges};

/// Cuts edges where overlapping ones end, and keeps shared pieces once.
///
/// With `tolerance_mm` of zero only exactly collinear edges overlap (robust's `orient2d`);
/// otherwise edges that deviate by at most that. Ink moves by at most `tolerance_mm`.
///
/// Vertices are found in a grid whose cells hold about one. An edge of length `l` visits about `l`
/// over the width of a cell: O(vertices + edges) for strokes much shorter than the page, and
/// O(edges · √vertices) when all are as long as the page.
pub fn remove_overlaps(graph: &mut Graph, tolerance_mm: f64) {
    let tolerance = tolerance_mm.max(0.0);
    let Some(grid) = VertexGrid::new(graph, tolerance) else {
        return;
    };
    let stars = IncidentEdges::new(graph);
    let shared: &Graph = graph;
    let cuts: Vec<(u32, Vec<u32>)> = (0..shared.edges.len() as u32)
        .into_par_iter()
        .filter_map(|e| {
            let inner = inner_vertices(shared, &stars, &grid, e, tolerance);
            (!inner.is_empty()).then_some((e, inner))
        })
        .collect();
    if cuts.is_empty() {
        return;
    }
    let mut keys: Vec<u64> = Vec::with_capacity(graph.edges.len() + cuts.len());
    let mut next_cut = cuts.iter().peekable();
    for (e, &[a, b]) in graph.edges.iter().enumerate() {
        match next_cut.next_if(|cut| cut.0 as usize == e) {
            None => keys.push(edge_key(a, b)),
            Some((_, inner)) => {
                let chain: Vec<u32> =
                    std::iter::once(a).chain(inner.iter().copied()).chain([b]).collect();
                keys.extend(chain.windows(2).map(|pair| edge_key(pair[0], pair[1])));
            }
        }
    }
    graph.edges = unique_edges(keys);
}

/// Vertices that cut edge `e`, from its first to its second vertex.
fn inner_vertices(
    graph: &Graph,
    stars: &IncidentEdges,
    grid: &VertexGrid,
    e: u32,
    tolerance: f64,
) -> Vec<u32> {
    let [a, b] = graph.edges[e as usize];
    let edge = InkSegment { from: graph.position(a), to: graph.position(b), tolerance };
    let mut inner: Vec<(f64, u32)> = Vec::new();
    grid.near(edge.from, edge.to, tolerance, |vertex| {
        let p = graph.position(vertex);
        if vertex != a && vertex != b && edge.passes(p) {
            let runs_along = stars.of(vertex).iter().any(|&h| {
                let other = target(graph, h);
                let q = graph.position(other);
                let ahead = (q - p).dot(edge.to - edge.from);
                let end = if ahead > 0.0 { b } else { a };
                let onward = InkSegment { from: p, to: q, tolerance };
                ahead != 0.0
                    && (other == end || edge.passes(q) || onward.passes(graph.position(end)))
            });
            if runs_along {
                inner.push(((p - edge.from).dot(edge.to - edge.from), vertex));
            }
        }
    });
    inner.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
    inner.into_iter().map(|(_, vertex)| vertex).collect()
}

/// A straight piece, and the largest deviation at which ink still counts as being on it.
struct InkSegment {
    from: DVec2,
    to: DVec2,
    tolerance: f64,
}

impl InkSegment {
    /// Whether `p` is on the piece, strictly between its ends.
    fn passes(&self, p: DVec2) -> bool {
        let along = self.to - self.from;
        let t = (p - self.from).dot(along);
        if t <= 0.0 || t >= along.length_squared() {
            return false;
        }
        let coord = |p: DVec2| robust::Coord { x: p.x, y: p.y };
        let area = robust::orient2d(coord(self.from), coord(self.to), coord(p));
        area.abs() <= self.tolerance * along.length()
    }
}

/// Vertices by square cells.
struct VertexGrid {
    low: DVec2,
    cell: f64,
    n_columns: usize,
    n_rows: usize,
    vertices: Groups,
}

impl VertexGrid {
    fn new(graph: &Graph, tolerance: f64) -> Option<Self> {
        let first = *graph.positions.first()?;
        let (low, high) =
            graph.positions.iter().fold((first, first), |(l, h), &p| (l.min(p), h.max(p)));
        let n = graph.positions.len() as f64;
        let size = high - low;
        let cell = (size.x * size.y / n).sqrt().max(size.max_element() / n).max(tolerance);
        if !(cell > 0.0 && cell.is_finite()) {
            return None;
        }
        let mut grid = Self {
            low,
            cell,
            n_columns: (size.x / cell) as usize + 1,
            n_rows: (size.y / cell) as usize + 1,
            vertices: Groups::default(),
        };
        let cells: Vec<usize> = graph
            .positions
            .iter()
            .map(|p| grid.row(p.y) * grid.n_columns + grid.column(p.x))
            .collect();
        grid.vertices = Groups::new(grid.n_columns * grid.n_rows, |sorter| {
            (0..).zip(&cells).for_each(|(vertex, &c)| sorter.put(c, vertex));
        });
        Some(grid)
    }

    fn column(&self, x: f64) -> usize {
        (((x - self.low.x) / self.cell) as usize).min(self.n_columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.low.y) / self.cell) as usize).min(self.n_rows - 1)
    }

    /// Calls `visit` with every vertex within `margin` of the segment, and with some others.
    fn near(&self, from: DVec2, to: DVec2, margin: f64, mut visit: impl FnMut(u32)) {
        let (left, right) = if from.x <= to.x { (from, to) } else { (to, from) };
        let slope = (right.y - left.y) / (right.x - left.x);
        let (low_y, high_y) = (from.y.min(to.y), from.y.max(to.y));
        for column in self.column(left.x - margin)..=self.column(right.x + margin) {
            let x0 = self.low.x + column as f64 * self.cell;
            // Wider than the column by a quarter on both sides: more than rounding and margin
            // ever are, as no cell is narrower than the margin.
            let slack = 0.25 * self.cell + margin;
            let (y0, y1) = (
                left.y + (x0 - slack - left.x) * slope,
                left.y + (x0 + self.cell + slack - left.x) * slope,
            );
            // A vertical piece has no slope: both are not numbers, and the whole height is kept.
            let (bottom, top) = if slope.is_finite() {
                (y0.min(y1).clamp(low_y, high_y), y0.max(y1).clamp(low_y, high_y))
            } else {
                (low_y, high_y)
            };
            for row in self.row(bottom - slack)..=self.row(top + slack) {
                let c = row * self.n_columns + column;
                self.vertices.of(c).iter().for_each(|&vertex| visit(vertex));
            }
        }
    }
}
