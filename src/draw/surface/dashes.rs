//! Dashes: in the level curves of heights below 0, and in the lines of sheets that would look alike.

use glam::DVec2;

use super::levels::LevelSet;
use crate::strokes::{StrokeKind, Strokes};

/// Length of a dash, in millimeters.
const DASH_MM: f64 = 2.4;

/// Length of the gap after a dash, in millimeters.
const GAP_MM: f64 = 1.2;

/// Cuts curves of negative heights, in image coordinates with `mm` millimeters to a unit, into dashes. A
/// curve begins and ends with a whole dash, or goes around evenly; all dashes of a curve are equally long.
pub(super) fn dash_negative(drawing: &Strokes, levels: &LevelSet, mm: f64) -> Strokes {
    let mut result = Strokes::default();
    let pattern = Pattern::new(&[DASH_MM, GAP_MM], mm);
    for stroke in drawing.iter() {
        if !levels.is_negative(stroke.part.level) || stroke.kind == StrokeKind::Label {
            result.push_like(&stroke, stroke.points.iter().copied());
            continue;
        }
        for part in pattern.parts(stroke.points) {
            result.push_like(&stroke, part);
        }
    }
    result
}

/// Dashes and gaps in turn, in image coordinates.
pub(super) struct Pattern {
    lengths: Vec<f64>,
}

/// A pattern that would have to shrink to less than this part is left out: its line is drawn whole.
const LEAST_SHRUNK: f64 = 0.6;

impl Pattern {
    /// Lengths of dashes and gaps in turn, in millimeters, `mm` of which are a unit of the image.
    pub(super) fn new(lengths_mm: &[f64], mm: f64) -> Self {
        Self { lengths: lengths_mm.iter().map(|length| length / mm).collect() }
    }

    /// The dashes of a polyline. It begins and ends with a whole dash, or goes around evenly; the pattern is
    /// stretched for that, the same everywhere.
    pub(super) fn parts(&self, points: &[DVec2]) -> Vec<Vec<DVec2>> {
        let period: f64 = self.lengths.iter().sum();
        let last_gap = self.lengths.last().copied().unwrap_or(0.0);
        let length: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let is_closed = points.first() == points.last();
        let ends_with = if is_closed { 0.0 } else { last_gap };
        let n = ((length + ends_with) / period).round().max(1.0);
        let scale = length / (n * period - ends_with);
        if scale < LEAST_SHRUNK && self.lengths.len() > 2 {
            return vec![points.to_vec()];
        }
        let mut walk = Walk::new(points);
        let mut parts = Vec::new();
        for k in 0..n as usize {
            let mut at = k as f64 * period;
            for pair in self.lengths.chunks(2) {
                parts.push(walk.part(at * scale, (at + pair[0]) * scale));
                at += pair.iter().sum::<f64>();
            }
        }
        parts
    }
}

/// Cuts a polyline from its beginning to its end.
struct Walk<'a> {
    points: &'a [DVec2],
    /// The segment that was reached, and the length up to its beginning.
    segment: usize,
    along: f64,
}

impl<'a> Walk<'a> {
    fn new(points: &'a [DVec2]) -> Self {
        Self { points, segment: 0, along: 0.0 }
    }

    /// The part between two lengths, not before those of the last part.
    fn part(&mut self, from: f64, to: f64) -> Vec<DVec2> {
        let mut part = vec![self.reach(from)];
        let first = self.segment;
        let last = self.reach(to);
        part.extend_from_slice(&self.points[first + 1..=self.segment]);
        part.push(last);
        part
    }

    fn reach(&mut self, length: f64) -> DVec2 {
        loop {
            let [a, b] = [self.points[self.segment], self.points[self.segment + 1]];
            let own = a.distance(b);
            if self.along + own >= length || self.segment + 2 >= self.points.len() {
                let part = (length - self.along) / own;
                return if part.is_nan() { a } else { a.lerp(b, part.clamp(0.0, 1.0)) };
            }
            self.along += own;
            self.segment += 1;
        }
    }
}
