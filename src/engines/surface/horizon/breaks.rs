//! Breaks, where one piece of a horizon gives way to the next, and stops, where visible runs end.

use super::{Horizon, HorizonPiece};
use crate::engines::surface::segment::{
    CROSSING_PRECISION, End, HorizonPlane, HorizonSegment, Samples, UNIT,
};

/// Where a piece begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::stages::engines::surface) struct Break {
    pub(in crate::stages::engines::surface) u: f64,
    /// Bound on the error of `u`.
    pub(in crate::stages::engines::surface) error: f64,
    pub(in crate::stages::engines::surface) kind: Kind,
}

/// What a break is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::stages::engines::surface) enum Kind {
    /// The strip's border, at exactly `u`.
    Border,
    /// The u of a sample.
    Vertex(u32),
    /// The crossing of two lines, both from left to right. The pieces on both sides pass through it.
    Crossing([u32; 2], [u32; 2]),
}

/// A place on a segment, as a visible run reports its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::stages::engines::surface) enum Stop {
    /// The segment's left end.
    Left,
    /// The segment's right end.
    Right,
    /// Somewhere between.
    Inside(Break),
    /// At the strip's border, at exactly this u.
    Border(f64),
}

impl Horizon {
    /// The break where a segment begins.
    pub(super) fn left_break(&self, s: &HorizonSegment, piece: &HorizonPiece, du: f64) -> Break {
        match s.left {
            End::Vertex => Break { u: s.line.ua, error: du, kind: Kind::Vertex(s.line.a) },
            End::Border => piece.from,
        }
    }

    /// Where the segment crosses a piece, between given ends of their common range.
    pub(super) fn crossing<S: Samples>(
        &mut self,
        plane: &HorizonPlane<S>,
        s: &HorizonSegment,
        piece: &HorizonPiece,
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

/// Where a run begins that begins with its segment.
pub(super) fn left_stop(s: &HorizonSegment, border: f64) -> Stop {
    match s.left {
        End::Vertex => Stop::Left,
        End::Border => Stop::Border(border),
    }
}
