//! Stroke optimization: no doubled ink, the fewest strokes, little pen-up travel.
//!
//! ```text
//!  lines ─► graph ─────► overlap ────► trails ───► simplify ─► order ─► lines
//!           where they   shared ink    fewest,     fewer       short
//!           meet         once          straightest points      travel
//! ```
//!
//! Each layer belongs to one pen and is processed separately. [`estimate`] computes how long the result takes
//! on a machine. Memory grows with the points of the largest layer: a line of a million segments takes 210 MB
//! in all.

use std::time::Duration;

use glam::DVec2;
use rayon::prelude::*;

use crate::plot::{Plot, Polylines};

mod graph;
pub use graph::{Graph, Joints};

mod overlap;
pub use overlap::remove_overlaps;

mod trails;
pub use trails::{Trails, trails};

mod simplify;

mod nearest;

mod greedy;

mod tour;

mod order;
use order::order_watched;
pub use order::{Ordered, order};

pub mod estimate;

mod near_overlap;
pub use near_overlap::{NearOverlap, near_overlap};

mod split;
pub use split::split_by_distance;

/// The default join tolerance for strokes from a file: coordinates with three decimals put a point that two
/// strokes share up to two micrometers apart along an axis. The last picometer is for binary numbers, which
/// only approximate decimal ones. A joint is the center of the box of its points, whose diagonal is at most
/// this long, so ink moves by at most half of it, a micrometer.
pub const JOIN_TOLERANCE_MM: f64 = 0.002_000_000_001;

/// The default overlap tolerance for drawings: half of the last digit written.
pub const OVERLAP_MM: f64 = 0.0005;

/// How long to search for a stroke order with little pen-up travel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// Strokes stay in the order in which they were joined.
    None,
    /// Nearest stroke first, then 2-opt and Or-opt.
    Fast,
    /// The same, then a number of random changes that grows with the number of strokes.
    Best,
    /// The same for this long: the only effort whose result depends on the clock.
    Within(Duration),
}

impl Effort {
    /// Random changes to try on `n` strokes.
    fn n_changes(self, n: usize) -> u64 {
        let n = n as u64;
        match self {
            Self::None => 0,
            Self::Fast => {
                if n <= 2_000 {
                    500
                } else {
                    0
                }
            }
            Self::Best => (20_000 + 3 * n).min(200 * n),
            Self::Within(_) => u64::MAX,
        }
    }
}

/// What to do with a drawing's strokes; lengths in page millimeters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OptimizeOptions {
    /// Points at most this far apart are one joint; zero joins equal points only, and `None` joins nothing
    /// and keeps doubled ink.
    pub join_tolerance_mm: Option<f64>,
    /// Ink that runs along other ink at most this far from it is drawn once; zero finds exactly
    /// collinear ink only.
    pub overlap_mm: f64,
    /// How far points left out may be from the stroke; zero leaves out exactly collinear ones.
    pub simplify_mm: f64,
    /// Strokes shorter than this are dropped, and strokes whose ends are closer than this are closed. Zero
    /// does neither.
    pub shortest_mm: f64,
    /// Keep the strokes of a layer where joining would only cut them into more, to save less than
    /// [`HARDLY_ANY_INK`] of the ink.
    pub keeps_fewer: bool,
    /// How long to search for a better stroke order.
    pub effort: Effort,
}

/// The share of the ink for which it is not worth cutting a stroke.
pub const HARDLY_ANY_INK: f64 = 0.01;

impl OptimizeOptions {
    /// For new drawings: joints are equal points, ink overlaps if it deviates by less than the digits
    /// written, and carefully joined strokes are not cut for nothing.
    pub fn for_drawings() -> Self {
        Self {
            join_tolerance_mm: Some(0.0),
            overlap_mm: OVERLAP_MM,
            keeps_fewer: true,
            ..Self::default()
        }
    }

    /// How long to search for a better stroke order.
    #[must_use]
    pub fn effort(self, effort: Effort) -> Self {
        Self { effort, ..self }
    }

    /// Joins ends at most this far apart, in millimeters.
    #[must_use]
    pub fn join_tolerance_mm(self, tolerance_mm: f64) -> Self {
        Self { join_tolerance_mm: Some(tolerance_mm), ..self }
    }

    /// Draws ink at most this far from other ink of the same pen only once, in millimeters.
    #[must_use]
    pub fn overlap_mm(self, overlap_mm: f64) -> Self {
        Self { overlap_mm, ..self }
    }

    /// Removes points at most this far from the simplified stroke, in millimeters.
    #[must_use]
    pub fn simplify_mm(self, simplify_mm: f64) -> Self {
        Self { simplify_mm, ..self }
    }

    /// Whether strokes stay unchanged, except for points on straight lines.
    pub fn is_idle(&self) -> bool {
        self.join_tolerance_mm.is_none()
            && self.effort == Effort::None
            && self.simplify_mm == 0.0
            && self.shortest_mm == 0.0
    }
}

impl Default for OptimizeOptions {
    /// For strokes from a file: joints are points that are near, and only exactly collinear ink
    /// overlaps, since rounded coordinates can also put distinct lines close together.
    fn default() -> Self {
        Self {
            join_tolerance_mm: Some(JOIN_TOLERANCE_MM),
            overlap_mm: 0.0,
            simplify_mm: 0.0,
            shortest_mm: 0.0,
            keeps_fewer: false,
            effort: Effort::Fast,
        }
    }
}

/// Joins, simplifies and orders the strokes of every layer; returns the new page and the random
/// changes that were tried on all of them.
pub fn optimize(plot: &Plot, options: &OptimizeOptions) -> (Plot, u64) {
    optimize_watched(plot, options, &mut |_| ())
}

/// Like [`optimize`], and reports the share of the work that is done to `watch` as it grows from 0 to 1.
pub fn optimize_watched(
    plot: &Plot,
    options: &OptimizeOptions,
    watch: &mut Watch<'_>,
) -> (Plot, u64) {
    let n_points: usize = plot.layers.iter().map(|layer| layer.lines.n_points()).sum();
    let (mut n_changes, mut n_done) = (0, 0);
    let layers = plot
        .layers
        .iter()
        .map(|layer| {
            let n = layer.lines.n_points();
            let mut within = |share: f64| {
                watch((n_done as f64 + share * n as f64) / n_points.max(1) as f64);
            };
            let ordered = joined_and_ordered(&layer.lines, None, options, &mut within);
            n_done += n;
            n_changes += ordered.n_changes;
            layer.with_lines(ordered.lines)
        })
        .collect();
    (plot.with_layers(layers), n_changes)
}

/// Receives the share of the work that is done, from 0 to 1.
pub type Watch<'a> = dyn FnMut(f64) + 'a;

/// Share of the work that is done when strokes are joined and are yet to be ordered.
const JOINED: f64 = 0.3;

/// Joins, simplifies and orders one pen's strokes.
///
/// `numbers` may give each point of each stroke, in order, the number of the vertex it is; points
/// of equal number, and equal points, are then the joints, and the join tolerance is not used.
pub fn optimize_lines(
    lines: &Polylines,
    numbers: Option<&[u32]>,
    options: &OptimizeOptions,
) -> Ordered {
    joined_and_ordered(lines, numbers, options, &mut |_| ())
}

fn joined_and_ordered(
    lines: &Polylines,
    numbers: Option<&[u32]>,
    options: &OptimizeOptions,
    watch: &mut Watch<'_>,
) -> Ordered {
    watch(0.0);
    let joined = match options.join_tolerance_mm {
        None => simplified(lines.iter().map(|line| (line.to_vec(), None)), options),
        Some(tolerance) => {
            let joints = numbers.map_or(Joints::Near(tolerance), Joints::Numbered);
            let mut graph = Graph::new(lines, joints);
            watch(JOINED / 3.0);
            remove_overlaps(&mut graph, options.overlap_mm);
            watch(2.0 * JOINED / 3.0);
            let trails = trails(&graph);
            let n_strokes = trails.len() + graph.dots.len();
            let is_kept = options.keeps_fewer
                && n_strokes > lines.len()
                && graph.length_mm() > (1.0 - HARDLY_ANY_INK) * lines.length_mm();
            if is_kept {
                let kept = simplified(lines.iter().map(|line| (line.to_vec(), None)), options);
                return order_watched(kept, options.effort, &mut |share| {
                    watch(JOINED + (1.0 - JOINED) * share);
                });
            }
            let degree = degrees(&graph);
            let strokes = trails.iter().map(|trail| {
                let points = trail.iter().map(|&v| graph.position(v)).collect();
                let joints = trail.iter().map(|&v| degree[v as usize] != 2).collect();
                (points, Some(joints))
            });
            let dots = graph.dots.iter().map(|&v| (vec![graph.position(v); 2], None));
            simplified(strokes.chain(dots), options)
        }
    };
    order_watched(joined, options.effort, &mut |share| watch(JOINED + (1.0 - JOINED) * share))
}

/// Edges that end at each vertex.
fn degrees(graph: &Graph) -> Vec<u32> {
    let mut degrees = vec![0; graph.positions.len()];
    for &v in graph.edges.iter().flatten() {
        degrees[v as usize] += 1;
    }
    degrees
}

/// This many strokes are simplified at a time, to limit memory.
const TOGETHER: usize = 1024;

/// Strokes with fewer points, without the shortest; joints are kept.
fn simplified(
    strokes: impl Iterator<Item = (Vec<DVec2>, Option<Vec<bool>>)>,
    options: &OptimizeOptions,
) -> Polylines {
    let shortened = |(points, joints): (Vec<DVec2>, Option<Vec<bool>>)| {
        let is_joint = |i: usize| joints.as_ref().is_some_and(|joints| joints[i]);
        let mut line = simplify::simplify(&points, is_joint, options.simplify_mm);
        if options.shortest_mm > 0.0 {
            let length: f64 = line.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            if length < options.shortest_mm {
                return Vec::new();
            }
            if let (Some(&first), Some(&last)) = (line.first(), line.last())
                && line.len() > 2
                && first != last
                && first.distance(last) < options.shortest_mm
            {
                line.push(first);
            }
        }
        line
    };
    let mut result = Polylines::default();
    let mut strokes = strokes.peekable();
    while strokes.peek().is_some() {
        let together: Vec<_> = strokes.by_ref().take(TOGETHER).collect();
        let lines: Vec<Vec<DVec2>> = together.into_par_iter().map(shortened).collect();
        lines.into_iter().for_each(|line| result.push(line));
    }
    result
}
