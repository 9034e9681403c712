//! Leaves out ink that runs along ink of higher precedence.
//!
//! ```text
//!   first  ────────────────────────────
//!   next        ─────┄┄┄┄┄┄┄┄┄┄┄┄──────        ┄ runs beside the first one: left out
//! ```
//!
//! Strokes are taken in their order, most important first, and compared with what was kept of those
//! before. Lines that cross at a larger angle never count.

use rayon::prelude::*;

use crate::strokes::StrokeKind;
use crate::strokes::draft::{Draft, Mark};

use super::Paper;
use super::edits::{Ends, between};
use super::near::{Parts, ROUNDING, SegmentGrid, are_parallel, part_within};

/// Stretches of one kind shorter than this, in millimeters, go with what is before them.
const SHORTEST_RUN_MM: f64 = 1.0;

/// Ink of one stroke lies on itself only where it is farther away along the stroke than this many times
/// the distance at which ink lies on ink.
const OWN_REACH: f64 = 3.0;

/// When ink is left out; lengths in image units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rule {
    /// A stretch this close to other ink is left out, …
    pub(super) near: f64,
    /// … if it comes as close as this somewhere, …
    pub(super) crowded: f64,
    /// … and their directions differ by no more than an angle of this sine.
    pub(super) sine: f64,
    /// Shorter stretches stay.
    pub(super) shortest_gap: f64,
    /// Of strokes of which something is left out, shorter pieces go too.
    pub(super) shortest_piece: f64,
    /// The same for strokes, other than outline, that lose more than the share below.
    pub(super) shortest_scrap: f64,
    /// A stroke of which less is left than this share has scraps only.
    pub(super) scrap_share: f64,
}

/// The draft without what the rule leaves out, and the length of that.
///
/// O(segments + pairs of segments that run beside each other), in parallel but for the latter.
pub(super) fn leave_out(draft: &Draft, paper: &Paper, rule: &Rule) -> (Draft, f64) {
    let search = Search::new(draft, paper, rule);
    let has_company = search.with_company();
    if !has_company.contains(&true) {
        return (draft.clone(), 0.0);
    }
    let mut kept = Kept::new(draft);
    let (mut near, mut crowded) = (Parts::default(), Parts::default());
    let mut left_out = 0.0;
    for unit in units(draft, &search.ends, SHORTEST_RUN_MM * paper.mm) {
        near.clear();
        crowded.clear();
        for segment in unit.first..unit.end {
            if has_company[segment as usize] {
                search.compare(segment, &unit, &kept, &mut near, &mut crowded);
            }
        }
        let pieces = kept_pieces(&search.ends, &unit, near.join(0.0), crowded.join(0.0), rule);
        let length: f64 = pieces.iter().map(|(from, to)| to - from).sum();
        left_out += (search.ends.along(unit.end) - search.ends.along(unit.first) - length).max(0.0);
        pieces.iter().for_each(|&(from, to)| kept.add(&search.ends, &unit, from, to));
    }
    (kept.into_draft(draft, &search.ends), left_out)
}

/// The share of the ink beside which other ink runs as the rule says, whichever is more important.
pub(super) fn crowded_share(draft: &Draft, paper: &Paper, rule: &Rule) -> f64 {
    let search = Search::new(draft, paper, rule);
    let lengths = |segment: u32| {
        let points = draft.points();
        let [a, b] = [segment, segment + 1].map(|k| points[k as usize].at);
        let mut parts = Parts::default();
        search.for_each_company(segment, |other| {
            if let Some((t0, t1)) = search.part_beside(segment, other, (0.0, 1.0), rule.crowded) {
                parts.add(t0, t1);
            }
        });
        let crowded: f64 = parts.join(0.0).iter().map(|(from, to)| to - from).sum();
        [crowded * a.distance(b), a.distance(b)]
    };
    let segments: Vec<[f64; 2]> = search.segments().into_par_iter().map(lengths).collect();
    let [crowded, all] =
        segments.iter().fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]]);
    if all > 0.0 { crowded / all } else { 0.0 }
}

/// A stretch of a stroke that is drawn for one reason.
struct Unit {
    stroke: u32,
    /// The number of its first segment, and that of the point at which it ends.
    first: u32,
    end: u32,
    mark: Mark,
    length: f64,
}

/// All units, the most important first.
fn units(draft: &Draft, ends: &Ends, shortest: f64) -> Vec<Unit> {
    let points = draft.points();
    let mut units = Vec::new();
    for stroke in 0..draft.len() {
        let range = draft.range(stroke);
        let mut first = range.start;
        for i in range.start + 1..range.end {
            let is_last = i + 1 == range.end;
            let length = ends.along(i as u32) - ends.along(first as u32);
            let is_change = precedence(points[i].mark) != precedence(points[first].mark);
            if is_last || is_change && length >= shortest {
                let (mark, stroke) = (points[first].mark, stroke as u32);
                units.push(Unit { stroke, first: first as u32, end: i as u32, mark, length });
                first = i;
            }
        }
    }
    units.sort_by(|a, b| {
        let by_kind = precedence(a.mark).cmp(&precedence(b.mark));
        by_kind.then(b.length.total_cmp(&a.length)).then(a.first.cmp(&b.first))
    });
    units
}

/// The order of precedence: visible before hidden lines, then by kind.
fn precedence(mark: Mark) -> (bool, u32) {
    let by_kind = match mark.kind {
        _ if mark.outline => 0,
        StrokeKind::Silhouette => 1,
        StrokeKind::Boundary | StrokeKind::Nonmanifold => 2,
        StrokeKind::Intersection | StrokeKind::Wire => 3,
        StrokeKind::Crease => 4,
        StrokeKind::Material => 5,
        _ => 6,
    };
    (mark.qi > 0, by_kind)
}

/// The pieces of a unit that stay, as lengths along the stroke.
fn kept_pieces(
    ends: &Ends,
    unit: &Unit,
    near: &[(f64, f64)],
    crowded: &[(f64, f64)],
    rule: &Rule,
) -> Vec<(f64, f64)> {
    let (start, end) = (ends.along(unit.first), ends.along(unit.end));
    let is_whole = |(from, to): (f64, f64)| to - from >= unit.length * (1.0 - ROUNDING);
    let is_gap = |&(from, to): &(f64, f64)| {
        (to - from >= rule.shortest_gap || is_whole((from, to)))
            && crowded.iter().any(|part| part.0 <= to && part.1 >= from)
    };
    let mut pieces = Vec::new();
    let mut at = start;
    for &(from, to) in near.iter().filter(|part| is_gap(part)) {
        pieces.push((at, from));
        at = to;
    }
    pieces.push((at, end));
    if pieces.len() == 1 && at == start {
        return pieces;
    }
    pieces.retain(|(from, to)| to - from >= rule.shortest_piece);
    let left: f64 = pieces.iter().map(|(from, to)| to - from).sum();
    if left < rule.scrap_share * unit.length && !unit.mark.outline {
        pieces.retain(|(from, to)| to - from >= rule.shortest_scrap);
    }
    pieces
}

/// Finds ink beside ink.
struct Search<'a> {
    draft: &'a Draft,
    ends: Ends<'a>,
    grid: SegmentGrid,
    rule: &'a Rule,
}

impl<'a> Search<'a> {
    fn new(draft: &'a Draft, paper: &Paper, rule: &'a Rule) -> Self {
        Self { draft, ends: Ends::new(draft), grid: paper.grid(draft, rule.near), rule }
    }

    fn segments(&self) -> Vec<u32> {
        (0..self.draft.len())
            .flat_map(|stroke| {
                let range = self.draft.range(stroke);
                range.start as u32..range.end as u32 - 1
            })
            .collect()
    }

    /// For each segment whether there is ink beside it at all.
    fn with_company(&self) -> Vec<bool> {
        let segments = self.segments();
        let found: Vec<bool> = segments
            .par_iter()
            .with_min_len(256)
            .map(|&segment| {
                let mut is_found = false;
                self.for_each_company(segment, |other| {
                    is_found = is_found
                        || self.part_beside(segment, other, (0.0, 1.0), self.rule.near).is_some();
                });
                is_found
            })
            .collect();
        let mut has_company = vec![false; self.draft.points().len()];
        segments
            .iter()
            .zip(found)
            .for_each(|(&segment, found)| has_company[segment as usize] = found);
        has_company
    }

    /// Calls `f` with the segments near one that run in its direction, some more than once.
    fn for_each_company(&self, segment: u32, mut f: impl FnMut(u32)) {
        let [a, b] = self.at(segment);
        self.grid.near(a, b, self.rule.near, |other| {
            let [p, q] = self.at(other);
            if other != segment && are_parallel(b - a, q - p, self.rule.sine) {
                f(other);
            }
        });
    }

    fn at(&self, segment: u32) -> [glam::DVec2; 2] {
        [segment, segment + 1].map(|k| self.draft.points()[k as usize].at)
    }

    /// The part of a segment within `reach` of a part of another one, but not where the stroke only goes
    /// on.
    fn part_beside(
        &self,
        segment: u32,
        other: u32,
        part: (f64, f64),
        reach: f64,
    ) -> Option<(f64, f64)> {
        let (here, there) = (self.at(segment), self.at(other));
        let kept = [part.0, part.1].map(|t| there[0].lerp(there[1], t));
        let (t0, t1) = part_within(here, kept, reach)?;
        let stroke = self.grid.stroke(segment);
        if stroke != self.grid.stroke(other) {
            return Some((t0, t1));
        }
        // How far the two places are from each other along the stroke; linear in `t`, but for the ends
        // of the other segment.
        let apart = |t: f64| {
            let at = here[0].lerp(here[1], t);
            let along = there[1] - there[0];
            let foot = ((at - there[0]).dot(along) / along.length_squared()).clamp(part.0, part.1);
            let [from, to] = [(segment, t, here), (other, foot, there)]
                .map(|(k, t, ends)| self.ends.along(k) + t * ends[0].distance(ends[1]));
            (from - to).abs()
        };
        let least = OWN_REACH * reach;
        // A closed stroke goes on at its first point.
        let is_closed = !self.ends.has(stroke);
        let most = if is_closed { self.ends.length(stroke) - least } else { f64::INFINITY };
        let (d0, d1) = (apart(t0), apart(t1));
        let inside = |d: f64| least < d && d < most;
        let at = |d: f64| t0 + (t1 - t0) * ((d - d0) / (d1 - d0)).clamp(0.0, 1.0);
        let (first, last) = if d0 < d1 { (at(least), at(most)) } else { (at(most), at(least)) };
        match (inside(d0), inside(d1)) {
            (true, true) => Some((t0, t1)),
            (true, false) => Some((t0, last)),
            (false, true) => Some((first, t1)),
            (false, false) if d0.min(d1) <= least && d0.max(d1) >= most => Some((first, last)),
            (false, false) => None,
        }
    }

    /// Adds the parts of a segment beside which there is ink that was kept, as lengths along the stroke.
    fn compare(
        &self,
        segment: u32,
        unit: &Unit,
        kept: &Kept,
        near: &mut Parts,
        crowded: &mut Parts,
    ) {
        let [a, b] = self.at(segment);
        let (start, length) = (self.ends.along(segment), a.distance(b));
        self.for_each_company(segment, |other| {
            let mut add = |part: (f64, f64)| {
                for (reach, parts) in
                    [(self.rule.near, &mut *near), (self.rule.crowded, &mut *crowded)]
                {
                    if let Some((t0, t1)) = self.part_beside(segment, other, part, reach) {
                        parts.add(start + t0 * length, start + t1 * length);
                    }
                }
            };
            // Of the unit itself the earlier segments count.
            if (unit.first..unit.end).contains(&other) {
                if other < segment {
                    add((0.0, 1.0));
                }
            } else {
                kept.parts(other).for_each(add);
            }
        });
    }
}

/// What was kept: for each segment a list of its parts.
pub(super) struct Kept {
    first: Vec<u32>,
    parts: Vec<(f64, f64, u32)>,
    /// Pieces as strokes and lengths along them.
    pieces: Vec<(u32, f64, f64)>,
}

const NONE: u32 = u32::MAX;

impl Kept {
    pub(super) fn new(draft: &Draft) -> Self {
        Self { first: vec![NONE; draft.points().len()], parts: Vec::new(), pieces: Vec::new() }
    }

    /// The parts of a segment that were kept.
    fn parts(&self, segment: u32) -> impl Iterator<Item = (f64, f64)> {
        let entry = |at: u32| self.parts.get(at as usize);
        let first = entry(self.first[segment as usize]);
        std::iter::successors(first, move |part| entry(part.2)).map(|&(t0, t1, _)| (t0, t1))
    }

    /// Adds a piece of a stroke, unless it is empty.
    pub(super) fn add_piece(&mut self, stroke: u32, from: f64, to: f64) {
        if from < to {
            self.pieces.push((stroke, from, to));
        }
    }

    /// Adds a piece of a unit.
    fn add(&mut self, ends: &Ends, unit: &Unit, from: f64, to: f64) {
        self.add_piece(unit.stroke, from, to);
        for segment in unit.first..unit.end {
            let (start, end) = (ends.along(segment), ends.along(segment + 1));
            if end > from && start < to {
                let fraction = |at: f64| ((at - start) / (end - start)).clamp(0.0, 1.0);
                self.parts.push((fraction(from), fraction(to), self.first[segment as usize]));
                self.first[segment as usize] = self.parts.len() as u32 - 1;
            }
        }
    }

    /// The pieces as strokes; those that touch are one.
    pub(super) fn into_draft(mut self, draft: &Draft, ends: &Ends) -> Draft {
        self.pieces.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        self.pieces.dedup_by(|next, last| {
            let touches = next.0 == last.0 && next.1 <= last.2;
            if touches {
                last.2 = last.2.max(next.2);
            }
            touches
        });
        let mut kept = Draft::default();
        for pieces in self.pieces.chunk_by(|a, b| a.0 == b.0) {
            let stroke = pieces[0].0;
            let range = draft.range(stroke as usize);
            let whole = ends.length(stroke);
            let goes_round =
                !ends.has(stroke) && pieces[0].1 == 0.0 && pieces[pieces.len() - 1].2 >= whole;
            let push = |kept: &mut Draft, from: f64, to: f64| {
                for i in range.start..range.end - 1 {
                    let (start, end) = (ends.along(i as u32), ends.along(i as u32 + 1));
                    if end <= from || start >= to {
                        continue;
                    }
                    let (a, b) = (draft.points()[i], draft.points()[i + 1]);
                    let at = |s: f64| between(a, b, (s - start) / (end - start));
                    kept.push(if from > start { at(from) } else { a });
                    kept.push(if to < end { at(to) } else { b });
                }
            };
            let turned = usize::from(goes_round && pieces.len() > 1);
            for (k, &(_, from, to)) in pieces.iter().enumerate().skip(turned) {
                push(&mut kept, from, to);
                if turned == 1 && k + 1 == pieces.len() {
                    push(&mut kept, pieces[0].1, pieces[0].2);
                }
                kept.end_stroke();
            }
        }
        kept
    }
}
