//! What one triangle hides of one edge.

use super::World;
use super::exact::{Int, Plane, Point, Ratio, decomposed, negated, plane_through, sign, value};

/// One side of a triangle's kept part, seen from the eye.
struct Border {
    /// Through the side and the eye; positive on the inner side.
    plane: Plane,
    /// A corner of the kept part off the side.
    inner_corner: Point,
}

/// The part of a triangle in front of the near plane.
pub(super) struct Cover {
    borders: Vec<Border>,
    /// The triangle's own plane; negative on the eye's side.
    plane: Plane,
    /// Squared length of the plane's normal, in scaled units.
    normal_squared: Int,
    pub(super) image_box: Option<ImageBox>,
}

/// Lowest and highest image coordinates.
#[derive(Clone, Copy)]
pub(super) struct ImageBox([f64; 2], [f64; 2]);

/// One triangle's part of an edge.
pub(super) struct Hidden {
    pub(super) t0: Ratio,
    pub(super) t1: Ratio,
    pub(super) left: bool,
    pub(super) right: bool,
}

impl World {
    /// Corners of the part of a triangle that the near plane keeps.
    pub(super) fn kept_part(&self, triangle: [usize; 3]) -> Vec<Point> {
        let corners = triangle.map(|v| self.point(v));
        let Some(near) = &self.near else {
            return corners.to_vec();
        };
        let heights = [0, 1, 2].map(|i| value(near, &corners[i]));
        let mut kept = Vec::new();
        for i in 0..3 {
            let j = (i + 1) % 3;
            if sign(&heights[i]) >= 0 {
                kept.push(corners[i].clone());
            }
            if sign(&heights[i]) * sign(&heights[j]) < 0 {
                // The weights are those of the other end's distance, both positive.
                let (a, b) = if sign(&heights[i]) > 0 { (i, j) } else { (j, i) };
                let (of_a, of_b) = (-&heights[b], &heights[a]);
                kept.push([0, 1, 2, 3].map(|k| &corners[a][k] * &of_a + &corners[b][k] * of_b));
            }
        }
        kept
    }

    /// What of a triangle can cover; `None` for one behind the near plane, edge-on or without area.
    pub(super) fn cover(&self, triangle: [usize; 3], boxes: bool) -> Option<Cover> {
        let [a, b, c] = triangle.map(|v| self.point(v));
        let mut plane = plane_through(&a, &b, &c);
        match sign(&value(&plane, &self.eye)) {
            0 => return None,
            1 => plane = negated(plane),
            _ => {}
        }
        let kept = self.kept_part(triangle);
        if kept.len() < 3 {
            return None;
        }
        let borders = (0..kept.len())
            .map(|i| {
                let n = kept.len();
                let inner_corner = kept[(i + 2) % n].clone();
                let plane = plane_through(&kept[i], &kept[(i + 1) % n], &self.eye);
                let plane = match sign(&value(&plane, &inner_corner)) {
                    0 => panic!("a kept part without area that is not edge-on"),
                    1 => plane,
                    _ => negated(plane),
                };
                Border { plane, inner_corner }
            })
            .collect();
        let normal_squared = &plane[0] * &plane[0] + &plane[1] * &plane[1] + &plane[2] * &plane[2];
        let image_box = if boxes { self.image_box(&triangle) } else { None };
        Some(Cover { borders, plane, normal_squared, image_box })
    }

    /// A box around the image, a little too large; `None` when a vertex is not well in front.
    pub(super) fn image_box(&self, vertices: &[usize]) -> Option<ImageBox> {
        let forward = self.sight.forward();
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        // Any two directions across the view will do: those of the axes other than the main one.
        let main = (0..3).max_by(|&i, &j| forward[i].abs().total_cmp(&forward[j].abs()))?;
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let mut size = 0.0f64;
        for &v in vertices {
            let d = [0, 1, 2].map(|i| self.positions[v][i] - self.sight.eye[i]);
            let depth = dot(d, forward) / forward[main];
            let lengths = d.map(f64::abs);
            let spread = lengths[0].max(lengths[1]).max(lengths[2]);
            for (k, axis) in [(main + 1) % 3, (main + 2) % 3].into_iter().enumerate() {
                let x = if self.near.is_some() {
                    // Well in front: no cancellation in the depth to speak of.
                    if depth * forward[main].signum() < 1e-3 * spread {
                        return None;
                    }
                    size = size.max(1e3 * spread / depth.abs());
                    d[axis] / depth
                } else {
                    let t = dot(d, forward) / dot(forward, forward);
                    size = size.max(spread);
                    d[axis] - t * forward[axis]
                };
                (low[k], high[k]) = (low[k].min(x), high[k].max(x));
            }
        }
        let margin = 1e-6 * size;
        Some(ImageBox(low.map(|x| x - margin), high.map(|x| x + margin)))
    }

    /// What `cover` hides of the edge within t0..t1.
    pub(super) fn hidden_part(
        &self,
        cover: &Cover,
        ends: [&Point; 2],
        kept: (&Ratio, &Ratio),
        tolerance: f64,
    ) -> Option<Hidden> {
        let [p, q] = ends;
        let behind = [value(&cover.plane, p), value(&cover.plane, q)];
        if tolerance > 0.0 && behind.iter().all(|b| self.is_within(b, cover, tolerance)) {
            return None;
        }
        // Strictly behind the plane somewhere.
        if behind.iter().all(|b| sign(b) <= 0) {
            return None;
        }
        self.image_part(cover, ends, kept, vec![behind])
    }

    /// Where the edge's image lies in that of `cover` and the conditions, given by their values at
    /// both ends, hold.
    pub(super) fn image_part(
        &self,
        cover: &Cover,
        [p, q]: [&Point; 2],
        kept: (&Ratio, &Ratio),
        mut conditions: Vec<[Int; 2]>,
    ) -> Option<Hidden> {
        let (mut t0, mut t1) = (kept.0.clone(), kept.1.clone());
        let (mut left, mut right) = (true, true);
        for border in &cover.borders {
            let inside = [value(&border.plane, p), value(&border.plane, q)];
            match (sign(&inside[0]), sign(&inside[1])) {
                (0, 0) => {
                    // The image runs along this border: only the inner side is covered.
                    let line = plane_through(p, q, &self.eye);
                    if sign(&value(&line, &border.inner_corner)) > 0 {
                        right = false;
                    } else {
                        left = false;
                    }
                }
                (a, b) if a <= 0 && b <= 0 => return None,
                _ => conditions.push(inside),
            }
        }
        for [at_p, at_q] in conditions {
            // at_p (1 − t) + at_q t is zero at at_p / (at_p − at_q).
            let (from, to) = (sign(&at_p), sign(&at_q));
            if from < 0 {
                t0 = t0.max(Ratio::new(at_p.clone(), at_p - at_q));
            } else if to < 0 {
                t1 = t1.min(Ratio::new(at_p.clone(), at_p - at_q));
            }
        }
        (t0 < t1).then_some(Hidden { t0, t1, left, right })
    }

    /// Whether the point with this value in the triangle's plane is at most `tolerance` away.
    pub(super) fn is_within(&self, value: &Int, cover: &Cover, tolerance: f64) -> bool {
        // |value| / |normal| counts in 2^exponent.
        let (mantissa, exponent) = decomposed(tolerance);
        let limit = Int::from(mantissa) * Int::from(mantissa) * &cover.normal_squared;
        let shift = 2 * (exponent - self.exponent);
        let square = value * value;
        if shift >= 0 {
            square <= limit << shift as usize
        } else {
            square << (-shift) as usize <= limit
        }
    }
}

pub(super) fn are_apart(a: Option<ImageBox>, b: Option<ImageBox>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (0..2).any(|k| a.1[k] < b.0[k] || b.1[k] < a.0[k]),
        _ => false,
    }
}
