//! Splitting edges, and the triangles along them.
//!
//! ```text
//!      ●             ●             ●              Which edges of a triangle are split says how it is
//!     ╱ ╲           ╱ ╲           ╱ ╲             cut. With two, the remaining quadrilateral is cut
//!    ╱   ╲         ○───○         ○───○            along its shorter diagonal.
//!   ╱  │  ╲       ╱ ╲   ╲       ╱ ╲ ╱ ╲
//!  ●───○───●     ●───────●     ●───○───●
//! ```

use glam::DVec3;
use rayon::prelude::*;

use crate::model::topology::Topology;

use super::fans::Corners;
use super::midpoint::{circle_tangent, curve_middle, middle_normal, smooth_middle};

/// Creases that turn more than this at a vertex, in degrees, have a corner there. Octagons are round,
/// whatever their corners were rounded to.
const CORNER_DEG: f64 = 45.5;

/// A mesh of triangles while it is refined.
pub(super) struct Refinement {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// The face that each triangle is part of; triangles of a face follow each other.
    faces: Vec<u32>,
    corners: Corners,
    topology: Topology,
    /// The middle of each edge.
    middles: Vec<Middle>,
    is_refined: bool,
}

/// Where the middle of an edge lies on the curved surface, and whether the edge is to be split there.
#[derive(Clone, Copy)]
struct Middle {
    at: DVec3,
    sagitta: f64,
    is_split: bool,
}

/// What a round of splitting would do.
pub(super) struct Split {
    pub(super) n_edges: usize,
    /// How many triangles it adds.
    pub(super) n_triangles: usize,
    /// The largest distance of an edge's middle from the curved surface.
    pub(super) farthest: f64,
}

impl Refinement {
    pub(super) fn new(
        positions: Vec<DVec3>,
        triangles: Vec<[u32; 3]>,
        faces: Vec<u32>,
        corners: Corners,
    ) -> Self {
        let topology = Topology::default();
        let middles = Vec::new();
        Self { positions, triangles, faces, corners, topology, middles, is_refined: false }
    }

    pub(super) fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    pub(super) fn n_triangles(&self) -> usize {
        self.triangles.len()
    }

    pub(super) fn is_refined(&self) -> bool {
        self.is_refined
    }

    /// The triangles of each face.
    pub(super) fn by_face(&self) -> impl Iterator<Item = (u32, &[[u32; 3]])> {
        let mut first = 0;
        self.faces.chunk_by(|a, b| a == b).map(move |run| {
            let triangles = &self.triangles[first..first + run.len()];
            first += run.len();
            (run[0], triangles)
        })
    }

    /// Finds the edges whose middle is farther than `tolerance` from the curved surface.
    pub(super) fn measure(&mut self, tolerance: f64) -> Split {
        self.topology = Topology::of_triangles(&self.triangles, self.positions.len());
        let tangents = Tangents::new(self);
        let middle = |edge: u32| {
            let [a, b] = self.topology.edge(edge);
            let ends = [a, b].map(|v| self.positions[v as usize]);
            let used = self.topology.uses(edge)[0].face() as usize;
            let (triangle, fans) = (self.triangles[used], self.corners.fans[used]);
            let at = if self.is_hard(edge) {
                curve_middle(ends, tangents.of(self, edge))
            } else {
                let normal = |vertex: u32| {
                    let corner = triangle.iter().position(|&v| v == vertex).unwrap_or(0);
                    self.corners.normals[fans[corner] as usize]
                };
                smooth_middle(ends, [a, b].map(normal))
            };
            let sagitta = at.distance(0.5 * (ends[0] + ends[1]));
            let is_split = sagitta > tolerance && at.is_finite();
            Middle { at, sagitta, is_split }
        };
        let n_edges = self.topology.edges().len() as u32;
        let middles: Vec<Middle> = (0..n_edges).into_par_iter().map(middle).collect();
        let mut split = Split { n_edges: 0, n_triangles: 0, farthest: 0.0 };
        for (edge, middle) in (0..).zip(&middles) {
            split.farthest = split.farthest.max(middle.sagitta);
            if middle.is_split {
                split.n_edges += 1;
                split.n_triangles += self.topology.uses(edge).len();
            }
        }
        self.middles = middles;
        split
    }

    /// Splits the edges that were found.
    pub(super) fn split(&mut self) {
        self.is_refined = true;
        // The vertex at the middle of each edge that is split.
        let mut vertices = vec![u32::MAX; self.middles.len()];
        for (vertex, middle) in vertices.iter_mut().zip(&self.middles) {
            if middle.is_split {
                *vertex = self.positions.len() as u32;
                self.positions.push(middle.at);
            }
        }
        // Along a smooth edge both triangles share the new fan.
        let mut shared = vec![u32::MAX; self.middles.len()];
        let old = std::mem::take(&mut self.triangles);
        let old_faces = std::mem::take(&mut self.faces);
        let fans = std::mem::take(&mut self.corners.fans);
        let hard = std::mem::take(&mut self.corners.hard);
        for (t, triangle) in old.iter().enumerate() {
            let mut cut = Cut { corners: [(0, 0); 6], hard: [false; 3] };
            let mut is_split = [false; 3];
            for i in 0..3 {
                let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
                cut.corners[i] = (a, fans[t][i]);
                cut.hard[i] = hard[t][i];
                let Some(edge) = self.topology.find_edge(a, b) else { continue };
                let edge = edge as usize;
                if !self.middles[edge].is_split {
                    continue;
                }
                is_split[i] = true;
                let along = self.positions[b as usize] - self.positions[a as usize];
                let ends = [fans[t][i], fans[t][(i + 1) % 3]];
                let normals = ends.map(|fan| self.corners.normals[fan as usize]);
                let mut fan = shared[edge];
                if fan == u32::MAX {
                    fan = self.corners.normals.len() as u32;
                    self.corners.normals.push(middle_normal(along, normals));
                    if !hard[t][i] {
                        shared[edge] = fan;
                    }
                }
                cut.corners[3 + i] = (vertices[edge], fan);
            }
            let before = self.triangles.len();
            self.cut(&cut, is_split);
            self.faces.extend(std::iter::repeat_n(old_faces[t], self.triangles.len() - before));
        }
    }

    /// Adds the parts of a triangle whose sides are split or not.
    fn cut(&mut self, cut: &Cut, is_split: [bool; 3]) {
        let first = is_split.iter().position(|&split| split);
        let (Some(first), n) = (first, is_split.iter().filter(|&&split| split).count()) else {
            return self.push(cut, [0, 1, 2]);
        };
        match n {
            1 => {
                // From the middle of side `i` to the corner across.
                let [i, j, k] = [first, (first + 1) % 3, (first + 2) % 3];
                self.push(cut, [i, 3 + i, k]);
                self.push(cut, [3 + i, j, k]);
            }
            2 => {
                // Turned so that sides `i` and `j` are split: corner `j` is cut off.
                let i = if is_split[(first + 1) % 3] { first } else { (first + 2) % 3 };
                let [j, k] = [(i + 1) % 3, (i + 2) % 3];
                self.push(cut, [3 + i, j, 3 + j]);
                let at = |place: usize| self.positions[cut.corners[place].0 as usize];
                let one = at(i).distance_squared(at(3 + j));
                let other = at(3 + i).distance_squared(at(k));
                let is_first = match one.total_cmp(&other) {
                    std::cmp::Ordering::Equal => cut.corners[i].0 < cut.corners[k].0,
                    order => order.is_lt(),
                };
                if is_first {
                    self.push(cut, [i, 3 + i, 3 + j]);
                    self.push(cut, [i, 3 + j, k]);
                } else {
                    self.push(cut, [i, 3 + i, k]);
                    self.push(cut, [3 + i, 3 + j, k]);
                }
            }
            _ => {
                for i in 0..3 {
                    self.push(cut, [i, 3 + i, 3 + (i + 2) % 3]);
                }
                self.push(cut, [3, 4, 5]);
            }
        }
    }

    /// Adds a triangle of some of the corners and middles of a cut one.
    fn push(&mut self, cut: &Cut, places: [usize; 3]) {
        self.triangles.push(places.map(|place| cut.corners[place].0));
        self.corners.fans.push(places.map(|place| cut.corners[place].1));
        let hard = [0, 1, 2].map(|n| cut.is_hard(places[n], places[(n + 1) % 3]));
        self.corners.hard.push(hard);
    }

    /// Whether an edge bounds a smooth part.
    fn is_hard(&self, edge: u32) -> bool {
        let triangle = self.topology.uses(edge)[0].face() as usize;
        let side = super::fans::side(self.triangles[triangle], self.topology.edge(edge));
        self.corners.hard[triangle][side]
    }
}

/// A triangle that is cut: its corners, then the middles of its sides, as vertices and fans.
struct Cut {
    corners: [(u32, u32); 6],
    /// Which of its sides are hard.
    hard: [bool; 3],
}

impl Cut {
    /// Whether the line between two places is part of a hard side.
    fn is_hard(&self, a: usize, b: usize) -> bool {
        let on_side = |place: usize, side: usize| {
            place == side || place == (side + 1) % 3 || place == 3 + side
        };
        (0..3).any(|side| self.hard[side] && on_side(a, side) && on_side(b, side))
    }
}

/// The directions of creases and borders at their ends.
struct Tangents {
    /// At each vertex where just two of them meet, the vertices at their other ends.
    neighbors: Vec<[u32; 2]>,
    counts: Vec<u8>,
}

impl Tangents {
    fn new(mesh: &Refinement) -> Self {
        let n = mesh.positions.len();
        let (mut neighbors, mut counts) = (vec![[0; 2]; n], vec![0u8; n]);
        for edge in (0..mesh.topology.edges().len() as u32).filter(|&edge| mesh.is_hard(edge)) {
            let [a, b] = mesh.topology.edge(edge);
            for (v, other) in [(a, b), (b, a)] {
                let count = &mut counts[v as usize];
                if let Some(place) = neighbors[v as usize].get_mut(*count as usize) {
                    *place = other;
                }
                *count = count.saturating_add(1);
            }
        }
        Self { neighbors, counts }
    }

    /// The unit tangents at both ends of a hard edge, from its first to its second vertex.
    fn of(&self, mesh: &Refinement, edge: u32) -> [DVec3; 2] {
        let [a, b] = mesh.topology.edge(edge);
        let at = |v: u32| mesh.positions[v as usize];
        let own = (at(b) - at(a)).normalize_or_zero();
        let cos_corner = libm::cos(CORNER_DEG.to_radians());
        let tangent = |v: u32, other: u32| {
            let neighbors = self.neighbors[v as usize];
            let beyond = if neighbors[0] == other { neighbors[1] } else { neighbors[0] };
            (self.counts[v as usize] == 2)
                .then(|| circle_tangent([at(beyond), at(v), at(other)], cos_corner))
                .flatten()
        };
        [tangent(a, b).unwrap_or(own), tangent(b, a).map_or(own, |t| -t)]
    }
}
