//! Roberts' first step: what faces away from the eye is left out only where nothing changes.
//!
//! The judge is the engine that tests all pairs, which takes no such step.

use super::covered_cells::assert_same;
use crate::scenes::{Rng, number_of_scenes};
use glam::{DVec3, dvec3};
use hiddenline::stages::camera::{Camera, DEFAULT_NEAR, Projection};
use hiddenline::stages::classify::{LineSelection, ViewedScene};
use hiddenline::stages::engines::edge::{LineCounts, LineEngine, VisibilityOptions, solve};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;

const VISIBLE_ONLY: VisibilityOptions = VisibilityOptions::EXACT;

fn add(soup: &mut PolygonSoup, points: &[DVec3], faces: &[&[u32]]) {
    let first = soup.positions.len() as u32;
    soup.positions.extend_from_slice(points);
    for face in faces {
        soup.push_face(&face.iter().map(|corner| first + corner).collect::<Vec<u32>>());
    }
}

/// Faces of a box, wound outward; corner `x + 2 y + 4 z`.
const BOX: [&[u32]; 6] =
    [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];

fn corners(low: DVec3, size: DVec3) -> Vec<DVec3> {
    let part = |i: u32, bit: u32| f64::from(i >> bit & 1);
    (0..8).map(|i| low + size * dvec3(part(i, 0), part(i, 1), part(i, 2))).collect()
}

fn reversed<'f>(faces: &[&[u32]], store: &'f mut Vec<Vec<u32>>) -> Vec<&'f [u32]> {
    *store = faces.iter().map(|face| face.iter().rev().copied().collect()).collect();
    store.iter().map(Vec::as_slice).collect()
}

fn scene(soup: PolygonSoup) -> Scene {
    Scene::new(Mesh::new(soup).unwrap().0).with_intersections()
}

fn looking(from: DVec3, projection: Projection) -> Camera {
    Camera::new(from, DVec3::ZERO, DVec3::Z, projection).unwrap()
}

const PERSPECTIVE: Projection = Projection::Perspective { fov_deg: 30.0, near: DEFAULT_NEAR };

/// Compares with all pairs, and returns what Roberts counted.
fn checked(name: &str, scene: &Scene, camera: &Camera, options: &VisibilityOptions) -> LineCounts {
    let every = LineSelection::all_edges().union(LineSelection::default());
    let view = ViewedScene::new(scene, camera, every, 30.0);
    let (expected, _, _) = solve(&view, LineEngine::AllPairs, options);
    let (found, counts, _) = solve(&view, LineEngine::Roberts, options);
    // Where lines are hidden, nobody asks whether others coincide with them.
    assert_same(name, &expected, &found, |span| {
        if span.qi == 0 && span.doubled { u32::MAX } else { span.qi }
    });
    counts
}

fn counted(scene: &Scene, camera: &Camera, options: &VisibilityOptions) -> [u64; 2] {
    let counts = checked("", scene, camera, options);
    [counts.back_faces, counts.back_edges]
}

#[test]
fn back_faces_of_closed_bodies_are_not_tested() {
    let points = corners(dvec3(-1.0, -1.0, -1.0), dvec3(2.0, 2.0, 2.0));
    let mut store = Vec::new();
    let inward = reversed(&BOX, &mut store);
    let with = |bodies: &[(&[DVec3], &[&[u32]])]| {
        let mut soup = PolygonSoup::default();
        bodies.iter().for_each(|(points, faces)| add(&mut soup, points, faces));
        scene(soup)
    };
    let aside = looking(dvec3(5.0, -7.0, 4.0), Projection::Orthographic);
    let near = looking(dvec3(5.0, -7.0, 4.0), PERSPECTIVE);
    let cube = with(&[(&points, &BOX)]);
    // Three square faces, and the three edges where two of them meet.
    assert_eq!(counted(&cube, &aside, &VISIBLE_ONLY), [6, 3]);
    assert_eq!(counted(&cube, &near, &VISIBLE_ONLY), [6, 3]);
    // Seen along an axis, four faces are edge-on.
    let ahead = looking(dvec3(0.0, -7.0, 0.0), Projection::Orthographic);
    assert_eq!(counted(&cube, &ahead, &VISIBLE_ONLY), [2, 0]);

    let layers = VisibilityOptions { count_layers: true, ..VISIBLE_ONLY };
    assert_eq!(counted(&cube, &aside, &layers), [0, 0]);
    // A back face beside an edge-on one tells alone that its border is nearer than others.
    let doubled = VisibilityOptions { find_doubled: true, ..VISIBLE_ONLY };
    assert_eq!(counted(&cube, &aside, &doubled), [6, 3]);
    assert_eq!(counted(&cube, &ahead, &doubled), [0, 0]);
    // Edges in contact with a front face ask the back faces, so none is left out unseen.
    let contact = VisibilityOptions { contact_tolerance: 1e-9, ..VISIBLE_ONLY };
    assert_eq!(counted(&cube, &aside, &contact), [6, 0]);
    // Where bodies are not looked for, all faces are tested.
    let mut soup = PolygonSoup::default();
    add(&mut soup, &points, &BOX);
    let shell = Scene::new(Mesh::new(soup).unwrap().0);
    let [all, saved] = [&shell, &cube].map(|s| checked("", s, &aside, &contact).candidate_pairs);
    assert!(4 * saved <= 3 * all, "{saved} of {all} pairs");
    // From inside, the near plane cuts the body.
    let inside = Camera::new(DVec3::ZERO, dvec3(0.3, 1.0, 0.2), DVec3::Z, PERSPECTIVE).unwrap();
    assert_eq!(counted(&cube, &inside, &VISIBLE_ONLY), [0, 0]);

    // Open, wound inward, wound inconsistently.
    assert_eq!(counted(&with(&[(&points, &BOX[1..])]), &aside, &VISIBLE_ONLY), [0, 0]);
    assert_eq!(counted(&with(&[(&points, &inward)]), &aside, &VISIBLE_ONLY), [0, 0]);
    let mut mixed = BOX.to_vec();
    mixed[2] = inward[2];
    assert_eq!(counted(&with(&[(&points, &mixed)]), &aside, &VISIBLE_ONLY), [0, 0]);

    // Each body by itself, whether they nest, cross, or lie flush; a hollow keeps all its faces.
    let small = corners(dvec3(-0.5, -0.5, -0.5), dvec3(1.0, 1.0, 1.0));
    let across = corners(dvec3(-3.0, -0.25, -0.5), dvec3(6.0, 0.75, 0.5));
    let flush = corners(dvec3(1.0, -0.5, -0.25), dvec3(1.0, 1.0, 0.5));
    for (second, faces, expected) in [
        (&small, &BOX[..], [12, 6]),
        (&small, &inward, [6, 3]),
        (&across, &BOX, [12, 6]),
        (&flush, &BOX, [12, 6]),
    ] {
        let two = with(&[(&points, &BOX), (second, faces)]);
        assert_eq!(counted(&two, &aside, &VISIBLE_ONLY), expected);
        assert_eq!(counted(&two, &near, &VISIBLE_ONLY), expected);
    }
    // Two boxes with one edge in common are one surface, and that is not closed.
    let beside = corners(dvec3(1.0, 1.0, -1.0), dvec3(2.0, 2.0, 2.0));
    let joined = with(&[(&points, &BOX), (&beside, &BOX)]);
    assert_eq!(counted(&joined, &aside, &VISIBLE_ONLY), [0, 0]);
    // With one vertex in common they are two.
    let beyond = corners(dvec3(1.0, 1.0, 1.0), dvec3(2.0, 2.0, 2.0));
    let joined = with(&[(&points, &BOX), (&beyond, &BOX)]);
    assert_eq!(counted(&joined, &aside, &VISIBLE_ONLY), [12, 6]);
}

#[test]
fn a_box_of_many_coplanar_triangles_is_a_body() {
    // Each side of the box a grid: triangles that only share a vertex are no contact.
    let n = 3;
    let mut soup = PolygonSoup::default();
    for face in BOX {
        let unit = corners(DVec3::ZERO, DVec3::ONE);
        let [a, b, _, d] = [0, 1, 2, 3].map(|i| unit[face[i] as usize]);
        let at = |i: u32, j: u32| {
            a + (b - a) * (f64::from(i) / f64::from(n)) + (d - a) * (f64::from(j) / f64::from(n))
        };
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            let split: [&[u32]; 2] = match (i + j) % 2 {
                0 => [&[0, 1, 2], &[0, 2, 3]],
                _ => [&[0, 1, 3], &[1, 2, 3]],
            };
            // Corners at thirds agree: they are computed alike from either side.
            add(&mut soup, &quad.map(|p| (p * 12.0).round()), &split);
        }
    }
    let scene = scene(soup);
    let camera = looking(dvec3(50.0, -70.0, 40.0), Projection::Orthographic);
    let (n, n_faces) = (u64::from(n), 3 * 2 * u64::from(n * n));
    // On each square inner grid lines and diagonals, and the lines where two squares meet.
    let n_edges = 3 * (2 * n * (n - 1) + n * n) + 3 * n;
    assert_eq!(counted(&scene, &camera, &VISIBLE_ONLY), [n_faces, n_edges]);
}

#[test]
fn an_edge_that_touches_the_wall_of_its_own_body_shows() {
    // Seen from the front, two humps behind a wall; the valley between them touches the wall.
    let wall = [(-2.0, 0.0), (2.0, 0.0), (2.0, 4.0), (-2.0, 4.0)];
    let humps = [(-1.0, 1.0), (-1.0, 3.0), (1.0, 1.0), (1.0, 3.0)];
    let flat = |height: f64| move |&(x, z): &(f64, f64)| dvec3(x, height, z);
    for valley in [0.0, 0.5] {
        let mut points: Vec<DVec3> = wall.iter().map(flat(0.0)).collect();
        points.extend(humps.iter().map(flat(2.0)));
        points.extend([(0.0, 1.25), (0.0, 2.75)].iter().map(flat(valley)));
        let faces: [&[u32]; 14] = [
            &[0, 1, 2, 3],
            &[0, 5, 4],
            &[0, 3, 5],
            &[4, 5, 9],
            &[4, 9, 8],
            &[8, 9, 7],
            &[8, 7, 6],
            &[6, 7, 2],
            &[6, 2, 1],
            &[0, 4, 8],
            &[0, 8, 1],
            &[1, 8, 6],
            &[3, 9, 5],
            &[3, 2, 9],
        ];
        let mut soup = PolygonSoup::default();
        add(&mut soup, &points, &faces);
        add(&mut soup, &points, &[&[2, 7, 9]]);
        let scene = scene(soup);
        let camera = looking(dvec3(0.0, -9.0, 2.0), PERSPECTIVE);
        let counts = checked("valley", &scene, &camera, &VISIBLE_ONLY);
        assert_eq!(counts.back_faces > 0, valley > 0.0);
    }
}

/// A random closed surface: two tips over a closed path. It may be wound inward, cross itself, touch
/// itself, and have faces without area.
fn add_spindle(soup: &mut PolygonSoup, rng: &mut Rng, scale: f64, offset: DVec3) {
    let n = 3 + rng.below(3) as u32;
    let mut points: Vec<DVec3> = (0..n + 2)
        .map(|_| scale * dvec3(rng.integer(-3, 3), rng.integer(-3, 3), rng.integer(-3, 3)) + offset)
        .collect();
    if rng.one_in(2) {
        // Mostly without crossings: around the middle, with the tips above and below.
        for i in 0..n {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
            let around = dvec3(angle.cos(), angle.sin(), 0.0).round() * 3.0;
            points[i as usize] += scale * around;
        }
        points[n as usize].z += 3.0 * scale;
        points[n as usize + 1].z -= 3.0 * scale;
    }
    let first = soup.positions.len() as u32;
    soup.positions.extend_from_slice(&points);
    let is_open = rng.one_in(12);
    for i in 0..n {
        let (a, b) = (first + i, first + (i + 1) % n);
        soup.push_face(&[a, b, first + n]);
        if i > 0 || !is_open {
            soup.push_face(&[b, a, first + n + 1]);
        }
    }
}

#[test]
fn what_is_left_out_changes_nothing() {
    let (mut n_left_out, mut n_waiting, n_scenes) = (0, 0, number_of_scenes(600));
    for seed in 0..n_scenes {
        let mut rng = Rng(seed);
        // Small integers coincide often; other numbers never do.
        let scale = rng.pick(&[1.0, 1.0, 0.3 + f64::EPSILON]);
        let mut soup = PolygonSoup::default();
        for _ in 0..1 + rng.below(3) {
            let offset = dvec3(rng.integer(-2, 2), rng.integer(-2, 2), rng.integer(-2, 2));
            add_spindle(&mut soup, &mut rng, scale, offset);
        }
        if rng.one_in(3) {
            let low = dvec3(rng.integer(-4, 2), rng.integer(-4, 2), rng.integer(-4, 2));
            let size = dvec3(rng.integer(1, 4), rng.integer(1, 4), rng.integer(1, 4));
            add(&mut soup, &corners(low, size), &BOX);
        }
        let scene = scene(soup);
        let from = dvec3(rng.integer(-9, 9), -rng.integer(5, 30), rng.integer(-9, 9));
        let camera = looking(from, rng.pick(&[Projection::Orthographic, PERSPECTIVE]));
        let name = format!("seed {seed}");
        let counts = checked(&name, &scene, &camera, &VISIBLE_ONLY);
        n_left_out += u64::from(counts.back_edges > 0);
        let options = VisibilityOptions {
            contact_tolerance: scale * rng.pick(&[0.0, 1e-9, 0.3, 1.0, 2.5]),
            find_doubled: rng.one_in(2),
            ..VISIBLE_ONLY
        };
        let counts = checked(&format!("{name}, {options:?}"), &scene, &camera, &options);
        n_waiting += u64::from(counts.back_faces > 0);
    }
    eprintln!("edges left out in {n_left_out}, faces in {n_waiting} of {n_scenes} scenes");
    assert!(n_left_out > n_scenes / 4 && n_waiting > n_scenes / 4);
}

#[test]
fn edges_in_a_flat_pleat_show() {
    // A box whose top goes in, out again and in again, all in one plane:
    // from 3 to 1, back to 2, and from there to the middle.
    let mut points = corners(dvec3(-3.0, -3.0, -3.0), dvec3(6.0, 6.0, 6.0));
    for reach in [1.0, 2.0] {
        let ring = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        points.extend(ring.map(|(x, y)| dvec3(reach * x, reach * y, 3.0)));
    }
    let mut faces: Vec<Vec<u32>> =
        BOX.iter().filter(|face| **face != BOX[1]).map(|face| face.to_vec()).collect();
    for [outer, inner] in [[[4, 5, 7, 6], [8, 9, 10, 11]], [[8, 9, 10, 11], [12, 13, 14, 15]]] {
        for (i, k) in [(0, 1), (1, 2), (2, 3), (3, 0)] {
            faces.push(vec![outer[i], outer[k], inner[k]]);
            faces.push(vec![outer[i], inner[k], inner[i]]);
        }
    }
    faces.push(vec![12, 13, 14, 15]);
    let faces: Vec<&[u32]> = faces.iter().map(Vec::as_slice).collect();
    let mut soup = PolygonSoup::default();
    add(&mut soup, &points, &faces);
    let camera = looking(dvec3(5.0, -7.0, 9.0), PERSPECTIVE);
    assert_eq!(counted(&scene(soup), &camera, &VISIBLE_ONLY), [0, 0]);
}
