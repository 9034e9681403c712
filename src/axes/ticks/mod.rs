//! Round numbers along an axis.
//!
//! ```text
//!   ├─┴─┴─┼─┴─┴─┼─┴─┴─┤     Proposals are made for many steps and scored: numbers at both ends,
//!  −6    −3     0     3     zero among them, a simple step, and about as many as there is room
//!                           for. The axis takes the best one whose numbers do not touch.
//! ```

mod logarithmic;
mod numbers;
mod range;
mod round;
mod spacing;

pub(super) use self::range::AxisRange;
pub(super) use self::spacing::Ticks;

use self::numbers::Unit;
use self::spacing::Spacing;

/// The maximum number of ticks with a requested step.
const MOST_TICKS: i64 = 1000;

/// Proposals that are worth trying.
const MOST_PROPOSALS: usize = 40;

/// The numbers on an axis.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum TickRule {
    /// Round numbers, about as many as there is room for.
    #[default]
    Round,
    /// All multiples of this number.
    Step(f64),
    /// Multiples of π, π/2 or π/4, written with π.
    Pi,
}

/// Ticks for an axis, the best ones first; `wanted` is how many numbers there is room for. Logarithmic
/// axes of more than a decade have powers of ten, whatever the rule.
pub(super) fn proposals(range: &AxisRange, rule: TickRule, wanted: f64) -> Vec<Ticks> {
    if !range.has_ticks() {
        return Vec::new();
    }
    if range.is_log {
        let decades = logarithmic::proposals(range);
        if !decades.is_empty() {
            return decades;
        }
    }
    let spacings = match rule {
        TickRule::Round => None,
        TickRule::Step(step) => fixed(range, step).map(|spacing| vec![spacing]),
        TickRule::Pi => round::spacings_of_pi(range, wanted),
    };
    let spacings = spacings.unwrap_or_else(|| round::spacings(range, wanted));
    spacings.iter().take(MOST_PROPOSALS).map(|spacing| spacing.ticks(range)).collect()
}

/// Whether a step would make more ticks than can be drawn.
pub(super) fn has_too_many(range: &AxisRange, rule: TickRule) -> bool {
    match rule {
        TickRule::Step(step) => range.has_ticks() && fixed(range, step).is_none(),
        TickRule::Round | TickRule::Pi => false,
    }
}

/// Ticks at all multiples of a step; `None` if they are too many.
fn fixed(range: &AxisRange, step: f64) -> Option<Spacing> {
    let unit = Unit::decimal(step)?;
    let (first, last) = range.indices(unit, 1, 0)?;
    let spacing = Spacing { unit, first, last, every: 1, parts: unit.parts(), score: 0.0 };
    (last - first <= MOST_TICKS).then_some(spacing)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;

    fn range(low: f64, high: f64) -> AxisRange {
        AxisRange { low, high, is_log: false, may_grow: false, saves_digits: false }
    }

    fn best(range: &AxisRange, rule: TickRule) -> (String, Ticks) {
        let ticks = proposals(range, rule, 5.0).swap_remove(0);
        let labels: Vec<&str> = ticks.majors.iter().map(|(_, label)| &label[..]).collect();
        (labels.join(" "), ticks)
    }

    fn labels(low: f64, high: f64) -> String {
        best(&range(low, high), TickRule::Round).0
    }

    #[test]
    fn ticks_are_those_that_a_draughtsman_would_choose() {
        for (low, high, expected) in [
            (-5.0, 5.0, "−5.0 −2.5 0.0 2.5 5.0"),
            (-12.0, 12.0, "−12 −8 −4 0 4 8 12"),
            (-3.0, 3.0, "−3 −2 −1 0 1 2 3"),
            (-6.0, 6.0, "−6 −3 0 3 6"),
            (-7.0, 7.0, "−6 −3 0 3 6"),
            (-8.0, 8.0, "−8 −4 0 4 8"),
            (-10.0, 10.0, "−10 −5 0 5 10"),
            (-1.5, 1.5, "−1.5 −1.0 −0.5 0.0 0.5 1.0 1.5"),
            (0.0, 10.0, "0.0 2.5 5.0 7.5 10.0"),
            (0.0, 24.0, "0 4 8 12 16 20 24"),
            (0.0, TAU, "0 2 4 6"),
            (0.05, 1.0, "0.2 0.4 0.6 0.8 1.0"),
            (103.0, 195.0, "110 130 150 170 190"),
            (0.0, 86.0, "0 20 40 60 80"),
            (-0.217, 1.0, "−0.2 0.0 0.2 0.4 0.6 0.8 1.0"),
            (-1.0, 3.0, "−1 0 1 2 3"),
            (1950.0, 2020.0, "1950 1960 1970 1980 1990 2000 2010 2020"),
        ] {
            assert_eq!(labels(low, high), expected, "{low}:{high}");
        }
    }

    #[test]
    fn ticks_are_evenly_spaced_and_no_further_one_fits() {
        let mut n_checked = 0;
        for (low, length) in (-40..40).flat_map(|low| (1..40).map(move |length| (low, length))) {
            let [low, high] = [low, low + length].map(|k| f64::from(k) / 7.0);
            for ticks in proposals(&range(low, high), TickRule::Round, 5.0) {
                let values: Vec<f64> = ticks.majors.iter().map(|(value, _)| *value).collect();
                let [first, second, ..] = values[..] else { continue };
                let (step, last) = (second - first, values[values.len() - 1]);
                let is_even = |pair: &[f64]| (pair[1] - pair[0] - step).abs() < 1e-9 * step;
                assert!(values.windows(2).all(is_even), "{low}:{high}: {values:?}");
                assert!(low <= first && last <= high, "{low}:{high}: {values:?}");
                let is_full = first - step < low && last + step > high;
                assert!(is_full, "{low}:{high}: {values:?}");
                n_checked += 1;
            }
        }
        assert!(n_checked > 10_000, "{n_checked}");
    }

    #[test]
    fn the_same_ranges_in_other_units_have_the_same_ticks() {
        for exponent in -250..250 {
            let end: f64 = format!("1.2e{exponent}").parse().expect("a number");
            let ticks = best(&range(-end, end), TickRule::Round).1;
            let values = ticks.majors.iter().map(|(value, _)| value / (end / 3.0));
            let expected = [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0];
            assert_eq!(ticks.majors.len(), 7, "{exponent}");
            assert!(values.zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{exponent}");
            assert_eq!(ticks.exponent.is_some(), !(-4..6).contains(&exponent), "{exponent}");
        }
    }

    #[test]
    fn long_numbers_share_a_power_of_ten() {
        let (text, ticks) = best(&range(0.0, 4e6), TickRule::Round);
        assert_eq!((&text[..], ticks.exponent), ("0 1 2 3 4", Some(6)));
        let (text, ticks) = best(&range(0.0, 1e-6), TickRule::Round);
        assert_eq!((&text[..], ticks.exponent), ("0.00 0.25 0.50 0.75 1.00", Some(-6)));
        // A power of ten does not make these shorter.
        let (text, ticks) = best(&range(1e6, 1e6 + 4.0), TickRule::Round);
        assert_eq!(ticks.exponent, None);
        assert!(text.starts_with("1000000 1000001"), "{text}");
        let short = AxisRange { saves_digits: true, ..range(0.0, 4000.0) };
        let (text, ticks) = best(&short, TickRule::Round);
        assert_eq!((&text[..], ticks.exponent), ("0 1 2 3 4", Some(3)));
    }

    #[test]
    fn automatic_ranges_grow_to_a_tick_that_is_near() {
        let grown = |low, high| {
            let range = AxisRange { may_grow: true, ..range(low, high) };
            best(&range, TickRule::Round).1.range
        };
        assert_eq!(grown(0.013, 0.97), (0.0, 1.0));
        assert_eq!(grown(-0.217, 1.0), (-0.25, 1.0));
        // Up to 100 would be too far.
        assert_eq!(grown(0.0, 86.0), (0.0, 86.0));
        for (low, high) in [(-0.9, 7.3), (1.0, 1.7), (-33.0, -2.0), (0.0, 86.0), (-6.55, 8.1)] {
            let (from, to) = grown(low, high);
            assert!(from <= low && high <= to);
            assert!((low - from).max(to - high) <= 0.1 * (high - low) * (1.0 + 1e-12));
        }
    }

    #[test]
    fn minor_ticks_divide_steps_into_simple_parts() {
        let minors = |low, high| best(&range(low, high), TickRule::Round).1.minors;
        assert_eq!(minors(-3.0, 3.0).len(), 6 * 4);
        assert_eq!(minors(-8.0, 8.0), [-7., -6., -5., -3., -2., -1., 1., 2., 3., 5., 6., 7.]);
        assert_eq!(minors(-6.0, 6.0), [-5., -4., -2., -1., 1., 2., 4., 5.]);
        // Beyond the last number, too.
        let minors = minors(-7.0, 7.0);
        assert_eq!([minors[0], minors[minors.len() - 1]], [-7.0, 7.0]);
    }

    #[test]
    fn steps_can_be_given() {
        let of = |low, high, step| best(&range(low, high), TickRule::Step(step)).0;
        assert_eq!(of(0.0, 360.0, 90.0), "0 90 180 270 360");
        assert_eq!(of(0.0, 1.0, 0.3), "0.0 0.3 0.6 0.9");
        assert_eq!(
            of(-1.0, 1.0, 0.125),
            "−1.000 −0.875 −0.750 −0.625 −0.500 −0.375 −0.250 −0.125 \
                                          0.000 0.125 0.250 0.375 0.500 0.625 0.750 0.875 1.000"
        );
        assert!(has_too_many(&range(0.0, 1.0), TickRule::Step(1e-9)));
        assert!(!has_too_many(&range(0.0, 1.0), TickRule::Step(0.01)));
    }

    #[test]
    fn angles_are_written_with_pi() {
        let of = |low, high| best(&range(low, high), TickRule::Pi).0;
        assert_eq!(of(-PI, PI), "−π −π/2 0 π/2 π");
        assert_eq!(of(0.0, TAU), "0 π/2 π 3π/2 2π");
        assert_eq!(of(0.0, PI), "0 π/4 π/2 3π/4 π");
        assert_eq!(of(-2.0 * TAU, 2.0 * TAU), "−4π −2π 0 2π 4π");
        assert_eq!(of(0.0, 40.0 * PI), "0 10π 20π 30π 40π");
        // Too short for any.
        assert_eq!(of(0.1, 0.5), labels(0.1, 0.5));
        let range = AxisRange { may_grow: true, ..range(-3.13, 3.12) };
        assert_eq!(best(&range, TickRule::Pi).1.range, (-PI, PI));
    }

    #[test]
    fn logarithmic_axes_of_less_than_a_decade_have_round_numbers() {
        let of = |low, high| {
            let range = AxisRange { is_log: true, ..range(low, high) };
            best(&range, TickRule::Round).0
        };
        assert_eq!(of(2.0, 6.0), "2 3 4 5 6");
        assert_eq!(of(0.5, 5.0), "1 2 3 4 5");
        assert_eq!(of(0.1, 100.0), "0.1 1 10 100");
        let range = AxisRange { is_log: true, ..range(-1.0, 5.0) };
        assert!(proposals(&range, TickRule::Round, 5.0).is_empty());
    }

    #[test]
    fn ranges_without_room_for_numbers_have_none() {
        let none = |low, high| proposals(&range(low, high), TickRule::Round, 5.0).is_empty();
        assert!(none(1.0, 1.0) && none(2.0, 1.0) && none(f64::NAN, 1.0));
        assert!(none(0.0, f64::INFINITY) && none(-1e308, 1e308));
        assert!(none(1e300, 1e300 + 1e285));
        assert!(none(0.0, 5e-324) && none(0.0, 1e-320));
    }
}
