//! Scenes whose visible lengths are known in closed form.

use crate::laws::engines;
use crate::oracle::compare::{Image, compare, compare_strokes, truth_of, visible_segments};
use crate::oracle::{EdgeTruth, Kind};
use crate::scenes::{Model, P, Scene, orthographic, perspective};

/// The truth, which every engine must tell as well.
fn edges_of(scene: &Scene) -> Vec<EdgeTruth> {
    let edges = truth_of(scene).unwrap();
    for (name, solve) in engines::ALL {
        let Some(spans) = solve(scene) else { continue };
        compare(&scene.sight, &edges, &spans)
            .unwrap_or_else(|e| panic!("{name}, {}: {e}", scene.name));
    }
    edges
}

/// Visible and hidden length in the image.
fn lengths(scene: &Scene, edges: &[EdgeTruth]) -> [f64; 2] {
    let image = Image::new(&scene.sight);
    let mut sums = [0.0; 2];
    for e in edges {
        for p in &e.pieces {
            sums[usize::from(p.qi > 0)] += image.length(e.ends, p.t0.to_f64(), p.t1.to_f64());
        }
    }
    sums
}

fn is_close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * (1.0 + b.abs())
}

/// The pieces of the edge between two points, t running from the first: (t0, t1, qi).
fn pieces(edges: &[EdgeTruth], a: P, b: P) -> Vec<(f64, f64, u32)> {
    let ends = if a < b { [a, b] } else { [b, a] };
    let edge = edges.iter().find(|e| e.ends == ends).unwrap();
    let mut list: Vec<_> =
        edge.pieces.iter().map(|p| (p.t0.to_f64(), p.t1.to_f64(), p.qi)).collect();
    if b < a {
        list = list.iter().rev().map(|&(t0, t1, qi)| (1.0 - t1, 1.0 - t0, qi)).collect();
    }
    list
}

fn assert_pieces(edges: &[EdgeTruth], a: P, b: P, expected: &[(f64, f64, u32)]) {
    let got = pieces(edges, a, b);
    let same = got.len() == expected.len()
        && got
            .iter()
            .zip(expected)
            .all(|(g, e)| is_close(g.0, e.0) && is_close(g.1, e.1) && (g.2 > 0) == (e.2 > 0));
    assert!(same, "{a:?} to {b:?}: {got:?}, not {expected:?}");
}

/// Rogers' variant of Warnock's pair: a tilted triangle through a square, the nearer the smaller z.
fn warnock() -> Scene {
    let mut model = Model::default();
    model.face(&[[18.5, 12.5, 0.0], [22.5, 16.5, 0.0], [14.5, 22.5, 14.0]]);
    model.face(&[[12.5, 14.5, 6.0], [20.5, 14.5, 6.0], [20.5, 20.5, 6.0], [12.5, 20.5, 6.0]]);
    model.seen_by("Warnock's pair", orthographic([0.0, 0.0, 1.0], [0.0, 1.0, 0.0]))
}

#[test]
fn warnocks_triangle_and_square_hide_each_other_where_they_should() {
    let scene = warnock();
    let edges = edges_of(&scene);
    let [a, b, c] = [[18.5, 12.5, 0.0], [22.5, 16.5, 0.0], [14.5, 22.5, 14.0]];
    assert_pieces(&edges, a, b, &[(0.0, 1.0, 0)]);
    let (from, to) = (3.0 / 7.0, 2.0 / 3.0);
    assert_pieces(&edges, b, c, &[(0.0, from, 0), (from, to, 1), (to, 1.0, 0)]);
    let (from, to) = (1.0 / 5.0, 4.0 / 7.0);
    assert_pieces(&edges, c, a, &[(0.0, from, 0), (from, to, 1), (to, 1.0, 0)]);
    let [p, q, r, s] = [[12.5, 14.5, 6.0], [20.5, 14.5, 6.0], [20.5, 20.5, 6.0], [12.5, 20.5, 6.0]];
    assert_pieces(&edges, p, q, &[(0.0, 5.2 / 8.0, 0), (5.2 / 8.0, 1.0, 1)]);
    assert_pieces(&edges, q, r, &[(0.0, 3.5 / 6.0, 1), (3.5 / 6.0, 1.0, 0)]);
    assert_pieces(&edges, r, s, &[(0.0, 1.0, 0)]);
    assert_pieces(&edges, s, p, &[(0.0, 1.0, 0)]);
    let expected =
        4.0 * 2f64.sqrt() + 160.0 / 21.0 + 22.0 / 35.0 * 116f64.sqrt() + 5.2 + 2.5 + 8.0 + 6.0;
    assert!((expected - 41.745_823_340).abs() < 1e-9);
    assert!(is_close(lengths(&scene, &edges)[0], expected));
}

fn cube(edge: f64, direction: P) -> Scene {
    let mut model = Model::default();
    model.add_box([0.0; 3], [edge; 3]);
    let up =
        if direction[0] == 0.0 && direction[1] == 0.0 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
    model.seen_by(format!("a cube along {direction:?}"), orthographic(direction, up))
}

#[test]
fn a_cube_shows_three_quarters_of_its_edges_from_a_general_direction() {
    for direction in [[1.0, 1.0, 1.0], [-1.0, 2.0, 3.0], [5.0, -1.0, -2.0], [-7.0, -1.0, 1.0]] {
        let scene = cube(2.0, direction);
        let length = direction.iter().map(|x| x * x).sum::<f64>();
        let sum: f64 = direction.iter().map(|x| (1.0 - x * x / length).sqrt()).sum();
        let [visible, hidden] = lengths(&scene, &edges_of(&scene));
        assert!(is_close(visible, 6.0 * sum) && is_close(hidden, 2.0 * sum), "{direction:?}");
    }
    let scene = cube(1.0, [1.0, 1.0, 1.0]);
    let [visible, hidden] = lengths(&scene, &edges_of(&scene));
    assert!((visible - 7.348_469_228).abs() < 1e-9 && (hidden - 2.449_489_743).abs() < 1e-9);
}

#[test]
fn a_cube_along_an_axis_shows_eight_edges_on_four_lines() {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for direction in axes.into_iter().chain(axes.map(|d| d.map(|x| -x))) {
        let edges = edges_of(&cube(1.0, direction));
        assert_eq!(edges.iter().filter(|e| e.image_is_point).count(), 4);
        let visible = |e: &&EdgeTruth| e.pieces.iter().any(|p| p.qi == 0);
        assert_eq!(edges.iter().filter(visible).count(), 8, "{direction:?}");
        assert!(edges.iter().all(|e| e.pieces.len() <= 1));
    }
}

#[test]
fn a_cube_with_one_zero_component_shows_two_rectangles_of_seven_lines() {
    for (direction, zero) in [([0.0, 1.0, 2.0], 0), ([3.0, 0.0, -1.0], 1), ([-1.0, 1.0, 0.0], 2)] {
        let scene = cube(1.0, direction);
        let length = direction.iter().map(|x| x * x).sum::<f64>();
        let others = (0..3).filter(|&i| i != zero);
        let sides: f64 = others.map(|i| (1.0 - direction[i] * direction[i] / length).sqrt()).sum();
        // Back edges lie on the same lines as the rectangles' sides and are visible as well.
        let visible = visible_segments(&scene.sight, &edges_of(&scene), |_| true);
        let union = compare_strokes(&visible, &[], &[]).total;
        assert!((union - (3.0 + 2.0 * sides)).abs() < 1e-8, "{direction:?}: {union}");
    }
}

#[test]
fn a_tetrahedron_shows_three_five_or_six_edges() {
    let [a, b, c, d] = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    let seen_along = |direction: P| {
        let mut model = Model::default();
        for corners in [[a, b, c], [a, d, b], [a, c, d], [b, d, c]] {
            model.face(&corners);
        }
        model.seen_by("a tetrahedron", orthographic(direction, [1.0, 2.0, 5.0]))
    };
    let n_visible = |direction: P| {
        let edges = edges_of(&seen_along(direction));
        edges.iter().filter(|e| e.pieces.iter().any(|p| p.qi == 0)).count()
    };
    // One face: seen against its normal, which is the direction opposite to the fourth vertex.
    assert_eq!(n_visible([10.0, 11.0, 12.0]), 3);
    assert_eq!(n_visible([1.0, 9.0, 2.0]), 5);
    assert_eq!(n_visible([-10.0, -11.0, -12.0]), 6);
    let scene = seen_along([1.0, 1.0, 1.0]);
    let hidden = lengths(&scene, &edges_of(&scene))[1];
    let edge = 8f64.sqrt();
    assert!(is_close(hidden, 3.0 * edge / 3f64.sqrt()), "{hidden}");
}

#[test]
fn crossing_boxes_cut_each_others_edges_where_they_pierce() {
    let mut model = Model::default();
    model.add_box([-2.0, -1.0, -1.0], [2.0, 1.0, 1.0]);
    model.add_box([-1.0, -2.0, -0.5], [1.0, 2.0, 1.5]);
    // From in front, right and above: (1, −2, 3) away.
    let scene = model.seen_by("crossing boxes", orthographic([-1.0, 2.0, -3.0], [0.0, 0.0, 1.0]));
    let edges = edges_of(&scene);
    // The near upper edge of A (along x at y = −1, z = 1) runs inside B from x = −1 to 1. In front
    // of it, to the left, B's own front shows nothing: B's left wall is edge x = −1 turned away.
    let left = pieces(&edges, [-2.0, -1.0, 1.0], [2.0, -1.0, 1.0]);
    // Inside B from t = 1/4 to 3/4.
    assert!(left.iter().filter(|p| p.2 == 0).all(|p| p.1 <= 0.25 + 1e-12 || p.0 >= 0.75 - 1e-12));
    assert!(left.iter().any(|p| is_close(p.0, 0.75) && is_close(p.1, 1.0) && p.2 == 0), "{left:?}");
    // The upper near edge of B (y = −2, z = 3/2) has nothing in front of it.
    assert_pieces(&edges, [-1.0, -2.0, 1.5], [1.0, -2.0, 1.5], &[(0.0, 1.0, 0)]);
    // B's lower edge along y at x = 1, z = −1/2 is inside A for y in −1..1.
    let low = pieces(&edges, [1.0, -2.0, -0.5], [1.0, 2.0, -0.5]);
    assert!(low.iter().filter(|p| p.2 == 0).all(|p| p.1 <= 0.25 + 1e-12), "{low:?}");
    assert!(low.iter().any(|p| is_close(p.0, 0.0) && is_close(p.1, 0.25) && p.2 == 0), "{low:?}");
    assert!(edges.iter().filter_map(|e| e.kinds(30.0)).all(|k| k != [Kind::Mesh]));
}

/// z = 0 at even and 1 at odd x; valleys hide what lies behind peaks.
#[test]
fn lines_across_a_triangle_wave_are_hidden_behind_its_peaks() {
    // Seen from −x, falling by 1/2 per unit: hidden for x in (2k + 1, 2k + 7/3).
    let mut model = Model::default();
    let height = |x: i32| f64::from(x % 2);
    for x in 0..6 {
        let at = |x: i32, y: f64| [f64::from(x), y, height(x)];
        // Cut at x + 1/4 as well, next to where the shadow ends.
        let cut = |y: f64| {
            let u = 0.25;
            [f64::from(x) + u, y, height(x) + u * (height(x + 1) - height(x))]
        };
        for y in [0.0, 2.0] {
            model.face(&[at(x, y), cut(y), cut(y + 2.0), at(x, y + 2.0)]);
            model.face(&[cut(y), at(x + 1, y), at(x + 1, y + 2.0), cut(y + 2.0)]);
        }
    }
    let sight = orthographic([2.0, 0.0, -1.0], [0.0, 0.0, 1.0]);
    let scene = model.seen_by("a triangle wave", sight);
    let edges = edges_of(&scene);
    let mut n_along_y = 0;
    for e in &edges {
        let x = e.ends[0][0];
        if x != e.ends[1][0] {
            continue;
        }
        n_along_y += 1;
        // An edge of constant x is hidden as a whole or not at all.
        let k = ((x - 1.0) / 2.0).floor();
        let offset = x - (2.0 * k + 1.0);
        let hidden = k >= 0.0 && offset > 0.0 && offset < 4.0 / 3.0;
        assert_eq!(e.pieces.len(), 1);
        assert_eq!(e.pieces[0].qi > 0, hidden, "x = {x}");
    }
    assert_eq!(n_along_y, 26);
    // Along x the shadow ends at 7/3, within the edge from 2.25 to 3. The line in the middle has
    // faces on both sides; at the rim, one side stays open and the line is visible throughout.
    let rim = pieces(&edges, [2.25, 0.0, 0.25], [3.0, 0.0, 1.0]);
    assert_eq!(rim, [(0.0, 1.0, 0)]);
    let half = pieces(&edges, [2.25, 2.0, 0.25], [3.0, 2.0, 1.0]);
    let at = (7.0 / 3.0 - 2.25) / 0.75;
    assert_eq!(half.len(), 2);
    assert!(is_close(half[0].1, at) && half[0].2 > 0 && half[1].2 == 0, "{half:?}");
}

#[test]
fn the_near_plane_opens_a_box_around_the_eye() {
    let mut model = Model::default();
    model.add_box([-2.0; 3], [2.0; 3]);
    // Inside, looking along y, the near plane at y = 1: only the far wall and a rim are kept.
    let sight = perspective([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], 1.0);
    let edges = edges_of(&model.seen_by("inside a box", sight));
    for e in &edges {
        let y = e.ends.map(|p| p[1]);
        match (y[0] == 2.0, y[1] == 2.0) {
            (true, true) => assert_eq!(e.pieces.len(), 1),
            (false, false) => assert!(e.pieces.is_empty()),
            _ => {
                assert_eq!(e.pieces.len(), 1);
                assert_eq!(e.pieces[0].t0.to_f64(), 0.75);
                assert_eq!(e.pieces[0].qi, 0);
            }
        }
    }
}

#[test]
fn a_square_cut_by_the_near_plane_hides_up_to_the_cut_only() {
    // The eye at the origin looks along y; a slanted square begins behind the near plane (y = 1).
    let mut model = Model::default();
    model.face(&[[-4.0, 0.0, 1.0], [4.0, 0.0, 1.0], [4.0, 4.0, -1.0], [-4.0, 4.0, -1.0]]);
    // A vertical line far behind it: a thin triangle seen edge-on.
    model.face(&[[0.0, 8.0, 8.0], [0.0, 8.0, -8.0], [0.0, 9.0, 0.0]]);
    let sight = perspective([0.0; 3], [0.0, 1.0, 0.0], 1.0);
    let edges = edges_of(&model.seen_by("a cut square", sight));
    // The square is kept from (y, z) = (1, 1/2), at image height 1/2, to (4, −1), at −1/4.
    // At y = 8 that is z from 4 down to −2: t from 1/4 to 5/8.
    assert_pieces(
        &edges,
        [0.0, 8.0, 8.0],
        [0.0, 8.0, -8.0],
        &[(0.0, 0.25, 0), (0.25, 0.625, 1), (0.625, 1.0, 0)],
    );
}

#[test]
fn a_box_behind_another_of_its_size_loses_no_line_and_one_between_shows_none() {
    let mut model = Model::default();
    model.add_box([0.0, 0.0, 0.0], [2.0, 1.0, 2.0]);
    model.add_box([0.0, 4.0, 0.0], [2.0, 5.0, 2.0]);
    model.add_box([0.5, 2.0, 0.5], [1.5, 3.0, 1.5]);
    let scene = model.seen_by("boxes in a row", orthographic([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]));
    for e in edges_of(&scene).iter().filter(|e| !e.image_is_point) {
        let between = e.ends.iter().all(|p| p[1] >= 2.0 && p[1] <= 3.0);
        assert_eq!(e.pieces.len(), 1);
        assert_eq!(e.pieces[0].qi > 0, between, "{:?}", e.ends);
    }
}

#[test]
fn a_segment_behind_the_shared_diagonal_of_two_triangles_is_hidden() {
    let mut model = Model::default();
    let [a, b, c, d] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 0.0, 4.0], [0.0, 0.0, 4.0]];
    model.face(&[a, b, c]);
    model.face(&[a, c, d]);
    model.face(&[[1.0, 2.0, 1.0], [3.0, 2.0, 3.0], [2.0, 3.0, 1.0]]);
    let scene = model.seen_by("a diagonal", orthographic([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]));
    assert_pieces(&edges_of(&scene), [1.0, 2.0, 1.0], [3.0, 2.0, 3.0], &[(0.0, 1.0, 1)]);
}
