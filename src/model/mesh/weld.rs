//! Which positions become one vertex: equal ones always, near ones on request.

use glam::DVec3;
use hashbrown::HashTable;
use std::hash::{BuildHasher, Hasher};

/// For each position the index of the first one equal to it (−0 is 0). O(n) expected.
pub(super) fn first_equal_position(positions: &[DVec3]) -> Vec<u32> {
    // The hash has a new seed in each run, so that no file can be made to collide on purpose; the
    // result does not depend on it.
    let hasher = hashbrown::DefaultHashBuilder::default();
    let bits = |p: DVec3| (p + DVec3::ZERO).to_array().map(f64::to_bits);
    let hash = |key: [u64; 3]| {
        let mut state = hasher.build_hasher();
        key.into_iter().for_each(|word| state.write_u64(word));
        state.finish()
    };
    // Triangle lists repeat each position about six times; other files make the table grow.
    let mut first: HashTable<u32> = HashTable::with_capacity(positions.len() / 4);
    let mut result = Vec::with_capacity(positions.len());
    for (i, &position) in positions.iter().enumerate() {
        let key = bits(position);
        let found = first.entry(
            hash(key),
            |&j| bits(positions[j as usize]) == key,
            |&j| hash(bits(positions[j as usize])),
        );
        result.push(*found.or_insert(i as u32).get());
    }
    result
}

/// For each position the lowest index among those that it is joined to, directly or over others,
/// by steps shorter than `distance` (which is positive and finite).
///
/// Positions are halved along the longest side of their box until a box is smaller than the
/// distance (all in it are joined) or a single position; pairs of boxes are then joined, skipped,
/// or halved again. Nearly O(n log n), also when very many positions crowd into few places.
pub(super) fn first_near_position(positions: &[DVec3], distance: f64) -> Vec<u32> {
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    let mut boxes = Boxes { positions, distance, nodes: Vec::new() };
    let mut groups = Groups { parent: order.clone() };
    if !order.is_empty() {
        let root = boxes.build(&mut order, 0);
        boxes.join_within(root, &order, &mut groups);
    }
    (0..positions.len() as u32).map(|i| groups.first(i)).collect()
}

/// A box around `order[start..end]`.
#[derive(Debug, Clone, Copy)]
struct Node {
    low: DVec3,
    high: DVec3,
    start: u32,
    end: u32,
    /// Two nodes, unless the box is a point.
    halves: Option<(u32, u32)>,
    /// Whether the box is smaller than the distance, so that all in it are joined.
    is_small: bool,
}

struct Boxes<'a> {
    positions: &'a [DVec3],
    distance: f64,
    nodes: Vec<Node>,
}

impl Boxes<'_> {
    /// Builds the tree over a slice that begins at `start` of the whole order.
    fn build(&mut self, order: &mut [u32], start: u32) -> u32 {
        let positions = self.positions;
        let at = |i: u32| positions[i as usize];
        let (low, high) =
            order.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &i| {
                (low.min(at(i)), high.max(at(i)))
            });
        let node = self.nodes.len() as u32;
        self.nodes.push(Node {
            low,
            high,
            start,
            end: start + order.len() as u32,
            halves: None,
            is_small: self.is_shorter(high - low),
        });
        if low != high {
            // Halved before subtracting, a side as long as all doubles does not overflow.
            let axis = (high / 2.0 - low / 2.0).max_position();
            let middle = order.len() / 2;
            order.select_nth_unstable_by(middle, |&a, &b| {
                at(a)[axis].total_cmp(&at(b)[axis]).then(a.cmp(&b))
            });
            let (left, right) = order.split_at_mut(middle);
            let left = self.build(left, start);
            let right = self.build(right, start + middle as u32);
            self.nodes[node as usize].halves = Some((left, right));
        }
        node
    }

    /// Whether a vector is shorter than the distance; scaled, so that its square cannot underflow.
    fn is_shorter(&self, vector: DVec3) -> bool {
        (vector / self.distance).length_squared() < 1.0
    }

    /// Joins all positions in a box that are near each other.
    fn join_within(&self, node: u32, order: &[u32], groups: &mut Groups) {
        let Node { start, end, halves, is_small, .. } = self.nodes[node as usize];
        if is_small {
            let members = &order[start as usize..end as usize];
            for &member in members {
                groups.join(members[0], member);
            }
        } else if let Some((left, right)) = halves {
            self.join_within(left, order, groups);
            self.join_within(right, order, groups);
            self.join_between(left, right, order, groups);
        }
    }

    /// Joins positions in one box with those in another that are near; each box is joined within.
    fn join_between(&self, a: u32, b: u32, order: &[u32], groups: &mut Groups) {
        let (first, second) = (self.nodes[a as usize], self.nodes[b as usize]);
        let gap = (first.low - second.high).max(second.low - first.high).max(DVec3::ZERO);
        if !self.is_shorter(gap) {
            return;
        }
        if first.is_small && second.is_small {
            let (i, j) = (order[first.start as usize], order[second.start as usize]);
            if groups.first(i) == groups.first(j) {
                return;
            }
            let span = first.high.max(second.high) - first.low.min(second.low);
            let are_points = first.halves.is_none() && second.halves.is_none();
            if are_points || self.is_shorter(span) {
                groups.join(i, j);
                return;
            }
        }
        let size = |node: &Node| (node.high / 2.0 - node.low / 2.0).max_element();
        let (halves, other) = match (first.halves, second.halves) {
            (Some(halves), None) => (halves, b),
            (Some(halves), Some(_)) if size(&first) >= size(&second) => (halves, b),
            (_, Some(halves)) => (halves, a),
            (None, None) => {
                // Points are small boxes, so they were joined above.
                return;
            }
        };
        self.join_between(halves.0, other, order, groups);
        self.join_between(halves.1, other, order, groups);
    }
}

/// Disjoint sets whose root is their lowest member.
struct Groups {
    parent: Vec<u32>,
}

impl Groups {
    fn first(&mut self, mut i: u32) -> u32 {
        loop {
            let parent = self.parent[i as usize];
            if parent == i {
                return i;
            }
            let grandparent = self.parent[parent as usize];
            self.parent[i as usize] = grandparent;
            i = grandparent;
        }
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.first(a), self.first(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }
}
