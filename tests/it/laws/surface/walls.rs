//! Lines on the back of the box around a surface: the horizons against the mesh engine.

use glam::{DVec3, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::classify::{LineSelection, ViewSegments, ViewedScene};
use hiddenline::stages::engines::edge::{VisibilityOptions, roberts};
use hiddenline::stages::engines::surface::{CellOrder, max_min};
use hiddenline::stages::predicates::PiercePoint;
use hiddenline::stages::strokes::StrokeKind;
use hiddenline::stages::surface::{Grid, LatticeLines, LinedMesh};
use proptest::prelude::*;

/// Wires on all faces of the box that are behind it for an eye at `eye`, or seen along `-eye`.
fn wires(low: DVec3, high: DVec3, camera: &Camera) -> Vec<[DVec3; 2]> {
    let mut wires = Vec::new();
    for axis in 0..3 {
        for (side, outwards) in [(low[axis], -1.0), (high[axis], 1.0)] {
            let toward_eye = match camera.projection() {
                Projection::Perspective { .. } => camera.eye()[axis] - side,
                Projection::Orthographic => -camera.forward()[axis],
            };
            if toward_eye * outwards >= 0.0 {
                continue;
            }
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            for (across, along) in [(b, c), (c, b)] {
                for part in [0.0, 0.25, 0.5, 0.625, 1.0] {
                    let mut ends = [DVec3::ZERO; 2];
                    for (end, place) in ends.iter_mut().zip([low, high]) {
                        end[axis] = side;
                        end[across] = low[across] + part * (high[across] - low[across]);
                        end[along] = place[along];
                    }
                    wires.push(ends);
                }
            }
        }
    }
    wires
}

/// The visible parts of wires as the mesh engine finds them.
fn by_mesh(grid: &Grid, camera: &Camera, wires: &[[DVec3; 2]]) -> Vec<Vec<[f64; 2]>> {
    let lines =
        LatticeLines { along_rows: false, along_columns: false, every: 1, triangles: false };
    let mut mesh = LinedMesh::default();
    mesh.push_grid(grid, &lines);
    let scene = mesh.into_scene().expect("a scene").scene;
    let mut segments = ViewSegments::new(&scene);
    for wire in wires {
        let ends = wire.map(|p| segments.push_point(PiercePoint::at(p)));
        segments.push(ends, StrokeKind::Wire);
    }
    let view = ViewedScene::with_segments(&scene, camera, LineSelection::NONE, 180.0, &segments);
    let (visibility, _) = roberts::solve(&view, &VisibilityOptions::EXACT);
    let first = scene.n_lines() as u32;
    let mut parts = vec![Vec::new(); wires.len()];
    for (number, drawn) in view.selected().iter().enumerate() {
        let visible = visibility.spans(number).iter().filter(|span| span.qi == 0);
        parts[(drawn.edge - first) as usize] = visible.map(|span| [span.t0, span.t1]).collect();
    }
    parts
}

/// How much of a wire only one of two lists shows.
fn difference(one: &[[f64; 2]], other: &[[f64; 2]]) -> f64 {
    let length = |parts: &[[f64; 2]]| parts.iter().map(|[a, b]| b - a).sum::<f64>();
    let common: f64 = one
        .iter()
        .flat_map(|[a, b]| other.iter().map(move |[c, d]| (b.min(*d) - a.max(*c)).max(0.0)))
        .sum();
    length(one) + length(other) - 2.0 * common
}

fn check(grid: &Grid, lift: f64, camera: &Camera) -> Result<usize, TestCaseError> {
    let (xs, ys) = (grid.xs(), grid.ys());
    let (least, most) = grid.heights().expect("heights");
    let low = dvec3(xs[0], ys[0], least - lift);
    let high = dvec3(xs[xs.len() - 1], ys[ys.len() - 1], most + lift);
    let wires = wires(low, high, camera);
    // Wires that are seen end-on have no image.
    let Ok((_, parts)) = max_min::solve_with_wires(grid, camera, CellOrder::Rows, &wires) else {
        return Ok(0);
    };
    let expected = by_mesh(grid, camera, &wires);
    let mut n_hidden = 0;
    for ((wire, found), expected) in wires.iter().zip(&parts).zip(&expected) {
        let [a, b] = wire.map(|p| camera.image(p));
        if a.distance(b) < 1e-9 {
            continue;
        }
        n_hidden += usize::from(difference(expected, &[[0.0, 1.0]]) > 0.0);
        prop_assert!(
            difference(found, expected) < 1e-9,
            "{wire:?}: {found:?}, not {expected:?}; {grid:?} {camera:?}"
        );
    }
    Ok(n_hidden)
}

fn grid(nx: usize, ny: usize, zs: Vec<f64>) -> Grid {
    let even = |n: usize| (0..n).map(|k| k as f64).collect();
    Grid::new(even(nx), even(ny), zs).expect("a grid")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn horizons_hide_lines_behind_the_surface_as_the_mesh_engine_does(
        (nx, ny, zs) in (2..6_usize, 2..6_usize).prop_flat_map(|(nx, ny)| {
            (Just(nx), Just(ny), prop::collection::vec(-2..3_i32, nx * ny))
        }),
        eye in (-9..14_i32, -9..14_i32, -9..14_i32),
        lift in 1..3_i32,
        is_parallel in any::<bool>(),
        jitter in prop::collection::vec(-0.5..0.5_f64, 25),
        is_rough in any::<bool>(),
    ) {
        let rough = |k: usize| if is_rough { jitter[k] } else { 0.0 };
        let zs = zs.iter().enumerate().map(|(k, z)| f64::from(*z) + rough(k)).collect();
        let grid = grid(nx, ny, zs);
        let eye = dvec3(eye.0.into(), eye.1.into(), eye.2.into());
        let middle = dvec3((nx - 1) as f64 / 2.0, (ny - 1) as f64 / 2.0, 0.0);
        let projection = if is_parallel {
            Projection::Orthographic
        } else {
            Projection::Perspective { fov_deg: 40.0, near: 1e-6 }
        };
        let Ok(camera) = Camera::new(eye, middle, DVec3::Z, projection) else { return Ok(()) };
        // Axes are drawn only around what is wholly in front of the eye.
        let size = dvec3(nx as f64, ny as f64, 4.0);
        prop_assume!(is_parallel || (eye - middle).abs().cmpgt(size).any());
        check(&grid, f64::from(lift), &camera)?;
    }
}

#[test]
fn a_hat_hides_the_walls_behind_it_with_many_strips() {
    let hat = Grid::from_fn((-6.0, 6.0), (-6.0, 6.0), (160, 140), |x: f64, y: f64| {
        let r = x.hypot(y);
        if r == 0.0 { 4.0 } else { 4.0 * libm::sin(2.0 * r) / (2.0 * r) }
    });
    let hat = hat.expect("a grid");
    for eye in [dvec3(10.0, -20.0, 9.0), dvec3(-3.0, -30.0, 2.0), dvec3(20.0, 20.0, -6.0)] {
        for projection in
            [Projection::Orthographic, Projection::Perspective { fov_deg: 30.0, near: 1e-3 }]
        {
            let camera = Camera::new(eye, DVec3::ZERO, DVec3::Z, projection).expect("a camera");
            let n_hidden = check(&hat, 0.5, &camera).expect("the same parts");
            assert!(n_hidden > 10, "{n_hidden}");
        }
    }
}
