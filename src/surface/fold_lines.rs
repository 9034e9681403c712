//! Which edges of triangles are drawn as folds.
//!
//! ```text
//!       ●                   The fold of the function runs along edges between triangles of different
//!      ╱ ╲   front          sides. A flat triangle beside it may still face the other way than its
//!   ──●═══●══●══ fold       function (shaded), most often where sight lines nearly run along the
//!      ╲▒╱   back           surface. The line then follows the outline of what hides, so that no line
//!       ●                   ends beside it, unless that leads far from the fold.
//! ```

use glam::DVec2;
use rustc_hash::{FxHashMap, FxHashSet};

/// Along rims, where surfaces may be steep, triangles that face the other way than their function are
/// followed only if they go no farther than this from a fold on paper, in millimeters: if it is smaller,
/// lines end beside folds; if larger, slivers at the rims of balls are drawn.
const FOLLOWED_MM: f64 = 0.5;

/// Longer segments, far beyond the page, are looked at in this many places only.
const MOST_CELLS: f64 = 1024.0;

/// A triangle beside a fold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct SidedTriangle {
    pub(super) corners: [u32; 3],
    /// The number of its sheet, from 1.
    pub(super) sheet: u16,
    /// Whether some corner is on a fold.
    pub(super) is_on_fold: bool,
    /// Whether its sheet has a rim.
    pub(super) has_rim: bool,
    /// Whether the function's upper side faces the eye.
    pub(super) side: bool,
    /// Whether its own upper side does.
    pub(super) is_front: bool,
}

impl SidedTriangle {
    fn edges(&self) -> [[u32; 2]; 3] {
        let [a, b, c] = self.corners;
        [[a, b], [b, c], [c, a]]
    }

    fn is_wrong(&self) -> bool {
        self.side != self.is_front
    }
}

/// An edge with the triangles along it, and whether they run along it from its lower to its higher end.
#[derive(Debug, Clone, Copy, Default)]
struct Sides {
    n: u32,
    triangles: [u32; 2],
    runs_up: [bool; 2],
}

/// The edges that are drawn as folds of these triangles, lower ends first, in order, and the sheets that
/// they are on. `image` gives places on paper in millimeters. O(triangles).
pub(super) fn fold_lines(
    triangles: &[SidedTriangle],
    image: impl Fn(u32) -> DVec2,
) -> Vec<([u32; 2], u16)> {
    let is_marked = |triangle: &&SidedTriangle| triangle.is_wrong() || triangle.is_on_fold;
    let marked: FxHashSet<u32> =
        triangles.iter().filter(is_marked).flat_map(|triangle| triangle.corners).collect();
    // All others are on the side that they face, and so are their neighbors.
    let is_beside = |triangle: &&SidedTriangle| {
        let is_marked = |vertex: &u32| marked.contains(vertex);
        triangle.corners.iter().any(is_marked)
    };
    let triangles: Vec<SidedTriangle> = triangles.iter().filter(is_beside).copied().collect();
    let mut edges: FxHashMap<[u32; 2], Sides> = FxHashMap::default();
    for (triangle, number) in triangles.iter().zip(0..) {
        for [a, b] in triangle.edges() {
            let sides = edges.entry([a.min(b), a.max(b)]).or_default();
            if let Some(known) = sides.triangles.get_mut(sides.n as usize) {
                *known = number;
                sides.runs_up[sides.n as usize] = a < b;
            }
            sides.n += 1;
        }
    }
    let is_fold = |edge: &[u32; 2]| {
        let Sides { n, triangles: of, runs_up } = edges[edge];
        // Sheets that meet at a rim are wound alike, so that one has its upper side below.
        let is_against = runs_up[0] == runs_up[1];
        let [one, other] = of.map(|triangle| triangles[triangle as usize].side);
        n == 2 && one != (other != is_against)
    };
    let mut is_drawn: FxHashMap<[u32; 2], bool> =
        edges.keys().filter(|edge| is_fold(edge)).map(|edge| (*edge, true)).collect();
    let near = NearFolds::new(is_drawn.keys().map(|edge| edge.map(&image)));
    let mut is_seen = vec![false; triangles.len()];
    for (start, triangle) in triangles.iter().enumerate() {
        if is_seen[start] || !triangle.is_wrong() {
            continue;
        }
        is_seen[start] = true;
        let mut part = vec![start];
        let mut next = 0;
        let mut border: Vec<[u32; 2]> = Vec::new();
        while next < part.len() {
            for [a, b] in triangles[part[next]].edges() {
                let edge = [a.min(b), a.max(b)];
                let Sides { n, triangles: of, .. } = edges[&edge];
                if n != 2 {
                    continue;
                }
                let across = if of[0] as usize == part[next] { of[1] } else { of[0] } as usize;
                if !triangles[across].is_wrong() {
                    border.push(edge);
                } else if !std::mem::replace(&mut is_seen[across], true) {
                    part.push(across);
                }
            }
            next += 1;
        }
        let is_near = |vertex: u32| near.holds(image(vertex));
        let is_followed = |triangle: usize| {
            let SidedTriangle { corners, has_rim, .. } = triangles[triangle];
            !has_rim || corners.into_iter().all(is_near)
        };
        if part.iter().all(|&triangle| is_followed(triangle)) {
            for edge in border {
                let drawn = is_drawn.entry(edge).or_insert(false);
                *drawn = !*drawn;
            }
        }
    }
    let sheet = |edge: &[u32; 2]| triangles[edges[edge].triangles[0] as usize].sheet;
    let mut drawn: Vec<([u32; 2], u16)> = is_drawn
        .iter()
        .filter(|(_, is_drawn)| **is_drawn)
        .map(|(edge, _)| (*edge, sheet(edge)))
        .collect();
    drawn.sort_unstable();
    drawn
}

/// The surroundings of folds on paper.
struct NearFolds {
    /// Segments by the cells of a square grid that they or their surroundings meet.
    cells: FxHashMap<[i64; 2], Vec<[DVec2; 2]>>,
}

impl NearFolds {
    /// Side of a cell in millimeters.
    const CELL: f64 = 1.0;

    fn new(segments: impl Iterator<Item = [DVec2; 2]>) -> Self {
        let mut cells: FxHashMap<[i64; 2], Vec<[DVec2; 2]>> = FxHashMap::default();
        for segment @ [a, b] in segments {
            // The cells around places no farther apart than a cell hold all that is near.
            let n = (a.distance(b) / Self::CELL).ceil().clamp(1.0, MOST_CELLS);
            let mut last = None;
            for k in 0..=n as u32 {
                let cell = Self::cell(a.lerp(b, f64::from(k) / n));
                if last.replace(cell) != Some(cell) {
                    cells.entry(cell).or_default().push(segment);
                }
            }
        }
        Self { cells }
    }

    fn cell(p: DVec2) -> [i64; 2] {
        (p / Self::CELL).floor().to_array().map(|at| at as i64)
    }

    fn holds(&self, p: DVec2) -> bool {
        let [x, y] = Self::cell(p);
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [i, j]));
        let cells =
            around.filter_map(|[i, j]| self.cells.get(&[x.saturating_add(i), y.saturating_add(j)]));
        cells.flatten().any(|segment| distance(p, *segment) <= FOLLOWED_MM)
    }
}

fn distance(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = b - a;
    let t = (p - a).dot(along) / along.length_squared();
    let t = if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a + t * along)
}
