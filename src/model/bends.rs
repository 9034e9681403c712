//! Where bent faces are folded.
//!
//! A face whose corners do not lie in one plane has the shape of its triangles: it is folded along the
//! diagonals that cut it. If one of the triangles beside a diagonal faces the eye and the other does not, the
//! silhouette of the model runs along it, although it is not an edge.
//!
//! ```text
//!    ●───────────●
//!    │ front ╱   │      drawn from where the two triangles face different ways
//!    │    ╱ back │
//!    ●───────────●
//! ```

use rayon::prelude::*;

use crate::model::mesh::Mesh;
use crate::model::topology::Topology;
use crate::predicates::{Sign, Solid};

/// A diagonal along which a bent face is folded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bend {
    /// Its vertices, the lower one first.
    pub ends: [u32; 2],
    /// The triangles on both sides, which are parts of one face.
    pub triangles: [u32; 2],
}

/// The bends of all faces, face by face. A diagonal that is also an edge of the mesh is not a bend. Exact;
/// O(corners log corners of a face), in parallel.
pub(crate) fn bends(
    mesh: &Mesh,
    topology: &Topology,
    triangles: &[[u32; 3]],
    triangle_faces: &[u32],
) -> Vec<Bend> {
    if triangles.len() == mesh.n_faces() {
        return Vec::new();
    }
    let solid = Solid::new(mesh.positions());
    let is_bent = |[a, b]: [u32; 2]| {
        let (corners, other) = (triangles[a as usize], triangles[b as usize]);
        let apex = other.into_iter().find(|vertex| !corners.contains(vertex));
        apex.is_some_and(|apex| solid.side_of(corners, apex) != Sign::Zero)
    };
    let mut first = 0;
    let groups: Vec<(u32, u32)> = triangle_faces
        .chunk_by(|a, b| a == b)
        .map(|group| {
            let begin = first;
            first += group.len() as u32;
            (begin, first)
        })
        .filter(|(begin, end)| end - begin > 1)
        .collect();
    groups
        .into_par_iter()
        .with_min_len(1 << 10)
        .flat_map_iter(|(begin, end)| {
            let mut sides: Vec<([u32; 2], u32)> = (begin..end)
                .flat_map(|triangle| {
                    let [p, q, r] = triangles[triangle as usize];
                    [[p, q], [q, r], [r, p]].map(|[a, b]| ([a.min(b), a.max(b)], triangle))
                })
                .collect();
            sides.sort_unstable();
            let twice = sides.chunk_by(|a, b| a.0 == b.0).filter_map(|same| match *same {
                [(ends, a), (_, b)] => Some(Bend { ends, triangles: [a, b] }),
                _ => None,
            });
            let is_bend = |bend: &Bend| {
                is_bent(bend.triangles) && topology.find_edge(bend.ends[0], bend.ends[1]).is_none()
            };
            twice.filter(is_bend).collect::<Vec<_>>()
        })
        .collect()
}
