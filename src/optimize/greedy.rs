//! A first route: shortest links first (greedy edge, as in Bentley 1992). It leaves less for the local
//! search to improve than a nearest-neighbor route.

use glam::DVec2;
use rayon::prelude::*;

use super::graph::NONE;
use super::nearest::NearestPoints;

/// Entry ends in drawing order. Stroke `s` has the ends `2s` and `2s + 1`; `neighbors` lists
/// `n_neighbors` near ends for each, filled up with `NONE`.
///
/// Neighbors are linked in order of distance if both ends are free and the link closes no ring. The
/// resulting chains are then visited from the page's origin, always the nearest next.
pub(super) fn greedy(ends: &[DVec2], neighbors: &[u32], n_neighbors: usize) -> Vec<u32> {
    let near = |i: u32| &neighbors[i as usize * n_neighbors..(i as usize + 1) * n_neighbors];
    let mut pairs: Vec<(f64, u32, u32)> = neighbors
        .par_iter()
        .enumerate()
        .filter(|&(_, &j)| j != NONE)
        // Most pairs are listed at both ends; once is enough, and takes half of the memory.
        .filter(|&(k, &j)| {
            let i = (k / n_neighbors) as u32;
            i < j || !near(j).contains(&i)
        })
        .map(|(k, &j)| {
            let i = (k / n_neighbors) as u32;
            (ends[i as usize].distance_squared(ends[j as usize]), i.min(j), i.max(j))
        })
        .collect();
    pairs.par_sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
    let mut linked = vec![NONE; ends.len()];
    // For an end of a chain, the chain's other end.
    let mut far: Vec<u32> = (0..ends.len() as u32).map(|i| i ^ 1).collect();
    for (_, i, j) in pairs {
        let free = linked[i as usize] == NONE && linked[j as usize] == NONE;
        if free && far[i as usize] != j {
            linked[i as usize] = j;
            linked[j as usize] = i;
            let (a, b) = (far[i as usize], far[j as usize]);
            far[a as usize] = b;
            far[b as usize] = a;
        }
    }
    let free: Vec<u32> = (0..ends.len() as u32).filter(|&i| linked[i as usize] == NONE).collect();
    let points: Vec<DVec2> = free.iter().map(|&i| ends[i as usize]).collect();
    let mut left = NearestPoints::new(&points);
    let mut entries = Vec::with_capacity(ends.len() / 2);
    let mut here = DVec2::ZERO;
    while let Some(point) = left.nearest(here) {
        left.remove(point);
        let mut entry = free[point as usize];
        loop {
            entries.push(entry);
            match linked[entry as usize ^ 1] {
                NONE => break,
                next => entry = next,
            }
        }
        let exit = entry ^ 1;
        if let Ok(other) = free.binary_search(&exit) {
            left.remove(other as u32);
        }
        here = ends[exit as usize];
    }
    entries
}
