//! Where level curves cross the edges of triangles: on the function, where it is known, and otherwise
//! along the straight edge.
//!
//! ```text
//!        ╭───● high        The root of f − level between the ends of an edge. Its height is the
//!   ─ ─ ●─ ─ ─ ─ level     level's very own. Of several levels, a higher one is always crossed
//!      ╱                   farther from the lower end, so that triangles can be cut at all of
//!     ● low                them, however the function winds between the ends.
//! ```

use glam::DVec3;
use rayon::prelude::*;

use super::height_function::HeightFunction;

/// Roots are known to this part of an edge.
const ROOT_WIDTH: f64 = 1e-13;

/// A crossing to be found: of the edge from `low` to `high` with a level between their heights.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    pub(super) level: f64,
}

impl Crossing {
    /// Where the straight edge crosses, as a part of the way from its lower to its upper end.
    pub(super) fn straight(&self) -> f64 {
        // Halves, since the difference of two finite heights may overflow.
        let Self { low, high, level } = self;
        (level / 2.0 - low.z / 2.0) / (high.z / 2.0 - low.z / 2.0)
    }
}

/// Where the function crosses the levels, as parts of the ways from the lower to the upper ends: one
/// number for each crossing. Crossings of one edge follow each other with rising levels, and so do their
/// places. O(crossings), in parallel.
pub(super) fn places(function: &HeightFunction, crossings: &[Crossing]) -> Vec<f64> {
    const CHUNK: usize = 1024;
    let mut places = vec![0.0; crossings.len()];
    places.par_chunks_mut(CHUNK).zip(crossings.par_chunks(CHUNK)).for_each(
        |(places, crossings)| {
            let brackets = vec![(0.0, 1.0); crossings.len()];
            roots(function, crossings, &brackets, places);
        },
    );
    let is_same_edge = |a: &Crossing, b: &Crossing| a.low == b.low && a.high == b.high;
    let mut start = 0;
    for edge in crossings.chunk_by(is_same_edge) {
        let places = &mut places[start..start + edge.len()];
        start += edge.len();
        if places.is_sorted_by(|a, b| a < b) {
            continue;
        }
        // Between two crossings of neighboring levels lies one of each level between.
        let mut from = 0.0;
        for (crossing, place) in edge.iter().zip(places) {
            roots(function, &[*crossing], &[(from, 1.0)], std::slice::from_mut(place));
            *place = place.max(from);
            from = *place;
        }
    }
    places
}

/// The roots in the given brackets, at whose ends the function is taken to be below the level and
/// above it. By Chandrupatla's method: inverse quadratic interpolation where that is safe, and
/// bisection elsewhere (T. R. Chandrupatla, Advances in Engineering Software 28, 1997). All crossings
/// take a step together.
fn roots(
    function: &HeightFunction,
    crossings: &[Crossing],
    brackets: &[(f64, f64)],
    places: &mut [f64],
) {
    let begin = |(k, crossing): (usize, &Crossing)| Search::begin(k, crossing, brackets[k]);
    let mut active: Vec<Search> = crossings.iter().enumerate().map(begin).collect();
    let (mut xs, mut ys, mut zs) = (Vec::new(), Vec::new(), Vec::new());
    while !active.is_empty() {
        xs.clear();
        ys.clear();
        for search in &active {
            let Crossing { low, high, .. } = crossings[search.crossing];
            let place = low + search.t * (high - low);
            xs.push(place.x);
            ys.push(place.y);
        }
        zs.resize(xs.len(), 0.0);
        function.heights(&xs, &ys, &mut zs);
        let mut values = zs.iter();
        active.retain_mut(|search| {
            let crossing = &crossings[search.crossing];
            let value = values.next().map_or(f64::NAN, |z| z - crossing.level);
            let found = search.step(value, crossing);
            if let Some(t) = found {
                places[search.crossing] = t;
            }
            found.is_none()
        });
    }
}

/// A bracket that closes on a root: the last place `a`, the other end `b` of the bracket, and the place
/// `c` before.
struct Search {
    crossing: usize,
    a: (f64, f64),
    b: (f64, f64),
    /// The place to look at next.
    t: f64,
}

impl Search {
    fn begin(crossing: usize, given: &Crossing, (from, to): (f64, f64)) -> Self {
        let below = if from > 0.0 { -f64::MIN_POSITIVE } else { given.low.z - given.level };
        let above = given.high.z - given.level;
        let straight = below / (below - above);
        let t = if straight > 0.0 && straight < 1.0 {
            from + straight * (to - from)
        } else {
            0.5 * (from + to)
        };
        Self { crossing, a: (from, below), b: (to, above), t }
    }

    /// Takes the value at the place that was looked at; the root, once it is known.
    fn step(&mut self, value: f64, crossing: &Crossing) -> Option<f64> {
        if value.is_nan() {
            return Some(crossing.straight());
        }
        let new = (self.t, value);
        let c = if (value < 0.0) == (self.a.1 < 0.0) {
            std::mem::replace(&mut self.a, new)
        } else {
            let old = std::mem::replace(&mut self.a, new);
            std::mem::replace(&mut self.b, old)
        };
        let (a, b) = (self.a, self.b);
        let width = (b.0 - a.0).abs();
        let nearest = if a.1.abs() < b.1.abs() { a } else { b };
        if value == 0.0 || width <= 2.0 * ROOT_WIDTH {
            return Some(nearest.0);
        }
        let xi = (a.0 - b.0) / (c.0 - b.0);
        let phi = (a.1 - b.1) / (c.1 - b.1);
        let is_safe = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
        let part = if is_safe {
            let [fa, fb, fc] = [a.1, b.1, c.1];
            fa / (fb - fa) * fc / (fb - fc)
                + (c.0 - a.0) / (b.0 - a.0) * fa / (fc - fa) * fb / (fc - fb)
        } else {
            0.5
        };
        let least = (ROOT_WIDTH / width).min(0.5);
        let part = if part.is_nan() { 0.5 } else { part.clamp(least, 1.0 - least) };
        self.t = a.0 + part * (b.0 - a.0);
        None
    }
}
