//! The function that a sheet was sampled from, as it is drawn: what level curves are traced on.

use glam::DVec3;

use super::axis_scale::AxisScale;
use super::formula::Formula;

/// How many places of an edge are looked at together.
const PLACES: usize = 63;

/// How often the interval around the highest place of an edge is narrowed, by `PLACES` / 2 each time:
/// until nothing more can be seen in 53 bits, since heights near a peak differ by the square.
const NARROWINGS: usize = 5;

/// z = f(x, y) in the coordinates of the drawn surface.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightFunction {
    formula: Formula,
    scales: [AxisScale; 3],
}

impl HeightFunction {
    /// The heights of `formula`, multiplied by `z_factor`.
    pub fn new(formula: Formula, z_factor: f64) -> Self {
        Self::scaled(formula, [AxisScale::DATA, AxisScale::DATA, AxisScale::linear(z_factor)])
    }

    /// The heights of `formula`, which sees values, as coordinates at coordinates.
    pub fn scaled(formula: Formula, scales: [AxisScale; 3]) -> Self {
        Self { formula, scales }
    }

    /// The height; not a number where there is none.
    pub fn height(&self, x: f64, y: f64) -> f64 {
        let [of_x, of_y, of_z] = self.scales;
        of_z.drawn(self.formula.value(of_x.value(x), of_y.value(y)))
    }

    /// The heights at many places, as many as the shortest of the three slices holds.
    pub fn heights(&self, xs: &[f64], ys: &[f64], out: &mut [f64]) {
        let [of_x, of_y, of_z] = self.scales;
        if of_x == AxisScale::DATA && of_y == AxisScale::DATA {
            self.formula.values(xs, ys, out);
        } else {
            let values = |scale: AxisScale, drawn: &[f64]| -> Vec<f64> {
                drawn.iter().map(|&d| scale.value(d)).collect()
            };
            self.formula.values(&values(of_x, xs), &values(of_y, ys), out);
        }
        out.iter_mut().for_each(|z| *z = of_z.drawn(*z));
    }

    /// The heights at `PLACES` places that divide the part `t0..t1` of the edge from `a` to `b` evenly, and
    /// the places as parts of the edge.
    fn heights_between(
        &self,
        a: DVec3,
        b: DVec3,
        (t0, t1): (f64, f64),
    ) -> ([f64; PLACES], [f64; PLACES]) {
        let ts = std::array::from_fn(|k| t0 + (t1 - t0) * (k + 1) as f64 / (PLACES + 1) as f64);
        let (mut xs, mut ys, mut zs) = ([0.0; PLACES], [0.0; PLACES], [0.0; PLACES]);
        for (k, &t) in ts.iter().enumerate() {
            let place = a + t * (b - a);
            (xs[k], ys[k]) = (place.x, place.y);
        }
        self.heights(&xs, &ys, &mut zs);
        (ts, zs)
    }

    /// The highest point of the function above the edge from `a` to `b`, or the lowest one, if that is
    /// higher, or lower, than both ends.
    pub(super) fn extreme(&self, a: DVec3, b: DVec3, is_highest: bool) -> Option<DVec3> {
        let sign = if is_highest { 1.0 } else { -1.0 };
        let mut best = (0.5, f64::NEG_INFINITY);
        let mut part = (0.0, 1.0);
        for _ in 0..NARROWINGS {
            let (ts, zs) = self.heights_between(a, b, part);
            for (t, z) in ts.into_iter().zip(zs) {
                if sign * z > best.1 {
                    best = (t, sign * z);
                }
            }
            let step = (part.1 - part.0) / (PLACES + 1) as f64;
            part = ((best.0 - step).max(0.0), (best.0 + step).min(1.0));
        }
        let is_beyond = best.1 > sign * a.z && best.1 > sign * b.z && best.1.is_finite();
        is_beyond.then(|| (a + best.0 * (b - a)).with_z(sign * best.1))
    }

    /// Where the function first reaches the height of `high`, on the way from `low`, if it stays there for
    /// more than the last thousandth of the way: the edge of a plateau.
    pub(super) fn plateau_edge(&self, low: DVec3, high: DVec3) -> Option<DVec3> {
        let reaches = |t: f64| {
            let place = low + t * (high - low);
            self.height(place.x, place.y) >= high.z
        };
        const LAST: f64 = 1.0 - 1.0 / 1024.0;
        if !reaches(LAST) {
            return None;
        }
        let (mut below, mut above) = (0.0, LAST);
        loop {
            let (ts, zs) = self.heights_between(low, high, (below, above));
            let first = zs.iter().position(|z| *z >= high.z).unwrap_or(PLACES);
            let new_below = if first == 0 { below } else { ts[first - 1] };
            let new_above = if first == PLACES { above } else { ts[first] };
            if new_above - new_below >= above - below || new_above <= new_below {
                break;
            }
            (below, above) = (new_below, new_above);
        }
        (above > 0.0).then(|| (low + above * (high - low)).with_z(high.z))
    }

    /// Where a level curve that crosses the edge from `a` to `b` does so, if both ends and the edge between
    /// them are at the level: there the slope across the edge changes its sign. None if the ends of the edge
    /// are at one place.
    pub(super) fn crossing_of_level_edge(&self, a: DVec3, b: DVec3) -> Option<DVec3> {
        let across = (b - a).truncate().perp() / 1024.0;
        let slope = |t: f64| {
            let place = (a + t * (b - a)).truncate();
            let [one, other] = [place + across, place - across];
            self.height(one.x, one.y) - self.height(other.x, other.y)
        };
        let (mut low, mut high) = (0.0, 1.0);
        let sign = slope(low).signum();
        let is_crossed = slope(low) * slope(high) < 0.0;
        if !is_crossed {
            return None;
        }
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if slope(middle) * sign > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some((a + high * (b - a)).with_z(a.z))
    }

    /// The saddle near `start`, if Newton's method finds one in the rectangle between `low` and `high`.
    ///
    /// ```text
    ///   ∇f = 0 with det H < 0; slopes and curvatures are central differences over 1/1024 of the
    ///   rectangle, exact for quadratic functions
    /// ```
    pub(super) fn saddle(&self, start: DVec3, low: DVec3, high: DVec3) -> Option<DVec3> {
        let [hx, hy] = [(high.x - low.x) / 1024.0, (high.y - low.y) / 1024.0];
        let (mut x, mut y) = (start.x, start.y);
        for _ in 0..16 {
            let at = [-1.0, 0.0, 1.0];
            let xs: [f64; 9] = std::array::from_fn(|k| x + hx * at[k % 3]);
            let ys: [f64; 9] = std::array::from_fn(|k| y + hy * at[k / 3]);
            let mut f = [0.0; 9];
            self.heights(&xs, &ys, &mut f);
            // In units of hx and hy.
            let (fx, fy) = ((f[5] - f[3]) / 2.0, (f[7] - f[1]) / 2.0);
            let (fxx, fyy) = (f[5] - 2.0 * f[4] + f[3], f[7] - 2.0 * f[4] + f[1]);
            let fxy = (f[8] - f[6] - f[2] + f[0]) / 4.0;
            let determinant = fxx * fyy - fxy * fxy;
            if determinant.is_nan() || determinant >= 0.0 {
                return None;
            }
            let dx = hx * (fy * fxy - fx * fyy) / determinant;
            let dy = hy * (fx * fxy - fy * fxx) / determinant;
            (x, y) = (x + dx, y + dy);
            // One on a side would make triangles without an area.
            let is_inside = x > low.x + hx && x < high.x - hx && y > low.y + hy && y < high.y - hy;
            if !is_inside {
                return None;
            }
            if dx.abs() <= hx * 1e-9 && dy.abs() <= hy * 1e-9 {
                let z = self.height(x, y);
                return z.is_finite().then(|| DVec3::new(x, y, z));
            }
        }
        None
    }
}
