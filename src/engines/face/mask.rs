//! The part of the image drawn already: with this mask, a walk from near to far leaves out what is hidden.
//!
//! ```text
//!   near ──────────────────────────► far      a fragment whose image is in covered squares is
//!    ▓▓▓▓     covered by nearer               hidden and left out; so is everything in a box whose
//!    ▓▓▓▓  ┌┄┄┐ fragments                     image is; what is shown covers its squares
//!    ▓▓▓▓  └┄┄┘
//! ```
//!
//! A fragment covers squares as soon as it is shown, and a face as soon as its last fragment is, so
//! large faces hide much. Faces smaller than the smallest squares cover squares together where they meet
//! (`seams.rs`), so a fine mesh hides its own back.
//!
//! What is left out is certainly hidden; what remains may be hidden.
//!
//! Source: lecture notes on visibility (Slovak), end of section 3.2.

use super::fragment::{Easel, Fragment};
use super::occupancy::Occupancy;
use super::painting::Painting;
use super::seams::Seams;
use crate::camera::Camera;
use crate::model::scene::Scene;
use crate::predicates::{Corner, Plane, PlaneName, Planes, Sign};
use glam::{DVec2, DVec3};
use serde::Serialize;
use std::borrow::Cow;

/// In perspective, vertices with image coordinates beyond this do not make the quadtree larger.
const FARTHEST: f64 = 4.0;

/// Faces of more corners than this cover fragment by fragment only.
const MAX_COVERING_CORNERS: usize = 16;

/// What a view left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct MaskCounts {
    /// Boxes of a tree that were found hidden, not counting boxes inside them.
    #[serde(skip)]
    pub hidden_boxes: u64,
    /// Fragments that were found hidden, those in hidden boxes included.
    pub hidden_fragments: u64,
    /// Fragments that were painted.
    pub painted: u64,
}

/// How many fragments faces and triangles were cut into.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FragmentsOf {
    faces: Vec<u32>,
    triangles: Vec<u32>,
}

impl FragmentsOf {
    /// Counts all fragments of a scene.
    pub(super) fn new(scene: &Scene, fragments: &[Fragment]) -> Self {
        let mut faces = vec![0; scene.mesh().n_faces()];
        let mut triangles = vec![0; scene.triangles().len()];
        for fragment in fragments {
            triangles[fragment.triangle() as usize] += 1;
            faces[scene.triangle_faces()[fragment.triangle() as usize] as usize] += 1;
        }
        Self { faces, triangles }
    }
}

/// The mask of one view, and the fragments shown so far.
pub(super) struct Mask<'a> {
    view: PaintedView<'a>,
    of: &'a FragmentsOf,
    missing: FragmentsOf,
    occupancy: Occupancy,
    seams: Seams,
    shown: Vec<(Cow<'a, Fragment>, Sign)>,
    counts: MaskCounts,
}

impl<'a> Mask<'a> {
    /// None of `n_fragments` shown yet. `planes` must be those of the scene with the camera.
    pub(super) fn new(
        scene: &'a Scene,
        camera: &'a Camera,
        planes: &'a Planes<'a>,
        of: &'a FragmentsOf,
        n_fragments: usize,
    ) -> Self {
        let view = PaintedView {
            scene,
            easel: Easel::new(scene, camera),
            near: planes.has_near_plane().then(|| planes.plane(PlaneName::Near)),
            planes,
        };
        let occupancy = view.empty();
        let seams = Seams::new(&occupancy);
        let counts = MaskCounts { hidden_fragments: n_fragments as u64, ..MaskCounts::default() };
        Self { view, of, missing: of.clone(), occupancy, seams, shown: Vec::new(), counts }
    }

    /// Whether everything in a box is certainly hidden; then its fragments can be skipped.
    pub(super) fn hides(&mut self, low: DVec3, high: DVec3) -> bool {
        let is_hidden = self.view.hides(&self.occupancy, low, high);
        self.counts.hidden_boxes += u64::from(is_hidden);
        is_hidden
    }

    /// Takes the next fragment, which only earlier ones can hide, with the side of its plane that the
    /// eye is on.
    pub(super) fn add(&mut self, fragment: &'a Fragment, facing: Sign) {
        self.counts.hidden_fragments -= 1;
        let face = self.view.easel.face(fragment) as usize;
        let triangle = fragment.triangle() as usize;
        self.missing.triangles[triangle] -= 1;
        self.missing.faces[face] -= 1;
        if facing != Sign::Zero
            && let Some(kept) = fragment.kept(self.view.planes, self.view.near.as_ref())
        {
            let polygon = self.view.polygon(kept.corners(), facing, self.occupancy.rim());
            let is_hidden = polygon.as_ref().is_some_and(|polygon| {
                let low = polygon.iter().copied().fold(DVec2::INFINITY, DVec2::min);
                let high = polygon.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
                self.occupancy.is_covered(low, high)
            });
            if is_hidden {
                self.counts.hidden_fragments += 1;
            } else {
                if let Some(polygon) = polygon {
                    self.occupancy.cover(&polygon);
                }
                self.shown.push((kept, facing));
            }
        }
        if self.missing.triangles[triangle] == 0 && facing != Sign::Zero {
            let (seams, occupancy) = (&mut self.seams, &mut self.occupancy);
            self.view.add_triangle(seams, occupancy, fragment.triangle(), facing);
        }
        if self.missing.faces[face] == 0 && self.of.faces[face] > 1 {
            self.view.cover_face(&mut self.occupancy, face as u32);
        }
    }

    /// What is shown, from far to near.
    pub(super) fn painting(self) -> (Painting, MaskCounts) {
        let mut painting = Painting::new(false);
        for (fragment, facing) in self.shown.iter().rev() {
            self.view.easel.paint(&mut painting, fragment, *facing);
        }
        (painting, MaskCounts { painted: self.shown.len() as u64, ..self.counts })
    }
}

/// A scene as one camera sees it.
struct PaintedView<'a> {
    scene: &'a Scene,
    easel: Easel<'a>,
    planes: &'a Planes<'a>,
    near: Option<Plane>,
}

impl PaintedView<'_> {
    /// A quadtree around the images of all vertices in front of the eye.
    fn empty(&self) -> Occupancy {
        let positions = self.scene.mesh().positions();
        let images = positions.iter().filter_map(|&point| {
            let (image, error) = self.easel.image_within(point, 0.0);
            // Images of points close to the eye's plane would make all squares too large.
            (error < 1.0 && image.abs().max_element() < FARTHEST || self.near.is_none())
                .then_some(image)
        });
        let (low, high) = images.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| {
            (low.min(p), high.max(p))
        });
        Occupancy::new(low, high)
    }

    /// Whether everything in a box is certainly covered.
    fn hides(&self, occupancy: &Occupancy, low: DVec3, high: DVec3) -> bool {
        let (mut image_low, mut image_high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in 0..8 {
            let pick = |axis: usize| if corner >> axis & 1 == 1 { high[axis] } else { low[axis] };
            let (image, error) =
                self.easel.image_within(DVec3::new(pick(0), pick(1), pick(2)), 0.0);
            if !error.is_finite() {
                return false;
            }
            (image_low, image_high) = (image_low.min(image - error), image_high.max(image + error));
        }
        occupancy.is_covered(image_low, image_high)
    }

    /// The image of a convex polygon, counter-clockwise, unless its error may exceed `limit`.
    fn polygon<'c>(
        &self,
        corners: impl Iterator<Item = &'c Corner>,
        facing: Sign,
        limit: f64,
    ) -> Option<Vec<DVec2>> {
        let mut polygon = corners
            .map(|corner| {
                let (image, error) = self.easel.image_within(corner.point, corner.error);
                (error < limit).then_some(image)
            })
            .collect::<Option<Vec<DVec2>>>()?;
        if facing == Sign::Negative {
            polygon.reverse();
        }
        Some(polygon)
    }

    /// Records that all of a triangle is painted, if the near plane does not cut it.
    fn add_triangle(
        &self,
        seams: &mut Seams,
        occupancy: &mut Occupancy,
        triangle: u32,
        facing: Sign,
    ) {
        let vertices = self.scene.triangles()[triangle as usize];
        let corners = vertices.map(|vertex| self.planes.vertex(vertex));
        if let Some(near) = &self.near
            && corners.iter().any(|corner| self.planes.side(near, corner).1 == Sign::Negative)
        {
            return;
        }
        let images = corners.map(|corner| self.easel.image_within(corner.point, corner.error));
        if images.iter().any(|&(_, error)| error.is_nan() || error >= seams.limit()) {
            return;
        }
        let mut corners = [0, 1, 2].map(|k| (vertices[k], images[k].0));
        if facing == Sign::Negative {
            corners.reverse();
        }
        seams.add(corners, occupancy);
    }

    /// Marks the image of a face if it is convex and its triangles all face one way: then they cover the
    /// whole inside of the outline, flat or not.
    fn cover_face(&self, occupancy: &mut Occupancy, face: u32) {
        let corners = self.scene.mesh().face(face);
        if corners.len() > MAX_COVERING_CORNERS {
            return;
        }
        let corners: Vec<Corner> = corners.iter().map(|&v| self.planes.vertex(v)).collect();
        if let Some(near) = &self.near
            && corners.iter().any(|corner| self.planes.side(near, corner).1 == Sign::Negative)
        {
            return;
        }
        let faces = self.scene.triangle_faces();
        let first = faces.partition_point(|&other| other < face) as u32;
        let last = faces.partition_point(|&other| other <= face) as u32;
        let facings = || {
            (first..last)
                .map(|t| self.planes.side_of_eye(PlaneName::Triangle(t)))
                .filter(|&facing| facing != Sign::Zero)
        };
        let Some(facing) = facings().next() else { return };
        let n = corners.len();
        let is_convex = (0..n).all(|i| {
            let (a, b) = (&corners[i], &corners[(i + 1) % n]);
            corners.iter().all(|c| self.planes.turn(a, b, c).times(facing) != Sign::Negative)
        });
        if is_convex
            && facings().all(|other| other == facing)
            && let Some(polygon) = self.polygon(corners.iter(), facing, occupancy.rim())
        {
            occupancy.cover(&polygon);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Projection;
    use crate::model::mesh::{Mesh, PolygonSoup};

    /// In a parallel view the eye's distance changes no image, but how it is rounded.
    #[test]
    fn what_shows_from_near_is_not_hidden_from_far() {
        let mut soup = PolygonSoup::default();
        soup.positions.extend([DVec3::ZERO, DVec3::X, DVec3::Y]);
        soup.push_face(&[0, 1, 2]);
        let scene = Scene::new(Mesh::new(soup).expect("a mesh").0);
        let camera = |distance: f64| {
            let eye = distance * DVec3::new(-4.0, 3.0, 0.0);
            Camera::new(eye, DVec3::ZERO, DVec3::Z, Projection::Orthographic).expect("a camera")
        };
        let (near, far) = (camera(1.0), camera(2f64.powi(40)));
        let planes = Planes::new(scene.mesh().positions(), scene.triangles()).seen_by(&far);
        let view = PaintedView {
            scene: &scene,
            easel: Easel::new(&scene, &far),
            planes: &planes,
            near: None,
        };
        // Covered up to 0.5 in the image, to the right.
        let mut occupancy = Occupancy::new(DVec2::NEG_ONE, DVec2::ONE);
        let right = 0.5 + 1.5 * occupancy.rim();
        let (low, high) = (DVec2::new(-0.7, -0.7), DVec2::new(right, 0.7));
        occupancy.cover(&[low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]);

        let (mut n_beyond, mut n_hidden) = (0, 0);
        for k in 0..4000 {
            let part = |prime: f64| (f64::from(k) * prime).fract();
            // Full mantissas around the border of what is covered, and well inside.
            let across =
                if k % 2 == 0 { 0.5 + 2e-3 * (part(0.754_877) - 0.5) } else { 0.4 * part(0.3) };
            let along = part(0.569_840) - 0.5;
            let right = near.frame().right;
            let point = right * across + near.frame().forward * along;
            let is_hidden = view.hides(&occupancy, point, point);
            let is_beyond = near.image(point).x > 0.5 + 1e-9;
            assert!(!(is_hidden && is_beyond), "{point} is seen at {}", near.image(point));
            n_beyond += u32::from(is_beyond);
            n_hidden += u32::from(is_hidden);
        }
        assert!(n_beyond > 500 && n_hidden > 500, "{n_beyond} beyond, {n_hidden} hidden");
    }
}
