//! Equal item buffers, pixel by pixel.

use super::{built, face, fitted};
use crate::models;
use crate::scenes::{number_of_scenes, random};
use glam::DVec2;
use hiddenline::stages::camera::Camera;
use hiddenline::stages::camera::framing::{NamedView, Standpoint, View};
use hiddenline::stages::engines::image::raster::RasterTriangle;
use hiddenline::stages::engines::image::{ImageEngine, NOTHING, Raster, painter, solve};
use hiddenline::stages::model::scene::Scene;

/// All but the painter, who does not promise it, and the z-buffer, which they are compared with.
const OTHERS: [ImageEngine; 4] =
    [ImageEngine::ScanLine, ImageEngine::Spanning, ImageEngine::Watkins, ImageEngine::RayCast];

/// How many pixels differ at equal depths; panics when any differs otherwise.
fn ties(name: &str, scene: &Scene, raster: &Raster) -> usize {
    let expected = solve(raster, ImageEngine::ZBuffer);
    let mut ties = 0;
    for engine in OTHERS {
        let found = solve(raster, engine);
        for (at, (&a, &b)) in (0..).zip(expected.iter().zip(&found)) {
            if face(scene, raster, a) == face(scene, raster, b) {
                continue;
            }
            let (column, row) = (at % raster.width(), at / raster.width());
            assert!(a != NOTHING && b != NOTHING, "{name}, {engine:?}: {column}, {row}");
            let nearness = [a, b].map(|item| raster.triangle(item).plane.nearness(column, row));
            let difference = (nearness[0] - nearness[1]).abs() / nearness[0].abs();
            assert!(difference <= 1e-9, "{name}, {engine:?}: {column}, {row}: {nearness:?}");
            ties += 1;
        }
    }
    ties
}

#[test]
fn engines_agree_on_random_scenes() {
    let n = number_of_scenes(400);
    let (mut total, mut shown) = (0, 0);
    for seed in 0..n {
        let (scene, camera) = built(&random(seed));
        let (_, raster) = fitted(&scene, &camera, (61, 47));
        total += ties(&format!("seed {seed}"), &scene, &raster);
        let items = solve(&raster, ImageEngine::ZBuffer);
        shown += items.iter().filter(|&&item| item != NOTHING).count();
    }
    eprintln!("{n} scenes, {shown} pixels with faces, {total} differ at equal depths");
    assert!(shown > 100 * n as usize, "the scenes are hardly seen: {shown} pixels");
    // Faces in one plane, whose depths rounding puts on both sides of a step.
    assert!(total * 1000 < shown, "{total} of {shown} pixels differ");
}

#[test]
fn engines_agree_on_models() {
    let (paths, least) = models::all();
    assert!(paths.len() >= least, "only {} models", paths.len());
    for path in &paths {
        let name = models::name(path);
        let scene = Scene::new(hiddenline::stages::read::read_file(path, None).unwrap().mesh);
        let bounds = scene.mesh().bounds().unwrap();
        let named = |view| View {
            standpoint: Standpoint::Named { view, distance: None },
            ..View::default()
        };
        let framings = [View::default(), named(NamedView::Isometric), named(NamedView::Top)];
        // Large models show in one view what there is to show.
        let n_views = if scene.triangles().len() > 15_000 { 1 } else { framings.len() };
        for framing in &framings[..n_views] {
            let camera = framing.camera(bounds).unwrap();
            let (_, raster) = fitted(&scene, &camera, (240, 180));
            let ties = ties(&name, &scene, &raster);
            if ties > 0 {
                eprintln!("{name}: {ties} pixels differ at equal depths");
            }
        }
    }
}

#[test]
fn a_picture_does_not_depend_on_its_strips() {
    let (scene, camera) = built(&random(7));
    let (map, high) = fitted(&scene, &camera, (50, 100));
    let low = Raster::new(&scene, &camera, &map, (50, 45));
    for engine in ImageEngine::ALL {
        let n = 50 * 45;
        assert_eq!(solve(&high, engine)[..n], solve(&low, engine)[..], "{engine:?}");
    }
}

/// How far a pixel's center is from the nearest side of a triangle, in pixels.
fn distance_to_border(triangle: &RasterTriangle, column: u32, row: u32) -> f64 {
    let center = DVec2::new(f64::from(column), f64::from(row)) + 0.5;
    let [a, b, c] = triangle.corners;
    let to_side = |(from, to): (DVec2, DVec2)| {
        let along = to - from;
        let t = ((center - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        center.distance(from + along * t)
    };
    [(a, b), (b, c), (c, a)].map(to_side).into_iter().fold(f64::INFINITY, f64::min)
}

/// How many pixels of the painter differ from the z-buffer's. It knows nothing of the depth at a
/// pixel's center, so faces that touch there, or cross there, may be told apart the other way.
fn painted_otherwise(
    name: &str,
    scene: &Scene,
    camera: &Camera,
    size: (u32, u32),
) -> (usize, usize) {
    let (map, raster) = fitted(scene, camera, size);
    let painted = painter::raster(scene, camera, &map, size).unwrap();
    let (expected, found) =
        (solve(&raster, ImageEngine::ZBuffer), solve(&painted, ImageEngine::Painter));
    let shown = expected.iter().filter(|&&item| item != NOTHING).count();
    let mut n_differing = 0;
    for (at, (&a, &b)) in (0..).zip(expected.iter().zip(&found)) {
        if face(scene, &raster, a) == face(scene, &painted, b) {
            continue;
        }
        n_differing += 1;
        let (column, row) = (at % size.0, at / size.0);
        if a == NOTHING || b == NOTHING {
            // Corners of cut faces are rounded, which may move a border over a center that it met.
            let shown = if a == NOTHING { painted.triangle(b) } else { raster.triangle(a) };
            let to_border = distance_to_border(&shown, column, row);
            assert!(to_border <= 1e-9, "{name}: {column}, {row}: {to_border} pixels off a border");
            continue;
        }
        let nearness = raster.triangle(a).plane.nearness(column, row);
        let difference = (painted.triangle(b).plane.nearness(column, row) - nearness).abs();
        assert!(difference <= 1e-9 * nearness, "{name}: {column}, {row}: by {difference}");
    }
    (n_differing, shown)
}

#[test]
fn the_painter_paints_what_the_z_buffer_shows() {
    let (mut differing, mut shown) = (0, 0);
    for seed in 0..number_of_scenes(300) {
        let (scene, camera) = built(&random(seed));
        let counts = painted_otherwise(&format!("seed {seed}"), &scene, &camera, (61, 47));
        (differing, shown) = (differing + counts.0, shown + counts.1);
    }
    eprintln!("{differing} of {shown} pixels differ where depths agree");
    assert!(differing * 200 < shown, "{differing} of {shown} pixels differ");
    for name in ["openscad_csg.stl", "kenney_street.obj", "spot.obj", "cornell_box_negidx.obj"] {
        let Some(mesh) = models::get(name) else { return };
        let scene = Scene::new(mesh);
        let camera = View::default().camera(scene.mesh().bounds().unwrap()).unwrap();
        let (differing, shown) = painted_otherwise(name, &scene, &camera, (240, 180));
        eprintln!("{name}: {differing} of {shown} pixels differ where depths agree");
        assert!(differing * 100 < shown, "{name}: {differing} of {shown} pixels differ");
    }
}
