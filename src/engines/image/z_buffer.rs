//! The z-buffer: every pixel keeps the depth of the nearest triangle so far.
//!
//! ```text
//!   for every triangle                        depth  0 0 3 3 3 0      5 is nearer than 3
//!     for every row, its columns a..b         item   · · A A A ·
//!       nearer than the one kept? keep it     with B 0 5 5 5 3 0  →   · B B B A ·
//! ```
//!
//! Source: lecture notes on visibility (Slovak), section 2.1, refined: the ends of each
//! triangle's span row by row, and depth by steps between them. Catmull 1974.
//! Good for: any scene; the cost hardly depends on where the triangles are. Keeps a strip of depths.
//!
//! Coherence: face coherence (depth changes evenly over a triangle).

use super::depth::Depth;
use super::raster::{Raster, RowStrip, columns};

/// Fills the `items` of a strip. O(pixels that its triangles cover).
pub fn solve(raster: &Raster, strip: &RowStrip, items: &mut [u32]) {
    let width = raster.width();
    let mut depths = vec![Depth::default(); items.len()];
    for &number in strip.triangles {
        let triangle = raster.triangle(number);
        let edges = triangle.edges();
        for row in triangle.rows(&strip.rows) {
            let columns = columns(&edges, row, width);
            let start = (row - strip.rows.start) as usize * width as usize;
            let at = start + columns.start as usize..start + columns.end as usize;
            let depth = triangle.plane.row(row);
            for ((column, kept), item) in columns.zip(&mut depths[at.clone()]).zip(&mut items[at]) {
                let depth = depth.at(column);
                // Triangles come in order of number, so at equal depths the lowest stays.
                if depth > *kept {
                    (*kept, *item) = (depth, number);
                }
            }
        }
    }
}
