//! What users mistype, and what the program makes of it: one mistake a test.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::{CUBE, hiddenline, text};

const LINE: &str = "\
<svg xmlns='http://www.w3.org/2000/svg' width='210mm' height='297mm' viewBox='0 0 210 297'>
<path d='M50 50L100 50' fill='none' stroke='black'/></svg>";

/// A folder with a model and its materials, heights, points and an SVG.
fn with_files() -> (TempDir, PathBuf) {
    let keep = tempfile::tempdir().unwrap();
    let folder = keep.path().to_owned();
    for (name, content) in [
        ("cube.obj", &*format!("mtllib cube.mtl\n{CUBE}")),
        ("cube.mtl", "newmtl red\nKd 1 0 0\n"),
        ("heights.csv", "1,2\n3,5\n"),
        ("points.xyz", "0 0 1\n1 0 2\n0 1 3\n"),
        ("line.svg", LINE),
    ] {
        fs::write(folder.join(name), content).unwrap();
    }
    (keep, folder)
}

/// Runs the program, which must end with `code`, and returns its messages.
fn told(folder: &Path, arguments: &[&str], code: i32) -> String {
    let output = hiddenline(folder, arguments);
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
    stderr
}

fn fails(folder: &Path, arguments: &[&str], code: i32, message: &str) {
    let stderr = told(folder, arguments, code);
    assert!(stderr.contains(message), "{arguments:?}: {stderr}");
}

#[test]
fn no_file_that_is_read_is_replaced() {
    let (_keep, folder) = with_files();
    let before = |name: &str| fs::read(folder.join(name)).unwrap();
    for (arguments, name) in [
        (&["preview", "cube.obj", "-o", "./cube.obj"][..], "cube.obj"),
        (&["draw", "cube.obj", "--format", "svg", "-o", "cube.obj"], "cube.obj"),
        (&["fill", "cube.obj", "--format", "svg", "-o", "cube.mtl"], "cube.mtl"),
        (
            &["surface", "--grid", "heights.csv", "--format", "svg", "-o", "heights.csv"],
            "heights.csv",
        ),
        (
            &["surface", "--points", "points.xyz", "--format", "svg", "-o", "points.xyz"],
            "points.xyz",
        ),
        (&["optimize", "line.svg", "--format", "hpgl", "-o", "line.svg"], "line.svg"),
    ] {
        let bytes = before(name);
        fails(&folder, arguments, 1, "would be replaced");
        assert!(before(name) == bytes, "{arguments:?}");
    }
    told(&folder, &["draw", "cube.obj", "-o", "view.json"], 0);
    let camera = ["draw", "cube.obj", "--camera", "view.json", "-o", "view.json"];
    fails(&folder, &camera, 1, "would be replaced");
    fs::copy(folder.join("cube.obj"), folder.join("turn-002.svg")).unwrap();
    let model = ["fill", "turn-002.svg", "--input-format", "obj"];
    let turntable = [&model[..], &["--turntable", "2", "-o", "turn.svg"]].concat();
    fails(&folder, &turntable, 1, "would be replaced");
    assert!(!folder.join("turn-001.svg").exists());
}

#[cfg(unix)]
#[test]
fn a_model_is_not_replaced_by_way_of_a_link() {
    let (_keep, folder) = with_files();
    std::os::unix::fs::symlink(folder.join("cube.obj"), folder.join("link.svg")).unwrap();
    let before = fs::read(folder.join("cube.obj")).unwrap();
    fails(&folder, &["draw", "cube.obj", "-o", "link.svg"], 1, "would be replaced");
    assert!(fs::read(folder.join("cube.obj")).unwrap() == before);
}

#[test]
fn an_svg_can_be_optimized_in_place() {
    let (_keep, folder) = with_files();
    told(&folder, &["optimize", "line.svg", "-o", "line.svg"], 0);
    let svg = fs::read_to_string(folder.join("line.svg")).unwrap();
    assert!(svg != LINE && svg.contains("M50 50"), "{svg}");
}

#[test]
fn a_preview_is_not_written_under_the_name_of_another_format() {
    let (_keep, folder) = with_files();
    for name in ["x.jpg", "x.svg", "x"] {
        fails(&folder, &["preview", "cube.obj", "-o", name], 2, "does not end in .png");
        assert!(!folder.join(name).exists());
    }
    let stderr = told(&folder, &["preview", "cube.obj", "--size", "40", "-o", "x.PNG"], 0);
    assert!(stderr.contains("x.PNG  40 x 40 pixels"), "{stderr}");
}

#[test]
fn a_missing_folder_is_told_without_the_name_of_a_temporary_file() {
    let (_keep, folder) = with_files();
    for command in [["draw", "cube.obj"], ["preview", "cube.obj"], ["optimize", "line.svg"]] {
        let name = if command[0] == "preview" { "no/x.png" } else { "no/x.svg" };
        let stderr = told(&folder, &[&command[..], &["-o", name]].concat(), 1);
        assert!(stderr.contains("folder no does not exist") && !stderr.contains(".hiddenline"));
    }
}

#[test]
fn negative_numbers_are_values_that_may_be_too_small() {
    let (_keep, folder) = with_files();
    for (option, message) in [
        ("--margin", "must be 0 or more"),
        ("--crease", "must be 0 or more"),
        ("--weld", "must be 0 or more"),
        ("--distance", "must be above 0"),
        ("--pen-width", "must be above 0"),
    ] {
        fails(&folder, &["draw", "cube.obj", option, "-4.5"], 2, message);
    }
}

#[test]
fn unknown_options_are_not_taken_for_files() {
    let (_keep, folder) = with_files();
    let unknown = told(&folder, &["draw", "cube.obj", "--quux"], 2);
    assert!(unknown.contains("--quux") && !unknown.contains("tip"), "{unknown}");
    for size in ["--width", "--height=500", "--size"] {
        let stderr = told(&folder, &["draw", "cube.obj", size], 2);
        assert!(stderr.contains("'--page WIDTHxHEIGHT'"), "{stderr}");
        assert!(stderr.contains("'--png-width'") && !stderr.contains("'-- "), "{stderr}");
    }
    fails(&folder, &["preview", "cube.obj", "--width", "9"], 2, "'--size WIDTHxHEIGHT'");
    fails(&folder, &["draw", "cube.obj", "--engin", "appel"], 2, "'--engine'");
}

#[test]
fn parametric_formulas_do_not_swallow_options() {
    let (_keep, folder) = with_files();
    let three = "three formulas are needed";
    fails(&folder, &["surface", "--parametric", "u", "v", "-o", "x.svg"], 2, three);
    fails(&folder, &["surface", "--parametric", "u", "v", "--view", "top"], 2, three);
    told(&folder, &["surface", "--parametric", "u", "-v", "-u*v", "-o", "x.svg"], 0);
}

#[test]
fn a_surface_without_values_is_told_with_its_formula_and_range() {
    let (_keep, folder) = with_files();
    let nothing = |formula: &str, more: &[&str], messages: &[&str]| {
        let stderr = told(&folder, &[&["surface", formula], more].concat(), 1);
        for message in messages {
            assert!(stderr.contains(message), "{message}: {stderr}");
        }
    };
    nothing("1/0", &[], &["`1/0` has a value at none of 81 × 81", "-5:5", "--x and --y"]);
    nothing("sqrt(-1-r)", &["--x=0:2"], &["`sqrt(-1-r)`", "x in 0:2 and y in -5:5"]);
    nothing("x", &["--where", "x>30"], &["--where `x>30` holds at none"]);
    nothing("1/0", &["--where", "x>30"], &["`1/0` has a value at none"]);
}

#[test]
fn a_level_surface_has_no_level_curves() {
    let (_keep, folder) = with_files();
    let flat = ["surface", "0", "--samples", "5", "--lines", "levels"];
    fails(&folder, &flat, 1, "the surface is flat at height 0");
    let more = ["surface", "3", "--samples", "5", "--lines", "levels,x", "-o", "x.svg"];
    fails(&folder, &more, 0, "warning: the surface is flat at height 3");
    let away = ["surface", "x", "--samples", "5", "--lines", "levels", "--levels", "7,9"];
    fails(&folder, &away, 1, "heights from -5 to 5: none of the --levels is in this range");
}

#[test]
fn an_empty_drawing_has_no_negative_length() {
    let (_keep, folder) = with_files();
    let away = ["draw", "cube.obj", "--eye", "9,0,0", "--target", "20,0,0", "-o", "x.svg"];
    let stderr = told(&folder, &away, 0);
    assert!(stderr.contains("visible 0 strokes 0.0 m\n"), "{stderr}");
}

#[test]
fn files_of_another_kind_are_told() {
    let (_keep, folder) = with_files();
    fails(&folder, &["draw", "heights.csv"], 1, "--input-format");
    fs::write(folder.join("bytes"), b"\x80\x00\xff").unwrap();
    for name in ["bytes", "cube.obj"] {
        let camera = ["draw", "cube.obj", "--camera", name];
        fails(
            &folder,
            &camera,
            1,
            &format!("--camera {name}: this is not a file of strokes as JSON"),
        );
    }
}

#[test]
fn what_is_wrong_with_a_file_of_heights_is_told() {
    let (_keep, folder) = with_files();
    let heights = |option: &str, content: &[u8], told: &str| {
        fs::write(folder.join("h.dat"), content).unwrap();
        fails(&folder, &["surface", option, "h.dat", "-o", "x.svg"], 1, told);
    };
    let apart = "line 1, cell 1: `1,234,567.5` is not a number; numbers have no separators between";
    heights("--grid", b"1,234,567.5;2;3\n4;5;6\n7;8;9\n", apart);
    heights(
        "--grid",
        "a b\n1 2\n1'000 3\n".as_bytes(),
        "line 3, cell 1: `1'000` is not a number; n",
    );
    heights("--grid", b"1 2 3\n", "1 sample makes no surface along y");
    heights("--grid", b"II*\0\x08\0\0\0", "TIFF: the file ends too early");
    heights(
        "--points",
        b"1 2 3 4\n4 5 6 7\n7 8 9 1\n",
        "use --grid h.dat instead of --points h.dat",
    );
    // Ends of lines of the old Mac OS, and minus signs of typesetters.
    for text in ["1\u{2212} 2\r4 5\r", "1 \u{2212}2\r4 5\r"] {
        fs::write(folder.join("h.dat"), text).unwrap();
        let is_number = !text.starts_with("1\u{2212}");
        let code = if is_number { 0 } else { 1 };
        let said = told(&folder, &["surface", "--grid", "h.dat", "-o", "x.svg"], code);
        assert_eq!(said.contains("2 × 2 samples"), is_number, "{said}");
    }
    // Many columns are a grid, and a few may be colors.
    let row = |n: usize, k: usize| {
        (0..n).map(|j| format!("{} ", j * j + 7 * k * k * (j % 2 + 1))).collect::<String>() + "\n"
    };
    for (n, is_told) in [(12, true), (7, false)] {
        let text: String = (0..30).map(|k| row(n, k)).collect();
        fs::write(folder.join("h.dat"), text.replace("0 ", "0.5 ")).unwrap();
        let mut arguments = vec!["surface", "--points", "h.dat", "-o", "x.svg"];
        arguments.extend(["--duplicates", "first"]);
        let output = super::hiddenline(&folder, &arguments);
        let said = super::text(&output.stderr);
        assert_eq!(said.contains("use --grid h.dat instead"), is_told, "{n}: {said}");
    }
}

#[test]
fn the_place_of_an_error_in_a_formula_is_marked() {
    let (_keep, folder) = with_files();
    let second = ["surface", "x", "y + 2x"];
    fails(&folder, &second, 2, "in formula 2 of 2, column 6");
    fails(&folder, &second, 2, "\n  y + 2x\n       ^\n");
    fails(&folder, &["surface", "z=x^2"], 2, "leave out `z =`\n  z=x^2\n  ^\n");
    fails(&folder, &["surface", "x", "--x=-2pi:2pi"], 2, "`2*pi`\n  -2pi\n    ^\n");
    fails(&folder, &["surface", "x", "--where", "x=3"], 2, "\n  x=3\n   ^\n");
    fails(&folder, &["preview", "--expr", "2x", "-o", "x.png"], 2, "\n  2x\n   ^\n");
}

#[test]
fn kinds_of_line_that_are_nearly_right_are_told() {
    let (_keep, folder) = with_files();
    for name in ["sillhouette", "Silhouette"] {
        let lines = ["draw", "cube.obj", "--lines", name];
        fails(&folder, &lines, 2, "did you mean silhouette?");
    }
}

#[test]
fn the_largest_scale_that_fits_is_told_and_fits() {
    let (_keep, folder) = with_files();
    for unit in ["mm", "m"] {
        let draw = |scale: &str| {
            let drawing = ["draw", "cube.obj", "--unit", unit, "-o", "x.svg", "--drawing-scale"];
            told(&folder, &[&drawing[..], &[scale]].concat(), 0)
        };
        let stderr = draw("1000:1");
        let (_, rest) = stderr.split_once("the largest scale that fits is ").unwrap();
        let fitting = rest.lines().next().unwrap();
        assert!(!draw(fitting).contains("cut off"), "{fitting}");
        let (paper, model) = fitting.split_once(':').unwrap();
        let ratio = paper.parse::<f64>().unwrap() / model.parse::<f64>().unwrap();
        assert!(draw(&(1.02 * ratio).to_string()).contains("cut off"), "{fitting}");
    }
}

#[test]
fn wrong_names_are_bad_usage() {
    let (_keep, folder) = with_files();
    fails(&folder, &["draw", "cube.obj", "--machine", "axidrew"], 2, "did you mean axidraw");
    fails(&folder, &["draw", "cube.obj", "--preset", "none"], 2, "unknown preset `none`");
    fails(&folder, &["surface", "x", "--samples", "100000"], 2, "exceed the limit of 100000000");
    fails(&folder, &["preview", "cube.obj", "--light", "0,0,0"], 2, "not a direction");
    fails(&folder, &["fill", "cube.obj", "--light", "0,0,0"], 2, "not a direction");
}

#[test]
fn one_of_a_kind_is_not_many() {
    let (_keep, folder) = with_files();
    fs::write(folder.join("one.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let stderr = told(&folder, &["draw", "one.obj", "--view", "top", "-o", "x.svg"], 0);
    assert!(stderr.contains("one.obj: 3 vertices, 1 face\n"), "{stderr}");
    assert!(stderr.contains("visible 1 stroke ") && stderr.contains(" 1 lift,"), "{stderr}");
}

#[test]
fn hours_are_told_as_hours() {
    let (_keep, folder) = with_files();
    let slow = "[machine.slow.motion]\ndown_speed = 0.1\ndown_acceleration = 200\ncorner = 0.1
up_speed = 200\nup_acceleration = 400\nraise = 0.1\nlower = 0.1\n";
    fs::write(folder.join("hiddenline.toml"), slow).unwrap();
    // 50 mm at 0.1 mm/s and as much again are a quarter of an hour.
    let stderr = told(&folder, &["optimize", "line.svg", "--machine", "slow", "-o", "x.svg"], 0);
    assert!(stderr.contains("about 8.3 min"), "{stderr}");
    let stderr = told(&folder, &["draw", "cube.obj", "--machine", "slow", "-o", "x.svg"], 0);
    let (_, time) = stderr.split_once("about ").unwrap();
    let (hours, rest) = time.split_once(" h ").unwrap();
    let (minutes, _) = rest.split_once(" min").unwrap();
    let meters = stderr.split_once(" strokes ").unwrap().1.split_once(" m").unwrap().0;
    let told = 60.0 * hours.parse::<f64>().unwrap() + minutes.parse::<f64>().unwrap();
    let expected = meters.parse::<f64>().unwrap() * 10_000.0 / 60.0;
    assert!((told / expected - 1.0).abs() < 0.1, "{stderr}");
}

#[test]
fn options_without_effect_are_warned_of() {
    let (_keep, folder) = with_files();
    let drawn =
        |more: &[&str]| told(&folder, &[&["draw", "cube.obj", "-o", "x.svg"], more].concat(), 0);
    for (more, message) in [
        (&["--dash", "1,1"][..], "--dash has no effect"),
        (&["--dash=1,1", "--hidden", "solid"], "--dash has no effect"),
        (&["--pen", "hidden=2"], "--pen for hidden lines has no effect"),
        (&["--hidden-levels", "2", "--hidden", "none"], "--hidden-levels has no effect"),
        (&["--dpi", "100"], "--dpi has no effect on svg"),
        (&["--exact", "--halo", "1"], "--halo has no effect with --exact"),
        (&["--exact", "--thin=2"], "--thin has no effect with --exact"),
        (&["--exact", "--overlap", "keep"], "--overlap has no effect with --exact"),
        (&["--exact", "--join-tolerance", "3"], "--join-tolerance has no effect with --exact"),
        (
            &["--overlap", "keep", "--overlap-tolerance", "1"],
            "--overlap-tolerance has no effect with --overlap keep",
        ),
        (&["--exact", "--smooth", "30"], "--smooth has no effect with --exact"),
        (&["--smooth-tolerance", "1"], "--smooth-tolerance has no effect without --smooth"),
        (&["--format", "dxf", "--dxf-dashes", "native"], "--dxf-dashes has no effect without"),
        (
            &["--format=dxf", "--pen", "visible=1:speed=9:pause"],
            "speed of --pen has no effect on dxf",
        ),
        (
            &["--format=gcode", "--pen", "visible=1:height=9"],
            "height of --pen has no effect on gcode",
        ),
        (&["--format=hpgl", "--pen", "visible=1:delay=9"], "delay of --pen has no effect on hpgl"),
        (&["--unit", "m"], "--unit has no effect without --drawing-scale"),
        (
            &["--split-distance", "1mm", "--split-overlap", "5"],
            "--split-overlap 5 is more than half of --split-distance: 0.5 mm are used",
        ),
    ] {
        let stderr = drawn(more);
        assert!(stderr.contains(&format!("warning: {message}")), "{more:?}: {stderr}");
    }
    let plotted =
        |more: &[&str]| told(&folder, &[&["surface", "x*y", "-o", "x.svg"], more].concat(), 0);
    let levels = ["--lines", "levels", "--view", "top"];
    for (more, message) in [
        (&["--label-side", "uphill"][..], "--label-side has no effect without levels among"),
        (&["--lines", "both,levels", "--label-side", "uphill"], "effect without labels; --labels"),
        (&[&levels[..], &["--labels", "none", "--label-side=uphill"]].concat(), "without labels"),
        (&[&levels[..], &["--exact", "--labels", "all"]].concat(), "--labels has no effect with"),
        (&[&levels[..], &["--exact", "--label-side=uphill"]].concat(), "--label-side has no"),
        (&[&levels[..], &["--exact", "--negative", "dashed"]].concat(), "--negative has no effect"),
        (&["--exact", "--legend"], "--legend has no effect with --exact"),
        (&["--set", "a=2"], "--set a=… has no effect: no formula names a"),
        (&["--for", "xy=1,2"], "--for xy=… has no effect: no formula names xy"),
        (&["--names", "a"], "--names has no effect without --legend"),
        (&["--pen", "level=2"], "--pen level=… draws nothing"),
        (&["--pen", "box=2"], "--pen box=… draws nothing"),
        (&["--axes", "back", "--pen", "level-base=2"], "--pen level-base=… draws nothing"),
    ] {
        let stderr = plotted(more);
        assert!(stderr.contains("warning: ") && stderr.contains(message), "{more:?}: {stderr}");
    }
    for more in [
        &[&levels[..], &["--label-side", "uphill", "--labels", "all"]].concat()[..],
        &[&levels[..], &["--label-side", "uphill", "--negative", "dashed"]].concat(),
        &["--lines", "x,levels", "--every", "80", "--labels", "all", "--label-side", "uphill"],
        &["--legend", "--names", "a"],
        &["--where", "a*x>0", "--set", "a=2"],
        &["--axes", "box", "--title", "T", "--pen", "box=2", "--pen", "back=3", "--pen", "title=4"],
        &["--axes", "base", "--pen", "box=2", "--pen", "text=3", "--pen", "axis=4"],
    ] {
        let stderr = plotted(more);
        assert!(!stderr.contains("warning"), "{more:?}: {stderr}");
    }
    for more in [
        &["--dash", "1,1", "--hidden", "dashed", "--pen", "hidden=2"][..],
        &["--hidden-levels", "2", "--dash", "1,1"],
        &["--dpi", "100", "--format", "png"],
    ] {
        let stderr = drawn(more);
        assert!(!stderr.contains("warning"), "{more:?}: {stderr}");
    }
    // Settings for all drawings need not have an effect on each.
    fs::write(folder.join("hiddenline.toml"), "[defaults]\ndash = '1,1'\ndpi = 100\n").unwrap();
    let stderr = drawn(&[]);
    assert!(!stderr.contains("warning"), "{stderr}");
}

#[test]
fn what_other_options_make_useless_is_warned_of_and_changes_nothing() {
    let (_keep, folder) = with_files();
    let lines = "<svg xmlns='http://www.w3.org/2000/svg' width='90mm' height='50mm' \
                 viewBox='0 0 90 50'><path d='M5 5H80V40' stroke='black' fill='none'/></svg>";
    fs::write(folder.join("lines.svg"), lines).unwrap();
    fs::write(folder.join("grid.csv"), "0,1,2\n1,3,1\n0,2,2\n").unwrap();
    let draw = &["draw", "cube.obj"][..];
    let top = &["draw", "cube.obj", "--view", "top"][..];
    let exact = &["draw", "cube.obj", "--exact"][..];
    let surface = &["surface", "x*y", "--samples", "9"][..];
    let exact_surface = &["surface", "x*y", "--samples", "9", "--exact"][..];
    let silhouette = &["draw", "cube.obj", "--lines", "silhouette"][..];
    let levels = &["surface", "x*y", "--samples", "9", "--lines", "levels"][..];
    let far = &["draw", "cube.obj", "--eye", "9,8,7"][..];
    let bare = &["fill", "cube.obj", "--no-edges"][..];
    let preview = &["preview", "cube.obj", "--size", "40x30"][..];
    let depth = &["preview", "cube.obj", "--size", "40x30", "--show", "depth"][..];
    let optimize = &["optimize", "lines.svg"][..];
    let fit = &["optimize", "lines.svg", "--fit"][..];
    for (command, option) in [
        (silhouette, &["--crease", "20"][..]),
        (draw, &["--unit", "m"]),
        (top, &["--near", "0.1"]),
        (top, &["--fov", "20"]),
        (top, &["--distance", "50"]),
        (far, &["--fov", "20"]),
        (exact, &["--shortest-stroke", "5"]),
        (exact, &["--simplify", "1"]),
        (exact, &["--optimize", "best"]),
        (exact_surface, &["--smoothness", "1"]),
        (&["surface", "--grid", "grid.csv"], &["--smoothness", "1"]),
        (surface, &["--u", "0:2"]),
        (surface, &["--v", "0:2"]),
        (levels, &["--every", "3"]),
        (&["fill", "cube.obj", "--engine", "bsp"], &["--leaf", "3"]),
        (&["fill", "cube.obj", "--engine", "octree"], &["--subdivision", "vertices"]),
        (bare, &["--crease", "10"]),
        (bare, &["--pen-width", "1"]),
        (bare, &["--simplify", "1"]),
        (preview, &["--edge-width", "3"]),
        (preview, &["--smooth-angle", "20"]),
        (depth, &["--shading", "smooth"]),
        (depth, &["--light", "1,1,1"]),
        (depth, &["--paint", "red"]),
        (optimize, &["--margin", "10"]),
        (fit, &["--center"]),
    ] {
        let end = if command[0] == "preview" { ".png" } else { ".svg" };
        let made = |more: &[&str], name: &str| {
            let name = format!("{name}{end}");
            let stderr = told(&folder, &[command, more, &["-o", &name]].concat(), 0);
            let bytes = fs::read(folder.join(name)).unwrap();
            let text = String::from_utf8_lossy(&bytes).into_owned();
            // The command line is part of an SVG.
            let picture: Vec<String> = text.lines().map(str::to_owned).collect();
            let of_lines = |line: &&String| !line.contains("hiddenline");
            (stderr, picture.iter().filter(of_lines).cloned().collect::<Vec<_>>())
        };
        let (with, picture) = made(option, "with");
        let message = format!("warning: {} has no effect", option[0]);
        assert_eq!(with.matches(&message).count(), 1, "{command:?} {option:?}: {with}");
        let (without, same) = made(&[], "without");
        assert!(!without.contains("no effect"), "{command:?}: {without}");
        assert!(picture == same, "{command:?} {option:?}");
    }
    for options in [
        &["draw", "cube.obj", "--unit", "m", "--drawing-scale", "1:100"][..],
        &["draw", "cube.obj", "--view", "top", "--projection", "perspective", "--fov", "20"],
        &["draw", "cube.obj", "--eye", "9,8,7", "--fov", "60", "--fit-fov"],
        &["draw", "cube.obj", "--crease", "20", "--lines", "silhouette,crease"],
        &["surface", "--grid", "grid.csv", "--lines", "x,levels", "--every", "2"],
        &["surface", "--parametric", "u", "v", "u*v", "--u", "0:2"],
        &["fill", "cube.obj", "--crease", "10", "--pen-width", "1"],
        &["optimize", "lines.svg", "--margin", "4", "--fit"],
    ] {
        let stderr = told(&folder, &[options, &["-o", "x.svg"]].concat(), 0);
        assert!(!stderr.contains("no effect"), "{options:?}: {stderr}");
    }
}

#[test]
fn pens_that_draw_nothing_are_warned_of() {
    let (_keep, folder) = with_files();
    let drawn =
        |more: &[&str]| told(&folder, &[&["draw", "cube.obj", "-o", "x.svg"], more].concat(), 0);
    for pen in ["wire=2", "mesh=3", "underside=2", "outline=2"] {
        let what = pen.split_once('=').unwrap().0;
        let stderr = drawn(&["--pen", pen]);
        assert!(stderr.contains(&format!("warning: --pen {what}=… draws nothing")), "{stderr}");
    }
    // A more special pen takes all of its strokes.
    let pens = ["visible=1", "silhouette=2", "crease=3"];
    let pens: Vec<&str> = pens.iter().flat_map(|pen| ["--pen", *pen]).collect();
    assert!(drawn(&pens).contains("warning: --pen visible=… draws nothing"));
    assert!(!drawn(&["--pen", "visible=1", "--pen", "crease=2"]).contains("warning"));
    let strict = ["draw", "cube.obj", "--pen", "wire=2", "--strict", "-o", "never.svg"];
    assert!(told(&folder, &strict, 1).contains("draws nothing"));
    assert!(!folder.join("never.svg").exists());
    fs::write(folder.join("hiddenline.toml"), "[defaults]\npen = ['wire=2']\n").unwrap();
    assert!(!drawn(&[]).contains("warning"));
}

#[test]
fn filling_tells_of_pens_only_where_there_are_lines_and_of_formats_that_it_has() {
    let (_keep, folder) = with_files();
    let areas = told(&folder, &["fill", "cube.obj", "--no-edges", "-o", "x.svg"], 0);
    assert!(areas.contains("fills 3 areas\n") && !areas.contains("pen-up"), "{areas}");
    let edged = told(&folder, &["fill", "cube.obj", "-o", "x.svg"], 0);
    assert!(edged.contains("pen-up"), "{edged}");
    let turned = told(&folder, &["fill", "cube.obj", "--turntable", "3", "-o", "x.svg"], 0);
    assert!(turned.lines().all(|line| !line.is_empty()), "{turned}");
    let help = String::from_utf8(hiddenline(&folder, &["fill", "--help"]).stdout).unwrap();
    assert!(help.contains(".svg; .pdf; .png") && !help.contains("hpgl, gcode"), "{help}");
    assert!(!help.contains(".gcode"), "{help}");
}

#[test]
fn letters_that_the_font_does_not_have_are_warned_of_once() {
    let (_keep, folder) = with_files();
    let titled = |title: &str| {
        let surface = ["surface", "x", "--samples", "5", "-o", "x.svg", "--title", title];
        told(&folder, &surface, 0)
    };
    assert!(!titled("Grüße: 3 m² ± 2°").contains("warning"));
    let stderr = titled("日本日");
    assert!(stderr.contains("warning: the font lacks `日`, `本`: "), "{stderr}");
}

#[test]
fn the_help_lists_kinds_of_line_one_a_line() {
    let (_keep, folder) = with_files();
    let help = String::from_utf8(hiddenline(&folder, &["draw", "--help"]).stdout).unwrap();
    for kind in ["silhouette", "crease", "boundary", "nonmanifold", "intersection", "outline"] {
        assert!(help.lines().any(|line| line.trim_start().starts_with(&format!("{kind}  "))));
    }
}

#[test]
fn models_far_from_the_origin_are_not_said_to_be_seen_from_themselves() {
    let (_keep, folder) = with_files();
    for (shift, code) in [("1e6", 0), ("1e12", 0), ("1e17", 1), ("1e300", 1), ("1e308", 1)] {
        let shift = format!("{shift},0,0");
        let draw = ["draw", "cube.obj", "--move", &shift, "-o", "far.svg"];
        let stderr = told(&folder, &draw, code);
        assert_eq!(stderr.contains("too large for a model of this size"), code == 1, "{stderr}");
        assert!(!stderr.contains("same point"), "{stderr}");
    }
}

#[test]
fn models_of_any_size_have_the_same_drawing() {
    let (_keep, folder) = with_files();
    let drawn = |scale: &str| {
        let draw = ["draw", "cube.obj", "--scale", scale, "-o", "sized.svg", "-q"];
        told(&folder, &draw, 0);
        let svg = fs::read_to_string(folder.join("sized.svg")).unwrap();
        svg.lines().filter(|line| line.starts_with("<path")).map(str::to_owned).collect::<Vec<_>>()
    };
    let expected = drawn("1");
    assert!(!expected.is_empty());
    // Powers of two change no digit.
    for exponent in [-480, -380, -200, 200, 400] {
        assert_eq!(drawn(&format!("{:e}", 2f64.powi(exponent))), expected, "2^{exponent}");
    }
    for scale in ["1e-160", "1e-300"] {
        let draw = ["draw", "cube.obj", "--scale", scale, "-o", "tiny.svg"];
        fails(&folder, &draw, 1, "too small for any drawing; scale the model up");
    }
}
