//! Where a smooth surface folds: its sight lines touch it there, and it turns away from the eye.
//!
//! ```text
//!       eye ●                          Φ = N · (E − P), with the normal N of the function itself
//!            ╲ sight line
//!       Φ > 0 ╲  ╭──╮                  z = f(x, y):  Φ = (E − P).z − ∂f/∂d with d = (E − P) in plan
//!              ╲╱    ╲ Φ < 0           X(u, v):      Φ = (∂X/∂u × ∂X/∂v) · (E − X)
//! ```
//!
//! In orthographic projection E − P is the direction toward the eye everywhere.

use glam::{DVec2, DVec3};

use super::formula::{Class, Interval, Jet, JetGraph};
use super::root::Bracket;
use super::sheet_jets::SheetJets;
use crate::camera::{Camera, Projection};
use crate::predicates::Sign;
use crate::predicates::exact::{Towards, facing};

/// Normals shorter than this part of what they are made of are none: a lattice meets in a pole.
const NO_NORMAL: f64 = 1e-9;

/// Volumes below this part of what they are made of may be rounding alone. The exact sign is found for
/// them; if it is larger, that only takes longer.
const ROUNDING: f64 = 1.0 / (1u64 << 40) as f64;

/// How folds are seen.
#[derive(Debug, Clone, Copy)]
pub struct FoldView<'a> {
    /// From where.
    pub camera: &'a Camera,
    /// The scale of the page, as near as it is known.
    pub mm_per_image_unit: f64,
}

impl FoldView<'_> {
    /// From where normals are seen.
    pub(super) fn eye(&self) -> Towards {
        match self.camera.projection() {
            Projection::Perspective { .. } => Towards::Point(self.camera.eye()),
            Projection::Orthographic => Towards::Along(self.camera.forward()),
        }
    }

    /// Whether the upper side of a triangle faces the eye. Exact.
    pub(super) fn is_front(&self, corners: [DVec3; 3]) -> bool {
        let [a, b, c] = corners;
        let to_eye = match self.eye() {
            Towards::Point(eye) => eye - a,
            Towards::Along(forward) => -forward,
        };
        let (along, to) = (b - a, c - a);
        let volume = along.cross(to).dot(to_eye);
        let size = corners.iter().fold(self.camera.eye().abs(), |size, p| size.max(p.abs()));
        let size = size.max(to_eye.abs()).max_element();
        if volume.abs() > ROUNDING * along.length() * to.length() * size {
            return volume > 0.0;
        }
        facing(corners, self.eye()) == Sign::Positive
    }
}

/// A sheet as the eye sees it, by its formulas.
#[derive(Debug, Clone)]
pub(super) struct FoldFunction {
    jets: SheetJets,
    eye: Towards,
}

/// A place of a sheet: x and y, or u and v; and what is there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FoldPoint {
    pub(super) position: DVec3,
    /// Above 0 where the upper side faces the eye, below 0 where the lower side does; not a number
    /// where that is not known.
    pub(super) facing: f64,
}

impl FoldFunction {
    /// The formulas give coordinates as they are drawn.
    pub(super) fn new(jets: SheetJets, eye: Towards) -> Self {
        Self { jets, eye }
    }

    /// Whether places are x and y as they are drawn; otherwise they are u and v.
    pub(super) fn is_in_plan(&self) -> bool {
        matches!(self.jets, SheetJets::Height(_))
    }

    /// What is at a place. `room` is kept from call to call so that nothing is allocated.
    pub(super) fn at(&self, place: DVec2, room: &mut Vec<Jet>) -> FoldPoint {
        let mut along = |graph: &JetGraph, direction: DVec2| {
            let [a, b] = place.to_array().map(Interval::point);
            let jet = graph.over(a, b, direction.to_array(), room);
            let is_known = jet.class >= Class::Lipschitz;
            let middle = |of: Interval| 0.5 * of.low + 0.5 * of.high;
            (middle(jet.value), if is_known { middle(jet.first) } else { f64::NAN })
        };
        match &self.jets {
            SheetJets::Height(graph) => {
                let in_plan = match self.eye {
                    Towards::Point(eye) => eye.truncate() - place,
                    Towards::Along(forward) => -forward.truncate(),
                };
                let (z, slope) = along(graph, in_plan);
                let rise = match self.eye {
                    Towards::Point(eye) => eye.z - z,
                    Towards::Along(forward) => -forward.z,
                };
                FoldPoint { position: place.extend(z), facing: rise - slope }
            }
            SheetJets::Space(graphs) => {
                let both = graphs.each_ref().map(|graph| {
                    let (value, by_u) = along(graph, DVec2::X);
                    (value, by_u, along(graph, DVec2::Y).1)
                });
                let position = DVec3::from(both.map(|(value, ..)| value));
                let (by_u, by_v) = (both.map(|of| of.1).into(), both.map(|of| of.2).into());
                let normal = DVec3::cross(by_u, by_v);
                let to_eye = match self.eye {
                    Towards::Point(eye) => eye - position,
                    Towards::Along(forward) => -forward,
                };
                let longest = by_u.length_squared().max(by_v.length_squared());
                let has_normal = normal.length() > NO_NORMAL * longest;
                FoldPoint {
                    position,
                    facing: if has_normal { normal.dot(to_eye) } else { f64::NAN },
                }
            }
        }
    }

    /// Where between two places, whose sides facing the eye differ, the sheet folds: the part of the way,
    /// and the point. None where that is not known.
    pub(super) fn between(
        &self,
        [a, b]: [DVec2; 2],
        [at_a, at_b]: [f64; 2],
        room: &mut Vec<Jet>,
    ) -> Option<(f64, FoldPoint)> {
        let mut bracket = Bracket::new((0.0, at_a), (1.0, at_b));
        loop {
            let t = bracket.next();
            let point = self.at(a + t * (b - a), room);
            if point.facing.is_nan() || !point.position.is_finite() {
                return None;
            }
            if let Some(t) = bracket.step(point.facing) {
                let point = self.at(a + t * (b - a), room);
                return point.position.is_finite().then_some((t, point));
            }
        }
    }
}
