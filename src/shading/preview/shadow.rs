//! Which points of a picture the light does not reach: a grid over what the light sees.
//!
//! ```text
//!       ☼          The light's own image is divided into cells, each of which lists the triangles that
//!     ╱ │ ╲        its rays may meet. A point of the scene lies in one cell; it is dark when one of
//!    ┌──┼──┐       these covers it and is nearer to the light.
//!    └──┼──┘
//!       ● P
//! ```
//!
//! Rounded, as befits pixels: the lines of hatching decide the same exactly.

use glam::{DVec2, DVec3};

use crate::camera::{Camera, ImagePoint};
use crate::groups::Groups;
use crate::model::scene::Scene;
use crate::shading::normals::{area_vector, corners};

/// Triangles for each cell, about.
const TRIANGLES_PER_CELL: f64 = 2.0;

/// Most cells along a side.
const MOST_CELLS: f64 = 2048.0;

/// A triangle casts a shadow on points at least this far behind it, as a part of the scene's depth.
const CONTACT: f64 = 1e-9;

/// Triangles by what the light sees of them.
pub(super) struct ShadowGrid<'a> {
    scene: &'a Scene,
    camera: Camera,
    images: Vec<ImagePoint>,
    low: DVec2,
    cells_per_unit: f64,
    columns: usize,
    rows: usize,
    /// The triangles of each cell.
    by_cell: Groups,
    contact: f64,
}

impl<'a> ShadowGrid<'a> {
    /// The grid for a camera in the place of the light. O(triangles + cells that they reach).
    pub(super) fn new(scene: &'a Scene, camera: Camera) -> Self {
        let frame = camera.frame();
        let image = |p: &DVec3| ImagePoint::new(*p - camera.eye(), &camera, &frame);
        let images: Vec<ImagePoint> = scene.mesh().positions().iter().map(image).collect();
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (mut nearest, mut farthest) = (f64::INFINITY, f64::NEG_INFINITY);
        for image in &images {
            (low, high) = (low.min(image.image()), high.max(image.image()));
            (nearest, farthest) = (nearest.min(image.depth), farthest.max(image.depth));
        }
        let size = high - low;
        let cells = (scene.triangles().len() as f64 / TRIANGLES_PER_CELL).sqrt().ceil();
        let cells = cells.clamp(1.0, MOST_CELLS);
        let per_unit = cells / size.max_element();
        let cells_per_unit = if per_unit.is_finite() { per_unit } else { 1.0 };
        let count =
            |length: f64| (length * cells_per_unit).floor().clamp(0.0, MOST_CELLS) as usize + 1;
        let (columns, rows) = (count(size.x), count(size.y));
        let mut grid = Self {
            scene,
            camera,
            images,
            low,
            cells_per_unit,
            columns,
            rows,
            by_cell: Groups::default(),
            contact: CONTACT * (farthest - nearest),
        };
        let all = 0..scene.triangles().len() as u32;
        grid.by_cell = Groups::new(columns * rows, |sorter| {
            all.clone().for_each(|triangle| {
                grid.for_cells(triangle, |cell| sorter.put(cell, triangle));
            });
        });
        grid
    }

    fn cell(&self, image: DVec2) -> (usize, usize) {
        let at = (image - self.low) * self.cells_per_unit;
        ((at.x as usize).min(self.columns - 1), (at.y as usize).min(self.rows - 1))
    }

    /// Calls `f` with the cells that the box around a triangle's image touches.
    fn for_cells(&self, triangle: u32, mut f: impl FnMut(usize)) {
        let [a, b, c] =
            self.scene.triangles()[triangle as usize].map(|v| self.images[v as usize].image());
        let (low, high) = (self.cell(a.min(b).min(c)), self.cell(a.max(b).max(c)));
        for row in low.1..=high.1 {
            for column in low.0..=high.0 {
                f(row * self.columns + column);
            }
        }
    }

    /// Whether something keeps the light from a point of a triangle.
    pub(super) fn hides(&self, at: DVec3, own: u32) -> bool {
        let frame = self.camera.frame();
        let point = ImagePoint::new(at - self.camera.eye(), &self.camera, &frame);
        let image = point.image();
        let (column, row) = self.cell(image);
        let cell = row * self.columns + column;
        self.by_cell
            .of(cell)
            .iter()
            .any(|&triangle| triangle != own && self.covers(triangle, image, at))
    }

    /// Whether a triangle covers a point from the light.
    fn covers(&self, triangle: u32, image: DVec2, at: DVec3) -> bool {
        let vertices = self.scene.triangles()[triangle as usize];
        let [a, b, c] = vertices.map(|v| self.images[v as usize].image() - image);
        let turns = [a.perp_dot(b), b.perp_dot(c), c.perp_dot(a)];
        let is_within =
            turns.iter().all(|&turn| turn > 0.0) || turns.iter().all(|&turn| turn < 0.0);
        if !is_within {
            return false;
        }
        let points = corners(self.scene, triangle);
        let normal = area_vector(points).normalize_or_zero();
        let towards = normal.dot(self.camera.eye() - points[0]);
        let towards = match self.camera.projection() {
            crate::camera::Projection::Perspective { .. } => towards,
            crate::camera::Projection::Orthographic => -normal.dot(self.camera.forward()),
        };
        // Behind the plane, as the light sees it.
        let height = normal.dot(at - points[0]);
        height * towards.signum() < -self.contact
    }
}
