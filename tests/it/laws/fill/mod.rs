//! Faces as polygons: the engines that clip and divide the image, and how their regions are filled.

mod borders;
mod colors;
mod counts;
mod heaps;
mod regions;
mod warnock;
mod white;

use crate::laws::engines::{camera, mesh};
use crate::scenes::Scene as TestScene;
use glam::DVec2;
use hiddenline::stages::camera::Camera;
use hiddenline::stages::engines::face::Painting;
use hiddenline::stages::model::scene::Scene;

fn built(scene: &TestScene) -> (Scene, Camera) {
    (Scene::new(mesh(scene)), camera(scene))
}

/// The face painted last over a point, and how far the point is from the nearest border of a piece.
fn painted(painting: &Painting, point: DVec2) -> (Option<u32>, f64) {
    let (mut face, mut nearest) = (None, f64::INFINITY);
    for piece in painting.pieces() {
        let mut inside = false;
        for ring in piece.rings() {
            let n = ring.points.len();
            for k in 0..n {
                let (a, b) = (ring.points[k], ring.points[(k + 1) % n]);
                nearest = nearest.min(distance(point, a, b));
                if (a.y > point.y) != (b.y > point.y)
                    && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
                {
                    inside = !inside;
                }
            }
        }
        if inside {
            face = Some(piece.face);
        }
    }
    (face, nearest)
}

/// How far a point is from a segment.
fn distance(point: DVec2, a: DVec2, b: DVec2) -> f64 {
    let (d, p) = (b - a, point - a);
    let t = if d == DVec2::ZERO { 0.0 } else { (p.dot(d) / d.length_squared()).clamp(0.0, 1.0) };
    p.distance(d * t)
}
