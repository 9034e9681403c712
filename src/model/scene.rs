//! The scene, once for all views: mesh, triangles that hide, topology, and where faces cross.
//!
//! All that can be drawn is numbered in one row, and so are its ends:
//!
//! ```text
//!   lines     edges of the mesh       | lines of intersection               | bends
//!   points    vertices of the mesh    | ends of those that are no vertices
//! ```

use crate::camera::Camera;
use crate::extent::Extent;
use crate::model::bends::{Bend, bends};
use crate::model::intersections::{Intersection, Intersections};
use crate::model::mesh::Mesh;
use crate::model::topology::Topology;
use crate::model::triangulate::triangulate;
use crate::predicates::PiercePoint;
use glam::DVec3;

/// A mesh with everything about it that does not depend on the view.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scene {
    mesh: Mesh,
    topology: Topology,
    triangles: Vec<[u32; 3]>,
    triangle_faces: Vec<u32>,
    intersections: Intersections,
    bends: Vec<Bend>,
    /// Vertices and ends of intersections, rounded; empty when there are none of the latter.
    points: Vec<DVec3>,
}

impl Scene {
    /// Triangulates the faces of `mesh` and finds its edges.
    pub fn new(mesh: Mesh) -> Self {
        let topology = Topology::new(&mesh);
        let (triangles, triangle_faces) = triangulate(&mesh);
        Self { mesh, topology, triangles, triangle_faces, ..Self::default() }
    }

    /// Also finds the lines in which faces cross, so that they can be drawn.
    ///
    /// For the cost see [`crate::model::intersections`].
    #[must_use]
    pub fn with_intersections(mut self) -> Self {
        self.intersections =
            Intersections::new(&self.mesh, &self.triangles, &self.triangle_faces, &self.topology);
        self.points = Vec::new();
        let constructed = self.intersections.points();
        if !constructed.is_empty() {
            self.points.reserve_exact(self.mesh.positions().len() + constructed.len());
            self.points.extend_from_slice(self.mesh.positions());
            self.points.extend(constructed.iter().map(PiercePoint::rounded));
        }
        self
    }

    /// Also finds where bent faces are folded, so that contours which run there can be drawn.
    ///
    /// Edges beside bent faces then are silhouettes by the triangles along them, not by the faces'
    /// mean normals. O(corners), in parallel.
    #[must_use]
    pub fn with_bends(mut self) -> Self {
        self.bends = bends(&self.mesh, &self.topology, &self.triangles, &self.triangle_faces);
        self
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Its edges and the faces along them.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// The triangles that cover, as vertex indices, face by face; they are wound as their face is.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The face that each triangle is part of.
    pub fn triangle_faces(&self) -> &[u32] {
        &self.triangle_faces
    }

    /// Where faces cross; nothing before [`with_intersections`](Self::with_intersections).
    pub fn intersections(&self) -> &Intersections {
        &self.intersections
    }

    /// Where bent faces are folded; nothing before [`with_bends`](Self::with_bends).
    pub fn bends(&self) -> &[Bend] {
        &self.bends
    }

    /// Whether a face is known to be bent. O(log bends).
    pub fn is_bent(&self, face: u32) -> bool {
        let of = |bend: &Bend| self.triangle_faces[bend.triangles[0] as usize];
        self.bends.binary_search_by_key(&face, of).is_ok()
    }

    /// What of the image the scene takes up as `camera` sees it. O(vertices), in parallel; where the
    /// near plane cuts or the view is very wide, O(edges).
    pub fn extent(&self, camera: &Camera) -> Extent {
        Extent::new(self.mesh.positions(), self.topology.edges(), camera)
    }

    /// The positions of all vertices, then those of constructed points, rounded.
    pub fn points(&self) -> &[DVec3] {
        if self.points.is_empty() { self.mesh.positions() } else { &self.points }
    }

    /// Number of edges, lines of intersection and bends.
    pub fn n_lines(&self) -> usize {
        self.topology.edges().len() + self.intersections.lines().len() + self.bends.len()
    }

    /// The ends of an edge, line of intersection or bend, as numbers of points. Panics when there is no
    /// such line.
    #[inline]
    pub fn line(&self, line: u32) -> [u32; 2] {
        let edges = self.topology.edges();
        if let Some(&ends) = edges.get(line as usize) {
            return ends;
        }
        let (number, crossings) = (line as usize - edges.len(), self.intersections.lines());
        match crossings.get(number) {
            Some(crossing) => crossing.ends,
            None => self.bends[number - crossings.len()].ends,
        }
    }

    /// The line of intersection with this number among all lines; `None` for an edge or bend.
    #[inline]
    pub fn intersection(&self, line: u32) -> Option<&Intersection> {
        let number = (line as usize).checked_sub(self.topology.edges().len())?;
        self.intersections.lines().get(number)
    }
}
