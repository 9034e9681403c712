//! Surfaces of formulas are cut off exactly where their heights leave the range that is asked for.

use std::f64::consts::PI;

use hiddenline::glam::{DVec2, DVec3};
use hiddenline::stages::draw::surface::{SurfaceOutput, draw_surface};
use hiddenline::{Aspect, PageOptions, Surface, SurfaceLines, View};

fn bowl(low: f64, high: f64, samples: usize) -> Surface {
    let bowl = Surface::formula("x^2 + y^2").expect("a formula").aspect(Aspect::Data);
    bowl.x(-3.0, 3.1).y(-2.9, 3.0).z(low, high).samples(samples, samples)
}

/// The area of a surface in space, and that of its map.
fn areas(surface: &Surface) -> [f64; 2] {
    let scene = surface.scene().expect("a scene");
    let at = scene.mesh().positions();
    let mut areas = [0.0; 2];
    for corners in scene.triangles() {
        let [p, q, r] = corners.map(|corner| at[corner as usize]);
        let normal = 0.5 * (q - p).cross(r - p);
        areas = [areas[0] + normal.length(), areas[1] + normal.z.abs()];
    }
    areas
}

#[test]
fn a_bowl_has_the_area_between_two_heights() {
    // π/6 · (1 + 4z)^{3/2} up to a height z.
    let below = |z: f64| PI / 6.0 * ((1.0 + 4.0 * z).powf(1.5) - 1.0);
    for samples in [80, 81] {
        for (low, high) in [(0.0, 4.0), (1.0, 4.0), (-2.0, 2.5), (0.3, 7.0)] {
            let [area, of_map] = areas(&bowl(low, high, samples));
            let expected = below(high) - below(low.max(0.0));
            assert!((area / expected - 1.0).abs() < 3e-3, "{low} {high}: {area} of {expected}");
            let expected = PI * (high - low.max(0.0));
            assert!((of_map / expected - 1.0).abs() < 3e-3, "{low} {high}: {of_map} of {expected}");
        }
    }
}

/// The ends of the strokes of a map, by x and y.
fn map(output: &SurfaceOutput) -> Vec<[DVec2; 2]> {
    let origin = output.camera.eye().truncate();
    let ends = |points: &[DVec2]| [points[0] + origin, points[points.len() - 1] + origin];
    output.drawn.drawing.iter().map(|stroke| ends(stroke.points)).collect()
}

#[test]
fn lines_end_where_the_range_does() {
    let lines = SurfaceLines::default().without_axes();
    for samples in [20, 33] {
        let surface = bowl(1.0, 4.0, samples);
        let output = draw_surface(&surface, &View::top(), &lines, &PageOptions::default());
        let output = output.expect("a drawing");
        let ends = map(&output);
        assert!(ends.len() > 20);
        let (mut n_inner, mut n_outer) = (0, 0);
        for end in ends.concat() {
            let radius = end.length();
            n_inner += usize::from((radius - 1.0).abs() < 1e-6);
            n_outer += usize::from((radius - 2.0).abs() < 1e-6);
            assert!((0.999..2.001).contains(&radius), "{end}");
        }
        assert!(n_inner > 10 && n_outer > 10, "{n_inner} {n_outer}");
    }
}

#[test]
fn a_range_keeps_the_box_and_leaves_poles_to_the_reader() {
    let pole = Surface::formula("1/x").expect("a formula").z(-2.0, 3.0).samples(40, 40);
    let sampled = pole.sample().expect("samples");
    assert_eq!(sampled.ranges()[2], (-2.0, 3.0));
    let output = draw_surface(
        &pole,
        &View::from_angles(30.0, 25.0),
        &SurfaceLines::default(),
        &PageOptions::default(),
    );
    assert!(
        output.expect("a drawing").notes.iter().all(|note| !note.to_string().contains("grows"))
    );
    // A range that nothing is in, and one that all is in: the box is as high, and stands for more.
    assert!(Surface::formula("x + y").expect("a formula").z(20.0, 30.0).sample().is_err());
    let all = Surface::formula("x + y").expect("a formula");
    let bounds = |surface: &Surface| surface.sample().expect("samples").bounds();
    let (low, high) = bounds(&all);
    let halved = DVec3::new(1.0, 1.0, 0.5);
    assert_eq!(bounds(&all.clone().z(-20.0, 20.0)), (low * halved, high * halved));
    assert!(bounds(&all).0.cmplt(DVec3::ZERO).all());
}
