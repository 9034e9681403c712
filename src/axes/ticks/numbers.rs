//! Units for the multiples at which ticks are placed, and the numbers written beside them.

use std::f64::consts::PI;

/// Numbers with more digits than this share a power of ten.
const MOST_DIGITS: usize = 6;

/// The same where room is scarce.
const FEW_DIGITS: usize = 3;

/// What ticks are multiples of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Unit {
    /// `mantissa` · 10^`exponent`.
    Decimal { mantissa: i64, exponent: i32 },
    /// `numerator` · π / `denominator`.
    Pi { numerator: i64, denominator: i64 },
}

impl Unit {
    /// A decimal number as it is written; `None` unless it is above 0.
    pub(super) fn decimal(number: f64) -> Option<Self> {
        if !(number > 0.0 && number.is_finite()) {
            return None;
        }
        let text = format!("{number:e}");
        let (digits, exponent) = text.split_once('e')?;
        let n_decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let mantissa = digits.replace('.', "").parse().ok()?;
        Some(Self::Decimal {
            mantissa,
            exponent: exponent.parse::<i32>().ok()? - n_decimals as i32,
        })
    }

    /// The `index`-th multiple, rounded once: 3 · 0.1 is 0.3.
    pub(super) fn value(self, index: i64) -> f64 {
        match self {
            Self::Decimal { mantissa, exponent } => {
                decimal_value(index as f64 * mantissa as f64, exponent)
            }
            Self::Pi { numerator, denominator } => {
                index as f64 * numerator as f64 * PI / denominator as f64
            }
        }
    }

    /// Into how many parts minor ticks divide it.
    pub(super) fn parts(self) -> i64 {
        let Self::Decimal { mut mantissa, .. } = self else { return 1 };
        while mantissa > 0 && mantissa % 10 == 0 {
            mantissa /= 10;
        }
        match mantissa {
            1 | 5 | 25 => 5,
            2 | 4 => 4,
            3 | 6 | 9 => 3,
            _ => 1,
        }
    }

    /// The numbers at these multiples, and the power of ten that all of them are multiplied by.
    pub(super) fn labels(self, indices: &[i64], saves_digits: bool) -> (Vec<String>, Option<i32>) {
        match self {
            Self::Decimal { mantissa, exponent } => {
                let whole: Vec<f64> = indices.iter().map(|&k| k as f64 * mantissa as f64).collect();
                decimal_labels(&whole, exponent, saves_digits)
            }
            Self::Pi { numerator, denominator } => {
                let times = |k: i64| i128::from(k) * i128::from(numerator);
                let label = |&k: &i64| label_with_pi(times(k), i128::from(denominator));
                (indices.iter().map(label).collect(), None)
            }
        }
    }
}

/// A whole number times a power of ten, rounded once.
fn decimal_value(whole: f64, exponent: i32) -> f64 {
    // Powers of ten up to 10²² are exact.
    match exponent {
        0..=22 => whole * libm::pow(10.0, f64::from(exponent)),
        -22..0 => whole / libm::pow(10.0, f64::from(-exponent)) + 0.0,
        _ => format!("{whole}e{exponent}").parse().unwrap_or(f64::NAN) + 0.0,
    }
}

fn decimal_labels(whole: &[f64], exponent: i32, saves_digits: bool) -> (Vec<String>, Option<i32>) {
    let n_zeros = |&number: &f64| {
        let mut number = number.abs() as u64;
        let mut n = 0;
        while number > 0 && number.is_multiple_of(10) {
            number /= 10;
            n += 1;
        }
        n
    };
    let shared = whole.iter().filter(|n| **n != 0.0).map(n_zeros).min().unwrap_or(0);
    let last_place = exponent + shared;
    let largest = whole.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    // As a text, so that 999 and 1000 are not mistaken for each other.
    let first_place = exponent + format!("{largest:.0}").len() as i32 - 1;
    let n_digits =
        if last_place >= 0 { first_place + 1 } else { (first_place.max(0) + 1) - last_place }
            as usize;
    let most = if saves_digits { FEW_DIGITS } else { MOST_DIGITS };
    let n_after = (first_place - last_place) as usize + 1;
    let common = (n_digits > most && n_after < n_digits).then_some(first_place);
    let by = common.unwrap_or(0);
    let decimals = (by - last_place).max(0) as usize;
    let label = |&number: &f64| {
        let text = format!("{:.*}", decimals, decimal_value(number, exponent - by));
        text.replace('-', "−")
    };
    (whole.iter().map(label).collect(), common)
}

/// A fraction of π in lowest terms.
fn label_with_pi(numerator: i128, denominator: i128) -> String {
    let mut divisor = (numerator.abs(), denominator);
    while divisor.1 != 0 {
        divisor = (divisor.1, divisor.0 % divisor.1);
    }
    let (numerator, denominator) = (numerator / divisor.0.max(1), denominator / divisor.0.max(1));
    let sign = if numerator < 0 { "−" } else { "" };
    let times = match numerator.abs() {
        0 => return "0".to_owned(),
        1 => String::new(),
        n => n.to_string(),
    };
    let over = if denominator == 1 { String::new() } else { format!("/{denominator}") };
    format!("{sign}{times}π{over}")
}
