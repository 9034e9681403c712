//! Segments of the surface in the plane of horizons, and samples there: rounded, with error bounds.

use std::cmp::Ordering;

use glam::DVec3;

use super::plan_predicates::PlanSight;

/// Stands for no sample.
pub(super) const NONE: u32 = u32::MAX;

/// Half the distance from 1 to the next number.
pub(super) const UNIT: f64 = f64::EPSILON / 2.0;

/// Crossings whose u is less accurate than this are computed again in integers. It affects where a stroke
/// ends, never what is visible.
pub(super) const CROSSING_PRECISION: f64 = 1e-13;

/// Ends of pieces that are less accurate than this fraction of the edge are computed again in integers. It
/// affects where a stroke ends, never what is visible.
pub(super) const PLACE_PRECISION: f64 = 1e-10;

/// Samples by number.
pub(super) trait Samples: Sync {
    /// Where a sample is.
    fn point(&self, sample: u32) -> DVec3;
}

/// A sample in the plane of horizons, rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HorizonVertex {
    pub(super) id: u32,
    pub(super) u: f64,
    pub(super) v: f64,
}

/// The corners of a cell of a grid and how it is cut in two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    pub(super) near: HorizonVertex,
    pub(super) right: HorizonVertex,
    pub(super) left: HorizonVertex,
    pub(super) far: HorizonVertex,
    pub(super) diagonal: Diagonal,
}

impl Cell {
    /// The corners that the diagonal joins.
    pub(super) fn diagonal(&self) -> (HorizonVertex, HorizonVertex) {
        match self.diagonal {
            Diagonal::NearToFar => (self.near, self.far),
            Diagonal::LeftToRight => (self.left, self.right),
        }
    }
}

/// Which corners of a cell its diagonal joins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Diagonal {
    NearToFar,
    LeftToRight,
}

/// The samples, how they are seen, and the error bounds of rounded u and v.
pub(super) struct HorizonPlane<'a, S: Samples> {
    pub(super) samples: &'a S,
    pub(super) sight: PlanSight,
    /// Bound on the error of u.
    pub(super) du: f64,
    /// Bound on the error of v: `dv_relative · |v| + dv`.
    pub(super) dv_relative: f64,
    /// See `dv_relative`.
    pub(super) dv: f64,
}

impl<'a, S: Samples> HorizonPlane<'a, S> {
    /// `size` bounds |x|, |y| and |z| of all samples minus the sight's center.
    pub(super) fn new(samples: &'a S, sight: PlanSight, size: DVec3) -> Self {
        match sight.forward {
            // dx, dy and dz have one rounding each, their sum and difference two, relative to the sum,
            // which is not less than the difference; the quotients add one.
            None => Self {
                samples,
                sight,
                du: 6.0 * UNIT,
                dv_relative: 6.0 * UNIT,
                dv: f64::MIN_POSITIVE,
            },
            Some(f) => {
                let reach = f.x.abs() * size.y + f.y.abs() * size.x;
                let plan = f.x * f.x + f.y * f.y;
                let along = f.z.abs() * (f.x.abs() * size.x + f.y.abs() * size.y);
                let (du, dv) = (4.0 * UNIT * reach, 8.0 * UNIT * (plan * size.z + along));
                Self {
                    samples,
                    sight,
                    du: du + f64::MIN_POSITIVE,
                    dv_relative: 0.0,
                    dv: dv + f64::MIN_POSITIVE,
                }
            }
        }
    }

    /// An upper bound on |u| of all samples; 0 to within rounding only if all are 0.
    pub(super) fn reach(&self) -> f64 {
        self.du / UNIT
    }

    pub(super) fn vertex(&self, id: u32) -> HorizonVertex {
        let [hu, hw, hv] = self.sight.rounded(self.samples.point(id));
        HorizonVertex { id, u: hu / hw, v: hv / hw }
    }

    pub(super) fn point(&self, id: u32) -> DVec3 {
        self.samples.point(id)
    }

    pub(super) fn v_error(&self, v: f64) -> f64 {
        self.dv_relative * v.abs() + self.dv
    }

    /// Whether `a` is left or right of `b` along u.
    pub(super) fn order(&self, a: HorizonVertex, b: HorizonVertex) -> Ordering {
        if a.id == b.id {
            return Ordering::Equal;
        }
        filtered(a.u - b.u, 2.0 * self.du)
            .unwrap_or_else(|| self.sight.order(self.point(a.id), self.point(b.id)))
    }

    /// Whether `a` is left or right of a border.
    pub(super) fn order_to_border(&self, a: HorizonVertex, u: f64) -> Ordering {
        filtered(a.u - u, self.du)
            .unwrap_or_else(|| self.sight.order_to_border(self.point(a.id), u))
    }
}

/// The sign of a rounded number, if it is farther from zero than its error. Twice the bound covers the
/// rounding of the bound and of the last difference.
pub(super) fn filtered(value: f64, error: f64) -> Option<Ordering> {
    if value > 2.0 * error {
        Some(Ordering::Greater)
    } else if value < -2.0 * error {
        Some(Ordering::Less)
    } else {
        None
    }
}

/// A straight line in the plane of horizons, through two samples from left to right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HorizonLine {
    pub(super) a: u32,
    pub(super) b: u32,
    pub(super) ua: f64,
    pub(super) va: f64,
    pub(super) vb: f64,
    pub(super) slope: f64,
    /// Bound on the error of `at` between the ends; infinite when the line is too steep to filter.
    pub(super) error: f64,
}

impl HorizonLine {
    pub(super) const EMPTY: Self =
        Self { a: NONE, b: NONE, ua: 0.0, va: 0.0, vb: 0.0, slope: 0.0, error: 0.0 };

    pub(super) fn is_empty(&self) -> bool {
        self.a == NONE
    }

    pub(super) fn at(&self, u: f64) -> f64 {
        self.va + self.slope * (u - self.ua)
    }
}

/// Where a segment ends within its strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum End {
    /// At its own sample.
    Vertex,
    /// At the strip's border.
    Border,
}

/// A segment of the surface to be tested against a horizon and added to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HorizonSegment {
    pub(super) line: HorizonLine,
    pub(super) ub: f64,
    pub(super) left: End,
    pub(super) right: End,
}

impl HorizonSegment {
    /// The samples that it joins.
    pub(super) fn ids(&self) -> (u32, u32) {
        (self.line.a, self.line.b)
    }

    /// The segment from `a` to `b`, where `a` is strictly to the left of `b` and both are in the
    /// part of the sight.
    #[inline]
    pub(super) fn new<S: Samples>(
        plane: &HorizonPlane<S>,
        (a, left): (HorizonVertex, End),
        (b, right): (HorizonVertex, End),
    ) -> Self {
        let width = b.u - a.u;
        let v_error = plane.v_error(a.v) + plane.v_error(b.v);
        let line = HorizonLine {
            a: a.id,
            b: b.id,
            ua: a.u,
            va: a.v,
            vb: b.v,
            slope: 0.0,
            error: f64::INFINITY,
        };
        let mut segment = Self { line, ub: b.u, left, right };
        segment.set_slope(width, v_error, plane.du);
        segment
    }

    fn set_slope(&mut self, width: f64, v_error: f64, du: f64) {
        // Below this the errors of the ends' u are no longer small compared with their distance.
        if width > 64.0 * du {
            let line = &mut self.line;
            line.slope = (line.vb - line.va) / width;
            // An error of du at either end shifts the line by up to du times its slope, slightly more
            // to second order; evaluation rounds four times.
            line.error = 2.0 * v_error
                + 6.0 * du * line.slope.abs()
                + 8.0 * UNIT * (line.va.abs() + line.vb.abs());
        }
    }

    /// A segment with an end that may be outside the part bounded by `dx, dy ≥ 0`; it then ends at the
    /// part's border, u = −1 or 1. `a` is to the left of `b` as seen from the eye.
    pub(super) fn clipped<S: Samples>(
        plane: &HorizonPlane<S>,
        (a, left): (u32, End),
        (b, right): (u32, End),
    ) -> Self {
        let sight = &plane.sight;
        let d = |id: u32| {
            let d = plane.point(id) - sight.center;
            DVec3::new(d.x * sight.sx, d.y * sight.sy, d.z)
        };
        let (da, db) = (d(a), d(b));
        let size = da.abs().max(db.abs());
        let end = |id: u32, d: DVec3, other: DVec3, u: f64, out: bool| {
            if !out {
                return (
                    HorizonVertex { id, u: (d.x - d.y) / (d.x + d.y), v: d.z / (d.x + d.y) },
                    plane.v_error(d.z / (d.x + d.y)),
                );
            }
            // The border u = −1 is dx = 0, and u = 1 is dy = 0.
            let (from, to) = if u < 0.0 { (d.x, other.x) } else { (d.y, other.y) };
            let t = from / (from - to);
            let at = d + t * (other - d);
            let depth = if u < 0.0 { at.y } else { at.x };
            let v = at.z / depth;
            let depth_error = 8.0 * UNIT * size.x.max(size.y);
            let error = (8.0 * UNIT * size.z + v.abs() * depth_error) / (depth - depth_error);
            let error = if depth > 2.0 * depth_error { error } else { f64::INFINITY };
            (HorizonVertex { id, u, v }, error)
        };
        let (a_at, a_error) = end(a, da, db, -1.0, left == End::Border);
        let (b_at, b_error) = end(b, db, da, 1.0, right == End::Border);
        let line = HorizonLine {
            a,
            b,
            ua: a_at.u,
            va: a_at.v,
            vb: b_at.v,
            slope: 0.0,
            error: f64::INFINITY,
        };
        let mut segment = Self { line, ub: b_at.u, left, right };
        if a_error + b_error < f64::INFINITY {
            segment.set_slope(b_at.u - a_at.u, a_error + b_error, plane.du);
        }
        segment
    }

    pub(super) fn a(&self) -> HorizonVertex {
        HorizonVertex { id: self.line.a, u: self.line.ua, v: self.line.va }
    }

    pub(super) fn b(&self) -> HorizonVertex {
        HorizonVertex { id: self.line.b, u: self.ub, v: self.line.vb }
    }
}
