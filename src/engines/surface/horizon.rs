//! Horizons: the highest and lowest lines seen so far, as exact piecewise linear functions of u.
//!
//! ```text
//!   v ▲        ╱╲   piece = part of one input segment
//!     │  ╲    ╱  ╲        ┌────   break = where one piece ends and the next begins: at the u of a
//!     │   ╲  ╱    ╲   ╱───┘               sample, at the crossing of two segments, or at the
//!     │    ╲╱      ╲╱                     border of the strip
//!     └────────────────────────► u
//! ```
//!
//! A horizon is kept in two stacks that meet at a finger, so adding a segment near the previous one costs
//! only what it touches. Pieces and breaks name the samples they come from. The rounded numbers beside
//! them have proven error bounds and serve only as a filter: where they cannot decide, the samples do,
//! exactly.

mod advance;
mod breaks;
mod order;

use std::cmp::Ordering;

use self::breaks::left_stop;
pub(super) use self::breaks::{Break, Kind, Stop};
use super::segment::{End, HorizonLine, HorizonPlane, HorizonSegment, HorizonVertex, Samples};
use super::steps::Steps;

#[derive(Debug, Clone, Copy, PartialEq)]
struct HorizonPiece {
    line: HorizonLine,
    from: Break,
}

/// Counts of work, for measuring growth.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct HorizonCounts {
    /// Pieces of horizons that a segment was compared with.
    pub comparisons: u64,
    /// Decisions that rounded numbers left open.
    pub exact: u64,
}

impl std::ops::AddAssign for HorizonCounts {
    fn add_assign(&mut self, other: Self) {
        self.comparisons += other.comparisons;
        self.exact += other.exact;
    }
}

/// One horizon over a strip of u; see the [module](self).
#[derive(Clone)]
pub(super) struct Horizon {
    /// Pieces to the left of the finger, the nearest last.
    left: Vec<HorizonPiece>,
    /// Pieces to the right of the finger, the nearest last. Never empty between calls.
    right: Vec<HorizonPiece>,
    /// Where the strip begins and ends.
    start: f64,
    /// See `start`.
    border: f64,
    /// 1 for the upper horizon, −1 for the lower one.
    up: f64,
    steps: Steps,
    pub(super) work: HorizonCounts,
}

impl Horizon {
    /// An empty horizon from `from` to `to`; `upper` keeps the highest line, otherwise the lowest.
    pub(super) fn new(from: f64, to: f64, upper: bool) -> Self {
        let from = Break { u: from, error: 0.0, kind: Kind::Border };
        let right = vec![HorizonPiece { line: HorizonLine::EMPTY, from }];
        let up = if upper { 1.0 } else { -1.0 };
        let steps = Steps::new(from.u, to);
        Self {
            left: Vec::new(),
            right,
            start: from.u,
            border: to,
            up,
            steps,
            work: HorizonCounts::default(),
        }
    }

    /// Whether a whole triangle or cell is certainly strictly within the horizon: then its segments change
    /// nothing and none is visible. `from` and `to` are the least and greatest u of
    /// its corners.
    #[inline]
    pub(super) fn encloses<S: Samples, const N: usize>(
        &mut self,
        plane: &HorizonPlane<S>,
        corners: [HorizonVertex; N],
        (from, to): (f64, f64),
    ) -> bool {
        self.work.comparisons += 1;
        // Twice the error covers the rounding of the sum.
        let heights = corners.map(|p| p.v * self.up + 2.0 * plane.v_error(p.v));
        let highest = heights.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b));
        let (from, to) = (from - 2.0 * plane.du, to + 2.0 * plane.du);
        !heights.iter().any(|height| height.is_nan()) && self.steps.are_beyond(highest, from, to)
    }

    /// The cost of [`renew_steps`](Self::renew_steps).
    pub(super) fn n_parts(&self) -> usize {
        self.left.len() + self.right.len() + self.steps.len()
    }

    /// Updates the steps that the horizon is certainly beyond.
    pub(super) fn renew_steps(&mut self) {
        let Self { left, right, steps, up, border, .. } = self;
        steps.raise();
        let pieces = left.iter().chain(right.iter().rev());
        let begins = pieces.clone().skip(1).map(|piece| (piece.from.u, piece.from.error));
        for (piece, (to, to_error)) in pieces.zip(begins.chain([(*border, 0.0)])) {
            let HorizonPiece { line, from: Break { u: from, error: from_error, .. } } = *piece;
            let height = if line.is_empty() {
                f64::NEG_INFINITY
            } else {
                // Twice the error covers the rounding of this sum.
                let sway = line.slope.abs() * (from_error + to_error);
                (line.at(from) * *up).min(line.at(to) * *up) - 2.0 * (line.error + sway)
            };
            steps.lower(from - 2.0 * from_error, to + 2.0 * to_error, height);
        }
    }

    /// Adds a segment, and reports the runs of it that are on or beyond the horizon as it was before.
    #[inline]
    pub(super) fn add<S: Samples>(
        &mut self,
        plane: &HorizonPlane<S>,
        s: &HorizonSegment,
        mut report: impl FnMut(Stop, Stop),
    ) {
        let starts_at_break = self.seek(plane, s);
        if self.is_inside(plane, s) {
            return;
        }
        let Some(mut piece) = self.right.pop() else {
            return;
        };
        // Whether the last piece on the left stack is the segment.
        let mut on_segment = false;
        let mut at_start = true;
        let mut run: Option<Stop> = None;
        if !starts_at_break {
            self.left.push(piece);
        }
        loop {
            // Whether the segment ends before, at or after the end of this piece.
            let next = self.right.last().map(|next| next.from);
            let ends = match (next, s.right) {
                (None, End::Border) => Ordering::Equal,
                (None, End::Vertex) => Ordering::Less,
                (Some(_), End::Border) => Ordering::Greater,
                (Some(next), End::Vertex) => self.order_of(plane, next, s.b()).reverse(),
            };
            let at_end = ends != Ordering::Greater;
            let (from, to) = if piece.line.is_empty() {
                (Ordering::Greater, Ordering::Greater)
            } else {
                self.work.comparisons += 1;
                let from = if at_start {
                    self.left_end(plane, s, &piece.line)
                } else {
                    self.at_break(plane, s, &piece.line, piece.from)
                };
                let to = match next {
                    Some(next) if !at_end => self.at_break(plane, s, &piece.line, next),
                    _ => self.right_end(plane, s, &piece.line),
                };
                (from, to)
            };
            let start =
                if at_start { left_stop(s, piece.from.u) } else { Stop::Inside(piece.from) };
            let start_break =
                if at_start { self.left_break(s, &piece, plane.du) } else { piece.from };
            // The piece itself is on the left stack when the segment starts inside it.
            let piece_is_down = at_start && !starts_at_break;
            match (from, to) {
                (Ordering::Less | Ordering::Equal, Ordering::Less | Ordering::Equal) => {
                    if !piece_is_down {
                        self.left.push(piece);
                    }
                    on_segment = false;
                    if from == to && from == Ordering::Equal {
                        run.get_or_insert(start);
                    } else if let Some(begin) = run.take() {
                        report(begin, start);
                    }
                }
                (Ordering::Less, Ordering::Greater) => {
                    if !piece_is_down {
                        self.left.push(piece);
                    }
                    if let Some(begin) = run.take() {
                        report(begin, start);
                    }
                    let crossing = self.crossing(plane, s, &piece, at_start, next, at_end);
                    run = Some(Stop::Inside(crossing));
                    self.left.push(HorizonPiece { line: s.line, from: crossing });
                    on_segment = true;
                }
                (Ordering::Greater, Ordering::Less) => {
                    if !on_segment {
                        self.left.push(HorizonPiece { line: s.line, from: start_break });
                    }
                    let crossing = self.crossing(plane, s, &piece, at_start, next, at_end);
                    report(run.take().unwrap_or(start), Stop::Inside(crossing));
                    self.left.push(HorizonPiece { line: piece.line, from: crossing });
                    on_segment = false;
                }
                _ => {
                    if !on_segment {
                        self.left.push(HorizonPiece { line: s.line, from: start_break });
                    }
                    run.get_or_insert(start);
                    on_segment = true;
                }
            }
            if at_end {
                if on_segment && s.right == End::Vertex {
                    let from = Break { u: s.ub, error: plane.du, kind: Kind::Vertex(s.line.b) };
                    match (ends, self.right.last_mut()) {
                        (Ordering::Equal, Some(next)) => next.from = from,
                        _ => self.right.push(HorizonPiece { line: piece.line, from }),
                    }
                }
                break;
            }
            at_start = false;
            match self.right.pop() {
                Some(next) => piece = next,
                None => break,
            }
        }
        if let Some(begin) = run {
            report(
                begin,
                if s.right == End::Vertex { Stop::Right } else { Stop::Border(self.border) },
            );
        }
        if self.right.is_empty()
            && let Some(last) = self.left.pop()
        {
            self.right.push(last);
        }
    }

    /// Whether the segment is certainly strictly within the horizon, as most are: then it changes nothing
    /// and is not visible. Uses rounded numbers only; false if they leave it open. The finger is where
    /// `seek` puts it.
    #[inline]
    fn is_inside<S: Samples>(&mut self, plane: &HorizonPlane<S>, s: &HorizonSegment) -> bool {
        if s.left == End::Border || s.right == End::Border {
            return false;
        }
        let up = self.up;
        let inside = |difference: f64, error: f64| difference * up < -2.0 * error;
        let Some((mut piece, rest)) = self.right.split_last() else {
            return false;
        };
        if !inside(
            s.line.va - piece.line.at(s.line.ua),
            piece.line.error + plane.v_error(s.line.va),
        ) {
            return false;
        }
        for next in rest.iter().rev() {
            if piece.line.is_empty() {
                return false;
            }
            self.work.comparisons += 1;
            let beyond = next.from.u - s.ub;
            let margin = 2.0 * (next.from.error + plane.du);
            if beyond > margin {
                break;
            }
            let at = s.line.at(next.from.u);
            let sway =
                |line: &HorizonLine| (s.line.slope - line.slope).abs() * 2.0 * next.from.error;
            let below = |line: &HorizonLine| {
                inside(at - line.at(next.from.u), s.line.error + line.error + sway(line))
            };
            if beyond >= -margin || !below(&piece.line) || !below(&next.line) {
                return false;
            }
            piece = next;
        }
        !piece.line.is_empty()
            && inside(s.line.vb - piece.line.at(s.ub), piece.line.error + plane.v_error(s.line.vb))
    }

    /// Moves the finger so that the next piece on the right holds the segment's left end; returns
    /// whether that piece begins there.
    #[inline]
    fn seek<S: Samples>(&mut self, plane: &HorizonPlane<S>, s: &HorizonSegment) -> bool {
        if s.left == End::Border {
            while let Some(piece) = self.left.pop() {
                self.right.push(piece);
            }
            return true;
        }
        self.seek_vertex(plane, s.a()) == Ordering::Equal
    }

    /// Moves the finger so that the next piece on the right is the last that begins at or before
    /// `p`; returns where it begins compared with `p`.
    #[inline]
    fn seek_vertex<S: Samples>(&mut self, plane: &HorizonPlane<S>, p: HorizonVertex) -> Ordering {
        let mut moved_back = false;
        let mut found = Ordering::Less;
        while let Some(piece) = self.right.last() {
            found = self.order_of(plane, piece.from, p);
            if found != Ordering::Greater {
                break;
            }
            match self.left.pop() {
                Some(piece) => self.right.push(piece),
                None => break,
            }
            moved_back = true;
        }
        while !moved_back
            && found == Ordering::Less
            && let [.., next, _] = self.right[..]
        {
            let order = self.order_of(plane, next.from, p);
            if order == Ordering::Greater {
                break;
            }
            found = order;
            self.left.extend(self.right.pop());
        }
        found
    }

    /// Which part of a radial segment is beyond the horizon, as a range of 0..1 from its near end
    /// to its far end. Both ends are at the same u, or the near end is right below or above the
    /// eye; the horizon is taken just beside that u, on the given side.
    pub(super) fn radial<S: Samples>(
        &mut self,
        plane: &HorizonPlane<S>,
        near: u32,
        far: u32,
        right_side: bool,
    ) -> Option<(f64, f64)> {
        let far_at = plane.vertex(far);
        let begins_here = self.seek_vertex(plane, far_at) == Ordering::Equal;
        let stack = if begins_here && !right_side { &self.left } else { &self.right };
        let line = stack.last().map_or(HorizonLine::EMPTY, |piece| piece.line);
        if line.is_empty() {
            return Some((0.0, 1.0));
        }
        let [_, near_depth, near_height] = plane.sight.rounded(plane.point(near));
        let [_, far_depth, _] = plane.sight.rounded(plane.point(far));
        let over_near = if near_depth > 0.0 {
            let near_at = HorizonVertex { id: near, u: far_at.u, v: near_height / near_depth };
            self.point_over(plane, near_at, &line)
        } else {
            Ordering::Less
        };
        let over_far = self.point_over(plane, far_at, &line);
        let height = line.at(far_at.u);
        let from = near_height - near_depth * height;
        let to = far_depth * (far_at.v - height);
        let crossing = (from / (from - to)).clamp(0.0, 1.0);
        match (over_near, over_far) {
            (Ordering::Less, Ordering::Greater) => Some((crossing, 1.0)),
            (Ordering::Greater, Ordering::Less) => Some((0.0, crossing)),
            (Ordering::Less, _) | (_, Ordering::Less) => None,
            _ => Some((0.0, 1.0)),
        }
    }
}
