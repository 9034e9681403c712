//! Outlines of shadows: where light turns to shade along exact lines on the faces, and nowhere else.

use glam::{DVec2, DVec3, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::draw::DrawOptions;
use hiddenline::stages::hatch::{Ground, HatchOptions, planes, shadow_outlines};
use hiddenline::stages::shading::light::{Light, LightSource};

use super::truth::{page, sight_of};
use crate::laws::engines::{camera, mesh};
use crate::oracle::hatch::{HatchPlane, HatchTruth, hatch_truth};
use crate::scenes::{Rng, number_of_scenes, random};

type Segment = [DVec2; 2];

fn distance(x: DVec2, [a, b]: Segment) -> f64 {
    let along = b - a;
    let t = (along.dot(x - a) / along.length_squared()).clamp(0.0, 1.0);
    (x - a - along * if t.is_nan() { 0.0 } else { t }).length()
}

/// Where two segments cross, as parts of their ways; `None` for parallel ones.
fn crossing([a, b]: Segment, [p, q]: Segment) -> Option<[f64; 2]> {
    let (u, v, w) = (b - a, q - p, p - a);
    let turn = u.perp_dot(v);
    (turn.abs() > 1e-9 * u.length() * v.length())
        .then(|| [w.perp_dot(v) / turn, w.perp_dot(u) / turn])
}

#[test]
fn light_turns_to_shade_exactly_at_outlines() {
    let (mut n_borders, mut n_outlines, mut n_crossed) = (0, 0, 0);
    for seed in 0..number_of_scenes(60) {
        let scene = random(seed);
        let mut rng = Rng(seed + 5);
        let towards = dvec3(rng.integer(-3, 3), rng.integer(-3, 3), rng.integer(1, 4));
        let light = match rng.one_in(3) {
            true => LightSource::At(towards * 40.0),
            false => LightSource::From(towards),
        };
        let camera = camera(&scene);
        let built = hiddenline::Scene::new(mesh(&scene)).with_intersections();
        let Some(bounds) = built.mesh().bounds() else { continue };
        let Ok(light_camera) = Light::new(light, &camera).camera(bounds) else { continue };
        // In perspective image coordinates are tangents.
        let step = if scene.sight.near.is_some() { 0.02 } else { 0.37 };
        let normal = Some(dvec3(0.31, -0.43, 0.77));
        let options = HatchOptions { light, normal, ..HatchOptions::default() };
        let cutting: Vec<HatchPlane> = planes(&camera, &options, &page(step, 0.6), -160..161)
            .iter()
            .map(|plane| HatchPlane { normal: plane.normal.to_array(), offset: plane.offset })
            .collect();
        let (eye, lamp) = (&scene.sight, &sight_of(&light_camera));
        let Ok(truth) = hatch_truth(&scene.positions, &scene.faces, eye, lamp, &cutting) else {
            continue;
        };
        let exact = DrawOptions::default().exact();
        let strokes = shadow_outlines(&built, &camera, light, None, &exact, 1.0).unwrap();
        let outlines: Vec<Segment> =
            strokes.iter().map(|stroke| [stroke.points[0], stroke.points[1]]).collect();
        n_outlines += outlines.len();
        let size = outlines
            .iter()
            .flatten()
            .chain([&DVec2::ONE])
            .fold(0.0, |size: f64, p| size.max(p.abs().max_element()));
        // Where faces meet or pierce each other, light may turn to shade too: these are lines anyway.
        let lines = (0..built.n_lines() as u32)
            .map(|line| built.line(line).map(|end| camera.image(built.points()[end as usize])));
        let drawn: Vec<Segment> = outlines.iter().copied().chain(lines).collect();
        let ends = |part: &HatchTruth| part.ends.map(DVec2::from_array);
        // Where one visible piece of a face ends lit and the next one begins dark.
        for pair in truth.windows(2) {
            let ([_, end], [start, _]) = (ends(&pair[0]), ends(&pair[1]));
            if pair[0].face != pair[1].face
                || pair[0].is_lit == pair[1].is_lit
                || end.distance(start) > 1e-12 * size
            {
                continue;
            }
            n_borders += 1;
            let nearest = drawn.iter().map(|&o| distance(end, o)).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-9 * size, "{}: {end} is {nearest} off\n{scene:?}", scene.name);
        }
        // No outline runs through a piece of a visible face that is all lit or all dark.
        for outline in &outlines {
            for part in &truth {
                let Some([s, t]) = crossing(*outline, ends(part)) else { continue };
                let (own, other) = (outline[0].distance(outline[1]), {
                    let [a, b] = ends(part);
                    a.distance(b)
                });
                let is_inside = |s: f64, length: f64| {
                    s * length > 1e-7 * size && (1.0 - s) * length > 1e-7 * size
                };
                n_crossed += 1;
                assert!(
                    !(is_inside(s, own) && is_inside(t, other)),
                    "{}: {outline:?} runs through {part:?}\n{scene:?}",
                    scene.name
                );
            }
        }
    }
    eprintln!("{n_borders} borders, {n_outlines} outlines, {n_crossed} pairs");
    assert!(n_borders > 20 && n_outlines > 20 && n_crossed > 500);
}

#[test]
fn a_cube_has_the_outline_of_its_shadow_on_the_ground() {
    let side = 2.0;
    let from = dvec3(-1.0, -0.5, 2.0);
    let corner =
        |i: u32| side * dvec3(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1));
    let corners: Vec<DVec3> = (0..8).map(corner).collect();
    let faces: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let scene = hiddenline::Scene::from_faces(&corners, faces).unwrap();
    let eye = dvec3(0.0, 0.0, 9.0);
    let camera = Camera::new(eye, DVec3::ZERO, DVec3::Y, Projection::Orthographic).unwrap();
    let (light, ground) = (LightSource::From(from), Some(Ground::Lowest));
    let lines = DrawOptions::default();
    let strokes = shadow_outlines(&scene, &camera, light, ground, &lines, 10.0).unwrap();
    let length: f64 = strokes
        .iter()
        .flat_map(|stroke| stroke.points.windows(2).map(|p| p[0].distance(p[1])))
        .sum();
    let (p, q) = (-side * from.x / from.z, -side * from.y / from.z);
    let expected = 2.0 * side + 2.0 * p.hypot(q);
    assert!((length - expected).abs() < 1e-9, "{length} {expected}");
    assert_eq!(strokes.len(), 1, "one stroke from corner to corner");
}
