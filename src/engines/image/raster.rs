//! The triangles of a scene in pixels, and the strips of rows that a picture is made of.
//!
//! ```text
//!    (0,0) ┌────────────────► x, columns      strip 0: rows 0 to 31
//!          │   ╱╲                             strip 1: rows 32 to 63
//!          │  ╱  ╲                            …
//!          ▼ ╱────╲                           each knows the triangles that
//!        y, rows                              may show in it, by number
//! ```
//!
//! In perspective, triangles are cut at the near plane first. Corners are rounded here; from here on
//! borders are decided exactly.

use std::ops::Range;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::depth::DepthPlane;
use super::edge::{PixelEdge, first_center};
use crate::classify::ImagePoint;
use crate::predicates::{Sight, Sign};
use crate::scene::Scene;
use crate::view::{Camera, Projection};

/// Rows of a strip. Fewer list large triangles more often; more leave threads without work and
/// need more memory.
pub const STRIP_ROWS: u32 = 32;

/// The map from the image (y upwards) to pixels (y downwards).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelMap {
    /// Pixels for a unit of the image.
    pub scale: f64,
    /// The pixel coordinates of the image's origin.
    pub origin: DVec2,
}

impl PixelMap {
    /// A point of the image in pixels.
    #[inline]
    pub fn pixel(&self, image: DVec2) -> DVec2 {
        DVec2::new(self.origin.x + image.x * self.scale, self.origin.y - image.y * self.scale)
    }

    /// Shows the rectangle between `low` and `high` as large as leaves `margin` pixels on each side.
    pub fn fitting((low, high): (DVec2, DVec2), size: (u32, u32), margin: f64) -> Self {
        let (width, height) = (f64::from(size.0), f64::from(size.1));
        let room = DVec2::new(width - 2.0 * margin, height - 2.0 * margin).max(DVec2::ONE);
        let scale = (room / (high - low)).min_element();
        let scale = if scale > 0.0 && scale.is_finite() { scale } else { 1.0 };
        let middle = (low + high) / 2.0;
        let origin = DVec2::new(width / 2.0 - middle.x * scale, height / 2.0 + middle.y * scale);
        Self { scale, origin }
    }

    /// Shows exactly the vertical field of view, with the target in the middle; `None` for an
    /// orthographic camera.
    pub fn field_of_view(camera: &Camera, size: (u32, u32)) -> Option<Self> {
        let Projection::Perspective { fov_deg, .. } = camera.projection() else { return None };
        let (width, height) = (f64::from(size.0), f64::from(size.1));
        let scale = height / 2.0 / libm::tan(fov_deg.to_radians() / 2.0);
        Some(Self { scale, origin: DVec2::new(width, height) / 2.0 })
    }
}

/// A triangle in pixels.
#[derive(Debug, Clone, Copy)]
pub struct RasterTriangle {
    /// Its corners.
    pub corners: [DVec2; 3],
    /// How near it is.
    pub plane: DepthPlane,
    /// Its number among those of the scene.
    pub triangle: u32,
}

impl RasterTriangle {
    /// Its edges that are not level.
    #[inline]
    pub fn edges(&self) -> [Option<PixelEdge>; 3] {
        let [a, b, c] = self.corners;
        [PixelEdge::new(a, b), PixelEdge::new(b, c), PixelEdge::new(c, a)]
    }

    /// The rows that it may cover of those in `within`.
    #[inline]
    pub fn rows(&self, within: &Range<u32>) -> Range<u32> {
        let [a, b, c] = self.corners.map(|corner| corner.y);
        let from = first_center(a.min(b).min(c), within.end).max(within.start);
        from..first_center(a.max(b).max(c), within.end).max(from)
    }
}

/// The columns of a row between the edges of a triangle.
#[inline]
pub fn columns(edges: &[Option<PixelEdge>; 3], row: u32, width: u32) -> Range<u32> {
    let here = row..row + 1;
    let met = edges.iter().flatten().filter(|edge| !edge.rows(&here).is_empty());
    let (from, to) = met
        .map(|edge| edge.column(row, edge.estimate(row), width))
        .fold((width, 0), |(from, to), column| (from.min(column), to.max(column)));
    from..to.max(from)
}

/// Some rows of a picture, and the triangles that may show there.
#[derive(Debug, Clone)]
pub struct Strip<'a> {
    /// The rows.
    pub rows: Range<u32>,
    /// Numbers of triangles of the raster, increasing.
    pub triangles: &'a [u32],
}

/// The triangles that may show in a picture. They are in the order of the scene's triangles; of
/// those with equal depth the first is seen.
#[derive(Debug, Clone)]
pub struct Raster {
    width: u32,
    height: u32,
    triangles: Vec<RasterTriangle>,
    /// Where each strip begins in `listed`, and where the last one ends.
    strip_starts: Vec<usize>,
    listed: Vec<u32>,
    /// Whether nearness is the reciprocal of a distance.
    is_perspective: bool,
}

impl Raster {
    /// A picture of `size` = (columns, rows). O(triangles + strips they reach).
    pub fn new(scene: &Scene, camera: &Camera, map: &PixelMap, size: (u32, u32)) -> Self {
        let view = Corners::new(scene, camera);
        let (right, bottom) = (f64::from(size.0), f64::from(size.1));
        let triangles: Vec<RasterTriangle> = (0..scene.triangles().len() as u32)
            .into_par_iter()
            .flat_map_iter(|triangle| {
                view.pieces(triangle).into_iter().flatten().map(move |corners| (triangle, corners))
            })
            .filter_map(|(triangle, corners)| {
                let pixels = corners.map(|corner| map.pixel(corner.image()));
                let low = pixels[0].min(pixels[1]).min(pixels[2]);
                let high = pixels[0].max(pixels[1]).max(pixels[2]);
                let shows = low.is_finite()
                    && high.is_finite()
                    && low.cmple(DVec2::new(right, bottom)).all()
                    && high.cmpge(DVec2::ZERO).all();
                let nearness = corners.map(|corner| view.nearness(&corner));
                let lifted = |k: usize| pixels[k].extend(nearness[k]);
                shows.then(|| RasterTriangle {
                    corners: pixels,
                    plane: DepthPlane::through([lifted(0), lifted(1), lifted(2)]),
                    triangle,
                })
            })
            .collect();
        let is_perspective = view.near.is_some();
        Self { is_perspective, ..Self::of_triangles(triangles, size) }
    }

    /// A picture, without perspective, of triangles that are in pixels already.
    pub fn of_triangles(triangles: Vec<RasterTriangle>, size: (u32, u32)) -> Self {
        let (width, height) = size;
        let n_strips = height.div_ceil(STRIP_ROWS) as usize;
        let strips = |triangle: &RasterTriangle| {
            let rows = triangle.rows(&(0..height));
            let from = (rows.start / STRIP_ROWS) as usize;
            from..if rows.is_empty() { from } else { rows.end.div_ceil(STRIP_ROWS) as usize }
        };
        let mut strip_starts = vec![0; n_strips + 1];
        for triangle in &triangles {
            for strip in strips(triangle) {
                strip_starts[strip + 1] += 1;
            }
        }
        for k in 0..n_strips {
            strip_starts[k + 1] += strip_starts[k];
        }
        let mut next = strip_starts.clone();
        let mut listed = vec![0; strip_starts[n_strips]];
        for (number, triangle) in (0..).zip(&triangles) {
            for strip in strips(triangle) {
                listed[next[strip]] = number;
                next[strip] += 1;
            }
        }
        Self { width, height, triangles, strip_starts, listed, is_perspective: false }
    }

    /// The same picture with `n` times as many pixels along each side, whose strips are those of
    /// this one divided by `n`. Exact when `n` is a power of two.
    #[must_use]
    pub fn finer(&self, n: u32) -> Self {
        let times = f64::from(n);
        let triangles = self.triangles.par_iter().map(|triangle| RasterTriangle {
            corners: triangle.corners.map(|corner| corner * times),
            plane: triangle.plane.finer(times),
            ..*triangle
        });
        let finer = Self::of_triangles(triangles.collect(), (self.width * n, self.height * n));
        Self { is_perspective: self.is_perspective, ..finer }
    }

    /// The distance along the direction of view for a nearness, up to a constant.
    pub fn distance(&self, nearness: f64) -> f64 {
        if self.is_perspective { 1.0 / nearness } else { -nearness }
    }

    /// Number of columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The triangles that may show, and pieces of those that the near plane cuts.
    pub fn triangles(&self) -> &[RasterTriangle] {
        &self.triangles
    }

    /// Number of strips.
    pub fn n_strips(&self) -> usize {
        self.strip_starts.len() - 1
    }

    /// A strip; panics when there is none of that number.
    pub fn strip(&self, number: usize) -> Strip<'_> {
        let from = number as u32 * STRIP_ROWS;
        let listed = self.strip_starts[number]..self.strip_starts[number + 1];
        Strip { rows: from..(from + STRIP_ROWS).min(self.height), triangles: &self.listed[listed] }
    }
}

/// The images of a scene's triangles, cut at the near plane.
pub struct Corners<'a> {
    scene: &'a Scene,
    sight: Sight<'a>,
    images: Vec<ImagePoint>,
    /// The least w that is kept; `None` without a near plane.
    near: Option<f64>,
    /// Depth that becomes nearness 0 without perspective.
    farthest: f64,
}

impl<'a> Corners<'a> {
    /// O(vertices), in parallel.
    pub fn new(scene: &'a Scene, camera: &Camera) -> Self {
        let positions = scene.mesh().positions();
        let (eye, frame) = (camera.eye(), camera.frame());
        let images: Vec<ImagePoint> =
            positions.par_iter().map(|&p| ImagePoint::new(p - eye, camera, &frame)).collect();
        let near = match camera.projection() {
            Projection::Perspective { near, .. } => Some(near * camera.forward().length()),
            Projection::Orthographic => None,
        };
        let range = |(low, high): (f64, f64), depth: f64| (low.min(depth), high.max(depth));
        let depths = images.iter().map(|image| image.depth);
        let (low, high) = depths.fold((f64::INFINITY, f64::NEG_INFINITY), range);
        // The farthest nearness is the scene's depth or more, so that rounding is even all over.
        let size = (high - low).max(low.abs().max(high.abs()) * f64::EPSILON);
        let farthest = high + if size > 0.0 { size } else { 1.0 };
        Self { scene, sight: Sight::new(positions, camera), images, near, farthest }
    }

    /// The corners of what the near plane leaves of a triangle: up to two triangles. Nothing when it
    /// is edge-on.
    pub fn pieces(&self, triangle: u32) -> [Option<[ImagePoint; 3]>; 2] {
        let vertices = self.scene.triangles()[triangle as usize];
        let [p, q, r] = vertices;
        if self.sight.turn(p, q, r) == Sign::Zero {
            return [None, None];
        }
        let corners = vertices.map(|vertex| self.images[vertex as usize]);
        let Some(near) = self.near else { return [Some(corners), None] };
        let kept = corners.map(|corner| corner.w >= near);
        // From the kept corner to the other, so that neighbors get the same point.
        let cut = |from: usize, to: usize| {
            let (a, b) = (corners[from], corners[to]);
            let mut point = a.towards(b, (a.w - near) / (a.w - b.w));
            point.w = near;
            point
        };
        match kept.iter().filter(|&&kept| kept).count() {
            0 => [None, None],
            3 => [Some(corners), None],
            1 => {
                let a = kept.iter().position(|&kept| kept).unwrap_or_default();
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                [Some([corners[a], cut(a, b), cut(a, c)]), None]
            }
            _ => {
                let c = kept.iter().position(|&kept| !kept).unwrap_or_default();
                let (a, b) = ((c + 1) % 3, (c + 2) % 3);
                let (at_a, at_b) = (cut(a, c), cut(b, c));
                [Some([corners[a], corners[b], at_b]), Some([corners[a], at_b, at_a])]
            }
        }
    }

    /// For each piece of a triangle the sides of the triangle that its sides lie on; `None` for what
    /// the near plane cuts and for the diagonal between two pieces.
    pub fn side_sources(&self, triangle: u32) -> [[Option<usize>; 3]; 2] {
        const WHOLE: [Option<usize>; 3] = [Some(0), Some(1), Some(2)];
        let vertices = self.scene.triangles()[triangle as usize];
        let near = self.near.unwrap_or(f64::NEG_INFINITY);
        let kept = vertices.map(|vertex| self.images[vertex as usize].w >= near);
        match kept.iter().filter(|&&kept| kept).count() {
            1 => {
                let a = kept.iter().position(|&kept| kept).unwrap_or_default();
                [[Some(a), None, Some((a + 2) % 3)], [None; 3]]
            }
            2 => {
                let c = kept.iter().position(|&kept| !kept).unwrap_or_default();
                let (a, b) = ((c + 1) % 3, (c + 2) % 3);
                [[Some(a), Some(b), None], [None, None, Some(c)]]
            }
            _ => [WHOLE, WHOLE],
        }
    }

    /// See [`super::depth`].
    #[inline]
    fn nearness(&self, corner: &ImagePoint) -> f64 {
        if self.near.is_some() { 1.0 / corner.w } else { self.farthest - corner.depth }
    }

    /// The rectangle of the image that the triangles cover; `None` when there are none.
    pub fn bounds(&self) -> Option<(DVec2, DVec2)> {
        let n_triangles = self.scene.triangles().len() as u32;
        let nothing = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let joined = |a: (DVec2, DVec2), b: (DVec2, DVec2)| (a.0.min(b.0), a.1.max(b.1));
        let (low, high) = (0..n_triangles)
            .into_par_iter()
            .flat_map_iter(|triangle| self.pieces(triangle).into_iter().flatten().flatten())
            .map(|corner| (corner.image(), corner.image()))
            .reduce(|| nothing, joined);
        (low.is_finite() && high.is_finite()).then_some((low, high))
    }
}

/// A triangle with corners in pixels and their nearness.
pub fn triangle_in_pixels(corners: [DVec3; 3], triangle: u32) -> RasterTriangle {
    RasterTriangle {
        corners: corners.map(DVec3::truncate),
        plane: DepthPlane::through(corners),
        triangle,
    }
}
