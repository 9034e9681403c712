//! What is known about an axis before ticks are chosen.

use super::numbers::Unit;

/// A range of heights grows to the next tick by at most this part of it at each end.
pub(super) const MOST_GROWTH: f64 = 0.1;

/// The values that an axis is for.
#[derive(Debug, Clone, Copy)]
pub(in crate::axes) struct AxisRange {
    /// The smaller value first.
    pub(in crate::axes) low: f64,
    pub(in crate::axes) high: f64,
    pub(in crate::axes) is_log: bool,
    /// Whether the range may grow to the next ticks outside of it.
    pub(in crate::axes) may_grow: bool,
    /// Whether all numbers of more than three digits share a power of ten.
    pub(in crate::axes) saves_digits: bool,
}

impl AxisRange {
    pub(super) fn has_ticks(&self) -> bool {
        let is_range = self.low < self.high && (self.high - self.low).is_finite();
        is_range && (!self.is_log || self.low > 0.0)
    }

    /// The first and the last multiple of a unit in the range, or a little outside of it if it may
    /// grow, of those that are `start` more than a multiple of `every`. `None` if multiples are too
    /// many to be distinguished.
    pub(super) fn indices(&self, unit: Unit, every: i64, start: i64) -> Option<(i64, i64)> {
        /// Whole numbers above this are not all exact when multiplied by a unit.
        const MOST: f64 = 1e12;
        let size = unit.value(1);
        let (from, to) = (libm::ceil(self.low / size), libm::floor(self.high / size));
        if !(from.abs() < MOST && to.abs() < MOST && size > 0.0) {
            return None;
        }
        // Division rounds, so that a tick at the very end may seem to be outside, or one outside of it
        // to be at the end.
        let (mut first, mut last) = (from as i64 - 1, to as i64 + 1);
        while unit.value(first) < self.low {
            first += 1;
        }
        while unit.value(last) > self.high {
            last -= 1;
        }
        first += (start - first).rem_euclid(every);
        last -= (last - start).rem_euclid(every);
        if self.may_grow {
            let growth = MOST_GROWTH * (self.high - self.low);
            let (below, above) = (unit.value(first - every), unit.value(last + every));
            if unit.value(first) > self.low && self.low - below <= growth {
                first -= every;
            }
            if unit.value(last) < self.high && above - self.high <= growth {
                last += every;
            }
        }
        Some((first, last))
    }
}
