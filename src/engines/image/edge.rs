//! Which pixel centers are right of an edge: the half of the pixel rule that is about borders.
//!
//! ```text
//!          a ●                 the edge meets the rows whose centers have
//!     ·   ·  │╲·   ·   ·       a.y ≤ y < b.y; in each it gives the column of
//!     ·   ·   ·╲  (x)  ·       the first center on it or right of it, here x;
//!     ·   ·   · │ ·   ·        a triangle covers the columns from the one of its
//!               ● b            left edge up to the one before its right edge's.
//! ```
//!
//! A border that two triangles share is the same edge for both, so one begins where the other ends: no
//! pixel is missed and none is covered twice.

use std::ops::Range;

use glam::DVec2;

use crate::predicates::{Sign, orient2d};

/// An edge in pixels that runs downward.
#[derive(Debug, Clone, Copy)]
pub struct PixelEdge {
    upper: DVec2,
    lower: DVec2,
    /// Columns per row.
    slope: f64,
}

impl PixelEdge {
    /// The edge between two points; `None` if it is horizontal, since it meets no row then.
    #[inline]
    pub fn new(a: DVec2, b: DVec2) -> Option<Self> {
        let (upper, lower) = if a.y < b.y { (a, b) } else { (b, a) };
        (upper.y < lower.y).then(|| {
            let d = lower - upper;
            Self { upper, lower, slope: d.x / d.y }
        })
    }

    /// The rows that meet the edge, of those in `within`.
    #[inline]
    pub fn rows(&self, within: &Range<u32>) -> Range<u32> {
        // Subtracting ½ is exact wherever the result is near an integer that matters.
        let from = first_center(self.upper.y, within.end).max(within.start);
        let to = first_center(self.lower.y, within.end).max(from);
        from..to
    }

    /// Whether the line through the centers of a row meets the edge.
    #[inline]
    pub fn meets(&self, row: u32) -> bool {
        let y = center(row);
        self.upper.y <= y && y < self.lower.y
    }

    /// Columns per row.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// Where the edge meets the line through the centers of a row, rounded.
    #[inline]
    pub fn estimate(&self, row: u32) -> f64 {
        self.upper.x + (center(row) - self.upper.y) * self.slope
    }

    /// The first column whose center is on the edge or right of it, at most `width`.
    #[inline]
    pub fn column(&self, row: u32, width: u32) -> u32 {
        let estimate = self.estimate(row);
        // The slope and the distance down have relative errors of 2 ε each, their product one more; it
        // is at most |Δx|, and the sum is rounded once: below 7 ε (|x₁| + |x₂|). The 1 covers
        // underflow.
        let error = 8.0 * f64::EPSILON * (self.upper.x.abs() + self.lower.x.abs() + 1.0);
        let column = first_center(estimate, width);
        let to_right = center(column) - estimate;
        if error < to_right && to_right < 1.0 - error {
            return column;
        }
        self.column_near(row, estimate, width)
    }

    /// The same, where the edge is known to meet the row at about `estimate`: the answer does not
    /// depend on it.
    #[inline]
    pub fn column_near(&self, row: u32, estimate: f64, width: u32) -> u32 {
        let has_on_right = |column| self.has_on_right(column, row);
        let start = first_center(estimate, width);
        // The answer is one of low..=high; steps away from the estimate double.
        let (mut low, mut high) = (start, start);
        let mut step = 1;
        if start > 0 && has_on_right(start - 1) {
            high = start - 1;
            low = 0;
            while high > 0 {
                let probe = high.saturating_sub(step);
                if !has_on_right(probe) {
                    low = probe + 1;
                    break;
                }
                high = probe;
                step = step.saturating_mul(2);
            }
        } else {
            while low < width && !has_on_right(high.min(width - 1)) {
                low = high.min(width - 1) + 1;
                high = low.saturating_add(step).min(width);
                step = step.saturating_mul(2);
            }
        }
        while low < high {
            let middle = low + (high - low) / 2;
            if has_on_right(middle) {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        low
    }

    /// Whether a pixel's center is on the edge's line or right of it. Exact.
    #[inline]
    pub fn has_on_right(&self, column: u32, row: u32) -> bool {
        let center = DVec2::new(center(column), center(row));
        // With y downward, points right of an edge that runs down make a negative turn.
        orient2d(self.upper, self.lower, center) != Sign::Positive
    }
}

/// The coordinate of the center of a pixel.
#[inline]
pub fn center(pixel: u32) -> f64 {
    f64::from(pixel) + 0.5
}

/// The first pixel whose center is at `x` or above, at most `end`.
#[inline]
pub fn first_center(x: f64, end: u32) -> u32 {
    // The cast rounds toward 0 and turns negative numbers and NaN into 0.
    let below = (x - 0.5) as u32;
    below.saturating_add(u32::from(x - 0.5 > f64::from(below))).min(end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_column_does_not_depend_on_the_estimate() {
        let width = 37;
        for (a, b) in [
            (DVec2::new(3.5, 0.0), DVec2::new(3.5, 9.0)),
            (DVec2::new(-40.0, -3.0), DVec2::new(80.0, 12.0)),
            (DVec2::new(90.0, -2.0), DVec2::new(-7.25, 11.0)),
            (DVec2::new(500.0, 0.0), DVec2::new(400.0, 9.0)),
            (DVec2::new(-5.0, 0.0), DVec2::new(-1.0, 9.0)),
        ] {
            let edge = PixelEdge::new(a, b).expect("not level");
            for row in 0..9 {
                let column = (0..width).find(|&column| edge.has_on_right(column, row));
                let column = column.unwrap_or(width);
                for estimate in [f64::NAN, -1e300, -0.5, 0.0, 1.5, 17.0, 36.0, 37.5, 40.0, 1e300] {
                    assert_eq!(edge.column_near(row, estimate, width), column, "{row} {estimate}");
                }
            }
        }
    }

    /// Edges through a center up to rounding: the estimate alone errs on both sides.
    #[test]
    fn edges_that_nearly_meet_a_center_give_the_exact_column() {
        let mut state = 5u64;
        let mut part = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let (width, mut n_corrected) = (64, 0);
        for _ in 0..20_000 {
            let (column, row) = ((part() * 60.0) as u32 + 1, (part() * 8.0) as u32);
            let way = DVec2::new(40.0 * part() - 20.0, 1.0 + 9.0 * part());
            let at = DVec2::new(center(column), center(row));
            let edge = PixelEdge::new(at - way * part(), at + way * part()).expect("not level");
            let expected = (0..width).find(|&column| edge.has_on_right(column, row));
            n_corrected +=
                u32::from(first_center(edge.estimate(row), width) != expected.unwrap_or(width));
            assert_eq!(edge.column(row, width), expected.unwrap_or(width), "{edge:?}, {row}");
        }
        assert!(n_corrected > 100, "only {n_corrected} estimates were off");
    }
}
