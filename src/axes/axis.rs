//! One axis: its line, its ticks with numbers, and its title, laid out so that no two texts touch.

use glam::{DVec2, DVec3};

use super::font::text;
use super::ticks::ticks;
use crate::camera::Camera;
use crate::strokes::{StrokeKind, Strokes};

/// Length of ticks and gap beside text, as a fraction of the height of numbers.
const SPACE: f64 = 0.6;

/// Minimum horizontal and vertical gap between two texts, as fractions of the height of numbers: wider
/// than a blank, with room for descenders.
const CLEARANCE: DVec2 = DVec2::new(1.0, 0.5);

/// One axis, from `a` to `b` in model space.
pub(super) struct Axis<'a> {
    pub(super) axis: usize,
    pub(super) a: DVec3,
    pub(super) b: DVec3,
    pub(super) factor: f64,
    /// Center of the box in the image.
    pub(super) center: DVec2,
    /// Height of numbers in the image.
    pub(super) height: f64,
    pub(super) title: &'a str,
}

/// A line of text at its position.
pub(super) struct Label {
    line: String,
    height: f64,
    center: DVec2,
    half_size: DVec2,
}

/// An axis laid out in the image.
pub(super) struct Laid {
    ends: [DVec2; 2],
    /// Unit vector pointing away from the box.
    out: DVec2,
    /// Foot, tip and number of each tick; the number is `None` if there is no room for it.
    ticks: Vec<(DVec2, DVec2, Option<Label>)>,
    title: Option<Label>,
}

impl Label {
    /// A line of text whose box is `gap` away from `at` in the direction `out`.
    fn beside(line: &str, height: f64, at: DVec2, out: DVec2, gap: f64) -> Self {
        let (_, width) = text(line, height);
        let half_size = DVec2::new(width, height) / 2.0;
        let center = at + out * (gap + half_size.dot(out.abs()));
        Self { line: line.to_owned(), height, center, half_size }
    }

    fn is_clear_of(&self, other: &Self, space: DVec2) -> bool {
        let apart = (self.center - other.center).abs() - self.half_size - other.half_size;
        apart.cmpge(space).any()
    }

    /// The bounding box of its strokes.
    #[cfg(test)]
    pub(super) fn drawn_box(&self) -> (DVec2, DVec2) {
        let mut drawing = Strokes::default();
        self.draw(&mut drawing);
        drawing.bounds().unwrap_or((self.center, self.center))
    }

    /// Draws the text, with its capitals centered vertically.
    fn draw(&self, drawing: &mut Strokes) {
        let (strokes, _) = text(&self.line, self.height);
        let corner = self.center - self.half_size;
        for stroke in strokes {
            drawing.push(StrokeKind::Text, 0, stroke.into_iter().map(|p| corner + p));
        }
    }
}

impl Axis<'_> {
    /// Places ticks and numbers so that no number touches another one, on this axis or on `others`. If
    /// numbers of this axis would touch, it gets fewer ticks. A number that would touch one of another
    /// axis is shifted a little along its own axis, or left out.
    pub(super) fn lay(&self, camera: &Camera, others: &[Laid]) -> Option<Laid> {
        let ends = [self.a, self.b].map(|p| camera.image(p));
        let along = (ends[1] - ends[0]).normalize_or_zero();
        if along == DVec2::ZERO {
            return None;
        }
        let middle = ends[0] / 2.0 + ends[1] / 2.0;
        let mut out = along.perp();
        if out.dot(middle - self.center) < 0.0 {
            out = -out;
        }
        let clearance = CLEARANCE * self.height;
        let mut placed = self.numbers(camera, out, 0);
        let mut coarser = 0;
        while !placed.windows(2).all(|pair| pair[0].2.is_clear_of(&pair[1].2, clearance)) {
            coarser += 1;
            let fewer = self.numbers(camera, out, coarser);
            if fewer.is_empty() {
                placed.truncate(1);
            } else {
                placed = fewer;
            }
        }
        let taken = || others.iter().flat_map(Laid::labels);
        let mut laid = Laid { ends, out, ticks: Vec::with_capacity(placed.len()), title: None };
        for (foot, tip, label) in placed {
            let inwards = along * (middle - foot).dot(along).signum();
            let half = label.half_size.dot(along.abs());
            let moved = [0.0, 0.5, 1.0].into_iter().find_map(|part| {
                let center = label.center + inwards * (part * half);
                let Label { height, half_size, .. } = label;
                let moved = Label { line: label.line.clone(), height, center, half_size };
                let is_clear = |other: &Label| moved.is_clear_of(other, clearance);
                (taken().all(is_clear) && laid.labels().all(is_clear)).then_some(moved)
            });
            laid.ticks.push((foot, tip, moved));
        }
        Some(laid)
    }

    /// Foot, tip and number of each tick.
    fn numbers(&self, camera: &Camera, out: DVec2, coarser: u32) -> Vec<(DVec2, DVec2, Label)> {
        let (from, to) = (self.a[self.axis] / self.factor, self.b[self.axis] / self.factor);
        let at_tick = |(value, label): (f64, String)| {
            let mut p = self.a;
            p[self.axis] = value * self.factor;
            let foot = camera.image(p);
            let space = SPACE * self.height;
            let tip = foot + out * space;
            (foot, tip, Label::beside(&label, self.height, tip, out, space))
        };
        ticks(from.min(to), from.max(to), coarser).into_iter().map(at_tick).collect()
    }

    /// The title, outside the numbers of this axis and clear of all other text.
    pub(super) fn place_title(&self, k: usize, all: &[Laid]) -> Option<Label> {
        let laid = all.get(k).filter(|_| !self.title.is_empty())?;
        let space = SPACE * self.height;
        let beyond = |label: &Label| space + 2.0 * label.half_size.dot(laid.out.abs());
        let reach = laid.labels().map(beyond).fold(0.0, f64::max);
        let middle = laid.ends[0] / 2.0 + laid.ends[1] / 2.0;
        let at = middle + laid.out * (space + reach);
        let mut title = Label::beside(self.title, 1.3 * self.height, at, laid.out, space);
        let clearance = CLEARANCE * self.height;
        let is_clear = |title: &Label| {
            all.iter().flat_map(Laid::labels).all(|other| title.is_clear_of(other, clearance))
        };
        for _ in 0..MOST_STEPS {
            if is_clear(&title) {
                break;
            }
            title.center += laid.out * (space / 2.0);
        }
        Some(title)
    }
}

/// How many times at most a title moves farther out, by half the gap beside it each time.
const MOST_STEPS: usize = 200;

impl Laid {
    /// Its numbers and its title.
    pub(super) fn labels(&self) -> impl Iterator<Item = &Label> {
        self.ticks.iter().filter_map(|(.., label)| label.as_ref()).chain(&self.title)
    }

    pub(super) fn set_title(&mut self, title: Option<Label>) {
        self.title = title;
    }

    pub(super) fn draw(&self, drawing: &mut Strokes) {
        drawing.push(StrokeKind::Axis, 0, self.ends);
        for (foot, tip, label) in &self.ticks {
            drawing.push(StrokeKind::Axis, 0, [*foot, *tip]);
            if let Some(label) = label {
                label.draw(drawing);
            }
        }
        if let Some(title) = &self.title {
            title.draw(drawing);
        }
    }
}

/// Draws a line of text centered at `at`.
pub(super) fn write_centered(drawing: &mut Strokes, line: &str, height: f64, at: DVec2) {
    Label::beside(line, height, at, DVec2::ZERO, 0.0).draw(drawing);
}
