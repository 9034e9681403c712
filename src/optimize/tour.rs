//! Local search on the order of strokes: 2-opt (Croes 1958) and Or-opt (Or 1976) with neighbor
//! lists and a work queue (Bentley 1992), then iterated with small random changes that are undone
//! unless they help (Martin, Otto and Felten 1991).
//!
//! Stroke `s` has the ends `2s` and `2s + 1`. The tour is a ring of entry ends: the pen enters a
//! stroke at `c` and leaves it at `c ^ 1`. One more stroke without place or cost closes the ring,
//! so that the path begins and ends wherever it likes.
//!
//! ```text
//!        c   c^1      d   d^1
//!   ┄┄┄┄►●────●┄┄┄┄┄┄►●────●┄┄┄┄►      turning a run of strokes around reverses their order and
//!        link   link     link          swaps each one's ends
//! ```
//!
//! Lengths are whole nanometers, so that sums are exact: a move either shortens the path or does
//! not, and the search ends.

use std::collections::VecDeque;

use glam::DVec2;

use super::Watch;

/// Nanometers in a millimeter.
const NM_PER_MM: f64 = 1e6;
/// Strokes Or-opt moves at once.
const MAX_MOVED: usize = 3;
/// Strokes in either of the two runs that a random change swaps.
const MAX_SWAPPED: usize = 50;

pub(super) struct Tour<'a> {
    /// Both ends of every stroke.
    ends: &'a [DVec2],
    /// `n_neighbors` ends of other strokes for each end, nearest first.
    neighbors: &'a [u32],
    n_neighbors: usize,
    /// Entry ends in drawing order; the closing stroke's end is `ends.len()` or one more.
    ring: Vec<u32>,
    place: Vec<u32>,
    queue: VecDeque<u32>,
    queued: Vec<bool>,
    /// Farthest apart that strokes may stand whose ends a move links.
    max_turn: usize,
    /// Runs turned since the last change was accepted: place and length.
    turned: Vec<(u32, u32)>,
    logging: bool,
}

impl<'a> Tour<'a> {
    /// `entries` are the ends at which the strokes are entered, in order.
    pub(super) fn new(
        ends: &'a [DVec2],
        entries: &[u32],
        neighbors: &'a [u32],
        n_neighbors: usize,
    ) -> Self {
        let mut ring = entries.to_vec();
        ring.push(ends.len() as u32);
        let mut place = vec![0; ring.len()];
        for (i, &c) in ring.iter().enumerate() {
            place[c as usize / 2] = i as u32;
        }
        Self {
            ends,
            neighbors,
            n_neighbors,
            ring,
            place,
            queue: VecDeque::new(),
            queued: vec![false; ends.len()],
            max_turn: 0,
            turned: Vec::new(),
            logging: false,
        }
    }

    /// Entry ends in drawing order, from the closing stroke on.
    pub(super) fn entries(&self) -> Vec<u32> {
        let closing = self.place[self.ends.len() / 2] as usize;
        let (before, from) = self.ring.split_at(closing);
        from[1..].iter().chain(before).copied().collect()
    }

    /// Applies moves until none shortens the path; a move reverses `max_turn` strokes at most.
    pub(super) fn improve_all(&mut self, max_turn: usize, watch: &mut Watch<'_>) {
        self.max_turn = max_turn;
        for i in 0..self.ring.len() {
            let c = self.ring[i];
            self.push(c);
            self.push(c ^ 1);
        }
        let n_queued = self.queue.len().max(1) as f64;
        let mut least = n_queued;
        self.improve_queued(|n_left| {
            // Moves put ends back into the queue; the share never shrinks.
            least = least.min(n_left as f64);
            watch(1.0 - least / n_queued);
        });
    }

    /// Swaps two neighboring runs of strokes at a random place, improves the route around them and
    /// keeps the result unless it is longer. Does so `n_changes` times, or until `go_on`, called with the
    /// number of changes tried, returns false. Returns how many were tried.
    pub(super) fn iterate(
        &mut self,
        n_changes: u64,
        max_turn: usize,
        mut go_on: impl FnMut(u64) -> bool,
    ) -> u64 {
        self.max_turn = max_turn;
        let n = self.ring.len();
        if n < 8 {
            return 0;
        }
        let mut random = Random(0x9e37_79b9_7f4a_7c15);
        self.logging = true;
        let longest = MAX_SWAPPED.min(n / 3);
        for done in 0..n_changes {
            if done % 128 == 0 && !go_on(done) {
                self.logging = false;
                return done;
            }
            self.turned.clear();
            let start = random.below(n);
            let (a, b) = (1 + random.below(longest), 1 + random.below(longest));
            let mut change = -self.links(start, a, b);
            self.swap_runs(start, a, b, false);
            change += self.links(start, b, a);
            for i in [start, start + b, start + a + b] {
                let c = self.ring[i % n];
                self.push(self.linked(c));
                self.push(c);
            }
            change += self.improve_queued(|_| ());
            if change > 0 {
                for i in (0..self.turned.len()).rev() {
                    let (start, len) = self.turned[i];
                    self.reverse(start as usize, len as usize);
                }
            }
        }
        self.logging = false;
        n_changes
    }

    /// Length of the links before, between and after two neighboring runs.
    fn links(&self, start: usize, a: usize, b: usize) -> i64 {
        let n = self.ring.len();
        [start, start + a, start + a + b]
            .into_iter()
            .map(|i| self.link(self.ring[(i + n - 1) % n] ^ 1, self.ring[i % n]))
            .sum()
    }

    fn push(&mut self, end: u32) {
        if let Some(queued) = self.queued.get_mut(end as usize)
            && !*queued
        {
            *queued = true;
            self.queue.push_back(end);
        }
    }

    /// Distance between two ends; 0 to the closing stroke.
    fn link(&self, a: u32, b: u32) -> i64 {
        match (self.ends.get(a as usize), self.ends.get(b as usize)) {
            (Some(a), Some(b)) => (a.distance(*b) * NM_PER_MM) as i64,
            _ => 0,
        }
    }

    /// The end that the pen comes from or goes to at `end`.
    fn linked(&self, end: u32) -> u32 {
        let n = self.ring.len();
        let i = self.place[end as usize / 2] as usize;
        if self.ring[i] == end {
            self.ring[if i == 0 { n - 1 } else { i - 1 }] ^ 1
        } else {
            self.ring[if i + 1 == n { 0 } else { i + 1 }]
        }
    }

    /// Improves around queued ends; returns the change of the path's length.
    /// `watch` is given the number of ends left, every thousand ends.
    fn improve_queued(&mut self, mut watch: impl FnMut(usize)) -> i64 {
        let mut change = 0;
        let mut n_done = 0_usize;
        while let Some(end) = self.queue.pop_front() {
            n_done += 1;
            if n_done.is_multiple_of(1000) {
                watch(self.queue.len());
            }
            self.queued[end as usize] = false;
            while let Some(gain) = self.improve(end) {
                change -= gain;
            }
        }
        change
    }

    /// Applies the best move that links `end` to one of its neighbors, if one shortens the path.
    fn improve(&mut self, end: u32) -> Option<i64> {
        let f = self.linked(end);
        let now = self.link(end, f);
        let mut best: Option<(i64, Move)> = None;
        let mut offer = |gain: i64, action: Move| {
            if gain > best.as_ref().map_or(0, |b| b.0) {
                best = Some((gain, action));
            }
        };
        let neighbors = self.neighbors;
        let start = end as usize * self.n_neighbors;
        for &c in neighbors.get(start..start + self.n_neighbors)? {
            let new = self.link(end, c);
            if new >= now || c as usize >= self.ends.len() {
                break;
            }
            let g = self.linked(c);
            if c == f || g == end || self.apart(end, c) > self.max_turn {
                continue;
            }
            let freed = now + self.link(c, g) - new;
            if self.is_entry(end) == self.is_entry(c) {
                offer(freed - self.link(f, g), Move::Turn { end, c });
            }
            self.offer_moves(end, f, c, g, freed, &mut offer);
            self.offer_moves(c, g, end, f, freed, &mut offer);
        }
        let (gain, action) = best?;
        self.apply(action);
        Some(gain)
    }

    /// Strokes between those of two ends, the shorter way around the ring: what a move costs.
    fn apart(&self, a: u32, b: u32) -> usize {
        let distance = self.place_of(a).abs_diff(self.place_of(b));
        distance.min(self.ring.len() - distance)
    }

    /// Offers to take the strokes from `end` away from `f` and put them between `c` and `g`.
    fn offer_moves(
        &self,
        end: u32,
        f: u32,
        c: u32,
        g: u32,
        freed: i64,
        offer: &mut impl FnMut(i64, Move),
    ) {
        let mut last = end;
        for n_strokes in 1..=MAX_MOVED {
            let x = last ^ 1;
            // The run must not hold the link to be cut, nor the closing stroke.
            if x as usize >= self.ends.len() || x / 2 == c / 2 || x / 2 == g / 2 {
                return;
            }
            let a = self.linked(x);
            let gain = freed + self.link(a, x) - self.link(x, g) - self.link(a, f);
            offer(gain, Move::Shift { end, c, n_strokes });
            last = a;
        }
    }

    fn is_entry(&self, end: u32) -> bool {
        self.ring[self.place[end as usize / 2] as usize] == end
    }

    fn apply(&mut self, action: Move) {
        let n = self.ring.len();
        match action {
            Move::Turn { end, c } => {
                let (f, g) = (self.linked(end), self.linked(c));
                let (i, j) = (self.place_of(end), self.place_of(c));
                // Between the two cut links: from one entry up to before the other.
                let (from, to) = if self.is_entry(end) { (i, j) } else { (i + 1, j + 1) };
                let len = (to + n - from) % n;
                let (from, len) = if 2 * len > n { (to, n - len) } else { (from, len) };
                self.turn(from % n, len);
                for touched in [end, c, f, g] {
                    self.push(touched);
                }
            }
            Move::Shift { end, c, n_strokes } => {
                let (f, g) = (self.linked(end), self.linked(c));
                let entering = self.is_entry(end);
                // First place of the run, and of what follows the link to be cut.
                let first = if entering {
                    self.place_of(end)
                } else {
                    self.place_of(end) + n + 1 - n_strokes
                } % n;
                let x = if entering {
                    self.ring[(first + n_strokes - 1) % n] ^ 1
                } else {
                    self.ring[first]
                };
                let a = self.linked(x);
                let c_enters = self.is_entry(c);
                let cut = if c_enters { self.place_of(c) } else { self.place_of(c) + 1 } % n;
                let turned = entering == c_enters;
                let after = (cut + n - first) % n - n_strokes;
                let before = (first + n - cut) % n;
                if after <= before {
                    self.swap_runs(first, n_strokes, after, turned);
                } else {
                    self.swap_runs_turning_second(cut, before, n_strokes, turned);
                }
                for touched in [end, c, f, g, x, a] {
                    self.push(touched);
                }
            }
        }
    }

    fn place_of(&self, end: u32) -> usize {
        self.place[end as usize / 2] as usize
    }

    /// Swaps a run of `a` strokes with the `b` after it; the first one is also turned on request.
    fn swap_runs(&mut self, start: usize, a: usize, b: usize, turn_first: bool) {
        self.turn(start, a + b);
        self.turn(start, b);
        if !turn_first {
            self.turn(start + b, a);
        }
    }

    /// Swaps a run of `a` strokes with the `b` after it; the second one is also turned on request.
    fn swap_runs_turning_second(&mut self, start: usize, a: usize, b: usize, turn_second: bool) {
        self.turn(start, a + b);
        self.turn(start + b, a);
        if !turn_second {
            self.turn(start, b);
        }
    }

    fn turn(&mut self, start: usize, len: usize) {
        let start = start % self.ring.len();
        if self.logging {
            self.turned.push((start as u32, len as u32));
        }
        self.reverse(start, len);
    }

    /// Turns `len` strokes from `start` around. Its own inverse.
    fn reverse(&mut self, start: usize, len: usize) {
        let n = self.ring.len();
        if len == 0 {
            return;
        }
        let (mut i, mut j) = (start, (start + len - 1) % n);
        for _ in 0..len / 2 {
            let (a, b) = (self.ring[i] ^ 1, self.ring[j] ^ 1);
            self.ring[i] = b;
            self.ring[j] = a;
            self.place[b as usize / 2] = i as u32;
            self.place[a as usize / 2] = j as u32;
            i = if i + 1 == n { 0 } else { i + 1 };
            j = if j == 0 { n - 1 } else { j - 1 };
        }
        if len % 2 == 1 {
            self.ring[i] ^= 1;
        }
    }
}

/// A change of the tour that links `end` to `c`.
#[derive(Clone, Copy)]
enum Move {
    /// Turn around what lies between the links of `end` and `c`, which are both entries or both
    /// exits (2-opt).
    Turn { end: u32, c: u32 },
    /// Take the run of strokes that begins at `end`, away from its link, into the link of `c`.
    Shift { end: u32, c: u32, n_strokes: usize },
}

/// xorshift64* (Vigna 2016): a fixed sequence, the same everywhere.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let high = self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 32;
        ((high * n as u64) >> 32) as usize
    }
}
