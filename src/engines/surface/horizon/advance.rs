//! The usual case: a cell whose near edges lie on the horizon and whose far edges lie beyond it.
//!
//! ```text
//!           far
//!        ╱‾‾   ‾‾╲          The horizon ran from left over near to right, and now runs from left
//!   left           right    over far to right. Two comparisons settle it.
//!        ╲__   __╱
//!           near
//! ```

use std::cmp::Ordering;

use super::{Break, Horizon, HorizonPiece, Kind};
use crate::engines::surface::segment::{
    Cell, Diagonal, End, HorizonLine, HorizonPlane, HorizonSegment, HorizonVertex, Samples,
    filtered,
};

impl Horizon {
    /// Moves the horizon from a cell's near edges to its far ones, if it lies on the near ones and
    /// the far ones are surely beyond; then both are wholly visible. Otherwise nothing is done, and
    /// the cell's segments must be added one by one. No corner may lie at the u of another but near
    /// and far. A cell that the strip's border cuts has no break of the horizon there, so it is left
    /// alone.
    ///
    /// Between left and right, the far edges less the near ones are a function that is straight but
    /// at near and far, so it is positive where it is so at both. A diagonal from near to far lies
    /// on the near edges at near and on the far ones at far, and the far edges are straight between:
    /// it is not beyond them. Where the diagonal joins left and right, far beyond it makes the far
    /// edges concave; then near within them means that both near edges are, and so is the diagonal.
    #[inline]
    pub(in crate::stages::engines::surface) fn advance<S: Samples>(
        &mut self,
        plane: &HorizonPlane<S>,
        cell: &Cell,
    ) -> bool {
        let Some(near_edges) = self.near_edges(cell) else {
            return false;
        };
        let Cell { near, right, left, far, diagonal } = *cell;
        let Some(order) = filtered(near.u - far.u, 2.0 * plane.du) else {
            return false;
        };
        self.work.comparisons += 2;
        let segment = |a, b| HorizonSegment::new(plane, (a, End::Vertex), (b, End::Vertex)).line;
        let (left_far, far_right) = (segment(left, far), segment(far, right));
        let (beside_far, beside_near) = match order {
            Ordering::Less => (near_edges[1], left_far),
            _ => (near_edges[0], far_right),
        };
        let far_is_beyond = match diagonal {
            Diagonal::NearToFar => self.is_surely_beyond(plane, far, &beside_far),
            Diagonal::LeftToRight => self.is_surely_beyond(plane, far, &segment(left, right)),
        };
        if !far_is_beyond || !self.is_surely_within(plane, near, &beside_near) {
            return false;
        }
        let at_left = self.right.pop().map(|piece| piece.from);
        if let (Some(from), Some(next)) = (at_left, self.right.last_mut()) {
            self.left.push(HorizonPiece { line: left_far, from });
            let from = Break { u: far.u, error: plane.du, kind: Kind::Vertex(far.id) };
            *next = HorizonPiece { line: far_right, from };
        }
        true
    }

    /// The near edges of a cell, if the horizon lies on both between left and right and no break is
    /// in them but near. Then the next piece on the right is the first of the two.
    #[inline]
    fn near_edges(&mut self, cell: &Cell) -> Option<[HorizonLine; 2]> {
        let joins = |piece: &HorizonPiece, a: HorizonVertex, b: HorizonVertex| {
            (piece.line.a, piece.line.b) == (a.id, b.id) && piece.from.kind == Kind::Vertex(a.id)
        };
        // The finger may be at near if the previous cell was added segment by segment.
        if self.left.last().is_some_and(|piece| joins(piece, cell.left, cell.near)) {
            self.right.extend(self.left.pop());
        }
        let [.., after, second, first] = &self.right[..] else {
            return None;
        };
        let lies_on_both = joins(first, cell.left, cell.near)
            && joins(second, cell.near, cell.right)
            && after.from.kind == Kind::Vertex(cell.right.id);
        lies_on_both.then_some([first.line, second.line])
    }

    #[inline]
    fn is_surely_beyond<S: Samples>(
        &self,
        plane: &HorizonPlane<S>,
        p: HorizonVertex,
        line: &HorizonLine,
    ) -> bool {
        self.side_of(plane, p, line) == Some(Ordering::Greater)
    }

    #[inline]
    fn is_surely_within<S: Samples>(
        &self,
        plane: &HorizonPlane<S>,
        p: HorizonVertex,
        line: &HorizonLine,
    ) -> bool {
        self.side_of(plane, p, line) == Some(Ordering::Less)
    }
}
