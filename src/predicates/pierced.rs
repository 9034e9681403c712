//! Constructed points: where an edge meets a plane, that of a triangle or one given by numbers.
//!
//! Such a point is a ratio of polynomials in the input. It is kept as a pair of `f64` for the
//! filters, with a bound of what is missing, and in integers for the exact path, so that decisions
//! about it are as exact as about any vertex. M. Attene, "Indirect predicates for geometric
//! constructions", Computer-Aided Design 126 (2020), calls it an LPI (line-plane intersection);
//! here its coordinates are evaluated once instead of in each predicate, since there are few of
//! them and each is asked about often. Points of hatch lines are many, and rarely need them: they
//! keep what defines them instead.
//!
//! ```text
//!             q ●
//!       ╲      ╱   ╲           P = (dp q − dq p) / (dp − dq), with dp and dq the signed volumes
//!        ╲    ●P    ╲          of p and q over the triangle; they have opposite signs
//!         ╲  ┆       ╲
//!          ●╱─────────●
//!        p ●
//! ```

use super::FreePlane;
use super::exact::{self, Dyadic};
use dashu_int::IBig;
use glam::DVec3;
use std::cmp::Ordering;

/// What is missing in the pair of `f64` of a coordinate, as a part of the coordinate: each of the
/// two ratios is rounded by less than four units in the last place.
const PAIR_ERROR: f64 = 1.0 / (1u128 << 98) as f64;

/// A point in homogeneous coordinates: `x / w`, where `w` is positive.
#[derive(Debug, Clone, PartialEq)]
pub struct Homogeneous {
    /// The coordinates, times `w`.
    pub x: [Dyadic; 3],
    /// The divisor, positive.
    pub w: Dyadic,
}

impl From<DVec3> for Homogeneous {
    fn from(point: DVec3) -> Self {
        Self { x: exact::dyadic(point), w: Dyadic::from(1.0) }
    }
}

impl Homogeneous {
    /// Where the edge from `p` to `q` meets the plane of a triangle. The edge's ends must lie
    /// strictly on opposite sides of it.
    fn pierced([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> Self {
        let [of_p, of_q] = exact::point_volumes(a, b, c, [p, q]);
        let w = &of_p - &of_q;
        let is_negative = exact::sign(&w) == super::Sign::Negative;
        let turned = |x: IBig| Dyadic::from(if is_negative { -x } else { x });
        let (of_p, of_q, w) = (turned(of_p), turned(of_q), turned(w));
        let (p, q) = (exact::dyadic(p), exact::dyadic(q));
        let x = std::array::from_fn(|i| q[i].clone() * of_p.clone() - p[i].clone() * of_q.clone());
        Self { x, w }
    }

    /// Where the edge from `p` to `q`, whose ends lie strictly on opposite sides, meets a plane.
    fn on_plane(ends: [DVec3; 2], plane: &FreePlane) -> Self {
        let [p, q] = ends.map(Self::from);
        let (of_p, of_q) = (plane.exact_value(&p), plane.exact_value(&q));
        let w = of_p.clone() - of_q.clone();
        let (of_p, of_q, w) = match w.sign() {
            super::Sign::Negative => (-of_p, -of_q, -w),
            _ => (of_p, of_q, w),
        };
        let x =
            std::array::from_fn(|i| q.x[i].clone() * of_p.clone() - p.x[i].clone() * of_q.clone());
        Self { x, w }
    }
}

/// Where an edge meets a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct PiercePoint {
    edge: [u32; 2],
    triangle: [u32; 3],
    other_edge: Option<[u32; 2]>,
    high: DVec3,
    low: DVec3,
    error: DVec3,
    exact: Truth,
}

/// Where the exact coordinates of a constructed point are.
#[derive(Debug, Clone, PartialEq)]
enum Truth {
    /// The rounded point is the very point.
    Rounded,
    /// Here.
    Known(Homogeneous),
    /// They are computed when requested, which is rare: where an edge, by its ends, meets a plane.
    OnPlane([DVec3; 2], FreePlane),
}

/// Rounded points on planes are taken as they are up to this error, as a part of their largest
/// coordinate; above it they are computed from integers. It bounds a construction, not a decision.
const POINT_ERROR: f64 = 8.0 * f64::EPSILON;

impl PiercePoint {
    /// Where `edge` meets the plane of `triangle`, by vertex numbers in `positions`.
    ///
    /// The ends of the edge must lie strictly on opposite sides of the plane. `other_edge` is an
    /// edge of the triangle, or of others in its plane, that runs through the same point.
    pub fn new(
        positions: &[DVec3],
        edge: [u32; 2],
        triangle: [u32; 3],
        other_edge: Option<[u32; 2]>,
    ) -> Self {
        let at = |v: u32| positions[v as usize];
        let exact = Homogeneous::pierced(edge.map(at), triangle.map(at));
        Self { edge, triangle, other_edge, ..Self::rounding(exact) }
    }

    /// A point by its coordinates, all finite.
    pub fn at(point: DVec3) -> Self {
        let x = super::exact::dyadic(point);
        Self::rounding(Homogeneous { x, w: Dyadic::from(1.0) })
    }

    /// A point on no edge and in no plane, as far as numbers of vertices tell.
    pub(super) fn rounding(exact: Homogeneous) -> Self {
        let high = DVec3::from_array(std::array::from_fn(|i| ratio(&exact.x[i], &exact.w)));
        let rest: [Dyadic; 3] =
            std::array::from_fn(|i| exact.x[i].clone() - exact.w.clone() * Dyadic::from(high[i]));
        let low = DVec3::from_array(std::array::from_fn(|i| ratio(&rest[i], &exact.w)));
        let is_exact = rest.iter().all(|x| x.sign() == super::Sign::Zero);
        Self {
            edge: [u32::MAX; 2],
            triangle: [u32::MAX; 3],
            other_edge: None,
            // Adding zero turns −0 into 0.
            high: high + DVec3::ZERO,
            low,
            error: if is_exact {
                DVec3::ZERO
            } else if super::sight::fits_filter(&high) {
                high.abs() * PAIR_ERROR
            } else {
                // Products with such numbers may vanish: nothing is known without the exact path.
                DVec3::INFINITY
            },
            exact: if is_exact { Truth::Rounded } else { Truth::Known(exact) },
        }
    }

    /// A point that is known to be on an edge, by vertex numbers.
    pub(super) fn rounding_on(edge: [u32; 2], exact: Homogeneous) -> Self {
        Self { edge, ..Self::rounding(exact) }
    }

    /// Where `edge`, by vertex numbers in `positions`, meets a plane given by numbers. Its ends must
    /// lie strictly on opposite sides, or one of them on the plane.
    pub fn on_plane(positions: &[DVec3], edge: [u32; 2], plane: FreePlane) -> Self {
        let ends = edge.map(|v| positions[v as usize]);
        let at = ends.map(|end| plane.value(end));
        // From the nearer end, where the part of the way is smaller.
        let (near, far) = if at[0].value.abs() <= at[1].value.abs() { (0, 1) } else { (1, 0) };
        let difference = at[near].value - at[far].value;
        let t = at[near].value / difference;
        // As for `Sight::cut`; twice that, below, also covers the roundings of the point.
        let error_of_t = (at[far].value.abs() * at[near].error
            + at[near].value.abs() * at[far].error)
            / (difference * difference)
            + 1.5 * f64::EPSILON * t;
        let step = ends[far] - ends[near];
        let point = ends[near] + step * t;
        let error = step.abs() * (2.0 * error_of_t) + point.abs() * f64::EPSILON;
        let size = ends[0].abs().max(ends[1].abs()).max_element();
        if error.max_element() <= POINT_ERROR * size && ends.iter().all(super::sight::fits_filter) {
            let triangle = [u32::MAX; 3];
            let (high, low) = (point + DVec3::ZERO, DVec3::ZERO);
            let exact = Truth::OnPlane(ends, plane);
            return Self { edge, triangle, other_edge: None, high, low, error, exact };
        }
        Self::rounding_on(edge, Homogeneous::on_plane(ends, &plane))
    }

    /// The point, rounded: within four units in the last place of each coordinate.
    pub fn rounded(&self) -> DVec3 {
        self.high
    }

    /// What the rounded point lacks, itself rounded.
    pub fn rest(&self) -> DVec3 {
        self.low
    }

    /// How far the rounded point and its rest together may be off in each coordinate.
    pub(super) fn error(&self) -> DVec3 {
        self.error
    }

    /// Whether the rounded point is the very point.
    pub fn is_exact(&self) -> bool {
        self.exact == Truth::Rounded
    }

    /// Whether the point lies on the line through two vertices, by the numbers of those alone.
    pub(super) fn is_on_edge(&self, p: u32, q: u32) -> bool {
        let same = |edge: [u32; 2]| edge == [p, q] || edge == [q, p];
        same(self.edge) || self.other_edge.is_some_and(same)
    }

    /// Whether the point lies in the plane of a triangle, by the numbers of its corners alone.
    pub(super) fn is_in_plane(&self, corners: [u32; 3]) -> bool {
        let within = |edge: [u32; 2]| edge.iter().all(|end| corners.contains(end));
        within(self.edge)
            || self.other_edge.is_some_and(within)
            || self.triangle.iter().all(|corner| corners.contains(corner))
    }

    /// The point in homogeneous coordinates.
    pub fn homogeneous(&self) -> Homogeneous {
        match &self.exact {
            Truth::Rounded => Homogeneous::from(self.high),
            Truth::Known(exact) => exact.clone(),
            Truth::OnPlane(ends, plane) => Homogeneous::on_plane(*ends, plane),
        }
    }

    /// The order by x, then y, then z, exactly. On any one line it is the order along the line.
    pub fn order(&self, other: &Self) -> Ordering {
        for i in 0..3 {
            let difference = (self.high[i] - other.high[i]) + (self.low[i] - other.low[i]);
            // Four roundings of numbers no larger than these.
            let sizes =
                (self.high[i] - other.high[i]).abs() + self.low[i].abs() + other.low[i].abs();
            let error = 8.0 * f64::EPSILON * sizes + 2.0 * (self.error[i] + other.error[i]);
            if difference.abs() > error {
                return difference.total_cmp(&0.0);
            }
            if self.is_exact() && other.is_exact() {
                // Both rests are zero, so the difference has the right sign.
                match self.high[i].total_cmp(&other.high[i]) {
                    Ordering::Equal => continue,
                    order => return order,
                }
            }
            let (a, b) = (self.homogeneous(), other.homogeneous());
            let sign = (a.x[i].clone() * b.w - b.x[i].clone() * a.w).sign();
            match sign {
                super::Sign::Negative => return Ordering::Less,
                super::Sign::Zero => {}
                super::Sign::Positive => return Ordering::Greater,
            }
        }
        Ordering::Equal
    }

    /// A vertex as such a point, so that both kinds can be ordered.
    pub fn vertex(position: DVec3) -> Self {
        Self {
            edge: [u32::MAX; 2],
            triangle: [u32::MAX; 3],
            other_edge: None,
            high: position,
            low: DVec3::ZERO,
            error: DVec3::ZERO,
            exact: Truth::Rounded,
        }
    }
}

/// `a / b` rounded to within four units in the last place; `b` must not be zero.
pub(super) fn ratio(a: &Dyadic, b: &Dyadic) -> f64 {
    let [a, b] = exact::same_scale([a.clone(), b.clone()]);
    exact::ratio(&a, &b)
}

/// The values of an affine function at two points, up to one positive factor: `f` gets the
/// homogeneous coordinates of each and returns its value times `w`.
fn values(points: [&Homogeneous; 2], f: impl Fn(&Homogeneous) -> Dyadic) -> [IBig; 2] {
    let [a, b] = points.map(f);
    let [of_a, of_b] = points.map(|point| point.w.clone());
    exact::same_scale([a * of_b, b * of_a])
}

/// `x − base`, times the `w` of `x`.
fn from_base(x: &Homogeneous, base: &[Dyadic; 3]) -> [Dyadic; 3] {
    std::array::from_fn(|i| x.x[i].clone() - x.w.clone() * base[i].clone())
}

/// As [`exact::point_volumes`].
pub(super) fn point_volumes(triangle: [DVec3; 3], x: [&Homogeneous; 2]) -> [IBig; 2] {
    let [a, b, c] = triangle.map(exact::dyadic);
    let normal = exact::cross(&exact::minus(&b, &a), &exact::minus(&c, &a));
    values(x, |x| exact::dot(&normal, &from_base(x, &a)))
}

/// As [`exact::direction_volumes`].
pub(super) fn direction_volumes(
    direction: DVec3,
    [a, b]: [DVec3; 2],
    x: [&Homogeneous; 2],
) -> [IBig; 2] {
    let [direction, a, b] = [direction, a, b].map(exact::dyadic);
    let normal = exact::cross(&direction, &exact::minus(&b, &a));
    values(x, |x| exact::dot(&normal, &from_base(x, &a)))
}

/// As [`exact::near_distances`].
pub(super) fn near_distances(
    eye: DVec3,
    forward: DVec3,
    near: f64,
    x: [&Homogeneous; 2],
) -> [IBig; 2] {
    let (eye, forward) = (exact::dyadic(eye), exact::dyadic(forward));
    let limit = Dyadic::from(near) * exact::dot(&forward, &forward);
    values(x, |x| exact::dot(&from_base(x, &eye), &forward) - limit.clone() * x.w.clone())
}

/// As [`exact::near_cut_values`].
pub(super) fn near_cut_values(
    eye: DVec3,
    forward: DVec3,
    near: f64,
    triangle: [DVec3; 3],
    x: [&Homogeneous; 2],
) -> [IBig; 2] {
    let (eye, forward) = (exact::dyadic(eye), exact::dyadic(forward));
    let [p, q, r] = triangle.map(exact::dyadic);
    let normal = exact::cross(&exact::minus(&q, &p), &exact::minus(&r, &p));
    let height = exact::dot(&normal, &exact::minus(&p, &eye));
    let limit = Dyadic::from(near) * exact::dot(&forward, &forward);
    values(x, |x| {
        let d = from_base(x, &eye);
        height.clone() * exact::dot(&d, &forward) - limit.clone() * exact::dot(&normal, &d)
    })
}

/// As [`exact::within_distance`].
pub(super) fn within_distance(triangle: [DVec3; 3], x: &Homogeneous, distance: f64) -> bool {
    let [p, q, r] = triangle.map(exact::dyadic);
    let normal = exact::cross(&exact::minus(&q, &p), &exact::minus(&r, &p));
    let height = exact::dot(&normal, &from_base(x, &p));
    let distance = Dyadic::from(distance) * x.w.clone();
    let left = height.clone() * height;
    let right = distance.clone() * distance * exact::dot(&normal, &normal);
    (left - right).sign() != super::Sign::Positive
}

/// `turn(a, b, x)` for two constructed points and a vertex `x`, up to a positive factor.
///
/// With `x` as the base, perspective has `det(a − eye, b − eye, x − eye)` and orthographic
/// projection `det(forward, a − x, b − x)`, each with a minus in front.
pub(super) fn turn(
    viewpoint: super::Viewpoint,
    [a, b]: [&Homogeneous; 2],
    x: DVec3,
) -> super::Sign {
    let x = exact::dyadic(x);
    let volume = match viewpoint {
        super::Viewpoint::Eye(eye) => {
            let eye = exact::dyadic(eye);
            let normal = exact::cross(&from_base(a, &eye), &from_base(b, &eye));
            exact::dot(&normal, &exact::minus(&x, &eye))
        }
        super::Viewpoint::Direction(forward) => {
            let normal = exact::cross(&from_base(a, &x), &from_base(b, &x));
            exact::dot(&normal, &exact::dyadic(forward))
        }
    };
    volume.sign().flipped()
}

/// Whether two points have one image.
pub(super) fn same_image(viewpoint: super::Viewpoint, [a, b]: [&Homogeneous; 2]) -> bool {
    let product = match viewpoint {
        super::Viewpoint::Eye(eye) => {
            let eye = exact::dyadic(eye);
            exact::cross(&from_base(a, &eye), &from_base(b, &eye))
        }
        super::Viewpoint::Direction(forward) => {
            // b/w − a/v, times both.
            let difference: [Dyadic; 3] = std::array::from_fn(|i| {
                b.x[i].clone() * a.w.clone() - a.x[i].clone() * b.w.clone()
            });
            exact::cross(&difference, &exact::dyadic(forward))
        }
    };
    product.iter().all(|x| x.sign() == super::Sign::Zero)
}
