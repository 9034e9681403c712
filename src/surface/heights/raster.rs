//! The raster that every height format is read into.

use super::HeightOptions;
use crate::surface::grid::{Grid, GridError, evenly};

/// Heights row by row, the row of the smallest y first; holes are NaN.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Raster {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) heights: Vec<f64>,
    /// The x of each column, where the file has them, rising or falling.
    pub(super) xs: Option<Vec<f64>>,
    /// The y of each row, likewise.
    pub(super) ys: Option<Vec<f64>>,
}

impl Raster {
    /// A raster without coordinates.
    pub(super) fn new(columns: usize, rows: usize, heights: Vec<f64>) -> Self {
        Self { columns, rows, heights, xs: None, ys: None }
    }

    /// Reverses the order of the rows, with their coordinates.
    pub(super) fn flip(&mut self) {
        if self.columns > 0 {
            self.heights = self.heights.chunks(self.columns).rev().flatten().copied().collect();
        }
        if let Some(ys) = &mut self.ys {
            ys.reverse();
        }
    }

    fn mirror(&mut self) {
        if self.columns > 0 {
            self.heights.chunks_mut(self.columns).for_each(<[f64]>::reverse);
        }
        if let Some(xs) = &mut self.xs {
            xs.reverse();
        }
    }

    /// Puts columns and rows in ascending order and places them.
    pub(super) fn place(mut self, options: &HeightOptions) -> Result<Grid, GridError> {
        if options.flip_y {
            self.flip();
        }
        if self.ys.as_deref().is_some_and(falls) {
            self.flip();
        }
        if self.xs.as_deref().is_some_and(falls) {
            self.mirror();
        }
        let xs = coordinates('x', options.x, self.xs, self.columns)?;
        let ys = coordinates('y', options.y, self.ys, self.rows)?;
        Grid::new(xs, ys, self.heights)
    }
}

fn falls(coordinates: &[f64]) -> bool {
    coordinates.len() > 1 && coordinates.windows(2).all(|pair| pair[0] > pair[1])
}

fn coordinates(
    axis: char,
    range: Option<(f64, f64)>,
    own: Option<Vec<f64>>,
    n: usize,
) -> Result<Vec<f64>, GridError> {
    match range {
        Some((from, to)) if from.partial_cmp(&to) != Some(std::cmp::Ordering::Less) => {
            Err(GridError::Range { axis, from, to })
        }
        Some((from, to)) => Ok(evenly(from, to, n)),
        None => Ok(own.unwrap_or_else(|| evenly(0.0, n.saturating_sub(1) as f64, n))),
    }
}

/// The heights that mean "no data" in a file.
#[derive(Debug, Clone, Copy)]
pub(super) struct NoData {
    /// NaN, which equals nothing, for none.
    values: [f64; 2],
}

impl NoData {
    /// The one given as an option, and the one that the file names.
    pub(super) fn new(asked: Option<f64>, named: Option<f64>) -> Self {
        Self { values: [asked, named].map(|value| value.unwrap_or(f64::NAN)) }
    }

    /// For heights that are stored in single precision: −99999.9 is then not the nearest double.
    pub(super) fn in_single_precision(self) -> Self {
        Self { values: self.values.map(|value| f64::from(value as f32)) }
    }

    /// The height, or NaN if it means "no data".
    pub(super) fn height(self, z: f64) -> f64 {
        if self.values.contains(&z) { f64::NAN } else { z }
    }
}
