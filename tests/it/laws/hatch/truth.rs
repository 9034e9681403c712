//! Every base line, seen and lit, against exact fractions.

use glam::{DVec2, DVec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::draw::DrawOptions;
use hiddenline::stages::hatch::{
    HatchMethod, HatchOptions, HatchPage, HatchShadows, hatch, planes,
};
use hiddenline::stages::shading::light::{Light, LightSource};
use hiddenline::stages::strokes::Strokes;

use crate::laws::engines::{camera, mesh};
use crate::oracle::Sight;
use crate::oracle::compare::compare_strokes;
use crate::oracle::hatch::{HatchPlane, hatch_truth};
use crate::scenes::{Rng, Scene, number_of_scenes, random};

/// A page at one millimeter a unit, whose base lines are `step` apart: 320 of them or less.
pub(super) fn page(step: f64, black: f64) -> HatchPage {
    let all = DVec2::splat(160.0 * step);
    HatchPage { mm_per_image_unit: 1.0, window: (-all, all), pen_width_mm: 8.0 * black * step }
}

pub(super) fn sight_of(camera: &Camera) -> Sight {
    Sight {
        eye: camera.eye().to_array(),
        target: camera.target().to_array(),
        up: camera.up().to_array(),
        near: match camera.projection() {
            Projection::Perspective { near, .. } => Some(near),
            Projection::Orthographic => None,
        },
    }
}

fn strokes_of(strokes: &Strokes, is_lit: bool) -> Vec<Vec<[f64; 2]>> {
    let own = strokes.iter().filter(|stroke| stroke.lit == Some(is_lit));
    own.map(|stroke| stroke.points.iter().map(|p| p.to_array()).collect()).collect()
}

/// Compares one scene; returns the lengths of lit and dark lines.
fn check(scene: &Scene, options: &HatchOptions, step: f64) -> Option<[f64; 2]> {
    let camera = camera(scene);
    // In perspective image coordinates are tangents.
    let is_perspective = scene.sight.near.is_some();
    let page = page(if is_perspective { step / 16.0 } else { step }, options.black);
    // Where the eye's plane is near, lines are without end.
    let frame = camera.frame();
    let is_in_front = |p: &[f64; 3]| {
        let d = DVec3::from_array(*p) - camera.eye();
        d.dot(frame.forward) > 0.1 * d.length()
    };
    if is_perspective && !scene.positions.iter().all(is_in_front) {
        return None;
    }
    let mesh = hiddenline::Scene::new(mesh(scene));
    let bounds = mesh.mesh().bounds()?;
    let light = Light::new(options.light, &camera).camera(bounds).ok()?;
    let exact = DrawOptions::default().exact();
    let found = hatch(&mesh, &camera, options, &exact, &page).unwrap();
    let cutting: Vec<HatchPlane> = planes(&camera, options, &page, -320..321)
        .iter()
        .map(|plane| HatchPlane { normal: plane.normal.to_array(), offset: plane.offset })
        .collect();
    let (positions, faces) = (&scene.positions, &scene.faces);
    let truth = hatch_truth(positions, faces, &scene.sight, &sight_of(&light), &cutting).ok()?;
    Some([true, false].map(|is_lit| {
        let expected: Vec<[[f64; 2]; 2]> =
            truth.iter().filter(|part| part.is_lit == is_lit).map(|part| part.ends).collect();
        let got = strokes_of(&found, is_lit);
        let difference = compare_strokes(&expected, &got, &[]);
        assert!(
            difference.is_small(),
            "{} lit {is_lit}: {difference:?}\n{scene:?}\n{options:?}",
            scene.name
        );
        difference.total
    }))
}

/// Scenes of which all faces are well in front of the eye, and lines of all kinds on them.
fn compared(method: HatchMethod, n: u64) {
    let (mut n_compared, mut totals) = (0, [0.0; 2]);
    for seed in 0..number_of_scenes(n) {
        let scene = random(seed);
        let mut rng = Rng(seed + 77);
        let towards = loop {
            let p = rng.point(-3, 3);
            if p != [0.0; 3] {
                break p;
            }
        };
        let light = match rng.one_in(3) {
            true => LightSource::At(DVec3::from_array(towards) * 40.0),
            false => LightSource::From(DVec3::from_array(towards)),
        };
        let normal = match rng.below(3) {
            // Through vertices and along faces.
            0 => Some(rng.pick(&[DVec3::X, DVec3::Y, DVec3::Z])),
            1 => Some(DVec3::new(0.3, -0.4, 0.8)),
            _ => None,
        };
        let step = rng.pick(&[1.0, 0.5, 0.7]);
        let options = HatchOptions { method, light, normal, ..HatchOptions::default() };
        if let Some(lengths) = check(&scene, &options, step) {
            n_compared += 1;
            totals[0] += lengths[0];
            totals[1] += lengths[1];
        }
    }
    eprintln!("{n_compared} scenes, {totals:?} lit and dark");
    assert!(n_compared as u64 > number_of_scenes(n) / 3);
    assert!(totals.iter().all(|&total| total > 0.0));
}

#[test]
fn sections_are_seen_and_lit_as_exact_fractions_say() {
    compared(HatchMethod::Sections, 24);
}

#[test]
fn straight_lines_are_seen_and_lit_as_exact_fractions_say() {
    compared(HatchMethod::Straight, 24);
}

#[test]
fn own_shadows_alone_need_no_light_view() {
    let scene = random(3);
    let camera = camera(&scene);
    let mesh = hiddenline::Scene::new(mesh(&scene));
    let exact = DrawOptions::default().exact();
    let of = |shadows| {
        let options = HatchOptions { shadows, ..HatchOptions::default() };
        let strokes = hatch(&mesh, &camera, &options, &exact, &page(0.5, 0.6)).unwrap();
        let length = |is_lit| -> f64 {
            let own = strokes_of(&strokes, is_lit);
            own.iter().map(|s| (s[0][0] - s[1][0]).hypot(s[0][1] - s[1][1])).sum()
        };
        [length(true), length(false)]
    };
    let [cast, own, none] = [HatchShadows::Cast, HatchShadows::Own, HatchShadows::None].map(of);
    let total = |lengths: [f64; 2]| lengths[0] + lengths[1];
    assert!((total(cast) - total(own)).abs() < 1e-9 * total(cast));
    assert!((total(cast) - total(none)).abs() < 1e-9 * total(cast));
    assert!(cast[0] <= own[0] && own[0] <= none[0] && none[1] == 0.0);
}
