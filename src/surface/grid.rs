//! A surface sampled on a rectangular grid.

use glam::DVec3;
use rayon::prelude::*;
use thiserror::Error;

use super::axis_scale::AxisScale;
use super::height_function::HeightFunction;
use crate::surface::formula::Formula;

/// The maximum number of samples of a grid: 10⁸.
pub const MAX_SAMPLES: usize = 100_000_000;

/// Heights over a rectangular grid whose lines need not be evenly spaced.
///
/// ```text
///   y ▲   (i,j+1)──(i+1,j+1)        The surface is triangulated: each cell is cut along
///     │      │    ╱    │            (i,j)–(i+1,j+1). Sample (i,j) is at (xs[i], ys[j]).
///     │      │  ╱      │            A height that is not a number is a hole: the cells
///     │    (i,j)────(i+1,j)         around it are not part of the surface.
///     └──────────────────► x
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    xs: Vec<f64>,
    ys: Vec<f64>,
    zs: Vec<f64>,
    heights: Heights,
}

/// What all heights together are.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Heights {
    low: f64,
    high: f64,
    n_holes: usize,
}

impl Heights {
    const NONE: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY, n_holes: 0 };

    fn of(zs: &[f64]) -> Self {
        // `min` and `max` ignore NaN.
        let add = |all: Self, z: &f64| Self {
            low: all.low.min(*z),
            high: all.high.max(*z),
            n_holes: all.n_holes + usize::from(z.is_nan()),
        };
        let join = |a: Self, b: Self| Self {
            low: a.low.min(b.low),
            high: a.high.max(b.high),
            n_holes: a.n_holes + b.n_holes,
        };
        zs.par_chunks(1 << 14).map(|zs| zs.iter().fold(Self::NONE, add)).reduce(|| Self::NONE, join)
    }
}

/// Which samples of a grid have no height.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Holes {
    /// Every sample has a height.
    None,
    /// Some have none.
    Some,
    /// None has.
    All,
}

/// Why numbers do not form a grid.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum GridError {
    /// Fewer than two samples along an axis.
    #[error(
        "{found} {} no surface along {axis}; at least 2 are needed",
        if *found == 1 { "sample makes" } else { "samples make" }
    )]
    TooFew {
        /// `x` or `y`.
        axis: char,
        /// How many there are.
        found: usize,
    },
    /// More than [`MAX_SAMPLES`].
    #[error("{x} × {y} samples exceed the limit of {MAX_SAMPLES}")]
    TooMany {
        /// Along x.
        x: usize,
        /// Along y.
        y: usize,
    },
    /// A range that is reversed, empty or not finite.
    #[error(
        "the range of {axis} must go from a smaller to a larger number, not from {from} to {to}"
    )]
    Range {
        /// `x` or `y`.
        axis: char,
        /// First value.
        from: f64,
        /// Last value.
        to: f64,
    },
    /// Coordinates that do not increase, because they are unsorted or too close for their size.
    #[error("the {axis} values must increase, but value {index} ({value}) does not")]
    NotIncreasing {
        /// `x` or `y`.
        axis: char,
        /// Counted from 0.
        index: usize,
        /// The value that is not larger than the one before it.
        value: f64,
    },
    /// Heights that do not fill the grid.
    #[error("{found} heights for {x} × {y} samples")]
    Count {
        /// Along x.
        x: usize,
        /// Along y.
        y: usize,
        /// How many heights there are.
        found: usize,
    },
}

/// `n` values from `from` to `to`, ends included: `from + (to − from)·i/(n − 1)`, in this order.
pub fn evenly(from: f64, to: f64, n: usize) -> Vec<f64> {
    let last = n.saturating_sub(1).max(1) as f64;
    (0..n).map(|i| from + (to - from) * i as f64 / last).collect()
}

/// Checks the ranges of x and y.
pub(super) fn check_ranges(x: (f64, f64), y: (f64, f64)) -> Result<(), GridError> {
    for (axis, (from, to)) in [('x', x), ('y', y)] {
        if !(from < to && from.is_finite() && (to - from).is_finite()) {
            return Err(GridError::Range { axis, from, to });
        }
    }
    Ok(())
}

/// Checks the numbers of samples along the parameters of a surface in space.
pub(super) fn check_parameters(samples: (usize, usize)) -> Result<(), GridError> {
    for (axis, found) in [('u', samples.0), ('v', samples.1)] {
        if found < 2 {
            return Err(GridError::TooFew { axis, found });
        }
    }
    if samples.0.checked_mul(samples.1).is_none_or(|n| n > MAX_SAMPLES) {
        return Err(GridError::TooMany { x: samples.0, y: samples.1 });
    }
    Ok(())
}

/// The x and y of evenly spaced lines.
fn even_lines(
    x: (f64, f64),
    y: (f64, f64),
    n: (usize, usize),
) -> Result<(Vec<f64>, Vec<f64>), GridError> {
    check_size(n.0, n.1)?;
    check_ranges(x, y)?;
    Ok((evenly(x.0, x.1, n.0), evenly(y.0, y.1, n.1)))
}

impl Grid {
    /// A grid with given lines; `zs` holds the heights row by row, the row of `ys[0]` first.
    /// Heights that are not finite become holes; −0 becomes 0.
    ///
    /// # Errors
    /// Too few or too many samples, coordinates that do not increase, or a wrong count of heights.
    pub fn new(xs: Vec<f64>, ys: Vec<f64>, mut zs: Vec<f64>) -> Result<Self, GridError> {
        check_size(xs.len(), ys.len())?;
        for (axis, values) in [('x', &xs), ('y', &ys)] {
            let wrong = |k: usize| {
                !values[k].is_finite()
                    || k > 0
                        && values[k].partial_cmp(&values[k - 1])
                            != Some(std::cmp::Ordering::Greater)
            };
            if let Some(index) = (0..values.len()).find(|&k| wrong(k)) {
                return Err(GridError::NotIncreasing { axis, index, value: values[index] });
            }
        }
        if zs.len() != xs.len() * ys.len() {
            return Err(GridError::Count { x: xs.len(), y: ys.len(), found: zs.len() });
        }
        for z in &mut zs {
            *z = if z.is_finite() { *z + 0.0 } else { f64::NAN };
        }
        let heights = Heights::of(&zs);
        Ok(Self { xs, ys, zs, heights })
    }

    /// Samples a formula on `n` = (along x, along y) evenly spaced lines. O(samples), in parallel.
    ///
    /// # Errors
    /// A range that does not increase, too few or too many samples.
    pub fn sample(
        formula: &Formula,
        x: (f64, f64),
        y: (f64, f64),
        n: (usize, usize),
    ) -> Result<Self, GridError> {
        Self::sample_function(&HeightFunction::new(formula.clone(), 1.0), x, y, n)
    }

    /// The same for a formula in the coordinates of the drawn surface.
    ///
    /// # Errors
    /// As [`sample`](Self::sample).
    pub fn sample_function(
        function: &HeightFunction,
        x: (f64, f64),
        y: (f64, f64),
        n: (usize, usize),
    ) -> Result<Self, GridError> {
        let (xs, ys) = even_lines(x, y, n)?;
        Self::sample_at(function, xs, ys)
    }

    /// Samples a function on given lines. O(samples), in parallel.
    ///
    /// # Errors
    /// Places that do not rise, or too few or too many samples.
    pub fn sample_at(
        function: &HeightFunction,
        xs: Vec<f64>,
        ys: Vec<f64>,
    ) -> Result<Self, GridError> {
        check_size(xs.len(), ys.len())?;
        let mut zs = vec![0.0; xs.len() * ys.len()];
        zs.par_chunks_mut(xs.len()).zip(&ys).for_each(|(row, &y)| {
            function.heights(&xs, &vec![y; xs.len()], row);
        });
        Self::new(xs, ys, zs)
    }

    /// Samples a function on `n` = (along x, along y) evenly spaced lines; a height that is not finite
    /// is a hole.
    ///
    /// # Errors
    /// As [`sample`](Self::sample).
    pub fn from_fn(
        x: (f64, f64),
        y: (f64, f64),
        n: (usize, usize),
        z: impl Fn(f64, f64) -> f64,
    ) -> Result<Self, GridError> {
        let (xs, ys) = even_lines(x, y, n)?;
        let mut zs = Vec::with_capacity(n.0 * n.1);
        for &y in &ys {
            zs.extend(xs.iter().map(|&x| z(x, y)));
        }
        Self::new(xs, ys, zs)
    }

    /// The x of each line across x, increasing.
    pub fn xs(&self) -> &[f64] {
        &self.xs
    }

    /// The y of each line across y, increasing.
    pub fn ys(&self) -> &[f64] {
        &self.ys
    }

    /// Heights, row by row; a hole is not a number.
    pub fn zs(&self) -> &[f64] {
        &self.zs
    }

    /// The sample with index `j · xs.len() + i`. Panics when there is none.
    pub fn point(&self, sample: u32) -> DVec3 {
        // Division of short numbers is several times faster.
        let (j, i) = (sample / self.xs.len() as u32, sample % self.xs.len() as u32);
        let (j, i) = (j as usize, i as usize);
        DVec3::new(self.xs[i], self.ys[j], self.zs[sample as usize])
    }

    /// How many edges there are between neighboring samples.
    ///
    /// Edges along x come first, row by row: (i,j)–(i+1,j) is number `j·(nx−1) + i`. Then those along
    /// y, column by column: (i,j)–(i,j+1) is number `ny·(nx−1) + i·(ny−1) + j`.
    pub fn n_edges(&self) -> usize {
        let (nx, ny) = (self.xs.len(), self.ys.len());
        ny * (nx - 1) + nx * (ny - 1)
    }

    /// The samples at the ends of an edge, the lower number first.
    pub fn ends(&self, edge: u32) -> [u32; 2] {
        let (nx, ny, edge) = (self.xs.len(), self.ys.len(), edge as usize);
        let along_x = ny * (nx - 1);
        if edge < along_x {
            let (j, i) = (edge / (nx - 1), edge % (nx - 1));
            [j * nx + i, j * nx + i + 1].map(|k| k as u32)
        } else {
            let (i, j) = ((edge - along_x) / (ny - 1), (edge - along_x) % (ny - 1));
            [j * nx + i, (j + 1) * nx + i].map(|k| k as u32)
        }
    }

    /// The number of the edge between two samples, given the lower number first, if they are neighbors.
    pub fn edge(&self, [low, high]: [u32; 2]) -> Option<u32> {
        let (nx, ny) = (self.xs.len() as u32, self.ys.len() as u32);
        let (j, i) = (low / nx, low % nx);
        if high == low + nx {
            Some(ny * (nx - 1) + i * (ny - 1) + j)
        } else {
            (high == low + 1 && i + 1 < nx).then_some(j * (nx - 1) + i)
        }
    }

    /// Lowest and highest height; `None` when all samples are holes.
    pub fn heights(&self) -> Option<(f64, f64)> {
        let Heights { low, high, .. } = self.heights;
        (low <= high).then_some((low, high))
    }

    /// The (lowest, highest) corner of the box around the surface; of height 0 if all samples are holes.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let (low, high) = self.heights().unwrap_or((0.0, 0.0));
        let (nx, ny) = (self.xs.len(), self.ys.len());
        let first = DVec3::new(self.xs[0], self.ys[0], low);
        (first, DVec3::new(self.xs[nx - 1], self.ys[ny - 1], high))
    }

    /// Multiplies all heights. O(samples).
    pub fn scale_heights(&mut self, factor: f64) {
        self.zs.iter_mut().for_each(|z| *z *= factor);
        self.heights = Heights::of(&self.zs);
    }

    /// Sets the heights of some samples. O(samples) if there are any.
    pub(super) fn set_heights(&mut self, heights: &[(u32, f64)]) {
        if heights.is_empty() {
            return;
        }
        heights.iter().for_each(|&(sample, z)| self.zs[sample as usize] = z);
        self.heights = Heights::of(&self.zs);
    }

    /// Multiplies the x and y of all lines by factors above 0. O(lines).
    pub(super) fn scale_lines(&mut self, x: f64, y: f64) {
        self.xs.iter_mut().for_each(|value| *value *= x);
        self.ys.iter_mut().for_each(|value| *value *= y);
    }

    /// The grid in other coordinates; samples without a coordinate become holes. O(samples).
    ///
    /// # Errors
    /// Lines that have no coordinates, or the same ones.
    pub(super) fn mapped(&self, scales: &[AxisScale; 3]) -> Result<Self, GridError> {
        let drawn = |values: &[f64], scale: AxisScale| -> (Vec<f64>, bool) {
            let mut drawn: Vec<f64> = values.iter().map(|&v| scale.drawn(v)).collect();
            let is_turned = scale.factor < 0.0;
            if is_turned {
                drawn.reverse();
            }
            (drawn, is_turned)
        };
        let ((xs, x_turned), (ys, y_turned)) =
            (drawn(&self.xs, scales[0]), drawn(&self.ys, scales[1]));
        let (nx, ny) = (xs.len(), ys.len());
        let from = |k: usize| {
            let (i, j) = (k % nx, k / nx);
            let (i, j) =
                (if x_turned { nx - 1 - i } else { i }, if y_turned { ny - 1 - j } else { j });
            self.zs[j * nx + i]
        };
        let zs = (0..nx * ny).into_par_iter().map(|k| scales[2].drawn(from(k))).collect();
        Self::new(xs, ys, zs)
    }

    /// Whether some samples have no height.
    pub fn holes(&self) -> Holes {
        match self.heights.n_holes {
            0 => Holes::None,
            n if n == self.zs.len() => Holes::All,
            _ => Holes::Some,
        }
    }
}

pub(super) fn check_size(x: usize, y: usize) -> Result<(), GridError> {
    for (axis, found) in [('x', x), ('y', y)] {
        if found < 2 {
            return Err(GridError::TooFew { axis, found });
        }
    }
    if x.checked_mul(y).is_none_or(|n| n > MAX_SAMPLES) {
        return Err(GridError::TooMany { x, y });
    }
    Ok(())
}
