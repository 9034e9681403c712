//! How surfaces are sampled: joined along seams and rims, and scaled.

use glam::DVec3;

use super::axis_scale::AxisScale;
use super::domain::{Cutting, TrimmedGrid};
use super::formula::{Axis, Formula};
use super::grid::{Grid, Holes, check_parameters, check_ranges, check_size};
use super::height_cut::HeightCut;
use super::height_function::HeightFunction;
use super::lined_mesh::close_seams;
use super::places::Places;
use super::proportions::{check_positive, mapped};
use super::sampled::{SampledSurface, Samples};
use super::sampling_error::SamplingError;
use super::sheet_jets::SheetJets;
use super::source::{FormulaSheet, Outside, Source, Surface};

/// Rim points of two sheets at the same x and y are one point if their heights differ by at most this
/// part of the height of both sheets.
const RIM_TOLERANCE: f64 = 1e-6;

impl Surface {
    /// Samples the surface on its own lines. O(samples), in parallel.
    ///
    /// # Errors
    /// See [`SamplingError`].
    pub fn sample(&self) -> Result<SampledSurface, SamplingError> {
        match (self.places()?, self.heights()) {
            (Some(places), Some(heights)) => self.sample_torn(places, Some(heights), 0.0),
            (places, _) => self.sample_at(places),
        }
    }

    /// The range of heights at which formulas are cut off, if they are, in coordinates before any is
    /// multiplied.
    pub(crate) fn heights(&self) -> Option<(f64, f64)> {
        let is_formula = matches!(self.source, Source::Formulas(_));
        self.given_heights().filter(|_| is_formula && self.outside == Outside::Cut)
    }

    /// The range of heights that is requested, if it is, in coordinates before any is multiplied.
    fn given_heights(&self) -> Option<(f64, f64)> {
        let scale = self.own_scales()[2];
        let drawn = |z: f64| match scale.is_log && z <= 0.0 {
            true => f64::NEG_INFINITY * scale.factor,
            false => scale.drawn(z),
        };
        let (a, b) = self.z.map(|(from, to)| (drawn(from), drawn(to)))?;
        Some((a.min(b), a.max(b)))
    }

    /// The formula of a sheet, with plateaus if these are requested.
    fn height_of(&self, sheet: &FormulaSheet) -> Formula {
        match (self.z, self.outside) {
            (Some((a, b)), Outside::Clamp) => sheet.height.clamped(a.min(b), a.max(b)),
            _ => sheet.height.clone(),
        }
    }

    /// The surface's own lines, if formulas are sampled, in coordinates before any is multiplied.
    ///
    /// # Errors
    /// A range that does not increase or has no logarithm, too few or too many samples.
    pub(crate) fn places(&self) -> Result<Option<Places>, SamplingError> {
        match &self.source {
            Source::Formulas(_) => {
                let [x, y] = self.drawn_ranges()?;
                check_size(self.samples.0, self.samples.1)?;
                check_ranges(x, y)?;
                Ok(Some(Places::evenly([x, y], self.samples.into())?))
            }
            Source::Parametric { u, v, .. } => {
                check_parameters(self.samples)?;
                Ok(Some(Places::evenly([*u, *v], self.samples.into())?))
            }
            Source::Grid(_) | Source::Triangles { .. } | Source::Lattice { .. } => Ok(None),
        }
    }

    /// The formulas of each sheet ready to be enclosed: of z alone, or of x, y and z, in coordinates before
    /// any is multiplied. None for what is given by points.
    pub(crate) fn jets(&self) -> Vec<SheetJets> {
        let scales = self.own_scales();
        match &self.source {
            Source::Formulas(sheets) => {
                let jets = |sheet: &FormulaSheet| self.height_of(sheet).jets().scaled(scales);
                sheets.iter().map(|sheet| SheetJets::Height(jets(sheet))).collect()
            }
            Source::Parametric { formulas, .. } => {
                let data = AxisScale::DATA;
                let of = |k: usize| formulas[k].jets().scaled([data, data, scales[k]]);
                vec![SheetJets::Space([of(0), of(1), of(2)])]
            }
            Source::Grid(_) | Source::Triangles { .. } | Source::Lattice { .. } => Vec::new(),
        }
    }

    /// Samples the surface on these lines, if it is given by formulas. O(samples), in parallel.
    ///
    /// # Errors
    /// See [`SamplingError`].
    pub(crate) fn sample_at(
        &self,
        places: Option<Places>,
    ) -> Result<SampledSurface, SamplingError> {
        let on = |axis: Axis| places.as_ref().map_or(Vec::new(), |p| p.along(axis).to_vec());
        let on = || (on(Axis::First), on(Axis::Second));
        let scales = self.own_scales();
        let mut n_not_positive = 0;
        let sheets = match &self.source {
            Source::Formulas(sheets) if sheets.iter().all(|sheet| sheet.domain.is_none()) => {
                self.everywhere(sheets, &on)?
            }
            Source::Formulas(sheets) => {
                let grids = self.trimmed(sheets, &on)?;
                if grids.iter().all(TrimmedGrid::is_whole) {
                    Samples::Grids(grids.iter().map(|g| g.grid().clone()).collect())
                } else {
                    joined_at_rim(grids)
                }
            }
            Source::Grid(grid) if scales == [AxisScale::DATA; 3] => {
                Samples::Grids(vec![grid.clone()])
            }
            Source::Grid(grid) => {
                check_positive('x', scales[0], grid.xs()[0])?;
                check_positive('y', scales[1], grid.ys()[0])?;
                if scales[2].is_log {
                    n_not_positive = grid.zs().iter().filter(|z| **z <= 0.0).count();
                }
                Samples::Grids(vec![grid.mapped(&scales)?])
            }
            Source::Triangles { points, triangles } => {
                let (points, n) = mapped(points, &scales);
                n_not_positive = n;
                let is_whole = |t: &[u32; 3]| t.iter().all(|&k| points[k as usize].is_finite());
                // Turning one axis around turns triangles over.
                let is_turned = self.reversed[0] != self.reversed[1];
                let kept = triangles.iter().filter(|t| is_whole(t));
                let kept = kept.map(|&[a, b, c]| if is_turned { [a, c, b] } else { [a, b, c] });
                let triangles = kept.collect();
                Samples::Triangles { points, triangles }
            }
            Source::Lattice { n_columns, points } => {
                let (points, n) = mapped(points, &scales);
                n_not_positive = n;
                self.turned(*n_columns, points)
            }
            Source::Parametric { formulas, .. } => {
                let (n_columns, points) = lattice(formulas, on());
                let (points, n) = mapped(&points, &scales);
                n_not_positive = n;
                self.turned(n_columns, points)
            }
        };
        self.at_scale(sheets, n_not_positive, places)
    }

    /// As [`sample_at`](Self::sample_at), but cut off smoothly where formulas have no value, and torn open
    /// where they jump. Heights outside of `heights` are left out; gaps between heights that are closer
    /// than `closes` are filled. Both are coordinates before any is multiplied.
    pub(crate) fn sample_torn(
        &self,
        places: Places,
        heights: Option<(f64, f64)>,
        closes: f64,
    ) -> Result<SampledSurface, SamplingError> {
        let Source::Formulas(sheets) = &self.source else {
            // Those of a sampled surface, which were turned with it.
            let is_turned = matches!(self.source, Source::Parametric { .. }) && self.is_turned();
            return self.sample_at(Some(if is_turned { places.turned() } else { places }));
        };
        let sample = |sheet: &FormulaSheet| {
            let domain = sheet.domain.as_ref().map(|domain| self.domain_function(domain));
            let cutting = Cutting { domain: domain.as_ref(), heights, closes };
            let [xs, ys] = [Axis::First, Axis::Second].map(|axis| places.along(axis).to_vec());
            let jets = self.height_of(sheet).jets().scaled(self.own_scales());
            TrimmedGrid::sample_torn(&self.function(sheet), jets, &cutting, xs, ys)
        };
        let grids = sheets.iter().map(sample).collect::<Result<Vec<_>, _>>()?;
        let sheets = if grids.iter().all(TrimmedGrid::is_whole) {
            Samples::Grids(grids.iter().map(|g| g.grid().clone()).collect())
        } else {
            joined_at_rim(grids)
        };
        let is_cut = self.heights().is_some();
        match self.at_scale(sheets, 0, Some(places.clone())) {
            Err(SamplingError::NoHeights { .. }) if is_cut => {
                let (low, high) = self.sample_at(Some(places))?.ranges()[2];
                Err(SamplingError::OutOfRange { low, high })
            }
            sampled => sampled,
        }
    }

    /// The samples as they are drawn.
    fn at_scale(
        &self,
        sheets: Samples,
        n_not_positive: usize,
        places: Option<Places>,
    ) -> Result<SampledSurface, SamplingError> {
        let scales = self.own_scales();
        let formulas = match &self.source {
            Source::Formulas(sheets) => sheets.iter().map(|s| self.height_of(s)).collect(),
            _ => Vec::new(),
        };
        let in_space = match &self.source {
            Source::Parametric { formulas, .. } => Some(formulas.clone()),
            _ => None,
        };
        let ranges = [(0.0, 0.0); 3];
        let is_turned = matches!(self.source, Source::Parametric { .. }) && self.is_turned();
        let places = if is_turned { places.map(Places::turned) } else { places };
        let factors = DVec3::ONE;
        let mut surface = SampledSurface {
            sheets,
            formulas,
            in_space,
            scales,
            ranges,
            n_not_positive,
            factors,
            places,
            given_heights: self.given_heights(),
            given_range: self.z.map(|(a, b)| (a.min(b), a.max(b))),
            cut: None,
        };
        if scales[2].is_log && !surface.formulas.is_empty() {
            surface.n_not_positive = surface.count_not_positive();
        }
        let (low, high) = surface.bounds();
        if low.x > high.x {
            return Err(SamplingError::NoHeights { outside_domain: self.has_heights_outside() });
        }
        surface.ranges = self.ranges(&scales, low, high);
        if let Some((least, most)) = surface.given_heights
            && surface.formulas.is_empty()
        {
            if least > high.z || most < low.z {
                let (low, high) = surface.ranges[2];
                return Err(SamplingError::OutOfRange { low, high });
            }
            let is_clamped = self.outside == Outside::Clamp;
            let cut = HeightCut { low: least, high: most, is_clamped };
            surface.cut = (least > low.z || most < high.z).then_some(cut);
            let (low, high) = surface.bounds();
            surface.ranges = self.ranges(&scales, low, high);
        }
        let (low, high) = surface.box_bounds();
        let size = high - low;
        if !size.is_finite() {
            return Err(SamplingError::TooFarApart { low: low.z, high: high.z });
        }
        let factors = self.factors(size);
        if !(low.z * factors.z).is_finite() || !(high.z * factors.z).is_finite() {
            return Err(SamplingError::TooHigh { factor: factors.z });
        }
        surface.scale_by(factors);
        Ok(surface)
    }

    /// Whether an odd number of axes is turned around.
    fn is_turned(&self) -> bool {
        let [x, y] = self.reversed;
        x ^ y ^ self.z.is_some_and(|(from, to)| from > to)
    }

    /// Rows of points, reversed if that keeps the upper side of the surface where it was.
    fn turned(&self, n_columns: usize, mut points: Vec<DVec3>) -> Samples {
        if self.is_turned() {
            points.chunks_mut(n_columns.max(1)).for_each(<[DVec3]>::reverse);
        }
        Samples::Lattice { n_columns, points }
    }

    /// Samples wherever their formulas have values; two that end at the same rim are joined there.
    fn everywhere(
        &self,
        sheets: &[FormulaSheet],
        on: &impl Fn() -> (Vec<f64>, Vec<f64>),
    ) -> Result<Samples, SamplingError> {
        let sample = |sheet: &FormulaSheet| {
            let (xs, ys) = on();
            Grid::sample_at(&self.function(sheet), xs, ys)
        };
        let grids = sheets.iter().map(sample).collect::<Result<Vec<_>, _>>()?;
        if grids.len() == 2 && grids.iter().any(|grid| grid.holes() != Holes::None) {
            let trimmed = self.trimmed(sheets, on)?;
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
        sheets: &[FormulaSheet],
        on: &impl Fn() -> (Vec<f64>, Vec<f64>),
    ) -> Result<Vec<TrimmedGrid>, SamplingError> {
        let sample = |sheet: &FormulaSheet| {
            let (xs, ys) = on();
            let domain = sheet.domain.as_ref().map(|domain| self.domain_function(domain));
            TrimmedGrid::sample_at(&self.function(sheet), domain.as_ref(), xs, ys)
        };
        Ok(sheets.iter().map(sample).collect::<Result<_, _>>()?)
    }

    fn domain_function(&self, domain: &Formula) -> HeightFunction {
        let [of_x, of_y, _] = self.own_scales();
        HeightFunction::scaled(domain.clone(), [of_x, of_y, AxisScale::DATA])
    }

    fn function(&self, sheet: &FormulaSheet) -> HeightFunction {
        HeightFunction::scaled(self.height_of(sheet), self.own_scales())
    }

    /// Whether there is a domain, and samples have heights outside of it.
    fn has_heights_outside(&self) -> bool {
        let Source::Formulas(sheets) = &self.source else { return false };
        let Ok([x, y]) = self.drawn_ranges() else { return false };
        let sample =
            |s: &FormulaSheet| Grid::sample_function(&self.function(s), x, y, self.samples);
        let of_domains = sheets.iter().filter(|sheet| sheet.domain.is_some());
        of_domains.map(sample).any(|g| g.is_ok_and(|g| g.heights().is_some()))
    }
}

fn lattice(formulas: &[Formula; 3], (us, vs): (Vec<f64>, Vec<f64>)) -> (usize, Vec<DVec3>) {
    let mut points = Vec::with_capacity(us.len() * vs.len());
    for v in vs {
        let mut rows = [(); 3].map(|()| vec![0.0; us.len()]);
        for (formula, row) in formulas.iter().zip(&mut rows) {
            formula.values(&us, &vec![v; us.len()], row);
        }
        points.extend((0..us.len()).map(|i| DVec3::new(rows[0][i], rows[1][i], rows[2][i])));
    }
    close_seams(us.len(), &mut points);
    (us.len(), points)
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
