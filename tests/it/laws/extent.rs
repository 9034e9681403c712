//! Extents: what a page is fitted to, against closed forms and clipping by hand.

use glam::{DVec2, DVec3, dvec2, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::extent::Extent;
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::page::{Page, PageOptions, Placement};
use hiddenline::stages::strokes::StrokeKind;
use hiddenline::stages::surface::lattice_extent;

/// Looks along +y from the origin, so the image of a point is (x / y, z / y).
fn perspective(near: f64) -> Camera {
    let projection = Projection::Perspective { fov_deg: 40.0, near };
    Camera::new(DVec3::ZERO, DVec3::Y, DVec3::Z, projection).unwrap()
}

fn orthographic() -> Camera {
    Camera::new(DVec3::ZERO, DVec3::Y, DVec3::Z, Projection::Orthographic).unwrap()
}

/// The corners, rounded to multiples of a billionth.
fn corners(extent: Extent) -> Option<[DVec2; 2]> {
    let rounded = |p: DVec2| (p * 1e9).round() / 1e9 + DVec2::ZERO;
    extent.corners().map(|(low, high)| [rounded(low), rounded(high)])
}

fn triangle(points: [DVec3; 3]) -> Scene {
    let positions = points.to_vec();
    let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
    soup.push_face(&[0, 1, 2]);
    Scene::new(Mesh::new(soup).unwrap().0)
}

#[test]
fn the_extent_of_points_in_view_is_the_box_of_their_images() {
    let scene = triangle([dvec3(-2.0, 4.0, 0.0), dvec3(1.0, 4.0, 2.0), dvec3(0.0, 2.0, -1.0)]);
    let expected = [dvec2(-0.5, -0.5), dvec2(0.25, 0.5)];
    assert_eq!(corners(scene.extent(&perspective(1e-6))), Some(expected));
    let expected = [dvec2(-2.0, -1.0), dvec2(1.0, 2.0)];
    assert_eq!(corners(scene.extent(&orthographic())), Some(expected));
}

#[test]
fn what_lies_beyond_sixty_degrees_is_clipped_there() {
    // From the middle of the image to a point 10 units to the right of it, one unit away.
    let scene = triangle([dvec3(0.0, 1.0, 0.0), dvec3(10.0, 1.0, 0.0), dvec3(0.0, 1.0, 1.0)]);
    let sqrt_3 = 3f64.sqrt();
    let right = (sqrt_3 * 1e9).round() / 1e9;
    assert_eq!(corners(scene.extent(&perspective(1e-6))), Some([DVec2::ZERO, dvec2(right, 1.0)]));
    let expected = [DVec2::ZERO, dvec2(10.0, 1.0)];
    assert_eq!(corners(scene.extent(&orthographic())), Some(expected));
}

#[test]
fn where_nothing_lies_within_sixty_degrees_everything_counts() {
    let scene = triangle([dvec3(10.0, 1.0, 0.0), dvec3(12.0, 1.0, 0.0), dvec3(11.0, 1.0, 1.0)]);
    let expected = [dvec2(10.0, 0.0), dvec2(12.0, 1.0)];
    assert_eq!(corners(scene.extent(&perspective(1e-6))), Some(expected));
}

#[test]
fn the_near_plane_cuts_segments() {
    // The near plane is y = 1. Two sides reach it at x = 1 and x = 0.5.
    let scene = triangle([dvec3(0.0, 3.0, 0.0), dvec3(1.5, 0.0, 0.0), dvec3(0.75, 0.0, 0.75)]);
    let expected = [DVec2::ZERO, dvec2(1.0, 0.5)];
    assert_eq!(corners(scene.extent(&perspective(1.0))), Some(expected));
    // All of it lies before the near plane, or exactly on it.
    let scene = triangle([dvec3(0.0, 0.5, 0.0), dvec3(1.0, 0.5, 0.0), dvec3(0.0, 0.25, 1.0)]);
    assert_eq!(corners(scene.extent(&perspective(1.0))), None);
    let scene = triangle([dvec3(0.0, 1.0, 0.0), dvec3(1.0, 1.0, 0.0), dvec3(0.0, 1.0, 1.0)]);
    assert_eq!(corners(scene.extent(&perspective(1.0))), Some([DVec2::ZERO, DVec2::ONE]));
}

#[test]
fn holes_of_a_lattice_do_not_count() {
    // Three by two samples at y = 1, the last of each row a hole or far to the side.
    let samples = |far: f64| {
        move |k: usize| match k {
            2 => DVec3::NAN,
            5 => dvec3(far, 1.0, 1.0),
            _ => dvec3((k % 3) as f64 / 2.0, 1.0, (k / 3) as f64),
        }
    };
    for camera in [perspective(1e-6), orthographic()] {
        let extent = lattice_extent(3, 6, samples(1.5), &camera);
        assert_eq!(corners(extent), Some([DVec2::ZERO, dvec2(1.5, 1.0)]));
    }
    // Only the segment from (0.5, 1) to (9, 1) leaves the window.
    let extent = lattice_extent(3, 6, samples(9.0), &perspective(1e-6));
    let right = (3f64.sqrt() * 1e9).round() / 1e9;
    assert_eq!(corners(extent), Some([DVec2::ZERO, dvec2(right, 1.0)]));
}

#[test]
fn a_page_is_placed_alike_whatever_lines_are_chosen() {
    // A flat pyramid seen from above: its silhouette is its base, its creases meet at the top.
    let positions = [[-1.0, 4.0, -1.0], [1.0, 4.0, -1.0], [1.0, 4.0, 1.0], [-1.0, 4.0, 1.0]]
        .map(DVec3::from_array)
        .to_vec();
    let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
    soup.positions.push(dvec3(0.0, 2.0, 0.0));
    for [a, b] in [[1, 0], [2, 1], [3, 2], [0, 3]] {
        soup.push_face(&[a, b, 4]);
    }
    let scene = Scene::new(Mesh::new(soup).unwrap().0);
    let camera = perspective(1e-6);
    let extent = scene.extent(&camera);
    assert_eq!(corners(extent), Some([dvec2(-0.25, -0.25), dvec2(0.25, 0.25)]));
    let options = PageOptions::default();
    let page = Page::place(&extent, &camera, &options).unwrap();
    assert!((page.mm_per_image_unit() - 190.0 / 0.5).abs() < 1e-9);
    // What is drawn of a convex body reaches its border.
    let drawn = draw(&scene, &camera, &DrawOptions::default(), page.mm_per_image_unit());
    assert_eq!(drawn.drawing.extent(&camera), extent);
    assert!(drawn.drawing.iter().any(|stroke| stroke.kind == StrokeKind::Crease));
    let scaled = PageOptions { placement: Placement::Scale { mm_per_unit: 7.0 }, ..options };
    let page = Page::place(&extent, &camera, &scaled).unwrap();
    assert!((page.mm_per_image_unit() - 7.0).abs() < 1e-12);
}

#[test]
fn the_extent_of_several_views_is_the_box_around_all() {
    let scene = triangle([dvec3(-2.0, 4.0, 0.0), dvec3(1.0, 4.0, 2.0), dvec3(0.0, 2.0, -1.0)]);
    let from_behind =
        Camera::new(DVec3::ZERO, DVec3::NEG_Y, DVec3::Z, Projection::Orthographic).unwrap();
    let both = scene.extent(&orthographic()).union(scene.extent(&from_behind));
    assert_eq!(corners(both), Some([dvec2(-2.0, -1.0), dvec2(2.0, 2.0)]));
    assert_eq!(both.union(Extent::EMPTY), both);
    assert_eq!(Extent::EMPTY.corners(), None);
}
