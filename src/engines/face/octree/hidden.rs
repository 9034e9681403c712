//! Octants from near to far, without those that are hidden.

use super::seams::Seams;
use super::{Leaves, Octant, Octree};
use crate::camera::Camera;
use crate::engines::face::bsp::WalkOrder;
use crate::engines::face::fragment::Easel;
use crate::engines::face::occupancy::Occupancy;
use crate::engines::face::painting::Painting;
use crate::model::scene::Scene;
use crate::predicates::{Corner, Plane, PlaneName, Planes, Sign};
use glam::{DVec2, DVec3};
use serde::Serialize;

/// In perspective, vertices with image coordinates beyond this do not make the quadtree larger.
const FARTHEST: f64 = 4.0;

/// Faces of more corners than this cover fragment by fragment only.
const MAX_COVERING_CORNERS: usize = 16;

/// What a view left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Hidden {
    /// Octants that were found hidden, not counting those in them.
    pub hidden_octants: u64,
    /// Fragments that were found hidden, those in hidden octants included.
    pub hidden_fragments: u64,
    /// Fragments that were painted.
    pub painted: u64,
}

impl Octree {
    /// The fragments from far to near, cut at the near plane, without most of those that nearer ones
    /// hide. `scene` must be that of the tree.
    ///
    /// What is left out is surely hidden; what is left may be.
    pub fn paint_seen(&self, scene: &Scene, camera: &Camera) -> (Painting, Hidden) {
        let planes = Planes::new(scene.mesh().positions(), scene.triangles()).seen_by(camera);
        let view = View {
            scene,
            easel: Easel::new(scene, camera),
            near: planes.has_near_plane().then(|| planes.plane(PlaneName::Near)),
            planes: &planes,
        };
        let mut seen = Vec::new();
        let mut occupancy = view.empty();
        let mut seams = Seams::new(&occupancy);
        let mut missing = self.of_face.clone();
        let mut missing_of_triangle = self.of_triangle.clone();
        let mut hidden =
            Hidden { hidden_fragments: self.fragments().len() as u64, ..Hidden::default() };
        let mut leaves = Leaves::new(self, &planes, WalkOrder::NearToFar);
        loop {
            let next = leaves.next(|octant| {
                let is_hidden = view.hides(&occupancy, octant);
                hidden.hidden_octants += u64::from(is_hidden);
                !is_hidden
            });
            let Some(root) = next else { break };
            for (fragment, facing) in self.forest.walk(&planes, root, WalkOrder::NearToFar) {
                hidden.hidden_fragments -= 1;
                let face = view.easel.face(fragment);
                let triangle = fragment.triangle();
                missing_of_triangle[triangle as usize] -= 1;
                missing[face as usize] -= 1;
                if facing != Sign::Zero
                    && let Some(kept) = fragment.kept(&planes, view.near.as_ref())
                {
                    let polygon = view.polygon(kept.corners(), facing, occupancy.rim());
                    let is_hidden = polygon.as_ref().is_some_and(|polygon| {
                        let low = polygon.iter().copied().fold(DVec2::INFINITY, DVec2::min);
                        let high = polygon.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
                        occupancy.is_covered(low, high)
                    });
                    if is_hidden {
                        hidden.hidden_fragments += 1;
                    } else {
                        if let Some(polygon) = polygon {
                            occupancy.cover(&polygon);
                        }
                        seen.push((kept, facing));
                    }
                }
                if missing_of_triangle[triangle as usize] == 0 && facing != Sign::Zero {
                    view.add_triangle(&mut seams, &mut occupancy, triangle, facing);
                }
                if missing[face as usize] == 0 && self.of_face[face as usize] > 1 {
                    view.cover_face(&mut occupancy, face);
                }
            }
        }
        let mut painting = Painting::new(false);
        for (fragment, facing) in seen.iter().rev() {
            view.easel.paint(&mut painting, fragment, *facing);
        }
        hidden.painted = painting.len() as u64;
        (painting, hidden)
    }
}

/// A scene as one camera sees it.
struct View<'a> {
    scene: &'a Scene,
    easel: Easel<'a>,
    planes: &'a Planes<'a>,
    near: Option<Plane>,
}

impl View<'_> {
    /// A quadtree around the images of all vertices in front of the eye.
    fn empty(&self) -> Occupancy {
        let positions = self.scene.mesh().positions();
        let images = positions.iter().filter_map(|&point| {
            let (image, error) = self.easel.image_within(point, 0.0);
            // Images of what is close to the eye's own plane would make all squares too large.
            (error < 1.0 && image.abs().max_element() < FARTHEST || self.near.is_none())
                .then_some(image)
        });
        let (low, high) = images.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| {
            (low.min(p), high.max(p))
        });
        Occupancy::new(low, high)
    }

    /// Whether all that an octant holds is surely covered.
    fn hides(&self, occupancy: &Occupancy, octant: &Octant) -> bool {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in 0..8 {
            let pick = |axis: usize| {
                if corner >> axis & 1 == 1 { octant.high[axis] } else { octant.low[axis] }
            };
            let (image, error) =
                self.easel.image_within(DVec3::new(pick(0), pick(1), pick(2)), 0.0);
            if !error.is_finite() {
                return false;
            }
            (low, high) = (low.min(image - error), high.max(image + error));
        }
        occupancy.is_covered(low, high)
    }

    /// The image of a convex polygon, counter-clockwise, unless it may be off by more than `limit`.
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

    /// Notes that all of a triangle is painted, if the near plane leaves it whole.
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

    /// Marks the image of a face, if it is convex and its triangles all face one way: then they cover
    /// all of the outline's inside, flat or not.
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
