//! Normals: of triangles, and smooth ones for shading that hides where triangles meet.

use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::model::scene::Scene;

/// At vertices with more triangles than this the mean is that of all: the tip of a fan so fine is no
/// corner of anything, and comparing each with each would take too long.
const MOST_COMPARED: usize = 256;

/// For each corner of each triangle the mean normal, by area, of the triangles at that vertex that meet
/// it at `angle_deg` or less: of length one, or zero where there is none.
///
/// At vertices with more than 256 triangles it is the mean of all of them. O(triangles), in
/// parallel.
pub fn smooth_normals(scene: &Scene, angle_deg: f64) -> Vec<[DVec3; 3]> {
    let triangles = scene.triangles();
    let cosine = libm::cos(angle_deg.clamp(0.0, 180.0).to_radians());
    let flat: Vec<DVec3> = (0..triangles.len() as u32)
        .into_par_iter()
        .map(|triangle| area_vector(corners(scene, triangle)))
        .collect();
    let mut starts = vec![0; scene.mesh().positions().len() + 1];
    for vertex in triangles.iter().flatten() {
        starts[*vertex as usize + 1] += 1;
    }
    for k in 1..starts.len() {
        starts[k] += starts[k - 1];
    }
    let mut next = starts.clone();
    let mut around = vec![0u32; triangles.len() * 3];
    for (number, triangle) in (0..).zip(triangles) {
        for &vertex in triangle {
            around[next[vertex as usize]] = number;
            next[vertex as usize] += 1;
        }
    }
    let range = |vertex: u32| starts[vertex as usize]..starts[vertex as usize + 1];
    let of_all = |vertex: u32| -> DVec3 {
        around[range(vertex)].iter().map(|&triangle| flat[triangle as usize]).sum()
    };
    let is_crowded = |vertex: &u32| range(*vertex).len() > MOST_COMPARED;
    let crowded: FxHashMap<u32, DVec3> = (0..scene.mesh().positions().len() as u32)
        .filter(is_crowded)
        .map(|vertex| (vertex, of_all(vertex).normalize_or_zero()))
        .collect();
    let mean = |own: DVec3, vertex: u32| {
        if let Some(&mean) = crowded.get(&vertex) {
            return mean;
        }
        let range = range(vertex);
        let near = around[range].iter().map(|&other| flat[other as usize]);
        let near = near.filter(|other| own.dot(*other) >= cosine * own.length() * other.length());
        near.sum::<DVec3>().normalize_or_zero()
    };
    triangles
        .par_iter()
        .zip(&flat)
        .map(|(triangle, &own)| triangle.map(|vertex| mean(own, vertex)))
        .collect()
}

/// The positions of a triangle's corners.
pub fn corners(scene: &Scene, triangle: u32) -> [DVec3; 3] {
    scene.triangles()[triangle as usize].map(|vertex| scene.mesh().positions()[vertex as usize])
}

/// Normal of a triangle, twice as long as its area is large.
pub fn area_vector([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}
