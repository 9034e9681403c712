//! One axis: its line, its ticks with numbers, and its title.
//!
//! ```text
//!    ──┬──────┬──────┬──         a tick leaves the box as if a grid line went on, if that is not too
//!     ╱      ╱      ╱            slanted; numbers follow in its direction, and the title lies beyond
//!   −5      0      5             all numbers
//! ```

use glam::{DVec2, DVec3};

use super::text_block::TextBlock;
use super::ticks::Ticks;
use crate::camera::Camera;
use crate::strokes::{StrokeKind, Strokes};
use crate::surface::AxisScale;

/// Length of ticks, in millimeters on paper.
const TICK_MM: f64 = 1.2;

/// Length of ticks without numbers, in millimeters on paper.
const MINOR_TICK_MM: f64 = 0.7;

/// Ticks without numbers are left out where two would be closer than this, in millimeters on paper.
const CLOSEST_TICKS_MM: f64 = 1.0;

/// The same for ticks between powers of ten: a decade must be longer than this.
const SHORTEST_DECADE_MM: f64 = 8.0;

/// Cosine of the greatest angle between ticks and the normal of their axis: 50°.
const MOST_SLANTED: f64 = 0.642_787_609_686_539_3;

/// An axis whose image is shorter than this has no numbers, in millimeters on paper.
const SHORTEST_AXIS_MM: f64 = 8.0;

/// Gap between a tick and its number, as a part of the height of numbers.
const GAP: f64 = 0.6;

/// Minimum gap between text and other text or ink, as a part of the height of numbers.
pub(super) const CLEARANCE: f64 = 0.5;

/// Minimum gap between two numbers of one axis, as a part of their height.
const BETWEEN_NUMBERS: f64 = 1.0;

/// Places that are tried for a number, relative to the usual one: along the axis by parts of half its
/// width, and away from it by parts of its height.
const SHIFTS: [(f64, f64); 12] = [
    (0.0, 0.0),
    (0.5, 0.0),
    (1.0, 0.0),
    (0.0, 0.7),
    (0.5, 0.7),
    (1.0, 0.7),
    (0.0, 1.4),
    (0.5, 1.4),
    (1.0, 1.4),
    (0.0, 2.1),
    (0.5, 2.1),
    (1.0, 2.1),
];

/// How large things are in the image.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sizes {
    /// Height of numbers.
    pub(super) text: f64,
    /// One millimeter on paper.
    pub(super) mm: f64,
}

/// An axis along an edge of the box.
#[derive(Debug, Clone, Copy)]
pub(super) struct AxisLine {
    pub(super) axis: usize,
    /// At the low and the high end of the drawn coordinate.
    pub(super) ends: [DVec3; 2],
    pub(super) scale: AxisScale,
    /// The axis along which ticks run, and the coordinate of the box's other side there.
    pub(super) across: Option<(usize, f64)>,
    /// Whether ticks point into the box.
    pub(super) inwards: bool,
}

/// A number with its tick.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LaidTick {
    pub(super) foot: DVec2,
    pub(super) tip: DVec2,
    /// `None` if there is no room for it.
    pub(super) number: Option<TextBlock>,
}

/// An axis laid out in the image.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LaidAxis {
    pub(super) axis: usize,
    pub(super) ends: [DVec2; 2],
    /// Unit vector at right angles to the axis, away from the box.
    pub(super) out: DVec2,
    pub(super) ticks: Vec<LaidTick>,
    pub(super) minors: Vec<[DVec2; 2]>,
    /// The ticks that were chosen.
    pub(super) chosen: Option<Ticks>,
    pub(super) exponent: Option<TextBlock>,
    pub(super) title: Option<TextBlock>,
    /// How far ticks and numbers reach out from the axis, but for numbers that made room for others.
    pub(super) reach: f64,
}

impl AxisLine {
    /// The point of the axis at a value.
    fn at(&self, value: f64) -> DVec3 {
        let mut p = self.ends[0];
        p[self.axis] = self.scale.drawn(value);
        p
    }

    /// Length on paper in millimeters.
    pub(super) fn length_mm(&self, camera: &Camera, sizes: &Sizes) -> f64 {
        let [a, b] = self.ends.map(|p| camera.image(p));
        a.distance(b) / sizes.mm
    }

    /// Chooses the first of the proposals whose numbers do not touch and places it. A number that would
    /// touch `taken` text or `ink` is shifted a little along its axis, or left out.
    pub(super) fn lay(
        &self,
        camera: &Camera,
        sizes: &Sizes,
        center: DVec2,
        proposals: &[Ticks],
        (taken, ink): (&[TextBlock], &[Vec<DVec2>]),
        every_second: bool,
    ) -> Option<LaidAxis> {
        let ends = self.ends.map(|p| camera.image(p));
        let along = (ends[1] - ends[0]).normalize_or_zero();
        if along == DVec2::ZERO {
            return None;
        }
        let middle = ends[0] / 2.0 + ends[1] / 2.0;
        let mut out = along.perp();
        if out.dot(middle - center) < 0.0 {
            out = -out;
        }
        let mut laid = LaidAxis {
            axis: self.axis,
            ends,
            out,
            ticks: Vec::new(),
            minors: Vec::new(),
            chosen: None,
            exponent: None,
            title: None,
            reach: 0.0,
        };
        if self.length_mm(camera, sizes) < SHORTEST_AXIS_MM {
            return Some(laid);
        }
        let clear = BETWEEN_NUMBERS * sizes.text;
        let is_legible = |ticks: &[LaidTick]| {
            let numbers: Vec<&TextBlock> = ticks.iter().filter_map(|t| t.number.as_ref()).collect();
            numbers.windows(2).all(|pair| pair[0].is_clear_of(&pair[1].corners(), clear))
        };
        let place = |ticks: &Ticks| {
            let (at, numbered) =
                (ticks.majors.iter().enumerate(), if every_second { 2 } else { 1 });
            at.map(|(k, (value, number))| {
                let number = (k % numbered == 0).then_some(&number[..]);
                self.tick(camera, sizes, out, *value, number)
            })
            .collect::<Vec<LaidTick>>()
        };
        let placed = proposals.iter().map(|ticks| (ticks, place(ticks)));
        let Some((chosen, placed)) = placed
            .clone()
            .find(|(_, placed)| is_legible(placed))
            .or_else(|| placed.min_by_key(|(_, placed)| placed.len()))
        else {
            return Some(laid);
        };
        for tick in placed {
            let reach = |text: &TextBlock| (text.anchor - ends[0]).dot(out) + text.reach(out);
            let number_reach = tick.number.as_ref().map_or(0.0, reach);
            laid.reach = laid.reach.max((tick.tip - tick.foot).dot(out)).max(number_reach);
            let number = tick.number.and_then(|number| {
                let inwards = along * (middle - tick.foot).dot(along).signum();
                let half = number.reach(along);
                SHIFTS.into_iter().find_map(|(along, away)| {
                    let mut moved = number.clone();
                    moved.anchor += inwards * (along * half) + laid.out * (away * sizes.text);
                    let own = laid.ticks.iter().filter_map(|tick| tick.number.as_ref());
                    is_clear(&moved, own.chain(taken), ink, CLEARANCE * sizes.text).then_some(moved)
                })
            });
            laid.ticks.push(LaidTick { number, ..tick });
        }
        laid.minors = self.minors(camera, sizes, out, chosen);
        laid.chosen = Some(chosen.clone());
        Some(laid)
    }

    fn tick(
        &self,
        camera: &Camera,
        sizes: &Sizes,
        out: DVec2,
        value: f64,
        number: Option<&str>,
    ) -> LaidTick {
        let (foot, way) = self.way(camera, out, value);
        let length = TICK_MM * sizes.mm;
        let sign = if self.inwards { -1.0 } else { 1.0 };
        let tip = foot + way * (length * sign);
        let outside = if self.inwards { 0.0 } else { length };
        let number = number.map(|number| {
            let mut number = TextBlock::line(number, sizes.text);
            let (steepness, gap) = (way.dot(out), GAP * sizes.text);
            let away = (outside * steepness + gap + number.reach(-out)) / steepness;
            number.anchor = foot + way * away;
            number
        });
        LaidTick { foot, tip, number }
    }

    /// The foot of a tick, and the direction out of the box in which it runs.
    fn way(&self, camera: &Camera, out: DVec2, value: f64) -> (DVec2, DVec2) {
        let p = self.at(value);
        let foot = camera.image(p);
        let across = self.across.map(|(axis, other_side)| {
            let mut opposite = p;
            opposite[axis] = other_side;
            (foot - camera.image(opposite)).normalize_or_zero()
        });
        (foot, across.filter(|way| way.dot(out) >= MOST_SLANTED).unwrap_or(out))
    }

    /// Ticks without numbers, if there is room for all of them.
    fn minors(
        &self,
        camera: &Camera,
        sizes: &Sizes,
        out: DVec2,
        chosen: &Ticks,
    ) -> Vec<[DVec2; 2]> {
        let foot = |value: f64| camera.image(self.at(value));
        let closest = |values: &[f64]| {
            let distances = values.windows(2).map(|pair| foot(pair[0]).distance(foot(pair[1])));
            distances.fold(f64::INFINITY, f64::min) / sizes.mm
        };
        let majors: Vec<f64> = chosen.majors.iter().map(|(value, _)| *value).collect();
        let has_room = if chosen.is_decades {
            closest(&majors) >= SHORTEST_DECADE_MM
        } else {
            let mut all = [&majors[..], &chosen.minors].concat();
            all.sort_by(f64::total_cmp);
            closest(&all) >= CLOSEST_TICKS_MM
        };
        let length = MINOR_TICK_MM * sizes.mm * if self.inwards { -1.0 } else { 1.0 };
        let minors = chosen.minors.iter().filter(|_| has_room).map(|&value| {
            let (foot, way) = self.way(camera, out, value);
            [foot, foot + way * length]
        });
        minors.collect()
    }
}

impl LaidAxis {
    /// Its numbers, the power of ten they share, and its title.
    pub(super) fn texts(&self) -> impl Iterator<Item = &TextBlock> {
        self.numbers().chain(&self.title)
    }

    fn numbers(&self) -> impl Iterator<Item = &TextBlock> {
        let numbers = self.ticks.iter().filter_map(|tick| tick.number.as_ref());
        numbers.chain(&self.exponent)
    }

    /// Its ticks as ink.
    pub(super) fn ink(&self) -> impl Iterator<Item = Vec<DVec2>> {
        let ticks = self.ticks.iter().map(|tick| vec![tick.foot, tick.tip]);
        ticks.chain(self.minors.iter().map(|minor| minor.to_vec()))
    }

    pub(super) fn draw(&self, drawing: &mut Strokes) {
        drawing.push(StrokeKind::Axis, 0, self.ends);
        for tick in &self.ticks {
            drawing.push(StrokeKind::Axis, 0, [tick.foot, tick.tip]);
        }
        for minor in &self.minors {
            drawing.push(StrokeKind::Axis, 0, *minor);
        }
        self.numbers().for_each(|text| text.draw(StrokeKind::Text, drawing));
        self.title.iter().for_each(|title| title.draw(StrokeKind::Title, drawing));
    }
}

/// Whether text is at least `clearance` away from other text and from ink.
pub(super) fn is_clear<'a>(
    text: &TextBlock,
    mut texts: impl Iterator<Item = &'a TextBlock>,
    ink: &[Vec<DVec2>],
    clearance: f64,
) -> bool {
    texts.all(|other| text.is_clear_of(&other.corners(), clearance))
        && ink.iter().all(|ink| text.is_clear_of(ink, clearance))
}
