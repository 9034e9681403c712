//! Surfaces as triangles with the lines that are drawn on them: what the mesh engines draw.

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::Grid;
use super::formula::Axis;
use super::height_function::HeightFunction;
use super::places::Places;
use super::split_cells::{Center, Splitting};
use crate::classify::SelectedLine;
use crate::model::mesh::{Mesh, MeshError, MeshPart, PolygonSoup};
use crate::model::scene::Scene;
use crate::strokes::{GridFamily, StrokeKind, SurfacePart};

/// Points on the border of a parametric surface that are closer than this fraction of its largest
/// coordinate are one point, so that a torus closes although sin 2π is rounded. If it is smaller, seams
/// stay open; if larger, narrow slits close.
pub const SEAM_TOLERANCE: f64 = 1.0 / (1u64 << 36) as f64;

/// Triangles that hide, and lines along their edges that are drawn. Triangles without a line along
/// an edge still hide; a line that is on no triangle is not drawn.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LinedMesh {
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) lines: Vec<SurfaceLine>,
    /// Levels, in rising order, at which the cells of lattices are split.
    pub(super) split_at: Vec<f64>,
    pub(super) sheets: Vec<Sheet>,
    /// Whether its lines have all folds of the view.
    pub(super) has_folds: bool,
}

/// What is added to a mesh from here on, until the next sheet.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sheet {
    pub(super) first_triangle: usize,
    /// What it was sampled from, if level curves are traced on that.
    pub(super) function: Option<HeightFunction>,
    /// From here on its vertices are points of a rim, which is straight between them.
    pub(super) rim_from: u32,
}

/// A line between two vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct SurfaceLine {
    pub(super) ends: [u32; 2],
    pub(super) kind: StrokeKind,
    pub(super) part: SurfacePart,
}

/// Which lines of a lattice are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LatticeLines {
    /// Those along the rows: y or v is constant.
    pub along_rows: bool,
    /// Those along the columns: x or u is constant.
    pub along_columns: bool,
    /// Only each line with a number that is a multiple of this, counted from 0, and the last one.
    pub every: usize,
    /// All edges of all triangles, with the diagonals.
    pub triangles: bool,
}

impl LatticeLines {
    /// For each column and for each row of a lattice whether its line is drawn.
    pub(super) fn drawn(&self, n: (usize, usize), places: Option<&Places>) -> [Vec<bool>; 2] {
        let of = |is_wanted: bool, n: usize, axis: Axis| match places {
            _ if !is_wanted => vec![false; n],
            Some(places) => places.drawn(axis, self.every),
            None => (0..n).map(|k| k.is_multiple_of(self.every.max(1)) || k + 1 == n).collect(),
        };
        [of(self.along_columns, n.0, Axis::First), of(self.along_rows, n.1, Axis::Second)]
    }
}

/// A [`LinedMesh`] prepared for any number of views.
#[derive(Debug, Clone)]
pub struct LinedScene {
    /// The triangles.
    pub scene: Scene,
    /// The edges that are on a line.
    pub lines: Vec<SelectedLine>,
    /// Whether all folds of the view that it was made for are among the lines.
    pub has_folds: bool,
}

impl LinedMesh {
    /// An empty mesh for level curves: cells of lattices that one of the `levels` meets are cut into
    /// triangles about a point of their surface. Not with `LatticeLines::triangles`, which draws the two
    /// triangles of a cell.
    ///
    /// The curves themselves are drawn by [`add_levels`](Self::add_levels).
    pub fn for_levels(levels: &[f64]) -> Self {
        Self { split_at: sorted(levels), ..Self::default() }
    }

    /// Begins a sheet: what is added from now on belongs to it. Level curves are traced on the function
    /// that it was sampled from, if that is given.
    pub fn begin_sheet(&mut self, function: Option<HeightFunction>) {
        let first_triangle = self.triangles.len();
        self.sheets.push(Sheet { first_triangle, function, rim_from: u32::MAX });
    }

    /// Adds the triangles and lines of a grid; the cells around a hole are left out.
    pub fn push_grid(&mut self, grid: &Grid, lines: &LatticeLines) {
        self.push_grid_at(grid, lines, None, &|_, _| false);
    }

    /// As [`push_grid`](Self::push_grid), on lines that are not all the surface's own; edges that are torn
    /// and what is beside them are left out.
    pub(super) fn push_grid_at(
        &mut self,
        grid: &Grid,
        lines: &LatticeLines,
        places: Option<&Places>,
        is_torn: &dyn Fn(usize, usize) -> bool,
    ) {
        let points: Vec<DVec3> = (0..grid.zs().len() as u32).map(|k| grid.point(k)).collect();
        self.push_lattice_at(grid.xs().len(), &points, lines, places, is_torn);
    }

    /// Adds a lattice of points in space, given row by row with `n_columns` in each; a point that
    /// is not finite is a hole. Cells are cut along (i,j)–(i+1,j+1). O(points).
    pub fn push_lattice(&mut self, n_columns: usize, points: &[DVec3], lines: &LatticeLines) {
        self.push_lattice_at(n_columns, points, lines, None, &|_, _| false);
    }

    /// As [`push_lattice`](Self::push_lattice), on lines that are not all the surface's own; edges that are
    /// torn and what is beside them are left out.
    pub(super) fn push_lattice_at(
        &mut self,
        n_columns: usize,
        points: &[DVec3],
        lines: &LatticeLines,
        places: Option<&Places>,
        is_torn: &dyn Fn(usize, usize) -> bool,
    ) {
        // All edges of all triangles are to be those of the surface as it is drawn without levels.
        let levels = if lines.triangles { Vec::new() } else { self.split_at.clone() };
        let function = self.sheets.last().and_then(|sheet| sheet.function.clone());
        let splitting = Splitting { levels: &levels, function: function.as_ref() };
        let extremes = splitting.extremes(n_columns, points);
        let base = self.positions.len();
        let n_rows = points.len() / n_columns.max(1);
        let is_hole = |k: usize| !points[k].is_finite();
        // Vertices that no triangle uses are dropped later; they only have to be finite until then.
        self.positions.extend(points.iter().map(|p| if p.is_finite() { *p } else { DVec3::ZERO }));
        let id = |k: usize| (base + k) as u32;
        let mut sides: Vec<[usize; 2]> = extremes.keys().copied().collect();
        sides.sort_unstable();
        let between: FxHashMap<[usize; 2], u32> = sides
            .iter()
            .zip(self.positions.len() as u32..)
            .map(|(side, vertex)| (*side, vertex))
            .collect();
        self.positions.extend(sides.iter().map(|side| extremes[side]));
        let between = |a: usize, b: usize| between.get(&[a.min(b), a.max(b)]).copied();
        let (mut ring, mut points_of_ring) = (Vec::new(), Vec::new());
        for j in 0..n_rows.saturating_sub(1) {
            for i in 0..n_columns - 1 {
                let k = j * n_columns + i;
                let (right, above) = (k + 1, k + n_columns);
                let corners = [k, right, above + 1, above];
                ring.clear();
                points_of_ring.clear();
                for side in 0..4 {
                    let (a, b) = (corners[side], corners[(side + 1) % 4]);
                    ring.push(id(a));
                    points_of_ring.push(points[a]);
                    if let Some(vertex) = between(a, b) {
                        ring.push(vertex);
                        points_of_ring.push(self.positions[vertex as usize]);
                    }
                }
                let is_torn_cell = is_torn(k, above + 1)
                    || (0..4).any(|side| is_torn(corners[side], corners[(side + 1) % 4]));
                let center = splitting.center(corners.map(|k| points[k]), &points_of_ring);
                match center.filter(|_| !is_torn_cell) {
                    Some(Center::Inside(center)) => {
                        self.positions.push(center);
                        let center = (self.positions.len() - 1) as u32;
                        for (k, &a) in ring.iter().enumerate() {
                            self.push_triangle([a, ring[(k + 1) % ring.len()], center], false);
                        }
                        continue;
                    }
                    Some(Center::OnRing(first)) => {
                        ring.rotate_left(first);
                        for pair in ring[1..].windows(2) {
                            self.push_triangle([ring[0], pair[0], pair[1]], false);
                        }
                        continue;
                    }
                    None => {}
                }
                for corners in [[k, right, above + 1], [k, above + 1, above]] {
                    let is_cut = is_torn_cell
                        && (0..3).any(|side| is_torn(corners[side], corners[(side + 1) % 3]));
                    if !corners.into_iter().any(is_hole) && !is_cut {
                        self.push_triangle(corners.map(id), lines.triangles);
                    }
                }
            }
        }
        let [columns, rows] = lines.drawn((n_columns, n_rows), places);
        let sheet = self.sheet();
        let mut push = |a: usize, b: usize, family: GridFamily| {
            if is_hole(a) || is_hole(b) || is_torn(a, b) {
                return;
            }
            let part = SurfacePart { sheet, family: Some(family), ..SurfacePart::default() };
            let mut push =
                |ends| self.lines.push(SurfaceLine { ends, kind: StrokeKind::Grid, part });
            match between(a, b) {
                Some(middle) => {
                    push([id(a), middle]);
                    push([middle, id(b)]);
                }
                None => push([id(a), id(b)]),
            }
        };
        for k in 0..points.len() {
            let (i, j) = (k % n_columns, k / n_columns);
            if i + 1 < n_columns && rows[j] {
                push(k, k + 1, GridFamily::AlongX);
            }
            if j + 1 < n_rows && columns[i] {
                push(k, k + n_columns, GridFamily::AlongY);
            }
        }
    }

    /// Adds triangles with their own points, and with lines of kind mesh along all of their edges if
    /// `is_lined`.
    pub fn push_triangles(&mut self, points: &[DVec3], triangles: &[[u32; 3]], is_lined: bool) {
        let base = self.positions.len() as u32;
        // Vertices that no triangle uses are dropped later; they only have to be finite until then.
        self.positions.extend(points.iter().map(|p| if p.is_finite() { *p } else { DVec3::ZERO }));
        for corners in triangles {
            self.push_triangle(corners.map(|k| base + k), is_lined);
        }
    }

    /// The number of the sheet that is being added, from 1; 0 before the first.
    pub(super) fn sheet(&self) -> u16 {
        u16::try_from(self.sheets.len()).unwrap_or(u16::MAX)
    }

    pub(super) fn push_line(
        &mut self,
        ends: [u32; 2],
        kind: StrokeKind,
        family: Option<GridFamily>,
    ) {
        let part = SurfacePart { sheet: self.sheet(), level: 0, family };
        self.lines.push(SurfaceLine { ends, kind, part });
    }

    pub(super) fn push_triangle(&mut self, corners @ [a, b, c]: [u32; 3], is_lined: bool) {
        self.triangles.push(corners);
        if is_lined {
            for ends in [[a, b], [b, c], [c, a]] {
                self.push_line(ends, StrokeKind::Mesh, None);
            }
        }
    }

    /// Number of triangles.
    pub fn n_triangles(&self) -> usize {
        self.triangles.len()
    }

    /// The triangles alone, with equal vertices merged.
    ///
    /// # Errors
    /// Coordinates that are not finite, or more than a mesh can have.
    pub fn into_mesh(self) -> Result<Mesh, MeshError> {
        let mut soup = PolygonSoup { positions: self.positions, ..PolygonSoup::default() };
        // Faces know their sheets by their parts.
        let n_sheets = self.sheets.len();
        soup.parts = vec![MeshPart::default(); if n_sheets > 1 { n_sheets } else { 0 }];
        let mut sheet = 0;
        for (triangle, corners) in self.triangles.iter().enumerate() {
            soup.push_face(corners);
            if n_sheets > 1 {
                let is_past = |sheet: &Sheet| sheet.first_triangle <= triangle;
                while self.sheets.get(sheet + 1).is_some_and(is_past) {
                    sheet += 1;
                }
                soup.face_parts.push(sheet as u32);
            }
        }
        Ok(Mesh::new(soup)?.0)
    }

    /// Merges equal vertices and finds the edges that are on lines.
    ///
    /// # Errors
    /// Coordinates that are not finite, or more than a mesh can have.
    pub fn into_scene(self) -> Result<LinedScene, MeshError> {
        let key = |p: DVec3| (p + 0.0).to_array().map(f64::to_bits);
        let (lines, has_folds) = (self.lines.clone(), self.has_folds);
        let ends: Vec<[DVec3; 2]> =
            lines.iter().map(|line| line.ends.map(|k| self.positions[k as usize])).collect();
        let scene = Scene::new(self.into_mesh()?);
        let vertices: FxHashMap<[u64; 3], u32> =
            scene.mesh().positions().iter().zip(0..).map(|(p, vertex)| (key(*p), vertex)).collect();
        let edge = |[a, b]: [DVec3; 2]| {
            scene.topology().find_edge(*vertices.get(&key(a))?, *vertices.get(&key(b))?)
        };
        let lines = ends
            .iter()
            .zip(&lines)
            .filter_map(|(ends, line)| {
                Some(SelectedLine { edge: edge(*ends)?, kind: line.kind, part: line.part })
            })
            .collect();
        Ok(LinedScene { scene, lines, has_folds })
    }
}

/// The finite heights in rising order, each once.
pub(super) fn sorted(levels: &[f64]) -> Vec<f64> {
    let mut levels: Vec<f64> = levels.iter().filter(|z| z.is_finite()).map(|z| z + 0.0).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    levels
}

/// Makes border points of a lattice equal if they nearly coincide, within [`SEAM_TOLERANCE`].
///
/// The first of such points, in the order of the lattice, replaces them all. O(border²) at worst, for
/// a border whose points all have the same x; O(border log border) usually.
pub fn close_seams(n_columns: usize, points: &mut [DVec3]) {
    let n_rows = points.len() / n_columns.max(1);
    let is_border = |k: &usize| {
        let (i, j) = (k % n_columns, k / n_columns);
        i == 0 || j == 0 || i + 1 == n_columns || j + 1 == n_rows
    };
    let mut border: Vec<usize> =
        (0..points.len()).filter(is_border).filter(|&k| points[k].is_finite()).collect();
    let size = border.iter().map(|&k| points[k].abs().max_element()).fold(0.0, f64::max);
    let tolerance = size * SEAM_TOLERANCE;
    border.sort_by(|&a, &b| points[a].x.total_cmp(&points[b].x).then(a.cmp(&b)));
    let original: Vec<DVec3> = border.iter().map(|&k| points[k]).collect();
    for (at, &k) in border.iter().enumerate() {
        let p = original[at];
        let near = original[..at].iter().rev().take_while(|q| p.x - q.x <= tolerance).count();
        let ahead = original[at..].iter().take_while(|q| q.x - p.x <= tolerance).count();
        let first = (at - near..at + ahead)
            .filter(|&other| original[other].distance(p) <= tolerance)
            .min_by_key(|&other| border[other]);
        if let Some(first) = first {
            points[k] = original[first];
        }
    }
}
