//! The box around a surface, with its faces and edges as an eye sees them.
//!
//! ```text
//!        ┌──────────┐         front face: the eye is on its outer side
//!       ╱  back    ╱│         outline: edges between a front face and another one; nothing in the box
//!      ┌──────────┐ │                  hides them
//!      │  front   │ ┘         back edges: between two back faces; the surface may hide them
//!      └──────────┘╱          front edges: between two front faces; they hide nothing
//! ```

use glam::{DVec2, DVec3};

use crate::camera::{Camera, Projection};

/// A box seen by a camera.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoundingBox<'a> {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    pub(super) camera: &'a Camera,
}

/// An edge along an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BoxEdge {
    pub(super) axis: usize,
    /// For each axis, whether it is on the high side; that of its own axis does not count.
    pub(super) sides: [bool; 3],
}

/// Where an edge is, as the eye sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum EdgePlace {
    Outline,
    Front,
    Back,
}

impl BoundingBox<'_> {
    pub(super) fn corner(&self, is_high: [bool; 3]) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|k| self.side(k, is_high[k])))
    }

    /// The coordinate of a face.
    pub(super) fn side(&self, axis: usize, is_high: bool) -> f64 {
        if is_high { self.high[axis] } else { self.low[axis] }
    }

    pub(super) fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|k| self.corner([k & 1, k >> 1 & 1, k >> 2 & 1].map(|b| b == 1)))
    }

    /// Whether the eye is in front of a face. One that is seen edge-on counts as it would from a
    /// slightly smaller azimuth, so that axes change sides only once.
    pub(super) fn is_front(&self, axis: usize, is_high: bool) -> bool {
        let outwards = if is_high { 1.0 } else { -1.0 };
        let toward_eye = self.toward_eye(axis, is_high);
        if toward_eye != 0.0 {
            return toward_eye * outwards > 0.0;
        }
        let forward = self.camera.forward();
        let step = [-forward.y, forward.x, 0.0][axis];
        step * outwards > 0.0
    }

    /// Whether a face is behind all that is in the box, with an image that is an area. If the eye is
    /// between two opposite faces, this is the farther one.
    pub(super) fn is_wall(&self, axis: usize, is_high: bool) -> bool {
        let outwards = if is_high { 1.0 } else { -1.0 };
        let distance = |is_high| self.toward_eye(axis, is_high);
        let is_behind = |is_high: bool, outwards: f64| distance(is_high) * outwards < 0.0;
        let has_two = is_behind(is_high, outwards) && is_behind(!is_high, -outwards);
        is_behind(is_high, outwards)
            && (!has_two
                || matches!(self.camera.projection(), Projection::Orthographic)
                || distance(is_high).abs() > distance(!is_high).abs()
                || distance(is_high).abs() == distance(!is_high).abs() && !is_high)
    }

    /// Which way the eye is from a face along an axis: exact in its sign.
    fn toward_eye(&self, axis: usize, is_high: bool) -> f64 {
        match self.camera.projection() {
            Projection::Perspective { .. } => {
                let (eye, side) = (self.camera.eye()[axis], self.side(axis, is_high));
                // Differences of unequal numbers are never zero.
                eye - side
            }
            Projection::Orthographic => -self.camera.forward()[axis],
        }
    }

    /// The four edges along an axis; none if the box has no extent there.
    pub(super) fn edges(&self, axis: usize) -> impl Iterator<Item = BoxEdge> + use<> {
        let has_extent = self.low[axis] < self.high[axis];
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let all = [[false, false], [true, false], [true, true], [false, true]];
        all.into_iter().filter(move |_| has_extent).map(move |[on_b, on_c]| {
            let mut sides = [false; 3];
            (sides[b], sides[c]) = (on_b, on_c);
            BoxEdge { axis, sides }
        })
    }

    pub(super) fn place(&self, edge: &BoxEdge) -> EdgePlace {
        let fronts = [1, 2].map(|k| {
            let axis = (edge.axis + k) % 3;
            self.is_front(axis, edge.sides[axis])
        });
        match fronts {
            [true, true] => EdgePlace::Front,
            [false, false] => EdgePlace::Back,
            _ => EdgePlace::Outline,
        }
    }

    /// The ends of an edge, at the low and the high end of its axis.
    pub(super) fn ends(&self, edge: &BoxEdge) -> [DVec3; 2] {
        [false, true].map(|is_high| {
            let mut sides = edge.sides;
            sides[edge.axis] = is_high;
            self.corner(sides)
        })
    }

    pub(super) fn image_of(&self, edge: &BoxEdge) -> [DVec2; 2] {
        self.ends(edge).map(|p| self.camera.image(p))
    }

    /// Of the edges of the outline along an axis the one for which `key` of its middle in the image is
    /// least.
    pub(super) fn outline_edge(&self, axis: usize, key: impl Fn(DVec2) -> f64) -> Option<BoxEdge> {
        let outline = self.edges(axis).filter(|edge| self.place(edge) == EdgePlace::Outline);
        outline.min_by(|one, other| {
            let [one, other] = [one, other].map(|edge| {
                let [a, b] = self.image_of(edge);
                key(a / 2.0 + b / 2.0)
            });
            one.total_cmp(&other)
        })
    }

    /// The axis along which ticks on an edge run: that of the face beside it which is behind the
    /// surface. `None` unless there is exactly one.
    pub(super) fn across(&self, edge: &BoxEdge) -> Option<usize> {
        let [b, c] = [1, 2].map(|k| (edge.axis + k) % 3);
        let [of_b, of_c] = [b, c].map(|axis| self.is_front(axis, edge.sides[axis]));
        // A face at right angles to b extends along c.
        match (of_b, of_c) {
            (true, false) => Some(b),
            (false, true) => Some(c),
            _ => None,
        }
    }
}

/// The convex hull of some points, counterclockwise.
pub(super) fn hull(points: &[DVec2]) -> Vec<DVec2> {
    let mut points = points.to_vec();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(p - a) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut points.iter().copied());
    hull.extend(half(&mut points.iter().rev().copied()));
    hull
}
