//! The image-space engines: all against each other, and against what is known otherwise.

mod a_buffer;
mod agreement;
mod shades;
mod sight_lines;
mod strokes;
mod warnock;

use crate::laws::engines::{camera, mesh};
use crate::scenes::Scene as TestScene;
use glam::DVec2;
use hiddenline::stages::camera::Camera;
use hiddenline::stages::engines::image::raster::Corners;
use hiddenline::stages::engines::image::{NOTHING, PixelMap, Raster};
use hiddenline::stages::model::scene::Scene;

/// The scene, as large as fits into a picture.
fn fitted(scene: &Scene, camera: &Camera, size: (u32, u32)) -> (PixelMap, Raster) {
    let bounds = Corners::new(scene, camera).bounds().unwrap_or((DVec2::NEG_ONE, DVec2::ONE));
    let map = PixelMap::fitting(bounds, size, 2.0);
    (map, Raster::new(scene, camera, &map, size))
}

fn built(scene: &TestScene) -> (Scene, Camera) {
    (Scene::new(mesh(scene)), camera(scene))
}

/// The face that an item is part of.
pub(crate) fn face(scene: &Scene, raster: &Raster, item: u32) -> Option<u32> {
    (item != NOTHING).then(|| scene.triangle_faces()[raster.number(item) as usize])
}
