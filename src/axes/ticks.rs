//! Round numbers along an axis.

/// The approximate number of ticks on an axis.
const TICKS: f64 = 5.0;

/// About [`TICKS`] round numbers from `low` to `high`, each with its label. The step between them is 1, 2
/// or 5 times a power of ten; `coarser` moves it that many places up in the sequence 1, 2, 5, 10, 20 …
pub(super) fn ticks(low: f64, high: f64, coarser: u32) -> Vec<(f64, String)> {
    let range = high - low;
    if !(range > 0.0 && range.is_finite()) {
        return Vec::new();
    }
    let exponent = libm::floor(libm::log10(range / TICKS));
    let wanted = range / TICKS / libm::pow(10.0, exponent);
    let digits = [1.0, 2.0, 5.0];
    let place = digits.iter().position(|digit| *digit >= wanted).unwrap_or(digits.len());
    let place = place + coarser as usize;
    let exponent = exponent + (place / digits.len()) as f64;
    let step = digits[place % digits.len()] * libm::pow(10.0, exponent);
    let first = libm::ceil(low / step);
    let count = libm::floor(high / step) - first;
    // Too large for the step: adjacent ticks would round to the same number.
    if !(step > 0.0 && (0.0..100.0).contains(&count) && first.abs() < 1e12) {
        return Vec::new();
    }
    let decimals = (-exponent).clamp(0.0, 300.0);
    let is_plain = (-5.0..6.0).contains(&exponent) && low.abs().max(high.abs()) < 1e7;
    (0..=count as u32)
        .map(|k| {
            let number = first + f64::from(k);
            // Division by a whole number rounds only once: 0.3, not 0.30000000000000004.
            let whole = libm::pow(10.0, decimals);
            let value = if decimals > 0.0 && whole.is_finite() {
                number * libm::round(step * whole) / whole
            } else {
                number * step
            } + 0.0;
            let label = if is_plain {
                format!("{value:.*}", decimals as usize)
            } else {
                format!("{value:e}")
            };
            (value, label)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::ticks;

    #[test]
    fn ticks_are_round_numbers_with_the_digits_they_need() {
        let labels = |low, high| -> Vec<String> {
            ticks(low, high, 0).into_iter().map(|(_, label)| label).collect()
        };
        assert_eq!(labels(-5.0, 5.0), ["-4", "-2", "0", "2", "4"]);
        assert_eq!(labels(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(0.05, 0.31), ["0.1", "0.2", "0.3"]);
        assert_eq!(labels(0.0, 1234.0), ["0", "500", "1000"]);
        assert!(labels(1.0, 1.0).is_empty() && labels(1e300, 1e300 + 1e285).is_empty());
    }

    #[test]
    fn coarser_ticks_are_the_next_round_numbers() {
        let labels = |coarser| -> Vec<String> {
            ticks(0.0, 1.0, coarser).into_iter().map(|(_, label)| label).collect()
        };
        assert_eq!(labels(1), ["0.0", "0.5", "1.0"]);
        assert_eq!(labels(2), ["0", "1"]);
        assert_eq!(labels(3), ["0"]);
    }
}
