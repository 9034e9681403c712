//! Hatching from the command line.

use std::path::Path;

use super::{CUBE, assert_fails, hiddenline, text};
use crate::models::SPOT;

fn run(folder: &Path, arguments: &[&str]) -> std::process::Output {
    std::fs::write(folder.join("cube.obj"), CUBE).unwrap();
    hiddenline(folder, arguments)
}

/// The end of an SVG path's attribute `d`, taken apart into its strokes' lengths in millimeters.
fn lengths(svg: &str, layer: &str) -> Vec<f64> {
    let document = roxmltree::Document::parse(svg).unwrap();
    let groups = document.root_element().children().filter(|node| node.has_tag_name("g"));
    let label = ("http://www.inkscape.org/namespaces/inkscape", "label");
    let group = groups.into_iter().find(|group| group.attribute(label) == Some(layer)).unwrap();
    let paths = group.descendants().filter_map(|node| node.attribute("d"));
    paths
        .map(|d| {
            let numbers: Vec<f64> = d
                .split(|c: char| c.is_ascii_alphabetic() || c == ',' || c == ' ')
                .filter_map(|number| number.parse().ok())
                .collect();
            let points: Vec<&[f64]> = numbers.chunks(2).collect();
            points.windows(2).map(|p| (p[0][0] - p[1][0]).hypot(p[0][1] - p[1][1])).sum()
        })
        .collect()
}

#[test]
fn a_hatched_cow_is_a_few_hundred_long_strokes_on_a_layer_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let light = "--light=-2,1,3";
    let arguments = [
        "draw",
        SPOT,
        "--up-axis",
        "y",
        "--azimuth",
        "215",
        "--hatch",
        "--ground",
        light,
        "--stats",
    ];
    let output = run(folder.path(), &arguments);
    let stderr = text(&output.stderr);
    assert!(output.status.success(), "{stderr}");
    let strokes = lengths(&text(&output.stdout), "2 hatch");
    assert!((100..=800).contains(&strokes.len()), "{} strokes", strokes.len());
    let shortest = strokes.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(shortest > 0.99, "{shortest} mm");
    let down: f64 = strokes.iter().sum();
    assert!(down > 5_000.0, "{down} mm");
    let stats: serde_json::Value = serde_json::from_str(stderr.lines().last().unwrap()).unwrap();
    let of = |name: &str| stats["plot"]["after"][name].as_f64().unwrap();
    assert!(of("up_m") < of("down_m") / 4.0, "{stats}");
}

#[test]
fn exact_json_has_every_line_with_whether_it_is_lit() {
    let folder = tempfile::tempdir().unwrap();
    let arguments =
        ["draw", "cube.obj", "--hatch", "--exact", "--format", "json", "--light=-1,-2,3"];
    let output = run(folder.path(), &arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let drawing: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let strokes = drawing["strokes"].as_array().unwrap();
    let hatch: Vec<_> = strokes.iter().filter(|stroke| stroke["kind"] == "hatch").collect();
    assert!(hatch.len() > 1000);
    assert!(hatch.iter().all(|stroke| stroke["points"].as_array().unwrap().len() == 2));
    for is_lit in [true, false] {
        assert!(hatch.iter().any(|stroke| stroke["lit"] == is_lit), "{is_lit}");
    }
    assert!(strokes.iter().filter(|s| s["kind"] != "hatch").all(|s| s.get("lit").is_none()));
}

#[test]
fn mistakes_are_reported_with_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |more: &[&str]| run(folder.path(), &[&["draw", "cube.obj"], more].concat());
    assert_fails(
        &draw(&["--hatch", "--light-at", "0,0,0.5"]),
        1,
        "use --light-at with a point outside",
    );
    let low = draw(&["--hatch", "--ground", "--light", "1,1,0"]);
    assert_fails(&low, 1, "use a --light with a positive z");
    assert_fails(&draw(&["--hatch", "--hatch-levels", "7"]), 2, "a number of levels from 2 to 6");
    assert_fails(&draw(&["--hatch", "--hatch-black", "1.5"]), 2, "must be at most 1");
    assert_fails(&draw(&["--hatch", "--hatch-material", "brick"]), 2, "such as brick=30:0.4");
    assert_fails(
        &draw(&["--hatch", "--light", "1,0,0", "--light-at", "9,9,9"]),
        2,
        "cannot be used",
    );
    let without = draw(&["--ground", "--hatch-cross"]);
    let stderr = text(&without.stderr);
    assert!(stderr.contains("--ground has no effect without --hatch"), "{stderr}");
    assert!(stderr.contains("--hatch-cross has no effect without --hatch"), "{stderr}");
}

#[test]
fn hatching_has_the_pen_that_it_is_given() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |more: &[&str]| {
        let output =
            run(folder.path(), &[&["draw", "cube.obj", "--hatch", "straight"], more].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    let usual: f64 = lengths(&draw(&[]), "2 hatch").iter().sum();
    let thin: f64 = lengths(&draw(&["--pen", "hatch=5:0.15mm:blue"]), "5 hatch").iter().sum();
    // Half as wide a pen takes twice as many lines.
    assert!((thin / usual - 2.0).abs() < 0.2, "{thin} {usual}");
}

#[test]
fn outlines_of_shadows_are_a_kind_of_line() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = [
        "draw",
        "cube.obj",
        "--view",
        "top",
        "--drawing-scale",
        "10:1",
        "--lines",
        "boundary,shadow",
        "--ground",
        "--light=-1,-1,1",
        "--pen",
        "shadow=3",
    ];
    let output = run(folder.path(), &arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(lengths(&text(&output.stdout), "3 shadow").len(), 1);
}

#[test]
fn surfaces_and_fills_are_hatched_too() {
    let folder = tempfile::tempdir().unwrap();
    let surface = ["surface", "x*y", "--lines", "border", "--no-axes", "--hatch", "--light=1,1,1"];
    let output = run(folder.path(), &surface);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(lengths(&text(&output.stdout), "2 hatch").len() > 20);
    let fill = ["fill", "cube.obj", "--palette", "3", "--hatch", "--light=1,-1,1"];
    let output = run(folder.path(), &fill);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("hatch"));
}

#[test]
fn materials_have_their_own_angle_and_darkness() {
    let folder = tempfile::tempdir().unwrap();
    // Two squares beside each other, upright, with the light along them.
    let walls = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 2 0 0\nv 3 0 0\nv 3 0 1\nv 2 0 1\n\
                 usemtl brick\nf 1 2 3 4\nusemtl wood\nf 5 6 7 8\n";
    std::fs::write(folder.path().join("walls.obj"), walls).unwrap();
    let fixed = ["draw", "walls.obj", "--view", "front", "--light", "1,0,0", "--hatch", "straight"];
    let fixed = [&fixed[..], &["--hatch-levels", "continuous", "--format", "json"]].concat();
    // For the left and for the right wall the length of the lines, and whether all are level.
    let drawn = |more: &[&str]| {
        let output = hiddenline(folder.path(), &[&fixed[..], more].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let drawing: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let mut walls = [(0.0, true); 2];
        for stroke in drawing["strokes"].as_array().unwrap() {
            if stroke["kind"] == "hatch" {
                let points: Vec<[f64; 2]> =
                    serde_json::from_value(stroke["points"].clone()).unwrap();
                let wall = &mut walls[usize::from(points[0][0] > 0.0)];
                for pair in points.windows(2) {
                    let step = [0, 1].map(|k| pair[1][k] - pair[0][k]);
                    wall.0 += step[0].hypot(step[1]);
                    wall.1 &= step[1].abs() < 1e-9;
                }
            }
        }
        walls
    };
    let [left, right] = drawn(&[]);
    assert!(left.0 > 0.0 && !left.1 && !right.1);
    assert!((right.0 / left.0 - 1.0).abs() < 0.05, "{left:?} {right:?}");
    let [other, level] = drawn(&["--hatch-material", "wood=0:0.3"]);
    assert_eq!(other, left);
    // Half as dark.
    assert!(level.1 && (level.0 / left.0 - 0.5).abs() < 0.05, "{left:?} {level:?}");
}
