//! Points seen from one place: signs and estimates of turns and depths by vertex number.

use super::pierced::{self, Homogeneous, PiercePoint};
use super::{Estimate, Sign, TRIPLE_PRODUCT_ERROR, exact};
use crate::camera::{Camera, Projection};
use dashu_int::IBig;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Where the sight lines come from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Viewpoint {
    /// All sight lines pass through the eye.
    Eye(DVec3),
    /// All sight lines run along this direction, away from the observer.
    Direction(DVec3),
}

/// Sizes of coordinates for which no triple product of differences under- or overflows: differences
/// are then no smaller than 2⁻³⁰⁵ or zero.
const FILTER_WINDOW: std::ops::RangeInclusive<f64> = 1e-76..=1e76;

/// Whether the bounds of the filters hold for a point.
pub(super) fn fits_filter(p: &DVec3) -> bool {
    let fits = |x: f64| x == 0.0 || FILTER_WINDOW.contains(&x.abs());
    fits(p.x) && fits(p.y) && fits(p.z)
}

/// The points of a scene as one camera sees them; answers every question of [`super`].
#[derive(Debug)]
pub struct Sight<'a> {
    positions: &'a [DVec3],
    /// The last of the points, where these are constructed.
    pierced: &'a [PiercePoint],
    n_vertices: usize,
    viewpoint: Viewpoint,
    forward: DVec3,
    near: f64,
    in_window: bool,
    size: f64,
    n_exact: AtomicU64,
}

/// A plane as an affine function of a point, with what is needed to bound its error.
///
/// The function is `normal · (x − base)` up to sign; `spread` holds the sums of the absolute
/// values of the terms of each component of `normal`.
#[derive(Debug, Clone, Copy)]
pub struct PlaneThrough {
    normal: DVec3,
    spread: DVec3,
    base: DVec3,
}

/// The points near a plane; see [`Sight::slab`].
#[derive(Debug, Clone, Copy)]
pub struct Slab {
    plane: PlaneThrough,
    limit: f64,
}

impl PlaneThrough {
    /// The plane through `base`, `base + a` and `base + b`; both vectors must be differences of two
    /// points, rounded once.
    #[inline]
    pub(super) fn new(a: DVec3, b: DVec3, base: DVec3) -> Self {
        let (a_size, b_size) = (a.abs(), b.abs());
        Self {
            normal: a.cross(b),
            spread: DVec3::new(
                a_size.y * b_size.z + a_size.z * b_size.y,
                a_size.z * b_size.x + a_size.x * b_size.z,
                a_size.x * b_size.y + a_size.y * b_size.x,
            ),
            base,
        }
    }

    /// More than the length of the true normal.
    #[inline]
    fn longest_normal(&self) -> f64 {
        let longest = self.normal.abs() + TRIPLE_PRODUCT_ERROR * self.spread;
        3.0 * longest.max_element()
    }

    #[inline]
    pub(super) fn negated_at(&self, x: DVec3) -> Estimate {
        let d = x - self.base;
        Estimate {
            value: -self.normal.dot(d),
            error: TRIPLE_PRODUCT_ERROR * self.spread.dot(d.abs()),
        }
    }

    /// The same for a constructed point: one rounding more, and what the point itself lacks.
    #[cold]
    fn negated_at_pierced(&self, x: &PiercePoint) -> Estimate {
        let (high, low) = (x.rounded() - self.base, x.rest());
        let sizes = high.abs() + low.abs();
        Estimate {
            value: -self.normal.dot(high + low),
            error: TRIPLE_PRODUCT_ERROR * self.spread.dot(sizes) + 2.0 * self.spread.dot(x.error()),
        }
    }
}

impl<'a> Sight<'a> {
    /// The points of `positions`, all finite, as `camera` sees them. O(points).
    pub fn new(positions: &'a [DVec3], camera: &Camera) -> Self {
        Self::with_pierced(positions, &[], camera)
    }

    /// The same where the last of the positions are those of constructed points, rounded.
    pub fn with_pierced(
        positions: &'a [DVec3],
        pierced: &'a [PiercePoint],
        camera: &Camera,
    ) -> Self {
        let n_vertices = positions.len() - pierced.len();
        let forward = camera.forward();
        let (viewpoint, near) = match camera.projection() {
            Projection::Perspective { near, .. } => (Viewpoint::Eye(camera.eye()), near),
            Projection::Orthographic => (Viewpoint::Direction(forward), 0.0),
        };
        let eye = camera.eye();
        let size_of = |p: &DVec3| (p - eye).abs().element_sum() + p.abs().element_sum();
        let both = |a: (bool, f64), b: (bool, f64)| (a.0 && b.0, a.1.max(b.1));
        let (vertices, constructed) = positions.split_at(n_vertices);
        let (fit, size) = vertices
            .par_iter()
            .with_min_len(1 << 14)
            .map(|p| (fits_filter(p), size_of(p)))
            .reduce(|| (true, 0.0), both);
        let size = constructed.iter().map(size_of).fold(size, f64::max);
        let in_window = fit && [forward, eye].iter().all(fits_filter);
        let n_exact = AtomicU64::new(0);
        Self { positions, pierced, n_vertices, viewpoint, forward, near, in_window, size, n_exact }
    }

    /// Whether all numbers are of sizes for which the bounds of the floating-point filters hold.
    pub fn has_filters(&self) -> bool {
        self.in_window
    }

    /// The largest number, in model units, that goes into the image of any point: distances from the
    /// eye and from the origin added up, component by component.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// The points.
    pub fn positions(&self) -> &'a [DVec3] {
        self.positions
    }

    /// Where the sight lines come from.
    pub fn viewpoint(&self) -> Viewpoint {
        self.viewpoint
    }

    /// How many questions the floating-point filter could not answer so far.
    pub fn n_exact(&self) -> u64 {
        self.n_exact.load(Relaxed)
    }

    #[inline]
    pub(super) fn count_exact(&self) {
        self.n_exact.fetch_add(1, Relaxed);
    }

    #[inline]
    fn position(&self, vertex: u32) -> DVec3 {
        self.positions[vertex as usize]
    }

    /// A constructed point, unless it is the very point that its position says.
    #[inline]
    fn pierced(&self, vertex: u32) -> Option<&'a PiercePoint> {
        if (vertex as usize) < self.n_vertices {
            return None;
        }
        self.pierced.get(vertex as usize - self.n_vertices).filter(|point| !point.is_exact())
    }

    /// Both points in homogeneous coordinates, when at least one is not what its position says.
    fn homogeneous(&self, points: [u32; 2]) -> Option<[Homogeneous; 2]> {
        let is_given = points.iter().all(|&x| self.pierced(x).is_none());
        (!is_given).then(|| {
            points.map(|x| match self.pierced(x) {
                Some(point) => point.homogeneous(),
                None => Homogeneous::from(self.position(x)),
            })
        })
    }

    /// Whether the edges of a constructed point show that it is on a line.
    #[inline]
    fn is_on_edge(&self, vertex: u32, p: u32, q: u32) -> bool {
        vertex as usize >= self.n_vertices
            && self.pierced[vertex as usize - self.n_vertices].is_on_edge(p, q)
    }

    /// Whether the edges of a constructed point show that it is in a triangle's plane.
    #[inline]
    fn is_in_plane(&self, vertex: u32, triangle: [u32; 3]) -> bool {
        vertex as usize >= self.n_vertices
            && self.pierced[vertex as usize - self.n_vertices].is_in_plane(triangle)
    }

    /// The value of a plane at a point, which may be a constructed one.
    #[inline]
    fn estimate_at(&self, plane: &PlaneThrough, x: u32) -> Estimate {
        match self.pierced(x) {
            None => plane.negated_at(self.position(x)),
            Some(point) => plane.negated_at_pierced(point),
        }
    }

    /// An estimate's sign, unless the numbers are outside the window in which its bound holds.
    #[inline]
    fn decided(&self, estimate: Estimate) -> Option<Sign> {
        if self.in_window { estimate.sign() } else { None }
    }

    /// An estimate and its sign, by the exact path when the bound does not decide.
    #[inline]
    fn settled(&self, estimate: Estimate, exact: impl FnOnce() -> [IBig; 2]) -> (Estimate, Sign) {
        match self.decided(estimate) {
            Some(sign) => (estimate, sign),
            None => {
                self.count_exact();
                let [value, _] = exact();
                undecided(estimate, exact::sign(&value))
            }
        }
    }

    /// The plane of sight through two vertices: its value at `x` is `turn(p, q, x)`.
    #[inline]
    pub fn sight_plane(&self, p: u32, q: u32) -> PlaneThrough {
        // The differences to a corner keep the error small where the points are near each other,
        // however far the eye is.
        let base = self.position(p);
        PlaneThrough::new(self.sight_line(p), self.position(q) - base, base)
    }

    /// The direction of sight through a vertex, away from the observer.
    #[inline]
    fn sight_line(&self, vertex: u32) -> DVec3 {
        match self.viewpoint {
            Viewpoint::Eye(eye) => self.position(vertex) - eye,
            Viewpoint::Direction(forward) => forward,
        }
    }

    /// The plane of a triangle: its value at `x` is `depth(p, q, r; x)`.
    #[inline]
    pub fn triangle_plane(&self, [p, q, r]: [u32; 3]) -> PlaneThrough {
        let base = self.position(p);
        PlaneThrough::new(self.position(q) - base, self.position(r) - base, base)
    }

    /// `turn(p, q, x)` and its sign, for the plane of sight through `p` and `q`.
    ///
    /// The estimate has the sign that is returned.
    #[inline]
    pub fn turn_at(&self, plane: &PlaneThrough, p: u32, q: u32, x: u32) -> (Estimate, Sign) {
        if x == p || x == q || self.is_on_edge(x, p, q) {
            return (Estimate::ZERO, Sign::Zero);
        }
        let estimate = self.estimate_at(plane, x);
        self.settled(estimate, || self.exact_turns(p, q, [x, x]))
    }

    /// `depth(p, q, r; x)` and its sign, for the plane of the triangle.
    ///
    /// The estimate has the sign that is returned.
    #[inline]
    pub fn depth_at(&self, plane: &PlaneThrough, triangle: [u32; 3], x: u32) -> (Estimate, Sign) {
        if triangle.contains(&x) || self.is_in_plane(x, triangle) {
            return (Estimate::ZERO, Sign::Zero);
        }
        let estimate = self.estimate_at(plane, x);
        self.settled(estimate, || self.exact_depths(triangle, [x, x]))
    }

    /// The sign of `turn(a, b, c)`; of constructed points only `a` and `b` may be: positive when the image of the path turns counter-clockwise.
    #[inline]
    pub fn turn(&self, a: u32, b: u32, c: u32) -> Sign {
        if let Some([a, b]) = self.homogeneous([a, b]) {
            // The estimates are for planes through vertices.
            self.count_exact();
            return pierced::turn(self.viewpoint, [&a, &b], self.position(c));
        }
        self.turn_at(&self.sight_plane(a, b), a, b, c).1
    }

    /// The sign of `depth(p, q, r; x)`.
    #[inline]
    pub fn depth(&self, triangle: [u32; 3], x: u32) -> Sign {
        self.depth_at(&self.triangle_plane(triangle), triangle, x).1
    }

    /// Which way a polygon faces: the sign of its Newell normal times the direction to the eye.
    ///
    /// Positive is front, negative back, zero edge-on. Newell's sum equals the sum over a fan of
    /// triangles, which is what is evaluated here. O(corners).
    pub fn facing(&self, polygon: &[u32]) -> Sign {
        let &[first, ref rest @ ..] = polygon else {
            return Sign::Zero;
        };
        if let &[second, third] = rest {
            return self.turn(first, second, third);
        }
        let mut sum = Estimate::ZERO;
        for pair in rest.windows(2) {
            let plane = self.sight_plane(first, pair[0]);
            let term = plane.negated_at(self.position(pair[1]));
            sum.value += term.value;
            sum.error += term.error + sum.value.abs() * f64::EPSILON;
        }
        if let Some(sign) = self.decided(sum) {
            return sign;
        }
        self.count_exact();
        let viewpoint = match self.viewpoint {
            Viewpoint::Eye(eye) => exact::Towards::Point(eye),
            Viewpoint::Direction(forward) => exact::Towards::Along(forward),
        };
        exact::facing(polygon.iter().map(|&v| self.position(v)), viewpoint)
    }

    /// Whether the images of two points are the same, where one of them at least is constructed.
    fn same_image_of_constructed(&self, ends: [u32; 2]) -> bool {
        let known = ends.map(|x| match self.pierced(x) {
            None => (self.position(x), DVec3::ZERO, DVec3::ZERO),
            Some(point) => (point.rounded(), point.rest(), point.error()),
        });
        let [(a, rest_a, error_a), (b, rest_b, error_b)] = known;
        let (sight, sight_error) = match self.viewpoint {
            Viewpoint::Eye(eye) => (a - eye + rest_a, error_a),
            Viewpoint::Direction(forward) => (forward, DVec3::ZERO),
        };
        let (along, along_error) = (b - a + (rest_b - rest_a), error_a + error_b);
        let spread = |u: DVec3, v: DVec3| PlaneThrough::new(u.abs(), v.abs(), DVec3::ZERO).spread;
        let error = 2.0 * TRIPLE_PRODUCT_ERROR * spread(sight, along)
            + 2.0 * (spread(sight_error, along) + spread(sight.abs() + sight_error, along_error));
        if self.in_window && sight.cross(along).abs().cmpgt(error).any() {
            return false;
        }
        self.count_exact();
        let points = ends.map(|x| match self.pierced(x) {
            Some(point) => point.homogeneous(),
            None => Homogeneous::from(self.position(x)),
        });
        pierced::same_image(self.viewpoint, [&points[0], &points[1]])
    }

    /// Whether the images of two points are the same.
    pub fn same_image(&self, a: u32, b: u32) -> bool {
        if [a, b].iter().any(|&x| self.pierced(x).is_some()) {
            return self.same_image_of_constructed([a, b]);
        }
        let plane = self.sight_plane(a, b);
        let differs = plane.normal.abs().cmpgt(TRIPLE_PRODUCT_ERROR * plane.spread).any();
        if self.in_window && differs {
            return false;
        }
        self.count_exact();
        match self.viewpoint {
            Viewpoint::Eye(eye) => exact::collinear(eye, self.position(a), self.position(b)),
            Viewpoint::Direction(forward) => {
                exact::parallel(self.position(a), self.position(b), forward)
            }
        }
    }

    /// Whether there is a near plane, which only perspective has.
    pub fn has_near_plane(&self) -> bool {
        matches!(self.viewpoint, Viewpoint::Eye(_))
    }

    /// `(x − eye)·forward − near · forward·forward` and its sign: zero or positive is kept.
    ///
    /// Without a near plane every point is kept. The estimate has the sign that is returned.
    #[inline]
    pub fn near_distance(&self, x: u32) -> (Estimate, Sign) {
        let Viewpoint::Eye(eye) = self.viewpoint else {
            return (Estimate { value: 1.0, error: 0.0 }, Sign::Positive);
        };
        let d = self.position(x) - eye;
        let limit = self.near * self.forward.length_squared();
        let size = self.forward.abs();
        let mut estimate = Estimate {
            value: d.dot(self.forward) - limit,
            error: TRIPLE_PRODUCT_ERROR * (d.abs().dot(size) + limit),
        };
        if let Some(point) = self.pierced(x) {
            // The rest is left out, and counts as error.
            estimate.error += 2.0 * size.dot(point.rest().abs() + point.error());
        }
        self.settled(estimate, || self.exact_near_distances([x, x]))
    }

    /// The plane of sight through the near plane's cut of `triangle`, at both of `ends`.
    ///
    /// Multiplied by the opposite of the triangle's turn, it is positive on the kept side.
    pub fn near_cut(&self, triangle: [u32; 3], ends: [u32; 2]) -> [Sign; 2] {
        self.count_exact();
        self.exact_near_cut_values(triangle, ends).map(|value| exact::sign(&value))
    }

    /// Whether both ends of a segment lie within `distance` of a triangle's plane.
    ///
    /// The triangle must have an area. Decided exactly for the number `distance`.
    pub fn in_contact(&self, triangle: [u32; 3], ends: [u32; 2], distance: f64) -> bool {
        let plane = self.triangle_plane(triangle);
        let limit = distance * plane.normal.length();
        ends.iter().all(|&x| {
            let (depth, _) = self.depth_at(&plane, triangle, x);
            // The limit is rounded, and the normal it stems from has the error of its spread.
            let slack =
                depth.error + (limit + distance * plane.spread.length()) * TRIPLE_PRODUCT_ERROR;
            let beyond = depth.value.abs() - limit;
            if self.in_window && beyond.abs() > slack {
                beyond < 0.0
            } else {
                self.count_exact();
                let corners = triangle.map(|v| self.position(v));
                match self.pierced(x) {
                    None => exact::within_distance(corners, self.position(x), distance),
                    Some(x) => pierced::within_distance(corners, &x.homogeneous(), distance),
                }
            }
        })
    }

    /// Whether a point with this value may lie within `distance` of a plane; in doubt, yes.
    #[inline]
    pub fn may_be_within(&self, plane: &PlaneThrough, value: &Estimate, distance: f64) -> bool {
        let beyond = value.value.abs() - value.error - distance * plane.longest_normal();
        !self.in_window || beyond <= 0.0 || beyond.is_nan()
    }

    /// On which side of a triangle's plane a vertex lies, when it is certainly further than the
    /// distance that went into `slab` from it; `None` in doubt.
    #[inline]
    pub fn side_of_slab(&self, slab: &Slab, vertex: u32) -> Option<Sign> {
        let Estimate { value, error } = slab.plane.negated_at(self.position(vertex));
        let beyond = value.abs() - error - slab.limit;
        (self.in_window && beyond > 0.0).then(|| Sign::of(value))
    }

    /// All points within `distance` of the plane of a triangle, and a few more.
    #[inline]
    pub fn slab(&self, triangle: [u32; 3], distance: f64) -> Slab {
        let plane = self.triangle_plane(triangle);
        Slab { plane, limit: distance * plane.longest_normal() }
    }

    /// How far behind a triangle a point within `distance` of its plane may be, at most, in lengths
    /// of the sight line through it: of the eye's distance in perspective, of the direction of view
    /// in orthographic projection. Infinite when nothing is certain.
    pub fn contact_reach(&self, triangle: [u32; 3], distance: f64) -> f64 {
        // A sight line comes nearer to the plane by the eye's height over it.
        let plane = self.triangle_plane(triangle);
        let sight = self.sight_line(triangle[0]);
        let height =
            plane.normal.dot(sight).abs() - TRIPLE_PRODUCT_ERROR * plane.spread.dot(sight.abs());
        // Twice as far covers all roundings.
        let reach = 2.0 * distance * plane.longest_normal() / height;
        if self.in_window && height > 0.0 && reach.is_finite() { reach } else { f64::INFINITY }
    }

    pub(super) fn exact_turns(&self, p: u32, q: u32, x: [u32; 2]) -> [IBig; 2] {
        let [p, q] = [p, q].map(|v| self.position(v));
        let volumes = match (self.homogeneous(x), self.viewpoint) {
            (None, Viewpoint::Eye(eye)) => exact::point_volumes(eye, p, q, self.both(x)),
            (None, Viewpoint::Direction(forward)) => {
                exact::direction_volumes(forward, p, q, self.both(x))
            }
            (Some([a, b]), Viewpoint::Eye(eye)) => pierced::point_volumes([eye, p, q], [&a, &b]),
            (Some([a, b]), Viewpoint::Direction(forward)) => {
                pierced::direction_volumes(forward, [p, q], [&a, &b])
            }
        };
        volumes.map(|volume| -volume)
    }

    pub(super) fn exact_depths(&self, triangle: [u32; 3], x: [u32; 2]) -> [IBig; 2] {
        let [p, q, r] = triangle.map(|v| self.position(v));
        match self.homogeneous(x) {
            None => exact::point_volumes(p, q, r, self.both(x)),
            Some([a, b]) => pierced::point_volumes([p, q, r], [&a, &b]),
        }
        .map(|volume| -volume)
    }

    pub(super) fn exact_near_distances(&self, x: [u32; 2]) -> [IBig; 2] {
        let Viewpoint::Eye(eye) = self.viewpoint else {
            return [IBig::ONE, IBig::ONE];
        };
        match self.homogeneous(x) {
            None => exact::near_distances(eye, self.forward, self.near, self.both(x)),
            Some([a, b]) => pierced::near_distances(eye, self.forward, self.near, [&a, &b]),
        }
    }

    pub(super) fn exact_near_cut_values(&self, triangle: [u32; 3], x: [u32; 2]) -> [IBig; 2] {
        let Viewpoint::Eye(eye) = self.viewpoint else {
            return [IBig::ONE, IBig::ONE];
        };
        let corners = triangle.map(|v| self.position(v));
        let (forward, near) = (self.forward, self.near);
        match self.homogeneous(x) {
            None => exact::near_cut_values(eye, forward, near, corners, self.both(x)),
            Some([a, b]) => pierced::near_cut_values(eye, forward, near, corners, [&a, &b]),
        }
    }

    fn both(&self, points: [u32; 2]) -> [DVec3; 2] {
        points.map(|x| self.position(x))
    }
}

/// Makes an estimate agree with the sign that the exact path found.
///
/// Its bound stays, so that constructions know how little the value is worth.
fn undecided(estimate: Estimate, sign: Sign) -> (Estimate, Sign) {
    let size = estimate.value.abs().max(f64::MIN_POSITIVE);
    let estimate = match sign {
        Sign::Negative => Estimate { value: -size, ..estimate },
        Sign::Zero => Estimate::ZERO,
        Sign::Positive => Estimate { value: size, ..estimate },
    };
    (estimate, sign)
}
