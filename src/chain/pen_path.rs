//! The order and direction in which the strokes of a family of grid lines are drawn.
//!
//! ```text
//!   ──────►─┐   ┌─►────      Where lines are hidden in part, what is visible falls into fields.
//!   ┌─◄─────┘   └──◄──┐      The pen goes to and fro over one field, and then on to the next,
//!   └───►───    ┌──►──┘      instead of leaping over what is hidden once for each line.
//! ```

use glam::DVec2;

/// A visible stroke on a line of its family.
#[derive(Debug, Clone, Copy)]
pub(super) struct LineStroke {
    /// Number of its line.
    pub(super) line: u32,
    /// Where on the line it begins and ends, in samples.
    pub(super) span: [f64; 2],
    /// The same in the image.
    pub(super) ends: [DVec2; 2],
}

/// On how many lines to either side the pen looks for the next stroke. More lines than one let it
/// pass over a line that is done or hidden here.
const NEAR_LINES: u32 = 2;

/// How many strokes of a line are looked at to either side of the pen. It bounds the cost on rough
/// surfaces, whose lines have very many strokes.
const NEAR_STROKES: usize = 8;

/// Orders strokes, which are sorted by line and span: for each in turn its number, and whether it
/// is drawn backward. O(strokes log strokes).
pub(super) fn order(strokes: &[LineStroke]) -> Vec<(usize, bool)> {
    let mut is_drawn = vec![false; strokes.len()];
    let mut path: Vec<(usize, bool)> = Vec::with_capacity(strokes.len());
    let mut first_left = 0;
    while path.len() < strokes.len() {
        while is_drawn[first_left] {
            first_left += 1;
        }
        let mut next = (first_left, false);
        if let Some(&(last, is_backwards)) = path.last() {
            let pen = &strokes[last];
            let end = usize::from(!is_backwards);
            let (at, position) = (pen.ends[end], pen.span[end]);
            let mut nearest = f64::INFINITY;
            let mut consider = |stroke: usize| {
                for (k, point) in strokes[stroke].ends.iter().enumerate() {
                    let distance = point.distance_squared(at);
                    if distance < nearest {
                        nearest = distance;
                        next = (stroke, k == 1);
                    }
                }
            };
            consider(first_left);
            for line in pen.line.saturating_sub(NEAR_LINES)..=pen.line + NEAR_LINES {
                let here = strokes.partition_point(|s| (s.line, s.span[0]) < (line, position));
                let before = strokes[..here].iter().rev().take_while(|s| s.line == line);
                let after = strokes[here..].iter().take_while(|s| s.line == line);
                let (n_before, n_after) =
                    (before.take(NEAR_STROKES).count(), after.take(NEAR_STROKES).count());
                (here - n_before..here + n_after).filter(|&k| !is_drawn[k]).for_each(&mut consider);
            }
        }
        is_drawn[next.0] = true;
        path.push(next);
    }
    path
}
