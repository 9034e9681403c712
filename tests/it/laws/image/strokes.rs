//! Lines and pictures: visible strokes lie where pixels change, and where pixels change there are
//! strokes.

use super::{face, fitted};
use crate::models;
use glam::DVec2;
use hiddenline::stages::camera::Camera;
use hiddenline::stages::camera::framing::{Standpoint, View};
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::engines::image::{ImageEngine, solve};
use hiddenline::stages::model::scene::Scene;

#[test]
fn visible_strokes_lie_on_borders_of_pixels_and_cover_the_outline() {
    for name in ["platonic_shelf_ngons.obj", "openscad_example016.stl", "cad_angle_block_open.stl"]
    {
        let Some(mesh) = models::get(name) else { return };
        let scene = Scene::new(mesh);
        let from_below =
            Standpoint::Angles { azimuth_deg: 205.0, elevation_deg: -31.0, distance: None };
        for framing in [View::default(), View { standpoint: from_below, ..View::default() }] {
            let camera = framing.camera(scene.mesh().bounds().unwrap()).unwrap();
            check(name, &scene, &camera);
        }
    }
}

fn check(name: &str, scene: &Scene, camera: &Camera) {
    let size = (1600, 1200);
    let (map, raster) = fitted(scene, camera, size);
    let items = solve(&raster, ImageEngine::ZBuffer);
    let faces: Vec<Option<u32>> = items.iter().map(|&item| face(scene, &raster, item)).collect();
    let at = |column: i64, row: i64| faces[(row * i64::from(size.0) + column) as usize];

    let options =
        DrawOptions { lines: LineSelection::all_edges(), exact: true, ..DrawOptions::default() };
    let drawing = draw(scene, camera, &options, 1.0).drawing;
    let mut is_near_stroke = vec![false; faces.len()];
    let (mut n_points, mut n_strokes) = (0, 0);
    for stroke in drawing.iter().filter(|stroke| stroke.qi == 0) {
        n_strokes += 1;
        let points: Vec<DVec2> = stroke.points.iter().map(|&point| map.pixel(point)).collect();
        for pair in points.windows(2) {
            let n = (pair[0].distance(pair[1]) * 2.0).ceil() as u32;
            for k in 0..=n {
                let point = pair[0].lerp(pair[1], f64::from(k) / f64::from(n.max(1)));
                let (column, row) = (point.x as i64, point.y as i64);
                let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)));
                let mut seen = Vec::new();
                for (dx, dy) in around {
                    seen.push(at(column + dx, row + dy));
                    is_near_stroke[((row + dy) * i64::from(size.0) + column + dx) as usize] = true;
                }
                assert!(
                    seen.iter().any(|face| *face != seen[0]),
                    "{name}: a stroke at {point} where all pixels show {:?}",
                    seen[0]
                );
                n_points += 1;
            }
        }
    }
    assert!(n_strokes > 50 && n_points > 1000, "{name}: {n_strokes} strokes, {n_points} points");

    for row in 0..i64::from(size.1) {
        for column in 1..i64::from(size.0) {
            let pair = [at(column - 1, row), at(column, row)];
            if pair[0].is_none() != pair[1].is_none() {
                let place = (row * i64::from(size.0) + column) as usize;
                assert!(
                    is_near_stroke[place],
                    "{name}: no stroke where {column}, {row} meets nothing"
                );
            }
        }
    }
}
