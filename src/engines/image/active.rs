//! The edges that a row meets, kept from row to row.
//!
//! ```text
//!   S, by first row:   [e1 e4] [ ] [e2] [e3 e5] …      added when their row comes
//!   A, by column:      e4 e1 e2                        removed after their last row
//! ```
//!
//! From row to row an edge moves by its slope (edge and scan-line coherence); the column is then corrected
//! exactly, so rounding of the steps does not matter.

use std::ops::Range;

use super::edge::PixelEdge;
use super::raster::{Raster, RowStrip};

/// An edge and where it meets the row.
#[derive(Debug, Clone, Copy)]
pub(super) struct ActiveEdge {
    edge: PixelEdge,
    /// Number in the raster of the triangle that it borders.
    pub(super) triangle: u32,
    /// The row after its last one.
    end: u32,
    x: f64,
    /// The first column on its right.
    pub(super) column: u32,
}

/// All edges of a strip, and those that the row meets.
pub(super) struct EdgeTable {
    /// In reverse order of their first rows.
    waiting: Vec<(u32, ActiveEdge)>,
    active: Vec<ActiveEdge>,
    width: u32,
}

impl EdgeTable {
    /// The edges that the rows of a strip meet. O(edges log edges).
    pub(super) fn new(raster: &Raster, strip: &RowStrip) -> Self {
        let mut waiting = Vec::with_capacity(strip.triangles.len() * 2);
        for &triangle in strip.triangles {
            for edge in raster.triangle(triangle).edges().into_iter().flatten() {
                let rows: Range<u32> = edge.rows(&strip.rows);
                if !rows.is_empty() {
                    let x = edge.estimate(rows.start);
                    let edge = ActiveEdge { edge, triangle, end: rows.end, x, column: 0 };
                    waiting.push((rows.start, edge));
                }
            }
        }
        waiting.sort_by_key(|(row, edge)| std::cmp::Reverse((*row, edge.triangle)));
        Self { waiting, active: Vec::new(), width: raster.width() }
    }

    /// The edges that a row meets, from left to right. Rows must be requested in their order.
    pub(super) fn advance(&mut self, row: u32) -> &[ActiveEdge] {
        self.active.retain_mut(|active| {
            active.x += active.edge.slope();
            active.end > row
        });
        while let Some((_, edge)) = self.waiting.pop_if(|(first, _)| *first <= row) {
            self.active.push(edge);
        }
        for active in &mut self.active {
            active.column = active.edge.column_near(row, active.x, self.width);
        }
        // Nearly sorted already, which this sort exploits.
        self.active.sort_by_key(|active| (active.column, active.triangle));
        &self.active
    }
}
