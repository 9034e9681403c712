//! What stands around the drawing of a surface: axes with ticks, numbers and titles, as strokes.
//!
//! ```text
//!      ╱▔▔▔╲            Each axis runs along an edge of the surface's box between a face that the
//!  2 ─┤     ╲           eye is in front of and one that it is not: an edge of the box's outline.
//!     │      ▏          Nothing in the box hides such an edge, nor what is drawn outside of it, so
//!  0 ─╲     ╱           no visibility needs to be found, and the lettering covers nothing.
//!    ┼ ╲┼┼┼╱
//! ```

mod font;

pub use font::text;

use glam::{DVec2, DVec3, dvec2};

use crate::strokes::{Drawing, StrokeKind};
use crate::view::{Camera, Projection};

/// Height of numbers, as a part of the longer side of the box's image: 4.6 mm on A4 landscape.
const TEXT_HEIGHT: f64 = 1.0 / 60.0;

/// About how many ticks an axis has.
const TICKS: f64 = 5.0;

/// What is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Titles {
    /// Beside the axes x, y and z; none where empty.
    pub axes: [String; 3],
    /// Above the drawing; none when empty.
    pub drawing: String,
}

impl Default for Titles {
    fn default() -> Self {
        Self { axes: ["x", "y", "z"].map(str::to_owned), drawing: String::new() }
    }
}

/// Adds axes around `bounds`, the (lowest, highest) corner of what is drawn, and titles.
///
/// Numbers are heights divided by `z_factor`: heights as given, for a surface whose heights were
/// multiplied by it. An axis that has no edge on the outline of the box is left out; so are all
/// when a corner of the box is not beyond the near plane.
pub fn dress(
    drawing: &mut Drawing,
    bounds: (DVec3, DVec3),
    z_factor: f64,
    camera: &Camera,
    titles: &Titles,
) {
    let bbox = BoundingBox { low: bounds.0, high: bounds.1, camera };
    let corners = (0..8).map(|k| bbox.corner([k & 1, k >> 1 & 1, k >> 2 & 1].map(|b| b == 1)));
    let near = match camera.projection() {
        Projection::Perspective { near, .. } => near * camera.forward().length(),
        Projection::Orthographic => f64::NEG_INFINITY,
    };
    let forward = camera.frame().forward;
    let corners: Vec<DVec3> = corners.collect();
    let depth = |p: &DVec3| (*p - camera.eye()).dot(forward);
    if !corners.iter().all(|p| p.is_finite() && depth(p) > near) {
        return;
    }
    let images: Vec<DVec2> = corners.iter().map(|p| camera.image(*p)).collect();
    let low = images.iter().fold(DVec2::INFINITY, |low, p| low.min(*p));
    let high = images.iter().fold(DVec2::NEG_INFINITY, |high, p| high.max(*p));
    let height = (high - low).max_element() * TEXT_HEIGHT;
    if !(height > 0.0 && height.is_finite()) {
        return;
    }
    let center = images.iter().sum::<DVec2>() / 8.0;
    for axis in 0..3 {
        if let Some([a, b]) = bbox.axis_edge(axis) {
            let factor = if axis == 2 { z_factor } else { 1.0 };
            Axis { axis, a, b, factor, center, height, title: &titles.axes[axis] }
                .draw(camera, drawing);
        }
    }
    if !titles.drawing.is_empty() {
        let at = dvec2(low.x / 2.0 + high.x / 2.0, high.y.max(top(drawing)) + 3.0 * height);
        write_centered(drawing, &titles.drawing, 1.5 * height, at);
    }
}

fn top(drawing: &Drawing) -> f64 {
    drawing.bounds().map_or(f64::NEG_INFINITY, |(_, high)| high.y)
}

struct BoundingBox<'a> {
    low: DVec3,
    high: DVec3,
    camera: &'a Camera,
}

impl BoundingBox<'_> {
    fn corner(&self, is_high: [bool; 3]) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|k| if is_high[k] { self.high[k] } else { self.low[k] }))
    }

    /// Whether the eye is on the outer side of a face.
    fn is_front(&self, axis: usize, is_high: bool) -> bool {
        match (self.camera.projection(), is_high) {
            (Projection::Perspective { .. }, false) => self.camera.eye()[axis] < self.low[axis],
            (Projection::Perspective { .. }, true) => self.camera.eye()[axis] > self.high[axis],
            (Projection::Orthographic, false) => self.camera.forward()[axis] > 0.0,
            (Projection::Orthographic, true) => self.camera.forward()[axis] < 0.0,
        }
    }

    /// The edge of the outline along an axis that is lowest, or leftmost for z, in the image.
    fn axis_edge(&self, axis: usize) -> Option<[DVec3; 2]> {
        if self.low[axis] >= self.high[axis] {
            return None;
        }
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut best: Option<(f64, [DVec3; 2])> = None;
        for sides in [[false, false], [true, false], [true, true], [false, true]] {
            if self.is_front(b, sides[0]) == self.is_front(c, sides[1]) {
                continue;
            }
            let mut is_high = [false; 3];
            (is_high[b], is_high[c]) = (sides[0], sides[1]);
            let from = self.corner(is_high);
            is_high[axis] = true;
            let ends = [from, self.corner(is_high)];
            let middle = ends.map(|p| self.camera.image(p)).iter().sum::<DVec2>() / 2.0;
            let key = if axis == 2 { middle.x } else { middle.y };
            if best.is_none_or(|(least, _)| key < least) {
                best = Some((key, ends));
            }
        }
        best.map(|(_, ends)| ends)
    }
}

/// One axis, from `a` to `b` in space.
struct Axis<'a> {
    axis: usize,
    a: DVec3,
    b: DVec3,
    factor: f64,
    /// Of the box, in the image.
    center: DVec2,
    /// Of numbers, in the image.
    height: f64,
    title: &'a str,
}

impl Axis<'_> {
    fn draw(&self, camera: &Camera, drawing: &mut Drawing) {
        let ends = [self.a, self.b].map(|p| camera.image(p));
        let along = (ends[1] - ends[0]).normalize_or_zero();
        if along == DVec2::ZERO {
            return;
        }
        let middle = ends[0] / 2.0 + ends[1] / 2.0;
        let mut out = along.perp();
        if out.dot(middle - self.center) < 0.0 {
            out = -out;
        }
        drawing.push(StrokeKind::Axis, 0, ends);
        let (from, to) = (self.a[self.axis] / self.factor, self.b[self.axis] / self.factor);
        let mut reach = 0.0_f64;
        for (value, label) in ticks(from.min(to), from.max(to)) {
            let mut p = self.a;
            p[self.axis] = value * self.factor;
            let foot = camera.image(p);
            let tip = foot + out * (0.6 * self.height);
            drawing.push(StrokeKind::Axis, 0, [foot, tip]);
            let extent = self.beside(drawing, &label, self.height, tip, out);
            reach = reach.max(extent);
        }
        if !self.title.is_empty() {
            let at = middle + out * (0.6 * self.height + reach);
            self.beside(drawing, self.title, 1.3 * self.height, at, out);
        }
    }

    /// Writes a line whose box stands off `at` in the direction `out`; returns how far it reaches.
    fn beside(&self, drawing: &mut Drawing, line: &str, height: f64, at: DVec2, out: DVec2) -> f64 {
        let (_, width) = text(line, height);
        let half = (out.x.abs() * width + out.y.abs() * height) / 2.0;
        let gap = 0.6 * self.height;
        write_centered(drawing, line, height, at + out * (gap + half));
        gap + 2.0 * half
    }
}

/// Writes a line with the middle of its capitals at `at`.
fn write_centered(drawing: &mut Drawing, line: &str, height: f64, at: DVec2) {
    let (strokes, width) = text(line, height);
    let corner = at - dvec2(width, height) / 2.0;
    for stroke in strokes {
        drawing.push(StrokeKind::Text, 0, stroke.into_iter().map(|p| corner + p));
    }
}

/// Round numbers from `low` to `high`, about [`TICKS`], with what is written beside them.
fn ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let range = high - low;
    if !(range > 0.0 && range.is_finite()) {
        return Vec::new();
    }
    let exponent = libm::floor(libm::log10(range / TICKS));
    let power = libm::pow(10.0, exponent);
    let wanted = range / TICKS / power;
    let digit = [1.0, 2.0, 5.0].into_iter().find(|digit| *digit >= wanted).unwrap_or(10.0);
    let step = digit * power;
    let first = libm::ceil(low / step);
    let count = libm::floor(high / step) - first;
    // Beyond the digits of a number, ticks would fall together.
    if !(step > 0.0 && (0.0..100.0).contains(&count) && first.abs() < 1e12) {
        return Vec::new();
    }
    let decimals = if digit == 10.0 { -exponent - 1.0 } else { -exponent }.clamp(0.0, 300.0);
    let is_plain = (-5.0..6.0).contains(&exponent) && low.abs().max(high.abs()) < 1e7;
    (0..=count as u32)
        .map(|k| {
            let number = first + f64::from(k);
            // Dividing by a whole number rounds once: 0.3, not 0.30000000000000004.
            let whole = libm::pow(10.0, decimals);
            let value = if decimals > 0.0 && whole.is_finite() {
                number * libm::round(step * whole) / whole
            } else {
                number * step
            } + 0.0;
            let label = if is_plain {
                format!("{value:.*}", decimals as usize)
            } else {
                format!("{value:e}")
            };
            (value, label)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_with_the_digits_they_need() {
        let labels = |low, high| -> Vec<String> {
            ticks(low, high).into_iter().map(|(_, label)| label).collect()
        };
        assert_eq!(labels(-5.0, 5.0), ["-4", "-2", "0", "2", "4"]);
        assert_eq!(labels(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(0.05, 0.31), ["0.1", "0.2", "0.3"]);
        assert_eq!(labels(0.0, 1234.0), ["0", "500", "1000"]);
        assert!(labels(1.0, 1.0).is_empty() && labels(1e300, 1e300 + 1e285).is_empty());
    }

    #[test]
    fn every_printable_character_has_strokes_of_its_own() {
        let glyphs: Vec<_> = ('!'..='~').map(|c| text(&c.to_string(), 6.0).0).collect();
        for (k, glyph) in glyphs.iter().enumerate() {
            assert!(
                !glyph.is_empty() && !glyphs[..k].contains(glyph),
                "{:?}",
                char::from(33 + k as u8)
            );
            let points = glyph.iter().flatten();
            assert!(points.clone().all(|p| p.x >= 0.0 && p.x <= 4.0 && p.y >= -2.0 && p.y <= 7.0));
        }
    }
}
