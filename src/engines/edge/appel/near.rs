//! Triangles that segments may pierce, touch or be in near contact with.
//!
//! The boxes of both, in the image and in depth, say which are near each other; then the plane of
//! the triangle rules out most of what is left, since the ends of nearly all edges lie well on one
//! side of it.
//!
//! Points in near contact lie behind the triangle on a sight line through it, so that its box needs
//! to be made larger in depth only, if by much where the triangle is nearly edge-on.

use super::super::index::Rounding;
use super::super::segment::Segment;
use super::box_join::{Lattice, LatticeBox, Place, box_of_all, meeting_pairs};
use super::cutting::is_counted;
use crate::classify::{ImagePoint, ViewedScene};
use crate::predicates::{Sign, Viewpoint};
use glam::DVec3;
use rayon::prelude::*;

/// The triangles near each segment.
#[derive(Debug, Default)]
pub(super) struct NearTriangles {
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl NearTriangles {
    /// Finds them among those that lie wholly beyond the near plane.
    ///
    /// Expected cost: segments and triangles, once.
    pub(super) fn new(
        view: &ViewedScene,
        rounding: &Rounding,
        places: &Places,
        segments: &[Option<Segment>],
        contact_tolerance: f64,
    ) -> Self {
        let ends: Vec<[u32; 2]> = segments
            .par_iter()
            .map(|segment| segment.as_ref().map_or([0; 2], |segment| segment.ends))
            .collect();
        let near = Near { view, contact_tolerance, ends, places };
        let first: Vec<LatticeBox> = segments
            .par_iter()
            .enumerate()
            .filter_map(|(i, segment)| {
                let bounds = rounding.bounds(segment.as_ref()?.image, segment.as_ref()?.depth);
                places.lattice.place(bounds.corners()).of(i as u32)
            })
            .collect();
        let second = |triangle| near.box_of_triangle(triangle);
        let n_triangles = view.scene().triangles().len();
        let mut pairs = meeting_pairs(&first, n_triangles, second, |triangle, meeting, found| {
            near.push_meetings(triangle, meeting, found);
        });
        pairs.par_sort_unstable();
        let mut starts = vec![0u32; segments.len() + 1];
        for &(segment, _) in &pairs {
            starts[segment as usize + 1] += 1;
        }
        for i in 0..segments.len() {
            starts[i + 1] += starts[i];
        }
        Self { starts, triangles: pairs.into_iter().map(|(_, triangle)| triangle).collect() }
    }

    /// The triangles near one segment, by its number.
    pub(super) fn of(&self, segment: usize) -> &[u32] {
        match self.starts.get(segment..segment + 2) {
            Some(&[start, end]) => &self.triangles[start as usize..end as usize],
            _ => &[],
        }
    }
}

/// Where the images and the depths of the vertices lie on a lattice over all segments.
pub(super) struct Places {
    pub lattice: Lattice,
    vertices: Vec<Place>,
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

    /// The place of a triangle.
    #[inline]
    pub(super) fn around(&self, corners: [u32; 3]) -> Place {
        Place::around(corners.map(|corner| &self.vertices[corner as usize]))
    }
}

struct Near<'n, 'a> {
    view: &'n ViewedScene<'a>,
    contact_tolerance: f64,
    /// The vertices of each segment.
    ends: Vec<[u32; 2]>,
    places: &'n Places,
}

impl Near<'_, '_> {
    /// The box of a triangle with all points behind it that are in near contact with its plane;
    /// `None` when it covers nothing or is not [counted](is_counted).
    #[inline]
    fn box_of_triangle(&self, triangle: u32) -> Option<LatticeBox> {
        if !is_counted(self.view, triangle) {
            return None;
        }
        let corners = self.view.scene().triangles()[triangle as usize];
        let mut place = self.places.around(corners);
        if self.contact_tolerance > 0.0 {
            let reach = self.view.sight().contact_reach(corners, self.contact_tolerance);
            let depths = corners.map(|corner| self.view.image()[corner as usize].depth);
            let farthest = depths.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let length = match self.view.sight().viewpoint() {
                Viewpoint::Eye(_) => farthest,
                Viewpoint::Direction(forward) => forward.length(),
            };
            let farthest = self.places.lattice.z_place(farthest + reach * length);
            place.high[2] = place.high[2].max(farthest);
        }
        place.of(triangle)
    }

    /// Pushes those of some segments that may pierce a triangle, touch it or be in near contact
    /// with it.
    fn push_meetings(&self, triangle: u32, segments: &[u32], found: &mut Vec<(u32, u32)>) {
        let corners = self.view.scene().triangles()[triangle as usize];
        let slab = self.view.sight().slab(corners, self.contact_tolerance);
        // Zero for a corner, `None` when that is in doubt.
        let side = |end: u32| match corners.contains(&end) {
            true => Some(Sign::Zero),
            false => self.view.sight().side_of_slab(&slab, end),
        };
        let may_meet = |[a, b]: [u32; 2]| match side(a) {
            None => true,
            // Of a segment that ends in a corner only the other end matters; a side has none.
            Some(Sign::Zero) => side(b).is_none(),
            Some(from) => side(b).is_none_or(|to| from.times(to) == Sign::Negative),
        };
        let meeting = segments.iter().filter(|&&i| may_meet(self.ends[i as usize]));
        found.extend(meeting.map(|&i| (i, triangle)));
    }
}
