//! Cameras around the vertical, and the frame that holds all of their images.

use glam::{DVec3, dvec3};
use hiddenline::stages::camera::framing::View;
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;
use proptest::prelude::*;

fn whole() -> impl Strategy<Value = DVec3> {
    [-9i32..9, -9i32..9, -9i32..9].prop_map(|p| DVec3::from_array(p.map(f64::from)))
}

fn cameras() -> impl Strategy<Value = Camera> {
    let projection = prop_oneof![
        Just(Projection::Orthographic),
        (1.0..170.0, 1e-6..0.9)
            .prop_map(|(fov_deg, near)| Projection::Perspective { fov_deg, near }),
    ];
    (whole(), whole(), whole(), projection)
        .prop_filter_map("no camera", |(eye, target, up, p)| Camera::new(eye, target, up, p).ok())
}

proptest! {
    #[test]
    fn quarter_turns_are_exact(camera in cameras()) {
        let around = camera.turntable(4).expect("cameras");
        let quarter = |p: DVec3| dvec3(-p.y, p.x, p.z);
        let mut expected = camera.eye() - camera.target();
        let mut up = camera.up();
        for turned in &around {
            prop_assert_eq!(turned.eye(), camera.target() + expected);
            prop_assert_eq!(turned.target(), camera.target());
            prop_assert_eq!(turned.up(), up);
            prop_assert_eq!(turned.projection(), camera.projection());
            (expected, up) = (quarter(expected), quarter(up));
        }
        prop_assert_eq!(around[0], camera);
        prop_assert_eq!(around.len(), 4);
    }

    #[test]
    fn turning_the_camera_turns_the_image_of_the_scene(
        camera in cameras(),
        angle_deg in -400.0..400.0,
        point in whole(),
    ) {
        let turned = camera.turned(angle_deg).expect("a camera");
        let (sin, cos) = (libm::sin(f64::to_radians(angle_deg)), libm::cos(f64::to_radians(angle_deg)));
        let p = point - camera.target();
        let point_turned = camera.target() + dvec3(cos * p.x - sin * p.y, sin * p.x + cos * p.y, p.z);
        let depth = (point - camera.eye()).dot(camera.forward()) / camera.forward().length();
        prop_assume!(depth > 0.1);
        let (one, other) = (camera.image(point), turned.image(point_turned));
        prop_assert!(one.distance(other) < 1e-9 * (1.0 + one.length()), "{} {}", one, other);
    }

    #[test]
    fn a_framing_made_from_a_camera_gives_it_back(camera in cameras(), far in 0.0..1e9_f64) {
        let bounds = (DVec3::splat(-far), DVec3::splat(far + 1.0));
        prop_assert_eq!(View::from(&camera).camera(bounds).expect("a camera"), camera);
    }
}

#[test]
fn the_frame_of_a_turntable_is_as_wide_as_the_widest_view() {
    let corner = |k: u8| dvec3(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2 & 1));
    let positions = (0..8).map(corner).collect();
    let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
    for face in [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    {
        soup.push_face(&face);
    }
    let scene = Scene::new(Mesh::new(soup).expect("a mesh").0);
    let (low, high) = scene.mesh().bounds().expect("a box");
    let middle = low / 2.0 + high / 2.0;
    let side = high.x - low.x;
    let eye = middle - 10.0 * side * DVec3::Y;
    let camera = Camera::new(eye, middle, DVec3::Z, Projection::Orthographic).expect("a camera");
    let frame = |n| scene.extent_of_views(&camera.turntable(n).expect("cameras"));
    for (n, widest) in [(4, 1.0), (8, 2f64.sqrt())] {
        let (low, high) = frame(n).corners().expect("an extent");
        let size = (high - low) / side;
        assert!((size.x - widest).abs() < 1e-12 && (size.y - 1.0).abs() < 1e-12, "{n}: {size}");
    }
    assert_eq!(frame(0).corners(), None);
}
