//! Pixels against exact sight lines, which know nothing of pixels.
//!
//! Engines round the images of corners, so they may differ from the sight line through a pixel's
//! center where it passes next to a border or where depths agree: such pixels are counted.

use super::{built, face, fitted};
use crate::oracle::sight_lines::SightLines;
use crate::scenes::{number_of_scenes, random};
use glam::DVec2;
use hiddenline::stages::engines::image::{ImageEngine, solve};

#[test]
fn pixels_show_what_sight_lines_meet() {
    let engines = ImageEngine::ALL.into_iter().filter(|&engine| engine != ImageEngine::Painter);
    let engines: Vec<ImageEngine> = engines.collect();
    let (mut judged, mut differing) = (0u32, 0u32);
    for seed in 0..number_of_scenes(120) {
        let (scene, camera) = built(&random(seed));
        let size = (31, 23);
        let (map, raster) = fitted(&scene, &camera, size);
        let pictures: Vec<_> = engines.iter().map(|&engine| solve(&raster, engine)).collect();
        let lines = SightLines::new(&scene, &camera);
        for at in 0..size.0 * size.1 {
            let center = DVec2::new(f64::from(at % size.0), f64::from(at / size.0)) + 0.5;
            let image = (center - map.origin) / map.scale;
            let image = DVec2::new(image.x, -image.y);
            let expected = lines.seen(image);
            judged += 1;
            for (engine, picture) in engines.iter().zip(&pictures) {
                let found = face(&scene, &raster, picture[at as usize]);
                assert!(
                    found == expected || !lines.is_clear(image),
                    "seed {seed}, pixel {at}, {engine:?}: {found:?} instead of {expected:?}"
                );
                differing += u32::from(found != expected);
            }
        }
    }
    // On a border the pixel rule gives the pixel to one side, which sight lines know nothing of.
    assert!(differing * 50 < judged, "{differing} of {judged} pixels differ");
}
