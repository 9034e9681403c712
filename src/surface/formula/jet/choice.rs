//! Functions in pieces: steps, remainders, extremes, comparisons and conditions.

use super::super::interval::Interval;
use super::{Class, Jet};

/// A truth value: certain, or not.
enum Truth {
    Yes,
    No,
    Unknown,
}

/// What both orders of a comparison come to.
#[derive(Clone, Copy)]
pub(crate) enum Comparison {
    Less,
    LessOrEqual,
    Equal,
}

impl Jet {
    /// A function that is constant between the numbers where it jumps upward.
    pub(crate) fn step(self, function: fn(f64) -> f64) -> Self {
        let (low, high) = (function(self.value.low), function(self.value.high));
        // The argument may jump as long as this keeps its value.
        let class = if low == high { Class::Smooth } else { Class::Defined };
        let of_argument = if self.class >= Class::Defined { class } else { self.class };
        Self { class: of_argument, ..Self::level(Interval::new(low, high)) }
    }

    /// The part of it after the point, which is at least 0.
    pub(crate) fn fract(self) -> Self {
        let floor = self.step(libm::floor);
        if floor.value.is_point() {
            return Self { value: self.value - floor.value, ..self };
        }
        Self::of_values(Interval::new(0.0, 1.0), self.class.min(Class::Defined))
    }

    /// The remainder, with the sign of the divisor.
    pub(crate) fn modulo(self, divisor: Self) -> Self {
        if divisor.value == Interval::ZERO {
            return Self::NOWHERE;
        }
        let class = self.class.min(divisor.class);
        if divisor.value.contains(0.0) {
            let range = divisor.value.hull(Interval::ZERO);
            return Self::of_values(range, class.min(Class::Partial));
        }
        let times = self.divide(divisor).step(libm::floor).value;
        if times.is_point() && times.is_bounded() {
            return self.add(divisor.multiply(Self::level(times)).negate());
        }
        let range = divisor.value.hull(Interval::ZERO);
        Self::of_values(range, class.min(Class::Defined))
    }

    pub(crate) fn abs(self) -> Self {
        if self.value.low >= 0.0 {
            return self;
        }
        if self.value.high <= 0.0 {
            return self.negate();
        }
        let other = self.negate();
        Self {
            value: Interval::new(0.0, self.value.largest()),
            first: self.first.hull(other.first),
            second: self.second.hull(other.second),
            class: self.class.min(Class::Lipschitz),
        }
    }

    pub(crate) fn least(self, other: Self) -> Self {
        let (a, b) = (self.value, other.value);
        let value = Interval::new(a.low.min(b.low), a.high.min(b.high));
        self.one_of(other, a.high < b.low, b.high < a.low, value)
    }

    pub(crate) fn greatest(self, other: Self) -> Self {
        self.negate().least(other.negate()).negate()
    }

    /// This one or the other, continuously; not a number where either is none.
    fn one_of(self, other: Self, is_this: bool, is_other: bool, value: Interval) -> Self {
        let worst = self.class.min(other.class);
        if worst <= Class::Partial {
            return Self::of_values(value, worst);
        }
        if is_this {
            return self;
        }
        if is_other {
            return other;
        }
        Self {
            value,
            first: self.first.hull(other.first),
            second: self.second.hull(other.second),
            class: worst.min(Class::Lipschitz),
        }
    }

    /// 1 where the comparison is true, 0 where it is false. What is not a number compares as false.
    pub(crate) fn compare(self, other: Self, comparison: Comparison) -> Self {
        let (a, b) = (self.value, other.value);
        let worst = self.class.min(other.class);
        let (yes, no) = match comparison {
            Comparison::Less => (a.high < b.low, a.low >= b.high),
            Comparison::LessOrEqual => (a.high <= b.low, a.low > b.high),
            Comparison::Equal => (a.is_point() && a == b, !a.overlaps(b)),
        };
        Self::truth(if no || worst == Class::Nowhere {
            Truth::No
        } else if yes && worst >= Class::Defined {
            Truth::Yes
        } else {
            Truth::Unknown
        })
    }

    fn truth(truth: Truth) -> Self {
        match truth {
            Truth::Yes => Self::level(Interval::ONE),
            Truth::No => Self::level(Interval::ZERO),
            Truth::Unknown => Self::of_values(Interval::new(0.0, 1.0), Class::Defined),
        }
    }

    /// Whether it is true as a condition: neither zero nor no number.
    fn holds(self) -> Truth {
        if self.class == Class::Nowhere || self.value == Interval::ZERO {
            Truth::No
        } else if self.class >= Class::Defined && !self.value.contains(0.0) {
            Truth::Yes
        } else {
            Truth::Unknown
        }
    }

    pub(crate) fn not(self) -> Self {
        Self::truth(match self.holds() {
            Truth::Yes => Truth::No,
            Truth::No => Truth::Yes,
            Truth::Unknown => Truth::Unknown,
        })
    }

    pub(crate) fn and(self, other: Self) -> Self {
        Self::truth(match (self.holds(), other.holds()) {
            (Truth::Yes, Truth::Yes) => Truth::Yes,
            (Truth::No, _) | (_, Truth::No) => Truth::No,
            _ => Truth::Unknown,
        })
    }

    pub(crate) fn or(self, other: Self) -> Self {
        self.not().and(other.not()).not()
    }

    /// `yes` where this holds, else `no`.
    pub(crate) fn select(self, yes: Self, no: Self) -> Self {
        match self.holds() {
            Truth::Yes => yes,
            Truth::No => no,
            Truth::Unknown => {
                let worst = yes.class.min(no.class);
                let class = if worst > Class::Partial {
                    Class::Defined
                } else if yes.class == no.class {
                    worst
                } else {
                    Class::Partial
                };
                let value = match (yes.class, no.class) {
                    (Class::Nowhere, _) => no.value,
                    (_, Class::Nowhere) => yes.value,
                    _ => yes.value.hull(no.value),
                };
                Self::of_values(value, class)
            }
        }
    }
}
