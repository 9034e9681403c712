//! Which ink is near a segment, and along which part of it.

use glam::DVec2;
use rayon::prelude::*;

use crate::extent::window::Window;
use crate::groups::Groups;
use crate::strokes::draft::Draft;

use super::cells::{Cells, MAX_CELLS};

/// Entries of a grid for each segment, at most, and some more for few segments.
const ENTRIES_PER_SEGMENT: f64 = 6.0;
const SPARE_ENTRIES: f64 = (1 << 16) as f64;

/// Most cells of a grid for each segment, with some more for few segments.
const CELLS_PER_SEGMENT: f64 = 1.0;

/// Parts of a stretch that are this close to its ends, or to each other, as fractions of its length, meet
/// there: they were computed with rounding.
pub(super) const ROUNDING: f64 = 1e-9;

/// The segments of a draft by square cells. A segment goes by the number of its first point.
pub(super) struct SegmentGrid {
    cells: Cells,
    /// The segments of each cell.
    segments: Groups,
    /// The stroke of each point.
    strokes: Vec<u32>,
}

impl SegmentGrid {
    /// Sorts the segments into cells of at least `cell`, within a box of the image: what lies outside
    /// is near nothing. O(segments).
    pub(super) fn new(draft: &Draft, (low, high): (DVec2, DVec2), cell: f64) -> Self {
        let box_of_all = Window { low, high, slack: 0.0 };
        let points = draft.points();
        let strokes = draft.strokes_of_points();
        let is_segment = |i: &usize| *i + 1 < points.len() && strokes[*i] == strokes[*i + 1];
        let inside = |i: usize| {
            let (a, b) = (points[i].at, points[i + 1].at);
            let part = box_of_all.part_inside(a, b);
            part.map(|(t0, t1)| (i as u32, [t0, t1].map(|t| a.lerp(b, t))))
        };
        let segments: Vec<(u32, [DVec2; 2])> = (0..points.len())
            .into_par_iter()
            .with_min_len(1024)
            .filter(is_segment)
            .filter_map(inside)
            .collect();
        let n = segments.len() as f64;
        let ink: f64 = segments.iter().map(|(_, [a, b])| (*b - *a).abs().element_sum()).sum();
        let cell = cell.max(ink / (ENTRIES_PER_SEGMENT * n + SPARE_ENTRIES));
        let max_cells = (CELLS_PER_SEGMENT * n + SPARE_ENTRIES).min(MAX_CELLS);
        let cells = Cells::new((low, high), cell, max_cells);
        let segments = Groups::new(cells.len(), |sorter| {
            for &(segment, [a, b]) in &segments {
                cells.near(a, b, 0.0, |c| sorter.put(c, segment));
            }
        });
        Self { cells, segments, strokes }
    }

    /// The stroke that a point belongs to.
    pub(super) fn stroke(&self, point: u32) -> u32 {
        self.strokes[point as usize]
    }

    /// Calls `visit` with every segment within `margin` of the one from `a` to `b`, and with some
    /// others; with some more than once.
    pub(super) fn near(&self, a: DVec2, b: DVec2, margin: f64, mut visit: impl FnMut(u32)) {
        self.cells.near(a, b, margin, |c| {
            self.segments.of(c).iter().for_each(|&segment| visit(segment));
        });
    }
}

/// The part of the segment from `a` to `b` that lies within `reach` of the one from `p` to `q`, as
/// fractions of the way.
pub(super) fn part_within(
    [a, b]: [DVec2; 2],
    [p, q]: [DVec2; 2],
    reach: f64,
) -> Option<(f64, f64)> {
    let mut part: Option<(f64, f64)> = None;
    let mut add = |t0: f64, t1: f64| {
        let (t0, t1) = (t0.max(0.0), t1.min(1.0));
        if t0 <= t1 {
            part = Some(part.map_or((t0, t1), |(u0, u1)| (t0.min(u0), t1.max(u1))));
        }
    };
    let along = b - a;
    let squared = along.length_squared();
    // Within a disc around either end.
    for center in [p, q] {
        let d = a - center;
        if squared == 0.0 {
            if d.length_squared() <= reach * reach {
                add(0.0, 1.0);
            }
            continue;
        }
        let half = along.dot(d) / squared;
        let root = half * half - (d.length_squared() - reach * reach) / squared;
        if root >= 0.0 {
            add(-half - root.sqrt(), -half + root.sqrt());
        }
    }
    // Beside the segment, between the perpendiculars at its ends.
    let length = p.distance(q);
    if length > 0.0 {
        let axis = (q - p) / length;
        let clip = |value: f64, speed: f64, low: f64, high: f64| {
            if speed == 0.0 {
                return if value >= low && value <= high { (0.0, 1.0) } else { (1.0, 0.0) };
            }
            let (t0, t1) = ((low - value) / speed, (high - value) / speed);
            (t0.min(t1), t0.max(t1))
        };
        let d = a - p;
        let (s0, s1) = clip(d.dot(axis), along.dot(axis), 0.0, length);
        let (r0, r1) = clip(d.perp_dot(axis), along.perp_dot(axis), -reach, reach);
        add(s0.max(r0).max(0.0), s1.min(r1).min(1.0));
    }
    part
}

/// Whether two directions, either way along them, differ by no more than an angle of this sine.
pub(super) fn are_parallel(u: DVec2, v: DVec2, sine: f64) -> bool {
    u.perp_dot(v).abs() <= sine * u.length() * v.length()
}

/// Parts of a stretch, joined where they touch.
#[derive(Default)]
pub(super) struct Parts {
    parts: Vec<(f64, f64)>,
}

impl Parts {
    pub(super) fn clear(&mut self) {
        self.parts.clear();
    }

    pub(super) fn add(&mut self, from: f64, to: f64) {
        self.parts.push((from, to));
    }

    /// Sorts the parts and joins those that are no farther apart than `gap`.
    pub(super) fn join(&mut self, gap: f64) -> &[(f64, f64)] {
        self.parts.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        self.parts.dedup_by(|next, last| {
            let touches = next.0 <= last.1 + gap;
            if touches {
                last.1 = last.1.max(next.1);
            }
            touches
        });
        &self.parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strokes::StrokeKind;
    use crate::strokes::draft::{DraftPoint, Mark};
    use glam::dvec2;

    /// Numbers from 0 to 1.
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    fn distance(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
        let t = ((p - a).dot(b - a) / a.distance_squared(b)).clamp(0.0, 1.0);
        p.distance(if t.is_nan() { a } else { a.lerp(b, t) })
    }

    #[test]
    fn the_part_within_reach_is_the_one_that_samples_say() {
        let mut next = numbers(3);
        let (mut n_some, mut n_none) = (0, 0);
        for k in 0..2000 {
            // Coarse coordinates too, for parallel, level and degenerate segments.
            let grain = if k % 2 == 0 { 4.0 } else { 1e6 };
            let mut point = || dvec2((next() * grain).floor(), (next() * grain).floor()) / grain;
            let (s, other) = ([point(), point()], [point(), point()]);
            let reach = 0.01 + 0.4 * next();
            let part = part_within(s, other, reach);
            for i in 0..=50 {
                let t = f64::from(i) / 50.0;
                let d = distance(s[0].lerp(s[1], t), other);
                let is_inside = part.is_some_and(|(t0, t1)| t0 <= t && t <= t1);
                if (d - reach).abs() > 1e-9 {
                    assert_eq!(is_inside, d < reach, "{s:?} {other:?} {reach} {t} {part:?}");
                }
            }
            *(if part.is_some() { &mut n_some } else { &mut n_none }) += 1;
        }
        assert!(n_some > 300 && n_none > 300);
    }

    #[test]
    fn every_segment_within_the_margin_is_visited() {
        let mark = Mark { kind: StrokeKind::Crease, only_outline: false, outline: false, qi: 0 };
        for (seed, scale, cell) in [(1, 1.0, 0.05), (2, 1000.0, 0.01), (3, 30.0, 100.0)] {
            let mut next = numbers(seed);
            let mut draft = Draft::default();
            for k in 0..120 {
                // Long ones, short ones, upright and level ones.
                let start = dvec2(next(), next()) * scale;
                let size = if k % 3 == 0 { scale } else { 0.05 * scale };
                let step = dvec2(next() - 0.5, next() - 0.5) * size;
                let step = [step, dvec2(step.x, 0.0), dvec2(0.0, step.y)][k % 3];
                for at in [start, start + step, start + step.perp()] {
                    draft.push(DraftPoint { at, depth: 0.0, mark });
                }
                draft.end_stroke();
            }
            let points = draft.points();
            let (mut low, mut high) = (points[0].at, points[0].at);
            points.iter().for_each(|p| (low, high) = (low.min(p.at), high.max(p.at)));
            let grid = SegmentGrid::new(&draft, (low, high), cell);
            let segments =
                (0..points.len() - 1).filter(|i| grid.strokes[*i] == grid.strokes[i + 1]);
            let segments: Vec<usize> = segments.collect();
            let margin = 0.03 * scale;
            for &i in &segments {
                let s = [points[i].at, points[i + 1].at];
                let mut visited = vec![false; points.len()];
                grid.near(s[0], s[1], margin, |k| visited[k as usize] = true);
                for &k in &segments {
                    let other = [points[k].at, points[k + 1].at];
                    if part_within(s, other, margin).is_some() {
                        assert!(visited[k], "{s:?} and {other:?}");
                    }
                }
            }
        }
    }
}
