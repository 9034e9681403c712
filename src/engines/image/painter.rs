//! The painter's algorithm: faces from far to near, each painted over the ones before.
//!
//! ```text
//!   engines::face ─► fragments from far to near ─► triangles in pixels, in that order ─► items
//!                    faces that cross are cut                                  no depth is kept
//! ```
//!
//! Source: lecture notes on visibility (Slovak), section 3: Newell, Newell and Sancha's order with
//! its tests and splits ([`depth_sort`]). Scenes that would take too long to sort are ordered by a tree
//! of planes ([`bsp`]), and scenes with too many crossing faces even for that are refused.
//!
//! Good for: checking the order in which fills are painted; it keeps nothing but the order.
//!
//! Coherence: face coherence (a face is painted row by row, without looking at any other).

use glam::DVec3;
use thiserror::Error;

use super::raster::{Corners, PixelMap, Raster, RowStrip, columns};
use crate::camera::Camera;
use crate::engines::face::fragment::Easel;
use crate::engines::face::{bsp, depth_sort};
use crate::model::scene::Scene;

/// The faces of a scene pierce each other too often to be put in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "the faces pierce each other too often for the painter to find an order in reasonable time"
)]
pub struct NoOrder;

/// The picture whose items are in the paint order. O(triangles log triangles) usually; see
/// [`depth_sort`].
///
/// # Errors
/// [`NoOrder`].
pub fn raster(
    scene: &Scene,
    camera: &Camera,
    map: &PixelMap,
    size: (u32, u32),
) -> Result<Raster, NoOrder> {
    let fragments = match depth_sort::order(scene, camera) {
        Ok((fragments, _)) => fragments,
        Err(_) => bsp::BspTree::new(scene).map_err(|_| NoOrder)?.order(scene, camera),
    };
    let (easel, view) = (Easel::new(scene, camera), Corners::new(scene, camera));
    let mut triangles: Vec<([DVec3; 3], u32)> = Vec::with_capacity(fragments.len());
    for fragment in &fragments {
        let mut corners =
            fragment.corners().map(|corner| view.in_pixels(&easel.image(corner), map));
        let (Some(first), Some(mut last)) = (corners.next(), corners.next()) else { continue };
        for corner in corners {
            triangles.push(([first, last, corner], fragment.triangle()));
            last = corner;
        }
    }
    Ok(Raster::of_triangles(&triangles, size).seen_by(camera))
}

/// Fills the `items` of a strip of a picture that [`raster`] made. O(pixels that its triangles cover).
pub fn solve(raster: &Raster, strip: &RowStrip, items: &mut [u32]) {
    let width = raster.width();
    for &number in strip.triangles {
        let triangle = raster.triangle(number);
        let edges = triangle.edges();
        for row in triangle.rows(&strip.rows) {
            let start = (row - strip.rows.start) as usize * width as usize;
            let columns = columns(&edges, row, width);
            items[start + columns.start as usize..start + columns.end as usize].fill(number);
        }
    }
}
