//! Nearest points among those not yet used: a k-d tree over fixed points that counts what is left
//! in each node.

use glam::DVec2;

/// Points a leaf holds at most.
const LEAF: usize = 8;

/// A balanced k-d tree; node `i` has the children `2i + 1` and `2i + 2`.
pub(super) struct NearestPoints<'a> {
    points: &'a [DVec2],
    /// Point numbers, those of a leaf together.
    order: Vec<u32>,
    /// Where in `order` each point stands.
    place: Vec<u32>,
    nodes: Vec<TreeNode>,
    n_inner: usize,
}

#[derive(Clone, Copy)]
struct TreeNode {
    low: DVec2,
    high: DVec2,
    start: u32,
    /// Points not yet removed; in a leaf they are the first.
    left: u32,
}

impl TreeNode {
    fn distance_squared(&self, p: DVec2) -> f64 {
        p.distance_squared(p.clamp(self.low, self.high))
    }
}

impl<'a> NearestPoints<'a> {
    /// O(n log n).
    pub(super) fn new(points: &'a [DVec2]) -> Self {
        let mut depth = 0;
        while points.len() >> depth > LEAF {
            depth += 1;
        }
        let n_inner = (1 << depth) - 1;
        let empty = TreeNode { low: DVec2::ZERO, high: DVec2::ZERO, start: 0, left: 0 };
        let mut tree = Self {
            points,
            order: (0..points.len() as u32).collect(),
            place: vec![0; points.len()],
            nodes: vec![empty; 2 * n_inner + 1],
            n_inner,
        };
        tree.build(0, 0, points.len());
        for (place, &point) in tree.order.iter().enumerate() {
            tree.place[point as usize] = place as u32;
        }
        tree
    }

    fn build(&mut self, node: usize, start: usize, end: usize) {
        let run = &mut self.order[start..end];
        let points = self.points;
        let first = run.first().map_or(DVec2::ZERO, |&i| points[i as usize]);
        let (low, high) = run.iter().fold((first, first), |(low, high), &i| {
            (low.min(points[i as usize]), high.max(points[i as usize]))
        });
        let middle = (end - start) / 2;
        if node < self.n_inner && middle > 0 {
            let wide = (high - low).x >= (high - low).y;
            let key = |i: u32| {
                if wide { points[i as usize].x } else { points[i as usize].y }
            };
            run.select_nth_unstable_by(middle, |&i, &j| key(i).total_cmp(&key(j)).then(i.cmp(&j)));
        }
        self.nodes[node] = TreeNode { low, high, start: start as u32, left: (end - start) as u32 };
        if node < self.n_inner {
            self.build(2 * node + 1, start, start + middle);
            self.build(2 * node + 2, start + middle, end);
        }
    }

    /// Takes `point` out of all further searches. O(log n).
    pub(super) fn remove(&mut self, point: u32) {
        let place = self.place[point as usize];
        let mut node = 0;
        loop {
            self.nodes[node].left -= 1;
            if node >= self.n_inner {
                break;
            }
            node = 2 * node + 1 + usize::from(place >= self.nodes[2 * node + 2].start);
        }
        // Those left in a leaf stay in front.
        let last = self.nodes[node].start + self.nodes[node].left;
        let other = self.order[last as usize];
        self.order.swap(place as usize, last as usize);
        self.place[other as usize] = place;
        self.place[point as usize] = last;
    }

    /// The point nearest to `p` among those left, the lower number of two as near.
    pub(super) fn nearest(&self, p: DVec2) -> Option<u32> {
        let mut best: Option<(f64, u32)> = None;
        self.search(p, |d, i| {
            if best.is_none_or(|b| (d, i) < b) {
                best = Some((d, i));
            }
            best.map_or(f64::INFINITY, |b| b.0)
        });
        best.map(|(_, i)| i)
    }

    /// The `k` points nearest to `p` that `wanted` accepts, nearest first, into `found`.
    pub(super) fn nearest_k(
        &self,
        p: DVec2,
        k: usize,
        wanted: impl Fn(u32) -> bool,
        found: &mut Vec<(f64, u32)>,
    ) {
        found.clear();
        self.search(p, |d, i| {
            if wanted(i) && (found.len() < k || found.last().is_some_and(|&last| (d, i) < last)) {
                let at = found.partition_point(|&other| other < (d, i));
                found.insert(at, (d, i));
                found.truncate(k);
            }
            if found.len() < k { f64::INFINITY } else { found.last().map_or(0.0, |last| last.0) }
        });
    }

    /// Shows `visit` points with their squared distances, until none left is within the bound it
    /// returned last.
    fn search(&self, p: DVec2, mut visit: impl FnMut(f64, u32) -> f64) {
        let mut bound = f64::INFINITY;
        let mut stack = [(0.0, 0usize); 64];
        let mut n = 1;
        while n > 0 {
            n -= 1;
            let (distance, node) = stack[n];
            if distance > bound || self.nodes[node].left == 0 {
                continue;
            }
            if node >= self.n_inner {
                let start = self.nodes[node].start as usize;
                for &i in &self.order[start..start + self.nodes[node].left as usize] {
                    bound = visit(self.points[i as usize].distance_squared(p), i);
                }
                continue;
            }
            let (a, b) = (2 * node + 1, 2 * node + 2);
            let (da, db) = (self.nodes[a].distance_squared(p), self.nodes[b].distance_squared(p));
            let (near, far) = if da <= db { ((da, a), (db, b)) } else { ((db, b), (da, a)) };
            stack[n] = far;
            stack[n + 1] = near;
            n += 2;
        }
    }
}
