//! Which side of a triangle's plane a point lies on, independent of the view.

use super::sight::{PlaneThrough, fits_filter};
use super::{Sign, TRIPLE_PRODUCT_ERROR, exact};
use glam::DVec3;
use rayon::prelude::*;

/// Sizes of coordinates for which `robust::orient3d` is exact: its products of three and their
/// rounding errors neither overflow nor vanish.
const ROBUST_WINDOW: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// Points in space; answers questions that do not depend on an eye.
#[derive(Debug, Clone, Copy)]
pub struct Solid<'a> {
    positions: &'a [DVec3],
    in_window: bool,
    is_robust: bool,
    /// No difference of coordinates is larger; infinite when bounds of errors do not hold.
    reach: f64,
}

/// A plane with one bound of the error for all points of a scene.
#[derive(Debug, Clone, Copy)]
pub struct QuickPlane {
    normal: DVec3,
    base: DVec3,
    error: f64,
}

impl<'a> Solid<'a> {
    /// The points of `positions`, all finite. O(points).
    pub fn new(positions: &'a [DVec3]) -> Self {
        let robust = |x: f64| x == 0.0 || ROBUST_WINDOW.contains(&x.abs());
        let positions_par = || positions.par_iter().with_min_len(1 << 14);
        let in_window = positions_par().all(fits_filter);
        let largest = positions_par().map(|p| p.abs().max_element()).reduce(|| 0.0, f64::max);
        Self {
            positions,
            in_window,
            reach: if in_window { 2.0 * largest } else { f64::INFINITY },
            is_robust: positions_par().all(|p| robust(p.x) && robust(p.y) && robust(p.z)),
        }
    }

    /// The points.
    pub fn positions(&self) -> &'a [DVec3] {
        self.positions
    }

    #[inline]
    fn position(&self, vertex: u32) -> DVec3 {
        self.positions[vertex as usize]
    }

    /// The plane of a triangle, for [`side`](Self::side).
    #[inline]
    pub fn plane(&self, triangle: [u32; 3]) -> PlaneThrough {
        let [p, q, r] = triangle.map(|corner| self.position(corner));
        PlaneThrough::new(q - p, r - p, p)
    }

    /// A plane through three points for [`certain_side`](Self::certain_side).
    #[inline(always)]
    pub fn quick_plane(&self, base: DVec3, q: DVec3, r: DVec3) -> QuickPlane {
        let (a, b) = (q - base, r - base);
        let (a_size, b_size) = (a.abs().max_element(), b.abs().max_element());
        // The terms of a component of the normal are at most twice the product of these sizes, and
        // there are three components; the rest covers the rounding of the bound.
        let error = TRIPLE_PRODUCT_ERROR * 8.0 * a_size * b_size * self.reach;
        QuickPlane { normal: a.cross(b), base, error }
    }

    /// The side of a point when floating point is certain of it: 1, −1, or 0 for unknown.
    ///
    /// One bound serves for all points of the scene, which is enough to recognize most that are not
    /// nearly in the plane.
    #[inline(always)]
    pub fn certain_side(&self, plane: &QuickPlane, point: DVec3) -> i32 {
        let value = plane.normal.dot(point - plane.base);
        i32::from(value < -plane.error) - i32::from(value > plane.error)
    }

    /// The side of `x`: the sign of `−(q − p) × (r − p) · (x − p)`, with the plane of the triangle.
    #[inline]
    pub fn side(&self, plane: &PlaneThrough, triangle: [u32; 3], x: u32) -> Sign {
        let estimate = plane.negated_at(self.position(x));
        match estimate.sign() {
            Some(sign) if self.in_window => sign,
            _ => self.exact_side(triangle, x),
        }
    }

    /// The side of `x`, without a prepared plane.
    pub fn side_of(&self, triangle: [u32; 3], x: u32) -> Sign {
        self.side(&self.plane(triangle), triangle, x)
    }

    /// Whether the volume that the triangles of a closed surface enclose is certainly positive, which
    /// it is when they are wound counter-clockwise as seen from outside.
    ///
    /// A volume that is small for the size of the surface is not certain. O(triangles).
    pub fn is_outward(&self, triangles: impl Iterator<Item = [u32; 3]>) -> bool {
        let (mut volume, mut size, mut n) = (0.0, 0.0, 0.0);
        let mut base = None;
        for triangle in triangles {
            let [p, q, r] = triangle.map(|corner| self.position(corner));
            let base = *base.get_or_insert(p);
            let plane = PlaneThrough::new(q - base, r - base, base);
            let estimate = plane.negated_at(p);
            volume -= estimate.value;
            size += estimate.error / TRIPLE_PRODUCT_ERROR;
            n += 1.0;
        }
        // Each term is off by its own error, and each sum of n terms by n roundings of the sizes.
        self.in_window && volume > (2.0 * TRIPLE_PRODUCT_ERROR + n * f64::EPSILON) * size
    }

    #[cold]
    fn exact_side(&self, triangle: [u32; 3], x: u32) -> Sign {
        let [p, q, r] = triangle.map(|v| self.position(v));
        let x = self.position(x);
        if self.is_robust {
            let [p, q, r, x] = [p, q, r, x].map(|p| robust::Coord3D { x: p.x, y: p.y, z: p.z });
            return Sign::of(robust::orient3d(p, q, r, x));
        }
        let [volume, _] = exact::point_volumes(p, q, r, [x, x]);
        exact::sign(&volume).flipped()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn filter_robust_and_integers_agree_on_the_side() {
        let near = |i: u32| f64::from(i % 3) * f64::EPSILON;
        for i in 0..27 {
            let x = dvec3(0.3 + near(i), 0.3 + near(i / 3), 0.4 + near(i / 9));
            let points = [DVec3::X, DVec3::Y, DVec3::Z, x];
            let solid = Solid::new(&points);
            let triangle = [0, 1, 2];
            let [volume, _] = exact::point_volumes(points[0], points[1], points[2], [x, x]);
            let truth = exact::sign(&volume).flipped();
            assert_eq!(solid.side_of(triangle, 3), truth, "{x}");
            assert_eq!(solid.exact_side(triangle, 3), truth, "{x}");
            let without = Solid { is_robust: false, ..solid };
            assert_eq!(without.exact_side(triangle, 3), truth, "{x}");
        }
    }
}
