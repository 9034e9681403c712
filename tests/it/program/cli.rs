//! The program itself, one behavior a test.

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::Stdio;

use tempfile::TempDir;

use super::{CUBE, assert_fails, command, hiddenline, text};

/// A folder with `cube.obj` in it.
fn with_cube() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().to_owned();
    fs::write(path.join("cube.obj"), CUBE).expect("written");
    (folder, path)
}

/// Runs `draw cube.obj` with more arguments and reads the strokes that it writes.
fn strokes_of(arguments: &[&str]) -> serde_json::Value {
    let (_keep, folder) = with_cube();
    let all = [&["draw", "cube.obj", "--format", "json"], arguments].concat();
    let output = hiddenline(&folder, &all);
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

#[test]
fn a_drawing_goes_to_the_file_and_a_brief_line_to_stderr() {
    let (_keep, folder) = with_cube();
    let output = hiddenline(&folder, &["draw", "cube.obj", "-o", "cube.svg"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stdout.is_empty());
    let stderr = text(&output.stderr);
    assert!(stderr.contains("cube.svg  A4 "), "{stderr}");
    let svg = fs::read_to_string(folder.join("cube.svg")).expect("written");
    let document = roxmltree::Document::parse(&svg).expect("valid XML");
    assert!(document.descendants().any(|node| node.tag_name().name() == "path"));
    assert!(svg.contains("<dc:source>hiddenline draw cube.obj</dc:source>"), "{svg}");
}

#[test]
fn dash_is_standard_output() {
    let (_keep, folder) = with_cube();
    let dash = hiddenline(&folder, &["draw", "cube.obj", "-o", "-"]);
    let nothing = hiddenline(&folder, &["draw", "cube.obj"]);
    assert!(text(&dash.stdout).starts_with("<svg "));
    assert_eq!(dash.stdout, nothing.stdout);
}

#[test]
fn dash_is_standard_input() {
    let (_keep, folder) = with_cube();
    let mut child = command(&folder, &["draw", "-", "--input-format", "obj"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    child.stdin.take().expect("piped").write_all(CUBE.as_bytes()).expect("read");
    let output = child.wait_with_output().expect("ends");
    assert!(output.status.success());
    assert!(text(&output.stdout).contains("<title>standard input</title>"));
}

#[test]
fn the_extension_gives_the_format() {
    let (_keep, folder) = with_cube();
    for (name, start) in
        [("a.svg", &b"<svg"[..]), ("a.PNG", b"\x89PNG"), ("a.json", b"{\"format\"")]
    {
        let output = hiddenline(&folder, &["draw", "cube.obj", "-o", name]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let bytes = fs::read(folder.join(name)).expect("written");
        assert!(bytes.starts_with(start), "{name}");
    }
}

#[test]
fn an_unknown_extension_is_bad_usage() {
    let (_keep, folder) = with_cube();
    let output = hiddenline(&folder, &["draw", "cube.obj", "-o", "cube.xyz"]);
    assert_fails(&output, 2, "use --format");
}

#[test]
fn an_unknown_option_is_bad_usage() {
    let (_keep, folder) = with_cube();
    assert_fails(&hiddenline(&folder, &["draw", "cube.obj", "--sideways"]), 2, "--sideways");
}

#[test]
fn a_missing_model_is_named() {
    let (_keep, folder) = with_cube();
    assert_fails(&hiddenline(&folder, &["draw", "cub.obj"]), 1, "cub.obj");
}

#[test]
fn a_broken_model_leaves_the_old_drawing_as_it_was() {
    let (_keep, folder) = with_cube();
    fs::write(folder.join("bad.obj"), "v 0 0 0\nf 1 2 9\n").expect("written");
    fs::write(folder.join("old.svg"), "old").expect("written");
    let output = hiddenline(&folder, &["draw", "bad.obj", "-o", "old.svg"]);
    assert_fails(&output, 1, "bad.obj:2");
    assert_eq!(fs::read_to_string(folder.join("old.svg")).expect("there"), "old");
    assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 3);
}

#[test]
fn a_failure_while_writing_leaves_nothing_behind() {
    let (_keep, folder) = with_cube();
    let output = hiddenline(&folder, &["draw", "cube.obj", "-o", "cube.png", "--dpi", "1000000"]);
    assert_fails(&output, 1, "--dpi");
    assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 1);
}

#[test]
fn a_missing_folder_is_an_error_that_names_the_file() {
    let (_keep, folder) = with_cube();
    let output = hiddenline(&folder, &["draw", "cube.obj", "-o", "nowhere/cube.svg"]);
    assert_fails(&output, 1, "cannot write nowhere/cube.svg");
}

#[test]
fn negative_eyes_can_be_written_both_ways() {
    let joined = strokes_of(&["--eye=-3,2,1"]);
    let apart = strokes_of(&["--eye", "-3,2,1"]);
    assert_eq!(joined, apart);
    assert_eq!(joined["camera"]["eye"], serde_json::json!([-3.0, 2.0, 1.0]));
    assert_eq!(joined["camera"]["target"], serde_json::json!([0.0, 0.0, 0.0]));
}

#[test]
fn a_drawing_can_take_the_camera_of_another() {
    let (_keep, folder) = with_cube();
    let first = ["draw", "cube.obj", "--eye", "3,2,1", "--fov", "50", "-o", "first.json"];
    assert!(hiddenline(&folder, &first).status.success());
    let second = ["draw", "cube.obj", "--camera", "first.json", "-o", "second.json"];
    assert!(hiddenline(&folder, &second).status.success());
    let read = |name| fs::read_to_string(folder.join(name)).expect("written");
    assert_eq!(read("first.json"), read("second.json"));
}

#[test]
fn a_camera_from_a_file_goes_with_no_other_camera() {
    let (_keep, folder) = with_cube();
    let output = hiddenline(&folder, &["draw", "cube.obj", "--camera", "x", "--eye", "1,2,3"]);
    assert_fails(&output, 2, "cannot be used with");
}

#[test]
fn named_views_are_orthographic_unless_asked() {
    assert_eq!(strokes_of(&["--view", "top"])["camera"]["projection"], "orthographic");
    let asked = strokes_of(&["--view", "top", "--projection", "perspective"]);
    assert_eq!(asked["camera"]["projection"], "perspective");
    assert_eq!(asked["camera"]["up"], serde_json::json!([0.0, 1.0, 0.0]));
}

#[test]
fn up_along_the_view_is_an_error_when_given() {
    let (_keep, folder) = with_cube();
    let output = hiddenline(&folder, &["draw", "cube.obj", "--eye", "0,0,5", "--up", "0,0,1"]);
    assert_fails(&output, 1, "--up");
}

#[test]
fn stats_are_the_last_line_with_all_keys() {
    let (_keep, folder) = with_cube();
    let arguments = ["draw", "cube.obj", "-o", "cube.svg", "--stats", "--threads", "1"];
    let stderr = text(&hiddenline(&folder, &arguments).stderr);
    let last = stderr.lines().last().expect("a line");
    let stats: serde_json::Value = serde_json::from_str(last).expect("JSON");
    assert_eq!((&stats["threads"], &stats["vertices"]), (&1.into(), &8.into()));
    assert_eq!((&stats["faces"], &stats["edges"]), (&6.into(), &12.into()));
    for key in ["engine", "triangles", "drawn_edges", "strokes", "points", "peak_bytes"] {
        assert!(stats.get(key).is_some(), "{key}");
    }
    for key in [
        "read",
        "topology",
        "classify",
        "visibility",
        "strokes",
        "drafting",
        "order",
        "write",
        "total",
    ] {
        assert!(stats["seconds"][key].is_number(), "{key}");
    }
    for key in ["candidate_pairs", "exact_predicates", "contour_crossings", "fallback_edges"] {
        assert!(stats["counts"][key].is_number(), "{key}");
    }
}

#[test]
fn quiet_prints_nothing() {
    let (_keep, folder) = with_cube();
    let output = hiddenline(&folder, &["draw", "cube.obj", "-o", "cube.svg", "--quiet"]);
    assert!(output.status.success());
    assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
}

#[test]
fn any_number_of_threads_writes_the_same_bytes() {
    let (_keep, folder) = with_cube();
    let drawn = |threads| {
        let arguments = ["draw", "cube.obj", "--lines", "all", "--threads", threads];
        hiddenline(&folder, &arguments).stdout
    };
    let one = drawn("1");
    assert!(one.starts_with(b"<svg "));
    assert_eq!(one, drawn("2"));
}

#[test]
fn a_model_that_is_not_in_view_gives_an_empty_drawing_and_a_warning() {
    let (_keep, folder) = with_cube();
    let output = hiddenline(&folder, &["draw", "cube.obj", "--eye", "9,0,0", "--target", "20,0,0"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stderr).contains("the drawing is empty"));
    let svg = text(&output.stdout);
    roxmltree::Document::parse(&svg).expect("valid XML");
    assert!(!svg.contains("<path"));
}

#[test]
fn models_are_drawn_together() {
    let (_keep, folder) = with_cube();
    fs::write(folder.join("more.obj"), CUBE.replace("v -1", "v 2").replace("v 1", "v 3"))
        .expect("written");
    let arguments = ["draw", "cube.obj", "more.obj", "--stats"];
    let stderr = text(&hiddenline(&folder, &arguments).stderr);
    assert!(stderr.contains("\"faces\":12"), "{stderr}");
}

#[test]
fn nothing_is_drawn_outside_the_margins() {
    let (_keep, folder) = with_cube();
    let arguments = [
        "draw",
        "cube.obj",
        "--drawing-scale",
        "200:1",
        "--page",
        "100x80",
        "--svg-element",
        "polyline",
    ];
    let output = hiddenline(&folder, &arguments);
    assert!(text(&output.stderr).contains("cut off at the margins"));
    let svg = text(&output.stdout);
    let document = roxmltree::Document::parse(&svg).expect("valid XML");
    let points = document.descendants().filter_map(|node| node.attribute("points"));
    for pair in points.flat_map(str::split_whitespace) {
        let (x, y) = pair.split_once(',').expect("a pair");
        let (x, y): (f64, f64) = (x.parse().expect("x"), y.parse().expect("y"));
        assert!((10.0..=90.0).contains(&x) && (10.0..=70.0).contains(&y), "{pair}");
    }
}

#[test]
fn margins_wider_than_the_page_are_an_error() {
    let (_keep, folder) = with_cube();
    let output = hiddenline(&folder, &["draw", "cube.obj", "--margin", "12cm"]);
    assert_fails(&output, 1, "--margin");
}

#[test]
fn an_unknown_kind_of_line_is_bad_usage() {
    let (_keep, folder) = with_cube();
    let output = hiddenline(&folder, &["draw", "cube.obj", "--lines", "crease,ridge"]);
    assert_fails(&output, 2, "unknown line kind `ridge`");
}

#[test]
fn help_has_examples_and_completions_and_manual_are_printed() {
    let (_keep, folder) = with_cube();
    let help = hiddenline(&folder, &["draw", "--help"]);
    assert!(text(&help.stdout).contains("Examples:"));
    let completions = hiddenline(&folder, &["completions", "bash"]);
    assert!(text(&completions.stdout).contains("_hiddenline"));
    let manual = hiddenline(&folder, &["man", "draw"]);
    assert!(text(&manual.stdout).contains(".TH"));
}

#[test]
fn completions_know_machines_presets_and_pens() {
    let (_keep, folder) = with_cube();
    let settings = "[preset.thin-lines]\npen-width = 0.1\n[machine.attic]\nlike = 'hp7550'\n";
    std::fs::write(folder.join("hiddenline.toml"), settings).unwrap();
    // Scripts for elvish and PowerShell complete options, but no values.
    for shell in ["bash", "zsh", "fish"] {
        let script = text(&hiddenline(&folder, &["completions", shell]).stdout);
        for name in ["hp7475a", "grbl-servo", "saxi", "attic", "thin-lines", "silhouette="] {
            assert!(script.contains(name), "{shell} {name}");
        }
    }
    // Other values than the known ones stay possible.
    let run = hiddenline(&folder, &["draw", "cube.obj", "--pen", "visible=7:1mm", "-o", "x.svg"]);
    assert!(run.status.success(), "{}", text(&run.stderr));
}

#[test]
fn names_are_listed_in_the_help_and_suggested_for_others() {
    let (_keep, folder) = with_cube();
    let help = text(&hiddenline(&folder, &["draw", "-h"]).stdout);
    for names in ["perspective, orthographic", "svg, hpgl, gcode", "path, polyline", "front, right"]
    {
        assert!(help.contains(names), "{names}");
    }
    let help = text(&hiddenline(&folder, &["draw", "--help"]).stdout);
    for described in ["- orthographic: Lines of sight are parallel", "- dashed:", "- appel:"] {
        assert!(help.contains(described), "{described}");
    }
    for (option, typed, meant) in [
        ("--view", "isometrc", "isometric"),
        ("--projection", "perspectiv", "perspective"),
        ("--format", "gcod", "gcode"),
        ("--svg-element", "poliline", "polyline"),
    ] {
        let output = hiddenline(&folder, &["draw", "cube.obj", option, typed]);
        assert_fails(&output, 2, &format!("'{meant}'"));
    }
}

#[test]
fn the_margin_is_10_mm_but_none_for_finished_drawings() {
    let (_keep, folder) = with_cube();
    let json = |more: &[&str]| {
        let command = [&["draw", "cube.obj", "--format", "json", "-o", "-", "-q"], more].concat();
        text(&hiddenline(&folder, &command).stdout)
    };
    assert_eq!(json(&[]), json(&["--margin", "10"]));
    assert_ne!(json(&[]), json(&["--margin", "5"]));
    hiddenline(&folder, &["draw", "cube.obj", "-o", "cube.svg", "-q"]);
    let dxf = |more: &[&str]| {
        let options = ["--fit", "--format", "dxf", "-o", "-", "-q"];
        let command = [&["optimize", "cube.svg"], &options[..], more].concat();
        text(&hiddenline(&folder, &command).stdout)
    };
    assert_eq!(dxf(&[]), dxf(&["--margin", "0"]));
    assert_ne!(dxf(&[]), dxf(&["--margin", "5"]));
}
