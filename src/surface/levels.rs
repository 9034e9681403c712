//! Level curves, as edges of the triangles they run over.
//!
//! ```text
//!            ● hi                  Each triangle is cut along z = level. The new vertices are
//!           ╱ ╲                    shared by the triangles on both sides of an edge, so that the
//!   ───────●───●────── level       cut surface has no cracks, and stand at the level's very z.
//!         ╱     ╲
//!     lo ●───────● mid             They lie where the function crosses the level, if it is known,
//!                                  and else on the edge, x and y rounded once.
//! ```
//!
//! The cut surface is the scene: what is visible of it, level curves included, is then decided
//! exactly.

use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

use super::crossings::{Crossing, places};
use super::height_function::HeightFunction;
use super::lined_mesh::{LinedMesh, SurfaceLine, sorted};
use crate::strokes::{StrokeKind, SurfacePart};

/// A sample of a function that is closer to a level than this part of the rise to its neighbors is at the
/// level, but for rounding. On paper this is less than a millionth of a cell.
const ROUNDING: f64 = 1.0 / (1u64 << 30) as f64;

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
    /// side. On sheets with a function the curves run through points of the function.
    /// O(triangles + pieces).
    pub fn add_levels(&mut self, levels: &[f64]) {
        let levels = sorted(levels);
        self.move_to_levels(&levels);
        self.cut_where_level(&levels);
        let traced = self.traced_places(&levels);
        let curves = self.split_at_levels(&levels, traced);
        self.lines.extend(curves);
    }

    /// Cuts all triangles and lines at the given heights, in rising order.
    pub(super) fn split_at_planes(&mut self, heights: &[f64]) {
        self.split_at_levels(heights, TracedPlaces::default());
    }

    /// Cuts all triangles and lines at the given heights; the lines there.
    fn split_at_levels(&mut self, levels: &[f64], traced: TracedPlaces) -> Vec<SurfaceLine> {
        let mut cutter = Cutter {
            levels,
            n_original: self.positions.len() as u32,
            positions: std::mem::take(&mut self.positions),
            origins: Vec::new(),
            cuts: FxHashMap::default(),
            traced,
        };
        let mut triangles = Vec::with_capacity(self.triangles.len());
        let mut curves = Vec::new();
        let mut curve_lines = Vec::new();
        let mut firsts = Vec::with_capacity(self.sheets.len());
        // A ridge at a level is found from both of its sides.
        let mut seen = FxHashSet::default();
        for (k, corners) in self.triangles.iter().enumerate() {
            while self.sheets.get(firsts.len()).is_some_and(|sheet| sheet.first_triangle <= k) {
                firsts.push(triangles.len());
            }
            curves.clear();
            cutter.cut(*corners, &mut triangles, &mut curves);
            for (ends, level) in &curves {
                if seen.insert(*ends) {
                    let [sheet, level] = [firsts.len(), level + 1]
                        .map(|number| u16::try_from(number).unwrap_or(u16::MAX));
                    let part = SurfacePart { sheet, level, family: None };
                    curve_lines.push(SurfaceLine { ends: *ends, kind: StrokeKind::Level, part });
                }
            }
        }
        firsts.resize(self.sheets.len(), triangles.len());
        for (sheet, first_triangle) in self.sheets.iter_mut().zip(firsts) {
            sheet.first_triangle = first_triangle;
        }
        let mut lines = Vec::with_capacity(self.lines.len());
        for line in &self.lines {
            cutter.split(*line, &mut lines);
        }
        (self.positions, self.triangles, self.lines) = (cutter.positions, triangles, lines);
        curve_lines
    }

    /// Makes curves index lines that `is_index` is true for, by the numbers of their levels, from 1 for the
    /// lowest.
    pub fn mark_index_levels(&mut self, is_index: impl Fn(u16) -> bool) {
        for line in &mut self.lines {
            if line.kind == StrokeKind::Level && is_index(line.part.level) {
                line.kind = StrokeKind::Index;
            }
        }
    }

    /// The sheets that are traced on a function, each with its triangles.
    fn traced_sheets(&self) -> impl Iterator<Item = (&HeightFunction, std::ops::Range<usize>)> {
        let ends = self.sheets.iter().skip(1).map(|sheet| sheet.first_triangle);
        let ends = ends.chain([self.triangles.len()]);
        self.sheets
            .iter()
            .zip(ends)
            .filter_map(|(sheet, end)| Some((sheet.function.as_ref()?, sheet.first_triangle..end)))
    }

    /// The lower and the upper end of an edge.
    fn by_height(&self, [a, b]: [u32; 2]) -> [u32; 2] {
        let z = |vertex: u32| self.positions[vertex as usize].z;
        if (z(a), a) < (z(b), b) { [a, b] } else { [b, a] }
    }

    /// Where functions cross the levels on the edges of triangles.
    fn traced_places(&self, levels: &[f64]) -> TracedPlaces {
        let mut traced = TracedPlaces::default();
        for (function, triangles) in self.traced_sheets() {
            let mut crossings = Vec::new();
            let first_place = traced.places.len();
            for &[a, b, c] in &self.triangles[triangles] {
                for edge in [[a, b], [b, c], [c, a]].map(|ends| self.by_height(ends)) {
                    let [low, high] = edge.map(|vertex| self.positions[vertex as usize]);
                    let crossed = between(levels, low.z, high.z);
                    if crossed.is_empty() || traced.first.contains_key(&edge) {
                        continue;
                    }
                    let first = first_place + crossings.len();
                    traced.first.insert(edge, (first, crossed.start));
                    let of = |level: &f64| Crossing { low, high, level: *level };
                    crossings.extend(levels[crossed].iter().map(of));
                }
            }
            traced.places.extend(places(function, &crossings));
        }
        traced
    }

    /// Moves vertices of functions to levels that they miss by rounding only: x² − y² is not 0 in all samples
    /// with x = y. A crossing between such a vertex and the next could not be distinguished from the vertex.
    fn move_to_levels(&mut self, levels: &[f64]) {
        let mut rises = vec![0.0_f64; self.positions.len()];
        for (_, triangles) in self.traced_sheets() {
            for &[a, b, c] in &self.triangles[triangles] {
                for ends in [[a, b], [b, c], [c, a]] {
                    let [p, q] = ends.map(|vertex| self.positions[vertex as usize].z);
                    for vertex in ends {
                        let rise = &mut rises[vertex as usize];
                        *rise = rise.max((p - q).abs());
                    }
                }
            }
        }
        for (position, rise) in self.positions.iter_mut().zip(rises) {
            let next = levels.partition_point(|level| *level < position.z);
            let near = levels[next.saturating_sub(1)..].iter().take(2);
            let nearest =
                near.min_by(|a, b| (*a - position.z).abs().total_cmp(&(*b - position.z).abs()));
            if let Some(level) = nearest
                && (level - position.z).abs() < ROUNDING * rise
            {
                position.z = *level;
            }
        }
    }

    /// Adds vertices on edges that end at a level, where the function is not what the ends say, and splits
    /// triangles and lines there.
    ///
    /// ```text
    ///      ╭──●───●    × where the function first reaches a plateau at the level
    ///     ╱   ×
    ///    ●
    ///    ●──╮ ╭───●    × where it dips below the level between two ends at the level, or, if it
    ///       ╰×╯          does not, where another level curve crosses the edge
    /// ```
    fn cut_where_level(&mut self, levels: &[f64]) {
        let mut edges: FxHashMap<[u32; 2], Option<u32>> = FxHashMap::default();
        let mut found: Vec<DVec3> = Vec::new();
        for (function, triangles) in self.traced_sheets() {
            for &[a, b, c] in &self.triangles[triangles] {
                for edge in [[a, b], [b, c], [c, a]].map(|ends| self.by_height(ends)) {
                    let [low, high] = edge.map(|vertex| self.positions[vertex as usize]);
                    if number_of(levels, high.z).is_none() {
                        continue;
                    }
                    edges.entry(edge).or_insert_with(|| {
                        found.push(if low.z < high.z {
                            function.plateau_edge(low, high)?
                        } else {
                            // The function may well not be level between the ends.
                            let dip = function.extreme(low, high, false);
                            dip.or_else(|| function.crossing_of_level_edge(low, high))?
                        });
                        Some((self.positions.len() + found.len() - 1) as u32)
                    });
                }
            }
        }
        if found.is_empty() {
            return;
        }
        let n_before = self.positions.len() as u32;
        let z = |vertex: u32| match vertex.checked_sub(n_before) {
            Some(new) => found[new as usize].z,
            None => self.positions[vertex as usize].z,
        };
        let middle = |mesh: &Self, ends: [u32; 2]| *edges.get(&mesh.by_height(ends))?;
        let mut triangles = Vec::with_capacity(self.triangles.len());
        let mut firsts = self.sheets.iter().map(|sheet| sheet.first_triangle).peekable();
        let mut new_firsts = Vec::with_capacity(self.sheets.len());
        for (k, &corners) in self.triangles.iter().enumerate() {
            while firsts.next_if(|first| *first <= k).is_some() {
                new_firsts.push(triangles.len());
            }
            let [a, b, c] = corners;
            let middles = [[a, b], [b, c], [c, a]].map(|ends| middle(self, ends));
            split_triangle(corners, middles, &z, &mut triangles);
        }
        new_firsts.resize(self.sheets.len(), triangles.len());
        let mut lines = Vec::with_capacity(self.lines.len());
        for line in &self.lines {
            let [a, b] = line.ends;
            match middle(self, line.ends) {
                Some(m) => lines.extend([[a, m], [m, b]].map(|ends| SurfaceLine { ends, ..*line })),
                None => lines.push(*line),
            }
        }
        (self.triangles, self.lines) = (triangles, lines);
        self.positions.extend(found);
        for (sheet, first_triangle) in self.sheets.iter_mut().zip(new_firsts) {
            sheet.first_triangle = first_triangle;
        }
    }
}

/// The number of the level at a height; −0 is 0.
fn number_of(levels: &[f64], height: f64) -> Option<usize> {
    levels.binary_search_by(|level| level.total_cmp(&(height + 0.0))).ok()
}

/// Splits a triangle at points on its sides: that between corners 0 and 1, 1 and 2, 2 and 0.
fn split_triangle(
    corners: [u32; 3],
    middles: [Option<u32>; 3],
    z: &impl Fn(u32) -> f64,
    out: &mut Vec<[u32; 3]>,
) {
    let [a, b, c] = corners;
    match middles {
        [None, None, None] => out.push(corners),
        [Some(m), None, None] => out.extend([[a, m, c], [m, b, c]]),
        [Some(m), Some(n), None] => {
            out.push([m, b, n]);
            // A diagonal from a dip would part what is at the level on both sides of it.
            if z(m).min(z(c)) >= z(a).min(z(n)) {
                out.extend([[a, m, c], [m, n, c]]);
            } else {
                out.extend([[a, m, n], [a, n, c]]);
            }
        }
        [Some(m), Some(n), Some(o)] => out.extend([[a, m, o], [m, b, n], [n, c, o], [m, n, o]]),
        // The next corner first.
        [first, second, third] => split_triangle([b, c, a], [second, third, first], z, out),
    }
}

/// Places of crossings on functions.
#[derive(Default)]
struct TracedPlaces {
    /// For an edge, by its lower and upper end, its first place and the number of its level.
    first: FxHashMap<[u32; 2], (usize, usize)>,
    /// Parts of the ways from the lower to the upper ends, in the order of levels on each edge.
    places: Vec<f64>,
}

impl TracedPlaces {
    fn place(&self, edge: [u32; 2], level: usize) -> Option<f64> {
        let (first, first_level) = self.first.get(&edge)?;
        Some(self.places[first + level - first_level])
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
    traced: TracedPlaces,
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
        let straight = || Crossing { low: a, high: b, level: z }.straight();
        let t = self.traced.place(edge, level).unwrap_or_else(straight);
        let vertex = self.positions.len() as u32;
        self.positions.push((a + t * (b - a)).with_z(z));
        self.origins.push(edge);
        self.cuts.insert((edge, level as u32), vertex);
        vertex
    }

    fn cut(
        &mut self,
        corners: [u32; 3],
        out: &mut Vec<[u32; 3]>,
        curves: &mut Vec<([u32; 2], usize)>,
    ) {
        let heights = corners.map(|v| self.z(v));
        let low = heights.into_iter().fold(f64::INFINITY, f64::min);
        let high = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
        // Half-open: a vertex at the level counts as above it, so that a plateau is outlined along
        // its lower side only, and a ridge at the level is one line.
        if low < high
            && let Some(level) = number_of(self.levels, high)
        {
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                if self.z(a) == high && self.z(b) == high {
                    curves.push(([a.min(b), a.max(b)], level));
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
                curves.push(([a, b], level));
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
