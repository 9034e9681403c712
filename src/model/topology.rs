//! Which faces meet at which edges. No coordinates in here.
//!
//! An *edge* is an unordered pair of vertices. Its *uses* are the times a face's border runs along
//! it: a closed surface uses each edge twice, a border once, a fin three times.
//!
//! ```text
//!     lower vertex      higher vertex
//!          ●───────────────►●        a use that runs upwards, by the face above;
//!          ●◄───────────────●        consistent winding makes the other run downwards
//! ```

use crate::model::mesh::Mesh;
use rayon::prelude::*;

/// Edges of a mesh with the faces along them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Topology {
    edges: Vec<[u32; 2]>,
    use_starts: Vec<u32>,
    uses: Vec<EdgeUse>,
}

/// One time that a face's border runs along an edge.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct EdgeUse {
    /// The face, and in the lowest bit whether the border runs upwards.
    packed: u32,
}

impl EdgeUse {
    fn new(face: usize, upwards: bool) -> Self {
        Self { packed: (face as u32) << 1 | u32::from(upwards) }
    }

    /// The face.
    pub fn face(self) -> u32 {
        self.packed >> 1
    }

    /// Whether the face's border runs from the edge's lower vertex to its higher one.
    pub fn runs_upwards(self) -> bool {
        self.packed & 1 == 1
    }
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

/// One use of an edge while the table is built, with the higher vertex.
type Entry = (u32, EdgeUse);

impl Topology {
    /// Finds the edges of `mesh`, ordered by their lower vertex, then their higher one.
    ///
    /// The uses of an edge are in the order of their faces. O(corners), in parallel.
    pub fn new(mesh: &Mesh) -> Self {
        Self::of_faces(mesh.corners(), mesh.face_starts(), mesh.positions().len())
    }

    /// The same for bare triangles: their sides, each with the triangles along it as faces.
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

        let n_edges = parts.iter().map(|part| part.edges.len()).sum();
        let mut topology = Self {
            edges: Vec::with_capacity(n_edges),
            use_starts: Vec::with_capacity(n_edges + 1),
            uses: Vec::with_capacity(corners.len()),
        };
        topology.use_starts.push(0);
        for part in &parts {
            let before = topology.uses.len() as u32;
            topology.edges.extend_from_slice(&part.edges);
            topology.use_starts.extend(part.use_ends.iter().map(|end| before + end));
            topology.uses.extend_from_slice(&part.uses);
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

    /// The uses of one edge. Panics when there is no such edge.
    pub fn uses(&self, edge: u32) -> &[EdgeUse] {
        let edge = edge as usize;
        &self.uses[self.use_starts[edge] as usize..self.use_starts[edge + 1] as usize]
    }

    /// Counts what is not a closed, consistently wound surface.
    pub fn count_edges(&self) -> EdgeCounts {
        let mut counts = EdgeCounts::default();
        for edge in 0..self.edges.len() as u32 {
            match *self.uses(edge) {
                [_] => counts.boundary += 1,
                [a, b] if a.runs_upwards() == b.runs_upwards() => {
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
    uses: Vec<EdgeUse>,
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
        let mut entries: Vec<Entry> = vec![Entry::default(); starts[n_vertices] as usize];
        let mut next = starts.clone();
        for_each_use(corners, face_starts, |low, high, edge_use| {
            if vertices.contains(&low) {
                let slot = &mut next[(low - vertices.start) as usize];
                entries[*slot as usize] = (high, edge_use);
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
            for &(high, edge_use) in bucket.iter() {
                if part.edges.last() != Some(&[low, high]) {
                    part.edges.push([low, high]);
                    part.use_ends.push(0);
                }
                part.uses.push(edge_use);
                if let Some(end) = part.use_ends.last_mut() {
                    *end = part.uses.len() as u32;
                }
            }
        }
        part
    }
}

/// Calls `f` with the lower vertex and the higher vertex of every use of an edge, and the use.
fn for_each_use(corners: &[u32], face_starts: &[u32], mut f: impl FnMut(u32, u32, EdgeUse)) {
    for (face, range) in face_starts.windows(2).enumerate() {
        let border = &corners[range[0] as usize..range[1] as usize];
        let Some(&last) = border.last() else { continue };
        let mut from = last;
        for &to in border {
            f(from.min(to), from.max(to), EdgeUse::new(face, from < to));
            from = to;
        }
    }
}
