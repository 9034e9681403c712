//! Smoothing fans: the faces around a vertex that belong to one smooth part, and their common normal.
//!
//! ```text
//!        ╲  │  ╱
//!      1  ╲ │ ╱ 1            Two fans at one vertex, apart along two hard edges (═). Each corner of a
//!    ══════●══════           triangle belongs to a fan.
//!          2
//! ```

use glam::DVec3;
use rayon::prelude::*;

use crate::disjoint_sets::DisjointSets;
use crate::model::creases::CreaseAngle;
use crate::model::mesh::Mesh;
use crate::model::topology::Topology;

use super::SmoothParts;

/// Normals in a file that differ by no more than this are one; as the square of a sine.
const SAME_NORMAL: f64 = 1e-6;

/// The corners of triangles with their fans, and the edges that bound smooth parts.
pub(super) struct Corners {
    /// The fan of each corner.
    pub(super) fans: Vec<[u32; 3]>,
    /// For each side of each triangle, from corner `i` to the next, whether it bounds a smooth part.
    pub(super) hard: Vec<[bool; 3]>,
    /// The unit normal of each fan; zero where there is none.
    pub(super) normals: Vec<DVec3>,
}

impl Corners {
    /// Finds the fans of triangles that are parts of the mesh's faces.
    pub(super) fn new(
        mesh: &Mesh,
        triangles: &[[u32; 3]],
        faces: &[u32],
        parts: SmoothParts,
    ) -> Self {
        let topology = Topology::of_triangles(triangles, mesh.positions().len());
        let given =
            (!mesh.corner_normals().is_empty()).then(|| given_normals(mesh, triangles, faces));
        // Zero where the file gives none, as in all of some models of a scene.
        let given_at =
            |corner: usize| given.as_ref().map_or(DVec3::ZERO, |normals| normals[corner]);
        let area = |t: usize| {
            let [p, q, r] = triangles[t].map(|v| mesh.positions()[v as usize]);
            (q - p).cross(r - p)
        };
        let areas: Vec<DVec3> = (0..triangles.len()).into_par_iter().map(area).collect();
        let limits = match parts {
            SmoothParts::Below(degrees) => Some(CreaseAngle::from_degrees(degrees)),
            SmoothParts::ByNormals => None,
        };
        // What joins corners into fans, and triangles into flat regions.
        let mut fans = DisjointSets::new(3 * triangles.len());
        let mut flats = DisjointSets::new(triangles.len());
        let mut hard = vec![[true; 3]; triangles.len()];
        for edge in 0..topology.edges().len() as u32 {
            let &[first, second] = topology.uses(edge) else { continue };
            if first.runs_upwards() == second.runs_upwards() {
                continue;
            }
            let [a, b] = topology.edge(edge);
            let [t, u] = [first.face(), second.face()];
            let is_flat = is_flat(mesh, &areas, [t, u], triangles);
            if is_flat {
                flats.unite(t, u);
            }
            let corner = |t: u32, v: u32| 3 * t + place(triangles[t as usize], v) as u32;
            let at = |v: u32| [t, u].map(|t| given_at(corner(t, v) as usize));
            let is_given = [a, b].iter().any(|&v| at(v) != [DVec3::ZERO; 2]);
            let is_smooth = match limits {
                _ if is_given => [a, b].iter().all(|&v| {
                    let [n, m] = at(v);
                    n.cross(m).length_squared() <= SAME_NORMAL && n.dot(m) > 0.0
                }),
                Some(limit) => {
                    faces[t as usize] == faces[u as usize]
                        || is_flat
                        || !limit.is_exceeded_by(areas[t as usize], areas[u as usize], || {
                            mesh.coordinate_error() * heights(mesh, [a, b], [t, u], &areas)
                        })
                }
                None => false,
            };
            if is_smooth {
                for v in [a, b] {
                    fans.unite(corner(t, v), corner(u, v));
                }
                for t in [t, u] {
                    hard[t as usize][side(triangles[t as usize], [a, b])] = false;
                }
            }
        }
        let mut regions = vec![0.0; triangles.len()];
        for t in 0..triangles.len() as u32 {
            regions[flats.of(t) as usize] += areas[t as usize].length();
        }
        let mut sums = vec![DVec3::ZERO; 3 * triangles.len()];
        let mut largest = vec![Largest::default(); 3 * triangles.len()];
        for (t, corners) in triangles.iter().enumerate() {
            let region = regions[flats.of(t as u32) as usize];
            for i in 0..3 {
                let [p, q, r] =
                    [i, (i + 1) % 3, (i + 2) % 3].map(|k| mesh.positions()[corners[k] as usize]);
                let (along, across) = (q - p, r - p);
                let angle = libm::atan2(along.cross(across).length(), along.dot(across));
                let fan = fans.of(3 * t as u32 + i as u32) as usize;
                let normal = given_at(3 * t + i);
                if normal != DVec3::ZERO {
                    sums[fan] += normal;
                    continue;
                }
                // Large flat regions stay flat beside narrow fillets.
                sums[fan] += angle * region * region * areas[t].normalize_or_zero();
                largest[fan].add(flats.of(t as u32), region, areas[t]);
            }
        }
        // Fans by number, in the order of their first corners.
        let mut numbers = vec![u32::MAX; 3 * triangles.len()];
        let mut normals = Vec::new();
        let fans = (0..triangles.len() as u32)
            .map(|t| {
                [0, 1, 2].map(|i| {
                    let root = fans.of(3 * t + i) as usize;
                    if numbers[root] == u32::MAX {
                        numbers[root] = normals.len() as u32;
                        let flat = largest[root].normal();
                        normals.push(flat.unwrap_or(sums[root]).normalize_or_zero());
                    }
                    numbers[root]
                })
            })
            .collect();
        Self { fans, hard, normals }
    }
}

/// A flat region is a face of its own beside others that are this many times smaller: fillets.
const MUCH_LARGER: f64 = 10.0;

/// The largest flat region of a fan, and how large the next one is.
#[derive(Clone, Copy, Default)]
struct Largest {
    region: u32,
    area: f64,
    normal: DVec3,
    next_area: f64,
}

impl Largest {
    fn add(&mut self, region: u32, area: f64, normal: DVec3) {
        if area > self.area {
            let next_area = if region == self.region { self.next_area } else { self.area };
            *self = Self { region, area, normal, next_area };
        } else if region != self.region {
            self.next_area = self.next_area.max(area);
        }
    }

    /// The normal of a region that is much larger than all others. It keeps its plane exactly.
    fn normal(&self) -> Option<DVec3> {
        let is_flat = self.next_area > 0.0 && self.area > MUCH_LARGER * self.next_area;
        is_flat.then_some(self.normal)
    }
}

/// The file's normals for the corners of all triangles.
fn given_normals(mesh: &Mesh, triangles: &[[u32; 3]], faces: &[u32]) -> Vec<DVec3> {
    let starts = mesh.face_starts();
    let corner = |face: u32, vertex: u32| {
        let first = starts[face as usize] as usize;
        let place = mesh.face(face).iter().position(|&v| v == vertex).unwrap_or(0);
        let [x, y, z] = mesh.corner_normals()[first + place].map(f64::from);
        DVec3::new(x, y, z).normalize_or_zero()
    };
    let of = |(triangle, &face): (&[u32; 3], &u32)| triangle.map(|vertex| corner(face, vertex));
    triangles.par_iter().zip(faces).map(of).collect::<Vec<_>>().into_flattened()
}

/// Whether two triangles lie in one plane, but for rounding of their corners.
fn is_flat(mesh: &Mesh, areas: &[DVec3], [t, u]: [u32; 2], triangles: &[[u32; 3]]) -> bool {
    let at = |v: u32| mesh.positions()[v as usize];
    let normal = areas[t as usize].normalize_or_zero();
    let corners = triangles[u as usize];
    let base = at(triangles[t as usize][0]);
    let error = 2.0 * mesh.coordinate_error();
    areas[t as usize].dot(areas[u as usize]) > 0.0
        && corners.iter().all(|&v| normal.dot(at(v) - base).abs() <= error)
}

/// The sum of one over the heights of two triangles above their common edge.
fn heights(mesh: &Mesh, [a, b]: [u32; 2], sides: [u32; 2], areas: &[DVec3]) -> f64 {
    let length = mesh.positions()[a as usize].distance(mesh.positions()[b as usize]);
    sides.map(|t| length / areas[t as usize].length()).iter().sum()
}

/// Which corner of a triangle a vertex is.
fn place(triangle: [u32; 3], vertex: u32) -> usize {
    triangle.iter().position(|&v| v == vertex).unwrap_or(0)
}

/// Which side of a triangle an edge is.
pub(super) fn side(triangle: [u32; 3], [a, b]: [u32; 2]) -> usize {
    let is_side = |&i: &usize| {
        let (p, q) = (triangle[i], triangle[(i + 1) % 3]);
        (p, q) == (a, b) || (p, q) == (b, a)
    };
    (0..3).find(is_side).unwrap_or(0)
}
