//! Which short pieces are left out of a drawing, and which are not.

use glam::{DVec3, dvec2, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::strokes::HiddenLines;

/// Strokes as (visible, first x, last x) of the level lines of some faces, seen from above, one
/// millimeter to the unit.
fn level_strokes(faces: &[[DVec3; 4]], shortest_stroke_mm: f64) -> Vec<(bool, f64, f64)> {
    let options = DrawOptions { shortest_stroke_mm, ..DrawOptions::default() };
    drawn_strokes(faces, options)
}

/// The same with other options.
fn drawn_strokes(faces: &[[DVec3; 4]], options: DrawOptions) -> Vec<(bool, f64, f64)> {
    let mut soup = PolygonSoup::default();
    for face in faces {
        let first = soup.positions.len() as u32;
        soup.positions.extend_from_slice(face);
        soup.push_face(&[0, 1, 2, 3].map(|i| first + i));
    }
    let scene = Scene::new(Mesh::new(soup).unwrap().0);
    let camera =
        Camera::new(dvec3(0.0, 0.0, 9.0), DVec3::ZERO, DVec3::Y, Projection::Orthographic).unwrap();
    let options = DrawOptions {
        lines: LineSelection::all_edges(),
        hidden: HiddenLines::Solid,
        apart_by_kind: true,
        ..options
    };
    let drawing = draw(&scene, &camera, &options, 1.0).drawing;
    let mut strokes: Vec<(bool, f64, f64)> = Vec::new();
    for stroke in drawing.iter() {
        for pair in stroke.points.windows(2).filter(|pair| pair[0].y == pair[1].y) {
            // Edges of the bar alone: the plates' lie elsewhere.
            if pair[0].y.abs() < 1.0 {
                let [a, b] = [0, 1].map(|i| (pair[i].x * 1e9).round() / 1e9);
                let (a, b) = (a.min(b), a.max(b));
                strokes.push((stroke.qi == 0, a, b));
            }
        }
    }
    strokes.sort_by(|a, b| a.partial_cmp(b).unwrap());
    strokes
}

fn level(x: [f64; 2], y: [f64; 2], z: f64) -> [DVec3; 4] {
    [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| dvec2(x[i], y[j]).extend(z))
}

#[test]
fn a_short_hidden_start_or_end_stays_hidden_and_a_short_gap_is_closed() {
    let bar = level([0.0, 10.0], [-0.5, 0.5], 0.0);
    let plate = |x| level(x, [-5.0, 5.0], 1.0);
    let plates = [bar, plate([-3.0, 0.5]), plate([4.0, 4.5]), plate([9.5, 13.0])];
    let twice = |strokes: &[(bool, f64, f64)]| -> Vec<(bool, f64, f64)> {
        strokes.iter().flat_map(|&stroke| [stroke; 2]).collect()
    };
    let parts = [
        (false, 0.0, 0.5),
        (false, 4.0, 4.5),
        (false, 9.5, 10.0),
        (true, 0.5, 4.0),
        (true, 4.5, 9.5),
    ];
    assert_eq!(level_strokes(&plates, 0.25), twice(&parts));
    let closed = [(false, 0.0, 0.5), (false, 9.5, 10.0), (true, 0.5, 9.5)];
    assert_eq!(level_strokes(&plates, 0.75), twice(&closed));
}

#[test]
fn short_hidden_strokes_are_drawn_and_short_visible_ones_are_not() {
    let plate = level([-5.0, 5.0], [-5.0, 5.0], 1.0);
    let below = level([1.0, 1.5], [-0.25, 0.25], 0.0);
    assert_eq!(level_strokes(&[plate, below], 3.0), [(false, 1.0, 1.5); 2]);
    let above = level([1.0, 1.5], [-0.25, 0.25], 2.0);
    assert_eq!(level_strokes(&[plate, above], 3.0), []);
    // What counts is how far it reaches.
    assert_eq!(level_strokes(&[plate, above], 0.7), [(true, 1.0, 1.5); 2]);
    assert_eq!(level_strokes(&[plate, above], 0.71), []);
}

#[test]
fn without_a_pen_too_short_hidden_strokes_are_drawn_and_short_visible_ones_are_not() {
    let strokes = |faces: &[[DVec3; 4]], shortest_stroke_mm: f64| {
        let options =
            DrawOptions { shortest_stroke_mm, pen_width_mm: 0.0, ..DrawOptions::default() };
        drawn_strokes(faces, options)
    };
    let plate = level([-5.0, 5.0], [-5.0, 5.0], 1.0);
    let below = level([1.0, 1.5], [-0.25, 0.25], 0.0);
    assert_eq!(strokes(&[plate, below], 3.0), [(false, 1.0, 1.5); 2]);
    let above = level([1.0, 1.5], [-0.25, 0.25], 2.0);
    // Here the length of all four sides counts.
    assert_eq!(strokes(&[plate, above], 2.01), []);
    assert_eq!(strokes(&[plate, above], 1.99), [(true, 1.0, 1.5); 2]);
}
