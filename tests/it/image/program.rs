//! `hiddenline preview` as a program.

use std::path::PathBuf;
use std::process::{Command, Output};

fn spot() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/models/spot.obj"))
}

fn preview(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hiddenline"));
    command.arg("preview").args(arguments).output().unwrap()
}

/// Columns, rows, channels and bytes.
fn picture(bytes: &[u8]) -> (u32, u32, usize, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    (info.width, info.height, info.color_type.samples(), pixels)
}

fn of_spot(more: &[&str]) -> (u32, u32, usize, Vec<u8>) {
    let model = spot();
    let mut arguments = vec![model.to_str().unwrap(), "--up-axis", "y", "--quiet"];
    arguments.extend(["--size", "90x70", "-o", "-"]);
    arguments.extend(more);
    let output = preview(&arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
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
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let (width, height, _, bytes) = picture(&output.stdout);
    assert_eq!((width, height), (40, 30));
    assert!(bytes.chunks(3).filter(|color| *color != [255; 3]).count() > 200);
    let text = String::from_utf8(output.stderr).unwrap();
    let stats: serde_json::Value = serde_json::from_str(text.lines().last().unwrap()).unwrap();
    assert_eq!((&stats["engine"], &stats["triangles"]), (&"z-buffer".into(), &79202.into()));
}

#[test]
fn bad_usage_is_told() {
    let spot = spot();
    let spot = spot.to_str().unwrap();
    for (arguments, message) in [
        (&["-o", "x.png"][..], "give models"),
        (&[spot, "--opacity", "0.5", "-o", "-"], "a-buffer"),
        (&[spot, "--size", "0x10", "-o", "-"], "WIDTHxHEIGHT"),
        (&[spot, "--tone", "--edges", "-o", "-"], "cannot be used with"),
    ] {
        let output = preview(arguments);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
        assert!(text.contains(message), "{arguments:?}: {text}");
    }
}
