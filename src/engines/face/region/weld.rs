//! Borders that coincide in truth are made to coincide on the grid.
//!
//! ```text
//!   ●───────────●        ●─────●─────●      a corner of one border within a few steps of the
//!     ····●····     ──►   ╲___╱ ╲___╱       side of another becomes a corner of both; corners
//!   ●─────┘             (exaggerated)       within a few steps of each other become one
//! ```

use glam::DVec2;
use rustc_hash::FxHashMap;

use super::{RegionSide, SLIVER_STEPS};
use crate::engines::face::boxes::BoxIndex;

/// The sides, with corners moved onto each other where they are near.
pub(super) fn welded(sides: Vec<RegionSide>) -> Vec<RegionSide> {
    let mut corners: Vec<DVec2> = sides.iter().map(|side| side.from).collect();
    corners.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    corners.dedup();
    let kept = first_near(&corners);
    let find = |at: DVec2| {
        let place = corners.binary_search_by(|p| p.x.total_cmp(&at.x).then(p.y.total_cmp(&at.y)));
        place.map_or(at, |number| corners[kept[number] as usize])
    };
    let moved: Vec<RegionSide> = sides
        .into_iter()
        .map(|side| RegionSide { from: find(side.from), to: find(side.to), ..side })
        .filter(|side| side.from != side.to)
        .collect();
    let around = DVec2::splat(SLIVER_STEPS);
    let bounds =
        |side: &RegionSide| (side.from.min(side.to) - around, side.from.max(side.to) + around);
    let index = BoxIndex::new(moved.iter().map(bounds).collect());
    // The corners on each side, as part of the way along it.
    let mut on_side: Vec<(u32, f64, DVec2)> = Vec::new();
    let mut near = Vec::new();
    for (number, &corner) in (0..).zip(&corners) {
        if kept[number as usize] != number {
            continue;
        }
        index.overlapping((corner - 1.0, corner + 1.0), &mut near);
        for &side in &near {
            let RegionSide { from, to, .. } = moved[side as usize];
            let (way, past) = (to - from, corner - from);
            let part = past.dot(way) / way.length_squared();
            let inside = corner != from && corner != to && part > 0.0 && part < 1.0;
            if inside && past.distance(way * part) <= SLIVER_STEPS {
                on_side.push((side, part, corner));
            }
        }
    }
    on_side.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut result = Vec::with_capacity(moved.len() + on_side.len());
    let mut next = on_side.into_iter().peekable();
    for (number, side) in (0..).zip(moved) {
        let mut from = side.from;
        while let Some((_, _, corner)) = next.next_if(|(side, _, _)| *side == number) {
            result.push(RegionSide { from, to: corner, ..side });
            from = corner;
        }
        result.push(RegionSide { from, ..side });
    }
    result
}

/// For each corner, in order, the first one within a few steps of it that stays in place, or else itself.
/// Only a few corners that stay fit into a cell of that size. O(n).
fn first_near(corners: &[DVec2]) -> Vec<u32> {
    let cell = |at: DVec2| (at / SLIVER_STEPS).floor().to_array().map(|x| x as i64);
    let mut staying: FxHashMap<[i64; 2], Vec<u32>> = FxHashMap::default();
    let mut kept: Vec<u32> = Vec::with_capacity(corners.len());
    for (number, &corner) in (0..).zip(corners) {
        let own = cell(corner);
        let around = (-1..=1).flat_map(|x| (-1..=1).map(move |y| [own[0] + x, own[1] + y]));
        let near = around
            .filter_map(|cell| staying.get(&cell))
            .flatten()
            .filter(|&&k| corner.distance(corners[k as usize]) <= SLIVER_STEPS)
            .min();
        let first = near.copied().unwrap_or(number);
        if first == number {
            staying.entry(own).or_default().push(number);
        }
        kept.push(first);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corners on a small lattice, many of them equal.
    #[test]
    fn corners_become_the_first_one_near_them_that_stays() {
        let step = SLIVER_STEPS / 3.0;
        let mut corners: Vec<DVec2> = (0..400u32)
            .map(|k| DVec2::new(f64::from(k * k % 7), f64::from(k * 31 % 173)) * step)
            .collect();
        corners.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        corners.dedup();
        let mut expected: Vec<usize> = Vec::new();
        for (number, corner) in corners.iter().enumerate() {
            let is_near =
                |&k: &usize| expected[k] == k && corner.distance(corners[k]) <= SLIVER_STEPS;
            let first = (0..number).find(is_near).unwrap_or(number);
            expected.push(first);
        }
        let found: Vec<usize> = first_near(&corners).into_iter().map(|k| k as usize).collect();
        assert_eq!(found, expected);
        assert!(expected.iter().zip(0..).any(|(&first, k)| first != k));
    }
}
