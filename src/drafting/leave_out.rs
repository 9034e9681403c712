//! Leaves out ink that runs along ink of higher precedence.
//!
//! ```text
//!   first  ────────────────────────────
//!   next        ─────┄┄┄┄┄┄┄┄┄┄┄┄──────        ┄ runs beside the first one: left out
//! ```
//!
//! Strokes are taken in their order, most important first, and compared with what was kept of those
//! before. Lines that cross at a larger angle never count.

use glam::DVec2;
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

/// The way a stroke goes at a place is that of the stretch which reaches this many pens to both sides:
/// contours of fine meshes zigzag.
const TREND_PENS: f64 = 1.0;

/// Of this many segments is measured how crowded they are.
const CROWDED_SAMPLE: usize = 1 << 15;

/// Units are compared with each other block by block, of about this many segments: what is known of their
/// company takes memory.
const BLOCK_SEGMENTS: u32 = 1 << 16;

/// A segment from end to end, as fractions of its length.
const WHOLE: (f64, f64) = (0.0, 1.0);

/// When ink is left out.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rule {
    /// Which stretches are left out. Each asks about what those before it have left.
    pub(super) stretches: Vec<Stretch>,
    /// Directions differ by no more than an angle of this sine.
    pub(super) sine: f64,
    /// Strokes, other than outline, that lose more than the share below have no shorter pieces, in image
    /// units.
    pub(super) shortest_scrap: f64,
    /// A stroke of which less is left than this share has scraps only.
    pub(super) scrap_share: f64,
}

/// A stretch that is left out; lengths in image units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretch {
    /// All of it is this close to other ink, …
    pub(super) near: f64,
    /// … and some of it as close as this.
    pub(super) crowded: f64,
    /// Shorter stretches stay.
    pub(super) shortest_gap: f64,
    /// Shorter pieces beside it go too.
    pub(super) shortest_piece: f64,
}

impl Rule {
    /// How far other ink may be.
    fn reach(&self) -> f64 {
        self.stretches.iter().fold(0.0, |reach, stretch| stretch.near.max(reach))
    }
}

/// The draft without what the rule leaves out, and the length of that.
///
/// O(segments + pairs of segments that run beside each other), in parallel but for what is kept of the
/// latter.
pub(super) fn leave_out(draft: &Draft, paper: &Paper, rule: &Rule) -> (Draft, f64) {
    let search = Search::new(draft, paper, rule);
    let units = units(draft, &search.ends, SHORTEST_RUN_MM * paper.mm);
    let mut ranks = vec![0; draft.points().len()];
    for (rank, unit) in units.iter().enumerate() {
        ranks[unit.first as usize..unit.end as usize].fill(rank as u32);
    }
    let mut kept = Kept::new(draft);
    let mut beside: Vec<Beside> = rule.stretches.iter().map(|_| Beside::default()).collect();
    let (mut left_out, mut has_company) = (0.0, false);
    for block in blocks(&units) {
        let found: Vec<Vec<Company>> = block
            .par_iter()
            .with_min_len(16)
            .map_init(Vec::new, |others, unit| search.company(unit, &ranks, others))
            .collect();
        for (unit, companies) in block.iter().zip(&found) {
            beside.iter_mut().for_each(Beside::clear);
            has_company |= !companies.is_empty();
            for company in companies {
                search.compare(company, unit, &kept, &mut beside);
            }
            let pieces = kept_pieces(&search.ends, unit, &mut beside, rule);
            let length: f64 = pieces.iter().map(|(from, to)| to - from).sum();
            let whole = search.ends.along(unit.end) - search.ends.along(unit.first);
            left_out += (whole - length).max(0.0);
            pieces.iter().for_each(|&(from, to)| kept.add(&search.ends, unit, from, to));
        }
    }
    if !has_company {
        return (draft.clone(), 0.0);
    }
    (kept.into_draft(draft, &search.ends), left_out)
}

/// The share of the ink that other ink crowds as the rule says, whichever is more important. Of large drawings, that of [`CROWDED_SAMPLE`] segments spread over all strokes.
pub(super) fn crowded_share(draft: &Draft, paper: &Paper, rule: &Rule) -> f64 {
    let search = Search::new(draft, paper, rule);
    let reach = rule.stretches.iter().fold(0.0, |reach, stretch| stretch.crowded.max(reach));
    let lengths = |others: &mut Vec<u32>, segment: u32| {
        let points = draft.points();
        let [a, b] = [segment, segment + 1].map(|k| points[k as usize].at);
        let mut parts = Parts::default();
        search.beside(segment, |_| true, others);
        for &other in others.iter() {
            if let Some((t0, t1)) = search.part_beside(segment, other, WHOLE, reach) {
                parts.add(t0, t1);
            }
        }
        let crowded: f64 = parts.join(0.0).iter().map(|(from, to)| to - from).sum();
        [crowded * a.distance(b), a.distance(b)]
    };
    let segments = search.segments();
    let step = segments.len().div_ceil(CROWDED_SAMPLE).max(1);
    let segments: Vec<[f64; 2]> = segments
        .into_par_iter()
        .step_by(step)
        .map_init(Vec::new, |others, segment| lengths(others, segment))
        .collect();
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

/// The units cut into blocks.
fn blocks(units: &[Unit]) -> impl Iterator<Item = &[Unit]> {
    let mut rest = units;
    std::iter::from_fn(move || {
        let mut n_segments = 0;
        let is_inside = |unit: &&Unit| {
            n_segments += unit.end - unit.first;
            n_segments <= BLOCK_SEGMENTS
        };
        let n = rest.iter().take_while(is_inside).count().max(1).min(rest.len());
        let (block, after) = rest.split_at(n);
        rest = after;
        (!block.is_empty()).then_some(block)
    })
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
fn kept_pieces(ends: &Ends, unit: &Unit, beside: &mut [Beside], rule: &Rule) -> Vec<(f64, f64)> {
    let whole = (ends.along(unit.first), ends.along(unit.end));
    let mut pieces = vec![whole];
    for (stretch, Beside { near, crowded }) in rule.stretches.iter().zip(beside) {
        let (near, crowded) = (near.join(0.0), crowded.join(0.0));
        if !near.is_empty() {
            let cut = |piece| cut(piece, near, crowded, stretch);
            pieces = pieces.into_iter().flat_map(cut).collect();
        }
    }
    let left: f64 = pieces.iter().map(|(from, to)| to - from).sum();
    let is_cut = pieces != [whole];
    if is_cut && left < rule.scrap_share * unit.length && !unit.mark.outline {
        pieces.retain(|(from, to)| to - from >= rule.shortest_scrap);
    }
    pieces
}

/// What is left of a piece without the stretches that are left out.
fn cut(
    piece: (f64, f64),
    near: &[(f64, f64)],
    crowded: &[(f64, f64)],
    stretch: &Stretch,
) -> Vec<(f64, f64)> {
    let (start, end) = piece;
    let is_gap = |&(from, to): &(f64, f64)| {
        let is_whole = to - from >= (end - start) * (1.0 - ROUNDING);
        (to - from >= stretch.shortest_gap || is_whole)
            && crowded.iter().any(|part| part.0 <= to && part.1 >= from)
    };
    let inside = near.iter().map(|&(from, to)| (from.max(start), to.min(end)));
    let mut pieces = Vec::new();
    let mut at = start;
    for (from, to) in inside.filter(|(from, to)| from <= to).filter(is_gap) {
        pieces.push((at, from));
        at = to;
    }
    pieces.push((at, end));
    if pieces != [piece] {
        pieces.retain(|(from, to)| to - from >= stretch.shortest_piece);
    }
    pieces
}

/// Two segments that run beside each other.
struct Company {
    segment: u32,
    other: u32,
    /// For each stretch of the rule, the parts of the first segment that are near and that are crowded if
    /// all of the other one is there.
    parts: [[Option<(f64, f64)>; 2]; MAX_STRETCHES],
}

/// Stretches of a rule, at most.
const MAX_STRETCHES: usize = 3;

/// For a stretch of the rule the parts of a unit, as lengths along the stroke.
#[derive(Default)]
struct Beside {
    near: Parts,
    crowded: Parts,
}

impl Beside {
    fn clear(&mut self) {
        self.near.clear();
        self.crowded.clear();
    }
}

/// For each point the direction of its stroke over a stretch around the segment that begins there.
fn trends(draft: &Draft, ends: &Ends, reach: f64) -> Vec<DVec2> {
    let points = draft.points();
    let along = |i: usize| ends.along(i as u32);
    let mut trends = Vec::with_capacity(points.len());
    for stroke in 0..draft.len() {
        let range = draft.range(stroke);
        let (mut first, mut last) = (range.start, range.start);
        trends.extend((range.start..range.end - 1).map(|i| {
            let middle = 0.5 * (along(i) + along(i + 1));
            while along(first + 1) <= middle - reach {
                first += 1;
            }
            while last + 1 < range.end && along(last) < middle + reach {
                last += 1;
            }
            let at = |from: usize, s: f64| {
                let t = ((s - along(from)) / (along(from + 1) - along(from))).clamp(0.0, 1.0);
                points[from].at.lerp(points[from + 1].at, t)
            };
            at(last - 1, middle + reach) - at(first, middle - reach)
        }));
        trends.push(DVec2::ZERO);
    }
    trends
}

/// Finds ink beside ink.
struct Search<'a> {
    draft: &'a Draft,
    ends: Ends<'a>,
    grid: SegmentGrid,
    /// The direction of each segment's stroke there, over a stretch as long as a few pens.
    trends: Vec<DVec2>,
    rule: &'a Rule,
}

impl<'a> Search<'a> {
    fn new(draft: &'a Draft, paper: &Paper, rule: &'a Rule) -> Self {
        let ends = Ends::new(draft);
        let trends = trends(draft, &ends, TREND_PENS * paper.pen);
        Self { draft, ends, grid: paper.grid(draft, rule.reach()), trends, rule }
    }

    fn segments(&self) -> Vec<u32> {
        (0..self.draft.len())
            .flat_map(|stroke| {
                let range = self.draft.range(stroke);
                range.start as u32..range.end as u32 - 1
            })
            .collect()
    }

    /// The ink of higher precedence that runs beside a unit.
    fn company(&self, unit: &Unit, ranks: &[u32], others: &mut Vec<u32>) -> Vec<Company> {
        let mut companies = Vec::new();
        for segment in unit.first..unit.end {
            // Of the unit itself the earlier segments count.
            let key = |segment: u32| (ranks[segment as usize], segment);
            self.beside(segment, |other| key(other) < key(segment), others);
            for &other in others.iter() {
                let parts = self.parts_beside(segment, other, WHOLE);
                if parts.iter().any(|[near, _]| near.is_some()) {
                    companies.push(Company { segment, other, parts });
                }
            }
        }
        companies
    }

    /// Replaces `others` by the segments near one that run in its direction and of which `counts` says
    /// so, in order.
    fn beside(&self, segment: u32, counts: impl Fn(u32) -> bool, others: &mut Vec<u32>) {
        others.clear();
        let [a, b] = self.at(segment);
        self.grid.near(a, b, self.rule.reach(), |other| {
            if other != segment && counts(other) {
                others.push(other);
            }
        });
        others.sort_unstable();
        others.dedup();
        others.retain(|&other| {
            let [p, q] = self.at(other);
            are_parallel(b - a, q - p, self.rule.sine) || {
                let [u, v] = [segment, other].map(|k| self.trends[k as usize]);
                are_parallel(u, v, self.rule.sine)
            }
        });
    }

    fn at(&self, segment: u32) -> [DVec2; 2] {
        [segment, segment + 1].map(|k| self.draft.points()[k as usize].at)
    }

    /// For each stretch of the rule, the parts of a segment that are near and that are crowded by a part of
    /// another one.
    fn parts_beside(
        &self,
        segment: u32,
        other: u32,
        part: (f64, f64),
    ) -> [[Option<(f64, f64)>; 2]; MAX_STRETCHES] {
        let mut parts = [[None; 2]; MAX_STRETCHES];
        for (parts, stretch) in parts.iter_mut().zip(&self.rule.stretches) {
            let near = self.part_beside(segment, other, part, stretch.near);
            let is_same = stretch.crowded == stretch.near;
            let crowded = || self.part_beside(segment, other, part, stretch.crowded);
            *parts = [near, if is_same { near } else { crowded() }];
        }
        parts
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
        // A closed stroke continues at its first point.
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

    /// Adds the parts of a segment beside which its company was kept.
    fn compare(&self, company: &Company, unit: &Unit, kept: &Kept, beside: &mut [Beside]) {
        let &Company { segment, other, .. } = company;
        let [a, b] = self.at(segment);
        let (start, length) = (self.ends.along(segment), a.distance(b));
        let mut add = |part: (f64, f64)| {
            let parts =
                if part == WHOLE { company.parts } else { self.parts_beside(segment, other, part) };
            for (found, beside) in parts.into_iter().zip(&mut *beside) {
                for (found, parts) in found.into_iter().zip([&mut beside.near, &mut beside.crowded])
                {
                    if let Some((t0, t1)) = found {
                        parts.add(start + t0 * length, start + t1 * length);
                    }
                }
            }
        };
        if (unit.first..unit.end).contains(&other) {
            add(WHOLE);
        } else {
            kept.parts(other).for_each(add);
        }
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
