//! Watkins' algorithm: each row from edge to edge, with the triangles in order of depth.
//!
//! ```text
//!   S   all edges of the strip, by first row
//!   A   edges that meet this row, by column      A┤    C┤   ┊    A├   C├
//!   H   triangles inside, nearest first           A   A C  C A    C    ·
//!                                                          ┊
//!            the artificial edge, where C and A swap places in H
//! ```
//!
//! At each edge its triangle enters or leaves H; the first of H is seen up to the next edge. If another
//! triangle would overtake the first of H before that edge, the faces cross there: an artificial edge is
//! placed in that column, and the row continues from it. So no pixel is written twice.
//!
//! Source: lecture slides on Watkins' algorithm (Czech), steps 1–6 and "intersection of two faces".
//! Deviation: back faces are kept, since an open sheet may show its back. Watkins 1970.
//! Good for: pictures that are written row by row, and costly shading: each pixel is shaded once.
//!
//! Coherence: face coherence (one triangle fills the columns up to the next edge), edge and scan-line
//! coherence (the edge table moves from row to row), depth coherence (H stays nearly sorted).

use std::cmp::Reverse;

use super::active::EdgeTable;
use super::depth::{Depth, DepthRow};
use super::raster::{Raster, RowStrip};

/// Fills the `items` of a strip. O(rows × edges met × triangles in H).
pub fn solve(raster: &Raster, strip: &RowStrip, items: &mut [u32]) {
    let mut edges = EdgeTable::new(raster, strip);
    let mut in_front: Vec<Entry> = Vec::new();
    for (row, items) in strip.rows.clone().zip(items.chunks_exact_mut(raster.width() as usize)) {
        in_front.clear();
        let mut column = 0;
        for edge in edges.advance(row) {
            run(&mut in_front, column, edge.column, items);
            column = edge.column;
            match in_front.iter().position(|entry| entry.number == edge.triangle) {
                Some(at) => {
                    in_front.remove(at);
                }
                None => {
                    let depth = raster.triangle(edge.triangle).plane.row(row);
                    in_front.push(Entry { number: edge.triangle, depth });
                }
            }
        }
    }
}

/// A triangle in H.
struct Entry {
    number: u32,
    depth: DepthRow,
}

impl Entry {
    /// Sorts the nearest first, at equal depths the lowest number.
    fn order(&self, column: u32) -> (Reverse<Depth>, u32) {
        (Reverse(self.depth.at(column)), self.number)
    }
}

/// Shows the first of H from one edge to the next, which may be artificial.
fn run(in_front: &mut [Entry], from: u32, to: u32, items: &mut [u32]) {
    let mut column = from;
    while column < to {
        // Nearly in order already.
        in_front.sort_by_key(|entry| entry.order(column));
        let Some((first, others)) = in_front.split_first() else { return };
        let end = others
            .iter()
            .filter_map(|other| overtakes(first, other, column, to))
            .min()
            .unwrap_or(to);
        items[column as usize..end as usize].fill(first.number);
        column = end;
    }
}

/// The column of the artificial edge, after `from` and before `to`, from which on `other` is before
/// `first`.
fn overtakes(first: &Entry, other: &Entry, from: u32, to: u32) -> Option<u32> {
    let is_before = |column: u32| other.order(column) < first.order(column);
    // Nearness is linear, so a triangle that is not in front at the end never was.
    if !is_before(to - 1) {
        return None;
    }
    let (mut behind, mut before) = (from, to - 1);
    while before - behind > 1 {
        let middle = behind + (before - behind) / 2;
        if is_before(middle) {
            before = middle;
        } else {
            behind = middle;
        }
    }
    Some(before)
}
