//! From exact lines to those of a drafter: what is joined, what is left out, and what never is.
//!
//! Wires are lines without faces, so a model of wires seen from above is any line drawing; at one
//! millimeter to the unit its coordinates are millimeters on paper.

use std::collections::HashMap;

use glam::{DVec2, DVec3, dvec2, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::draw::{DrawOptions, DrawOutput, draw};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::strokes::{HiddenLines, StrokeKind, Strokes};

use crate::scenes::Rng;

/// Width of the pen, in millimeters.
const PEN: f64 = 0.3;

fn from_above() -> Camera {
    Camera::new(dvec3(0.0, 0.0, 99.0), DVec3::ZERO, DVec3::Y, Projection::Orthographic).unwrap()
}

fn scene(wires: &[&[DVec3]], faces: &[&[DVec3]]) -> Scene {
    let mut soup = PolygonSoup::default();
    for (points, is_face) in wires.iter().map(|w| (w, false)).chain(faces.iter().map(|f| (f, true)))
    {
        let first = soup.positions.len() as u32;
        soup.positions.extend_from_slice(points);
        let corners: Vec<u32> = (first..first + points.len() as u32).collect();
        if is_face { soup.push_face(&corners) } else { soup.push_wire(&corners) }
    }
    Scene::new(Mesh::new(soup).unwrap().0)
}

fn drawn(scene: &Scene, options: DrawOptions) -> DrawOutput {
    draw(scene, &from_above(), &DrawOptions { pen_width_mm: PEN, ..options }, 1.0)
}

fn of_wires(wires: &[&[DVec2]], options: DrawOptions) -> Strokes {
    let wires: Vec<Vec<DVec3>> =
        wires.iter().map(|w| w.iter().map(|p| p.extend(0.0)).collect()).collect();
    let wires: Vec<&[DVec3]> = wires.iter().map(Vec::as_slice).collect();
    drawn(&scene(&wires, &[]), options).drawing
}

fn ink(strokes: &Strokes) -> f64 {
    strokes.iter().flat_map(|s| s.points.windows(2)).map(|p| p[0].distance(p[1])).sum()
}

fn plain() -> DrawOptions {
    DrawOptions::default()
}

#[test]
fn ends_within_a_pens_width_are_joined_where_a_line_goes_on() {
    let n = |gap: f64| {
        let start = dvec2(10.0 + gap, 0.0);
        // A third end near by, so that the two are no corner.
        let third = [start + dvec2(-0.05, -0.1), start + dvec2(-0.05, -9.0)];
        let lines = [[dvec2(0.0, 0.0), dvec2(10.0, 0.0)], [start, start + dvec2(9.0, 0.0)], third];
        of_wires(&[&lines[0], &lines[1], &lines[2]], plain()).len()
    };
    assert_eq!((n(0.29), n(0.31)), (2, 3));
}

#[test]
fn two_ends_alone_are_a_corner_whatever_the_turn() {
    let n = |gap: f64| {
        let lines = [[dvec2(0.0, 0.0), dvec2(10.0, 0.0)], [dvec2(10.0, gap), dvec2(2.0, 9.0)]];
        let strokes = of_wires(&[&lines[0], &lines[1]], plain());
        // Nothing is moved, only bridged.
        let bridged = if strokes.len() == 1 { gap } else { 0.0 };
        let lines: f64 = lines.iter().map(|l| l[0].distance(l[1])).sum();
        assert!((ink(&strokes) - lines - bridged).abs() < 1e-9);
        strokes.len()
    };
    assert_eq!(n(0.25), 1);
    assert_eq!(n(0.35), 2);
}

#[test]
fn a_stub_beyond_a_crossing_is_cut_off_and_the_rest_joined() {
    // The second line comes from below along the first, and ends on it shortly before its end.
    let first = [dvec2(0.0, 0.0), dvec2(20.0, 0.0)];
    let n = |stub: f64| {
        let foot = dvec2(stub, 0.0);
        let second = [foot + dvec2(-8.0, 6.0), foot];
        let strokes = of_wires(&[&first, &second], plain());
        (strokes.len(), ink(&strokes))
    };
    let (joined, joined_ink) = n(0.5);
    assert_eq!(joined, 1);
    assert!((joined_ink - 29.5).abs() < 1e-9, "{joined_ink}");
    let (apart, apart_ink) = n(0.7);
    assert_eq!(apart, 2);
    assert!((apart_ink - 30.0).abs() < 1e-9, "{apart_ink}");
}

#[test]
fn ink_on_ink_is_drawn_once_the_more_important_line_whole() {
    let long = [dvec2(0.0, 0.0), dvec2(30.0, 0.0)];
    let n = |distance: f64, turn_deg: f64| {
        let (sin, cos) = turn_deg.to_radians().sin_cos();
        let start = dvec2(10.0, distance);
        let short = [start, start + 8.0 * dvec2(cos, sin)];
        ink(&of_wires(&[&long, &short], plain()))
    };
    assert!((n(0.149, 0.0) - 30.0).abs() < 1e-9);
    assert!((n(0.151, 0.0) - 38.0).abs() < 1e-9);
    // At a small angle up to where the lines are half a pen's width apart.
    let angle = 4f64.to_radians();
    let apart = 0.15 / angle.sin();
    assert!((n(0.0, 4.0) - (38.0 - apart)).abs() < 1e-6, "{}", n(0.0, 4.0));
    assert!((n(0.0, 11.0) - 38.0).abs() < 1e-9);
    let keep = DrawOptions { drops_overlaps: false, ..plain() };
    let short = [dvec2(10.0, 0.1), dvec2(18.0, 0.1)];
    assert!((ink(&of_wires(&[&long, &short], keep)) - 38.0).abs() < 1e-9);
}

#[test]
fn a_closed_stroke_does_not_lie_on_itself_where_it_begins() {
    for start in [dvec2(0.0, 0.0), dvec2(6.0, 0.0), dvec2(11.9, 0.0)] {
        let square = [start, dvec2(12.0, 0.0), dvec2(12.0, 12.0), dvec2(0.0, 12.0), DVec2::ZERO];
        let strokes = of_wires(&[&square, &[DVec2::ZERO, start]], plain());
        assert!((ink(&strokes) - 48.0).abs() < 1e-9, "{start}: {}", ink(&strokes));
        let closed = [&square[..], &[start]].concat();
        let strokes = of_wires(&[&closed], plain());
        assert!((ink(&strokes) - 48.0).abs() < 1e-9, "{start}: {}", ink(&strokes));
    }
}

#[test]
fn wavering_ink_on_a_line_is_drawn_once_however_its_segments_turn() {
    let line = [dvec2(0.0, 0.0), dvec2(40.0, 0.0)];
    let wavering: Vec<DVec2> = (0..=400)
        .map(|k| dvec2(10.0 + 0.05 * f64::from(k), if k % 2 == 0 { 0.03 } else { 0.06 }))
        .collect();
    let strokes = of_wires(&[&line, &wavering], plain());
    assert!((ink(&strokes) - 40.0).abs() < 1.0, "{}", ink(&strokes));
}

#[test]
fn a_short_stroke_that_lies_wholly_on_another_is_left_out() {
    let options = || DrawOptions { shortest_stroke_mm: 0.0, ..plain() };
    for length in [0.4, 0.5, 2.0] {
        let line = [dvec2(0.0, 0.0), dvec2(40.0, 0.0)];
        let on_it = [dvec2(20.0, 0.1), dvec2(20.0 + length, 0.1)];
        let strokes = of_wires(&[&line, &on_it], options());
        assert!((ink(&strokes) - 40.0).abs() < 1e-9, "{length}: {}", ink(&strokes));
        let beside = [dvec2(20.0, 0.4), dvec2(20.0 + length, 0.4)];
        let strokes = of_wires(&[&line, &beside], options());
        assert!((ink(&strokes) - 40.0 - length).abs() < 1e-9, "{length}: {}", ink(&strokes));
    }
}

#[test]
fn of_what_is_thinned_away_for_the_most_part_no_scraps_are_left() {
    // A line that leaves a crowd for 3 mm, and one that leaves it for 12 mm.
    let crowd = [dvec2(0.0, 0.0), dvec2(60.0, 0.0)];
    let bump = |x: f64, length: f64| {
        [dvec2(x, 0.35), dvec2(x + 1.0, 1.8), dvec2(x + length, 1.8), dvec2(x + length + 1.0, 0.35)]
    };
    let line =
        |length: f64| [&[dvec2(2.0, 0.35)][..], &bump(20.0, length), &[dvec2(55.0, 0.35)]].concat();
    let options = || DrawOptions { thin_mm: Some(0.4), ..plain() };
    let left = |length: f64| ink(&of_wires(&[&crowd, &line(length)], options())) - 60.0;
    assert!(left(0.5).abs() < 1e-9, "{}", left(0.5));
    assert!(left(12.0) > 11.0, "{}", left(12.0));
}

#[test]
fn a_stroke_that_comes_back_on_itself_is_drawn_once() {
    let hairpin = [dvec2(0.0, 0.0), dvec2(20.0, 0.0), dvec2(20.0, 0.02), dvec2(0.0, 0.02)];
    let once = ink(&of_wires(&[&hairpin], plain()));
    assert!((20.0..20.8).contains(&once), "{once}");
    // A tight wave is no overlap: it goes on.
    let wave: Vec<DVec2> =
        (0..100).map(|k| dvec2(f64::from(k) * 0.1, f64::from(k % 2) * 0.004)).collect();
    let whole: f64 = wave.windows(2).map(|p| p[0].distance(p[1])).sum();
    assert!((ink(&of_wires(&[&wave], plain())) - whole).abs() < 1e-9);
}

#[test]
fn visible_lines_cover_hidden_ones_and_hidden_ones_cover_each_other_once() {
    // A plate above two plates of the same width, the lower ones with borders just beside the upper's.
    let plate = |low: f64, high: f64, z: f64| {
        [(low, low), (high, low), (high, high), (low, high)].map(|(x, y)| dvec3(x, y, z))
    };
    let (top, middle, bottom) =
        (plate(0.0, 30.0, 3.0), plate(0.1, 29.9, 2.0), plate(5.0, 20.0, 1.0));
    let lowest = plate(5.1, 19.9, 0.0);
    let options = DrawOptions { hidden: HiddenLines::Solid, ..plain() };
    let strokes = drawn(&scene(&[], &[&top, &middle, &bottom, &lowest]), options).drawing;
    let of = |is_hidden: bool| {
        let some = strokes.iter().filter(|s| (s.qi > 0) == is_hidden);
        some.flat_map(|s| s.points.windows(2)).map(|p| p[0].distance(p[1])).sum::<f64>()
    };
    assert!((of(false) - 120.0).abs() < 1e-9, "{}", of(false));
    assert!((of(true) - 60.0).abs() < 1e-9, "{}", of(true));
}

#[test]
fn a_visible_line_stays_whole_beside_a_longer_hidden_one() {
    let plate = |low: f64, high: f64, z: f64| {
        [(low, low), (high, low), (high, high), (low, high)].map(|(x, y)| dvec3(x, y, z))
    };
    let (top, small, below) =
        (plate(0.0, 30.0, 3.0), plate(10.0, 15.0, 5.0), plate(10.05, 29.0, 1.0));
    let options = DrawOptions { hidden: HiddenLines::Solid, ..plain() };
    let strokes = drawn(&scene(&[], &[&top, &small, &below]), options).drawing;
    let visible = strokes.iter().filter(|s| s.qi == 0).flat_map(|s| s.points.windows(2));
    let visible: f64 = visible.map(|p| p[0].distance(p[1])).sum();
    assert!((visible - 140.0).abs() < 1e-9, "{visible}");
}

/// The share of a drawing's ink that lies within 0.05 mm of other ink of the same direction, sampled, and
/// some of the places.
fn overlaps(strokes: &Strokes) -> (f64, Vec<DVec2>) {
    const STEP: f64 = 0.05;
    let samples: Vec<(usize, f64, DVec2, DVec2)> = strokes
        .iter()
        .enumerate()
        .flat_map(|(stroke, s)| {
            let mut walked = 0.0;
            let pairs: Vec<_> = s.points.windows(2).map(|p| (p[0], p[1])).collect();
            pairs.into_iter().flat_map(move |(a, b)| {
                let length = a.distance(b);
                let start = walked;
                walked += length;
                let n = (length / STEP).ceil() as usize;
                let direction = (b - a).normalize_or_zero();
                (0..n).map(move |k| {
                    let t = (k as f64 + 0.5) / n as f64;
                    (stroke, start + t * length, a.lerp(b, t), direction)
                })
            })
        })
        .collect();
    let cell = |p: DVec2| (p / STEP).floor().to_array().map(|x| x as i64);
    let mut cells: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    for (k, sample) in samples.iter().enumerate() {
        cells.entry(cell(sample.2)).or_default().push(k);
    }
    let on_other = samples.iter().filter(|&&(stroke, along, at, direction)| {
        let [x, y] = cell(at);
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [x + i, y + j]));
        around.filter_map(|near| cells.get(&near)).flatten().any(|&k| {
            let (other, other_along, p, q) = samples[k];
            let is_far = stroke != other || (along - other_along).abs() > 1.0;
            is_far && at.distance(p) <= STEP && direction.perp_dot(q).abs() < 0.17
        })
    });
    let places: Vec<DVec2> = on_other.map(|sample| sample.2).collect();
    let share = places.len() as f64 / samples.len().max(1) as f64;
    (share, places.into_iter().step_by(10).collect())
}

#[test]
fn hardly_any_ink_lies_on_other_ink_in_views_along_axes_with_hidden_lines() {
    let options = DrawOptions { hidden: HiddenLines::Solid, ..plain() };
    let mut n_overlapping = 0;
    for seed in 0..5 {
        let mut rng = Rng(seed);
        let mut model = crate::scenes::Model::default();
        for _ in 0..4 {
            // Long lines, since ends that touch count too; near each other, but hardly ever equal.
            let mut near = |c: f64| 8.0 * c + 0.001 * rng.integer(-60, 60);
            let low = [4, 3, 9].map(|c| near(f64::from(c)));
            let high = [12, 15, 20].map(|c| near(f64::from(c)));
            model.add_box(low, high);
        }
        let mut soup = PolygonSoup::default();
        soup.positions.extend(model.positions.iter().map(|&p| DVec3::from_array(p)));
        model.faces.iter().for_each(|face| soup.push_face(face));
        let scene = Scene::new(Mesh::new(soup).unwrap().0);
        let kept = drawn(&scene, DrawOptions { drops_overlaps: false, ..options }).drawing;
        n_overlapping += usize::from(overlaps(&kept).0 > 0.004);
        let once = drawn(&scene, options).drawing;
        let (share, places) = overlaps(&once);
        assert!(share < 0.002, "seed {seed}: {share} at {places:?}");
        // All that was there is still near ink.
        for stroke in kept.iter() {
            for pair in stroke.points.windows(2) {
                for k in 0..=20 {
                    let at = pair[0].lerp(pair[1], f64::from(k) / 20.0);
                    let distance = distance_to(&once, at);
                    assert!(distance < 0.5 * PEN + 0.5, "seed {seed}: {at} is {distance} away");
                }
            }
        }
    }
    assert!(n_overlapping > 1, "{n_overlapping}");
}

fn distance_to(strokes: &Strokes, at: DVec2) -> f64 {
    let segments = strokes.iter().flat_map(|s| s.points.windows(2));
    let distances = segments.map(|p| {
        let along = p[1] - p[0];
        let t = ((at - p[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        at.distance(p[0].lerp(p[1], t))
    });
    distances.fold(f64::INFINITY, f64::min)
}

#[test]
fn thinned_lines_keep_their_distance_and_thinning_again_changes_nothing() {
    let lines: Vec<[DVec2; 2]> = (0..40)
        .map(|k| {
            [dvec2(0.0, f64::from(k) * 0.2), dvec2(60.0 - f64::from(k) * 0.1, f64::from(k) * 0.2)]
        })
        .collect();
    let lines: Vec<&[DVec2]> = lines.iter().map(|l| &l[..]).collect();
    let thin = DrawOptions { thin_mm: Some(0.45), ..plain() };
    let strokes = of_wires(&lines, thin);
    let mut heights: Vec<f64> = strokes.iter().map(|s| s.points[0].y).collect();
    heights.sort_by(f64::total_cmp);
    assert!(heights.windows(2).all(|p| p[1] - p[0] >= 0.45), "{heights:?}");
    // 40 lines 0.2 apart: every third stays.
    assert_eq!(strokes.len(), 14);
    let again: Vec<Vec<DVec2>> = strokes.iter().map(|s| s.points.to_vec()).collect();
    let again: Vec<&[DVec2]> = again.iter().map(Vec::as_slice).collect();
    assert!((ink(&of_wires(&again, thin)) - ink(&strokes)).abs() < 0.01 * ink(&strokes));
}

#[test]
fn lines_that_cross_at_a_large_angle_are_not_thinned() {
    let fan: Vec<[DVec2; 2]> = (0..5)
        .map(|k| {
            let direction = DVec2::from_angle(f64::from(k) * 36f64.to_radians());
            [-20.0 * direction, 20.0 * direction]
        })
        .collect();
    let fan: Vec<&[DVec2]> = fan.iter().map(|l| &l[..]).collect();
    let strokes = of_wires(&fan, DrawOptions { thin_mm: Some(0.6), ..plain() });
    assert!((ink(&strokes) - 200.0).abs() < 1e-9);
}

#[test]
fn crowded_lines_are_noticed() {
    let lines: Vec<[DVec3; 2]> = (0..20)
        .map(|k| [dvec3(0.0, f64::from(k) * 0.2, 0.0), dvec3(50.0, f64::from(k) * 0.2, 0.0)])
        .collect();
    let lines: Vec<&[DVec3]> = lines.iter().map(|l| &l[..]).collect();
    let drafted = drawn(&scene(&lines, &[]), plain()).drafted;
    assert!((drafted.crowded_share - 1.0).abs() < 1e-9);
    let drafted = drawn(&scene(&lines[..1], &[]), plain()).drafted;
    assert_eq!(drafted.crowded_share, 0.0);
}

#[test]
fn a_halo_is_a_gap_of_its_width_on_both_sides_of_a_nearer_line() {
    for angle_deg in [90f64, 30.0, 60.0] {
        let direction = DVec2::from_angle(angle_deg.to_radians());
        let near = [dvec3(-20.0, 0.0, 5.0), dvec3(20.0, 0.0, 5.0)];
        let far = [(-20.0 * direction).extend(0.0), (20.0 * direction).extend(0.0)];
        let halo = DrawOptions { halo_mm: 0.8, ..plain() };
        for wires in [[&near[..], &far[..]], [&far[..], &near[..]]] {
            let strokes = drawn(&scene(&wires, &[]), halo).drawing;
            let gap = 2.0 * 0.8 / angle_deg.to_radians().sin();
            assert_eq!(strokes.len(), 3, "{angle_deg}");
            assert!((ink(&strokes) - (80.0 - gap)).abs() < 1e-9, "{angle_deg}: {}", ink(&strokes));
        }
    }
}

#[test]
fn lines_that_meet_have_no_halo_and_a_line_that_ends_behind_a_face_stops_short() {
    let halo = DrawOptions { halo_mm: 0.8, ..plain() };
    let cross = [
        [dvec3(-9.0, 0.0, 1.0), dvec3(9.0, 0.0, 1.0)],
        [dvec3(0.0, -9.0, 1.0), dvec3(0.0, 9.0, 1.0)],
    ];
    let strokes = drawn(&scene(&[&cross[0], &cross[1]], &[]), halo).drawing;
    assert!((ink(&strokes) - 36.0).abs() < 1e-9);
    let plate =
        [(0, -10), (20, -10), (20, 10), (0, 10)].map(|(x, y)| dvec3(x.into(), y.into(), 5.0));
    let rod = [dvec3(-20.0, 0.0, 0.0), dvec3(10.0, 0.0, 0.0)];
    let strokes = drawn(&scene(&[&rod], &[&plate]), halo).drawing;
    assert!((ink(&strokes) - (80.0 + 20.0 - 0.8)).abs() < 1e-9, "{}", ink(&strokes));
}

#[test]
fn halos_are_as_wide_in_perspective_and_for_what_is_nearer_by_a_pens_width_there() {
    // A millimeter of the model is one on paper at the distance of the eye.
    let projection = Projection::Perspective { fov_deg: 20.0, near: 1e-6 };
    let camera = Camera::new(dvec3(0.0, 0.0, 1000.0), DVec3::ZERO, DVec3::Y, projection).unwrap();
    let n_strokes = |height: f64| {
        let near = [dvec3(-20.0, 0.0, height), dvec3(20.0, 0.0, height)];
        let far = [dvec3(0.0, -20.0, 0.0), dvec3(0.0, 20.0, 0.0)];
        let options = DrawOptions { halo_mm: 0.8, pen_width_mm: PEN, ..plain() };
        let strokes = draw(&scene(&[&near, &far], &[]), &camera, &options, 1000.0).drawing;
        let gap = 40.0 + 40.0 / (1.0 - height / 1000.0) - 1000.0 * ink(&strokes);
        assert!(gap.abs() < 1e-6 || (gap - 1.6).abs() < 1e-6, "{height}: {gap}");
        strokes.len()
    };
    assert_eq!([0.2, 0.29, 0.31, 1.0, 30.0].map(n_strokes), [2, 2, 3, 3, 3]);
}

#[test]
fn creases_have_no_halo() {
    // A roof over a rod: its ridge is a crease.
    let side = |x: f64| {
        [dvec3(0.0, -10.0, 9.0), dvec3(0.0, 10.0, 9.0), dvec3(x, 10.0, 4.0), dvec3(x, -10.0, 4.0)]
    };
    let mut other = side(-10.0);
    other.reverse();
    let mut soup = PolygonSoup::default();
    soup.positions.extend(side(10.0));
    soup.positions.extend(&other[..2]);
    soup.push_face(&[0, 1, 2, 3]);
    soup.push_face(&[1, 0, 4, 5]);
    soup.positions.extend([dvec3(-8.0, 0.0, 0.0), dvec3(8.0, 0.0, 0.0)]);
    soup.push_wire(&[6, 7]);
    let scene = Scene::new(Mesh::new(soup).unwrap().0);
    let options = DrawOptions { halo_mm: 0.8, hidden: HiddenLines::Solid, ..plain() };
    let strokes = drawn(&scene, options).drawing;
    let kinds: Vec<StrokeKind> = strokes.iter().map(|stroke| stroke.kind).collect();
    assert!(kinds.contains(&StrokeKind::Crease), "{kinds:?}");
    let hidden: Vec<&[DVec2]> = strokes.iter().filter(|s| s.qi > 0).map(|s| s.points).collect();
    let length: f64 = hidden.iter().map(|points| points[0].distance(points[1])).sum();
    assert!(hidden.len() == 1 && (length - 16.0).abs() < 1e-9, "{hidden:?}");
}

#[test]
fn a_cube_has_no_halos() {
    let mut model = crate::scenes::Model::default();
    model.add_box([0.0; 3], [20.0; 3]);
    let mut soup = PolygonSoup::default();
    soup.positions.extend(model.positions.iter().map(|&p| DVec3::from_array(p)));
    model.faces.iter().for_each(|face| soup.push_face(face));
    let scene = Scene::new(Mesh::new(soup).unwrap().0);
    for projection in
        [Projection::Orthographic, Projection::Perspective { fov_deg: 40.0, near: 1e-6 }]
    {
        let camera =
            Camera::new(dvec3(70.0, -50.0, 60.0), DVec3::splat(10.0), DVec3::Z, projection)
                .unwrap();
        let scale = if projection == Projection::Orthographic { 1.0 } else { 100.0 };
        let [without, with] = [0.0, 0.8].map(|halo_mm| {
            draw(&scene, &camera, &DrawOptions { halo_mm, ..plain() }, scale).drawing
        });
        assert_eq!(without, with);
    }
}

/// A bump before a large plate: seen against the plate, not the background.
fn bump(size: f64) -> Scene {
    let plate =
        [(-50, -50), (50, -50), (50, 50), (-50, 50)].map(|(x, y)| dvec3(x.into(), y.into(), -9.0));
    let mut soup = PolygonSoup::default();
    soup.positions.extend(plate);
    soup.push_face(&[0, 1, 2, 3]);
    let corners = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
    soup.positions.extend(corners.map(|(x, y)| dvec3(x * size / 2.0, y * size / 2.0, 0.0)));
    soup.positions.extend([dvec3(0.0, 0.0, 1.0), dvec3(0.0, 0.0, -1.0)]);
    for k in 0..4 {
        let (a, b) = (4 + k, 4 + (k + 1) % 4);
        soup.push_face(&[a, b, 8]);
        soup.push_face(&[b, a, 9]);
    }
    Scene::new(Mesh::new(soup).unwrap().0)
}

#[test]
fn specks_before_a_surface_are_left_out_and_larger_figures_are_not() {
    let silhouettes = LineSelection::NONE.with(StrokeKind::Silhouette);
    let n =
        |size: f64| drawn(&bump(size), DrawOptions { lines: silhouettes, ..plain() }).drawing.len();
    assert_eq!((n(0.2), n(0.5), n(3.0)), (0, 1, 1));
}

#[test]
fn nothing_is_tidied_without_a_pens_width_or_in_exact_drawings() {
    let lines = [[dvec2(0.0, 0.0), dvec2(10.0, 0.0)], [dvec2(10.2, 0.0), dvec2(20.0, 0.1)]];
    let wires = lines.map(|l| l.map(|p| p.extend(0.0)));
    let scene = scene(&[&wires[0], &wires[1]], &[]);
    let without = draw(&scene, &from_above(), &DrawOptions { pen_width_mm: 0.0, ..plain() }, 1.0);
    let exact = drawn(&scene, plain().exact());
    assert_eq!((without.drawing.len(), exact.drawing.len()), (2, 2));
    assert_eq!(drawn(&scene, plain()).drawing.len(), 1);
}

#[test]
fn the_outline_runs_past_cracks_narrower_than_the_pen_and_into_wider_ones() {
    let outline = |gap: f64| {
        let square = |low: f64| {
            [(low, 0.0), (low + 20.0, 0.0), (low + 20.0, 20.0), (low, 20.0)]
                .map(|(x, y)| dvec3(x, y, 0.0))
        };
        let (one, other) = (square(0.0), square(20.0 + gap));
        let lines = LineSelection::NONE.with_outline();
        let strokes = drawn(&scene(&[], &[&one, &other]), DrawOptions { lines, ..plain() }).drawing;
        assert!(strokes.iter().all(|stroke| stroke.outline));
        (strokes.len(), ink(&strokes))
    };
    let (n, length) = outline(0.1);
    assert_eq!(n, 1);
    assert!((length - 120.2).abs() < 1.0, "{length}");
    let (n, length) = outline(1.0);
    assert_eq!(n, 2);
    assert!((length - 160.0).abs() < 1e-9, "{length}");
    // All borders, of which those along a crack are no outline.
    let lines = LineSelection::default().with_outline();
    let square = [(0, 0), (20, 0), (20, 20), (0, 20)].map(|(x, y)| dvec3(x.into(), y.into(), 0.0));
    let moved = square.map(|p| p + dvec3(20.1, 0.0, 0.0));
    let strokes = drawn(&scene(&[], &[&square, &moved]), DrawOptions { lines, ..plain() }).drawing;
    let inner: f64 = strokes
        .iter()
        .filter(|stroke| !stroke.outline)
        .flat_map(|s| s.points.windows(2))
        .map(|p| p[0].distance(p[1]))
        .sum();
    // The one line that stays of two within half a pen's width.
    assert!((18.0..21.0).contains(&inner), "{inner}");
}

#[test]
fn what_lies_before_the_near_plane_is_no_background_to_hide() {
    // A plate, and a larger one between it and the eye that the near plane takes away.
    let plate = |low: DVec2, high: DVec2, z: f64| {
        [low, dvec2(high.x, low.y), high, dvec2(low.x, high.y)].map(|p| p.extend(z))
    };
    let seen = plate(DVec2::ZERO, DVec2::splat(20.0), 0.0);
    let before = plate(dvec2(11.0, -30.0), dvec2(60.0, 50.0), 30.0);
    let (eye, target) = (dvec3(10.0, 10.0, 50.0), dvec3(10.0, 10.0, 0.0));
    let lines = LineSelection::NONE.with_outline();
    let outline = |near: f64| {
        let projection = Projection::Perspective { fov_deg: 40.0, near };
        let camera = Camera::new(eye, target, DVec3::Y, projection).unwrap();
        let options = DrawOptions { lines, pen_width_mm: PEN, ..plain() };
        // A millimeter on paper to the unit, where the plate is.
        let scene = scene(&[], &[&seen, &before]);
        50.0 * ink(&draw(&scene, &camera, &options, 50.0).drawing)
    };
    assert!((outline(0.5) - 80.0).abs() < 1e-6, "{}", outline(0.5));
    assert!(outline(0.01) > 200.0, "{}", outline(0.01));
}

#[test]
fn where_lines_are_thinned_the_outline_stays() {
    // A fold close to the border of a plate: its edge is a silhouette.
    let plate = [(0, 0), (20, 0), (20, 20), (0, 20)].map(|(x, y)| dvec3(x.into(), y.into(), 0.0));
    let fold = [
        dvec3(5.0, 1.0, 2.0),
        dvec3(19.2, 1.0, 1.5),
        dvec3(19.2, 19.0, 1.5),
        dvec3(5.0, 19.0, 2.0),
        dvec3(5.0, 1.0, 1.0),
        dvec3(5.0, 19.0, 1.0),
    ];
    let mut soup = PolygonSoup::default();
    soup.positions.extend(plate);
    soup.positions.extend(fold);
    soup.push_face(&[0, 1, 2, 3]);
    soup.push_face(&[4, 5, 6, 7]);
    soup.push_face(&[5, 8, 9, 6]);
    let scene = Scene::new(Mesh::new(soup).unwrap().0);
    let right = |thin_mm: Option<f64>| {
        let strokes = drawn(&scene, DrawOptions { thin_mm, ..plain() }).drawing;
        let pairs = strokes.iter().flat_map(|s| s.points.windows(2));
        let mut lengths = [0.0; 2];
        for pair in pairs.filter(|p| p[0].x == p[1].x && p[0].x > 19.0) {
            lengths[usize::from(pair[0].x > 19.9)] += pair[0].distance(pair[1]);
        }
        lengths
    };
    assert_eq!(right(None), [18.0, 20.0]);
    let [fold, border] = right(Some(1.2));
    assert!(fold < 2.0 && (border - 20.0).abs() < 1e-9, "{fold} {border}");
}
