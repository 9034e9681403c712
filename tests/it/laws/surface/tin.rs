//! Max-Min patches over triangulations, against all pairs of edge and triangle.

use super::max_min::{Dice, PERSPECTIVE, camera, coordinate, rough};
use glam::{DVec3, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::classify::ViewedScene;
use hiddenline::stages::engines::edge::{LineEngine, VisibilityOptions, solve};
use hiddenline::stages::engines::surface::{CellOrder, max_min, tin};
use hiddenline::stages::engines::visibility::Visibility;
use hiddenline::stages::surface::formula::{Formula, Variables};
use hiddenline::stages::surface::{LatticeLines, LinedMesh, LinedScene, TrimmedGrid, delaunay};

const ALL: LatticeLines =
    LatticeLines { along_rows: true, along_columns: true, every: 1, triangles: true };

/// Visible parts of each drawn edge, joined where they touch.
fn visible(visibility: &Visibility) -> Vec<Vec<(f64, f64)>> {
    let of_edge = |k: usize| {
        let mut ranges: Vec<(f64, f64)> = Vec::new();
        for span in visibility.spans(k).iter().filter(|span| span.qi == 0) {
            match ranges.last_mut() {
                Some(last) if last.1 == span.t0 => last.1 = span.t1,
                _ => ranges.push((span.t0, span.t1)),
            }
        }
        ranges
    };
    (0..visibility.len()).map(of_edge).collect()
}

/// Length of what only one of them holds.
fn difference(a: &[(f64, f64)], b: &[(f64, f64)]) -> f64 {
    let mut cuts: Vec<f64> = a.iter().chain(b).flat_map(|&(t0, t1)| [t0, t1]).collect();
    cuts.sort_by(f64::total_cmp);
    let holds = |ranges: &[(f64, f64)], t: f64| ranges.iter().any(|r| r.0 < t && t < r.1);
    cuts.windows(2)
        .filter(|pair| {
            let middle = (pair[0] + pair[1]) / 2.0;
            holds(a, middle) != holds(b, middle)
        })
        .map(|pair| pair[1] - pair[0])
        .sum()
}

/// Whether the horizons could draw it; panics where they differ from all pairs.
fn check(surface: &LinedScene, camera: &Camera, name: &str) -> bool {
    let view = ViewedScene::with_edges(&surface.scene, camera, surface.lines.clone());
    let settings = VisibilityOptions::EXACT;
    let Some((by_horizons, _)) = tin::solve(&view) else { return false };
    let (in_strips, _) = tin::solve_in_strips(&view, 3).expect("as in one strip");
    let (expected, ..) = solve(&view, LineEngine::AllPairs, &settings);
    let expected = visible(&expected);
    for (how, found) in [("one strip", by_horizons), ("strips", in_strips)] {
        for (k, (found, expected)) in visible(&found).iter().zip(&expected).enumerate() {
            let ends = surface.scene.line(view.selected()[k].edge);
            let ends = ends.map(|v| surface.scene.mesh().positions()[v as usize]);
            assert!(
                difference(found, expected) < 1e-9,
                "{name}, {how}: {ends:?} is visible at {expected:?}, not {found:?}\n{camera:?}"
            );
        }
    }
    true
}

/// Scattered points with whole coordinates; some share lines and circles.
fn scattered(dice: &mut Dice, kind: u64, n: usize) -> Vec<DVec3> {
    let mut points: Vec<DVec3> = Vec::new();
    while points.len() < n {
        let (x, y) = (dice.roll(9) as f64, dice.roll(9) as f64);
        let z = match kind {
            0 => dice.roll(16) as f64 - 8.0,
            1 => dice.roll(2) as f64 * 12.0,
            _ => dice.roll(3) as f64,
        };
        if points.iter().all(|p| (p.x, p.y) != (x, y)) {
            points.push(dvec3(x, y, z));
        }
    }
    points
}

fn lined(points: &[DVec3]) -> Option<LinedScene> {
    let triangles = delaunay(points).ok()?;
    let mut mesh = LinedMesh::default();
    mesh.push_triangles(points, &triangles, true);
    Some(mesh.into_scene().expect("a scene"))
}

#[test]
fn scattered_points_equal_all_pairs_from_all_nine_regions() {
    let mut dice = Dice(11);
    let mut checked = 0;
    for round in 0..720 {
        let (kind, region) = (round % 3, round / 3 % 9);
        let n = 4 + dice.roll(12) as usize;
        let points = scattered(&mut dice, kind, n);
        let Some(surface) = lined(&points) else { continue };
        let range = [0.0, 2.0, 4.0, 6.0, 8.0];
        let mut eye = dvec3(
            coordinate(&mut dice, region % 3, &range),
            coordinate(&mut dice, region / 3, &range),
            (dice.roll(160) as f64 - 80.0) / 4.0,
        );
        if dice.roll(4) == 0 {
            // Right above or below a point, or on the line of an edge.
            let [a, b] = surface.scene.line(0).map(|v| points[v as usize % points.len()]);
            let t = [0.0, 0.5, 2.0, -1.0][dice.roll(4) as usize];
            (eye.x, eye.y) = (a.x + t * (b.x - a.x), a.y + t * (b.y - a.y));
        }
        // The whole surface is seen from beside it only; straight down or up it always is.
        let target =
            if region == 4 { eye - eye.z.signum() * DVec3::Z } else { dvec3(4.0, 4.0, 0.0) };
        if target == eye {
            continue;
        }
        let camera = camera(eye, target, PERSPECTIVE);
        checked += u64::from(check(&surface, &camera, &format!("round {round}")));
    }
    assert!(checked > 300, "only {checked} scenes were drawn by horizons");
}

#[test]
fn scattered_points_equal_all_pairs_in_orthographic_projection() {
    let mut dice = Dice(12);
    let mut checked = 0;
    for round in 0..400 {
        let n = 4 + dice.roll(12) as usize;
        let points = scattered(&mut dice, round % 3, n);
        let Some(surface) = lined(&points) else { continue };
        let step = |dice: &mut Dice| dice.roll(7) as f64 - 3.0;
        let forward = dvec3(step(&mut dice), step(&mut dice), step(&mut dice));
        if forward == DVec3::ZERO {
            continue;
        }
        let camera = camera(DVec3::ZERO, forward, Projection::Orthographic);
        assert!(check(&surface, &camera, &format!("round {round}")), "round {round}: not drawn");
        checked += 1;
    }
    assert!(checked > 350, "only {checked} scenes");
}

#[test]
fn grids_with_level_curves_equal_all_pairs() {
    let mut dice = Dice(13);
    for round in 0..120 {
        let (nx, ny) = (2 + dice.roll(4) as usize, 2 + dice.roll(4) as usize);
        let grid = rough(&mut dice, round % 5, nx, ny);
        let mut mesh = LinedMesh::default();
        mesh.push_grid(&grid, &ALL);
        mesh.add_levels(&[-2.5, 0.5, 1.0]);
        let surface = mesh.into_scene().expect("a scene");
        let eye = dvec3(-7.0 - dice.roll(9) as f64, 3.0 - dice.roll(20) as f64, 9.0);
        let camera = camera(eye, dvec3(3.0, 3.0, 0.0), PERSPECTIVE);
        check(&surface, &camera, &format!("round {round}"));
    }
}

#[test]
fn a_disk_is_drawn_by_horizons() {
    let formula = |text| Formula::parse(text, Variables::Plane).expect("a formula");
    let (z, disk) = (formula("sin(3*x)*cos(2*y)"), formula("x^2+y^2<=1"));
    let grid =
        TrimmedGrid::sample(&z, Some(&disk), (-1.5, 1.5), (-1.5, 1.5), (16, 16)).expect("a grid");
    let mut mesh = LinedMesh::default();
    mesh.push_trimmed(&grid, &ALL);
    let surface = mesh.into_scene().expect("a scene");
    for eye in [dvec3(4.0, -3.0, 2.0), dvec3(-0.3, 5.0, 0.5)] {
        assert!(check(&surface, &camera(eye, DVec3::ZERO, PERSPECTIVE), "disk"));
    }
}

/// Two sheets over the same triangles that meet along the border: a grid of `n` × `n` cells with its
/// corners cut off, so that every inner edge has an inner end.
fn lens(dice: &mut Dice, kind: u64, n: i64) -> LinedScene {
    let is_cut = |i: i64, j: i64| (i == 0 || i == n) && (j == 0 || j == n);
    let is_rim = |i: i64, j: i64| i == 0 || i == n || j == 0 || j == n;
    let mut sheets: [Vec<DVec3>; 2] = Default::default();
    for k in 0..(n + 1) * (n + 1) {
        let (i, j) = (k % (n + 1), k / (n + 1));
        let middle = match kind {
            0 => 0.0,
            1 => (i + 2 * j) as f64,
            _ => dice.roll(9) as f64,
        };
        let mut half = || if is_rim(i, j) { 0.0 } else { [1.0, 3.0, 0.5][dice.roll(3) as usize] };
        let at = |z: f64| dvec3(2.0 * i as f64, 2.0 * j as f64, z);
        sheets[0].push(at(middle + half()));
        sheets[1].push(at(middle - half()));
    }
    let id = |i: i64, j: i64| (j * (n + 1) + i) as u32;
    let mut triangles = Vec::new();
    for (i, j) in (0..n).flat_map(|j| (0..n).map(move |i| (i, j))) {
        let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
        match corners.iter().position(|&(i, j)| is_cut(i, j)) {
            Some(k) => {
                let [a, b, c] = [1, 2, 3].map(|step| corners[(k + step) % 4]);
                triangles.push([a, b, c].map(|(i, j)| id(i, j)));
            }
            None => {
                let [a, b, c, d] = corners.map(|(i, j)| id(i, j));
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    let mut mesh = LinedMesh::default();
    sheets.iter().for_each(|points| mesh.push_triangles(points, &triangles, true));
    mesh.into_scene().expect("a scene")
}

#[test]
fn two_sheets_that_meet_along_the_border_equal_all_pairs_from_all_nine_regions() {
    let mut dice = Dice(15);
    let mut drawn = [0; 2];
    for round in 0..270 {
        let (kind, region) = (round % 3, round / 3 % 9);
        let n = 3 + dice.roll(2) as i64;
        let surface = lens(&mut dice, kind, n);
        let size = 2.0 * n as f64;
        let range: Vec<f64> = (0..=n).map(|k| 2.0 * k as f64).collect();
        let eye = dvec3(
            coordinate(&mut dice, region % 3, &range),
            coordinate(&mut dice, region / 3, &range),
            (dice.roll(160) as f64 - 80.0) / 4.0,
        );
        let target = if region == 4 {
            eye - eye.z.signum() * DVec3::Z
        } else {
            dvec3(size, size, 0.0) / 2.0
        };
        if target == eye {
            continue;
        }
        let camera = camera(eye, target, PERSPECTIVE);
        drawn[usize::from(region == 4)] +=
            u32::from(check(&surface, &camera, &format!("round {round}")));
    }
    assert!(drawn[0] > 150 && drawn[1] > 12, "only {drawn:?} scenes were drawn by horizons");
}

#[test]
fn two_sheets_equal_all_pairs_in_orthographic_projection() {
    let mut dice = Dice(16);
    for round in 0..120 {
        let n = 3 + dice.roll(2) as i64;
        let surface = lens(&mut dice, round % 3, n);
        let step = |dice: &mut Dice| dice.roll(7) as f64 - 3.0;
        let mut forward = dvec3(step(&mut dice), step(&mut dice), step(&mut dice));
        if round % 20 == 0 {
            forward = if round % 40 == 0 { DVec3::Z } else { -DVec3::Z };
        }
        if forward == DVec3::ZERO {
            continue;
        }
        let camera = camera(DVec3::ZERO, forward, Projection::Orthographic);
        assert!(check(&surface, &camera, &format!("round {round}")), "round {round}: not drawn");
    }
}

#[test]
fn a_ball_of_two_sheets_is_drawn_by_horizons() {
    let formula = |text| Formula::parse(text, Variables::Plane).expect("a formula");
    let disk = formula("1");
    let sheets = ["sqrt(1-x^2-y^2)", "-sqrt(1-x^2-y^2)"].map(|text| {
        let (x, n) = ((-1.1, 1.1), (12, 12));
        TrimmedGrid::sample(&formula(text), Some(&disk), x, x, n).expect("a grid")
    });
    let [mut upper, mut lower] = sheets;
    assert!(upper.meet_at_rim(&mut lower, 1e-6) > 12);
    let mut mesh = LinedMesh::default();
    mesh.push_trimmed(&upper, &ALL);
    mesh.push_trimmed(&lower, &ALL);
    let surface = mesh.into_scene().expect("a scene");
    for eye in [dvec3(4.0, -3.0, 2.0), dvec3(-0.3, 5.0, 0.5), dvec3(0.2, 0.1, -6.0)] {
        let camera = camera(eye, DVec3::ZERO, PERSPECTIVE);
        assert!(check(&surface, &camera, "ball"), "{eye}");
    }
}

#[test]
fn sheets_that_cross_or_leave_a_gap_are_left_to_mesh_engines() {
    let camera = camera(dvec3(30.0, -22.0, 16.0), DVec3::ZERO, PERSPECTIVE);
    let heights = |inner: [f64; 2], rim: f64| {
        let ring = [(4.0, 0.0), (0.0, 4.0), (-4.0, 0.0), (0.0, -4.0)];
        let triangles = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
        let mut mesh = LinedMesh::default();
        for (z, rim) in [(inner[0], 0.0), (inner[1], rim)] {
            let mut points: Vec<DVec3> = ring.iter().map(|&(x, y)| dvec3(x, y, rim)).collect();
            points.push(dvec3(0.0, 0.0, z));
            mesh.push_triangles(&points, &triangles, true);
        }
        mesh.into_scene().expect("a scene")
    };
    let is_drawn = |surface: &LinedScene| check(surface, &camera, "roof");
    assert!(is_drawn(&heights([2.0, -1.0], 0.0)) && is_drawn(&heights([-1.0, 2.0], 0.0)));
    assert!(is_drawn(&heights([5.0, 2.0], 0.0)), "both above the rim");
    assert!(!is_drawn(&heights([2.0, -1.0], -0.5)), "a gap along the rim");
    assert!(!is_drawn(&heights([2.0, -1.0], 0.5)), "crossing near the rim");
    // The same with a second ring on which the sheets change places.
    let mut dice = Dice(17);
    let crossing = {
        let surface = lens(&mut dice, 0, 3);
        let mut points = surface.scene.mesh().positions().to_vec();
        let top = (0..points.len()).find(|&k| points[k].z > 0.0).expect("an inner vertex");
        let twin = (0..points.len())
            .find(|&k| points[k].truncate() == points[top].truncate() && points[k].z < 0.0)
            .expect("its twin");
        points[top].z = -5.0;
        assert!(points[twin].z > -5.0);
        let mut mesh = LinedMesh::default();
        mesh.push_triangles(&points, surface.scene.triangles(), true);
        mesh.into_scene().expect("a scene")
    };
    assert!(!is_drawn(&crossing), "crossing inside");
    // With the eye between the sheets neither horizon starts at infinity.
    let inside = super::max_min::camera(dvec3(0.5, 0.25, 0.5), DVec3::X, PERSPECTIVE);
    assert!(!check(&heights([4.0, -4.0], 0.0), &inside, "inside"));
}

#[test]
fn what_is_no_function_over_a_convex_domain_is_left_to_mesh_engines() {
    let eye = dvec3(9.0, -7.0, 6.0);
    let camera = camera(eye, DVec3::ZERO, PERSPECTIVE);
    let is_drawn = |points: &[DVec3], triangles: &[[u32; 3]]| {
        let mut mesh = LinedMesh::default();
        mesh.push_triangles(points, triangles, true);
        let surface = mesh.into_scene().expect("a scene");
        let view = ViewedScene::with_edges(&surface.scene, &camera, surface.lines.clone());
        tin::solve(&view).is_some()
    };
    let plan = |corners: &[(f64, f64)]| -> Vec<DVec3> {
        corners.iter().map(|&(x, y)| dvec3(x, y, 0.0)).collect()
    };
    let square = plan(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
    assert!(is_drawn(&square, &[[0, 1, 2], [0, 2, 3]]), "a square");
    assert!(!is_drawn(&square, &[[0, 2, 1], [0, 3, 2]]), "seen from below it is wound so");
    let bay = plan(&[(0.0, 0.0), (2.0, 0.0), (1.0, 0.5), (0.0, 2.0)]);
    assert!(!is_drawn(&bay, &[[0, 1, 2], [0, 2, 3]]), "a bay");
    let apart = plan(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (3.0, 0.0), (4.0, 0.0), (3.0, 1.0)]);
    assert!(!is_drawn(&apart, &[[0, 1, 2], [3, 4, 5]]), "two pieces");
    // Three blades around a hole, each beginning behind the one before.
    let ring = plan(&[(0.0, 0.0), (6.0, 0.0), (3.0, 6.0), (2.0, 1.0), (4.0, 1.0), (3.0, 3.0)]);
    let blades = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]];
    assert!(!is_drawn(&ring, &blades), "a hole");
}

/// Large enough for the horizons' steps to be found several times.
#[test]
fn surfaces_of_which_most_is_passed_over_equal_all_pairs() {
    let mut dice = Dice(14);
    for round in 0..10 {
        let grid = rough(&mut dice, round % 5, 24, 24);
        let mut mesh = LinedMesh::default();
        mesh.push_grid(&grid, &LatticeLines { triangles: false, ..ALL });
        let surface = mesh.into_scene().expect("a scene");
        let height = [40.0, 3.0, -25.0][dice.roll(3) as usize];
        let eye = dvec3(-9.0 - dice.roll(40) as f64, dice.roll(60) as f64 - 5.0, height);
        let camera = camera(eye, dvec3(24.0, 24.0, 0.0), PERSPECTIVE);
        assert!(check(&surface, &camera, &format!("round {round}")), "round {round}: not drawn");

        let view = ViewedScene::with_edges(&surface.scene, &camera, surface.lines.clone());
        let (by_triangles, _) = tin::solve(&view).expect("pieces");
        let by_triangles: f64 =
            visible(&by_triangles).iter().flatten().map(|(t0, t1)| t1 - t0).sum();
        let by_cells = max_min::solve(&grid, &camera, CellOrder::Rows).expect("pieces");
        let by_cells: f64 = by_cells.iter().map(|piece| piece.t1 - piece.t0).sum();
        assert!((by_cells - by_triangles).abs() < 1e-7, "{round}: {by_cells}, {by_triangles}");
    }
}

#[test]
fn triangles_that_come_before_each_other_in_turn_are_left_to_mesh_engines() {
    let at = |deg: f64, radius: f64| {
        let (sin, cos) = deg.to_radians().sin_cos();
        dvec3(radius * cos, radius * sin, 0.0)
    };
    // A pinwheel: from its middle every blade lies behind the next one.
    let mut points: Vec<DVec3> = [5.0, 125.0, 245.0].map(|deg| at(deg, 10.0)).to_vec();
    points.extend([30.0, 150.0, 270.0].map(|deg| at(deg, 1.0)));
    let triangles = [[0, 4, 3], [0, 1, 4], [1, 5, 4], [1, 2, 5], [2, 3, 5], [2, 0, 3], [3, 4, 5]];
    let mut mesh = LinedMesh::default();
    mesh.push_triangles(&points, &triangles, true);
    let surface = mesh.into_scene().expect("a scene");
    let above = |x: f64, y: f64| camera(dvec3(x, y, 5.0), dvec3(x, y, 0.0), PERSPECTIVE);
    assert!(!check(&surface, &above(0.0, 0.0), "pinwheel"));
    assert!(check(&surface, &above(40.0, 3.0), "from beside it"));
}
