//! Ray casting: one ray through each pixel's center, against a tree of boxes.
//!
//! ```text
//!            ┌────────┐            boxes of columns, rows and depth; of two halves
//!   ray ·····┤┌──┐    │            the nearer one first, skipping boxes that
//!            ││  │ ┌─┐│            begin behind the nearest hit so far
//!            └┴──┴─┴─┴┘
//! ```
//!
//! In image space all rays are parallel, along the depth. Each triangle that a ray may hit is tested
//! separately, edge by edge, for whether it covers the center. So this engine shares the rule with the
//! others, but nothing that they carry from pixel to pixel.
//!
//! Source: lecture notes on visibility (Slovak), section 2.4: a z-buffer with tiles of one
//! pixel. The tree halves the triangles by the centers of their boxes (Kay, Kajiya 1986).
//! Good for: checking the others; single pixels.
//!
//! Coherence: object coherence (boxes stand for triangles); none from pixel to pixel.

use glam::DVec2;

use super::depth::Depth;
use super::edge::center;
use super::raster::{Raster, RasterTriangle, RowStrip};

/// Triangles in a leaf of the tree.
const LEAF: usize = 4;

/// Fills the `items` of a strip. O(triangles log triangles + pixels × boxes met).
pub fn solve(raster: &Raster, strip: &RowStrip, items: &mut [u32]) {
    let tree = RayTree::new(strip.triangles.iter().map(|&n| (n, raster.triangle(n))).collect());
    for (row, items) in strip.rows.clone().zip(items.chunks_exact_mut(raster.width() as usize)) {
        for (column, item) in (0..).zip(items) {
            if let Some(number) = tree.nearest(column, row) {
                *item = number;
            }
        }
    }
}

/// A box around triangles.
#[derive(Clone, Copy)]
struct RayNode {
    low: DVec2,
    high: DVec2,
    nearest: Depth,
    /// The triangles in it.
    from: u32,
    to: u32,
    /// The node of the second half; the first half follows this node. 0 for a leaf.
    second: u32,
}

struct RayTree {
    /// With their numbers in the raster.
    triangles: Vec<(u32, RasterTriangle)>,
    nodes: Vec<RayNode>,
}

impl RayTree {
    fn new(triangles: Vec<(u32, RasterTriangle)>) -> Self {
        let mut tree = Self { triangles, nodes: Vec::new() };
        let n = tree.triangles.len();
        if n > 0 {
            tree.build(0, n);
        }
        tree
    }

    /// The node of some of the triangles, and of its halves.
    fn build(&mut self, from: usize, to: usize) -> u32 {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let mut nearest = Depth::default();
        for (_, triangle) in &self.triangles[from..to] {
            let (own_low, own_high) = bounds(triangle);
            (low, high) = (low.min(own_low), high.max(own_high));
            let corners = triangle.corners.map(|corner| triangle.plane.nearness_at(corner));
            let largest = corners[0].max(corners[1]).max(corners[2]);
            // Inside, rounding may make it slightly nearer than at the corners.
            nearest = nearest.max(Depth::of(largest).next_nearer());
        }
        let own = self.nodes.len();
        let (start, end) = (from as u32, to as u32);
        self.nodes.push(RayNode { low, high, nearest, from: start, to: end, second: 0 });
        if to - from > LEAF {
            let size = high - low;
            let middle = |(_, triangle): &(u32, RasterTriangle)| {
                let (low, high) = bounds(triangle);
                if size.x > size.y { low.x + high.x } else { low.y + high.y }
            };
            let half = (to - from) / 2;
            self.triangles[from..to]
                .select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
            self.build(from, from + half);
            self.nodes[own].second = self.build(from + half, to);
        }
        own as u32
    }

    /// The triangle that a ray hits first.
    fn nearest(&self, column: u32, row: u32) -> Option<u32> {
        let point = DVec2::new(center(column), center(row));
        let mut best: Option<(Depth, u32)> = None;
        let mut waiting = vec![0];
        while let Some(at) = waiting.pop() {
            let Some(node) = self.nodes.get(at as usize) else { continue };
            let is_behind = best.is_some_and(|(depth, _)| node.nearest < depth);
            if is_behind || !(node.low.cmple(point).all() && node.high.cmpge(point).all()) {
                continue;
            }
            if node.second != 0 {
                let halves = [at + 1, node.second];
                let nearness = halves.map(|half| self.nodes[half as usize].nearest);
                let first = usize::from(nearness[1] > nearness[0]);
                waiting.extend([halves[1 - first], halves[first]]);
                continue;
            }
            for (number, triangle) in &self.triangles[node.from as usize..node.to as usize] {
                if !covers(triangle, column, row) {
                    continue;
                }
                let depth = triangle.plane.at(column, row);
                let is_nearer = best
                    .is_none_or(|(kept, other)| depth > kept || depth == kept && *number < other);
                if is_nearer {
                    best = Some((depth, *number));
                }
            }
        }
        best.map(|(_, number)| number)
    }
}

/// Whether a ray to the left from the pixel's center crosses the border an odd number of times.
fn covers(triangle: &RasterTriangle, column: u32, row: u32) -> bool {
    let y = center(row);
    let [a, b, c] = triangle.corners;
    let crossed = [(a, b), (b, c), (c, a)].into_iter().filter(|(a, b)| {
        let (upper, lower) = if a.y < b.y { (*a, *b) } else { (*b, *a) };
        let meets = upper.y <= y && y < lower.y;
        meets
            && super::edge::PixelEdge::new(upper, lower)
                .is_some_and(|edge| edge.has_on_right(column, row))
    });
    crossed.count() % 2 == 1
}

/// The rectangle around a triangle.
fn bounds(triangle: &RasterTriangle) -> (DVec2, DVec2) {
    let [a, b, c] = triangle.corners;
    (a.min(b).min(c), a.max(b).max(c))
}

#[cfg(test)]
mod tests {
    use super::super::depth::DepthPlane;
    use super::*;
    use glam::DVec3;

    /// Slim, steep triangles as near as where a step of depth begins: rounding takes some pixels over it.
    #[test]
    fn no_pixel_is_nearer_than_its_box() {
        let mut state = 1u64;
        let mut below = |n: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % n
        };
        let (mut n_pixels, mut n_nearer) = (0, 0);
        for _ in 0..5000 {
            // A step of depth begins half a step above 1: a long side is just below it.
            let below_step = 1.0 + 2f64.powi(-41) - f64::EPSILON;
            let deeper = 2f64.powi(-39) * below(1 << 31) as f64;
            let corners = [
                DVec3::new(0.5, 0.5, below_step),
                DVec3::new(24.7, 24.7, below_step),
                DVec3::new(24.75, 24.65, below_step - deeper),
            ];
            let triangle = RasterTriangle {
                corners: corners.map(DVec3::truncate),
                plane: DepthPlane::through(corners),
                triangle: 0,
            };
            let tree = RayTree::new(vec![(0, triangle)]);
            let at_corners = corners.map(|corner| Depth::of(corner.z)).into_iter().max();
            for at in 1..24 {
                if covers(&triangle, at, at) {
                    let depth = triangle.plane.at(at, at);
                    assert!(depth <= tree.nodes[0].nearest, "{corners:?} at {at}");
                    n_pixels += 1;
                    n_nearer += u32::from(Some(depth) > at_corners);
                }
            }
        }
        assert!(n_pixels > 50_000 && n_nearer > 100, "{n_nearer} of {n_pixels}");
    }
}
