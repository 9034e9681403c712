//! Cuts: where an affine function of a segment's parameter is zero, and their exact order.

use super::{Estimate, Sight, Sign, exact};
use dashu_int::IBig;
use std::cmp::Ordering;

/// The plane whose crossing is a cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CutPlane {
    /// No plane: the segment's own first or last point.
    End,
    /// The plane of sight through two vertices, the lower number first.
    Sight(u32, u32),
    /// The plane of a triangle, by its vertices.
    Triangle([u32; 3]),
    /// The camera's near plane.
    Near,
    /// The plane of sight through the line where the near plane cuts a triangle.
    NearCut([u32; 3]),
}

/// A point of a segment, as the root of an affine function of its parameter `t`.
///
/// `t` is rounded and lies within `error` of the truth; order is decided by [`Sight::cut_order`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cut {
    /// Parameter along the segment, 0 at its first point and 1 at its last.
    pub t: f64,
    /// How far the true parameter may be from `t`.
    pub error: f64,
    /// What makes the cut.
    pub plane: CutPlane,
}

/// Largest error of a cut's rounded parameter that is left alone: above it the parameter is
/// computed again from exact integers. It bounds a construction, not a decision.
const PARAMETER_ERROR: f64 = 1.0 / (1u64 << 36) as f64;

impl Cut {
    /// The segment's first point.
    pub const START: Self = Self { t: 0.0, error: 0.0, plane: CutPlane::End };
    /// The segment's last point.
    pub const END: Self = Self { t: 1.0, error: 0.0, plane: CutPlane::End };
}

impl Sight<'_> {
    /// The cut of the segment from vertex `ends[0]` to `ends[1]` with `plane`, given estimates of
    /// the plane's function at both ends, whose true signs must be opposite.
    #[inline]
    pub fn cut(&self, ends: [u32; 2], plane: CutPlane, at: [Estimate; 2]) -> Cut {
        let [a, b] = at;
        let difference = a.value - b.value;
        // d(a / (a − b)) ≤ (|b| da + |a| db) / (a − b)²; three roundings come on top.
        let error = (b.value.abs() * a.error + a.value.abs() * b.error) / (difference * difference)
            * 2.0
            + 4.0 * f64::EPSILON;
        let certain = difference.abs() > 2.0 * (a.error + b.error);
        if certain && error <= PARAMETER_ERROR {
            return Cut { t: (a.value / difference).clamp(0.0, 1.0), error, plane };
        }
        let [a, b] = self.exact_values(ends, plane);
        let t = exact::ratio(&a, &(&a - b)).clamp(0.0, 1.0);
        Cut { t, error: 8.0 * f64::EPSILON, plane }
    }

    /// The order of two cuts along the segment, exactly. Two planes may cut at one point.
    #[inline]
    pub fn cut_order(&self, ends: [u32; 2], a: &Cut, b: &Cut) -> Ordering {
        if (a.t - b.t).abs() > a.error + b.error {
            return a.t.total_cmp(&b.t);
        }
        if a.plane == b.plane {
            // Both ends of the segment bear the same name, but differ by one in t.
            return Ordering::Equal;
        }
        match (a.plane, b.plane) {
            // A plane cuts strictly between the ends: at an end there is no change of sign.
            (CutPlane::End, _) => {
                return if a.t < 0.5 { Ordering::Less } else { Ordering::Greater };
            }
            (_, CutPlane::End) => {
                return if b.t < 0.5 { Ordering::Greater } else { Ordering::Less };
            }
            _ => {}
        }
        // t = f0 / (f0 − f1), so t_a < t_b ⇔ a0 (b0 − b1) < b0 (a0 − a1) ⇔ b0 a1 < a0 b1, up to
        // the signs of the two denominators, which are those of a0 and b0.
        let [a0, a1] = self.exact_values(ends, a.plane);
        let [b0, b1] = self.exact_values(ends, b.plane);
        let order = exact::sign(&(&b0 * a1 - &a0 * b1));
        match order.times(exact::sign(&a0)).times(exact::sign(&b0)) {
            Sign::Negative => Ordering::Less,
            Sign::Zero => Ordering::Equal,
            Sign::Positive => Ordering::Greater,
        }
    }

    /// The function of `plane` at both ends of a segment, up to one positive factor.
    fn exact_values(&self, ends: [u32; 2], plane: CutPlane) -> [IBig; 2] {
        self.count_exact();
        match plane {
            CutPlane::End => [IBig::ZERO, IBig::ONE],
            CutPlane::Sight(p, q) => self.exact_turns(p, q, ends),
            CutPlane::Triangle(triangle) => self.exact_depths(triangle, ends),
            CutPlane::Near => self.exact_near_distances(ends),
            CutPlane::NearCut(triangle) => self.exact_near_cut_values(triangle, ends),
        }
    }
}
