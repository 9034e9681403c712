//! From pieces to strokes: chained along their lines, without strokes too short for a pen.
//!
//! ```text
//!   segments of one line    ├────┼──┼─────┼───┼──────┤     each ends where the next one begins
//!   drawn                   ├────────┤ ├──────┤   ├┤
//!   strokes                 ├─────────────────┤            gaps close, crumbs go
//! ```
//!
//! Joints are equal points, never points near each other.

use glam::DVec2;
use rayon::prelude::*;

use super::interval::Intervals;
use super::pieces::Pieces;
use crate::strokes::{StrokeKind, Strokes};

/// Where a line is seen but not drawn for less than this, it is drawn: pens do not lift for less.
const LEAST_LIFT_MM: f64 = 0.6;

/// The same for what is hidden: no more than the pen's own width or so.
const LEAST_HIDDEN_MM: f64 = 0.25;

/// Marks no segment.
const NONE: u32 = u32::MAX;

/// What is to be done with a part of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Drawn,
    /// Seen, but too light.
    Blank,
    Hidden,
}

/// A part of a line that is drawn or not, with its ends on paper.
#[derive(Debug, Clone, Copy)]
struct Part {
    state: State,
    ends: [DVec2; 2],
    length_mm: f64,
}

/// One stroke for each visible part, with whether it is lit.
pub(super) fn exact(pieces: &Pieces, intervals: &Intervals) -> Strokes {
    let mut strokes = Strokes::default();
    for i in 0..pieces.hatched.len() {
        for part in intervals.of(i) {
            let ends = [part.t0, part.t1].map(|t| pieces.image(i, t));
            strokes.push_lit(StrokeKind::Hatch, part.is_lit, ends);
        }
    }
    strokes
}

/// The strokes of all lines: every second line runs the other way, for a pen that goes to and fro.
/// O(segments log segments of a line), in parallel.
pub(super) fn chained(pieces: &Pieces, intervals: &Intervals, shortest_mm: f64) -> Strokes {
    let lines: Vec<std::ops::Range<usize>> = {
        let mut start = 0;
        let line = |a: &super::HatchSegment| (a.family, a.line);
        let groups = pieces.hatched.chunk_by(|a, b| line(a) == line(b));
        let ranges = groups.map(|group| {
            start += group.len();
            start - group.len()..start
        });
        ranges.collect()
    };
    let of_lines: Vec<Vec<Vec<DVec2>>> = lines
        .par_iter()
        .map(|line| strokes_of_line(pieces, intervals, line.clone(), shortest_mm))
        .collect();
    let mut strokes = Strokes::default();
    let drawn = of_lines.iter().filter(|line| !line.is_empty());
    for (number, line) in drawn.enumerate() {
        if number % 2 == 0 {
            line.iter().for_each(|s| strokes.push(StrokeKind::Hatch, 0, s.iter().copied()));
        } else {
            let backwards = line.iter().rev();
            backwards.for_each(|s| strokes.push(StrokeKind::Hatch, 0, s.iter().rev().copied()));
        }
    }
    strokes
}

/// The strokes of one line, whose segments have these numbers.
fn strokes_of_line(
    pieces: &Pieces,
    intervals: &Intervals,
    line: std::ops::Range<usize>,
    shortest_mm: f64,
) -> Vec<Vec<DVec2>> {
    let mut strokes = Vec::new();
    if line.clone().all(|i| intervals.of(i).iter().all(|part| !part.is_drawn)) {
        return strokes;
    }
    let following = following(pieces, line.clone());
    let mut follows = vec![false; line.len()];
    following.iter().filter(|&&next| next != NONE).for_each(|&next| follows[next as usize] = true);
    let mut is_done = vec![false; line.len()];
    let mut parts = Vec::new();
    // Chains with a beginning first, then rings.
    for rings in [false, true] {
        for start in 0..line.len() {
            if is_done[start] || (follows[start] && !rings) {
                continue;
            }
            parts.clear();
            let mut at = start as u32;
            while at != NONE && !is_done[at as usize] {
                is_done[at as usize] = true;
                add_parts(pieces, intervals, line.start + at as usize, &mut parts);
                at = following[at as usize];
            }
            if rings {
                begin_at_a_gap(&mut parts);
            }
            let drawn = |part: &Part| part.state == State::Drawn;
            close(&mut parts, State::Blank, LEAST_LIFT_MM);
            close(&mut parts, State::Hidden, LEAST_HIDDEN_MM);
            for run in parts.chunk_by(|a, b| drawn(a) == drawn(b)) {
                let length_mm: f64 = run.iter().map(|part| part.length_mm).sum();
                if drawn(&run[0]) && length_mm >= shortest_mm {
                    let rest = run.iter().map(|part| part.ends[1]);
                    strokes.push([run[0].ends[0]].into_iter().chain(rest).collect());
                }
            }
        }
    }
    strokes
}

/// For each segment of a line the one that begins where it ends, counted from the first one.
fn following(pieces: &Pieces, line: std::ops::Range<usize>) -> Vec<u32> {
    let mut starts: Vec<(u32, u32)> =
        (0..).zip(line.clone()).map(|(k, i)| (pieces.segments.ends(i)[0], k)).collect();
    starts.sort_unstable();
    let mut is_taken = vec![false; starts.len()];
    line.map(|i| {
        let end = pieces.segments.ends(i)[1];
        let first = starts.partition_point(|&(start, _)| start < end);
        let mut meeting = starts[first..].iter().take_while(|&&(start, _)| start == end);
        let next = meeting.find(|&&(_, k)| !is_taken[k as usize]);
        next.map_or(NONE, |&(_, k)| {
            is_taken[k as usize] = true;
            k
        })
    })
    .collect()
}

/// Appends the parts of a segment, those that are hidden among them.
fn add_parts(pieces: &Pieces, intervals: &Intervals, i: usize, parts: &mut Vec<Part>) {
    let mut at = 0.0;
    let mut add = |t0: f64, t1: f64, state: State| {
        let ends = [t0, t1].map(|t| pieces.image(i, t));
        parts.push(Part { state, ends, length_mm: pieces.length_mm(i, t0, t1) });
    };
    for part in intervals.of(i) {
        if part.t0 > at {
            add(at, part.t0, State::Hidden);
        }
        add(part.t0, part.t1, if part.is_drawn { State::Drawn } else { State::Blank });
        at = part.t1;
    }
    if at < 1.0 {
        add(at, 1.0, State::Hidden);
    }
}

/// Turns a ring so that it does not begin within a stroke, if there is a gap.
fn begin_at_a_gap(parts: &mut [Part]) {
    if let Some(gap) = parts.iter().position(|part| part.state != State::Drawn) {
        parts.rotate_left(gap);
    }
}

/// Draws what of a state is shorter than this between two drawn parts.
fn close(parts: &mut [Part], state: State, limit_mm: f64) {
    let mut start = 0;
    while start < parts.len() {
        let length = parts[start..].iter().take_while(|part| part.state == state).count();
        let end = start + length;
        let is_between = length > 0
            && start > 0
            && end < parts.len()
            && parts[start - 1].state == State::Drawn
            && parts[end].state == State::Drawn;
        let length_mm: f64 = parts[start..end].iter().map(|part| part.length_mm).sum();
        if is_between && length_mm < limit_mm {
            parts[start..end].iter_mut().for_each(|part| part.state = State::Drawn);
        }
        start = end.max(start + 1);
    }
}
