//! Numbers with a fixed number of decimals, the same on every machine.

use std::fmt;

/// A number rounded to a number of decimals, without zeros at the end and never `-0`.
pub(super) struct Decimal {
    value: f64,
    decimals: u32,
}

impl Decimal {
    /// At most nine decimals.
    pub(super) fn new(value: f64, decimals: u32) -> Self {
        Self { value, decimals: decimals.min(9) }
    }
}

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = 10_u64.pow(self.decimals);
        let scaled = (self.value * unit as f64).round() as i64;
        let (whole, rest) = (scaled.unsigned_abs() / unit, scaled.unsigned_abs() % unit);
        if scaled < 0 {
            f.write_str("-")?;
        }
        write!(f, "{whole}")?;
        if rest != 0 {
            let digits = format!("{rest:0width$}", width = self.decimals as usize);
            write!(f, ".{}", digits.trim_end_matches('0'))?;
        }
        Ok(())
    }
}
