//! The elementary functions of one number.

use std::f64::consts::{FRAC_2_PI, FRAC_2_SQRT_PI, LN_2, LN_10};

use super::super::function::Function;
use super::super::interval::Interval;
use super::{Class, Jet};

/// More than this many quarter turns are not distinguished.
const MOST_QUARTERS: f64 = 1e12;

/// The largest second derivative of the arctangent, 3√3/8, rounded up.
const ATAN_BEND: f64 = 0.649_52;

/// The largest second derivative of the hyperbolic tangent, 4√3/9, rounded up.
const TANH_BEND: f64 = 0.769_81;

const ONE: Interval = Interval::ONE;

impl Jet {
    /// A function of one number, of this one.
    pub(crate) fn apply(self, function: Function) -> Self {
        use Function::*;
        let t = self.value;
        if self.class == Class::Nowhere {
            return Self::NOWHERE;
        }
        match function {
            Sin => self.chain(sine(t), cosine(t), -sine(t), Class::Smooth),
            Cos => self.chain(cosine(t), -sine(t), -cosine(t), Class::Smooth),
            Tan => self.tangent(),
            Asin => self.arcsine(),
            Acos => self.arccosine(),
            Atan => {
                let first = (ONE + t.square()).recip();
                let second = (-t.double() * first.square()).meet(Interval::within(ATAN_BEND));
                self.chain(t.rising(libm::atan), first, second, Class::Smooth)
            }
            Sinh => {
                let value = t.rising(libm::sinh);
                self.chain(value, hyperbolic_cosine(t), value, Class::Smooth)
            }
            Cosh => {
                let value = hyperbolic_cosine(t);
                self.chain(value, t.rising(libm::sinh), value, Class::Smooth)
            }
            Tanh => {
                let value = t.rising(libm::tanh).meet(Interval::within(1.0));
                let first = (ONE - value.square()).meet(Interval::new(0.0, 1.0));
                let second = (-value.double() * first).meet(Interval::within(TANH_BEND));
                self.chain(value, first, second, Class::Smooth)
            }
            Asinh => {
                let square = ONE + t.square();
                let first = square.sqrt().recip();
                self.chain(t.rising(libm::asinh), first, -t * first.over(square), Class::Smooth)
            }
            Acosh => self.hyperbolic_arccosine(),
            Atanh => self.hyperbolic_arctangent(),
            Sqrt => self.square_root(),
            Cbrt => {
                let value = t.rising(libm::cbrt);
                let class = if t.contains(0.0) { Class::Continuous } else { Class::Smooth };
                let first = value.square().times(3.0).recip();
                // −2/(9 g⁵) = −2 g'/(3 g³).
                let second = (-first.double()).over((value.square() * value).times(3.0));
                self.chain(value, first, second, class)
            }
            Exp => {
                let value = exponential(t);
                self.chain(value, value, value, Class::Smooth)
            }
            Ln => self.logarithm(ONE, libm::log),
            Log2 => self.logarithm(Interval::rounded(LN_2), libm::log2),
            Log10 => self.logarithm(Interval::rounded(LN_10), libm::log10),
            Abs => self.abs(),
            Sign => self.step(Sign.evaluator()),
            Floor => self.step(libm::floor),
            Ceil => self.step(libm::ceil),
            Round => self.step(libm::round),
            Trunc => self.step(libm::trunc),
            Fract => self.fract(),
            Erf => {
                // The slope at zero is 2/√π.
                let first = Interval::rounded(FRAC_2_SQRT_PI) * exponential(-t.square());
                let value = t.rising(libm::erf).meet(Interval::within(1.0));
                self.chain(value, first, -t.double() * first, Class::Smooth)
            }
            Sinc | J0 | J1 | Y0 | Y1 | Gamma => self.by_mean_value(function),
        }
    }

    fn tangent(self) -> Self {
        let t = self.value;
        if has_quarter(t, 1) || has_quarter(t, 3) {
            return Self::of_values(Interval::ALL, self.class.min(Class::Partial));
        }
        let value = t.rising(libm::tan);
        let first = ONE + value.square();
        self.chain(value, first, value.double() * first, Class::Smooth)
    }

    fn arcsine(self) -> Self {
        let t = self.value;
        let Some((inside, class)) = self.within_one() else { return Self::NOWHERE };
        let square = (ONE - t) * (ONE + t);
        let first = square.sqrt().recip();
        let second = t * first.over(square);
        self.chain(inside.rising(libm::asin), first, second, class)
    }

    fn arccosine(self) -> Self {
        let t = self.value;
        let Some((inside, class)) = self.within_one() else { return Self::NOWHERE };
        let square = (ONE - t) * (ONE + t);
        let first = -square.sqrt().recip();
        let second = t * first.over(square);
        self.chain(inside.falling(libm::acos), first, second, class)
    }

    /// What lies from −1 to 1, and how well functions behave there that end there.
    fn within_one(self) -> Option<(Interval, Class)> {
        let (t, range) = (self.value, Interval::within(1.0));
        let class = if t.low > -1.0 && t.high < 1.0 {
            Class::Smooth
        } else if t.low >= -1.0 && t.high <= 1.0 {
            Class::Continuous
        } else {
            Class::Partial
        };
        t.overlaps(range).then(|| (t.meet(range), class))
    }

    fn hyperbolic_arccosine(self) -> Self {
        let t = self.value;
        if t.high < 1.0 {
            return Self::NOWHERE;
        }
        let class = match t.low {
            low if low > 1.0 => Class::Smooth,
            1.0 => Class::Continuous,
            _ => Class::Partial,
        };
        let square = (t - ONE) * (t + ONE);
        let first = square.sqrt().recip();
        let inside = Interval::new(t.low.max(1.0), t.high);
        self.chain(inside.rising(libm::acosh), first, -t * first.over(square), class)
    }

    fn hyperbolic_arctangent(self) -> Self {
        let t = self.value;
        if t.low >= 1.0 || t.high <= -1.0 {
            return Self::NOWHERE;
        }
        let is_inside = t.low > -1.0 && t.high < 1.0;
        let class = if is_inside { Class::Smooth } else { Class::Partial };
        let first = ((ONE - t) * (ONE + t)).recip();
        let inside = t.meet(Interval::within(1.0));
        let second = t.double() * first.square();
        self.chain(inside.rising(libm::atanh), first, second, class)
    }

    fn square_root(self) -> Self {
        let t = self.value;
        if t.high < 0.0 {
            return Self::NOWHERE;
        }
        let class = match t.low {
            low if low > 0.0 => Class::Smooth,
            0.0 => Class::Continuous,
            _ => Class::Partial,
        };
        let value = t.sqrt();
        let first = value.double().recip();
        // −1/(4 g³) = −g'/(2 g²).
        let second = (-first).over(value.square().double());
        self.chain(value, first, second, class)
    }

    /// A logarithm, the natural one divided by `scale`.
    pub(super) fn logarithm(self, scale: Interval, function: fn(f64) -> f64) -> Self {
        let t = self.value;
        if t.high <= 0.0 {
            return Self::NOWHERE;
        }
        if t.low <= 0.0 {
            let high = t.high.min(f64::MAX);
            let value =
                Interval::new(f64::NEG_INFINITY, Interval::point(high).rising(function).high);
            return Self::of_values(value, self.class.min(Class::Partial));
        }
        let first = (t * scale).recip();
        self.chain(t.rising(function), first, -first.over(t), Class::Smooth)
    }
}

/// Powers of e. They are never zero, although numbers may be.
pub(super) fn exponential(t: Interval) -> Interval {
    let [low, high] = [t.low, t.high].map(libm::exp);
    Interval::new(low.next_down().next_down().max(0.0), high.next_up().next_up())
}

fn hyperbolic_cosine(t: Interval) -> Interval {
    let [low, high] = [t.smallest(), t.largest()].map(libm::cosh);
    Interval::new(low.next_down().next_down().max(1.0), high.next_up().next_up())
}

pub(super) fn sine(t: Interval) -> Interval {
    wave(t, libm::sin, 1, 3)
}

pub(super) fn cosine(t: Interval) -> Interval {
    wave(t, libm::cos, 0, 2)
}

/// The values of a wave that is 1 after `top` quarter turns and −1 after `bottom`.
fn wave(t: Interval, function: fn(f64) -> f64, top: i64, bottom: i64) -> Interval {
    if t.largest() >= MOST_QUARTERS {
        return Interval::within(1.0);
    }
    let ends =
        Interval::point(t.low).rising(function).hull(Interval::point(t.high).rising(function));
    let low = if has_quarter(t, bottom) { -1.0 } else { ends.low.max(-1.0) };
    let high = if has_quarter(t, top) { 1.0 } else { ends.high.min(1.0) };
    Interval::new(low, high)
}

/// Whether some number of `t` may be `quarter` quarter turns and some whole turns.
fn has_quarter(t: Interval, quarter: i64) -> bool {
    if t.largest() >= MOST_QUARTERS {
        return true;
    }
    // Rounded twice, so off by less than this part.
    let margin = |turns: f64| turns.abs() * (4.0 * f64::EPSILON);
    let (low, high) = (t.low * FRAC_2_PI, t.high * FRAC_2_PI);
    let first = libm::ceil(low - margin(low)) as i64;
    let last = libm::floor(high + margin(high)) as i64;
    first + (quarter - first).rem_euclid(4) <= last
}
