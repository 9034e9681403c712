//! Level curves in the plane against closed forms: the half-open rule and saddles.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use hiddenline::stages::strokes::StrokeKind;
use hiddenline::stages::surface::formula::{Formula, Variables};
use hiddenline::stages::surface::{
    Grid, HeightFunction, HeightOptions, LatticeLines, LinedMesh, TrimmedGrid, read_heights,
};

const NO_LINES: LatticeLines =
    LatticeLines { along_rows: false, along_columns: false, every: 1, triangles: false };

/// The ends of the pieces of the level curves in the plane.
fn pieces(grid: &Grid, levels: &[f64]) -> Vec<[f64; 4]> {
    traced(grid, None, levels)
}

/// The same, traced on the function that the grid was sampled from.
fn traced(grid: &Grid, function: Option<HeightFunction>, levels: &[f64]) -> Vec<[f64; 4]> {
    let mut mesh = LinedMesh::for_levels(levels);
    mesh.begin_sheet(function);
    mesh.push_grid(grid, &NO_LINES);
    mesh.add_levels(levels);
    let scene = mesh.into_scene().expect("a scene");
    let mesh = scene.scene.mesh();
    let ends = |edge: u32| {
        let [a, b] = scene.scene.topology().edge(edge);
        [a, b].map(|v| mesh.positions()[v as usize])
    };
    let pieces: Vec<[f64; 4]> =
        scene.lines.iter().map(|line| ends(line.edge)).map(|[a, b]| [a.x, a.y, b.x, b.y]).collect();
    let unique: BTreeSet<[u64; 4]> = pieces.iter().map(|p| p.map(f64::to_bits)).collect();
    assert_eq!(unique.len(), pieces.len(), "no piece is drawn twice");
    pieces
}

fn length(pieces: &[[f64; 4]]) -> f64 {
    pieces.iter().map(|[ax, ay, bx, by]| (ax - bx).hypot(ay - by)).sum()
}

fn sampled(text: &str, n: usize) -> Grid {
    let formula = Formula::parse(text, Variables::Plane).expect("a formula");
    Grid::sample(&formula, (-5.0, 5.0), (-5.0, 5.0), (n, n)).expect("a grid")
}

#[test]
fn curves_of_saddles_and_kinks_have_their_lengths() {
    for (text, level, expected) in [
        ("x*y", 0.0, 20.0),
        ("-x*y", 0.0, 20.0),
        ("x*y + 4", 4.0, 20.0),
        ("min(x, 0)", 0.0, 10.0),
        ("min(y, 0)", 0.0, 10.0),
        ("max(x, 0)", 0.0, 0.0),
        ("-abs(x)", 0.0, 10.0),
        ("x + y", 0.0, 200f64.sqrt()),
        ("x - y", 0.0, 200f64.sqrt()),
        ("x", 5.0, 10.0),
        ("x", -5.0, 0.0),
    ] {
        for n in [80, 81, 41] {
            if text == "-abs(x)" && n == 80 {
                // Without samples at x = 0 nothing is as high as 0.
                continue;
            }
            let found = length(&pieces(&sampled(text, n), &[level]));
            assert!((found - expected).abs() < 1e-9, "{text}, {n} samples: {found}");
        }
    }
    // The saddle is beside the middle of its cell, at a fraction that binary numbers have.
    let found = pieces(&sampled("(x - 0.03125) * (y + 0.09375)", 81), &[0.0]);
    let at_saddle = found.iter().filter(|p| p.chunks(2).any(|p| p == [0.03125, -0.09375]));
    assert_eq!(at_saddle.count(), 4);
    let found = length(&pieces(&sampled("x^2 - y^2", 81), &[0.0]));
    assert!((found - 2.0 * 200f64.sqrt()).abs() < 1e-9, "{found}");
}

#[test]
fn curves_of_functions_have_their_lengths_wherever_the_samples_are() {
    let (pi, root2) = (std::f64::consts::PI, 2f64.sqrt());
    for (text, level, expected, tolerance) in [
        ("x*y", 0.0, 20.0, 1e-9),
        ("x*y + 4", 4.0, 20.0, 1e-9),
        ("(x - 0.3)*(y + 1.7)", 0.0, 20.0, 1e-9),
        ("x^2 - y^2", 0.0, 20.0 * root2, 1e-9),
        ("abs(x) - abs(y)", 0.0, 20.0 * root2, 1e-9),
        ("(x - 0.3)^2 - (y + 0.7)^2", 0.0, 18.6 * root2, 1e-9),
        ("min(x, 0)", 0.0, 10.0, 1e-9),
        ("min(x - 0.3, 0)", 0.0, 10.0, 1e-9),
        ("floor(x)", 1.0, 10.0, 1e-9),
        // Circles are polygons.
        ("x^2 + y^2", 9.0, 6.0 * pi, 4e-3),
        ("min(r, 2)", 2.0, 4.0 * pi, 4e-3),
    ] {
        let formula = Formula::parse(text, Variables::Plane).expect("a formula");
        for n in [(40, 40), (41, 41), (37, 64), (64, 37)] {
            // A drawing scales heights.
            let factor = if n.0 < n.1 { 0.16 } else { 1.0 };
            let grid = Grid::sample(&formula, (-5.0, 5.0), (-5.0, 5.0), n);
            let mut grid = grid.expect("a grid");
            grid.scale_heights(factor);
            let function = HeightFunction::new(formula.clone(), factor);
            let found = length(&traced(&grid, Some(function), &[level * factor]));
            assert!((found - expected).abs() < tolerance, "{text}, {n:?}: {found}");
        }
    }
}

#[test]
fn curves_of_functions_run_through_points_of_them() {
    let levels: Vec<f64> = (-9..=9).map(|k| f64::from(k) / 10.0).collect();
    for text in ["sin(x)*cos(y)", "exp(-r^2/9)", "sin(3*x + y^2)", "min(sin(x), y/4)"] {
        let formula = Formula::parse(text, Variables::Plane).expect("a formula");
        let grid = Grid::sample(&formula, (-5.0, 4.0), (-3.0, 5.0), (33, 46)).expect("a grid");
        let found = traced(&grid, Some(HeightFunction::new(formula.clone(), 1.0)), &levels);
        assert!(found.len() > 300, "{text}: {}", found.len());
        for [ax, ay, bx, by] in found {
            for (x, y) in [(ax, ay), (bx, by)] {
                let z = formula.value(x, y);
                let off = levels.iter().map(|level| (level - z).abs()).fold(1.0, f64::min);
                assert!(off < 1e-11, "{text} at {x}, {y}: {z}");
            }
        }
    }
}

/// The area of a triangle in the plane, twice, with its sign.
fn area([a, b, c]: [DVec3; 3]) -> f64 {
    (b - a).truncate().perp_dot((c - a).truncate())
}

#[test]
fn curves_of_functions_have_no_loose_ends_and_no_triangle_is_turned_over() {
    for text in
        ["(x-0.3)^2 - (y+0.7)^2", "sin(x)*cos(y)", "sin(x*y)", "min(x, sin(y))", "x^3-3*x*y^2"]
    {
        let formula = Formula::parse(text, Variables::Plane).expect("a formula");
        for n in [21, 40] {
            let grid = Grid::sample(&formula, (-5.0, 5.0), (-5.0, 5.0), (n, n));
            let mut grid = grid.expect("a grid");
            grid.scale_heights(0.1);
            let (low, high) = grid.heights().expect("heights");
            let level = |k: i32| low + (high - low) * f64::from(k) / 16.0;
            let levels: Vec<f64> = (1..16).map(level).collect();
            let function = HeightFunction::new(formula.clone(), 0.1);
            let mut mesh = LinedMesh::for_levels(&levels);
            mesh.begin_sheet(Some(function.clone()));
            mesh.push_grid(&grid, &NO_LINES);
            mesh.add_levels(&levels);
            let mesh = mesh.into_mesh().expect("a mesh");
            for corners in (0..mesh.n_faces()).map(|face| mesh.face(face as u32)) {
                let corners = [corners[0], corners[1], corners[2]];
                let corners = corners.map(|v| mesh.positions()[v as usize]);
                assert!(area(corners) > 0.0, "{text}, {n}: {corners:?}");
            }
            let mut n_ends: BTreeMap<[u64; 2], usize> = BTreeMap::new();
            for [ax, ay, bx, by] in traced(&grid, Some(function), &levels) {
                for end in [[ax, ay], [bx, by]] {
                    *n_ends.entry(end.map(|c| (c + 0.0).to_bits())).or_default() += 1;
                }
            }
            for (end, n) in n_ends {
                let [x, y] = end.map(f64::from_bits);
                let is_inside = x.abs() < 5.0 && y.abs() < 5.0;
                assert!(!is_inside || n % 2 == 0, "{text}, {n}: an end at {x}, {y}");
            }
        }
    }
}

#[test]
fn a_circle_through_samples_and_one_that_is_the_edge_of_a_plateau_are_round() {
    for (text, radius) in [("x^2 + y^2", 5.0), ("min(hypot(x, y), 5)", 5.0)] {
        let formula = Formula::parse(text, Variables::Plane).expect("a formula");
        // (3, 4) and (5, 0) are samples.
        let grid = Grid::sample(&formula, (-7.0, 7.0), (-7.0, 7.0), (29, 29)).expect("a grid");
        let level = formula.value(5.0, 0.0);
        let found = traced(&grid, Some(HeightFunction::new(formula, 1.0)), &[level]);
        for [ax, ay, bx, by] in &found {
            assert!((ax.hypot(*ay) - radius).abs() < 1e-9, "{text}: {ax}, {ay}");
            assert!((bx.hypot(*by) - radius).abs() < 1e-9, "{text}: {bx}, {by}");
        }
        let around = 2.0 * std::f64::consts::PI * radius;
        assert!((length(&found) - around).abs() < 0.05, "{text}: {}", length(&found));
    }
}

#[test]
fn a_level_through_a_vertex_is_drawn_through_it() {
    // Of the plane z = x − 2y every second curve runs through corners of cells, between them.
    let found = pieces(&sampled("x - 2*y", 11), &[0.0]);
    assert!((length(&found) - 125f64.sqrt()).abs() < 1e-12, "{found:?}");
    let through_origin =
        |[ax, ay, bx, by]: &&[f64; 4]| (*ax, *ay) == (0.0, 0.0) || (*bx, *by) == (0.0, 0.0);
    assert_eq!(found.iter().filter(through_origin).count(), 2);
    for [ax, ay, bx, by] in found {
        assert!((ax - 2.0 * ay).abs() < 1e-12 && (bx - 2.0 * by).abs() < 1e-12);
    }
}

#[test]
fn a_plateau_is_outlined_once_on_its_lower_side() {
    let read =
        |text: &str| read_heights(text.as_bytes(), &HeightOptions::default()).expect("a grid").grid;
    // A mesa of height 1 whose top has 3 × 2 samples, and a basin of the same size.
    let mesa = read("0 0 0 0 0\n0 1 1 1 0\n0 1 1 1 0\n0 0 0 0 0\n");
    assert_eq!(length(&pieces(&mesa, &[1.0])), 6.0);
    // The outline of z ≥ 0 is the border of the grid, which is no curve.
    assert_eq!(length(&pieces(&mesa, &[0.0])), 0.0);
    let basin = read("1 1 1 1 1\n1 0 0 0 1\n1 0 0 0 1\n1 1 1 1 1\n");
    assert_eq!(length(&pieces(&basin, &[1.0])), 14.0);
    assert_eq!(length(&pieces(&basin, &[0.0])), 0.0);
    // A single peak or pit at the level is a point.
    assert_eq!(length(&pieces(&read("0 0 0\n0 1 0\n0 0 0\n"), &[1.0])), 0.0);
    assert_eq!(length(&pieces(&read("1 1 1\n1 0 1\n1 1 1\n"), &[0.0])), 0.0);
}

#[test]
fn every_k_th_line_and_the_last_one_are_drawn() {
    let grid =
        Grid::new((0..6).map(f64::from).collect(), (0..5).map(f64::from).collect(), vec![0.0; 30]);
    let grid = grid.expect("a grid");
    for (every, columns, rows) in [
        (1, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0][..], &[0.0, 1.0, 2.0, 3.0, 4.0][..]),
        (2, &[0.0, 2.0, 4.0, 5.0], &[0.0, 2.0, 4.0]),
        (3, &[0.0, 3.0, 5.0], &[0.0, 3.0, 4.0]),
        (9, &[0.0, 5.0], &[0.0, 4.0]),
    ] {
        let drawn = |along_rows: bool| -> Vec<f64> {
            let lines = LatticeLines { along_rows, along_columns: !along_rows, every, ..NO_LINES };
            let mut mesh = LinedMesh::default();
            mesh.push_grid(&grid, &lines);
            let scene = mesh.into_scene().expect("a scene");
            let at = |edge: u32| {
                let [a, _] = scene.scene.topology().edge(edge);
                let p = scene.scene.mesh().positions()[a as usize];
                if along_rows { p.y } else { p.x }
            };
            let mut places: Vec<f64> = scene.lines.iter().map(|line| at(line.edge)).collect();
            places.sort_by(f64::total_cmp);
            places.dedup();
            places
        };
        assert_eq!((&drawn(false)[..], &drawn(true)[..]), (columns, rows), "every {every}");
    }
}

#[test]
fn the_last_line_of_every_k_reaches_the_rim_of_a_domain() {
    let formula = |text: &str| Formula::parse(text, Variables::Plane).expect("a formula");
    // Rows and columns are cut at 0.25 beyond a sample.
    for (domain, along_rows, expected) in
        [("x <= 2.25", true, [0.0, 3.0, 4.0]), ("y <= 2.25", false, [0.0, 3.0, 5.0])]
    {
        let grid = TrimmedGrid::sample(
            &formula("0"),
            Some(&formula(domain)),
            (0.0, 5.0),
            (0.0, 4.0),
            (6, 5),
        );
        let lines = LatticeLines { along_rows, along_columns: !along_rows, every: 3, ..NO_LINES };
        let mut mesh = LinedMesh::default();
        mesh.push_trimmed(&grid.expect("a grid"), &lines);
        let scene = mesh.into_scene().expect("a scene");
        let mut places: Vec<f64> = Vec::new();
        for line in scene.lines.iter().filter(|line| line.kind == StrokeKind::Grid) {
            let ends = scene.scene.topology().edge(line.edge);
            let ends = ends.map(|v| scene.scene.mesh().positions()[v as usize]);
            let (along, across) = if along_rows { (0, 1) } else { (1, 0) };
            if ends.iter().any(|p| (p[along] - 2.25).abs() < 1e-9) {
                places.push(ends[0][across]);
            }
        }
        places.sort_by(f64::total_cmp);
        assert_eq!(places, expected, "{domain}");
    }
}

#[test]
fn a_rim_through_samples_lies_on_them() {
    let formula = |text: &str| Formula::parse(text, Variables::Plane).expect("a formula");
    let (zero, domain) = (formula("0"), formula("x <= 2"));
    let size = (6, 5);
    let grid = TrimmedGrid::sample(&zero, Some(&domain), (0.0, 5.0), (0.0, 4.0), size);
    let grid = grid.expect("a grid");
    assert!(grid.rim().count() >= 5 && grid.rim().all(|p| p.x == 2.0));
}

#[test]
fn curves_end_at_borders_and_where_others_begin_and_nowhere_else() {
    let curves = |text: &str, levels: &[f64]| {
        let mut mesh = LinedMesh::for_levels(levels);
        mesh.push_grid(&sampled(text, 21), &NO_LINES);
        mesh.add_levels(levels);
        mesh.level_curves()
    };
    let is_on_border = |p: &DVec3| p.x.abs().max(p.y.abs()) == 5.0;
    // Straight lines that turn by turn begin at any of the sides.
    for text in ["x - y/3", "y/3 - x", "y - x/3", "-y - x/3"] {
        let found = curves(text, &[-1.0, 0.0, 1.5]);
        assert_eq!(found.len(), 3, "{text}");
        for curve in found {
            let ends = [&curve.points[0], &curve.points[curve.points.len() - 1]];
            assert!(ends.into_iter().all(is_on_border) && ends[0] != ends[1], "{text}");
        }
    }
    for curve in curves("r^2", &[4.0, 9.0]) {
        assert_eq!(curve.points[0], curve.points[curve.points.len() - 1]);
        assert!(curve.points.len() > 20);
    }
    assert_eq!(curves("r^2", &[4.0, 9.0]).len(), 2);
    // Four arms meet in a saddle.
    let arms = curves("x*y", &[0.0]);
    assert_eq!(arms.len(), 4);
    for arm in arms {
        let ends = [arm.points[0], arm.points[arm.points.len() - 1]];
        let is_saddle = |p: &DVec3| *p == DVec3::ZERO;
        assert!(ends.iter().any(is_saddle) && ends.iter().any(is_on_border), "{ends:?}");
        assert!(!arm.points[1..arm.points.len() - 1].iter().any(is_saddle));
    }
}

#[test]
fn sheets_share_a_rim_only_if_all_of_it_is_shared() {
    let sheet = |text: &str| {
        let formula = Formula::parse(text, Variables::Plane).expect("a formula");
        let grid = TrimmedGrid::sample(&formula, None, (-5.0, 5.0), (-5.0, 5.0), (31, 31));
        grid.expect("a sheet")
    };
    let [upper, lower] = ["sqrt(9 - r^2)", "-sqrt(9 - r^2)"].map(sheet);
    let with_hole = sheet("r < 1 ? nan : -sqrt(9 - r^2)");
    assert!(upper.shares_rim(&lower, 0.1) && lower.shares_rim(&upper, 0.1));
    assert!(!upper.shares_rim(&with_hole, 0.1) && !with_hole.shares_rim(&upper, 0.1));
    assert!(!upper.shares_rim(&sheet("1 - sqrt(9 - r^2)"), 0.1));
}
