//! Every geometric decision of the line engines, exact. The only home of sign conventions.
//!
//! A decision is the sign of a polynomial in the numbers of the scene and the camera *as given*.
//! [`Sight`] first evaluates it in floating point together with a proven bound of the error
//! ([`Estimate`]); only a value within its own bound goes to integers of any size
//! ([`exact`]). There is no tolerance, so answers never contradict each other.
//!
//! # Signs
//!
//! Two quantities decide everything. Both treat the eye as a point in perspective and as a
//! direction in orthographic projection, where `target − eye` takes its place.
//!
//! ```text
//!  turn(a, b, c)                          depth(p, q, r; x)
//!
//!         c                                     ╲ r
//!         ●         positive: the image   eye    ╲      x      positive when p, q, r turn
//!        ╱          of a → b → c turns     ◁      ● q   ●      counter-clockwise and x is
//!   a ●─────► b     counter-clockwise           ╱              behind their plane; in front
//!                   (y up, as on paper)        ● p             of it the sign is reversed
//! ```
//!
//! * `turn(a, b, c) = −det(a − eye, b − eye, c − eye)`; a face wound counter-clockwise as seen is
//!   a front face, so the turn of its corners is positive.
//! * `depth(p, q, r; x) = −(q − p) × (r − p) · (x − p)`. A point is strictly behind a triangle's
//!   plane, as the eye sees it, when this has the sign of `turn(p, q, r)`.
//!
//! Both are affine in their last point, so along a segment each changes sign at most once. That
//! point is a [`Cut`]; the order of two cuts is the sign of a polynomial of degree six.
//!
//! Faces that are cut ask [`Planes`] on which side of a plane a [`Corner`] lies. Planes have a positive
//! side by themselves, whoever looks: that to which the normal of `p`, `q`, `r` points, where `depth`
//! is negative.
//!
//! # Bounds
//!
//! A triple product of differences suffers at most eight roundings a term, so its error is below
//! 8.01 ε times the sum of the absolute values of its terms (ε = 2⁻⁵³); the code uses 10 ε. This
//! holds while nothing under- or overflows: coordinates below 10⁻⁷⁶ or above 10⁷⁶ in size (and not
//! zero) always take the exact path. See Shewchuk, "Adaptive precision
//! floating-point arithmetic and fast robust geometric predicates" (1997), section 4.

pub mod cut;
pub mod exact;

mod cast;
mod corner;
mod free_plane;
mod near_plane;
mod pierced;
mod planes;
mod sight;
mod volume;

pub use cast::Screen;
pub use corner::{Corner, CornerPlace};
pub use cut::{Cut, CutPlane};
pub use free_plane::FreePlane;
pub use near_plane::Kept;
pub use pierced::{Homogeneous, PiercePoint};
pub use planes::{Plane, PlaneName, Planes};
pub use sight::{PlaneThrough, Sight, Slab, Viewpoint};
pub use volume::{QuickPlane, Solid};

use glam::{DVec2, DVec3};

/// The relative error of a floating-point triple product of differences, see the module's page.
pub const TRIPLE_PRODUCT_ERROR: f64 = 10.0 * (f64::EPSILON / 2.0);

/// The sign of a real number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Sign {
    /// Below zero.
    Negative,
    /// Zero, exactly.
    Zero,
    /// Above zero.
    Positive,
}

impl Sign {
    /// The sign of `value`, taken as exact. NaN counts as zero.
    pub fn of(value: f64) -> Self {
        if value > 0.0 {
            Self::Positive
        } else if value < 0.0 {
            Self::Negative
        } else {
            Self::Zero
        }
    }

    /// The sign of the product of two numbers.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        match self {
            Self::Zero => Self::Zero,
            Self::Positive => other,
            Self::Negative => other.flipped(),
        }
    }

    /// The sign of the negated number.
    #[must_use]
    pub fn flipped(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Zero => Self::Zero,
            Self::Positive => Self::Negative,
        }
    }
}

impl From<std::cmp::Ordering> for Sign {
    fn from(ordering: std::cmp::Ordering) -> Self {
        match ordering {
            std::cmp::Ordering::Less => Self::Negative,
            std::cmp::Ordering::Equal => Self::Zero,
            std::cmp::Ordering::Greater => Self::Positive,
        }
    }
}

/// A floating-point value and a bound of its distance from the true one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The computed value.
    pub value: f64,
    /// The true value lies within this distance; zero when `value` is exact.
    pub error: f64,
}

impl Estimate {
    /// Exactly zero.
    pub const ZERO: Self = Self { value: 0.0, error: 0.0 };

    /// The sign of the true value, when the bound decides it.
    #[inline]
    pub fn sign(self) -> Option<Sign> {
        if self.value > self.error {
            Some(Sign::Positive)
        } else if self.value < -self.error {
            Some(Sign::Negative)
        } else if self.error == 0.0 && self.value == 0.0 {
            Some(Sign::Zero)
        } else {
            None
        }
    }
}

impl std::ops::Neg for Estimate {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, error: self.error }
    }
}

/// Sizes of coordinates for which `robust::orient2d` is exact.
const ROBUST_WINDOW: std::ops::RangeInclusive<f64> = 1e-90..=1e90;

/// Which way the path `a → b → c` turns in the plane, exactly.
///
/// ```text
///        c
///         ●          Positive; y up, as on paper.
///        ╱           Swapping two arguments
///   a ●───────► b    reverses the answer.
/// ```
///
/// ```
/// use hiddenline::glam::dvec2;
/// use hiddenline::stages::predicates::{Sign, orient2d};
/// let (a, b) = (dvec2(0.5, 0.5), dvec2(12.0, 12.0));
/// assert_eq!(orient2d(a, b, dvec2(24.0, 24.0)), Sign::Zero);
/// // One unit in the last place above the line.
/// assert_eq!(orient2d(a, b, dvec2(24.0, 24.0_f64.next_up())), Sign::Positive);
/// ```
pub fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> Sign {
    let fits = |x: f64| x == 0.0 || ROBUST_WINDOW.contains(&x.abs());
    if [a, b, c].iter().all(|p| fits(p.x) && fits(p.y)) {
        let coordinates = |p: DVec2| robust::Coord { x: p.x, y: p.y };
        return Sign::of(robust::orient2d(coordinates(a), coordinates(b), coordinates(c)));
    }
    let [a, b, c] = [a, b, c].map(|p| p.extend(0.0));
    let [value, _] = exact::direction_volumes(DVec3::Z, a, b, [c, c]);
    exact::sign(&value)
}
