//! Bodies: connected closed surfaces, wound outward, that do not meet themselves.
//!
//! Each side of a body's triangles is a side of exactly two of them, which run along it in opposite
//! directions, and the triangles meet nowhere else. By the Jordan–Brouwer theorem such a surface has
//! an inside and an outside, and a line of sight that starts outside enters through a front face
//! before it leaves through a back face. This is what L. G. Roberts' first step rests on ("Machine
//! perception of three-dimensional solids", 1963), and no more: bodies may cross, touch and contain
//! each other, since each is judged by itself.

use crate::disjoint_sets::DisjointSets;
use crate::model::mesh::Mesh;
use crate::model::topology::Topology;
use crate::predicates::Solid;
use rayon::prelude::*;

/// No surface.
const NONE: u32 = u32::MAX;

/// The connected closed surfaces of a scene, while it is not known yet which are bodies.
#[derive(Debug)]
pub(super) struct Surfaces {
    /// For each triangle the lowest triangle of its surface; [`NONE`] when that is not
    /// closed.
    surface_of: Vec<u32>,
}

impl Surfaces {
    /// Finds the surfaces along the sides of triangles. O(triangles).
    pub(super) fn new(mesh: &Mesh, triangles: &[[u32; 3]], topology: &Topology) -> Self {
        let of_triangles;
        let sides = if triangles.len() == mesh.n_faces() {
            topology
        } else {
            of_triangles = Topology::of_triangles(triangles, mesh.positions().len());
            &of_triangles
        };
        let mut surfaces = DisjointSets::new(triangles.len());
        let mut open = Vec::new();
        for side in 0..sides.edges().len() as u32 {
            let uses = sides.uses(side);
            let [a, b] = *uses else {
                open.extend(uses.iter().map(|used| used.face()));
                continue;
            };
            if a.runs_upwards() == b.runs_upwards() {
                open.extend([a.face(), b.face()]);
                continue;
            }
            surfaces.unite(a.face(), b.face());
        }
        let mut is_open = vec![false; triangles.len()];
        for triangle in open {
            is_open[surfaces.of(triangle) as usize] = true;
        }
        let surface_of = (0..triangles.len() as u32).map(|triangle| {
            let surface = surfaces.of(triangle);
            if is_open[surface as usize] { NONE } else { surface }
        });
        Self { surface_of: surface_of.collect() }
    }

    /// The closed surface that two triangles are both part of.
    #[inline]
    pub(super) fn common(&self, [a, b]: [u32; 2]) -> Option<u32> {
        let [a, b] = [a, b].map(|triangle| self.surface_of[triangle as usize]);
        (a == b && a != NONE).then_some(a)
    }

    /// For each triangle whether it is part of a body: a surface that is not `touched` and is wound
    /// outward. What cannot be shown to be a body is none. Empty when there is no body.
    pub(super) fn in_bodies(
        self,
        touched: impl Iterator<Item = u32>,
        solid: &Solid,
        triangles: &[[u32; 3]],
    ) -> Vec<bool> {
        let mut is_touched = vec![false; triangles.len()];
        for surface in touched {
            is_touched[surface as usize] = true;
        }
        let mut members: Vec<(u32, u32)> = (self.surface_of.into_iter().zip(0..))
            .filter(|&(surface, _)| surface != NONE && !is_touched[surface as usize])
            .collect();
        members.par_sort_unstable();
        let mut in_bodies = Vec::new();
        for members in members.chunk_by(|a, b| a.0 == b.0) {
            if solid.is_outward(members.iter().map(|&(_, t)| triangles[t as usize])) {
                in_bodies.resize(triangles.len(), false);
                members.iter().for_each(|&(_, t)| in_bodies[t as usize] = true);
            }
        }
        in_bodies
    }
}
