//! The list being sorted: which fragments move to its front, and which are split.
//!
//! Items moved before each other form a stack: on top is the one being tested, below it the one that it
//! has to precede, and so on down to the one that headed the list. All of them are marked.

use super::boxes::BoxTree;
use super::relation::{Test, is_across, test};
use super::{DepthSortCounts, DepthSortError, MAX_SPLITS, MAX_TESTS, Settled, SortedFragment};
use crate::engines::face::fragment::Easel;
use crate::predicates::{PlaneName, Planes};
use rustc_hash::FxHashMap;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Waiting,
    /// On the stack, at this height.
    Marked(usize),
    Painted,
    /// Replaced by the item of this number and the next.
    Split(u32),
}

/// An item being tested, and those that it may hide.
#[derive(Debug)]
struct Entry {
    item: u32,
    others: Vec<u32>,
    next: usize,
}

/// The farthest item first; of equals that of the highest number, so of the highest face.
#[derive(Debug, PartialEq)]
struct Farthest(f64, u32);

impl Eq for Farthest {}

impl PartialOrd for Farthest {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Farthest {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0).then(self.1.cmp(&other.1))
    }
}

pub(super) struct List<'a> {
    planes: &'a Planes<'a>,
    easel: Easel<'a>,
    items: Vec<SortedFragment>,
    states: Vec<State>,
    boxes: BoxTree,
    /// For each item at the start, how many of its parts are not painted.
    n_parts: Vec<u32>,
    /// Items to put at the head of the list next.
    heap: BinaryHeap<Farthest>,
    stack: Vec<Entry>,
    /// Items that left the stack unpainted; their settled pairs remain settled.
    paused: FxHashMap<u32, Entry>,
}

impl<'a> List<'a> {
    pub(super) fn new(
        planes: &'a Planes<'a>,
        easel: Easel<'a>,
        mut items: Vec<SortedFragment>,
    ) -> Self {
        for (number, item) in (0..).zip(&mut items) {
            item.origin = number;
        }
        let n = items.len();
        Self {
            planes,
            easel,
            states: vec![State::Waiting; n],
            boxes: BoxTree::new(&items),
            n_parts: vec![1; n],
            heap: (0..).zip(&items).map(|(number, item)| Farthest(item.far, number)).collect(),
            stack: Vec::new(),
            paused: FxHashMap::default(),
            items,
        }
    }

    pub(super) fn item(&self, number: u32) -> &SortedFragment {
        &self.items[number as usize]
    }

    /// How many pairs there are to be tested, from a sample of the items.
    pub(super) fn estimated_pairs(&self, n_samples: usize) -> u64 {
        let n = self.items.len();
        let n_samples = n_samples.min(n);
        let mut found = 0u64;
        for k in 0..n_samples {
            let item = &self.items[k * n / n_samples];
            self.boxes.for_each(&self.items, item, |other| {
                // The pair is tested when the first of both is painted.
                found += u64::from(self.items[other as usize].far <= item.far);
            });
        }
        if n_samples == 0 { 0 } else { found / n_samples as u64 * n as u64 }
    }

    /// All items, or their parts, in the paint order.
    pub(super) fn sorted(
        &mut self,
        counts: &mut DepthSortCounts,
    ) -> Result<Vec<u32>, DepthSortError> {
        let max_splits = MAX_SPLITS * (self.items.len() as u64 + 64);
        let mut order = Vec::with_capacity(self.items.len());
        while let Some(Farthest(_, number)) = self.heap.pop() {
            if self.states[number as usize] != State::Waiting {
                continue;
            }
            self.begin(number);
            while let Some(top) = self.stack.last() {
                let p = top.item;
                let Some(&q) = top.others.get(top.next) else {
                    self.paint(p);
                    order.push(p);
                    continue;
                };
                counts.tests += 1;
                let (state, settled) = (self.states[q as usize], &mut counts.settled);
                match state {
                    State::Painted => self.pass(),
                    State::Split(first) => {
                        self.pass();
                        self.also(first);
                    }
                    _ if p == q || self.may_precede(p, q, settled) => self.pass(),
                    State::Waiting if self.may_precede(q, p, settled) => {
                        counts.moves += 1;
                        self.begin(q);
                    }
                    State::Waiting => {
                        // They pierce each other, or each hides a part of the other.
                        if is_across(self.planes, self.item(p), self.item(q)) {
                            self.split(p, q);
                        } else {
                            self.split(q, p);
                        }
                        counts.splits += 1;
                    }
                    State::Marked(height) => match self.split_of_cycle(height) {
                        Some((number, by)) => {
                            self.split(number, by);
                            counts.splits += 1;
                        }
                        // Unreachable: planes alone order items that cross none.
                        None => self.pass(),
                    },
                }
                if counts.splits > max_splits {
                    return Err(DepthSortError::TooManySplits(counts.splits));
                }
                if counts.tests > MAX_TESTS {
                    return Err(DepthSortError::TooManyTests(counts.tests));
                }
            }
        }
        Ok(order)
    }

    /// Whether `p` may be painted before `q`: it hides no part of it.
    fn may_precede(&self, p: u32, q: u32, settled: &mut Settled) -> bool {
        let test = test(self.planes, self.item(p), self.item(q));
        settled.count(test);
        test != Test::None
    }

    /// Marks the pair as settled.
    fn pass(&mut self) {
        if let Some(top) = self.stack.last_mut() {
            top.next += 1;
        }
    }

    /// The parts of another item have to be tested, too.
    fn also(&mut self, first: u32) {
        if let Some(top) = self.stack.last_mut() {
            top.others.extend([first, first + 1]);
        }
    }

    /// Moves an item to the front of the list.
    fn begin(&mut self, number: u32) {
        self.states[number as usize] = State::Marked(self.stack.len());
        if let Some(entry) = self.paused.remove(&number) {
            self.stack.push(entry);
            return;
        }
        let mut others = Vec::new();
        let item = &self.items[number as usize];
        self.boxes.for_each(&self.items, item, |other| {
            if other != item.origin {
                others.push(other);
            }
        });
        let far = |number: &u32| self.items[*number as usize].far;
        others.sort_unstable_by(|a, b| far(b).total_cmp(&far(a)).then(a.cmp(b)));
        self.stack.push(Entry { item: number, others, next: 0 });
    }

    fn paint(&mut self, number: u32) {
        self.stack.pop();
        self.states[number as usize] = State::Painted;
        let origin = self.items[number as usize].origin;
        self.n_parts[origin as usize] -= 1;
        if self.n_parts[origin as usize] == 0 {
            self.boxes.remove(origin);
        }
    }

    /// Of the items on the stack from `height` on, one that crosses the plane of another: best the one on
    /// top, since all above it have to be tested again.
    fn split_of_cycle(&self, height: usize) -> Option<(u32, u32)> {
        let members = || self.stack[height..].iter().rev().map(|entry| entry.item);
        let (first, last) = (self.stack.get(height)?.item, self.stack.last()?.item);
        let is_across =
            |&(x, y): &(u32, u32)| x != y && is_across(self.planes, self.item(x), self.item(y));
        [(last, first), (first, last)]
            .into_iter()
            .chain(members().flat_map(|x| members().map(move |y| (x, y))))
            .find(is_across)
    }

    /// Splits an item by the plane of another. If it is on the stack, it and all above leave it.
    fn split(&mut self, number: u32, by: u32) {
        if let State::Marked(height) = self.states[number as usize] {
            for entry in self.stack.drain(height..) {
                self.states[entry.item as usize] = State::Waiting;
                let far = self.items[entry.item as usize].far;
                // One that began the list may be among them.
                self.heap.push(Farthest(far, entry.item));
                if entry.item != number {
                    self.paused.insert(entry.item, entry);
                }
            }
        }
        let item = &self.items[number as usize];
        let name = PlaneName::Triangle(self.items[by as usize].fragment.triangle());
        let (front, back) = item.fragment.split(self.planes, &self.planes.plane(name));
        let (facing, origin) = (item.facing, item.origin);
        let first = self.items.len() as u32;
        self.states[number as usize] = State::Split(first);
        self.n_parts[origin as usize] += 1;
        for (part, number) in [front, back].into_iter().zip(first..) {
            let item = SortedFragment::new(&self.easel, part, facing, origin);
            self.heap.push(Farthest(item.far, number));
            self.items.push(item);
            self.states.push(State::Waiting);
        }
    }
}
