//! The way to paper on the command line: formats, machines, pens, order, and settings from files.

use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

use glam::{DVec2, dvec2};
use hiddenline::stages::optimize::estimate::{Motion, estimate_lines};
use hiddenline::stages::optimize::{
    Effort, Graph, JOIN_TOLERANCE_MM, Joints, OptimizeOptions, optimize, optimize_lines, order,
    remove_overlaps,
};
use hiddenline::stages::plot::Polylines;
use tempfile::TempDir;

use super::{CUBE, assert_fails, command, hiddenline, text};
use crate::laws::optimize::paired_by_chance;
use crate::models::not_run;

/// Four pieces of ink: two that are one line, one of them again, and one elsewhere.
const LINES: &str = "\
<svg xmlns='http://www.w3.org/2000/svg' width='210mm' height='297mm' viewBox='0 0 210 297'>
<g fill='none' stroke='black'><path d='M50 50L100 50'/><path d='M200 50L100 50'/>
<path d='M100 50L50 50'/><path d='M20 200L60 240'/></g></svg>";

fn with_models() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_owned();
    fs::write(path.join("cube.obj"), CUBE).unwrap();
    fs::write(path.join("lines.svg"), LINES).unwrap();
    (folder, path)
}

#[test]
fn every_command_writes_every_format() {
    let (_keep, folder) = with_models();
    let commands: [&[&str]; 3] =
        [&["draw", "cube.obj"], &["surface", "x*y", "--samples", "5"], &["optimize", "lines.svg"]];
    for command in commands {
        for (name, start) in [
            ("a.svg", "<svg"),
            ("a.plt", "IN;DF;"),
            ("a.HPGL", "IN;DF;"),
            ("a.nc", ";"),
            ("a.pdf", "%PDF"),
            ("a.dxf", "0\nSECTION"),
            ("a.png", "\u{fffd}PNG"),
        ] {
            let output = hiddenline(&folder, &[command, &["-o", name]].concat());
            assert!(output.status.success(), "{name}: {}", text(&output.stderr));
            let bytes = fs::read(folder.join(name)).unwrap();
            let written = text(&bytes).replace("\r\n", "\n");
            let starts = written.trim_start().starts_with(start);
            assert!(starts || name == "a.nc" && written.contains("G1"), "{name}: {written:.40}");
        }
    }
}

#[test]
fn machines_are_known_by_name_and_near_misses_are_told() {
    let (_keep, folder) = with_models();
    let draw = |more: &[&str]| hiddenline(&folder, &[&["draw", "cube.obj"], more].concat());
    let unknown = draw(&["--machine", "hp7457a", "-o", "a.plt"]);
    assert_fails(&unknown, 2, "did you mean hp7475a");
    let other = draw(&["--machine", "grbl", "-o", "a.gcode"]);
    assert_fails(&other, 2, "did you mean grbl-z or");
    assert_fails(&draw(&["--machine", "marlin", "-o", "a.plt"]), 2, "not a machine for hpgl");
    fs::write(folder.join("mine.toml"), "feed = 1\n").unwrap();
    assert_fails(&draw(&["--gcode-profile", "mine.toml", "-o", "a.nc"]), 1, "mine.toml: ");
    assert_fails(&draw(&["--page", "123x45", "--margin", "1", "-o", "a.plt"]), 1, "take paper of");
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 3, "nothing was written");
    assert!(draw(&["--machine", "marlin", "-o", "a.gcode"]).status.success());
    assert!(text(&fs::read(folder.join("a.gcode")).unwrap()).contains("G1"));
}

#[test]
fn optimizing_joins_and_says_what_it_saved() {
    let (_keep, folder) = with_models();
    let output = hiddenline(&folder, &["optimize", "lines.svg", "--stats", "-o", "out.svg"]);
    let stderr = text(&output.stderr);
    assert!(stderr.contains("2 strokes 0.2 m, pen-up"), "{stderr}");
    assert!(stderr.contains("(before: 4 strokes 0.3 m, pen-up"), "{stderr}");
    let stats: serde_json::Value = serde_json::from_str(stderr.lines().last().unwrap()).unwrap();
    assert_eq!(stats["plot"]["before"]["strokes"], 4);
    assert_eq!(stats["plot"]["after"]["lifts"], 2);
    let svg = fs::read_to_string(folder.join("out.svg")).unwrap();
    assert_eq!(svg.matches("<path").count(), 2);
    assert!(svg.contains("L200 50\"") || svg.contains("L50 50\""), "{svg}");
}

#[test]
fn bad_drawings_are_refused_in_words_and_nothing_is_written() {
    let (_keep, folder) = with_models();
    let laughs: String = (1..40)
        .map(|i| format!("<!ENTITY l{i} '{}'>", format!("&l{};", i - 1).repeat(10)))
        .collect();
    let laughs =
        format!("<!DOCTYPE svg [<!ENTITY l0 'ha'>{laughs}]><svg width='9' height='9'>&l39;</svg>");
    fs::write(folder.join("old.svg"), "old").unwrap();
    for (content, message) in [
        ("<svg", "not a readable SVG"),
        ("<html/>", "not <svg>"),
        ("<svg width='9' height='9'><line x2='1e30' stroke='red'/></svg>", "line 1"),
        ("<svg width='0' height='9'/>", "no positive width"),
        (&laughs, "bad.svg: "),
    ] {
        fs::write(folder.join("bad.svg"), content).unwrap();
        let output = hiddenline(&folder, &["optimize", "bad.svg", "-o", "old.svg"]);
        assert_fails(&output, 1, message);
        assert_eq!(fs::read_to_string(folder.join("old.svg")).unwrap(), "old");
    }
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 4);
}

#[test]
fn a_kill_at_any_time_leaves_the_old_file_or_the_new_one() {
    let (_keep, folder) = with_models();
    let strokes: String =
        (0..20_000).map(|i| format!("<path d='M{} {}l1 1.5'/>", i % 200, 2 * (i / 200))).collect();
    let svg = format!("<svg width='9in' height='9in' stroke='red'>{strokes}</svg>");
    fs::write(folder.join("many.svg"), svg).unwrap();
    for wait_ms in [20, 80, 160, 320, 640] {
        fs::write(folder.join("out.svg"), "old").unwrap();
        let arguments = ["optimize", "many.svg", "-q", "-o", "out.svg"];
        let mut child = command(&folder, &arguments).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(wait_ms));
        let _ = child.kill();
        child.wait().unwrap();
        let left = fs::read_to_string(folder.join("out.svg")).unwrap();
        assert!(left == "old" || left.ends_with("</svg>\n"), "after {wait_ms} ms");
    }
}

#[test]
fn each_kind_of_line_can_have_its_pen() {
    let (_keep, folder) = with_models();
    let draw = |more: &[&str]| {
        let output = hiddenline(&folder, &[&["draw", "cube.obj"], more].concat());
        (text(&output.stdout), text(&output.stderr))
    };
    let (svg, _) =
        draw(&["--hidden", "dashed", "--pen", "visible=1:0.5mm:red", "--pen", "hidden=4"]);
    assert!(svg.contains(r#"inkscape:label="1 visible""#) && svg.contains("#ff0000"), "{svg:.900}");
    assert!(svg.contains(r#"inkscape:label="4 hidden""#) && svg.contains(r#"stroke-width="0.5""#));
    let (svg, stderr) = draw(&["--pen", "crease=2::blue"]);
    assert!(svg.contains(r#"inkscape:label="2 crease""#), "{svg:.900}");
    assert!(svg.contains(r#"inkscape:label="1 visible""#), "{svg:.900}");
    assert!(stderr.contains("crease"), "{stderr}");
    // Two kinds with one pen are joined as if they were one.
    let (one, _) = draw(&["--pen", "crease=1", "--pen", "silhouette=1"]);
    let (plain, _) = draw(&[]);
    assert_eq!(one.matches("<path").count(), plain.matches("<path").count());
    let (_, stderr) = draw(&["--pen", "crese=2"]);
    assert!(stderr.contains("did you mean crease"), "{stderr}");
}

#[test]
fn a_pen_that_has_drawn_far_enough_begins_a_new_layer() {
    let (_keep, folder) = with_models();
    let arguments = ["optimize", "lines.svg", "--split-distance", "0.1m"];
    let svg = text(&hiddenline(&folder, &arguments).stdout);
    assert!(svg.contains("part-1") && svg.contains("part-2"), "{svg}");
}

#[test]
fn typed_settings_go_before_the_environment_and_that_before_files() {
    let (_keep, folder) = with_models();
    fs::create_dir_all(folder.join("user/hiddenline")).unwrap();
    fs::write(folder.join("user/hiddenline/config.toml"), "[defaults]\npage = 'a1'\nmargin = 20\n")
        .unwrap();
    let page = |arguments: &[&str], variable: Option<&str>| {
        let mut command =
            command(&folder, &[&["draw", "cube.obj", "-o", "x.svg"], arguments].concat());
        if let Some(page) = variable {
            command.env("HIDDENLINE_PAGE", page);
        }
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stderr).split_once("x.svg  ").unwrap().1[..2].to_owned()
    };
    assert_eq!(page(&[], None), "A1");
    let project = "[defaults]\npage = 'a2'\n[preset.small]\npage = 'a6'\nlandscape = true\n";
    fs::write(folder.join("hiddenline.toml"), project).unwrap();
    assert_eq!(page(&[], None), "A2");
    assert_eq!(page(&[], Some("a3")), "A3");
    assert_eq!(page(&["--preset", "small"], None), "A6");
    assert_eq!(page(&["--page", "a5", "--preset", "small"], Some("a3")), "A5");
    // What is typed wins over a setting that conflicts with it.
    assert_eq!(page(&["--portrait", "--preset", "small"], None), "A6");
    let shown = text(&hiddenline(&folder, &["config", "show"]).stdout);
    assert!(shown.contains("page = \"a2\"  # hiddenline.toml"), "{shown}");
    assert!(shown.contains("margin = \"20"), "{shown}");
    let output = hiddenline(&folder, &["draw", "cube.obj", "--preset", "smal"]);
    assert_fails(&output, 2, "did you mean small");
    fs::write(folder.join("hiddenline.toml"), "[defaults]\npgae = 'a2'\n").unwrap();
    assert_fails(&hiddenline(&folder, &["draw", "cube.obj"]), 1, "pgae");
}

#[test]
fn a_configuration_file_can_have_machines() {
    let (_keep, folder) = with_models();
    let machines = "\
[preset.shop]\nmachine = 'mine'
[machine.mine]\nlike = 'grbl-servo'\npen_down = \"M3 S300\\n\"\ndecimals = 1
[machine.old]\nunit = 0.025\npens = 2
[[machine.old.paper]]\nnames = ['a5']\nsize = [210, 148]\nx = [0, 8000]\ny = [0, 5600]\norigin = [5, 143]
park = [0, 0]
[machine.slow.motion]\ndown_speed = 1\ndown_acceleration = 200\ncorner = 0.1\nup_speed = 200
up_acceleration = 400\nraise = 0.1\nlower = 0.1
[machine.broken]\nlike = 'grbl-servo'\nline = \"G1 {nonsense}\\n\"
[machine.stray]\nlike = 'gerbil'\n";
    fs::write(folder.join("hiddenline.toml"), machines).unwrap();
    let draw = |more: &[&str]| hiddenline(&folder, &[&["draw", "cube.obj"], more].concat());
    let written = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    assert!(draw(&["--preset", "shop", "-o", "a.nc"]).status.success());
    assert!(written("a.nc").contains("M3 S300\n") && written("a.nc").contains("G4 P0.3"));
    let old = draw(&["--machine", "OLD", "--page", "a5", "-o", "a.plt"]);
    assert!(old.status.success(), "{}", text(&old.stderr));
    assert!(written("a.plt").contains("PU0,0;SP0"), "{}", written("a.plt"));
    assert_fails(&draw(&["--machine", "old", "-o", "b.plt"]), 1, "choose from a5");
    // What limits a line of 1 mm/s is its length: 6 edges of a cube on A4 take a quarter of an hour.
    let minutes = |machine: &str| {
        let output = draw(&["--machine", machine, "--stats", "-o", "a.svg"]);
        let stderr = text(&output.stderr);
        let stats: serde_json::Value =
            serde_json::from_str(stderr.lines().last().unwrap()).unwrap();
        stats["plot"]["after"]["minutes"].as_f64().unwrap()
    };
    assert!(minutes("slow") > 10.0 * minutes("saxi"));
    let broken = draw(&["--machine", "broken", "-o", "a.nc"]);
    assert_fails(
        &broken,
        1,
        "machine broken in hiddenline.toml: template line: unknown placeholder",
    );
    assert_fails(&draw(&["--machine", "stray", "-o", "a.nc"]), 1, "did you mean grbl");
    assert_fails(&draw(&["--machine", "mime", "-o", "a.nc"]), 2, "did you mean mine");
    let shown = text(&hiddenline(&folder, &["config", "show"]).stdout);
    assert!(shown.contains("#   machine mine"), "{shown}");
}

/// How many pixels of a PNG on a page of 210 by 297 mm `is_it`, by red, green and blue.
fn pixels(bytes: &[u8], is_it: impl Fn(&[u8]) -> bool) -> usize {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut data).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgb);
    data.chunks_exact(3).filter(|pixel| is_it(pixel)).count()
}

#[test]
fn a_picture_can_show_how_the_pen_goes() {
    let (_keep, folder) = with_models();
    let show = |what: &str| {
        let arguments =
            ["optimize", "lines.svg", "--format", "png", "--dpi", "100", "--png-show", what];
        hiddenline(&folder, &arguments).stdout
    };
    let is_red = |p: &[u8]| p[0] > 180 && p[1] < 110 && p[2] < 110;
    let is_blue = |p: &[u8]| p[2] > 180 && p[0] < 90 && p[1] < 90;
    // From the end of one of the two strokes to the beginning of the other: 100 mm or more.
    let travel = show("travel");
    assert!(pixels(&travel, is_red) + pixels(&travel, |p| p[0] > 220 && p[1] < 200) > 300);
    assert_eq!(pixels(&travel, is_blue), 0);
    let order = show("order");
    assert!(pixels(&order, is_blue) > 100, "{}", pixels(&order, is_blue));
    assert!(pixels(&order, |p| p[1] > 150 && p[0] < 90 && p[2] < 90) > 100);
    assert_ne!(show("travel,order"), order);
}

#[test]
fn strict_takes_warnings_for_errors() {
    let (_keep, folder) = with_models();
    let away = ["draw", "cube.obj", "--eye", "9,0,0", "--target", "20,0,0", "--strict"];
    assert_fails(&hiddenline(&folder, &away), 1, "the drawing is empty");
}

#[test]
fn colors_come_only_when_asked_for() {
    let (_keep, folder) = with_models();
    let colored = hiddenline(&folder, &["draw", "none.obj", "--color", "always"]);
    assert!(text(&colored.stderr).contains("\u{1b}["));
    let plain = hiddenline(&folder, &["draw", "none.obj"]);
    assert!(!text(&plain.stderr).contains("\u{1b}["));
}

/// The drawing of `gen_strokes.py wire N`, where it can be made.
fn wire(n: &str) -> Option<Polylines> {
    let generator =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/models/generators/gen_strokes.py");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("wire.svg");
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    let made = Command::new(python).arg(generator).args(["wire", n]).arg(&file).output();
    if !made.is_ok_and(|output| output.status.success()) {
        not_run("gen_strokes.py needs ../shared/models and Python with numpy (PYTHON)");
        return None;
    }
    let text = fs::read_to_string(file).unwrap();
    let read = hiddenline::stages::read_svg::read(
        &text,
        &hiddenline::stages::read_svg::SvgOptions::default(),
    );
    Some(read.unwrap().plot.layers.swap_remove(0).lines)
}

#[test]
fn a_wire_drawing_has_as_few_strokes_as_there_can_be() {
    let Some(lines) = wire("2000") else { return };
    let layer = hiddenline::stages::plot::Layer {
        number: 1,
        name: "lines".into(),
        pen: hiddenline::stages::plot::Pen { width_mm: 0.3, color: "#000000".into() },
        lines,
        ..Default::default()
    };
    let plot = hiddenline::stages::plot::Plot { layers: vec![layer], ..Default::default() };
    let (done, _) = optimize(&plot, &OptimizeOptions::default());
    let work = estimate_lines(&done.layers[0].lines, &Motion::SAXI);
    eprintln!("{work:?}");
    assert_eq!(work.strokes, 134);
    assert!((work.down_mm - 6696.0).abs() < 1.0, "{}", work.down_mm);
    assert!(work.up_mm <= 700.0, "{}", work.up_mm);
}

#[test]
fn a_wire_drawing_takes_much_less_time_than_strokes_paired_by_chance() {
    let Some(lines) = wire("20000") else { return };
    let ours = optimize_lines(&lines, None, &OptimizeOptions::default()).lines;
    assert_eq!(ours.len(), 454);
    let mut graph = Graph::new(&lines, Joints::Near(JOIN_TOLERANCE_MM));
    remove_overlaps(&mut graph, 0.0);
    let arbitrary = paired_by_chance(&graph.positions, &graph.edges);
    let seconds = |lines: &Polylines| estimate_lines(lines, &Motion::SAXI).seconds;
    let ratio = seconds(&ours) / seconds(&order(&arbitrary, Effort::Fast).lines);
    eprintln!("{ratio:.3} of the time of {} strokes paired by chance", arbitrary.len());
    assert!(ratio <= 0.65, "{ratio}");
}

#[test]
fn joints_move_by_half_of_the_tolerance_at_most() {
    // A stroke's end and another's beginning, two micrometers apart as three decimals have them.
    let lines =
        [[dvec2(10.0, 10.0), dvec2(20.001, 10.0)], [dvec2(20.003, 10.0), dvec2(20.0, 30.0)]];
    let mut polylines = Polylines::default();
    lines.iter().for_each(|line| polylines.push(line.iter().copied()));
    let joined = optimize_lines(&polylines, None, &OptimizeOptions::default()).lines;
    assert_eq!(joined.len(), 1);
    let corner = joined.iter().next().unwrap()[1];
    let farthest = |p: DVec2| p.distance(corner);
    assert!(farthest(lines[0][1]) <= JOIN_TOLERANCE_MM / 2.0);
    assert!(farthest(lines[1][0]) <= JOIN_TOLERANCE_MM / 2.0);
}
