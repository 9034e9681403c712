//! The camera against the projections of the literature, and the views that have names.

use glam::{DVec2, DVec3, dvec2, dvec3};
use hiddenline::stages::camera::framing::{NamedView, ProjectionKind, Standpoint, View, ViewError};
use hiddenline::stages::camera::{Camera, CameraError, Projection};
use hiddenline::stages::classify::{LineSelection, ViewedScene};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::strokes::StrokeKind;

const PERSPECTIVE: Projection = Projection::Perspective { fov_deg: 30.0, near: 1e-6 };

/// Points scattered in front of the observer and around, none of them special.
fn some_points() -> Vec<DVec3> {
    let mut seed = 1_u32;
    let mut next = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(seed >> 8) / f64::from(1 << 24) - 0.5
    };
    (0..50).map(|_| dvec3(next(), next(), next())).collect()
}

/// Checks that `theirs` is `ours` times a positive factor, mirrored if `mirror`.
fn assert_similar(ours: DVec2, theirs: DVec2, factor: f64, mirror: bool) {
    let expected = dvec2(if mirror { -ours.x } else { ours.x }, ours.y) * factor;
    assert!(expected.distance(theirs) <= 1e-12 * factor, "{expected} is not {theirs}");
}

/// `P1 = [1 0 0 0; 0 1 0 0; 0 0 1 0; 0 0 −1/d 0]`: center in the origin, image plane z = −d.
#[test]
fn projection_from_the_origin_is_the_camera_looking_down_z() {
    let d = 2.5;
    let camera = Camera::new(DVec3::ZERO, dvec3(0.0, 0.0, -d), DVec3::Y, PERSPECTIVE);
    let camera = camera.expect("a good camera");
    for p in some_points() {
        let p = p - 3.0 * DVec3::Z;
        let w = -p.z / d;
        assert_similar(camera.image(p), dvec2(p.x, p.y) / w, d, false);
    }
}

/// `P2 = [1 0 0 0; 0 1 0 0; 0 0 1 0; 0 0 1/d 1]`: center (0, 0, −d), image plane z = 0. Looking
/// along +z with x to the right and y up is left-handed, so the image is mirrored.
#[test]
fn projection_onto_z_zero_is_the_camera_mirrored() {
    let d = 2.5;
    let camera = Camera::new(dvec3(0.0, 0.0, -d), DVec3::ZERO, DVec3::Y, PERSPECTIVE);
    let camera = camera.expect("a good camera");
    for p in some_points() {
        let w = p.z / d + 1.0;
        assert_similar(camera.image(p), dvec2(p.x, p.y) / w, d, true);
    }
}

/// Vega-Paez, Ortega and Pulido 2008, appendix, (7) and (8), with the sign in `r` as (6) has it.
#[test]
fn projection_onto_the_plane_through_the_origin_is_the_camera() {
    let v = dvec3(3.0, -2.0, 1.5);
    let camera = Camera::new(v, DVec3::ZERO, DVec3::Z, PERSPECTIVE).expect("a good camera");
    let d1 = v.x.hypot(v.y);
    let d = v.length();
    for a in some_points() {
        let r = d * d / (d * d - (a.x * v.x + a.y * v.y + a.z * v.z));
        let image = dvec2(
            r * (a.y * v.x - a.x * v.y) / d1,
            r * (-a.x * v.x * v.z - a.y * v.y * v.z + a.z * d1 * d1) / (d * d1),
        );
        assert_similar(camera.image(a), image, d, false);
    }
}

/// A box whose middle has many digits.
const BOUNDS: (DVec3, DVec3) = (dvec3(0.1, 0.2, 0.3), dvec3(1.7, 2.3, 0.9));

fn named(view: NamedView) -> Camera {
    let standpoint = Standpoint::Named { view, distance: None };
    View { standpoint, ..View::default() }.camera(BOUNDS).expect("a good camera")
}

#[test]
fn views_along_axes_are_exactly_along_axes() {
    for (view, forward, up) in [
        (NamedView::Front, DVec3::Y, DVec3::Z),
        (NamedView::Right, DVec3::NEG_X, DVec3::Z),
        (NamedView::Back, DVec3::NEG_Y, DVec3::Z),
        (NamedView::Left, DVec3::X, DVec3::Z),
        (NamedView::Top, DVec3::NEG_Z, DVec3::Y),
        (NamedView::Bottom, DVec3::Z, DVec3::NEG_Y),
    ] {
        let camera = named(view);
        let length = camera.forward().abs().max_element();
        assert_eq!(camera.forward(), forward * length, "{}", view.name());
        assert_eq!(camera.up(), up, "{}", view.name());
        assert_eq!(camera.projection(), Projection::Orthographic);
    }
}

#[test]
fn isometric_foreshortens_all_axes_exactly_alike() {
    let forward = named(NamedView::Isometric).forward();
    assert_eq!(forward, dvec3(-1.0, 1.0, -1.0) * forward.y);
    assert!(forward.y > 0.0);
}

#[test]
fn diagonal_azimuth_is_exactly_diagonal() {
    let standpoint =
        Standpoint::Angles { azimuth_deg: 135.0, elevation_deg: 20.0, distance: Some(7.3) };
    let framing = View { standpoint, ..View::default() };
    let forward = framing.camera(BOUNDS).expect("a good camera").forward();
    assert_eq!(forward.x, forward.y);
    assert!((forward.length() - 7.3).abs() < 1e-12);
}

#[test]
fn eye_is_where_the_angles_say() {
    let standpoint =
        Standpoint::Angles { azimuth_deg: 30.0, elevation_deg: 25.0, distance: Some(2.0) };
    let target = Some(dvec3(1.0, 2.0, 3.0));
    let framing = View { standpoint, target, ..View::default() };
    let eye = framing.camera(BOUNDS).expect("a good camera").eye();
    let (az, el) = (30_f64.to_radians(), 25_f64.to_radians());
    let expected =
        dvec3(1.0, 2.0, 3.0) + 2.0 * dvec3(az.sin() * el.cos(), -az.cos() * el.cos(), el.sin());
    assert!(eye.distance(expected) < 1e-14, "{eye}");
}

#[test]
fn automatic_target_is_the_middle_of_the_box() {
    let target = View::default().camera(BOUNDS).expect("a good camera").target();
    assert!(target.distance(dvec3(0.9, 1.25, 0.6)) < 1e-5, "{target}");
}

#[test]
fn automatic_distance_shows_the_whole_box() {
    let (low, high) = BOUNDS;
    let edge = 15_f64.to_radians().tan();
    for azimuth in 0..36 {
        let standpoint = Standpoint::Angles {
            azimuth_deg: f64::from(azimuth) * 10.0,
            elevation_deg: 25.0,
            distance: None,
        };
        let camera = View { standpoint, ..View::default() }.camera(BOUNDS);
        let camera = camera.expect("a good camera");
        for corner in 0..8 {
            let pick = |bit: u32, axis: usize| {
                if corner >> bit & 1 == 0 { low[axis] } else { high[axis] }
            };
            let image = camera.image(dvec3(pick(0, 0), pick(1, 1), pick(2, 2)));
            assert!(image.abs().max_element() <= edge, "{azimuth}: {image}");
        }
    }
}

#[test]
fn up_along_the_view_is_an_error_when_given_and_y_by_default() {
    let standpoint = Standpoint::Eye(dvec3(0.5, 0.5, 9.0));
    let target = Some(dvec3(0.5, 0.5, 0.0));
    let framing = View { standpoint, target, ..View::default() };
    assert_eq!(framing.camera(BOUNDS).map(|camera| camera.up()), Ok(DVec3::Y));
    let given = View { up: Some(DVec3::Z), ..framing };
    assert_eq!(given.camera(BOUNDS), Err(ViewError::Camera(CameraError::UpParallel)));
}

#[test]
fn named_views_can_be_perspective() {
    let standpoint = Standpoint::Named { view: NamedView::Isometric, distance: None };
    let projection = Some(ProjectionKind::Perspective);
    let camera = View { standpoint, projection, ..View::default() }.camera(BOUNDS);
    assert_eq!(camera.map(|camera| camera.projection()), Ok(PERSPECTIVE));
}

#[test]
fn creases_depend_on_the_angle_not_on_the_winding() {
    let (sin, cos) = (libm::sin(40f64.to_radians()), libm::cos(40f64.to_radians()));
    let positions = vec![DVec3::ZERO, DVec3::Y, dvec3(1.0, 0.5, 0.0), dvec3(-cos, 0.5, sin)];
    let camera = Camera::new(dvec3(0.1, 0.2, 9.0), DVec3::ZERO, DVec3::Y, PERSPECTIVE).unwrap();
    for second in [[0, 1, 3], [1, 0, 3]] {
        let mut soup = PolygonSoup { positions: positions.clone(), ..PolygonSoup::default() };
        soup.push_face(&[0, 2, 1]);
        soup.push_face(&second);
        let scene = Scene::new(Mesh::new(soup).unwrap().0);
        // One scene, several angles.
        for (crease_deg, expected) in [(39.0, 1), (41.0, 0), (0.0, 1), (139.0, 0)] {
            let creases = LineSelection::NONE.with(StrokeKind::Crease);
            let view = ViewedScene::new(&scene, &camera, creases, crease_deg);
            assert_eq!(view.selected().len(), expected, "{second:?}, {crease_deg}°");
        }
    }
}
