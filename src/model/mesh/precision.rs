//! How precisely positions were written down, judged by their digits.

use glam::DVec3;

/// Coordinates whose decimal digits are looked at, at most.
const SAMPLES: usize = 6000;

/// The most decimals that are tried: enough digits to distinguish doubles of any size below one.
const MOST_DECIMALS: u32 = 17;

/// Twice the spacing of single precision, as a part of the largest coordinate.
const SINGLE_SPACING: f64 = 1.0 / (1 << 22) as f64;

/// The same for double precision.
const DOUBLE_SPACING: f64 = 1.0 / (1u64 << 51) as f64;

/// How far a coordinate may be from its intended value, in model units.
///
/// Positions that are singles (exactly, or rounded to the decimals they have) came through single
/// precision. Otherwise two units in the last decimal place count, taken from the coordinates within
/// two decades of the largest one: those below have more decimals when digits are counted from the
/// first one that is not zero, as `%g` does. O(vertices).
pub(super) fn coordinate_error(positions: &[DVec3]) -> f64 {
    let coordinates = || positions.iter().flat_map(|p| p.to_array());
    let largest = coordinates().fold(0.0, |largest: f64, c| largest.max(c.abs()));
    let single_error = largest * SINGLE_SPACING;
    if largest == 0.0 || coordinates().all(|c| f64::from(c as f32) == c) {
        return single_error;
    }
    let step = (3 * positions.len()).div_ceil(SAMPLES);
    // Coordinates of all three axes take part, whatever the step.
    let step = if step.is_multiple_of(3) { step + 1 } else { step };
    let decade = libm::floor(libm::log10(largest));
    let mut most = [0; 2];
    let mut n_samples = 0;
    let mut n_singles = 0;
    for coordinate in coordinates().step_by(step).filter(|&c| c != 0.0) {
        let below = decade - libm::floor(libm::log10(coordinate.abs()));
        let decimals = decimals(coordinate);
        if below < 2.0 {
            let most = &mut most[usize::from(below >= 1.0)];
            *most = decimals.max(*most);
        }
        n_samples += 1;
        let half_unit = 0.5000001 * power_of_ten(decimals);
        let distance = (f64::from(coordinate as f32) - coordinate).abs();
        n_singles += usize::from(distance <= half_unit);
    }
    let [top, next] = most;
    let decimals = top.max(next.saturating_sub(1));
    let written = if decimals >= MOST_DECIMALS - 1 { 0.0 } else { 2.0 * power_of_ten(decimals) };
    let single = if n_singles == n_samples { single_error } else { 0.0 };
    written.min(largest).max(single).max(largest * DOUBLE_SPACING)
}

/// The fewest decimals that a number is written with.
fn decimals(number: f64) -> u32 {
    let text = format!("{:e}", number.abs());
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let n_digits = digits.len().saturating_sub(usize::from(digits.len() > 1)) as i32;
    let exponent: i32 = exponent.parse().unwrap_or(0);
    (n_digits - 1 - exponent).clamp(0, MOST_DECIMALS as i32) as u32
}

fn power_of_ten(decimals: u32) -> f64 {
    libm::pow(10.0, -f64::from(decimals))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error_of(coordinates: &[f64]) -> f64 {
        let points: Vec<_> = coordinates.iter().map(|&c| DVec3::new(c, 0.0, 0.0)).collect();
        coordinate_error(&points)
    }

    #[test]
    fn decimals_are_those_of_the_shortest_writing() {
        for (number, expected) in
            [(0.1, 1), (-12.25, 2), (100.0, 0), (6.92820323, 8), (1e-20, 17), (1e300, 0)]
        {
            assert_eq!(decimals(number), expected, "{number}");
        }
    }

    #[test]
    fn few_decimals_count_rather_than_size() {
        assert_eq!(error_of(&[84_523.12, 446_021.913, 12.001]), 0.002);
        // As written with `%.9g`: one decimal less in the top decade.
        assert_eq!(error_of(&[12.3456789, 6.92820323, 4.8985872e-16]), 2e-7);
        assert_eq!(error_of(&[8.0, 6.92820323]), 2e-8);
    }

    #[test]
    fn singles_have_the_spacing_of_singles() {
        let single = f64::from(0.1_f32);
        assert_eq!(error_of(&[100.0, single]), 100.0 * SINGLE_SPACING);
        // Singles printed with nine digits, which are no longer singles.
        assert_eq!(error_of(&[100.0, 0.100000001, 33.2999992]), 100.0 * SINGLE_SPACING);
        let third = 100.0 / 3.0;
        assert_eq!(error_of(&[100.0, third]), 100.0 * DOUBLE_SPACING);
    }
}
