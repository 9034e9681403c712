//! The parts of segments and triangles beyond the near plane.
//!
//! ```text
//!      eye ◁──────┊──●────────●      A segment is cut where it crosses the plane. Of a triangle that
//!            ●────┊──×             the plane cuts, engines test the pyramid of sight planes, and
//!                 ┊                the plane of sight through the cut: see `Sight::near_cut`.
//! ```

use super::{Cut, CutPlane, Sight, Sign};

/// The part of a triangle beyond the near plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kept {
    /// All of it.
    All,
    /// A part with an area, and the sides that its corners are on: positive ones are kept.
    Part([Sign; 3]),
    /// No area.
    Nothing,
}

impl Sight<'_> {
    /// The part of a segment that the near plane keeps, decided exactly; `None` when it keeps nothing.
    #[inline]
    pub fn kept_of_segment(&self, ends: [u32; 2]) -> Option<[Cut; 2]> {
        let [(a, a_sign), (b, b_sign)] = ends.map(|end| self.near_distance(end));
        let cut = || self.cut(ends, CutPlane::Near, [a, b]);
        match (a_sign, b_sign) {
            (Sign::Negative, Sign::Positive) => Some([cut(), Cut::END]),
            (Sign::Positive, Sign::Negative) => Some([Cut::START, cut()]),
            (Sign::Negative, _) | (_, Sign::Negative) => None,
            _ => Some([Cut::START, Cut::END]),
        }
    }

    /// The part of a triangle beyond the near plane, decided exactly. A triangle in the plane itself is kept.
    #[inline]
    pub fn kept_of_triangle(&self, corners: [u32; 3]) -> Kept {
        let signs = corners.map(|corner| self.near_distance(corner).1);
        if !signs.contains(&Sign::Negative) {
            Kept::All
        } else if signs.contains(&Sign::Positive) {
            Kept::Part(signs)
        } else {
            Kept::Nothing
        }
    }
}
