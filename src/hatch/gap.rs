//! The white margin of hatching beside nearer outlines.
//!
//! ```text
//!   ═══════════ outline of something nearer; its own hatching goes up to the line
//!    ↕ gap      no hatching of what lies behind
//!   ─────────── hatching of what lies behind
//! ```
//!
//! A. Appel, F. J. Rohlf and A. J. Stein, "The haloed line effect for hidden line elimination", SIGGRAPH
//! 1979, for hatching only: on the outer side of the outline, and of what is clearly farther away.

use glam::DVec2;
use rustc_hash::FxHashMap;

use super::interval::Interval;
use crate::camera::{ImagePoint, Projection};
use crate::classify::{LineSelection, ViewedScene};
use crate::engines::visibility::Visibility;
use crate::predicates::Sign;
use crate::strokes::StrokeKind;

/// Lines are cut into pieces of at most this length to be looked up.
const CELL_MM: f64 = 4.0;

/// What lies behind an outline by less than this many margins is not behind it but beside it: a face
/// that continues there.
const LEAST_DEPTH_IN_GAPS: f64 = 2.0;

/// The lines that have margins: where the surface ends in the image.
pub(super) fn outlines() -> LineSelection {
    LineSelection::NONE
        .with(StrokeKind::Silhouette)
        .with(StrokeKind::Boundary)
        .with(StrokeKind::Nonmanifold)
}

/// A piece of an outline, in millimeters from the image's origin.
#[derive(Debug, Clone, Copy)]
struct Outline {
    ends: [DVec2; 2],
    /// Nearness at both ends: smaller is nearer, and linear in the image.
    nearness: [f64; 2],
    depth: f64,
    /// 1 when the outer side is on the left, or else −1; 0 when both sides are.
    outer: f64,
}

/// All margins, by cells of the image.
#[derive(Debug)]
pub(super) struct Gaps {
    outlines: Vec<Outline>,
    cells: FxHashMap<[i32; 2], Vec<u32>>,
    gap_mm: f64,
    mm_per_image_unit: f64,
    is_perspective: bool,
}

impl Gaps {
    /// The margins of what is visible of the outlines among the lines of `view`.
    pub(super) fn new(
        view: &ViewedScene,
        visibility: &Visibility,
        gap_mm: f64,
        mm_per_image_unit: f64,
    ) -> Self {
        let is_perspective = matches!(view.camera().projection(), Projection::Perspective { .. });
        let mut gaps = Self {
            outlines: Vec::new(),
            cells: FxHashMap::default(),
            gap_mm,
            mm_per_image_unit,
            is_perspective,
        };
        if gap_mm == 0.0 {
            return gaps;
        }
        for (i, drawn) in view.selected().iter().enumerate() {
            if drawn.kind == StrokeKind::Hatch {
                continue;
            }
            let Some(outer) = outer_side(view, drawn.edge) else { continue };
            let ends = view.line(drawn.edge).map(|end| view.image()[end as usize]);
            for span in visibility.spans(i).iter().filter(|span| span.qi == 0) {
                let [from, to] = [span.t0, span.t1].map(|t| ends[0].towards(ends[1], t));
                gaps.add([from, to], outer);
            }
        }
        for (number, outline) in (0..).zip(&gaps.outlines) {
            let [a, b] = outline.ends;
            let (low, high) = (a.min(b) - gap_mm, a.max(b) + gap_mm);
            let (low, high) = (cell(low), cell(high));
            for y in low[1]..=high[1] {
                for x in low[0]..=high[0] {
                    gaps.cells.entry([x, y]).or_default().push(number);
                }
            }
        }
        gaps
    }

    fn nearness(&self, point: ImagePoint) -> f64 {
        if self.is_perspective { -1.0 / point.depth } else { point.depth }
    }

    /// Adds a visible part of an outline in short pieces.
    fn add(&mut self, ends: [ImagePoint; 2], outer: f64) {
        let [a, b] = ends.map(|end| end.image() * self.mm_per_image_unit);
        let [near_a, near_b] = ends.map(|end| self.nearness(end));
        let length = a.distance(b);
        if !length.is_finite() || length > MOST_MM {
            return;
        }
        let n = (length / CELL_MM).ceil().max(1.0) as u32;
        for k in 0..n {
            let [s, t] = [k, k + 1].map(|k| f64::from(k) / f64::from(n));
            let nearness = [s, t].map(|s| near_a + (near_b - near_a) * s);
            self.outlines.push(Outline {
                ends: [a.lerp(b, s), a.lerp(b, t)],
                nearness,
                depth: ends[0].depth.min(ends[1].depth),
                outer,
            });
        }
    }

    /// Takes the margins out of the drawn intervals of a segment with these ends; nothing stays there.
    pub(super) fn cut(&self, ends: [ImagePoint; 2], intervals: &mut Vec<Interval>) {
        if self.outlines.is_empty() || intervals.iter().all(|part| !part.is_drawn) {
            return;
        }
        let [w0, w1] = ends.map(|end| end.w);
        if !(w0 > 0.0 && w1 > 0.0) {
            return;
        }
        let [a, b] = ends.map(|end| end.image() * self.mm_per_image_unit);
        let mut near: Vec<u32> = Vec::new();
        let n = (a.distance(b) / CELL_MM).ceil().clamp(1.0, 1024.0) as u32;
        for k in 0..n {
            let [p, q] = [k, k + 1].map(|k| cell(a.lerp(b, f64::from(k) / f64::from(n))));
            for y in p[1].min(q[1])..=p[1].max(q[1]) {
                for x in p[0].min(q[0])..=p[0].max(q[0]) {
                    near.extend(self.cells.get(&[x, y]).into_iter().flatten());
                }
            }
        }
        near.sort_unstable();
        near.dedup();
        let nearness = ends.map(|end| self.nearness(end));
        for number in near {
            let outline = &self.outlines[number as usize];
            let Some([s0, s1]) = self.margin(outline, [a, b], nearness) else { continue };
            // From parts of the way in the image to parts of the way in space.
            let [t0, t1] = [s0, s1].map(|s| s * w0 / (w1 * (1.0 - s) + w0 * s));
            let mut kept = Vec::with_capacity(intervals.len() + 1);
            for part in intervals.iter() {
                if !part.is_drawn || part.t1 <= t0 || part.t0 >= t1 {
                    kept.push(*part);
                    continue;
                }
                if part.t0 < t0 {
                    kept.push(Interval { t1: t0, ..*part });
                }
                if part.t1 > t1 {
                    kept.push(Interval { t0: t1, ..*part });
                }
            }
            *intervals = kept;
        }
    }

    /// The part of a line that lies in the margin of an outline, as parts of the way in the image.
    fn margin(
        &self,
        outline: &Outline,
        [a, b]: [DVec2; 2],
        nearness: [f64; 2],
    ) -> Option<[f64; 2]> {
        let [p, q] = outline.ends;
        let (along, step) = (q - p, b - a);
        let mut part = [f64::INFINITY, f64::NEG_INFINITY];
        let mut add = |from: f64, to: f64| {
            if from <= to {
                part = [part[0].min(from), part[1].max(to)];
            }
        };
        for center in [p, q] {
            // |a + s step − center| ≤ gap.
            let d = a - center;
            let (square, half) = (step.length_squared(), d.dot(step));
            let root = half * half - square * (d.length_squared() - self.gap_mm * self.gap_mm);
            if root > 0.0 && square > 0.0 {
                add((-half - root.sqrt()) / square, (-half + root.sqrt()) / square);
            }
        }
        let length = along.length();
        if length > 0.0 {
            let unit = along / length;
            let beside = |x: DVec2| unit.perp_dot(x - p);
            let beyond = |x: DVec2| unit.dot(x - p);
            let mut slab = [f64::NEG_INFINITY, f64::INFINITY];
            within(&mut slab, self.gap_mm - beside(a), self.gap_mm - beside(b));
            within(&mut slab, self.gap_mm + beside(a), self.gap_mm + beside(b));
            within(&mut slab, beyond(a), beyond(b));
            within(&mut slab, length - beyond(a), length - beyond(b));
            add(slab[0], slab[1]);
        }
        if part[0] > part[1] {
            return None;
        }
        if outline.outer != 0.0 {
            within(
                &mut part,
                outline.outer * along.perp_dot(a - p),
                outline.outer * along.perp_dot(b - p),
            );
        }
        part = [part[0].max(0.0), part[1].min(1.0)];
        if part[0] >= part[1] {
            return None;
        }
        let middle = (part[0] + part[1]) / 2.0;
        let foot = (along.dot(a.lerp(b, middle) - p) / along.length_squared()).clamp(0.0, 1.0);
        let foot = if foot.is_nan() { 0.0 } else { foot };
        let own = nearness[0] + (nearness[1] - nearness[0]) * middle;
        let other = outline.nearness[0] + (outline.nearness[1] - outline.nearness[0]) * foot;
        let gap = LEAST_DEPTH_IN_GAPS * self.gap_mm / self.mm_per_image_unit;
        // A step of the gap's size in depth, as a step in nearness.
        let least = if self.is_perspective { gap / outline.depth } else { gap };
        (own - other > least).then_some(part)
    }
}

/// Lengths on paper beyond this are of no paper.
const MOST_MM: f64 = 1e5;

fn cell(p: DVec2) -> [i32; 2] {
    (p / CELL_MM).floor().to_array().map(|x| x as i32)
}

/// Keeps of a part that where a linear function, given at 0 and 1, is not negative.
fn within(part: &mut [f64; 2], at_0: f64, at_1: f64) {
    let step = at_1 - at_0;
    if step > 0.0 {
        part[0] = part[0].max(-at_0 / step);
    } else if step < 0.0 {
        part[1] = part[1].min(-at_0 / step);
    } else if at_0 < 0.0 {
        *part = [f64::INFINITY, f64::NEG_INFINITY];
    }
}

/// On which side of the image of an edge its face is not: 1 is left. `None` for lines that are not edges.
fn outer_side(view: &ViewedScene, edge: u32) -> Option<f64> {
    let scene = view.scene();
    if edge as usize >= scene.topology().edges().len() {
        return None;
    }
    let ends = scene.topology().edge(edge);
    let mut sides = [false; 2];
    for used in scene.topology().uses(edge) {
        let face = scene.mesh().face(used.face());
        if view.facing(used.face()) == Sign::Zero {
            continue;
        }
        // The corner farthest from the edge's line is on the face's side, for most faces at least.
        let at = |v: u32| view.image()[v as usize].image();
        let [p, q] = ends.map(at);
        let offset = |v: u32| (q - p).perp_dot(at(v) - p);
        let farthest = face
            .iter()
            .copied()
            .map(offset)
            .fold(0.0, |far: f64, x| if x.abs() > far.abs() { x } else { far });
        sides[usize::from(farthest > 0.0)] = true;
    }
    Some(match sides {
        [true, false] => 1.0,
        [false, true] => -1.0,
        [false, false] => 0.0,
        [true, true] => return None,
    })
}
