//! Planes given by numbers instead of by points: `normal · x = offset`, exactly as given.
//!
//! Hatch lines are where such planes cut faces. Which side of a plane a vertex lies on is decided
//! exactly.

use glam::DVec3;

use super::exact::{self, Dyadic};
use super::{Estimate, Homogeneous, Sign};

/// The points `x` with `normal · x = offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreePlane {
    /// Its normal, of any length but zero.
    pub normal: DVec3,
    /// Where it is along its normal.
    pub offset: f64,
}

/// A sum of six roundings of numbers no larger than the sum of their sizes; twice that for good
/// measure.
const VALUE_ERROR: f64 = 8.0 * f64::EPSILON;

/// What products lose that vanish: they are no larger than this.
const LOST: f64 = 64.0 * f64::MIN_POSITIVE;

impl FreePlane {
    /// On which side a point lies; positive is where the normal points. Exact.
    #[inline]
    pub fn side(&self, x: DVec3) -> Sign {
        let value = self.normal.dot(x) - self.offset;
        if value.abs() > VALUE_ERROR * self.size(x) + LOST {
            return Sign::of(value);
        }
        self.exact_value(&Homogeneous::from(x)).sign()
    }

    /// The sum of the sizes of all terms.
    #[inline]
    fn size(&self, x: DVec3) -> f64 {
        self.normal.abs().dot(x.abs()) + self.offset.abs()
    }

    /// `normal · x − offset`, summed with the errors of all products and sums.
    pub(super) fn value(&self, x: DVec3) -> Estimate {
        let products = (self.normal * x).to_array();
        let (normal, at) = (self.normal.to_array(), x.to_array());
        let mut rest = 0.0;
        for i in 0..3 {
            rest += normal[i].mul_add(at[i], -products[i]);
        }
        let mut sum = -self.offset;
        for product in products {
            let (next, error) = two_sum(sum, product);
            sum = next;
            rest += error;
        }
        let value = sum + rest;
        // The rests are half a unit in the last place of the terms at most, and are off by as small a
        // part of that.
        let error =
            f64::EPSILON * value.abs() + 32.0 * f64::EPSILON * f64::EPSILON * self.size(x) + LOST;
        Estimate { value, error }
    }

    /// `normal · x − offset`, times the divisor of `x`.
    pub(super) fn exact_value(&self, x: &Homogeneous) -> Dyadic {
        exact::dot(&exact::dyadic(self.normal), &x.x) - Dyadic::from(self.offset) * x.w.clone()
    }
}

/// A sum and what its rounding lost (Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn a_vertex_on_the_plane_differs_from_one_just_below() {
        let plane = FreePlane { normal: dvec3(0.1, 0.2, 0.3), offset: 0.0 };
        let on = dvec3(2.0, -1.0, 0.0);
        assert_eq!(plane.side(on), Sign::Zero);
        assert_eq!(plane.side(dvec3(2.0, -1.0, -f64::MIN_POSITIVE)), Sign::Negative);
        let above = FreePlane { offset: f64::MIN_POSITIVE, ..plane };
        assert_eq!(above.side(on), Sign::Negative);
    }

    #[test]
    fn values_are_within_their_error_of_the_exact_one() {
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for i in 0..1000 {
            let normal = dvec3(next(), next(), next());
            let x = dvec3(next(), next(), next()) * 1e3;
            // Next to the plane, where everything cancels.
            let offset = normal.dot(x) + f64::from(i % 5 - 2) * 1e-14;
            let plane = FreePlane { normal, offset };
            let Estimate { value, error } = plane.value(x);
            let truth = plane.exact_value(&Homogeneous::from(x));
            let difference = (truth.clone() - Dyadic::from(value)).sign();
            let beyond = match difference {
                Sign::Positive => truth.clone() - Dyadic::from(value) - Dyadic::from(error),
                _ => Dyadic::from(value) - truth.clone() - Dyadic::from(error),
            };
            assert_ne!(beyond.sign(), Sign::Positive, "{i}");
            assert_eq!(plane.side(x), truth.sign(), "{i}");
            assert!(error <= 1e-12);
        }
    }
}
