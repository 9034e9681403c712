//! Changes to a draft: strokes left out, ends cut off, ends joined.

use glam::DVec2;

use crate::links::{FREE, for_each_trail};
use crate::strokes::draft::{Draft, DraftPoint, is_closed};

/// What tidying did, in image units.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Tidied {
    /// Ends that were joined to others.
    pub(super) n_joined: usize,
    /// The widest gap that a joint bridged.
    pub(super) farthest: f64,
    /// Strokes that were left out.
    pub(super) n_dropped: usize,
    /// Their length.
    pub(super) dropped: f64,
}

/// What is to become of the strokes of a draft.
pub(super) struct Edits {
    /// For each end, numbered `2 · stroke + side`, the end it is joined to, or [`FREE`].
    links: Vec<u32>,
    /// How much of the stroke is cut off at each end.
    stubs: Vec<f64>,
    is_dropped: Vec<bool>,
}

impl Edits {
    /// None yet.
    pub(super) fn new(draft: &Draft) -> Self {
        Self {
            links: vec![FREE; 2 * draft.len()],
            stubs: vec![0.0; 2 * draft.len()],
            is_dropped: vec![false; draft.len()],
        }
    }

    /// Whether an end is joined to another.
    pub(super) fn is_joined(&self, end: u32) -> bool {
        self.links[end as usize] != FREE
    }

    /// Joins two ends.
    pub(super) fn join(&mut self, a: u32, b: u32) {
        (self.links[a as usize], self.links[b as usize]) = (b, a);
    }

    /// Cuts off the last `length` of the stroke at one of its ends.
    pub(super) fn cut(&mut self, end: u32, length: f64) {
        self.stubs[end as usize] = length;
    }

    /// Leaves a stroke out.
    pub(super) fn drop(&mut self, stroke: usize) {
        self.is_dropped[stroke] = true;
    }

    /// The draft with the changes made. O(points).
    pub(super) fn apply(&self, draft: &Draft) -> Draft {
        let mut changed = Draft::default();
        for_each_trail(&self.links, |trail| {
            if self.is_dropped[trail[0] as usize / 2] {
                return;
            }
            let mut first = None;
            for &end in trail {
                let stroke = end as usize / 2;
                let is_backward = end % 2 == 1;
                let stubs = [self.stubs[2 * stroke], self.stubs[2 * stroke + 1]];
                for_each_point(draft.stroke(stroke), stubs, is_backward, |point| {
                    first.get_or_insert(point);
                    changed.push(point);
                });
            }
            // Around and back to where it began.
            let last = trail[trail.len() - 1] ^ 1;
            if let Some(first) = first.filter(|_| self.links[last as usize] == trail[0]) {
                changed.push(first);
            }
            changed.end_stroke();
        });
        changed
    }
}

/// Calls `f` with the points of a stroke without its stubs. Backward, the mark of each segment moves to
/// its other point.
fn for_each_point(
    points: &[DraftPoint],
    stubs: [f64; 2],
    is_backward: bool,
    mut f: impl FnMut(DraftPoint),
) {
    let n = points.len();
    let (first, start) = cut_point(n, |i| points[i], stubs[0]);
    let (after, stop) = cut_point(n, |i| points[n - 1 - i], stubs[1]);
    // The last segment that is left begins here.
    let last = (n - 1 - after).saturating_sub(1);
    let start = DraftPoint { mark: points[first].mark, ..start };
    let stop = DraftPoint { mark: points[last].mark, ..stop };
    if is_backward {
        f(stop);
        let inner = (first + 1..=last).rev();
        inner.for_each(|i| f(DraftPoint { mark: points[i - 1].mark, ..points[i] }));
        f(start);
    } else {
        f(start);
        points[(first + 1).min(last + 1)..=last].iter().for_each(|&point| f(point));
        f(stop);
    }
}

/// The point a stub's length along a stroke, and the number of the segment's first point.
fn cut_point(n: usize, at: impl Fn(usize) -> DraftPoint, stub: f64) -> (usize, DraftPoint) {
    let mut left = stub;
    for i in 0..n - 1 {
        let (from, to) = (at(i), at(i + 1));
        let length = from.at.distance(to.at);
        if left < length {
            return (i, between(from, to, left / length));
        }
        left -= length;
    }
    (n - 1, at(n - 1))
}

/// A point of a segment, a fraction `t` of the way.
pub(super) fn between(from: DraftPoint, to: DraftPoint, t: f64) -> DraftPoint {
    if t == 0.0 {
        return from;
    }
    let depth = from.depth + t * (to.depth - from.depth);
    DraftPoint { at: from.at.lerp(to.at, t), depth, ..from }
}

/// The ends of the strokes of a draft that are not closed.
pub(super) struct Ends<'a> {
    draft: &'a Draft,
    /// How far each point is along its stroke.
    along: Vec<f64>,
}

impl<'a> Ends<'a> {
    pub(super) fn new(draft: &'a Draft) -> Self {
        let mut along = Vec::with_capacity(draft.points().len());
        for points in draft.iter() {
            let mut sum = 0.0;
            along.push(0.0);
            along.extend(points.windows(2).map(|pair| {
                sum += pair[0].at.distance(pair[1].at);
                sum
            }));
        }
        Self { draft, along }
    }

    /// Whether a stroke has ends.
    pub(super) fn has(&self, stroke: u32) -> bool {
        !is_closed(self.draft.stroke(stroke as usize))
    }

    /// The number of an end's point.
    pub(super) fn point(&self, end: u32) -> u32 {
        let range = self.draft.range(end as usize / 2);
        (if end.is_multiple_of(2) { range.start } else { range.end - 1 }) as u32
    }

    /// Where an end is.
    pub(super) fn at(&self, end: u32) -> DVec2 {
        self.draft.points()[self.point(end) as usize].at
    }

    /// How far a point is along its stroke.
    pub(super) fn along(&self, point: u32) -> f64 {
        self.along[point as usize]
    }

    /// The length of a stroke.
    pub(super) fn length(&self, stroke: u32) -> f64 {
        self.along[self.draft.range(stroke as usize).end - 1]
    }

    /// The points of a stroke from an end on, each with how far it is from there along the stroke.
    pub(super) fn inward(&self, end: u32) -> impl Iterator<Item = (DVec2, f64)> {
        let range = self.draft.range(end as usize / 2);
        let from = self.along(self.point(end));
        (0..range.len()).map(move |k| {
            let i = if end.is_multiple_of(2) { range.start + k } else { range.end - 1 - k };
            (self.draft.points()[i].at, (self.along[i] - from).abs())
        })
    }

    /// The direction in which the stroke runs out at an end, over its last `reach`.
    pub(super) fn outward(&self, end: u32, reach: f64) -> DVec2 {
        let points = self.draft.stroke(end as usize / 2);
        let n = points.len();
        let inner = match end % 2 {
            0 => cut_point(n, |i| points[i], reach),
            _ => cut_point(n, |i| points[n - 1 - i], reach),
        };
        (self.at(end) - inner.1.at).normalize_or_zero()
    }
}
