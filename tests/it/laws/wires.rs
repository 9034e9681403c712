//! Lines that border no face: wires of the model, and segments that only a view has.

use crate::laws::engines::{camera, mesh};
use crate::oracle::compare::{EngineEdge, EngineSpan, compare, truth_of};
use crate::scenes::{Rng, Scene as TestScene, number_of_scenes, random};
use glam::{DVec2, DVec3, dvec2, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::classify::{LineSelection, ViewSegments, ViewedScene};
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::engines::edge::{LineEngine, VisibilityOptions, solve};
use hiddenline::stages::engines::surface::tin;
use hiddenline::stages::model::arrange::{Arrangement, Pose};
use hiddenline::stages::model::mesh::{Mesh, MeshError, PolygonSoup};
use hiddenline::stages::model::scene::{LineSource, Scene};
use hiddenline::stages::strokes::StrokeKind;

const WIRES: LineSelection = LineSelection::NONE.with(StrokeKind::Wire);

const ENGINES: [LineEngine; 3] = [LineEngine::Roberts, LineEngine::Appel, LineEngine::AllPairs];

const COUNTED: VisibilityOptions =
    VisibilityOptions { count_layers: true, ..VisibilityOptions::EXACT };

/// The scene's mesh as soup.
fn soup(scene: &TestScene) -> PolygonSoup {
    let positions = scene.positions.iter().map(|&p| DVec3::from(p)).collect();
    let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
    scene.faces.iter().for_each(|face| soup.push_face(face));
    soup
}

/// The spans of all wires.
fn spans_of_wires(scene: &Scene, camera: &Camera, engine: LineEngine) -> Vec<EngineEdge> {
    let view = ViewedScene::new(scene, camera, WIRES, 30.0);
    let (visibility, ..) = solve(&view, engine, &COUNTED);
    let span = |i: usize| {
        let spans = visibility.spans(i).iter();
        spans.map(|s| EngineSpan { t0: s.t0, t1: s.t1, qi: s.qi }).collect()
    };
    let position = |point: u32| scene.points()[point as usize].to_array();
    let drawn = view.selected().iter().enumerate();
    drawn
        .map(|(i, drawn)| EngineEdge { ends: view.line(drawn.edge).map(position), spans: span(i) })
        .collect()
}

/// A wire is hidden as the edge of a face without area is, which hides nothing either.
#[test]
fn wires_are_hidden_as_the_truth_says() {
    let (mut n_wires, mut n_parts) = (0, 0);
    for seed in 0..number_of_scenes(150) {
        let scene = random(seed);
        if scene.is_in_tenths {
            continue;
        }
        let mut rng = Rng(seed ^ 0x51ab);
        let (mut with_faces, mut soup) = (scene.clone(), soup(&scene));
        let corners = scene.positions.len();
        for _ in 0..4 {
            // Between vertices of the model, or loose on the lattice; its middle is on the lattice too.
            let middle = rng.point(-4, 4);
            let end =
                if rng.one_in(3) { scene.positions[rng.below(corners)] } else { rng.point(-6, 6) };
            let other = [0, 1, 2].map(|k| 2.0 * middle[k] - end[k]);
            if end == other {
                continue;
            }
            let first = with_faces.positions.len() as u32;
            with_faces.positions.extend([end, middle, other]);
            with_faces.faces.push(vec![first, first + 1, first + 2]);
            let first = soup.positions.len() as u32;
            soup.positions.extend([DVec3::from(end), DVec3::from(other)]);
            soup.push_wire(&[first, first + 1]);
        }
        let built = Scene::new(Mesh::new(soup).unwrap().0);
        let Some(truth) = truth_of(&with_faces) else { continue };
        let ends = |wire: &[u32; 2]| {
            let ends = wire.map(|v| built.mesh().positions()[v as usize].to_array());
            if ends[0] < ends[1] { ends } else { [ends[1], ends[0]] }
        };
        let wires: Vec<_> = built.mesh().wires().iter().map(ends).collect();
        let truth: Vec<_> = truth.into_iter().filter(|edge| wires.contains(&edge.ends)).collect();
        for engine in ENGINES {
            let found = spans_of_wires(&built, &camera(&scene), engine);
            if let Err(problem) = compare(&scene.sight, &truth, &found) {
                panic!("{}, {engine:?}: {problem}", scene.name);
            }
            n_parts += found.iter().map(|wire| wire.spans.len()).sum::<usize>();
            n_wires += found.len();
        }
    }
    assert!(n_wires > 900 && n_parts > n_wires + 200, "{n_wires} wires in {n_parts} parts");
}

#[test]
fn wires_hide_nothing_and_leave_edges_as_they_are() {
    for seed in 0..number_of_scenes(60) {
        let scene = random(seed);
        let plain = Scene::new(mesh(&scene));
        let mut soup = soup(&scene);
        let n = soup.positions.len() as u32;
        (1..n).for_each(|end| soup.push_wire(&[0, end]));
        let wired = Scene::new(Mesh::new(soup).unwrap().0);
        let lines = LineSelection::all_edges();
        for engine in ENGINES {
            let spans = |scene_: &Scene| {
                let view = ViewedScene::new(scene_, &camera(&scene), lines, 30.0);
                let visibility = solve(&view, engine, &COUNTED).0;
                (0..visibility.len()).map(|i| visibility.spans(i).to_vec()).collect::<Vec<_>>()
            };
            assert_eq!(spans(&plain), spans(&wired), "{}, {engine:?}", scene.name);
        }
    }
}

/// A square in front of a wire that runs on to both sides, and a wire before it.
fn square_and_wires() -> Scene {
    let positions = [
        [-1.0, 0.0, -1.0],
        [1.0, 0.0, -1.0],
        [1.0, 0.0, 1.0],
        [-1.0, 0.0, 1.0],
        [-2.0, 2.0, 0.0],
        [2.0, 2.0, 0.0],
        [2.0, 2.0, 2.0],
        [-0.5, -1.0, 0.5],
        [0.5, -1.0, 0.5],
    ]
    .map(DVec3::from_array)
    .to_vec();
    let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
    soup.push_face(&[0, 1, 2, 3]);
    soup.push_wire(&[4, 5, 6]);
    soup.push_wire(&[7, 8]);
    Scene::new(Mesh::new(soup).unwrap().0)
}

fn front() -> Camera {
    Camera::new(dvec3(0.0, -9.0, 0.0), DVec3::ZERO, DVec3::Z, Projection::Orthographic).unwrap()
}

#[test]
fn a_wire_behind_a_square_is_drawn_beside_it_and_joined_at_its_corner() {
    let scene = square_and_wires();
    let drawing = draw(&scene, &front(), &DrawOptions::default(), 100.0).drawing;
    let wires: Vec<Vec<DVec2>> = drawing
        .iter()
        .filter(|stroke| stroke.kind == StrokeKind::Wire)
        .map(|stroke| stroke.points.to_vec())
        .collect();
    let expected = [
        vec![dvec2(-2.0, 0.0), dvec2(-1.0, 0.0)],
        vec![dvec2(1.0, 0.0), dvec2(2.0, 0.0), dvec2(2.0, 2.0)],
        vec![dvec2(-0.5, 0.5), dvec2(0.5, 0.5)],
    ];
    assert_eq!(wires, expected);
    let lines = LineSelection::all_edges();
    let drawing = draw(&scene, &front(), &DrawOptions { lines, ..Default::default() }, 100.0);
    assert!(drawing.drawing.iter().all(|stroke| stroke.kind != StrokeKind::Wire));
    assert_eq!(scene.source(3), None);
    assert_eq!(scene.source(4), Some(LineSource::Wire(0)));
    // The page is fitted to the wires, too.
    assert_eq!(scene.extent(&front()).corners(), Some((dvec2(-2.0, -1.0), dvec2(2.0, 2.0))));
}

#[test]
fn a_model_may_be_nothing_but_wires() {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Z];
    let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
    soup.push_wire(&[0, 1, 2]);
    let scene = Scene::new(Mesh::new(soup).unwrap().0);
    for engine in ENGINES {
        let options = DrawOptions { engine, ..DrawOptions::default() };
        let drawing = draw(&scene, &front(), &options, 1000.0).drawing;
        let strokes: Vec<_> = drawing.iter().map(|stroke| (stroke.kind, stroke.qi)).collect();
        assert_eq!(strokes, [(StrokeKind::Wire, 0)], "{engine:?}");
    }
}

#[test]
fn meshes_keep_each_wire_once_and_refuse_vertices_that_are_not_there() {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::ZERO, DVec3::Y, DVec3::Z];
    let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
    soup.push_wire(&[0, 1, 2]);
    soup.push_wire(&[0, 2]);
    soup.push_wire(&[4, 0]);
    let (mesh, repairs) = Mesh::new(soup.clone()).unwrap();
    assert_eq!(mesh.wires(), [[0, 1], [2, 0]]);
    assert_eq!(mesh.positions(), [DVec3::ZERO, DVec3::X, DVec3::Z]);
    let counts = (repairs.dropped_wires, repairs.unused_vertices, repairs.welded_vertices);
    assert_eq!(counts, (2, 1, 1));
    // Moved models keep theirs.
    let pose = Pose { move_by: DVec3::Y, ..Pose::default() };
    let models = vec![(mesh.clone(), Pose::default()), (mesh, pose)];
    let (both, _) = Arrangement::default().arrange(models).unwrap();
    assert_eq!(both.wires(), [[0, 1], [2, 0], [3, 4], [5, 3]]);
    assert_eq!(both.positions()[3], DVec3::Y);
    soup.push_wire(&[1, 5]);
    let error = MeshError::MissingWireVertex { wire: 4, vertex: 5, n_vertices: 5 };
    assert_eq!(Mesh::new(soup), Err(error));
}

#[test]
fn an_engine_for_triangulated_surfaces_leaves_wires_to_others() {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
    soup.push_face(&[0, 1, 2]);
    soup.push_wire(&[0, 3]);
    let scene = Scene::new(Mesh::new(soup).unwrap().0);
    let eye = dvec3(3.0, -9.0, 5.0);
    let camera = Camera::new(eye, DVec3::ZERO, DVec3::Z, Projection::Orthographic).unwrap();
    let all = LineSelection::all_edges();
    assert!(tin::solve(&ViewedScene::new(&scene, &camera, all, 30.0)).is_some());
    let wired = all.with(StrokeKind::Wire);
    assert!(tin::solve(&ViewedScene::new(&scene, &camera, wired, 30.0)).is_none());
}

/// Lines of intersection are found once for the scene. Given to the view instead, ends and all, they
/// are hidden alike.
#[test]
fn segments_of_a_view_are_hidden_as_lines_of_the_scene_are() {
    let mut n_segments = 0;
    for seed in 0..number_of_scenes(150) {
        let scene = random(seed);
        let plain = Scene::new(mesh(&scene));
        let crossed = plain.clone().with_intersections();
        let mut segments = ViewSegments::new(&plain);
        for point in crossed.intersections().points() {
            segments.push_point(point.clone());
        }
        for line in crossed.intersections().lines() {
            segments.push(line.ends, StrokeKind::Hatch);
        }
        let lines = LineSelection::NONE;
        for engine in ENGINES {
            let camera = camera(&scene);
            let of_view = ViewedScene::with_segments(&plain, &camera, lines, 30.0, &segments);
            let crossings = lines.with(StrokeKind::Intersection);
            let of_scene = ViewedScene::new(&crossed, &camera, crossings, 30.0);
            let spans = |view: &ViewedScene| {
                let visibility = solve(view, engine, &COUNTED).0;
                let line =
                    |i: usize| (view.line(view.selected()[i].edge), visibility.spans(i).to_vec());
                (0..visibility.len()).map(line).collect::<Vec<_>>()
            };
            let found = spans(&of_view);
            assert_eq!(found, spans(&of_scene), "{}, {engine:?}", scene.name);
            n_segments += found.len();
        }
    }
    assert!(n_segments > 300, "{n_segments}");
}
