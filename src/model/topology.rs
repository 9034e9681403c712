//! Which faces meet at which edges, without coordinates.
//!
//! An *edge* is an unordered pair of vertices. Its *uses* are the times a face's border runs along
//! it: a closed surface uses each edge twice, a border once, a fin three times.
//!
//! ```text
//!     lower vertex      higher vertex
//!          ●───────────────►●        a use that runs upward, by the face above;
//!          ●◄───────────────●        consistent winding makes the other run downward
//! ```

use crate::model::mesh::Mesh;
use rayon::prelude::*;

/// Edges of a mesh with the faces along them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Topology {
    edges: Vec<[u32; 2]>,
    /// The uses of each edge, when there are one or two: the second is [`EdgeUse::NONE`] when there is
    /// one. Otherwise [`EdgeUse::MANY`] stands second, after a number in `many_starts`.
    pairs: Vec<[EdgeUse; 2]>,
    /// Where the uses of each edge that has three or more begin in `many`, and where the last end.
    many_starts: Vec<u32>,
    many: Vec<EdgeUse>,
    /// For each vertex the first edge of which it is the lower one; then the number of edges.
    first_edges: Vec<u32>,
}

/// One time that a face's border runs along an edge.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct EdgeUse {
    /// The face, and in the lowest bit whether the border runs upward.
    packed: u32,
}

impl EdgeUse {
    /// No use. A mesh has fewer than 2³² / 3 faces, so no face has this number.
    const NONE: Self = Self { packed: u32::MAX };
    /// Three uses or more; no face has this number either.
    const MANY: Self = Self { packed: u32::MAX - 1 };

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

impl Topology {
    /// Finds the edges of `mesh`, ordered by their lower vertex, then their higher one.
    ///
    /// The uses of an edge are in the order of their faces. O(corners), in parallel.
    pub fn new(mesh: &Mesh) -> Self {
        Self::of_faces(mesh.corners(), Faces::of(mesh), mesh.positions().len())
    }

    /// The same for bare triangles: their sides, each with the triangles along it as faces.
    pub fn of_triangles(triangles: &[[u32; 3]], n_vertices: usize) -> Self {
        Self::of_faces(triangles.as_flattened(), Faces::Triangles, n_vertices)
    }

    fn of_faces(corners: &[u32], faces: Faces, n_vertices: usize) -> Self {
        let n_parts = rayon::current_num_threads().max(1);
        let vertices_per_part = n_vertices.div_ceil(n_parts).max(1);

        // Each part owns a range of lower vertices and reads all corners: no part waits for
        // another, and the result does not depend on how many there are.
        let parts: Vec<Part> = (0..n_parts)
            .into_par_iter()
            .map(|part| {
                let first = (part * vertices_per_part).min(n_vertices) as u32;
                let last = ((part + 1) * vertices_per_part).min(n_vertices) as u32;
                Part::collect(corners, faces, first..last)
            })
            .collect();

        let n_edges = parts.iter().map(|part| part.edges.len()).sum();
        let mut topology = Self {
            edges: vec![[0; 2]; n_edges],
            pairs: vec![[EdgeUse::default(); 2]; n_edges],
            many_starts: vec![0],
            many: Vec::new(),
            first_edges: vec![0; n_vertices + 1],
        };
        let (mut edges, mut pairs) = (&mut topology.edges[..], &mut topology.pairs[..]);
        let mut firsts = &mut topology.first_edges[..n_vertices];
        let (mut runs, mut n_before) = (Vec::with_capacity(n_parts), 0);
        for part in &parts {
            let (edge_run, pair_run, first_run);
            (edge_run, edges) = edges.split_at_mut(part.edges.len());
            (pair_run, pairs) = pairs.split_at_mut(part.edges.len());
            (first_run, firsts) = firsts.split_at_mut(part.first_edges.len());
            let n_many = topology.many_starts.len() as u32 - 1;
            runs.push((part, edge_run, pair_run, first_run, n_before, n_many));
            n_before += part.edges.len() as u32;
            let n_uses = topology.many.len() as u32;
            topology.many_starts.extend(part.many_ends.iter().map(|end| n_uses + end));
            topology.many.extend_from_slice(&part.many);
        }
        runs.into_par_iter().for_each(|(part, edges, pairs, firsts, n_before, n_many)| {
            edges.copy_from_slice(&part.edges);
            for (pair, own) in pairs.iter_mut().zip(&part.pairs) {
                *pair = match *own {
                    [number, EdgeUse::MANY] => {
                        [EdgeUse { packed: n_many + number.packed }, EdgeUse::MANY]
                    }
                    pair => pair,
                };
            }
            for (first, own) in firsts.iter_mut().zip(&part.first_edges) {
                *first = n_before + own;
            }
        });
        topology.first_edges[n_vertices] = n_edges as u32;
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

    /// The edge between two vertices, if there is one. O(log edges at the lower one).
    pub fn find_edge(&self, a: u32, b: u32) -> Option<u32> {
        let (low, high) = (a.min(b) as usize, a.max(b));
        let &[first, last] = self.first_edges.get(low..low + 2)? else { return None };
        let edges = &self.edges[first as usize..last as usize];
        edges.binary_search_by_key(&high, |edge| edge[1]).ok().map(|i| first + i as u32)
    }

    /// The uses of one edge. Panics when there is no such edge.
    #[inline]
    pub fn uses(&self, edge: u32) -> &[EdgeUse] {
        match &self.pairs[edge as usize] {
            [number, EdgeUse::MANY] => {
                let number = number.packed as usize;
                let [start, end] = [self.many_starts[number], self.many_starts[number + 1]];
                &self.many[start as usize..end as usize]
            }
            pair @ [_, EdgeUse::NONE] => &pair[..1],
            pair => pair,
        }
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

/// How corners are divided into faces.
#[derive(Clone, Copy)]
enum Faces<'f> {
    /// Three to each.
    Triangles,
    /// Where each begins, and where the last ends.
    Starts(&'f [u32]),
}

impl<'f> Faces<'f> {
    fn of(mesh: &'f Mesh) -> Self {
        let are_triangles = mesh.corners().len() == 3 * mesh.n_faces()
            && mesh.face_starts().par_iter().enumerate().all(|(i, &at)| at as usize == 3 * i);
        if are_triangles { Self::Triangles } else { Self::Starts(mesh.face_starts()) }
    }

    /// Calls `f` with the lower vertex and the higher vertex of every use of an edge, and the use.
    #[inline]
    fn for_each_use(self, corners: &[u32], mut f: impl FnMut(u32, u32, EdgeUse)) {
        let mut add = |face, from: u32, to: u32| {
            f(from.min(to), from.max(to), EdgeUse::new(face, from < to));
        };
        match self {
            Self::Triangles => {
                let (triangles, _) = corners.as_chunks::<3>();
                for (face, &[p, q, r]) in triangles.iter().enumerate() {
                    add(face, r, p);
                    add(face, p, q);
                    add(face, q, r);
                }
            }
            Self::Starts(starts) => {
                for (face, range) in starts.windows(2).enumerate() {
                    let border = &corners[range[0] as usize..range[1] as usize];
                    let Some(&last) = border.last() else { continue };
                    let mut from = last;
                    for &to in border {
                        add(face, from, to);
                        from = to;
                    }
                }
            }
        }
    }
}

/// The edges whose lower vertex lies in one range of vertices; numbers begin with the range.
struct Part {
    edges: Vec<[u32; 2]>,
    pairs: Vec<[EdgeUse; 2]>,
    many_ends: Vec<u32>,
    many: Vec<EdgeUse>,
    first_edges: Vec<u32>,
}

impl Part {
    fn collect(corners: &[u32], faces: Faces, vertices: std::ops::Range<u32>) -> Self {
        let n_vertices = vertices.len();
        let mut starts = vec![0u32; n_vertices + 1];
        faces.for_each_use(corners, |low, _, _| {
            if vertices.contains(&low) {
                starts[(low - vertices.start) as usize + 1] += 1;
            }
        });
        for i in 0..n_vertices {
            starts[i + 1] += starts[i];
        }
        // One use of an edge each: the higher vertex in the upper half.
        let mut entries = vec![0u64; starts[n_vertices] as usize];
        // The start of each vertex moves to where the next one starts.
        faces.for_each_use(corners, |low, high, edge_use| {
            if vertices.contains(&low) {
                let slot = &mut starts[(low - vertices.start) as usize];
                entries[*slot as usize] = u64::from(high) << 32 | u64::from(edge_use.packed);
                *slot += 1;
            }
        });
        let mut part = Self {
            edges: Vec::with_capacity(entries.len() / 2 + 16),
            pairs: Vec::with_capacity(entries.len() / 2 + 16),
            many_ends: Vec::new(),
            many: Vec::new(),
            first_edges: Vec::with_capacity(n_vertices),
        };
        let mut start = 0;
        for (low, &end) in vertices.zip(&starts) {
            part.first_edges.push(part.edges.len() as u32);
            let bucket = &mut entries[start as usize..end as usize];
            start = end;
            sort(bucket);
            for uses in bucket.chunk_by(|a, b| a >> 32 == b >> 32) {
                part.push(low, uses);
            }
        }
        part
    }

    /// Adds the edge from `low` that these entries are uses of.
    fn push(&mut self, low: u32, entries: &[u64]) {
        let edge_use = |entry: u64| EdgeUse { packed: entry as u32 };
        let pair = match *entries {
            [one] => [edge_use(one), EdgeUse::NONE],
            [one, other] => [edge_use(one), edge_use(other)],
            _ => {
                self.many.extend(entries.iter().map(|&entry| edge_use(entry)));
                self.many_ends.push(self.many.len() as u32);
                [EdgeUse { packed: self.many_ends.len() as u32 - 1 }, EdgeUse::MANY]
            }
        };
        self.edges.push([low, (entries[0] >> 32) as u32]);
        self.pairs.push(pair);
    }
}

/// Sorts a few numbers by insertion, many as usual.
fn sort(numbers: &mut [u64]) {
    const FEW: usize = 24;
    if numbers.len() > FEW {
        numbers.sort_unstable();
        return;
    }
    for i in 1..numbers.len() {
        let number = numbers[i];
        let mut at = i;
        while at > 0 && numbers[at - 1] > number {
            numbers[at] = numbers[at - 1];
            at -= 1;
        }
        numbers[at] = number;
    }
}
