//! Which part of the image is certainly covered: a quadtree of squares.
//!
//! ```text
//!   ┌───────┬───┬───┐    a square is covered when one convex polygon covers it, or when its four
//!   │       │   │ ▓ │    quarters are; along borders of polygons squares stay open, however
//!   │   ▓   ├───┼───┤    small, so an answer of "covered" is certain, one of "open" is not
//!   │       │ ▓ │ ▓ │
//!   ├───────┼───┴───┤
//! ```
//!
//! Source: lecture notes on visibility (Slovak), after Hearn and Baker: octants are visited from near
//! to far, and those whose image is in covered quadrants are left out with everything in them.

use glam::DVec2;

/// How often squares are quartered. Smaller faces cover finer squares, but each level doubles the
/// number of squares along borders.
pub const LEVELS: u32 = 9;

/// Squares count as covered, and rectangles as open, with a rim of this part of the smallest square, so
/// that rounding errors of the image smaller than this do no harm.
pub const RIM: f64 = 1.0 / 64.0;

const OPEN: u32 = u32::MAX;
const COVERED: u32 = u32::MAX - 1;

/// The covered part of a square of the image.
#[derive(Debug, Clone)]
pub struct Occupancy {
    low: DVec2,
    size: f64,
    rim: f64,
    root: u32,
    quarters: Vec<[u32; 4]>,
}

/// A square by its lower left corner.
#[derive(Clone, Copy)]
struct Square {
    low: DVec2,
    size: f64,
    level: u32,
}

impl Square {
    fn quarter(self, number: usize) -> Self {
        let size = self.size / 2.0;
        let step = DVec2::new((number & 1) as f64, (number >> 1) as f64);
        Self { low: self.low + step * size, size, level: self.level + 1 }
    }
}

impl Occupancy {
    /// The square around a rectangle, with nothing covered.
    pub fn new(low: DVec2, high: DVec2) -> Self {
        let size = (high - low).max_element();
        let size = if size.is_finite() && size > 0.0 { size } else { 1.0 };
        let rim = RIM * size / f64::from(1u32 << LEVELS);
        Self { low, size, rim, root: OPEN, quarters: Vec::new() }
    }

    /// The largest error that images may have.
    pub fn rim(&self) -> f64 {
        self.rim
    }

    /// The square of the image: its lower left corner and its side.
    pub fn square(&self) -> (DVec2, f64) {
        (self.low, self.size)
    }

    fn whole(&self) -> Square {
        Square { low: self.low, size: self.size, level: 0 }
    }

    /// Marks one of the smallest squares, by its column and row.
    pub fn cover_square(&mut self, column: usize, row: usize) {
        self.root = self.with_square(self.root, LEVELS, column, row);
    }

    fn with_square(&mut self, node: u32, levels_below: u32, column: usize, row: usize) -> u32 {
        if node == COVERED || levels_below == 0 {
            return COVERED;
        }
        let mut quarters = match node {
            OPEN => [OPEN; 4],
            _ => self.quarters[node as usize],
        };
        let level = levels_below - 1;
        let number = (column >> level & 1) | (row >> level & 1) << 1;
        quarters[number] = self.with_square(quarters[number], level, column, row);
        self.with_quarters(node, quarters)
    }

    /// A node with these quarters in place of `node`.
    fn with_quarters(&mut self, node: u32, quarters: [u32; 4]) -> u32 {
        if quarters == [COVERED; 4] {
            return COVERED;
        }
        if quarters == [OPEN; 4] {
            return node;
        }
        match node {
            OPEN => {
                self.quarters.push(quarters);
                self.quarters.len() as u32 - 1
            }
            _ => {
                self.quarters[node as usize] = quarters;
                node
            }
        }
    }

    /// Marks what a convex polygon covers; its corners run counter-clockwise.
    pub fn cover(&mut self, polygon: &[DVec2]) {
        let low = polygon.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = polygon.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let least = self.size / f64::from(1u32 << LEVELS);
        if polygon.len() >= 3 && (high - low).min_element() > least {
            self.root = self.covered(self.root, self.whole(), polygon);
        }
    }

    fn covered(&mut self, node: u32, square: Square, polygon: &[DVec2]) -> u32 {
        if node == COVERED {
            return COVERED;
        }
        let half = square.size / 2.0;
        let center = square.low + half;
        let (mut is_within, mut n_corners) = (true, polygon.len());
        for (i, &from) in polygon.iter().enumerate() {
            let to = polygon[(i + 1) % polygon.len()];
            let side = to - from;
            let reach = side.x.abs() + side.y.abs();
            let value = side.perp_dot(center - from);
            if value + reach * half <= 0.0 {
                return node;
            }
            is_within &= value > reach * (half + self.rim);
            n_corners -= usize::from(!value.is_finite());
        }
        if n_corners < polygon.len() {
            return node;
        }
        if is_within {
            return COVERED;
        }
        if square.level == LEVELS {
            return node;
        }
        let mut quarters = match node {
            OPEN => [OPEN; 4],
            _ => self.quarters[node as usize],
        };
        for (number, quarter) in quarters.iter_mut().enumerate() {
            *quarter = self.covered(*quarter, square.quarter(number), polygon);
        }
        self.with_quarters(node, quarters)
    }

    /// Whether a rectangle is certainly covered.
    pub fn is_covered(&self, low: DVec2, high: DVec2) -> bool {
        let (low, high) = (low - self.rim, high + self.rim);
        let end = self.low + self.size;
        if !(low.cmpge(self.low).all() && high.cmple(end).all()) {
            return false;
        }
        let mut waiting = vec![(self.root, self.whole())];
        while let Some((node, square)) = waiting.pop() {
            let is_apart =
                low.cmpgt(square.low + square.size).any() || high.cmplt(square.low).any();
            match node {
                COVERED => {}
                _ if is_apart => {}
                OPEN => return false,
                _ => {
                    let quarters = self.quarters[node as usize];
                    waiting.extend((0..4).map(|k| (quarters[k], square.quarter(k))));
                }
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_two_halves_cover_is_open_along_their_common_border_alone() {
        let mut occupancy = Occupancy::new(DVec2::ZERO, DVec2::ONE);
        let p = |x: f64, y: f64| DVec2::new(x, y);
        occupancy.cover(&[p(0.1, 0.1), p(0.9, 0.1), p(0.9, 0.9)]);
        assert!(!occupancy.is_covered(p(0.2, 0.5), p(0.3, 0.6)));
        occupancy.cover(&[p(0.1, 0.1), p(0.9, 0.9), p(0.1, 0.9)]);
        assert!(occupancy.is_covered(p(0.2, 0.5), p(0.3, 0.6)));
        assert!(occupancy.is_covered(p(0.7, 0.2), p(0.8, 0.3)));
        assert!(!occupancy.is_covered(p(0.45, 0.45), p(0.55, 0.55)));
        assert!(!occupancy.is_covered(p(0.05, 0.5), p(0.3, 0.6)));
        occupancy.cover(&[p(0.3, 0.2), p(0.7, 0.3), p(0.7, 0.7), p(0.3, 0.8)]);
        assert!(occupancy.is_covered(p(0.45, 0.45), p(0.55, 0.55)));
    }

    #[test]
    fn a_rim_around_squares_and_rectangles_stays_open() {
        let after_covering_to = |x: f64| {
            let mut occupancy = Occupancy::new(DVec2::ZERO, DVec2::ONE);
            let p = |x: f64, y: f64| DVec2::new(x, y);
            occupancy.cover(&[p(-0.1, -0.1), p(x, -0.1), p(x, 1.1), p(-0.1, 1.1)]);
            move |to: f64| occupancy.is_covered(p(0.2, 0.2), p(to, 0.6))
        };
        let rim = Occupancy::new(DVec2::ZERO, DVec2::ONE).rim();
        // Only what reaches past the middle by the rim covers the squares left of it.
        assert!(!after_covering_to(0.5 + 0.5 * rim)(0.5 - 2.0 * rim));
        let is_covered = after_covering_to(0.5 + 2.0 * rim);
        assert!(is_covered(0.5 - 2.0 * rim) && !is_covered(0.5 - 0.5 * rim));
    }
}
