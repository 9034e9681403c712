//! Ticks of logarithmic axes: powers of ten.
//!
//! ```text
//!   ├──┴─┴┴┴┴┴┴┼──┴─┴┴┴┴┴┴┤     major ticks at powers of ten, minor ones at 2, 3 … 9 times
//!  10⁻¹        1          10    these
//! ```

use super::range::{AxisRange, MOST_GROWTH};
use super::spacing::Ticks;

/// Most powers of ten with numbers.
const MOST_NUMBERS: i32 = 7;

/// Ticks at every power of ten, or at every second, third … if these are too many; then those at fewer
/// of them. Empty if the range has fewer than two powers of ten.
pub(super) fn proposals(range: &AxisRange) -> Vec<Ticks> {
    let (first, last) = powers(range);
    let n = last - first + 1;
    if n < 2 {
        return Vec::new();
    }
    let least = (n - 1) / MOST_NUMBERS + 1;
    let mut proposals: Vec<Ticks> = (least..n)
        .map(|every| {
            // Multiples of the step, so that 1 is among the numbers if it can be.
            let start = first + (-first).rem_euclid(every);
            let exponents: Vec<i32> = (start..=last).step_by(every as usize).collect();
            ticks(range, (first, last), &exponents, every)
        })
        .filter(|ticks| ticks.majors.len() > 1)
        .collect();
    if proposals.is_empty() {
        proposals.push(ticks(range, (first, last), &[first, last], last - first));
    }
    proposals
}

/// The exponents of the first and the last power of ten in the range, or a little outside of it if it
/// may grow.
fn powers(range: &AxisRange) -> (i32, i32) {
    let (low, high) = (libm::log10(range.low), libm::log10(range.high));
    let growth = if range.may_grow { MOST_GROWTH * (high - low) } else { 0.0 };
    let mut first = libm::floor(low) as i32;
    if power(first) < range.low && low - f64::from(first) > growth {
        first += 1;
    }
    let mut last = libm::ceil(high) as i32;
    if power(last) > range.high && f64::from(last) - high > growth {
        last -= 1;
    }
    (first, last)
}

fn ticks(range: &AxisRange, (first, last): (i32, i32), exponents: &[i32], every: i32) -> Ticks {
    let is_short = exponents.iter().all(|exponent| (-1..=2).contains(exponent));
    let label = |exponent: i32| {
        if is_short {
            power(exponent).to_string()
        } else {
            format!("10^{{{exponent}}}").replace('-', "−")
        }
    };
    let majors: Vec<(f64, String)> = exponents.iter().map(|&e| (power(e), label(e))).collect();
    let (low, high) = (range.low.min(power(first)), range.high.max(power(last)));
    let minors = if every > 1 {
        let rest = (first..=last).filter(|exponent| !exponents.contains(exponent));
        rest.map(power).collect()
    } else {
        let times = |exponent| (2..10).map(move |digit| f64::from(digit) * power(exponent));
        (first - 1..=last).flat_map(times).filter(|v| (low..=high).contains(v)).collect()
    };
    Ticks { majors, minors, exponent: None, is_decades: every == 1, range: (low, high) }
}

/// The decimal number nearest to a power of ten.
fn power(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn best(low: f64, high: f64, may_grow: bool) -> (String, Ticks) {
        let range = AxisRange { low, high, is_log: true, may_grow, saves_digits: false };
        let ticks = proposals(&range).swap_remove(0);
        let labels: Vec<&str> = ticks.majors.iter().map(|(_, label)| &label[..]).collect();
        (labels.join(" "), ticks)
    }

    #[test]
    fn powers_of_ten_are_numbered() {
        assert_eq!(best(0.1, 1000.0, false).0, "10^{−1} 10^{0} 10^{1} 10^{2} 10^{3}");
        assert_eq!(best(0.1, 100.0, false).0, "0.1 1 10 100");
        assert_eq!(best(2.0, 2e4, false).0, "10^{1} 10^{2} 10^{3} 10^{4}");
        assert_eq!(best(1e-10, 1e5, false).0, "10^{−9} 10^{−6} 10^{−3} 10^{0} 10^{3}");
        assert_eq!(best(1e-20, 1.0, false).0.split(' ').count(), 7);
        assert_eq!(best(1e-300, 1e300, false).0.split(' ').count(), 7);
    }

    #[test]
    fn minor_ticks_are_multiples_of_powers_of_ten() {
        let (_, ticks) = best(0.5, 20.0, false);
        let expected = [0.5, 0.6, 0.7, 0.8, 0.9, 2., 3., 4., 5., 6., 7., 8., 9., 20.];
        assert_eq!(ticks.minors.len(), expected.len());
        assert!(ticks.minors.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12));
        let (_, ticks) = best(1.0, 1e9, false);
        assert_eq!(ticks.minors, [1e1, 1e3, 1e5, 1e7, 1e9]);
    }

    #[test]
    fn automatic_ranges_grow_to_a_power_of_ten_that_is_near() {
        assert_eq!(best(1.2e-4, 9.0, true).1.range, (1e-4, 10.0));
        assert_eq!(best(1.2e-4, 9.0, false).1.range, (1.2e-4, 9.0));
    }
}
