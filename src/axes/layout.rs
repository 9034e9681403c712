//! Placement of axes, numbers and titles so that no text touches ink or other text.

use glam::{DVec2, DVec3, dvec2};

use super::axis::{AxisLine, CLEARANCE, LaidAxis, Sizes, is_clear};
use super::bounding_box::{BoundingBox, EdgePlace, hull};
use super::font::text;
use super::options::{Axes, AxesStyle, BoxFront, ZAxis};
use super::text_block::{TextBlock, wrapped};
use super::ticks::{AxisRange, Ticks, has_too_many, proposals};
use super::walls::{self, Wire};
use crate::camera::Camera;
use crate::strokes::{StrokeKind, Strokes};
use crate::surface::AxisScale;

/// Height of titles of axes, as a multiple of that of numbers.
const TITLE: f64 = 1.2;

/// Height of the title of the drawing, as a multiple of that of numbers.
const DRAWING_TITLE: f64 = 1.5;

/// An axis has numbers about every so many of their heights.
const HEIGHTS_PER_NUMBER: f64 = 4.0;

/// Fewest and most numbers that are aimed at.
const NUMBERS: (f64, f64) = (3.0, 9.0);

/// A title longer than this part of its axis is written along it.
const SHORT_TITLE: f64 = 1.0 / 3.0;

/// A title of the z axis with more letters than this is written along it.
const FEW_LETTERS: usize = 3;

/// An axis that rises more than this is read from below.
const STEEP: f64 = 2.0;

/// Most lines of a title.
const MOST_LINES: usize = 3;

/// How many times at most a text moves farther out, by a quarter of a number's height each time.
const MOST_STEPS: usize = 400;

/// Dashes and gaps of the box's front edges, in millimeters on paper.
const DASH_MM: f64 = 1.0;

/// The box that axes are drawn around, in the coordinates of the drawn surface, and the values there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxesBox {
    /// The lowest corner.
    pub low: DVec3,
    /// The highest corner.
    pub high: DVec3,
    /// How values become coordinates.
    pub scales: [AxisScale; 3],
    /// The smallest and the largest value of each axis.
    pub ranges: [(f64, f64); 3],
    /// Whether the range of z may grow to the next numbers.
    pub z_may_grow: bool,
}

/// How much room text may take up.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Economy {
    /// As much as it likes.
    #[default]
    None,
    /// Titles are broken into several lines.
    Wrapped,
    /// Numbers share powers of ten.
    Exponents,
    /// Every second tick has a number.
    EverySecond,
    /// Text is smaller.
    Smaller,
    /// Titles stand at the ends of axes.
    AtEnds,
}

impl Economy {
    /// All of them, each with all that those before it do.
    pub const ALL: [Self; 6] = [
        Self::None,
        Self::Wrapped,
        Self::Exponents,
        Self::EverySecond,
        Self::Smaller,
        Self::AtEnds,
    ];
}

/// How much smaller text is where room is scarce.
const SMALLER: f64 = 0.85;

/// How large text and ticks are in the image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxesSize {
    /// Height of numbers, in millimeters on paper.
    pub text_mm: f64,
    /// Millimeters on paper for one unit of the image.
    pub mm_per_unit: f64,
    /// How much room text may take up.
    pub economy: Economy,
}

impl AxesSize {
    /// Height of numbers in the image.
    pub fn text(&self) -> f64 {
        let smaller = if self.economy >= Economy::Smaller { SMALLER } else { 1.0 };
        smaller * self.text_mm / self.mm_per_unit
    }
}

/// Axes laid out for an image.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct AxesLayout {
    pub(super) axes: Vec<LaidAxis>,
    pub(super) title: Option<TextBlock>,
    /// Solid or dashed lines that nothing hides.
    lines: Vec<(StrokeKind, [DVec2; 2])>,
    /// The image of the box.
    pub(super) hull: Vec<DVec2>,
    wires: Vec<Wire>,
    has_too_many_ticks: bool,
    base: Option<f64>,
}

impl AxesLayout {
    /// Lays axes out around a box. `None` if a corner of the box is in front of the near plane, or the box
    /// has no extent in the image.
    pub fn new(around: &AxesBox, camera: &Camera, axes: &Axes, size: &AxesSize) -> Option<Self> {
        let sizes = Sizes { text: size.text(), mm: 1.0 / size.mm_per_unit };
        let is_map = is_straight_down(camera);
        let style = axes.style.unwrap_or(if is_map { AxesStyle::Frame } else { AxesStyle::Edges });
        let economy = size.economy;
        let mut bbox = BoundingBox { low: around.low, high: around.high, camera };
        if !(is_seen(&bbox) && sizes.text > 0.0 && sizes.text.is_finite()) {
            return None;
        }
        let mut chosen: Option<Ticks> = None;
        if around.z_may_grow && style != AxesStyle::Frame {
            let layouter = Layouter { around, bbox, axes, style, sizes, economy };
            chosen = layouter.z_ticks();
            if let Some(ticks) = &chosen {
                let drawn = [ticks.range.0, ticks.range.1].map(|z| around.scales[2].drawn(z));
                bbox.low.z = bbox.low.z.min(drawn[0]).min(drawn[1]);
                bbox.high.z = bbox.high.z.max(drawn[0]).max(drawn[1]);
            }
            if !is_seen(&bbox) {
                return None;
            }
        }
        let layouter = Layouter { around, bbox, axes, style, sizes, economy };
        let base = Some(bbox.side(2, bbox.is_front(2, false)));
        let layout = AxesLayout { base, ..layouter.layout(chosen) };
        (!layout.hull.is_empty()).then_some(layout)
    }

    /// The strokes that nothing hides.
    pub fn strokes(&self) -> Strokes {
        let mut drawing = Strokes::default();
        for (kind, line) in &self.lines {
            drawing.push(*kind, 0, *line);
        }
        self.axes.iter().for_each(|axis| axis.draw(&mut drawing));
        if let Some(title) = &self.title {
            title.draw(StrokeKind::Title, &mut drawing);
        }
        drawing
    }

    /// Lines behind the surface.
    pub fn wires(&self) -> &[Wire] {
        &self.wires
    }

    /// The height of the horizontal face of the box that is behind the surface; `None` without axes.
    pub fn base(&self) -> Option<f64> {
        self.base
    }

    /// The corners of the box's image.
    pub fn box_in_image(&self) -> &[DVec2] {
        &self.hull
    }

    /// Whether an axis has other ticks than requested, because these would be too many.
    pub fn has_too_many_ticks(&self) -> bool {
        self.has_too_many_ticks
    }

    /// All text.
    #[cfg(test)]
    pub(super) fn texts(&self) -> impl Iterator<Item = &TextBlock> {
        self.axes.iter().flat_map(LaidAxis::texts).chain(&self.title)
    }
}

/// The height of the horizontal face of a box that is behind what is in it.
pub fn base_height(around: &AxesBox, camera: &Camera) -> f64 {
    let bbox = BoundingBox { low: around.low, high: around.high, camera };
    bbox.side(2, bbox.is_front(2, false))
}

/// Whether a camera looks straight down or up in orthographic projection, so that a surface is seen as a map.
pub fn is_straight_down(camera: &Camera) -> bool {
    let forward = camera.forward();
    camera.near_distance().is_none() && forward.x == 0.0 && forward.y == 0.0
}

/// Whether the whole box is in front of the camera, with an extent in the image.
fn is_seen(bbox: &BoundingBox) -> bool {
    let camera = bbox.camera;
    let near = camera.near_distance().unwrap_or(f64::NEG_INFINITY);
    let forward = camera.frame().forward;
    let corners = bbox.corners();
    let is_in_front = |p: &DVec3| p.is_finite() && (*p - camera.eye()).dot(forward) > near;
    let images = corners.map(|p| camera.image(p));
    corners.iter().all(is_in_front)
        && images.iter().all(|p| p.is_finite())
        && images.iter().any(|p| *p != images[0])
}

struct Layouter<'a> {
    around: &'a AxesBox,
    bbox: BoundingBox<'a>,
    axes: &'a Axes,
    style: AxesStyle,
    sizes: Sizes,
    economy: Economy,
}

impl Layouter<'_> {
    /// The line of an axis, if it has one on the outline.
    fn line(&self, axis: usize) -> Option<AxisLine> {
        let bbox = &self.bbox;
        let is_map = self.style == AxesStyle::Frame;
        let edge = match axis {
            2 if is_map => return None,
            2 => {
                let sign = if self.axes.z_axis == ZAxis::Right { -1.0 } else { 1.0 };
                bbox.outline_edge(2, |p| p.x * sign)?
            }
            // On a map that is turned, x may be upright.
            _ if is_map => {
                let [a, b] = bbox.image_of(&bbox.edges(axis).next()?);
                let is_upright = (b - a).y.abs() > (b - a).x.abs();
                bbox.outline_edge(axis, |p| if is_upright { p.x } else { p.y })?
            }
            _ => bbox.outline_edge(axis, |p| p.y)?,
        };
        let across = bbox.across(&edge).map(|other| (other, bbox.side(other, !edge.sides[other])));
        let scale = self.around.scales[axis];
        Some(AxisLine { axis, ends: bbox.ends(&edge), scale, across, inwards: is_map })
    }

    /// Ticks for an axis, the best ones first.
    fn proposals(&self, line: &AxisLine, may_grow: bool) -> Vec<Ticks> {
        let (low, high) = self.around.ranges[line.axis];
        let range = AxisRange {
            low,
            high,
            is_log: line.scale.is_log,
            may_grow,
            saves_digits: self.economy >= Economy::Exponents,
        };
        let length = line.length_mm(self.bbox.camera, &self.sizes) * self.sizes.mm;
        let wanted = (length / (HEIGHTS_PER_NUMBER * self.sizes.text)).clamp(NUMBERS.0, NUMBERS.1);
        proposals(&range, self.axes.ticks[line.axis], wanted)
    }

    fn lay(
        &self,
        line: &AxisLine,
        proposals: &[Ticks],
        taken: (&[TextBlock], &[Vec<DVec2>]),
    ) -> Option<LaidAxis> {
        let every_second = self.economy >= Economy::EverySecond;
        line.lay(self.bbox.camera, &self.sizes, self.center(), proposals, taken, every_second)
    }

    fn center(&self) -> DVec2 {
        self.bbox.corners().iter().map(|p| self.bbox.camera.image(*p)).sum::<DVec2>() / 8.0
    }

    /// The ticks of a z axis that may grow.
    fn z_ticks(&self) -> Option<Ticks> {
        let line = self.line(2)?;
        let proposals = self.proposals(&line, true);
        self.lay(&line, &proposals, (&[], &[]))?.chosen
    }

    fn layout(&self, z_ticks: Option<Ticks>) -> AxesLayout {
        let camera = self.bbox.camera;
        let corners = self.bbox.corners().map(|p| camera.image(p));
        let mut layout = AxesLayout { hull: hull(&corners), ..AxesLayout::default() };
        let (mut texts, mut ink) = (Vec::new(), vec![layout.hull.clone()]);
        let mut chosen: [Option<Ticks>; 3] = Default::default();
        // The numbers of z move least to make room.
        for axis in [2, 0, 1] {
            let Some(line) = self.line(axis) else { continue };
            let proposals = match &z_ticks {
                Some(ticks) if axis == 2 => vec![ticks.clone()],
                _ => self.proposals(&line, false),
            };
            let Some(laid) = self.lay(&line, &proposals, (&texts, &ink[1..])) else { continue };
            layout.has_too_many_ticks |= self.has_too_many_ticks(&line);
            texts.extend(laid.texts().cloned());
            if !line.inwards {
                ink.extend(laid.ink());
            }
            chosen[axis] = laid.chosen.clone();
            layout.axes.push(laid);
        }
        layout.axes.sort_by_key(|laid| laid.axis);
        self.other_lines(&mut layout, &chosen);
        // A number next to another axis may touch its ticks, which came later.
        for axis in &mut layout.axes {
            for tick in &mut axis.ticks {
                let is_clear = |text: &TextBlock| {
                    is_clear(text, [].into_iter(), &ink[1..], CLEARANCE * self.sizes.text)
                };
                tick.number = tick.number.take().filter(is_clear);
            }
        }
        let numbers = layout.axes.iter().flat_map(LaidAxis::texts).cloned();
        let mut texts: Vec<TextBlock> = numbers.collect();
        for axis in &mut layout.axes {
            axis.exponent = self.exponent(axis, &texts, &ink);
            texts.extend(axis.exponent.clone());
        }
        for axis in &mut layout.axes {
            axis.title = self.title(axis, &texts, &ink);
            texts.extend(axis.title.clone());
        }
        layout.title = self.drawing_title(&layout.hull, &texts);
        layout
    }

    fn has_too_many_ticks(&self, line: &AxisLine) -> bool {
        let (low, high) = self.around.ranges[line.axis];
        let range = AxisRange {
            low,
            high,
            is_log: line.scale.is_log,
            may_grow: false,
            saves_digits: false,
        };
        has_too_many(&range, self.axes.ticks[line.axis])
    }

    /// The lines of the style that are not axes.
    fn other_lines(&self, layout: &mut AxesLayout, chosen: &[Option<Ticks>; 3]) {
        let bbox = &self.bbox;
        let axes: Vec<[DVec2; 2]> = layout.axes.iter().map(|axis| axis.ends).collect();
        let edges = || (0..3).flat_map(|axis| bbox.edges(axis));
        let is_outline = |edge: &_| bbox.place(edge) == EdgePlace::Outline;
        // Axes are drawn already.
        let solid = |lines: &mut Vec<(StrokeKind, [DVec2; 2])>, kind, edge: &_| {
            let ends = bbox.image_of(edge);
            if !axes.contains(&ends) && ends[0] != ends[1] {
                lines.push((kind, ends));
            }
        };
        match self.style {
            AxesStyle::Edges => {}
            AxesStyle::Base => {
                let is_high = bbox.is_front(2, false);
                let is_base =
                    |edge: &super::bounding_box::BoxEdge| edge.axis < 2 && edge.sides[2] == is_high;
                edges()
                    .filter(|e| is_base(e) && is_outline(e))
                    .for_each(|e| solid(&mut layout.lines, StrokeKind::Box, &e));
                let is_hidden =
                    |e: &super::bounding_box::BoxEdge| is_base(e) && walls::is_behind(bbox, e);
                layout.wires = walls::edges(bbox, StrokeKind::Box, is_hidden);
                layout.wires.extend(self.base_ticks(chosen, is_high));
            }
            AxesStyle::Back | AxesStyle::Box => {
                layout.wires = walls::grid(bbox, chosen, &self.around.scales);
                let is_behind = |e: &_| walls::is_behind(bbox, e);
                layout.wires.extend(walls::edges(bbox, StrokeKind::Back, is_behind));
                let is_box = self.style == AxesStyle::Box;
                for edge in edges().filter(is_outline) {
                    match walls::is_beside_wall(bbox, &edge) {
                        true => solid(&mut layout.lines, StrokeKind::Back, &edge),
                        false if is_box => solid(&mut layout.lines, StrokeKind::Box, &edge),
                        false => {}
                    }
                }
                if is_box && self.axes.box_front != BoxFront::None {
                    for edge in edges().filter(|e| bbox.place(e) == EdgePlace::Front) {
                        let ends = bbox.image_of(&edge);
                        match self.axes.box_front {
                            BoxFront::Dashed => {
                                let dashes = dashes(ends, DASH_MM * self.sizes.mm).into_iter();
                                layout.lines.extend(dashes.map(|dash| (StrokeKind::Box, dash)));
                            }
                            _ => solid(&mut layout.lines, StrokeKind::Box, &edge),
                        }
                    }
                }
            }
            AxesStyle::Frame => {
                let is_high = bbox.is_front(2, true);
                for edge in edges().filter(|e| e.axis < 2 && e.sides[2] == is_high) {
                    let ends = bbox.image_of(&edge);
                    if axes.contains(&ends) {
                        continue;
                    }
                    solid(&mut layout.lines, StrokeKind::Axis, &edge);
                    let opposite = layout.axes.iter().find(|axis| axis.axis == edge.axis);
                    let Some(opposite) = opposite else { continue };
                    let shift = ends[0] - opposite.ends[0];
                    let across =
                        |[foot, tip]: [DVec2; 2]| [foot + shift, foot + shift - (tip - foot)];
                    let ticks = opposite.ticks.iter().map(|tick| [tick.foot, tick.tip]);
                    let ticks = ticks.chain(opposite.minors.iter().copied()).map(across);
                    layout.lines.extend(ticks.map(|tick| (StrokeKind::Axis, tick)));
                }
            }
        }
    }

    /// Ticks on the sides of the base that are not axes, pointing inwards.
    fn base_ticks(&self, chosen: &[Option<Ticks>; 3], is_high: bool) -> Vec<Wire> {
        let bbox = &self.bbox;
        let mut wires = Vec::new();
        for axis in 0..2 {
            let (Some(ticks), other) = (&chosen[axis], 1 - axis) else { continue };
            for edge in bbox.edges(axis).filter(|edge| edge.sides[2] == is_high) {
                if !walls::is_between_walls(bbox, &edge) {
                    continue;
                }
                for (value, _) in &ticks.majors {
                    let mut foot = bbox.corner(edge.sides);
                    foot[axis] = self.around.scales[axis].drawn(*value);
                    let mut opposite = foot;
                    opposite[other] = bbox.side(other, !edge.sides[other]);
                    let length = bbox.camera.image(foot).distance(bbox.camera.image(opposite));
                    let part = (BASE_TICK_MM * self.sizes.mm / length).min(0.25);
                    let tip = foot + (opposite - foot) * part;
                    wires.push(Wire { ends: [foot, tip], kind: StrokeKind::Axis });
                }
            }
        }
        wires
    }

    /// The power of ten that numbers share, beyond the end of the axis.
    fn exponent(
        &self,
        axis: &LaidAxis,
        texts: &[TextBlock],
        ink: &[Vec<DVec2>],
    ) -> Option<TextBlock> {
        let exponent = axis.chosen.as_ref()?.exponent?;
        let line = format!("×10^{{{}}}", exponent.to_string().replace('-', "−"));
        let mut block = TextBlock::line(&line, self.sizes.text);
        let along = (axis.ends[1] - axis.ends[0]).normalize_or_zero();
        let gap = CLEARANCE * self.sizes.text;
        let away = (axis.reach - block.reach(axis.out)).max(gap + block.reach(-axis.out));
        block.anchor = axis.ends[1] + axis.out * away + along * block.reach(-along);
        self.push_out(block, along, (texts, ink), gap)
    }

    /// Moves text in a direction until it is at least `clearance` away from text and ink.
    fn push_out(
        &self,
        mut block: TextBlock,
        direction: DVec2,
        (texts, ink): (&[TextBlock], &[Vec<DVec2>]),
        clearance: f64,
    ) -> Option<TextBlock> {
        for _ in 0..MOST_STEPS {
            if is_clear(&block, texts.iter(), ink, clearance) {
                break;
            }
            block.anchor += direction * (self.sizes.text / 4.0);
        }
        Some(block)
    }

    /// The title of an axis, beyond its numbers.
    fn title(&self, axis: &LaidAxis, texts: &[TextBlock], ink: &[Vec<DVec2>]) -> Option<TextBlock> {
        let title = &self.axes.titles.axes[axis.axis];
        if title.trim().is_empty() {
            return None;
        }
        let height = TITLE * self.sizes.text;
        let width = |line: &str| text(line, height).1;
        let along = (axis.ends[1] - axis.ends[0]).normalize_or_zero();
        let length = axis.ends[0].distance(axis.ends[1]);
        let is_long = width(title) > SHORT_TITLE * length
            || axis.axis == 2 && title.chars().count() > FEW_LETTERS;
        let at_end = self.economy >= Economy::AtEnds;
        let longest = if self.economy >= Economy::Wrapped { 0.5 * length } else { length };
        let longest = if at_end { SHORT_TITLE * length } else { longest };
        let lines = wrapped(title, longest, MOST_LINES, width);
        // Read from the left, or from below if the axis is steep.
        let is_steep = along.y.abs() > STEEP * along.x.abs();
        let is_forward = if is_steep { along.y > 0.0 } else { along.x > 0.0 };
        let reading = if is_forward { along } else { -along };
        let direction = if is_long && !at_end { reading } else { DVec2::X };
        let mut block = TextBlock::new(lines, height, direction);
        let gap = GAP_TO_TITLE * self.sizes.text;
        if at_end {
            block.anchor = axis.ends[1] + along * (gap + block.reach(-along));
            return self.push_out(block, (along + axis.out) / 2.0, (texts, ink), gap);
        }
        let middle = axis.ends[0] / 2.0 + axis.ends[1] / 2.0;
        block.anchor = middle + axis.out * (axis.reach + gap + block.reach(-axis.out));
        self.push_out(block, axis.out, (texts, ink), gap)
    }

    /// The title of the drawing, above everything.
    fn drawing_title(&self, hull: &[DVec2], texts: &[TextBlock]) -> Option<TextBlock> {
        let title = &self.axes.titles.drawing;
        if title.trim().is_empty() {
            return None;
        }
        let height = DRAWING_TITLE * self.sizes.text;
        let (left, right) = span(hull.iter().map(|p| p.x));
        let corners = texts.iter().flat_map(TextBlock::corners);
        let (_, top) = span(hull.iter().copied().chain(corners).map(|p| p.y));
        let lines = wrapped(title, right - left, MOST_LINES, |line| text(line, height).1);
        let mut block = TextBlock::new(lines, height, DVec2::X);
        block.anchor = dvec2(left / 2.0 + right / 2.0, top + height + block.reach(-DVec2::Y));
        Some(block)
    }
}

/// Gap between numbers and a title, as a part of the height of numbers.
const GAP_TO_TITLE: f64 = 0.9;

/// Length of the ticks on the other sides of the base, in millimeters on paper.
const BASE_TICK_MM: f64 = 1.2;

fn span(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}

/// Dashes of a length, with gaps as long, beginning and ending with one.
fn dashes([a, b]: [DVec2; 2], length: f64) -> Vec<[DVec2; 2]> {
    let n = ((a.distance(b) / length - 1.0) / 2.0).round().max(0.0) as u32;
    let parts = f64::from(2 * n + 1);
    let at = |k: u32| a.lerp(b, f64::from(k) / parts);
    (0..=n).map(|k| [at(2 * k), at(2 * k + 1)]).collect()
}
