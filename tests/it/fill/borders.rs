//! Borders of exact regions are the visible lines of exact drawings.

use super::built;
use crate::scenes::{
    Model, Scene as TestScene, number_of_scenes, orthographic, perspective, random,
};
use glam::DVec2;
use hiddenline::classify::LineSelection;
use hiddenline::draw::{DrawOptions, draw};
use hiddenline::engines::face::images::Images;
use hiddenline::engines::face::weiler_atherton::solve;
use hiddenline::scene::Scene;
use hiddenline::stats::Stats;
use hiddenline::strokes::StrokeKind;
use hiddenline::view::Camera;

type Segment = [DVec2; 2];

/// The visible strokes of `draw --exact --lines all,intersection`.
fn strokes(scene: Scene, camera: &Camera) -> Vec<Segment> {
    let lines = LineSelection::all_edges().with(StrokeKind::Intersection);
    let options = DrawOptions { lines, exact: true, ..DrawOptions::default() };
    let scene = scene.with_intersections();
    let drawing = draw(&scene, camera, &options, |_| 1.0, &mut Stats::default());
    drawing.iter().map(|stroke| [stroke.points[0], stroke.points[1]]).collect()
}

/// All sides of all regions.
fn borders(scene: &Scene, camera: &Camera) -> Vec<Segment> {
    let painting = solve(scene, camera).unwrap();
    let rings = painting.pieces().flat_map(|piece| piece.rings().collect::<Vec<_>>());
    rings
        .flat_map(|ring| {
            let n = ring.points.len();
            (0..n).map(move |k| [ring.points[k], ring.points[(k + 1) % n]])
        })
        .collect()
}

/// How much of `these` lies farther than `slack` from all of `those`: judged by points on them.
fn uncovered(these: &[Segment], those: &[Segment], slack: f64) -> Option<DVec2> {
    const POINTS: u32 = 17;
    for &[a, b] in these {
        for k in 0..POINTS {
            let point = a.lerp(b, (f64::from(k) + 0.5) / f64::from(POINTS));
            let is_near = |&[c, d]: &Segment| super::distance(point, c, d) <= slack;
            if a.distance(b) > 4.0 * slack && !those.iter().any(is_near) {
                return Some(point);
            }
        }
    }
    None
}

/// Both ways; `slack` as a part of the image's diagonal.
fn are_the_same(scene: &TestScene, slack: f64) {
    let (built_scene, camera) = built(scene);
    let bounds = Images::new(&built_scene, &camera).bounds;
    let slack = slack * (bounds.1 - bounds.0).length();
    let borders = borders(&built_scene, &camera);
    let strokes = strokes(built_scene, &camera);
    assert!(!strokes.is_empty() && !borders.is_empty(), "{}", scene.name);
    let point = uncovered(&borders, &strokes, slack);
    assert!(point.is_none(), "{}: the border at {point:?} is no stroke", scene.name);
    let point = uncovered(&strokes, &borders, slack);
    assert!(point.is_none(), "{}: the stroke at {point:?} is no border", scene.name);
}

#[test]
fn borders_are_the_strokes_of_known_scenes() {
    let sights = [
        orthographic([-3.0, 5.0, -4.0], [0.0, 0.0, 1.0]),
        perspective([9.0, -11.0, 7.0], [2.0, 2.0, 1.0], 1e-6),
        perspective([-7.0, -9.0, 12.0], [2.0, 2.0, 1.0], 1e-6),
    ];
    are_the_same(&super::regions::warnocks_pair(), 1e-12);
    for (k, sight) in sights.into_iter().enumerate() {
        let mut cube = Model::default();
        cube.add_box([0.0; 3], [2.0, 3.0, 1.0]);
        are_the_same(&cube.seen_by(format!("a box, {k}"), sight), 1e-12);
        let mut crossing = Model::default();
        crossing.add_box([0.0, 1.0, 1.0], [6.0, 3.0, 3.0]);
        crossing.add_box([2.0, 0.0, 0.0], [4.0, 5.0, 2.0]);
        are_the_same(&crossing.seen_by(format!("crossing boxes, {k}"), sight), 1e-12);
        let mut pair = Model::default();
        pair.face(&[[0.0, 0.0, 0.0], [5.0, 0.0, 1.0], [1.0, 5.0, 3.0]]);
        pair.face(&[[1.0, 1.0, -3.0], [4.0, 2.0, 4.0], [0.0, 4.0, 3.0]]);
        are_the_same(&pair.seen_by(format!("a penetrating pair, {k}"), sight), 1e-12);
        let mut bars = Model::default();
        bars.face(&[[0.0, 0.0, 0.0], [6.0, 0.0, 2.0], [6.0, 1.0, 2.0], [0.0, 1.0, 0.0]]);
        bars.face(&[[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [3.0, 6.0, 2.0], [2.0, 6.0, 2.0]]);
        bars.face(&[[3.0, 6.0, 0.0], [4.0, 6.0, 0.0], [1.0, -1.0, 2.0], [0.0, -1.0, 2.0]]);
        are_the_same(&bars.seen_by(format!("cyclic bars, {k}"), sight), 1e-12);
    }
}

#[test]
fn borders_of_random_scenes_are_strokes() {
    let (mut compared, mut left_out) = (0, 0);
    for seed in 0..number_of_scenes(300) {
        let test = random(seed);
        let (scene, camera) = built(&test);
        // A border that the near plane makes is no stroke.
        let is_cut = test.sight.near.is_some_and(|near| {
            let forward = camera.forward();
            let limit = near * forward.length_squared();
            test.positions
                .iter()
                .any(|&p| (glam::DVec3::from(p) - camera.eye()).dot(forward) < limit)
        });
        if is_cut || test.is_in_tenths {
            left_out += 1;
            continue;
        }
        let bounds = Images::new(&scene, &camera).bounds;
        let slack = 1e-9 * (bounds.1 - bounds.0).length();
        let borders = borders(&scene, &camera);
        let point = uncovered(&borders, &strokes(scene, &camera), slack);
        assert!(point.is_none(), "{}: the border at {point:?} is no stroke\n{test:?}", test.name);
        compared += 1;
    }
    eprintln!("{compared} scenes compared, {left_out} cut at the near plane or nearly aligned");
    assert!(compared > left_out);
}
