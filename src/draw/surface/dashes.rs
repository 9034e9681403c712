//! Dashes in the level curves of heights below 0.

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
    let (dash, gap) = (DASH_MM / mm, GAP_MM / mm);
    for stroke in drawing.iter() {
        if !levels.is_negative(stroke.part.level) || stroke.kind == StrokeKind::Label {
            result.push_like(&stroke, stroke.points.iter().copied());
            continue;
        }
        let points = stroke.points;
        let length: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let is_closed = points.first() == points.last();
        let ends_with = if is_closed { 0.0 } else { gap };
        let n = ((length + ends_with) / (dash + gap)).round().max(1.0);
        let scale = length / (n * (dash + gap) - ends_with);
        let mut walk = Walk::new(points);
        for k in 0..n as usize {
            let start = k as f64 * (dash + gap) * scale;
            result.push_like(&stroke, walk.part(start, start + dash * scale));
        }
    }
    result
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
