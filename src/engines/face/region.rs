//! Regions of the image on one integer grid: intersected, subtracted, joined.
//!
//! ```text
//!    image box            grid of 2⁵⁰ steps along its longer side
//!   ┌───────────┐         ┌┬┬┬┬┬┬┬┬┬┬┬┐   every corner of every region is a grid point; a side
//!   │  ╱╲       │   ──►   ├┼┼┼╱╲┼┼┼┼┼┼┤   carries the line of the scene that it is on through
//!   │ ╱__╲      │         └┴┴┴┴┴┴┴┴┴┴┴┘   all operations
//!   └───────────┘
//! ```
//!
//! Points of the grid are kept as whole numbers of steps in `f64`.
//!
//! The operations are those of the `i_overlay` crate on 64-bit integers. They are exact except where
//! two sides cross: that point is rounded to the grid, and sides whose ends come within a step of each
//! other are joined there.
//!
//! # Error
//!
//! One grid serves a whole image, so only what is cut twice is rounded twice. The step is a power of
//! two, at most 2⁻⁴⁹ of the longer side of the image's box. A side is no longer than the diagonal, so
//! the step is below 1.8·10⁻¹⁵ of the diagonal. An operation moves a
//! side by at most [`STEPS_AN_OPERATION`] steps, so after `k` operations a border is within
//! `k ·` [`STEPS_AN_OPERATION`] steps of the truth, except where sides nearly coincide and have to be
//! rounded more than once: in round `n` they may move by 2 · 8ⁿ steps. Whatever
//! ends up narrower than [`SLIVER_STEPS`] is left out.

mod weld;

use glam::DVec2;
use i_overlay::core::edge_data::{EdgeDataMerge, OverlayEdgeData};
use i_overlay::core::edge_overlay::{EdgeOverlay, InputEdge};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::ShapeType;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Precision;
use i_overlay::i_float::int::point::IntPoint;
use i_overlay::segm::boolean::ShapeCountBoolean;

/// How far one operation may move a side, in steps: half a step along each axis by rounding, and a
/// step where ends are joined.
pub const STEPS_AN_OPERATION: f64 = 2.0;

/// Parts of a region with a mean width below this many steps are left out: rounding leaves them between
/// sides that coincide in truth. A smaller value keeps such slivers; a much larger one removes real
/// parts.
pub const SLIVER_STEPS: f64 = 8.0;

/// Sides that nearly coincide cross again and again as they are rounded. In each round the library joins
/// to a side's end everything within a distance that starts at two steps and grows eightfold, so that
/// all are one after a few rounds; if the distance grows more slowly, the number of sides explodes first.
const PRECISION: Precision = Precision { start: 2, progression: 6 };

/// Steps along the longer side of the image's box, as a power of two. The library takes 62 bits;
/// with 50 every point is an exact `f64`, as are the auxiliary lines around the box.
const STEPS_LOG2: i32 = 50;

/// The map between the image and the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SnapGrid {
    origin: DVec2,
    step: f64,
}

impl SnapGrid {
    /// The grid of an image between the corners `low` and `high`.
    pub fn new(low: DVec2, high: DVec2) -> Self {
        let size = (high - low).max_element();
        let exponent = if size > 0.0 && size.is_finite() { libm::ilogb(size) + 1 } else { 0 };
        // Both the step and its reciprocal must be normal numbers.
        let exponent = (exponent - STEPS_LOG2).clamp(-1000, 1000);
        let step = libm::scalbn(1.0, exponent);
        let middle = low / 2.0 + high / 2.0;
        // A multiple of the step, so that round image coordinates are grid points.
        let origin = (middle / step).round() * step;
        Self { origin: if origin.is_finite() { origin } else { DVec2::ZERO }, step }
    }

    /// The distance of neighboring points in image units.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The nearest grid point. Points far outside the image are clamped to its surroundings.
    pub fn snap(&self, point: DVec2) -> DVec2 {
        const FARTHEST: f64 = (1u64 << 52) as f64;
        let at = ((point - self.origin) / self.step).round();
        at.clamp(DVec2::splat(-FARTHEST), DVec2::splat(FARTHEST))
    }

    /// The image coordinates of a point of the grid.
    pub fn point(&self, at: DVec2) -> DVec2 {
        self.origin + at * self.step
    }
}

/// One side of a region's border, with the region on its left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegionSide {
    /// Where it begins.
    pub from: DVec2,
    /// Where it ends.
    pub to: DVec2,
    /// The line of the scene that it is on, or
    /// [`NO_LINE`](super::painting::NO_LINE).
    pub line: u32,
}

/// A region: any number of parts with any number of holes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Region {
    sides: Vec<RegionSide>,
    /// Where each ring ends among the sides, and whether it is the outer one of a part.
    rings: Vec<(u32, bool)>,
    low: DVec2,
    high: DVec2,
}

/// The line that a side is on, as the library carries it along.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LineTag(u32);

impl OverlayEdgeData for LineTag {
    type Store = ();

    fn merge(both: EdgeDataMerge<ShapeCountBoolean, Self>, _: &mut ()) -> Self {
        // NO_LINE is the highest number, so any line takes precedence.
        Self(both.lhs_data.0.min(both.rhs_data.0))
    }
}

impl Region {
    /// The region within rings, by the nonzero rule.
    pub fn of_rings<R>(rings: impl IntoIterator<Item = R>) -> Self
    where
        R: IntoIterator<Item = (DVec2, u32)>,
    {
        let mut sides = Vec::new();
        for ring in rings {
            let corners: Vec<(DVec2, u32)> = ring.into_iter().collect();
            for (k, &(from, line)) in corners.iter().enumerate() {
                let (to, _) = corners[(k + 1) % corners.len()];
                sides.push(RegionSide { from, to, line });
            }
        }
        operated(OverlayRule::Subject, &sides, &[])
    }

    /// Whether it is empty.
    pub fn is_empty(&self) -> bool {
        self.sides.is_empty()
    }

    /// All sides of its border.
    pub fn sides(&self) -> &[RegionSide] {
        &self.sides
    }

    /// The box around it.
    pub fn bounds(&self) -> (DVec2, DVec2) {
        (self.low, self.high)
    }

    /// Whether its box and that of another share more than a border.
    pub fn boxes_overlap(&self, other: &Self) -> bool {
        self.low.cmplt(other.high).all() && other.low.cmplt(self.high).all()
    }

    /// Its area in square steps.
    pub fn area(&self) -> f64 {
        area_of(&self.sides)
    }

    /// The part within another region.
    #[must_use]
    pub fn within(&self, other: &Self) -> Self {
        if !self.boxes_overlap(other) {
            return Self::default();
        }
        operated(OverlayRule::Intersect, &self.sides, &other.sides)
    }

    /// The part outside another region.
    #[must_use]
    pub fn without(&self, other: &Self) -> Self {
        if !self.boxes_overlap(other) {
            return self.clone();
        }
        operated(OverlayRule::Difference, &self.sides, &other.sides)
    }

    /// The part outside several regions.
    #[must_use]
    pub fn without_all<'a>(&self, others: impl IntoIterator<Item = &'a Self>) -> Self {
        let clip: Vec<RegionSide> =
            others.into_iter().flat_map(|other| other.sides.iter().copied()).collect();
        if clip.is_empty() {
            return self.clone();
        }
        operated(OverlayRule::Difference, &self.sides, &clip)
    }

    /// The union of several regions. O(n log n) in their sides.
    ///
    /// Where only one of two regions has a corner on a border they share, rounding opens a crack; such
    /// borders are welded first.
    pub fn union<'a>(regions: impl IntoIterator<Item = &'a Self>) -> Self {
        let sides: Vec<RegionSide> =
            regions.into_iter().flat_map(|region| region.sides.iter().copied()).collect();
        operated(OverlayRule::Subject, &weld::welded(sides), &[])
    }

    /// The region as parts: of each the outer ring, then its holes.
    pub fn parts(&self) -> Vec<Vec<&[RegionSide]>> {
        let mut parts: Vec<Vec<&[RegionSide]>> = Vec::new();
        let mut start = 0;
        for &(end, is_outer) in &self.rings {
            let ring = &self.sides[start..end as usize];
            match parts.last_mut() {
                Some(part) if !is_outer => part.push(ring),
                _ => parts.push(vec![ring]),
            }
            start = end as usize;
        }
        parts
    }

    /// Whether a point is within it or on its border. O(sides).
    pub fn contains(&self, point: DVec2) -> bool {
        let mut inside = false;
        for side in &self.sides {
            let (a, b) = (side.from, side.to);
            if (a.y > point.y) == (b.y > point.y) {
                let on_level = a.y == point.y && b.y == point.y;
                if on_level && a.x.min(b.x) <= point.x && point.x <= a.x.max(b.x) {
                    return true;
                }
                if a == point || b == point {
                    return true;
                }
                continue;
            }
            let turn = turn(a, b, point);
            if turn == 0 {
                return true;
            }
            if (turn > 0) == (b.y > a.y) {
                inside = !inside;
            }
        }
        inside
    }
}

/// Which way `a → b → c` turns: positive is counter-clockwise. Exact.
pub(super) fn turn(a: DVec2, b: DVec2, c: DVec2) -> i128 {
    // Differences of whole numbers below 2⁵² are exact.
    let (p, q) = (b - a, c - a);
    (p.x as i128) * (q.y as i128) - (p.y as i128) * (q.x as i128)
}

/// In square steps.
fn area_of(sides: &[RegionSide]) -> f64 {
    let Some(first) = sides.first() else { return 0.0 };
    let doubled: i128 = sides.iter().map(|side| turn(first.from, side.from, side.to)).sum();
    doubled as f64 / 2.0
}

/// Whether a ring is so narrow that rounding alone may have made it.
fn is_sliver(ring: &[RegionSide]) -> bool {
    let length: f64 = ring.iter().map(|s| s.from.distance(s.to)).sum();
    2.0 * area_of(ring).abs() <= SLIVER_STEPS * length
}

fn operated(rule: OverlayRule, subject: &[RegionSide], clip: &[RegionSide]) -> Region {
    let mut overlay = EdgeOverlay::<i64, LineTag>::new(subject.len() + clip.len());
    overlay.options.preserve_output_collinear = false;
    overlay.solver.precision = PRECISION;
    let edge = |side: &RegionSide| InputEdge {
        a: integers(side.from),
        b: integers(side.to),
        data: LineTag(side.line),
    };
    overlay.add_edges(subject.iter().map(edge), ShapeType::Subject);
    overlay.add_edges(clip.iter().map(edge), ShapeType::Clip);
    let mut region =
        Region { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY, ..Region::default() };
    for part in overlay.build_vector_shapes(rule, FillRule::NonZero) {
        for (number, ring) in part.into_iter().enumerate() {
            let start = region.sides.len();
            region.sides.extend(ring.iter().map(|edge| RegionSide {
                from: whole(edge.a),
                to: whole(edge.b),
                line: edge.data.0,
            }));
            if is_sliver(&region.sides[start..]) {
                region.sides.truncate(start);
                if number == 0 {
                    break;
                }
                continue;
            }
            for side in &region.sides[start..] {
                region.low = region.low.min(side.from);
                region.high = region.high.max(side.from);
            }
            region.rings.push((region.sides.len() as u32, number == 0));
        }
    }
    if region.sides.is_empty() { Region::default() } else { region }
}

fn integers(at: DVec2) -> IntPoint<i64> {
    IntPoint::new(at.x as i64, at.y as i64)
}

fn whole(at: IntPoint<i64>) -> DVec2 {
    DVec2::new(at.x as f64, at.y as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engines::face::painting::NO_LINE;
    use glam::dvec2;

    fn square(low: i32, high: i32, line: u32) -> Region {
        let corners = [(low, low), (high, low), (high, high), (low, high)];
        Region::of_rings([corners.map(|(x, y)| (dvec2(f64::from(x), f64::from(y)) * 100.0, line))])
    }

    #[test]
    fn round_numbers_of_the_image_are_points_of_the_grid() {
        let grid = SnapGrid::new(dvec2(9.5, 9.5), dvec2(25.5, 25.5));
        for p in [dvec2(18.5, 12.5), dvec2(9.5, 25.5), dvec2(10.0, 17.0)] {
            assert_eq!(grid.point(grid.snap(p)), p);
        }
        assert!(grid.step() <= 16.0 * libm::scalbn(1.0, -49));
    }

    #[test]
    fn a_hole_is_a_ring_of_its_part_and_sides_keep_their_lines() {
        let frame = square(0, 9, 7).without(&square(3, 6, 8));
        let parts = frame.parts();
        assert_eq!(parts.len(), 1);
        assert_eq!(parts[0].iter().map(|ring| ring.len()).collect::<Vec<_>>(), [4, 4]);
        assert!(parts[0][0].iter().all(|side| side.line == 7));
        assert!(parts[0][1].iter().all(|side| side.line == 8));
        assert_eq!(frame.area(), (81.0 - 9.0) * 1e4);
        assert!(frame.contains(dvec2(300.0, 400.0)) && !frame.contains(dvec2(400.0, 400.0)));
    }

    #[test]
    fn what_is_narrower_than_rounding_is_nothing() {
        let wide = Region::of_rings([[(0, 0), (1 << 30, 0), (1 << 30, 3), (0, 3)]
            .map(|(x, y)| (dvec2(f64::from(x), f64::from(y)), NO_LINE))]);
        assert!(wide.is_empty());
        let squares = [square(0, 4, 1), square(4, 8, 1), square(8, 9, 1)];
        assert_eq!(Region::union(&squares).area(), (16.0 + 16.0 + 1.0) * 1e4);
        assert_eq!(squares[0].without_all(&squares[1..]).area(), 16.0 * 1e4);
    }
}
