//! What a pen draws: chains, lines drawn once, contact, and short strokes.

use glam::{DMat3, DVec2, DVec3, dvec2, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::classify::{LineSelection, ViewedScene};
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::engines::edge::{LineEngine, VisibilityOptions, solve};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::predicates::Sign;
use hiddenline::stages::strokes::{HiddenLines, Strokes};

const BOX_FACES: [[u32; 4]; 6] =
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

/// Adds a box with opposite corners `low` and `high`, each corner moved by `place`.
fn add_box(soup: &mut PolygonSoup, low: DVec3, high: DVec3, place: impl Fn(DVec3) -> DVec3) {
    let first = soup.positions.len() as u32;
    for i in 0..8 {
        let pick = |bit: u32, low: f64, high: f64| if i >> bit & 1 == 0 { low } else { high };
        soup.positions.push(place(dvec3(
            pick(0, low.x, high.x),
            pick(1, low.y, high.y),
            pick(2, low.z, high.z),
        )));
    }
    for face in BOX_FACES {
        soup.push_face(&face.map(|corner| first + corner));
    }
}

fn scene(soup: PolygonSoup) -> Scene {
    Scene::new(Mesh::new(soup).unwrap().0)
}

fn unit_cube() -> Scene {
    let mut soup = PolygonSoup::default();
    add_box(&mut soup, DVec3::ZERO, DVec3::ONE, |p| p);
    scene(soup)
}

fn orthographic(eye: DVec3, up: DVec3) -> Camera {
    Camera::new(eye, DVec3::ZERO, up, Projection::Orthographic).unwrap()
}

fn drawn(scene: &Scene, camera: &Camera, options: &DrawOptions) -> Strokes {
    draw(scene, camera, options, 100.0).drawing
}

fn length(points: &[DVec2]) -> f64 {
    points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

#[test]
fn a_cube_seen_face_on_is_one_closed_square_drawn_once() {
    let camera = orthographic(dvec3(0.0, 0.0, 5.0), DVec3::Y);
    let drawing = drawn(&unit_cube(), &camera, &DrawOptions::default());
    let strokes: Vec<_> = drawing.iter().collect();
    assert_eq!(strokes.len(), 1);
    let points = strokes[0].points;
    assert_eq!((points.len(), points[0]), (5, points[4]));
    assert_eq!(length(points), 4.0);
}

#[test]
fn half_of_the_vertices_of_odd_degree_is_the_number_of_open_chains() {
    // Nine edges are visible; three meet at the near corner and at each of its neighbors.
    let camera = orthographic(dvec3(3.0, 4.0, 5.0), DVec3::Z);
    let drawing = drawn(&unit_cube(), &camera, &DrawOptions::default());
    let is_open = |points: &[DVec2]| points.first() != points.last();
    assert_eq!(drawing.iter().filter(|stroke| is_open(stroke.points)).count(), 2);
    assert_eq!(drawing.iter().map(|stroke| stroke.points.len() - 1).sum::<usize>(), 9);
}

#[test]
fn chains_go_straight_on_where_lines_cross() {
    // Four squares around the origin of one plane: their sides make a cross with arms of one.
    let mut soup = PolygonSoup::default();
    for (x, y) in [(0.0, 0.0), (-1.0, 0.0), (-1.0, -1.0), (0.0, -1.0)] {
        let first = soup.positions.len() as u32;
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            soup.positions.push(dvec3(x + dx, y + dy, 0.0));
        }
        soup.push_face(&[first, first + 1, first + 2, first + 3]);
    }
    let camera = orthographic(dvec3(0.0, 0.0, 5.0), DVec3::Y);
    let options = DrawOptions { lines: LineSelection::all_edges(), ..Default::default() };
    let drawing = drawn(&scene(soup), &camera, &options);
    let through_center =
        drawing.iter().filter(|s| s.points[1..s.points.len() - 1].contains(&DVec2::ZERO));
    for stroke in through_center {
        let at = stroke.points.iter().position(|&p| p == DVec2::ZERO).unwrap();
        assert_eq!(stroke.points[at - 1], -stroke.points[at + 1]);
    }
    assert!((drawing.iter().map(|s| length(s.points)).sum::<f64>() - 12.0).abs() < 1e-12);
}

#[test]
fn a_convex_solid_shows_the_edges_of_its_front_faces_whole() {
    // Roberts' first step solves a single convex solid alone: engines must add nothing to it.
    for eye in [dvec3(3.0, 4.0, 5.0), dvec3(5.0, 0.25, 0.5), dvec3(-3.0, 0.5, 0.5)] {
        let projection = Projection::Perspective { fov_deg: 30.0, near: 1e-6 };
        let camera = Camera::new(eye, DVec3::splat(0.5), DVec3::Z, projection).unwrap();
        let scene = unit_cube();
        let view = ViewedScene::new(&scene, &camera, LineSelection::all_edges(), 30.0);
        let (visibility, ..) = solve(&view, LineEngine::Roberts, &VisibilityOptions::default());
        for (i, drawn) in view.selected().iter().enumerate() {
            let uses = scene.topology().uses(drawn.edge);
            let in_front = uses.iter().any(|u| view.facing(u.face()) == Sign::Positive);
            let spans: Vec<_> =
                visibility.spans(i).iter().map(|s| (s.t0, s.t1, s.qi == 0)).collect();
            assert_eq!(spans, [(0.0, 1.0, in_front)]);
        }
    }
}

/// A box on a table, both turned together so that no coordinate is a round number, and rounded to
/// single precision as in a model file: they touch only nearly.
fn box_on_a_turned_table() -> Scene {
    let turn = DMat3::from_rotation_z(0.3) * DMat3::from_rotation_x(0.7);
    let place = |p: DVec3| (turn * p).as_vec3().as_dvec3();
    let mut soup = PolygonSoup::default();
    add_box(&mut soup, dvec3(-3.0, -3.0, -0.3), dvec3(3.0, 3.0, 0.0), place);
    add_box(&mut soup, dvec3(-1.1, -0.9, 0.0), dvec3(0.8, 1.3, 1.7), place);
    scene(soup)
}

#[test]
fn a_box_on_a_turned_table_keeps_its_bottom_edges() {
    let scene = box_on_a_turned_table();
    let turn = DMat3::from_rotation_z(0.3) * DMat3::from_rotation_x(0.7);
    let camera = orthographic(turn * dvec3(4.0, -7.0, 5.0), turn * DVec3::Z);
    let drawing = drawn(&scene, &camera, &DrawOptions::default());
    let image = |p: DVec3| camera.image(turn * p);
    // The two bottom edges toward the eye, in the middle of each.
    for middle in [dvec3(-0.15, -0.9, 0.0), dvec3(0.8, 0.2, 0.0)] {
        let point = image(middle);
        let on_stroke = drawing.iter().any(|stroke| {
            stroke.points.windows(2).any(|pair| {
                let (a, b) = (pair[0], pair[1]);
                (point.distance(a) + point.distance(b) - a.distance(b)).abs() < 1e-6
            })
        });
        assert!(on_stroke, "the bottom edge through {middle} is missing");
    }
}

#[test]
fn exact_drawings_have_a_stroke_for_each_visible_interval() {
    let camera = orthographic(dvec3(0.0, 0.0, 5.0), DVec3::Y);
    let options = DrawOptions { exact: true, ..Default::default() };
    let drawing = drawn(&unit_cube(), &camera, &options);
    // Front and back square coincide; neither is dropped, and nothing is joined.
    assert_eq!((drawing.len(), drawing.n_points()), (8, 16));
}

#[test]
fn hidden_lines_are_kept_when_asked_for() {
    let camera = orthographic(dvec3(3.0, 4.0, 5.0), DVec3::Z);
    let options = DrawOptions { hidden: HiddenLines::Solid, ..Default::default() };
    let drawing = drawn(&unit_cube(), &camera, &options);
    let hidden: f64 = drawing.iter().filter(|s| s.qi > 0).map(|s| length(s.points)).sum();
    let d = dvec3(3.0, 4.0, 5.0).normalize();
    let expected: f64 = d.to_array().iter().map(|x| (1.0 - x * x).sqrt()).sum();
    assert!((hidden - expected).abs() < 1e-12);
}

#[test]
fn strokes_shorter_than_the_shortest_are_dropped_and_long_chains_of_short_edges_are_not() {
    // A disc with a border of short edges, and far from it a tiny triangle.
    let mut soup = PolygonSoup::default();
    for i in 0..64 {
        let angle = f64::from(i) * std::f64::consts::TAU / 64.0;
        soup.positions.push(dvec3(angle.cos(), angle.sin(), 0.0));
    }
    soup.push_face(&(0..64).collect::<Vec<_>>());
    for (x, y) in [(2.0, 0.0), (2.01, 0.0), (2.0, 0.01)] {
        soup.positions.push(dvec3(x, y, 0.0));
    }
    soup.push_face(&[64, 65, 66]);
    let camera = orthographic(dvec3(0.0, 0.0, 5.0), DVec3::Y);
    // At 100 mm a unit the border's edges are 10 mm long, the triangle 3.4 mm around.
    let options = DrawOptions { shortest_stroke_mm: 20.0, ..Default::default() };
    let drawing = drawn(&scene(soup), &camera, &options);
    assert_eq!(drawing.len(), 1);
    assert_eq!(drawing.n_points(), 65);
    assert!(drawing.bounds().unwrap().1.distance(dvec2(1.0, 1.0)) < 1e-12);
}
