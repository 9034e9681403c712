//! Windows of the image: the known picture, and agreement with exact regions.

use super::regions::warnocks_pair;
use super::{built, painted};
use crate::laws::image::face;
use crate::models;
use crate::oracle::sight_lines::SightLines;
use crate::scenes::{Model, number_of_scenes, orthographic, random};
use glam::{DVec2, dvec2};
use hiddenline::stages::camera::framing::View;
use hiddenline::stages::engines::face::images::Images;
use hiddenline::stages::engines::face::warnock::{
    Subdivision, WarnockCounts, WarnockOptions, solve,
};
use hiddenline::stages::engines::face::{Painting, weiler_atherton};
use hiddenline::stages::engines::image::{self, PixelMap, Raster, painter};
use hiddenline::stages::model::scene::Scene;

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
        let options = WarnockOptions { leaf: Some(1.0), window, subdivision };
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
    let options = WarnockOptions { leaf: Some(1.0), window, subdivision: Subdivision::Regular };
    let painting = solve(&scene, &camera, &options).unwrap().0;
    let map = PixelMap { scale: 1.0, origin: dvec2(25.5, 25.5) };
    let raster = Raster::new(&scene, &camera, &map, (16, 16));
    for engine in image::ImageEngine::ALL {
        let raster = match engine {
            image::ImageEngine::Painter => {
                painter::raster(&scene, &camera, &map, (16, 16)).unwrap()
            }
            _ => raster.clone(),
        };
        for (at, item) in (0..).zip(image::solve(&raster, engine)) {
            let center = dvec2(f64::from(at % 16) - 25.0, 25.0 - f64::from(at / 16));
            let expected = shown(&painting, center);
            // The painter knows only which of both is painted last, not who is first in a tie.
            let is_tie = center.x == -center.y;
            if !(is_tie && engine == image::ImageEngine::Painter) {
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
            let options = WarnockOptions { leaf: Some(leaf), window: None, subdivision };
            let painting = solve(&scene, &camera, &options).unwrap().0;
            let name = format!("seed {seed}, {subdivision:?}");
            // Where a face is thinner than a leaf there may be no border near.
            let exact = weiler_atherton::solve(&scene, &camera).unwrap().0;
            let near = |at: DVec2| painted(&exact, at).1 <= 1.5 * leaf;
            let lines = SightLines::new(&scene, &camera);
            let judged = lines.judge(&painting, 13, |at| near(at) || !lines.is_clear(at));
            total += judged.unwrap_or_else(|problem| panic!("{name}: {problem}")).0;
        }
    }
    eprintln!("{total} points judged");
    assert!(total > 80 * n as u32, "only {total} points judged");
}

#[test]
fn both_ways_of_dividing_give_one_picture() {
    let Some(mesh) = models::get("spot_control_quads.obj") else { return };
    let scene = Scene::new(mesh);
    let camera = View::default().camera(scene.mesh().bounds().unwrap()).unwrap();
    let exact = weiler_atherton::solve(&scene, &camera).unwrap().0;
    let images = Images::new(&scene, &camera);
    let (low, high) = images.bounds;
    let leaf = (high - low).length() / 300.0;
    let [a, b] = BOTH.map(|subdivision| {
        solve(&scene, &camera, &WarnockOptions { leaf: Some(leaf), window: None, subdivision })
            .unwrap()
            .0
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

/// What a window with its lower left corner at `low` takes, seen against z on faces.
fn windows(faces: &[Vec<[f64; 3]>], low: [f64; 2], size: f64, how: Subdivision) -> WarnockCounts {
    let mut model = Model::default();
    faces.iter().for_each(|face| model.face(face));
    let sight = orthographic([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    let (scene, camera) = built(&model.seen_by("windows", sight));
    let low = camera.image(glam::DVec3::new(low[0], low[1], 0.0));
    let window = Some((low, low + size));
    let options = WarnockOptions { leaf: Some(size / 16.0), window, subdivision: how };
    solve(&scene, &camera, &options).unwrap().1
}

/// A face over a rectangle in x and y, with a height at each x.
fn ramp(x: [f64; 2], y: [f64; 2], z: impl Fn(f64) -> f64) -> Vec<[f64; 3]> {
    let corners = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])];
    corners.map(|(x, y)| [x, y, z(x)]).to_vec()
}

#[test]
fn a_window_behind_a_surrounding_face_is_not_divided() {
    let sides = [-10.0, 10.0];
    // They cross at x = -4/3, so only depths tell which one is in front in a window.
    let near = ramp(sides, sides, |x| x / 2.0);
    let far = ramp(sides, [-9.0, 9.5], |x| -1.0 - x / 4.0);
    let covered = WarnockCounts { windows: 1, covered: 1, ..WarnockCounts::default() };
    // All of the far face is behind the nearer one's farthest point; then only in the window.
    for low in [[6.0, 1.0], [2.0, 1.0]] {
        for faces in [[near.clone(), far.clone()], [far.clone(), near.clone()]] {
            assert_eq!(windows(&faces, low, 2.0, Subdivision::Regular), covered, "{low:?}");
        }
    }
    // Of several that surround it the nearest hides the others, whatever comes first.
    let flat = |z: f64, reach: f64| ramp([-reach, reach], [-reach, reach], |_| z);
    let mut faces = vec![flat(1.0, 10.0), flat(3.0, 9.0), flat(2.0, 0.5)];
    for _ in 0..3 {
        faces.rotate_left(1);
        assert_eq!(windows(&faces, [-1.0, -1.0], 2.0, Subdivision::Regular), covered);
    }
}

#[test]
fn windows_divided_at_vertices_are_fewer() {
    let faces = [ramp([0.0, 5.0], [0.0, 5.0], |_| 0.0), ramp([5.0, 16.0], [5.0, 16.0], |_| 1.0)];
    // At the common corner all four parts are simple: a face each, or nothing.
    let found = windows(&faces, [0.0, 0.0], 16.0, Subdivision::Vertices);
    assert_eq!([found.windows, found.divided, found.empty, found.leaves], [5, 1, 2, 0]);
    let found = windows(&faces, [0.0, 0.0], 16.0, Subdivision::Regular);
    // Only the fourth middle, after 8, 4 and 6, is the corner.
    assert_eq!([found.windows, found.divided, found.leaves], [17, 4, 0]);
}

#[test]
fn windows_away_from_a_crossing_are_covered_by_the_nearer_face() {
    let mut model = crate::scenes::Model::default();
    for slope in [1.0, -1.0] {
        let at = |x: f64, y: f64| [x, y, slope * x];
        model.face(&[at(-8.0, -8.0), at(8.0, -8.0), at(8.0, 8.0), at(-8.0, 8.0)]);
    }
    let sight = crate::scenes::orthographic([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    let scene = model.seen_by("crossing slopes", sight);
    let camera = crate::laws::engines::camera(&scene);
    let scene = Scene::new(crate::laws::engines::mesh(&scene));
    let options = WarnockOptions { leaf: Some(0.25), ..WarnockOptions::default() };
    let (_, counts) = solve(&scene, &camera, &options).unwrap();
    // 64 by 64 leaves, of which those along the crossing alone are decided one by one.
    assert!(counts.leaves <= 2 * 64 && counts.covered >= 2, "{counts:?}");
}

#[test]
fn a_face_that_a_surrounding_one_crosses_shows_where_it_is_in_front() {
    // A ramp, and a small plate that it comes through at x = 1/3.
    let at = 1.0 / 3.0;
    let ramp_and_plate =
        [ramp([-8.0, 8.0], [-8.0, 8.0], |x| x), ramp([-4.0, 4.0], [-4.0, 4.0], |_| at)];
    let mut model = Model::default();
    ramp_and_plate.iter().for_each(|face| model.face(face));
    let sight = orthographic([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    let (scene, camera) = built(&model.seen_by("ramp and plate", sight));
    // Both windows lie within the ramp; the second one is within the plate, too.
    for (reach, leaf) in [(6.0, 0.125), (3.0, 0.0625)] {
        let [low, high] = [-reach, reach].map(|x| camera.image(glam::DVec3::new(x, x, 0.0)));
        let window = Some((low.min(high), low.max(high)));
        for subdivision in BOTH {
            let options = WarnockOptions { leaf: Some(leaf), window, subdivision };
            let painting = solve(&scene, &camera, &options).unwrap().0;
            for (i, j) in (0..24).flat_map(|i| (0..24).map(move |j| (i, j))) {
                let [x, y] = [i, j].map(|k| reach * (f64::from(k) / 11.5 - 1.0) * 0.97);
                let beside = [(x - at).abs(), (x.abs() - 4.0).abs(), (y.abs() - 4.0).abs()];
                if beside.iter().all(|away| *away > 2.0 * leaf) {
                    let is_plate = x < at && x.abs() < 4.0 && y.abs() < 4.0;
                    let image = camera.image(glam::DVec3::new(x, y, 0.0));
                    let found = painted(&painting, image).0;
                    assert_eq!(found, Some(u32::from(is_plate)), "{subdivision:?}: {x}, {y}");
                }
            }
        }
    }
}
