//! Level curves as polylines, for drawing them elsewhere than on the surface.

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::lined_mesh::LinedMesh;
use crate::strokes::{StrokeKind, SurfacePart};

/// A level curve, or a part of one that ends where others begin.
#[derive(Debug, Clone, PartialEq)]
pub struct LevelCurve {
    /// Its sheet and level.
    pub part: SurfacePart,
    /// Two points or more; a closed curve ends at its first point.
    pub points: Vec<DVec3>,
}

impl LinedMesh {
    /// The level curves that were added. O(lines).
    pub fn level_curves(&self) -> Vec<LevelCurve> {
        let is_level = |kind| matches!(kind, StrokeKind::Level | StrokeKind::Index);
        let lines: Vec<_> = self.lines.iter().filter(|line| is_level(line.kind)).collect();
        // Lines by the ends that they share with others of the same curve.
        let mut at: FxHashMap<(SurfacePart, u32), Vec<usize>> = FxHashMap::default();
        for (k, line) in lines.iter().enumerate() {
            for end in line.ends {
                at.entry((line.part, end)).or_default().push(k);
            }
        }
        let mut is_used = vec![false; lines.len()];
        let mut curves = Vec::new();
        let walk = |first: usize, from: u32, is_used: &mut [bool]| {
            let part = lines[first].part;
            let mut points = vec![self.positions[from as usize]];
            let (mut line, mut end) = (first, from);
            loop {
                is_used[line] = true;
                let [a, b] = lines[line].ends;
                end = if a == end { b } else { a };
                points.push(self.positions[end as usize]);
                let here = &at[&(part, end)];
                let next = here.iter().find(|k| here.len() == 2 && !is_used[**k]);
                let Some(next) = next else { break };
                line = *next;
            }
            LevelCurve { part, points }
        };
        // Curves with ends first: what is left then goes around.
        for (k, line) in lines.iter().enumerate() {
            let start = line.ends.into_iter().find(|end| at[&(line.part, *end)].len() != 2);
            if let (false, Some(start)) = (is_used[k], start) {
                curves.push(walk(k, start, &mut is_used));
            }
        }
        for (k, line) in lines.iter().enumerate() {
            if !is_used[k] {
                curves.push(walk(k, line.ends[0], &mut is_used));
            }
        }
        curves
    }
}
