//! Named views and axes against closed forms.

use glam::{DVec2, DVec3, dvec2, dvec3};
use hiddenline::stages::axes::{
    Axes, AxesBox, AxesLayout, AxesSize, AxesStyle, Economy, Titles, text,
};
use hiddenline::stages::camera::framing::{NamedView, Standpoint, View};
use hiddenline::stages::camera::{Camera, CameraError, Projection};
use hiddenline::stages::strokes::StrokeKind;
use hiddenline::stages::surface::AxisScale;

const CUBE: (DVec3, DVec3) = (DVec3::NEG_ONE, DVec3::ONE);

#[test]
fn named_views_shorten_the_axes_as_the_textbooks_say() {
    for (view, expected) in [
        (NamedView::Isometric, [0.8165, 0.8165, 0.8165]),
        // Two axes alike, the third half as long: sqrt(8)/3 and sqrt(2)/3.
        (NamedView::Dimetric, [0.9428, 0.4714, 0.9428]),
        // cos² 30° + sin² 30° sin² 25°, sin² 30° + cos² 30° sin² 25°, cos² 25°, of each the root.
        (NamedView::Trimetric, [0.89143, 0.61964, 0.90631]),
        (NamedView::Front, [1.0, 0.0, 1.0]),
        (NamedView::Right, [0.0, 1.0, 1.0]),
        (NamedView::Top, [1.0, 1.0, 0.0]),
    ] {
        let standpoint = Standpoint::Named { view, distance: None };
        let camera = View { standpoint, ..View::default() }.camera(CUBE).expect("a camera");
        let at = |p: DVec3| camera.image(p);
        let lengths = DVec3::AXES.map(|axis| at(axis).distance(at(DVec3::ZERO)));
        let off = lengths.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-4, "{view:?}: {lengths:?}");
    }
}

/// The lines and ticks of the axes around a box, and how many strokes its lettering has. Numbers are 1.4
/// units of the image high.
fn lines_and_text(
    (low, high): (DVec3, DVec3),
    factor: f64,
    camera: &Camera,
) -> (Vec<[DVec2; 2]>, usize) {
    let titles = Titles { axes: Default::default(), drawing: String::new() };
    let scales = [1.0, 1.0, factor].map(AxisScale::linear);
    let ranges = [0, 1, 2].map(|k| (scales[k].value(low[k]), scales[k].value(high[k])));
    let around = AxesBox { low, high, scales, ranges, z_may_grow: false };
    let axes = Axes::new(AxesStyle::Edges).titles(titles);
    let size = AxesSize { text_mm: 1.4, mm_per_unit: 1.0, economy: Economy::None };
    let layout = AxesLayout::new(&around, camera, &axes, &size).expect("a layout");
    let drawing = layout.strokes();
    let of = |kind| drawing.iter().filter(move |stroke| stroke.kind == kind);
    let lines = of(StrokeKind::Axis).map(|stroke| [stroke.points[0], stroke.points[1]]).collect();
    (lines, of(StrokeKind::Text).count())
}

#[test]
fn axes_run_along_the_outline_of_the_box_z_on_the_left_and_the_others_below() {
    let (low, high) = (dvec3(-1.0, -2.0, -0.5), dvec3(3.0, 1.0, 1.5));
    let middle = low / 2.0 + high / 2.0;
    for step in 0..24 {
        let azimuth = f64::from(step) * 0.26 + 0.1;
        for elevation in [-0.8, -0.2, 0.3, 0.9] {
            let flat = libm::cos(elevation);
            let (sin, cos) = (libm::sin(azimuth), libm::cos(azimuth));
            let way = dvec3(sin * flat, -cos * flat, libm::sin(elevation));
            for projection in
                [Projection::Orthographic, Projection::Perspective { fov_deg: 30.0, near: 1e-3 }]
            {
                let camera = Camera::new(middle + 20.0 * way, middle, DVec3::Z, projection)
                    .expect("a camera");
                let corner = |k: usize| {
                    let pick = |i: usize| if k >> i & 1 == 1 { high[i] } else { low[i] };
                    camera.image(dvec3(pick(0), pick(1), pick(2)))
                };
                let on_outline = |[a, b]: [DVec2; 2]| {
                    let sides = (0..8).map(|k| (b - a).perp_dot(corner(k) - a));
                    let (least, most) =
                        sides.fold((0.0_f64, 0.0_f64), |(l, m), s| (l.min(s), m.max(s)));
                    least > -1e-9 || most < 1e-9
                };
                let (found, _) = lines_and_text((low, high), 1.0, &camera);
                for axis in 0..3 {
                    let edges = (0..8).filter(|k| k >> axis & 1 == 0);
                    let edges = edges.map(|k| [corner(k), corner(k | 1 << axis)]);
                    let outline: Vec<[DVec2; 2]> = edges.filter(|e| on_outline(*e)).collect();
                    assert!(outline.len() >= 2);
                    let key = |[a, b]: &[DVec2; 2]| if axis == 2 { a.x + b.x } else { a.y + b.y };
                    let best = outline.iter().min_by(|a, b| key(a).total_cmp(&key(b)));
                    let is_best = |line: &&[DVec2; 2]| {
                        best.is_some_and(|best| (0..2).all(|k| line[k].distance(best[k]) < 1e-9))
                    };
                    let n = found.iter().filter(is_best).count();
                    assert_eq!(n, 1, "axis {axis} at {azimuth}, {elevation}, {projection:?}");
                }
            }
        }
    }
}

#[test]
fn numbers_on_the_z_axis_are_heights_before_scaling() {
    // A wall from 0 to 28 that shows heights from 0 to 4, seen from the front.
    let bounds = (dvec3(0.0, 0.0, 0.0), dvec3(0.0, 0.0, 28.0));
    let camera = Camera::new(
        dvec3(5.0, -50.0, 14.0),
        dvec3(0.0, 0.0, 14.0),
        DVec3::Z,
        Projection::Orthographic,
    )
    .expect("a camera");
    // Ticks with numbers are longer than the others.
    let feet = |lines: &[[DVec2; 2]]| {
        let ticks = lines[1..].iter().filter(|[foot, tip]| foot.distance(*tip) > 1.0);
        let mut feet: Vec<f64> = ticks.map(|tick| tick[0].y + 14.0).collect();
        feet.sort_by(f64::total_cmp);
        feet
    };
    let (lines, n_text) = lines_and_text(bounds, 7.0, &camera);
    let found = feet(&lines);
    let expected = [0.0, 7.0, 14.0, 21.0, 28.0];
    assert_eq!(found.len(), expected.len(), "{found:?}");
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}");
    let strokes = |label: &str| text(label, 1.0).0.len();
    assert_eq!(n_text, ["0", "1", "2", "3", "4"].map(strokes).iter().sum::<usize>());
    let found = feet(&lines_and_text(bounds, 1.0, &camera).0);
    assert!((found[1] - 5.0).abs() < 1e-9, "{found:?}");
    assert!(dvec2(found[0], 0.0).length() < 1e-9);
}

#[test]
fn the_eye_is_where_the_sphere_around_the_target_fills_the_view() {
    let box_around = (DVec3::ZERO, dvec3(2.0, 3.0, 6.0));
    // The farthest corner is 7 away from either end of the diagonal, and 3.5 from its middle.
    for (target, radius) in
        [(dvec3(1.0, 1.5, 3.0), 3.5), (DVec3::ZERO, 7.0), (dvec3(2.0, 3.0, 6.0), 7.0)]
    {
        let view = View::from_angles(30.0, 20.0).target(target).fov_deg(60.0);
        let camera = view.camera(box_around).expect("a camera");
        let distance = camera.forward().length();
        // Rounded up to a few binary digits.
        assert!((1.0..1.04).contains(&(distance / (2.0 * radius))), "{target}: {distance}");
    }
}

#[test]
fn a_field_of_view_is_less_than_half_of_all_directions() {
    for (fov_deg, expected) in [(179.0, true), (180.0, false), (200.0, false), (0.0, false)] {
        let projection = Projection::Perspective { fov_deg, near: 1e-6 };
        let camera = Camera::new(DVec3::ZERO, DVec3::Y, DVec3::Z, projection);
        assert_eq!(camera.is_ok(), expected, "{fov_deg}");
        assert!(expected || camera == Err(CameraError::FieldOfView));
    }
}
