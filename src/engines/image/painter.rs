//! The painter: triangles from far to near, each painted over what is there.
//!
//! Source: lecture notes on visibility (Slovak), section 3, without the tests and splits that follow
//! there: triangles are ordered by their farthest point alone, as Newell, Newell and Sancha begin.
//! Good for: convex bodies, terrains of small triangles, a first look; it keeps nothing but the order.
//!
//! Cannot: triangles that cross; triangles that overlap in turn, three bars each over the next; a
//! large triangle beside or below small ones, whose farthest point says little about the rest. There
//! the picture differs from that of the other engines.

use std::cmp::Reverse;

use super::depth::Depth;
use super::raster::{Raster, RasterTriangle, Strip, columns};

/// Fills the `items` of a strip. O(triangles log triangles + pixels they cover).
pub fn solve(raster: &Raster, strip: &Strip, items: &mut [u32]) {
    let width = raster.width();
    let mut order: Vec<(Depth, Reverse<u32>)> = strip
        .triangles
        .iter()
        .map(|&number| (farthest(&raster.triangle(number)), Reverse(number)))
        .collect();
    order.sort_unstable();
    for (_, Reverse(number)) in order {
        let triangle = raster.triangle(number);
        let edges = triangle.edges();
        for row in triangle.rows(&strip.rows) {
            let start = (row - strip.rows.start) as usize * width as usize;
            let columns = columns(&edges, row, width);
            items[start + columns.start as usize..start + columns.end as usize].fill(number);
        }
    }
}

/// The depth of the farthest corner.
fn farthest(triangle: &RasterTriangle) -> Depth {
    let least = triangle.corners.map(|corner| triangle.plane.nearness_at(corner));
    Depth::of(least[0].min(least[1]).min(least[2]))
}
