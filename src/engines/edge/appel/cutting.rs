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
//! Edge-on triangles cover nothing and are not counted.

use crate::classify::ViewedScene;
use crate::model::topology::Topology;
use crate::predicates::Sign;
use rayon::prelude::*;
use std::borrow::Cow;

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

/// The sides of all triangles with the triangles along each.
#[derive(Debug)]
pub(in super::super) struct Sides<'a> {
    table: Cow<'a, Topology>,
    /// The faces are the triangles, so that sides have the numbers of edges.
    sides_are_edges: bool,
}

impl<'a> Sides<'a> {
    /// The sides of the triangles of a scene. O(triangles) when faces have more than three corners.
    pub(in super::super) fn new(view: &ViewedScene<'a>) -> Self {
        let scene = view.scene();
        let triangles = scene.triangles();
        // A face of n corners makes n − 2 triangles: as many as faces means that they are the same.
        let sides_are_edges = triangles.len() == scene.mesh().n_faces();
        let table = if sides_are_edges {
            Cow::Borrowed(scene.topology())
        } else {
            let n_vertices = scene.mesh().positions().len();
            Cow::Owned(Topology::of_triangles(triangles, n_vertices))
        };
        Self { table, sides_are_edges }
    }

    /// Whether every side has an even number of triangles, so that they enclose whatever they do.
    pub(super) fn are_closed(&self) -> bool {
        let n_sides = self.table.edges().len() as u32;
        (0..n_sides)
            .into_par_iter()
            .with_min_len(4096)
            .all(|side| self.table.uses(side).len().is_multiple_of(2))
    }

    /// The triangles along an edge, each with whether it runs along it upwards.
    pub(in super::super) fn along_edge(
        &self,
        view: &ViewedScene,
        edge: u32,
    ) -> impl Iterator<Item = (u32, bool)> {
        self.side(view, edge).into_iter().flat_map(|side| self.along(side))
    }

    /// The side that is an edge; some edges of faces without area are none.
    fn side(&self, view: &ViewedScene, edge: u32) -> Option<u32> {
        if self.sides_are_edges {
            return Some(edge);
        }
        let [p, q] = view.line(edge);
        self.table.find_edge(p, q)
    }

    fn along(&self, side: u32) -> impl Iterator<Item = (u32, bool)> {
        self.table.uses(side).iter().map(|along| (along.face(), along.runs_upwards()))
    }

    /// How many of the triangles that count lie on the left and on the right of a side, and one of
    /// them.
    fn count(&self, view: &ViewedScene, side: u32) -> ([i32; 2], Option<u32>) {
        let (mut counts, mut last) = ([0; 2], None);
        for (triangle, upwards) in self.along(side) {
            if is_counted(view, triangle) {
                let turn = view.triangle_turns()[triangle as usize];
                counts[usize::from((turn == Sign::Positive) != upwards)] += 1;
                last = Some(triangle);
            }
        }
        (counts, last)
    }

    /// Whether an edge has exactly one triangle that counts on each side.
    pub(super) fn is_even(&self, view: &ViewedScene, edge: u32) -> bool {
        let side = self.side(view, edge);
        side.is_some_and(|side| self.count(view, side).0 == [1; 2])
    }

    /// The sides at which the number of layers changes, in their order, and for each vertex whether
    /// all its sides are even: with one triangle left and right, or none at all.
    ///
    /// O(triangles), in parallel.
    pub(super) fn cutting_edges(&self, view: &ViewedScene) -> (Vec<CuttingEdge>, Vec<bool>) {
        let uneven: Vec<CuttingEdge> = (0..self.table.edges().len() as u32)
            .into_par_iter()
            .with_min_len(4096)
            .filter_map(|side| {
                let ([left, right], last) = self.count(view, side);
                let triangle = last.filter(|_| [left, right] != [1; 2])?;
                Some(CuttingEdge { ends: self.table.edge(side), step: left - right, triangle })
            })
            .collect();
        let mut is_even = vec![true; view.scene().mesh().positions().len()];
        for end in uneven.iter().flat_map(|edge| edge.ends) {
            is_even[end as usize] = false;
        }
        (uneven.into_iter().filter(|edge| edge.step != 0).collect(), is_even)
    }
}

/// Whether a triangle covers anything and is wholly beyond the near plane.
///
/// Triangles that the near plane cuts do not enter the carried `qi`; they are tested one by one.
#[inline]
pub(super) fn is_counted(view: &ViewedScene, triangle: u32) -> bool {
    if view.triangle_turns()[triangle as usize] == Sign::Zero {
        return false;
    }
    let is_kept = |&corner: &u32| view.sight().near_distance(corner).1 != Sign::Negative;
    !view.near_plane_cuts() || view.scene().triangles()[triangle as usize].iter().all(is_kept)
}

/// The triangles around vertices, of those that count.
#[derive(Debug)]
pub(super) struct Stars {
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Stars {
    /// The triangles around each vertex that is `wanted`. O(triangles).
    pub(super) fn new(view: &ViewedScene, wanted: &[bool]) -> Self {
        let triangles = view.scene().triangles();
        let counted: Vec<bool> = (0..triangles.len() as u32)
            .into_par_iter()
            .map(|triangle| is_counted(view, triangle))
            .collect();
        let mut starts = vec![0u32; wanted.len() + 1];
        for (corners, _) in triangles.iter().zip(&counted).filter(|(_, counted)| **counted) {
            for &corner in corners {
                starts[corner as usize + 1] += u32::from(wanted[corner as usize]);
            }
        }
        for vertex in 0..wanted.len() {
            starts[vertex + 1] += starts[vertex];
        }
        let mut around = vec![0; starts.last().map_or(0, |&n| n as usize)];
        let mut next = starts.clone();
        for (triangle, corners) in triangles.iter().enumerate().filter(|(i, _)| counted[*i]) {
            for &corner in corners.iter().filter(|&&corner| wanted[corner as usize]) {
                let slot = &mut next[corner as usize];
                around[*slot as usize] = triangle as u32;
                *slot += 1;
            }
        }
        Self { starts, triangles: around }
    }

    /// The triangles around one vertex.
    pub(super) fn around(&self, vertex: u32) -> &[u32] {
        let vertex = vertex as usize;
        &self.triangles[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }
}
