//! Rays in space against every triangle say which face is seen.

use super::{built, painted};
use crate::scenes::{number_of_scenes, random};
use glam::{DVec2, DVec3};
use hiddenline::camera::{Camera, Projection};
use hiddenline::engines::face::{Painting, weiler_atherton};
use hiddenline::engines::image::raster::Corners;
use hiddenline::model::scene::Scene;

/// The face that a ray meets first; the outer `None` where rounding might decide.
fn met(origin: DVec3, direction: DVec3, near: f64, scene: &Scene) -> Option<Option<u32>> {
    const DOUBT: f64 = 1e-7;
    let positions = scene.mesh().positions();
    let mut hits: Vec<(f64, u32)> = Vec::new();
    for (triangle, &face) in scene.triangles().iter().zip(scene.triangle_faces()) {
        let [a, b, c] = triangle.map(|vertex| positions[vertex as usize]);
        let (p, q) = (b - a, c - a);
        let normal = p.cross(q);
        let towards = normal.dot(direction);
        let size = normal.length() * direction.length();
        if towards.abs() <= DOUBT * size {
            if (a - origin).dot(normal).abs() <= 1e-6 * size {
                return None; // edge-on
            }
            continue;
        }
        let t = (a - origin).dot(normal) / towards;
        let x = origin + direction * t - a;
        let u = x.cross(q).dot(normal) / normal.length_squared();
        let v = p.cross(x).dot(normal) / normal.length_squared();
        let least = u.min(v).min(1.0 - u - v);
        if least < -DOUBT {
            continue;
        }
        if least < DOUBT || (t - near).abs() < DOUBT {
            return None;
        }
        if t > near {
            hits.push((t, face));
        }
    }
    hits.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    match hits[..] {
        [] => Some(None),
        [(_, face)] => Some(Some(face)),
        [(t, face), (next, other), ..] => {
            (next - t > DOUBT * t.abs().max(1.0) || other == face).then_some(Some(face))
        }
    }
}

/// How many points of a lattice over the image were judged; panics where the painting is wrong. Points
/// that are `near` a border are left out.
pub(super) fn judged(
    name: &str,
    (scene, camera): (&Scene, &Camera),
    painting: &Painting,
    n: u32,
    near_border: impl Fn(DVec2) -> bool,
) -> u32 {
    let Some((low, high)) = Corners::new(scene, camera).bounds() else {
        assert!(painting.is_empty(), "{name}: painted out of nothing");
        return 0;
    };
    let frame = camera.frame();
    let mut judged = 0;
    for at in 0..n * n {
        let part = (DVec2::new(f64::from(at % n), f64::from(at / n)) + 0.513) / f64::from(n);
        let point = low + (high - low) * part;
        let aside = frame.right * point.x + frame.upward * point.y;
        let (origin, direction, near) = match camera.projection() {
            Projection::Perspective { near, .. } => {
                (camera.eye(), frame.forward + aside, near * camera.forward().length())
            }
            Projection::Orthographic => (camera.eye() + aside, frame.forward, f64::NEG_INFINITY),
        };
        let Some(expected) = met(origin, direction, near, scene) else { continue };
        if near_border(point) {
            continue;
        }
        let (found, to_border) = painted(painting, point);
        assert_eq!(found, expected, "{name}: at {point}, {to_border} from a border");
        judged += 1;
    }
    judged
}

#[test]
fn weiler_and_athertons_regions_show_what_rays_in_space_meet() {
    let n = number_of_scenes(300);
    let mut total = 0;
    for seed in 0..n {
        let (scene, camera) = built(&random(seed));
        let painting = weiler_atherton::solve(&scene, &camera).unwrap().0;
        total += judged(&format!("seed {seed}"), (&scene, &camera), &painting, 13, |_| false);
    }
    eprintln!("{total} points judged");
    assert!(total > 80 * n as u32, "only {total} points judged");
}
