//! Functions without simple extremes, by the mean value theorem: over an interval with the middle m and
//! the radius r, `g` is within `r·sup|g'|` of `g(m)`.

use std::f64::consts::PI;

use super::super::function::Function;
use super::super::interval::Interval;
use super::{Class, Jet};

/// How far values of the Bessel functions of `libm` may be off, and more.
const BESSEL_ERROR: f64 = 1e-14;

/// How far their derivatives, sums of a few values, may be off, and more.
const SLOPE_ERROR: f64 = 1e-13;

/// Beyond this the Bessel functions of `libm` lose digits.
const FAR: f64 = 1e6;

/// Where the gamma function is least above zero, between these numbers, and a number below its value.
const GAMMA_VALLEY: (f64, f64, f64) = (1.461_632_1, 1.461_632_2, 0.885_603_19);

/// The range of sin t / t.
const SINC_RANGE: Interval = Interval { low: -0.217_234, high: 1.0 };

impl Jet {
    pub(super) fn by_mean_value(self, function: Function) -> Self {
        let t = self.value;
        match function {
            Function::Sinc => self.sinc(),
            Function::Y0 | Function::Y1 if t.high <= 0.0 => Self::NOWHERE,
            Function::Y0 | Function::Y1 | Function::Gamma if t.low <= 0.0 || !t.is_bounded() => {
                Self::of_values(Interval::ALL, self.class.min(Class::Partial))
            }
            Function::Y0 => {
                // |Y0'| = |Y1|.
                let slope =
                    (Interval::point(t.low) * Interval::rounded(PI)).recip().double().high + 0.25;
                self.of_mean_value(libm::y0, slope)
            }
            Function::Y1 => {
                let square = Interval::point(t.low).square() * Interval::rounded(PI);
                self.of_mean_value(libm::y1, square.recip().double().high + 0.45)
            }
            Function::Gamma => self.gamma(),
            _ if t.largest() >= FAR => {
                Self::of_values(Interval::within(1.0), self.class.min(Class::Continuous))
            }
            Function::J0 => self.bessel([
                |t| libm::j0(t),
                |t| -libm::j1(t),
                |t| 0.5 * (libm::jn(2, t) - libm::j0(t)),
            ]),
            _ => self.bessel([
                |t| libm::j1(t),
                |t| 0.5 * (libm::j0(t) - libm::jn(2, t)),
                |t| 0.25 * (libm::jn(3, t) - 3.0 * libm::j1(t)),
            ]),
        }
    }

    /// A Bessel function of the first kind, from it and its derivatives, all of which are at most 1.
    fn bessel(self, functions: [fn(f64) -> f64; 3]) -> Self {
        let [value, first, second] = functions;
        let at = |function: fn(f64) -> f64, error: f64| {
            let (middle, radius) = middle_and_radius(self.value);
            Interval::point(function(middle)).widened(radius + error).meet(Interval::within(1.0))
        };
        let (first, second) = (at(first, SLOPE_ERROR), at(second, SLOPE_ERROR));
        self.chain(at(value, BESSEL_ERROR), first, second, Class::Smooth)
    }

    /// Values alone, from the largest slope.
    fn of_mean_value(self, function: fn(f64) -> f64, slope: f64) -> Self {
        let (middle, radius) = middle_and_radius(self.value);
        let at_middle = function(middle);
        let error = at_middle.abs() * (8.0 * f64::EPSILON) + BESSEL_ERROR;
        let value = Interval::point(at_middle).widened(up(up(radius * slope) + error));
        Self::of_values(value, self.class.min(Class::Continuous))
    }

    /// Above zero: falling and then rising.
    fn gamma(self) -> Self {
        let (before, after, least) = GAMMA_VALLEY;
        let t = self.value;
        let [low, high] = [t.low, t.high].map(|t| {
            let value = libm::tgamma(t);
            Interval::point(value).widened(value * (8.0 * f64::EPSILON))
        });
        let ends = low.hull(high);
        let is_in_valley = t.low < after && t.high > before;
        let value = if is_in_valley { Interval::new(least.min(ends.low), ends.high) } else { ends };
        Self::of_values(value, self.class.min(Class::Continuous))
    }

    /// sin t / t, which is ½∫cos(ts)ds over s from −1 to 1: its k-th derivative is at most 1/(k + 1).
    fn sinc(self) -> Self {
        let t = self.value;
        if !t.is_bounded() {
            return self.chain(
                SINC_RANGE,
                Interval::within(0.4363),
                Interval::within(0.334),
                Class::Smooth,
            );
        }
        let (middle, radius) = middle_and_radius(t);
        // Far from zero they are smaller: t·g' = cos t − g, and t·g⁽ᵏ⁾ + k·g⁽ᵏ⁻¹⁾ is a sine or cosine.
        let near = t.smallest();
        let bound = |k: f64, lower: f64, most: f64| up(up(1.0 + up(k * lower)) / near).min(most);
        let s0 = bound(0.0, 0.0, 1.0);
        let s1 = bound(1.0, s0, 0.4363);
        let s2 = bound(2.0, s1, 0.334);
        let s3 = bound(3.0, s2, 0.25);
        let [g0, g1, g2] = sinc_derivatives(middle);
        let around = |g: f64, sup: f64| Interval::point(g).widened(up(radius * sup) + SLOPE_ERROR);
        // The value itself is only as far off as a sine and a quotient.
        let value = Interval::point(g0).widened(up(radius * s1) + 4.0 * f64::EPSILON * g0.abs());
        let first = around(g1, s2).meet(Interval::within(s1));
        let second = around(g2, s3).meet(Interval::within(s2));
        self.chain(value.meet(SINC_RANGE), first, second, Class::Smooth)
    }
}

/// A number and how far others of the interval are from it at most.
fn middle_and_radius(t: Interval) -> (f64, f64) {
    let middle = t.middle();
    (middle, up(t.high - middle).max(up(middle - t.low)))
}

fn up(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.next_up() }
}

/// sin t / t and its first two derivatives, to within a few units of 10⁻¹⁵.
fn sinc_derivatives(t: f64) -> [f64; 3] {
    if t.abs() >= 1.0 {
        let value = libm::sin(t) / t;
        let first = (libm::cos(t) - value) / t;
        return [value, first, -value - 2.0 * first / t];
    }
    // Σ (−1)ᵏ t²ᵏ/(2k + 1)!, whose terms fall below 10⁻²⁰.
    let square = t * t;
    let (mut first, mut second) = (0.0, 0.0);
    // The power t²ᵏ⁻² over (2k + 1)!, with its sign.
    let mut term = 1.0;
    for k in 1..=10 {
        let n = 2.0 * f64::from(k);
        term /= -n * (n + 1.0);
        first += n * term * t;
        second += n * (n - 1.0) * term;
        term *= square;
    }
    [if t == 0.0 { 1.0 } else { libm::sin(t) / t }, first, second]
}
