//! What faces cover together: squares of the image that no open seam runs through.
//!
//! ```text
//!    ┌───┬───┬───┐     each painted triangle counts along its sides, counter-clockwise; where two
//!    │  ╱│╲  │   │     triangles meet, the counts cancel and the seam between them closes. Those left
//!    ├─●─┼─╲─┼───┤     are the border of everything painted. In a square that no border enters, all
//!    │  ╲│  ●│   │     points are covered equally often: at least once if a painted triangle reaches
//!    └───┴───┴───┘     into it
//! ```
//!
//! That is the winding number of the border around a point, which equals the number of triangles over
//! it, since all of them run counter-clockwise. So a mesh of faces smaller than the squares covers them
//! too, except along its silhouettes. It need not be closed, and any number of faces may share an edge.

use glam::DVec2;
use rustc_hash::FxHashMap;

use super::occupancy::{LEVELS, Occupancy};

/// Squares along each side.
const SIDE: usize = 1 << LEVELS;

/// The open seams of what is painted, by the squares that they run through.
pub(super) struct Seams {
    low: DVec2,
    size: f64,
    rim: f64,
    /// For each edge from a lower to a higher vertex, how many more triangles run along it than against
    /// it; without zeros.
    turns: FxHashMap<[u32; 2], i32>,
    /// How many open seams run through each square.
    open: Vec<u32>,
    is_reached: Vec<bool>,
    /// Squares that a triangle changed.
    changed: Vec<u32>,
}

impl Seams {
    /// Nothing is painted.
    pub(super) fn new(occupancy: &Occupancy) -> Self {
        let (low, size) = occupancy.square();
        Self {
            low,
            size: size / SIDE as f64,
            rim: occupancy.rim(),
            turns: FxHashMap::default(),
            open: vec![0; SIDE * SIDE],
            is_reached: vec![false; SIDE * SIDE],
            changed: Vec::new(),
        }
    }

    /// The largest error of the images of corners. Open seams stay out of squares with twice this rim
    /// around them, so the true seams stay out with more than one and a half; a triangle that comes
    /// within one rim of such a square really reaches into it.
    pub(super) fn limit(&self) -> f64 {
        self.rim / 4.0
    }

    /// Adds a painted triangle, its corners counter-clockwise in the image, and marks what it covers. A
    /// triangle that reaches beyond the image is left out, which does no harm.
    pub(super) fn add(&mut self, corners: [(u32, DVec2); 3], occupancy: &mut Occupancy) {
        let places = corners.map(|(_, image)| (image - self.low) / self.size);
        let is_inside = |p: &DVec2| p.cmpge(DVec2::ZERO).all() && p.max_element() <= SIDE as f64;
        if !places.iter().all(is_inside) {
            return;
        }
        for from in 0..3 {
            let to = (from + 1) % 3;
            self.side([(corners[from].0, places[from]), (corners[to].0, places[to])]);
        }
        let mut changed = std::mem::take(&mut self.changed);
        for square in changed.drain(..) {
            if self.open[square as usize] == 0 && self.is_reached[square as usize] {
                occupancy.cover_square(square as usize % SIDE, square as usize / SIDE);
            }
        }
        self.changed = changed;
    }

    fn side(&mut self, [from, to]: [(u32, DVec2); 2]) {
        // In the same direction for both triangles, so that both note the same squares.
        let (low, high, turn) = if from.0 < to.0 { (from, to, 1) } else { (to, from, -1) };
        let turns = self.turns.entry([low.0, high.0]).or_default();
        let was_open = *turns != 0;
        *turns += turn;
        let is_open = *turns != 0;
        if !is_open {
            self.turns.remove(&[low.0, high.0]);
        }
        let rim = self.rim / self.size;
        let (open, changed) = (&mut self.open, &mut self.changed);
        if is_open && !was_open {
            squares(low.1, high.1, 2.0 * rim, |square| open[square] += 1);
            let is_reached = &mut self.is_reached;
            squares(low.1, high.1, rim, |square| is_reached[square] = true);
        } else if was_open && !is_open {
            squares(low.1, high.1, 2.0 * rim, |square| {
                open[square] -= 1;
                if open[square] == 0 {
                    changed.push(square as u32);
                }
            });
        }
    }
}

/// The squares that a segment comes closer to than `rim`, and some more.
fn squares(a: DVec2, b: DVec2, rim: f64, mut found: impl FnMut(usize)) {
    let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
    let number = |at: f64| (at.max(0.0) as usize).min(SIDE - 1);
    let across = b - a;
    for row in number(a.y - rim)..=number(b.y + rim) {
        let part =
            |y: f64| if across.y > 0.0 { ((y - a.y) / across.y).clamp(0.0, 1.0) } else { 0.0 };
        let (from, to) = match across.y > 0.0 {
            true => (part(row as f64 - rim), part(row as f64 + 1.0 + rim)),
            false => (0.0, 1.0),
        };
        let (from, to) = (a.x + across.x * from, a.x + across.x * to);
        for column in number(from.min(to) - rim)..=number(from.max(to) + rim) {
            found(row * SIDE + column);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fan of triangles around a point, all but one of them painted, then the last one.
    #[test]
    fn a_fan_of_small_faces_covers_once_it_is_closed() {
        let mut occupancy = Occupancy::new(DVec2::ZERO, DVec2::ONE);
        let mut seams = Seams::new(&occupancy);
        let p = |k: u32| {
            let angle = f64::from(k) / 40.0 * std::f64::consts::TAU;
            (k + 1, 0.5 + 0.4 * DVec2::new(libm::cos(angle), libm::sin(angle)))
        };
        let middle = (0, DVec2::splat(0.5));
        let (low, high) = (DVec2::splat(0.45), DVec2::splat(0.55));
        let mut paint = |triangle: [(u32, DVec2); 3], occupancy: &mut Occupancy| {
            occupancy.cover(&triangle.map(|(_, image)| image));
            seams.add(triangle, occupancy);
        };
        for k in 0..39 {
            paint([middle, p(k), p(k + 1)], &mut occupancy);
        }
        assert!(!occupancy.is_covered(low, high));
        assert!(occupancy.is_covered(DVec2::new(0.3, 0.45), DVec2::new(0.4, 0.55)));
        paint([middle, p(39), p(0)], &mut occupancy);
        // No single face covers any square along the seams.
        assert!(occupancy.is_covered(low, high));
        assert!(!occupancy.is_covered(low, DVec2::new(0.95, 0.55)));
    }

    #[test]
    fn a_fold_stays_open() {
        let mut occupancy = Occupancy::new(DVec2::ZERO, DVec2::ONE);
        let mut seams = Seams::new(&occupancy);
        let [a, b, c, d] =
            [(0.1, 0.1), (0.5, 0.9), (0.9, 0.1), (0.8, 0.2)].map(|(x, y)| DVec2::new(x, y));
        // Both lie on the right of the side from a to b.
        seams.add([(0, a), (2, c), (1, b)], &mut occupancy);
        seams.add([(0, a), (3, d), (1, b)], &mut occupancy);
        let middle = a.midpoint(b);
        assert!(!occupancy.is_covered(middle - 0.01, middle + 0.01));
    }
}
