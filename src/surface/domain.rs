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
use crate::strokes::{GridFamily, StrokeKind};
use crate::surface::formula::Formula;

/// How often the edge on which the rim lies is halved: then it is known to the last bit of an edge
/// that does not begin at the origin.
const HALVINGS: u32 = 60;

/// A grid over a domain with a smooth rim: the border of the domain is found by bisection.
#[derive(Debug, Clone, PartialEq)]
pub struct TrimmedGrid {
    /// Samples outside of the domain are holes.
    grid: Grid,
    /// Where edges leave the domain, by the numbers of their samples, the one inside first.
    rim: FxHashMap<[u32; 2], DVec3>,
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
        Ok(Self { grid, rim })
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
        for (edge, p) in &mut self.rim {
            let Some(q) = other.rim.get_mut(edge) else { continue };
            if p.truncate() == q.truncate() && p.z != q.z && (p.z - q.z).abs() <= tolerance {
                p.z = 0.5 * p.z + 0.5 * q.z;
                q.z = p.z;
                n_moved += 1;
            }
        }
        n_moved
    }

    /// Multiplies all heights.
    pub fn scale_heights(&mut self, factor: f64) {
        self.grid.scale_heights(factor);
        self.rim.values_mut().for_each(|p| p.z *= factor);
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

impl LinedMesh {
    /// Adds the part of a surface inside its domain, with grid lines up to the rim, and the rim as
    /// lines of kind boundary if any grid lines are drawn. O(samples).
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
        let TrimmedGrid { grid, rim } = trimmed;
        let base = self.positions.len() as u32;
        self.push_grid_at(grid, lines, places);
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
                    let is_cut = corners.iter().any(|&k| inside(k));
                    if is_cut && !corners.iter().all(|&k| inside(k)) {
                        let mut polygon = Vec::with_capacity(4);
                        let mut cut = Vec::with_capacity(2);
                        for (a, b) in
                            [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (corners[a], corners[b]))
                        {
                            if inside(a) {
                                polygon.push(base + a);
                            }
                            if inside(a) != inside(b) {
                                let edge = if inside(a) { [a, b] } else { [b, a] };
                                if let Some(&number) = numbers.get(&edge) {
                                    polygon.push(number);
                                    cut.push(number);
                                }
                            }
                        }
                        polygon.dedup();
                        if polygon.first() == polygon.last() {
                            polygon.pop();
                        }
                        if let Some((&first, rest)) = polygon.split_first() {
                            for pair in rest.windows(2) {
                                self.push_triangle([first, pair[0], pair[1]], lines.triangles);
                            }
                        }
                        if let (true, &[a, b]) = (draws_rim && polygon.len() > 2, &cut[..])
                            && a != b
                        {
                            self.push_line([a, b], StrokeKind::Boundary, None);
                        }
                    }
                }
            }
        }
    }
}
