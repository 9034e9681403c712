//! Areas on the page that clip lines or hide them: polygons with a fill rule, united and intersected.
//!
//! ```text
//!        t1      t2            a line is cut wherever it crosses a border; the middle of each
//!    ────┼░░░░░░░┼────         piece is inside or outside by its winding number
//!        └───────┘
//! ```
//!
//! Which side a point is on is decided by exact predicates; cuts are rounded once. Borders are
//! [`BORDER_MM`] wide on paper, so that a line along a border is not broken up.

use std::rc::Rc;

use glam::DVec2;
use robust::{Coord, orient2d};

use crate::plot::Polylines;

/// Points this close to the border of an area are on it: half of the last digit that is written.
const BORDER_MM: f64 = 0.0005;
/// The most horizontal bands that the sides of a polygon are sorted into.
const MAX_BANDS: usize = 1024;

/// What to do with ink on the border of an area, and which ink to keep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Keep {
    /// Ink inside or on the border.
    Inside,
    /// Ink outside or on the border.
    Outside,
}

/// A union of polygons, within other areas.
#[derive(Debug, Default)]
pub(super) struct ClipRegion {
    pub(super) polygons: Vec<Polygon>,
    /// The region ends where any of these does.
    pub(super) within: Vec<Rc<ClipRegion>>,
}

impl ClipRegion {
    /// Box around the region, ignoring the ones around it. `None` if it is empty.
    pub(super) fn bounds(&self) -> Option<[DVec2; 2]> {
        let boxes = self.polygons.iter().map(|polygon| polygon.bounds);
        boxes.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])
    }

    /// Calls `emit` with the pieces of `line` to keep, in order. A closed line is not split at its first
    /// point. O(points · sides nearby).
    pub(super) fn cut(&self, line: &[DVec2], keep: Keep, mut emit: impl FnMut(&[DVec2])) {
        let (Some(&first), Some(&last)) = (line.first(), line.last()) else { return };
        if !self.is_near(line) {
            if keep == Keep::Outside {
                emit(line);
            }
            return;
        }
        let is_kept = |p: DVec2| match keep {
            Keep::Inside => self.contains(p, true),
            Keep::Outside => !self.contains(p, false),
        };
        if line.iter().all(|&p| p == first) {
            if is_kept(first) {
                emit(line);
            }
            return;
        }
        let mut pieces: Vec<Vec<DVec2>> = Vec::new();
        let (mut is_open, mut begins_kept, mut any_cut) = (false, false, false);
        let mut cuts: Vec<f64> = Vec::new();
        for (i, pair) in line.windows(2).enumerate() {
            let (from, to) = (pair[0], pair[1]);
            if from == to {
                continue;
            }
            cuts.clear();
            cuts.extend([0.0, 1.0]);
            self.add_cuts(from, to, &mut cuts);
            cuts.sort_unstable_by(f64::total_cmp);
            cuts.dedup();
            let at = |t: f64| match t {
                0.0 => from,
                1.0 => to,
                _ => from.lerp(to, t),
            };
            for t in cuts.windows(2) {
                let kept = is_kept(at(0.5 * (t[0] + t[1])));
                if kept && is_open {
                    if let Some(piece) = pieces.last_mut() {
                        // Cuts that change nothing add no point.
                        if t[0] > 0.0 {
                            piece.pop();
                        }
                        piece.push(at(t[1]));
                    }
                } else if kept {
                    pieces.push(vec![at(t[0]), at(t[1])]);
                    begins_kept |= i == 0 && t[0] == 0.0;
                }
                any_cut |= !kept;
                is_open = kept;
            }
        }
        if !any_cut {
            emit(line);
            return;
        }
        if first == last && begins_kept && is_open && pieces.len() > 1 {
            let head = pieces.remove(0);
            if let Some(tail) = pieces.last_mut() {
                tail.extend_from_slice(&head[1..]);
            }
        }
        pieces.iter().for_each(|piece| emit(piece));
    }

    fn is_near(&self, line: &[DVec2]) -> bool {
        let Some([low, high]) = self.bounds() else { return false };
        let (a, b) = bounds(line);
        let margin = DVec2::splat(BORDER_MM);
        (a - margin).cmple(high).all() && (b + margin).cmpge(low).all()
    }

    fn contains(&self, p: DVec2, with_border: bool) -> bool {
        self.within.iter().all(|region| region.contains(p, with_border))
            && self.polygons.iter().any(|polygon| polygon.contains(p, with_border))
    }

    fn add_cuts(&self, from: DVec2, to: DVec2, cuts: &mut Vec<f64>) {
        self.within.iter().for_each(|region| region.add_cuts(from, to, cuts));
        self.polygons.iter().for_each(|polygon| polygon.add_cuts(from, to, cuts));
    }
}

/// Where a polygon with crossing or nested rings is filled.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum FillRule {
    /// Where the rings wind around a point.
    #[default]
    NonZero,
    /// Where an odd number of rings surrounds a point.
    EvenOdd,
}

/// Rings with a fill rule, within other areas.
#[derive(Debug)]
pub(super) struct Polygon {
    sides: Vec<[DVec2; 2]>,
    rule: FillRule,
    within: Vec<Rc<ClipRegion>>,
    bounds: [DVec2; 2],
    /// Sides that touch each horizontal band of equal height, as one list and its ends.
    band_sides: Vec<u32>,
    band_ends: Vec<u32>,
    band_mm: f64,
}

impl Polygon {
    /// The polygon of `lines`, each closed by a straight side where it is open; `None` without area.
    pub(super) fn new(
        lines: &Polylines,
        rule: FillRule,
        within: Vec<Rc<ClipRegion>>,
    ) -> Option<Self> {
        let mut sides = Vec::with_capacity(lines.n_points());
        for line in lines.iter() {
            sides.extend(line.windows(2).map(|pair| [pair[0], pair[1]]));
            if let (Some(&first), Some(&last)) = (line.first(), line.last())
                && first != last
            {
                sides.push([last, first]);
            }
        }
        sides.retain(|side| side[0] != side[1]);
        let first = sides.first()?[0];
        let bounds = sides.iter().fold([first; 2], |[low, high], side| {
            [low.min(side[0]).min(side[1]), high.max(side[0]).max(side[1])]
        });
        let n_bands = (sides.len() as f64).sqrt().ceil().clamp(1.0, MAX_BANDS as f64);
        let band_mm = ((bounds[1].y - bounds[0].y) / n_bands).max(BORDER_MM);
        let mut polygon = Self {
            sides,
            rule,
            within,
            bounds,
            band_sides: Vec::new(),
            band_ends: Vec::new(),
            band_mm,
        };
        let n_bands = polygon.band(bounds[1].y) + 1;
        let mut counts = vec![0u32; n_bands + 1];
        let spans: Vec<[usize; 2]> =
            polygon.sides.iter().map(|side| polygon.bands(side[0].y, side[1].y)).collect();
        for &[low, high] in &spans {
            counts[low..=high].iter_mut().for_each(|count| *count += 1);
        }
        let mut next: Vec<u32> = Vec::with_capacity(n_bands);
        let mut total = 0;
        for count in &counts[..n_bands] {
            next.push(total);
            total += count;
            polygon.band_ends.push(total);
        }
        polygon.band_sides = vec![0; total as usize];
        for (side, &[low, high]) in spans.iter().enumerate() {
            for slot in &mut next[low..=high] {
                polygon.band_sides[*slot as usize] = side as u32;
                *slot += 1;
            }
        }
        Some(polygon)
    }

    fn band(&self, y: f64) -> usize {
        ((y - self.bounds[0].y) / self.band_mm).max(0.0) as usize
    }

    /// The bands between two heights, and a border's width beyond.
    fn bands(&self, a: f64, b: f64) -> [usize; 2] {
        let last = self.band(self.bounds[1].y);
        [self.band(a.min(b) - BORDER_MM).min(last), self.band(a.max(b) + BORDER_MM).min(last)]
    }

    fn sides_in(&self, [low, high]: [usize; 2]) -> impl Iterator<Item = [DVec2; 2]> {
        let start = low.checked_sub(1).map_or(0, |before| self.band_ends[before] as usize);
        let sides = &self.band_sides[start..self.band_ends[high] as usize];
        sides.iter().map(|&side| self.sides[side as usize])
    }

    fn contains(&self, p: DVec2, with_border: bool) -> bool {
        let margin = DVec2::splat(BORDER_MM);
        let [low, high] = self.bounds;
        if !(p.cmpge(low - margin).all() && p.cmple(high + margin).all()) {
            return false;
        }
        let mut winding = 0;
        for [a, b] in self.sides_in(self.bands(p.y, p.y)) {
            if distance_to_segment(p, a, b) <= BORDER_MM {
                return with_border && self.within.iter().all(|region| region.contains(p, true));
            }
            // A side counts with its lower end and without its upper one.
            let turn = orient2d(coord(a), coord(b), coord(p));
            if a.y <= p.y && p.y < b.y && turn > 0.0 {
                winding += 1;
            } else if b.y <= p.y && p.y < a.y && turn < 0.0 {
                winding -= 1;
            }
        }
        let inside = match self.rule {
            FillRule::NonZero => winding != 0,
            FillRule::EvenOdd => winding % 2 != 0,
        };
        inside && self.within.iter().all(|region| region.contains(p, with_border))
    }

    /// Adds where the segment from `from` to `to` crosses the border, as fractions of the segment; also some
    /// points where it does not.
    fn add_cuts(&self, from: DVec2, to: DVec2, cuts: &mut Vec<f64>) {
        self.within.iter().for_each(|region| region.add_cuts(from, to, cuts));
        let along = to - from;
        let (low, high) = (from.min(to), from.max(to));
        for [a, b] in self.sides_in(self.bands(from.y, to.y)) {
            let margin = DVec2::splat(BORDER_MM);
            if !(a.max(b).cmpge(low - margin).all() && a.min(b).cmple(high + margin).all()) {
                continue;
            }
            let side = b - a;
            let area = along.perp_dot(side);
            let t = (a - from).perp_dot(side) / area;
            let u = (a - from).perp_dot(along) / area;
            let slack = 1e-9;
            if t > 0.0 && t < 1.0 && u >= -slack && u <= 1.0 + slack {
                cuts.push(t);
            }
            for end in [a, b] {
                let t = (end - from).dot(along) / along.length_squared();
                if t > 0.0 && t < 1.0 && from.lerp(to, t).distance(end) <= BORDER_MM {
                    cuts.push(t);
                }
            }
        }
    }
}

/// Lowest and highest corner of the box around a line.
pub(super) fn bounds(line: &[DVec2]) -> (DVec2, DVec2) {
    let first = line.first().copied().unwrap_or_default();
    line.iter().fold((first, first), |(low, high), &p| (low.min(p), high.max(p)))
}

fn coord(p: DVec2) -> Coord<f64> {
    Coord { x: p.x, y: p.y }
}

fn distance_to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    p.distance(a + along * t)
}
