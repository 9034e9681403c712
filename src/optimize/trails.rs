//! The fewest strokes that draw a graph, passing as straight as possible through every vertex.
//!
//! A connected part with `k` vertices of odd degree needs at least `max(1, k / 2)` strokes if nothing is
//! drawn twice (Euler 1736, Hierholzer 1873). Here:
//!
//! 1. At every vertex the edges are paired, straightest pairs first; at an odd vertex one edge stays
//!    single and a stroke ends. The pairs form trails: `k / 2` open ones in each part, and closed ones.
//! 2. A closed trail is spliced into another at a vertex on both, by pairing their four edges there
//!    differently; the straightest splices come first, as in Kruskal's spanning tree.
//!
//! ```text
//!      │    ╭──╮            │╭──╮         one open and one closed trail meet in ●:
//!   ───●────╯  │    ─►   ───●╯  │         the new pairs make one open trail
//!      ╰───────╯            ╰───╯
//! ```

use glam::DVec2;

use crate::disjoint_sets::DisjointSets;

use super::graph::{Graph, IncidentEdges, NONE, target};

/// Strokes as runs of vertices; a closed one ends at its first vertex.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trails {
    vertices: Vec<u32>,
    ends: Vec<u32>,
}

impl Trails {
    /// The strokes.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        self.ends.iter().scan(0, |start, &end| {
            let trail = &self.vertices[*start..end as usize];
            *start = end as usize;
            Some(trail)
        })
    }

    /// Number of strokes.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }
}

/// Draws every edge of `graph` once, in the fewest strokes.
///
/// Open strokes come first, by their first vertex, then closed ones; the result depends on the
/// graph alone. O(edges · log edges) for vertices of bounded degree.
pub fn trails(graph: &Graph) -> Trails {
    let stars = IncidentEdges::new(graph);
    let mut pairing = Pairing { graph, mate: vec![NONE; graph.edges.len() * 2] };
    for vertex in 0..graph.positions.len() as u32 {
        pairing.pair_straightest(stars.of(vertex));
    }
    splice_closed(&mut pairing, &stars);
    pairing.walk(&stars)
}

/// Degrees up to this are paired by trying every pairing: 15 of them.
const MAX_DEGREE_TRIED: usize = 6;
/// Degrees up to this are paired greedily from all pairs; beyond, opposite edges by angle.
const MAX_DEGREE_GREEDY: usize = 64;

/// For each half-edge, the one at the same vertex with which its stroke continues; `NONE` ends a stroke.
struct Pairing<'a> {
    graph: &'a Graph,
    mate: Vec<u32>,
}

impl Pairing<'_> {
    fn direction(&self, half_edge: u32) -> DVec2 {
        let from = self.graph.edges[half_edge as usize / 2][half_edge as usize & 1];
        let to = target(self.graph, half_edge);
        (self.graph.position(to) - self.graph.position(from)).normalize_or_zero()
    }

    /// How sharply a stroke that comes in along one half-edge turns to leave along the other:
    /// 0 straight on, 1 a right angle, 2 back; 0 where it ends.
    fn bend(&self, a: u32, b: u32) -> f64 {
        if a == NONE || b == NONE { 0.0 } else { 1.0 + self.direction(a).dot(self.direction(b)) }
    }

    fn join(&mut self, a: u32, b: u32) {
        if a != NONE {
            self.mate[a as usize] = b;
        }
        if b != NONE {
            self.mate[b as usize] = a;
        }
    }

    fn pair_straightest(&mut self, star: &[u32]) {
        match star {
            [] | [_] => {}
            &[a, b] => self.join(a, b),
            _ if star.len() <= MAX_DEGREE_TRIED => {
                let mut best = (f64::INFINITY, Vec::new());
                self.try_pairings(star, 0.0, &mut Vec::new(), &mut best);
                for (a, b) in best.1 {
                    self.join(a, b);
                }
            }
            _ if star.len() <= MAX_DEGREE_GREEDY => {
                let mut pairs: Vec<(f64, u32, u32)> = Vec::new();
                for (i, &a) in star.iter().enumerate() {
                    pairs.extend(star[i + 1..].iter().map(|&b| (self.bend(a, b), a, b)));
                }
                pairs
                    .sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
                for (_, a, b) in pairs {
                    if self.mate[a as usize] == NONE && self.mate[b as usize] == NONE {
                        self.join(a, b);
                    }
                }
            }
            _ => {
                let mut by_angle: Vec<(f64, u32)> = star
                    .iter()
                    .map(|&h| (libm::atan2(self.direction(h).y, self.direction(h).x), h))
                    .collect();
                by_angle.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
                let half = by_angle.len() / 2;
                for i in 0..half {
                    self.join(by_angle[i].1, by_angle[i + half].1);
                }
            }
        }
    }

    /// Finds the pairing with the least total bend; of an odd number, one half-edge stays single.
    fn try_pairings(
        &self,
        open: &[u32],
        bend: f64,
        pairs: &mut Vec<(u32, u32)>,
        best: &mut (f64, Vec<(u32, u32)>),
    ) {
        if bend >= best.0 {
            return;
        }
        let Some((&first, rest)) = open.split_first() else {
            *best = (bend, pairs.clone());
            return;
        };
        for i in 0..rest.len() {
            let mut left = rest.to_vec();
            let second = left.remove(i);
            pairs.push((first, second));
            self.try_pairings(&left, bend + self.bend(first, second), pairs, best);
            pairs.pop();
        }
        if open.len() % 2 == 1 {
            self.try_pairings(rest, bend, pairs, best);
        }
    }

    /// Follows the stroke that leaves its vertex along `half_edge` until it ends or returns, calling
    /// `visit` with each half-edge in the direction of the walk.
    fn follow(&self, half_edge: u32, mut visit: impl FnMut(u32)) {
        let mut h = half_edge;
        loop {
            visit(h);
            h = self.mate[(h ^ 1) as usize];
            if h == NONE || h == half_edge {
                return;
            }
        }
    }

    fn walk(&self, stars: &IncidentEdges) -> Trails {
        let mut drawn = vec![false; self.graph.edges.len()];
        let mut trails = Trails::default();
        let n = self.graph.positions.len() as u32;
        for closed in [false, true] {
            for h in (0..n).flat_map(|vertex| stars.of(vertex)).copied() {
                if drawn[h as usize / 2] || (!closed && self.mate[h as usize] != NONE) {
                    continue;
                }
                trails.vertices.push(self.graph.edges[h as usize / 2][h as usize & 1]);
                self.follow(h, |h| {
                    drawn[h as usize / 2] = true;
                    trails.vertices.push(target(self.graph, h));
                });
                trails.ends.push(trails.vertices.len() as u32);
            }
        }
        trails
    }
}

/// Splices every closed trail into another trail of its part of the graph, if there is one.
fn splice_closed(pairing: &mut Pairing<'_>, stars: &IncidentEdges) {
    let mut sets = TrailSets::new(pairing, stars);
    if !sets.open.contains(&false) {
        return;
    }
    let mut splices: Vec<(f64, u32, u32)> = Vec::new();
    for vertex in 0..pairing.graph.positions.len() as u32 {
        let star = stars.of(vertex);
        if star.len() < 3 {
            continue;
        }
        let passes: Vec<u32> = star
            .iter()
            .copied()
            .filter(|&h| pairing.mate[h as usize] == NONE || h < pairing.mate[h as usize])
            .collect();
        for (i, &a) in passes.iter().enumerate() {
            let window = if star.len() <= MAX_DEGREE_GREEDY { passes.len() } else { i + 2 };
            for &c in passes.iter().take(window).skip(i + 1) {
                if sets.can_splice(a, c) {
                    splices.push((repairing(pairing, a, c).0, a, c));
                }
            }
        }
    }
    splices.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
    for (_, a, c) in splices {
        if sets.can_splice(a, c) {
            // Earlier splices at this vertex may have changed the pairs.
            let (_, [(p, q), (r, s)]) = repairing(pairing, a, c);
            for h in [p, q, r, s].into_iter().filter(|&h| h != NONE) {
                pairing.mate[h as usize] = NONE;
            }
            pairing.join(p, q);
            pairing.join(r, s);
            sets.unite(a, c);
        }
    }
}

/// The straighter of the two other pairings of the passes of `a` and `c` through their vertex, and how
/// much more it bends than the present one.
fn repairing(pairing: &Pairing<'_>, a: u32, c: u32) -> (f64, [(u32, u32); 2]) {
    let (b, d) = (pairing.mate[a as usize], pairing.mate[c as usize]);
    let now = pairing.bend(a, b) + pairing.bend(c, d);
    let first = pairing.bend(a, c) + pairing.bend(b, d);
    let second = pairing.bend(a, d) + pairing.bend(b, c);
    if first <= second { (first - now, [(a, c), (b, d)]) } else { (second - now, [(a, d), (b, c)]) }
}

/// Which trails have been spliced together.
struct TrailSets {
    trail_of_edge: Vec<u32>,
    sets: DisjointSets,
    /// Whether a set holds an open trail; valid at its root.
    open: Vec<bool>,
}

impl TrailSets {
    fn new(pairing: &Pairing<'_>, stars: &IncidentEdges) -> Self {
        let mut trail_of_edge = vec![NONE; pairing.graph.edges.len()];
        let mut open = Vec::new();
        for closed in [false, true] {
            for vertex in 0..pairing.graph.positions.len() as u32 {
                for &h in stars.of(vertex) {
                    let new = trail_of_edge[h as usize / 2] == NONE;
                    if new && (closed || pairing.mate[h as usize] == NONE) {
                        let trail = open.len() as u32;
                        pairing.follow(h, |h| trail_of_edge[h as usize / 2] = trail);
                        open.push(!closed);
                    }
                }
            }
        }
        Self { trail_of_edge, sets: DisjointSets::new(open.len()), open }
    }

    fn root(&mut self, half_edge: u32) -> u32 {
        self.sets.of(self.trail_of_edge[half_edge as usize / 2])
    }

    /// Whether two half-edges are of different sets of which one is closed: two open trails that
    /// cross only swap their ends when spliced.
    fn can_splice(&mut self, a: u32, c: u32) -> bool {
        let (a, c) = (self.root(a), self.root(c));
        a != c && !(self.open[a as usize] && self.open[c as usize])
    }

    fn unite(&mut self, a: u32, c: u32) {
        let [a, c] = [a, c].map(|half_edge| self.trail_of_edge[half_edge as usize / 2]);
        let [kept, gone] = self.sets.unite(a, c);
        self.open[kept as usize] |= self.open[gone as usize];
    }
}
