//! The triangles between lines: how far the surface that hides is from the function.
//!
//! Over a cell of hx × hy, cut along either diagonal, |f − triangle| is at most
//! (hx² sup|f_xx| + 2 hx hy sup|f_xy| + hy² sup|f_yy|)/8 (D. Filip, R. Magedson and R. Markot, "Surface
//! algorithms using bounds on derivatives", CAGD 3, 1986). Jets along both sides and the diagonal of the
//! cell give all three terms.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::bound::{PaperBound, SeenPoint};
use crate::surface::formula::{Axis, Class, Interval, Jet, JetGraph};
use crate::surface::{Places, SheetJets};

/// Cells along both sides of a block that is enclosed at once.
const BLOCK: usize = 8;

/// Jets for each block on average that are spent on cells at most.
const JETS_PER_BLOCK: usize = 24;

/// What is known about the cells of a sheet.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct CellCertificate {
    /// Cells without holes.
    pub(super) cells: usize,
    /// Those whose triangles may be farther from the function than allowed.
    pub(super) failed: usize,
    /// Evaluations of jets.
    pub(super) jets: usize,
}

struct Cells<'a> {
    graphs: Vec<(usize, &'a JetGraph, f64)>,
    places: &'a Places,
    point: &'a (dyn Fn(usize) -> DVec3 + Sync),
    paper: &'a PaperBound,
    allowed_mm: f64,
}

/// Certifies the cells of a sheet; `scales` are those of x, y and z.
pub(super) fn certify_cells(
    sheet: &SheetJets,
    scales: [f64; 3],
    places: &Places,
    point: &(dyn Fn(usize) -> DVec3 + Sync),
    paper: &PaperBound,
    allowed_mm: f64,
) -> CellCertificate {
    let graphs = match sheet {
        SheetJets::Height(z) => vec![(2, z, scales[2])],
        SheetJets::Space(all) => (0..3).map(|k| (k, &all[k], scales[k])).collect(),
    };
    let cells = Cells { graphs, places, point, paper, allowed_mm };
    let (nx, ny) = places.size();
    let rows = (ny - 1).div_ceil(BLOCK);
    let of_row = |row: usize| {
        let mut known = CellCertificate::default();
        let mut room = Vec::new();
        let (first, end) = (row * BLOCK, ((row + 1) * BLOCK).min(ny - 1));
        for start in (0..nx - 1).step_by(BLOCK) {
            let columns = start..(start + BLOCK).min(nx - 1);
            let budget = (start / BLOCK + 1) * JETS_PER_BLOCK;
            cells.block(columns, first..end, budget, &mut room, &mut known);
        }
        known
    };
    let add = |a: CellCertificate, b: CellCertificate| CellCertificate {
        cells: a.cells + b.cells,
        failed: a.failed + b.failed,
        jets: a.jets + b.jets,
    };
    (0..rows).into_par_iter().map(of_row).reduce(CellCertificate::default, add)
}

impl Cells<'_> {
    fn block(
        &self,
        columns: Range<usize>,
        rows: Range<usize>,
        budget: usize,
        room: &mut Vec<Jet>,
        known: &mut CellCertificate,
    ) {
        let nx = self.places.size().0;
        let ends = |range: &Range<usize>, along: &[f64]| {
            let (a, b) = (along[range.start], along[range.end]);
            Interval::new(a.min(b), a.max(b))
        };
        let (xs, ys) = (self.places.along(Axis::First), self.places.along(Axis::Second));
        let longest = |range: &Range<usize>, along: &[f64]| {
            range.clone().map(|k| (along[k + 1] - along[k]).abs()).fold(0.0, f64::max)
        };
        let (hx, hy) = (longest(&columns, xs), longest(&rows, ys));
        let mut corners: Vec<(SeenPoint, DVec3)> = Vec::new();
        let mut n_whole = 0;
        for j in rows.clone() {
            for i in columns.clone() {
                let k = j * nx + i;
                let points = [k, k + 1, k + nx, k + nx + 1].map(self.point);
                let seen = points.map(|p| self.paper.see(p));
                if seen.iter().all(Option::is_some) {
                    n_whole += 1;
                    corners.extend(seen.into_iter().flatten().zip(points));
                }
            }
        }
        if n_whole == 0 {
            return;
        }
        let boxed = (ends(&columns, xs), ends(&rows, ys));
        let mut off = DVec3::ZERO;
        for &(axis, graph, scale) in &self.graphs {
            let jets = [[hx, 0.0], [0.0, hy], [hx, hy]]
                .map(|along| graph.over(boxed.0, boxed.1, along, room));
            known.jets += 3;
            let heights = corners.iter().map(|(_, p)| p[axis]);
            let range = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| {
                (low.min(z), high.max(z))
            });
            off[axis] = off_triangles(&jets, scale, range);
        }
        let seen: Vec<SeenPoint> = corners.iter().map(|(seen, _)| *seen).collect();
        let is_single = columns.len() == 1 && rows.len() == 1;
        if self.paper.on_paper(&seen, off) <= self.allowed_mm {
            known.cells += n_whole;
        } else if is_single || known.jets > budget {
            known.cells += n_whole;
            known.failed += n_whole;
        } else {
            let halves = |range: Range<usize>| {
                let middle = range.start + range.len().div_ceil(2);
                [range.start..middle, middle..range.end]
            };
            for rows in halves(rows) {
                for columns in halves(columns.clone()) {
                    if !rows.is_empty() && !columns.is_empty() {
                        self.block(columns, rows.clone(), budget, room, known);
                    }
                }
            }
        }
    }
}

/// How far a function with these jets along both sides and the diagonal of a cell is from its triangles,
/// whose corners are in a range of heights.
fn off_triangles(jets: &[Jet; 3], scale: f64, (low, high): (f64, f64)) -> f64 {
    let [x, y, both] = jets;
    let mut off = f64::INFINITY;
    if both.class >= Class::Continuous {
        let value = both.value.times(scale);
        off = (value.high - low).max(high - value.low);
    }
    if both.class == Class::Smooth {
        let mixed = both.second - x.second - y.second;
        let sum = x.second.largest() + y.second.largest() + mixed.largest();
        off = off.min(sum * scale.abs() / 8.0 * (1.0 + 1e-12));
    }
    if off.is_nan() { f64::INFINITY } else { off }
}
