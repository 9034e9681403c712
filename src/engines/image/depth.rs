//! How near a triangle is at a pixel's center: the half of the pixel rule that is about depth.
//!
//! *Nearness* is 1 / w in perspective, where w is the distance along the direction of view, and a constant
//! minus w in orthographic projection; the constant keeps it positive. Larger is nearer. It is linear in
//! the image, so over a triangle it is `base + column · along_row + row · down`: one multiplication and
//! one addition for each pixel. The sum is not accumulated, so that every engine gets the same number.
//!
//! Nearness is compared as a [`Depth`]: rounded to 40 bits. Rounding errors of the plane are a
//! thousand times smaller, so faces in one plane are at equal depth nearly everywhere and the lowest
//! number wins there, instead of a pattern of both.

use glam::{DVec2, DVec3};

use super::edge::center;

/// Low bits of a number's 52 that [`Depth`] drops. With fewer, rounding errors show where faces coincide;
/// with more, different depths become equal.
const BITS_LEFT_OUT: u32 = 12;

/// How near; larger is nearer. 0 is infinitely far away.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Depth(u64);

impl Depth {
    /// The nearest of all.
    pub const NEAREST: Self = Self(u64::MAX);

    /// The next one that is nearer.
    pub fn next_nearer(self) -> Self {
        Self(self.0.saturating_add(1))
    }

    /// The depth for a nearness of any sign.
    pub fn of_any(nearness: f64) -> Self {
        // Negative numbers have their bits in reverse order.
        let bits = nearness.to_bits();
        let ordered = if bits >> 63 == 0 { bits | 1 << 63 } else { !bits };
        Self(ordered.saturating_add(1 << (BITS_LEFT_OUT - 1)) >> BITS_LEFT_OUT)
    }

    /// The depth for a nearness; one that is not positive is infinitely far away.
    #[inline]
    pub fn of(nearness: f64) -> Self {
        // The bits of positive numbers are ordered as the numbers are.
        let bits = if nearness > 0.0 { nearness.to_bits() } else { 0 };
        Self((bits + (1 << (BITS_LEFT_OUT - 1))) >> BITS_LEFT_OUT)
    }
}

/// Nearness over a triangle.
#[derive(Debug, Clone, Copy)]
pub struct DepthPlane {
    origin: DVec3,
    along_row: f64,
    down: f64,
}

impl DepthPlane {
    /// The plane through three points: x and y in pixels, z is nearness.
    pub fn through([a, b, c]: [DVec3; 3]) -> Self {
        let (p, q) = (b - a, c - a);
        let area = p.x * q.y - p.y * q.x;
        let along_row = (p.z * q.y - p.y * q.z) / area;
        let down = (p.x * q.z - p.z * q.x) / area;
        let or_level = |slope: f64| if slope.is_finite() { slope } else { 0.0 };
        Self { origin: a, along_row: or_level(along_row), down: or_level(down) }
    }

    /// Nearness along a row.
    #[inline]
    pub fn row(&self, row: u32) -> DepthRow {
        let base = self.origin.z + (center(row) - self.origin.y) * self.down;
        DepthRow { base, x: self.origin.x, along_row: self.along_row }
    }

    /// The depth at a pixel's center.
    #[inline]
    pub fn at(&self, column: u32, row: u32) -> Depth {
        self.row(row).at(column)
    }

    /// Nearness at a pixel's center.
    #[inline]
    pub fn nearness(&self, column: u32, row: u32) -> f64 {
        self.row(row).nearness(column)
    }

    /// Nearness at any point, in pixels.
    pub fn nearness_at(&self, point: DVec2) -> f64 {
        let d = point - self.origin.truncate();
        self.origin.z + d.y * self.down + d.x * self.along_row
    }
}

/// Nearness of a triangle along a row of pixels.
#[derive(Debug, Clone, Copy)]
pub struct DepthRow {
    base: f64,
    x: f64,
    along_row: f64,
}

impl DepthRow {
    /// The depth at the center of a column.
    #[inline]
    pub fn at(&self, column: u32) -> Depth {
        Depth::of(self.nearness(column))
    }

    /// Nearness at the center of a column.
    #[inline]
    pub fn nearness(&self, column: u32) -> f64 {
        self.base + (center(column) - self.x) * self.along_row
    }

    /// About where, in pixels, this is as near as `other`; infinite or not a number if nowhere.
    #[inline]
    pub fn meets(&self, other: &Self) -> f64 {
        let there = other.base + (self.x - other.x) * other.along_row;
        self.x + (there - self.base) / (self.along_row - other.along_row)
    }
}
