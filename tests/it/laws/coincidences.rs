//! Coincidences that random scenes hardly ever meet, each made on purpose.

use crate::laws::engines::{all_pairs, appel, camera, mesh, roberts};
use crate::oracle::compare::{compare, truth_of};
use crate::scenes::{Model, P, Rng, Scene as TestScene, orthographic, perspective};
use glam::{DVec3, dvec3};
use hiddenline::stages::classify::{LineSelection, ViewedScene};
use hiddenline::stages::engines::edge::{LineEngine, VisibilityOptions, solve};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;

fn assert_as_the_truth_says(scene: &TestScene) {
    let edges = truth_of(scene).unwrap();
    for solve in [roberts, all_pairs, appel] {
        let spans = solve(scene).unwrap();
        compare(&scene.sight, &edges, &spans).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
    }
}

/// The near plane cuts a floor, whose border there has the image of an edge under the floor. What
/// lies beyond the cut covers the edge on its upper side only.
#[test]
fn a_floor_cut_by_the_near_plane_covers_the_side_on_which_it_goes_on() {
    // The eye looks along x, and the near plane is x = 1, so that the floor z = −1 begins at v = −1.
    let sight = perspective([0.0; 3], [1.0, 0.0, 0.0], 1.0);
    let floor = [[-1.0, 0.0, -1.0], [3.0, -4.0, -1.0], [3.0, 4.0, -1.0]];
    let apron = [[1.5, -3.0, -1.5], [1.5, 3.0, -1.5], [1.5, 0.0, -5.0]];
    let shelf = [[1.5, -3.0, -1.5], [1.5, 3.0, -1.5], [1.25, 0.0, 2.0]];
    let under = [[2.0, -1.0, -2.0], [2.0, 1.0, -2.0], [4.0, 0.0, -7.0]];
    for (name, more) in [("floor", None), ("with apron", Some(apron)), ("with shelf", Some(shelf))]
    {
        for turn in [false, true] {
            let mut model = Model::default();
            for mut face in [Some(floor), Some(under), more].into_iter().flatten() {
                if turn {
                    face.reverse();
                }
                model.face(&face);
            }
            assert_as_the_truth_says(&model.seen_by(name, sight));
        }
    }
}

/// Edges with one level image line each: rounding gives some an angle just above zero, and others
/// one just below half a turn.
#[test]
fn level_lines_drawn_twice_are_found_whichever_way_rounding_tilts_them() {
    let mut n_doubled = 0;
    for seed in 0..40 {
        let mut rng = Rng(seed);
        let (a, b) = (rng.integer(1, 9), rng.integer(1, 9));
        // Level in the image: across both the direction of view and z.
        let (forward, level): (P, P) = ([a, b, -rng.integer(1, 9)], [b, -a, 0.0]);
        let mut model = Model::default();
        for _ in 0..6 {
            let start = rng.point(-50, 50);
            for copy in 0..3 {
                let (shift, times) = (rng.integer(-4, 4), f64::from(copy));
                let at = |along: f64, up: f64| -> P {
                    [0, 1, 2].map(|i| {
                        let up = if i == 2 { up } else { 0.0 };
                        start[i] + times * forward[i] + (along + shift) * level[i] + up
                    })
                };
                let length = rng.integer(5, 9);
                model.face(&[at(0.0, 0.0), at(length, 0.0), at(2.0, rng.integer(1, 9))]);
            }
        }
        let test = model.seen_by(format!("seed {seed}"), orthographic(forward, [0.0, 0.0, 1.0]));
        let scene = Scene::new(mesh(&test));
        let view = ViewedScene::new(&scene, &camera(&test), LineSelection::all_edges(), 30.0);
        let settings = VisibilityOptions {
            count_layers: true,
            find_doubled: true,
            ..VisibilityOptions::EXACT
        };
        let (expected, _, _) = solve(&view, LineEngine::AllPairs, &settings);
        let (found, _, _) = solve(&view, LineEngine::Appel, &settings);
        for i in 0..found.len() {
            let [a, b] = [&expected, &found].map(|v| {
                let long = v.spans(i).iter().filter(|s| s.t1 - s.t0 > 1e-12);
                long.map(|s| (s.qi, s.doubled)).collect::<Vec<_>>()
            });
            assert_eq!(a, b, "{}, edge {i}", test.name);
            n_doubled += a.iter().filter(|span| span.1).count();
        }
    }
    assert!(n_doubled > 200, "{n_doubled}");
}

fn scene_of(faces: &[&[DVec3]]) -> Scene {
    let mut soup = PolygonSoup::default();
    for face in faces {
        let first = soup.positions.len() as u32;
        soup.positions.extend_from_slice(face);
        soup.push_face(&(first..first + face.len() as u32).collect::<Vec<_>>());
    }
    Scene::new(Mesh::new(soup).unwrap().0)
}

/// Faces of four corners are cut along the diagonal from the second to the last.
#[test]
fn faces_that_share_a_diagonal_cross_there_only_when_they_lie_in_two_planes() {
    let (p, q) = (dvec3(4.0, 0.0, 0.0), dvec3(0.0, 4.0, 0.0));
    let square = [DVec3::ZERO, p, dvec3(4.0, 4.0, 0.0), q];
    let upright = [dvec3(2.0, 2.0, -1.0), p, dvec3(2.0, 2.0, 3.0), q];
    let flat = [dvec3(1.0, 1.0, 0.0), p, dvec3(5.0, 5.0, 0.0), q];
    let n_lines = |faces: &[&[DVec3]]| {
        let scene = scene_of(faces).with_intersections();
        scene.intersections().lines().len()
    };
    assert_eq!(n_lines(&[&square, &upright]), 1);
    assert_eq!(n_lines(&[&upright, &flat]), 1);
    assert_eq!(n_lines(&[&square, &flat]), 0);
    assert_eq!(n_lines(&[&flat, &square]), 0);
    // A fin on the square, and a face beside the fin that lies on the square.
    let fin = [p, q, dvec3(2.0, 2.0, 3.0)];
    for lying in [[p, q, dvec3(1.0, 2.0, 0.0)], [p, q, dvec3(9.0, 1.0, 0.0)]] {
        assert_eq!(n_lines(&[&square, &lying]), 0);
        assert_eq!(n_lines(&[&square, &fin, &lying]), 0);
        assert_eq!(n_lines(&[&square, &lying, &fin]), 0);
    }
    assert_eq!(n_lines(&[&square, &fin, &[p, q, dvec3(2.0, 2.0, -3.0)]]), 1);
}

/// Polygons with holes, joined to the outline by bridges: the corners where bridges start and end
/// are there twice.
#[test]
fn keyholes_are_cut_into_triangles_that_leave_the_holes_open() {
    let outline = [[0, 0], [12, 0], [12, 8], [0, 8]];
    let holes: [&[[i32; 2]]; 4] = [
        &[[2, 2], [2, 4], [4, 4], [4, 2]],
        &[[6, 3], [5, 5], [7, 6]],
        &[[9, 1], [8, 3], [9, 7], [10, 3]],
        &[[1, 6], [3, 7], [4, 6]],
    ];
    let doubled_area = |ring: &[[i32; 2]]| -> i32 {
        let n = ring.len();
        (0..n).map(|i| (ring[i], ring[(i + 1) % n])).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
    };
    for (n, hole) in holes.iter().enumerate() {
        for corner in 0..4 {
            for at in 0..hole.len() {
                // Outline from the bridge round to it, hole round, and back.
                let mut ring: Vec<[i32; 2]> = (0..5).map(|i| outline[(corner + i) % 4]).collect();
                ring.extend((0..=hole.len()).map(|i| hole[(at + i) % hole.len()]));
                for start in 0..ring.len() {
                    ring.rotate_left(1);
                    let points: Vec<DVec3> =
                        ring.iter().map(|&[x, y]| dvec3(x.into(), y.into(), 1.0)).collect();
                    let scene = scene_of(&[&points]);
                    let areas: Vec<f64> = scene
                        .triangles()
                        .iter()
                        .map(|t| {
                            let [a, b, c] = t.map(|v| scene.mesh().positions()[v as usize]);
                            (b - a).cross(c - a).z
                        })
                        .collect();
                    let bridge_crosses = crosses(outline[corner], hole[at], hole);
                    if bridge_crosses {
                        continue;
                    }
                    let name = format!("hole {n}, bridge {corner} {at}, start {start}: {ring:?}");
                    assert!(areas.iter().all(|&area| area >= 0.0), "{name}: {areas:?}");
                    let total: f64 = areas.iter().sum();
                    assert_eq!(total, f64::from(doubled_area(&ring)), "{name}");
                }
            }
        }
    }
}

/// Whether the bridge from `p` to a hole's corner `q` meets the hole elsewhere.
fn crosses(p: [i32; 2], q: [i32; 2], hole: &[[i32; 2]]) -> bool {
    let turn = |a: [i32; 2], b: [i32; 2], c: [i32; 2]| {
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).signum()
    };
    (0..hole.len()).any(|i| {
        let (a, b) = (hole[i], hole[(i + 1) % hole.len()]);
        a != q && b != q && turn(p, q, a) * turn(p, q, b) <= 0 && turn(a, b, p) * turn(a, b, q) <= 0
    })
}
