//! The image-space engines: all against each other, and against what is known otherwise.

mod a_buffer;
mod agreement;
mod judge;
mod program;
mod strokes;
mod warnock;

use crate::engines::{camera, mesh};
use crate::scenes::Scene as TestScene;
use glam::DVec2;
use hiddenline::camera::Camera;
use hiddenline::engines::image::raster::Corners;
use hiddenline::engines::image::{NOTHING, PixelMap, Raster};
use hiddenline::model::mesh::Mesh;
use hiddenline::model::scene::Scene;
use hiddenline::read::read_file;
use std::path::{Path, PathBuf};

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

/// A model, unless the folder of models is missing.
pub(crate) fn model(name: &str) -> Option<Mesh> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/models"));
    if !folder.is_dir() {
        eprintln!("no models in {}: skipped", folder.display());
        return None;
    }
    Some(read_file(&folder.join(name), None).unwrap().mesh)
}

/// All models by name; none when their folder is missing.
fn models() -> Vec<(String, Mesh)> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/models"));
    let Ok(entries) = std::fs::read_dir(folder) else {
        eprintln!("no models in {}: skipped", folder.display());
        return Vec::new();
    };
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "obj" || e == "stl"));
    paths.sort();
    let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
    paths.iter().map(|path| (name(path), read_file(path, None).unwrap().mesh)).collect()
}
