//! The triangles of a scene in pixels, and the strips of rows that a picture is made of.
//!
//! ```text
//!    (0,0) ┌────────────────► x, columns      strip 0: rows 0 to 15
//!          │   ╱╲                             strip 1: rows 16 to 31
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
use crate::camera::{Camera, ImagePoint, Projection};
use crate::model::scene::Scene;
use crate::predicates::{Sight, Sign};

/// Rows of a strip. Fewer list large triangles more often; more leave threads without work and
/// need more memory.
pub const STRIP_ROWS: u32 = 16;

/// The map from the image (y upward) to pixels (y downward).
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

    /// The map to a picture with `n` times as many pixels along each side. Exact when `n` is a power
    /// of two.
    #[must_use]
    pub fn finer(&self, n: u32) -> Self {
        Self { scale: self.scale * f64::from(n), origin: self.origin * f64::from(n) }
    }

    /// Shows the rectangle between `low` and `high` as large as a margin of `margin` pixels allows.
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
    let (mut from, mut to) = (width, 0);
    for edge in edges.iter().flatten() {
        if edge.meets(row) {
            let column = edge.column(row, width);
            (from, to) = (from.min(column), to.max(column));
        }
    }
    from..to.max(from)
}

/// Some rows of a picture, and the triangles that may show there.
#[derive(Debug, Clone)]
pub struct RowStrip<'a> {
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
    /// Corners: x and y in pixels, z is nearness.
    corners: Vec<DVec3>,
    items: Vec<ListedTriangle>,
    /// Where each strip begins in `listed`, and where the last one ends.
    strip_starts: Vec<usize>,
    listed: Vec<u32>,
    /// Whether nearness is the reciprocal of a distance.
    is_perspective: bool,
}

/// A triangle, by its corners. Small, since there may be millions of which most are used once.
#[derive(Debug, Clone, Copy)]
struct ListedTriangle {
    corners: [u32; 3],
    /// Its number in the scene.
    triangle: u32,
    first_strip: u16,
    last_strip: u16,
}

impl ListedTriangle {
    /// `None` when no pixel center can be in the triangle.
    #[inline]
    fn new(
        number: u32,
        indices: [u32; 3],
        corners: [DVec3; 3],
        (width, height): (u32, u32),
    ) -> Option<Self> {
        let [a, b, c] = corners;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let rows = first_center(low.y, height)..first_center(high.y, height);
        let shows = low.is_finite()
            && high.is_finite()
            && first_center(low.x, width) < first_center(high.x, width)
            && !rows.is_empty();
        shows.then(|| Self {
            corners: indices,
            triangle: number,
            first_strip: (rows.start / STRIP_ROWS) as u16,
            last_strip: ((rows.end - 1) / STRIP_ROWS) as u16,
        })
    }
}

impl Raster {
    /// A picture of `size` = (columns, rows). O(triangles + strips they reach), in parallel.
    ///
    /// Triangles that no pixel center can be in are left out.
    pub fn new(scene: &Scene, camera: &Camera, map: &PixelMap, size: (u32, u32)) -> Self {
        let view = Corners::new(scene, camera);
        let in_pixels = |corner: &ImagePoint| view.in_pixels(corner, map);
        let mut corners: Vec<DVec3> = view.images.par_iter().map(in_pixels).collect();
        let all = 0..scene.triangles().len() as u32;
        let is_cut = |triangle: u32| view.is_cut(scene.triangles()[triangle as usize]);
        // Clipping at the near plane adds corners.
        let mut pieces = Vec::new();
        let cut: Vec<u32> = all.clone().into_par_iter().filter(|&n| is_cut(n)).collect();
        for triangle in cut {
            for piece in view.pieces(triangle).into_iter().flatten() {
                pieces.push((triangle, corners.len() as u32));
                corners.extend(piece.iter().map(in_pixels));
            }
        }
        let item = |triangle: u32, indices: [u32; 3]| {
            let item =
                ListedTriangle::new(triangle, indices, indices.map(|k| corners[k as usize]), size);
            item.filter(|_| !view.is_edge_on(triangle))
        };
        let mut items: Vec<ListedTriangle> = all
            .into_par_iter()
            .filter(|&triangle| !is_cut(triangle))
            .filter_map(|triangle| item(triangle, scene.triangles()[triangle as usize]))
            .collect();
        if !pieces.is_empty() {
            items.extend(pieces.iter().filter_map(|&(n, k)| item(n, [k, k + 1, k + 2])));
            items.sort_by_key(|item| item.triangle);
        }
        Self::listing(corners, items, size).seen_by(camera)
    }

    /// A picture, without perspective, of triangles that are in pixels already, z being nearness;
    /// each with its number.
    pub fn of_triangles(triangles: &[([DVec3; 3], u32)], size: (u32, u32)) -> Self {
        let items = (0..).zip(triangles).filter_map(|(k, &(corners, number))| {
            ListedTriangle::new(number, [3 * k, 3 * k + 1, 3 * k + 2], corners, size)
        });
        let items = items.collect();
        Self::listing(triangles.iter().flat_map(|(corners, _)| *corners).collect(), items, size)
    }

    /// Nearness is what it is for this camera.
    pub(super) fn seen_by(self, camera: &Camera) -> Self {
        let is_perspective = matches!(camera.projection(), Projection::Perspective { .. });
        Self { is_perspective, ..self }
    }

    /// Lists the items strip by strip.
    fn listing(
        corners: Vec<DVec3>,
        items: Vec<ListedTriangle>,
        (width, height): (u32, u32),
    ) -> Self {
        let n_strips = height.div_ceil(STRIP_ROWS) as usize;
        let strips =
            |item: &ListedTriangle| usize::from(item.first_strip)..=usize::from(item.last_strip);
        let mut strip_starts = vec![0; n_strips + 1];
        for strip in items.iter().flat_map(strips) {
            strip_starts[strip + 1] += 1;
        }
        for k in 0..n_strips {
            strip_starts[k + 1] += strip_starts[k];
        }
        let mut next = strip_starts.clone();
        let mut listed = vec![0; strip_starts[n_strips]];
        for (number, item) in (0..).zip(&items) {
            for strip in strips(item) {
                listed[next[strip]] = number;
                next[strip] += 1;
            }
        }
        Self { width, height, corners, items, strip_starts, listed, is_perspective: false }
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

    /// Number of triangles that may show, counting the pieces of those that the near plane cuts.
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// The triangle of an item; panics if the number is too large. A few divisions.
    #[inline]
    pub fn triangle(&self, item: u32) -> RasterTriangle {
        let item = &self.items[item as usize];
        let corners = item.corners.map(|corner| self.corners[corner as usize]);
        RasterTriangle {
            corners: corners.map(DVec3::truncate),
            plane: DepthPlane::through(corners),
            triangle: item.triangle,
        }
    }

    /// The number in the scene of an item's triangle; panics when there is no such item.
    #[inline]
    pub fn number(&self, item: u32) -> u32 {
        self.items[item as usize].triangle
    }

    /// Number of strips.
    pub fn n_strips(&self) -> usize {
        self.strip_starts.len() - 1
    }

    /// A strip; panics if the number is too large.
    pub fn strip(&self, number: usize) -> RowStrip<'_> {
        let from = number as u32 * STRIP_ROWS;
        let listed = self.strip_starts[number]..self.strip_starts[number + 1];
        RowStrip {
            rows: from..(from + STRIP_ROWS).min(self.height),
            triangles: &self.listed[listed],
        }
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
        let near = camera.near_distance();
        let range = |(low, high): (f64, f64), depth: f64| (low.min(depth), high.max(depth));
        let depths = images.iter().map(|image| image.depth);
        let (low, high) = depths.fold((f64::INFINITY, f64::NEG_INFINITY), range);
        // The farthest nearness is at least the scene's depth, so that rounding is about the same
        // everywhere.
        let size = (high - low).max(low.abs().max(high.abs()) * f64::EPSILON);
        let farthest = high + if size > 0.0 { size } else { 1.0 };
        Self { scene, sight: Sight::new(positions, camera), images, near, farthest }
    }

    /// Whether the eye is in the plane of a triangle. Exact.
    #[inline]
    fn is_edge_on(&self, triangle: u32) -> bool {
        let [p, q, r] = self.scene.triangles()[triangle as usize];
        self.sight.turn(p, q, r) == Sign::Zero
    }

    /// Whether the near plane cuts off part of a triangle, or all of it.
    #[inline]
    fn is_cut(&self, vertices: [u32; 3]) -> bool {
        self.near.is_some_and(|near| vertices.iter().any(|&v| self.images[v as usize].w < near))
    }

    /// The corners of the part of a triangle beyond the near plane: up to two triangles. Nothing if it is
    /// edge-on.
    pub fn pieces(&self, triangle: u32) -> [Option<[ImagePoint; 3]>; 2] {
        let vertices = self.scene.triangles()[triangle as usize];
        if self.is_edge_on(triangle) {
            return [None, None];
        }
        let corners = vertices.map(|vertex| self.images[vertex as usize]);
        let Some(near) = self.near else { return [Some(corners), None] };
        let kept = corners.map(|corner| corner.w >= near);
        // From the corner that is kept to the other, so that neighbors get the same point.
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

    /// For each piece of a triangle, the sides of the triangle that its sides are on; `None` for cuts at
    /// the near plane and for the diagonal between two pieces.
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

    /// A corner in pixels; z is its nearness.
    #[inline]
    pub(super) fn in_pixels(&self, corner: &ImagePoint, map: &PixelMap) -> DVec3 {
        map.pixel(corner.image()).extend(self.nearness(corner))
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
