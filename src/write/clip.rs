//! Polylines cut off at a rectangle: what a machine cannot reach is not written.

use glam::DVec2;

/// The pieces of `line` inside the rectangle from `low` to `high`, border included, in order.
///
/// Segment by segment as Liang and Barsky (1984). Cuts lie on the border exactly, so rounding a
/// piece to whole units never leaves a rectangle with whole corners.
pub(super) fn clip(line: &[DVec2], low: DVec2, high: DVec2) -> Vec<Vec<DVec2>> {
    let mut pieces: Vec<Vec<DVec2>> = Vec::new();
    let mut open = false;
    for pair in line.windows(2) {
        let Some((from, to)) = clip_segment(pair[0], pair[1], low, high) else {
            open = false;
            continue;
        };
        match pieces.last_mut() {
            Some(piece) if open && from == pair[0] => piece.push(to),
            _ => pieces.push(vec![from, to]),
        }
        open = to == pair[1];
    }
    // A line that only touches the border is not drawn there; a dot is.
    let is_dot = |line: &[DVec2]| line.iter().all(|p| *p == line[0]);
    if !is_dot(line) {
        pieces.retain(|piece| !is_dot(piece));
    }
    pieces
}

fn clip_segment(from: DVec2, to: DVec2, low: DVec2, high: DVec2) -> Option<(DVec2, DVec2)> {
    if !(from.is_finite() && to.is_finite()) {
        return None;
    }
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let (a, way) = (from[axis], to[axis] - from[axis]);
        if way == 0.0 {
            if a < low[axis] || a > high[axis] {
                return None;
            }
            continue;
        }
        let (t0, t1) = ((low[axis] - a) / way, (high[axis] - a) / way);
        enter = enter.max(t0.min(t1));
        leave = leave.min(t0.max(t1));
    }
    let at = |t: f64| (from + (to - from) * t).clamp(low, high);
    let start = if enter <= 0.0 { from } else { at(enter) };
    let end = if leave >= 1.0 { to } else { at(leave) };
    (enter <= leave).then_some((start, end))
}
