//! Polygons over shared points: what every reader produces and every later stage starts from.
//!
//! A reader fills a [`PolygonSoup`] with whatever the file says. [`Mesh::new`] turns it into a
//! [`Mesh`] in which equal positions are one vertex and every face has at least three corners.

mod weld;

use std::collections::HashSet;

use glam::DVec3;
use thiserror::Error;

use weld::{first_equal_position, first_near_position};

/// Faces as a file lists them: positions may repeat, faces may be degenerate.
///
/// Face `f` has the corners `corners[face_starts[f]..face_starts[f + 1]]`, each an index into
/// `positions`; `face_starts` has one entry more than there are faces and begins with 0.
#[derive(Debug, Clone, PartialEq)]
pub struct PolygonSoup {
    /// Points in model units, as read: nothing is rounded.
    pub positions: Vec<DVec3>,
    /// Indices into `positions`, face after face.
    pub corners: Vec<u32>,
    /// Where each face begins in `corners`, and where the last one ends.
    pub face_starts: Vec<u32>,
    /// For each face an index into `parts`; empty when the file names no parts.
    pub face_parts: Vec<u32>,
    /// The groups and materials that the file names.
    pub parts: Vec<Part>,
    /// Segments of polylines that border no face, as pairs of indices into `positions`.
    pub wires: Vec<[u32; 2]>,
}

/// What a file calls a run of faces: its object or group, and its material.
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash)]
pub struct Part {
    /// Name of the object or group; empty when the file gives none.
    pub group: String,
    /// Name of the material; empty when the file gives none.
    pub material: String,
    /// Which of the models that were put together it is a part of, counted from 0.
    pub model: u32,
}

impl Default for PolygonSoup {
    fn default() -> Self {
        Self {
            positions: Vec::new(),
            corners: Vec::new(),
            face_starts: vec![0],
            face_parts: Vec::new(),
            parts: Vec::new(),
            wires: Vec::new(),
        }
    }
}

impl PolygonSoup {
    /// Appends one face.
    pub fn push_face(&mut self, corners: &[u32]) {
        self.corners.extend_from_slice(corners);
        self.face_starts.push(self.corners.len() as u32);
    }

    /// Appends the segments of a polyline that borders no face.
    pub fn push_wire(&mut self, points: &[u32]) {
        self.wires.extend(points.windows(2).map(|pair| [pair[0], pair[1]]));
    }

    /// Number of faces, degenerate ones included.
    pub fn n_faces(&self) -> usize {
        self.face_starts.len().saturating_sub(1)
    }
}

/// A polygon mesh: finite positions, no two of them equal, faces of three corners or more.
///
/// Consecutive corners of a face differ. Nothing else is promised: faces may be concave, bent, of
/// zero area, wound either way, and an edge may have any number of faces.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    positions: Vec<DVec3>,
    corners: Vec<u32>,
    face_starts: Vec<u32>,
    face_parts: Vec<u32>,
    parts: Vec<Part>,
    wires: Vec<[u32; 2]>,
}

/// What [`Mesh::new`] changed on the way from soup to mesh.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Repairs {
    /// Positions that were equal to an earlier one and became the same vertex.
    pub welded_vertices: usize,
    /// Positions that neither a face nor a wire uses.
    pub unused_vertices: usize,
    /// Faces left with fewer than three corners.
    pub degenerate_faces: usize,
    /// Corners equal to the one before them on the same face.
    pub repeated_corners: usize,
    /// Wires whose ends are one vertex, or that are the same as an earlier one.
    pub dropped_wires: usize,
}

impl std::ops::AddAssign for Repairs {
    fn add_assign(&mut self, more: Self) {
        self.welded_vertices += more.welded_vertices;
        self.unused_vertices += more.unused_vertices;
        self.degenerate_faces += more.degenerate_faces;
        self.repeated_corners += more.repeated_corners;
        self.dropped_wires += more.dropped_wires;
    }
}

/// Why a [`PolygonSoup`] is no mesh.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum MeshError {
    /// A coordinate is infinite or not a number.
    #[error("vertex {vertex} is not finite")]
    NotFinite {
        /// Position in the list, counted from 0.
        vertex: usize,
    },
    /// A corner names a vertex that does not exist.
    #[error("face {face} refers to vertex {vertex}, but there are only {n_vertices}")]
    MissingVertex {
        /// Face in the list, counted from 0.
        face: usize,
        /// The index it uses, counted from 0.
        vertex: u32,
        /// How many positions there are.
        n_vertices: usize,
    },
    /// A wire names a vertex that does not exist.
    #[error("wire {wire} refers to vertex {vertex}, but there are only {n_vertices}")]
    MissingWireVertex {
        /// Wire in the list, counted from 0.
        wire: usize,
        /// The index it uses, counted from 0.
        vertex: u32,
        /// How many positions there are.
        n_vertices: usize,
    },
    /// A distance to weld within that is negative, infinite or not a number.
    #[error("the distance to weld within is {distance}; it must be a finite number, 0 or more")]
    BadDistance {
        /// The distance as given, in model units.
        distance: f64,
    },
    /// More than 2³² − 1 vertices or corners.
    #[error("more than 4,294,967,294 vertices or face corners")]
    TooLarge,
}

impl Mesh {
    /// Welds equal positions, removes repeated corners and faces without area to span, and drops
    /// wires without length and those given twice.
    ///
    /// Positions are equal when their coordinates are (−0 is 0); the first of them stands for all,
    /// and vertices keep the order of their first appearance. O(vertices + corners).
    ///
    /// # Errors
    /// A coordinate that is not finite, an index out of range, or too many of either.
    pub fn new(soup: PolygonSoup) -> Result<(Self, Repairs), MeshError> {
        let n_vertices = soup.positions.len();
        if n_vertices >= u32::MAX as usize || soup.corners.len() >= u32::MAX as usize {
            return Err(MeshError::TooLarge);
        }
        if let Some(vertex) = soup.positions.iter().position(|p| !p.is_finite()) {
            return Err(MeshError::NotFinite { vertex });
        }
        for (face, range) in soup.face_starts.windows(2).enumerate() {
            for &vertex in &soup.corners[range[0] as usize..range[1] as usize] {
                if vertex as usize >= n_vertices {
                    return Err(MeshError::MissingVertex { face, vertex, n_vertices });
                }
            }
        }
        for (wire, ends) in soup.wires.iter().enumerate() {
            if let Some(&vertex) = ends.iter().find(|&&end| end as usize >= n_vertices) {
                return Err(MeshError::MissingWireVertex { wire, vertex, n_vertices });
            }
        }
        let mut repairs = Repairs::default();
        let first_equal = first_equal_position(&soup.positions);
        repairs.welded_vertices =
            first_equal.iter().enumerate().filter(|&(i, &first)| i as u32 != first).count();

        let mut mesh = Self {
            positions: Vec::with_capacity(n_vertices - repairs.welded_vertices),
            corners: Vec::with_capacity(soup.corners.len()),
            face_starts: Vec::with_capacity(soup.face_starts.len()),
            face_parts: Vec::new(),
            parts: soup.parts,
            wires: Vec::with_capacity(soup.wires.len()),
        };
        mesh.face_starts.push(0);
        let mut used = vec![false; n_vertices];
        for (face, range) in soup.face_starts.windows(2).enumerate() {
            let start = mesh.corners.len();
            for &corner in &soup.corners[range[0] as usize..range[1] as usize] {
                let vertex = first_equal[corner as usize];
                if mesh.corners.len() > start && mesh.corners.last() == Some(&vertex) {
                    repairs.repeated_corners += 1;
                } else {
                    mesh.corners.push(vertex);
                }
            }
            while mesh.corners.len() > start + 1
                && mesh.corners.last() == Some(&mesh.corners[start])
            {
                mesh.corners.pop();
                repairs.repeated_corners += 1;
            }
            if mesh.corners.len() < start + 3 {
                mesh.corners.truncate(start);
                repairs.degenerate_faces += 1;
                continue;
            }
            for &vertex in &mesh.corners[start..] {
                used[vertex as usize] = true;
            }
            mesh.face_starts.push(mesh.corners.len() as u32);
            if let Some(&part) = soup.face_parts.get(face) {
                mesh.face_parts.push(part);
            }
        }

        let mut known = HashSet::new();
        for ends in &soup.wires {
            let [a, b] = ends.map(|end| first_equal[end as usize]);
            if a == b || !known.insert([a.min(b), a.max(b)]) {
                repairs.dropped_wires += 1;
                continue;
            }
            (used[a as usize], used[b as usize]) = (true, true);
            mesh.wires.push([a, b]);
        }

        let mut renumbered = vec![u32::MAX; n_vertices];
        for (vertex, &position) in soup.positions.iter().enumerate() {
            if used[vertex] {
                renumbered[vertex] = mesh.positions.len() as u32;
                // Adding zero turns −0 into 0 and leaves every other number as it is.
                mesh.positions.push(position + DVec3::ZERO);
            } else if first_equal[vertex] as usize == vertex {
                repairs.unused_vertices += 1;
            }
        }
        for corner in mesh.corners.iter_mut().chain(mesh.wires.as_flattened_mut()) {
            *corner = renumbered[*corner as usize];
        }
        Ok((mesh, repairs))
    }

    /// Makes vertices that are closer than `distance` (model units) one, and says what changed.
    ///
    /// Chains count: two vertices become one when steps shorter than `distance` lead from one to
    /// the other over vertices of the mesh. The first vertex of each group keeps its position, so a
    /// distance longer than the edges of a mesh makes it vanish. Zero changes nothing.
    /// Nearly O(v log v), also for vertices that crowd together.
    ///
    /// # Errors
    /// A distance that is negative, infinite or not a number.
    pub fn weld(self, distance: f64) -> Result<(Self, Repairs), MeshError> {
        if !(distance.is_finite() && distance >= 0.0) {
            return Err(MeshError::BadDistance { distance });
        }
        if distance == 0.0 {
            return Ok((self, Repairs::default()));
        }
        let first_near = first_near_position(&self.positions, distance);
        let positions = first_near.iter().map(|&first| self.positions[first as usize]).collect();
        Self::new(PolygonSoup {
            positions,
            corners: self.corners,
            face_starts: self.face_starts,
            face_parts: self.face_parts,
            parts: self.parts,
            wires: self.wires,
        })
    }

    /// Vertex positions in model units.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Vertex indices of all faces, one face after the other.
    pub fn corners(&self) -> &[u32] {
        &self.corners
    }

    /// Where each face begins in [`corners`](Self::corners), and where the last one ends.
    pub fn face_starts(&self) -> &[u32] {
        &self.face_starts
    }

    /// Number of faces.
    pub fn n_faces(&self) -> usize {
        self.face_starts.len().saturating_sub(1)
    }

    /// Vertex indices of one face, in the order of its border. Panics when there is no such face.
    pub fn face(&self, face: u32) -> &[u32] {
        let face = face as usize;
        &self.corners[self.face_starts[face] as usize..self.face_starts[face + 1] as usize]
    }

    /// Index into [`parts`](Self::parts) of each face; empty when the model names no parts.
    pub fn face_parts(&self) -> &[u32] {
        &self.face_parts
    }

    /// The groups and materials of the model.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Segments of polylines that border no face, as pairs of vertex indices: they can be hidden and
    /// hide nothing. No two of them are the same, and none has equal ends.
    pub fn wires(&self) -> &[[u32; 2]] {
        &self.wires
    }

    /// Smallest box around all vertices as (lowest, highest) corner; `None` without vertices.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let (first, rest) = self.positions.split_first()?;
        Some(rest.iter().fold((*first, *first), |(low, high), &p| (low.min(p), high.max(p))))
    }
}
