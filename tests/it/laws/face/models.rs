//! Models from elsewhere: rounded, open, crossing themselves.

use super::{ENGINES, EXACT};
use crate::models;
use crate::oracle::sight_lines::SightLines;
use hiddenline::stages::camera::framing::{NamedView, Standpoint, View};
use hiddenline::stages::engines::face::{bsp, depth_sort, piercing};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::read::read_file;

const MODELS: [&str; 14] = [
    "benchy_wheel.stl",
    "cad_aatbase.stl",
    "cad_angle_block_open.stl",
    "concave_66gon.obj",
    "cornell_box_negidx.obj",
    "far_offset_tiny_cube.obj",
    "kenney_street.obj",
    "moebius.obj",
    "naca0012_wing.stl",
    "nonmanifold_crash.obj",
    "openscad_example016.stl",
    "platonic_shelf_ngons.obj",
    "quadknot.obj",
    "spot_control_quads.obj",
];

#[test]
fn paintings_of_models_are_what_exact_rays_meet() {
    for name in MODELS {
        let Some(mesh) = models::get(name) else { return };
        let scene = Scene::new(mesh);
        let bounds = scene.mesh().bounds().unwrap();
        let top = Standpoint::Named { view: NamedView::Top, distance: None };
        for framing in [View::default(), View { standpoint: top, ..View::default() }] {
            let camera = framing.camera(bounds).unwrap();
            let world = SightLines::new(&scene, &camera);
            for (engine, solve) in ENGINES.into_iter().chain([EXACT]) {
                let (judged, _) = world
                    .judge(&solve(&scene, &camera), 20, |_| false)
                    .unwrap_or_else(|problem| panic!("{name}, {engine}: {problem}"));
                assert!(judged > 350, "{name}, {engine}: only {judged} points judged");
            }
        }
    }
}

#[test]
fn no_model_is_refused() {
    let (paths, least) = models::all();
    assert!(paths.len() >= least);
    for path in paths {
        let scene = Scene::new(read_file(&path, None).unwrap().mesh);
        let (n, found) = (scene.triangles().len() as u64, piercing::estimate(&scene));
        eprintln!("{}: {n} triangles, about {found} pairs pierce", path.display());
        assert!(found <= depth_sort::MAX_PIERCINGS.min(bsp::MAX_PIERCINGS) * n);
    }
}
