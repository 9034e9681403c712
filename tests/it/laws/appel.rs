//! Appel against Roberts where no oracle goes: on models, and in what only drawings need.

use crate::laws::engines;
use crate::models;
use crate::scenes::{number_of_scenes, random};
use glam::{DVec3, dvec3};
use hiddenline::stages::camera::{Camera, DEFAULT_NEAR, Projection};
use hiddenline::stages::classify::{LineSelection, ViewedScene};
use hiddenline::stages::engines::edge::{LineEngine, VisibilityOptions, solve};
use hiddenline::stages::engines::visibility::Span;
use hiddenline::stages::model::scene::Scene;

/// Spans as a drawing shows them: without those that rounding leaves next to nothing of, and
/// without telling hidden parts apart by who else draws them when layers do not count.
fn as_drawn(spans: &[Span], settings: &VisibilityOptions) -> Vec<Span> {
    let mut drawn: Vec<Span> = Vec::new();
    for span in spans {
        let mut span = *span;
        span.doubled &= settings.count_layers || span.qi == 0;
        match drawn.last_mut() {
            Some(last) if last.qi == span.qi && last.doubled == span.doubled => last.t1 = span.t1,
            Some(last) if span.t1 - span.t0 <= 1e-12 => last.t1 = span.t1,
            _ => drawn.push(span),
        }
    }
    drawn
}

fn is_same(a: &[Span], b: &[Span]) -> bool {
    a.len() == b.len()
        && a.iter().zip(b).all(|(a, b)| {
            a.qi == b.qi
                && a.doubled == b.doubled
                && (a.t0 - b.t0).abs() < 1e-9
                && (a.t1 - b.t1).abs() < 1e-9
        })
}

/// How many edges there are and how many of them were given to Roberts.
fn assert_equal(name: &str, view: &ViewedScene, settings: &VisibilityOptions) -> (usize, u64) {
    let (expected, _, _) = solve(view, LineEngine::Roberts, settings);
    let (found, counts, engine) = solve(view, LineEngine::Appel, settings);
    assert_eq!(engine, "appel");
    assert_eq!(counts.checksum_failures, 0, "{name}");
    assert_eq!(found.len(), expected.len(), "{name}");
    for i in 0..found.len() {
        let (a, b) = (as_drawn(expected.spans(i), settings), as_drawn(found.spans(i), settings));
        assert!(
            is_same(&a, &b),
            "{name}, {settings:?}, edge {}:\nroberts {a:?}\nappel   {b:?}",
            view.selected()[i].edge
        );
    }
    (found.len(), counts.fallback_edges)
}

#[test]
fn lines_drawn_twice_are_found_as_roberts_finds_them() {
    for seed in 60_000..60_000 + number_of_scenes(2000) {
        let scene = random(seed);
        let built = Scene::new(engines::mesh(&scene));
        let camera = engines::camera(&scene);
        for lines in [LineSelection::all_edges(), LineSelection::default()] {
            let view = ViewedScene::new(&built, &camera, lines, 30.0);
            for (contact_tolerance, count_layers) in
                [(0.0, true), (0.0, false), (0.3, true), (1e-6, false)]
            {
                let settings = VisibilityOptions {
                    contact_tolerance,
                    count_layers,
                    find_doubled: true,
                    ..VisibilityOptions::EXACT
                };
                assert_equal(&scene.name, &view, &settings);
            }
        }
    }
}

fn cameras(scene: &Scene) -> Vec<Camera> {
    let positions = scene.mesh().positions();
    let low = positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = positions.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let (center, size) = (0.5 * (low + high), (high - low).length());
    let camera = |direction: DVec3, times: f64, projection| {
        Camera::new(center + times * size * direction, center, DVec3::Z, projection).unwrap()
    };
    let isometric = dvec3(1.0, -1.0, 1.0);
    let askew = dvec3(0.3, -0.8, 0.45);
    let perspective = Projection::Perspective { fov_deg: 30.0, near: DEFAULT_NEAR };
    vec![
        camera(isometric, 1.0, Projection::Orthographic),
        camera(askew, 1.0, Projection::Orthographic),
        camera(dvec3(0.0, -1.0, 0.0), 1.0, Projection::Orthographic),
        camera(isometric, 1.0, perspective),
        camera(askew, 0.2, perspective),
    ]
}

#[test]
fn models_are_drawn_as_roberts_draws_them() {
    let largest = std::env::var("HIDDENLINE_LARGEST_MODEL").ok().and_then(|n| n.parse().ok());
    let largest: u64 = largest.unwrap_or(500_000);
    let (paths, least) = models::all();
    let mut n_models = 0;
    for path in paths {
        let is_small = std::fs::metadata(&path).is_ok_and(|data| data.len() <= largest);
        if !is_small {
            continue;
        }
        let Ok(model) = hiddenline::stages::read::read_file(&path, None) else {
            continue;
        };
        n_models += 1;
        let scene = Scene::new(model.mesh);
        let name = models::name(&path);
        let size =
            scene.mesh().positions().iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let (mut n_edges, mut n_given) = (0, 0);
        for camera in cameras(&scene) {
            for (lines, settings) in [
                (
                    LineSelection::all_edges(),
                    VisibilityOptions { count_layers: true, ..VisibilityOptions::EXACT },
                ),
                (
                    LineSelection::default(),
                    VisibilityOptions {
                        contact_tolerance: size
                            * hiddenline::stages::draw::DEFAULT_CONTACT_TOLERANCE,
                        find_doubled: true,
                        ..VisibilityOptions::EXACT
                    },
                ),
            ] {
                let view = ViewedScene::new(&scene, &camera, lines, 30.0);
                let (edges, given) = assert_equal(&name, &view, &settings);
                n_edges += edges;
                n_given += given;
            }
        }
        eprintln!("{name}: {n_edges} edges, {n_given} given to Roberts");
    }
    assert!(n_models >= least.min(6), "only {n_models} models");
}
