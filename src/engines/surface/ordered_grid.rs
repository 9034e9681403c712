//! A grid with the triangles of its cut cells in the order in which they are visited.
//!
//! Inside a cell the order is that of [`tin`](super::tin): of two triangles that share a side, the one on
//! the eye's side of it comes first. The cells themselves come in the order of the grid, since what is
//! in a cell stays within its borders.

use std::ops::Range;

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::plan_predicates::PlanSight;
use super::plan_triangle::{Facing, PlanTriangle, Side, facing, signs};
use super::segment::Samples;
use crate::camera::{Camera, Projection};
use crate::predicates::{Sign, orient2d};
use crate::surface::{CutGrid, Grid, GridCuts};

/// A grid as one camera sees it.
#[derive(Debug, Clone)]
pub struct OrderedGrid<'a> {
    cut: CutGrid<'a>,
    /// One bit for each cell.
    is_cut: Vec<u64>,
    cells: FxHashMap<u32, Range<usize>>,
    triangles: Vec<PlanTriangle>,
}

impl Samples for OrderedGrid<'_> {
    fn point(&self, sample: u32) -> DVec3 {
        self.cut.point(sample)
    }
}

impl<'a> OrderedGrid<'a> {
    /// A grid of which no cell is cut.
    pub fn uncut(grid: &'a Grid) -> Self {
        static NONE: GridCuts = GridCuts::NONE;
        let cut = CutGrid { grid, cuts: &NONE };
        Self { cut, is_cut: Vec::new(), cells: FxHashMap::default(), triangles: Vec::new() }
    }

    /// `None` where a mesh engine is needed: if rounding turned a triangle over or made them a cycle,
    /// with the eye over a cell that is cut, or where the near plane cuts one.
    pub fn new(cut: CutGrid<'a>, camera: &Camera) -> Option<Self> {
        let (low, high) = cut.grid.bounds();
        let is_perspective = matches!(camera.projection(), Projection::Perspective { .. });
        let center = if is_perspective { camera.eye() } else { low + 0.5 * (high - low) };
        let (sx, sy) = signs(camera);
        let sight = PlanSight::new(camera, sx, sy, center);
        let (xs, ys) = (cut.grid.xs(), cut.grid.ys());
        let nx = xs.len();
        let (first, last) =
            (DVec3::new(xs[0], ys[0], 0.0), DVec3::new(xs[nx - 1], ys[ys.len() - 1], 0.0));
        let is_border = |ends: [DVec3; 2]| {
            let is_at = |k: usize, at: f64| ends.iter().all(|end| end[k] == at);
            (0..2).any(|k| is_at(k, first[k]) || is_at(k, last[k]))
        };
        let n_cells = (nx - 1) * (ys.len() - 1);
        let mut is_cut = vec![0; n_cells.div_ceil(64)];
        let mut cells = FxHashMap::default();
        let mut triangles = Vec::with_capacity(cut.cuts.triangles().len());
        for (cell, range) in cut.cuts.cells() {
            let (i, j) = (cell as usize % (nx - 1), cell as usize / (nx - 1));
            let is_over = |at: f64, lines: &[f64]| (lines[0]..=lines[1]).contains(&at);
            if is_perspective && is_over(center.x, &xs[i..]) && is_over(center.y, &ys[j..]) {
                return None;
            }
            let of_cell = &cut.cuts.triangles()[range];
            let is_left = |corners: &[u32; 3]| {
                let [a, b, c] = corners.map(|vertex| cut.point(vertex).truncate());
                orient2d(a, b, c) == Sign::Positive
            };
            if !of_cell.iter().all(is_left) || !is_clear_of_near_plane(&cut, of_cell, camera) {
                return None;
            }
            let sided = |corners: &[u32; 3]| {
                let [a, b, c] = *corners;
                let sides = [[a, b], [b, c], [c, a]].map(|ends| {
                    let points = ends.map(|vertex| cut.point(vertex));
                    let (edge, facing) = (cut.edge(ends), facing(&sight, points));
                    Side { edge, facing, is_border: is_border(points) }
                });
                PlanTriangle { corners: *corners, sides }
            };
            let start = triangles.len();
            outward(of_cell.iter().map(sided).collect(), &mut triangles)?;
            cells.insert(cell, start..triangles.len());
            is_cut[cell as usize / 64] |= 1 << (cell % 64);
        }
        Some(Self { cut, is_cut, cells, triangles })
    }

    /// The grid and its cuts.
    pub fn cut(&self) -> CutGrid<'a> {
        self.cut
    }

    /// The grid.
    pub(super) fn grid(&self) -> &'a Grid {
        self.cut.grid
    }

    /// How many edges there are.
    pub(super) fn n_edges(&self) -> usize {
        self.cut.n_edges()
    }

    /// How many vertices there are.
    pub(super) fn n_vertices(&self) -> usize {
        self.cut.grid.zs().len() + self.cut.cuts.points().len()
    }

    /// The (lowest, highest) corner of the box around all vertices.
    pub(super) fn bounds(&self) -> (DVec3, DVec3) {
        let points = self.cut.cuts.points().iter();
        points.fold(self.cut.grid.bounds(), |(low, high), p| (low.min(*p), high.max(*p)))
    }

    /// The triangles of a cell from the eye outward, if it is cut.
    #[inline]
    pub(super) fn triangles(&self, cell: u32) -> Option<&[PlanTriangle]> {
        let is_cut =
            self.is_cut.get(cell as usize / 64).is_some_and(|bits| bits >> (cell % 64) & 1 > 0);
        if !is_cut {
            return None;
        }
        self.cells.get(&cell).map(|range| &self.triangles[range.clone()])
    }
}

/// Puts the triangles of a cell in order; `None` if they come before each other in turn.
fn outward(mut left: Vec<PlanTriangle>, out: &mut Vec<PlanTriangle>) -> Option<()> {
    while !left.is_empty() {
        let is_first = |triangle: &PlanTriangle| {
            let nearer = triangle.ends().into_iter().zip(triangle.sides);
            let nearer = nearer.filter(|(_, side)| side.facing == Facing::Near);
            let is_left =
                |[a, b]: [u32; 2]| left.iter().any(|other| other.ends().contains(&[b, a]));
            !nearer.map(|(ends, _)| ends).any(is_left)
        };
        let first = left.iter().position(is_first)?;
        out.push(left.remove(first));
    }
    Some(())
}

/// Whether every triangle is beyond the near plane, or wholly behind the eye, where it hides nothing.
fn is_clear_of_near_plane(cut: &CutGrid, triangles: &[[u32; 3]], camera: &Camera) -> bool {
    let Projection::Perspective { near, .. } = camera.projection() else { return true };
    let forward = camera.forward();
    let depth = |vertex: u32| (cut.point(vertex) - camera.eye()).dot(forward);
    triangles.iter().all(|corners| {
        let depths = corners.map(depth);
        let is_beyond = depths.iter().all(|depth| *depth >= near * forward.length_squared());
        is_beyond || depths.iter().all(|depth| *depth <= 0.0)
    })
}
