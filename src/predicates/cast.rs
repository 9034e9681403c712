//! Shadows of points: where the light's ray through a vertex meets a plane, and where the plane through
//! the light and an edge meets another edge.
//!
//! ```text
//!      ☼ light                  ☼
//!       ╲                      ╱│╲ plane of light through e
//!        ● vertex             ╱ e ╲
//!         ╲                  ╱     ╲
//!   ───────●─── plane       ╱───●───╲── side
//! ```
//!
//! Both are ratios of polynomials, kept exact as all constructed points are.

use glam::DVec3;

use super::exact::{self, Dyadic};
use super::pierced::{Homogeneous, PiercePoint};
use super::{FreePlane, Sign, Viewpoint};

/// The plane that a shadow falls on.
#[derive(Debug, Clone, Copy)]
pub enum Screen {
    /// That of a triangle.
    Triangle([DVec3; 3]),
    /// One given by numbers.
    Free(FreePlane),
}

impl Screen {
    /// The plane as normal and offset.
    fn coefficients(&self) -> ([Dyadic; 3], Dyadic) {
        match self {
            Self::Triangle(corners) => {
                let [a, b, c] = corners.map(exact::dyadic);
                let normal = exact::cross(&exact::minus(&b, &a), &exact::minus(&c, &a));
                let offset = exact::dot(&normal, &a);
                (normal, offset)
            }
            Self::Free(plane) => (exact::dyadic(plane.normal), Dyadic::from(plane.offset)),
        }
    }
}

impl PiercePoint {
    /// The shadow of `point` on a plane, which the light's ray through it must meet.
    pub fn cast(light: Viewpoint, point: DVec3, screen: &Screen) -> Self {
        let (normal, offset) = screen.coefficients();
        let from_plane = |x: &[Dyadic; 3]| exact::dot(&normal, x) - offset.clone();
        let at = exact::dyadic(point);
        let of_point = from_plane(&at);
        let (light, of_light, w) = match light {
            Viewpoint::Eye(eye) => {
                let eye = exact::dyadic(eye);
                let of_eye = from_plane(&eye);
                let w = of_eye.clone() - of_point.clone();
                (eye, of_eye, w)
            }
            Viewpoint::Direction(forward) => {
                let forward = exact::dyadic(forward);
                let along = exact::dot(&normal, &forward);
                (forward, along.clone(), along)
            }
        };
        let x = std::array::from_fn(|i| {
            at[i].clone() * of_light.clone() - light[i].clone() * of_point.clone()
        });
        Self::rounding(positive(x, w))
    }

    /// Where the plane through the light and the points of `edge` meets `side`, whose ends must lie
    /// strictly on opposite sides of it; vertex numbers in `positions`.
    pub fn on_side(light: Viewpoint, positions: &[DVec3], edge: [u32; 2], side: [u32; 2]) -> Self {
        let at = |v: u32| exact::dyadic(positions[v as usize]);
        let [a, b] = edge.map(at);
        let [p, q] = side.map(at);
        let along = match light {
            Viewpoint::Eye(eye) => exact::minus(&a, &exact::dyadic(eye)),
            Viewpoint::Direction(forward) => exact::dyadic(forward),
        };
        let normal = exact::cross(&along, &exact::minus(&b, &a));
        let [of_p, of_q] = [&p, &q].map(|x| exact::dot(&normal, &exact::minus(x, &a)));
        let w = of_p.clone() - of_q.clone();
        let x = std::array::from_fn(|i| q[i].clone() * of_p.clone() - p[i].clone() * of_q.clone());
        Self::rounding_on(side, positive(x, w))
    }
}

/// With a positive divisor.
fn positive(x: [Dyadic; 3], w: Dyadic) -> Homogeneous {
    match w.sign() {
        Sign::Negative => Homogeneous { x: x.map(|x| -x), w: -w },
        _ => Homogeneous { x, w },
    }
}
