//! Which sides of triangles are not edges but diagonals of their faces.
//!
//! Triangles that share an edge do not cross there. But where an edge of one face joins the same
//! vertices as a diagonal of another, the faces may cross, however they are triangulated.

use crate::model::mesh::Mesh;
use rayon::prelude::*;

/// Diagonals of all faces with more than three corners.
#[derive(Debug)]
pub(super) struct Diagonals<'a> {
    faces: &'a [u32],
    /// A bit for each side, in the order of the corners it begins with; empty when all faces are
    /// triangles.
    sides: Vec<u8>,
}

impl<'a> Diagonals<'a> {
    /// Finds the sides that two triangles of a face share and that are not edges of it.
    /// O(corners log corners of a face), in parallel.
    pub(super) fn new(mesh: &Mesh, triangles: &[[u32; 3]], faces: &'a [u32]) -> Self {
        if triangles.len() == mesh.n_faces() {
            return Self { faces, sides: Vec::new() };
        }
        let groups: Vec<&[u32]> = faces.chunk_by(|a, b| a == b).collect();
        let mut starts = Vec::with_capacity(groups.len());
        let mut start = 0;
        for group in &groups {
            starts.push(start);
            start += group.len();
        }
        let of_faces: Vec<Vec<u8>> = groups
            .par_iter()
            .with_min_len(1 << 10)
            .zip(&starts)
            .map(|(group, &start)| {
                let border = mesh.face(group[0]);
                in_common(border, &triangles[start..start + group.len()])
            })
            .collect();
        Self { faces, sides: of_faces.concat() }
    }

    /// Whether there are no diagonals.
    pub(super) fn is_empty(&self) -> bool {
        self.sides.is_empty()
    }

    /// The face that a triangle is part of.
    pub(super) fn face(&self, triangle: u32) -> u32 {
        self.faces[triangle as usize]
    }

    /// Whether a side, the lower vertex first, is a diagonal of the triangle's face.
    pub(super) fn has(&self, triangle: u32, corners: [u32; 3], side: [u32; 2]) -> bool {
        let Some(&sides) = self.sides.get(triangle as usize) else { return false };
        (0..3).any(|i| sides >> i & 1 == 1 && side_of(corners, i) == side)
    }
}

fn side_of(corners: [u32; 3], i: usize) -> [u32; 2] {
    let (a, b) = (corners[i], corners[(i + 1) % 3]);
    [a.min(b), a.max(b)]
}

/// For each triangle of a face a bit for each side that another of them has too.
///
/// The border of a keyhole runs twice along its bridge, which is an edge and no diagonal.
fn in_common(border: &[u32], triangles: &[[u32; 3]]) -> Vec<u8> {
    let mut common = vec![0; triangles.len()];
    if triangles.len() < 2 {
        return common;
    }
    let mut sides: Vec<([u32; 2], usize, usize)> = (0..triangles.len())
        .flat_map(|t| (0..3).map(move |i| (side_of(triangles[t], i), t, i)))
        .collect();
    sides.sort_unstable();
    let twice = || sides.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1);
    let mut edges: Vec<[u32; 2]> = Vec::new();
    if twice().count() >= triangles.len() {
        let next = border.iter().cycle().skip(1);
        edges = border.iter().zip(next).map(|(&a, &b)| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
    }
    for same in twice().filter(|same| edges.binary_search(&same[0].0).is_err()) {
        for &(_, t, i) in same {
            common[t] |= 1 << i;
        }
    }
    common
}
