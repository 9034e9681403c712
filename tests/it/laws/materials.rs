//! Lines where materials or groups change.

use glam::{DVec3, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::read::read_bytes;
use hiddenline::stages::strokes::{StrokeKind, Strokes};

/// Six unit squares in a row along x, in one plane: materials and groups change on the way, once back
/// to an earlier one, once only in name, and once where the strip bends upward.
const STRIP: &str = "\
v 0 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 2 0 0\nv 2 1 0\nv 3 0 0\nv 3 1 0\nv 4 0 0\nv 4 1 0\nv 5 0 0\nv 5 1 0\nv 6 0 1\nv 6 1 1
usemtl red\nf 1 3 4 2\nf 3 5 6 4\nusemtl blue\nf 5 7 8 6\nusemtl red\nf 7 9 10 8\nusemtl red\nf 9 11 12 10
g lid\nf 11 13 14 12
";

fn drawn(lines: LineSelection) -> Strokes {
    let model = read_bytes("strip.obj", STRIP.as_bytes(), None).unwrap();
    let scene = Scene::new(model.mesh);
    let camera =
        Camera::new(dvec3(2.0, -3.0, 9.0), DVec3::ZERO, DVec3::Z, Projection::Orthographic)
            .unwrap();
    let options = DrawOptions { lines, apart_by_kind: true, ..DrawOptions::default() };
    draw(&scene, &camera, &options, 100.0).drawing
}

fn count(drawing: &Strokes, kind: StrokeKind) -> usize {
    drawing.iter().filter(|stroke| stroke.kind == kind).count()
}

#[test]
fn lines_are_drawn_where_materials_or_groups_change() {
    let drawing = drawn(LineSelection::NONE.with(StrokeKind::Material));
    // At x = 2 and 3 the material changes; at 5 the group, where the strip bends as well.
    assert_eq!(count(&drawing, StrokeKind::Material), 2);
    assert_eq!(count(&drawing, StrokeKind::Crease), 1);
    assert_eq!(drawing.len(), 3);
}

#[test]
fn materials_are_only_told_when_asked_for() {
    let drawing = drawn(LineSelection::all_edges());
    assert_eq!(count(&drawing, StrokeKind::Material), 0);
    assert_eq!(count(&drawing, StrokeKind::Mesh), 4);
    let both = drawn(LineSelection::all_edges().with(StrokeKind::Material));
    assert_eq!((count(&both, StrokeKind::Material), count(&both, StrokeKind::Mesh)), (2, 2));
    assert!(drawn(LineSelection::NONE).is_empty());
}
