//! Fragments: cutting loses nothing of a triangle, and nothing of its edges.

use crate::laws::engines::{camera, mesh};
use crate::scenes::{number_of_scenes, orthographic, random};
use glam::DVec3;
use hiddenline::stages::engines::face::fragment::Fragment;
use hiddenline::stages::engines::face::painting::NO_LINE;
use hiddenline::stages::engines::face::{bsp, depth_sort, octree};
use hiddenline::stages::model::scene::Scene;
use std::collections::HashMap;

/// Largest error of a sum of rounded lengths or areas, in parts of it.
const ROUNDING: f64 = 1e-9;

/// Trees of random scenes, by either kind.
fn cut(scene: &Scene) -> [Vec<Fragment>; 2] {
    [
        bsp::BspTree::new(scene).unwrap().fragments().to_vec(),
        octree::Octree::new(scene).unwrap().fragments().to_vec(),
    ]
}

fn corners(scene: &Scene, triangle: u32) -> [DVec3; 3] {
    scene.triangles()[triangle as usize].map(|v| scene.mesh().positions()[v as usize])
}

#[test]
fn areas_of_fragments_sum_to_those_of_their_triangles() {
    let mut n_cut = 0;
    for seed in 0..number_of_scenes(200) {
        let scene = Scene::new(mesh(&random(seed)));
        for fragments in cut(&scene) {
            let mut areas = vec![0.0; scene.triangles().len()];
            for fragment in &fragments {
                areas[fragment.triangle() as usize] += fragment.area();
            }
            n_cut += fragments.len() - areas.iter().filter(|&&area| area > 0.0).count();
            for (triangle, &found) in (0..).zip(&areas) {
                let [p, q, r] = corners(&scene, triangle);
                let area = (q - p).cross(r - p).length() / 2.0;
                let scale = (q - p).length() * (r - p).length();
                assert!((found - area).abs() <= ROUNDING * scale, "seed {seed}: {found}, {area}");
            }
        }
    }
    assert!(n_cut > 400, "hardly anything is cut: {n_cut}");
}

#[test]
fn sides_of_fragments_sum_to_the_edges_that_they_lie_on() {
    for seed in 0..number_of_scenes(200) {
        let scene = Scene::new(mesh(&random(seed)));
        for fragments in cut(&scene) {
            let mut lengths: HashMap<(u32, u32), f64> = HashMap::new();
            for fragment in &fragments {
                let sides = fragment.sides();
                for (i, side) in sides.iter().enumerate() {
                    let (p, q) = (side.corner.point, sides[(i + 1) % sides.len()].corner.point);
                    if side.line == NO_LINE {
                        continue;
                    }
                    let [a, b] =
                        scene.line(side.line).map(|v| scene.mesh().positions()[v as usize]);
                    for x in [p, q] {
                        let off = (b - a).cross(x - a).length() / (b - a).length_squared();
                        assert!(off < ROUNDING, "seed {seed}: {x} is not on {a} to {b}");
                    }
                    let key = (fragment.triangle(), side.line);
                    *lengths.entry(key).or_default() += p.distance(q);
                }
            }
            for (triangle, vertices) in (0..).zip(scene.triangles()) {
                let [p, q, r] = corners(&scene, triangle);
                if (q - p).cross(r - p) == DVec3::ZERO {
                    continue;
                }
                let face = scene.triangle_faces()[triangle as usize];
                for (from, to) in [(0, 1), (1, 2), (2, 0)] {
                    let ends = [vertices[from], vertices[to]];
                    let edge = scene.topology().find_edge(ends[0], ends[1]);
                    let found = edge.and_then(|edge| lengths.get(&(triangle, edge)).copied());
                    let border = scene.mesh().face(face);
                    let is_border = (0..border.len()).any(|i| {
                        let side = [border[i], border[(i + 1) % border.len()]];
                        side == ends || side == [ends[1], ends[0]]
                    });
                    let [a, b] = ends.map(|v| scene.mesh().positions()[v as usize]);
                    let expected = if is_border { a.distance(b) } else { 0.0 };
                    let found = found.unwrap_or(0.0);
                    let difference = (found - expected).abs();
                    assert!(
                        difference <= ROUNDING * a.distance(b),
                        "seed {seed}: {found}, {expected}"
                    );
                }
            }
        }
    }
}

#[test]
fn painted_sides_lie_on_the_images_of_their_lines() {
    let mut n_sides = 0;
    for seed in 0..number_of_scenes(150) {
        let mut test_scene = random(seed);
        test_scene.sight = orthographic([1.0, -2.0, -3.0], [0.0, 0.0, 1.0]);
        let (scene, camera) = (Scene::new(mesh(&test_scene)), camera(&test_scene));
        let tree = octree::Octree::new(&scene).unwrap();
        for painting in [
            bsp::solve(&scene, &camera).unwrap().0,
            tree.paint(&scene, &camera),
            tree.paint_seen(&scene, &camera).0,
            depth_sort::solve(&scene, &camera).unwrap().0,
        ] {
            for piece in painting.pieces() {
                assert!(piece.area() > -ROUNDING, "seed {seed}: clockwise");
                for ring in piece.rings() {
                    for (i, &line) in ring.lines.iter().enumerate() {
                        if line == NO_LINE {
                            continue;
                        }
                        let ends = scene.line(line).map(|v| scene.mesh().positions()[v as usize]);
                        let [a, b] = ends.map(|p| camera.image(p));
                        let next = ring.points[(i + 1) % ring.points.len()];
                        for x in [ring.points[i], next] {
                            let off = (b - a).perp_dot(x - a) / (b - a).length();
                            assert!(off.abs() < ROUNDING, "seed {seed}: {x} is not on {a} to {b}");
                        }
                        n_sides += 1;
                    }
                }
            }
        }
    }
    assert!(n_sides > 10_000, "{n_sides} sides");
}
