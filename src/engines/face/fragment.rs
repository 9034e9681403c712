//! Fragments: convex parts of triangles, cut by planes without loss.
//!
//! ```text
//!            ● q                    a fragment keeps its triangle, so its face;
//!           ╱ ╲                     each corner its exact place (see `predicates::Corner`);
//!     edge ╱   ╲ diagonal           each side whether it is part of a line of the scene (edge)
//!         ╱┄┄┄┄┄╲  cut              or was made by triangulation or by a cut; the latter are
//!      p ●───────● r                never drawn
//!          edge
//! ```
//!
//! Cutting keeps a fragment strictly convex: no corner is on the line through its neighbors, and a
//! plane that only touches does not cut.

use super::FragmentCounts;
use super::painting::{NO_LINE, Painting};
use crate::camera::{Camera, Frame, ImagePoint, Projection};
use crate::model::scene::Scene;
use crate::predicates::{Corner, CornerPlace, Estimate, Plane, PlaneName, Planes, Sign};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::borrow::Cow;

/// What, with the plane of its triangle, defines the line of a side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Border {
    /// The line through two vertices.
    Edge([u32; 2]),
    /// A plane that cut it.
    Cut(PlaneName),
}

/// A corner of a fragment and the side that begins there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FragmentSide {
    /// Where the side begins.
    pub corner: Corner,
    /// What defines its line.
    pub border: Border,
    /// The line of the scene that it is part of, or [`NO_LINE`].
    pub line: u32,
}

/// A convex part of a triangle.
#[derive(Debug, Clone, PartialEq)]
pub struct Fragment {
    triangle: u32,
    sides: Vec<FragmentSide>,
}

/// Where a fragment is relative to a plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Position {
    /// On its positive side; corners may be on the plane.
    Front,
    /// On its negative side; corners may be on the plane.
    Back,
    /// In the plane.
    Within,
    /// On both sides.
    Across,
}

impl Fragment {
    /// A whole triangle of the scene; `None` for one without area.
    pub fn new(scene: &Scene, planes: &Planes, triangle: u32) -> Option<Self> {
        if !planes.has_area(triangle) {
            return None;
        }
        let face = scene.triangle_faces()[triangle as usize];
        let [p, q, r] = planes.triangle(triangle);
        let side = |from: u32, to: u32| {
            let topology = scene.topology();
            // An edge of another face may run along a diagonal of this one.
            let edge = topology.find_edge(from, to);
            let edge = edge.filter(|&edge| topology.uses(edge).iter().any(|u| u.face() == face));
            FragmentSide {
                corner: planes.vertex(from),
                border: Border::Edge([from, to]),
                line: edge.unwrap_or(NO_LINE),
            }
        };
        Some(Self { triangle, sides: vec![side(p, q), side(q, r), side(r, p)] })
    }

    /// All triangles of the scene that have an area, in their order.
    pub fn all(scene: &Scene, planes: &Planes) -> Vec<Self> {
        let n_triangles = scene.triangles().len() as u32;
        (0..n_triangles).into_par_iter().filter_map(|t| Self::new(scene, planes, t)).collect()
    }

    /// The triangle that it is part of.
    pub fn triangle(&self) -> u32 {
        self.triangle
    }

    /// Its sides, three or more, in the order in which the triangle is wound.
    pub fn sides(&self) -> &[FragmentSide] {
        &self.sides
    }

    /// Its corners.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = &Corner> + Clone {
        self.sides.iter().map(|side| &side.corner)
    }

    /// Where it is relative to a plane, exactly. O(corners).
    #[inline]
    pub fn position(&self, planes: &Planes, plane: &Plane) -> Position {
        if plane.name() == PlaneName::Triangle(self.triangle) {
            return Position::Within;
        }
        let (mut is_in_front, mut is_behind) = (false, false);
        for corner in self.corners() {
            match planes.side(plane, corner).1 {
                Sign::Positive => is_in_front = true,
                Sign::Negative => is_behind = true,
                Sign::Zero => {}
            }
        }
        match (is_in_front, is_behind) {
            (true, true) => Position::Across,
            (true, false) => Position::Front,
            (false, true) => Position::Back,
            (false, false) => Position::Within,
        }
    }

    /// The parts on the positive and the negative side of a plane that crosses it.
    ///
    /// ```text
    ///      from ●──────●           + ─► −: the cut begins the side of the positive part,
    ///          ╱    +   ╲              the rest of this side that of the negative
    ///   ┄┄┄┄┄┄●┄┄┄┄┄┄┄┄┄┄●┄┄┄ plane
    ///          ╲    −   ╱          − ─► +: the other way around
    ///           ●──────●
    /// ```
    pub fn split(&self, planes: &Planes, plane: &Plane) -> (Self, Self) {
        let name = plane.name();
        let values: Vec<(Estimate, Sign)> =
            self.corners().map(|corner| planes.side(plane, corner)).collect();
        let n = self.sides.len();
        let mut front = Vec::with_capacity(n + 1);
        let mut back = Vec::with_capacity(n + 1);
        let cut_from =
            |corner: Corner| FragmentSide { corner, border: Border::Cut(name), line: NO_LINE };
        for (i, side) in self.sides.iter().enumerate() {
            let j = (i + 1) % n;
            let (from, to) = (values[i].1, values[j].1);
            match (from, to) {
                (Sign::Positive, _) => front.push(*side),
                (Sign::Negative, _) => back.push(*side),
                (Sign::Zero, Sign::Negative) => {
                    front.push(cut_from(side.corner));
                    back.push(*side);
                }
                (Sign::Zero, _) => {
                    front.push(*side);
                    back.push(cut_from(side.corner));
                }
            }
            if from.times(to) == Sign::Negative {
                let place = match side.border {
                    Border::Edge(ends) => CornerPlace::OnEdge(ends, name),
                    Border::Cut(other) => {
                        CornerPlace::InFace([PlaneName::Triangle(self.triangle), other, name])
                    }
                };
                let ends = [&side.corner, &self.sides[j].corner];
                let corner = planes.corner_between(ends, [values[i].0, values[j].0], place);
                let rest = FragmentSide { corner, ..*side };
                let (of_front, of_back) = if from == Sign::Positive {
                    (cut_from(corner), rest)
                } else {
                    (rest, cut_from(corner))
                };
                front.push(of_front);
                back.push(of_back);
            }
        }
        let part = |sides| Self { triangle: self.triangle, sides };
        (part(front), part(back))
    }

    /// The parts on the positive and the negative side of a plane, if any. A fragment in the plane
    /// counts as being on the positive side.
    pub fn parted(
        self,
        planes: &Planes,
        plane: &Plane,
        counts: &mut FragmentCounts,
    ) -> (Option<Self>, Option<Self>) {
        counts.tests += 1;
        match self.position(planes, plane) {
            Position::Front | Position::Within => (Some(self), None),
            Position::Back => (None, Some(self)),
            Position::Across => {
                counts.splits += 1;
                let (front, back) = self.split(planes, plane);
                (Some(front), Some(back))
            }
        }
    }

    /// The part beyond the near plane; all of it when there is no near plane.
    pub fn kept(&self, planes: &Planes, near: Option<&Plane>) -> Option<Cow<'_, Self>> {
        let Some(near) = near else { return Some(Cow::Borrowed(self)) };
        match self.position(planes, near) {
            // Fragments in the near plane are kept.
            Position::Front | Position::Within => Some(Cow::Borrowed(self)),
            Position::Back => None,
            Position::Across => Some(Cow::Owned(self.split(planes, near).0)),
        }
    }

    /// Its area in space, from rounded corners.
    pub fn area(&self) -> f64 {
        let Some(first) = self.sides.first() else { return 0.0 };
        let origin = first.corner.point;
        let normals = self
            .sides
            .windows(2)
            .map(|pair| (pair[0].corner.point - origin).cross(pair[1].corner.point - origin));
        normals.sum::<DVec3>().length() / 2.0
    }
}

/// A box around fragments, with room for rounding.
pub(super) fn bounds(fragments: &[Fragment]) -> (DVec3, DVec3) {
    let corners = || fragments.iter().flat_map(Fragment::corners);
    let low = corners().fold(DVec3::INFINITY, |low, c| low.min(c.point - c.error));
    (low, corners().fold(DVec3::NEG_INFINITY, |high, c| high.max(c.point + c.error)))
}

/// A bound on the rounding errors of a projection, relative to the size of its operands: one for the
/// difference, three for each product, and those of the directions, about 8 units of 2⁻⁵³ in all.
const IMAGE_ERROR: f64 = 16.0 * f64::EPSILON;

/// Projects fragments.
#[derive(Debug, Clone, Copy)]
pub struct Easel<'a> {
    scene: &'a Scene,
    camera: &'a Camera,
    frame: Frame,
}

impl<'a> Easel<'a> {
    /// For one camera.
    pub fn new(scene: &'a Scene, camera: &'a Camera) -> Self {
        Self { scene, camera, frame: camera.frame() }
    }

    /// The image of a corner, from its rounded point.
    pub fn image(&self, corner: &Corner) -> ImagePoint {
        ImagePoint::new(corner.point - self.camera.eye(), self.camera, &self.frame)
    }

    /// The image of a point known to within `error`, and a bound on the image's error; infinite for a
    /// point that may not be in front of the eye.
    pub(super) fn image_within(&self, point: DVec3, error: f64) -> (DVec2, f64) {
        let d = point - self.camera.eye();
        let image = ImagePoint::new(d, self.camera, &self.frame);
        let error = 2.0 * error + IMAGE_ERROR * (d.length() + point.length());
        match self.camera.projection() {
            Projection::Orthographic => (image.image(), error),
            Projection::Perspective { .. } if image.w > 2.0 * error => {
                let at = image.image();
                (at, 2.0 * error * (1.0 + at.length()) / image.w)
            }
            Projection::Perspective { .. } => (image.image(), f64::INFINITY),
        }
    }

    /// The distance of a corner along the direction of view, and a bound on its error.
    pub(super) fn depth_within(&self, corner: &Corner) -> (f64, f64) {
        let d = corner.point - self.camera.eye();
        let error = 2.0 * corner.error + IMAGE_ERROR * (d.length() + corner.point.length());
        (d.dot(self.frame.forward), error)
    }

    /// The face that a fragment is part of.
    pub fn face(&self, fragment: &Fragment) -> u32 {
        self.scene.triangle_faces()[fragment.triangle as usize]
    }

    /// Paints a fragment over all others. `facing` is the side of its plane that the eye is on;
    /// edge-on fragments are left out.
    pub fn paint(&self, painting: &mut Painting, fragment: &Fragment, facing: Sign) {
        let sides = &fragment.sides;
        let image = |side: &FragmentSide| self.image(&side.corner).image();
        let n = sides.len();
        match facing {
            Sign::Zero => {}
            Sign::Positive => {
                let ring = sides.iter().map(|side| (image(side), side.line));
                painting.push(self.face(fragment), [ring]);
            }
            Sign::Negative => {
                // In reverse order, a corner begins the side that ended there.
                let ring = (0..n).rev().map(|i| (image(&sides[i]), sides[(i + n - 1) % n].line));
                painting.push(self.face(fragment), [ring]);
            }
        }
    }
}
