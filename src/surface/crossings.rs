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
use super::root::Bracket;

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
/// above it. All crossings take a step together.
fn roots(
    function: &HeightFunction,
    crossings: &[Crossing],
    brackets: &[(f64, f64)],
    places: &mut [f64],
) {
    let begin = |(k, given): (usize, &Crossing)| {
        let (from, to) = brackets[k];
        let below = if from > 0.0 { -f64::MIN_POSITIVE } else { given.low.z - given.level };
        (k, Bracket::new((from, below), (to, given.high.z - given.level)))
    };
    let mut active: Vec<(usize, Bracket)> = crossings.iter().enumerate().map(begin).collect();
    let (mut xs, mut ys, mut zs) = (Vec::new(), Vec::new(), Vec::new());
    while !active.is_empty() {
        xs.clear();
        ys.clear();
        for (k, bracket) in &active {
            let Crossing { low, high, .. } = crossings[*k];
            let place = low + bracket.next() * (high - low);
            xs.push(place.x);
            ys.push(place.y);
        }
        zs.resize(xs.len(), 0.0);
        function.heights(&xs, &ys, &mut zs);
        let mut values = zs.iter();
        active.retain_mut(|(k, bracket)| {
            let crossing = &crossings[*k];
            let value = values.next().map_or(f64::NAN, |z| z - crossing.level);
            let found =
                if value.is_nan() { Some(crossing.straight()) } else { bracket.step(value) };
            if let Some(t) = found {
                places[*k] = t;
            }
            found.is_none()
        });
    }
}
