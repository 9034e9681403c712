//! `hiddenline preview` as a program.

use std::process::Output;

use super::{CUBE, assert_fails, hiddenline, text};
use crate::models::SPOT;

fn preview(arguments: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    hiddenline(folder.path(), &[&["preview"], arguments].concat())
}

/// Columns, rows, channels and bytes.
fn picture(bytes: &[u8]) -> (u32, u32, usize, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    (info.width, info.height, info.color_type.samples(), pixels)
}

fn of_spot(more: &[&str]) -> (u32, u32, usize, Vec<u8>) {
    let mut arguments = vec![SPOT, "--up-axis", "y", "--quiet"];
    arguments.extend(["--size", "90x70", "-o", "-"]);
    arguments.extend(more);
    let output = preview(&arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(output.stderr.is_empty());
    picture(&output.stdout)
}

#[test]
fn engines_write_the_same_picture() {
    let first = of_spot(&["--show", "faces"]);
    assert_eq!((first.0, first.1, first.2), (90, 70, 3));
    for engine in ["scan-line", "spanning", "watkins", "ray-cast"] {
        assert!(of_spot(&["--show", "faces", "--engine", engine]) == first, "{engine}");
    }
    assert!(of_spot(&["--show", "faces", "--threads", "1"]) == first);
}

#[test]
fn a_tone_is_gray_and_white_around() {
    let (width, height, channels, bytes) = of_spot(&["--tone"]);
    assert_eq!((width, height, channels), (90, 70, 1));
    assert_eq!(bytes[0], 255);
    let darkest = bytes.iter().min().unwrap();
    assert!((60..120).contains(darkest), "{darkest}");
}

#[test]
fn edges_darken_the_picture_and_nothing_else() {
    let plain = of_spot(&[]).3;
    let edged = of_spot(&["--edges"]).3;
    let darker = plain.iter().zip(&edged).filter(|(a, b)| b < a).count();
    assert!(plain.iter().zip(&edged).all(|(a, b)| b <= a));
    assert!(darker > 500 && darker < plain.len() / 2, "{darker} of {}", plain.len());
}

#[test]
fn glass_shows_what_is_behind() {
    let opaque = of_spot(&["--engine", "a-buffer"]).3;
    let glass = of_spot(&["--engine", "a-buffer", "--opacity", "0.3"]).3;
    assert_ne!(opaque, glass);
    assert_eq!(of_spot(&["--engine", "a-buffer", "--opacity", "1"]).3, opaque);
}

#[test]
fn a_background_goes_around() {
    let bytes = of_spot(&["--background", "#102030", "--show", "normals"]).3;
    assert_eq!(bytes[..3], [0x10, 0x20, 0x30]);
}

#[test]
fn a_formula_has_a_picture() {
    let output = preview(&["--expr", "sin(r)", "--size", "40x30", "--stats", "-o", "-"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let (width, height, _, bytes) = picture(&output.stdout);
    assert_eq!((width, height), (40, 30));
    assert!(bytes.chunks(3).filter(|color| *color != [255; 3]).count() > 200);
    let text = String::from_utf8(output.stderr).unwrap();
    let stats: serde_json::Value = serde_json::from_str(text.lines().last().unwrap()).unwrap();
    assert_eq!((&stats["engine"], &stats["triangles"]), (&"z-buffer".into(), &79202.into()));
}

/// The picture of a surface, and its counts.
fn of_surface(more: &[&str]) -> (Vec<u8>, serde_json::Value) {
    let output = preview(&[&["--size", "60x50", "--stats", "-o", "-"], more].concat());
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{more:?}: {text}");
    (picture(&output.stdout).3, serde_json::from_str(text.lines().last().unwrap()).unwrap())
}

#[test]
fn a_surface_has_one_picture_however_it_is_given() {
    let folder = tempfile::tempdir().unwrap();
    let row = |y: i32| (-2..=2).map(|x| (x * y).to_string()).collect::<Vec<_>>().join(" ");
    let rows = (-2..=2).map(row).collect::<Vec<_>>().join("\n");
    let at = |y: i32| (-2..=2).map(move |x| format!("{x} {y} {}\n", x * y));
    let points: String = (-2..=2).flat_map(at).collect();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let (grid, points) = (file("heights", &rows), file("points", &points));
    let ranges = ["--x=-2:2", "--y=-2:2"];
    let formula = [&["--expr", "x*y", "--samples", "5"][..], &ranges].concat();
    let (expected, stats) = of_surface(&formula);
    assert_eq!(stats["triangles"], 32);
    assert!(expected.chunks(3).filter(|color| *color != [255; 3]).count() > 300);
    assert!(of_surface(&[&["--grid", &grid][..], &ranges].concat()).0 == expected);
    let formulas = ["--parametric", "u", "v", "u*v", "--u=-2:2", "--v=-2:2"];
    let parametric = [&formulas[..], &["--samples", "5", "--aspect", "box"]].concat();
    assert!(of_surface(&parametric).0 == expected);
    // The diagonals of scattered points are free.
    assert_eq!(of_surface(&["--points", &points]).1["triangles"], 32);
}

#[test]
fn several_formulas_are_sheets_of_one_picture() {
    let one = of_surface(&["--expr", "2", "--samples", "3"]);
    let both = of_surface(&["--expr", "2", "--expr=-2", "--samples", "3"]);
    assert_eq!([&one.1["triangles"], &both.1["triangles"]], [8, 16]);
    assert!(one.0 != both.0);
    let disc = of_surface(&["--expr", "2", "--where", "r<=3", "--samples", "9"]);
    assert!(disc.1["triangles"].as_u64() < Some(8 * 8 * 2 * 2) && disc.0 != one.0);
}

#[test]
fn edges_are_counted_as_draw_counts_them() {
    let folder = tempfile::tempdir().unwrap();
    let pair = folder.path().join("pair.obj");
    let text = "v 0 0 0\nv 4 0 4\nv 4 4 4\nv 0 4 0\nv 0 1 4\nv 4 1 0\nv 4 3 0\nv 0 3 4\n\
                f 1 2 3 4\nf 5 6 7 8\n";
    std::fs::write(&pair, text).unwrap();
    let stats = |command: &str, more: &[&str]| -> serde_json::Value {
        let arguments = [&[command, "pair.obj", "--stats"], more].concat();
        let output = hiddenline(folder.path(), &arguments);
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{text}");
        serde_json::from_str(text.lines().last().unwrap()).unwrap()
    };
    let drawn = stats("draw", &[]);
    let shown = stats("preview", &["--edges", "-o", "-"]);
    assert_eq!(shown["intersections"], 1);
    assert_eq!(shown["counts"], drawn["counts"]);
    for key in ["vertices", "faces", "triangles", "edges", "intersections", "drawn_edges"] {
        assert_eq!(shown[key], drawn[key], "{key}");
    }
    assert!(shown["seconds"]["topology"].as_f64() > Some(0.0));
    // Without edges nobody asks where faces cross.
    assert_eq!(stats("preview", &["-o", "-"])["counts"]["intersection_pairs"], 0);
}

#[test]
fn bad_usage_is_told() {
    for (arguments, message) in [
        (&["-o", "x.png"][..], "specify models"),
        (&[SPOT, "--expr", "x", "-o", "-"], "cannot be used with"),
        (&[SPOT, "--grid", "x.csv", "-o", "-"], "cannot be used with"),
        (&[SPOT, "--x", "0:1", "-o", "-"], "are for surfaces"),
        (&["--expr", "x", "--expr", "y+", "-o", "-"], "in formula 2"),
        (&[SPOT, "--opacity", "0.5", "-o", "-"], "a-buffer"),
        (&[SPOT, "--size", "0x10", "-o", "-"], "WIDTHxHEIGHT"),
        (&[SPOT, "--tone", "--edges", "-o", "-"], "cannot be used with"),
    ] {
        let output = preview(arguments);
        let text = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
        assert!(text.contains(message), "{arguments:?}: {text}");
    }
}

#[test]
fn a_parallel_view_has_no_field_of_view_to_fit() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    std::fs::write(folder.path().join("old.png"), "as it was").unwrap();
    let arguments = ["preview", "cube.obj", "--fit-fov", "--view", "isometric", "-o", "old.png"];
    let refused = hiddenline(folder.path(), &arguments);
    assert_fails(&refused, 1, "no field of view to fit; use --projection perspective");
    assert_eq!(std::fs::read_to_string(folder.path().join("old.png")).unwrap(), "as it was");
    let shown = hiddenline(folder.path(), &["preview", "cube.obj", "--fit-fov", "-o", "-"]);
    assert!(shown.status.success(), "{}", text(&shown.stderr));
}
