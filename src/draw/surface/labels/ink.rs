//! Where ink is: segments on paper, found by the cells of a square lattice that they run through.

use glam::DVec2;
use rustc_hash::FxHashMap;

/// Side of a cell, in millimeters.
const CELL_MM: f64 = 4.0;

/// A segment of a line, in millimeters.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    pub(super) ends: [DVec2; 2],
    /// The number of its line.
    pub(super) line: u32,
    /// Length along the line up to its first end.
    pub(super) along: f64,
}

/// All segments, by cells.
#[derive(Debug, Default)]
pub(super) struct Ink {
    segments: Vec<Segment>,
    cells: FxHashMap<[i32; 2], Vec<u32>>,
}

impl Ink {
    /// Adds the segments of a line. O(length / cell).
    pub(super) fn push(&mut self, line: u32, points: &[DVec2]) {
        let mut along = 0.0;
        for pair in points.windows(2) {
            let length = pair[0].distance(pair[1]);
            let n = ((length / CELL_MM).ceil() as usize).clamp(1, 100_000);
            for k in 0..n {
                let at = |k: usize| pair[0].lerp(pair[1], k as f64 / n as f64);
                let ends = [at(k), at(k + 1)];
                let number = self.segments.len() as u32;
                let along = along + length * k as f64 / n as f64;
                self.segments.push(Segment { ends, line, along });
                let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])].map(cell);
                for x in low[0]..=high[0] {
                    for y in low[1]..=high[1] {
                        self.cells.entry([x, y]).or_default().push(number);
                    }
                }
            }
            along += length;
        }
    }

    /// Calls `f` with the segments that may be within `distance` of a box; with some of them twice.
    pub(super) fn near(&self, rectangle: &Rectangle, distance: f64, mut f: impl FnMut(&Segment)) {
        let (low, high) = rectangle.bounds();
        let [low, high] = [low - distance, high + distance].map(cell);
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for &segment in self.cells.get(&[x, y]).into_iter().flatten() {
                    f(&self.segments[segment as usize]);
                }
            }
        }
    }
}

fn cell(p: DVec2) -> [i32; 2] {
    [(p.x / CELL_MM).floor() as i32, (p.y / CELL_MM).floor() as i32]
}

/// A turned rectangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rectangle {
    pub(super) center: DVec2,
    /// The direction of its length, a unit vector.
    pub(super) along: DVec2,
    /// Half its length and half its height.
    pub(super) half: DVec2,
}

impl Rectangle {
    /// The same with `margin` more on all sides.
    pub(super) fn grown(&self, margin: f64) -> Self {
        Self { half: self.half + margin, ..*self }
    }

    /// The corners in order.
    pub(super) fn corners(&self) -> [DVec2; 4] {
        let (u, v) = (self.along * self.half.x, self.along.perp() * self.half.y);
        [-u - v, u - v, u + v, v - u].map(|offset| self.center + offset)
    }

    /// The lowest and the highest corner of the box around it.
    pub(super) fn bounds(&self) -> (DVec2, DVec2) {
        let corners = self.corners();
        let low = corners.iter().fold(DVec2::INFINITY, |low, p| low.min(*p));
        (low, corners.iter().fold(DVec2::NEG_INFINITY, |high, p| high.max(*p)))
    }

    /// Coordinates along its length and its height, from the center.
    fn local(&self, p: DVec2) -> DVec2 {
        let d = p - self.center;
        DVec2::new(d.dot(self.along), d.dot(self.along.perp()))
    }

    /// The part of a segment inside, as parameters of it.
    pub(super) fn inside(&self, ends: [DVec2; 2]) -> Option<(f64, f64)> {
        let [p, q] = ends.map(|end| self.local(end));
        let d = q - p;
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for (start, change, half) in [(p.x, d.x, self.half.x), (p.y, d.y, self.half.y)] {
            if change == 0.0 {
                if start.abs() >= half {
                    return None;
                }
                continue;
            }
            let (one, other) = ((-half - start) / change, (half - start) / change);
            (from, to) = (from.max(one.min(other)), to.min(one.max(other)));
        }
        (from < to).then_some((from, to))
    }

    /// How far a segment is from it; 0 if they meet.
    pub(super) fn distance(&self, ends: [DVec2; 2]) -> f64 {
        if self.inside(ends).is_some() {
            return 0.0;
        }
        let outside = |p: DVec2| (self.local(p).abs() - self.half).max(DVec2::ZERO).length();
        let to_corner = self.corners().map(|corner| from_segment(corner, ends));
        to_corner.into_iter().chain(ends.map(outside)).fold(f64::INFINITY, f64::min)
    }

    /// Whether two rectangles overlap, by the axes that may separate them.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        let axes = [self.along, self.along.perp(), other.along, other.along.perp()];
        axes.into_iter().all(|axis| {
            let reach = |r: &Self| {
                r.half.x * r.along.dot(axis).abs() + r.half.y * r.along.perp().dot(axis).abs()
            };
            (self.center - other.center).dot(axis).abs() < reach(self) + reach(other)
        })
    }
}

/// How far a point is from a segment.
pub(super) fn from_segment(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let d = b - a;
    let t = ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0);
    if t.is_nan() { p.distance(a) } else { p.distance(a + t * d) }
}
