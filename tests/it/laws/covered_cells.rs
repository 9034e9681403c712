//! What the index over the image leaves out behind opaque walls: never anything that shows, and so
//! much that layers behind a wall cost nothing.
//!
//! The judge of what shows is the engine that has no index; see `oracle` for the judge of that one.

use crate::scenes::{Rng, number_of_scenes};
use glam::{DVec3, dvec3};
use hiddenline::stages::camera::{Camera, DEFAULT_NEAR, Projection};
use hiddenline::stages::classify::{LineSelection, ViewedScene};
use hiddenline::stages::engines::edge::{LineEngine, VisibilityOptions, solve};
use hiddenline::stages::engines::visibility::{Span, Visibility};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;

const VISIBLE_ONLY: VisibilityOptions = VisibilityOptions::EXACT;

/// Faces in a frame of their own: x to the right, y away from the eye, z up.
#[derive(Default)]
struct Builder(PolygonSoup);

impl Builder {
    fn face(&mut self, corners: &[DVec3]) {
        let first = self.0.positions.len() as u32;
        self.0.positions.extend_from_slice(corners);
        let face: Vec<u32> = (first..first + corners.len() as u32).collect();
        self.0.push_face(&face);
    }

    /// `n × n` tiles over the square from (0, 0) to (`size`, `size`) at depth `y`; `keep` says which
    /// tiles there are.
    fn wall(&mut self, n: u32, size: f64, y: f64, mut keep: impl FnMut(u32, u32) -> bool) {
        let at = |i: u32, j: u32| {
            let part = |k: u32| size * f64::from(k) / f64::from(n);
            dvec3(part(i), y, part(j))
        };
        for i in 0..n {
            for j in 0..n {
                if keep(i, j) {
                    self.face(&[at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }

    fn scene(mut self, place: impl Fn(DVec3) -> DVec3) -> Scene {
        self.0.positions.iter_mut().for_each(|p| *p = place(*p));
        Scene::new(Mesh::new(self.0).unwrap().0)
    }
}

fn unit(rng: &mut Rng) -> f64 {
    (rng.next() >> 11) as f64 / (1u64 << 53) as f64
}

/// A wall of 64 tiles, and layers of triangles or tiles behind it.
fn walled(n_layers: u32, of_tiles: bool) -> Builder {
    let mut rng = Rng(u64::from(n_layers));
    let mut builder = Builder::default();
    builder.wall(8, 8.0, 0.0, |_, _| true);
    for layer in 0..n_layers {
        let y = 2.0 + 0.25 * f64::from(layer);
        for _ in 0..64 {
            let (x, z) = (0.75 + 5.5 * unit(&mut rng), 0.75 + 5.5 * unit(&mut rng));
            let mut offset = || dvec3(unit(&mut rng), 0.0, unit(&mut rng));
            let corner = dvec3(x, y, z);
            if of_tiles {
                let square = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Z, DVec3::Z];
                builder.face(&square.map(|d| corner + d));
            } else {
                builder.face(&[corner, corner + offset(), corner + offset()]);
            }
        }
    }
    builder
}

fn looking(from: DVec3, projection: Projection) -> Camera {
    Camera::new(from, dvec3(4.0, 0.0, 4.0), DVec3::Z, projection).unwrap()
}

fn pairs_per_edge(scene: &Scene, camera: &Camera, settings: &VisibilityOptions) -> f64 {
    let view = ViewedScene::new(scene, camera, LineSelection::all_edges(), 30.0);
    let (_, counts, _) = solve(&view, LineEngine::Roberts, settings);
    counts.candidate_pairs as f64 / view.selected().len() as f64
}

#[test]
fn layers_behind_a_wall_cost_nothing() {
    let front = dvec3(4.0, -30.0, 4.0);
    let perspective = Projection::Perspective { fov_deg: 30.0, near: DEFAULT_NEAR };
    let leaning = |p: DVec3| dvec3(p.x, p.y + 0.5 * p.z - 0.25 * p.x, p.z);
    let straight = |p: DVec3| p;
    let with = |contact_tolerance| VisibilityOptions { contact_tolerance, ..VISIBLE_ONLY };
    type Place = fn(DVec3) -> DVec3;
    let cases: [(&str, Place, Camera, VisibilityOptions); 6] = [
        ("parallel", straight, looking(front, Projection::Orthographic), with(0.0)),
        ("perspective", straight, looking(front, perspective), with(0.0)),
        ("slanted", leaning, looking(front, Projection::Orthographic), with(0.0)),
        ("slanted, perspective", leaning, looking(front, perspective), with(0.0)),
        ("slanted, touching", leaning, looking(front, perspective), with(1e-3)),
        ("askew", straight, looking(dvec3(4.5, -30.0, 4.6), Projection::Orthographic), with(1e-6)),
    ];
    for of_tiles in [false, true] {
        for (name, place, camera, settings) in &cases {
            let figures = [1, 4, 16, 64].map(|n_layers| {
                pairs_per_edge(&walled(n_layers, of_tiles).scene(place), camera, settings)
            });
            eprintln!("{name}, tiles: {of_tiles}: {figures:.2?}");
            let largest = figures.iter().copied().fold(0.0, f64::max);
            assert!(largest <= 1.5 * figures[0], "{name}, tiles: {of_tiles}: {figures:.2?}");
        }
    }
}

/// Walls with holes, folds and steps, one behind the other and through each other, and triangles
/// between them.
fn rubble(rng: &mut Rng) -> Scene {
    let mut builder = Builder::default();
    for _ in 0..1 + rng.below(3) {
        let n = 1 + rng.below(4) as u32;
        let y = rng.integer(0, 6);
        let missing = rng.below(6);
        let size = rng.integer(5, 8);
        builder.wall(n, size, y, |_, _| missing == 0 || !rng.one_in(2 * missing + 1));
    }
    if rng.one_in(3) {
        // Many triangles around one vertex, some of them missing.
        let (y, n) = (rng.integer(0, 3), 48);
        let rim = |i: u32| {
            let angle = std::f64::consts::TAU * f64::from(i % n) / f64::from(n);
            dvec3(4.1 + 4.0 * angle.cos(), y, 3.9 + 4.0 * angle.sin())
        };
        for i in (0..n).filter(|_| !rng.one_in(24)) {
            builder.face(&[dvec3(4.1, y, 3.9), rim(i), rim(i + 1)]);
        }
    }
    let n_walls = builder.0.positions.len();
    let bend = rng.below(4);
    for p in &mut builder.0.positions[..n_walls] {
        // Shared corners stay shared.
        let fold = ((p.x + 2.0 * p.z) * 1.7).sin();
        p.y += [0.0, 0.4, 2.0, 0.0][bend] * fold;
        p.x += [0.0, 0.0, 0.0, 3.0][bend] * fold;
    }
    for _ in 0..200 + rng.below(200) {
        let corner = dvec3(8.0 * unit(rng), rng.integer(0, 32) * 0.25, 8.0 * unit(rng));
        let flat = rng.one_in(2);
        let mut offset = || {
            let depth = if flat { 0.0 } else { 2.0 * unit(rng) - 1.0 };
            dvec3(unit(rng) - 0.5, depth, unit(rng) - 0.5)
        };
        builder.face(&[corner, corner + offset(), corner + offset()]);
    }
    let lean = rng.pick(&[0.0, 0.0, 0.5, -3.0]);
    builder.scene(|p| dvec3(p.x, p.y + lean * p.z, p.z))
}

/// Compares the parts of each edge that `told` tells apart by their `qi`.
pub(crate) fn assert_same(
    name: &str,
    expected: &Visibility,
    found: &Visibility,
    state: impl Fn(&Span) -> u32,
) {
    assert_eq!(expected.len(), found.len(), "{name}");
    for i in 0..found.len() {
        let [a, b] = [expected, found].map(|visibility| {
            let mut parts: Vec<(u32, f64, f64)> = Vec::new();
            for span in visibility.spans(i).iter().filter(|span| span.t1 - span.t0 > 1e-9) {
                match parts.last_mut() {
                    Some(last) if last.0 == state(span) => last.2 = span.t1,
                    _ => parts.push((state(span), span.t0, span.t1)),
                }
            }
            parts
        });
        let near = |x: f64, y: f64| (x - y).abs() < 2e-9;
        let same = a.len() == b.len()
            && a.iter().zip(&b).all(|(a, b)| a.0 == b.0 && near(a.1, b.1) && near(a.2, b.2));
        assert!(same, "{name}, edge {i}: {b:?}, not {a:?}");
    }
}

#[test]
fn nothing_that_shows_is_left_out_behind_walls() {
    let (mut n_thinned, n_scenes) = (0, number_of_scenes(16));
    for seed in 0..n_scenes {
        let mut rng = Rng(seed);
        let scene = rubble(&mut rng);
        let camera = if rng.one_in(3) {
            // From very near, images reach far beyond the cells.
            let (from, ahead) = (dvec3(rng.integer(2, 6), -0.25, rng.integer(2, 6)), DVec3::Y);
            let projection = Projection::Perspective { fov_deg: 30.0, near: DEFAULT_NEAR };
            Camera::new(from, from + ahead, DVec3::Z, projection).unwrap()
        } else {
            let from = dvec3(rng.integer(-4, 12), -rng.integer(2, 30), rng.integer(-4, 12));
            let near = rng.pick(&[DEFAULT_NEAR, 1.0, 3.0]);
            let perspective = Projection::Perspective { fov_deg: 30.0, near };
            looking(from, rng.pick(&[Projection::Orthographic, perspective]))
        };
        let view = ViewedScene::new(&scene, &camera, LineSelection::all_edges(), 30.0);
        let every = view.selected().iter().copied().step_by(32).collect();
        let few = ViewedScene::with_edges(&scene, &camera, every);
        for contact_tolerance in [0.0, rng.pick(&[0.3, 2.0])] {
            let settings = VisibilityOptions { contact_tolerance, ..VISIBLE_ONLY };
            let counted = VisibilityOptions { count_layers: true, ..settings };
            let name = format!("seed {seed}, tolerance {contact_tolerance}");
            let (expected, _, _) = solve(&view, LineEngine::AllPairs, &counted);
            let (found, all, _) = solve(&view, LineEngine::Roberts, &counted);
            assert_same(&name, &expected, &found, |span| span.qi);
            let (found, kept, _) = solve(&view, LineEngine::Roberts, &settings);
            assert_same(&name, &expected, &found, |span| span.qi.min(1));
            let (found, _, _) = solve(&few, LineEngine::Roberts, &settings);
            let (expected, _, _) = solve(&few, LineEngine::AllPairs, &settings);
            assert_same(&format!("{name}, few edges"), &expected, &found, |span| span.qi);
            n_thinned += u64::from(2 * kept.candidate_pairs < all.candidate_pairs);
        }
    }
    eprintln!("{n_thinned} of {n_scenes} scenes, each twice, lost half of their pairs or more");
    assert!(n_thinned > n_scenes / 8);
}

#[test]
fn what_lies_far_out_is_not_behind_a_wall_in_a_border_cell() {
    // Cells end at an image coordinate of about 8; what lies further out is filed in the last ones. The
    // wall covers one of these. Beyond the wall's end one triangle hides the other.
    let mut builder = Builder::default();
    let rectangle = |low: f64, high: f64, depth: f64, half: f64| {
        [(low, -half), (high, -half), (high, half), (low, half)].map(|(x, z)| dvec3(x, depth, z))
    };
    builder.face(&rectangle(-12.5, 12.5, 1.0, 3.0));
    builder.face(&rectangle(26.0, 30.0, 2.0, 1.0));
    builder.face(&rectangle(41.0, 43.0, 3.0, 0.5));
    let scene = builder.scene(|p| p);
    let projection = Projection::Perspective { fov_deg: 30.0, near: DEFAULT_NEAR };
    let camera = Camera::new(DVec3::ZERO, DVec3::Y, DVec3::Z, projection).unwrap();
    let view = ViewedScene::new(&scene, &camera, LineSelection::all_edges(), 30.0);
    let (expected, _, _) = solve(&view, LineEngine::AllPairs, &VISIBLE_ONLY);
    let (found, _, _) = solve(&view, LineEngine::Roberts, &VISIBLE_ONLY);
    assert_same("far out", &expected, &found, |span| span.qi);
    let n_hidden = (0..found.len()).filter(|&i| found.spans(i)[0].qi > 0).count();
    assert_eq!(n_hidden, 4);
}
