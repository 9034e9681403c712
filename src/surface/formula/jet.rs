//! Enclosures of a function's value and of its first two derivatives along a direction, over a box.
//!
//! ```text
//!   value  ∋ f                        first  ∋ ∂f/∂w · |w|        w: the direction in the plane of the
//!   second ∋ ∂²f/∂w² · |w|²                                       two variables
//! ```
//!
//! Every operation has a rule: `g(f)` has the derivatives `g'·f'` and `g''·f'² + g'·f''`. What an enclosure
//! is good for is said by its [`Class`], the lesser of those of the operands and of the operation. The
//! classes correspond to the decorations of IEEE 1788-2015: com, dac, def, trv and ill-formed or empty.

mod choice;
mod elementary;
mod mean_value;
mod plane;
mod power;

pub(super) use choice::Comparison;

use super::interval::Interval;

/// How well a function behaves on a box; a later class implies all earlier ones but the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// It has no finite value anywhere.
    Nowhere,
    /// It may lack a finite value somewhere; what values there are lie in `value`.
    Partial,
    /// It has a value everywhere and may jump.
    Defined,
    /// It is continuous; slopes may be infinite.
    Continuous,
    /// It may have kinks; `first` encloses the slopes on both sides of each.
    Lipschitz,
    /// It is twice continuously differentiable, and `second` holds.
    Smooth,
}

/// Enclosures of a value and of two derivatives along a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet {
    /// The values.
    pub value: Interval,
    /// The first derivatives, from class [`Class::Lipschitz`] on.
    pub first: Interval,
    /// The second derivatives, in class [`Class::Smooth`].
    pub second: Interval,
    /// How smooth the function is, and so which of these enclosures are valid.
    pub class: Class,
}

impl Jet {
    /// A function without a value.
    pub(super) const NOWHERE: Self = Self {
        value: Interval::ALL,
        first: Interval::ALL,
        second: Interval::ALL,
        class: Class::Nowhere,
    };

    /// One number everywhere.
    pub(super) fn constant(value: f64) -> Self {
        if !value.is_finite() {
            return Self::NOWHERE;
        }
        Self::level(Interval::point(value))
    }

    /// A constant function with a value in an interval.
    fn level(value: Interval) -> Self {
        Self { value, first: Interval::ZERO, second: Interval::ZERO, class: Class::Smooth }
    }

    /// A variable over a range, with this part of the direction.
    pub(super) fn variable(range: Interval, direction: f64) -> Self {
        Self { first: Interval::point(direction), ..Self::level(range) }
    }

    /// Only values are known.
    fn of_values(value: Interval, class: Class) -> Self {
        Self { value, first: Interval::ALL, second: Interval::ALL, class }
    }

    /// The same with a class that is no better than this one.
    fn at_most(self, class: Class) -> Self {
        Self { class: self.class.min(class), ..self }
    }

    /// A function of this one, from its values and derivatives over the values here.
    fn chain(self, value: Interval, first: Interval, second: Interval, class: Class) -> Self {
        let class = self.class.min(class);
        if class < Class::Lipschitz {
            return Self::of_values(value, class);
        }
        Self {
            value,
            first: first * self.first,
            second: second * self.first.square() + first * self.second,
            class,
        }
    }

    /// Values that are too large for a number are none.
    pub(super) fn checked(self) -> Self {
        if self.value.is_bounded() { self } else { self.at_most(Class::Partial) }
    }

    pub(super) fn negate(self) -> Self {
        Self { value: -self.value, first: -self.first, second: -self.second, ..self }
    }

    /// A multiple.
    pub(super) fn times(self, factor: f64) -> Self {
        let scaled = |interval: Interval| interval.times(factor);
        match factor {
            1.0 => self,
            -1.0 => self.negate(),
            _ => Self {
                value: scaled(self.value),
                first: scaled(self.first),
                second: scaled(self.second),
                ..self
            },
        }
    }

    pub(super) fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            first: self.first + other.first,
            second: self.second + other.second,
            class: self.class.min(other.class),
        }
    }

    pub(super) fn multiply(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            first: self.first * other.value + self.value * other.first,
            second: self.second * other.value
                + self.value * other.second
                + (self.first * other.first).double(),
            class: self.class.min(other.class),
        }
    }

    pub(super) fn square(self) -> Self {
        Self {
            value: self.value.square(),
            first: (self.value * self.first).double(),
            second: (self.first.square() + self.value * self.second).double(),
            class: self.class,
        }
    }

    pub(super) fn divide(self, by: Self) -> Self {
        if by.value == Interval::ZERO {
            return Self::NOWHERE;
        }
        let class = self.class.min(by.class);
        let value = self.value.over(by.value);
        if by.value.contains(0.0) {
            return Self::of_values(value, class.min(Class::Partial));
        }
        // From f = q·g: q' = (f' − q·g')/g and q'' = (f'' − 2·q'·g' − q·g'')/g.
        let first = (self.first - value * by.first).over(by.value);
        let second = self.second - (first * by.first).double() - value * by.second;
        Self { value, first, second: second.over(by.value), class }
    }
}
