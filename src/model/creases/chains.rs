//! Creases of organic models: chains of bent edges that are long and strong enough on paper.

use rayon::prelude::*;

use crate::camera::{Camera, Projection};
use crate::links::{FREE, for_each_trail};
use crate::model::scene::Scene;

use super::looseness::model;
use super::narrow::{NarrowFold, folds};
use super::surroundings::bend_nearby;
use super::{CreaseAngle, SHARP_DEG, along, angle, length, looseness};

/// Edges that turn more than this, in degrees, do not continue into each other.
const MAX_TURN_DEG: f64 = 45.0;

/// In organic models, chains shorter than this on paper are left out, in millimeters.
const SHORTEST_MM: f64 = 3.0;

/// In organic models, chains weaker than this are left out, in degrees above half the crease angle times
/// millimeters, for each degree of the crease angle.
const STRENGTH_MM: f64 = 10.0 / 3.0;

/// How much of the surroundings' bend is subtracted from an edge's angle.
const SURROUNDINGS: f64 = 0.7;

/// Angles below [`SHARP_DEG`] by this many degrees and more feel the surroundings in full.
const SHARP_RAMP_DEG: f64 = 15.0;

/// The creases of a scene that depend on the scale: of organic models, and of narrow folds.
#[derive(Debug, Clone, PartialEq)]
pub struct CreaseChains {
    crease_deg: f64,
    /// Edges that are creases in every view.
    certain: Vec<u32>,
    links: Vec<ChainLink>,
    chains: Vec<ChainEnd>,
    /// Edges that are no creases where the pen is wider than twice their distance.
    narrow: Vec<NarrowFold>,
}

/// An edge of a chain.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ChainLink {
    edge: u32,
    length: f64,
    /// Degrees above the lower threshold.
    excess_deg: f64,
}

/// Where a chain ends in the list of links, and what it takes for it to be drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ChainEnd {
    end: u32,
    shortest_mm: f64,
    strength: f64,
}

impl CreaseChains {
    /// The creases of a scene; `None` if they are the same at every scale: all edges above the crease angle.
    /// O(edges log edges).
    pub fn of_scene(scene: &Scene, crease_deg: f64) -> Option<Self> {
        if !looseness(scene).is_constructed() {
            return Some(Self::new(scene, crease_deg));
        }
        let threshold = CreaseAngle::from_degrees(crease_deg);
        let edges =
            || (0..scene.topology().edges().len() as u32).into_par_iter().with_min_len(4096);
        let narrow = folds(scene, threshold, edges());
        if narrow.is_empty() {
            return None;
        }
        let certain = edges().filter(|&edge| threshold.is_exceeded(scene, edge)).collect();
        Some(Self { crease_deg, certain, links: Vec::new(), chains: Vec::new(), narrow })
    }

    /// Finds the chains. O(edges log edges).
    pub fn new(scene: &Scene, crease_deg: f64) -> Self {
        let looseness = looseness(scene);
        let threshold = CreaseAngle::from_degrees(crease_deg);
        let sharp = CreaseAngle::from_degrees(SHARP_DEG);
        let lows: Vec<LowThreshold> = looseness
            .of_models()
            .map(|grown| {
                let degrees = crease_deg * (1.0 - 0.5 * grown);
                LowThreshold { grown, degrees, angle: CreaseAngle::from_degrees(degrees) }
            })
            .collect();
        let n_edges = scene.topology().edges().len() as u32;
        let edges = || (0..n_edges).into_par_iter().with_min_len(4096);
        let is_certain = |&edge: &u32| {
            let grown = lows[model(scene, edge)].grown;
            let is_certain = grown == 0.0
                || grown < 1.0 && sharp.is_exceeded(scene, edge) && looseness.is_closed(edge);
            is_certain && threshold.is_exceeded(scene, edge)
        };
        let candidate = |edge: u32| {
            let low = &lows[model(scene, edge)];
            (low.grown > 0.0 && low.angle.is_exceeded(scene, edge)).then(|| ChainLink {
                edge,
                length: length(scene, edge),
                excess_deg: excess_deg(scene, edge, low),
            })
        };
        let certain: Vec<u32> = edges().filter(is_certain).collect();
        let candidates: Vec<ChainLink> = edges().filter_map(candidate).collect();
        let narrow = folds(scene, threshold, certain.par_iter().copied());
        let (links, chains) = (Vec::new(), Vec::new());
        let mut found = Self { crease_deg, certain, links, chains, narrow };
        for_each_trail(&straightest(scene, &candidates), |trail| {
            let links = trail.iter().map(|&end| candidates[end as usize / 2]);
            if !links.clone().any(|link| threshold.is_exceeded(scene, link.edge)) {
                return;
            }
            let grown = lows[model(scene, candidates[trail[0] as usize / 2].edge)].grown;
            found.links.extend(links);
            found.chains.push(ChainEnd {
                end: found.links.len() as u32,
                shortest_mm: SHORTEST_MM * grown,
                strength: STRENGTH_MM * crease_deg * grown,
            });
        });
        found
    }

    /// The crease angle that the chains were made for, in degrees.
    pub fn crease_deg(&self) -> f64 {
        self.crease_deg
    }

    /// For each edge whether it is a crease of a view at `mm_per_unit`, the millimeters on paper of an
    /// image unit, for a pen. O(edges).
    ///
    /// Chains are measured whole, with what is hidden of them, so that views of a turntable agree.
    pub fn of_view(
        &self,
        scene: &Scene,
        camera: &Camera,
        mm_per_unit: f64,
        pen_width_mm: f64,
    ) -> Vec<bool> {
        let mut is_crease = vec![false; scene.topology().edges().len()];
        self.certain.iter().for_each(|&edge| is_crease[edge as usize] = true);
        let positions = scene.mesh().positions();
        let (eye, forward) = (camera.eye(), camera.frame().forward);
        // A length at an edge, in millimeters on paper.
        let mm = |edge: u32, length: f64| match camera.projection() {
            Projection::Orthographic => mm_per_unit * length,
            Projection::Perspective { near, .. } => {
                let [a, b] = scene.topology().edge(edge).map(|v| positions[v as usize]);
                let depth = (0.5 * (a + b) - eye).dot(forward);
                mm_per_unit * length / depth.max(near * camera.forward().length())
            }
        };
        let mut start = 0;
        for chain in &self.chains {
            let links = &self.links[start..chain.end as usize];
            start = chain.end as usize;
            let (mut length_mm, mut strength) = (0.0, 0.0);
            for link in links {
                let mm = mm(link.edge, link.length);
                length_mm += mm;
                strength += link.excess_deg * mm;
            }
            if length_mm >= chain.shortest_mm && strength >= chain.strength {
                links.iter().for_each(|link| is_crease[link.edge as usize] = true);
            }
        }
        for fold in &self.narrow {
            if mm(fold.edge, fold.distance) <= 0.5 * pen_width_mm {
                is_crease[fold.edge as usize] = false;
            }
        }
        is_crease
    }
}

/// The angle above which edges of a model may be part of a chain.
struct LowThreshold {
    /// How organic the model is.
    grown: f64,
    degrees: f64,
    angle: CreaseAngle,
}

/// How far an edge is bent beyond the lower threshold, less what its surroundings are bent.
fn excess_deg(scene: &Scene, edge: u32, low: &LowThreshold) -> f64 {
    let angle_deg = angle(scene, edge).to_degrees();
    let share = ((SHARP_DEG - angle_deg) / SHARP_RAMP_DEG).clamp(0.0, 1.0);
    let nearby_deg = if share > 0.0 { bend_nearby(scene, edge).to_degrees() } else { 0.0 };
    let excess_deg = angle_deg - SURROUNDINGS * low.grown * share * nearby_deg;
    (excess_deg - low.degrees).max(-low.degrees)
}

/// For each end of each candidate, numbered `2 · candidate + side`, the end it continues into: at each
/// vertex the straightest first.
fn straightest(scene: &Scene, candidates: &[ChainLink]) -> Vec<u32> {
    let cos_turn = libm::cos(MAX_TURN_DEG.to_radians());
    let mut ends: Vec<(u32, u32)> = (0..2 * candidates.len() as u32)
        .map(|end| {
            let edge = candidates[end as usize / 2].edge;
            (scene.topology().edge(edge)[end as usize % 2], end)
        })
        .collect();
    ends.par_sort_unstable();
    // Away from the vertex.
    let direction = |end: u32| {
        let along = along(scene, candidates[end as usize / 2].edge).normalize_or_zero();
        if end.is_multiple_of(2) { along } else { -along }
    };
    let mut links = vec![FREE; ends.len()];
    let mut pairs: Vec<(f64, u32, u32)> = Vec::new();
    for group in ends.chunk_by(|a, b| a.0 == b.0) {
        pairs.clear();
        for (i, &(_, a)) in group.iter().enumerate() {
            let others = group[i + 1..].iter().take(MAX_OTHERS);
            let straight = others.map(|&(_, b)| (direction(a).dot(direction(b)), a, b));
            pairs.extend(straight.filter(|pair| pair.0 <= -cos_turn));
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        for &(_, a, b) in &pairs {
            if links[a as usize] == FREE && links[b as usize] == FREE {
                (links[a as usize], links[b as usize]) = (b, a);
            }
        }
    }
    links
}

/// Most others that an end is compared with, so that a hub of very many edges costs no square.
const MAX_OTHERS: usize = 64;
