//! How close the drawn lines of a surface are to its formulas, with a proof by enclosures.

use std::fmt;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::bound::PaperBound;
use super::certified_cells::certify_cells;
use super::certified_line::{CertifiedLine, LineCertificate};
use super::options::SurfaceLines;
use crate::surface::formula::{Axis, Interval, JetGraph};
use crate::surface::{Lattice, Places, SampledSurface, SheetJets};

/// What is proven about a drawing of formulas.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Certificate {
    /// The greatest distance of a certified chord from the function, in millimeters on paper.
    pub bound_mm: f64,
    /// Chords of drawn lines.
    pub chords: usize,
    /// How many of these are not certified.
    pub uncertified_chords: usize,
    /// Cells between lines, each of two triangles, that hide what is behind them.
    pub cells: usize,
    /// How many of these are not certified.
    pub uncertified_cells: usize,
    /// Places on drawn lines where the surface is torn open.
    pub tears: usize,
    /// How often formulas were enclosed.
    pub jets: usize,
    /// The place of the first chord that is not certified, by x and y or u and v.
    pub first: Option<DVec2>,
}

impl Certificate {
    /// Whether every chord of a drawn line is as close as requested.
    pub fn holds(&self) -> bool {
        self.uncertified_chords == 0
    }
}

impl fmt::Display for Certificate {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.holds() {
            let rounded_up = (self.bound_mm * 1000.0).ceil() / 1000.0;
            write!(f, "lines within {rounded_up} mm of the function (certified)")?;
        } else {
            let Self { uncertified_chords, chords, .. } = self;
            write!(f, "{uncertified_chords} of {chords} pieces of lines are not certified")?;
            if let Some(p) = self.first {
                write!(f, ", first near ({}, {})", brief(p.x), brief(p.y))?;
            }
        }
        match self.tears {
            0 => Ok(()),
            1 => write!(f, "; 1 tear of a line left open"),
            n => write!(f, "; {n} tears of lines left open"),
        }
    }
}

/// A number with at most three significant digits.
fn brief(number: f64) -> f64 {
    format!("{number:.2e}").parse().unwrap_or(number)
}

/// More samples that lines need.
#[derive(Debug, Clone, Default)]
pub(super) struct Needs {
    /// Into how many parts each cell between own lines is divided, along both axes.
    pub(super) parts: [Vec<u32>; 2],
    /// Further places along both axes, in rising order.
    pub(super) further: [Vec<f64>; 2],
}

/// The formulas of a surface, and how it is sampled and seen.
pub(super) struct Certifier<'a> {
    pub(super) sheets: &'a [SheetJets],
    pub(super) sampled: &'a SampledSurface,
    /// What coordinates are multiplied by to be drawn; `sampled` may have other factors.
    pub(super) factors: DVec3,
    /// The heights that are drawn, before any scaling, if not all are.
    pub(super) heights: Option<(f64, f64)>,
    pub(super) paper: &'a PaperBound,
    pub(super) lines: &'a SurfaceLines,
}

impl Certifier<'_> {
    /// Certifies all drawn lines and, unless it searches, the cells between them. What fails is searched
    /// for the samples it needs if `searches` is set.
    pub(super) fn certify(&self, searches: bool) -> (Certificate, Needs) {
        let Some(places) = self.sampled.places() else { return Default::default() };
        let mut certificate = Certificate::default();
        let mut needs = Needs {
            parts: [Axis::First, Axis::Second].map(|axis| vec![1; places.along(axis).len() - 1]),
            ..Needs::default()
        };
        for (sheet, lattice) in self.sheets.iter().zip(self.sampled.lattices()) {
            for (axis, is_wanted) in
                [(Axis::First, self.lines.along_x), (Axis::Second, self.lines.along_y)]
            {
                if is_wanted {
                    let found = self.family(sheet, &lattice, places, axis, searches);
                    found.into_iter().for_each(|(at, line)| {
                        certificate.add(places, axis, at, &line);
                        needs.add(axis, line);
                    });
                }
            }
        }
        for further in &mut needs.further {
            further.sort_unstable_by(f64::total_cmp);
            further.dedup();
        }
        (certificate, needs)
    }

    /// Adds what is known about the cells between lines.
    pub(super) fn certify_cells(&self, certificate: &mut Certificate) {
        let Some(places) = self.sampled.places() else { return };
        for (sheet, lattice) in self.sheets.iter().zip(self.sampled.lattices()) {
            let point = |k: usize| self.point(&lattice, k);
            let scales = self.factors.to_array();
            let allowed = self.lines.smoothness_mm;
            let known = certify_cells(sheet, scales, places, &point, self.paper, allowed);
            certificate.cells += known.cells;
            certificate.uncertified_cells += known.failed;
            certificate.jets += known.jets;
        }
    }

    fn point(&self, lattice: &Lattice, k: usize) -> DVec3 {
        let (p, of_sampled) = (lattice.sample(k), self.sampled.factors());
        if of_sampled == self.factors { p } else { p / of_sampled * self.factors }
    }

    /// The drawn lines of a family: the number of each, and what is known about it.
    pub(super) fn family(
        &self,
        sheet: &SheetJets,
        lattice: &Lattice,
        places: &Places,
        axis: Axis,
        searches: bool,
    ) -> Vec<(usize, LineCertificate)> {
        let across = axis.other();
        let drawn = places.drawn(across, self.lines.every);
        let n_columns = places.along(Axis::First).len();
        let lines: Vec<usize> = (0..drawn.len()).filter(|&k| drawn[k]).collect();
        let graphs: Vec<(usize, &JetGraph, f64)> = match sheet {
            SheetJets::Height(z) => vec![(2, z, self.factors.z)],
            SheetJets::Space(all) => {
                all.iter().enumerate().map(|(k, graph)| (k, graph, self.factors[k])).collect()
            }
        };
        let of_line = |line: usize| {
            let formulas = graphs.iter().map(|&(of, graph, scale)| {
                let mut jets = graph.along(axis);
                jets.go_to(places.along(across)[line]);
                (of, jets, scale)
            });
            let sample = |k: usize| match axis {
                Axis::First => self.point(lattice, line * n_columns + k),
                Axis::Second => self.point(lattice, k * n_columns + line),
            };
            let is_torn = |k: usize| match axis {
                Axis::First => lattice.is_torn(line * n_columns + k - 1, line * n_columns + k),
                Axis::Second => lattice.is_torn((k - 1) * n_columns + line, k * n_columns + line),
            };
            let mut certified = CertifiedLine {
                paper: self.paper,
                formulas: formulas.collect(),
                places: places.along(axis),
                points: (0..places.along(axis).len()).map(sample).collect(),
                torn: (1..places.along(axis).len()).map(is_torn).collect(),
                heights: self.heights.map(|(low, high)| {
                    let (a, b) = (low * self.factors.z, high * self.factors.z);
                    Interval::new(a.min(b), a.max(b))
                }),
                allowed_mm: self.lines.smoothness_mm,
            };
            (line, certified.certify(searches))
        };
        lines.into_par_iter().map(of_line).collect()
    }
}

impl Certificate {
    fn add(&mut self, places: &Places, axis: Axis, at: usize, line: &LineCertificate) {
        self.chords += line.n_chords;
        self.uncertified_chords += line.failed.len();
        self.bound_mm = self.bound_mm.max(line.bound_mm);
        self.tears += line.n_torn;
        self.jets += line.n_jets;
        if let (None, Some(&cell)) = (self.first, line.failed.first()) {
            let (along, across) = (places.along(axis), places.along(axis.other()));
            let middle = 0.5 * (along[cell as usize] + along[cell as usize + 1]);
            self.first = Some(match axis {
                Axis::First => DVec2::new(middle, across[at]),
                Axis::Second => DVec2::new(across[at], middle),
            });
        }
    }
}

impl Needs {
    fn add(&mut self, axis: Axis, line: LineCertificate) {
        let parts = &mut self.parts[axis as usize];
        for (cell, n) in line.parts {
            parts[cell as usize] = parts[cell as usize].max(n);
        }
        self.further[axis as usize].extend(line.further);
    }

    /// Whether the samples suffice.
    pub(super) fn are_none(&self) -> bool {
        self.parts.iter().flatten().all(|n| *n == 1) && self.further.iter().all(Vec::is_empty)
    }
}
