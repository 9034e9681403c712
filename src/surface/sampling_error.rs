//! Why a surface has no samples.

use thiserror::Error;

use super::grid::GridError;

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
    /// There are heights, but none in the range of z.
    #[error("heights are from {low} to {high}: none is in the range of z")]
    OutOfRange {
        /// The lowest.
        low: f64,
        /// The highest.
        high: f64,
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
    /// A range that a logarithmic axis cannot have.
    #[error("a logarithmic {axis} axis needs values above 0, not {from}")]
    NotPositive {
        /// `x` or `y`.
        axis: char,
        /// The smallest value.
        from: f64,
    },
}
