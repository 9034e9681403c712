//! Square cells of the image, for finding what is near.

use glam::DVec2;

use crate::extent::window::Window;

/// Most cells.
pub(super) const MAX_CELLS: f64 = (1 << 22) as f64;

/// By how much more than asked cells are searched, as a fraction of a cell: far more than the rounding of
/// the way to a cell. It costs time only.
const CELL_SLACK: f64 = 1e-6;

/// A box of the image, cut into square cells.
pub(super) struct Cells {
    low: DVec2,
    high: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
}

impl Cells {
    /// Cells of at least `cell`, not many more than `max_cells` of them.
    pub(super) fn new((low, high): (DVec2, DVec2), cell: f64, max_cells: f64) -> Self {
        let size = high - low;
        let cell = cell
            .max((size.x * size.y / max_cells).sqrt())
            .max(size.max_element() / max_cells)
            .max(f64::MIN_POSITIVE);
        let [columns, rows] = [size.x, size.y].map(|length| (length / cell) as usize + 1);
        Self { low, high, cell, columns, rows }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.columns * self.rows
    }

    /// Calls `visit` with the cells within `margin` of a segment, and with some others. What is farther
    /// than that from the box has none.
    pub(super) fn near(&self, a: DVec2, b: DVec2, margin: f64, mut visit: impl FnMut(usize)) {
        let wide = Window { low: self.low - margin, high: self.high + margin, slack: 0.0 };
        let Some((t0, t1)) = wide.part_inside(a, b) else { return };
        let (a, b) = (a.lerp(b, t0), a.lerp(b, t1));
        let margin = margin + CELL_SLACK * self.cell;
        let (bottom, top) = if a.y <= b.y { (a, b) } else { (b, a) };
        let row = |y: f64| (((y - self.low.y) / self.cell) as usize).min(self.rows - 1);
        let column = |x: f64| (((x - self.low.x) / self.cell) as usize).min(self.columns - 1);
        let (left, right) = (a.x.min(b.x), a.x.max(b.x));
        let (first, last) = (row(bottom.y - margin), row(top.y + margin));
        if first == last {
            (column(left - margin)..=column(right + margin))
                .for_each(|c| visit(first * self.columns + c));
            return;
        }
        let slope = (top.x - bottom.x) / (top.y - bottom.y);
        for r in first..=last {
            let y = self.low.y + r as f64 * self.cell;
            let at = |y: f64| bottom.x + (y - bottom.y) * slope;
            let (x0, x1) = (at(y - margin), at(y + self.cell + margin));
            // A level segment has no slope: then its whole width counts.
            let (x0, x1) = if x0.is_finite() && x1.is_finite() {
                (x0.min(x1).clamp(left, right), x0.max(x1).clamp(left, right))
            } else {
                (left, right)
            };
            for c in column(x0 - margin)..=column(x1 + margin) {
                visit(r * self.columns + c);
            }
        }
    }
}
