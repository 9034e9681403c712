//! How values along an axis become coordinates of the drawn surface.

/// The scale of one axis: the drawn coordinate is `factor` times the value, or times its decimal
/// logarithm. A negative factor turns the axis around.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisScale {
    /// Drawn units for one unit of the value, or for one decade.
    pub factor: f64,
    /// Whether the axis is logarithmic.
    pub is_log: bool,
}

impl AxisScale {
    /// Values as they are.
    pub const DATA: Self = Self::linear(1.0);

    /// The drawn coordinate is `factor` times the value.
    pub const fn linear(factor: f64) -> Self {
        Self { factor, is_log: false }
    }

    /// The drawn coordinate of a value; not a number if it has none.
    pub fn drawn(self, value: f64) -> f64 {
        let value = if !self.is_log {
            value
        } else if value > 0.0 {
            libm::log10(value)
        } else {
            f64::NAN
        };
        value * self.factor
    }

    /// The value at a drawn coordinate.
    pub fn value(self, drawn: f64) -> f64 {
        let value = drawn / self.factor;
        if self.is_log { libm::pow(10.0, value) } else { value }
    }
}
