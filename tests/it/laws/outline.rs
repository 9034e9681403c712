//! The outline: against the truth on random scenes, and where it is known in closed form.

use crate::laws::engines::{assert_truth, camera, mesh};
use crate::oracle::EdgeTruth;
use crate::oracle::compare::{Image, compare_strokes};
use crate::scenes::{Model, P, Scene as TestScene, orthographic, perspective};
use hiddenline::stages::classify::{LineSelection, ViewedScene};
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::engines::edge::outline;
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::strokes::{StrokeKind, Strokes};
use std::cell::Cell;
use std::collections::HashMap;

fn bits(p: P) -> [u64; 3] {
    p.map(f64::to_bits)
}

/// What the truth says is outline, as parameters from the smaller end.
fn true_parts(edge: &EdgeTruth) -> Vec<[f64; 2]> {
    let is_asked = edge.n_uses != 2 || edge.silhouette == Some(true);
    let open = edge.image_pieces.iter().filter(|piece| is_asked && piece.qi == 0);
    open.map(|piece| [piece.t0.to_f64(), piece.t1.to_f64()]).collect()
}

fn outline_is_true(scene: &TestScene, edges: &[EdgeTruth]) -> Result<(), String> {
    let built = Scene::new(mesh(scene));
    let view = ViewedScene::new(&built, &camera(scene), LineSelection::NONE.with_outline(), 30.0);
    let outline = outline::find(&view);
    let position = |v: u32| built.mesh().positions()[v as usize].to_array();
    let mut found = HashMap::new();
    for (i, drawn) in view.selected().iter().enumerate() {
        let [a, b] = built.topology().edge(drawn.edge).map(position);
        let mut parts = outline.parts(i).to_vec();
        if b < a {
            parts = parts.iter().rev().map(|[t0, t1]| [1.0 - t1, 1.0 - t0]).collect();
        }
        let ends = if a < b { [a, b] } else { [b, a] };
        found.insert(ends.map(bits), parts);
    }
    for edge in edges {
        if edge.n_uses == 2 && edge.silhouette.is_none() {
            continue;
        }
        let expected = true_parts(edge);
        let got = found.remove(&edge.ends.map(bits)).unwrap_or_default();
        let near = |a: &[f64; 2], b: &[f64; 2]| (0..2).all(|k| (a[k] - b[k]).abs() < 1e-9);
        let same =
            got.len() == expected.len() && got.iter().zip(&expected).all(|(a, b)| near(a, b));
        if !same {
            return Err(format!("{:?} is outline at {got:?}, not {expected:?}", edge.ends));
        }
        // What is seen against the background is seen.
        for [t0, t1] in got.into_iter().filter(|[t0, t1]| t1 - t0 > 1e-9) {
            let middle = 0.5 * (t0 + t1);
            let around =
                |p: &&crate::oracle::Piece| p.t0.to_f64() < middle && middle < p.t1.to_f64();
            if edge.pieces.iter().find(around).is_some_and(|piece| piece.qi > 0) {
                return Err(format!("{:?} is outline and hidden at {middle}", edge.ends));
            }
        }
    }
    Ok(())
}

#[test]
fn the_outline_is_where_the_truth_sees_the_background() {
    assert_truth(70_000, 4000, outline_is_true);
}

/// Between a back face and an edge-on one an edge may border on the background without being a
/// silhouette. The edge-on face's other edges have the same image and end as outline themselves.
#[test]
fn nothing_of_the_true_outline_is_left_out() {
    let n_compared = Cell::new(0);
    assert_truth(80_000, 1000, |scene, edges| {
        let is_undecided = |e: &EdgeTruth| e.n_uses == 2 && e.silhouette.is_none();
        if scene.sight.near.is_some() || scene.is_in_tenths || edges.iter().any(is_undecided) {
            return Ok(());
        }
        let image = Image::new(&scene.sight);
        let at = |e: &EdgeTruth, t: [f64; 2]| t.map(|t| image.at(e.ends, t));
        let all: Vec<_> = edges
            .iter()
            .flat_map(|e| {
                let open = e.image_pieces.iter().filter(|piece| piece.qi == 0);
                open.map(|piece| at(e, [piece.t0.to_f64(), piece.t1.to_f64()])).collect::<Vec<_>>()
            })
            .collect();
        let found: Vec<Vec<_>> = edges
            .iter()
            .flat_map(|e| true_parts(e).into_iter().map(|t| at(e, t).to_vec()))
            .collect();
        let difference = compare_strokes(&all, &found, &[]);
        // Edge-on faces alone have an image of lines; these are no outline.
        let has_lines_only = edges.iter().all(|e| e.image_pieces.iter().all(|p| p.qi == 0));
        n_compared.set(n_compared.get() + 1);
        let missing = difference.missing > 1e-8 * difference.total && !has_lines_only;
        if missing { Err(format!("{difference:?}")) } else { Ok(()) }
    });
    assert!(n_compared.get() > 0);
}

fn drawing(scene: &TestScene, lines: LineSelection) -> Strokes {
    // A pen without width sees every gap.
    let options =
        DrawOptions { lines, apart_by_kind: true, pen_width_mm: 0.0, ..DrawOptions::default() };
    let built = Scene::new(mesh(scene));
    draw(&built, &camera(scene), &options, 100.0).drawing
}

fn length(drawing: &Strokes, outline: bool) -> f64 {
    let strokes = drawing.iter().filter(|stroke| stroke.outline == outline);
    strokes.flat_map(|s| s.points.windows(2)).map(|pair| pair[0].distance(pair[1])).sum()
}

const ONLY: LineSelection = LineSelection::NONE.with_outline();

#[test]
fn a_cubes_outline_is_a_hexagon_of_six_edges() {
    let mut model = Model::default();
    model.add_box([0.0; 3], [1.0; 3]);
    let scene = model.seen_by("a cube", orthographic([1.0, 1.0, 1.0], [0.0, 0.0, 1.0]));
    let drawn = drawing(&scene, ONLY);
    assert_eq!(drawn.len(), 1);
    let stroke = drawn.iter().next().unwrap();
    assert_eq!((stroke.points.len(), stroke.points[0]), (7, stroke.points[6]));
    assert!(stroke.outline);
    assert!((length(&drawn, true) - 6.0 * (2f64 / 3.0).sqrt()).abs() < 1e-12);
    // With creases the three inner edges come too, and are not outline.
    let both = drawing(&scene, ONLY.with(StrokeKind::Crease));
    assert!((length(&both, true) - length(&drawn, true)).abs() < 1e-12);
    assert!((length(&both, false) - 3.0 * (2f64 / 3.0).sqrt()).abs() < 1e-12);
}

#[test]
fn a_cube_in_front_of_a_plate_has_no_outline_and_one_behind_it_none_either() {
    for y in [-5.0, 5.0] {
        let mut model = Model::default();
        model.add_box([-1.0, y - 1.0, -1.0], [1.0, y + 1.0, 1.0]);
        model.face(&[
            [-40.0, 0.0, -40.0],
            [40.0, 0.0, -40.0],
            [40.0, 0.0, 40.0],
            [-40.0, 0.0, 40.0],
        ]);
        let sight = perspective([3.0, -20.0, 2.0], [0.0, 0.0, 0.0], 1e-6);
        let scene = model.seen_by("a cube before a plate", sight);
        let drawn = drawing(&scene, ONLY);
        let stroke = drawn.iter().next().unwrap();
        assert_eq!((drawn.len(), stroke.points.len(), stroke.kind), (1, 5, StrokeKind::Boundary));
    }
}

#[test]
fn two_boxes_that_overlap_in_the_image_have_one_outline_around_both() {
    let mut model = Model::default();
    // In the image: 4 by 2 and 2 by 4, a cross; the second is nearer, smaller x sticks out by one.
    model.add_box([-2.0, 4.0, -1.0], [2.0, 5.0, 1.0]);
    model.add_box([-1.0, 0.0, -2.0], [1.0, 1.0, 2.0]);
    let scene = model.seen_by("a cross", orthographic([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]));
    let drawn = drawing(&scene, ONLY);
    assert!((length(&drawn, true) - 16.0).abs() < 1e-12, "{}", length(&drawn, true));
    let image = Image::new(&scene.sight);
    let corner = |x: f64, z: f64| image.of([x, 0.0, z]);
    let points = [
        [-2.0, -1.0],
        [-1.0, -1.0],
        [-1.0, -2.0],
        [1.0, -2.0],
        [1.0, -1.0],
        [2.0, -1.0],
        [2.0, 1.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [-1.0, 2.0],
        [-1.0, 1.0],
        [-2.0, 1.0],
        [-2.0, -1.0],
    ];
    let expected: Vec<_> = points
        .windows(2)
        .map(|pair| [corner(pair[0][0], pair[0][1]), corner(pair[1][0], pair[1][1])])
        .collect();
    let strokes: Vec<Vec<[f64; 2]>> =
        drawn.iter().map(|s| s.points.iter().map(|p| p.to_array()).collect()).collect();
    assert!(compare_strokes(&expected, &strokes, &[]).is_small());
    // All silhouettes: the nearer box's four inner sides come too.
    let all = drawing(&scene, ONLY.with(StrokeKind::Silhouette));
    assert!((length(&all, true) - 16.0).abs() < 1e-12 && (length(&all, false) - 4.0).abs() < 1e-12);
}

#[test]
fn a_part_seen_through_a_window_has_its_outline_there() {
    let mut model = Model::default();
    // A frame of four plates around a window of 4 by 4, and far behind it a bar across the window.
    for (low, high) in [
        ([-4.0, -4.0], [4.0, -2.0]),
        ([-4.0, 2.0], [4.0, 4.0]),
        ([-4.0, -2.0], [-2.0, 2.0]),
        ([2.0, -2.0], [4.0, 2.0]),
    ] {
        model.face(&[
            [low[0], 0.0, low[1]],
            [high[0], 0.0, low[1]],
            [high[0], 0.0, high[1]],
            [low[0], 0.0, high[1]],
        ]);
    }
    model.face(&[[-9.0, 9.0, -1.0], [9.0, 9.0, -1.0], [9.0, 9.0, 1.0], [-9.0, 9.0, 1.0]]);
    let scene = model.seen_by("a window", orthographic([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]));
    let drawn = drawing(&scene, ONLY);
    // Outside: around a frame of 8 by 8 with two ends of the bar, 5 by 2 each; inside: the window's
    // border above and below the bar, and the bar's two sides across it.
    let outside = 32.0 + 4.0 * 5.0;
    let inside = 4.0 * 4.0 - 4.0 + 2.0 * 4.0;
    assert!((length(&drawn, true) - (outside + inside)).abs() < 1e-12, "{}", length(&drawn, true));
}
