//! Horizons: the highest and lowest lines seen so far, as exact piecewise linear functions of u.
//!
//! ```text
//!   v ▲        ╱╲   piece = part of one input segment
//!     │  ╲    ╱  ╲        ┌────   break = where one piece gives way to the next: at the u of a
//!     │   ╲  ╱    ╲   ╱───┘               sample, at the crossing of two segments, or at the
//!     │    ╲╱      ╲╱                     border of the strip
//!     └────────────────────────► u
//! ```
//!
//! A horizon is kept in two stacks that meet at a finger, so that adding a segment near the one
//! before costs what it touches. Pieces and breaks name the samples they come from; the rounded
//! numbers beside them carry proven error bounds and only ever filter: where they cannot decide, the
//! samples themselves do, exactly.

use std::cmp::Ordering;

use super::plan_predicates::Place;
use super::segment::{
    CROSSING_PRECISION, End, Line, Plane, Samples, Segment, UNIT, Vertex, filtered,
};
use super::steps::Steps;

/// Where a piece begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Break {
    pub(super) u: f64,
    /// Bound on the error of `u`.
    pub(super) error: f64,
    pub(super) kind: Kind,
}

/// What a break is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    /// The strip's border, at exactly `u`.
    Border,
    /// The u of a sample.
    Vertex(u32),
    /// The crossing of two lines, both from left to right. The pieces on both sides pass through it.
    Crossing([u32; 2], [u32; 2]),
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    line: Line,
    from: Break,
}

/// A place on a segment, as a visible run reports its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stop {
    /// The segment's left end.
    Left,
    /// The segment's right end.
    Right,
    /// Somewhere between.
    Inside(Break),
    /// At the strip's border, at exactly this u.
    Border(f64),
}

/// Counts of work, for measuring growth.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Pieces of horizons that a segment was compared with.
    pub comparisons: u64,
    /// Decisions that rounded numbers could not make.
    pub exact: u64,
}

impl std::ops::AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.comparisons += other.comparisons;
        self.exact += other.exact;
    }
}

/// One horizon over a strip of u; see the [module](self).
pub(super) struct Horizon {
    /// Pieces to the left of the finger, the nearest last.
    left: Vec<Piece>,
    /// Pieces to the right of the finger, the nearest last. Never empty between calls.
    right: Vec<Piece>,
    /// Where the strip begins and ends.
    start: f64,
    /// See `start`.
    border: f64,
    /// 1 for the upper horizon, −1 for the lower one.
    up: f64,
    steps: Steps,
    pub(super) work: Work,
}

impl Horizon {
    /// An empty horizon from `from` to `to`; `upper` keeps the highest line, otherwise the lowest.
    pub(super) fn new(from: f64, to: f64, upper: bool) -> Self {
        let from = Break { u: from, error: 0.0, kind: Kind::Border };
        let right = vec![Piece { line: Line::EMPTY, from }];
        let up = if upper { 1.0 } else { -1.0 };
        let steps = Steps::new(from.u, to);
        Self {
            left: Vec::new(),
            right,
            start: from.u,
            border: to,
            up,
            steps,
            work: Work::default(),
        }
    }

    /// Whether all of a triangle or cell surely lies strictly within the horizon: then its segments
    /// change nothing and nothing of them is seen. `from` and `to` are the least and greatest u of
    /// its corners.
    #[inline]
    pub(super) fn encloses<S: Samples, const N: usize>(
        &mut self,
        plane: &Plane<S>,
        corners: [Vertex; N],
        (from, to): (f64, f64),
    ) -> bool {
        self.work.comparisons += 1;
        // Twice the error covers the rounding of the sum.
        let heights = corners.map(|p| p.v * self.up + 2.0 * plane.v_error(p.v));
        let highest = heights.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b));
        let (from, to) = (from - 2.0 * plane.du, to + 2.0 * plane.du);
        !heights.iter().any(|height| height.is_nan()) && self.steps.are_beyond(highest, from, to)
    }

    /// What [`renew_steps`](Self::renew_steps) costs.
    pub(super) fn n_parts(&self) -> usize {
        self.left.len() + self.right.len() + self.steps.len()
    }

    /// Finds anew what the horizon is surely beyond.
    pub(super) fn renew_steps(&mut self) {
        let Self { left, right, steps, up, border, .. } = self;
        steps.raise();
        let pieces = left.iter().chain(right.iter().rev());
        let begins = pieces.clone().skip(1).map(|piece| (piece.from.u, piece.from.error));
        for (piece, (to, to_error)) in pieces.zip(begins.chain([(*border, 0.0)])) {
            let Piece { line, from: Break { u: from, error: from_error, .. } } = *piece;
            let height = if line.is_empty() {
                f64::NEG_INFINITY
            } else {
                // Errors twice, which covers the rounding of this sum.
                let sway = line.slope.abs() * (from_error + to_error);
                (line.at(from) * *up).min(line.at(to) * *up) - 2.0 * (line.error + sway)
            };
            steps.lower(from - 2.0 * from_error, to + 2.0 * to_error, height);
        }
    }

    /// Adds a segment, and reports the runs of it that lie on or beyond the horizon as it was.
    #[inline]
    pub(super) fn add<S: Samples>(
        &mut self,
        plane: &Plane<S>,
        s: &Segment,
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
                    self.left.push(Piece { line: s.line, from: crossing });
                    on_segment = true;
                }
                (Ordering::Greater, Ordering::Less) => {
                    if !on_segment {
                        self.left.push(Piece { line: s.line, from: start_break });
                    }
                    let crossing = self.crossing(plane, s, &piece, at_start, next, at_end);
                    report(run.take().unwrap_or(start), Stop::Inside(crossing));
                    self.left.push(Piece { line: piece.line, from: crossing });
                    on_segment = false;
                }
                _ => {
                    if !on_segment {
                        self.left.push(Piece { line: s.line, from: start_break });
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
                        _ => self.right.push(Piece { line: piece.line, from }),
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

    /// Whether the segment certainly lies strictly within the horizon, as most do: then it changes
    /// nothing and nothing of it is seen. Rounded numbers only; what they leave open is false. The
    /// finger is where `seek` puts it.
    #[inline]
    fn is_inside<S: Samples>(&mut self, plane: &Plane<S>, s: &Segment) -> bool {
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
            let sway = |line: &Line| (s.line.slope - line.slope).abs() * 2.0 * next.from.error;
            let below = |line: &Line| {
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
    fn seek<S: Samples>(&mut self, plane: &Plane<S>, s: &Segment) -> bool {
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
    fn seek_vertex<S: Samples>(&mut self, plane: &Plane<S>, p: Vertex) -> Ordering {
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

    /// Which part of a radial segment lies beyond the horizon, as a range of 0..1 from its near end
    /// to its far end. Both ends are at the same u, or the near end is right below or above the
    /// eye; the horizon counts as it is just beside that u, on the given side.
    pub(super) fn radial<S: Samples>(
        &mut self,
        plane: &Plane<S>,
        near: u32,
        far: u32,
        right_side: bool,
    ) -> Option<(f64, f64)> {
        let far_at = plane.vertex(far);
        let begins_here = self.seek_vertex(plane, far_at) == Ordering::Equal;
        let stack = if begins_here && !right_side { &self.left } else { &self.right };
        let line = stack.last().map_or(Line::EMPTY, |piece| piece.line);
        if line.is_empty() {
            return Some((0.0, 1.0));
        }
        let [_, near_depth, near_height] = plane.sight.rounded(plane.point(near));
        let [_, far_depth, _] = plane.sight.rounded(plane.point(far));
        let over_near = if near_depth > 0.0 {
            let near_at = Vertex { id: near, u: far_at.u, v: near_height / near_depth };
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

    /// Where a break lies along u compared with a sample.
    #[inline]
    fn order_of<S: Samples>(&self, plane: &Plane<S>, b: Break, p: Vertex) -> Ordering {
        if let Some(order) = filtered(b.u - p.u, b.error + plane.du) {
            return order;
        }
        match b.kind {
            Kind::Vertex(id) if id == p.id => Ordering::Equal,
            Kind::Vertex(id) => plane.sight.order(plane.point(id), plane.point(p.id)),
            Kind::Border => plane.sight.order_to_border(plane.point(p.id), b.u).reverse(),
            Kind::Crossing(first, second) => plane
                .sight
                .order_to_crossing(
                    plane.point(p.id),
                    first.map(|id| plane.point(id)),
                    second.map(|id| plane.point(id)),
                )
                .reverse(),
        }
    }

    fn upward(&self, order: Ordering) -> Ordering {
        if self.up < 0.0 { order.reverse() } else { order }
    }

    /// Whether a sample is beyond a line: `Greater` is above for the upper horizon.
    fn point_over<S: Samples>(&mut self, plane: &Plane<S>, p: Vertex, line: &Line) -> Ordering {
        if p.id == line.a || p.id == line.b {
            return Ordering::Equal;
        }
        let error = line.error + plane.v_error(p.v);
        if let Some(order) = filtered((p.v - line.at(p.u)) * self.up, error) {
            return order;
        }
        self.work.exact += 1;
        let [p, a, b] = [p.id, line.a, line.b].map(|id| plane.point(id));
        self.upward(plane.sight.point_over_line(p, a, b))
    }

    fn at_border<S: Samples>(
        &mut self,
        plane: &Plane<S>,
        s: &Segment,
        line: &Line,
        u: f64,
    ) -> Ordering {
        let difference = (s.line.at(u) - line.at(u)) * self.up;
        if let Some(order) = filtered(difference, s.line.error + line.error) {
            return order;
        }
        self.lines_at(plane, s, line, Place::Border(u))
    }

    fn lines_at<S: Samples>(
        &mut self,
        plane: &Plane<S>,
        s: &Segment,
        line: &Line,
        at: Place,
    ) -> Ordering {
        if (s.line.a, s.line.b) == (line.a, line.b) {
            return Ordering::Equal;
        }
        self.work.exact += 1;
        let [a, b, c, d] = [s.line.a, s.line.b, line.a, line.b].map(|id| plane.point(id));
        self.upward(plane.sight.line_over_line([a, b], [c, d], at))
    }

    fn left_end<S: Samples>(&mut self, plane: &Plane<S>, s: &Segment, line: &Line) -> Ordering {
        match s.left {
            End::Vertex => self.point_over(plane, s.a(), line),
            End::Border => self.at_border(plane, s, line, self.start),
        }
    }

    fn right_end<S: Samples>(&mut self, plane: &Plane<S>, s: &Segment, line: &Line) -> Ordering {
        match s.right {
            End::Vertex => self.point_over(plane, s.b(), line),
            End::Border => self.at_border(plane, s, line, self.border),
        }
    }

    /// Whether the segment is beyond a line at a break inside both.
    #[inline]
    fn at_break<S: Samples>(
        &mut self,
        plane: &Plane<S>,
        s: &Segment,
        line: &Line,
        b: Break,
    ) -> Ordering {
        let difference = (s.line.at(b.u) - line.at(b.u)) * self.up;
        let error = s.line.error
            + line.error
            + (s.line.slope - line.slope).abs() * b.error
            + UNIT * (s.line.slope.abs() + line.slope.abs()) * b.error;
        if let Some(order) = filtered(difference, error) {
            return order;
        }
        match b.kind {
            Kind::Border => self.lines_at(plane, s, line, Place::Border(b.u)),
            Kind::Vertex(id) => {
                let on_segment = id == s.line.a || id == s.line.b;
                let on_line = id == line.a || id == line.b;
                match (on_segment, on_line) {
                    (true, true) => Ordering::Equal,
                    (false, true) => {
                        self.work.exact += 1;
                        let [p, a, b] = [id, s.line.a, s.line.b].map(|id| plane.point(id));
                        self.upward(plane.sight.point_over_line(p, a, b)).reverse()
                    }
                    (true, false) => {
                        self.work.exact += 1;
                        let [p, a, b] = [id, line.a, line.b].map(|id| plane.point(id));
                        self.upward(plane.sight.point_over_line(p, a, b))
                    }
                    (false, false) => self.lines_at(plane, s, line, Place::Vertex(plane.point(id))),
                }
            }
            Kind::Crossing(first, second) => {
                self.work.exact += 1;
                let points = |ids: [u32; 2]| ids.map(|id| plane.point(id));
                let own = points([s.line.a, s.line.b]);
                let sight = &plane.sight;
                self.upward(sight.line_over_crossing(own, points(first), points(second)))
            }
        }
    }

    /// The break where a segment begins.
    fn left_break(&self, s: &Segment, piece: &Piece, du: f64) -> Break {
        match s.left {
            End::Vertex => Break { u: s.line.ua, error: du, kind: Kind::Vertex(s.line.a) },
            End::Border => piece.from,
        }
    }

    /// Where the segment crosses a piece, between given ends of their common range.
    fn crossing<S: Samples>(
        &mut self,
        plane: &Plane<S>,
        s: &Segment,
        piece: &Piece,
        at_start: bool,
        next: Option<Break>,
        at_end: bool,
    ) -> Break {
        let line = &piece.line;
        let (low, low_error) = match (at_start, s.left) {
            (true, End::Vertex) => (s.line.ua, plane.du),
            (true, End::Border) => (self.start, 0.0),
            (false, _) => (piece.from.u, piece.from.error),
        };
        let (high, high_error) = match (at_end, s.right, next) {
            (true, End::Vertex, _) => (s.ub, plane.du),
            (false, _, Some(next)) => (next.u, next.error),
            _ => (self.border, 0.0),
        };
        let (from, to) = (s.line.at(low) - line.at(low), s.line.at(high) - line.at(high));
        let slope = s.line.slope - line.slope;
        let lines_error = s.line.error + line.error;
        let t = (from / (from - to)).clamp(0.0, 1.0);
        let width = high - low;
        let mut u = if t.is_nan() { low + 0.5 * width } else { low + t * width };
        // The lines' errors move the crossing by their sum over the difference of slopes, which
        // itself has an error; interpolation rounds a few times.
        let slope_error = 2.0 * lines_error / width.max(0.0);
        let steep = slope.abs() - slope_error;
        let mut error = if steep > 0.5 * slope.abs() {
            2.0 * lines_error / steep
                + 4.0 * UNIT * (low.abs() + high.abs())
                + low_error
                + high_error
        } else {
            f64::INFINITY
        };
        if error.is_nan() || error >= CROSSING_PRECISION * plane.reach() / 6.0 {
            self.work.exact += 1;
            let points = |ids: [u32; 2]| ids.map(|id| plane.point(id));
            u = plane.sight.crossing_u(points([s.line.a, s.line.b]), points([line.a, line.b]));
            error = 2.0 * f64::EPSILON * u.abs() + plane.du;
        }
        Break { u, error, kind: Kind::Crossing([s.line.a, s.line.b], [line.a, line.b]) }
    }
}

fn left_stop(s: &Segment, border: f64) -> Stop {
    match s.left {
        End::Vertex => Stop::Left,
        End::Border => Stop::Border(border),
    }
}
