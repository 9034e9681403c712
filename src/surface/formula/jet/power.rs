//! Powers, by whole and by other exponents.

use super::super::interval::Interval;
use super::{Class, Jet};

/// Whole exponents up to this size have rules of their own; every power of a number is zero, one or
/// infinite long before.
const LARGEST_WHOLE: f64 = 1e6;

impl Jet {
    pub(crate) fn power(self, exponent: Self) -> Self {
        let p = exponent.value.low;
        if !exponent.value.is_point() || exponent.first != Interval::ZERO {
            return self.power_of_both(exponent);
        }
        if p == 0.0 {
            // Even of what is not a number, as `pow` has it.
            return Self::constant(1.0);
        }
        if p == 1.0 {
            return self;
        }
        if p == 2.0 {
            return self.square();
        }
        if p == libm::trunc(p) && p.abs() <= LARGEST_WHOLE {
            return if p > 0.0 {
                self.whole_power(p)
            } else {
                Self::constant(1.0).divide(self.whole_power(-p))
            };
        }
        self.fractional_power(p)
    }

    /// By a whole exponent above 0.
    fn whole_power(self, n: f64) -> Self {
        let p = |exponent: f64| whole(self.value, exponent);
        let second = if n < 2.0 { Interval::ZERO } else { p(n - 2.0).times(n * (n - 1.0)) };
        self.chain(p(n), p(n - 1.0).times(n), second, Class::Smooth)
    }

    /// By an exponent that is not whole.
    fn fractional_power(self, p: f64) -> Self {
        let t = self.value;
        if t.high < 0.0 || t.high == 0.0 && p < 0.0 {
            return Self::NOWHERE;
        }
        let above = Interval::new(t.low.max(0.0), t.high);
        let value = of_corners(above, Interval::point(p));
        let class = match t.low {
            low if low > 0.0 => Class::Smooth,
            low if low < 0.0 || p < 0.0 => Class::Partial,
            _ if p >= 2.0 => Class::Smooth,
            _ if p >= 1.0 => Class::Lipschitz,
            _ => Class::Continuous,
        };
        let factor = Interval::point(p) * (Interval::point(p) - Interval::ONE);
        let second = factor * raised(above, p, 2.0);
        let first = raised(above, p, 1.0);
        self.chain(value, first.times(p), second, class)
    }

    /// Base and exponent both vary: exp(b · ln a).
    fn power_of_both(self, exponent: Self) -> Self {
        let (a, b) = (self.value, exponent.value);
        let class = self.class.min(exponent.class);
        if a.low < 0.0 || a.low == 0.0 && b.low <= 0.0 {
            return Self::of_values(Interval::ALL, class.min(Class::Partial));
        }
        let value = of_corners(a, b);
        if a.low == 0.0 {
            return Self::of_values(value, class.min(Class::Continuous));
        }
        let log = exponent.multiply(self.logarithm(Interval::ONE, libm::log));
        Self {
            value,
            first: value * log.first,
            second: value * (log.second + log.first.square()),
            class,
        }
    }
}

/// A whole power, n ≥ 0, of an interval.
fn whole(t: Interval, n: f64) -> Interval {
    if n == 0.0 {
        return Interval::ONE;
    }
    if n == 1.0 {
        return t;
    }
    if n == 2.0 {
        return t.square();
    }
    let at = |t: f64| of_corners(Interval::point(t.abs()), Interval::point(n));
    let is_even = libm::fmod(n, 2.0) == 0.0;
    let signed = |t: f64| if t < 0.0 && !is_even { -at(t) } else { at(t) };
    if is_even && t.contains(0.0) {
        return Interval::new(0.0, at(t.largest()).high);
    }
    signed(t.low).hull(signed(t.high))
}

/// Powers of numbers that are not negative: they have their extremes at the corners.
fn of_corners(a: Interval, b: Interval) -> Interval {
    let all = [(a.low, b.low), (a.low, b.high), (a.high, b.low), (a.high, b.high)];
    let powers = all.map(|(a, b)| libm::pow(a, b));
    let low = powers.into_iter().fold(f64::INFINITY, f64::min);
    let high = powers.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let high = if a.high == 0.0 { high } else { high.next_up().next_up() };
    Interval::new(low.next_down().next_down().max(0.0), high)
}

/// Powers by `p − less`, a difference that may be rounded.
fn raised(a: Interval, p: f64, less: f64) -> Interval {
    of_corners(a, Interval::point(p) - Interval::point(less))
}
