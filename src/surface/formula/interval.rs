//! Intervals whose ends are rounded outwards, so that they enclose the real result of each operation.
//!
//! Sums, products, quotients and square roots are correctly rounded: one number further out encloses the
//! real result. Functions of `libm` are off by less than one unit in the last place: two numbers further
//! out enclose theirs. A product of zero and infinity is zero, as each interval stands for finite numbers
//! only. Zeros have no sign here.

use std::ops::{Add, Mul, Neg, Sub};

/// All numbers from `low` to `high`; unbounded where these are infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The least number.
    pub low: f64,
    /// The greatest number.
    pub high: f64,
}

impl Interval {
    /// All numbers.
    pub const ALL: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
    /// Zero alone.
    pub const ZERO: Self = Self { low: 0.0, high: 0.0 };
    /// One alone.
    pub const ONE: Self = Self { low: 1.0, high: 1.0 };

    /// The numbers from `low` to `high`. Not a number stands for no bound.
    #[inline]
    pub fn new(low: f64, high: f64) -> Self {
        let low = if low.is_nan() { f64::NEG_INFINITY } else { low };
        let high = if high.is_nan() { f64::INFINITY } else { high };
        Self { low, high }
    }

    /// One number.
    pub fn point(value: f64) -> Self {
        Self::new(value, value)
    }

    /// A constant that was rounded to the nearest number.
    pub fn rounded(constant: f64) -> Self {
        Self::new(constant.next_down(), constant.next_up())
    }

    /// From −`size` to `size`.
    pub fn within(size: f64) -> Self {
        Self::new(-size, size)
    }

    /// Whether a number is in it.
    pub fn contains(self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// Whether both ends are finite.
    #[inline]
    pub fn is_bounded(self) -> bool {
        self.low > f64::NEG_INFINITY && self.high < f64::INFINITY
    }

    /// Whether it is one number.
    pub fn is_point(self) -> bool {
        self.low == self.high
    }

    /// The greatest absolute value.
    #[inline]
    pub fn largest(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// The least absolute value.
    pub fn smallest(self) -> f64 {
        if self.contains(0.0) { 0.0 } else { self.low.abs().min(self.high.abs()) }
    }

    /// The distance between its ends, rounded up.
    pub fn width(self) -> f64 {
        (self.high - self.low).next_up()
    }

    /// A number in it, about in the middle; it must be bounded.
    pub fn middle(self) -> f64 {
        (0.5 * self.low + 0.5 * self.high).clamp(self.low, self.high)
    }

    /// The smallest interval around both.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// What is in both; they must overlap.
    #[must_use]
    pub fn meet(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.min(other.high) }
    }

    /// Whether some number is in both.
    pub fn overlaps(self, other: Self) -> bool {
        self.low <= other.high && other.low <= self.high
    }

    /// The squares of its numbers.
    #[must_use]
    pub fn square(self) -> Self {
        let (low, high) = (self.smallest(), self.largest());
        Self::new(product_down(low, low), product_up(high, high))
    }

    /// Twice its numbers, exactly.
    #[must_use]
    pub fn double(self) -> Self {
        Self::new(2.0 * self.low, 2.0 * self.high)
    }

    /// Its numbers times one number.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        self * Self::point(factor)
    }

    /// The reciprocals of its numbers; of one that only ends at zero, those of the others.
    #[must_use]
    pub fn recip(self) -> Self {
        if self.low < 0.0 && self.high > 0.0 || self == Self::ZERO {
            return Self::ALL;
        }
        let low = if self.high == 0.0 { f64::NEG_INFINITY } else { (1.0 / self.high).next_down() };
        let high = if self.low == 0.0 { f64::INFINITY } else { (1.0 / self.low).next_up() };
        // A reciprocal has the sign of its number.
        if self.low >= 0.0 { Self::new(low.max(0.0), high) } else { Self::new(low, high.min(0.0)) }
    }

    /// The quotients of its numbers by others; if the divisor only ends at zero, those by its others.
    #[must_use]
    pub fn over(self, divisor: Self) -> Self {
        if divisor.low < 0.0 && divisor.high > 0.0 || divisor == Self::ZERO {
            return Self::ALL;
        }
        let is_bounded = self.is_bounded() && divisor.is_bounded();
        if divisor.low == 0.0 || divisor.high == 0.0 || !is_bounded {
            return self * divisor.recip();
        }
        let all = [
            (self.low, divisor.low),
            (self.low, divisor.high),
            (self.high, divisor.low),
            (self.high, divisor.high),
        ];
        let down = |(a, b): (f64, f64)| if a == 0.0 { 0.0 } else { (a / b).next_down() };
        let up = |(a, b): (f64, f64)| if a == 0.0 { 0.0 } else { (a / b).next_up() };
        let (low, high) = (all.map(down), all.map(up));
        Self::new(
            low[0].min(low[1]).min(low[2].min(low[3])),
            high[0].max(high[1]).max(high[2].max(high[3])),
        )
    }

    /// The square roots of what is not negative in it.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let low = self.low.max(0.0).sqrt();
        let high = self.high.max(0.0).sqrt();
        Self::new(down(low, 1).max(0.0), up(high, 1))
    }

    /// The values of a function of `libm` that never decreases, and is zero at zero if anywhere exactly.
    #[must_use]
    pub fn rising(self, function: fn(f64) -> f64) -> Self {
        Self::new(down(function(self.low), 2), up(function(self.high), 2))
    }

    /// The values of a function of `libm` that never increases.
    #[must_use]
    pub fn falling(self, function: fn(f64) -> f64) -> Self {
        Self::new(
            function(self.high).next_down().next_down(),
            function(self.low).next_up().next_up(),
        )
    }

    /// Its numbers moved outwards by up to `error`.
    #[must_use]
    pub fn widened(self, error: f64) -> Self {
        Self::new((self.low - error).next_down(), (self.high + error).next_up())
    }
}

/// `steps` numbers further down. Zero stays: sums and functions are zero only if that is exact.
#[inline]
fn down(value: f64, steps: u32) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    (0..steps).fold(value, |value, _| value.next_down())
}

/// `steps` numbers further up; see [`down`].
#[inline]
fn up(value: f64, steps: u32) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    (0..steps).fold(value, |value, _| value.next_up())
}

#[inline]
fn product_down(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { (a * b).next_down() }
}

#[inline]
fn product_up(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { (a * b).next_up() }
}

impl Add for Interval {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        // Adding zero rounds nothing, and sums of small numbers are exact, those that are zero above all.
        if other == Self::ZERO {
            return self;
        }
        if self == Self::ZERO {
            return other;
        }
        Self::new(down(self.low + other.low, 1), up(self.high + other.high, 1))
    }
}

impl Neg for Interval {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl Sub for Interval {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        if self == Self::ZERO || other == Self::ZERO {
            return Self::ZERO;
        }
        let (a, b) = (self, other);
        if a.low >= 0.0 && b.low >= 0.0 {
            return Self::new(product_down(a.low, b.low), product_up(a.high, b.high));
        }
        let low = [product_down(a.low, b.low), product_down(a.low, b.high)];
        let low =
            [low[0].min(low[1]), product_down(a.high, b.low).min(product_down(a.high, b.high))];
        let high = [product_up(a.low, b.low), product_up(a.low, b.high)];
        let high =
            [high[0].max(high[1]), product_up(a.high, b.low).max(product_up(a.high, b.high))];
        Self::new(low[0].min(low[1]), high[0].max(high[1]))
    }
}
