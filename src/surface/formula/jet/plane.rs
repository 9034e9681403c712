//! Distance and angle of a point in the plane.

use std::f64::consts::PI;

use super::super::interval::Interval;
use super::{Class, Jet};

impl Jet {
    /// The distance of the point (x, y) from the origin.
    pub(crate) fn hypotenuse(x: Self, y: Self) -> Self {
        let class = x.class.min(y.class);
        // The correctly rounded sum and root may fall outside of what `hypot` gives by one number.
        let exact = (x.value.square() + y.value.square()).sqrt();
        let low = if exact.low == 0.0 { 0.0 } else { exact.low.next_down() };
        let value = Interval::new(low, exact.high.next_up());
        let speed = (x.first.square() + y.first.square()).sqrt();
        if value.low <= 0.0 {
            let first = Interval::within(speed.high);
            let class = class.min(Class::Lipschitz);
            return Self { value, first, second: Interval::ALL, class };
        }
        // r' = (x·x' + y·y')/r and r'' = ((x·y' − y·x')²/r² + x·x'' + y·y'')/r.
        let first = (x.value * x.first + y.value * y.first).over(value);
        let first =
            if speed.high.is_finite() { first.meet(Interval::within(speed.high)) } else { first };
        let across = (x.value * y.first - y.value * x.first).over(value);
        let bend = x.value * x.second + y.value * y.second;
        Self { value, first, second: (across.square() + bend).over(value), class }
    }

    /// The angle of the point (x, y) from the x axis. It jumps at the negative half of that.
    pub(crate) fn angle(y: Self, x: Self) -> Self {
        let class = x.class.min(y.class);
        let (xs, ys) = (x.value, y.value);
        let is_cut = xs.low < 0.0 && ys.low < 0.0 && ys.high >= 0.0;
        if is_cut || xs.contains(0.0) && ys.contains(0.0) {
            let all = Interval::within(PI.next_up().next_up());
            // Half a turn at the origin, at least: with y of one sign no cut is met.
            return Self::of_values(all, class.min(Class::Defined));
        }
        let value = angles(ys, xs);
        // θ' = (x·y' − y·x')/r², and the quotient's rule gives θ''.
        let square = xs.square() + ys.square();
        let turn = xs * y.first - ys * x.first;
        let bend = xs * y.second - ys * x.second;
        let growth = (xs * x.first + ys * y.first).double();
        let first = turn.over(square);
        Self { value, first, second: (bend - first * growth).over(square), class }
    }
}

/// The angles of a box that meets neither the origin nor the cut in its inside.
fn angles(y: Interval, x: Interval) -> Interval {
    if y.high <= 0.0 && y.low < 0.0 {
        return -angles(-y, x);
    }
    // Seen from the origin, the corners that are farthest apart.
    let low_at = if y.low >= 0.0 {
        if x.high >= 0.0 { (y.low, x.high) } else { (y.high, x.high) }
    } else {
        (y.low, x.low)
    };
    let high_at = if y.low >= 0.0 {
        if x.low >= 0.0 { (y.high, x.low) } else { (y.low, x.low) }
    } else {
        (y.high, x.low)
    };
    // A negative zero would be on the other side of the cut.
    let at = |(y, x): (f64, f64)| libm::atan2(y + 0.0, x);
    let (low, high) = (at(low_at), at(high_at));
    let low = if low == 0.0 && low_at.0 == 0.0 { 0.0 } else { low.next_down().next_down() };
    let high = if high == 0.0 && high_at.0 == 0.0 { 0.0 } else { high.next_up().next_up() };
    Interval::new(low, high)
}
