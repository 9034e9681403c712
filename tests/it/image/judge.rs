//! A judge that knows nothing of pixels' edges: rays in space against every triangle.

use super::{built, fitted};
use crate::scenes::{number_of_scenes, random};
use glam::{DVec2, DVec3};
use hiddenline::engines::image::{Engine, NOTHING, solve};
use hiddenline::view::Projection;

/// What a ray meets: the triangle, or nothing; `None` where rounding might decide.
fn met(origin: DVec3, direction: DVec3, near: f64, triangles: &[[DVec3; 3]]) -> Option<u32> {
    const DOUBT: f64 = 1e-9;
    let mut hits: Vec<(f64, u32)> = Vec::new();
    for (number, [a, b, c]) in (0..).zip(triangles) {
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
        let x = origin + direction * t - *a;
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
            hits.push((t, number));
        }
    }
    hits.sort_by(|a, b| a.0.total_cmp(&b.0));
    match hits[..] {
        [] => Some(NOTHING),
        [(_, number)] => Some(number),
        [(t, number), (next, _), ..] => (next - t > DOUBT * t.abs().max(1.0)).then_some(number),
    }
}

#[test]
fn pixels_show_what_rays_in_space_meet() {
    let (mut judged, mut doubtful) = (0u32, 0u32);
    for seed in 0..number_of_scenes(150) {
        let (scene, camera) = built(&random(seed));
        let size = (31, 23);
        let (map, raster) = fitted(&scene, &camera, size);
        let items = solve(&raster, Engine::ZBuffer);
        let positions = scene.mesh().positions();
        let triangles: Vec<[DVec3; 3]> =
            scene.triangles().iter().map(|t| t.map(|vertex| positions[vertex as usize])).collect();
        let frame = camera.frame();
        for (at, &item) in (0..).zip(&items) {
            let center = DVec2::new(f64::from(at % size.0), f64::from(at / size.0)) + 0.5;
            let image = (center - map.origin) / map.scale;
            let aside = frame.right * image.x - frame.upward * image.y;
            let (origin, direction, near) = match camera.projection() {
                Projection::Perspective { near, .. } => {
                    let near = near * camera.forward().length();
                    (camera.eye(), frame.forward + aside, near)
                }
                Projection::Orthographic => {
                    (camera.eye() + aside, frame.forward, f64::NEG_INFINITY)
                }
            };
            let Some(expected) = met(origin, direction, near, &triangles) else {
                doubtful += 1;
                continue;
            };
            let found = if item == NOTHING { NOTHING } else { raster.number(item) };
            assert_eq!(found, expected, "seed {seed}, pixel {at}");
            judged += 1;
        }
    }
    eprintln!("{judged} pixels judged, {doubtful} left out as doubtful");
    assert!(judged > 4 * doubtful, "{doubtful} doubtful, {judged} judged");
}
