//! Which boxes of the image overlap: a grid of cells that lists them.

use std::ops::Range;

use glam::DVec2;

/// The most cells along each side.
const MOST_CELLS: usize = 256;

/// Boxes that reach more cells than this many rows of the grid have are listed separately: they are large
/// in both directions. Long thin ones are not.
const MOST_ROWS: usize = 4;

/// Boxes by the cells of the image that they reach.
pub(crate) struct BoxIndex {
    low: DVec2,
    cell: DVec2,
    n: usize,
    cells: Vec<Vec<u32>>,
    /// Boxes that are listed in no cell, since they reach too many.
    large: Vec<u32>,
    boxes: Vec<(DVec2, DVec2)>,
}

impl BoxIndex {
    /// Boxes as (lowest, highest) corner. O(boxes + cells they reach).
    pub(crate) fn new(boxes: Vec<(DVec2, DVec2)>) -> Self {
        let (low, high) = boxes
            .iter()
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), b| (l.min(b.0), h.max(b.1)));
        let n = ((boxes.len() as f64).sqrt() as usize).clamp(1, MOST_CELLS);
        let size = if boxes.is_empty() { DVec2::ONE } else { high - low };
        let cell = size / n as f64 + 1.0;
        let cells = vec![Vec::new(); n * n];
        let mut index = Self { low, cell, n, cells, large: Vec::new(), boxes };
        for number in 0..index.boxes.len() {
            let (xs, ys) = index.reached(index.boxes[number]);
            if xs.len() * ys.len() > MOST_ROWS * n {
                index.large.push(number as u32);
                continue;
            }
            for cell in ys.flat_map(|y| xs.clone().map(move |x| y * n + x)) {
                index.cells[cell].push(number as u32);
            }
        }
        index
    }

    /// The columns and rows of cells that a box reaches.
    fn reached(&self, (low, high): (DVec2, DVec2)) -> (Range<usize>, Range<usize>) {
        let cell = |at: f64| (at.max(0.0) as usize).min(self.n - 1);
        let (from, to) = ((low - self.low) / self.cell, (high - self.low) / self.cell);
        (cell(from.x)..cell(to.x) + 1, cell(from.y)..cell(to.y) + 1)
    }

    /// Whether more than `most` pairs of boxes overlap. O(boxes + pairs up to that).
    pub(crate) fn has_more_pairs(&self, most: u64) -> bool {
        let (mut found, mut n_twice) = (Vec::new(), 0u64);
        self.boxes.iter().any(|&bounds| {
            self.overlapping(bounds, &mut found);
            // A box overlaps itself, unless it has no width.
            n_twice += (found.len() as u64).saturating_sub(1);
            n_twice > 2 * most
        })
    }

    /// The boxes that share more than a border with a box, in order.
    pub(crate) fn overlapping(&self, bounds: (DVec2, DVec2), found: &mut Vec<u32>) {
        found.clear();
        let overlaps = |&other: &u32| {
            let (low, high) = self.boxes[other as usize];
            low.cmplt(bounds.1).all() && bounds.0.cmplt(high).all()
        };
        let (xs, ys) = self.reached(bounds);
        if xs.len() * ys.len() > MOST_ROWS * self.n {
            found.extend((0..self.boxes.len() as u32).filter(overlaps));
            return;
        }
        found.extend(self.large.iter().copied().filter(overlaps));
        for cell in ys.flat_map(|y| xs.clone().map(move |x| y * self.n + x)) {
            found.extend(self.cells[cell].iter().copied().filter(overlaps));
        }
        found.sort_unstable();
        found.dedup();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_and_large_boxes_are_found_by_both() {
        let at = |k: u32| DVec2::new(f64::from(k * 7 % 101), f64::from(k * 13 % 97));
        let size = |k: u32| if k.is_multiple_of(9) { 60.0 } else { 2.0 };
        let boxes: Vec<(DVec2, DVec2)> = (0..2000).map(|k| (at(k), at(k) + size(k))).collect();
        let index = BoxIndex::new(boxes.clone());
        assert!(!index.large.is_empty() && index.large.len() < boxes.len());
        let overlap =
            |a: (DVec2, DVec2), b: (DVec2, DVec2)| a.0.cmplt(b.1).all() && b.0.cmplt(a.1).all();
        let (mut found, mut n_pairs) = (Vec::new(), 0);
        for (number, &bounds) in boxes.iter().enumerate() {
            index.overlapping(bounds, &mut found);
            let all = (0..boxes.len() as u32).filter(|&k| overlap(bounds, boxes[k as usize]));
            assert_eq!(found, all.collect::<Vec<_>>(), "{number}");
            n_pairs += found.len() as u64 - 1;
        }
        assert!(index.has_more_pairs(n_pairs / 2 - 1) && !index.has_more_pairs(n_pairs / 2));
    }
}
