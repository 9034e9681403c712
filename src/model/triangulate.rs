//! Polygons into triangles: exact ear clipping.
//!
//! The polygon is projected onto the coordinate plane perpendicular to the largest component of its Newell
//! normal, which is exact. There an *ear* is a corner that turns the same way as the polygon and whose
//! triangle contains no other corner:
//!
//! ```text
//!            ● next
//!           ╱ ╲               corner, next and previous are cut off
//!   corner ●   ╲              if no other vertex of the polygon
//!           ╲   ╲             is in or on the triangle
//!            ●───●
//!      previous
//! ```
//!
//! A vertex equal to one of the three corners does not count, so that keyhole polygons (a hole joined to
//! the outline by a bridge that runs both ways) are handled. A polygon that crosses itself has no correct
//! answer; it still yields `corners − 2` triangles.

use crate::model::mesh::Mesh;
use crate::predicates::{Sign, orient2d};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Triangles of all faces, and the face of each, in the order of the faces.
///
/// A face of `n` corners makes `n − 2` triangles, wound as the face. In parallel; O(n) for convex
/// faces, O(n²) at worst.
pub fn triangulate(mesh: &Mesh) -> (Vec<[u32; 3]>, Vec<u32>) {
    let n_triangles = mesh.corners().len() - 2 * mesh.n_faces();
    let mut triangles = vec![[0; 3]; n_triangles];
    let mut faces = vec![0; n_triangles];
    // A chunk of faces owns the run of triangles that they make.
    const CHUNK: usize = 4096;
    let n_chunks = mesh.n_faces().div_ceil(CHUNK);
    let mut runs = Vec::with_capacity(n_chunks);
    let (mut triangles_left, mut faces_left) = (&mut triangles[..], &mut faces[..]);
    for chunk in 0..n_chunks {
        let (first, last) = (chunk * CHUNK, ((chunk + 1) * CHUNK).min(mesh.n_faces()));
        let starts = mesh.face_starts();
        let n = (starts[last] - starts[first]) as usize - 2 * (last - first);
        let (triangle_run, rest) = triangles_left.split_at_mut(n);
        let (face_run, face_rest) = faces_left.split_at_mut(n);
        (triangles_left, faces_left) = (rest, face_rest);
        runs.push((first as u32..last as u32, triangle_run, face_run));
    }
    runs.into_par_iter().for_each(|(range, triangle_run, face_run)| {
        let mut clipper = EarClipper::default();
        let mut at = 0;
        for face in range {
            let corners = mesh.face(face);
            let n = corners.len() - 2;
            clipper.clip(mesh.positions(), corners, &mut triangle_run[at..at + n]);
            face_run[at..at + n].fill(face);
            at += n;
        }
    });
    (triangles, faces)
}

/// Newell's normal: twice the polygon's area as a vector, right for concave polygons.
pub fn newell_normal(positions: &[DVec3], corners: &[u32]) -> DVec3 {
    let mut normal = DVec3::ZERO;
    let Some((&first, rest)) = corners.split_first() else {
        return normal;
    };
    // Relative to the first corner, so that no digits are lost far from the origin.
    let base = positions[first as usize];
    for pair in rest.windows(2) {
        let (a, b) = (positions[pair[0] as usize] - base, positions[pair[1] as usize] - base);
        normal += a.cross(b);
    }
    normal
}

/// Scratch space, reused from polygon to polygon.
#[derive(Default)]
struct EarClipper {
    points: Vec<DVec2>,
    previous: Vec<u32>,
    next: Vec<u32>,
}

impl EarClipper {
    /// Fills `out` with the triangles of one polygon; `out` holds two fewer than `corners`.
    fn clip(&mut self, positions: &[DVec3], corners: &[u32], out: &mut [[u32; 3]]) {
        if let &[a, b, c] = corners {
            out[0] = [a, b, c];
            return;
        }
        self.flatten(positions, corners);
        let n = corners.len();
        self.previous.clear();
        self.previous.extend((0..n as u32).map(|i| (i + n as u32 - 1) % n as u32));
        self.next.clear();
        self.next.extend((0..n as u32).map(|i| (i + 1) % n as u32));

        let mut corner = 0u32;
        for (n_cut, triangle) in out.iter_mut().enumerate() {
            let n_left = n - n_cut;
            corner = self.find_ear(corner, n_left);
            let (before, after) = (self.previous[corner as usize], self.next[corner as usize]);
            *triangle = [before, corner, after].map(|i| corners[i as usize]);
            self.next[before as usize] = after;
            self.previous[after as usize] = before;
            // Continuing two corners further spreads the cuts around a convex polygon.
            corner = self.next[after as usize];
        }
    }

    /// Projects the corners so that the polygon runs counter-clockwise.
    fn flatten(&mut self, positions: &[DVec3], corners: &[u32]) {
        let normal = newell_normal(positions, corners);
        let size = normal.abs();
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let (i, j) = if normal[axis] < 0.0 { (j, i) } else { (i, j) };
        self.points.clear();
        self.points.extend(corners.iter().map(|&v| {
            let p = positions[v as usize];
            DVec2::new(p[i], p[j])
        }));
    }

    /// The first ear at or after `start`; failing that, the first straight corner, or else `start`.
    fn find_ear(&self, start: u32, n_left: usize) -> u32 {
        let mut straight = None;
        let mut corner = start;
        for _ in 0..n_left {
            match self.turn_at(corner) {
                Sign::Positive if n_left == 3 || self.is_empty(corner) => return corner,
                Sign::Zero if straight.is_none() => straight = Some(corner),
                _ => {}
            }
            corner = self.next[corner as usize];
        }
        straight.unwrap_or(start)
    }

    fn turn_at(&self, corner: u32) -> Sign {
        let [a, b, c] = self.triangle(corner);
        orient2d(a, b, c)
    }

    fn triangle(&self, corner: u32) -> [DVec2; 3] {
        [self.previous[corner as usize], corner, self.next[corner as usize]]
            .map(|i| self.points[i as usize])
    }

    /// Whether the triangle at `corner` contains no other vertex, neither inside nor on its border.
    fn is_empty(&self, corner: u32) -> bool {
        let [a, b, c] = self.triangle(corner);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let last = self.previous[corner as usize];
        let mut i = self.next[self.next[corner as usize] as usize];
        while i != last {
            let p = self.points[i as usize];
            let in_box = p.cmpge(low).all() && p.cmple(high).all();
            if in_box
                && p != a
                && p != b
                && p != c
                && orient2d(a, b, p) != Sign::Negative
                && orient2d(b, c, p) != Sign::Negative
                && orient2d(c, a, p) != Sign::Negative
            {
                return false;
            }
            i = self.next[i as usize];
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mesh::PolygonSoup;
    use glam::dvec3;

    /// Triangulates one polygon in the plane z = 0 and returns twice the triangles' areas.
    fn doubled_areas(points: &[(f64, f64)]) -> Vec<f64> {
        let mut soup = PolygonSoup {
            positions: points.iter().map(|&(x, y)| dvec3(x, y, 0.0)).collect(),
            ..Default::default()
        };
        soup.push_face(&(0..points.len() as u32).collect::<Vec<_>>());
        let (mesh, _) = Mesh::new(soup).expect("finite points");
        let (triangles, faces) = triangulate(&mesh);
        assert!(faces.iter().all(|&face| face == 0));
        triangles
            .iter()
            .map(|&[a, b, c]| {
                let [a, b, c] = [a, b, c].map(|v| mesh.positions()[v as usize]);
                (b - a).cross(c - a).z
            })
            .collect()
    }

    #[test]
    fn a_concave_quad_is_cut_inside() {
        // A dart: the diagonal between its two wing tips would run outside.
        let areas = doubled_areas(&[(0.0, 0.0), (2.0, 4.0), (0.0, 1.0), (-2.0, 4.0)]);
        assert!(areas.iter().all(|&area| area > 0.0), "{areas:?}");
        assert_eq!(areas.iter().sum::<f64>(), 4.0);
    }

    #[test]
    fn a_clockwise_polygon_keeps_its_winding() {
        let areas = doubled_areas(&[(0.0, 0.0), (0.0, 2.0), (2.0, 2.0), (2.0, 1.0), (1.0, 0.0)]);
        assert!(areas.iter().all(|&area| area < 0.0), "{areas:?}");
        assert_eq!(areas.iter().sum::<f64>(), -7.0);
    }

    #[test]
    fn a_keyhole_polygon_leaves_its_hole_open() {
        let outline = [(0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0), (0.0, 0.0)];
        let hole = [(2.0, 2.0), (2.0, 4.0), (4.0, 4.0), (4.0, 2.0), (2.0, 2.0)];
        let keyhole: Vec<_> = outline.into_iter().chain(hole).collect();
        let areas = doubled_areas(&keyhole);
        assert!(areas.iter().all(|&area| area >= 0.0), "{areas:?}");
        assert_eq!(areas.iter().sum::<f64>(), 2.0 * (36.0 - 4.0));
    }

    #[test]
    fn corners_on_a_straight_side_cost_no_area() {
        let areas = doubled_areas(&[
            (0.0, 0.0),
            (1.0, 0.0),
            (2.0, 0.0),
            (3.0, 0.0),
            (3.0, 3.0),
            (2.0, 3.0),
            (0.0, 3.0),
        ]);
        assert!(areas.iter().all(|&area| area >= 0.0), "{areas:?}");
        assert_eq!(areas.iter().sum::<f64>(), 18.0);
    }
}
