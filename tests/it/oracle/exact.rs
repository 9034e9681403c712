//! Exact numbers: every `f64` is an integer times a power of two, so a scene is a list of integers.

use dashu_int::IBig;
use dashu_int::ops::BitTest;
use std::cmp::Ordering;

/// An integer of any size.
pub(crate) type Int = IBig;

/// A point (x, y, z, w) with w > 0 standing for (x/w, y/w, z/w), or a direction with w = 0.
pub(crate) type Point = [Int; 4];

/// The linear form p ↦ c·p; a plane, with the sign of its value telling the side.
pub(crate) type Plane = [Int; 4];

/// −1, 0 or 1.
pub(crate) fn sign(x: &Int) -> i32 {
    match x.cmp(&Int::ZERO) {
        Ordering::Less => -1,
        Ordering::Equal => 0,
        Ordering::Greater => 1,
    }
}

/// `x = mantissa · 2^exponent`, the mantissa odd or zero.
pub(crate) fn decomposed(x: f64) -> (i64, i32) {
    assert!(x.is_finite());
    if x == 0.0 {
        return (0, i32::MAX);
    }
    let bits = x.to_bits();
    let field = ((bits >> 52) & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (mantissa, exponent) =
        if field == 0 { (fraction, -1074) } else { (fraction | (1 << 52), field - 1075) };
    let zeros = mantissa.trailing_zeros();
    let odd = mantissa >> zeros;
    (if x < 0.0 { -odd } else { odd }, exponent + zeros as i32)
}

/// The largest k for which every number is an integer times 2^k; 0 when all are zero.
pub(crate) fn common_exponent(numbers: impl IntoIterator<Item = f64>) -> i32 {
    let k = numbers.into_iter().map(|x| decomposed(x).1).min().unwrap_or(i32::MAX);
    if k == i32::MAX { 0 } else { k }
}

/// `x / 2^k`, which must be an integer.
pub(crate) fn scaled(x: f64, k: i32) -> Int {
    let (mantissa, exponent) = decomposed(x);
    if mantissa == 0 { Int::ZERO } else { Int::from(mantissa) << (exponent - k) as usize }
}

/// The value of a plane's form at a point.
pub(crate) fn value(plane: &Plane, p: &Point) -> Int {
    &plane[0] * &p[0] + &plane[1] * &p[1] + &plane[2] * &p[2] + &plane[3] * &p[3]
}

/// The form x ↦ det(a, b, c, x): zero on the plane through the three points.
pub(crate) fn plane_through(a: &Point, b: &Point, c: &Point) -> Plane {
    let minor = |i: usize, j: usize, k: usize| {
        &a[i] * (&b[j] * &c[k] - &b[k] * &c[j]) - &a[j] * (&b[i] * &c[k] - &b[k] * &c[i])
            + &a[k] * (&b[i] * &c[j] - &b[j] * &c[i])
    };
    [-minor(1, 2, 3), minor(0, 2, 3), -minor(0, 1, 3), minor(0, 1, 2)]
}

pub(crate) fn negated(plane: Plane) -> Plane {
    plane.map(|c| -c)
}

pub(crate) fn dot(a: &[Int; 3], b: &[Int; 3]) -> Int {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(crate) fn cross(a: &[Int; 3], b: &[Int; 3]) -> [Int; 3] {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

pub(crate) fn minus(a: &[Int; 3], b: &[Int; 3]) -> [Int; 3] {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

pub(crate) fn is_zero(v: &[Int; 3]) -> bool {
    v.iter().all(|x| sign(x) == 0)
}

/// A fraction; the denominator is positive, common factors may remain.
#[derive(Clone, Debug)]
pub(crate) struct Ratio {
    pub numerator: Int,
    pub denominator: Int,
}

impl Ratio {
    pub(crate) fn new(numerator: Int, denominator: Int) -> Self {
        match sign(&denominator) {
            0 => panic!("division by zero in the oracle"),
            1 => Self { numerator, denominator },
            _ => Self { numerator: -numerator, denominator: -denominator },
        }
    }

    pub(crate) fn integer(x: i32) -> Self {
        Self { numerator: Int::from(x), denominator: Int::ONE }
    }

    /// The nearest `f64` but for the last bit.
    pub(crate) fn to_f64(&self) -> f64 {
        if sign(&self.numerator) == 0 {
            return 0.0;
        }
        // The quotient gets 64 or 65 bits.
        let shift = 64 + self.denominator.bit_len() as i64 - self.numerator.bit_len() as i64;
        let quotient = if shift >= 0 {
            (&self.numerator << shift as usize) / &self.denominator
        } else {
            &self.numerator / (&self.denominator << (-shift) as usize)
        };
        let quotient = i128::try_from(quotient).unwrap() as f64;
        let half = (-shift / 2) as i32;
        quotient * 2f64.powi(half) * 2f64.powi((-shift) as i32 - half)
    }
}

impl PartialEq for Ratio {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Ratio {}

impl PartialOrd for Ratio {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ratio {
    fn cmp(&self, other: &Self) -> Ordering {
        (&self.numerator * &other.denominator).cmp(&(&other.numerator * &self.denominator))
    }
}

#[test]
fn numbers_survive_the_way_to_integers_and_back() {
    for x in [1.0, -0.5, 0.1, 1e-300, 5e-324, -1e300, 3.0, 1.0 / 3.0] {
        let k = common_exponent([x, 0.25]);
        let ratio = if k < 0 {
            Ratio::new(scaled(x, k), Int::ONE << (-k) as usize)
        } else {
            Ratio::new(scaled(x, k) << k as usize, Int::ONE)
        };
        assert_eq!(ratio.to_f64(), x);
    }
}

#[test]
fn a_plane_is_zero_at_its_points_and_has_the_sign_of_the_determinant() {
    let p = |x: i32, y: i32, z: i32, w: i32| [x, y, z, w].map(Int::from);
    let (a, b, c) = (p(1, 2, 3, 1), p(4, -1, 2, 2), p(0, 5, 1, 1));
    let plane = plane_through(&a, &b, &c);
    for q in [&a, &b, &c] {
        assert_eq!(value(&plane, q), Int::ZERO);
    }
    // Rows e0, e1, e2, e3: the identity.
    let unit = plane_through(&p(1, 0, 0, 0), &p(0, 1, 0, 0), &p(0, 0, 1, 0));
    assert_eq!(value(&unit, &p(0, 0, 0, 1)), Int::ONE);
}
