//! Surfaces over a part of the plane: a grid cut off where a formula stops being true.
//!
//! ```text
//!   ○────○────○        ● inside   ○ outside   × rim: the last point inside on each edge of a
//!   │  ╱ │  ╱ │          triangle that leaves the domain, found by bisection
//!   ×╌╌╌╌×  ╱ │
//!   │  ╱ │╲ ╱ │        Triangles are cut along the rim, whose points are shared by the triangles
//!   ●────●─×──○        on both sides of an edge, so that the surface has no cracks. The height
//!                      there is the function's own.
//! ```

use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::grid::{Grid, GridError, check_ranges, check_size, evenly};
use super::height_function::HeightFunction;
use super::lined_mesh::{LatticeLines, LinedMesh};
use super::places::Places;
use super::tears::{STILL, TornFunction, ends_of};
use crate::strokes::{GridFamily, StrokeKind};
use crate::surface::formula::{Formula, JetGraph};

/// How often the edge on which the rim lies is halved: then it is known to the last bit of an edge
/// that does not begin at the origin.
const HALVINGS: u32 = 60;

/// Heights that grow by this on the last millionth of an edge grow without end: a logarithm grows by a
/// third there, and the first power of 1/x by 64 times.
const GROWTH: f64 = 1.1;

/// Heights that differ by less than this part of the range of heights are the same.
const SAME_HEIGHT: f64 = 1e-6;

/// A rim that passes a sample this closely, as a fraction of an edge, runs through it: several points of the
/// rim beside one another would differ by little more than their rounding, which makes dents in the rim.
const AT_SAMPLE: f64 = 1e-6;

/// A grid over a domain with a smooth rim: the border of the domain is found by bisection.
#[derive(Debug, Clone, PartialEq)]
pub struct TrimmedGrid {
    /// Samples outside of the domain are holes.
    grid: Grid,
    /// Where edges leave the domain, by the numbers of their samples, the one inside first. An edge that
    /// is torn between two samples inside is left from both of them.
    rim: FxHashMap<[u32; 2], DVec3>,
    has_poles: bool,
    /// The lowest and the highest height, where heights are cut off.
    heights: Option<(f64, f64)>,
}

/// What a grid is cut off by, besides its formula.
pub(super) struct Cutting<'a> {
    /// Where the surface is.
    pub(super) domain: Option<&'a HeightFunction>,
    /// The heights that it has.
    pub(super) heights: Option<(f64, f64)>,
    /// Heights that are closer than this meet where the formula has a gap.
    pub(super) closes: f64,
}

impl TrimmedGrid {
    /// Samples `formula` as [`Grid::sample`] does, but only where `domain` is true, if there is one, and the
    /// formula has a value. Features narrower than a cell may be missed.
    ///
    /// O(samples + cut edges · `HALVINGS`), in parallel.
    ///
    /// # Errors
    /// As [`Grid::sample`].
    pub fn sample(
        formula: &Formula,
        domain: Option<&Formula>,
        x: (f64, f64),
        y: (f64, f64),
        n: (usize, usize),
    ) -> Result<Self, GridError> {
        check_size(n.0, n.1)?;
        check_ranges(x, y)?;
        let function = HeightFunction::new(formula.clone(), 1.0);
        let domain = domain.map(|domain| HeightFunction::new(domain.clone(), 1.0));
        let (xs, ys) = (evenly(x.0, x.1, n.0), evenly(y.0, y.1, n.1));
        Self::sample_at(&function, domain.as_ref(), xs, ys)
    }

    /// The same for formulas in the coordinates of the drawn surface, on given lines.
    ///
    /// # Errors
    /// As [`Grid::sample_at`].
    pub fn sample_at(
        function: &HeightFunction,
        domain: Option<&HeightFunction>,
        xs: Vec<f64>,
        ys: Vec<f64>,
    ) -> Result<Self, GridError> {
        let n = (xs.len(), ys.len());
        let whole = Grid::sample_at(function, xs, ys)?;
        let (xs, ys) = (whole.xs().to_vec(), whole.ys().to_vec());
        let mut zs = whole.zs().to_vec();
        if let Some(domain) = domain {
            zs.par_chunks_mut(n.0).zip(&ys).for_each(|(row, &y)| {
                let mut holds = vec![0.0; xs.len()];
                domain.heights(&xs, &vec![y; xs.len()], &mut holds);
                for (z, holds) in row.iter_mut().zip(holds) {
                    if !is_true(holds) {
                        *z = f64::NAN;
                    }
                }
            });
        }
        let grid = Grid::new(xs, ys, zs)?;
        let rim = (0..n.1 as u32)
            .into_par_iter()
            .flat_map_iter(|j| leaving_edges(&grid, j))
            .map(|edge| (edge, last_inside(&grid, function, domain, edge)))
            .collect();
        let mut trimmed = Self { grid, rim, has_poles: false, heights: None };
        trimmed.move_rim_to_samples();
        Ok(trimmed)
    }

    /// Samples `function` on given lines where it has a value, torn open where it jumps.
    ///
    /// # Errors
    /// As [`Grid::sample_at`].
    pub(super) fn sample_torn(
        function: &HeightFunction,
        jets: JetGraph,
        cutting: &Cutting,
        xs: Vec<f64>,
        ys: Vec<f64>,
    ) -> Result<Self, GridError> {
        let &Cutting { domain, heights, closes } = cutting;
        let whole = Grid::sample_at(function, xs, ys)?;
        let torn = TornFunction::new(function, jets, closes);
        let (xs, ys) = (whole.xs().to_vec(), whole.ys().to_vec());
        let nx = xs.len();
        let zs = (0..whole.zs().len()).into_par_iter().map(|k| {
            let z = whole.zs()[k];
            let z = if z.is_nan() { torn.filled(&whole, k).unwrap_or(z) } else { z };
            let is_in = heights.is_none_or(|(low, high)| (low..=high).contains(&z))
                && domain.is_none_or(|domain| is_true(domain.height(xs[k % nx], ys[k / nx])));
            if is_in { z } else { f64::NAN }
        });
        let zs: Vec<f64> = zs.collect();
        let grid = Grid::new(xs.clone(), ys, zs)?;
        let last = |from: DVec3, to: DVec3| last_before(function, domain, heights, from, to);
        let mut rim: FxHashMap<[u32; 2], DVec3> = (0..grid.ys().len() as u32)
            .into_par_iter()
            .flat_map_iter(|j| leaving_edges(&grid, j))
            .map(|edge @ [a, b]| (edge, last(grid.point(a), grid.point(b))))
            .collect();
        let tears: Vec<_> = torn
            .tears(&grid)
            .into_par_iter()
            .map(|tear| (tear.edge, ends_of(&grid, &tear, last)))
            .collect();
        for ([a, b], [from_a, from_b]) in tears {
            rim.insert([a, b], from_a);
            rim.insert([b, a], from_b);
        }
        let is_pole = |(edge, end): (&[u32; 2], &DVec3)| {
            let [a, b] = edge.map(|k| grid.point(k).truncate());
            let before = end.truncate() - STILL * (b - a);
            let z = function.height(before.x, before.y);
            end.z.abs() > GROWTH * z.abs() && (end.z - z).abs() > closes
        };
        let has_poles = heights.is_none() && rim.par_iter().any(is_pole);
        let mut trimmed = Self { grid, rim, has_poles, heights };
        // The heights at poles are only cut off when they are known.
        if !has_poles {
            trimmed.move_rim_to_samples();
        }
        Ok(trimmed)
    }

    /// Lets the rim run through the samples that it nearly touches, at its own height there. A sample on
    /// the rim is inside.
    fn move_rim_to_samples(&mut self) {
        let part = |[a, b]: [u32; 2], p: &DVec3| {
            let [from, to] = [a, b].map(|k| self.grid.point(k).truncate());
            let t = (p.truncate() - from).abs().max_element() / (to - from).abs().max_element();
            if t < AT_SAMPLE { Some(a) } else { (t > 1.0 - AT_SAMPLE).then_some(b) }
        };
        let mut near: Vec<(u32, [u32; 2], f64)> = (self.rim.par_iter())
            .filter(|(edge, _)| !self.is_torn(edge[0], edge[1]))
            .filter_map(|(edge, p)| Some((part(*edge, p)?, *edge, p.z)))
            .collect();
        near.par_sort_unstable_by_key(|&(sample, edge, _)| (sample, edge));
        let mut heights = Vec::new();
        for of_sample in near.chunk_by(|one, other| one.0 == other.0) {
            let (sample, _, z) = of_sample[0];
            let point = self.grid.point(sample).with_z(z);
            let is_outside = |k: &u32| self.grid.zs()[*k as usize].is_nan();
            let (outside, inside): (Vec<u32>, Vec<u32>) =
                neighbors(&self.grid, sample).partition(is_outside);
            if is_outside(&sample) {
                // Where one edge comes to the sample inside, another may leave the domain before it.
                if inside.len() != of_sample.len() {
                    continue;
                }
                for k in inside {
                    self.rim.remove(&[k, sample]);
                }
            }
            // An edge that runs on inside beside the rim ends here too: its end would make a triangle of
            // three points of the rim.
            self.rim.extend(outside.into_iter().map(|k| ([sample, k], point)));
            heights.push((sample, z));
        }
        for &(sample, _) in &heights {
            // Two samples on the rim may be neighbors.
            for other in neighbors(&self.grid, sample) {
                if heights.binary_search_by_key(&other, |of| of.0).is_ok() {
                    self.rim.remove(&[sample, other]);
                }
            }
        }
        self.grid.set_heights(&heights);
    }

    /// Whether heights seem to grow without end somewhere along the rim.
    pub(super) fn has_poles(&self) -> bool {
        self.has_poles
    }

    /// Whether the edge between two samples is torn: whether there is nothing somewhere between them.
    pub(super) fn is_torn(&self, a: u32, b: u32) -> bool {
        self.rim.contains_key(&[a, b]) && self.rim.contains_key(&[b, a])
    }

    /// Whether no edge leaves the domain: all is inside, or all is outside.
    pub fn is_whole(&self) -> bool {
        self.rim.is_empty()
    }

    /// The samples; those outside of the domain are holes.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The points of the rim, in no order.
    pub fn rim(&self) -> impl Iterator<Item = DVec3> {
        self.rim.values().copied()
    }

    /// The least and greatest height; `None` when all is outside of the domain.
    pub fn heights(&self) -> Option<(f64, f64)> {
        let inside = self.grid.heights()?;
        let rim = self.rim.values().map(|p| p.z);
        Some(rim.fold(inside, |(low, high), z| (low.min(z), high.max(z))))
    }

    /// Whether both end at the same places, at heights within `tolerance` of each other.
    pub fn shares_rim(&self, other: &Self, tolerance: f64) -> bool {
        let meets = |(edge, p): (&[u32; 2], &DVec3)| {
            let q = other.rim.get(edge);
            q.is_some_and(|q| p.truncate() == q.truncate() && (p.z - q.z).abs() <= tolerance)
        };
        !self.rim.is_empty() && self.rim.len() == other.rim.len() && self.rim.iter().all(meets)
    }

    /// Closes the gap that rounding leaves where two sheets end at the same rim: wherever both have a
    /// rim point at the same x and y, at heights within `tolerance` of each other, both take the mean
    /// height. Returns how many such points differed. `tolerance` is a height in model units.
    pub fn meet_at_rim(&mut self, other: &mut Self, tolerance: f64) -> usize {
        let mut n_moved = 0;
        let mut samples = Vec::new();
        for (edge, p) in &mut self.rim {
            let Some(q) = other.rim.get_mut(edge) else { continue };
            if p.truncate() == q.truncate() && p.z != q.z && (p.z - q.z).abs() <= tolerance {
                let is_sample = self.grid.point(edge[0]) == *p && other.grid.point(edge[0]) == *q;
                p.z = 0.5 * p.z + 0.5 * q.z;
                q.z = p.z;
                n_moved += 1;
                if is_sample {
                    samples.push((edge[0], p.z));
                }
            }
        }
        self.grid.set_heights(&samples);
        other.grid.set_heights(&samples);
        n_moved
    }

    /// Multiplies all heights.
    pub fn scale_heights(&mut self, factor: f64) {
        self.grid.scale_heights(factor);
        self.rim.values_mut().for_each(|p| p.z *= factor);
        self.heights = self.heights.map(|(low, high)| (low * factor, high * factor));
    }

    /// Whether the surface is cut off at the height of two points.
    fn is_cut_at(&self, a: DVec3, b: DVec3) -> bool {
        a.z == b.z && self.heights.is_some_and(|(low, high)| a.z == low || a.z == high)
    }

    /// Multiplies the x and y of all points by factors above 0.
    pub(super) fn scale_lines(&mut self, x: f64, y: f64) {
        self.grid.scale_lines(x, y);
        for p in self.rim.values_mut() {
            (p.x, p.y) = (p.x * x, p.y * y);
        }
    }
}

fn is_true(value: f64) -> bool {
    value != 0.0 && !value.is_nan()
}

/// The edges between row `j` and the next one, and along row `j`, that have one end inside.
fn leaving_edges(grid: &Grid, j: u32) -> Vec<[u32; 2]> {
    let (nx, ny) = (grid.xs().len() as u32, grid.ys().len() as u32);
    let inside = |k: u32| !grid.zs()[k as usize].is_nan();
    let mut edges = Vec::new();
    for i in 0..nx {
        let k = j * nx + i;
        let right = (i + 1 < nx).then_some(k + 1);
        let above = (j + 1 < ny).then_some(k + nx);
        let across = right.and(above).map(|above| above + 1);
        for other in [right, above, across].into_iter().flatten() {
            match (inside(k), inside(other)) {
                (true, false) => edges.push([k, other]),
                (false, true) => edges.push([other, k]),
                _ => {}
            }
        }
    }
    edges
}

/// The samples that share an edge with one.
fn neighbors(grid: &Grid, sample: u32) -> impl Iterator<Item = u32> + use<> {
    let (nx, ny) = (grid.xs().len() as u32, grid.ys().len() as u32);
    let (i, j) = (sample % nx, sample / nx);
    let (left, right, below, above) = (i > 0, i + 1 < nx, j > 0, j + 1 < ny);
    let edges = [
        (left, sample.wrapping_sub(1)),
        (right, sample + 1),
        (below, sample.wrapping_sub(nx)),
        (above, sample + nx),
        (left && below, sample.wrapping_sub(nx + 1)),
        (right && above, sample + nx + 1),
    ];
    edges.into_iter().filter_map(|(exists, other)| exists.then_some(other))
}

/// The last point on the way from the first sample to the second that is known to be inside.
fn last_inside(
    grid: &Grid,
    function: &HeightFunction,
    domain: Option<&HeightFunction>,
    [a, b]: [u32; 2],
) -> DVec3 {
    let holds = |p: DVec3| domain.is_none_or(|domain| is_true(domain.height(p.x, p.y)));
    let start = grid.point(a);
    let way = (grid.point(b) - start).with_z(0.0);
    let (mut last, mut low, mut high) = (start, 0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let p = start + middle * way;
        let z = function.height(p.x, p.y);
        if z.is_finite() && holds(p) {
            (low, last) = (middle, p.with_z(z + 0.0));
        } else {
            high = middle;
        }
    }
    last
}

/// The last point on the way from one place with a height to another that is known to be inside, where
/// the surface may end at a lowest or highest height.
fn last_before(
    function: &HeightFunction,
    domain: Option<&HeightFunction>,
    heights: Option<(f64, f64)>,
    from: DVec3,
    to: DVec3,
) -> DVec3 {
    let height = |t: f64| {
        let p = from + t * (to - from).with_z(0.0);
        let holds = domain.is_none_or(|domain| is_true(domain.height(p.x, p.y)));
        (p, if holds { function.height(p.x, p.y) + 0.0 } else { f64::NAN })
    };
    let is_in =
        |z: f64| z.is_finite() && heights.is_none_or(|(low, high)| (low..=high).contains(&z));
    let (end, z) = height(1.0);
    if is_in(z) {
        return end.with_z(z);
    }
    let (mut last, mut beyond, mut low, mut high) = (from, z, 0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let (p, z) = height(middle);
        if is_in(z) {
            (low, last) = (middle, p.with_z(z));
        } else {
            (high, beyond) = (middle, z);
        }
    }
    // Where the surface runs through its highest or lowest height it ends at that very height.
    let ends_at = heights.and_then(|(low, high)| {
        let is_near = |end: f64| (end - last.z).abs() <= SAME_HEIGHT * (high - low);
        [(high, beyond > high), (low, beyond < low)]
            .into_iter()
            .find_map(|(end, is_passed)| (is_passed && is_near(end)).then_some(end))
    });
    last.with_z(ends_at.unwrap_or(last.z))
}

impl LinedMesh {
    /// Adds the part of a surface inside its domain, with grid lines up to the rim, the rim as lines of kind
    /// boundary if any grid lines are drawn, and lines of kind cut where heights are cut off. O(samples).
    pub fn push_trimmed(&mut self, trimmed: &TrimmedGrid, lines: &LatticeLines) {
        self.push_trimmed_at(trimmed, lines, None);
    }

    /// As [`push_trimmed`](Self::push_trimmed), of a grid on lines that are not all the surface's own.
    pub(super) fn push_trimmed_at(
        &mut self,
        trimmed: &TrimmedGrid,
        lines: &LatticeLines,
        places: Option<&Places>,
    ) {
        let TrimmedGrid { grid, rim, .. } = trimmed;
        let base = self.positions.len() as u32;
        self.push_grid_at(grid, lines, places, &|a, b| trimmed.is_torn(a as u32, b as u32));
        let rim_from = self.positions.len() as u32;
        if let Some(sheet) = self.sheets.last_mut() {
            sheet.rim_from = rim_from;
        }
        let [columns, rows] = lines.drawn((grid.xs().len(), grid.ys().len()), places);
        let nx = grid.xs().len() as u32;
        let inside = |k: u32| !grid.zs()[k as usize].is_nan();
        let mut edges: Vec<[u32; 2]> = rim.keys().copied().collect();
        edges.sort_unstable();
        let mut numbers = FxHashMap::default();
        for edge in edges {
            let p = rim[&edge];
            // A rim that runs exactly through a sample adds no point there.
            let number = if p == grid.point(edge[0]) {
                base + edge[0]
            } else {
                self.positions.push(p);
                self.positions.len() as u32 - 1
            };
            numbers.insert(edge, number);
            let [a, b] = edge.map(|k| (k % nx, k / nx));
            let along_row = a.1 == b.1 && rows[a.1 as usize];
            let along_column = a.0 == b.0 && columns[a.0 as usize];
            if number != base + edge[0] && (along_row || along_column) {
                let family = if along_row { GridFamily::AlongX } else { GridFamily::AlongY };
                self.push_line([base + edge[0], number], StrokeKind::Grid, Some(family));
            }
        }
        let draws_rim = lines.along_rows || lines.along_columns;
        for j in 0..grid.ys().len() as u32 - 1 {
            for i in 0..nx - 1 {
                let k = j * nx + i;
                for corners in [[k, k + 1, k + nx + 1], [k, k + nx + 1, k + nx]] {
                    let sides = [0, 1, 2].map(|side| [corners[side], corners[(side + 1) % 3]]);
                    let is_whole =
                        |[a, b]: [u32; 2]| inside(a) && inside(b) && !trimmed.is_torn(a, b);
                    let n_whole = sides.into_iter().filter(|side| is_whole(*side)).count();
                    if n_whole == 3 || !corners.iter().any(|&k| inside(k)) {
                        continue;
                    }
                    for run in runs(sides, n_whole, base, &inside, &numbers) {
                        let Some((&first, rest)) = run.split_first() else { continue };
                        for pair in rest.windows(2) {
                            self.push_triangle([first, pair[0], pair[1]], lines.triangles);
                        }
                        if run.len() < 3 || n_whole == 2 {
                            continue;
                        }
                        let ends = [run[run.len() - 1], first];
                        let [a, b] = ends.map(|vertex| self.positions[vertex as usize]);
                        if trimmed.is_cut_at(a, b) {
                            self.push_line(ends, StrokeKind::Cut, None);
                        } else if draws_rim {
                            self.push_line(ends, StrokeKind::Boundary, None);
                        }
                    }
                }
            }
        }
    }
}

/// What is left of a triangle that the rim cuts: polygons that run along its border from one point of the
/// rim to the next. A tear that only one side of it shows ends at the corner across.
fn runs(
    mut sides: [[u32; 2]; 3],
    n_whole: usize,
    base: u32,
    inside: &impl Fn(u32) -> bool,
    numbers: &FxHashMap<[u32; 2], u32>,
) -> Vec<Vec<u32>> {
    let cut = |[a, b]: [u32; 2]| (numbers.get(&[a, b]), numbers.get(&[b, a]));
    let is_torn = |side: [u32; 2]| matches!(cut(side), (Some(_), Some(_)));
    // Begin right after a side that is cut or lies outside.
    let is_whole = |[a, b]: [u32; 2]| inside(a) && inside(b) && !is_torn([a, b]);
    while is_whole(sides[2]) && n_whole < 3 {
        sides.rotate_right(1);
    }
    let [.., last] = sides;
    if n_whole == 2
        && let (Some(&near), Some(&far)) = cut(last)
    {
        let [a, b] = last.map(|k| base + k);
        let across = base + sides[0][1];
        return vec![without_repeats(vec![across, a, near]), without_repeats(vec![across, far, b])];
    }
    let mut runs = Vec::new();
    let mut run: Vec<u32> = cut(last).1.copied().into_iter().collect();
    for side @ [a, _] in sides {
        if inside(a) {
            run.push(base + a);
        }
        if is_whole(side) {
            continue;
        }
        let (end, start) = cut(side);
        run.extend(end.copied());
        runs.push(without_repeats(std::mem::take(&mut run)));
        run.extend(start.copied());
    }
    runs
}

fn without_repeats(mut polygon: Vec<u32>) -> Vec<u32> {
    polygon.dedup();
    while polygon.len() > 1 && polygon.first() == polygon.last() {
        polygon.pop();
    }
    polygon
}
