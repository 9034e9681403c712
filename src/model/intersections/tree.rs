//! Which triangles' boxes touch: a tree of boxes in which neighbors in space are neighbors.
//!
//! Triangles are ordered along a curve that fills space (Morton's), eight of them make a leaf, and
//! eight nodes the node above, so that the tree is nothing but arrays of boxes:
//!
//! ```text
//!   level 1     ┌──────────────┬──────────────┬ ┄
//!   level 0     ├───┬───┬ ┄ ┬──┼───┬───┬ ┄ ┬──┼ ┄    one lane a leaf
//!   leaves      ▽▽▽▽ ▽▽▽▽ ┄ ▽▽▽▽ …                     one lane a triangle
//! ```
//!
//! What is near a node over leaves is looked up at once for all that is in it, and each pair is met
//! from its earlier leaf only.
//! Expected cost O(n log n), whatever the sizes of the triangles, and the pairs that touch.
//!
//! Boxes are single precision, of differences to the middle of the scene. Both roundings keep the
//! order of numbers, so boxes that touch still do, and no box need be widened.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Children of a node.
const WIDTH: usize = 8;

/// Bits of a Morton code for each axis.
const MORTON_BITS: u32 = 10;

/// Nodes over leaves that one piece of parallel work looks up.
const CHUNK: usize = 32;

/// Boxes of eight children; those that are missing touch nothing.
#[derive(Debug, Clone, Copy)]
struct Boxes {
    low: [[f32; WIDTH]; 3],
    high: [[f32; WIDTH]; 3],
}

impl Boxes {
    const EMPTY: Self =
        Self { low: [[f32::INFINITY; WIDTH]; 3], high: [[f32::NEG_INFINITY; WIDTH]; 3] };

    fn set(&mut self, lane: usize, (low, high): (Vec3, Vec3)) {
        for axis in 0..3 {
            self.low[axis][lane] = low[axis];
            self.high[axis][lane] = high[axis];
        }
    }

    fn get(&self, lane: usize) -> (Vec3, Vec3) {
        let corner = |of: &[[f32; WIDTH]; 3]| Vec3::new(of[0][lane], of[1][lane], of[2][lane]);
        (corner(&self.low), corner(&self.high))
    }

    /// The box around all.
    fn around(&self) -> (Vec3, Vec3) {
        (0..WIDTH)
            .map(|lane| self.get(lane))
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), (l, h)| {
                (low.min(l), high.max(h))
            })
    }

    /// A bit for each child whose box touches another.
    #[inline]
    fn touching(&self, (low, high): (Vec3, Vec3)) -> u32 {
        // The widest gap of each lane; a difference has the sign of the comparison.
        let mut gaps = [f32::NEG_INFINITY; WIDTH];
        for axis in 0..3 {
            let (l, h) = (&self.low[axis], &self.high[axis]);
            for lane in 0..WIDTH {
                let (before, after) = (l[lane] - high[axis], low[axis] - h[lane]);
                let gap = if before > after { before } else { after };
                gaps[lane] = if gap > gaps[lane] { gap } else { gaps[lane] };
            }
        }
        // One bit a lane, all at once.
        let mut bits = [0; WIDTH];
        for lane in 0..WIDTH {
            bits[lane] = if gaps[lane] <= 0.0 { 1 << lane } else { 0 };
        }
        bits.into_iter().fold(0, |all, bit| all | bit)
    }
}

/// A power of two that brings sizes to about 1, so that none is out of the range of single precision.
fn to_single(size: DVec3) -> f64 {
    let (_, exponent) = libm::frexp(size.max_element());
    libm::ldexp(1.0, -exponent.clamp(-1000, 1000))
}

/// Triangles by their boxes.
#[derive(Debug)]
pub(super) struct BoxTree {
    /// The triangles in the order of the curve.
    order: Vec<u32>,
    /// Leaves first, and at least one level more; node `i` of a level has the nodes `8 i …` of the
    /// one before as children.
    levels: Vec<Vec<Boxes>>,
}

impl BoxTree {
    /// Sorts the triangles with the numbers `of` into a tree. O(positions + of log of).
    pub(super) fn new(positions: &[DVec3], triangles: &[[u32; 3]], of: Vec<u32>) -> Self {
        let (low, high) = positions
            .par_iter()
            .with_min_len(1 << 14)
            .fold(
                || (DVec3::INFINITY, DVec3::NEG_INFINITY),
                |(low, high), &p| (low.min(p), high.max(p)),
            )
            .reduce(|| (DVec3::INFINITY, DVec3::NEG_INFINITY), |a, b| (a.0.min(b.0), a.1.max(b.1)));
        // Halves first: the sum may be too large for a number.
        let middle = low * 0.5 + high * 0.5;
        let scale = to_single(high * 0.5 - low * 0.5);
        let place = |p: DVec3| ((p - middle) * scale).as_vec3();
        let placed: Vec<Vec3> =
            positions.par_iter().with_min_len(1 << 14).map(|&p| place(p)).collect();
        let box_of = |triangle: u32| {
            let [p, q, r] = triangles[triangle as usize].map(|v| placed[v as usize]);
            (p.min(q).min(r), p.max(q).max(r))
        };
        let (low, high) = (place(low), place(high));
        let cells = (1u32 << MORTON_BITS) as f32 / (high - low).max_element();
        let mut keys: Vec<u64> = of
            .into_par_iter()
            .with_min_len(1 << 14)
            .map(|triangle| {
                let (l, h) = box_of(triangle);
                // Infinite or missing numbers end up in a border cell.
                let cell = ((l * 0.5 + h * 0.5 - low) * cells).to_array();
                let cell = cell.map(|x| (x as u32).min((1 << MORTON_BITS) - 1));
                u64::from(interleaved(cell)) << 32 | u64::from(triangle)
            })
            .collect();
        keys.par_sort_unstable();
        let order: Vec<u32> = keys.into_iter().map(|key| key as u32).collect();
        let leaves: Vec<Boxes> = order
            .par_chunks(WIDTH)
            .with_min_len(1 << 10)
            .map(|triangles| {
                let mut boxes = Boxes::EMPTY;
                for (lane, &triangle) in triangles.iter().enumerate() {
                    boxes.set(lane, box_of(triangle));
                }
                boxes
            })
            .collect();
        let mut levels = vec![leaves];
        while let Some(last) = levels.last().filter(|last| last.len() > 1 || levels.len() == 1) {
            let next = last
                .par_chunks(WIDTH)
                .with_min_len(1 << 10)
                .map(|children| {
                    let mut boxes = Boxes::EMPTY;
                    for (lane, child) in children.iter().enumerate() {
                        boxes.set(lane, child.around());
                    }
                    boxes
                })
                .collect();
            levels.push(next);
        }
        Self { order, levels }
    }

    /// Calls `visit` with each triangle and the later ones whose boxes touch its own, and returns
    /// what it collected. The order does not depend on the number of threads.
    ///
    /// `visit` gets the collection, what `prepare` made of the triangle, the triangle and another.
    pub(super) fn touching_pairs<T, P>(
        &self,
        prepare: impl Fn(u32) -> P + Sync,
        visit: impl Fn(&mut T, &P, u32, u32) + Sync,
    ) -> Vec<T>
    where
        T: Default + Send,
    {
        self.levels[1]
            .par_chunks(CHUNK)
            .enumerate()
            .map(|(chunk, nodes)| {
                let mut found = T::default();
                let mut near = Vec::new();
                let mut prepared = Vec::with_capacity(WIDTH);
                for (i, boxes) in nodes.iter().enumerate() {
                    let node = chunk * CHUNK + i;
                    near.clear();
                    self.nodes_from(node, boxes.around(), &mut near);
                    for leaf in node * WIDTH..self.levels[0].len().min((node + 1) * WIDTH) {
                        let own = self.triangles_of(leaf);
                        prepared.clear();
                        prepared.extend(own.iter().map(|&triangle| prepare(triangle)));
                        self.pairs_of_leaf(leaf, &near, |lane, with| {
                            visit(&mut found, &prepared[lane], own[lane], with);
                        });
                    }
                }
                found
            })
            .collect()
    }

    /// Calls `f` with lanes of a leaf and later triangles in the nodes `near` that touch these.
    #[inline]
    fn pairs_of_leaf(&self, leaf: usize, near: &[usize], mut f: impl FnMut(usize, u32)) {
        let (leaves, nodes) = (&self.levels[0], &self.levels[1]);
        let (node, own) = (leaf / WIDTH, &leaves[leaf]);
        let around = nodes[node].get(leaf % WIDTH);
        for &other_node in near {
            let mut leaf_bits = nodes[other_node].touching(around);
            if other_node == node {
                leaf_bits &= !0 << (leaf % WIDTH);
            }
            while leaf_bits != 0 {
                let lane = leaf_bits.trailing_zeros() as usize;
                leaf_bits &= leaf_bits - 1;
                let other = other_node * WIDTH + lane;
                let others = self.triangles_of(other);
                let mut own_bits = own.touching(nodes[other_node].get(lane));
                while own_bits != 0 {
                    let lane = own_bits.trailing_zeros() as usize;
                    own_bits &= own_bits - 1;
                    let mut bits = leaves[other].touching(own.get(lane));
                    if other == leaf {
                        bits &= !1 << lane;
                    }
                    while bits != 0 {
                        f(lane, others[bits.trailing_zeros() as usize]);
                        bits &= bits - 1;
                    }
                }
            }
        }
    }

    fn triangles_of(&self, leaf: usize) -> &[u32] {
        let start = leaf * WIDTH;
        &self.order[start..self.order.len().min(start + WIDTH)]
    }

    /// The nodes over leaves, from number `first` on, that touch a box, in order.
    fn nodes_from(&self, first: usize, around: (Vec3, Vec3), found: &mut Vec<usize>) {
        let top = self.levels.len() - 1;
        if top == 1 {
            found.push(0);
        } else {
            self.descend(top, 0, first, around, found);
        }
    }

    fn descend(
        &self,
        level: usize,
        node: usize,
        first: usize,
        around: (Vec3, Vec3),
        found: &mut Vec<usize>,
    ) {
        let mut bits = self.levels[level][node].touching(around);
        while bits != 0 {
            let child = node * WIDTH + bits.trailing_zeros() as usize;
            bits &= bits - 1;
            // Children whose last node over leaves comes before the first are done with.
            if (child + 1) << (3 * (level - 2)) <= first {
                continue;
            }
            if level == 2 {
                found.push(child);
            } else {
                self.descend(level - 1, child, first, around, found);
            }
        }
    }
}

/// The bits of three numbers in turn.
fn interleaved([x, y, z]: [u32; 3]) -> u32 {
    let spread = |x: u32| {
        let x = (x | x << 16) & 0x0300_00ff;
        let x = (x | x << 8) & 0x0300_f00f;
        let x = (x | x << 4) & 0x030c_30c3;
        (x | x << 2) & 0x0924_9249
    };
    spread(x) | spread(y) << 1 | spread(z) << 2
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;
    use std::collections::BTreeSet;

    /// Numbers without a pattern, the same on every run.
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 7_u64;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f64 / (1 << 24) as f64
        }
    }

    #[test]
    fn every_pair_of_touching_boxes_is_met_once() {
        for n in [1_u32, 2, 8, 9, 70, 600] {
            let mut next = numbers();
            let mut positions = Vec::new();
            for i in 0..n {
                let size = if i % 50 == 0 { 2.0 } else { 0.1 };
                let at = dvec3(next(), next(), next()) + DVec3::splat(1e6);
                for _ in 0..3 {
                    positions.push(at + size * dvec3(next(), next(), next()));
                }
            }
            let triangles: Vec<[u32; 3]> = (0..n).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
            let tree = BoxTree::new(&positions, &triangles, (0..n).collect());
            let pairs: Vec<Vec<[u32; 2]>> = tree.touching_pairs(
                |_| (),
                |found: &mut Vec<[u32; 2]>, (), a, b| found.push([a.min(b), a.max(b)]),
            );
            let met: Vec<[u32; 2]> = pairs.concat();
            let distinct: BTreeSet<[u32; 2]> = met.iter().copied().collect();
            assert_eq!(met.len(), distinct.len());
            let corner = |t: u32, f: fn(DVec3, DVec3) -> DVec3| {
                triangles[t as usize].map(|v| positions[v as usize]).into_iter().reduce(f)
            };
            for a in 0..n {
                for b in a + 1..n {
                    let (low, high) = (corner(a, DVec3::min), corner(a, DVec3::max));
                    let (l, h) = (corner(b, DVec3::min), corner(b, DVec3::max));
                    let touch = low.zip(h).is_some_and(|(x, y)| x.cmple(y).all())
                        && l.zip(high).is_some_and(|(x, y)| x.cmple(y).all());
                    assert!(!touch || distinct.contains(&[a, b]), "{a} {b}");
                }
            }
        }
    }
}
