//! Which cells of a lattice are cut into more triangles for level curves, and where.
//!
//! ```text
//!   − ────── +        A cell that a level meets is a fan about one point of its surface. Either
//!   │ ╲    ╱ │        diagonal alone would join two corners that are on one side of the level,
//!   │   ●    │        although x·y = 0 is a cross. The level curves of the four triangles meet
//!   │ ╱    ╲ │        in the saddle as those of the surface do.
//!   + ────── −
//!
//!   + ──×─── +        × lowest place of the function above a side, below the level, although both
//!   │ ╲ │  ╱ │        ends are above it. Both cells that share the side have it as a corner.
//!   │   ●    │
//! ```

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::height_function::HeightFunction;

/// The heights at which a lattice is to be cut, and the function that it was sampled from.
pub(super) struct Splitting<'a> {
    /// In rising order.
    pub(super) levels: &'a [f64],
    pub(super) function: Option<&'a HeightFunction>,
}

impl Splitting<'_> {
    /// Whether a level parts what is `low` from what is `high`; what is at the level counts as above it.
    fn parts(&self, low: f64, high: f64) -> bool {
        let first_above = self.levels.partition_point(|level| *level <= low);
        self.levels.get(first_above).is_some_and(|level| *level <= high)
    }

    /// The extremes of the function above the sides of cells, where a level passes near them, by the numbers
    /// of the sides' ends, the smaller first. O(points).
    pub(super) fn extremes(
        &self,
        n_columns: usize,
        points: &[DVec3],
    ) -> FxHashMap<[usize; 2], DVec3> {
        let mut extremes = FxHashMap::default();
        let (Some(function), false) = (self.function, self.levels.is_empty()) else {
            return extremes;
        };
        let n_rows = points.len() / n_columns.max(1);
        // Cells beside holes are not split. Beyond the border is nothing to be split.
        let can_split = |i: usize, j: usize| {
            let k = j * n_columns + i;
            let is_cell = i + 1 < n_columns && j + 1 < n_rows;
            !is_cell
                || [k, k + 1, k + n_columns, k + n_columns + 1]
                    .iter()
                    .all(|&k| points[k].is_finite())
        };
        let mut look_at = |k: usize, step: usize, at: usize, n: usize| {
            let (p, q) = (points[k], points[k + step]);
            // How heights change on the way to the side, and after it.
            let before = if at > 0 { Some(p.z - points[k - step].z) } else { None };
            let after = if at + 2 < n { Some(points[k + 2 * step].z - q.z) } else { None };
            // No smooth function goes farther beyond the ends than it rises on the way.
            let rises = [before, Some(q.z - p.z), after].into_iter().flatten();
            let most = rises.fold(0.0, |most, rise| rise.abs().max(most));
            for (is_highest, sign, end) in [(true, 1.0, p.z.max(q.z)), (false, -1.0, p.z.min(q.z))]
            {
                let is_turn = before.is_none_or(|rise| sign * rise > 0.0)
                    && after.is_none_or(|rise| sign * rise < 0.0);
                let is_met = |extreme: f64| {
                    // A level that only just misses the extreme or an end would cut off the corner of a
                    // saddle, too.
                    let height = (extreme - end).abs();
                    self.parts(end.min(extreme) - height, end.max(extreme) + height)
                };
                if is_turn
                    && is_met(end + sign * most)
                    && let Some(extreme) = function.extreme(p, q, is_highest)
                    && is_met(extreme.z)
                {
                    extremes.insert([k, k + step], extreme);
                }
            }
        };
        for k in 0..points.len() {
            let (i, j) = (k % n_columns, k / n_columns);
            if !can_split(i, j) {
                continue;
            }
            if i + 1 < n_columns && (j == 0 || can_split(i, j - 1)) {
                look_at(k, 1, i, n_columns);
            }
            if j + 1 < n_rows && (i == 0 || can_split(i - 1, j)) {
                look_at(k, n_columns, j, n_rows);
            }
        }
        extremes
    }

    /// The point about which a cell is split, given its four corners counter-clockwise, and `ring`, the
    /// corners and the extremes between them in the same order. `None` if no level meets the cell or it has a
    /// hole.
    pub(super) fn center(&self, [a, b, c, d]: [DVec3; 4], ring: &[DVec3]) -> Option<Center> {
        if self.levels.is_empty() || !ring.iter().all(|p| p.is_finite()) {
            return None;
        }
        let low = ring.iter().fold(f64::INFINITY, |low, p| low.min(p.z));
        let high = ring.iter().fold(f64::NEG_INFINITY, |high, p| high.max(p.z));
        if ring.len() == 4 && !self.parts(low, high) {
            return None;
        }
        let is_saddle = a.z.min(c.z) > b.z.max(d.z) || a.z.max(c.z) < b.z.min(d.z);
        let (u, v) = if is_saddle {
            let twist = (a.z - b.z) + (c.z - d.z);
            ((a.z - d.z) / twist, (a.z - b.z) / twist)
        } else {
            (0.5, 0.5)
        };
        let patch = (a * (1.0 - u) + b * u) * (1.0 - v) + (d * (1.0 - u) + c * u) * v;
        let is_inside = (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v);
        let patch = (patch.is_finite() && is_inside).then_some(patch);
        let Some(function) = self.function else { return patch.map(Center::Inside) };
        let start = patch.unwrap_or((a + b + c + d) / 4.0);
        if n_turns(ring) >= 4 {
            if let Some(saddle) = function.saddle(start, a, c) {
                return Some(Center::Inside(saddle));
            }
            // Without a saddle inside, what lies beyond the extreme continues from there through the cell.
            let corners = [a, b, c, d];
            if let Some(extreme) = ring.iter().position(|p| !corners.contains(p)) {
                return Some(Center::OnRing(extreme));
            }
        }
        let z = function.height(start.x, start.y);
        let center = if z.is_finite() { start.with_z(z) } else { start };
        if center.is_finite() { Some(Center::Inside(center)) } else { Some(Center::OnRing(0)) }
    }
}

/// What a cell is a fan about.
pub(super) enum Center {
    /// A point inside.
    Inside(DVec3),
    /// The point of the ring with this number.
    OnRing(usize),
}

/// How often heights turn from rising to falling, or back, on the way around: four times about a saddle.
fn n_turns(ring: &[DVec3]) -> usize {
    let n = ring.len();
    let rises = (0..n).map(|k| ring[(k + 1) % n].z - ring[k].z).filter(|rise| *rise != 0.0);
    let is_rising: Vec<bool> = rises.map(|rise| rise > 0.0).collect();
    let n = is_rising.len();
    (0..n).filter(|&k| is_rising[k] != is_rising[(k + 1) % n]).count()
}
