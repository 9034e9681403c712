//! A lattice over the drawn segments, in the image and in depth, and where the vertices lie on it.

use super::super::rounding::Rounding;
use super::super::segment::Segment;
use super::box_join::{Lattice, LatticeBox, LatticeRange, box_of_all};
use crate::camera::ImagePoint;
use crate::classify::ViewedScene;
use crate::predicates::Viewpoint;
use glam::DVec3;
use rayon::prelude::*;

/// Where the images and the depths of the vertices lie on a lattice over all segments.
pub(super) struct Places {
    pub lattice: Lattice,
    vertices: Vec<LatticeRange>,
}

impl Places {
    /// Lays out a lattice whose cells are about as deep as they are wide; `None` when there are no
    /// segments. O(segments + vertices).
    pub(super) fn new(
        view: &ViewedScene,
        rounding: &Rounding,
        segments: &[Option<Segment>],
    ) -> Option<Self> {
        let bounds = |segment: &Segment| rounding.bounds(segment.image, segment.depth).corners();
        let boxes: Vec<[DVec3; 2]> = segments
            .par_chunks(1 << 12)
            .map(|chunk| box_of_all(chunk.iter().flatten().map(bounds)))
            .collect();
        let all = box_of_all(boxes.into_iter());
        let units_per_image_unit = match view.sight().viewpoint() {
            Viewpoint::Eye(_) => 0.5 * (all[0].z + all[1].z),
            Viewpoint::Direction(_) => 1.0,
        };
        let lattice = Lattice::over(all, units_per_image_unit)?;
        let place = |point: &ImagePoint| {
            lattice.place(rounding.bounds([point.image()], [point.depth]).corners())
        };
        Some(Self { lattice, vertices: view.image().par_iter().map(place).collect() })
    }

    /// The boxes of the segments, each with its number.
    pub(super) fn of_segments(
        &self,
        rounding: &Rounding,
        segments: &[Option<Segment>],
    ) -> Vec<LatticeBox> {
        segments
            .par_iter()
            .enumerate()
            .filter_map(|(i, segment)| {
                let bounds = rounding.bounds(segment.as_ref()?.image, segment.as_ref()?.depth);
                self.lattice.place(bounds.corners()).of(i as u32)
            })
            .collect()
    }

    /// The place around some vertices.
    #[inline]
    pub(super) fn around<const N: usize>(&self, corners: [u32; N]) -> LatticeRange {
        LatticeRange::around(corners.map(|corner| &self.vertices[corner as usize]))
    }
}
