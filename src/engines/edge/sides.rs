//! The sides of all triangles, each with the triangles along it.

use super::occluders::Occluders;
use crate::classify::ViewedScene;
use crate::model::topology::Topology;
use crate::predicates::Sign;
use rayon::prelude::*;
use std::borrow::Cow;

/// The sides of all triangles with the triangles along each.
#[derive(Debug)]
pub(super) struct Sides<'a> {
    table: Cow<'a, Topology>,
    /// The faces are the triangles, so that sides have the numbers of edges.
    sides_are_edges: bool,
}

impl<'a> Sides<'a> {
    /// The sides of the triangles of a scene. O(triangles) when faces have more than three corners.
    pub(super) fn new(view: &ViewedScene<'a>) -> Self {
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

    /// Number of sides.
    pub(super) fn len(&self) -> usize {
        self.table.edges().len()
    }

    /// The vertices of a side, the lower one first.
    pub(super) fn ends(&self, side: u32) -> [u32; 2] {
        self.table.edge(side)
    }

    /// The side between two vertices.
    pub(super) fn find(&self, p: u32, q: u32) -> Option<u32> {
        self.table.find_edge(p, q)
    }

    /// Whether every side has an even number of triangles, so that they enclose whatever they do.
    pub(super) fn are_closed(&self) -> bool {
        let n_sides = self.table.edges().len() as u32;
        (0..n_sides)
            .into_par_iter()
            .with_min_len(4096)
            .all(|side| self.table.uses(side).len().is_multiple_of(2))
    }

    /// The triangles along an edge, each with whether it runs along it upward.
    pub(super) fn along_edge(
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

    /// The triangles along a side, each with whether it runs along it upward.
    pub(super) fn along(&self, side: u32) -> impl Iterator<Item = (u32, bool)> {
        self.table.uses(side).iter().map(|along| (along.face(), along.runs_upwards()))
    }

    /// How many of the occluders lie on the left and on the right of a side, and one of them.
    pub(super) fn count(
        &self,
        view: &ViewedScene,
        occluders: &Occluders,
        side: u32,
    ) -> ([i32; 2], Option<u32>) {
        let (mut counts, mut last) = ([0; 2], None);
        for (triangle, upwards) in self.along(side) {
            if occluders.contains(triangle) {
                let turn = view.triangle_turns()[triangle as usize];
                counts[usize::from((turn == Sign::Positive) != upwards)] += 1;
                last = Some(triangle);
            }
        }
        (counts, last)
    }

    /// Whether an edge has exactly one occluder on each side.
    pub(super) fn is_even(&self, view: &ViewedScene, occluders: &Occluders, edge: u32) -> bool {
        let side = self.side(view, edge);
        side.is_some_and(|side| self.count(view, occluders, side).0 == [1; 2])
    }
}
