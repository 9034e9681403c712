//! Contours along the diagonals of bent faces: a model of bent faces is drawn as its triangles are.

use std::collections::BTreeMap;

use glam::DVec3;
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::classify::{LineSelection, ViewedScene};
use hiddenline::stages::engines::edge::{LineEngine, VisibilityOptions, outline, solve};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::strokes::StrokeKind;

use crate::scenes::{Rng, number_of_scenes};

/// A net of quadrilaterals over a square, each as bent as it happens to be, and a second one below.
fn nets(rng: &mut Rng) -> Mesh {
    let mut soup = PolygonSoup::default();
    for base in [0.0, 6.0] {
        let first = soup.positions.len() as u32;
        for k in 0..16u32 {
            let (x, y) = (f64::from(k % 4), f64::from(k / 4));
            soup.positions.push(DVec3::new(2.0 * x, 2.0 * y, base + rng.integer(-2, 2)));
        }
        for k in (0..11).filter(|k| k % 4 < 3) {
            let corners = [k, k + 1, k + 5, k + 4].map(|corner| first + corner);
            soup.push_face(&corners);
        }
    }
    Mesh::new(soup).unwrap().0
}

/// The triangles of a scene as faces of their own.
fn split(scene: &Scene) -> Scene {
    let positions = scene.mesh().positions().to_vec();
    let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
    scene.triangles().iter().for_each(|corners| soup.push_face(corners));
    Scene::new(Mesh::new(soup).unwrap().0)
}

/// Where each drawn line is seen, by the bits of its ends, and where it is outline.
type Picture = BTreeMap<[[u64; 3]; 2], (StrokeKind, Vec<[u64; 2]>, Vec<[u64; 2]>)>;

fn picture(scene: &Scene, camera: &Camera, engine: LineEngine) -> Picture {
    let lines =
        LineSelection::NONE.with(StrokeKind::Silhouette).with(StrokeKind::Boundary).with_outline();
    let view = ViewedScene::new(scene, camera, lines, 30.0);
    let settings = VisibilityOptions::EXACT;
    let (visibility, _, _) = solve(&view, engine, &settings);
    let outline = outline::find(&view);
    let mut picture = Picture::new();
    for (k, drawn) in view.selected().iter().enumerate() {
        let ends = scene.line(drawn.edge).map(|v| scene.points()[v as usize]);
        let ends = ends.map(|p| p.to_array().map(|x| (x + 0.0).to_bits()));
        // The vertices of both scenes are in one order, so lines run the same way.
        let seen = visibility.spans(k).iter().filter(|span| span.qi == 0);
        let seen = seen.map(|span| [span.t0.to_bits(), span.t1.to_bits()]).collect();
        let rims = outline.parts(k).iter().map(|part| part.map(f64::to_bits)).collect();
        assert!(picture.insert(ends, (drawn.kind, seen, rims)).is_none());
    }
    picture
}

#[test]
fn bent_faces_are_drawn_as_their_triangles_are() {
    let mut n_bends = 0;
    for seed in 0..number_of_scenes(150) {
        let rng = &mut Rng(seed);
        let scene = Scene::new(nets(rng)).with_bends();
        let triangles = split(&scene);
        let eye = DVec3::new(rng.integer(-9, 15), rng.integer(-9, 15), rng.integer(-3, 15));
        let target = DVec3::new(3.0, 3.0, 3.0);
        let projection = match seed % 2 {
            0 => Projection::Orthographic,
            _ => Projection::Perspective { fov_deg: 40.0, near: 1e-6 },
        };
        let Ok(camera) = Camera::new(eye, target, DVec3::Z, projection) else { continue };
        for engine in [LineEngine::Roberts, LineEngine::Appel] {
            let expected = picture(&triangles, &camera, engine);
            let found = picture(&scene, &camera, engine);
            assert_eq!(found, expected, "scene {seed}, {engine:?}");
            let is_edge = |ends: &[u32; 2]| scene.topology().find_edge(ends[0], ends[1]).is_some();
            assert!(scene.bends().iter().all(|bend| !is_edge(&bend.ends)));
        }
        let n_edges = scene.topology().edges().len() as u32;
        let lines = LineSelection::NONE.with(StrokeKind::Silhouette);
        let view = ViewedScene::new(&scene, &camera, lines, 30.0);
        n_bends += view.selected().iter().filter(|drawn| drawn.edge >= n_edges).count();
    }
    assert!(n_bends > 100, "{n_bends}");
}

#[test]
fn flat_faces_have_no_bends() {
    let corners = [[0, 0, 0], [4, 0, 4], [4, 4, 8], [2, 1, 3], [0, 4, 4]];
    let positions = corners.map(|[x, y, z]| DVec3::new(f64::from(x), f64::from(y), f64::from(z)));
    let mut soup = PolygonSoup { positions: positions.to_vec(), ..PolygonSoup::default() };
    soup.push_face(&[0, 1, 2, 3, 4]);
    let scene = Scene::new(Mesh::new(soup).unwrap().0).with_bends();
    assert_eq!((scene.triangles().len(), scene.bends().len()), (3, 0));
}
