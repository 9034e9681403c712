//! Which boxes of the image overlap: a grid of cells that lists them.

use glam::DVec2;

/// Cells along each side, at most.
const MOST_CELLS: usize = 256;

/// Boxes by the cells of the image that they reach.
pub(crate) struct BoxIndex {
    low: DVec2,
    cell: DVec2,
    n: usize,
    cells: Vec<Vec<u32>>,
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
        let mut index = Self { low, cell, n, cells, boxes };
        for number in 0..index.boxes.len() {
            for cell in index.reached(index.boxes[number]) {
                index.cells[cell].push(number as u32);
            }
        }
        index
    }

    fn reached(&self, (low, high): (DVec2, DVec2)) -> impl Iterator<Item = usize> + use<> {
        let n = self.n;
        let cell = |at: f64| (at.max(0.0) as usize).min(n - 1);
        let (from, to) = ((low - self.low) / self.cell, (high - self.low) / self.cell);
        let (xs, ys) = (cell(from.x)..=cell(to.x), cell(from.y)..=cell(to.y));
        ys.flat_map(move |y| xs.clone().map(move |x| y * n + x))
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

    /// The boxes that have more than a border in common with a box, in order.
    pub(crate) fn overlapping(&self, bounds: (DVec2, DVec2), found: &mut Vec<u32>) {
        found.clear();
        for cell in self.reached(bounds) {
            found.extend(self.cells[cell].iter().filter(|&&other| {
                let (low, high) = self.boxes[other as usize];
                low.cmplt(bounds.1).all() && bounds.0.cmplt(high).all()
            }));
        }
        found.sort_unstable();
        found.dedup();
    }
}
