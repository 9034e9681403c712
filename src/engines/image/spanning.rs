//! The spanning scan line: visibility is decided for whole spans of a row.
//!
//! ```text
//!   edges by column   A├──────────┤A            in/out flags   A: 1 1 1 0
//!                         B├──────────────┤B                   B: 0 1 1 1
//!   spans             │ 1  │  2  │   3    │     in each: what is nearest at both ends is
//!                                               nearest all along; otherwise it is divided
//!                                               where the two are equally near
//! ```
//!
//! Edge table, polygon table with the planes (the raster) and an in/out flag for each triangle.
//! Within a span each triangle's nearness is linear, so a triangle that is nearest at both ends is nearest
//! throughout. So triangles may cross, which the textbook excludes.
//!
//! Source: lecture notes on visibility (Slovak), section 2.3; German notes, "Spanning Scan Line":
//! edge table, polygon table, flags. Bouknight 1970.
//! Good for: wide pictures of few, large faces.
//!
//! Coherence: face coherence (one triangle fills a span), edge and scan-line coherence (the edge table
//! moves from row to row).

use super::NOTHING;
use super::active::EdgeTable;
use super::depth::DepthRow;
use super::raster::{Raster, RowStrip};
use std::ops::Range;

/// Fills the `items` of a strip. O(rows × (edges log edges + spans × triangles in them)).
pub fn solve(raster: &Raster, strip: &RowStrip, items: &mut [u32]) {
    let mut edges = EdgeTable::new(raster, strip);
    let mut inside: Vec<Inside> = Vec::new();
    let rows = items.chunks_exact_mut(raster.width() as usize);
    for (row, items) in strip.rows.clone().zip(rows) {
        inside.clear();
        let mut from = 0;
        for edge in edges.advance(row) {
            fill(&inside, from..edge.column, items);
            from = edge.column;
            // The flag: a triangle that is in goes out, and the other way around.
            match inside.iter().position(|inside| inside.number == edge.triangle) {
                Some(at) => {
                    inside.swap_remove(at);
                }
                None => inside.push(Inside {
                    number: edge.triangle,
                    depth: raster.triangle(edge.triangle).plane.row(row),
                }),
            }
        }
    }
}

/// A triangle whose flag says "in".
struct Inside {
    number: u32,
    depth: DepthRow,
}

/// The nearest triangle in a column, of those inside.
fn nearest(inside: &[Inside], column: u32) -> Option<&Inside> {
    // Of several equally near, the lowest number counts as nearest.
    inside.iter().max_by_key(|inside| (inside.depth.at(column), std::cmp::Reverse(inside.number)))
}

/// Shows in each of the columns what is nearest there.
fn fill(inside: &[Inside], columns: Range<u32>, items: &mut [u32]) {
    let mut waiting = vec![columns];
    while let Some(columns) = waiting.pop() {
        if columns.is_empty() {
            continue;
        }
        let last = columns.end - 1;
        let (Some(left), Some(right)) = (nearest(inside, columns.start), nearest(inside, last))
        else {
            continue;
        };
        if left.number == right.number {
            items[columns.start as usize..columns.end as usize].fill(left.number);
        } else {
            // Both parts are shorter than the whole, wherever the cut is.
            let cut = left.depth.meets(&right.depth);
            let cut = if cut.is_finite() { cut as u32 } else { (columns.start + last) / 2 };
            let cut = cut.clamp(columns.start, last - 1) + 1;
            waiting.push(columns.start..cut);
            waiting.push(cut..columns.end);
        }
    }
    debug_assert!(!inside.iter().any(|inside| inside.number == NOTHING));
}
