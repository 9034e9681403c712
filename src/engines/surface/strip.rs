//! A strip of u with its two horizons, and the record of what is visible in it.

use std::cmp::Ordering;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

use glam::DVec3;

use super::HorizonCounts;
use super::horizon::{Break, Horizon, Kind, Stop};
use super::pieces::{HIDDEN, LOWER, SurfaceSide, UPPER, VisiblePiece};
use super::plan_predicates::PlaceOnU;
use super::segment::{
    Cell, End, HorizonPlane, HorizonSegment, HorizonVertex, PLACE_PRECISION, Samples, filtered,
};

/// A strip of one part of the domain, from one u to another. Strips never hide each other.
pub(super) struct HorizonStrip<'a, S: Samples> {
    pub(super) plane: HorizonPlane<'a, S>,
    pub(super) from: f64,
    pub(super) to: f64,
    /// Absent if the eye is below the surface within the domain: all is below it.
    upper: Option<Horizon>,
    /// Absent if the eye is above the surface within the domain.
    lower: Option<Horizon>,
    /// Whether there is nothing to do with the upper, the lower horizon in the cell that is visited.
    is_settled: [bool; 2],
    /// Whether the far edges of the cell that is visited are known to be visible.
    is_seen: bool,
    /// Cells visited since the horizons' steps were found.
    n_visited: usize,
    /// Edges wholly visible; each is written by the one strip that holds it.
    status: &'a [AtomicU8],
    pub(super) found: Vec<VisiblePiece>,
}

impl<'a, S: Samples> HorizonStrip<'a, S> {
    pub(super) fn new(
        plane: HorizonPlane<'a, S>,
        (from, to): (f64, f64),
        (upper, lower): (bool, bool),
        status: &'a [AtomicU8],
    ) -> Self {
        let upper = upper.then(|| Horizon::new(from, to, true));
        let lower = lower.then(|| Horizon::new(from, to, false));
        Self {
            plane,
            from,
            to,
            upper,
            lower,
            is_settled: [false; 2],
            is_seen: false,
            n_visited: 0,
            status,
            found: Vec::new(),
        }
    }

    /// A strip with horizons that are known.
    pub(super) fn with_horizons(
        plane: HorizonPlane<'a, S>,
        range: (f64, f64),
        horizons: [Option<Horizon>; 2],
        status: &'a [AtomicU8],
    ) -> Self {
        let mut strip = Self::new(plane, range, (false, false), status);
        strip.set_horizons(horizons);
        strip
    }

    /// Replaces the upper and the lower horizon.
    pub(super) fn set_horizons(&mut self, horizons: [Option<Horizon>; 2]) {
        [self.upper, self.lower] = horizons;
    }

    /// The upper and the lower horizon.
    pub(super) fn into_horizons(self) -> [Option<Horizon>; 2] {
        [self.upper, self.lower]
    }

    pub(super) fn work(&self) -> HorizonCounts {
        let mut work = HorizonCounts::default();
        for horizon in [&self.upper, &self.lower].into_iter().flatten() {
            work += horizon.work;
        }
        work
    }

    /// The segment between two samples of the part, `a` to the left of `b`, as far as it lies in the
    /// strip.
    #[inline]
    pub(super) fn segment(&self, a: HorizonVertex, b: HorizonVertex) -> Option<HorizonSegment> {
        let margin = 4.0 * self.plane.du;
        let (mut left, mut right) = (End::Vertex, End::Vertex);
        if !(a.u > self.from + margin && b.u < self.to - margin) {
            if self.plane.order_to_border(b, self.from) != Ordering::Greater
                || self.plane.order_to_border(a, self.to) != Ordering::Less
            {
                return None;
            }
            if self.plane.order_to_border(a, self.from) == Ordering::Less {
                left = End::Border;
            }
            if self.plane.order_to_border(b, self.to) == Ordering::Greater {
                right = End::Border;
            }
        }
        Some(HorizonSegment::new(&self.plane, (a, left), (b, right)))
    }

    /// The segment between two samples that may lie outside the part, or be radial.
    pub(super) fn clipped(&self, a: u32, b: u32) -> Option<HorizonSegment> {
        let sight = &self.plane.sight;
        let point = |id: u32| self.plane.samples.point(id);
        let (a, b) = match sight.order(point(a), point(b)) {
            Ordering::Less => (a, b),
            Ordering::Equal => return None,
            Ordering::Greater => (b, a),
        };
        let outside =
            |id: u32, s: f64, at: fn(DVec3) -> f64| at(point(id)) * s < at(sight.center) * s;
        let out = |id: u32| outside(id, sight.sx, |p| p.x) || outside(id, sight.sy, |p| p.y);
        let (a_out, b_out) = (out(a), out(b));
        // Both outside, it passes through the part only from beyond x, on the left, to beyond y.
        let crosses = || {
            outside(a, sight.sx, |p| p.x)
                && !outside(a, sight.sy, |p| p.y)
                && outside(b, sight.sy, |p| p.y)
                && !outside(b, sight.sx, |p| p.x)
        };
        if a_out && b_out && !crosses() {
            return None;
        }
        let end = |out: bool| if out { End::Border } else { End::Vertex };
        let mut segment = HorizonSegment::clipped(&self.plane, (a, end(a_out)), (b, end(b_out)));
        let order = |id: u32, u: f64| self.plane.order_to_border(self.plane.vertex(id), u);
        if (!b_out && order(b, self.from) != Ordering::Greater)
            || (!a_out && order(a, self.to) != Ordering::Less)
        {
            return None;
        }
        segment.left = end(a_out || order(a, self.from) == Ordering::Less);
        segment.right = end(b_out || order(b, self.to) == Ordering::Greater);
        Some(segment)
    }

    /// Looks where a triangle lies as a whole; says whether there is anything to do with its
    /// segments, which are compared with those horizons only that it is not surely within. `range`
    /// is that of its corners' u.
    #[inline]
    pub(super) fn visit(&mut self, corners: [HorizonVertex; 3], range: (f64, f64)) -> bool {
        self.keep_steps();
        for (horizon, is_settled) in
            [&mut self.upper, &mut self.lower].into_iter().zip(&mut self.is_settled)
        {
            *is_settled = horizon
                .as_mut()
                .is_none_or(|horizon| horizon.encloses(&self.plane, corners, range));
        }
        self.is_settled != [true; 2]
    }

    /// The same for a cell, whose far edges have these numbers; none where one of them is radial.
    /// A horizon that only moves from its near edges to its far ones does so at once.
    #[inline]
    pub(super) fn visit_cell(&mut self, cell: &Cell, far_edges: Option<[u32; 2]>) -> bool {
        self.keep_steps();
        let Cell { near, right, left, far, .. } = *cell;
        let horizons = [(&mut self.upper, UPPER), (&mut self.lower, LOWER)];
        for ((horizon, seen), is_settled) in horizons.into_iter().zip(&mut self.is_settled) {
            let Some(horizon) = horizon else {
                *is_settled = true;
                continue;
            };
            if let Some(edges) = far_edges
                && horizon.advance(&self.plane, cell)
            {
                if !self.is_seen {
                    for edge in edges {
                        self.status[edge as usize].store(seen, Relaxed);
                    }
                }
                (*is_settled, self.is_seen) = (true, true);
            } else {
                let corners = [near, right, left, far];
                *is_settled = horizon.encloses(&self.plane, corners, (left.u, right.u));
            }
        }
        self.is_settled != [true; 2]
    }

    /// Finds the horizons' steps again when that costs no more than was done since.
    #[inline]
    fn keep_steps(&mut self) {
        self.n_visited += 1;
        let horizons = [&self.upper, &self.lower].into_iter().flatten();
        if self.n_visited > horizons.map(Horizon::n_parts).sum() {
            self.n_visited = 0;
            [&mut self.upper, &mut self.lower].into_iter().flatten().for_each(Horizon::renew_steps);
        }
    }

    /// After this, segments are compared with both horizons.
    #[inline]
    pub(super) fn leave(&mut self) {
        self.is_settled = [false; 2];
        self.is_seen = false;
    }

    /// Lets a segment hide what comes later.
    #[inline]
    pub(super) fn hide(&mut self, segment: &HorizonSegment) {
        for (horizon, is_settled) in
            [&mut self.upper, &mut self.lower].into_iter().zip(self.is_settled)
        {
            if let Some(horizon) = horizon.as_mut().filter(|_| !is_settled) {
                horizon.add(&self.plane, segment, |_, _| {});
            }
        }
    }

    /// Records what is visible of a segment, which is an edge of the drawing, and lets it hide.
    #[inline]
    pub(super) fn draw(&mut self, segment: &HorizonSegment, edge: u32) {
        let Self { plane, status, found, from, to, is_settled, .. } = self;
        let mut wholly = self.is_seen;
        let horizons =
            [(&mut self.upper, SurfaceSide::Upper), (&mut self.lower, SurfaceSide::Lower)];
        for ((horizon, side), &is_settled) in horizons.into_iter().zip(&*is_settled) {
            let Some(horizon) = horizon.as_mut().filter(|_| !is_settled) else { continue };
            let seen_before = wholly;
            horizon.add(plane, segment, |begin, end| {
                if seen_before {
                    return;
                }
                if (begin, end) == (Stop::Left, Stop::Right) {
                    wholly = true;
                    let seen = if side == SurfaceSide::Upper { UPPER } else { LOWER };
                    status[edge as usize].store(seen, Relaxed);
                    return;
                }
                let t = |stop| place(plane, segment, stop, (*from, *to));
                let (a, b) = (t(begin), t(end));
                let (t0, t1) = (a.min(b), a.max(b));
                if t0 < t1 {
                    found.push(VisiblePiece { edge, t0, t1, side });
                }
            });
        }
    }

    /// Records an edge as visible from end to end.
    pub(super) fn draw_whole(&mut self, edge: u32) {
        let side = if self.upper.is_some() { SurfaceSide::Upper } else { SurfaceSide::Lower };
        self.found.push(VisiblePiece { edge, t0: 0.0, t1: 1.0, side });
    }

    /// As [`draw`](Self::draw), for an edge whose ends may lie outside the part.
    pub(super) fn draw_clipped(&mut self, a: u32, b: u32, edge: u32) {
        if let Some(segment) = self.clipped(a, b) {
            self.draw(&segment, edge);
        }
    }

    /// Whether a radial edge rises (`Greater`) or falls (`Less`) away from the eye in the plane of
    /// horizons. `None` when its near end is right above or below the eye.
    fn rise(&self, near: u32, far: u32) -> Option<Ordering> {
        let plane = &self.plane;
        let [_, near_depth, _] = plane.sight.rounded(plane.point(near));
        if near_depth <= 0.0 {
            return None;
        }
        let (from, to) = (plane.vertex(near), plane.vertex(far));
        let error = plane.v_error(from.v) + plane.v_error(to.v);
        let rounded = filtered(to.v - from.v, error);
        Some(rounded.unwrap_or_else(|| plane.sight.rise(plane.point(near), plane.point(far))))
    }

    /// The parts of a segment that are beyond a horizon, as ranges of 0..1 from `a` to `b`. The segment
    /// is behind the surface, and all of it is at the same u.
    pub(super) fn beyond_at(&mut self, a: u32, b: u32) -> Vec<[f64; 2]> {
        let depth = |id: u32| self.plane.sight.rounded(self.plane.point(id))[1];
        let is_behind = |id: u32| {
            let (p, sight) = (self.plane.point(id), &self.plane.sight);
            let [x, y] = [(p.x - sight.center.x) * sight.sx, (p.y - sight.center.y) * sight.sy];
            sight.forward.is_none() && (x < 0.0 || y < 0.0)
        };
        let (near, far) = if depth(a) <= depth(b) { (a, b) } else { (b, a) };
        if is_behind(far) {
            return Vec::new();
        }
        let at = self.plane.vertex(far);
        let from = self.plane.order_to_border(at, self.from);
        let to = self.plane.order_to_border(at, self.to);
        let mut parts = Vec::new();
        for right_side in [false, true] {
            let inside = if right_side {
                from != Ordering::Less && to == Ordering::Less
            } else {
                from == Ordering::Greater && to != Ordering::Greater
            };
            for horizon in [&mut self.upper, &mut self.lower].into_iter().flatten() {
                let beyond = horizon.radial(&self.plane, near, far, right_side);
                let Some((from, to)) = beyond.filter(|_| inside) else { continue };
                parts.push(if near == a { [from, to] } else { [1.0 - to, 1.0 - from] });
            }
        }
        parts
    }

    /// Records what is visible of a radial edge, whose ends are at the same u, as seen from the cell
    /// on one side of it. `t_foot` is set when the edge's near end lies behind the eye's foot.
    pub(super) fn draw_radial(
        &mut self,
        (near, far): (u32, u32),
        edge: u32,
        right_side: bool,
        t_foot: Option<f64>,
    ) {
        let at = self.plane.vertex(far);
        let from = self.plane.order_to_border(at, self.from);
        let to = self.plane.order_to_border(at, self.to);
        let inside = if right_side {
            from != Ordering::Less && to == Ordering::Less
        } else {
            from == Ordering::Greater && to != Ordering::Greater
        };
        if !inside {
            return;
        }
        // The surface right beside the edge's near part hides the rest of it from one of its sides.
        let rise = if t_foot.is_none() { self.rise(near, far) } else { None };
        let horizons = [
            (&mut self.upper, SurfaceSide::Upper, Ordering::Less),
            (&mut self.lower, SurfaceSide::Lower, Ordering::Greater),
        ];
        for (horizon, side, hidden) in horizons {
            let Some(horizon) = horizon else { continue };
            if rise == Some(hidden) {
                continue;
            }
            let Some((from, to)) = horizon.radial(&self.plane, near, far, right_side) else {
                continue;
            };
            let from = t_foot.map_or(from, |t| from.max(t));
            if (from, to) == (0.0, 1.0) {
                // The cells on both sides may be in different strips, so the order must not matter.
                let seen = if side == SurfaceSide::Upper { UPPER } else { LOWER };
                let merge = |old| Some(if old == HIDDEN { seen } else { seen.min(old) });
                let _ = self.status[edge as usize].fetch_update(Relaxed, Relaxed, merge);
                continue;
            }
            let (t0, t1) = if near < far { (from, to) } else { (1.0 - to, 1.0 - from) };
            if t0 < t1 {
                self.found.push(VisiblePiece { edge, t0, t1, side });
            }
        }
    }
}

/// Where a stop lies on the edge, from 0 at the sample with the smaller number to 1.
fn place<S: Samples>(
    plane: &HorizonPlane<S>,
    segment: &HorizonSegment,
    stop: Stop,
    (from, to): (f64, f64),
) -> f64 {
    let (a, b) = segment.ids();
    let (first, last) = (plane.samples.point(a.min(b)), plane.samples.point(a.max(b)));
    let u = match stop {
        Stop::Left => return if a < b { 0.0 } else { 1.0 },
        Stop::Right => return if a < b { 1.0 } else { 0.0 },
        Stop::Border(u) if plane.sight.forward.is_none() && (u == -1.0 || u == 1.0) => {
            // Both parts beside this border must find the same number.
            let k = usize::from(u > 0.0);
            let center = plane.sight.center[k];
            return (center - first[k]) / ((center - first[k]) + (last[k] - center));
        }
        Stop::Inside(at) => {
            // On an edge nearly in the vertical plane of the eye, u hardly changes.
            let width = segment.ub - segment.line.ua;
            if at.error + 2.0 * plane.du > PLACE_PRECISION * width {
                return exact_place(plane, [first, last], segment, at).clamp(0.0, 1.0);
            }
            at.u.clamp(from, to)
        }
        Stop::Border(u) => u.clamp(from, to),
    };
    let g = |p: DVec3| {
        let [hu, hw, _] = plane.sight.rounded(p);
        hu - u * hw
    };
    let (at_first, at_last) = (g(first), g(last));
    (at_first / (at_first - at_last)).clamp(0.0, 1.0)
}

/// The same for a break, from the very samples.
fn exact_place<S: Samples>(
    plane: &HorizonPlane<S>,
    ends: [DVec3; 2],
    segment: &HorizonSegment,
    at: Break,
) -> f64 {
    let points = |ids: [u32; 2]| ids.map(|id| plane.point(id));
    let own = [segment.line.a, segment.line.b];
    let sight = &plane.sight;
    match at.kind {
        Kind::Border => sight.way_to_place(ends, PlaceOnU::Border(at.u)),
        Kind::Vertex(id) => sight.way_to_place(ends, PlaceOnU::Vertex(plane.point(id))),
        Kind::Crossing(line, other) if other == own => sight.way_to_line(ends, points(line)),
        Kind::Crossing(line, other) if line == own => sight.way_to_line(ends, points(other)),
        Kind::Crossing(line, other) => sight.way_to_crossing(ends, points(line), points(other)),
    }
}
