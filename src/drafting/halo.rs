//! Halos: farther lines stop short of nearer ones, which shows which line passes in front.
//!
//! ```text
//!            │ nearer
//!   ───────  │  ───────      h on both sides, measured across the nearer line; where a line ends
//!            │               at a nearer one, on its own side only
//! ```
//!
//! After Appel, Rohlf and Stein, *The haloed line effect for hidden line elimination* (1979). Only lines
//! on which a surface can end, and wires, have halos: silhouette, boundary, non-manifold edges.

use glam::DVec2;
use rayon::prelude::*;

use crate::strokes::StrokeKind;
use crate::strokes::draft::Draft;

use super::Paper;
use super::edits::Ends;
use super::leave_out::Kept;
use super::near::{Parts, SegmentGrid};

/// Where lines cross at a small angle, a gap is at most this many times as long as the halo is wide, to
/// each side.
const LONGEST: f64 = 3.0;

/// Cuts `halo`, in image units, out of lines beside nearer ones.
///
/// A line is nearer when it is so by more than the pen width, as a length at that place: lines that
/// meet in space do not cut each other. O(segments + crossings), in parallel.
pub(super) fn cut(draft: &Draft, paper: &Paper, halo: f64, is_perspective: bool) -> Draft {
    let search = Search {
        draft,
        ends: Ends::new(draft),
        grid: paper.grid(draft, paper.pen),
        reach: paper.pen,
        halo,
        is_perspective,
    };
    let gaps: Vec<Vec<(f64, f64)>> = (0..draft.len())
        .into_par_iter()
        .with_min_len(16)
        .map_init(Parts::default, |gaps, stroke| {
            gaps.clear();
            draft.range(stroke).skip(1).for_each(|end| search.gaps_of(end as u32 - 1, gaps));
            gaps.join(0.0).to_vec()
        })
        .collect();
    let mut kept = Kept::new(draft);
    for (stroke, gaps) in gaps.iter().enumerate() {
        let mut at = 0.0;
        let end = search.ends.length(stroke as u32);
        for &(from, to) in gaps {
            kept.add_piece(stroke as u32, at, from.min(end));
            at = to;
        }
        kept.add_piece(stroke as u32, at, end);
    }
    kept.into_draft(draft, &search.ends)
}

struct Search<'a> {
    draft: &'a Draft,
    ends: Ends<'a>,
    grid: SegmentGrid,
    /// A line ends at another one if it is this close to it.
    reach: f64,
    halo: f64,
    is_perspective: bool,
}

impl Search<'_> {
    /// Adds the gaps that nearer lines make in a segment's stroke, as lengths along it.
    fn gaps_of(&self, segment: u32, gaps: &mut Parts) {
        let points = self.draft.points();
        let [a, b] = [segment, segment + 1].map(|k| points[k as usize]);
        let length = a.at.distance(b.at);
        // The last segments of a stroke reach a little farther.
        let stroke = self.grid.stroke(segment);
        let has_ends = self.ends.has(stroke);
        let is_end = |end: u32, point: u32| has_ends && self.ends.point(end) == point;
        let first = if is_end(2 * stroke, segment) { self.reach } else { 0.0 };
        let last = if is_end(2 * stroke + 1, segment + 1) { self.reach } else { 0.0 };
        self.grid.near(a.at, b.at, self.reach, |other| {
            let [p, q] = [other, other + 1].map(|k| points[k as usize]);
            if other == segment || !has_halo(p.mark.kind) || p.mark.qi > a.mark.qi {
                return;
            }
            let Some((t, u)) = crossing([a.at, b.at], [p.at, q.at]) else { return };
            let along = t * length;
            if along < -first || along > length + last || !(0.0..=1.0).contains(&u) {
                return;
            }
            let depth = a.depth + t.clamp(0.0, 1.0) * (b.depth - a.depth);
            let nearer = p.depth + u * (q.depth - p.depth);
            let unit = if self.is_perspective { depth.abs() } else { 1.0 };
            if depth - nearer > self.reach * unit {
                let (d, e) = (b.at - a.at, q.at - p.at);
                let sine = d.perp_dot(e).abs() / (d.length() * e.length());
                let half = (self.halo / sine).min(LONGEST * self.halo);
                let at = self.ends.along(segment) + along;
                gaps.add(at - half, at + half);
            }
        });
    }
}

fn has_halo(kind: StrokeKind) -> bool {
    matches!(
        kind,
        StrokeKind::Silhouette | StrokeKind::Boundary | StrokeKind::Nonmanifold | StrokeKind::Wire
    )
}

/// Where the lines through two segments cross, as fractions of the way along each.
fn crossing([a, b]: [DVec2; 2], [p, q]: [DVec2; 2]) -> Option<(f64, f64)> {
    let (d, e) = (b - a, q - p);
    let area = d.perp_dot(e);
    let (t, u) = ((p - a).perp_dot(e) / area, (p - a).perp_dot(d) / area);
    (t.is_finite() && u.is_finite()).then_some((t, u))
}
