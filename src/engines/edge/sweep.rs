//! From the covered parts of one segment to its spans: a sweep along the parameter.

use super::segment::Segment;
use super::shadow::Cover;
use crate::engines::visibility::Span;
use crate::predicates::{Cut, Sight};
use std::cmp::Ordering;

/// Collects what covers or doubles one segment, then sweeps it; reused from segment to segment.
#[derive(Debug, Default)]
pub(super) struct Sweep {
    /// Counts at the segment's first point, as in [`Event::change`].
    start: [i32; 3],
    /// The smallest number of layers on a side of any span.
    lowest: i32,
    events: Vec<Event>,
    spans: Vec<Span>,
}

/// A change of one of the counts at a cut.
#[derive(Debug, Clone, Copy)]
struct Event {
    at: Cut,
    /// What is added to the counts of layers on the left and right, and of doubling edges.
    change: [i32; 3],
}

impl Sweep {
    /// Removes everything collected.
    pub(super) fn clear(&mut self) {
        self.start = [0; 3];
        self.events.clear();
    }

    /// The smallest number of layers on either side of any of the last spans.
    pub(super) fn lowest(&self) -> i32 {
        self.lowest
    }

    /// Sets the numbers of layers on the left and right at the segment's start.
    pub(super) fn start_with(&mut self, [left, right]: [i32; 2]) {
        self.start = [left, right, 0];
    }

    /// Adds a change of the numbers of layers on the left and right.
    pub(super) fn add_change(&mut self, at: Cut, [left, right]: [i32; 2]) {
        self.events.push(Event { at, change: [left, right, 0] });
    }

    /// Adds a part that a triangle covers.
    pub(super) fn add_cover(&mut self, cover: &Cover) {
        let [left, right] = cover.sides.counts();
        self.add(cover, [left, right, 0]);
    }

    /// Adds a part that a coincident, nearer edge draws.
    pub(super) fn add_doubled(&mut self, cover: &Cover) {
        self.add(cover, [0, 0, 1]);
    }

    fn add(&mut self, cover: &Cover, change: [i32; 3]) {
        self.events.push(Event { at: cover.from, change });
        self.events.push(Event { at: cover.to, change: change.map(|x| -x) });
    }

    /// A single span, for a segment that needs no sweep.
    pub(super) fn only(&mut self, span: Span) -> &[Span] {
        self.spans.clear();
        self.spans.push(span);
        &self.spans
    }

    /// The spans of `segment` from what was added since it was cleared.
    ///
    /// Unless `count_layers`, the quantitative invisibility is 0 or 1.
    pub(super) fn spans(
        &mut self,
        sight: &Sight,
        segment: &Segment,
        count_layers: bool,
    ) -> &[Span] {
        self.spans_by(sight, segment, |[left, right]| {
            let layers = left.min(right);
            if count_layers { layers } else { layers.min(1) }
        })
    }

    /// The spans in which a number is constant that the layers on the left and right make; it stands in
    /// place of the quantitative invisibility.
    pub(super) fn spans_by(
        &mut self,
        sight: &Sight,
        segment: &Segment,
        number: impl Fn([u32; 2]) -> u32,
    ) -> &[Span] {
        let ends = segment.ends;
        // Equal cuts may come in any order: their changes are added before a span begins.
        self.events.sort_unstable_by(|a, b| sight.cut_order(ends, &a.at, &b.at));
        self.spans.clear();
        let mut counts = self.start;
        self.lowest = 0;
        let mut start = segment.from;
        for event in &self.events {
            if sight.cut_order(ends, &start, &event.at) == Ordering::Less {
                self.lowest = self.lowest.min(counts[0]).min(counts[1]);
                push(&mut self.spans, &start, &event.at, counts, &number);
                start = event.at;
            }
            for (count, change) in counts.iter_mut().zip(event.change) {
                *count += change;
            }
        }
        if sight.cut_order(ends, &start, &segment.to) == Ordering::Less || self.spans.is_empty() {
            self.lowest = self.lowest.min(counts[0]).min(counts[1]);
            push(&mut self.spans, &start, &segment.to, counts, &number);
        }
        &self.spans
    }
}

/// Appends a span, or lengthens the last one when nothing changes.
fn push(
    spans: &mut Vec<Span>,
    from: &Cut,
    to: &Cut,
    counts: [i32; 3],
    number: impl Fn([u32; 2]) -> u32,
) {
    let [left, right, doubled] = counts;
    let qi = number([left, right].map(|layers| layers.max(0) as u32));
    let doubled = doubled > 0;
    // Rounding may put two cuts the other way round by a unit in the last place.
    let t0 = spans.last().map_or(from.t, |last: &Span| last.t1);
    let t1 = to.t.max(t0);
    match spans.last_mut() {
        Some(last) if last.qi == qi && last.doubled == doubled => last.t1 = t1,
        _ => spans.push(Span { t0, t1, qi, doubled }),
    }
}
