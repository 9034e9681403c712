//! Which ink is near the ends of strokes.

use rayon::prelude::*;

use crate::groups::Groups;
use crate::strokes::draft::Draft;

use super::Paper;
use super::cells::{Cells, MAX_CELLS};
use super::edits::Ends;
use super::near::part_within;

/// Ends are searched this much farther than asked, as a fraction, for rounding.
const REACH_SLACK: f64 = 1e-9;

/// Where more ends than this share a cell, none continues into another: what is near which of them is not
/// even looked for, since that may be all pairs of the lines of a drawing.
const MAX_ENDS: usize = 128;

/// Most cells for each stroke with ends, with some more for few strokes.
const CELLS_PER_STROKE: f64 = 16.0;
const SPARE_CELLS: f64 = (1 << 12) as f64;

/// For each end of a stroke that is not closed the segments near it.
pub(super) struct SegmentsNearEnds {
    segments: Groups,
    /// The stroke of each point.
    strokes: Vec<u32>,
    /// Groups of ends that crowd each other.
    crowds: Vec<Vec<u32>>,
}

impl SegmentsNearEnds {
    /// Finds the segments within `reach` of each end.
    ///
    /// The ends are sorted into cells, and the segments walk through them: there are fewer ends than
    /// segments. O(segments + pairs), in parallel but for the ends.
    pub(super) fn new(draft: &Draft, ends: &Ends, paper: &Paper, reach: f64) -> Self {
        let reach = reach * (1.0 + REACH_SLACK);
        let n_open = (0..draft.len() as u32).filter(|&stroke| ends.has(stroke)).count();
        let max_cells = (CELLS_PER_STROKE * n_open as f64 + SPARE_CELLS).min(MAX_CELLS);
        let cells = Cells::new(paper.bounds, reach, max_cells);
        let by_cell = EndsByCell::new(draft, ends, &cells);
        let points = draft.points();
        let strokes = draft.strokes_of_points();
        let pairs_of = |pairs: &mut Vec<(u32, u32)>, i: usize| {
            if i + 1 == points.len() || strokes[i] != strokes[i + 1] {
                return;
            }
            let segment = [points[i].at, points[i + 1].at];
            cells.near(segment[0], segment[1], reach, |c| {
                for &end in by_cell.of(c) {
                    let at = ends.at(end);
                    if part_within([at, at], segment, reach).is_some() {
                        pairs.push((end, i as u32));
                    }
                }
            });
        };
        let found: Vec<Vec<(u32, u32)>> = (0..points.len())
            .into_par_iter()
            .with_min_len(1024)
            .fold(Vec::new, |mut pairs, i| {
                pairs_of(&mut pairs, i);
                pairs
            })
            .collect();
        let mut pairs = found.concat();
        pairs.par_sort_unstable();
        pairs.dedup();
        let segments = Groups::of_sorted(2 * draft.len(), pairs);
        Self { segments, strokes, crowds: by_cell.crowds }
    }

    /// The segments near an end, each by the number of its first point, in order. The end's own is one
    /// of them.
    pub(super) fn of(&self, end: u32) -> &[u32] {
        self.segments.of(end as usize)
    }

    /// Groups of ends that are so many in one place that nothing is said of what is near them.
    pub(super) fn crowds(&self) -> &[Vec<u32>] {
        &self.crowds
    }

    /// The stroke that a point belongs to.
    pub(super) fn stroke(&self, point: u32) -> u32 {
        self.strokes[point as usize]
    }
}

/// The ends of strokes by cells.
struct EndsByCell {
    is_used: Vec<u64>,
    ends: Groups,
    crowds: Vec<Vec<u32>>,
}

impl EndsByCell {
    fn new(draft: &Draft, ends: &Ends, cells: &Cells) -> Self {
        let mut sorted: Vec<(u32, u32)> = Vec::new();
        for end in (0..2 * draft.len() as u32).filter(|end| ends.has(end / 2)) {
            let at = ends.at(end);
            cells.near(at, at, 0.0, |c| sorted.push((c as u32, end)));
        }
        sorted.par_sort_unstable();
        let (mut is_used, mut crowds) = (vec![0; cells.len().div_ceil(64)], Vec::new());
        for of_cell in sorted.chunk_by(|a, b| a.0 == b.0) {
            let c = of_cell[0].0 as usize;
            if of_cell.len() > MAX_ENDS {
                crowds.push(of_cell.iter().map(|&(_, end)| end).collect());
            } else {
                is_used[c / 64] |= 1 << (c % 64);
            }
        }
        sorted.retain(|(c, _)| is_used[*c as usize / 64] & 1 << (c % 64) != 0);
        Self { is_used, ends: Groups::of_sorted(cells.len(), sorted), crowds }
    }

    fn of(&self, c: usize) -> &[u32] {
        if self.is_used[c / 64] & 1 << (c % 64) == 0 {
            return &[];
        }
        self.ends.of(c)
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, dvec2};

    use super::*;
    use crate::strokes::StrokeKind;
    use crate::strokes::draft::{DraftPoint, Mark};

    fn draft(strokes: &[Vec<DVec2>]) -> Draft {
        let mark = Mark { kind: StrokeKind::Crease, only_outline: false, outline: false, qi: 0 };
        let mut draft = Draft::default();
        for points in strokes {
            points.iter().for_each(|&at| draft.push(DraftPoint { at, depth: 0.0, mark }));
            draft.end_stroke();
        }
        draft
    }

    fn found(strokes: &[Vec<DVec2>], size: f64, reach: f64) -> (Draft, SegmentsNearEnds) {
        let bounds = (DVec2::ZERO, DVec2::splat(size));
        let paper = Paper { mm: 1.0, pen: reach, figure: reach, bounds };
        let draft = draft(strokes);
        let near = SegmentsNearEnds::new(&draft, &Ends::new(&draft), &paper, reach);
        (draft, near)
    }

    #[test]
    fn what_is_near_an_end_is_what_all_distances_say() {
        let mut state = 7_u64;
        let mut next = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut n_near = 0;
        for (size, reach) in [(1.0, 0.05), (100.0, 0.3), (10.0, 3.0)] {
            let strokes: Vec<Vec<DVec2>> = (0..150)
                .map(|k| {
                    let step = if k % 3 == 0 { size } else { 0.05 * size };
                    let mut at = dvec2(next(), next()) * size;
                    let mut points = vec![at];
                    for _ in 0..1 + k % 4 {
                        at = (at + (dvec2(next(), next()) - 0.5) * step)
                            .clamp(DVec2::ZERO, DVec2::splat(size));
                        points.push(at);
                    }
                    points.extend((k % 5 == 0).then_some(points[0]));
                    points
                })
                .collect();
            let (draft, near) = found(&strokes, size, reach);
            let (points, ends) = (draft.points(), Ends::new(&draft));
            for end in 0..2 * draft.len() as u32 {
                let at = ends.at(end);
                let is_near = |&i: &u32| {
                    let (a, b) = (points[i as usize].at, points[i as usize + 1].at);
                    let t = ((at - a).dot(b - a) / a.distance_squared(b)).clamp(0.0, 1.0);
                    ends.has(end / 2) && at.distance(a.lerp(b, t)) <= reach
                };
                let strokes = (0..draft.len()).map(|stroke| draft.range(stroke));
                let segments = strokes.flat_map(|range| range.start as u32..range.end as u32 - 1);
                let expected: Vec<u32> = segments.filter(is_near).collect();
                assert_eq!(near.of(end), expected, "{size} {reach} {end}");
                n_near += expected.len();
            }
            assert!(near.crowds().is_empty());
        }
        assert!(n_near > 2000, "{n_near}");
    }

    #[test]
    fn where_thousands_of_lines_meet_pairs_are_not_counted() {
        let center = dvec2(50.0, 50.0);
        let ray = |k: u32| vec![center, center + 40.0 * DVec2::from_angle(f64::from(k) * 0.002)];
        let rays: Vec<Vec<DVec2>> = (0..3000).map(ray).collect();
        let (_, near) = found(&rays, 100.0, 0.3);
        let crowd: Vec<u32> = near.crowds().concat();
        assert!((0..3000).all(|k| crowd.contains(&(2 * k)) && near.of(2 * k).is_empty()));
        assert!(near.of(1).contains(&0), "the outer ends are not crowded");
    }
}
