//! The grids of the pyramid: how fine each is, and how many there are.

use glam::DVec2;

use crate::engines::edge::rounding::Rounding;
use crate::engines::edge::segment::Segment;

/// Images further out than this, as the tangent of the angle off the axis, share the border cells.
const WIDEST_TANGENT: f64 = 8.0;

/// Triangles, or segments where there are more of these, for each cell of the finest level. Fewer make more cells to visit and more entries,
/// more make longer lists in each; between 1 and 16 the work differs by a tenth.
const TRIANGLES_PER_CELL: f64 = 4.0;

/// Bounds of the number of cells of the finest level.
const FINEST_CELLS: (f64, f64) = (16.0, (1 << 21) as f64);

/// One grid: `columns × rows` cells from the index's origin.
#[derive(Debug, Clone, Copy)]
pub(super) struct Level {
    pub(super) cell: f64,
    /// 1 / `cell`.
    pub(super) inverse: f64,
    pub(super) columns: u32,
    pub(super) rows: u32,
    /// Number of the first cell among those of all levels.
    pub(super) first: u32,
    /// Whether any triangle lies in this level.
    pub(super) used: bool,
}

/// The origin and the levels for the box of all segments.
pub(super) fn levels<'s>(
    rounding: &Rounding,
    segments: impl Iterator<Item = &'s Segment>,
    n_items: usize,
) -> (DVec2, Vec<Level>) {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for segment in segments {
        let bounds = rounding.bounds(segment.image, segment.depth);
        low = low.min(bounds.low);
        high = high.max(bounds.high);
    }
    if rounding.is_unbounded() {
        let widest = DVec2::splat(WIDEST_TANGENT);
        (low, high) = (low.clamp(-widest, widest), high.clamp(-widest, widest));
    }
    let size = high - low;
    if !(size.is_finite() && size.max_element() > 0.0) {
        return (
            DVec2::ZERO,
            vec![Level { cell: 1.0, inverse: 1.0, columns: 1, rows: 1, first: 0, used: false }],
        );
    }
    let n_cells = (n_items as f64 / TRIANGLES_PER_CELL).clamp(FINEST_CELLS.0, FINEST_CELLS.1);
    // A flat image gets cells as long as its longer side calls for.
    let cell = (size.x * size.y / n_cells).sqrt().max(size.max_element() / n_cells);
    let mut level = Level {
        cell,
        inverse: 1.0 / cell,
        columns: (size.x / cell) as u32 + 1,
        rows: (size.y / cell) as u32 + 1,
        first: 0,
        used: false,
    };
    let mut levels = vec![level];
    while level.columns > 1 || level.rows > 1 {
        level = Level {
            cell: level.cell * 2.0,
            inverse: level.inverse * 0.5,
            columns: level.columns.div_ceil(2),
            rows: level.rows.div_ceil(2),
            first: level.first + level.columns * level.rows,
            used: false,
        };
        levels.push(level);
    }
    (low, levels)
}
