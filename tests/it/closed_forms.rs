//! Drawings whose visible lengths are known in closed form.

use glam::{DVec3, dvec3};
use hiddenline::classify::{LineSelection, ViewedScene};
use hiddenline::engines::edge::{Engine, Settings, solve};
use hiddenline::mesh::{Mesh, PolygonSoup};
use hiddenline::scene::Scene;
use hiddenline::view::{Camera, Projection};

fn cube() -> Mesh {
    let mut soup = PolygonSoup::default();
    for i in 0..8 {
        soup.positions.push(dvec3(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)));
    }
    for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    {
        soup.push_face(&face);
    }
    Mesh::new(soup).expect("a cube").0
}

/// Visible and hidden length of all edges in the image.
fn lengths(mesh: Mesh, camera: &Camera, engine: Engine) -> (f64, f64) {
    let scene = Scene::new(mesh);
    let view = ViewedScene::new(&scene, camera, LineSelection::all_edges(), 30.0);
    let settings = Settings { count_layers: true, ..Default::default() };
    let (visibility, _, _) = solve(&view, engine, &settings);
    let (mut visible, mut hidden) = (0.0, 0.0);
    for (i, drawn) in view.drawn().iter().enumerate() {
        let [a, b] = scene.topology().edge(drawn.edge).map(|v| view.image()[v as usize]);
        for span in visibility.spans(i) {
            let length = a.towards(b, span.t0).image().distance(a.towards(b, span.t1).image());
            if span.qi == 0 { visible += length } else { hidden += length }
        }
    }
    (visible, hidden)
}

fn orthographic(towards: DVec3) -> Camera {
    Camera::new(towards * 5.0, DVec3::ZERO, dvec3(0.25, 0.5, 1.0), Projection::Orthographic)
        .expect("a camera")
}

#[test]
fn a_cube_shows_nine_edges_of_twelve() {
    for towards in [dvec3(1.0, 1.0, 1.0), dvec3(3.0, -2.0, 1.0), dvec3(-1.0, 5.0, -2.0)] {
        let d = towards.normalize();
        let sum: f64 = d.to_array().iter().map(|x| (1.0 - x * x).sqrt()).sum();
        for engine in [Engine::AllPairs, Engine::Roberts] {
            let (visible, hidden) = lengths(cube(), &orthographic(towards), engine);
            assert!((visible - 3.0 * sum).abs() < 1e-12, "{towards} {engine:?}: {visible}");
            assert!((hidden - sum).abs() < 1e-12, "{towards} {engine:?}: {hidden}");
        }
    }
}
