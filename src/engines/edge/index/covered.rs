//! Cells of an index behind which everything is hidden.
//!
//! ```text
//!   ┌──────┬──────┐       Whatever lies behind a covered cell (▓), as seen from the eye, is hidden
//!   │▓▓▓▓▓▓│▓▓▓▓▓▓│       there: W. R. Franklin, "A linear time exact hidden surface algorithm",
//!   │▓▓▓▓▓▓│▓▓▓▓▓▓│       SIGGRAPH 1980. A cell is covered by a single triangle, or by several that
//!   ├──────┴──╲───┤       meet edge to edge all over it. This is area coherence: what is true at one
//!   │▓▓▓▓▓▓▓▓▓▓╲▓▓│       point of a cell is true in all of it.
//!   └───────────╲─┘
//! ```
//!
//! Why a cell that several triangles cover has no gap: start at a point of the cell inside one
//! triangle and walk to any other point of the cell. The walk leaves a triangle through one of its
//! sides. If that side is *sealed* (shared with exactly one other triangle, which lies on the other
//! side of its image) the walk is inside that triangle from there on. So it is enough that every
//! side that comes near the cell is sealed. Whether a side is sealed is decided exactly; whether it
//! comes near the cell is rounded, and counts as near in doubt.

use super::super::rounding::Rounding;
use super::{ImageIndex, Level, Placed};
use crate::classify::ViewedScene;
use crate::predicates::Sign;
use glam::{DVec2, DVec3, dvec2};
use rayon::prelude::*;

/// Triangles seen at a flatter angle than this sine are not used as covers of cells: the contact
/// tolerance, divided by it, becomes a distance along the sight line.
const MIN_COVER_SINE: f64 = 0.05;

/// Triangles with a flatter corner than this sine are not used as covers of cells: their normals
/// lose too many digits.
const MIN_CORNER_SINE: f64 = 1e-6;

/// Each component of the unit normal of a cover is off by less than this: a dozen roundings,
/// divided by [`MIN_CORNER_SINE`].
const NORMAL_ERROR: f64 = 1e-9;

/// Covers are tried on cells of the level that is this much finer than their own, or the finest.
const FINER: u32 = 2;

/// Cells that a border of a surface crosses are quartered this many times.
const MAX_QUARTERINGS: u32 = 3;

/// More triangles than this are not tried on one cell.
const MAX_PATCH: usize = 24;

/// A triangle without a neighbor across a side that is not sealed.
const NONE: u32 = u32::MAX;

impl ImageIndex {
    /// For each cell of every level the smallest depth known behind which it is covered; infinite
    /// where it is not.
    pub(super) fn find_covered_cells(
        &self,
        view: &ViewedScene,
        near: &[Vec<Placed>],
        contact_tolerance: f64,
    ) -> Vec<f64> {
        let covers = Covers::new(view, self.rounding, near, contact_tolerance);
        let parts: Vec<Vec<(u32, f64)>> = (0..covers.list.len())
            .into_par_iter()
            .with_min_len(64)
            .fold(Vec::new, |mut covered, first| {
                self.cover_cells(&covers, first as u32, &mut covered);
                covered
            })
            .collect();
        let mut covered_from = vec![f64::INFINITY; self.starts.len() - 1];
        for &(cell, depth) in parts.iter().flatten() {
            let from = &mut covered_from[cell as usize];
            *from = from.min(depth);
        }
        // A cell is covered when its four parts are, and they are covered when it is.
        for pair in self.levels.windows(2) {
            for_parts(&pair[0], &pair[1], |cell, parts| {
                let behind_parts = parts
                    .iter()
                    .map(|part| part.map_or(f64::NEG_INFINITY, |p| covered_from[p as usize]))
                    .fold(f64::NEG_INFINITY, f64::max);
                let from = &mut covered_from[cell as usize];
                *from = from.min(behind_parts);
            });
        }
        for pair in self.levels.windows(2).rev() {
            for_parts(&pair[0], &pair[1], |cell, parts| {
                let whole = covered_from[cell as usize];
                for &part in parts.iter().flatten() {
                    let from = &mut covered_from[part as usize];
                    *from = from.min(whole);
                }
            });
        }
        covered_from
    }

    /// Finds the cells that one triangle covers, alone or with others around it.
    fn cover_cells(&self, covers: &Covers, first: u32, covered: &mut Vec<(u32, f64)>) {
        let placed = &covers.list[first as usize].placed;
        let level = placed.level.saturating_sub(FINER);
        let grid = &self.levels[level as usize];
        for row in self.row(grid, placed.bounds.low.y)..=self.row(grid, placed.bounds.high.y) {
            let columns =
                self.column(grid, placed.bounds.low.x)..=self.column(grid, placed.bounds.high.x);
            for column in columns {
                self.cover_cell(covers, first, [level, row, column], MAX_QUARTERINGS, covered);
            }
        }
    }

    fn cover_cell(
        &self,
        covers: &Covers,
        first: u32,
        [level, row, column]: [u32; 3],
        quarterings: u32,
        covered: &mut Vec<(u32, f64)>,
    ) {
        let grid = &self.levels[level as usize];
        if row >= grid.rows || column >= grid.columns {
            return;
        }
        let low = self.origin + grid.cell * dvec2(f64::from(column), f64::from(row));
        let square = Square { low, high: low + grid.cell };
        // Border cells stand for all that lies further out: no triangle covers that.
        let is_inner = |i: u32, n: u32| 0 < i && i + 1 < n;
        let is_bounded =
            !self.has_border_cells() || is_inner(row, grid.rows) && is_inner(column, grid.columns);
        match covers.patch_over(&square, first) {
            Patch::Apart => {}
            Patch::Whole(depth) if is_bounded => {
                covered.push((grid.first + row * grid.columns + column, depth));
            }
            Patch::Whole(_) | Patch::Torn => {
                if level > 0 && quarterings > 0 {
                    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        let part = [level - 1, 2 * row + i, 2 * column + j];
                        self.cover_cell(covers, first, part, quarterings - 1, covered);
                    }
                }
            }
        }
    }
}

/// A cell in the image.
struct Square {
    low: DVec2,
    high: DVec2,
}

/// What a triangle and those that continue from it across sealed sides do to a cell.
enum Patch {
    /// The triangle lies beside the cell.
    Apart,
    /// There may be gaps.
    Torn,
    /// They cover all of it, and all that lies behind this depth.
    Whole(f64),
}

/// A triangle that may cover cells.
struct Cover {
    placed: Placed,
    points: [DVec2; 3],
    /// The covers across the sides, [`NONE`] where one is not sealed. Side `i` begins at corner `i`.
    neighbors: [u32; 3],
    plane: DepthPlane,
}

/// All triangles that may cover cells: those that are large compared with the finest cells.
struct Covers {
    list: Vec<Cover>,
    rounding: Rounding,
}

impl Covers {
    fn new(
        view: &ViewedScene,
        rounding: Rounding,
        near: &[Vec<Placed>],
        contact_tolerance: f64,
    ) -> Self {
        let corners = |placed: &Placed| view.scene().triangles()[placed.item as usize];
        let mut list: Vec<Cover> = near
            .par_iter()
            .flatten()
            .filter(|placed| placed.level > 0)
            .filter_map(|&placed| {
                let corners = corners(&placed);
                Some(Cover {
                    placed,
                    points: corners.map(|corner| view.image()[corner as usize].image()),
                    neighbors: [NONE; 3],
                    plane: DepthPlane::new(view, corners, contact_tolerance)?,
                })
            })
            .collect();
        // Sides by their vertices, with the sign of the side of the image that the triangle is on.
        let mut sides: Vec<([u32; 2], u32, usize, Sign)> = list
            .par_iter()
            .enumerate()
            .flat_map_iter(|(i, cover)| {
                let corners = corners(&cover.placed);
                let turn = view.triangle_turns()[cover.placed.item as usize];
                (0..3).map(move |side| {
                    let (p, q) = (corners[side], corners[(side + 1) % 3]);
                    let sign = if p < q { turn } else { turn.flipped() };
                    ([p.min(q), p.max(q)], i as u32, side, sign)
                })
            })
            .collect();
        sides.par_sort_unstable();
        for same in sides.chunk_by(|a, b| a.0 == b.0) {
            if let &[(_, a, side_a, sign_a), (_, b, side_b, sign_b)] = same
                && sign_a == sign_b.flipped()
            {
                list[a as usize].neighbors[side_a] = b;
                list[b as usize].neighbors[side_b] = a;
            }
        }
        Self { list, rounding }
    }

    /// What `first` and the triangles around it do to a cell.
    fn patch_over(&self, cell: &Square, first: u32) -> Patch {
        let mut patch = [NONE; MAX_PATCH];
        patch[0] = first;
        let (mut n, mut next, mut depth) = (1, 0, f64::NEG_INFINITY);
        let mut is_inside = false;
        while next < n {
            let cover = &self.list[patch[next] as usize];
            let square = self.grown(cell, cover);
            for side in 0..3 {
                if !square.is_near(cover.points[side], cover.points[(side + 1) % 3]) {
                    continue;
                }
                let neighbor = cover.neighbors[side];
                if neighbor == NONE {
                    return if next == 0 && self.is_apart(cell, cover) {
                        Patch::Apart
                    } else {
                        Patch::Torn
                    };
                }
                if patch[..n].contains(&neighbor) {
                    continue;
                }
                if n == MAX_PATCH {
                    return Patch::Torn;
                }
                patch[n] = neighbor;
                n += 1;
            }
            depth = depth.max(cover.depth_over(&square, &self.rounding));
            is_inside |= self.holds(cover, 0.5 * (cell.low + cell.high))
                || self.holds(cover, cell.low + 0.3 * (cell.high - cell.low));
            next += 1;
        }
        if is_inside { Patch::Whole(depth) } else { Patch::Apart }
    }

    /// The cell with room for the errors of a triangle's image and of the cell's own corners.
    fn grown(&self, cell: &Square, cover: &Cover) -> Square {
        let margin = 4.0 * self.error_near(cell, cover);
        Square { low: cell.low - margin, high: cell.high + margin }
    }

    fn error_near(&self, cell: &Square, cover: &Cover) -> f64 {
        let bounds = &cover.placed.bounds;
        let farthest = [cell.low, cell.high, bounds.low, bounds.high]
            .into_iter()
            .fold(DVec2::ZERO, |far, p| far.max(p.abs()));
        self.rounding.image_error(farthest.element_sum())
    }

    /// Whether the box of a triangle's image lies beside a cell.
    fn is_apart(&self, cell: &Square, cover: &Cover) -> bool {
        let bounds = &cover.placed.bounds;
        bounds.high.cmplt(cell.low).any() || bounds.low.cmpgt(cell.high).any()
    }

    /// Whether a point of a cell certainly lies in a triangle's image.
    fn holds(&self, cover: &Cover, point: DVec2) -> bool {
        let error = self.error_near(&Square { low: point, high: point }, cover);
        let offsets = cover.points.map(|p| p - point);
        let reach = offsets.iter().fold(DVec2::ZERO, |reach, d| reach.max(d.abs()));
        // Each factor of an area is off by two errors at most.
        let slack = 8.0 * error * (reach.element_sum() + error);
        let areas = [0, 1, 2].map(|i| offsets[i].perp_dot(offsets[(i + 1) % 3]));
        areas.iter().all(|&area| area > slack) || areas.iter().all(|&area| area < -slack)
    }
}

impl Square {
    /// Whether a line between two points comes near; in doubt, yes.
    fn is_near(&self, a: DVec2, b: DVec2) -> bool {
        if a.max(b).cmplt(self.low).any() || a.min(b).cmpgt(self.high).any() {
            return false;
        }
        // Beside the line lie all four corners, on one side.
        let along = b - a;
        let (center, half) = (0.5 * (self.low + self.high), 0.5 * (self.high - self.low));
        let offset = center - a;
        let reach = half.x * along.y.abs() + half.y * along.x.abs();
        let sizes = (offset.x * along.y).abs() + (offset.y * along.x).abs() + reach;
        along.perp_dot(offset).abs() <= reach + 8.0 * f64::EPSILON * sizes
    }
}

impl Cover {
    /// No point of the triangle over a cell, nor any in contact with it there, is deeper than this.
    fn depth_over(&self, square: &Square, rounding: &Rounding) -> f64 {
        let corners = [
            square.low,
            square.high,
            dvec2(square.low.x, square.high.y),
            dvec2(square.high.x, square.low.y),
        ];
        let depths = corners.map(|corner| self.plane.depth_at(corner));
        // What is not a number of the plane's front side says nothing.
        let over_cell = depths.into_iter().fold(f64::NEG_INFINITY, |deepest, depth| {
            if depth.is_nan() { f64::INFINITY } else { deepest.max(depth) }
        });
        let over_cell = over_cell + rounding.depth_error();
        over_cell.min(self.placed.bounds.farthest) + self.plane.contact_reach
    }
}

/// The depth of a triangle's plane as a function of the image, rounded upward.
struct DepthPlane {
    /// The unit normal along the image's axes and the direction of view.
    normal: DVec3,
    /// The height of the triangle's first corner over the eye, along the normal.
    height: f64,
    /// The distance of that corner from the eye.
    distance: f64,
    is_perspective: bool,
    /// How much deeper than the plane what is in contact with it may lie.
    contact_reach: f64,
}

impl DepthPlane {
    /// `None` for a triangle that is too flat, to the eye or by itself, to serve as a cover.
    fn new(view: &ViewedScene, corners: [u32; 3], contact_tolerance: f64) -> Option<Self> {
        let positions = view.sight().positions();
        let [p, q, r] = corners.map(|corner| positions[corner as usize]);
        let (a, b) = (q - p, r - p);
        let product = a.cross(b);
        if product.length() < MIN_CORNER_SINE * a.length() * b.length() {
            return None;
        }
        let normal = product.normalize_or_zero();
        let (eye, frame) = (view.camera().eye(), view.camera().frame());
        let is_perspective = view.sight().has_near_plane();
        let height = normal.dot(p - eye);
        let sine = if is_perspective {
            let farthest = [p, q, r].iter().map(|&v| (v - eye).length()).fold(0.0, f64::max);
            height.abs() / farthest
        } else {
            normal.dot(frame.forward).abs()
        };
        // Not a number where sizes are out of range.
        (sine > MIN_COVER_SINE).then(|| Self {
            normal: DVec3::new(
                normal.dot(frame.right),
                normal.dot(frame.upward),
                normal.dot(frame.forward),
            ),
            height,
            distance: (p - eye).length(),
            is_perspective,
            contact_reach: contact_tolerance / sine,
        })
    }

    /// A depth that is at least the plane's at a point of the image; not a number where the plane
    /// does not meet the sight line in front of the eye.
    fn depth_at(&self, point: DVec2) -> f64 {
        let [x, y] = point.to_array();
        let sizes = 1.0 + x.abs() + y.abs();
        if self.is_perspective {
            let slope = self.normal.dot(DVec3::new(x, y, 1.0));
            let depth = self.height / slope;
            let error = NORMAL_ERROR * (1.0 / MIN_COVER_SINE + 4.0 * sizes / slope.abs());
            if depth > 0.0 && error < 1.0 { depth * (1.0 + 2.0 * error) } else { f64::NAN }
        } else {
            let [across, upward, along] = self.normal.to_array();
            let sizes = self.distance + x.abs() + y.abs();
            let error = 4.0 * NORMAL_ERROR * sizes / (MIN_COVER_SINE * MIN_COVER_SINE);
            (self.height - x * across - y * upward) / along + error
        }
    }
}

/// Calls `f` with each cell of `coarse` and its up to four parts in `fine`.
fn for_parts(fine: &Level, coarse: &Level, mut f: impl FnMut(u32, [Option<u32>; 4])) {
    for row in 0..coarse.rows {
        for column in 0..coarse.columns {
            let part = |i: u32, j: u32| {
                let (x, y) = (2 * column + i, 2 * row + j);
                (x < fine.columns && y < fine.rows).then(|| fine.first + y * fine.columns + x)
            };
            f(
                coarse.first + row * coarse.columns + column,
                [part(0, 0), part(1, 0), part(0, 1), part(1, 1)],
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Covers, Patch, Placed, Rounding, Square};
    use crate::camera::{Camera, Projection};
    use crate::classify::{LineSelection, ViewedScene};
    use crate::engines::edge::rounding::Place;
    use crate::model::mesh::{Mesh, PolygonSoup};
    use crate::model::scene::Scene;
    use glam::{DVec3, dvec2, dvec3};

    #[test]
    fn a_cell_nearer_to_an_open_side_than_the_image_is_exact_is_not_covered() {
        let positions = vec![dvec3(-1.0, -3.0, 0.0), dvec3(5.0, 0.0, 0.0), dvec3(-1.0, 3.0, 0.0)];
        let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
        soup.push_face(&[0, 1, 2]);
        let scene = Mesh::new(soup).map(|(mesh, _)| Scene::new(mesh)).unwrap_or_default();
        let eye = dvec3(0.0, 0.0, 7.0);
        let projection = Projection::Perspective { fov_deg: 40.0, near: 1e-6 };
        let camera = Camera::new(eye, DVec3::ZERO, DVec3::Y, projection).expect("a camera");
        let view = ViewedScene::new(&scene, &camera, LineSelection::all_edges(), 30.0);
        let rounding = Rounding::new(&view);
        let Place::Triangle(bounds, image) = rounding.place(&view, 0) else { panic!("not placed") };
        let placed = Placed { item: 0, level: 1, bounds, image, finer: 0 };
        let covers = Covers::new(&view, rounding, &[vec![placed]], 0.0);
        let side = image.iter().map(|p| p.x).fold(f64::INFINITY, f64::min);
        let error = rounding.image_error(dvec2(side.abs(), 0.2).element_sum());
        let covered = |inside: f64| {
            let low = dvec2(side + inside, -0.1);
            matches!(covers.patch_over(&Square { low, high: low + 0.2 }, 0), Patch::Whole(_))
        };
        assert!(covered(1e-3), "a cell well inside");
        assert!(!covered(-1e-3), "a cell across the side");
        // The side itself and the cell may each be off by so much.
        assert!(side + error > side && !covered(error) && !covered(2.0 * error));
    }
}
