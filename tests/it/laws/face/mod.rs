//! The face engines: what they paint, against exact rays.

mod corners;
mod fragments;
mod hides;
mod models;
mod order;

use hiddenline::stages::camera::Camera;
use hiddenline::stages::engines::face::{Painting, bsp, depth_sort, octree, weiler_atherton};
use hiddenline::stages::model::scene::Scene;

/// An engine without settings.
type Solve = fn(&Scene, &Camera) -> Painting;

const ENGINES: [(&str, Solve); 5] = [
    ("bsp, all", |scene, camera| bsp::solve(scene, camera).unwrap().0),
    ("bsp", |scene, camera| bsp::BspTree::new(scene).unwrap().paint_seen(scene, camera).0),
    ("octree", |scene, camera| octree::solve(scene, camera).unwrap().0),
    ("octree, all", |scene, camera| octree::Octree::new(scene).unwrap().paint(scene, camera)),
    ("depth sort", |scene, camera| depth_sort::solve(scene, camera).unwrap().0),
];

/// The one that finds regions instead of an order.
const EXACT: (&str, Solve) =
    ("weiler-atherton", |scene, camera| weiler_atherton::solve(scene, camera).unwrap().0);
