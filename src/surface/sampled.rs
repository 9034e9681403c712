//! Surfaces as points: sampled, joined along seams and rims, and scaled.

use std::fmt;

use glam::DVec3;
use thiserror::Error;

use super::domain::TrimmedGrid;
use super::formula::Formula;
use super::grid::{Grid, GridError, Holes, parameters};
use super::height_function::HeightFunction;
use super::lattice_extent::lattice_extent;
use super::lined_mesh::{LatticeLines, LinedMesh, close_seams};
use super::source::{Aspect, Source, Surface};
use crate::camera::Camera;
use crate::extent::Extent;

/// Height of the drawn box as a part of the longer side of its base, with [`Aspect::Box`].
const BOX_HEIGHT: f64 = 0.4;

/// Rim points of two sheets at the same x and y are one point if their heights differ by at most this
/// part of the height of both sheets.
const RIM_TOLERANCE: f64 = 1e-6;

/// Why a surface has no samples that can be drawn.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SamplingError {
    /// The samples make no grid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// All samples are holes.
    #[error("no sample has a height")]
    NoHeights {
        /// Whether there are samples with heights, but none of them in the domain.
        outside_domain: bool,
    },
    /// The difference of two heights is too large for a number.
    #[error(
        "heights from {low:e} to {high:e} are too far apart to draw; divide the formula or file"
    )]
    TooFarApart {
        /// The lowest.
        low: f64,
        /// The highest.
        high: f64,
    },
    /// Scaled heights are too large for a number.
    #[error("heights times {factor:e} are too large to draw")]
    TooHigh {
        /// What they were to be multiplied by.
        factor: f64,
    },
}

/// A surface sampled at points. Its [`Display`](fmt::Display) says how many, for messages.
#[derive(Debug, Clone)]
pub struct SampledSurface {
    sheets: Samples,
    /// What the sheets were sampled from, if that is z = f(x, y).
    formulas: Vec<Formula>,
    z_factor: f64,
}

#[derive(Debug, Clone)]
enum Samples {
    /// One or more, over the same x and y.
    Grids(Vec<Grid>),
    /// One or more, each over a part of the plane. `n_joined` rim points of two sheets were moved to
    /// their mean height.
    Trimmed {
        grids: Vec<TrimmedGrid>,
        n_joined: usize,
    },
    Triangles {
        points: Vec<DVec3>,
        triangles: Vec<[u32; 3]>,
    },
    Lattice {
        n_columns: usize,
        points: Vec<DVec3>,
    },
}

/// Points in rows, of which neighbors are joined by lines.
pub struct Lattice<'a> {
    /// How many samples are in a row.
    pub n_columns: usize,
    /// How many samples there are.
    pub n_samples: usize,
    sample: Box<dyn Fn(usize) -> DVec3 + Sync + 'a>,
}

impl Lattice<'_> {
    /// The sample with this number, row by row. Panics when there is none.
    pub fn sample(&self, k: usize) -> DVec3 {
        (self.sample)(k)
    }

    /// How many rows there are.
    pub fn n_rows(&self) -> usize {
        self.n_samples / self.n_columns.max(1)
    }
}

impl Surface {
    /// Samples the surface; if it is given by formulas, with `refined` times as many cells along both
    /// axes as it says itself. O(samples), in parallel.
    ///
    /// # Errors
    /// See [`SamplingError`].
    pub fn sample(&self, refined: usize) -> Result<SampledSurface, SamplingError> {
        let finer = |n: usize| n.saturating_sub(1).saturating_mul(refined.max(1)).saturating_add(1);
        let n = (finer(self.samples.0), finer(self.samples.1));
        let sheets = match &self.source {
            Source::Formulas { formulas, domain: None } => self.everywhere(formulas, n)?,
            Source::Formulas { formulas, domain: Some(domain) } => {
                let grids = self.trimmed(formulas, Some(domain), n)?;
                if grids.iter().all(TrimmedGrid::is_whole) {
                    Samples::Grids(grids.iter().map(|g| g.grid().clone()).collect())
                } else {
                    joined_at_rim(grids)
                }
            }
            Source::Grid(grid) => Samples::Grids(vec![grid.clone()]),
            Source::Triangles { points, triangles } => {
                Samples::Triangles { points: points.clone(), triangles: triangles.clone() }
            }
            Source::Lattice { n_columns, points } => {
                Samples::Lattice { n_columns: *n_columns, points: points.clone() }
            }
            Source::Parametric { formulas, u, v } => lattice(formulas, *u, *v, n)?,
        };
        let formulas = match &self.source {
            Source::Formulas { formulas, .. } => formulas.clone(),
            _ => Vec::new(),
        };
        let mut surface = SampledSurface { sheets, formulas, z_factor: 1.0 };
        let (low, high) = surface.bounds();
        if low.x > high.x {
            return Err(SamplingError::NoHeights { outside_domain: self.has_heights_outside() });
        }
        let size = high - low;
        if !size.is_finite() {
            return Err(SamplingError::TooFarApart { low: low.z, high: high.z });
        }
        let fitted = BOX_HEIGHT * size.x.max(size.y) / size.z;
        let fits = self.aspect == Aspect::Box && fitted.is_finite() && fitted > 0.0;
        let factor = if fits { fitted } else { 1.0 } * self.z_scale;
        if !(low.z * factor).is_finite() || !(high.z * factor).is_finite() {
            return Err(SamplingError::TooHigh { factor });
        }
        surface.scale_heights(factor);
        Ok(surface)
    }

    /// Samples wherever their formulas have values; two that end at the same rim are joined there.
    fn everywhere(
        &self,
        formulas: &[Formula],
        n: (usize, usize),
    ) -> Result<Samples, SamplingError> {
        let sample = |formula| Grid::sample(formula, self.x, self.y, n);
        let grids = formulas.iter().map(sample).collect::<Result<Vec<_>, _>>()?;
        if grids.len() == 2 && grids.iter().any(|grid| grid.holes() != Holes::None) {
            let trimmed = self.trimmed(formulas, None, n)?;
            if let [one, other] = &trimmed[..]
                && one.shares_rim(other, rim_tolerance(&trimmed))
            {
                return Ok(joined_at_rim(trimmed));
            }
        }
        Ok(Samples::Grids(grids))
    }

    fn trimmed(
        &self,
        formulas: &[Formula],
        domain: Option<&Formula>,
        n: (usize, usize),
    ) -> Result<Vec<TrimmedGrid>, GridError> {
        let sample = |formula| TrimmedGrid::sample(formula, domain, self.x, self.y, n);
        formulas.iter().map(sample).collect()
    }

    /// Whether there is a domain, and samples have heights outside of it.
    fn has_heights_outside(&self) -> bool {
        let Source::Formulas { formulas, domain: Some(_) } = &self.source else { return false };
        let sample = |formula| Grid::sample(formula, self.x, self.y, self.samples);
        formulas.iter().any(|f| sample(f).is_ok_and(|grid| grid.heights().is_some()))
    }
}

fn lattice(
    formulas: &[Formula; 3],
    u: (f64, f64),
    v: (f64, f64),
    n: (usize, usize),
) -> Result<Samples, GridError> {
    let (us, vs) = parameters(u, v, n)?;
    let mut points = Vec::with_capacity(n.0 * n.1);
    for v in vs {
        let mut rows = [(); 3].map(|()| vec![0.0; us.len()]);
        for (formula, row) in formulas.iter().zip(&mut rows) {
            formula.values(&us, &vec![v; us.len()], row);
        }
        points.extend((0..us.len()).map(|i| DVec3::new(rows[0][i], rows[1][i], rows[2][i])));
    }
    close_seams(us.len(), &mut points);
    Ok(Samples::Lattice { n_columns: us.len(), points })
}

/// Samples whose rims meet up to rounding are joined there if there are two of them.
fn joined_at_rim(mut grids: Vec<TrimmedGrid>) -> Samples {
    let tolerance = rim_tolerance(&grids);
    let n_joined = match &mut grids[..] {
        [one, other] => one.meet_at_rim(other, tolerance),
        _ => 0,
    };
    Samples::Trimmed { grids, n_joined }
}

fn rim_tolerance(grids: &[TrimmedGrid]) -> f64 {
    let heights = grids.iter().filter_map(TrimmedGrid::heights);
    let (low, high) = heights
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (a, b)| (low.min(a), high.max(b)));
    RIM_TOLERANCE * (high - low)
}

impl SampledSurface {
    /// The factor that heights were multiplied by.
    pub fn z_factor(&self) -> f64 {
        self.z_factor
    }

    /// The (lowest, highest) corner of the box around all points; holes do not count.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let mut bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut add = |p: DVec3| bounds = (bounds.0.min(p), bounds.1.max(p));
        match &self.sheets {
            Samples::Grids(grids) => {
                for grid in grids {
                    let (xs, ys) = (grid.xs(), grid.ys());
                    if let Some((low, high)) = grid.heights() {
                        add(DVec3::new(xs[0], ys[0], low));
                        add(DVec3::new(xs[xs.len() - 1], ys[ys.len() - 1], high));
                    }
                }
            }
            Samples::Trimmed { grids, .. } => {
                for trimmed in grids {
                    let grid = trimmed.grid();
                    let n = grid.zs().len() as u32;
                    let inside = (0..n).map(|k| grid.point(k)).filter(|p| !p.z.is_nan());
                    inside.chain(trimmed.rim()).for_each(&mut add);
                }
            }
            Samples::Triangles { points, .. } | Samples::Lattice { points, .. } => {
                points.iter().filter(|p| p.is_finite()).for_each(|p| add(*p));
            }
        }
        bounds
    }

    /// What of the image the lines of its lattices take up; nothing for scattered points.
    pub fn extent(&self, camera: &Camera) -> Extent {
        let of = |lattice: &Lattice| {
            lattice_extent(lattice.n_columns, lattice.n_samples, &lattice.sample, camera)
        };
        self.lattices().iter().map(of).fold(Extent::EMPTY, Extent::union)
    }

    fn scale_heights(&mut self, factor: f64) {
        match &mut self.sheets {
            Samples::Grids(grids) => grids.iter_mut().for_each(|grid| grid.scale_heights(factor)),
            Samples::Trimmed { grids, .. } => {
                grids.iter_mut().for_each(|grid| grid.scale_heights(factor));
            }
            Samples::Triangles { points, .. } | Samples::Lattice { points, .. } => {
                points.iter_mut().for_each(|p| p.z *= factor);
            }
        }
        self.z_factor *= factor;
    }

    /// Its triangles with these lines, split for level curves at `levels` (see
    /// [`LinedMesh::for_levels`]). Scattered points have no grid lines: they have lines along all edges
    /// if triangles are to have them.
    pub fn lined(&self, lines: &LatticeLines, levels: &[f64]) -> LinedMesh {
        let mut mesh = LinedMesh::for_levels(levels);
        let is_traced = !levels.is_empty() && !lines.triangles;
        let formulas = if is_traced { &self.formulas[..] } else { &[] };
        let function = |sheet: usize| {
            let formula = formulas.get(sheet)?;
            Some(HeightFunction::new(formula.clone(), self.z_factor))
        };
        match &self.sheets {
            Samples::Grids(grids) => {
                for (sheet, grid) in grids.iter().enumerate() {
                    mesh.begin_sheet(function(sheet));
                    mesh.push_grid(grid, lines);
                }
            }
            Samples::Trimmed { grids, .. } => {
                for (sheet, grid) in grids.iter().enumerate() {
                    mesh.begin_sheet(function(sheet));
                    mesh.push_trimmed(grid, lines);
                }
            }
            Samples::Triangles { points, triangles } => {
                mesh.push_triangles(points, triangles, lines.triangles);
            }
            Samples::Lattice { n_columns, points } => mesh.push_lattice(*n_columns, points, lines),
        }
        mesh
    }

    /// The samples that grid lines run through, one lattice for each sheet.
    pub fn lattices(&self) -> Vec<Lattice<'_>> {
        fn of(grid: &Grid) -> Lattice<'_> {
            let sample = Box::new(|k: usize| grid.point(k as u32));
            Lattice { n_columns: grid.xs().len(), n_samples: grid.zs().len(), sample }
        }
        match &self.sheets {
            Samples::Grids(grids) => grids.iter().map(of).collect(),
            Samples::Trimmed { grids, .. } => grids.iter().map(|g| of(g.grid())).collect(),
            Samples::Lattice { n_columns, points } => {
                let sample = Box::new(|k: usize| points[k]);
                vec![Lattice { n_columns: *n_columns, n_samples: points.len(), sample }]
            }
            Samples::Triangles { .. } => Vec::new(),
        }
    }

    /// The sheets, if they are whole grids over rectangles; otherwise none.
    pub fn grids(&self) -> &[Grid] {
        match &self.sheets {
            Samples::Grids(grids) => grids,
            _ => &[],
        }
    }

    /// How many points on the rim of two sheets were moved to their mean height.
    pub fn n_rim_points_joined(&self) -> usize {
        match self.sheets {
            Samples::Trimmed { n_joined, .. } => n_joined,
            _ => 0,
        }
    }
}

impl fmt::Display for SampledSurface {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let size = |grid: Option<&Grid>| {
            grid.map_or_else(String::new, |grid| {
                format!("{} × {} samples", grid.xs().len(), grid.ys().len())
            })
        };
        match &self.sheets {
            Samples::Grids(grids) => write!(f, "{}", size(grids.first())),
            Samples::Trimmed { grids, .. } => {
                write!(f, "{}", size(grids.first().map(TrimmedGrid::grid)))
            }
            Samples::Triangles { points, triangles } => {
                write!(f, "{} points, {} triangles", points.len(), triangles.len())
            }
            Samples::Lattice { n_columns, points } => {
                write!(f, "{n_columns} × {} samples", points.len() / n_columns)
            }
        }
    }
}
