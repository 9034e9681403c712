//! What sight lines meet: exact rays in space against every triangle, for all that fills an image.

use super::exact::{Int, Ratio, common_exponent, cross, decomposed, dot, minus, scaled, sign};
use glam::{DVec2, DVec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::engines::face::{PaintedPiece, Painting};
use hiddenline::stages::model::scene::Scene;

/// Samples nearer than this to the border of any piece, in parts of the image's size, are not judged.
const BORDER: f64 = 1e-7;

type P = [Int; 3];

/// All that exact rays meet.
pub(crate) struct SightLines<'a> {
    camera: &'a Camera,
    triangles: Vec<[P; 3]>,
    faces: &'a [u32],
    /// Image boxes of triangles, a little too large; all when behind the near plane in part.
    boxes: Vec<(DVec2, DVec2)>,
    exponent: i32,
}

/// A ray by its `f64` numbers, which are exact.
struct Ray {
    origin: DVec3,
    direction: DVec3,
    image: DVec2,
}

impl<'a> SightLines<'a> {
    pub(crate) fn new(scene: &'a Scene, camera: &'a Camera) -> Self {
        let positions = scene.mesh().positions();
        // No origin of a ray is finer: see `ray`.
        let eye = camera.eye();
        let numbers = positions.iter().chain([&eye]).flat_map(|p| p.to_array());
        let exponent = common_exponent(numbers).min(-200);
        let exact = |p: DVec3| p.to_array().map(|x| scaled(x, exponent));
        let points: Vec<P> = positions.iter().map(|&p| exact(p)).collect();
        let triangles =
            scene.triangles().iter().map(|t| t.map(|v| points[v as usize].clone())).collect();
        let is_perspective = matches!(camera.projection(), Projection::Perspective { .. });
        let boxes = scene
            .triangles()
            .iter()
            .map(|t| {
                let corners = t.map(|v| positions[v as usize]);
                let is_near = |p: DVec3| {
                    let d = p - camera.eye();
                    d.dot(camera.forward()) < 1e-3 * d.length() * camera.forward().length()
                };
                if is_perspective && corners.iter().any(|&p| is_near(p)) {
                    return (DVec2::NEG_INFINITY, DVec2::INFINITY);
                }
                let [a, b, c] = corners.map(|p| camera.image(p));
                let (low, high) = (a.min(b).min(c), a.max(b).max(c));
                let margin = DVec2::splat(1e-9 + 1e-6 * (high - low).max_element());
                let margin = margin + 1e-9 * low.abs().max(high.abs());
                (low - margin, high + margin)
            })
            .collect();
        Self { camera, triangles, faces: scene.triangle_faces(), boxes, exponent }
    }

    fn ray(&self, at: DVec2) -> Ray {
        let frame = self.camera.frame();
        let aside = frame.right * at.x + frame.upward * at.y;
        // Far fewer digits than are kept of the origin.
        let rounded = |v: DVec3| {
            DVec3::from_array(v.to_array().map(|x| (x * 2f64.powi(60)).round() / 2f64.powi(60)))
        };
        let eye = self.camera.eye();
        match self.camera.projection() {
            Projection::Perspective { .. } => {
                let direction = frame.forward + aside;
                let image = self.camera.image(eye + direction);
                Ray { origin: eye, direction, image }
            }
            Projection::Orthographic => {
                let origin = rounded(eye + aside);
                let image = self.camera.image(origin);
                Ray { origin, direction: self.camera.forward(), image }
            }
        }
    }

    /// The face that a ray meets first, the lowest of those in one plane.
    fn met(&self, ray: &Ray) -> Option<u32> {
        self.hits(ray).into_iter().min().map(|(_, face)| face)
    }

    /// Where along a ray it meets which face.
    fn hits(&self, ray: &Ray) -> Vec<(Ratio, u32)> {
        let origin = ray.origin.to_array().map(|x| scaled(x, self.exponent));
        let of_direction = common_exponent(ray.direction.to_array());
        let direction = ray.direction.to_array().map(|x| scaled(x, of_direction));
        let mut hits = Vec::new();
        for (i, [a, b, c]) in self.triangles.iter().enumerate() {
            let (low, high) = self.boxes[i];
            if !(low.cmple(ray.image).all() && high.cmpge(ray.image).all()) {
                continue;
            }
            let [a, b, c] = [a, b, c].map(|p| minus(p, &origin));
            let normal = cross(&minus(&b, &a), &minus(&c, &a));
            let slope = dot(&normal, &direction);
            if sign(&slope) == 0 {
                continue;
            }
            let is_within = [(&a, &b), (&b, &c), (&c, &a)]
                .iter()
                .all(|(p, q)| sign(&dot(&cross(p, q), &direction)) * sign(&slope) >= 0);
            let t = Ratio::new(dot(&normal, &a), slope);
            if is_within && self.is_kept(ray, &direction, &t) {
                hits.push((t, self.faces[i]));
            }
        }
        hits
    }

    /// Whether the near plane keeps the point at `t` of a ray.
    fn is_kept(&self, ray: &Ray, direction: &P, t: &Ratio) -> bool {
        let Projection::Perspective { near, .. } = self.camera.projection() else { return true };
        let forward = self.camera.forward().to_array();
        let of_forward = common_exponent(forward);
        let of_direction = common_exponent(ray.direction.to_array());
        let forward = forward.map(|x| scaled(x, of_forward));
        let (mantissa, of_near) = decomposed(near);
        // t counts in 2^(exponent − of_direction).
        let left = &t.numerator * dot(direction, &forward);
        let right = Int::from(mantissa) * dot(&forward, &forward) * &t.denominator;
        let shift =
            self.exponent - of_direction + of_direction + of_forward - (of_near + 2 * of_forward);
        if shift >= 0 {
            (left << shift as usize) >= right
        } else {
            left >= (right << (-shift) as usize)
        }
    }

    /// The face that is seen at a point of the image.
    pub(crate) fn seen(&self, at: DVec2) -> Option<u32> {
        self.met(&self.ray(at))
    }

    /// Whether nothing else could be meant at a point: the same face is seen next to it, and no other
    /// face is as near.
    pub(crate) fn is_clear(&self, at: DVec2) -> bool {
        const DOUBT: f64 = 1e-7;
        let mut hits = self.hits(&self.ray(at));
        hits.sort();
        if let [(t, face), rest @ ..] = hits.as_slice() {
            let t = t.to_f64();
            let is_tied = |hit: &&(Ratio, u32)| hit.0.to_f64() - t <= DOUBT * t.abs();
            if rest.iter().filter(|hit| hit.1 != *face).any(|hit| is_tied(&hit)) {
                return false;
            }
        }
        let face = hits.first().map(|hit| hit.1);
        let step = DOUBT * at.abs().max_element().max(1.0);
        [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)]
            .iter()
            .all(|&(x, y)| self.seen(at + DVec2::new(x, y) * step) == face)
    }

    /// Compares a painting with rays on a grid of `n` by `n` points of its image; the number of points
    /// judged and of those left out. Where it differs, `is_excused` says whether it may.
    ///
    /// # Errors
    /// The first point that differs, in words.
    pub(crate) fn judge(
        &self,
        painting: &Painting,
        n: u32,
        is_excused: impl Fn(DVec2) -> bool,
    ) -> Result<(u32, u32), String> {
        let pieces: Vec<(DVec2, DVec2, PaintedPiece)> = painting
            .pieces()
            .map(|piece| {
                let points = || piece.rings().flat_map(|ring| ring.points.iter().copied());
                let low = points().fold(DVec2::INFINITY, DVec2::min);
                (low, points().fold(DVec2::NEG_INFINITY, DVec2::max), piece)
            })
            .collect();
        // Near the eye images are huge; the middle is where things are.
        let window = DVec2::splat(if self.is_perspective() { 3.0 } else { f64::INFINITY });
        let images = || self.boxes.iter().filter(|b| b.0.is_finite() && b.1.is_finite());
        let low = images().fold(window, |low, b| low.min(b.0)).max(-window);
        let high = images().fold(-window, |high, b| high.max(b.1)).min(window);
        let size = if low.cmplt(high).all() { high - low } else { DVec2::splat(2.0) };
        let low = if low.cmplt(high).all() { low } else { DVec2::NEG_ONE };
        let border = BORDER * size.max_element();
        let (mut judged, mut left_out) = (0, 0);
        for i in 0..n * n {
            // Odd fractions, so that few points lie on anything.
            let part = DVec2::new(f64::from(i % n) + 0.4321, f64::from(i / n) + 0.5678);
            let ray = self.ray(low + size * part / f64::from(n));
            match topmost(&pieces, ray.image, border) {
                None => left_out += 1,
                Some(found) => {
                    let expected = self.met(&ray);
                    let at = ray.image;
                    if found != expected && is_excused(at) {
                        left_out += 1;
                        continue;
                    }
                    if found != expected {
                        return Err(format!("at {at}: {found:?} instead of {expected:?}"));
                    }
                    judged += 1;
                }
            }
        }
        Ok((judged, left_out))
    }

    fn is_perspective(&self) -> bool {
        matches!(self.camera.projection(), Projection::Perspective { .. })
    }
}

/// The face of the last piece over a point, if any; `None` too near to a border.
fn topmost(pieces: &[(DVec2, DVec2, PaintedPiece)], at: DVec2, border: f64) -> Option<Option<u32>> {
    let mut top = None;
    for (low, high, piece) in pieces {
        let margin = DVec2::splat(border);
        if !((low - margin).cmple(at).all() && (high + margin).cmpge(at).all()) {
            continue;
        }
        let mut is_within = false;
        for ring in piece.rings() {
            let n = ring.points.len();
            for (i, &p) in ring.points.iter().enumerate() {
                let q = ring.points[(i + 1) % n];
                if distance(at, p, q) < border {
                    return None;
                }
                if (p.y > at.y) != (q.y > at.y) {
                    let x = p.x + (q.x - p.x) * ((at.y - p.y) / (q.y - p.y));
                    is_within ^= x > at.x;
                }
            }
        }
        if is_within {
            top = Some(piece.face);
        }
    }
    Some(top)
}

fn distance(at: DVec2, p: DVec2, q: DVec2) -> f64 {
    let d = q - p;
    let t = if d == DVec2::ZERO { 0.0 } else { ((at - p).dot(d) / d.dot(d)).clamp(0.0, 1.0) };
    at.distance(p + d * t)
}
