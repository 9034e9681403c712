//! A scene in integers, and what is decided of it without any other triangle.

use super::Sight;
use super::exact::{
    Int, Plane, Point, Ratio, common_exponent, cross, decomposed, dot, is_zero, minus, scaled,
    sign, value,
};
use super::triangulate::triangles;
use std::collections::HashMap;

/// A scene turned into integers.
pub(crate) struct World {
    /// Distinct positions, in order of appearance.
    pub positions: Vec<[f64; 3]>,
    pub(super) points: Vec<[Int; 3]>,
    /// Faces without repeated corners, of three corners or more.
    pub faces: Vec<Vec<usize>>,
    /// The unit of `points` is 2^exponent.
    pub(super) exponent: i32,
    pub(super) eye: Point,
    /// Positive in front of the near plane; `None` in orthographic views.
    pub(super) near: Option<Plane>,
    pub(super) sight: Sight,
}

impl World {
    pub(crate) fn new(positions: &[[f64; 3]], faces: &[Vec<u32>], sight: &Sight) -> Self {
        let mut of_position: HashMap<[u64; 3], usize> = HashMap::new();
        let mut distinct: Vec<[f64; 3]> = Vec::new();
        let vertex_of: Vec<usize> = positions
            .iter()
            .map(|&p| {
                let p = p.map(|x| if x == 0.0 { 0.0 } else { x });
                *of_position.entry(p.map(f64::to_bits)).or_insert_with(|| {
                    distinct.push(p);
                    distinct.len() - 1
                })
            })
            .collect();
        let faces = faces
            .iter()
            .map(|face| {
                let mut face: Vec<usize> = face.iter().map(|&v| vertex_of[v as usize]).collect();
                face.dedup();
                while face.len() > 1 && face.first() == face.last() {
                    face.pop();
                }
                face
            })
            .filter(|face| face.len() >= 3)
            .collect();

        let exponent = common_exponent(distinct.iter().chain([&sight.eye]).flatten().copied());
        let forward = sight.forward();
        let forward_exponent = common_exponent(forward);
        let forward = forward.map(|x| scaled(x, forward_exponent));
        let eye = sight.eye.map(|x| scaled(x, exponent));
        let (eye, near) = match sight.near {
            None => {
                let [x, y, z] = forward;
                ([-x, -y, -z, Int::ZERO], None)
            }
            Some(near) => {
                // (p − eye)·F − near F·F, where p and the eye count in 2^exponent and F in
                // 2^forward_exponent; all divided by both.
                let (mantissa, near_exponent) = decomposed(near);
                let part = Int::from(mantissa) * dot(&forward, &forward);
                let shift = near_exponent + forward_exponent - exponent;
                let (times, part) = if shift >= 0 {
                    (Int::ONE, part << shift as usize)
                } else {
                    (Int::ONE << (-shift) as usize, part)
                };
                let [x, y, z] = forward.clone().map(|f| f * &times);
                let last = -(dot(&eye, &forward) * &times + part);
                let [ex, ey, ez] = eye;
                ([ex, ey, ez, Int::ONE], Some([x, y, z, last]))
            }
        };
        Self {
            points: distinct.iter().map(|p| p.map(|x| scaled(x, exponent))).collect(),
            positions: distinct,
            faces,
            exponent,
            eye,
            near,
            sight: *sight,
        }
    }

    pub(super) fn point(&self, vertex: usize) -> Point {
        let [x, y, z] = self.points[vertex].clone();
        [x, y, z, Int::ONE]
    }

    /// All triangles, with the vertices they have.
    ///
    /// # Errors
    /// A polygon that is not flat or crosses itself.
    pub(crate) fn triangles(&self) -> Result<Vec<[usize; 3]>, String> {
        let mut all = Vec::new();
        for face in &self.faces {
            all.extend(triangles(&self.points, face)?);
        }
        Ok(all)
    }

    /// The t that the near plane keeps of an edge; `None` when that is a point or nothing.
    pub(super) fn kept_range(&self, p: &Point, q: &Point) -> Option<(Ratio, Ratio)> {
        let whole = (Ratio::integer(0), Ratio::integer(1));
        let Some(near) = &self.near else {
            return Some(whole);
        };
        let (at_p, at_q) = (value(near, p), value(near, q));
        match (sign(&at_p), sign(&at_q)) {
            (a, b) if a >= 0 && b >= 0 => Some(whole),
            (a, b) if a <= 0 && b <= 0 => None,
            (a, _) => {
                let cut = Ratio::new(at_p.clone(), at_p - at_q);
                Some(if a > 0 { (whole.0, cut) } else { (cut, whole.1) })
            }
        }
    }

    /// −1, 0 or 1: whether a face shows its back, its rim or its front.
    pub(super) fn facing(&self, face: &[usize], normal: &[Int; 3]) -> i32 {
        let [x, y, z, w] = &self.eye;
        let p = &self.points[face[0]];
        let to_eye = [x - w * &p[0], y - w * &p[1], z - w * &p[2]];
        sign(&dot(normal, &to_eye))
    }

    /// Whether a face's normal, computed in `f64`, could be off by more than 1e-9 of its length.
    pub(super) fn is_sliver(&self, face: usize, normal: &[Int; 3]) -> bool {
        let corners = || self.faces[face].iter().map(|&v| self.positions[v]);
        let largest = corners().flatten().fold(0.0, |a: f64, x| a.max(x.abs()));
        let spread = |k: usize| {
            let (low, high) = corners()
                .map(|p| p[k])
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
            high - low
        };
        let size = (0..3).map(spread).fold(0.0, f64::max);
        // The normal's unit is 2^exponent squared; it has the size of an area.
        let area = normal.clone().map(|x| Ratio::new(x, Int::ONE).to_f64().abs());
        let area = area.iter().fold(0.0, |a: f64, &x| a.max(x));
        area * 2f64.powi(2 * self.exponent) <= 1e-6 * size * largest
    }

    pub(super) fn image_is_point(&self, a: usize, b: usize) -> bool {
        let [x, y, z, w] = &self.eye;
        let (p, q) = (&self.points[a], &self.points[b]);
        let to_eye = [x - w * &p[0], y - w * &p[1], z - w * &p[2]];
        is_zero(&cross(&minus(q, p), &to_eye))
    }
}
