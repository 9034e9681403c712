//! Order: whether samples and segments lie before or after a break, and beyond a line or not.
//! `Greater` is above for the upper horizon, below for the lower one.

use std::cmp::Ordering;

use super::{Break, Horizon, Kind};
use crate::engines::surface::plan_predicates::PlaceOnU;
use crate::engines::surface::segment::{
    End, HorizonLine, HorizonPlane, HorizonSegment, HorizonVertex, Samples, UNIT, filtered,
};

impl Horizon {
    /// Where a break lies along u compared with a sample.
    #[inline]
    pub(super) fn order_of<S: Samples>(
        &self,
        plane: &HorizonPlane<S>,
        b: Break,
        p: HorizonVertex,
    ) -> Ordering {
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

    /// Whether a sample is beyond a line, if rounded numbers can decide it.
    #[inline]
    pub(super) fn side_of<S: Samples>(
        &self,
        plane: &HorizonPlane<S>,
        p: HorizonVertex,
        line: &HorizonLine,
    ) -> Option<Ordering> {
        filtered((p.v - line.at(p.u)) * self.up, line.error + plane.v_error(p.v))
    }

    /// Whether a sample is beyond a line: `Greater` is above for the upper horizon.
    pub(super) fn point_over<S: Samples>(
        &mut self,
        plane: &HorizonPlane<S>,
        p: HorizonVertex,
        line: &HorizonLine,
    ) -> Ordering {
        if p.id == line.a || p.id == line.b {
            return Ordering::Equal;
        }
        if let Some(order) = self.side_of(plane, p, line) {
            return order;
        }
        self.work.exact += 1;
        let [p, a, b] = [p.id, line.a, line.b].map(|id| plane.point(id));
        self.upward(plane.sight.point_over_line(p, a, b))
    }

    fn at_border<S: Samples>(
        &mut self,
        plane: &HorizonPlane<S>,
        s: &HorizonSegment,
        line: &HorizonLine,
        u: f64,
    ) -> Ordering {
        let difference = (s.line.at(u) - line.at(u)) * self.up;
        if let Some(order) = filtered(difference, s.line.error + line.error) {
            return order;
        }
        self.lines_at(plane, s, line, PlaceOnU::Border(u))
    }

    fn lines_at<S: Samples>(
        &mut self,
        plane: &HorizonPlane<S>,
        s: &HorizonSegment,
        line: &HorizonLine,
        at: PlaceOnU,
    ) -> Ordering {
        if (s.line.a, s.line.b) == (line.a, line.b) {
            return Ordering::Equal;
        }
        self.work.exact += 1;
        let [a, b, c, d] = [s.line.a, s.line.b, line.a, line.b].map(|id| plane.point(id));
        self.upward(plane.sight.line_over_line([a, b], [c, d], at))
    }

    pub(super) fn left_end<S: Samples>(
        &mut self,
        plane: &HorizonPlane<S>,
        s: &HorizonSegment,
        line: &HorizonLine,
    ) -> Ordering {
        match s.left {
            End::Vertex => self.point_over(plane, s.a(), line),
            End::Border => self.at_border(plane, s, line, self.start),
        }
    }

    pub(super) fn right_end<S: Samples>(
        &mut self,
        plane: &HorizonPlane<S>,
        s: &HorizonSegment,
        line: &HorizonLine,
    ) -> Ordering {
        match s.right {
            End::Vertex => self.point_over(plane, s.b(), line),
            End::Border => self.at_border(plane, s, line, self.border),
        }
    }

    /// Whether the segment is beyond a line at a break inside both.
    #[inline]
    pub(super) fn at_break<S: Samples>(
        &mut self,
        plane: &HorizonPlane<S>,
        s: &HorizonSegment,
        line: &HorizonLine,
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
            Kind::Border => self.lines_at(plane, s, line, PlaceOnU::Border(b.u)),
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
                    (false, false) => {
                        self.lines_at(plane, s, line, PlaceOnU::Vertex(plane.point(id)))
                    }
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
}
