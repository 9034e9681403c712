//! Polygons and wires over shared points: what every reader produces, and where every later stage starts.
//!
//! A reader fills a [`PolygonSoup`] with whatever the file says. [`Mesh::new`] turns it into a
//! [`Mesh`] in which equal positions are one vertex and every face has at least three corners.

mod equal_faces;
mod precision;
mod weld;

use std::collections::HashSet;

use glam::DVec3;
use thiserror::Error;

use equal_faces::first_equal_face;
use precision::coordinate_error;
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
    /// For each face an index into `parts`; empty when the file has no parts.
    pub face_parts: Vec<u32>,
    /// The groups, materials and colors in the file.
    pub parts: Vec<MeshPart>,
    /// For each corner the unit normal that the file gives there, zero where it gives none; empty
    /// when it has no normals.
    pub corner_normals: Vec<[f32; 3]>,
    /// Segments that border no face, as pairs of indices into `positions`.
    pub wires: Vec<[u32; 2]>,
    /// How far a coordinate may be from its intended value, in model units; `None` to judge by the
    /// digits of the positions. See [`Mesh::coordinate_error`].
    pub coordinate_error: Option<f64>,
}

/// Properties that a run of faces shares: object or group, material, and color.
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash)]
pub struct MeshPart {
    /// Name of the object or group; empty when the file gives none.
    pub group: String,
    /// Name of the material; empty when the file gives none.
    pub material: String,
    /// Red, green and blue (sRGB) as given by the model file itself; `None` when it gives no color.
    pub color: Option<[u8; 3]>,
    /// The model that the part came from, counted from 0, when several share a scene.
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
            corner_normals: Vec::new(),
            wires: Vec::new(),
            coordinate_error: None,
        }
    }
}

impl PolygonSoup {
    /// The same with positions in the order in which faces, then segments, use them, and unused ones last.
    /// So the same model gives the same drawing in whatever format it comes. Nothing changes if an index
    /// is out of range. O(positions + corners).
    #[must_use]
    pub fn in_order_of_use(mut self) -> Self {
        let n = self.positions.len();
        let mut numbers = vec![u32::MAX; n];
        let mut order: Vec<u32> = Vec::with_capacity(n);
        for &index in self.corners.iter().chain(self.wires.as_flattened()) {
            let Some(number) = numbers.get_mut(index as usize) else { return self };
            if *number == u32::MAX {
                *number = order.len() as u32;
                order.push(index);
            }
        }
        if order.iter().zip(0..).all(|(index, k)| *index == k) {
            return self;
        }
        order.extend((0..n as u32).filter(|index| numbers[*index as usize] == u32::MAX));
        self.positions = order.iter().map(|index| self.positions[*index as usize]).collect();
        for index in self.corners.iter_mut().chain(self.wires.as_flattened_mut()) {
            *index = numbers[*index as usize];
        }
        self
    }

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

/// A polygon mesh: finite positions, no two of them equal, and faces of three corners or more.
///
/// Consecutive corners of a face differ. Nothing else is guaranteed: faces may be concave, bent, without
/// area, and wound either way, and an edge may have any number of faces.
///
/// A mesh may also hold *wires*, segments that border no face. They can be hidden but hide nothing.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    positions: Vec<DVec3>,
    corners: Vec<u32>,
    face_starts: Vec<u32>,
    face_parts: Vec<u32>,
    parts: Vec<MeshPart>,
    corner_normals: Vec<[f32; 3]>,
    wires: Vec<[u32; 2]>,
    coordinate_error: f64,
}

/// Meshes are equal if everything but their coordinate error is.
impl PartialEq for Mesh {
    fn eq(&self, other: &Self) -> bool {
        self.positions == other.positions
            && self.corners == other.corners
            && self.face_starts == other.face_starts
            && self.face_parts == other.face_parts
            && self.parts == other.parts
            && self.corner_normals == other.corner_normals
            && self.wires == other.wires
    }
}

/// What was merged or left out to make a mesh from a soup.
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
    /// Faces left out because an earlier face has the same border, in either winding.
    pub equal_faces: usize,
}

impl std::ops::AddAssign for Repairs {
    fn add_assign(&mut self, more: Self) {
        self.welded_vertices += more.welded_vertices;
        self.unused_vertices += more.unused_vertices;
        self.degenerate_faces += more.degenerate_faces;
        self.repeated_corners += more.repeated_corners;
        self.dropped_wires += more.dropped_wires;
        self.equal_faces += more.equal_faces;
    }
}

/// Why a [`PolygonSoup`] cannot become a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum MeshError {
    /// A face or wire uses a vertex with a coordinate that is infinite or not a number.
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
    /// A merge distance that is negative, infinite or not a number.
    #[error("the distance for merging vertices must be finite and 0 or more, not {distance}")]
    BadDistance {
        /// The distance as given, in model units.
        distance: f64,
    },
    /// More than 2³² − 1 vertices or corners.
    #[error("more than 4,294,967,294 vertices or face corners")]
    TooLarge,
}

impl Mesh {
    /// Merges equal positions, and removes repeated corners, faces left with fewer than three, and
    /// repeated or zero-length wires.
    ///
    /// Positions are equal if their coordinates are (−0 is 0). The first of them represents all,
    /// and vertices keep the order of their first appearance. Positions that nothing uses are left
    /// out; they need not be finite. O(vertices + corners).
    ///
    /// # Errors
    /// A coordinate in use that is not finite, an index out of range, or too many of either.
    pub fn new(soup: PolygonSoup) -> Result<(Self, Repairs), MeshError> {
        check(&soup)?;
        let n_vertices = soup.positions.len();
        let mut repairs = Repairs::default();
        let first_equal = first_equal_position(&soup.positions);
        let has_normals = soup.corner_normals.len() == soup.corners.len();
        let mut mesh = Self {
            positions: Vec::with_capacity(n_vertices),
            corners: Vec::with_capacity(soup.corners.len()),
            face_starts: Vec::with_capacity(soup.face_starts.len()),
            face_parts: Vec::with_capacity(soup.face_parts.len()),
            parts: soup.parts,
            corner_normals: Vec::new(),
            wires: Vec::with_capacity(soup.wires.len()),
            coordinate_error: 0.0,
        };
        mesh.face_starts.push(0);
        let mut used = vec![false; n_vertices];
        for (face, range) in soup.face_starts.windows(2).enumerate() {
            let start = mesh.corners.len();
            for corner in range[0] as usize..range[1] as usize {
                let vertex = first_equal[soup.corners[corner] as usize];
                if mesh.corners.len() > start && mesh.corners.last() == Some(&vertex) {
                    repairs.repeated_corners += 1;
                    continue;
                }
                mesh.corners.push(vertex);
                if has_normals {
                    mesh.corner_normals.push(soup.corner_normals[corner]);
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
                mesh.corner_normals.truncate(start);
                repairs.degenerate_faces += 1;
                continue;
            }
            mesh.corner_normals.truncate(mesh.corners.len());
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
            } else {
                repairs.welded_vertices += 1;
            }
        }
        for corner in mesh.corners.iter_mut().chain(mesh.wires.as_flattened_mut()) {
            *corner = renumbered[*corner as usize];
        }
        mesh.coordinate_error =
            soup.coordinate_error.unwrap_or_else(|| coordinate_error(&mesh.positions));
        Ok((mesh, repairs))
    }

    /// Merges vertices closer than `distance`, in model units, and says what changed.
    ///
    /// Chains count: two vertices are merged when steps shorter than `distance` lead from one to
    /// the other by way of other vertices. The first vertex of each group keeps its position, so a
    /// distance longer than the edges of a mesh makes it vanish. Zero changes nothing.
    /// Nearly O(v log v), even where vertices crowd together.
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
            corner_normals: self.corner_normals,
            wires: self.wires,
            coordinate_error: Some(self.coordinate_error),
        })
    }

    /// Leaves out each face with the same border as an earlier face, and reports how many there were.
    ///
    /// Borders are the same when they pass the same vertices in the same cyclic order, forward or
    /// backward: a wall exported from both sides, or a duplicated part. Two sides of one sheet
    /// then count as one face, so its rim is a boundary again. O(corners) expected.
    pub fn merge_equal_faces(self) -> (Self, Repairs) {
        let first_equal = first_equal_face(&self);
        let is_kept = |face: usize| first_equal[face] as usize == face;
        let equal_faces = (0..self.n_faces()).filter(|&face| !is_kept(face)).count();
        let repairs = Repairs { equal_faces, ..Repairs::default() };
        if equal_faces == 0 {
            return (self, repairs);
        }
        let mut mesh = Self {
            corners: Vec::with_capacity(self.corners.len()),
            face_starts: vec![0],
            face_parts: Vec::new(),
            corner_normals: Vec::new(),
            ..self
        };
        for (face, range) in self.face_starts.windows(2).enumerate() {
            if !is_kept(face) {
                continue;
            }
            let range = range[0] as usize..range[1] as usize;
            mesh.corners.extend_from_slice(&self.corners[range.clone()]);
            mesh.face_starts.push(mesh.corners.len() as u32);
            mesh.face_parts.extend(self.face_parts.get(face));
            mesh.corner_normals.extend(self.corner_normals.get(range).unwrap_or_default());
        }
        (mesh, repairs)
    }

    /// Vertex positions in model units.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Vertex indices of all faces, one face after another.
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

    /// Index into [`parts`](Self::parts) of each face; empty when the model has no parts.
    pub fn face_parts(&self) -> &[u32] {
        &self.face_parts
    }

    /// The groups, materials and colors of the model.
    pub fn parts(&self) -> &[MeshPart] {
        &self.parts
    }

    /// The unit normal at each corner, in the order of [`corners`](Self::corners); zero where the
    /// file gives none, and empty when it has no normals at all. Visibility never looks at these.
    pub fn corner_normals(&self) -> &[[f32; 3]] {
        &self.corner_normals
    }

    /// Segments of polylines that border no face, as pairs of vertex indices: they can be hidden and
    /// hide nothing. No two of them are the same, and none has equal ends.
    pub fn wires(&self) -> &[[u32; 2]] {
        &self.wires
    }

    /// How far a coordinate may be from its intended value, in model units.
    ///
    /// Judged by the digits of the positions: a few units in the last decimal place when they were
    /// written with few decimals, the spacing of single precision when all of them are singles.
    /// Angles between faces are uncertain by about this length over the height of the faces. No
    /// decision about visibility depends on it.
    pub fn coordinate_error(&self) -> f64 {
        self.coordinate_error
    }

    /// Smallest box around all vertices as (lowest, highest) corner; `None` without vertices.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let (first, rest) = self.positions.split_first()?;
        Some(rest.iter().fold((*first, *first), |(low, high), &p| (low.min(p), high.max(p))))
    }
}

/// Refuses indices without a vertex, and vertices in use that are not finite.
fn check(soup: &PolygonSoup) -> Result<(), MeshError> {
    let n_vertices = soup.positions.len();
    if n_vertices.max(soup.corners.len()).max(2 * soup.wires.len()) >= u32::MAX as usize {
        return Err(MeshError::TooLarge);
    }
    check_wires(&soup.wires, n_vertices)?;
    let is_whole = soup.positions.iter().all(|position| position.is_finite());
    let check_finite = |vertex: u32| {
        let vertex = vertex as usize;
        let is_sound = is_whole || soup.positions[vertex].is_finite();
        if is_sound { Ok(()) } else { Err(MeshError::NotFinite { vertex }) }
    };
    for (face, range) in soup.face_starts.windows(2).enumerate() {
        for &vertex in &soup.corners[range[0] as usize..range[1] as usize] {
            if vertex as usize >= n_vertices {
                return Err(MeshError::MissingVertex { face, vertex, n_vertices });
            }
            check_finite(vertex)?;
        }
    }
    soup.wires.as_flattened().iter().try_for_each(|&vertex| check_finite(vertex))
}

fn check_wires(wires: &[[u32; 2]], n_vertices: usize) -> Result<(), MeshError> {
    let ends = wires.iter().enumerate().flat_map(|(wire, ends)| ends.map(|vertex| (wire, vertex)));
    for (wire, vertex) in ends {
        if vertex as usize >= n_vertices {
            return Err(MeshError::MissingWireVertex { wire, vertex, n_vertices });
        }
    }
    Ok(())
}
