//! Windows of the image: the known picture, and agreement with exact regions.

use super::judge::judged;
use super::regions::warnocks_pair;
use super::{built, model, painted};
use crate::image::face;
use crate::scenes::{number_of_scenes, random};
use glam::{DVec2, dvec2};
use hiddenline::engines::face::images::Images;
use hiddenline::engines::face::warnock::{Options, Subdivision, solve};
use hiddenline::engines::face::{Painting, weiler_atherton};
use hiddenline::engines::image::{self, PixelMap, Raster, painter};
use hiddenline::framing::Framing;
use hiddenline::scene::Scene;

const BOTH: [Subdivision; 2] = [Subdivision::Regular, Subdivision::Vertices];

/// What is painted at a point, or next to it: a border belongs to what it is the border of.
fn shown(painting: &Painting, at: DVec2) -> Option<u32> {
    let mut found = None;
    for piece in painting.pieces() {
        let on_border = piece.rings().any(|ring| {
            let n = ring.points.len();
            (0..n).any(|k| super::distance(at, ring.points[k], ring.points[(k + 1) % n]) < 1e-12)
        });
        if on_border && found.is_none_or(|face| piece.face < face) {
            found = Some(piece.face);
        }
    }
    found.or(painted(painting, at).0)
}

#[test]
fn the_example_is_16_by_16_pixels_of_which_24_show_a_and_34_show_b() {
    let (scene, camera) = built(&warnocks_pair());
    for subdivision in BOTH {
        // Seen from below, the image is mirrored from left to right.
        let window = Some((dvec2(-25.5, 9.5), dvec2(-9.5, 25.5)));
        let options = Options { leaf: Some(1.0), window, subdivision };
        let painting = solve(&scene, &camera, &options).unwrap().0;
        let mut counts = [0; 3];
        for y in 10..26 {
            for x in 10..26 {
                let face = shown(&painting, dvec2(-f64::from(x), f64::from(y)));
                counts[face.map_or(2, |face| face as usize)] += 1;
                // On the border of A, and where both are equally near.
                let ties = [(19, 13), (20, 14), (21, 15), (22, 16), (17, 17), (18, 18), (19, 19)];
                if ties.contains(&(x, y)) {
                    assert_eq!(face, Some(0), "{subdivision:?}: {x}, {y}");
                }
            }
        }
        assert_eq!(counts, [24, 34, 198], "{subdivision:?}");
    }
}

#[test]
fn the_example_is_the_picture_of_the_image_space_engines() {
    let (scene, camera) = built(&warnocks_pair());
    let window = Some((dvec2(-25.5, 9.5), dvec2(-9.5, 25.5)));
    let options = Options { leaf: Some(1.0), window, subdivision: Subdivision::Regular };
    let painting = solve(&scene, &camera, &options).unwrap().0;
    let map = PixelMap { scale: 1.0, origin: dvec2(25.5, 25.5) };
    let raster = Raster::new(&scene, &camera, &map, (16, 16));
    for engine in image::Engine::ALL {
        let raster = match engine {
            image::Engine::Painter => painter::raster(&scene, &camera, &map, (16, 16)),
            _ => raster.clone(),
        };
        for (at, item) in (0..).zip(image::solve(&raster, engine)) {
            let center = dvec2(f64::from(at % 16) - 25.0, 25.0 - f64::from(at / 16));
            let expected = shown(&painting, center);
            // The painter knows only which of both is painted last, not who is first in a tie.
            let is_tie = center.x == -center.y;
            if !(is_tie && engine == image::Engine::Painter) {
                assert_eq!(face(&scene, &raster, item), expected, "{engine:?}: {center}");
            }
        }
    }
}

#[test]
fn windows_show_what_rays_meet_except_near_borders() {
    let n = number_of_scenes(100);
    let mut total = 0;
    for seed in 0..n {
        let (scene, camera) = built(&random(seed));
        let bounds = Images::new(&scene, &camera).bounds;
        let leaf = (bounds.1 - bounds.0).length() / 200.0;
        if leaf == 0.0 {
            continue;
        }
        for subdivision in BOTH {
            let options = Options { leaf: Some(leaf), window: None, subdivision };
            let painting = solve(&scene, &camera, &options).unwrap().0;
            let name = format!("seed {seed}, {subdivision:?}");
            // Where a face is thinner than a leaf there may be no border near.
            let exact = weiler_atherton::solve(&scene, &camera).unwrap().0;
            let near = |at: DVec2| painted(&exact, at).1 <= 1.5 * leaf;
            total += judged(&name, (&scene, &camera), &painting, 13, near);
        }
    }
    eprintln!("{total} points judged");
    assert!(total > 80 * n as u32, "only {total} points judged");
}

#[test]
fn both_ways_of_dividing_give_one_picture() {
    let Some(mesh) = model("spot_control_quads.obj") else { return };
    let scene = Scene::new(mesh);
    let camera = Framing::default().camera(scene.mesh().bounds().unwrap()).unwrap();
    let exact = weiler_atherton::solve(&scene, &camera).unwrap().0;
    let images = Images::new(&scene, &camera);
    let (low, high) = images.bounds;
    let leaf = (high - low).length() / 300.0;
    let [a, b] = BOTH.map(|subdivision| {
        solve(&scene, &camera, &Options { leaf: Some(leaf), window: None, subdivision }).unwrap().0
    });
    let mut compared = 0;
    for k in 0..2000 {
        // A sequence that fills a square evenly.
        let part = dvec2(0.754_877_67 * f64::from(k), 0.569_840_29 * f64::from(k)).fract();
        let at = low + (high - low) * part;
        let (expected, to_border) = painted(&exact, at);
        if to_border > 1.5 * leaf {
            assert_eq!([painted(&a, at).0, painted(&b, at).0], [expected; 2], "at {at}");
            compared += 1;
        }
    }
    assert!(compared > 1000, "only {compared} points compared");
}
