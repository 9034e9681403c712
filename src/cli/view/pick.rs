//! The point of a scene at a place in the image, to become the target.

use glam::{DVec2, DVec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::model::scene::Scene;
use rayon::prelude::*;

/// The nearest point of a triangle in front of the eye on the line of sight through a point of the
/// image; rounded, as a place to turn around. O(triangles), in parallel.
pub(super) fn nearest_hit(scene: &Scene, camera: &Camera, image: DVec2) -> Option<DVec3> {
    let frame = camera.frame();
    let across = frame.right * image.x + frame.upward * image.y;
    let (start, direction) = match camera.projection() {
        Projection::Perspective { .. } => (camera.eye(), frame.forward + across),
        Projection::Orthographic => (camera.eye() + across, frame.forward),
    };
    let is_orthographic = camera.projection() == Projection::Orthographic;
    let points = scene.points();
    let hits = scene.triangles().par_iter().filter_map(|triangle| {
        let corners = triangle.map(|vertex| points[vertex as usize]);
        let along = hit(corners, start, direction)?;
        (is_orthographic || along > 0.0).then_some(along)
    });
    let nearest = hits.min_by(f64::total_cmp)?;
    Some(start + direction * nearest)
}

/// Where a line meets a triangle, as a multiple of its direction (Möller, Trumbore 1997).
fn hit([a, b, c]: [DVec3; 3], start: DVec3, direction: DVec3) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(ac);
    let determinant = ab.dot(across);
    let from_a = start - a;
    let u = from_a.dot(across) / determinant;
    let other = from_a.cross(ab);
    let v = direction.dot(other) / determinant;
    let along = ac.dot(other) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && along.is_finite()).then_some(along)
}
