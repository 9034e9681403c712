//! Ticks at even distances.

use super::numbers::Unit;
use super::range::AxisRange;

/// Ticks that an axis could have.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::axes) struct Ticks {
    /// Values with their numbers, in rising order.
    pub(in crate::axes) majors: Vec<(f64, String)>,
    /// Values without numbers between them, in rising order.
    pub(in crate::axes) minors: Vec<f64>,
    /// The power of ten that all numbers are multiplied by.
    pub(in crate::axes) exponent: Option<i32>,
    /// Whether they are powers of ten, each with the next.
    pub(in crate::axes) is_decades: bool,
    /// The range that includes all of them.
    pub(in crate::axes) range: (f64, f64),
}

/// Ticks at every n-th multiple of a unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spacing {
    pub(super) unit: Unit,
    pub(super) first: i64,
    pub(super) last: i64,
    pub(super) every: i64,
    /// Into how many parts minor ticks divide the distance between two.
    pub(super) parts: i64,
    /// How good the ticks are; see `round`.
    pub(super) score: f64,
}

impl Spacing {
    pub(super) fn ticks(&self, range: &AxisRange) -> Ticks {
        let Self { unit, first, last, every, parts, .. } = *self;
        let indices: Vec<i64> = (0..=(last - first) / every).map(|k| first + k * every).collect();
        let (labels, exponent) = unit.labels(&indices, range.saves_digits);
        let values = indices.iter().map(|&k| unit.value(k));
        let majors: Vec<(f64, String)> = values.zip(labels).collect();
        let (from, to) = (unit.value(first), unit.value(last));
        let (low, high) = (range.low.min(from), range.high.max(to));
        let step = unit.value(1) * every as f64 / parts as f64;
        let n_before = libm::floor((from - low) / step).max(0.0) as i64;
        let n_after = libm::floor((high - from) / step).max(0.0) as i64;
        let is_minor = |k: &i64| parts > 1 && k.rem_euclid(parts) != 0;
        let minors = (-n_before..=n_after).filter(is_minor).map(|k| from + step * k as f64);
        let minors = minors.filter(|value| low <= *value && *value <= high).collect();
        Ticks { majors, minors, exponent, is_decades: false, range: (low, high) }
    }
}
