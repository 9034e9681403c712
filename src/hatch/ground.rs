//! The ground: a horizontal plane that catches shadows, has no lines and hides nothing.
//!
//! ```text
//!      ☼  ╲            The shadow lies within that of the box around the scene: the hull of the
//!          ╲ ┌──┐      corners' shadows. What of it is on the page is cut by the families, as faces
//!           ╲│  │╲     are.
//!   ─────────└──┘─╲────
//! ```

use glam::{DVec2, DVec3};

use super::cut::{Cutter, GROUND, HatchSegment, MOST_SEGMENTS, lines};
use super::families::{least_halvings, rank};
use super::options::{Ground, HatchError};
use crate::camera::Projection;
use crate::classify::ViewSegments;
use crate::predicates::PiercePoint;
use crate::shading::light::Light;
use crate::strokes::StrokeKind;

/// Of what is as high as a lamp, or higher, the shadow is taken to reach as far as that of what is this
/// part as high.
const HIGHEST_BELOW_LAMP: f64 = 0.999;

/// The z of the ground under a scene whose lowest corner is `low`.
pub(super) fn ground_height(ground: Ground, low: DVec3) -> f64 {
    match ground {
        Ground::Lowest => low.z,
        Ground::At(z) => z,
    }
}

impl Cutter<'_> {
    /// Adds the segments on the ground at height `z`. From below it is not seen.
    pub(super) fn cut_ground(
        &self,
        light: &Light,
        bounds: (DVec3, DVec3),
        z: f64,
        segments: &mut ViewSegments,
        hatched: &mut Vec<HatchSegment>,
    ) -> Result<(), HatchError> {
        if !light.is_above(z) {
            return Err(HatchError::Horizon);
        }
        if !self.camera.is_above(z) {
            return Ok(());
        }
        let shadow = self.on_page(hull(shadow_of_box(light, bounds, z)), z);
        if shadow.len() < 3 {
            return Ok(());
        }
        let corners: Vec<DVec3> = shadow.iter().map(|p| p.extend(z)).collect();
        for (number, family) in (0..).zip(&self.families.all) {
            let limit = match self.every_line {
                true => f64::INFINITY,
                false => self.tones.highest_rank_on_ground(family, &corners),
            };
            let is_left_out = self.every_line && family.is_alternate();
            if family.class != 0 || limit <= 0.0 || is_left_out {
                continue;
            }
            let halvings = if self.every_line { 0 } else { least_halvings(self.levels, limit) };
            let lines = lines(corners.iter().map(|&p| family.place(p)), halvings);
            for line in lines.ok_or(HatchError::TooMany(MOST_SEGMENTS))? {
                if !self.every_line && rank(self.levels, line) >= limit {
                    continue;
                }
                let plane = family.plane(line);
                let Some(ends) = across(&shadow, |p| plane.normal.dot(p.extend(z)) - plane.offset)
                else {
                    continue;
                };
                if hatched.len() >= MOST_SEGMENTS {
                    return Err(HatchError::TooMany(MOST_SEGMENTS));
                }
                // By definition the segment is the one between these rounded points: both are on the
                // ground, exactly.
                let ends = ends
                    .map(|p| segments.push_point(PiercePoint::vertex(p.extend(z) + DVec3::ZERO)));
                segments.push_within(ends, StrokeKind::Hatch, [0; 2]);
                hatched.push(HatchSegment { family: number, line, at: [GROUND; 2] });
            }
        }
        Ok(())
    }

    /// The part of a convex polygon on the ground that is on the page.
    fn on_page(&self, mut polygon: Vec<DVec2>, z: f64) -> Vec<DVec2> {
        let frame = self.camera.frame();
        let (low, high) = self.page.window;
        let eye = self.camera.eye();
        let d = move |p: DVec2| p.extend(z) - eye;
        let divisor = |p: DVec2| match self.camera.projection() {
            Projection::Perspective { .. } => d(p).dot(frame.forward),
            Projection::Orthographic => 1.0,
        };
        if let Projection::Perspective { near, .. } = self.camera.projection() {
            let nearest = near * self.camera.forward().length();
            polygon = clipped(&polygon, |p| divisor(p) - nearest);
        }
        polygon = clipped(&polygon, |p| d(p).dot(frame.right) - low.x * divisor(p));
        polygon = clipped(&polygon, |p| high.x * divisor(p) - d(p).dot(frame.right));
        polygon = clipped(&polygon, |p| d(p).dot(frame.upward) - low.y * divisor(p));
        clipped(&polygon, |p| high.y * divisor(p) - d(p).dot(frame.upward))
    }
}

/// The shadows of the corners of a box, as far as it is above the ground.
fn shadow_of_box(light: &Light, (low, high): (DVec3, DVec3), z: f64) -> Vec<DVec2> {
    let mut shadows = Vec::with_capacity(8);
    for i in 0..8 {
        let corner = DVec3::select(glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), high, low);
        let shadow = match *light {
            Light::Sun { towards, .. } => {
                let height = (corner.z - z).max(0.0);
                corner - towards * (height / towards.z)
            }
            Light::Lamp(place) => {
                let height = ((corner.z - z).max(0.0)).min((place.z - z) * HIGHEST_BELOW_LAMP);
                let reach = (place.z - z) / (place.z - z - height);
                place + (corner - place) * reach
            }
        };
        shadows.push(shadow.truncate());
    }
    shadows
}

/// The convex hull, counter-clockwise (A. M. Andrew's chains). Rounded.
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut hull: Vec<DVec2> = Vec::with_capacity(points.len() + 1);
    for chain in 0..2 {
        let start = hull.len();
        let add = |hull: &mut Vec<DVec2>, p: DVec2| {
            while hull.len() >= start + 2
                && (hull[hull.len() - 1] - hull[hull.len() - 2]).perp_dot(p - hull[hull.len() - 1])
                    <= 0.0
            {
                hull.pop();
            }
            hull.push(p);
        };
        if chain == 0 {
            points.iter().for_each(|&p| add(&mut hull, p));
        } else {
            points.iter().rev().for_each(|&p| add(&mut hull, p));
        }
        hull.pop();
    }
    hull
}

/// The part of a convex polygon where a linear function is not negative.
fn clipped(polygon: &[DVec2], f: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (of_p, of_q) = (f(p), f(q));
        if of_p >= 0.0 {
            kept.push(p);
        }
        if (of_p >= 0.0) != (of_q >= 0.0) {
            kept.push(p.lerp(q, of_p / (of_p - of_q)));
        }
    }
    kept
}

/// Where a line crosses a convex polygon: from the point where the function of the line turns negative
/// to the one where it turns positive.
fn across(polygon: &[DVec2], f: impl Fn(DVec2) -> f64) -> Option<[DVec2; 2]> {
    let mut ends = [None; 2];
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (of_p, of_q) = (f(p), f(q));
        if (of_p >= 0.0) != (of_q >= 0.0) {
            ends[usize::from(of_p < 0.0)] = Some(p.lerp(q, of_p / (of_p - of_q)));
        }
    }
    let [from, to] = [ends[0]?, ends[1]?];
    (from != to).then_some([from, to])
}
