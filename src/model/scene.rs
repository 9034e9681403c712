//! The scene, once for all views: mesh, triangles that hide, topology, and every line that can be drawn.
//!
//! Lines share one numbering, and so do their ends:
//!
//! ```text
//!   lines     edges of faces          | other lines: intersections, bends, wires | those of a view
//!   points    vertices of the mesh    | ends of lines other than vertices       | those of a view
//! ```
//!
//! A view may add its own lines and points; see
//! [`ViewSegments`](crate::classify::ViewSegments).

use crate::camera::Camera;
use crate::extent::Extent;
use crate::model::bends::{Bend, bends};
use crate::model::flush::{BoundaryPart, FlushEdges, flush_edges};
use crate::model::intersections::Intersections;
use crate::model::looseness::Looseness;
use crate::model::mesh::Mesh;
use crate::model::planes::planes;
use crate::model::topology::{EdgeUse, Topology};
use crate::model::triangulate::{newell_normal, triangulate};
use crate::predicates::PiercePoint;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::OnceLock;

/// A line that is not an edge of a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SceneLine {
    /// Its ends, as numbers of points.
    pub ends: [u32; 2],
    /// Where it comes from.
    pub source: LineSource,
}

/// Where a line comes from that is not an edge of a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineSource {
    /// Two faces cross: a number in [`Intersections::lines`].
    Intersection(u32),
    /// A bent face is folded: a number in [`Scene::bends`].
    Bend(u32),
    /// A polyline of the model that borders no face: a number in [`Mesh::wires`].
    Wire(u32),
    /// Part of a boundary edge: a number in [`Scene::boundary_parts`].
    BoundaryPart(u32),
}

/// The cosine of the angle between the normals of two faces that meet at an edge, as a fraction.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Dihedral {
    dot: f64,
    lengths: f64,
}

impl Dihedral {
    /// Whether the normals make more than the angle with this cosine.
    ///
    /// Rounded, since the angle is a setting. A face without area has no normal and no crease.
    #[inline]
    pub fn is_above(self, cosine: f64) -> bool {
        self.lengths > 0.0 && self.dot < cosine * self.lengths
    }
}

/// A mesh with everything about it that does not depend on the view.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    mesh: Mesh,
    topology: Topology,
    triangles: Vec<[u32; 3]>,
    triangle_faces: Vec<u32>,
    intersections: Intersections,
    bends: Vec<Bend>,
    /// All lines that are not whole edges of faces: intersections, then bends, then wires, then parts
    /// of boundary edges.
    lines: Vec<SceneLine>,
    normals: OnceLock<Vec<DVec3>>,
    dihedrals: OnceLock<Vec<Dihedral>>,
    groups: OnceLock<Vec<u32>>,
    planes: OnceLock<Vec<u32>>,
    looseness: OnceLock<Looseness>,
    flush_edges: FlushEdges,
    /// Vertices and ends of intersections, rounded; empty when there are none of the latter.
    points: Vec<DVec3>,
}

impl Scene {
    /// Triangulates the faces of `mesh` and finds its edges.
    pub fn new(mesh: Mesh) -> Self {
        let topology = Topology::new(&mesh);
        let (triangles, triangle_faces) = triangulate(&mesh);
        Self { mesh, topology, triangles, triangle_faces, ..Self::default() }.with_lines()
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
        self.with_lines()
    }

    /// Also finds where bent faces are folded, so that silhouettes that run there can be drawn.
    ///
    /// Edges of bent faces are then silhouettes by the triangles along them, not by the faces' mean
    /// normals. O(corners), in parallel.
    #[must_use]
    pub fn with_bends(mut self) -> Self {
        self.bends = bends(&self.mesh, &self.topology, &self.triangles, &self.triangle_faces);
        self.with_lines()
    }

    /// Lists the lines that are not edges of faces.
    fn with_lines(mut self) -> Self {
        self.lines.clear();
        let crossings = (0..).zip(self.intersections.lines());
        self.lines.extend(crossings.map(|(k, crossing)| SceneLine {
            ends: crossing.ends,
            source: LineSource::Intersection(k),
        }));
        let bends = (0..).zip(&self.bends);
        self.lines.extend(
            bends.map(|(k, bend)| SceneLine { ends: bend.ends, source: LineSource::Bend(k) }),
        );
        let wires = (0..).zip(self.mesh.wires());
        self.lines.extend(wires.map(|(k, &ends)| SceneLine { ends, source: LineSource::Wire(k) }));
        let parts = (0..).zip(&self.flush_edges.parts);
        self.lines.extend(
            parts.map(|(k, part)| SceneLine {
                ends: part.ends,
                source: LineSource::BoundaryPart(k),
            }),
        );
        self
    }

    /// Also finds boundary edges beyond which a coplanar face continues, as at T-junctions, so that they
    /// count as edges within a face. Those that are flush in part are split.
    /// Expected cost O(n log n) in boundary edges and triangles.
    #[must_use]
    pub fn with_flush_edges(mut self) -> Self {
        self.flush_edges =
            flush_edges(&self.mesh, &self.topology, &self.triangles, &self.triangle_faces);
        self.with_lines()
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Its edges and the faces along them.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// The triangles that hide lines, as vertex indices, face by face, with the winding of their face.
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

    /// Whether a boundary edge is known to lie flush in coplanar faces from end to end.
    /// O(log flush edges).
    pub fn is_flush(&self, edge: u32) -> bool {
        self.flush_edges.whole.binary_search(&edge).is_ok()
    }

    /// Parts of the boundary edges that lie flush in part; nothing before
    /// [`with_flush_edges`](Self::with_flush_edges).
    pub fn boundary_parts(&self) -> &[BoundaryPart] {
        &self.flush_edges.parts
    }

    /// Whether an edge is split: its parts are lines, in place of the whole.
    /// O(log boundary parts).
    pub fn is_split(&self, edge: u32) -> bool {
        self.flush_edges.parts.binary_search_by_key(&edge, |part| part.edge).is_ok()
    }

    /// Whether a face is known to be bent. O(log bends).
    pub fn is_bent(&self, face: u32) -> bool {
        let of = |bend: &Bend| self.triangle_faces[bend.triangles[0] as usize];
        self.bends.binary_search_by_key(&face, of).is_ok()
    }

    /// The extent of the scene in all these views together: the frame of a turntable.
    pub fn extent_of_views(&self, cameras: &[Camera]) -> Extent {
        cameras.iter().map(|camera| self.extent(camera)).fold(Extent::EMPTY, Extent::union)
    }

    /// The extent of the scene in the image of `camera`. O(vertices), in parallel; where the near
    /// plane cuts or the view is very wide, O(edges).
    pub fn extent(&self, camera: &Camera) -> Extent {
        let (edges, wires) = (self.topology.edges(), self.mesh.wires());
        Extent::new(self.mesh.positions(), &[edges, wires], camera)
    }

    /// The positions of all vertices, then those of constructed points, rounded.
    pub fn points(&self) -> &[DVec3] {
        if self.points.is_empty() { self.mesh.positions() } else { &self.points }
    }

    /// The Newell normal of each face, not normalized. Where coordinates are extremely large or small it
    /// is that of the scene scaled by a power of two. Computed on first use; O(corners), in parallel.
    pub fn normals(&self) -> &[DVec3] {
        computed_once::<Vec<DVec3>>(&self.normals, || {
            let positions = self.mesh.positions();
            let sizes = positions.par_iter().map(|p| p.abs().max_element());
            let (_, exponent) = libm::frexp(sizes.reduce(|| 0.0, f64::max));
            let scaled: Vec<DVec3>;
            let positions = if exponent.abs() <= MOST_EXPONENT {
                positions
            } else {
                let factor = libm::ldexp(1.0, -exponent.clamp(-1000, 1000));
                scaled = positions.par_iter().map(|&p| p * factor).collect();
                &scaled
            };
            let faces = (0..self.mesh.n_faces() as u32).into_par_iter();
            faces.map(|face| newell_normal(positions, self.mesh.face(face))).collect()
        })
    }

    /// At each edge, the angle between its two faces, one of them flipped if their windings disagree; 0° at
    /// edges of more or fewer faces. Computed on first use; O(corners), in parallel.
    pub fn dihedrals(&self) -> &[Dihedral] {
        computed_once::<Vec<Dihedral>>(&self.dihedrals, || {
            let normals = self.normals();
            let edges = (0..self.topology.edges().len() as u32).into_par_iter().with_min_len(4096);
            edges.map(|edge| dihedral(self.topology.uses(edge), normals)).collect()
        })
    }

    /// How organic the shapes of the models are, measured when first needed.
    pub(super) fn looseness_or(&self, measure: impl FnOnce(&Self) -> Looseness) -> &Looseness {
        computed_once(&self.looseness, || measure(self))
    }

    /// For each face a number that faces of equal group and material share; empty when the model
    /// names neither. Computed on first use.
    pub fn groups(&self) -> &[u32] {
        computed_once::<Vec<u32>>(&self.groups, || {
            let mut first = HashMap::new();
            let names = self.mesh.parts().iter().map(|part| (&part.group, &part.material));
            let numbers: Vec<u32> =
                (0..).zip(names).map(|(i, names)| *first.entry(names).or_insert(i)).collect();
            self.mesh.face_parts().iter().map(|&part| numbers[part as usize]).collect()
        })
    }

    /// For each triangle a number; triangles with the same number lie in one plane, exactly. Others may also
    /// do so, where no edge connects them. Computed on first use; O(corners), in parallel.
    pub fn planes(&self) -> &[u32] {
        computed_once::<Vec<u32>>(&self.planes, || {
            planes(&self.mesh, &self.topology, &self.triangles, &self.triangle_faces)
        })
    }

    /// The lines that are not edges of faces. Their numbers follow those of the edges.
    pub fn other_lines(&self) -> &[SceneLine] {
        &self.lines
    }

    /// Number of lines: edges of faces and others.
    pub fn n_lines(&self) -> usize {
        self.topology.edges().len() + self.lines.len()
    }

    /// The ends of a line, as numbers of points. Panics when there is no such line.
    #[inline]
    pub fn line(&self, line: u32) -> [u32; 2] {
        let edges = self.topology.edges();
        match edges.get(line as usize) {
            Some(&ends) => ends,
            None => self.lines[line as usize - edges.len()].ends,
        }
    }

    /// Where a line comes from; `None` for an edge of a face, and for a line that only a view has.
    #[inline]
    pub fn source(&self, line: u32) -> Option<LineSource> {
        let number = (line as usize).checked_sub(self.topology.edges().len())?;
        self.lines.get(number).map(|line| line.source)
    }
}

fn dihedral(uses: &[EdgeUse], normals: &[DVec3]) -> Dihedral {
    let &[first, second] = uses else { return Dihedral::default() };
    let [a, b] = [first, second].map(|used| normals[used.face() as usize]);
    let dot = if first.runs_upwards() == second.runs_upwards() { -a.dot(b) } else { a.dot(b) };
    Dihedral { dot, lengths: a.length() * b.length() }
}

/// Coordinates up to this power of two, and down to its inverse, have products of four that are in the range
/// of numbers: dot products of normals.
const MOST_EXPONENT: i32 = 200;

/// The value of a cell, computed if it is empty.
///
/// Views may be drawn in parallel, and `compute` runs in parallel itself. So the cell is not locked
/// meanwhile: a thread that picks up another view's work would deadlock. Two threads may both compute
/// the value.
fn computed_once<T>(cell: &OnceLock<T>, compute: impl FnOnce() -> T) -> &T {
    match cell.get() {
        Some(known) => known,
        None => {
            let computed = compute();
            cell.get_or_init(|| computed)
        }
    }
}
