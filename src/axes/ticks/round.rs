//! Steps between round numbers, scored as Talbot, Lin & Hanrahan do: An Extension of Wilkinson's
//! Algorithm for Positioning Tick Labels on Axes, InfoVis 2010.
//!
//! Differs from the paper: ticks outside the range are not considered, unless the range may grow, and ticks
//! at both ends are worth more. Whether numbers touch is decided by the layout.

use super::numbers::Unit;
use super::range::AxisRange;
use super::spacing::Spacing;

/// Simple steps in tenths, the best first, each with the number of parts that minor ticks make of it.
const STEPS: [(i64, i64); 6] = [(10, 5), (50, 5), (20, 4), (25, 5), (40, 4), (30, 3)];

/// Most simple steps that one step takes together.
const MOST_TOGETHER: i64 = 5;

/// Weights of simplicity, coverage and density, and what legibility is worth, which all proposals have.
const WEIGHTS: [f64; 4] = [0.25, 0.2, 0.5, 0.05];

/// What ticks at both ends are worth.
const AT_BOTH_ENDS: f64 = 0.2;

/// Most ticks of a proposal: more are never wanted.
const MOST_NUMBERS: i64 = 40;

/// Spacings by decimal steps, the best first; none if the numbers are too large for their differences.
pub(super) fn spacings(range: &AxisRange, wanted: f64) -> Vec<Spacing> {
    let exponent = libm::floor(libm::log10(range.high - range.low)) as i32;
    let mut spacings = Vec::new();
    for exponent in exponent - 2..=exponent {
        for (place, (mantissa, parts)) in STEPS.into_iter().enumerate() {
            let unit = Unit::Decimal { mantissa, exponent: exponent - 1 };
            let simplicity = 1.0 - place as f64 / (STEPS.len() - 1) as f64;
            for every in 1..=MOST_TOGETHER {
                // The same ticks as those of a simpler step.
                let is_simple = STEPS.iter().any(|(step, _)| {
                    every > 1 && [1, 10].iter().any(|by| step * by == every * mantissa)
                });
                let parts = if every == 1 { parts } else { every };
                for start in i64::from(is_simple)..every {
                    let spacing = spacing(range, unit, (every, start), simplicity, wanted);
                    spacings.extend(spacing.map(|spacing| Spacing { parts, ..spacing }));
                }
            }
        }
    }
    ranked(spacings)
}

/// Spacings by fractions and multiples of π, the best first; `None` if the range is too short for any.
pub(super) fn spacings_of_pi(range: &AxisRange, wanted: f64) -> Option<Vec<Spacing>> {
    /// Numerator, denominator, and parts for minor ticks; the best first.
    const FRACTIONS: [(i64, i64, i64); 4] = [(1, 1, 4), (1, 2, 2), (1, 4, 1), (2, 1, 4)];
    let turns = (range.high - range.low) / std::f64::consts::PI;
    let exponent = libm::log10(turns).clamp(0.0, 12.0) as u32;
    let long = [exponent, exponent.saturating_sub(1)].into_iter().flat_map(|exponent| {
        let times = 10_i64.pow(exponent);
        STEPS.map(|(mantissa, parts)| (mantissa * times, 10, parts))
    });
    // Whole multiples only.
    let long = long.filter(|(numerator, ..)| numerator % 10 == 0 && *numerator > 20);
    let steps = FRACTIONS.into_iter().chain(long).enumerate();
    let spacings = steps.filter_map(|(place, (numerator, denominator, parts))| {
        let unit = Unit::Pi { numerator, denominator };
        let simplicity = 1.0 - place.min(FRACTIONS.len()) as f64 / FRACTIONS.len() as f64;
        let spacing = spacing(range, unit, (1, 0), simplicity, wanted)?;
        Some(Spacing { parts, ..spacing })
    });
    let spacings: Vec<Spacing> = spacings.collect();
    (!spacings.is_empty()).then(|| ranked(spacings))
}

fn ranked(mut spacings: Vec<Spacing>) -> Vec<Spacing> {
    spacings.sort_by(|a, b| b.score.total_cmp(&a.score));
    spacings
}

/// A spacing with its score; `simplicity` is that of its unit.
fn spacing(
    range: &AxisRange,
    unit: Unit,
    (every, start): (i64, i64),
    simplicity: f64,
    wanted: f64,
) -> Option<Spacing> {
    let (first, last) = range.indices(unit, every, start)?;
    let n = (last - first) / every + 1;
    if !(2..=MOST_NUMBERS).contains(&n) {
        return None;
    }
    let (from, to) = (unit.value(first), unit.value(last));
    let size = range.high - range.low;
    let has_zero = start == 0 && first <= 0 && last >= 0;
    let simplicity = simplicity - every as f64 + f64::from(u8::from(has_zero));
    let off = [range.high - to, range.low - from].map(|gap| (gap / (0.1 * size)).powi(2));
    let coverage = 1.0 - 0.5 * (off[0] + off[1]);
    let density = (n - 1) as f64 / (to - from);
    let target = (wanted - 1.0) / (to.max(range.high) - from.min(range.low));
    let density = 2.0 - (density / target).max(target / density);
    let [by_simplicity, by_coverage, by_density, legible] = WEIGHTS;
    let mut score =
        by_simplicity * simplicity + by_coverage * coverage + by_density * density + legible;
    if from <= range.low && range.high <= to {
        score += AT_BOTH_ENDS;
    }
    let spacing = Spacing { unit, first, last, every, parts: 1, score };
    (to - from).is_finite().then_some(spacing).filter(|s| s.score.is_finite())
}
