//! Drawings without strokes say why, and so do models that no camera can show.

use super::{CUBE, assert_fails, hiddenline, text};

/// What `draw` says about a cube with sides of `size` units.
fn told(size: f64, arguments: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let half = format!("{:e}", size / 2.0);
    let scaled = |line: &str| match line.strip_prefix("v ") {
        Some(point) => format!("v {}\n", point.replace('1', &half)),
        None => format!("{line}\n"),
    };
    let cube: String = CUBE.lines().map(scaled).collect();
    std::fs::write(folder.path().join("cube.obj"), cube).unwrap();
    let output =
        hiddenline(folder.path(), &[&["draw", "cube.obj", "-o", "out.svg"], arguments].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stderr)
}

#[test]
fn a_drawing_that_is_too_small_is_not_said_to_be_out_of_view() {
    let small = told(0.05, &["--drawing-scale", "1:1"]);
    assert!(small.contains("every stroke is shorter than --shortest-stroke 0.25 mm"), "{small}");
    assert!(small.contains("--unit") && !small.contains("in view"), "{small}");
    let in_meters = told(0.05, &["--drawing-scale", "1:1", "--unit", "m"]);
    assert!(!in_meters.contains("empty"), "{in_meters}");
    let with_all = told(0.05, &["--drawing-scale", "1:1", "--shortest-stroke", "0"]);
    assert!(!with_all.contains("empty"), "{with_all}");
}

#[test]
fn an_empty_drawing_says_why() {
    let away = told(2.0, &["--eye", "0,-9,0", "--target", "0,-20,0"]);
    assert!(away.contains("the drawing is empty: nothing is in view"), "{away}");
    let no_boundary = told(2.0, &["--lines", "boundary"]);
    assert!(
        no_boundary.contains("no lines of the kinds selected; use other --lines"),
        "{no_boundary}"
    );
}

#[test]
fn coordinates_near_the_end_of_double_precision_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let obj = "v -1e308 0 0\nv 1e308 0 0\nv 0 1e308 1\nf 1 2 3\n";
    std::fs::write(folder.path().join("huge.obj"), obj).unwrap();
    let draw = |arguments: &[&str]| {
        hiddenline(folder.path(), &[&["draw", "huge.obj"], arguments].concat())
    };
    assert_fails(&draw(&[]), 1, "coordinates of 1e308 are too large");
    let up = draw(&["--eye", "0,0,9", "--target", "0,0,0", "--up", "0,0,1"]);
    assert_fails(&up, 1, "the up direction is parallel to the direction of view; use another --up");
    let same = draw(&["--eye", "1,2,3", "--target", "1,2,3"]);
    assert_fails(&same, 1, "eye and target are the same point; use another --eye or --target");
    let apart = draw(&["--eye", "-1e308,0,0", "--target", "1e308,0,0"]);
    assert_fails(&apart, 1, "eye and target are too far apart");
}

/// What the program says about a run that succeeds.
fn said(folder: &std::path::Path, arguments: &[&str]) -> String {
    let output = hiddenline(folder, arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stderr)
}

#[test]
fn an_empty_drawing_of_a_surface_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let surface = |more: &[&str]| {
        said(folder.path(), &[&["surface", "x+y", "--no-axes", "-o", "out.svg"], more].concat())
    };
    let folds = surface(&["--lines", "silhouette"]);
    assert!(folds.contains("every line of the kinds selected is hidden or shorter"), "{folds}");
    let away = surface(&["--eye", "0,0,20", "--target", "0,0,40"]);
    assert!(away.contains("the drawing is empty: nothing is in view"), "{away}");
}

#[test]
fn an_empty_drawing_from_an_svg_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let optimize = |path: &str, more: &[&str]| {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='100mm' \
             viewBox='0 0 100 100'><path fill='none' stroke='black' d='{path}'/></svg>"
        );
        std::fs::write(folder.path().join("in.svg"), svg).unwrap();
        said(folder.path(), &[&["optimize", "in.svg", "-o", "out.svg"], more].concat())
    };
    let nothing = optimize("", &[]);
    assert!(nothing.contains("the drawing is empty: the SVG has no visible strokes"), "{nothing}");
    let outside = optimize("M 200 200 L 300 300", &[]);
    assert!(outside.contains("the drawing is empty: every stroke lies outside"), "{outside}");
    let short = optimize("M 10 10 L 11 10", &["--shortest-stroke", "5"]);
    assert!(short.contains("every stroke is shorter than --shortest-stroke 5 mm"), "{short}");
}
