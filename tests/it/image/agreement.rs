//! Equal item buffers, pixel by pixel.

use super::{built, face, fitted, models};
use crate::scenes::{number_of_scenes, random};
use hiddenline::engines::image::{Engine, NOTHING, Raster, solve};
use hiddenline::framing::{Framing, NamedView, Standpoint};
use hiddenline::scene::Scene;

/// All but the painter, who does not promise it, and the z-buffer, which they are compared with.
const OTHERS: [Engine; 4] = [Engine::ScanLine, Engine::Spanning, Engine::Watkins, Engine::RayCast];

/// How many pixels differ at equal depths; panics when any differs otherwise.
fn ties(name: &str, scene: &Scene, raster: &Raster) -> usize {
    let expected = solve(raster, Engine::ZBuffer);
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
        let items = solve(&raster, Engine::ZBuffer);
        shown += items.iter().filter(|&&item| item != NOTHING).count();
    }
    eprintln!("{n} scenes, {shown} pixels with faces, {total} differ at equal depths");
    assert!(shown > 100 * n as usize, "the scenes are hardly seen: {shown} pixels");
    // Faces in one plane, whose depths rounding puts on both sides of a step.
    assert!(total * 1000 < shown, "{total} of {shown} pixels differ");
}

#[test]
fn engines_agree_on_models() {
    let mut n_models = 0;
    for (name, mesh) in models() {
        let scene = Scene::new(mesh);
        let bounds = scene.mesh().bounds().unwrap();
        let named = |view| Framing {
            standpoint: Standpoint::Named { view, distance: None },
            ..Framing::default()
        };
        let framings = [Framing::default(), named(NamedView::Isometric), named(NamedView::Top)];
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
        n_models += 1;
    }
    assert!(n_models == 0 || n_models > 20, "only {n_models} models");
}

#[test]
fn a_picture_does_not_depend_on_its_strips() {
    let (scene, camera) = built(&random(7));
    let (map, high) = fitted(&scene, &camera, (50, 100));
    let low = Raster::new(&scene, &camera, &map, (50, 45));
    for engine in Engine::ALL {
        let n = 50 * 45;
        assert_eq!(solve(&high, engine)[..n], solve(&low, engine)[..], "{engine:?}");
    }
}

#[test]
fn the_painter_is_right_where_nothing_overlaps_in_depth() {
    let mesh = {
        let mut model = crate::scenes::Model::default();
        for z in 0..6 {
            let z = f64::from(z);
            model.face(&[[z, 0.0, z], [z + 4.0, 1.0, z], [z + 1.0, 5.0, z]]);
        }
        let sight = crate::scenes::perspective([3.0, 2.0, 20.0], [3.0, 2.0, 0.0], 0.1);
        built(&model.seen_by("stairs", sight))
    };
    let (_, raster) = fitted(&mesh.0, &mesh.1, (80, 60));
    assert_eq!(solve(&raster, Engine::Painter), solve(&raster, Engine::ZBuffer));
}
