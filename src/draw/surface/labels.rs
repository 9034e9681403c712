//! Heights written into gaps of level curves.
//!
//! ```text
//!   ─────╮              ╭────    A label lies along its curve, where that is straight, level and
//!         ╰── 125 ─────╯         has room. Where other curves are closer than a label is high,
//!   ──────── ┊   ┊ ─────────     they have a gap, too, so that no label touches ink.
//! ```
//!
//! Places are tried every millimeter. The levels with the fewest places choose first, and index lines
//! before others; each takes the place that costs least. Long curves have further labels where no other
//! curve need be cut.

mod ink;

use glam::{DVec2, dvec2};
use rayon::prelude::*;

use self::ink::{Ink, Rectangle, from_segment};
use super::levels::LevelSet;
use super::options::{LabelSide, Labels};
use crate::axes;
use crate::strokes::{Stroke, StrokeKind, Strokes, SurfacePart};

/// A level with more line than this has a label, and so has each longer piece, in millimeters.
const LABELLED_MM: f64 = 40.0;

/// No label is closer than this to another or to lines that are not cut, in millimeters.
const CLEAR_MM: f64 = 0.5;

/// Labels of one curve are at least this far apart along it, in millimeters …
const APART_MM: f64 = 60.0;

/// … and a long curve has one for about each such length.
const REPEATED_MM: f64 = 120.0;

/// A piece of a curve between two gaps is at least this long, in millimeters.
const SHORTEST_PIECE_MM: f64 = 3.0;

/// More room than this around a label is no better, in millimeters.
const ROOM_MM: f64 = 2.0;

/// The gap of a label is longer than the label by this part of its height at either end …
const BESIDE: f64 = 0.4;

/// … and higher by this part above and below.
const ABOVE: f64 = 0.25;

/// How much worse a place at the end of a curve is than one in the middle, as costs.
const END_COST: f64 = 0.5;

/// Places are tried this far apart, in millimeters.
const STEP_MM: f64 = 1.0;

/// How a label may be placed.
#[derive(Debug, Clone, Copy)]
struct Rules {
    /// Height of digits.
    height: f64,
    /// How far a curve may be off its chord under a label, in heights.
    bend: f64,
    /// How many other curves may have a gap for it.
    crossings: usize,
    /// Whether index lines may.
    cuts_index: bool,
}

/// Writes labels into the level curves of a drawing in image coordinates, `mm` millimeters to a unit. `others`
/// are lines that are added to it later. Returns the levels of some length that have no place for a label.
pub(super) fn label(
    drawing: &mut Strokes,
    others: &Strokes,
    levels: &LevelSet,
    labels: &Labelling,
    mm: f64,
) -> Vec<u16> {
    let map = Map::new(drawing, others, mm);
    let is_labelled = |line: &Line| match labels.which {
        Labels::None => false,
        Labels::Index => line.stroke_kind == StrokeKind::Index,
        Labels::All => true,
    };
    let mut numbers: Vec<u16> = map
        .lines
        .iter()
        .filter(|line| line.level > 0 && is_labelled(line))
        .map(|line| line.level)
        .collect();
    numbers.sort_unstable();
    numbers.dedup();
    let rules =
        [(1.0, 0.4, 4, false), (0.9, 0.5, 8, false), (0.75, 0.5, 8, false), (0.75, 0.5, 8, true)]
            .map(|(part, bend, crossings, cuts_index)| Rules {
                height: labels.height_mm * part,
                bend,
                crossings,
                cuts_index,
            });
    let mut placed = Placed::new(&map, labels.side);
    let mut left = numbers;
    for rules in &rules {
        let mut choices: Vec<(u16, Vec<Place>)> = left
            .par_iter()
            .map(|&level| (level, map.places(level, &levels.text(level), rules)))
            .collect();
        choices.sort_by_key(|(level, places)| (!levels.is_index(*level), places.len(), *level));
        left.clear();
        for (level, places) in &choices {
            let total = map.total(*level);
            let first = places.iter().find(|place| placed.is_free(&map, place));
            match first {
                Some(place) => placed.put(&map, place, &levels.text(*level), rules.height),
                None if total > LABELLED_MM => left.push(*level),
                None => {}
            }
        }
        // Further labels of long curves.
        for (level, places) in &choices {
            for place in places.iter().filter(|place| place.crossed.is_empty()) {
                let length = map.lines[place.line as usize].length();
                let wanted = (length / REPEATED_MM) as usize;
                let is_wanted = placed.n_on(place.line) < wanted.max(1) && length > LABELLED_MM;
                if is_wanted && placed.is_free(&map, place) {
                    placed.put(&map, place, &levels.text(*level), rules.height);
                }
            }
        }
        left.sort_unstable();
        if left.is_empty() {
            break;
        }
    }
    *drawing = placed.drawing(&map, drawing, mm);
    left
}

/// Which labels are written, and how.
#[derive(Debug, Clone, Copy)]
pub(super) struct Labelling {
    pub(super) which: Labels,
    pub(super) side: LabelSide,
    /// Height of digits, in millimeters.
    pub(super) height_mm: f64,
}

/// A line on paper.
struct Line {
    /// In millimeters.
    points: Vec<DVec2>,
    /// Length up to each point.
    along: Vec<f64>,
    stroke_kind: StrokeKind,
    /// The number of its level; 0 for lines that are not level curves.
    level: u16,
}

impl Line {
    fn length(&self) -> f64 {
        self.along.last().copied().unwrap_or(0.0)
    }

    fn is_closed(&self) -> bool {
        self.points.first() == self.points.last()
    }

    /// The point at a length, which goes around on closed lines, and the number of the segment there.
    fn at(&self, length: f64) -> (DVec2, usize) {
        let length = if self.is_closed() { length.rem_euclid(self.length()) } else { length };
        let last = self.points.len() - 2;
        let k = self.along.partition_point(|along| *along <= length).saturating_sub(1).min(last);
        let part = (length - self.along[k]) / (self.along[k + 1] - self.along[k]);
        let part = if part.is_nan() { 0.0 } else { part.clamp(0.0, 1.0) };
        (self.points[k].lerp(self.points[k + 1], part), k)
    }
}

/// All lines of a drawing.
struct Map {
    lines: Vec<Line>,
    ink: Ink,
    low: DVec2,
    high: DVec2,
}

impl Map {
    fn new(drawing: &Strokes, others: &Strokes, mm: f64) -> Self {
        let mut ink = Ink::default();
        let mut lines = Vec::with_capacity(drawing.len() + others.len());
        let bounds = drawing.bounds().unwrap_or_default();
        for stroke in drawing.iter().chain(others.iter()) {
            let points: Vec<DVec2> = stroke.points.iter().map(|p| *p * mm).collect();
            let mut along = vec![0.0];
            for pair in points.windows(2) {
                along.push(along[along.len() - 1] + pair[0].distance(pair[1]));
            }
            ink.push(lines.len() as u32, &points);
            let is_curve = matches!(stroke.kind, StrokeKind::Level | StrokeKind::Index);
            let level = if is_curve { stroke.part.level } else { 0 };
            lines.push(Line { points, along, stroke_kind: stroke.kind, level });
        }
        Self { lines, ink, low: bounds.0 * mm, high: bounds.1 * mm }
    }

    /// The length of all curves of a level.
    fn total(&self, level: u16) -> f64 {
        self.lines.iter().filter(|line| line.level == level).map(Line::length).sum()
    }

    /// Whether the surface falls in a direction from a point on a level, as the nearest curves of other
    /// levels on either side say.
    fn is_downhill(&self, p: DVec2, direction: DVec2, level: u16) -> bool {
        let mut nearest = (f64::INFINITY, false);
        for line in self.lines.iter().filter(|line| line.level > 0 && line.level != level) {
            for pair in line.points.windows(2) {
                let [a, b] = [pair[0] - p, pair[1] - p];
                let [u, v] = [a, b].map(|q| direction.perp_dot(q));
                if (u < 0.0) == (v < 0.0) {
                    continue;
                }
                let ahead = direction.dot(a.lerp(b, u / (u - v)));
                if ahead.abs() < nearest.0 {
                    nearest = (ahead.abs(), (line.level > level) != (ahead > 0.0));
                }
            }
        }
        nearest.1
    }

    /// Where a level may be labeled, the cheapest place first.
    fn places(&self, level: u16, text: &str, rules: &Rules) -> Vec<Place> {
        let width = axes::text(text, rules.height).1;
        let is_long = self.total(level) > LABELLED_MM;
        let mut places = Vec::new();
        for (number, line) in self.lines.iter().enumerate().filter(|(_, line)| line.level == level)
        {
            let length = line.length();
            let least = if line.is_closed() { 3.0 * width } else { LABELLED_MM };
            if length
                <= if is_long { least.min(2.0 * width + 2.0 * SHORTEST_PIECE_MM) } else { least }
            {
                continue;
            }
            // The ends of an open curve stay, so that it can be seen to continue beyond the label.
            let end = if line.is_closed() { 0.0 } else { 0.5 * width + rules.height };
            let n = ((length - 2.0 * end) / STEP_MM).floor();
            if n < 0.0 {
                continue;
            }
            let at = |k: usize| end + k as f64 * STEP_MM;
            places.extend(
                (0..=n as usize).filter_map(|k| self.place(number as u32, at(k), width, rules)),
            );
        }
        places.sort_by(|a, b| {
            a.cost.total_cmp(&b.cost).then(a.line.cmp(&b.line)).then(a.at.total_cmp(&b.at))
        });
        places
    }

    /// The place at a length along a curve, if a label may be there.
    fn place(&self, number: u32, at: f64, width: f64, rules: &Rules) -> Option<Place> {
        let line = &self.lines[number as usize];
        let height = rules.height;
        let [(start, first), (end, last)] =
            [at - 0.5 * width, at + 0.5 * width].map(|length| line.at(length));
        let chord = end - start;
        if chord.length() < 0.9 * width {
            return None;
        }
        let n = line.points.len() - 1;
        let mut bend = from_segment(line.at(at).0, [start, end]);
        let mut k = first;
        while k != last {
            k = if k + 1 == n { 0 } else { k + 1 };
            bend = bend.max(from_segment(line.points[k], [start, end]));
        }
        if bend > rules.bend * height {
            return None;
        }
        let along = chord.normalize_or_zero();
        // Upright.
        let along = if (along.x, along.y) < (0.0, 0.0) { -along } else { along };
        let half = dvec2(0.5 * width + BESIDE * height, (0.5 + ABOVE) * height);
        let area = Rectangle { center: 0.5 * (start + end), along, half };
        let (low, high) = area.bounds();
        if low.cmplt(self.low).any() || high.cmpgt(self.high).any() {
            return None;
        }
        let mut crossed: Vec<u32> = Vec::new();
        let (mut room, mut is_refused) = (ROOM_MM, false);
        self.ink.near(&area, ROOM_MM, |segment| {
            let other = &self.lines[segment.line as usize];
            // The curve itself is cut under the label, and nowhere else.
            if segment.line == number {
                let middle = segment.along + 0.5 * segment.ends[0].distance(segment.ends[1]);
                let away = (middle - at).abs();
                let away = if line.is_closed() { away.min(line.length() - away) } else { away };
                if away > width + 2.0 * height {
                    is_refused |= area.distance(segment.ends) < CLEAR_MM;
                }
                return;
            }
            let distance = area.distance(segment.ends);
            let can_cut = other.stroke_kind == StrokeKind::Level || rules.cuts_index;
            if other.level > 0 && can_cut {
                if distance == 0.0 && !crossed.contains(&segment.line) {
                    crossed.push(segment.line);
                }
            } else {
                is_refused |= distance < CLEAR_MM;
            }
            room = room.min(distance);
        });
        if is_refused || crossed.len() > rules.crossings {
            return None;
        }
        crossed.sort_unstable();
        let turn = along.y.abs().atan2(along.x.abs()).to_degrees() / 90.0;
        let end = if line.is_closed() { 0.0 } else { (2.0 * at / line.length() - 1.0).abs() };
        let cost = 4.0 * bend / height
            + turn
            + (1.0 - room / ROOM_MM).max(0.0)
            + END_COST * end
            + 2.0 * crossed.len() as f64;
        Some(Place { line: number, at, area, crossed, cost })
    }
}

/// Where a label may be.
struct Place {
    line: u32,
    /// Length along the line up to its middle.
    at: f64,
    area: Rectangle,
    /// Other curves that run through it.
    crossed: Vec<u32>,
    cost: f64,
}

/// The labels that have a place.
struct Placed {
    areas: Vec<Rectangle>,
    /// The gaps of each line, as lengths along it.
    gaps: Vec<Vec<(f64, f64)>>,
    /// Where the labels of each line are, as lengths along it.
    labels: Vec<Vec<f64>>,
    side: LabelSide,
    strokes: Vec<(u16, Vec<DVec2>)>,
}

impl Placed {
    fn new(map: &Map, side: LabelSide) -> Self {
        let n = map.lines.len();
        Self {
            areas: Vec::new(),
            gaps: vec![Vec::new(); n],
            labels: vec![Vec::new(); n],
            side,
            strokes: Vec::new(),
        }
    }

    fn n_on(&self, line: u32) -> usize {
        self.labels[line as usize].len()
    }

    fn is_free(&self, map: &Map, place: &Place) -> bool {
        let line = &map.lines[place.line as usize];
        let is_far = |other: &f64| {
            let away = (place.at - other).abs();
            away.min(if line.is_closed() { line.length() - away } else { away }) >= APART_MM
        };
        let area = place.area.grown(CLEAR_MM);
        self.labels[place.line as usize].iter().all(is_far)
            && !self.areas.iter().any(|other| area.overlaps(other))
            && gaps_for(map, place).iter().all(|(number, (from, to))| {
                let gaps = &self.gaps[*number as usize];
                gaps.iter().all(|gap| {
                    gap.1 + SHORTEST_PIECE_MM <= *from || *to + SHORTEST_PIECE_MM <= gap.0
                })
            })
    }

    fn put(&mut self, map: &Map, place: &Place, text: &str, height: f64) {
        for (line, gap) in gaps_for(map, place) {
            self.gaps[line as usize].push(gap);
        }
        self.areas.push(place.area);
        self.labels[place.line as usize].push(place.at);
        let level = map.lines[place.line as usize].level;
        let (letters, width) = axes::text(text, height);
        let Rectangle { center, mut along, .. } = place.area;
        if self.side == LabelSide::Uphill && map.is_downhill(center, along.perp(), level) {
            along = -along;
        }
        let offset = dvec2(0.5 * width, 0.5 * height);
        let turned = |p: &DVec2| {
            let p = *p - offset;
            center + along * p.x + along.perp() * p.y
        };
        self.strokes
            .extend(letters.iter().map(|letter| (level, letter.iter().map(turned).collect())));
    }

    /// The drawing with gaps and labels.
    fn drawing(&self, map: &Map, drawing: &Strokes, mm: f64) -> Strokes {
        let mut result = Strokes::default();
        for (number, stroke) in drawing.iter().enumerate() {
            let mut gaps = self.gaps[number].clone();
            if gaps.is_empty() {
                result.push_like(&stroke, stroke.points.iter().copied());
                continue;
            }
            gaps.sort_by(|a, b| a.0.total_cmp(&b.0));
            push_with_gaps(&mut result, &stroke, &map.lines[number], &gaps, mm);
        }
        for (level, points) in &self.strokes {
            let part = SurfacePart { level: *level, ..SurfacePart::default() };
            result.push_part(StrokeKind::Label, part, points.iter().map(|p| *p / mm));
        }
        result
    }
}

/// The gaps that a label makes: which lines, and from where to where along them.
fn gaps_for(map: &Map, place: &Place) -> Vec<(u32, (f64, f64))> {
    let mut parts: Vec<(u32, (f64, f64))> = Vec::new();
    map.ink.near(&place.area, 0.0, |segment| {
        let is_cut =
            segment.line == place.line || place.crossed.binary_search(&segment.line).is_ok();
        if is_cut && let Some((from, to)) = place.area.inside(segment.ends) {
            let length = segment.ends[0].distance(segment.ends[1]);
            parts
                .push((segment.line, (segment.along + from * length, segment.along + to * length)));
        }
    });
    parts.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.0.total_cmp(&b.1.0)).then(a.1.1.total_cmp(&b.1.1)));
    // What follows on in the next segment is one gap.
    parts.dedup_by(|next, last| {
        let joins = next.0 == last.0 && next.1.0 <= last.1.1 + 1e-6;
        if joins {
            last.1.1 = last.1.1.max(next.1.1);
        }
        joins
    });
    parts
}

/// Draws what the gaps, in rising order, leave of a stroke.
fn push_with_gaps(
    result: &mut Strokes,
    stroke: &Stroke,
    line: &Line,
    gaps: &[(f64, f64)],
    mm: f64,
) {
    let mut kept: Vec<Vec<DVec2>> = Vec::new();
    let mut start = 0.0;
    for &(from, to) in gaps.iter().chain([&(line.length(), line.length())]) {
        if from > start {
            let (first, last) = (line.at_open(start), line.at_open(from));
            let between = |along: &f64| *along > start && *along < from;
            let inner = line.along.iter().zip(stroke.points).filter(|(along, _)| between(along));
            let ends = [first / mm, last / mm];
            let inner: Vec<DVec2> = inner.map(|(_, p)| *p).collect();
            kept.push([&ends[..1], &inner, &ends[1..]].concat());
        }
        start = start.max(to);
    }
    // A closed stroke continues where it began.
    if line.is_closed()
        && kept.len() > 1
        && gaps[0].0 > 0.0
        && gaps.iter().all(|gap| gap.1 < line.length())
    {
        let first = kept.remove(0);
        if let Some(last) = kept.last_mut() {
            last.extend_from_slice(&first[1..]);
        }
    }
    for points in kept {
        result.push_like(stroke, points);
    }
}

impl Line {
    /// The point at a length, which does not go around.
    fn at_open(&self, length: f64) -> DVec2 {
        if length >= self.length() { self.points[self.points.len() - 1] } else { self.at(length).0 }
    }
}
