//! Regions as exact polygons: known corners, areas.

use super::built;
use crate::oracle::sight_lines::SightLines;
use crate::scenes::{Model, Scene as TestScene, number_of_scenes, orthographic, random};
use glam::DVec2;
use hiddenline::stages::engines::face::images::Images;
use hiddenline::stages::engines::face::region::Region;
use hiddenline::stages::engines::face::weiler_atherton::solve;

/// Rogers' variant of Warnock's pair, seen along z.
pub(super) fn warnocks_pair() -> TestScene {
    let mut model = Model::default();
    model.face(&[[18.5, 12.5, 0.0], [22.5, 16.5, 0.0], [14.5, 22.5, 14.0]]);
    model.face(&[[12.5, 14.5, 6.0], [20.5, 14.5, 6.0], [20.5, 20.5, 6.0], [12.5, 20.5, 6.0]]);
    model.seen_by("Warnock's pair", orthographic([0.0, 0.0, 1.0], [0.0, 1.0, 0.0]))
}

#[test]
fn warnocks_pair_is_cut_where_the_faces_cross() {
    let (scene, camera) = built(&warnocks_pair());
    let painting = solve(&scene, &camera).unwrap().0;
    let step = Images::new(&scene, &camera).grid.step();
    // The picture is mirrored: x to the left, seen from below.
    for junction in [235.0 / 14.0, 267.0 / 14.0] {
        let expected = DVec2::new(-junction, junction);
        for face in 0..2 {
            let corners = painting.pieces().filter(|piece| piece.face == face);
            let corners = corners.flat_map(|piece| piece.rings().collect::<Vec<_>>());
            let nearest = corners
                .flat_map(|ring| ring.points.iter().map(|p| p.distance(expected)))
                .fold(f64::INFINITY, f64::min);
            assert!(nearest <= 4.0 * step, "{face}, {junction}: {} steps", nearest / step);
        }
    }
}

#[test]
fn areas_of_regions_sum_to_that_of_all_images() {
    let mut largest: f64 = 0.0;
    for seed in 0..number_of_scenes(600) {
        let (scene, camera) = built(&random(seed));
        let images = Images::new(&scene, &camera);
        let step = images.grid.step();
        let all = Region::union(images.flats.iter().map(|flat| &flat.region)).area() * step * step;
        let painting = solve(&scene, &camera).unwrap().0;
        let sum: f64 = painting.pieces().map(|piece| piece.area()).sum();
        let size = (images.bounds.1 - images.bounds.0).length();
        let error = (sum - all).abs() / (size * step).max(f64::MIN_POSITIVE);
        largest = largest.max(error);
        assert!(error < 1000.0, "seed {seed}: {sum} instead of {all}, {error} steps × diagonal");
    }
    eprintln!("largest error of area: {largest} steps × diagonal");
}

#[test]
fn regions_show_what_sight_lines_meet() {
    let n = number_of_scenes(300);
    let mut total = 0;
    for seed in 0..n {
        let (scene, camera) = built(&random(seed));
        let painting = solve(&scene, &camera).unwrap().0;
        let judged = SightLines::new(&scene, &camera).judge(&painting, 13, |_| false);
        total += judged.unwrap_or_else(|problem| panic!("seed {seed}: {problem}")).0;
    }
    assert!(total > 80 * n as u32, "only {total} points judged");
}
