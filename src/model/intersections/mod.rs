//! Where faces pierce each other: lines that are not edges of the mesh, found once for all views.
//!
//! ```text
//!   triangles ─► tree ─────────► pair ─────────────► contact ───────► lines
//!                boxes that      what both have      touch or         joined between
//!                touch           in common           cross            the same planes
//! ```
//!
//! An intersection line runs where two faces that do not lie in one plane cross. There is none
//! where they only touch (a box standing on a table has its own edges there), where they share an
//! edge, or where they lie in one plane. What two planar faces share is one line, however they are
//! cut into triangles.
//!
//! # What is exact
//!
//! All decisions: which triangles cross, where each line ends, what is coplanar, and later what hides
//! it, since ends that are not vertices stay unrounded in [`PiercePoint`]. Only the drawn ends are rounded, to within four units in the last place of
//! each coordinate in space.
//!
//! # Cost
//!
//! Expected O(n log n) for the tree, and a few signs of volumes for each pair of triangles whose
//! boxes touch. Most such pairs are neighbors in a mesh; those that share a side are passed by, for
//! those that share a corner two signs mostly suffice. All of it runs in parallel, and the result
//! does not depend on the number of threads.
//!
//! Differs from the usual (T. Möller, "A fast triangle-triangle intersection test", 1997; P.
//! Guigue and O. Devillers, "Fast and robust triangle-triangle overlap test using orientation
//! predicates", 2003) in that ends are compared by what makes them, never by their place.

mod bodies;
mod contact;
mod diagonals;
mod lines;
mod pair;
mod touch;
mod tree;

use crate::model::mesh::Mesh;
use crate::model::topology::Topology;
use crate::predicates::{PiercePoint, Solid};
use bodies::Surfaces;
use diagonals::Diagonals;
use pair::{Piece, Prepared};
use tree::BoxTree;

/// A line in which two planes' faces cross.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Intersection {
    /// Its ends: vertices, or from the number of vertices on, [`Intersections::points`].
    pub ends: [u32; 2],
    /// The two planes, by a triangle in each; see [`Intersections::is_in_plane_of`].
    planes: [u32; 2],
    edges: [u32; 2],
}

impl Intersection {
    const NO_EDGE: u32 = u32::MAX;

    /// The edges of the mesh, two at most, that the line is a part of.
    pub fn edges(&self) -> impl Iterator<Item = u32> {
        self.edges.into_iter().filter(|&edge| edge != Self::NO_EDGE)
    }
}

/// All lines in which faces of a mesh cross.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Intersections {
    lines: Vec<Intersection>,
    points: Vec<PiercePoint>,
    plane_of: Vec<u32>,
    n_pairs: u64,
    in_bodies: Vec<bool>,
}

impl Intersections {
    /// Finds where the triangles of a mesh cross. See the module for the cost.
    ///
    /// `faces` tells which face each triangle is part of; triangles of a face follow each other.
    pub fn new(mesh: &Mesh, triangles: &[[u32; 3]], faces: &[u32], topology: &Topology) -> Self {
        let diagonals = Diagonals::new(mesh, triangles, faces);
        let solid = Solid::new(mesh.positions());
        let tree = BoxTree::new(mesh.positions(), triangles, (0..triangles.len() as u32).collect());
        let surfaces = Surfaces::new(mesh, triangles, topology);
        let found: Vec<Found> = tree.touching_pairs(
            |triangle| Prepared::new(&solid, triangles[triangle as usize]),
            |found: &mut Found, prepared, a, b| {
                found.n_pairs += 1;
                let corners = triangles[b as usize];
                let share_a_side = pair::share_a_side(prepared, corners);
                let are_apart = pair::are_apart(&solid, &diagonals, prepared, corners);
                if !are_apart
                    && let Some(piece) = pair::piece(&solid, triangles, &diagonals, [a, b])
                {
                    found.pieces.push(piece);
                }
                if (!are_apart || share_a_side)
                    && let Some(surface) = surfaces.common([a, b])
                    && found.touched.last() != Some(&surface)
                    && touch::touch(&solid, triangles, [a, b])
                {
                    found.touched.push(surface);
                }
            },
        );
        drop(tree);
        let n_pairs = found.iter().map(|found| found.n_pairs).sum();
        let touched = found.iter().flat_map(|found| found.touched.iter().copied());
        let in_bodies = surfaces.in_bodies(touched, &solid, triangles);
        let pieces = found.into_iter().flat_map(|found| found.pieces).collect();
        let pieces = contact::crossings(pieces, &solid);
        Self { n_pairs, in_bodies, ..lines::joined(pieces, &solid, triangles, topology) }
    }

    /// The lines, in a fixed order.
    pub fn lines(&self) -> &[Intersection] {
        &self.lines
    }

    /// The ends of lines that are not vertices.
    pub fn points(&self) -> &[PiercePoint] {
        &self.points
    }

    /// For each triangle whether it is part of a body: a connected closed surface, wound outward,
    /// that meets itself nowhere. Empty when there is no body.
    pub fn in_bodies(&self) -> &[bool] {
        &self.in_bodies
    }

    /// How many pairs of triangles had boxes that touch.
    pub fn n_pairs(&self) -> u64 {
        self.n_pairs
    }

    /// Whether a triangle is known to lie in one of the two planes of a line.
    ///
    /// True for the triangles that cross there; others in these planes may be missed.
    #[inline]
    pub fn is_in_plane_of(&self, line: &Intersection, triangle: u32) -> bool {
        let plane = self.plane_of[triangle as usize];
        plane != u32::MAX && line.planes.contains(&plane)
    }
}

/// What a piece of parallel work found.
#[derive(Default)]
struct Found {
    pieces: Vec<Piece>,
    /// Closed surfaces that meet themselves.
    touched: Vec<u32>,
    n_pairs: u64,
}
