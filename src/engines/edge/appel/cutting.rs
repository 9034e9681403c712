//! Cutting edges: sides of triangles at which the number of layers changes.
//!
//! Seen along a side from its lower vertex to its higher one, each triangle with this side is to the left
//! or to the right of its image, as its third vertex is. If as many are left as right, nothing changes for
//! what is behind; otherwise the side is a *cutting edge*:
//!
//! ```text
//!    left 1   right 1            left 2   right 0            left 1   right 0
//!      ╲   q   ╱                      q                           q
//!       ╲  │  ╱                  ╱╱╱──│                      ╱╱╱──│
//!        ╲ │ ╱                        │                           │
//!          p      no cut              p     a silhouette          p    a boundary
//! ```
//!
//! Neither normals nor winding matter, so open, non-manifold and badly wound meshes need no special cases.
//! Only triangles that hide something count.

use super::super::occluders::Occluders;
use super::super::sides::Sides;
use crate::classify::ViewedScene;
use crate::groups::Groups;
use rayon::prelude::*;

/// A side of triangles with more of them on one side of its image than on the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct CuttingEdge {
    /// Its vertices, the lower number first.
    pub ends: [u32; 2],
    /// Triangles on its left less those on its right.
    pub step: i32,
    /// One of the triangles.
    pub triangle: u32,
}

/// The sides at which the number of layers changes, in their order, and for each vertex whether all
/// its sides are even: with one triangle left and right, or none at all.
///
/// O(sides), in parallel.
pub(super) fn cutting_edges(
    view: &ViewedScene,
    sides: &Sides,
    occluders: &Occluders,
) -> (Vec<CuttingEdge>, Vec<bool>) {
    let uneven = |side: u32| {
        let ([left, right], last) = sides.count(view, occluders, side);
        let triangle = last.filter(|_| [left, right] != [1; 2])?;
        Some(CuttingEdge { ends: sides.ends(side), step: left - right, triangle })
    };
    let n_sides = sides.len() as u32;
    let uneven: Vec<CuttingEdge> = match view.uneven_edges() {
        // Sides are edges then, and all triangles that face the eye or face away are occluders.
        Some(edges) if !occluders.are_culled() && !view.near_plane_cuts() => {
            edges.par_iter().with_min_len(4096).filter_map(|&edge| uneven(edge)).collect()
        }
        _ => (0..n_sides).into_par_iter().with_min_len(4096).filter_map(uneven).collect(),
    };
    let mut is_even = vec![true; view.scene().mesh().positions().len()];
    for end in uneven.iter().flat_map(|edge| edge.ends) {
        is_even[end as usize] = false;
    }
    (uneven.into_iter().filter(|edge| edge.step != 0).collect(), is_even)
}

/// The triangles around vertices, of those that hide something.
#[derive(Debug)]
pub(super) struct Stars(Groups);

impl Stars {
    /// The occluders around each vertex that is `wanted`. O(vertices + occluders).
    pub(super) fn new(view: &ViewedScene, occluders: &Occluders, wanted: &[bool]) -> Self {
        let triangles = view.scene().triangles();
        Self(Groups::new(wanted.len(), |sorter| {
            for &triangle in occluders.list() {
                let corners = triangles[triangle as usize];
                for corner in corners.into_iter().filter(|&corner| wanted[corner as usize]) {
                    sorter.put(corner as usize, triangle);
                }
            }
        }))
    }

    /// The triangles around one vertex.
    pub(super) fn around(&self, vertex: u32) -> &[u32] {
        self.0.of(vertex as usize)
    }
}
