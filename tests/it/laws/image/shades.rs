//! What pictures tell of depth and normals, on scenes with known answers.

use crate::laws::engines::{camera, mesh};
use crate::scenes::{Model, orthographic};
use glam::dvec3;
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::shading::light::LightSource;
use hiddenline::stages::shading::preview::{PreviewOptions, Show, write};

/// Columns and rows.
const SIZE: (u32, u32) = (40, 40);

/// The picture of a model seen from above, x to the right and y up: the color at a part of the way from
/// the left and from the bottom.
fn picture(model: Model, show: Show) -> impl Fn(f64, f64) -> [u8; 3] {
    let sight = orthographic([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    let scene = model.seen_by("shades", sight);
    let (built, camera) = (Scene::new(mesh(&scene)), camera(&scene));
    let options = PreviewOptions {
        size: SIZE,
        show,
        light: LightSource::From(glam::DVec3::Z),
        ..PreviewOptions::default()
    };
    let mut bytes = Vec::new();
    write(&built, &camera, &options, None, &mut bytes).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    let n = info.color_type.samples();
    move |x, y| {
        let (column, row) = (x * f64::from(SIZE.0), (1.0 - y) * f64::from(SIZE.1));
        let at = n * (row as usize * SIZE.0 as usize + column as usize);
        [0, 1, 2].map(|k| pixels[at + k.min(n - 1)])
    }
}

#[test]
fn what_is_nearer_is_lighter() {
    let mut model = Model::default();
    // Rises to the right, so the right is nearer to an eye above.
    model.face(&[[0.0, 0.0, 0.0], [4.0, 0.0, 4.0], [4.0, 4.0, 4.0], [0.0, 4.0, 0.0]]);
    let at = picture(model, Show::Depth);
    let (far, middle, near) = (at(0.1, 0.5)[0], at(0.5, 0.5)[0], at(0.9, 0.5)[0]);
    assert!(far < middle && middle < near && near > 230, "{far}, {middle}, {near}");
    // From white to a tenth, evenly.
    assert!((i32::from(middle) - 140).abs() < 8, "{middle}");
}

#[test]
fn what_something_keeps_the_light_from_has_the_tone_of_the_shade() {
    let mut model = Model::default();
    model.face(&[[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 8.0, 0.0], [0.0, 8.0, 0.0]]);
    model.add_box([2.0, 2.0, 3.0], [4.0, 4.0, 4.0]);
    let sight = orthographic([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    let scene = model.seen_by("shades", sight);
    let (built, camera) = (Scene::new(mesh(&scene)), camera(&scene));
    for light in
        [LightSource::From(dvec3(-1.0, 0.0, 1.0)), LightSource::At(dvec3(-40.0, 3.0, 43.0))]
    {
        let options = PreviewOptions { size: SIZE, show: Show::Tone, light, ..Default::default() };
        let mut bytes = Vec::new();
        write(&built, &camera, &options, None, &mut bytes).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        // The margin is a twenty-fifth of the side; world (x, y) from the lower left.
        let at = |x: f64, y: f64| {
            let pixel = |part: f64| (0.04 + 0.92 * part / 8.0) * f64::from(SIZE.0);
            pixels[pixel(8.0 - y) as usize * SIZE.0 as usize + pixel(x) as usize]
        };
        // The box is seen at 2 to 4; its shadow falls from 5 to 8.
        assert_eq!(at(6.0, 3.0), 64);
        assert!(
            at(3.0, 3.0) > 150 && at(1.0, 3.0) > 150 && at(6.0, 6.0) > 150 && at(4.6, 3.0) > 150
        );
    }
}

#[test]
fn normals_are_red_to_the_right_and_green_upwards() {
    let slope = |x: f64, y: f64| {
        let mut model = Model::default();
        let corner = |p: f64, q: f64| [p, q, -x * p - y * q];
        model.face(&[corner(0.0, 0.0), corner(4.0, 0.0), corner(4.0, 4.0), corner(0.0, 4.0)]);
        picture(model, Show::Normals)(0.5, 0.5)
    };
    // The normal of z = −x p − y q is (x, y, 1) over its length; 0.7071 is 218 of 255.
    for (x, y, expected) in [
        (0.0, 0.0, [128, 128, 255]),
        (1.0, 0.0, [218, 128, 218]),
        (-1.0, 0.0, [37, 128, 218]),
        (0.0, 1.0, [128, 218, 218]),
        (0.0, -1.0, [128, 37, 218]),
    ] {
        let found = slope(x, y);
        let is_near =
            found.iter().zip(expected).all(|(&a, b): (&u8, i32)| (i32::from(a) - b).abs() <= 1);
        assert!(is_near, "{x}, {y}: {found:?}, not {expected:?}");
    }
}

#[test]
fn backs_are_shaded_as_fronts_are() {
    let square = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]];
    let (mut front, mut back) = (Model::default(), Model::default());
    front.face(&square);
    let [a, b, c, d] = square;
    back.face(&[d, c, b, a]);
    let [front, back] = [front, back].map(|model| picture(model, Show::Tone)(0.5, 0.5));
    // Light from straight above on a level face is all of it.
    assert_eq!((front, back), ([255; 3], [255; 3]));
}

#[test]
fn what_is_turned_away_from_the_light_is_as_dark_as_in_the_shade() {
    use glam::{DVec3, dvec3};
    use hiddenline::stages::camera::{Camera, Projection};
    use hiddenline::stages::shading::light::{Light, LightSource};
    let eye = dvec3(5.0, -7.0, 4.0);
    let camera = Camera::new(eye, DVec3::ZERO, DVec3::Z, Projection::Orthographic).unwrap();
    for source in [
        LightSource::Shoulder,
        LightSource::From(dvec3(1.0, 2.0, 3.0)),
        LightSource::At(dvec3(-3.0, 1.0, 9.0)),
    ] {
        let light = Light::new(source, &camera);
        let at = dvec3(0.5, 0.25, -0.75);
        let towards = light.towards(at);
        let across = towards.any_orthonormal_vector();
        let tone = |angle_deg: f64| {
            let (sin, cos) = angle_deg.to_radians().sin_cos();
            light.tone(towards * cos + across * sin, at)
        };
        assert!((tone(0.0) - 1.0).abs() < 1e-12);
        let shade = tone(90.0001);
        assert!((tone(60.0) - (shade + 1.0) / 2.0).abs() < 1e-5);
        for angle in [95.0, 120.0, 150.0, 180.0] {
            assert!((tone(angle) - shade).abs() < 1e-5, "{source:?} at {angle}°");
        }
    }
}

#[test]
fn faces_in_one_plane_cast_no_shadows_on_each_other() {
    // Exactly in one plane; the points that are shaded are so but for rounding.
    let at = |x: f64, y: f64| [x, y, x / 2.0 + y / 4.0];
    let square = |low: f64, high: f64| [at(low, low), at(high, low), at(high, high), at(low, high)];
    for show in [Show::Tone, Show::Shaded] {
        let [alone, covered] = [false, true].map(|is_covered| {
            let mut model = Model::default();
            model.face(&square(0.0, 9.0));
            if is_covered {
                model.face(&square(1.5, 7.25));
                model.face(&[at(0.5, 0.5), at(8.0, 1.0), at(3.0, 8.5)]);
            }
            picture(model, show)
        });
        for (i, j) in (1..39).flat_map(|i| (1..39).map(move |j| (i, j))) {
            let [x, y] = [i, j].map(|k| (f64::from(k) + 0.5) / 40.0);
            assert_eq!(covered(x, y), alone(x, y), "{x}, {y}");
        }
    }
}
