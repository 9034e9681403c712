//! Triangles that continue into each other in one plane.
//!
//! Flat sides of a model are many triangles, and whether a point of one lies in the plane of the next is
//! a question that only exact arithmetic answers. So it is answered once for each edge.

use glam::DVec3;
use rayon::prelude::*;

use crate::disjoint_sets::DisjointSets;
use crate::model::mesh::Mesh;
use crate::model::topology::Topology;
use crate::predicates::{Sign, Solid};

/// Triangles with a flatter corner than this sine are not compared: three points nearly in a line lie in
/// many planes. Rounding changes sines by far less.
const MIN_CORNER_SINE: f64 = 1e-6;

/// For each triangle a number that it shares only with triangles in the same plane: those of its face, and
/// those of faces that it is connected with across edges without leaving the plane.
///
/// `triangles` cover the faces of the mesh in order, as listed in `triangle_faces`. Exact; O(corners), in
/// parallel but for joining.
pub(super) fn planes(
    mesh: &Mesh,
    topology: &Topology,
    triangles: &[[u32; 3]],
    triangle_faces: &[u32],
) -> Vec<u32> {
    let positions = mesh.positions();
    let solid = Solid::new(positions);
    let is_in_plane = |triangle: u32, corners: &[u32]| {
        let corners =
            || corners.iter().filter(|corner| !triangles[triangle as usize].contains(corner));
        let plane = solid.plane(triangles[triangle as usize]);
        corners().all(|&x| solid.side(&plane, triangles[triangle as usize], x) == Sign::Zero)
    };
    // For each flat face one of its triangles that says its plane.
    let first_of = |face: u32| triangle_faces.partition_point(|&other| other < face);
    let flat: Vec<Option<u32>> = (0..mesh.n_faces() as u32)
        .into_par_iter()
        .with_min_len(1024)
        .map(|face| {
            let triangle = (first_of(face)..first_of(face + 1)).find(|&triangle| {
                has_clear_plane(triangles[triangle].map(|corner| positions[corner as usize]))
            })? as u32;
            is_in_plane(triangle, mesh.face(face)).then_some(triangle)
        })
        .collect();
    let pairs: Vec<[u32; 2]> = (0..topology.edges().len() as u32)
        .into_par_iter()
        .with_min_len(1024)
        .filter_map(|edge| {
            let &[first, second] = topology.uses(edge) else { return None };
            let faces = [first, second].map(|used| flat[used.face() as usize]);
            let [Some(a), Some(b)] = faces else { return None };
            is_in_plane(a, &triangles[b as usize]).then_some([a, b])
        })
        .collect();
    let mut sets = DisjointSets::new(triangles.len());
    for (triangle, &face) in triangle_faces.iter().enumerate() {
        if let Some(flat) = flat[face as usize] {
            sets.unite(flat, triangle as u32);
        }
    }
    for [a, b] in pairs {
        sets.unite(a, b);
    }
    (0..triangles.len() as u32).map(|triangle| sets.of(triangle)).collect()
}

/// Whether three points are certainly not in one line.
fn has_clear_plane([a, b, c]: [DVec3; 3]) -> bool {
    let corner = |at: DVec3, p: DVec3, q: DVec3| {
        let (u, v) = ((p - at).normalize_or_zero(), (q - at).normalize_or_zero());
        u.cross(v).length()
    };
    [corner(a, b, c), corner(b, c, a), corner(c, a, b)].iter().all(|&sine| sine > MIN_CORNER_SINE)
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use crate::model::scene::Scene;

    fn planes(points: &[[f64; 3]], faces: &[&[u32]]) -> Vec<u32> {
        let points: Vec<_> = points.iter().map(|&[x, y, z]| dvec3(x, y, z)).collect();
        Scene::from_faces(&points, faces).expect("a mesh").planes().to_vec()
    }

    /// A roof: two flat halves of two triangles each.
    const ROOF: [[f64; 3]; 6] =
        [[0., 0., 0.], [1., 0., 1.], [2., 0., 0.], [0., 3., 0.], [1., 3., 1.], [2., 3., 0.]];

    #[test]
    fn the_halves_of_a_roof_are_two_planes() {
        let planes = planes(&ROOF, &[&[0, 1, 4], &[0, 4, 3], &[1, 2, 5], &[1, 5, 4]]);
        assert_eq!(planes[0], planes[1]);
        assert_eq!(planes[2], planes[3]);
        assert_ne!(planes[0], planes[2]);
    }

    #[test]
    fn the_last_bit_out_of_plane_is_another_plane() {
        let mut points = ROOF;
        points[3][2] = -f64::EPSILON;
        let planes = planes(&points, &[&[0, 1, 4], &[0, 4, 3]]);
        assert_ne!(planes[0], planes[1]);
    }

    #[test]
    fn flat_polygons_go_on_into_triangles_and_bent_ones_do_not() {
        let pentagon: &[u32] = &[0, 1, 2, 5, 3];
        let mut points =
            [[0., 0., 0.], [1., 0., 0.], [2., 1., 0.], [0., 2., 0.], [3., 3., 0.], [1., 2., 0.]];
        let flat = planes(&points, &[pentagon, &[2, 4, 5]]);
        assert!(flat.iter().all(|&plane| plane == flat[0]), "{flat:?}");
        points[0][2] = 1.0;
        let bent = planes(&points, &[pentagon, &[2, 4, 5]]);
        assert!(bent[..3].iter().all(|&plane| plane != bent[3]), "{bent:?}");
    }

    #[test]
    fn a_triangle_without_area_connects_no_planes() {
        // It lies between two halves of a roof, along the ridge.
        let mut points = ROOF.to_vec();
        points.push([1., 1., 1.]);
        let planes = planes(&points, &[&[0, 1, 4], &[1, 6, 4], &[6, 1, 2], &[4, 6, 2], &[4, 1, 6]]);
        assert_ne!(planes[0], planes[2]);
        assert_ne!(planes[0], planes[3]);
    }

    #[test]
    fn planes_of_random_lattice_meshes_are_planes() {
        let mut state = 5_u64;
        let mut next = move |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) % n
        };
        let mut n_shared = 0;
        for _ in 0..200 {
            let points: Vec<[f64; 3]> =
                (0..8).map(|_| [next(3), next(3), next(2)].map(|x| x as f64)).collect();
            let faces: Vec<[u32; 3]> = (0..10)
                .map(|_| [next(8), next(8), next(8)].map(|x| x as u32))
                .filter(|[a, b, c]| a != b && b != c && c != a)
                .collect();
            let positions: Vec<_> = points.iter().map(|&[x, y, z]| dvec3(x, y, z)).collect();
            let Ok(scene) = Scene::from_faces(&positions, &faces) else { continue };
            let (planes, at) = (scene.planes(), scene.mesh().positions());
            let corners = |t: usize| scene.triangles()[t].map(|v| at[v as usize]);
            for i in 0..planes.len() {
                for j in 0..i {
                    if planes[i] == planes[j] {
                        n_shared += 1;
                        let [p, q, r] = corners(i);
                        let normal = (q - p).cross(r - p);
                        assert!(normal.length() > 0.0);
                        assert!(corners(j).iter().all(|x| normal.dot(*x - p) == 0.0));
                    }
                }
            }
        }
        assert!(n_shared > 100, "{n_shared}");
    }
}
