//! Whether a model is constructed or organic.
//!
//! ```text
//!      ●──────●                 Creases of a constructed model bound faces: they close, and none
//!      │      │                 dangles. Those of a scan begin and end anywhere.
//!      ●──────●───●──●   ●─●
//!               loose   loose
//! ```

use rayon::prelude::*;

use crate::model::looseness::Looseness;
use crate::model::scene::Scene;

use super::{CreaseAngle, length};

/// The angle above which edges are looked at, whatever the crease angle is.
const BENT_DEG: f64 = 30.0;

/// Strips creases with a loose end until there are none, and measures them. O(edges).
pub(super) fn measure(scene: &Scene) -> Looseness {
    let topology = scene.topology();
    let bent = CreaseAngle::from_degrees(BENT_DEG);
    // Once, before many threads ask.
    scene.dihedrals();
    let n_edges = topology.edges().len() as u32;
    let creases: Vec<u32> = (0..n_edges)
        .into_par_iter()
        .with_min_len(4096)
        .filter(|&edge| bent.is_exceeded(scene, edge))
        .collect();
    // Creases that are left at each vertex, and borders, which are never stripped.
    let n_vertices = scene.mesh().positions().len();
    let mut degrees = vec![0u32; n_vertices];
    for edge in (0..n_edges).filter(|&edge| topology.uses(edge).len() != 2) {
        for vertex in topology.edge(edge) {
            degrees[vertex as usize] += 1;
        }
    }
    let mut starts = vec![0u32; n_vertices + 1];
    for &edge in &creases {
        for vertex in topology.edge(edge) {
            degrees[vertex as usize] += 1;
            starts[vertex as usize + 1] += 1;
        }
    }
    for vertex in 0..n_vertices {
        starts[vertex + 1] += starts[vertex];
    }
    let mut next = starts.clone();
    let mut around = vec![0u32; 2 * creases.len()];
    for (k, &edge) in (0..).zip(&creases) {
        for vertex in topology.edge(edge) {
            around[next[vertex as usize] as usize] = k;
            next[vertex as usize] += 1;
        }
    }
    let mut is_loose = vec![false; creases.len()];
    let mut open: Vec<u32> = (0..n_vertices as u32)
        .filter(|&vertex| degrees[vertex as usize] == 1 && starts_at(&starts, vertex) > 0)
        .collect();
    while let Some(vertex) = open.pop() {
        let range = starts[vertex as usize] as usize..starts[vertex as usize + 1] as usize;
        let Some(&k) = around[range].iter().find(|&&k| !is_loose[k as usize]) else { continue };
        is_loose[k as usize] = true;
        for end in topology.edge(creases[k as usize]) {
            degrees[end as usize] -= 1;
            if degrees[end as usize] == 1 {
                open.push(end);
            }
        }
    }
    let n_models = scene.mesh().parts().iter().map(|part| part.model + 1).max().unwrap_or(1);
    let mut lengths = vec![[0.0; 2]; n_models as usize];
    for (&edge, &is_loose) in creases.iter().zip(&is_loose) {
        lengths[model(scene, edge)][usize::from(is_loose)] += length(scene, edge);
    }
    let share = |[closed, loose]: [f64; 2]| {
        if loose > 0.0 { loose / (closed + loose) } else { 0.0 }
    };
    let total = lengths.iter().fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]]);
    let kept = creases.iter().zip(&is_loose).filter(|(_, is_loose)| !**is_loose);
    Looseness {
        shares: lengths.into_iter().map(share).collect(),
        whole: share(total),
        closed: kept.map(|(&edge, _)| edge).collect(),
    }
}

fn starts_at(starts: &[u32], vertex: u32) -> u32 {
    starts[vertex as usize + 1] - starts[vertex as usize]
}

/// The model that an edge belongs to.
pub(super) fn model(scene: &Scene, edge: u32) -> usize {
    let mesh = scene.mesh();
    let face = scene.topology().uses(edge)[0].face();
    let part = mesh.face_parts().get(face as usize);
    part.map_or(0, |&part| mesh.parts()[part as usize].model as usize)
}
