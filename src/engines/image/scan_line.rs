//! The scan-line z-buffer: a z-buffer one row high.
//!
//! ```text
//!   row by row: which triangles reach it?          ──A────────A──    pairs of edges, unsorted
//!     for each of them, its columns a..b              ──B───B──
//!       nearer than the one kept? keep it          depth of one row, cleared for the next
//! ```
//!
//! Source: lecture notes on visibility (Slovak), section 2.2: the loops of the z-buffer are
//! swapped; the pairs of edges are those of the scan-line z-buffer in the German notes.
//! Good for: pictures of any height with the memory of one row.
//!
//! Coherence: face coherence along a row, and scan-line coherence (triangles are kept from row to row).

use super::depth::Depth;
use super::raster::{Raster, RowStrip, columns};

/// Fills the `items` of a strip. O(triangles log triangles + pixels they cover).
pub fn solve(raster: &Raster, strip: &RowStrip, items: &mut [u32]) {
    let width = raster.width();
    let mut waiting: Vec<(u32, u32)> = strip
        .triangles
        .iter()
        .map(|&number| (raster.triangle(number).rows(&strip.rows).start, number))
        .collect();
    waiting.sort_unstable_by_key(|&entry| std::cmp::Reverse(entry));
    let mut active = Vec::new();
    let mut depths = vec![Depth::default(); width as usize];
    for (row, items) in strip.rows.clone().zip(items.chunks_exact_mut(width as usize)) {
        active.retain(|(_, _, _, end)| *end > row);
        while let Some((_, number)) = waiting.pop_if(|(first, _)| *first <= row) {
            let triangle = raster.triangle(number);
            let end = triangle.rows(&strip.rows).end;
            active.push((number, triangle.edges(), triangle.plane, end));
        }
        depths.fill(Depth::default());
        for (number, edges, plane, _) in &active {
            let depth = plane.row(row);
            for column in columns(edges, row, width) {
                let at = column as usize;
                let depth = depth.at(column);
                // They are unordered here, so numbers break ties between equal depths.
                if depth > depths[at] || depth == depths[at] && *number < items[at] {
                    (depths[at], items[at]) = (depth, *number);
                }
            }
        }
    }
}
