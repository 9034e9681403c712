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
    let first = AxesSize { text_mm: 3.5, mm_per_unit: 1.0, economy };
    let image = AxesLayout::new(around, camera, axes, &first)?;
    let xs = image.box_in_image().iter().map(|p| p.x);
    let (low, high) =
        xs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let size = AxesSize { mm_per_unit: 160.0 / (high - low), ..first };
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
