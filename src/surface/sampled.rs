//! Surfaces as points.

use std::fmt;

use glam::DVec3;

use super::axis_scale::AxisScale;
use super::domain::TrimmedGrid;
use super::formula::Formula;
use super::grid::Grid;
use super::height_cut::HeightCut;
use super::lattice_extent::lattice_extent;
use super::places::Places;
use crate::camera::Camera;
use crate::extent::Extent;

/// A surface sampled at points. Its [`Display`](fmt::Display) shows how many, for messages.
#[derive(Debug, Clone)]
pub struct SampledSurface {
    pub(super) sheets: Samples,
    /// What the sheets were sampled from, if that is z = f(x, y).
    pub(super) formulas: Vec<Formula>,
    /// What the only sheet was sampled from, if that is x, y and z of u and v.
    pub(super) in_space: Option<[Formula; 3]>,
    pub(super) scales: [AxisScale; 3],
    /// The smallest and the largest value of each axis.
    pub(super) ranges: [(f64, f64); 3],
    pub(super) n_not_positive: usize,
    /// What coordinates were multiplied by so that the box has its proportions.
    pub(super) factors: DVec3,
    /// The lines of the lattice before that, if formulas were sampled.
    pub(super) places: Option<Places>,
    /// The requested range of heights, as drawn, and in values.
    pub(super) given_heights: Option<(f64, f64)>,
    pub(super) given_range: Option<(f64, f64)>,
    /// Where what is given by points is cut off.
    pub(super) cut: Option<HeightCut>,
}

#[derive(Debug, Clone)]
pub(super) enum Samples {
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
    trimmed: Option<&'a TrimmedGrid>,
}

impl Lattice<'_> {
    /// The sample with this number, row by row. Panics when there is none.
    pub fn sample(&self, k: usize) -> DVec3 {
        (self.sample)(k)
    }

    /// Whether the line between two neighbors is torn open.
    pub(crate) fn is_torn(&self, a: usize, b: usize) -> bool {
        self.trimmed.is_some_and(|trimmed| trimmed.is_torn(a as u32, b as u32))
    }

    /// How many rows there are.
    pub fn n_rows(&self) -> usize {
        self.n_samples / self.n_columns.max(1)
    }
}

impl SampledSurface {
    /// The lines of the lattice, if formulas were sampled, in coordinates before any was multiplied.
    pub(crate) fn places(&self) -> Option<&Places> {
        self.places.as_ref()
    }

    /// Whether a range of heights was requested.
    pub(crate) fn has_given_heights(&self) -> bool {
        self.given_heights.is_some()
    }

    /// The requested range of heights, from the smaller to the larger one.
    pub fn given_range(&self) -> Option<(f64, f64)> {
        self.given_range
    }

    /// The corners of the box around the surface: its [`bounds`](Self::bounds), but with the requested range
    /// of heights.
    pub fn box_bounds(&self) -> (DVec3, DVec3) {
        let (mut low, mut high) = self.bounds();
        if let Some((least, most)) = self.given_heights {
            low.z = if least.is_finite() { least } else { low.z };
            high.z = if most.is_finite() { most } else { high.z };
        }
        (low, high)
    }

    /// Whether heights seem to grow without bound somewhere and are cut off there.
    pub(crate) fn has_poles(&self) -> bool {
        match &self.sheets {
            Samples::Trimmed { grids, .. } => grids.iter().any(TrimmedGrid::has_poles),
            _ => false,
        }
    }

    /// What coordinates were multiplied by so that the box has its proportions.
    pub(crate) fn factors(&self) -> DVec3 {
        self.factors
    }

    /// How values became coordinates along x, y and z.
    pub fn scales(&self) -> &[AxisScale; 3] {
        &self.scales
    }

    /// The smallest and the largest value along x, y and z.
    pub fn ranges(&self) -> &[(f64, f64); 3] {
        &self.ranges
    }

    /// How many samples are holes because a value on a logarithmic axis is not above 0.
    pub fn n_not_positive(&self) -> usize {
        self.n_not_positive
    }

    /// Samples of formulas whose heights have no logarithm.
    pub(super) fn count_not_positive(&self) -> usize {
        let [of_x, of_y, _] = self.scales;
        let is_hole = |z: f64| z.is_nan();
        let count = |(formula, lattice): (&Formula, &Lattice)| {
            (0..lattice.n_samples)
                .map(|k| lattice.sample(k))
                .filter(|p| is_hole(p.z))
                .filter(|p| formula.value(of_x.value(p.x), of_y.value(p.y)) <= 0.0)
                .count()
        };
        self.formulas.iter().zip(&self.lattices()).map(count).sum()
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
        if let Some(cut) = &self.cut {
            bounds.0.z = bounds.0.z.max(cut.low);
            bounds.1.z = bounds.1.z.min(cut.high);
        }
        bounds
    }

    /// The extent of the lines of its lattices in the image; empty for scattered points.
    pub fn extent(&self, camera: &Camera) -> Extent {
        let of = |lattice: &Lattice| {
            lattice_extent(lattice.n_columns, lattice.n_samples, &lattice.sample, camera)
        };
        self.lattices().iter().map(of).fold(Extent::EMPTY, Extent::union)
    }

    pub(super) fn scale_by(&mut self, factors: DVec3) {
        let (x, y) = (factors.x, factors.y);
        match &mut self.sheets {
            Samples::Grids(grids) => {
                for grid in grids {
                    grid.scale_heights(factors.z);
                    grid.scale_lines(x, y);
                }
            }
            Samples::Trimmed { grids, .. } => {
                for grid in grids {
                    grid.scale_heights(factors.z);
                    grid.scale_lines(x, y);
                }
            }
            Samples::Triangles { points, .. } | Samples::Lattice { points, .. } => {
                points.iter_mut().for_each(|p| *p *= factors);
            }
        }
        self.cut = self.cut.map(|cut| cut.scaled(factors.z));
        self.given_heights = self.given_heights.map(|(low, high)| {
            let (a, b) = (low * factors.z, high * factors.z);
            (a.min(b), a.max(b))
        });
        (0..3).for_each(|k| self.scales[k].factor *= factors[k]);
        self.factors *= factors;
    }

    /// The samples that grid lines run through, one lattice for each sheet.
    pub fn lattices(&self) -> Vec<Lattice<'_>> {
        fn of<'a>(grid: &'a Grid, trimmed: Option<&'a TrimmedGrid>) -> Lattice<'a> {
            let sample = Box::new(|k: usize| grid.point(k as u32));
            Lattice { n_columns: grid.xs().len(), n_samples: grid.zs().len(), sample, trimmed }
        }
        match &self.sheets {
            Samples::Grids(grids) => grids.iter().map(|grid| of(grid, None)).collect(),
            Samples::Trimmed { grids, .. } => {
                grids.iter().map(|trimmed| of(trimmed.grid(), Some(trimmed))).collect()
            }
            Samples::Lattice { n_columns, points } => {
                let sample = Box::new(|k: usize| points[k]);
                let (n_columns, n_samples) = (*n_columns, points.len());
                vec![Lattice { n_columns, n_samples, sample, trimmed: None }]
            }
            Samples::Triangles { .. } => Vec::new(),
        }
    }

    /// The sheets, if they are whole grids over rectangles; otherwise none.
    pub fn grids(&self) -> &[Grid] {
        match &self.sheets {
            Samples::Grids(grids) if self.cut.is_none() => grids,
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
