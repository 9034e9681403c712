//! Ink that nearly lies on other ink: what a larger overlap tolerance would leave out.

use super::{Graph, JOIN_TOLERANCE_MM, Joints, remove_overlaps};
use crate::plot::{Plot, Polylines};

/// Tolerances that are tried, in millimeters. Pens are ten times as wide.
const TOLERANCES_MM: [f64; 4] = [0.002, 0.005, 0.01, 0.02];
/// Share of the ink that must be saved to be worth a word.
const LEAST_SHARE: f64 = 0.02;
/// Share of the possible saving that a tolerance must reach to be proposed.
const ENOUGH: f64 = 0.9;
/// Points beyond which the search would take longer than the drawing's own order.
const MAX_POINTS: usize = 200_000;

/// A tolerance that would leave out ink that is drawn twice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearOverlap {
    /// The tolerance in millimeters.
    pub tolerance_mm: f64,
    /// Length of the ink it would save in millimeters.
    pub saved_mm: f64,
}

/// Looks for ink within 0.02 mm of other ink of its pen that is not exactly on it, as rounded
/// coordinates put it. `None` if there is little of it, or the drawing is too large to try. Four times
/// the cost of [`remove_overlaps`] at most.
pub fn near_overlap(plot: &Plot) -> Option<NearOverlap> {
    let n_points: usize = plot.plotted_layers().map(|layer| layer.lines.n_points()).sum();
    if n_points > MAX_POINTS {
        return None;
    }
    let ink =
        |tolerance| plot.plotted_layers().map(|layer| ink_mm(&layer.lines, tolerance)).sum::<f64>();
    let exact = ink(0.0);
    let [smaller @ .., largest] = TOLERANCES_MM;
    let possible = exact - ink(largest);
    if possible <= LEAST_SHARE * exact {
        return None;
    }
    let tried = smaller
        .into_iter()
        .map(|tolerance_mm| NearOverlap { tolerance_mm, saved_mm: exact - ink(tolerance_mm) });
    let largest = NearOverlap { tolerance_mm: largest, saved_mm: possible };
    tried.chain([largest]).find(|found| found.saved_mm >= ENOUGH * possible)
}

/// Length of the ink when what overlaps is drawn once.
fn ink_mm(lines: &Polylines, tolerance_mm: f64) -> f64 {
    let mut graph = Graph::new(lines, Joints::Near(JOIN_TOLERANCE_MM));
    remove_overlaps(&mut graph, tolerance_mm);
    graph.length_mm()
}
