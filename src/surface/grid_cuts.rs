//! Cells of a grid that are cut into smaller triangles, so that a line across them is made of edges.
//!
//! ```text
//!     ●────────●      Vertices on the sides of cells are shared by the cells on both sides; most cells
//!     │╲     ╱ │      are not cut.
//!     × ━━━━×  │
//!     │ ╱    ╲ │      numbers of edges: those of the grid, then two for each edge that is cut, and then
//!     ●────────●      the lines
//! ```

use std::ops::Range;

use glam::DVec3;

use super::Grid;

/// Cells of a grid in smaller triangles.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GridCuts {
    /// Further vertices, numbered after the samples of the grid: first one for each edge that is cut, in
    /// their order, and then those within cells.
    pub(super) points: Vec<DVec3>,
    /// Cut cells in rising order, counted row by row, and where their triangles end.
    pub(super) cells: Vec<(u32, u32)>,
    /// Triangles cell by cell, counterclockwise seen from above.
    pub(super) triangles: Vec<[u32; 3]>,
    /// The numbers of the edges of the grid that are cut, in rising order.
    pub(super) edges: Vec<u32>,
    /// Edges that are lines of their own, lower ends first.
    pub(super) lines: Vec<[u32; 2]>,
}

/// A grid of which some cells are in smaller triangles.
#[derive(Debug, Clone, Copy)]
pub struct CutGrid<'a> {
    /// The grid.
    pub grid: &'a Grid,
    /// The cells that are cut.
    pub cuts: &'a GridCuts,
}

impl GridCuts {
    /// No cell is cut.
    pub const NONE: Self = Self {
        points: Vec::new(),
        cells: Vec::new(),
        triangles: Vec::new(),
        edges: Vec::new(),
        lines: Vec::new(),
    };

    /// The further vertices.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The number of each cut cell, counted row by row, and its triangles.
    pub fn cells(&self) -> impl Iterator<Item = (u32, Range<usize>)> {
        let starts = std::iter::once(0).chain(self.cells.iter().map(|cell| cell.1));
        let cells = self.cells.iter().zip(starts);
        cells.map(|(&(cell, end), start)| (cell, start as usize..end as usize))
    }

    /// The triangles of all cut cells.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The edges that are lines of their own, lower ends first.
    pub fn lines(&self) -> &[[u32; 2]] {
        &self.lines
    }
}

impl CutGrid<'_> {
    /// Where a vertex is.
    pub fn point(&self, vertex: u32) -> DVec3 {
        match (vertex as usize).checked_sub(self.grid.zs().len()) {
            None => self.grid.point(vertex),
            Some(further) => self.cuts.points[further],
        }
    }

    /// How many edges there are.
    pub fn n_edges(&self) -> usize {
        self.grid.n_edges() + 2 * self.cuts.edges.len() + self.cuts.lines.len()
    }

    /// The vertex on an edge of the grid, if it is cut, and the numbers of the edges from there to its first
    /// end and to the other one.
    pub fn cut(&self, edge: u32) -> Option<(u32, [u32; 2])> {
        let k = self.cuts.edges.binary_search(&edge).ok()?;
        Some(((self.grid.zs().len() + k) as u32, self.halves(k)))
    }

    /// The number of the edge between two vertices; none if it only divides a cell.
    pub fn edge(&self, [a, b]: [u32; 2]) -> Option<u32> {
        let ends @ [low, high] = [a.min(b), a.max(b)];
        let n_samples = self.grid.zs().len();
        if let Some(edge) = self.grid.edge(ends).filter(|_| (high as usize) < n_samples) {
            return Some(edge);
        }
        let first_line = self.grid.n_edges() + 2 * self.cuts.edges.len();
        if let Ok(line) = self.cuts.lines.binary_search(&ends) {
            return Some((first_line + line) as u32);
        }
        let k = (high as usize).checked_sub(n_samples)?;
        let side = self.grid.ends(*self.cuts.edges.get(k)?).iter().position(|end| *end == low)?;
        Some(self.halves(k)[side])
    }

    /// The numbers of the two pieces of the k-th edge that is cut.
    fn halves(&self, k: usize) -> [u32; 2] {
        let first = (self.grid.n_edges() + 2 * k) as u32;
        [first, first + 1]
    }
}
