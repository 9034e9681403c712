//! Lines that belong to one view of a scene.

use glam::DVec3;
use rayon::prelude::*;

use crate::model::scene::Scene;
use crate::predicates::PiercePoint;
use crate::strokes::StrokeKind;

/// Points and segments that belong to a view, not to the scene: hatching, cuts by planes, contours of
/// smooth surfaces.
///
/// The scene's points keep their numbers; further ones are exact points where an edge meets a face. A
/// segment hides nothing. A face does not hide a segment in its own plane.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewSegments {
    /// The scene's points, then those of the view, rounded.
    pub(super) points: Vec<DVec3>,
    /// All that are not vertices, exact.
    pub(super) constructed: Vec<PiercePoint>,
    pub(super) ends: Vec<[u32; 2]>,
    pub(super) kinds: Vec<StrokeKind>,
    /// The first of the triangles that contain each segment, and the one after the last.
    pub(super) within: Vec<[u32; 2]>,
}

impl ViewSegments {
    /// No segments yet, for views of `scene`. O(points).
    pub fn new(scene: &Scene) -> Self {
        Self {
            points: scene.points().to_vec(),
            constructed: scene.intersections().points().to_vec(),
            ends: Vec::new(),
            kinds: Vec::new(),
            within: Vec::new(),
        }
    }

    /// Adds points, which get the numbers that follow those there are. O(points), in parallel.
    pub fn extend_points(&mut self, points: Vec<PiercePoint>) {
        self.points.par_extend(points.par_iter().map(PiercePoint::rounded));
        self.constructed.extend(points);
    }

    /// Number of points, those of the scene among them.
    pub fn n_points(&self) -> usize {
        self.points.len()
    }

    /// The points: those of the scene, then those of the view, rounded.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Number of segments.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are no segments.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The ends of a segment, as numbers of points. Panics when there is no such segment.
    pub fn ends(&self, segment: usize) -> [u32; 2] {
        self.ends[segment]
    }

    /// Adds a point and returns its number.
    pub fn push_point(&mut self, point: PiercePoint) -> u32 {
        self.points.push(point.rounded());
        self.constructed.push(point);
        self.points.len() as u32 - 1
    }

    /// Adds a segment between two points. Panics when there is no such point.
    pub fn push(&mut self, ends: [u32; 2], kind: StrokeKind) {
        self.push_within(ends, kind, [0; 2]);
    }

    /// Adds a segment that lies in certain triangles of the scene, all of one face: from the first
    /// number to the one before the last. These do not hide it. Panics when there is no such point.
    pub fn push_within(&mut self, ends: [u32; 2], kind: StrokeKind, triangles: [u32; 2]) {
        assert!(ends.iter().all(|&end| (end as usize) < self.points.len()), "no such point");
        self.ends.push(ends);
        self.kinds.push(kind);
        self.within.push(triangles);
    }
}
