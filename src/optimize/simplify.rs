//! Fewer points within a stated distance (Ramer 1972, Douglas and Peucker 1973).

use glam::DVec2;

/// Points in one run of the recursion, so that no drawing takes quadratic time.
const MAX_RUN: usize = 2048;

/// The points of `line` to keep so that none left out is farther than `tolerance_mm` from the
/// new line; points where `is_joint` says so are always kept, as are both ends.
///
/// With a tolerance of zero exactly those points go that lie on the segment between their
/// neighbors, by robust's `orient2d`. On a closed line the point farthest from the seam stays.
pub(super) fn simplify(
    line: &[DVec2],
    is_joint: impl Fn(usize) -> bool,
    tolerance_mm: f64,
) -> Vec<DVec2> {
    let (Some(&first), Some(&last)) = (line.first(), line.last()) else {
        return Vec::new();
    };
    if line.len() < 3 {
        return line.to_vec();
    }
    let mut turning = 0;
    if first == last {
        let farthest = |i: &usize, j: &usize| {
            line[*i].distance_squared(first).total_cmp(&line[*j].distance_squared(first))
        };
        turning = (1..line.len() - 1).max_by(farthest).unwrap_or(0);
    }
    let mut kept = vec![first];
    let mut start = 0;
    for i in 1..line.len() {
        if i + 1 == line.len() || i == turning || is_joint(i) || i - start >= MAX_RUN {
            if tolerance_mm > 0.0 {
                keep_farthest(&line[start..=i], tolerance_mm, &mut kept);
            } else {
                keep_corners(&line[start..=i], &mut kept);
            }
            kept.push(line[i]);
            start = i;
        }
    }
    kept
}

/// Appends the inner points of `run` that are farther than the tolerance from what is kept.
fn keep_farthest(run: &[DVec2], tolerance_mm: f64, kept: &mut Vec<DVec2>) {
    let mut keep = vec![false; run.len()];
    let mut stack = vec![(0, run.len() - 1)];
    while let Some((from, to)) = stack.pop() {
        let farthest = (from + 1..to)
            .map(|i| (distance_to_segment(run[i], run[from], run[to]), i))
            .max_by(|x, y| x.0.total_cmp(&y.0).then(y.1.cmp(&x.1)));
        if let Some((distance, i)) = farthest
            && distance > tolerance_mm
        {
            keep[i] = true;
            stack.push((from, i));
            stack.push((i, to));
        }
    }
    kept.extend(run.iter().zip(keep).filter(|(_, keep)| *keep).map(|(&p, _)| p));
}

/// Appends the inner points of `run` at which it is not exactly straight.
fn keep_corners(run: &[DVec2], kept: &mut Vec<DVec2>) {
    let mut before = run[0];
    for pair in run[1..].windows(2) {
        let (here, after) = (pair[0], pair[1]);
        let coord = |p: DVec2| robust::Coord { x: p.x, y: p.y };
        let straight = robust::orient2d(coord(before), coord(here), coord(after)) == 0.0
            && (here - before).dot(after - here) > 0.0;
        if !straight {
            kept.push(here);
            before = here;
        }
    }
}

fn distance_to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let length_squared = along.length_squared();
    let t = if length_squared > 0.0 { (p - a).dot(along) / length_squared } else { 0.0 };
    p.distance(a + along * t.clamp(0.0, 1.0))
}
