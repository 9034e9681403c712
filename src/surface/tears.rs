//! Where a function jumps, has a pole or has no value: the edges between samples that a surface is torn
//! along.
//!
//! ```text
//!   ●───×   ×───●     Enclosures that cannot be shown to be continuous are halved until they are narrower
//!   │  ╱      ╱ │     than anything on paper. What is left is a tear: × are the last points on both of
//!   │╱      ╱   │     its sides. If these meet, only the rule for the formula breaks there, as that of
//!   ●───×   ×───●     sin(x)/x does, and the edge is whole.
//! ```

use glam::DVec3;
use rayon::prelude::*;

use super::Grid;
use super::formula::{Class, Interval, Jet, JetGraph};
use super::height_function::HeightFunction;

/// Cells along both sides of a block that is enclosed at once.
const BLOCK: usize = 8;

/// How often an edge is halved: to parts of 10⁻⁸ of it, less than 10⁻⁶ mm on paper.
const HALVINGS: u32 = 26;

/// Parts of an edge that are halved further at the same time. An edge with more tears is left whole.
const MOST_PARTS: usize = 8;

/// A part of an edge, on both sides of a tear, over which heights must keep still if the tear is none.
pub(super) const STILL: f64 = 1.0 / (1 << 20) as f64;

/// A function whose tears are looked for.
pub(super) struct TornFunction<'a> {
    function: &'a HeightFunction,
    jets: JetGraph,
    /// Heights that are closer than this are joined.
    closes: f64,
}

/// A torn edge: its samples, and the parts of the way from the first to the second that are whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tear {
    pub(super) edge: [u32; 2],
    pub(super) from: f64,
    pub(super) to: f64,
}

impl<'a> TornFunction<'a> {
    pub(super) fn new(function: &'a HeightFunction, jets: JetGraph, closes: f64) -> Self {
        Self { function, jets, closes }
    }

    /// All edges and diagonals of cells that are torn, with heights at both ends. O(samples) enclosures at
    /// worst, in parallel.
    pub(super) fn tears(&self, grid: &Grid) -> Vec<Tear> {
        let rows = (grid.ys().len() - 1).div_ceil(BLOCK);
        let of_row = |row: usize| {
            let mut found = Vec::new();
            let mut room = Vec::new();
            let rows = [row * BLOCK, ((row + 1) * BLOCK).min(grid.ys().len() - 1)];
            for start in (0..grid.xs().len() - 1).step_by(BLOCK) {
                let columns = [start, (start + BLOCK).min(grid.xs().len() - 1)];
                self.block(grid, columns, rows, &mut room, &mut found);
            }
            found
        };
        (0..rows).into_par_iter().flat_map_iter(of_row).collect()
    }

    /// Looks at the cells from one column and row to others.
    fn block(
        &self,
        grid: &Grid,
        columns @ [left, right]: [usize; 2],
        rows @ [low, high]: [usize; 2],
        room: &mut Vec<Jet>,
        found: &mut Vec<Tear>,
    ) {
        let (xs, ys, nx) = (grid.xs(), grid.ys(), grid.xs().len());
        let has_height = |k: usize| !grid.zs()[k].is_nan();
        let x = Interval::new(xs[left], xs[right]);
        let y = Interval::new(ys[low], ys[high]);
        let class = self.jets.over(x, y, [1.0, 1.0], room).class;
        if class >= Class::Continuous || class == Class::Nowhere {
            return;
        }
        if right - left > 1 || high - low > 1 {
            let halves = |[from, to]: [usize; 2]| {
                let middle = from + (to - from).div_ceil(2);
                [[from, middle], [middle, to]]
            };
            for rows in halves(rows) {
                for columns in halves(columns) {
                    if rows[0] < rows[1] && columns[0] < columns[1] {
                        self.block(grid, columns, rows, room, found);
                    }
                }
            }
            return;
        }
        let k = low * nx + left;
        let mut edges = vec![[k, k + 1], [k, k + nx], [k, k + nx + 1]];
        if right + 1 == nx {
            edges.push([k + 1, k + nx + 1]);
        }
        if high + 1 == ys.len() {
            edges.push([k + nx, k + nx + 1]);
        }
        for edge in edges {
            if edge.iter().all(|&k| has_height(k)) {
                found.extend(self.tear(grid, edge.map(|k| k as u32), room));
            }
        }
    }

    /// The tear of an edge, if it is torn.
    fn tear(&self, grid: &Grid, edge: [u32; 2], room: &mut Vec<Jet>) -> Option<Tear> {
        let [p, q] = edge.map(|k| grid.point(k));
        let at = |t: f64| p + t * (q - p);
        let mut class = |from: f64, to: f64| {
            let (a, b) = (at(from), at(to));
            let range = |a: f64, b: f64| Interval::new(a.min(b), a.max(b));
            self.jets.over(range(a.x, b.x), range(a.y, b.y), [1.0, 1.0], room).class
        };
        if class(0.0, 1.0) >= Class::Continuous {
            return None;
        }
        let mut gap: Option<(f64, f64)> = None;
        let mut parts = vec![(0.0, 1.0)];
        for _ in 0..HALVINGS {
            let mut narrower = Vec::with_capacity(2 * parts.len());
            for (from, to) in parts {
                let middle = 0.5 * (from + to);
                for (from, to) in [(from, middle), (middle, to)] {
                    match class(from, to) {
                        Class::Nowhere => {
                            let known = gap.unwrap_or((from, to));
                            gap = Some((known.0.min(from), known.1.max(to)));
                        }
                        Class::Partial | Class::Defined => narrower.push((from, to)),
                        Class::Continuous | Class::Lipschitz | Class::Smooth => {}
                    }
                }
            }
            parts = narrower;
            if parts.is_empty() || parts.len() > MOST_PARTS {
                break;
            }
        }
        if parts.len() > MOST_PARTS {
            return None;
        }
        let all = parts.first().zip(parts.last()).map(|(first, last)| (first.0, last.1));
        let (from, to) = match (all, gap) {
            (Some(a), Some(b)) => (a.0.min(b.0), a.1.max(b.1)),
            (Some(one), None) | (None, Some(one)) => one,
            (None, None) => return None,
        };
        // Samples may have been filled.
        let height = |t: f64| match t {
            t if t <= 0.0 => p.z,
            t if t >= 1.0 => q.z,
            t => self.function.height(at(t).x, at(t).y),
        };
        let around = [from - STILL, from, to, to + STILL].map(height);
        let (least, most) = around
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), z| (a.min(*z), b.max(*z)));
        let is_still = around.iter().all(|z| z.is_finite()) && most - least <= self.closes;
        (!is_still || gap.is_some()).then_some(Tear { edge, from, to })
    }

    /// The height of a sample without one, if the function comes to the same height from all sides.
    pub(super) fn filled(&self, grid: &Grid, sample: usize) -> Option<f64> {
        let (xs, ys, nx) = (grid.xs(), grid.ys(), grid.xs().len());
        let (i, j) = (sample % nx, sample / nx);
        let step = |values: &[f64], k: usize| {
            let next = if k + 1 < values.len() {
                values[k + 1] - values[k]
            } else {
                values[k] - values[k - 1]
            };
            next * STILL
        };
        let (hx, hy) = (step(xs, i), step(ys, j));
        let beside = [(hx, 0.3 * hy), (-hx, -0.3 * hy), (0.3 * hx, -hy), (-0.3 * hx, hy)];
        let heights = beside.map(|(dx, dy)| self.function.height(xs[i] + dx, ys[j] + dy));
        let least = heights.into_iter().fold(f64::INFINITY, f64::min);
        let most = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let is_still = heights.iter().all(|z| z.is_finite()) && most - least <= self.closes;
        is_still.then_some(0.5 * least + 0.5 * most)
    }
}

/// What of a tear's edge has heights: the points that both sides end at, found by `last`, which goes from
/// a sample toward a point.
pub(super) fn ends_of(
    grid: &Grid,
    tear: &Tear,
    last: impl Fn(DVec3, DVec3) -> DVec3,
) -> [DVec3; 2] {
    let [p, q] = tear.edge.map(|k| grid.point(k));
    let at = |t: f64| p + t * (q - p);
    [last(p, at(tear.from)), last(q, at(tear.to))]
}
