//! Which faces meet at which edges. No coordinates in here.
//!
//! An *edge* is an unordered pair of vertices. Its *uses* are the times a face's border runs along
//! it: a closed surface uses each edge twice, a border once, a fin three times. A use is named by
//! the corner it starts from, so one number tells the face, the place on its border and, compared
//! with [`Topology::edge`], the direction:
//!
//! ```text
//!     corner c      corner c + 1 (or the first corner of the face)
//!        ●─────use c────►●
//!       ╱    face of c    ╲
//! ```

use crate::mesh::Mesh;
use rayon::prelude::*;

/// Edges of a mesh with the faces along them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Topology {
    edges: Vec<[u32; 2]>,
    use_starts: Vec<u32>,
    uses: Vec<u32>,
    corner_edges: Vec<u32>,
    corner_faces: Vec<u32>,
}

/// Counts of what a mesh is made of, for summaries.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct EdgeCounts {
    /// Edges with one use.
    pub boundary: usize,
    /// Edges with three uses or more.
    pub nonmanifold: usize,
    /// Edges with two uses in the same direction: their faces are wound against each other.
    pub inconsistent: usize,
}

/// One use of an edge while the table is built: the higher vertex and the corner.
type Entry = (u32, u32);

impl Topology {
    /// Finds the edges of `mesh`, ordered by their lower vertex, then their higher one.
    ///
    /// The uses of an edge are in the order of their corners. O(corners), in parallel.
    pub fn new(mesh: &Mesh) -> Self {
        Self::of_faces(mesh.corners(), mesh.face_starts(), mesh.positions().len())
    }

    /// The same for bare triangles: their sides, each with the triangles along it.
    ///
    /// Corner `3 t + i` is the `i`-th of triangle `t`.
    pub fn of_triangles(triangles: &[[u32; 3]], n_vertices: usize) -> Self {
        let starts: Vec<u32> = (0..=triangles.len() as u32).map(|t| 3 * t).collect();
        Self::of_faces(triangles.as_flattened(), &starts, n_vertices)
    }

    fn of_faces(corners: &[u32], face_starts: &[u32], n_vertices: usize) -> Self {
        let n_parts = rayon::current_num_threads().max(1);
        let vertices_per_part = n_vertices.div_ceil(n_parts).max(1);

        // Each part owns a range of lower vertices and reads all corners: no part waits for
        // another, and the result does not depend on how many there are.
        let parts: Vec<Part> = (0..n_parts)
            .into_par_iter()
            .map(|part| {
                let first = (part * vertices_per_part).min(n_vertices) as u32;
                let last = ((part + 1) * vertices_per_part).min(n_vertices) as u32;
                Part::collect(corners, face_starts, first..last)
            })
            .collect();

        let mut topology = Self {
            edges: Vec::with_capacity(parts.iter().map(|p| p.edges.len()).sum()),
            use_starts: Vec::with_capacity(parts.iter().map(|p| p.edges.len()).sum::<usize>() + 1),
            uses: Vec::with_capacity(corners.len()),
            corner_edges: vec![0; corners.len()],
            corner_faces: vec![0; corners.len()],
        };
        topology.use_starts.push(0);
        for part in &parts {
            let before = topology.uses.len() as u32;
            topology.edges.extend_from_slice(&part.edges);
            topology.use_starts.extend(part.use_ends.iter().map(|end| before + end));
            topology.uses.extend_from_slice(&part.uses);
        }
        for edge in 0..topology.edges.len() {
            let range = topology.use_starts[edge] as usize..topology.use_starts[edge + 1] as usize;
            for &corner in &topology.uses[range] {
                topology.corner_edges[corner as usize] = edge as u32;
            }
        }
        for (face, range) in face_starts.windows(2).enumerate() {
            topology.corner_faces[range[0] as usize..range[1] as usize].fill(face as u32);
        }
        topology
    }

    /// The vertices of every edge, the lower one first.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// The vertices of one edge, the lower one first. Panics when there is no such edge.
    pub fn edge(&self, edge: u32) -> [u32; 2] {
        self.edges[edge as usize]
    }

    /// The edge between two vertices, if there is one. O(log edges).
    pub fn find_edge(&self, a: u32, b: u32) -> Option<u32> {
        self.edges.binary_search(&[a.min(b), a.max(b)]).ok().map(|edge| edge as u32)
    }

    /// The uses of one edge, each named by its corner. Panics when there is no such edge.
    pub fn uses(&self, edge: u32) -> &[u32] {
        let edge = edge as usize;
        &self.uses[self.use_starts[edge] as usize..self.use_starts[edge + 1] as usize]
    }

    /// The edge that leaves `corner` along its face's border.
    pub fn corner_edge(&self, corner: u32) -> u32 {
        self.corner_edges[corner as usize]
    }

    /// The face that `corner` belongs to.
    pub fn corner_face(&self, corner: u32) -> u32 {
        self.corner_faces[corner as usize]
    }

    /// Whether the use at `corner` runs from the lower vertex to the higher one.
    pub fn runs_upwards(&self, mesh: &Mesh, corner: u32) -> bool {
        mesh.corners()[corner as usize] == self.edge(self.corner_edge(corner))[0]
    }

    /// Counts what is not a closed, consistently wound surface.
    pub fn count_edges(&self, mesh: &Mesh) -> EdgeCounts {
        let mut counts = EdgeCounts::default();
        for edge in 0..self.edges.len() as u32 {
            match *self.uses(edge) {
                [_] => counts.boundary += 1,
                [a, b] if self.runs_upwards(mesh, a) == self.runs_upwards(mesh, b) => {
                    counts.inconsistent += 1;
                }
                [_, _] => {}
                _ => counts.nonmanifold += 1,
            }
        }
        counts
    }
}

/// The edges whose lower vertex lies in one range of vertices.
struct Part {
    edges: Vec<[u32; 2]>,
    use_ends: Vec<u32>,
    uses: Vec<u32>,
}

impl Part {
    fn collect(corners: &[u32], face_starts: &[u32], vertices: std::ops::Range<u32>) -> Self {
        let n_vertices = vertices.len();
        let mut starts = vec![0u32; n_vertices + 1];
        for_each_use(corners, face_starts, |low, _, _| {
            if vertices.contains(&low) {
                starts[(low - vertices.start) as usize + 1] += 1;
            }
        });
        for i in 0..n_vertices {
            starts[i + 1] += starts[i];
        }
        let mut entries: Vec<Entry> = vec![(0, 0); starts[n_vertices] as usize];
        let mut next = starts.clone();
        for_each_use(corners, face_starts, |low, high, corner| {
            if vertices.contains(&low) {
                let slot = &mut next[(low - vertices.start) as usize];
                entries[*slot as usize] = (high, corner);
                *slot += 1;
            }
        });
        let mut part = Self {
            edges: Vec::with_capacity(entries.len() / 2),
            use_ends: Vec::with_capacity(entries.len() / 2),
            uses: Vec::with_capacity(entries.len()),
        };
        for (low, range) in (vertices).zip(starts.windows(2)) {
            let bucket = &mut entries[range[0] as usize..range[1] as usize];
            bucket.sort_unstable();
            for &(high, corner) in bucket.iter() {
                if part.edges.last() != Some(&[low, high]) {
                    part.edges.push([low, high]);
                    part.use_ends.push(0);
                }
                part.uses.push(corner);
                if let Some(end) = part.use_ends.last_mut() {
                    *end = part.uses.len() as u32;
                }
            }
        }
        part
    }
}

/// Calls `f` with the lower vertex, the higher vertex and the corner of every use of an edge.
fn for_each_use(corners: &[u32], face_starts: &[u32], mut f: impl FnMut(u32, u32, u32)) {
    for range in face_starts.windows(2) {
        let (start, end) = (range[0] as usize, range[1] as usize);
        let mut from = corners[end - 1];
        let mut corner = end - 1;
        for (i, &to) in corners[start..end].iter().enumerate() {
            f(from.min(to), from.max(to), corner as u32);
            from = to;
            corner = start + i;
        }
    }
}
