//! Where the middle of an edge lies on the curved surface.

use glam::DVec3;

/// The middle of a smooth edge from `a` to `b` whose ends have these unit normals.
///
/// Exact on circles, cylinders and spheres. With a factor of one for [`bulge`] this is the middle of a PN
/// triangle's edge, which errs by ⅜θ⁴R on a circle.
pub(super) fn smooth_middle([a, b]: [DVec3; 2], [n_a, n_b]: [DVec3; 2]) -> DVec3 {
    let along = b - a;
    let middle = 0.5 * (a + b);
    if n_a == DVec3::ZERO || n_b == DVec3::ZERO {
        return middle;
    }
    let bulge = bulge(n_a.dot(n_b));
    let pull = along.dot(n_a) * n_a - along.dot(n_b) * n_b;
    middle - bulge / 8.0 * pull
}

/// 2 / ((1 + cos θ) cos θ), where θ is half of the angle between the normals; at most 60°.
fn bulge(cos_between: f64) -> f64 {
    let cos = (0.5 * (1.0 + cos_between)).max(0.0).sqrt().max(0.5);
    2.0 / ((1.0 + cos) * cos)
}

/// The unit normal at the middle of a smooth edge: the normals at its ends reflected across it.
pub(super) fn middle_normal(along: DVec3, [n_a, n_b]: [DVec3; 2]) -> DVec3 {
    let sum = n_a + n_b;
    let squared = along.length_squared();
    if squared == 0.0 {
        return sum.normalize_or_zero();
    }
    (sum - 2.0 * along.dot(sum) / squared * along).normalize_or_zero()
}

/// The middle of a crease or border from `a` to `b` with these unit tangents at its ends, both toward
/// `b`. Exact on circles.
pub(super) fn curve_middle([a, b]: [DVec3; 2], [t_a, t_b]: [DVec3; 2]) -> DVec3 {
    let length = a.distance(b);
    let cos = 0.5 * (t_a + t_b).dot(b - a) / length;
    let bend = length * (t_a - t_b) / (4.0 * (1.0 + cos.max(0.0)));
    0.5 * (a + b) + if bend.is_finite() { bend } else { DVec3::ZERO }
}

/// A straight line continues into a curve where its piece is this many times as long as the curve's.
const STRAIGHT: f64 = 3.0;

/// The tangent at `v` of the circle through three points, from `before` toward `after`; `None` where the
/// turn is larger than `cos_turn` says. A much longer side is straight, and the tangent that of it.
pub(super) fn circle_tangent([before, v, after]: [DVec3; 3], cos_turn: f64) -> Option<DVec3> {
    let (a, b) = (v - before, after - v);
    let (la, lb) = (a.length(), b.length());
    if la == 0.0 || lb == 0.0 || a.dot(b) < cos_turn * la * lb {
        return None;
    }
    let tangent = match la / lb {
        ratio if ratio > STRAIGHT => a,
        ratio if ratio < 1.0 / STRAIGHT => b,
        _ => a / la * lb + b / lb * la,
    };
    Some(tangent.normalize_or_zero())
}
