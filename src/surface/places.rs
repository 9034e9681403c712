//! Where the lines of a lattice are: the surface's own, and those between them that make it smooth.

use super::formula::Axis;
use super::grid::{GridError, check_size, evenly};

/// The places of the lines of a lattice along both of its axes, rising or falling.
///
/// ```text
///   ●───┬───●───┬─┬─┬───●───────●     ● own lines, evenly spaced: of these some are drawn
///                                     ┬ between them: lines are drawn across these, not along them
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Places {
    along: [Vec<f64>; 2],
    /// The numbers of the surface's own lines among those.
    own: [Vec<u32>; 2],
}

impl Places {
    /// Evenly spaced lines, all of them the surface's own.
    ///
    /// # Errors
    /// Fewer than two along an axis, or too many.
    pub(super) fn evenly(ranges: [(f64, f64); 2], n: [usize; 2]) -> Result<Self, GridError> {
        check_size(n[0], n[1])?;
        let along = [0, 1].map(|axis| evenly(ranges[axis].0, ranges[axis].1, n[axis]));
        Ok(Self { along, own: n.map(|n| (0..n as u32).collect()) })
    }

    /// The same lines with others between them: `parts[axis][cell]` equal parts of each cell between two
    /// own lines, a power of two, and further places in rising order of the cell.
    #[must_use]
    pub fn divided(&self, parts: [&[u32]; 2], further: [&[f64]; 2]) -> Self {
        let mut along = [Vec::new(), Vec::new()];
        let mut own = [Vec::new(), Vec::new()];
        for axis in 0..2 {
            let places: Vec<f64> =
                self.own[axis].iter().map(|&k| self.along[axis][k as usize]).collect();
            let (first, last) = (places[0], places[places.len() - 1]);
            let n_cells = (places.len() - 1) as f64;
            for (cell, ends) in places.windows(2).enumerate() {
                own[axis].push(along[axis].len() as u32);
                along[axis].push(ends[0]);
                let n = parts[axis].get(cell).copied().unwrap_or(1);
                let part = |k: u32| cell as f64 + f64::from(k) / f64::from(n);
                let mut between: Vec<f64> =
                    (1..n).map(|k| first + (last - first) * part(k) / n_cells).collect();
                let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                between.extend(further[axis].iter().filter(|t| low < **t && **t < high));
                between.retain(|t| low < *t && *t < high);
                between.sort_unstable_by(f64::total_cmp);
                between.dedup();
                if ends[0] > ends[1] {
                    between.reverse();
                }
                along[axis].extend(between);
            }
            own[axis].push(along[axis].len() as u32);
            along[axis].push(last);
        }
        Self { along, own }
    }

    /// The same lines, the last of the first axis first.
    #[must_use]
    pub(super) fn turned(mut self) -> Self {
        self.along[0].reverse();
        self.own[0].reverse();
        let last = self.along[0].len() as u32 - 1;
        self.own[0].iter_mut().for_each(|k| *k = last - *k);
        self
    }

    /// Every place along an axis.
    pub fn along(&self, axis: Axis) -> &[f64] {
        &self.along[axis as usize]
    }

    /// The numbers of the surface's own lines among the places along an axis.
    pub fn own(&self, axis: Axis) -> &[u32] {
        &self.own[axis as usize]
    }

    /// How many lines there are along both axes.
    pub fn size(&self) -> (usize, usize) {
        (self.along[0].len(), self.along[1].len())
    }

    /// For each place along an axis whether its line is one of every `every` own lines, or the last.
    pub fn drawn(&self, axis: Axis, every: usize) -> Vec<bool> {
        let own = self.own(axis);
        let mut drawn = vec![false; self.along(axis).len()];
        for (k, &line) in own.iter().enumerate() {
            drawn[line as usize] = k.is_multiple_of(every.max(1)) || k + 1 == own.len();
        }
        drawn
    }
}
