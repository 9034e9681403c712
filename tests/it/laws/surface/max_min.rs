//! Max-Min patches against brute force in integers.

use std::collections::HashMap;

use glam::{DVec3, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::classify::ViewedScene;
use hiddenline::stages::engines::edge::{LineEngine, VisibilityOptions, solve as engine};
use hiddenline::stages::engines::surface::{
    CellOrder, GridPieces, HorizonError, SurfaceSide, max_min,
};
use hiddenline::stages::surface::{Grid, LatticeLines, LinedMesh};

use super::brute;

pub(super) const PERSPECTIVE: Projection = Projection::Perspective { fov_deg: 40.0, near: 1e-6 };

/// A small generator of whole numbers (Knuth's MMIX constants), so that failures repeat.
pub(super) struct Dice(pub(super) u64);

impl Dice {
    pub(super) fn roll(&mut self, sides: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 33) % sides
    }
}

pub(super) fn camera(eye: DVec3, target: DVec3, projection: Projection) -> Camera {
    let forward = target - eye;
    let up = if forward.x == 0.0 && forward.y == 0.0 { DVec3::Y } else { DVec3::Z };
    Camera::new(eye, target, up, projection).expect("a camera")
}

pub(super) fn intervals(pieces: &GridPieces) -> Vec<Vec<(f64, f64)>> {
    let mut edges = vec![Vec::new(); pieces.n_edges()];
    for piece in pieces.iter() {
        assert!(piece.t0 < piece.t1, "no zero-length piece: {piece:?}");
        let edge: &mut Vec<(f64, f64)> = &mut edges[piece.edge as usize];
        if let Some(last) = edge.last() {
            assert!(last.1 <= piece.t0, "pieces are disjoint: {last:?} {piece:?}");
        }
        edge.push((piece.t0, piece.t1));
    }
    edges
}

/// Rough surfaces of several kinds, with whole heights.
pub(super) fn rough(dice: &mut Dice, kind: u64, nx: usize, ny: usize) -> Grid {
    let heights = (0..nx * ny)
        .map(|_| match kind {
            0 => dice.roll(16) as f64 - 8.0,
            1 => {
                if dice.roll(6) == 0 {
                    dice.roll(60) as f64
                } else {
                    0.0
                }
            }
            2 => dice.roll(2) as f64 * 4.0,
            3 => dice.roll(3) as f64,
            _ => (dice.roll(1024) as f64 - 512.0) / 64.0,
        })
        .collect();
    let uneven = kind == 4;
    let mut lines = |n: usize| -> Vec<f64> {
        let mut at = 0.0;
        (0..n)
            .map(|_| {
                let here = at;
                at += if uneven { 1.0 + dice.roll(3) as f64 } else { 2.0 };
                here
            })
            .collect()
    };
    let (xs, ys) = (lines(nx), lines(ny));
    Grid::new(xs, ys, heights).expect("a grid")
}

fn check(grid: &Grid, camera: &Camera, name: &str) -> bool {
    let scale = 64.0;
    let place = |p: DVec3, w: i128| {
        let p = p * scale;
        assert_eq!(p, p.round());
        [p.x as i128, p.y as i128, p.z as i128, w]
    };
    let eye = match camera.projection() {
        Projection::Perspective { .. } => place(camera.eye(), 1),
        Projection::Orthographic => place(-camera.forward(), 0),
    };
    let by_rows = match max_min::solve(grid, camera, CellOrder::Rows) {
        Ok(pieces) => pieces,
        Err(HorizonError::EyeOnSurface) => return false,
        Err(error) => panic!("{name}: {error}"),
    };
    let by_diagonals = max_min::solve(grid, camera, CellOrder::Diagonals).expect("as by rows");
    let truth = brute::grid_lines(grid, eye, scale);
    let strips = max_min::solve_in_strips(grid, camera, CellOrder::Rows, 1).expect("as by rows");
    let all = [("rows", &by_rows), ("diagonals", &by_diagonals), ("strips", &strips)];
    for (order, pieces) in all {
        for (edge, (got, expected)) in intervals(pieces).iter().zip(&truth).enumerate() {
            if expected.first().is_some_and(|range| range.0.is_nan()) {
                continue;
            }
            let difference = brute::difference(got, expected);
            assert!(
                difference < 1e-9,
                "{name}, {order}: edge {edge} {:?} of {grid:?}\nfrom {camera:?}\nis visible at {expected:?}, not {got:?}",
                grid.ends(edge as u32).map(|k| grid.point(k))
            );
        }
    }
    true
}

/// An eye left of, in, or right of a range; half of those inside stand on a grid line.
pub(super) fn coordinate(dice: &mut Dice, region: u64, lines: &[f64]) -> f64 {
    let (low, high) = (lines[0], lines[lines.len() - 1]);
    let part = |dice: &mut Dice| (1 + dice.roll(24)) as f64 / 4.0;
    match region {
        0 => low - part(dice),
        1 if dice.roll(2) == 0 => lines[dice.roll(lines.len() as u64) as usize],
        1 => low + (dice.roll(1 + ((high - low) * 4.0) as u64)) as f64 / 4.0,
        _ => high + part(dice),
    }
}

#[test]
fn rough_surfaces_equal_brute_force_in_perspective_from_all_nine_regions() {
    let mut dice = Dice(7);
    let mut checked = 0;
    for round in 0..540 {
        let (kind, region) = (round % 5, round / 5 % 9);
        let (nx, ny) = (2 + dice.roll(4) as usize, 2 + dice.roll(4) as usize);
        let grid = rough(&mut dice, kind, nx, ny);
        let z = (dice.roll(160) as f64 - 80.0) / 4.0;
        let eye = dvec3(
            coordinate(&mut dice, region % 3, grid.xs()),
            coordinate(&mut dice, region / 3, grid.ys()),
            z,
        );
        let target = eye + dvec3(1.0 - dice.roll(3) as f64, 2.0 - dice.roll(3) as f64, -0.5);
        checked +=
            u64::from(check(&grid, &camera(eye, target, PERSPECTIVE), &format!("round {round}")));
    }
    assert!(checked > 450, "only {checked} scenes had the eye off the surface");
}

#[test]
fn a_tall_spike_off_the_axis_hides_no_more_than_it_covers() {
    let mut heights = vec![0.0; 9];
    heights[0] = 4.0;
    let grid = Grid::new(vec![0.0, 1.0, 2.0], vec![0.0, 1.0, 2.0], heights).expect("a grid");
    let camera = camera(dvec3(-2.0, -2.0, 5.0), dvec3(0.0, 2.0, 0.0), PERSPECTIVE);
    assert!((camera.image(dvec3(2.0, 1.0, 0.0)) - glam::dvec2(1.0 / 3.0, 0.0)).length() < 1e-15);
    assert!(check(&grid, &camera, "spike"));
    let pieces = max_min::solve(&grid, &camera, CellOrder::Rows).expect("a drawing");
    let lines = intervals(&pieces);
    // Sample (2,1), at which the edges from (1,1) and from (2,0) end.
    let edges: Vec<usize> = (0..lines.len()).filter(|&e| grid.ends(e as u32)[1] == 5).collect();
    assert_eq!(edges.len(), 2);
    for edge in edges {
        assert!(lines[edge].last().is_some_and(|range| range.1 == 1.0), "{:?}", lines[edge]);
    }
}

/// A triangle wave extruded along y: valleys at even x, peaks at odd x.
#[test]
fn valleys_of_a_triangle_wave_are_hidden_where_the_closed_form_says() {
    let n = 10;
    let heights = (0..3 * n).map(|k| f64::from(k % n % 2)).collect();
    let xs = (0..n).map(f64::from).collect();
    let grid = Grid::new(xs, vec![0.0, 1.0, 2.0], heights).expect("a grid");
    for slope in [0.5, 0.25, 0.9] {
        let forward = dvec3(1.0, 0.0, -slope);
        let camera = camera(DVec3::ZERO, forward, Projection::Orthographic);
        let pieces = max_min::solve(&grid, &camera, CellOrder::Rows).expect("a drawing");
        let lines = intervals(&pieces);
        // The middle line along x; those on the border have nothing beside them.
        let mut visible: Vec<(f64, f64)> = Vec::new();
        for i in 0..n as usize - 1 {
            for (from, to) in &lines[n as usize - 1 + i] {
                visible.push((i as f64 + from, i as f64 + to));
            }
        }
        let mut expected = vec![(0.0, 1.0)];
        for k in 0..n / 2 - 1 {
            let k = 2.0 * f64::from(k);
            expected.push((k + (3.0 + slope) / (1.0 + slope), (k + 3.0).min(f64::from(n - 1))));
        }
        assert!(brute::difference(&visible, &expected) < 1e-9, "{visible:?} {expected:?}");
    }
}

/// The contour of z = x² + y² seen from (ex, ey, ez) stands over the circle about (ex, ey) with
/// radius √(ex² + ey² − ez): within it the inner side is seen, beyond it nothing or the outer side.
#[test]
fn sides_of_a_paraboloid_change_at_its_closed_form_contour() {
    let n = 201;
    let lines = hiddenline::stages::surface::evenly(-2.0, 2.0, n);
    let heights = lines.iter().flat_map(|y| lines.iter().map(move |x| x * x + y * y)).collect();
    let grid = Grid::new(lines.clone(), lines, heights).expect("a grid");
    let eye = dvec3(-3.0, -1.0, 6.0);
    let radius = (eye.x * eye.x + eye.y * eye.y - eye.z).sqrt();
    let camera = camera(eye, DVec3::ZERO, PERSPECTIVE);
    let pieces = max_min::solve(&grid, &camera, CellOrder::Rows).expect("a drawing");
    let mut seen = [0, 0];
    for piece in pieces.iter() {
        let [a, b] = grid.ends(piece.edge).map(|k| grid.point(k));
        let middle = a + (piece.t0 + piece.t1) / 2.0 * (b - a);
        let distance = (middle.truncate() - eye.truncate()).length() - radius;
        // The outer side is seen from below and before the contour, the inner one beyond it.
        // The domain's near border has nothing in front that could tell the sides apart.
        if distance.abs() > 0.05 && a.x > -2.0 {
            let expected = if distance < 0.0 { SurfaceSide::Lower } else { SurfaceSide::Upper };
            assert_eq!(piece.side, expected, "at {middle}");
            seen[usize::from(distance < 0.0)] += 1;
        }
    }
    assert!(seen[0] > 1000 && seen[1] > 1000, "{seen:?}");
}

#[test]
fn an_eye_on_the_surface_and_holes_are_refused() {
    let grid =
        |z| Grid::new(vec![0.0, 1.0], vec![0.0, 1.0], vec![0.0, 0.0, 0.0, z]).expect("a grid");
    let camera = camera(dvec3(0.75, 0.25, 0.25), DVec3::ZERO, PERSPECTIVE);
    let solve =
        |grid: &Grid| max_min::solve(grid, &camera, CellOrder::Rows).expect_err("no drawing");
    assert_eq!(solve(&grid(1.0)), HorizonError::EyeOnSurface);
    assert_eq!(solve(&grid(f64::NAN)), HorizonError::Holes);
}

#[test]
fn a_view_from_right_above_hides_nothing() {
    let grid = rough(&mut Dice(3), 1, 6, 5);
    let camera = camera(dvec3(1.0, 1.0, 90.0), dvec3(1.0, 1.0, 0.0), Projection::Orthographic);
    let pieces = max_min::solve(&grid, &camera, CellOrder::Rows).expect("a drawing");
    assert!(intervals(&pieces).iter().all(|edge| edge[..] == [(0.0, 1.0)]));
}

#[test]
fn rough_surfaces_equal_brute_force_in_orthographic_views() {
    let mut dice = Dice(11);
    for round in 0..270 {
        let (nx, ny) = (2 + dice.roll(4) as usize, 2 + dice.roll(4) as usize);
        let grid = rough(&mut dice, round % 5, nx, ny);
        let component = |dice: &mut Dice| (dice.roll(9) as f64 - 4.0) / 2.0;
        let forward = dvec3(component(&mut dice), component(&mut dice), component(&mut dice));
        if forward == DVec3::ZERO {
            continue;
        }
        check(
            &grid,
            &camera(DVec3::ZERO, forward, Projection::Orthographic),
            &format!("round {round}"),
        );
    }
}

/// For each grid line between two samples what part of it an engine for meshes, which decides exactly,
/// finds visible.
fn visible_by_mesh(grid: &Grid, camera: &Camera) -> HashMap<[u32; 2], f64> {
    let mut mesh = LinedMesh::default();
    let all = LatticeLines { along_rows: true, along_columns: true, every: 1, triangles: false };
    mesh.push_grid(grid, &all);
    let surface = mesh.into_scene().expect("a scene");
    let view = ViewedScene::with_edges(&surface.scene, camera, surface.lines.clone());
    let (found, ..) = engine(&view, LineEngine::Roberts, &VisibilityOptions::EXACT);
    let visible = |k: usize| -> f64 {
        found.spans(k).iter().filter(|span| span.qi == 0).map(|span| span.t1 - span.t0).sum()
    };
    let topology = surface.scene.topology();
    let ends = surface.lines.iter().map(|line| topology.edge(line.edge));
    ends.enumerate().map(|(k, ends)| (ends, visible(k))).collect()
}

/// An eye next to the plane of a grid line, as decimal fractions have it.
#[test]
fn an_eye_nearly_in_the_plane_of_a_grid_line_loses_nothing_of_it() {
    let mut xs: Vec<f64> = (0..16).map(|k| -1.5 + 0.2 * f64::from(k)).collect();
    xs[6] = -0.30000000000000004;
    let heights = (0..256).map(|k| f64::from(k % 16 * (k / 16) % 7) / 4.0).collect();
    let grid = Grid::new(xs.clone(), xs, heights).expect("a grid");
    let camera = camera(dvec3(-0.3, 5.0, 2.5), DVec3::ZERO, PERSPECTIVE);
    let pieces = max_min::solve(&grid, &camera, CellOrder::Rows).expect("pieces");

    let expected = visible_by_mesh(&grid, &camera);
    let expected: f64 = expected.values().sum();
    let found: f64 = pieces.iter().map(|piece| piece.t1 - piece.t0).sum();
    assert!((found - expected).abs() < 1e-9 * expected, "{found} instead of {expected}");
}

#[test]
fn a_vertical_view_sees_the_upper_side_from_above_and_the_lower_side_from_below() {
    let grid = rough(&mut Dice(4), 0, 5, 4);
    for (height, side) in [(90.0, SurfaceSide::Upper), (-90.0, SurfaceSide::Lower)] {
        let camera =
            camera(dvec3(1.0, 1.0, height), dvec3(1.0, 1.0, 0.0), Projection::Orthographic);
        let pieces = max_min::solve(&grid, &camera, CellOrder::Rows).expect("a drawing");
        assert!(pieces.iter().all(|piece| piece.side == side), "{height}");
    }
}

#[test]
fn only_cells_between_the_eye_and_the_near_plane_are_in_its_way() {
    // The eye looks along x from 0; the near plane is at x = 1.
    let near = Projection::Perspective { fov_deg: 40.0, near: 1.0 };
    let camera = camera(dvec3(0.0, 0.0, 5.0), dvec3(1.0, 0.0, 5.0), near);
    let is_clear = |from: f64, to: f64| {
        let middle = 0.5 * from + 0.5 * to;
        let xs = vec![from, middle, to];
        let grid = Grid::new(xs, vec![-1.0, 1.0], vec![0.0; 6]).expect("a grid");
        max_min::is_clear_of_near_plane(&grid, &camera)
    };
    assert!(is_clear(1.0, 4.0), "beyond");
    assert!(is_clear(-4.0, 0.0), "behind the eye");
    assert!(!is_clear(0.25, 0.75), "between both");
    assert!(!is_clear(0.5, 2.0), "across the near plane");
    assert!(!is_clear(-0.5, 0.5), "across the eye");
}

/// A plane seen along itself, but for rounding: all its lines have one image, and which of two is in front
/// only exact arithmetic tells.
fn plane_along_itself(fraction: &mut impl FnMut() -> f64, n: usize) -> (Grid, Camera) {
    let mut lines = || (0..n).map(|k| k as f64 + 0.3 * fraction()).collect::<Vec<f64>>();
    let (xs, ys) = (lines(), lines());
    let (along, slope) = (dvec3(0.3 + fraction(), 0.3 + fraction(), 0.0), fraction());
    let heights =
        ys.iter().flat_map(|y| xs.iter().map(move |x| slope * (along.x * x + along.y * y)));
    let grid = Grid::new(xs.clone(), ys.clone(), heights.collect()).expect("a grid");
    let forward = along.with_z(slope * along.length_squared());
    (grid, camera(DVec3::ZERO, forward, Projection::Orthographic))
}

/// For each edge what part of it is visible.
fn visible_parts(pieces: &GridPieces) -> Vec<f64> {
    let mut found = vec![0.0; pieces.n_edges()];
    pieces.iter().for_each(|piece| found[piece.edge as usize] += piece.t1 - piece.t0);
    found
}

#[test]
fn planes_seen_nearly_along_themselves_equal_exact_engines() {
    let mut dice = Dice(29);
    let mut fraction = move || dice.roll(1 << 31) as f64 / f64::from(1u32 << 31);
    let (mut n_hidden, mut n_visible) = (0, 0);
    for round in 0..3 {
        let (grid, camera) = plane_along_itself(&mut fraction, 14);
        let pieces = max_min::solve(&grid, &camera, CellOrder::Rows).expect("pieces");
        let expected = visible_by_mesh(&grid, &camera);
        for (edge, found) in (0..).zip(visible_parts(&pieces)) {
            let expected = expected[&grid.ends(edge)];
            assert!((found - expected).abs() < 1e-6, "round {round}, {edge}: {found}, {expected}");
            n_hidden += usize::from(expected < 0.5);
            n_visible += usize::from(expected > 0.5);
        }
    }
    assert!(n_hidden > 50 && n_visible > 50, "{n_hidden} hidden, {n_visible} visible");
}

#[test]
fn planes_seen_nearly_along_themselves_are_the_same_in_any_order_and_number_of_strips() {
    let mut dice = Dice(31);
    let mut fraction = move || dice.roll(1 << 31) as f64 / f64::from(1u32 << 31);
    for round in 0..4 {
        let (grid, camera) = plane_along_itself(&mut fraction, 44);
        let solve = |order, cells| {
            let pieces = max_min::solve_in_strips(&grid, &camera, order, cells).expect("pieces");
            visible_parts(&pieces)
        };
        let expected = solve(CellOrder::Rows, 100);
        for (order, cells) in [(CellOrder::Rows, 10_000), (CellOrder::Diagonals, 10_000)] {
            let found = solve(order, cells);
            let farthest = expected.iter().zip(found).map(|(a, b)| (a - b).abs());
            let farthest = farthest.fold(0.0, f64::max);
            assert!(farthest < 1e-6, "round {round}, {order:?}, {cells}: {farthest}");
        }
    }
}
