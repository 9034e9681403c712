//! The scene, once for all views: mesh, triangles that hide, and topology.

use crate::mesh::Mesh;
use crate::topology::Topology;
use crate::triangulate::triangulate;

/// A mesh with everything about it that does not depend on the view.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scene {
    mesh: Mesh,
    topology: Topology,
    triangles: Vec<[u32; 3]>,
    triangle_faces: Vec<u32>,
}

impl Scene {
    /// Triangulates the faces of `mesh` and finds its edges.
    pub fn new(mesh: Mesh) -> Self {
        let topology = Topology::new(&mesh);
        let (triangles, triangle_faces) = triangulate(&mesh);
        Self { mesh, topology, triangles, triangle_faces }
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
}
