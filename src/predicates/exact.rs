//! The exact path: polynomials in `f64` inputs, evaluated with integers of arbitrary size.
//!
//! Every finite `f64` is an integer times a power of two. The inputs of one evaluation are scaled to a
//! common power of two (`Lattice`). If they then have at most 40 bits, as small integer coordinates do, a
//! triple product of their differences fits `i128`; otherwise integers of arbitrary size are used. Either
//! way the result is the exact value, up to a positive factor that is the same for all results of one call.

use super::Sign;
use dashu_int::IBig;
use glam::DVec3;
use std::ops::{Add, Mul, Neg, Sub};

/// Widest coordinate, in bits, whose triple products of differences fit `i128`:
/// three factors of 41 bits and six terms need 126 bits and a sign.
const MAX_SMALL_BITS: i32 = 40;

/// A finite `f64` as an odd integer times a power of two (zero as 0 · 2⁰).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct OddScaled {
    odd: i64,
    exponent: i32,
}

impl OddScaled {
    fn new(x: f64) -> Self {
        let bits = x.to_bits();
        let biased = ((bits >> 52) & 0x7ff) as i32;
        let fraction = bits & ((1 << 52) - 1);
        let (mantissa, exponent) =
            if biased == 0 { (fraction, -1074) } else { (fraction | (1 << 52), biased - 1075) };
        if mantissa == 0 {
            return Self { odd: 0, exponent: 0 };
        }
        let zeros = mantissa.trailing_zeros();
        let odd = (mantissa >> zeros) as i64;
        Self { odd: if x < 0.0 { -odd } else { odd }, exponent: exponent + zeros as i32 }
    }

    /// One more than the exponent of the highest bit.
    fn top(self) -> i32 {
        self.exponent + (64 - self.odd.unsigned_abs().leading_zeros() as i32)
    }
}

/// The exponents of the lowest and the highest set bit of all non-zero `numbers`, the latter plus
/// one; `None` when all are zero.
fn bit_range(numbers: impl IntoIterator<Item = f64>) -> Option<(i32, i32)> {
    numbers
        .into_iter()
        .filter(|&x| x != 0.0)
        .map(OddScaled::new)
        .map(|x| (x.exponent, x.top()))
        .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// A common power of two of several numbers.
struct Lattice {
    exponent: i32,
    bits: i32,
}

impl Lattice {
    fn of(points: &[DVec3]) -> Self {
        let range = bit_range(points.iter().flat_map(|p| p.to_array()));
        let (low, high) = range.unwrap_or((0, 0));
        Self { exponent: low, bits: high - low }
    }

    fn is_small(&self) -> bool {
        self.bits <= MAX_SMALL_BITS
    }

    fn small(&self, p: DVec3) -> [i128; 3] {
        p.to_array().map(|x| {
            let x = OddScaled::new(x);
            if x.odd == 0 { 0 } else { i128::from(x.odd) << (x.exponent - self.exponent) }
        })
    }

    fn big(&self, p: DVec3) -> [IBig; 3] {
        p.to_array().map(|x| {
            let x = OddScaled::new(x);
            if x.odd == 0 {
                IBig::ZERO
            } else {
                IBig::from(x.odd) << (x.exponent - self.exponent) as usize
            }
        })
    }
}

/// The integers that polynomials are evaluated in.
pub(super) trait Integer:
    Clone + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
}

impl Integer for i128 {}
impl Integer for IBig {}

pub(super) fn minus<T: Integer>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    std::array::from_fn(|i| a[i].clone() - b[i].clone())
}

pub(super) fn cross<T: Integer>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j].clone() * b[k].clone() - a[k].clone() * b[j].clone()
    })
}

pub(super) fn dot<T: Integer>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0].clone() * b[0].clone() + a[1].clone() * b[1].clone() + a[2].clone() * b[2].clone()
}

/// `(b − a) × (c − a) · (x − a)` for two points `x`, up to one positive factor.
fn volumes<T: Integer>(a: &[T; 3], b: &[T; 3], c: &[T; 3], x: [&[T; 3]; 2]) -> [T; 2] {
    let normal = cross(&minus(b, a), &minus(c, a));
    x.map(|x| dot(&normal, &minus(x, a)))
}

/// `(b − a) × (c − a) · (x − a)` for two points `x`, up to one positive factor.
pub fn point_volumes(a: DVec3, b: DVec3, c: DVec3, x: [DVec3; 2]) -> [IBig; 2] {
    let lattice = Lattice::of(&[a, b, c, x[0], x[1]]);
    if lattice.is_small() {
        let [a, b, c, x0, x1] = [a, b, c, x[0], x[1]].map(|p| lattice.small(p));
        volumes(&a, &b, &c, [&x0, &x1]).map(IBig::from)
    } else {
        let [a, b, c, x0, x1] = [a, b, c, x[0], x[1]].map(|p| lattice.big(p));
        volumes(&a, &b, &c, [&x0, &x1])
    }
}

/// `direction × (b − a) · (x − a)` for two points `x`, up to one positive factor.
pub fn direction_volumes(direction: DVec3, a: DVec3, b: DVec3, x: [DVec3; 2]) -> [IBig; 2] {
    fn volumes<T: Integer>(d: &[T; 3], a: &[T; 3], b: &[T; 3], x: [&[T; 3]; 2]) -> [T; 2] {
        let normal = cross(d, &minus(b, a));
        x.map(|x| dot(&normal, &minus(x, a)))
    }
    let lattice = Lattice::of(&[a, b, x[0], x[1]]);
    let own = Lattice::of(&[direction]);
    if lattice.is_small() && own.is_small() {
        let [a, b, x0, x1] = [a, b, x[0], x[1]].map(|p| lattice.small(p));
        volumes(&own.small(direction), &a, &b, [&x0, &x1]).map(IBig::from)
    } else {
        let [a, b, x0, x1] = [a, b, x[0], x[1]].map(|p| lattice.big(p));
        volumes(&own.big(direction), &a, &b, [&x0, &x1])
    }
}

/// Where a polygon is seen from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Towards {
    /// From a point.
    Point(DVec3),
    /// From infinity, looking along this direction.
    Along(DVec3),
}

/// The sign of the polygon's Newell normal times the direction from its first point to the eye.
pub fn facing(polygon: impl IntoIterator<Item = DVec3>, towards: Towards) -> Sign {
    let mut points = polygon.into_iter().map(dyadic);
    let Some(first) = points.next() else {
        return Sign::Zero;
    };
    let to_eye = match towards {
        Towards::Point(eye) => minus(&dyadic(eye), &first),
        Towards::Along(forward) => dyadic(-forward),
    };
    let mut sum = Dyadic::from(0.0);
    let mut last = first.clone();
    for point in points {
        let (a, b) = (minus(&last, &first), minus(&point, &first));
        sum = sum + dot(&cross(&a, &b), &to_eye);
        last = point;
    }
    sum.sign()
}

/// Whether `a`, `b` and `c` are on one line.
pub fn collinear(a: DVec3, b: DVec3, c: DVec3) -> bool {
    let lattice = Lattice::of(&[a, b, c]);
    let [a, b, c] = [a, b, c].map(|p| lattice.big(p));
    cross(&minus(&b, &a), &minus(&c, &a)).iter().all(|x| x.is_zero())
}

/// Whether `b − a` is parallel to `direction`.
pub fn parallel(a: DVec3, b: DVec3, direction: DVec3) -> bool {
    let lattice = Lattice::of(&[a, b]);
    let [a, b] = [a, b].map(|p| lattice.big(p));
    cross(&minus(&b, &a), &Lattice::of(&[direction]).big(direction)).iter().all(|x| x.is_zero())
}

/// A number `value · 2^exponent`, for polynomials whose inputs have several scales.
#[derive(Debug, Clone, PartialEq)]
pub struct Dyadic {
    value: IBig,
    exponent: i32,
}

impl From<f64> for Dyadic {
    fn from(x: f64) -> Self {
        let x = OddScaled::new(x);
        Self { value: IBig::from(x.odd), exponent: x.exponent }
    }
}

impl From<IBig> for Dyadic {
    fn from(value: IBig) -> Self {
        Self { value, exponent: 0 }
    }
}

impl Integer for Dyadic {}

impl Dyadic {
    fn aligned(self, other: Self) -> (IBig, IBig, i32) {
        let exponent = self.exponent.min(other.exponent);
        let shift = |x: Self| x.value << (x.exponent - exponent) as usize;
        (shift(self), shift(other), exponent)
    }

    /// Its sign.
    pub fn sign(&self) -> Sign {
        sign(&self.value)
    }
}

impl Add for Dyadic {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (a, b, exponent) = self.aligned(other);
        Self { value: a + b, exponent }
    }
}

impl Sub for Dyadic {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        let (a, b, exponent) = self.aligned(other);
        Self { value: a - b, exponent }
    }
}

impl Neg for Dyadic {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, exponent: self.exponent }
    }
}

impl Mul for Dyadic {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self { value: self.value * other.value, exponent: self.exponent + other.exponent }
    }
}

pub(super) fn dyadic(p: DVec3) -> [Dyadic; 3] {
    p.to_array().map(Dyadic::from)
}

/// Two dyadic numbers as integers of one scale.
pub(super) fn same_scale([a, b]: [Dyadic; 2]) -> [IBig; 2] {
    let (a, b, _) = a.aligned(b);
    [a, b]
}

/// `(x − eye) · forward − near · forward · forward` for two points `x`, up to one positive factor:
/// on which side of the near plane they are.
pub fn near_distances(eye: DVec3, forward: DVec3, near: f64, x: [DVec3; 2]) -> [IBig; 2] {
    let (eye, forward) = (dyadic(eye), dyadic(forward));
    let limit = Dyadic::from(near) * dot(&forward, &forward);
    same_scale(x.map(|x| dot(&minus(&dyadic(x), &eye), &forward) - limit.clone()))
}

/// The plane through the eye and the line in which the near plane cuts triangle `pqr`, at two
/// points `x`, up to one positive factor.
///
/// With `n` the triangle's normal and `h = n · (p − eye)`, the sight line of `x` meets the triangle
/// beyond the near plane when `h (x − eye)·forward − near forward·forward n·(x − eye)` has the sign
/// of `n · (x − eye)`; for points behind the triangle that is the sign of `h`.
pub fn near_cut_values(
    eye: DVec3,
    forward: DVec3,
    near: f64,
    triangle: [DVec3; 3],
    x: [DVec3; 2],
) -> [IBig; 2] {
    let (eye, forward) = (dyadic(eye), dyadic(forward));
    let [p, q, r] = triangle.map(dyadic);
    let normal = cross(&minus(&q, &p), &minus(&r, &p));
    let height = dot(&normal, &minus(&p, &eye));
    let limit = Dyadic::from(near) * dot(&forward, &forward);
    same_scale(x.map(|x| {
        let d = minus(&dyadic(x), &eye);
        height.clone() * dot(&d, &forward) - limit.clone() * dot(&normal, &d)
    }))
}

/// Whether `x` is within `distance` of the plane of `triangle`, which must have an area.
pub fn within_distance(triangle: [DVec3; 3], x: DVec3, distance: f64) -> bool {
    let [p, q, r] = triangle.map(dyadic);
    let normal = cross(&minus(&q, &p), &minus(&r, &p));
    let height = dot(&normal, &minus(&dyadic(x), &p));
    let distance = Dyadic::from(distance);
    let left = height.clone() * height;
    let right = distance.clone() * distance * dot(&normal, &normal);
    (left - right).sign() != Sign::Positive
}

/// The sign of an integer.
pub fn sign(x: &IBig) -> Sign {
    Sign::from(x.cmp(&IBig::ZERO))
}

/// `a / b` rounded to within a few units in the last place; `b` must not be zero.
pub fn ratio(a: &IBig, b: &IBig) -> f64 {
    // Both drop the same low bits; 900 bits stay below the largest double.
    let excess = a.bit_len().max(b.bit_len()).saturating_sub(900);
    let (a, b) = (a.clone() >> excess, b.clone() >> excess);
    a.to_f64().value() / b.to_f64().value()
}

trait BitLen {
    fn bit_len(&self) -> usize;
}

impl BitLen for IBig {
    fn bit_len(&self) -> usize {
        dashu_int::ops::BitTest::bit_len(self)
    }
}
