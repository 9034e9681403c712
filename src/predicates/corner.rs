//! Corners that cutting makes, exact however often a face is cut.
//!
//! ```text
//!          ● Vertex(v)                    A corner is known by what meets there:
//!         ╱┆╲                             a vertex of the input,
//!        ╱ ┆ ╲                            an edge and a plane, or
//!       ╱  ● InFace      ┄┄┄ cut 2        the face's own plane and two others.
//!      ●┄┄┄●┄┄┄● OnEdge  ┄┄┄ cut 1
//! ```
//!
//! Beside that each keeps a rounded point with a bound of its error. Almost all questions are answered
//! by the latter; for the rest coordinates are computed from the input in integers, so that errors
//! do not add up from cut to cut. M. Attene, "Indirect predicates for geometric constructions" (2020),
//! calls the two constructed kinds LPI and TPI, and evaluates them as is done here.

use super::exact::{self, Dyadic};
use super::pierced::ratio;
use super::planes::{Plane, PlaneName, Planes, evaluated, spread};
use super::{Estimate, Homogeneous, Sign, TRIPLE_PRODUCT_ERROR, Viewpoint};
use glam::DVec3;

/// What meets at a corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CornerPlace {
    /// A vertex of the input.
    Vertex(u32),
    /// The line through two vertices, and a plane that they lie strictly on both sides of.
    OnEdge([u32; 2], PlaneName),
    /// Three planes with one point in common.
    InFace([PlaneName; 3]),
}

/// A point of a face: where it is by definition, and rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// The exact place.
    pub place: CornerPlace,
    /// The place, rounded.
    pub point: DVec3,
    /// No coordinate of `point` is off by more than this.
    pub error: f64,
}

/// Largest error of a corner, as a part of its largest coordinate, that is left alone: above it the
/// point is computed again from integers. It bounds a construction, not a decision.
const CORNER_ERROR: f64 = 1.0 / (1u64 << 44) as f64;

impl Planes<'_> {
    /// The value of a plane at a corner, and its sign.
    ///
    /// The estimate need not have that sign where it is within its own error.
    #[inline]
    pub fn side(&self, plane: &Plane, corner: &Corner) -> (Estimate, Sign) {
        if is_known_within(&corner.place, plane) {
            return (Estimate::ZERO, Sign::Zero);
        }
        let d = corner.point - plane.base;
        let estimate = Estimate {
            value: plane.normal.dot(d) - plane.offset,
            error: TRIPLE_PRODUCT_ERROR * (plane.spread.dot(d.abs()) + plane.offset)
                + 2.0 * corner.error * plane.spread.element_sum(),
        };
        let sign = self.settle(estimate, || {
            evaluated(&self.coefficients(plane.name), &self.homogeneous(&corner.place)).sign()
        });
        (estimate, sign)
    }

    /// A vertex as a corner.
    #[inline]
    pub fn vertex(&self, vertex: u32) -> Corner {
        Corner { place: CornerPlace::Vertex(vertex), point: self.position(vertex), error: 0.0 }
    }

    /// The corner at `place`, where a plane cuts between `a` and `b`; `at` are the plane's values
    /// there, whose true signs must be opposite.
    pub fn corner_between(
        &self,
        [a, b]: [&Corner; 2],
        at: [Estimate; 2],
        place: CornerPlace,
    ) -> Corner {
        let [of_a, of_b] = at;
        let difference = of_a.value - of_b.value;
        if self.in_window() && difference.abs() > 2.0 * (of_a.error + of_b.error) {
            let t = (of_a.value / difference).clamp(0.0, 1.0);
            // As for `Sight::cut`.
            let error_of_t = 2.0 * (of_b.value.abs() * of_a.error + of_a.value.abs() * of_b.error)
                / (difference * difference)
                + 4.0 * f64::EPSILON;
            let step = b.point - a.point;
            let size = a.point.abs().max_element().max(b.point.abs().max_element());
            let error = a.error.max(b.error)
                + 2.0 * step.abs().max_element() * error_of_t
                + 2.0 * f64::EPSILON * size;
            if error <= CORNER_ERROR * size {
                return Corner { place, point: a.point + step * t, error };
            }
        }
        self.exact_corner(place)
    }

    fn exact_corner(&self, place: CornerPlace) -> Corner {
        let Homogeneous { x, w } = self.homogeneous(&place);
        // Adding zero turns −0 into 0.
        let point = DVec3::from_array(x.map(|x| ratio(&x, &w))) + DVec3::ZERO;
        let error = 4.0 * f64::EPSILON * point.abs().max_element();
        Corner { place, point, error: if self.in_window() { error } else { f64::INFINITY } }
    }

    /// Which way the image of the path `a → b → c` turns, as [`Sight::turn`](super::Sight::turn).
    /// Zero without a camera.
    pub fn turn(&self, a: &Corner, b: &Corner, c: &Corner) -> Sign {
        let Some(viewpoint) = self.viewpoint() else { return Sign::Zero };
        if is_known_collinear([&a.place, &b.place, &c.place]) {
            return Sign::Zero;
        }
        let (u, u_error) = match viewpoint {
            Viewpoint::Eye(eye) => (a.point - eye, a.error),
            Viewpoint::Direction(forward) => (forward, 0.0),
        };
        let estimate = triple(
            (u, u_error),
            (b.point - a.point, a.error + b.error),
            (c.point - a.point, a.error + c.error),
        );
        let sign = self.settle(estimate, || {
            let [a, b, c] = [a, b, c].map(|corner| self.homogeneous(&corner.place));
            let u = match viewpoint {
                Viewpoint::Eye(eye) => between(&Homogeneous::from(eye), &a),
                Viewpoint::Direction(forward) => exact::dyadic(forward),
            };
            exact::dot(&exact::cross(&u, &between(&a, &b)), &between(&a, &c)).sign()
        });
        sign.flipped()
    }

    /// The sign of `(b − a) × (c − a) · (d − a)`.
    pub fn volume(&self, corners: [&Corner; 4]) -> Sign {
        for (i, corner) in corners.iter().enumerate() {
            if corners[..i].iter().any(|other| other.place == corner.place) {
                return Sign::Zero;
            }
        }
        let a = corners[0];
        let [u, v, t] = [1, 2, 3].map(|i| (corners[i].point - a.point, a.error + corners[i].error));
        self.settle(triple(u, v, t), || {
            let [a, b, c, d] = corners.map(|corner| self.homogeneous(&corner.place));
            let normal = exact::cross(&between(&a, &b), &between(&a, &c));
            exact::dot(&normal, &between(&a, &d)).sign()
        })
    }

    /// A place in homogeneous coordinates.
    fn homogeneous(&self, place: &CornerPlace) -> Homogeneous {
        match *place {
            CornerPlace::Vertex(vertex) => Homogeneous::from(self.position(vertex)),
            CornerPlace::OnEdge(ends, plane) => {
                let plane = self.coefficients(plane);
                let [p, q] = ends.map(|vertex| Homogeneous::from(self.position(vertex)));
                let (of_p, of_q) = (evaluated(&plane, &p), evaluated(&plane, &q));
                let w = of_p.clone() - of_q.clone();
                let x = std::array::from_fn(|i| {
                    q.x[i].clone() * of_p.clone() - p.x[i].clone() * of_q.clone()
                });
                turned(x, w)
            }
            CornerPlace::InFace(planes) => {
                let [a, b, c] = planes.map(|plane| self.coefficients(plane));
                let normal = |p: &[Dyadic; 4]| [p[0].clone(), p[1].clone(), p[2].clone()];
                let products = [(&b, &c), (&c, &a), (&a, &b)]
                    .map(|(p, q)| exact::cross(&normal(p), &normal(q)));
                let w = exact::dot(&normal(&a), &products[0]);
                let x = std::array::from_fn(|i| {
                    let term = |k: usize, p: &[Dyadic; 4]| p[3].clone() * products[k][i].clone();
                    -(term(0, &a) + term(1, &b) + term(2, &c))
                });
                turned(x, w)
            }
        }
    }
}

/// A triple product of differences, each known but for an error of its components.
fn triple((u, du): (DVec3, f64), (v, dv): (DVec3, f64), (t, dt): (DVec3, f64)) -> Estimate {
    let [size_u, size_v, size_t] = [u, v, t].map(|x| x.abs().max_element());
    // Six products of components; twice that covers the rounding of the bound.
    let from_errors = 12.0
        * (du * (size_v + dv) * (size_t + dt) + size_u * dv * (size_t + dt) + size_u * size_v * dt);
    Estimate {
        value: u.cross(v).dot(t),
        error: TRIPLE_PRODUCT_ERROR * spread(u, v).dot(t.abs()) + from_errors,
    }
}

/// Whether a place is in a plane by its definition.
#[inline]
fn is_known_within(place: &CornerPlace, plane: &Plane) -> bool {
    let has = |vertex: &u32| plane.vertices.contains(vertex);
    match place {
        CornerPlace::Vertex(vertex) => has(vertex),
        CornerPlace::OnEdge(ends, cut) => *cut == plane.name || ends.iter().all(has),
        CornerPlace::InFace(planes) => planes.contains(&plane.name),
    }
}

/// With a positive divisor.
fn turned(x: [Dyadic; 3], w: Dyadic) -> Homogeneous {
    if w.sign() == Sign::Negative {
        Homogeneous { x: x.map(|x| -x), w: -w }
    } else {
        Homogeneous { x, w }
    }
}

/// Whether three places are on one line by their definition.
fn is_known_collinear(places: [&CornerPlace; 3]) -> bool {
    let [a, b, c] = places;
    if a == b || b == c || c == a {
        return true;
    }
    let edge = places.iter().find_map(|place| match place {
        CornerPlace::OnEdge(ends, _) => Some(*ends),
        _ => None,
    });
    edge.is_some_and(|edge| {
        places.iter().all(|place| match place {
            CornerPlace::Vertex(vertex) => edge.contains(vertex),
            CornerPlace::OnEdge(ends, _) => *ends == edge || *ends == [edge[1], edge[0]],
            CornerPlace::InFace(_) => false,
        })
    })
}

/// `b − a`, times both divisors.
fn between(a: &Homogeneous, b: &Homogeneous) -> [Dyadic; 3] {
    std::array::from_fn(|i| b.x[i].clone() * a.w.clone() - a.x[i].clone() * b.w.clone())
}
