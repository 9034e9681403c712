//! The order of painting: on scenes with known traps, and on random ones.

use super::{ENGINES, EXACT};
use crate::laws::engines::{camera, mesh};
use crate::oracle::Sight;
use crate::oracle::sight_lines::SightLines;
use crate::scenes::{
    Model, Scene as TestScene, number_of_scenes, orthographic, perspective, random,
};
use hiddenline::stages::engines::face::{bsp, depth_sort, octree, piercing};
use hiddenline::stages::model::scene::Scene;

/// Judges all engines on one scene; the number of points judged by each.
fn judge(scene: &TestScene, n: u32) -> u32 {
    let (built, camera) = (Scene::new(mesh(scene)), camera(scene));
    let world = SightLines::new(&built, &camera);
    let mut least = u32::MAX;
    for (engine, solve) in [EXACT].into_iter().chain(ENGINES) {
        let painting = solve(&built, &camera);
        match world.judge(&painting, n, |_| false) {
            Ok((judged, _)) => least = least.min(judged),
            Err(problem) => panic!("{}, {engine}: {problem}\n{scene:?}", scene.name),
        }
    }
    least
}

fn bars() -> Model {
    let mut model = Model::default();
    // Each rises over the next one.
    model.face(&[[0.0, 0.0, 0.0], [6.0, 0.0, 2.0], [6.0, 1.0, 2.0], [0.0, 1.0, 0.0]]);
    model.face(&[[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [3.0, 6.0, 2.0], [2.0, 6.0, 2.0]]);
    model.face(&[[3.0, 6.0, 0.0], [4.0, 6.0, 0.0], [1.0, -1.0, 2.0], [0.0, -1.0, 2.0]]);
    model
}

fn views() -> [Sight; 4] {
    [
        orthographic([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]),
        orthographic([1.0, 2.0, -3.0], [0.0, 0.0, 1.0]),
        perspective([3.0, 2.0, 12.0], [3.0, 3.0, 0.0], 1e-6),
        perspective([9.0, -5.0, 4.0], [2.0, 2.0, 1.0], 0.75),
    ]
}

#[test]
fn bars_that_overlap_in_turn_are_split() {
    for sight in views() {
        assert!(judge(&bars().seen_by("bars", sight), 40) > 1500);
    }
    // From above there is no order without a split: nine bars' overlaps are one cycle.
    let scene = bars().seen_by("bars", views()[0]);
    let (built, camera) = (Scene::new(mesh(&scene)), camera(&scene));
    let (painting, counts) = depth_sort::solve(&built, &camera).unwrap();
    assert!(counts.splits > 0);
    assert_eq!(painting.len() as u64, 6 + counts.splits);
}

#[test]
fn faces_that_pierce_each_other_are_split() {
    for sight in views() {
        let mut model = Model::default();
        model.face(&[[0.0, 0.0, 0.0], [5.0, 0.0, 4.0], [5.0, 5.0, 4.0], [0.0, 5.0, 0.0]]);
        model.face(&[[0.0, 1.0, 4.0], [5.0, 1.0, 0.0], [5.0, 4.0, 0.0], [0.0, 4.0, 4.0]]);
        judge(&model.seen_by("pair", sight), 40);
    }
}

#[test]
fn faces_that_cross_behind_the_eye_come_out_right() {
    // The planes meet at y = −1/2, and the image of that line is far above all that is seen.
    let slope = |y: f64| (y + 0.5) / 16.0;
    for swapped in [false, true] {
        let mut model = Model::default();
        let corners = [(-1.0, -10.0), (1.0, -10.0), (0.0, 50.0)];
        let level = corners.map(|(x, y)| [x, y, 0.0]);
        let sloping = corners.map(|(x, y)| [x, y, slope(y)]);
        let faces = if swapped { [sloping, level] } else { [level, sloping] };
        faces.iter().for_each(|face| model.face(face));
        let sight = perspective([0.0, 0.0, 5.0], [0.0, 1.0, 5.0], 1.0);
        let scene = model.seen_by("crossing behind the eye", sight);
        assert!(judge(&scene, 40) > 300);
    }
}

#[test]
fn a_triangle_through_a_square_comes_out_right() {
    // The triangle's plane is z = y − x + 6; the eye is at z = −∞.
    for (up, target) in [([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]), ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0])] {
        let mut model = Model::default();
        model.face(&[[18.5, 12.5, 0.0], [22.5, 16.5, 0.0], [14.5, 22.5, 14.0]]);
        model.face(&[[12.5, 14.5, 6.0], [20.5, 14.5, 6.0], [20.5, 20.5, 6.0], [12.5, 20.5, 6.0]]);
        judge(&model.seen_by("triangle and square", orthographic(target, up)), 64);
    }
}

#[test]
fn boxes_that_cross_come_out_right() {
    for sight in views() {
        let mut model = Model::default();
        model.add_box([0.0, 0.0, 0.0], [4.0, 4.0, 4.0]);
        model.add_box([1.0, -1.0, 1.0], [3.0, 5.0, 3.0]);
        model.add_box([-1.0, 1.0, 2.0], [5.0, 2.0, 5.0]);
        model.add_box([4.0, 4.0, 0.0], [6.0, 6.0, 2.0]);
        judge(&model.seen_by("boxes", sight), 40);
    }
}

#[test]
fn of_faces_in_one_plane_the_first_is_seen() {
    for sight in views() {
        let mut model = Model::default();
        model.face(&[[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [4.0, 4.0, 1.0], [0.0, 4.0, 1.0]]);
        model.face(&[[1.0, 1.0, 1.0], [2.0, 5.0, 1.0], [6.0, 2.0, 1.0]]);
        model.face(&[[-1.0, -1.0, 1.0], [5.0, -1.0, 1.0], [5.0, 3.0, 1.0], [-1.0, 3.0, 1.0]]);
        // Something that cuts all three.
        model.face(&[[2.0, -2.0, 0.0], [2.0, 6.0, 0.0], [3.0, 2.0, 3.0]]);
        judge(&model.seen_by("one plane", sight), 40);
    }
}

#[test]
fn of_faces_in_the_plane_where_two_objects_touch_the_first_is_seen_from_both_sides() {
    // Each has a square in the plane x = 1 and an arm to one side.
    let left = [
        [[1.0, 0.0, 0.0], [1.0, 4.0, 0.0], [1.0, 4.0, 4.0], [1.0, 0.0, 4.0]],
        [[1.0, 0.0, 0.0], [1.0, 0.0, 4.0], [0.0, 0.0, 4.0], [0.0, 0.0, 0.0]],
    ];
    let right = [
        [[1.0, 1.0, 1.0], [1.0, 5.0, 1.0], [1.0, 5.0, 5.0], [1.0, 1.0, 5.0]],
        [[1.0, 5.0, 1.0], [1.0, 5.0, 5.0], [2.0, 5.0, 5.0], [2.0, 5.0, 1.0]],
    ];
    for faces in [[left, right], [right, left]] {
        for x in [-3.0, 3.0] {
            let mut model = Model::default();
            faces.as_flattened().iter().for_each(|face| model.face(face));
            let sight = orthographic([x, 1.0, -1.0], [0.0, 0.0, 1.0]);
            assert!(judge(&model.seen_by("touching", sight), 40) > 500);
        }
    }
}

#[test]
fn what_the_near_plane_cuts_away_hides_nothing() {
    // The eye is at the origin and looks along y; the near plane is y = 1. Two triangles share a side
    // before it, right in front of a sliver.
    let (left, right) = ([-1.0, 0.6, 0.0], [1.0, 0.6, 0.0]);
    let mut model = Model::default();
    model.face(&[left, right, [0.0, 3.0, 3.0]]);
    model.face(&[right, left, [0.0, 0.5, -0.4]]);
    model.face(&[[-2.5, 5.0, 0.001], [2.5, 5.0, 0.001], [0.0, 5.0, 0.002]]);
    let sight = perspective([0.0, 0.0, 0.0], [0.0, 1.0, 0.0], 1.0);
    let scene = model.seen_by("a cut wall", sight);
    let (built, camera) = (Scene::new(mesh(&scene)), camera(&scene));
    for (engine, solve) in [EXACT].into_iter().chain(ENGINES) {
        let painting = solve(&built, &camera);
        assert!(painting.pieces().any(|piece| piece.face == 2), "{engine}");
    }
}

#[test]
fn the_painting_of_random_scenes_is_what_exact_rays_meet() {
    let n = number_of_scenes(300);
    let mut judged = 0;
    for seed in 0..n {
        judged += judge(&random(seed), 13);
    }
    eprintln!("{n} scenes, {judged} points judged for each engine");
    assert!(u64::from(judged) > 150 * n);
}

#[test]
fn the_painting_of_crossing_triangles_is_what_exact_rays_meet() {
    for seed in 0..number_of_scenes(60) {
        let mut rng = crate::scenes::Rng(seed ^ 0xc0ffee);
        let mut model = Model::default();
        for _ in 0..14 {
            let corners = [0; 3].map(|_| rng.point(-4, 4));
            model.face(&corners);
        }
        let eye = rng.point(-5, 5);
        let sight = if rng.one_in(2) || eye == [0.0; 3] {
            orthographic([1.0, -2.0, -3.0], [0.0, 0.0, 1.0])
        } else {
            perspective(eye, [0.0; 3], 0.1)
        };
        judge(&model.seen_by(format!("crossing, seed {seed}"), sight), 17);
    }
}

#[test]
fn heaps_of_faces_that_pierce_each_other_are_refused_before_the_start() {
    let mut rng = crate::scenes::Rng(1);
    let mut model = Model::default();
    for _ in 0..1500 {
        let corners = [0; 3].map(|_| rng.point(-400, 400));
        model.face(&corners);
    }
    let scene = model.seen_by("heap", views()[0]);
    let (built, camera) = (Scene::new(mesh(&scene)), camera(&scene));
    assert!(bsp::solve(&built, &camera).is_err());
    assert!(octree::solve(&built, &camera).is_err());
    let refused = depth_sort::solve(&built, &camera).unwrap_err();
    assert!(matches!(refused, depth_sort::DepthSortError::TooManyPiercings(_)), "{refused}");
}

#[test]
fn piercings_are_estimated_from_a_sample() {
    // Each of n planes across x goes through each of n planes across y.
    let n = 400;
    let mut model = Model::default();
    for k in 0..n {
        let at = f64::from(k);
        model.face(&[[at, -1000.0, -1000.0], [at, 3000.0, -1000.0], [at, 0.0, 3000.0]]);
        model.face(&[[-1000.0, at, -1100.0], [3000.0, at, -1100.0], [0.0, at, 3100.0]]);
    }
    let scene = Scene::new(mesh(&model.seen_by("lattice", views()[0])));
    let (found, expected) = (piercing::estimate(&scene) as f64, f64::from(n * n));
    assert!((found - expected).abs() < 0.03 * expected, "{found} instead of {expected}");
}

#[test]
fn too_many_pairs_are_refused_before_the_start() {
    // Parallel slopes over one triangle, all of which overlap in depth.
    let mut model = Model::default();
    for k in 0..21_000 {
        let z = f64::from(k) / 65536.0;
        model.face(&[[0.0, 0.0, z], [4.0, 0.0, z + 4.0], [0.0, 4.0, z]]);
    }
    let scene = model.seen_by("stack", views()[0]);
    let (built, camera) = (Scene::new(mesh(&scene)), camera(&scene));
    let refused = depth_sort::solve(&built, &camera).unwrap_err();
    assert!(matches!(refused, depth_sort::DepthSortError::TooManyPairs(_)), "{refused}");
}
