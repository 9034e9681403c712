//! Where values are in the drawn box: logarithms, axes that are turned around, and proportions.

use glam::DVec3;

use super::axis_scale::AxisScale;
use super::sampling_error::SamplingError;
use super::source::{Aspect, Source, Surface};

/// With [`Aspect::Box`], an edge of the base that is more than this many times as long as the other one is
/// drawn as long as that.
const MOST_OBLONG: f64 = 5.0;

/// Height of the drawn box as a part of the longer side of its base, with [`Aspect::Box`].
const BOX_HEIGHT: f64 = 0.4;

/// An end of the drawn box is an end of the range that was requested if it is this close, as a part of the
/// box: sampling rounds.
const RANGE_ROUNDING: f64 = 1e-12;

impl Surface {
    /// How values become coordinates, before any of them is multiplied.
    pub(super) fn own_scales(&self) -> [AxisScale; 3] {
        let [x, y, z] = self.is_reversed().map(|is_reversed| if is_reversed { -1.0 } else { 1.0 });
        [(x, 0), (y, 1), (z, 2)].map(|(factor, axis)| AxisScale { factor, is_log: self.log[axis] })
    }

    fn is_reversed(&self) -> [bool; 3] {
        let [x, y] = self.reversed;
        let is_z_reversed = self.z.is_some_and(|(from, to)| from > to);
        [x != (self.x.0 > self.x.1), y != (self.y.0 > self.y.1), is_z_reversed]
    }

    /// The ranges of x and y in coordinates, the smaller one first.
    pub(super) fn drawn_ranges(&self) -> Result<[(f64, f64); 2], SamplingError> {
        let scales = self.own_scales();
        let drawn = |axis, (from, to): (f64, f64), scale: AxisScale| {
            check_positive(axis, scale, from.min(to))?;
            let (a, b) = (scale.drawn(from), scale.drawn(to));
            Ok::<_, SamplingError>((a.min(b), a.max(b)))
        };
        Ok([drawn('x', self.x, scales[0])?, drawn('y', self.y, scales[1])?])
    }

    /// The values between two corners of the drawn box: those that were requested where these are the
    /// ends, since converting back would round.
    pub(super) fn ranges(
        &self,
        scales: &[AxisScale; 3],
        low: DVec3,
        high: DVec3,
    ) -> [(f64, f64); 3] {
        let asked = match &self.source {
            Source::Formulas(_) => [Some(self.x), Some(self.y), None],
            Source::Grid(grid) => {
                let ends = |values: &[f64]| Some((values[0], values[values.len() - 1]));
                [ends(grid.xs()), ends(grid.ys()), None]
            }
            _ => [None; 3],
        };
        [0, 1, 2].map(|k| {
            let near = (high[k] - low[k]) * RANGE_ROUNDING;
            let value = |drawn: f64| {
                let ends = asked[k].into_iter().flat_map(|(from, to)| [from, to]);
                let mut ends = ends.filter(|end| (scales[k].drawn(*end) - drawn).abs() <= near);
                ends.next().unwrap_or_else(|| scales[k].value(drawn)) + 0.0
            };
            let (a, b) = (value(low[k]), value(high[k]));
            (a.min(b), a.max(b))
        })
    }

    /// What coordinates are multiplied by so that the box has the right proportions.
    pub(super) fn factors(&self, size: DVec3) -> DVec3 {
        let usable = |factor: f64| if factor.is_finite() && factor > 0.0 { factor } else { 1.0 };
        let mut factors = match self.aspect {
            Aspect::Data => DVec3::ONE,
            Aspect::Lengths([x, y, z]) => {
                let of = |length: f64, k: usize| usable(length / x * size.x / size[k]);
                DVec3::new(1.0, of(y, 1), of(z, 2))
            }
            Aspect::Box => {
                let longest = size.x.max(size.y);
                let is_oblong = longest > MOST_OBLONG * size.x.min(size.y);
                let [x, y] = if is_oblong || self.log[0] || self.log[1] {
                    [usable(longest / size.x), usable(longest / size.y)]
                } else {
                    [1.0, 1.0]
                };
                DVec3::new(x, y, usable(BOX_HEIGHT * longest / size.z))
            }
        };
        factors.z *= self.z_scale;
        factors
    }
}

/// Points in coordinates, and how many have none because a value on a logarithmic axis is not above 0.
pub(super) fn mapped(points: &[DVec3], scales: &[AxisScale; 3]) -> (Vec<DVec3>, usize) {
    let is_missing = |p: &&DVec3| p.is_finite() && (0..3).any(|k| scales[k].is_log && p[k] <= 0.0);
    let n = points.iter().filter(is_missing).count();
    let drawn = |p: &DVec3| DVec3::from_array([0, 1, 2].map(|k| scales[k].drawn(p[k])));
    (points.iter().map(drawn).collect(), n)
}

pub(super) fn check_positive(axis: char, scale: AxisScale, from: f64) -> Result<(), SamplingError> {
    let is_fine = !scale.is_log || from > 0.0;
    if is_fine { Ok(()) } else { Err(SamplingError::NotPositive { axis, from }) }
}
