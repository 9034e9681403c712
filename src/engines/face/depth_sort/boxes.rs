//! A tree of boxes over image and depth, which finds the pairs that need tests.

use super::SortedFragment;
use glam::DVec2;

/// Items in a leaf.
const LEAF: usize = 4;

#[derive(Debug, Clone, Copy)]
struct BoxNode {
    low: DVec2,
    high: DVec2,
    far: f64,
    first: u32,
    last: u32,
    /// The node of the second half; the first half follows this node. 0 for a leaf.
    second: u32,
    parent: u32,
    /// Items that are not painted yet.
    n_left: u32,
}

/// The tree; items are removed as they are painted.
#[derive(Debug, Default)]
pub(super) struct BoxTree {
    nodes: Vec<BoxNode>,
    numbers: Vec<u32>,
    leaf_of: Vec<u32>,
    is_left: Vec<bool>,
}

impl BoxTree {
    /// O(n log n).
    pub(super) fn new(items: &[SortedFragment]) -> Self {
        let n = items.len();
        let mut boxes = Self {
            nodes: Vec::new(),
            numbers: (0..n as u32).collect(),
            leaf_of: vec![0; n],
            is_left: vec![true; n],
        };
        let mut waiting = vec![(0, n, 0, false)];
        while let Some((first, last, parent, is_second)) = waiting.pop() {
            if first == last {
                continue;
            }
            let own = boxes.nodes.len() as u32;
            if is_second {
                boxes.nodes[parent as usize].second = own;
            }
            let node = boxes.node(items, first, last, parent);
            boxes.nodes.push(node);
            if last - first > LEAF {
                let size = node.high - node.low;
                let middle = |number: &u32| {
                    let item = &items[*number as usize];
                    if size.x > size.y {
                        item.low.x + item.high.x
                    } else {
                        item.low.y + item.high.y
                    }
                };
                let half = (last - first) / 2;
                boxes.numbers[first..last]
                    .select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
                waiting.push((first + half, last, own, true));
                waiting.push((first, first + half, own, false));
            } else {
                for &number in &boxes.numbers[first..last] {
                    boxes.leaf_of[number as usize] = own;
                }
            }
        }
        boxes
    }

    fn node(&self, items: &[SortedFragment], first: usize, last: usize, parent: u32) -> BoxNode {
        let mut node = BoxNode {
            low: DVec2::INFINITY,
            high: DVec2::NEG_INFINITY,
            far: f64::NEG_INFINITY,
            first: first as u32,
            last: last as u32,
            second: 0,
            parent,
            n_left: (last - first) as u32,
        };
        for &number in &self.numbers[first..last] {
            let item = &items[number as usize];
            node.low = node.low.min(item.low);
            node.high = node.high.max(item.high);
            node.far = node.far.max(item.far);
        }
        node
    }

    /// Leaves an item out from now on. O(log n).
    pub(super) fn remove(&mut self, number: u32) {
        if !std::mem::take(&mut self.is_left[number as usize]) {
            return;
        }
        let mut at = self.leaf_of[number as usize];
        loop {
            let node = &mut self.nodes[at as usize];
            node.n_left -= 1;
            if at == 0 {
                return;
            }
            at = node.parent;
        }
    }

    /// Calls `found` with the numbers of all remaining items whose image box may meet that of `item` and
    /// whose farthest depth is beyond the nearest depth of `item`.
    pub(super) fn for_each(
        &self,
        items: &[SortedFragment],
        item: &SortedFragment,
        mut found: impl FnMut(u32),
    ) {
        let mut waiting = vec![0u32];
        while let Some(at) = waiting.pop() {
            let Some(node) = self.nodes.get(at as usize) else { continue };
            let meets = node.low.cmplt(item.high).all() && item.low.cmplt(node.high).all();
            if node.n_left == 0 || !meets || node.far <= item.near {
                continue;
            }
            if node.second != 0 {
                waiting.extend([at + 1, node.second]);
                continue;
            }
            for &number in &self.numbers[node.first as usize..node.last as usize] {
                let other = &items[number as usize];
                if self.is_left[number as usize] && other.far > item.near && item.may_meet(other) {
                    found(number);
                }
            }
        }
    }
}
