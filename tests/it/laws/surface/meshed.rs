//! Surfaces by the mesh engines: against Max-Min, the exact truth and closed forms.

use std::collections::HashMap;

use glam::{DVec3, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::classify::ViewedScene;
use hiddenline::stages::engines::edge::{LineEngine, VisibilityOptions, solve};
use hiddenline::stages::engines::surface::{CellOrder, max_min};
use hiddenline::stages::strokes::StrokeKind;
use hiddenline::stages::surface::{
    Grid, LatticeLines, LinedMesh, LinedScene, close_seams, delaunay, evenly,
};

use super::brute::difference;
use super::max_min::{Dice, PERSPECTIVE, camera, coordinate, intervals, rough};
use crate::oracle::{Settings as TruthSettings, Sight, truth};

const BOTH: LatticeLines =
    LatticeLines { along_rows: true, along_columns: true, every: 1, triangles: false };

type Visible = HashMap<[[u64; 3]; 2], Vec<(f64, f64)>>;

/// Names an edge by its ends, and turns ranges to run from the smaller end.
fn named([a, b]: [DVec3; 2], ranges: &[(f64, f64)]) -> ([[u64; 3]; 2], Vec<(f64, f64)>) {
    let bits = |p: DVec3| (p + 0.0).to_array().map(f64::to_bits);
    if a.to_array() < b.to_array() {
        ([bits(a), bits(b)], ranges.to_vec())
    } else {
        ([bits(b), bits(a)], ranges.iter().rev().map(|(from, to)| (1.0 - to, 1.0 - from)).collect())
    }
}

fn solved(surface: &LinedScene, camera: &Camera) -> Visible {
    let view = ViewedScene::with_edges(&surface.scene, camera, surface.lines.clone());
    let (visibility, _, _) = solve(&view, LineEngine::Roberts, &VisibilityOptions::default());
    let position = |v: u32| surface.scene.mesh().positions()[v as usize];
    view.selected()
        .iter()
        .enumerate()
        .map(|(k, drawn)| {
            let spans = visibility.spans(k).iter().filter(|span| span.qi == 0);
            let ranges: Vec<(f64, f64)> = spans.map(|span| (span.t0, span.t1)).collect();
            named(surface.scene.topology().edge(drawn.edge).map(position), &ranges)
        })
        .collect()
}

fn lined(grid: &Grid) -> LinedScene {
    let mut mesh = LinedMesh::default();
    mesh.push_grid(grid, &BOTH);
    mesh.into_scene().expect("a scene")
}

#[test]
fn a_mesh_engine_draws_what_max_min_draws() {
    let mut dice = Dice(23);
    let mut compared = 0;
    for round in 0..180 {
        let (kind, region) = (round % 5, round / 5 % 9);
        let (nx, ny) = (2 + dice.roll(7) as usize, 2 + dice.roll(7) as usize);
        let grid = rough(&mut dice, kind, nx, ny);
        let z = (dice.roll(160) as f64 - 80.0) / 4.0;
        let (x, y) = (
            coordinate(&mut dice, region % 3, grid.xs()),
            coordinate(&mut dice, region / 3, grid.ys()),
        );
        let eye = dvec3(x, y, z);
        let target = dvec3(nx as f64, ny as f64, -40.0);
        let projection = if round % 4 == 3 { Projection::Orthographic } else { PERSPECTIVE };
        if eye == target {
            continue;
        }
        let camera = camera(eye, target, projection);
        let Ok(pieces) = max_min::solve(&grid, &camera, CellOrder::Rows) else {
            continue;
        };
        let surface = lined(&grid);
        let positions = surface.scene.mesh().positions();
        let near = |p: &DVec3| (*p - eye).dot(camera.forward()) <= 1e-5;
        if projection != Projection::Orthographic && positions.iter().any(near) {
            continue; // The mesh engine leaves out what lies behind the eye.
        }
        let by_mesh = solved(&surface, &camera);
        for (edge, ranges) in intervals(&pieces).iter().enumerate() {
            let ends = grid.ends(edge as u32).map(|k| grid.point(k));
            let (name, expected) = named(ends, ranges);
            // Edges seen end-on are no part of a drawing.
            let Some(got) = by_mesh.get(&name) else { continue };
            compared += 1;
            assert!(
                difference(got, &expected) < 1e-9,
                "round {round}, {ends:?} of {grid:?} from {camera:?}: {got:?}, not {expected:?}"
            );
        }
    }
    assert!(compared > 2000, "{compared}");
}

fn equals_the_truth(surface: &LinedScene, camera: &Camera, name: &str) -> usize {
    let mesh = surface.scene.mesh();
    let positions: Vec<[f64; 3]> = mesh.positions().iter().map(DVec3::to_array).collect();
    let faces: Vec<Vec<u32>> =
        (0..mesh.n_faces() as u32).map(|face| mesh.face(face).to_vec()).collect();
    let sight = Sight {
        eye: camera.eye().to_array(),
        target: camera.target().to_array(),
        up: camera.up().to_array(),
        near: match camera.projection() {
            Projection::Perspective { near, .. } => Some(near),
            Projection::Orthographic => None,
        },
    };
    let by_mesh = solved(surface, camera);
    let mut compared = 0;
    let edges = truth(&positions, &faces, &sight, TruthSettings::default()).expect("a truth");
    for edge in edges {
        let expected: Vec<(f64, f64)> = edge
            .pieces
            .iter()
            .filter(|piece| piece.qi == 0)
            .map(|piece| (piece.t0.to_f64(), piece.t1.to_f64()))
            .collect();
        let (key, expected) = named(edge.ends.map(DVec3::from), &expected);
        let Some(got) = by_mesh.get(&key) else { continue };
        compared += 1;
        assert!(difference(got, &expected) < 1e-9, "{name}: {got:?}, not {expected:?}");
    }
    compared
}

#[test]
fn surfaces_with_holes_show_what_lies_behind_the_hole() {
    let mut dice = Dice(5);
    let mut compared = 0;
    for round in 0..40 {
        let grid = rough(&mut dice, round % 5, 5, 5);
        let mut heights = grid.zs().to_vec();
        for _ in 0..3 {
            heights[dice.roll(25) as usize] = f64::NAN;
        }
        let grid = Grid::new(grid.xs().to_vec(), grid.ys().to_vec(), heights).expect("a grid");
        let eye = dvec3(-3.0, -4.0 - dice.roll(5) as f64, 1.0 + dice.roll(12) as f64);
        let camera = camera(eye, dvec3(4.0, 4.0, 0.0), PERSPECTIVE);
        compared += equals_the_truth(&lined(&grid), &camera, &format!("round {round}"));
    }
    assert!(compared > 500, "{compared}");
}

#[test]
fn level_curves_and_scattered_points_equal_the_truth() {
    let mut dice = Dice(77);
    for round in 0..12 {
        let mut mesh = LinedMesh::default();
        if round % 2 == 0 {
            mesh.push_grid(&rough(&mut dice, round % 5, 4, 4), &BOTH);
        } else {
            let mut points: Vec<DVec3> = (0..14)
                .map(|_| dvec3(dice.roll(32) as f64, dice.roll(32) as f64, dice.roll(9) as f64))
                .collect();
            points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
            points.dedup_by(|a, b| a.x == b.x && a.y == b.y);
            let triangles = delaunay(&points).expect("triangles");
            mesh.push_triangles(&points, &triangles, true);
        }
        mesh.add_levels(&[-3.0, 0.3, 1.0, 2.5]);
        let surface = mesh.into_scene().expect("a scene");
        let positions = surface.scene.mesh().positions();
        for line in surface.lines.iter().filter(|line| line.kind == StrokeKind::Level) {
            let [a, b] = surface.scene.topology().edge(line.edge).map(|v| positions[v as usize].z);
            assert!(a == b && [-3.0, 0.3, 1.0, 2.5].contains(&a), "{a} {b}");
        }
        let camera = camera(dvec3(-9.0, -15.0, 14.0), dvec3(4.0, 4.0, 0.0), PERSPECTIVE);
        assert!(equals_the_truth(&surface, &camera, &format!("round {round}")) > 20);
    }
}

/// The level z = c of a cone of height 1 and radius 1 is a circle of radius 1 − c.
#[test]
fn levels_of_a_cone_are_circles() {
    let lines = evenly(-1.0, 1.0, 201);
    let height = |x: f64, y: f64| 1.0 - x.hypot(y);
    let heights = lines.iter().flat_map(|&y| lines.iter().map(move |&x| height(x, y))).collect();
    let grid = Grid::new(lines.clone(), lines, heights).expect("a grid");
    let mut mesh = LinedMesh::default();
    mesh.push_grid(&grid, &LatticeLines { along_rows: false, along_columns: false, ..BOTH });
    mesh.add_levels(&[0.25, 0.5]);
    let surface = mesh.into_scene().expect("a scene");
    let positions = surface.scene.mesh().positions();
    let mut length = 0.0;
    for line in &surface.lines {
        let [a, b] = surface.scene.topology().edge(line.edge).map(|v| positions[v as usize]);
        assert!((a.truncate().length() - (1.0 - a.z)).abs() < 1e-3, "{a}");
        length += a.distance(b);
    }
    let circles = std::f64::consts::TAU * (0.75 + 0.5);
    assert!((length - circles).abs() < 0.01 * circles, "{length} {circles}");
}

#[test]
fn a_torus_has_no_open_border() {
    let angles = evenly(0.0, std::f64::consts::TAU, 25);
    let mut points: Vec<DVec3> = angles
        .iter()
        .flat_map(|v| {
            angles.iter().map(move |u| {
                let radius = 3.0 + libm::cos(*v);
                dvec3(radius * libm::cos(*u), radius * libm::sin(*u), libm::sin(*v))
            })
        })
        .collect();
    let borders = |points: &[DVec3]| {
        let mut mesh = LinedMesh::default();
        mesh.push_lattice(25, points, &BOTH);
        let scene = mesh.into_scene().expect("a scene").scene;
        scene.topology().count_edges().boundary
    };
    assert!(borders(&points) > 0);
    close_seams(25, &mut points);
    assert_eq!(borders(&points), 0);
}
