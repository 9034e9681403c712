//! Planes that cut faces, and on which side of them a corner is, exactly.
//!
//! ```text
//!   Triangle(t)                Across { axis, at }         Near
//!      r ●                          ┆                        ┆
//!       ╱ ╲  + side: where   − side ┆ + side         eye ◁   ┆ + side
//!    p ●───● q  p, q, r turn        ┆                        ┆
//!       counter-clockwise          at                   kept is + or on it
//! ```
//!
//! The value of a plane at a point is a polynomial in the input; its sign is computed like all others, see
//! [`super`]. Cutting faces by planes and keeping the planes, not rounded corners, is the plane-based
//! representation of G. Bernstein, D. Fussell, "Fast, exact, linear booleans" (2009).

use super::exact::{self, Dyadic};
use super::sight::fits_filter;
use super::{Estimate, Homogeneous, Sign, TRIPLE_PRODUCT_ERROR, Viewpoint};
use crate::camera::{Camera, Projection};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// A plane by what defines it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlaneName {
    /// The plane of a triangle of the scene, which must have an area.
    Triangle(u32),
    /// The plane where one coordinate (0, 1 or 2 for x, y or z) has a value; finite.
    Across {
        /// The coordinate.
        axis: u8,
        /// Its value.
        at: f64,
    },
    /// The camera's near plane.
    Near,
}

/// A plane prepared for many tests.
#[derive(Debug, Clone, Copy)]
pub struct Plane {
    pub(super) name: PlaneName,
    pub(super) normal: DVec3,
    /// The sums of the absolute values of the terms of each component of the normal.
    pub(super) spread: DVec3,
    pub(super) base: DVec3,
    pub(super) offset: f64,
    pub(super) vertices: [u32; 3],
}

impl Plane {
    /// What defines it.
    pub fn name(&self) -> PlaneName {
        self.name
    }
}

/// Vertices and triangles, and the camera if there is one: what defines planes and corners.
#[derive(Debug)]
pub struct Planes<'a> {
    positions: &'a [DVec3],
    triangles: &'a [[u32; 3]],
    viewpoint: Option<Viewpoint>,
    forward: DVec3,
    near: f64,
    in_window: bool,
    n_exact: AtomicU64,
}

/// Stands for no vertex.
const NO_VERTEX: [u32; 3] = [u32::MAX; 3];

impl<'a> Planes<'a> {
    /// Planes without a camera, so without a near plane. O(vertices).
    pub fn new(positions: &'a [DVec3], triangles: &'a [[u32; 3]]) -> Self {
        let in_window = positions.par_iter().with_min_len(1 << 14).all(fits_filter);
        Self {
            positions,
            triangles,
            viewpoint: None,
            forward: DVec3::ZERO,
            near: 0.0,
            in_window,
            n_exact: AtomicU64::new(0),
        }
    }

    /// The same with a camera.
    #[must_use]
    pub fn seen_by(mut self, camera: &Camera) -> Self {
        self.forward = camera.forward();
        let viewpoint = match camera.projection() {
            Projection::Perspective { near, .. } => {
                self.near = near;
                Viewpoint::Eye(camera.eye())
            }
            Projection::Orthographic => Viewpoint::Direction(self.forward),
        };
        self.viewpoint = Some(viewpoint);
        self.in_window &= fits_filter(&self.forward) && fits_filter(&camera.eye());
        self
    }

    /// The vertices of a triangle.
    #[inline]
    pub fn triangle(&self, triangle: u32) -> [u32; 3] {
        self.triangles[triangle as usize]
    }

    /// The position of a vertex.
    #[inline]
    pub fn position(&self, vertex: u32) -> DVec3 {
        self.positions[vertex as usize]
    }

    /// Where sight lines come from; none without a camera.
    pub fn viewpoint(&self) -> Option<Viewpoint> {
        self.viewpoint
    }

    /// Whether there is a near plane, which only perspective has.
    pub fn has_near_plane(&self) -> bool {
        matches!(self.viewpoint, Some(Viewpoint::Eye(_)))
    }

    /// How many tests floating point could not decide so far.
    pub fn n_exact(&self) -> u64 {
        self.n_exact.load(Relaxed)
    }

    /// An estimate's sign, or that of the exact value.
    #[inline]
    pub(super) fn settle(&self, estimate: Estimate, exact: impl FnOnce() -> Sign) -> Sign {
        match estimate.sign() {
            Some(sign) if self.in_window => sign,
            _ => {
                self.n_exact.fetch_add(1, Relaxed);
                exact()
            }
        }
    }

    /// Whether the error bounds apply.
    pub(super) fn in_window(&self) -> bool {
        self.in_window
    }

    /// Whether a triangle has an area, exactly.
    pub fn has_area(&self, triangle: u32) -> bool {
        let plane = self.plane(PlaneName::Triangle(triangle));
        if self.in_window && plane.normal.abs().cmpgt(TRIPLE_PRODUCT_ERROR * plane.spread).any() {
            return true;
        }
        let [p, q, r] = plane.vertices.map(|vertex| self.position(vertex));
        !exact::collinear(p, q, r)
    }

    /// Prepares a plane.
    #[inline]
    pub fn plane(&self, name: PlaneName) -> Plane {
        match name {
            PlaneName::Triangle(triangle) => {
                let vertices = self.triangle(triangle);
                let [p, q, r] = vertices.map(|vertex| self.position(vertex));
                let (a, b) = (q - p, r - p);
                let spread = spread(a, b);
                Plane { name, normal: a.cross(b), spread, base: p, offset: 0.0, vertices }
            }
            PlaneName::Across { axis, at } => {
                let normal = DVec3::AXES[usize::from(axis).min(2)];
                let base = normal * at;
                Plane { name, normal, spread: normal, base, offset: 0.0, vertices: NO_VERTEX }
            }
            PlaneName::Near => Plane {
                name,
                normal: self.forward,
                spread: self.forward.abs(),
                base: match self.viewpoint {
                    Some(Viewpoint::Eye(eye)) => eye,
                    _ => DVec3::ZERO,
                },
                offset: self.near * self.forward.length_squared(),
                vertices: NO_VERTEX,
            },
        }
    }

    /// On which side of a plane the observer is. Zero without a camera.
    ///
    /// In orthographic projection the observer is infinitely far away, against the direction of view.
    pub fn side_of_eye(&self, name: PlaneName) -> Sign {
        let plane = self.plane(name);
        match self.viewpoint {
            None => Sign::Zero,
            Some(Viewpoint::Eye(eye)) => {
                // The eye is not a vertex, so no sign is known in advance.
                let d = eye - plane.base;
                let value = plane.normal.dot(d) - plane.offset;
                let error = TRIPLE_PRODUCT_ERROR * (plane.spread.dot(d.abs()) + plane.offset);
                self.settle(Estimate { value, error }, || {
                    evaluated(&self.coefficients(name), &Homogeneous::from(eye)).sign()
                })
            }
            Some(Viewpoint::Direction(forward)) => {
                let value = -plane.normal.dot(forward);
                let error = TRIPLE_PRODUCT_ERROR * plane.spread.dot(forward.abs());
                self.settle(Estimate { value, error }, || {
                    let [x, y, z, _] = self.coefficients(name);
                    exact::dot(&[x, y, z], &exact::dyadic(forward)).sign().flipped()
                })
            }
        }
    }

    /// The plane as a linear function of homogeneous coordinates.
    pub(super) fn coefficients(&self, name: PlaneName) -> [Dyadic; 4] {
        let (normal, at_origin) = match name {
            PlaneName::Triangle(triangle) => {
                let [p, q, r] =
                    self.triangle(triangle).map(|vertex| exact::dyadic(self.position(vertex)));
                let normal = exact::cross(&exact::minus(&q, &p), &exact::minus(&r, &p));
                let at_origin = -exact::dot(&normal, &p);
                (normal, at_origin)
            }
            PlaneName::Across { axis, at } => {
                (exact::dyadic(DVec3::AXES[usize::from(axis).min(2)]), Dyadic::from(-at))
            }
            PlaneName::Near => {
                let forward = exact::dyadic(self.forward);
                let limit = Dyadic::from(self.near) * exact::dot(&forward, &forward);
                let eye = match self.viewpoint {
                    Some(Viewpoint::Eye(eye)) => exact::dyadic(eye),
                    _ => exact::dyadic(DVec3::ZERO),
                };
                let at_origin = -(exact::dot(&eye, &forward) + limit);
                (forward, at_origin)
            }
        };
        let [x, y, z] = normal;
        [x, y, z, at_origin]
    }
}

/// The sums of the absolute values of the terms of a cross product.
pub(super) fn spread(a: DVec3, b: DVec3) -> DVec3 {
    let (a, b) = (a.abs(), b.abs());
    DVec3::new(a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x)
}

pub(super) fn evaluated(plane: &[Dyadic; 4], x: &Homogeneous) -> Dyadic {
    let [a, b, c, d] = plane.clone();
    exact::dot(&[a, b, c], &x.x) + d * x.w.clone()
}
