//! How often triangles pierce each other, estimated before an engine starts.
//!
//! Engines that cut faces make at least one more fragment for each pair of triangles that pierce each
//! other, and several where many do so in one place. The estimate comes from a sample of pairs, in plain
//! floating point: only the decision whether to start depends on it.

use crate::model::scene::Scene;
use glam::DVec3;
use rayon::prelude::*;

/// Pairs in the sample. With fewer than 600 triangles, all pairs are tested.
const N_SAMPLES: u64 = 180_000;

/// About how many pairs of triangles pierce each other. Deterministic; takes some ten milliseconds.
pub fn estimate(scene: &Scene) -> u64 {
    let n = scene.triangles().len() as u64;
    let n_pairs = n * n.saturating_sub(1) / 2;
    let n_samples = n_pairs.min(N_SAMPLES);
    if n_samples == 0 {
        return 0;
    }
    let found = (0..n_samples)
        .into_par_iter()
        .filter(|&k| {
            // Pair k of all pairs, or one of a sample spread by a multiple of the golden ratio.
            let pair = if n_pairs <= N_SAMPLES {
                k
            } else {
                ((u128::from(k.wrapping_mul(0x9e37_79b9_7f4a_7c15)) * u128::from(n_pairs)) >> 64)
                    as u64
            };
            // The later of both, from the inverse of pair = j (j − 1) / 2 + i.
            let mut j = ((1.0 + (1.0 + 8.0 * pair as f64).sqrt()) / 2.0) as u64;
            while j * (j - 1) / 2 > pair {
                j -= 1;
            }
            let i = pair - j * (j - 1) / 2;
            i < j && j < n && pierce(&corners(scene, i), &corners(scene, j))
        })
        .count() as u64;
    (u128::from(found) * u128::from(n_pairs) / u128::from(n_samples)) as u64
}

fn corners(scene: &Scene, triangle: u64) -> [DVec3; 3] {
    let positions = scene.mesh().positions();
    scene.triangles()[triangle as usize].map(|vertex| positions[vertex as usize])
}

/// Whether a side of one goes through the other.
fn pierce(p: &[DVec3; 3], q: &[DVec3; 3]) -> bool {
    let low = |t: &[DVec3; 3]| t[0].min(t[1]).min(t[2]);
    let high = |t: &[DVec3; 3]| t[0].max(t[1]).max(t[2]);
    if low(p).cmpge(high(q)).any() || low(q).cmpge(high(p)).any() {
        return false;
    }
    let goes_through = |from: DVec3, to: DVec3, [a, b, c]: &[DVec3; 3]| {
        let volume = |p: DVec3, q: DVec3, r: DVec3| (p - from).cross(q - from).dot(r - from);
        let normal = (b - a).cross(c - a);
        let sides = [volume(to, *a, *b), volume(to, *b, *c), volume(to, *c, *a)];
        normal.dot(from - a) * normal.dot(to - a) < 0.0
            && (sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0))
    };
    (0..3).any(|i| {
        let j = (i + 1) % 3;
        goes_through(p[i], p[j], q) || goes_through(q[i], q[j], p)
    })
}
