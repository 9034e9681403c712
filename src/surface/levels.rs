//! Level curves, as edges of the triangles they run over.
//!
//! ```text
//!            ● hi                  Each triangle is cut along z = level. The new vertices are
//!           ╱ ╲                    shared by the triangles on both sides of an edge, so that the
//!   ───────●───●────── level       cut surface has no cracks, and stand at the level's very z.
//!         ╱     ╲
//!     lo ●───────● mid             x and y of a new vertex are rounded once: it lies within
//!                                  4 ulps of its coordinates off the edge it cuts.
//! ```
//!
//! The cut surface is the scene: what is visible of it, level curves included, is then decided
//! exactly.

use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

use super::lined_mesh::{LinedMesh, SurfaceLine, sorted};
use crate::strokes::StrokeKind;

impl LinedMesh {
    /// How many pieces [`add_levels`](Self::add_levels) cuts the triangles into, at most.
    /// O(triangles log levels).
    pub fn n_pieces_with_levels(&self, levels: &[f64]) -> u64 {
        let levels = sorted(levels);
        let n_between = |corners: &[u32; 3]| {
            let heights = corners.map(|k| self.positions[k as usize].z);
            let low = heights.into_iter().fold(f64::INFINITY, f64::min);
            let high = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
            between(&levels, low, high).len() as u64
        };
        // A level cuts off a triangle or a quadrilateral from what is left.
        self.triangles.iter().map(|corners| 1 + 2 * n_between(corners)).sum()
    }

    /// Cuts all triangles at the given heights and draws lines of kind level there.
    ///
    /// A level curve is the border of what is as high as the level or higher: an edge at the level
    /// is drawn where a face beside it lies below. A plateau is thus outlined once, along its lower
    /// side. O(triangles + pieces).
    pub fn add_levels(&mut self, levels: &[f64]) {
        let levels = sorted(levels);
        let mut cutter = Cutter {
            levels: &levels,
            n_original: self.positions.len() as u32,
            positions: std::mem::take(&mut self.positions),
            origins: Vec::new(),
            cuts: FxHashMap::default(),
        };
        let mut triangles = Vec::with_capacity(self.triangles.len());
        let mut curves = Vec::new();
        for corners in &self.triangles {
            cutter.cut(*corners, &mut triangles, &mut curves);
        }
        // A ridge at a level is found from both of its sides.
        let mut seen = FxHashSet::default();
        curves.retain(|ends| seen.insert(*ends));
        let mut lines = Vec::with_capacity(self.lines.len() + curves.len());
        for line in &self.lines {
            cutter.split(*line, &mut lines);
        }
        lines.extend(curves.into_iter().map(|ends| SurfaceLine { ends, kind: StrokeKind::Level }));
        (self.positions, self.triangles, self.lines) = (cutter.positions, triangles, lines);
    }
}

/// The indices of the levels strictly between two heights.
fn between(levels: &[f64], low: f64, high: f64) -> std::ops::Range<usize> {
    let first = levels.partition_point(|z| *z <= low);
    first..levels.partition_point(|z| *z < high).max(first)
}

struct Cutter<'a> {
    levels: &'a [f64],
    n_original: u32,
    positions: Vec<DVec3>,
    /// For each new vertex, the lower and the upper end of the edge that it cuts.
    origins: Vec<[u32; 2]>,
    /// The new vertex on an edge, given by its lower and upper end, at a level, given by its number.
    cuts: FxHashMap<([u32; 2], u32), u32>,
}

impl Cutter<'_> {
    fn z(&self, vertex: u32) -> f64 {
        self.positions[vertex as usize].z
    }

    /// The vertex at a level on the edge, or the part of one, between two vertices on either side.
    fn vertex(&mut self, p: u32, q: u32, level: usize) -> u32 {
        // A part has at least one end that is new, and its whole is then where that came from.
        let origin = |v: u32| v.checked_sub(self.n_original).map(|k| self.origins[k as usize]);
        let edge = origin(p).or_else(|| origin(q)).unwrap_or(if self.z(p) < self.z(q) {
            [p, q]
        } else {
            [q, p]
        });
        if let Some(&vertex) = self.cuts.get(&(edge, level as u32)) {
            return vertex;
        }
        let [a, b] = edge.map(|v| self.positions[v as usize]);
        let z = self.levels[level];
        // Halves, since the difference of two finite heights may overflow.
        let t = (z / 2.0 - a.z / 2.0) / (b.z / 2.0 - a.z / 2.0);
        let vertex = self.positions.len() as u32;
        self.positions.push((a + t * (b - a)).with_z(z));
        self.origins.push(edge);
        self.cuts.insert((edge, level as u32), vertex);
        vertex
    }

    fn cut(&mut self, corners: [u32; 3], out: &mut Vec<[u32; 3]>, curves: &mut Vec<[u32; 2]>) {
        let heights = corners.map(|v| self.z(v));
        let low = heights.into_iter().fold(f64::INFINITY, f64::min);
        let high = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
        // Half-open: a vertex at the level counts as above it, so that a plateau is outlined along
        // its lower side only, and a ridge at the level is one line.
        if low < high && self.levels.binary_search_by(|l| l.total_cmp(&(high + 0.0))).is_ok() {
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                if self.z(a) == high && self.z(b) == high {
                    curves.push([a.min(b), a.max(b)]);
                }
            }
        }
        let mut above = corners.to_vec();
        for level in between(self.levels, low, high) {
            let z = self.levels[level];
            let (mut lower, mut upper) = (Vec::new(), Vec::new());
            let mut ends = Vec::with_capacity(2);
            for k in 0..above.len() {
                let (p, q) = (above[k], above[(k + 1) % above.len()]);
                let (zp, zq) = (self.z(p), self.z(q));
                if zp <= z {
                    lower.push(p);
                }
                if zp >= z {
                    upper.push(p);
                }
                if zp == z {
                    ends.push(p);
                }
                if (zp < z && z < zq) || (zq < z && z < zp) {
                    let vertex = self.vertex(p, q, level);
                    lower.push(vertex);
                    upper.push(vertex);
                    ends.push(vertex);
                }
            }
            if let &[a, b] = &ends[..] {
                curves.push([a, b]);
            }
            fan(&lower, out);
            above = upper;
        }
        fan(&above, out);
    }

    /// Splits a line at the new vertices on it.
    fn split(&self, line: SurfaceLine, out: &mut Vec<SurfaceLine>) {
        let [a, b] = line.ends;
        let (low, high) = if self.z(a) < self.z(b) { (a, b) } else { (b, a) };
        let mut last = low;
        for level in between(self.levels, self.z(low), self.z(high)) {
            if let Some(&vertex) = self.cuts.get(&([low, high], level as u32)) {
                out.push(SurfaceLine { ends: [last, vertex], ..line });
                last = vertex;
            }
        }
        out.push(SurfaceLine { ends: [last, high], ..line });
    }
}

/// Triangles of a convex polygon.
fn fan(corners: &[u32], out: &mut Vec<[u32; 3]>) {
    if let Some((&first, rest)) = corners.split_first() {
        out.extend(rest.windows(2).map(|pair| [first, pair[0], pair[1]]));
    }
}
