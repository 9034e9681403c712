//! The cells of one part of a grid, from the eye outward.
//!
//! ```text
//!   left ─────── far        The part is reflected so that the eye is at the lower left:
//!    │  ╲     ╱   │         columns and rows are counted away from it. The diagonal runs
//!    │    ╲ ╱     │         from near to far or from left to right. u grows from left over
//!    │    ╱ ╲     │         near and far to right.
//!   near ────── right
//! ```

use std::cmp::Ordering;
use std::ops::Range;

use super::CellOrder;
use super::ordered_grid::OrderedGrid;
use super::segment::{Cell, Diagonal, HorizonVertex, Samples};
use super::strip::HorizonStrip;
use crate::surface::Grid;

impl Samples for Grid {
    fn point(&self, sample: u32) -> glam::DVec3 {
        Grid::point(self, sample)
    }
}

/// One part of the domain: the lines of the grid by their distance from the eye.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GridPart {
    /// Columns of the grid, the nearest first; the first may be behind the eye's x.
    pub(super) columns: Vec<u32>,
    /// Rows of the grid, the nearest first; the first may be behind the eye's y.
    pub(super) rows: Vec<u32>,
    /// Signs that reflect the part.
    pub(super) sx: f64,
    /// See `sx`.
    pub(super) sy: f64,
    /// Where the first column is.
    pub(super) first_column: First,
    /// Where the first row is.
    pub(super) first_row: First,
    /// Edges along y are all radial (orthographic).
    pub(super) radial_columns: bool,
    /// Edges along x are all radial (orthographic).
    pub(super) radial_rows: bool,
}

/// Where the nearest line of a part is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum First {
    /// Beyond the eye: the edges along it are the nearest of the part.
    Beyond,
    /// In the vertical plane of the eye, on the border of the domain.
    RadialOnBorder,
    /// In the vertical plane of the eye, inside the domain.
    RadialInside,
    /// Behind the eye: its cells are cut.
    Behind,
}

impl GridPart {
    /// The sample at a column and row counted from the eye.
    pub(super) fn sample(&self, grid: &Grid, c: usize, r: usize) -> u32 {
        self.rows[r] * grid.xs().len() as u32 + self.columns[c]
    }

    /// How the cells are cut in two: in the grid, from the corner where x and y are least.
    fn diagonal(&self) -> Diagonal {
        if self.sx * self.sy > 0.0 { Diagonal::NearToFar } else { Diagonal::LeftToRight }
    }

    fn cells(&self) -> (usize, usize) {
        (self.columns.len() - 1, self.rows.len() - 1)
    }

    /// The number of the edge along x from sample (c, r) away from the eye.
    pub(super) fn x_edge(&self, grid: &Grid, c: usize, r: usize) -> u32 {
        let i = self.columns[c].min(self.columns[c + 1]);
        self.rows[r] * (grid.xs().len() as u32 - 1) + i
    }

    /// The number of the edge along y from sample (c, r) away from the eye.
    pub(super) fn y_edge(&self, grid: &Grid, c: usize, r: usize) -> u32 {
        let (nx, ny) = (grid.xs().len() as u32, grid.ys().len() as u32);
        let j = self.rows[r].min(self.rows[r + 1]);
        ny * (nx - 1) + self.columns[c] * (ny - 1) + j
    }

    /// Visits every cell that meets the strip and records what is visible in it.
    pub(super) fn sweep(
        &self,
        ordered: &OrderedGrid,
        strip: &mut HorizonStrip<OrderedGrid>,
        order: CellOrder,
    ) {
        let mut walk = CellWalk { part: self, grid: ordered.grid(), ordered, strip };
        match order {
            CellOrder::Rows => walk.rows(),
            CellOrder::Diagonals => walk.diagonals(),
        }
    }
}

struct CellWalk<'a, 'b, 'c, 'd> {
    part: &'a GridPart,
    grid: &'a Grid,
    ordered: &'a OrderedGrid<'a>,
    strip: &'b mut HorizonStrip<'c, OrderedGrid<'d>>,
}

/// Vertices of neighboring columns of one row.
#[derive(Default)]
struct Row {
    begin: usize,
    vertices: Vec<HorizonVertex>,
}

impl Row {
    /// The vertices of `columns`, taken from `known` where possible, which is of the same row of the grid
    /// or empty.
    fn fill(
        &mut self,
        known: &Self,
        columns: Range<usize>,
        vertex: impl Fn(usize) -> HorizonVertex,
    ) {
        let known_end = known.begin + known.vertices.len();
        let kept = columns.start.max(known.begin)..columns.end.min(known_end);
        self.begin = columns.start;
        self.vertices.clear();
        if kept.is_empty() {
            self.vertices.extend(columns.map(vertex));
            return;
        }
        let of_known = kept.start - known.begin..kept.end - known.begin;
        self.vertices.extend((columns.start..kept.start).map(&vertex));
        self.vertices.extend_from_slice(&known.vertices[of_known]);
        self.vertices.extend((kept.end..columns.end).map(&vertex));
    }
}

impl CellWalk<'_, '_, '_, '_> {
    fn id(&self, c: usize, r: usize) -> u32 {
        self.part.sample(self.grid, c, r)
    }

    fn rows(&mut self) {
        let (n_columns, n_rows) = self.part.cells();
        let first = usize::from(self.part.first_column == First::Behind);
        // Rounding of u can only make the range slightly too wide; segments are cut exactly.
        let margin = 4.0 * self.strip.plane.du;
        let (from, to) = (self.strip.from - margin, self.strip.to + margin);
        let (mut near, mut far) = (Row::default(), Row::default());
        let (mut begin, mut end) = (first, first);
        for r in 0..n_rows {
            if first == 1 {
                self.cut_cell(0, r);
            }
            if r == 0 && self.part.first_row == First::Behind {
                (first..n_columns).for_each(|c| self.cut_cell(c, r));
                continue;
            }
            let vertex = |c: usize, r: usize| self.strip.plane.vertex(self.id(c, r));
            // u grows with the column and falls with the row, so the range only moves on.
            while begin < n_columns && vertex(begin + 1, r).u < from {
                begin += 1;
            }
            end = end.max(begin);
            while end < n_columns && vertex(end, r + 1).u <= to {
                end += 1;
            }
            // The far vertices of the previous row are the near ones of this row.
            near.fill(&far, begin..end + 1, |c| vertex(c, r));
            far.fill(&Row::default(), begin..end + 1, |c| vertex(c, r + 1));
            let diagonal = self.part.diagonal();
            let pairs = near.vertices.windows(2).zip(far.vertices.windows(2));
            for ((near, far), c) in pairs.zip(begin..end) {
                let (&[near, right], &[left, far]) = (near, far) else { continue };
                self.cell(c, r, &Cell { near, right, left, far, diagonal });
            }
        }
    }

    fn diagonals(&mut self) {
        let (n_columns, n_rows) = self.part.cells();
        for level in 0..n_columns + n_rows - 1 {
            for c in level.saturating_sub(n_rows - 1)..n_columns.min(level + 1) {
                let r = level - c;
                if (c == 0 && self.part.first_column == First::Behind)
                    || (r == 0 && self.part.first_row == First::Behind)
                {
                    self.cut_cell(c, r);
                    continue;
                }
                let vertex = |c, r| self.strip.plane.vertex(self.id(c, r));
                let cell = Cell {
                    near: vertex(c, r),
                    right: vertex(c + 1, r),
                    left: vertex(c, r + 1),
                    far: vertex(c + 1, r + 1),
                    diagonal: self.part.diagonal(),
                };
                let margin = 4.0 * self.strip.plane.du;
                if cell.right.u >= self.strip.from - margin && cell.left.u <= self.strip.to + margin
                {
                    self.cell(c, r, &cell);
                }
            }
        }
    }

    /// Visits the triangles of a cell; whether it is cut.
    #[inline]
    fn triangles(&mut self, c: usize, r: usize) -> bool {
        let i = self.part.columns[c].min(self.part.columns[c + 1]);
        let j = self.part.rows[r].min(self.part.rows[r + 1]);
        let number = j * (self.grid.xs().len() as u32 - 1) + i;
        let Some(triangles) = self.ordered.triangles(number) else { return false };
        for triangle in triangles {
            let vertices = triangle.corners.map(|corner| self.strip.plane.vertex(corner));
            triangle.visit(vertices, self.strip);
        }
        true
    }

    /// A cell wholly inside the part.
    fn cell(&mut self, c: usize, r: usize, cell: &Cell) {
        if self.triangles(c, r) {
            return;
        }
        let Cell { near, right, left, far, .. } = *cell;
        let part = self.part;
        if (c == 0 && part.first_column != First::Beyond)
            || (r == 0 && part.first_row != First::Beyond)
            || part.radial_columns
            || part.radial_rows
        {
            self.radial_edges(c, r, cell);
        }
        if c == 0 && part.first_column == First::Beyond && !part.radial_columns {
            self.draw(left, near, part.y_edge(self.grid, c, r));
        }
        if r == 0 && part.first_row == First::Beyond && !part.radial_rows {
            self.draw(near, right, part.x_edge(self.grid, c, r));
        }
        let far_edges = [part.x_edge(self.grid, c, r + 1), part.y_edge(self.grid, c + 1, r)];
        let has_no_radial = !part.radial_rows && !part.radial_columns;
        if !self.strip.visit_cell(cell, has_no_radial.then_some(far_edges)) {
            self.strip.leave();
            return;
        }
        let (from, to) = cell.diagonal();
        let diagonal = match self.strip.plane.order(from, to) {
            Ordering::Less => self.strip.segment(from, to),
            Ordering::Equal => None,
            Ordering::Greater => self.strip.segment(to, from),
        };
        if let Some(diagonal) = diagonal {
            self.strip.hide(&diagonal);
        }
        if !part.radial_rows {
            self.draw(left, far, far_edges[0]);
        }
        if !part.radial_columns {
            self.draw(far, right, far_edges[1]);
        }
        self.strip.leave();
    }

    fn draw(&mut self, a: HorizonVertex, b: HorizonVertex, edge: u32) {
        if let Some(segment) = self.strip.segment(a, b) {
            self.strip.draw(&segment, edge);
        }
    }

    /// Tests the radial edges of a cell before the cell hides anything. An edge on the border of the domain
    /// has no cell on its outer side, so it is wholly visible.
    fn radial_edges(&mut self, c: usize, r: usize, cell: &Cell) {
        let Cell { near, right, left, far, .. } = *cell;
        let (part, grid, cells) = (self.part, self.grid, self.part.cells());
        let strip = &mut *self.strip;
        let mut test = |(a, b): (HorizonVertex, HorizonVertex), edge, right_side, on_border| {
            if on_border {
                strip.draw_whole(edge);
            } else {
                strip.draw_radial((a.id, b.id), edge, right_side, None);
            }
        };
        if part.radial_columns {
            test((near, left), part.y_edge(grid, c, r), true, c == 0);
            test((right, far), part.y_edge(grid, c + 1, r), false, c + 1 == cells.0);
        } else if c == 0 && matches!(part.first_column, First::RadialOnBorder | First::RadialInside)
        {
            let on_border = part.first_column == First::RadialOnBorder;
            test((near, left), part.y_edge(grid, c, r), true, on_border);
        }
        if part.radial_rows {
            test((near, right), part.x_edge(grid, c, r), false, r == 0);
            test((left, far), part.x_edge(grid, c, r + 1), true, r + 1 == cells.1);
        } else if r == 0 && matches!(part.first_row, First::RadialOnBorder | First::RadialInside) {
            let on_border = part.first_row == First::RadialOnBorder;
            test((near, right), part.x_edge(grid, c, r), false, on_border);
        }
    }

    /// A cell cut by the border of the part.
    fn cut_cell(&mut self, c: usize, r: usize) {
        if self.triangles(c, r) {
            return;
        }
        let (part, grid) = (self.part, self.grid);
        let [near, right, left, far] =
            [(c, r), (c + 1, r), (c, r + 1), (c + 1, r + 1)].map(|(c, r)| self.id(c, r));
        let strip = &mut *self.strip;
        let center = strip.plane.sight.center;
        if c == 0 && part.first_column != First::Behind {
            let edge = part.y_edge(grid, c, r);
            let (from, to) = (grid.point(near).y, grid.point(left).y);
            match part.first_column {
                First::RadialOnBorder => strip.draw_whole(edge),
                First::RadialInside => {
                    strip.draw_radial(
                        (near, left),
                        edge,
                        true,
                        Some((center.y - from) / (to - from)),
                    );
                }
                _ => strip.draw_clipped(left, near, edge),
            }
        }
        if r == 0 && part.first_row != First::Behind {
            let edge = part.x_edge(grid, c, r);
            let (from, to) = (grid.point(near).x, grid.point(right).x);
            match part.first_row {
                First::RadialOnBorder => strip.draw_whole(edge),
                First::RadialInside => {
                    strip.draw_radial(
                        (near, right),
                        edge,
                        false,
                        Some((center.x - from) / (to - from)),
                    );
                }
                _ => strip.draw_clipped(near, right, edge),
            }
        }
        let diagonal = match part.diagonal() {
            Diagonal::NearToFar => (near, far),
            Diagonal::LeftToRight => (left, right),
        };
        if let Some(diagonal) = strip.clipped(diagonal.0, diagonal.1) {
            strip.hide(&diagonal);
        }
        strip.draw_clipped(left, far, part.x_edge(grid, c, r + 1));
        strip.draw_clipped(far, right, part.y_edge(grid, c + 1, r));
    }
}
