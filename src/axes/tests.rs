//! Layouts of axes from many views: no text touches ink or other text.

use glam::{DVec2, DVec3, dvec3};

use super::text_block::TextBlock;
use super::*;
use crate::camera::framing::{ProjectionKind, View};
use crate::camera::{Camera, Projection};
use crate::surface::AxisScale;

/// A box around the origin.
fn around(size: DVec3) -> AxesBox {
    let (low, high) = (-size / 2.0, size / 2.0);
    AxesBox {
        low,
        high,
        scales: [AxisScale::DATA; 3],
        ranges: [0, 1, 2].map(|k| (low[k], high[k])),
        z_may_grow: false,
    }
}

fn camera(way: DVec3, distance: f64, projection: Projection) -> Camera {
    Camera::new(way * distance, DVec3::ZERO, DVec3::Z, projection).expect("a camera")
}

/// The direction of the eye.
fn way(azimuth: f64, elevation: f64) -> DVec3 {
    let (sin, cos) = (libm::sin(elevation), libm::cos(elevation));
    dvec3(libm::sin(azimuth) * cos, -libm::cos(azimuth) * cos, sin)
}

/// The axes of a box that is as wide as 160 mm of paper.
fn layout(around: &AxesBox, camera: &Camera, axes: &Axes, economy: Economy) -> Option<AxesLayout> {
    layout_on((160.0, 3.5), around, camera, axes, economy)
}

/// The axes of a box whose image is this many millimeters wide, with numbers of some height.
fn layout_on(
    (width_mm, text_mm): (f64, f64),
    around: &AxesBox,
    camera: &Camera,
    axes: &Axes,
    economy: Economy,
) -> Option<AxesLayout> {
    let first = AxesSize { text_mm, mm_per_unit: 1.0, economy };
    let image = AxesLayout::new(around, camera, axes, &first)?;
    let size = AxesSize { mm_per_unit: width_mm / width(&image), ..first };
    AxesLayout::new(around, camera, axes, &size)
}

const PERSPECTIVE: Projection = Projection::Perspective { fov_deg: 30.0, near: 1e-3 };

#[test]
fn no_text_touches_ink_or_other_text() {
    let long = ["the first direction of them", "the second direction", "height"].map(str::to_owned);
    let (mut n_texts, mut n_layouts) = (0, 0);
    for (number, size) in [[1.0, 1.0, 1.0], [10.0, 1.0, 0.3], [1.0, 20.0, 3.0], [2e4, 2e4, 0.7]]
        .into_iter()
        .map(DVec3::from_array)
        .enumerate()
    {
        for step in 0..10 {
            for (place, elevation) in [-0.7, 0.1, 0.4, 0.9, 1.4].into_iter().enumerate() {
                for (style, parallel) in [
                    (AxesStyle::Edges, false),
                    (AxesStyle::Base, true),
                    (AxesStyle::Back, false),
                    (AxesStyle::Box, true),
                    (AxesStyle::Box, false),
                ] {
                    let economy = Economy::ALL[(number + step + place) % Economy::ALL.len()];
                    let projection = if parallel { Projection::Orthographic } else { PERSPECTIVE };
                    let way = way(f64::from(step as u32) * 0.68, elevation);
                    let camera = camera(way, 4.0 * size.length(), projection);
                    let titles = Titles { axes: long.clone(), drawing: "A long title".to_owned() };
                    let axes = Axes::new(style).titles(titles);
                    let layout = layout(&around(size), &camera, &axes, economy);
                    let layout = layout.expect("a layout");
                    let texts: Vec<&TextBlock> = layout.texts().collect();
                    n_texts += texts.len();
                    n_layouts += 1;
                    let clearance = 0.85 * 0.5 * 3.5 * 0.999 / (160.0 / width(&layout));
                    let ink: Vec<Vec<DVec2>> =
                        layout.axes.iter().flat_map(axis::LaidAxis::ink).collect();
                    for (k, text) in texts.iter().enumerate() {
                        let others = texts[..k].iter().map(|other| other.corners().to_vec());
                        for polygon in others.chain([layout.hull.clone()]).chain(ink.clone()) {
                            assert!(
                                text.is_clear_of(&polygon, clearance),
                                "{size} {step} {elevation} {style:?} {economy:?}"
                            );
                        }
                    }
                }
            }
        }
    }
    assert!(n_texts > 12_000 && n_layouts == 1000, "{n_texts} {n_layouts}");
}

fn width(layout: &AxesLayout) -> f64 {
    let xs = layout.hull.iter().map(|p| p.x);
    let (low, high) =
        xs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    high - low
}

#[test]
fn ticks_are_not_too_slanted_and_keep_apart_on_any_paper() {
    let (mut n_slanted, mut n_minors, mut n_numbers) = (0, 0, 0);
    let sizes = [[10.0, 9.0, 4.0], [10.0, 2.0, 1.0], [3.0, 10.0, 0.5]].map(DVec3::from_array);
    let papers = [(160.0, 3.5), (60.0, 3.5), (60.0, 1.0), (20.0, 0.8)];
    for (size, paper) in sizes.into_iter().flat_map(|size| papers.map(|paper| (size, paper))) {
        for (step, (elevation, projection)) in (0..40).flat_map(|step| {
            [(0.15, PERSPECTIVE), (0.5, Projection::Orthographic), (1.2, PERSPECTIVE)]
                .map(|view| (step, view))
        }) {
            let camera = camera(way(f64::from(step) * 0.157, elevation), 30.0, projection);
            let axes = Axes::new(AxesStyle::Edges);
            let layout = layout_on(paper, &around(size), &camera, &axes, Economy::None);
            let layout = layout.expect("a layout");
            let mm = width(&layout) / paper.0;
            let name = format!("{size} on {paper:?} mm, {step} {elevation}");
            let ink: Vec<Vec<DVec2>> = layout.axes.iter().flat_map(axis::LaidAxis::ink).collect();
            for axis in &layout.axes {
                let ticks = axis.ticks.iter().map(|tick| [tick.foot, tick.tip]);
                for [foot, tip] in ticks.clone().chain(axis.minors.iter().copied()) {
                    let way = (tip - foot).normalize();
                    // 50° from the normal of the axis, and no more.
                    assert!(way.dot(axis.out) >= 0.6427, "{name}: {way}");
                    n_slanted += usize::from(way.dot(axis.out) < 0.9);
                }
                let along = (axis.ends[1] - axis.ends[0]).normalize();
                let feet = ticks.chain(axis.minors.iter().copied()).map(|[foot, _]| foot);
                let mut feet: Vec<f64> = feet.map(|foot| foot.dot(along)).collect();
                feet.sort_by(f64::total_cmp);
                if !axis.minors.is_empty() {
                    let is_apart = |pair: &[f64]| pair[1] - pair[0] > 0.999 * mm;
                    assert!(feet.windows(2).all(is_apart), "{name}");
                }
                n_minors += axis.minors.len();
                for number in axis.ticks.iter().filter_map(|tick| tick.number.as_ref()) {
                    let is_clear = |ink: &Vec<DVec2>| number.is_clear_of(ink, 0.49 * paper.1 * mm);
                    assert!(ink.iter().all(is_clear), "{name}");
                    n_numbers += 1;
                }
            }
        }
    }
    assert!(n_slanted > 200 && n_minors > 1000 && n_numbers > 1000);
}

/// The images of two ends, in whole billionths, in order.
fn line([a, b]: [DVec2; 2]) -> [[i64; 2]; 2] {
    let [a, b] = [a, b].map(|p| p.to_array().map(|x| (x * 1e9).round() as i64));
    [a.min(b), a.max(b)]
}

#[test]
fn walls_are_the_faces_behind_with_a_line_at_each_number_inside() {
    let around = around(dvec3(10.0, 12.0, 6.0));
    // From outside of all faces; between the two of x, nearer to either; straight on; from below.
    let eyes = [
        dvec3(20.0, -30.0, 15.0),
        dvec3(-30.0, 20.0, 15.0),
        dvec3(1.0, -40.0, 10.0),
        dvec3(-1.0, -40.0, 10.0),
        dvec3(2.0, -40.0, 1.0),
        dvec3(25.0, 30.0, -12.0),
    ];
    for (eye, parallel) in eyes.into_iter().flat_map(|eye| [(eye, false), (eye, true)]) {
        let projection = if parallel { Projection::Orthographic } else { PERSPECTIVE };
        let camera = camera(eye, 1.0, projection);
        let layout = layout(&around, &camera, &Axes::new(AxesStyle::Back), Economy::None);
        let layout = layout.expect("a layout");
        let toward_eye = |axis: usize, is_high: bool| {
            let side = if is_high { around.high[axis] } else { around.low[axis] };
            if parallel { eye[axis] } else { eye[axis] - side }
        };
        let mut expected = Vec::new();
        for (axis, is_high) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
            let outwards = |is_high: bool| if is_high { 1.0 } else { -1.0 };
            let is_behind = |is_high: bool| toward_eye(axis, is_high) * outwards(is_high) < 0.0;
            // Of two opposite faces that are both seen from inside, the nearer one is none.
            let [own, other] = [is_high, !is_high].map(|side| toward_eye(axis, side).abs());
            if !is_behind(is_high) || is_behind(!is_high) && own < other {
                continue;
            }
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            for (across, along) in [(b, c), (c, b)] {
                let of_axis = layout.axes.iter().find(|laid| laid.axis == across);
                let ticks = of_axis.and_then(|laid| laid.chosen.as_ref());
                let ticks = ticks.into_iter().flat_map(|ticks| &ticks.majors);
                let inner = ticks.map(|(value, _)| *value);
                let ends = [around.low[across], around.high[across]];
                for at in inner.filter(|at| !ends.contains(at)).chain(ends) {
                    expected.push(line([around.low, around.high].map(|end| {
                        let mut p = end;
                        p[axis] = if is_high { around.high[axis] } else { around.low[axis] };
                        (p[across], p[along]) = (at, end[along]);
                        camera.image(p)
                    })));
                }
            }
        }
        let axes: Vec<_> = layout.axes.iter().map(|axis| line(axis.ends)).collect();
        expected.retain(|line| !axes.contains(line));
        expected.sort_unstable();
        // Two faces share an edge.
        expected.dedup();
        let wires = layout.wires().iter().map(|wire| line(wire.ends.map(|p| camera.image(p))));
        let strokes = layout.strokes();
        let drawn = strokes.iter().filter(|stroke| stroke.kind == crate::strokes::StrokeKind::Back);
        let drawn = drawn.map(|stroke| line([stroke.points[0], stroke.points[1]]));
        let mut found: Vec<_> = wires.chain(drawn).collect();
        found.sort_unstable();
        assert_eq!(found, expected, "{eye} {projection:?}");
    }
}

#[test]
fn a_short_axis_has_fewer_ticks_than_a_long_one() {
    let titles = Titles { axes: Default::default(), drawing: String::new() };
    let flat = camera(dvec3(8.0, -30.0, 12.0), 1.0, PERSPECTIVE);
    let axes = Axes::from(titles);
    let layout = layout(&around(dvec3(10.0, 10.0, 1.0)), &flat, &axes, Economy::None);
    let layout = layout.expect("a layout");
    let count = |k: usize| layout.axes[k].texts().count();
    assert!(count(0) >= 4 && (1..=3).contains(&count(2)), "{} {}", count(0), count(2));
}

#[test]
fn ends_of_simple_ranges_have_ticks() {
    let mut n_axes = 0;
    for half in [5.0, 12.0, 3.0] {
        for step in 0..24 {
            let around = around(dvec3(2.0 * half, 2.0 * half, half));
            let camera = camera(way(f64::from(step) * 0.26, 0.43), 8.0 * half, PERSPECTIVE);
            let layout = layout(&around, &camera, &Axes::new(AxesStyle::Edges), Economy::None);
            let layout = layout.expect("a layout");
            let width = width(&layout);
            for axis in layout.axes.iter().filter(|axis| axis.axis < 2) {
                // A short axis has fewer numbers, and those of ±12 are then ±10.
                if axis.ends[0].distance(axis.ends[1]) < 65.0 / 160.0 * width {
                    continue;
                }
                n_axes += 1;
                let feet: Vec<DVec2> = axis.ticks.iter().map(|tick| tick.foot).collect();
                let has_ends = axis.ends.iter().all(|end| feet.contains(end));
                assert!(has_ends, "{half} {step} {:?}", axis.chosen);
            }
        }
    }
    assert!(n_axes > 60, "{n_axes}");
}

#[test]
fn axes_are_on_the_edges_of_the_table_by_octant() {
    // For each quarter of the azimuth: whether x is at the high y, y at the high x, z at the high x
    // and at the high y.
    let table = [
        [false, true, false, false],
        [true, true, true, false],
        [true, false, true, true],
        [false, false, false, true],
    ];
    for step in 0..72 {
        let azimuth_deg = 5 * step;
        // Where two quarters meet, that of the smaller azimuth counts.
        let [x_high, y_high, z_high_x, z_high_y] = table[(azimuth_deg + 359) / 90 % 4];
        for elevation_deg in [6.0, 30.0, 70.0] {
            for projection in [ProjectionKind::Perspective, ProjectionKind::Orthographic] {
                let view = View {
                    projection: Some(projection),
                    ..View::from_angles(azimuth_deg as f64, elevation_deg)
                };
                let around = around(dvec3(2.0, 2.0, 1.0));
                let camera = view.camera((around.low, around.high)).expect("a camera");
                // Between two opposite faces only one axis is on the outline below.
                let is_between = camera.eye().truncate().abs().min_element() <= 1.0;
                if is_between && projection == ProjectionKind::Perspective {
                    continue;
                }
                let layout = layout(&around, &camera, &Axes::new(AxesStyle::Edges), Economy::None);
                let at = |sides: [bool; 3]| {
                    let pick = |k: usize| if sides[k] { around.high[k] } else { around.low[k] };
                    camera.image(dvec3(pick(0), pick(1), pick(2)))
                };
                let expected = [
                    [at([false, x_high, false]), at([true, x_high, false])],
                    [at([y_high, false, false]), at([y_high, true, false])],
                    [at([z_high_x, z_high_y, false]), at([z_high_x, z_high_y, true])],
                ];
                let axes = layout.expect("a layout").axes;
                assert_eq!(axes.len(), 3);
                for axis in axes {
                    let place =
                        format!("{azimuth_deg} {elevation_deg} {projection:?} {}", axis.axis);
                    assert_eq!(axis.ends, expected[axis.axis], "{place}");
                }
            }
        }
    }
}

#[test]
fn a_shared_power_of_ten_is_written_once_beyond_the_end() {
    let around = around(dvec3(4e7, 2e7, 1e7));
    let camera = camera(way(0.5, 0.4), 2e8, PERSPECTIVE);
    let layout = layout(&around, &camera, &Axes::default(), Economy::None).expect("a layout");
    for axis in &layout.axes {
        let exponent = axis.exponent.as_ref().expect("a power of ten");
        let along = (axis.ends[1] - axis.ends[0]).normalize();
        assert!((exponent.anchor - axis.ends[1]).dot(along) > 0.0);
    }
}

#[test]
fn frames_have_ticks_on_all_four_sides() {
    let around = around(dvec3(10.0, 6.0, 1.0));
    let camera = Camera::new(dvec3(0.0, 0.0, 9.0), DVec3::ZERO, DVec3::Y, Projection::Orthographic);
    let camera = camera.expect("a camera");
    let layout = layout(&around, &camera, &Axes::default(), Economy::None).expect("a layout");
    assert_eq!(layout.axes.len(), 2);
    let strokes = layout.strokes();
    let is_within = |p: &DVec2| p.x.abs() <= 5.0 && p.y.abs() <= 3.0;
    let lines = strokes.iter().filter(|stroke| stroke.kind == crate::strokes::StrokeKind::Axis);
    let (mut sides, mut n_lines) = ([0; 4], 0);
    for stroke in lines.filter(|stroke| stroke.points[0].distance(stroke.points[1]) < 2.0) {
        assert!(stroke.points.iter().all(is_within));
        n_lines += 1;
        let foot = stroke.points[0];
        let on = [foot.x == -5.0, foot.x == 5.0, foot.y == -3.0, foot.y == 3.0];
        (0..4).filter(|k| on[*k]).for_each(|k| sides[k] += 1);
    }
    assert!(n_lines > 30 && sides[0] == sides[1] && sides[2] == sides[3], "{sides:?}");
}
