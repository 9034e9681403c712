//! The cells of a grid that lie along its folds, cut along them.
//!
//! ```text
//!     ●───●───●───●      Most triangles face the same way as those around them, and so does the function.
//!     │ + │ + │ + │      It is asked at vertices between triangles that face different ways, and at the
//!     ●───◆───◆───●      neighbors of these, and on from there as long as its side is another than that
//!     │ + │╱- │╱+ │      of the triangles. So the cost of folds is that of their length.
//!     ●───◆───◆───●
//! ```

use rayon::prelude::*;
use rustc_hash::FxHashSet;

use super::Grid;
use super::fold_cuts::SheetFolds;
use super::folds::FoldView;
use super::grid_cuts::{CutGrid, GridCuts};
use super::lined_mesh::{LinedMesh, SurfaceLine};
use crate::strokes::{StrokeKind, SurfacePart};

impl LinedMesh {
    /// Cuts cells and lines of the grid that is all there is of this mesh, and adds the lines of the cuts as
    /// folds. O(triangles).
    pub(super) fn cut_cells(&mut self, cut: &CutGrid) {
        let whole = std::mem::take(&mut self.triangles);
        let mut next = 0;
        for (cell, range) in cut.cuts.cells() {
            self.triangles.extend_from_slice(&whole[next..2 * cell as usize]);
            self.triangles.extend_from_slice(&cut.cuts.triangles()[range]);
            next = 2 * cell as usize + 2;
        }
        self.triangles.extend_from_slice(&whole[next..]);
        self.positions.extend_from_slice(cut.cuts.points());
        for line in std::mem::take(&mut self.lines) {
            let [a, b] = line.ends;
            let edge = cut.grid.edge([a.min(b), a.max(b)]);
            match edge.and_then(|edge| cut.cut(edge)) {
                Some((m, _)) => {
                    self.lines.extend([[a, m], [m, b]].map(|ends| SurfaceLine { ends, ..line }));
                }
                None => self.lines.push(line),
            }
        }
        let part = SurfacePart { sheet: 1, ..SurfacePart::default() };
        let fold =
            |ends: &[u32; 2]| SurfaceLine { ends: *ends, kind: StrokeKind::Silhouette, part };
        self.lines.extend(cut.cuts.lines().iter().map(fold));
        self.has_folds = true;
    }
}

/// The facing of the triangles of cells: those to the right of their diagonals, and the others.
struct Facing {
    n_columns: usize,
    is_front: Vec<[bool; 2]>,
}

impl Facing {
    fn new(grid: &Grid, view: &FoldView) -> Self {
        let nx = grid.xs().len();
        let of_cell = |cell: u32| {
            triangles(grid, cell).map(|corners| view.is_front(corners.map(|k| grid.point(k))))
        };
        let n_cells = (nx - 1) * (grid.ys().len() - 1);
        let is_front = (0..n_cells as u32).into_par_iter().map(of_cell).collect();
        Self { n_columns: nx - 1, is_front }
    }

    /// The vertices between triangles that face different ways, in rising order.
    fn mixed(&self, grid: &Grid) -> Vec<u32> {
        let n_rows = grid.ys().len() - 1;
        let in_row = |j: usize| {
            let row = &self.is_front[j * self.n_columns..(j + 1) * self.n_columns];
            let above = (j + 1 < n_rows).then(|| &self.is_front[(j + 1) * self.n_columns..]);
            let nx = self.n_columns + 1;
            let mut found = Vec::new();
            for (i, [right, left]) in row.iter().enumerate() {
                let corner = j * nx + i;
                if right != left {
                    found.extend([corner, corner + nx + 1]);
                }
                if row.get(i + 1).is_some_and(|next| next[1] != *right) {
                    found.extend([corner + 1, corner + nx + 1]);
                }
                if above.is_some_and(|above| above[i][0] != *left) {
                    found.extend([corner + nx, corner + nx + 1]);
                }
            }
            found
        };
        let mut found: Vec<u32> =
            (0..n_rows).into_par_iter().flat_map_iter(in_row).map(|k| k as u32).collect();
        found.par_sort_unstable();
        found.dedup();
        found
    }

    /// The cells around a vertex.
    fn around(&self, grid: &Grid, vertex: u32) -> impl Iterator<Item = u32> {
        let (nx, ny) = (grid.xs().len() as u32, grid.ys().len() as u32);
        let (i, j) = (vertex % nx, vertex / nx);
        let columns = i.saturating_sub(1)..(i + 1).min(nx - 1);
        let rows = j.saturating_sub(1)..(j + 1).min(ny - 1);
        rows.flat_map(move |j| columns.clone().map(move |i| j * (nx - 1) + i))
    }
}

/// The corners of the triangles of a cell: the one to the right of its diagonal, and the other.
fn triangles(grid: &Grid, cell: u32) -> [[u32; 3]; 2] {
    let nx = grid.xs().len() as u32;
    let k = cell / (nx - 1) * nx + cell % (nx - 1);
    [[k, k + 1, k + nx + 1], [k, k + nx + 1, k + nx]]
}

/// The cells of a grid without holes that are cut along the folds of its function.
pub(super) fn grid_folds(grid: &Grid, folds: &[SheetFolds], view: &FoldView) -> GridCuts {
    let [of_grid] = folds else { return GridCuts::NONE };
    let facing = Facing::new(grid, view);
    let mut band = facing.mixed(grid);
    let mut is_known: FxHashSet<u32> = band.iter().copied().collect();
    let mut n_done = 0;
    while n_done < band.len() {
        // Neighbors of the newest part of the band, with the facing of a triangle beside them.
        let mut beside: Vec<(u32, bool)> = Vec::new();
        for &vertex in &band[n_done..] {
            for cell in facing.around(grid, vertex) {
                let of_cell = triangles(grid, cell).into_iter().zip(facing.is_front[cell as usize]);
                let of_vertex = of_cell.filter(|(corners, _)| corners.contains(&vertex));
                for (corners, is_front) in of_vertex {
                    let new = corners.into_iter().filter(|corner| is_known.insert(*corner));
                    beside.extend(new.map(|corner| (corner, is_front)));
                }
            }
        }
        n_done = band.len();
        let is_other = |room: &mut Vec<_>, &(corner, is_front): &(u32, bool)| {
            let at = of_grid.function.at(grid.point(corner).truncate(), room).facing;
            (if is_front { at < 0.0 } else { at >= 0.0 }).then_some(corner)
        };
        let others = beside.par_iter().with_min_len(64).map_init(Vec::new, is_other);
        band.extend(others.flatten_iter().collect::<Vec<u32>>());
    }
    let mut cells: Vec<u32> = band.iter().flat_map(|vertex| facing.around(grid, *vertex)).collect();
    cells.par_sort_unstable();
    cells.dedup();
    cut_cells(grid, &cells, folds, view)
}

/// Cuts these cells, given in rising order.
fn cut_cells(grid: &Grid, cells: &[u32], folds: &[SheetFolds], view: &FoldView) -> GridCuts {
    let mut mesh = LinedMesh::default();
    let corners = cells.iter().flat_map(|cell| triangles(grid, *cell));
    let mut samples: Vec<u32> = corners.clone().flatten().collect();
    samples.par_sort_unstable();
    samples.dedup();
    let number = |sample: u32| samples.partition_point(|known| *known < sample) as u32;
    mesh.positions = samples.iter().map(|sample| grid.point(*sample)).collect();
    mesh.triangles = corners.map(|corners| corners.map(number)).collect();
    let mut pieces = mesh.add_folds(folds, view);
    // Vertices on edges of the grid first, in the order of these edges.
    let n_samples = grid.zs().len() as u32;
    let edge = |ends: [u32; 2]| grid.edge(ends.map(|end| samples[end as usize]));
    pieces.cuts.sort_by_key(|(ends, vertex)| (edge(*ends).is_none(), edge(*ends), *vertex));
    let mut edges = Vec::new();
    let mut points = Vec::with_capacity(pieces.cuts.len());
    let mut further = vec![0; pieces.cuts.len()];
    for ((ends, vertex), number) in pieces.cuts.iter().zip(n_samples..) {
        edges.extend(edge(*ends));
        points.push(mesh.positions[*vertex as usize]);
        further[*vertex as usize - samples.len()] = number;
    }
    let vertex = |vertex: u32| match samples.get(vertex as usize) {
        Some(sample) => *sample,
        None => further[vertex as usize - samples.len()],
    };
    let mut cuts = GridCuts { points, edges, ..GridCuts::NONE };
    let mut of_cell = pieces.origins.iter().zip(&mesh.triangles).peekable();
    let mut lines: Vec<[u32; 2]> = mesh.lines.iter().map(|line| line.ends.map(vertex)).collect();
    lines.iter_mut().for_each(|ends| ends.sort_unstable());
    lines.sort_unstable();
    lines.dedup();
    cuts.lines = lines;
    for (cell, k) in cells.iter().zip(0..) {
        let start = cuts.triangles.len();
        while let Some((_, corners)) = of_cell.next_if(|(origin, _)| **origin / 2 == k) {
            cuts.triangles.push(corners.map(vertex));
        }
        let of_this = &cuts.triangles[start..];
        let has_line = || {
            let cut = CutGrid { grid, cuts: &cuts };
            let sides = of_this.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
            sides
                .into_iter()
                .any(|ends| cut.edge(ends).is_some_and(|edge| edge as usize >= grid.n_edges()))
        };
        if of_this.len() == 2 && !has_line() {
            cuts.triangles.truncate(start);
        } else {
            cuts.cells.push((*cell, cuts.triangles.len() as u32));
        }
    }
    cuts
}
