//! Roots of functions of one variable, between a place where they are negative and one where they are
//! positive.

/// Roots are known to this width, on edges of length 1.
const ROOT_WIDTH: f64 = 1e-13;

/// A bracket that closes on a root: the last place `a`, the other end `b` of the bracket, and the next
/// place to look at. By Chandrupatla's method: inverse quadratic interpolation where that is safe, and
/// bisection elsewhere (T. R. Chandrupatla, Advances in Engineering Software 28, 1997).
#[derive(Debug, Clone)]
pub(super) struct Bracket {
    a: (f64, f64),
    b: (f64, f64),
    next: f64,
}

impl Bracket {
    /// A bracket between two places, given with values of different signs.
    pub(super) fn new(a: (f64, f64), b: (f64, f64)) -> Self {
        let straight = a.1 / (a.1 - b.1);
        let part = if straight > 0.0 && straight < 1.0 { straight } else { 0.5 };
        Self { a, b, next: a.0 + part * (b.0 - a.0) }
    }

    /// The place to look at next.
    pub(super) fn next(&self) -> f64 {
        self.next
    }

    /// Takes the value, a number, at the place that was looked at; the root, once it is known.
    pub(super) fn step(&mut self, value: f64) -> Option<f64> {
        let new = (self.next, value);
        let c = if (value < 0.0) == (self.a.1 < 0.0) {
            std::mem::replace(&mut self.a, new)
        } else {
            let old = std::mem::replace(&mut self.a, new);
            std::mem::replace(&mut self.b, old)
        };
        let (a, b) = (self.a, self.b);
        let width = (b.0 - a.0).abs();
        let nearest = if a.1.abs() < b.1.abs() { a } else { b };
        if value == 0.0 || width <= 2.0 * ROOT_WIDTH {
            return Some(nearest.0);
        }
        let xi = (a.0 - b.0) / (c.0 - b.0);
        let phi = (a.1 - b.1) / (c.1 - b.1);
        let is_safe = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
        let part = if is_safe {
            let [fa, fb, fc] = [a.1, b.1, c.1];
            fa / (fb - fa) * fc / (fb - fc)
                + (c.0 - a.0) / (b.0 - a.0) * fa / (fc - fa) * fb / (fc - fb)
        } else {
            0.5
        };
        let least = (ROOT_WIDTH / width).min(0.5);
        let part = if part.is_nan() { 0.5 } else { part.clamp(least, 1.0 - least) };
        self.next = a.0 + part * (b.0 - a.0);
        None
    }
}
