//! Exact decisions in the plane of horizons.
//!
//! A point of the surface seen from the eye is a homogeneous triple `h = (hu, hw, hv)`: in the plane of
//! horizons it is at `u = hu/hw`, to the right, and `v = hv/hw`, upward. In perspective,
//! with `d = P − eye` reflected so that the part's `dx, dy ≥ 0`, `h = (dx − dy, dx + dy, dz)`. In
//! orthographic projection, with `d = P − c` for a fixed `c` and `m` the plan direction of view,
//! `h = (my dx − mx dy, 1, dz m·m − fz (m·d))`. Both maps take straight lines to straight lines and
//! verticals to verticals, and both are polynomials in the input, so each decision below is the
//! sign of a polynomial. Floating point is tried first (see [`super::horizon`]); what it cannot decide is
//! decided here, with all numbers scaled to integers and nothing rounded.

use std::cmp::Ordering;

use dashu_int::ops::BitTest;
use dashu_int::{IBig, Sign};
use glam::DVec3;

use crate::camera::{Camera, Projection};

/// How points are seen from one part of the domain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlanSight {
    /// The eye, or in orthographic projection any fixed point near the surface.
    pub(super) center: DVec3,
    /// Signs that turn the part toward +x and +y.
    pub(super) sx: f64,
    /// See `sx`.
    pub(super) sy: f64,
    /// Orthographic: the direction of view, reflected, so that its x and y are not negative.
    pub(super) forward: Option<DVec3>,
}

/// A place along u at which two lines are compared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum PlaceOnU {
    /// The u of a sample.
    Vertex(DVec3),
    /// A given u.
    Border(f64),
}

impl PlanSight {
    /// The sight of the part in which `sx·(x − center.x)` and `sy·(y − center.y)` are positive, or
    /// in orthographic projection of the whole domain.
    pub(super) fn new(camera: &Camera, sx: f64, sy: f64, center: DVec3) -> Self {
        match camera.projection() {
            Projection::Perspective { .. } => Self { center: camera.eye(), sx, sy, forward: None },
            Projection::Orthographic => {
                let f = camera.forward();
                let largest = f.abs().max_element();
                // A power of two changes no sign and keeps products of components in range.
                let scale = libm::exp2(-libm::floor(libm::log2(largest)).clamp(-1000.0, 1000.0));
                let forward = DVec3::new(f.x * sx, f.y * sy, f.z) * scale;
                Self { center, sx, sy, forward: Some(forward) }
            }
        }
    }

    /// Whether a point lies beyond the part's borders x and y.
    pub(super) fn is_outside(&self, p: DVec3) -> (bool, bool) {
        let Self { center, sx, sy, forward } = *self;
        if forward.is_some() {
            return (false, false);
        }
        (p.x * sx < center.x * sx, p.y * sy < center.y * sy)
    }

    /// `h` of a point, rounded.
    pub(super) fn rounded(&self, p: DVec3) -> [f64; 3] {
        let d = p - self.center;
        let (dx, dy) = (d.x * self.sx, d.y * self.sy);
        match self.forward {
            None => [dx - dy, dx + dy, d.z],
            Some(f) => [
                f.y * dx - f.x * dy,
                1.0,
                d.z * (f.x * f.x + f.y * f.y) - f.z * (f.x * dx + f.y * dy),
            ],
        }
    }

    /// Where the u of `p` lies compared with the u of `q`.
    pub(super) fn order(&self, p: DVec3, q: DVec3) -> Ordering {
        if let Some(sign) = self.order_by_products(p, q).or_else(|| self.order_by_expansions(p, q))
        {
            return sign;
        }
        let [p, q] = self.exact([p, q]);
        sign(&(&p[0] * &q[1] - &q[0] * &p[1]))
    }

    /// The order if one product is zero or the signs differ, as on lines of the grid.
    fn order_by_products(&self, p: DVec3, q: DVec3) -> Option<Ordering> {
        let order = |a: f64, b: f64| a.partial_cmp(&b);
        let (left, right) = match self.forward {
            None => {
                // u grows with dx/dy: the sign of dx(p) dy(q) − dx(q) dy(p), up to the factor 2.
                let c = self.center;
                let side = |a: f64, b: f64, s: f64| order(a * s, b * s);
                (
                    product(side(p.x, c.x, self.sx)?, side(q.y, c.y, self.sy)?),
                    product(side(q.x, c.x, self.sx)?, side(p.y, c.y, self.sy)?),
                )
            }
            Some(f) => (
                product(order(f.y, 0.0)?, order(p.x * self.sx, q.x * self.sx)?),
                product(order(f.x, 0.0)?, order(p.y * self.sy, q.y * self.sy)?),
            ),
        };
        match (left, right) {
            (left, Ordering::Equal) => Some(left),
            (Ordering::Equal, right) => Some(right.reverse()),
            (left, right) if left != right => Some(left),
            _ => None,
        }
    }

    /// The order by an adaptive determinant, which is exact within its window of exponents.
    fn order_by_expansions(&self, p: DVec3, q: DVec3) -> Option<Ordering> {
        let coord = |x, y| robust::Coord { x, y };
        let plan = |p: DVec3| coord(p.x, p.y);
        let det = match self.forward {
            None => {
                let [p, q, c] = [p, q, self.center].map(plan);
                if ![p, q, c].iter().all(|p| in_window(p.x) && in_window(p.y)) {
                    return None;
                }
                robust::orient2d(p, q, c) * self.sx * self.sy
            }
            Some(f) => {
                let (dx, dx_error) = difference(p.x, q.x);
                let (dy, dy_error) = difference(p.y, q.y);
                if ![dx, dx_error, dy, dy_error, f.x, f.y].into_iter().all(in_window) {
                    return None;
                }
                let (across, along) = (f.y * self.sx, -f.x * self.sy);
                let products = [(across, dx), (across, dx_error), (along, dy), (along, dy_error)];
                sign_of_sum(products)
            }
        };
        det.partial_cmp(&0.0)
    }

    /// Where the u of `p` lies compared with `u`.
    pub(super) fn order_to_border(&self, p: DVec3, u: f64) -> Ordering {
        let scaled = self.scaled(&[p], &[PlaceOnU::Border(u)]);
        let (p, b) = (&scaled.0[0], &scaled.1[0]);
        sign(&(&p[0] * &b[1] - &b[0] * &p[1]))
    }

    /// Where the u of `p` lies compared with the crossing of two lines, each given from left to
    /// right.
    pub(super) fn order_to_crossing(
        &self,
        p: DVec3,
        first: [DVec3; 2],
        second: [DVec3; 2],
    ) -> Ordering {
        let [p, a, b, c, d] = self.exact([p, first[0], first[1], second[0], second[1]]);
        let w = cross(&cross(&a, &b), &cross(&c, &d));
        times(sign(&(&p[0] * &w[1] - &w[0] * &p[1])), sign(&w[1]))
    }

    /// Whether `p` is above (`Greater`), on or below the line from `a` on the left to `b`.
    pub(super) fn point_over_line(&self, p: DVec3, a: DVec3, b: DVec3) -> Ordering {
        let [p, a, b] = self.exact([p, a, b]);
        sign(&dot(&cross(&a, &b), &p)).reverse()
    }

    /// Whether `q` is above (`Greater`), level with or below `p`. Both are at the same u.
    pub(super) fn rise(&self, p: DVec3, q: DVec3) -> Ordering {
        let [p, q] = self.exact([p, q]);
        sign(&(&q[2] * &p[1] - &p[2] * &q[1]))
    }

    /// Whether the first line is above (`Greater`), on or below the second at a place.
    pub(super) fn line_over_line(
        &self,
        first: [DVec3; 2],
        second: [DVec3; 2],
        at: PlaceOnU,
    ) -> Ordering {
        let points = [first[0], first[1], second[0], second[1]];
        let scaled = self.scaled(&points, &[at]);
        let [a, b, c, d] = &scaled.0[..] else {
            return Ordering::Equal;
        };
        let at = &scaled.1[0];
        let (m, n) = (cross(a, b), cross(c, d));
        let height = |n: &Triple| &n[0] * &at[0] + &n[1] * &at[1];
        // v = −height / n[2] with n[2] < 0 for lines from left to right.
        sign(&(height(&n) * &m[2] - height(&m) * &n[2]))
    }

    /// Whether a line is above (`Greater`), on or below the point where two others cross.
    pub(super) fn line_over_crossing(
        &self,
        line: [DVec3; 2],
        first: [DVec3; 2],
        second: [DVec3; 2],
    ) -> Ordering {
        let [a, b, c, d, e, f] =
            self.exact([line[0], line[1], first[0], first[1], second[0], second[1]]);
        let w = cross(&cross(&c, &d), &cross(&e, &f));
        times(sign(&dot(&cross(&a, &b), &w)), sign(&w[1]))
    }

    /// The u at which two lines cross, correct to about the last digit.
    pub(super) fn crossing_u(&self, first: [DVec3; 2], second: [DVec3; 2]) -> f64 {
        let points = [first[0], first[1], second[0], second[1]];
        let scaled = self.scaled(&points, &[]);
        let [a, b, c, d] = &scaled.0[..] else {
            return 0.0;
        };
        let w = cross(&cross(a, b), &cross(c, d));
        let unit = self.forward.map_or(0, |_| scaled.2);
        libm::ldexp(ratio(&w[0], &w[1]), unit.clamp(-3000, 3000) as i32)
    }

    /// Where on the way from `p` to `q` a place is passed, as a fraction; correct to about the last digit.
    pub(super) fn way_to_place(&self, [p, q]: [DVec3; 2], place: PlaceOnU) -> f64 {
        let scaled = self.scaled(&[p, q], &[place]);
        let ([p, q], [w]) = (&scaled.0[..], &scaled.1[..]) else {
            return 0.0;
        };
        let passed = |h: &Triple| &h[0] * &w[1] - &w[0] * &h[1];
        way(&passed(p), &passed(q))
    }

    /// The same, for where the way passes over or under a line.
    pub(super) fn way_to_line(&self, [p, q]: [DVec3; 2], [a, b]: [DVec3; 2]) -> f64 {
        let [p, q, a, b] = self.exact([p, q, a, b]);
        let normal = cross(&a, &b);
        way(&dot(&normal, &p), &dot(&normal, &q))
    }

    /// The same, for the u at which two lines cross.
    pub(super) fn way_to_crossing(
        &self,
        [p, q]: [DVec3; 2],
        [a, b]: [DVec3; 2],
        [c, d]: [DVec3; 2],
    ) -> f64 {
        let [p, q, a, b, c, d] = self.exact([p, q, a, b, c, d]);
        let w = cross(&cross(&a, &b), &cross(&c, &d));
        let passed = |h: &Triple| &h[0] * &w[1] - &w[0] * &h[1];
        way(&passed(&p), &passed(&q))
    }

    fn exact<const N: usize>(&self, points: [DVec3; N]) -> [Triple; N] {
        let mut triples = self.scaled(&points, &[]).0.into_iter();
        std::array::from_fn(|_| triples.next().unwrap_or([IBig::ZERO; 3]))
    }

    /// Exact triples of points and places at a common scale, and the power of two of the unit of u in
    /// orthographic projection.
    fn scaled(&self, points: &[DVec3], places: &[PlaceOnU]) -> (Vec<Triple>, Vec<Triple>, i64) {
        let vertices = places.iter().filter_map(|place| match place {
            PlaceOnU::Vertex(p) => Some(*p),
            PlaceOnU::Border(_) => None,
        });
        let all = points.iter().copied().chain(vertices).chain([self.center]);
        let unit = all.flat_map(|p| p.to_array()).filter_map(exponent).min().unwrap_or(0);
        let f_unit = self
            .forward
            .map_or(0, |f| f.to_array().into_iter().filter_map(exponent).min().unwrap_or(0));
        let triples = points.iter().map(|&p| self.triple(p, unit, f_unit)).collect();
        let places = places
            .iter()
            .map(|place| match *place {
                PlaceOnU::Vertex(p) => self.triple(p, unit, f_unit),
                PlaceOnU::Border(u) => {
                    let (mantissa, power) = parts(u);
                    let unit_of_u = if self.forward.is_some() { unit + f_unit } else { 0 };
                    let shift = power - unit_of_u;
                    [
                        IBig::from(mantissa) << shift.max(0) as usize,
                        IBig::ONE << (-shift).max(0) as usize,
                        IBig::ZERO,
                    ]
                }
            })
            .collect();
        (triples, places, unit + f_unit)
    }

    fn triple(&self, p: DVec3, unit: i64, f_unit: i64) -> Triple {
        let d = |p: f64, c: f64| integer(p, unit) - integer(c, unit);
        let reflected = |d: IBig, s: f64| if s < 0.0 { -d } else { d };
        let dx = reflected(d(p.x, self.center.x), self.sx);
        let dy = reflected(d(p.y, self.center.y), self.sy);
        let dz = d(p.z, self.center.z);
        match self.forward {
            None => [&dx - &dy, dx + dy, dz],
            Some(f) => {
                let [fx, fy, fz] = f.to_array().map(|c| integer(c, f_unit));
                let plan = &fx * &dx + &fy * &dy;
                [&fy * &dx - &fx * &dy, IBig::ONE, dz * (&fx * &fx + &fy * &fy) - fz * plan]
            }
        }
    }
}

/// Where a linear function with values `p` and `q` at the ends is zero, as a fraction of the way.
fn way(p: &IBig, q: &IBig) -> f64 {
    ratio(p, &(p - q))
}

/// A quotient, correct to about the last digit; 0 if the divisor is.
fn ratio(numerator: &IBig, denominator: &IBig) -> f64 {
    if *denominator == IBig::ZERO {
        return 0.0;
    }
    let n_bits = |number: &IBig| number.clone().into_parts().1.bit_len() as isize;
    // Keep 128 bits more of the numerator than of the denominator, then shift back.
    let shift = (128 + n_bits(denominator) - n_bits(numerator)).max(0) as usize;
    let quotient = (numerator.clone() << shift) / denominator;
    libm::ldexp(quotient.to_f64().value(), -(shift.min(3000) as i32))
}

/// On which side of the plane through `a`, `b` and `c` a point is: `Greater` when `a`, `b`, `c` turn
/// counter-clockwise in plan and the point is above.
pub(super) fn over_plane(p: DVec3, a: DVec3, b: DVec3, c: DVec3) -> Ordering {
    let unit =
        [p, a, b, c].iter().flat_map(|p| p.to_array()).filter_map(exponent).min().unwrap_or(0);
    let minus = |q: DVec3| -> Triple {
        let difference = |k: usize| integer(q[k], unit) - integer(a[k], unit);
        [difference(0), difference(1), difference(2)]
    };
    sign(&dot(&cross(&minus(b), &minus(c)), &minus(p)))
}

/// Sizes between which products of two numbers and their rounding errors are normal numbers.
const WINDOW: std::ops::Range<f64> = 1e-60..1e60;

fn in_window(value: f64) -> bool {
    value == 0.0 || WINDOW.contains(&value.abs())
}

/// `a − b` and its rounding error (Knuth).
fn difference(a: f64, b: f64) -> (f64, f64) {
    let difference = a - b;
    let b_part = a - difference;
    (difference, (a - (difference + b_part)) + (b_part - b))
}

/// A number with the sign of the sum of products, exactly: an expansion that grows by each product
/// and its rounding error (Shewchuk 1997, section 2.4).
fn sign_of_sum(products: [(f64, f64); 4]) -> f64 {
    let mut expansion = [0.0; 8];
    let mut length = 0;
    for (a, b) in products {
        let product = a * b;
        for term in [a.mul_add(b, -product), product] {
            let mut carried = term;
            for part in &mut expansion[..length] {
                let (sum, error) = difference(carried, -*part);
                *part = error;
                carried = sum;
            }
            expansion[length] = carried;
            length += 1;
        }
    }
    expansion.into_iter().rev().find(|part| *part != 0.0).unwrap_or(0.0)
}

type Triple = [IBig; 3];

fn cross(a: &Triple, b: &Triple) -> Triple {
    let minor = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn dot(a: &Triple, b: &Triple) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn sign(value: &IBig) -> Ordering {
    match (value.is_zero(), value.sign()) {
        (true, _) => Ordering::Equal,
        (_, Sign::Positive) => Ordering::Greater,
        (_, Sign::Negative) => Ordering::Less,
    }
}

fn times(a: Ordering, b: Ordering) -> Ordering {
    product(a, b)
}

fn product(a: Ordering, b: Ordering) -> Ordering {
    match b {
        Ordering::Greater => a,
        Ordering::Equal => Ordering::Equal,
        Ordering::Less => a.reverse(),
    }
}

/// `value = mantissa · 2^power` for a finite number.
fn parts(value: f64) -> (i64, i64) {
    let bits = value.to_bits();
    let stored = ((bits >> 52) & 0x7ff) as i64;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (mantissa, power) =
        if stored == 0 { (fraction, -1074) } else { (fraction | (1 << 52), stored - 1075) };
    let zeros = if mantissa == 0 { 0 } else { mantissa.trailing_zeros() };
    let mantissa = (mantissa >> zeros) * if value < 0.0 { -1 } else { 1 };
    (mantissa, power + i64::from(zeros))
}

fn exponent(value: f64) -> Option<i64> {
    (value != 0.0).then(|| parts(value).1)
}

/// `value / 2^unit`, where `unit` is at most the exponent of `value`.
fn integer(value: f64, unit: i64) -> IBig {
    let (mantissa, power) = parts(value);
    IBig::from(mantissa) << (power - unit).max(0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_of_a_crossing_does_not_depend_on_the_order_of_its_lines() {
        // Seen along y, u is x and v is z.
        let sight = PlanSight { center: DVec3::ZERO, sx: 1.0, sy: 1.0, forward: Some(DVec3::Y) };
        let at = |x: f64, z: f64| DVec3::new(x, x, z);
        let (rising, falling) = ([at(0.0, 0.0), at(2.0, 2.0)], [at(0.0, 2.0), at(2.0, 0.0)]);
        for (x, expected) in
            [(0.5, Ordering::Less), (1.0, Ordering::Equal), (1.5, Ordering::Greater)]
        {
            assert_eq!(sight.order_to_crossing(at(x, 9.0), rising, falling), expected);
            assert_eq!(sight.order_to_crossing(at(x, 9.0), falling, rising), expected);
        }
    }
}
