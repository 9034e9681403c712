//! Lines of text at a place, and whether they are clear of everything else.
//!
//! ```text
//!    ┌─────────────┐           Text takes up the box around its strokes, turned with it. Two convex
//!    │ angle in °  │  ┆  ╱     shapes are clear of each other if a straight strip of the clearance's
//!    └─────────────┘  ┆ ╱      width lies between them, or else by their distance.
//! ```

use glam::DVec2;

use super::font::text;
use crate::strokes::{StrokeKind, Strokes};

/// From one line to the next, as a part of the height of capitals.
const LINE_SPACING: f64 = 1.8;

/// Lines of text, centered one below the other.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TextBlock {
    lines: Vec<String>,
    height: f64,
    /// Direction of the lines, a unit vector.
    along: DVec2,
    /// The middle of the text, capitals only.
    pub(super) anchor: DVec2,
    /// The box around all strokes, relative to the anchor, across and along the lines.
    ink: (DVec2, DVec2),
}

impl TextBlock {
    /// Text around the origin.
    pub(super) fn new(lines: Vec<String>, height: f64, along: DVec2) -> Self {
        let mut block = Self { lines, height, along, anchor: DVec2::ZERO, ink: Default::default() };
        let level = Self { along: DVec2::X, ..block.clone() };
        let mut strokes = Strokes::default();
        level.draw(StrokeKind::Text, &mut strokes);
        block.ink = strokes.bounds().unwrap_or_default();
        block
    }

    /// One horizontal line.
    pub(super) fn line(line: &str, height: f64) -> Self {
        Self::new(vec![line.to_owned()], height, DVec2::X)
    }

    /// How far its ink reaches from the anchor in a direction.
    pub(super) fn reach(&self, direction: DVec2) -> f64 {
        let at = |p: DVec2| (p - self.anchor).dot(direction);
        self.corners().map(at).into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    /// The corners of the box around its ink.
    pub(super) fn corners(&self) -> [DVec2; 4] {
        let (low, high) = self.ink;
        [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
            .map(|p| self.anchor + self.along * p.x + self.along.perp() * p.y)
    }

    /// Whether its ink is at least `clearance` away from a convex polygon, which may be a segment.
    pub(super) fn is_clear_of(&self, polygon: &[DVec2], clearance: f64) -> bool {
        let corners = self.corners();
        let gap = widest_strip(&corners, polygon);
        // A strip between them is no wider than their distance.
        gap >= clearance || gap >= 0.0 && distance(&corners, polygon) >= clearance
    }

    /// Draws it as strokes of a kind.
    pub(super) fn draw(&self, kind: StrokeKind, drawing: &mut Strokes) {
        let across = self.along.perp();
        let middle = (self.lines.len() as f64 - 1.0) / 2.0;
        for (k, line) in self.lines.iter().enumerate() {
            let (strokes, width) = text(line, self.height);
            let below = (k as f64 - middle) * LINE_SPACING * self.height;
            let center = self.anchor - across * below;
            let corner = center - self.along * (width / 2.0) - across * (self.height / 2.0);
            for stroke in strokes {
                let points = stroke.into_iter().map(|p| corner + self.along * p.x + across * p.y);
                drawing.push(kind, 0, points);
            }
        }
    }
}

/// The width of the widest straight strip between two convex polygons that is parallel to a side of one
/// of them; negative if they overlap.
fn widest_strip(one: &[DVec2], other: &[DVec2]) -> f64 {
    let sides = |polygon: &[DVec2]| -> Vec<DVec2> {
        let next = polygon.iter().cycle().skip(1);
        let way = |(a, b): (&DVec2, &DVec2)| (*b - *a).normalize_or_zero();
        polygon.iter().zip(next).map(way).filter(|way| *way != DVec2::ZERO).collect()
    };
    let span = |points: &[DVec2], normal: DVec2| {
        points
            .iter()
            .map(|p| p.dot(normal))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)))
    };
    let directions = sides(one).into_iter().chain(sides(other));
    let gap = |way: DVec2| {
        let (a, b) = (span(one, way.perp()), span(other, way.perp()));
        // A segment has no sides at its ends.
        let (c, d) = (span(one, way), span(other, way));
        (a.0 - b.1).max(b.0 - a.1).max((c.0 - d.1).max(d.0 - c.1))
    };
    directions.map(gap).fold(f64::NEG_INFINITY, f64::max)
}

/// The distance of two convex polygons that do not overlap.
fn distance(one: &[DVec2], other: &[DVec2]) -> f64 {
    let to_side = |p: DVec2, a: DVec2, b: DVec2| {
        let way = b - a;
        let t = ((p - a).dot(way) / way.length_squared()).clamp(0.0, 1.0);
        p.distance(if t.is_nan() { a } else { a + way * t })
    };
    let of = |points: &[DVec2], polygon: &[DVec2]| {
        let sides = || polygon.iter().zip(polygon.iter().cycle().skip(1));
        let distances = points.iter().flat_map(|p| sides().map(|(a, b)| to_side(*p, *a, *b)));
        distances.fold(f64::INFINITY, f64::min)
    };
    of(one, other).min(of(other, one))
}

/// Breaks a text at blanks into at most `most` lines no longer than `longest`, if that can be, of
/// lengths as equal as can be. `width` measures a line.
pub(super) fn wrapped(
    line: &str,
    longest: f64,
    most: usize,
    width: impl Fn(&str) -> f64,
) -> Vec<String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    if words.len() < 2 || width(line) <= longest {
        return vec![line.to_owned()];
    }
    let longest_of = |lines: &[String]| lines.iter().map(|l| width(l)).fold(0.0, f64::max);
    let mut best = vec![line.to_owned()];
    for n in 2..=most.min(words.len()) {
        let lines = balanced(&words, n, &width);
        if longest_of(&lines) < longest_of(&best) {
            best = lines;
        }
        if longest_of(&best) <= longest {
            break;
        }
    }
    best
}

/// The words in `n` lines, the longest of which is as short as can be.
fn balanced(words: &[&str], n: usize, width: &impl Fn(&str) -> f64) -> Vec<String> {
    let whole = || vec![words.join(" ")];
    if n <= 1 || words.len() < n {
        return whole();
    }
    let splits = (1..=words.len() + 1 - n).map(|first| {
        let mut lines = vec![words[..first].join(" ")];
        lines.extend(balanced(&words[first..], n - 1, width));
        lines
    });
    let longest = |lines: &Vec<String>| lines.iter().map(|l| width(l)).fold(0.0, f64::max);
    splits.min_by(|a, b| longest(a).total_cmp(&longest(b))).unwrap_or_else(whole)
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    #[test]
    fn lines_are_broken_at_blanks_and_balanced() {
        let width = |line: &str| line.chars().count() as f64;
        let of = |line, longest| wrapped(line, longest, 3, width).join("/");
        assert_eq!(of("transfer function", 20.0), "transfer function");
        assert_eq!(of("transfer function", 10.0), "transfer/function");
        assert_eq!(of("a bb ccc dddd", 8.0), "a bb/ccc dddd");
        assert_eq!(of("one two three four five six", 9.0), "one two/three four/five six");
        // No line can be as short as that.
        assert_eq!(of("one two three four", 2.0), "one two/three/four");
        assert_eq!(of("unbreakable", 3.0), "unbreakable");
    }

    #[test]
    fn the_first_line_is_the_uppermost() {
        let lines = ["i", "WWW", "i"].map(str::to_owned);
        let widest = |lines: &[String]| {
            let mut drawn = Strokes::default();
            TextBlock::new(lines.to_vec(), 1.0, DVec2::X).draw(StrokeKind::Text, &mut drawn);
            let points = drawn.iter().flat_map(|stroke| stroke.points.to_vec());
            points.max_by(|p, q| p.x.total_cmp(&q.x)).expect("ink").y
        };
        assert!(widest(&lines[..2]) < -0.3 && widest(&lines[1..]) > 0.3);
        assert!(widest(&lines).abs() <= 0.5);
    }

    #[test]
    fn turned_text_is_clear_of_what_its_upright_box_would_touch() {
        let mut text = TextBlock::new(vec!["diagonal".to_owned()], 1.0, dvec2(0.6, 0.8));
        text.anchor = dvec2(3.0, 4.0);
        // Two corners that face each other are as far apart as they are.
        let corner = text.corners()[0];
        let away = corner + (corner - text.anchor).normalize() * 2.0;
        assert!(text.is_clear_of(&[away, away * 2.0 - corner], 1.999));
        assert!(!text.is_clear_of(&[away, away * 2.0 - corner], 2.001));
        let beside = [dvec2(4.5, 3.0), dvec2(6.0, 5.0)];
        assert!(text.is_clear_of(&beside, 0.1));
        assert!(!text.is_clear_of(&beside, 3.0));
        let through = [dvec2(2.0, 5.0), dvec2(4.0, 3.0)];
        assert!(!text.is_clear_of(&through, 0.0));
        // All of its ink is within its box.
        let mut drawn = Strokes::default();
        text.draw(StrokeKind::Text, &mut drawn);
        for p in drawn.iter().flat_map(|stroke| stroke.points) {
            for (direction, reach) in
                [dvec2(0.6, 0.8), dvec2(-0.8, 0.6), dvec2(-0.6, -0.8), dvec2(0.8, -0.6)]
                    .map(|d| (d, text.reach(d)))
            {
                assert!((*p - text.anchor).dot(direction) <= reach + 1e-12);
            }
        }
    }
}
