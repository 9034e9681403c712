//! `hiddenline surface`, one behavior a test.

use std::process::Output;

use serde_json::Value;
use tempfile::TempDir;

use super::{hiddenline, text};

fn run(folder: &TempDir, arguments: &[&str]) -> Output {
    hiddenline(folder.path(), &[&["surface"], arguments].concat())
}

/// A folder with one file `heights`.
fn with_file(content: impl AsRef<[u8]>) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("heights"), content).expect("written");
    folder
}

/// The strokes of a drawing, and which engine drew it.
fn drawn(folder: &TempDir, arguments: &[&str]) -> (Vec<Value>, String) {
    let axes = if arguments.contains(&"--title") { &[][..] } else { &["--no-axes"] };
    let output = run(folder, &[arguments, axes, &["--format", "json", "--stats"]].concat());
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {stderr}");
    let drawing: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let stats: Value = serde_json::from_str(stderr.lines().last().expect("a line")).expect("JSON");
    let strokes = drawing["strokes"].as_array().expect("strokes").clone();
    (strokes, stats["engine"].as_str().expect("a name").to_owned())
}

fn kinds(strokes: &[Value]) -> Vec<&str> {
    let mut kinds: Vec<&str> = strokes.iter().filter_map(|s| s["kind"].as_str()).collect();
    kinds.sort_unstable();
    kinds.dedup();
    kinds
}

/// The segments of exact strokes, in a fixed order.
fn segments(strokes: &[Value]) -> Vec<[f64; 4]> {
    let mut segments: Vec<[f64; 4]> = strokes
        .iter()
        .map(|stroke| {
            let at = |k: usize, i: usize| stroke["points"][k][i].as_f64().expect("a number");
            let (a, b) = ([at(0, 0), at(0, 1)], [at(1, 0), at(1, 1)]);
            let (a, b) = if a < b { (a, b) } else { (b, a) };
            [a[0], a[1], b[0], b[1]]
        })
        .collect();
    segments.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    segments
}

#[test]
fn roberts_by_choice_draws_what_max_min_draws() {
    let folder = with_file("");
    let formula = ["2*sin(x)*cos(1.3*y)", "--samples", "25x19", "--exact", "--eye", "9,-12,5"];
    let (by_grid, engine) = drawn(&folder, &formula);
    assert_eq!(engine, "max-min");
    let (by_mesh, engine) = drawn(&folder, &[&formula[..], &["--engine", "roberts"]].concat());
    assert_eq!(engine, "roberts");
    let length =
        |list: &[[f64; 4]]| -> f64 { list.iter().map(|s| (s[2] - s[0]).hypot(s[3] - s[1])).sum() };
    let (by_grid, by_mesh) = (segments(&by_grid), segments(&by_mesh));
    assert!(by_mesh.len() > 350, "{}", by_mesh.len());
    assert!((length(&by_grid) - length(&by_mesh)).abs() < 1e-9 * length(&by_mesh));
    assert!(by_grid.len() >= by_mesh.len());
}

#[test]
fn what_max_min_cannot_draw_goes_to_a_mesh_engine() {
    let folder = with_file("1 2 3\n2 nan 2\n1 1 0\n0 0 0\n1 0 1\n");
    for arguments in [
        &["--grid", "heights"][..],
        &["sqrt(r^2 - 9)", "--samples", "21"],
        &["x", "(-y)", "--samples", "9"],
        &["-x^2", "--samples", "9", "--lines", "x,levels", "--where", "abs(x) > 1"],
        &["x", "(-y)", "--samples", "9", "--lines", "silhouette,border"],
        &["--parametric", "cos(u)", "sin(u)", "v", "--samples", "7", "--lines", "mesh"],
    ] {
        let (strokes, engine) = drawn(&folder, arguments);
        assert!(["roberts", "appel"].contains(&engine.as_str()), "{arguments:?}: {engine}");
        assert!(!strokes.is_empty(), "{arguments:?}");
    }
}

#[test]
fn triangles_over_a_convex_domain_are_drawn_by_horizons() {
    let folder = with_file("0,0,0\n2,0,1\n2,2,0\n0,2,1\n1,1,3\n");
    for (arguments, expected) in [
        (&["-x^2", "--samples", "9", "--lines", "x,levels"][..], &["grid", "level"][..]),
        (&["x*y", "--samples", "9", "--lines", "border"], &["boundary"]),
        (&["x*y", "--samples", "9", "--where", "r < 4", "--lines", "both"], &["boundary", "grid"]),
        (&["--points", "heights"], &["mesh"]),
    ] {
        let (strokes, engine) = drawn(&folder, arguments);
        assert_eq!((kinds(&strokes), engine.as_str()), (expected.to_vec(), "max-min"));
        let roberts = [arguments, &["--exact", "--engine", "roberts"]].concat();
        let (by_mesh, _) = drawn(&folder, &roberts);
        let (by_horizons, _) = drawn(&folder, &[arguments, &["--exact"]].concat());
        let length = |strokes| -> f64 {
            segments(strokes).iter().map(|s| (s[2] - s[0]).hypot(s[3] - s[1])).sum()
        };
        let (found, expected) = (length(&by_horizons), length(&by_mesh));
        assert!((found - expected).abs() < 1e-9 * expected, "{arguments:?}: {found}, {expected}");
    }
}

#[test]
fn a_sheet_hides_the_one_below() {
    let folder = with_file("");
    let view = ["--view", "top", "--samples", "4", "--exact"];
    let (one, _) = drawn(&folder, &[&["0"][..], &view].concat());
    let (two, _) = drawn(&folder, &[&["0", "(-1 - x/100)"][..], &view].concat());
    assert_eq!(one.len(), 24);
    // Its border has the image of the upper one's, beside which nothing hides it.
    assert_eq!(two.len(), one.len() + 12, "{two:?}");
}

#[test]
fn scattered_points_are_drawn_as_triangles() {
    let folder = with_file("x,y,z\n0,0,0\n2,0,1\n2,2,0\n0,2,1\n1,1,3\n");
    let (strokes, engine) = drawn(&folder, &["--points", "heights", "--view", "top", "--exact"]);
    assert_eq!(engine, "max-min");
    assert_eq!((strokes.len(), kinds(&strokes)), (8, vec!["mesh"]));
    let levels = ["--points", "heights", "--lines", "levels", "--levels", "2,"];
    let (strokes, _) = drawn(&folder, &levels);
    assert_eq!(kinds(&strokes), ["level"]);
}

#[test]
fn height_files_of_other_programs_stand_where_they_say() {
    let esri =
        "ncols 3\nnrows 2\nxllcorner 10\nyllcorner 20\ncellsize 2\nNODATA_value -1\n4 5 6\n1 2 3\n";
    let mut npy = b"\x93NUMPY\x01\x00".to_vec();
    let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }\n";
    npy.extend((header.len() as u16).to_le_bytes());
    npy.extend(header.as_bytes());
    npy.extend([1.0, 2.0, 3.0, 4.0, 5.0, 6.0_f32].iter().flat_map(|z| z.to_le_bytes()));
    let mut picture = Vec::new();
    let mut encoder = png::Encoder::new(&mut picture, 3, 2);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let mut writer = encoder.write_header().expect("a header");
    let gray = [40000, 50000, 60000, 10000, 20000, 30000_u16];
    let bytes: Vec<u8> = gray.iter().flat_map(|z| z.to_be_bytes()).collect();
    writer.write_image_data(&bytes).expect("pixels");
    writer.finish().expect("an end");
    let camera = ["--eye", "0,0,90", "--target", "1,1,0", "--exact"];
    let given = ["--x", "11:15", "--y", "21:23"];
    let expected = {
        let folder = with_file("1 2 3\n4 5 6\n");
        segments(&drawn(&folder, &[&["--grid", "heights"], &camera[..], &given].concat()).0)
    };
    let check = |file: &[u8], more: &[&str]| {
        let folder = with_file(file);
        let (strokes, _) = drawn(&folder, &[&["--grid", "heights"], &camera[..], more].concat());
        let got = segments(&strokes);
        assert_eq!(got.len(), expected.len());
        for (a, b) in got.iter().zip(&expected) {
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12), "{a:?} {b:?}");
        }
    };
    check(esri.as_bytes(), &[]);
    check(&npy, &given);
    let mut tiff = b"II*\0\x08\0\0\0\x08\0".to_vec();
    let long = |tag: u16, kind: u16, value: u32| {
        let head = [tag.to_le_bytes(), kind.to_le_bytes()].concat();
        [&head[..], &1_u32.to_le_bytes(), &value.to_le_bytes()].concat()
    };
    // Width, height, 16 bits, not compressed, black is 0, where the rows begin, rows, bytes.
    for (tag, value) in
        [(256, 3), (257, 2), (258, 16), (259, 1), (262, 1), (273, 110), (278, 2), (279, 12)]
    {
        tiff.extend(long(tag, if tag == 273 || tag == 279 { 4 } else { 3 }, value));
    }
    tiff.extend([0; 4]);
    assert_eq!(tiff.len(), 110);
    tiff.extend(gray.iter().flat_map(|z| z.to_le_bytes()));
    check(&tiff, &[&given[..], &["--z-scale", "6.5535"]].concat());
    check(&picture, &[&given[..], &["--z-scale", "6.5535"]].concat());
}

#[test]
fn axes_have_ticks_and_letters_outside_of_the_surface() {
    let folder = with_file("");
    let (strokes, engine) = drawn(
        &folder,
        &["sin(x)*y", "--title", "A title", "--levels", "3", "--lines", "both,levels"],
    );
    assert_eq!(
        (kinds(&strokes), engine.as_str()),
        (vec!["axis", "grid", "level", "text", "title"], "max-min")
    );
    let (strokes, engine) = drawn(&folder, &["sin(x)*y", "--title", "A title"]);
    let expected = vec!["axis", "grid", "silhouette", "text", "title"];
    assert_eq!((kinds(&strokes), engine.as_str()), (expected, "max-min"));
    let of = |kind: &str| strokes.iter().filter(|s| s["kind"] == kind).count();
    // Three axes with about seven ticks each, and four or so between two of them.
    assert!((60..200).contains(&of("axis")) && of("text") > 20, "{} {}", of("axis"), of("text"));
}

#[test]
fn bad_input_is_told_in_one_line() {
    let folder = with_file("1 2 3\n4 5\n");
    let usage = |arguments: &[&str], message: &str| fails(&folder, arguments, 2, message);
    usage(&["sine(x)"], "column 1: unknown name `sine`; did you mean `sin`?");
    usage(&["x", "1 +"], "in formula 2 of 2, column");
    usage(&["x", "--x", "1:1"], "the two numbers must be different");
    usage(&["x", "--aspect", "4:3"], "expected box, data, or three lengths, as in 4:4:3");
    usage(&["x", "--axis-titles", "a,b"], "a comma in a title is written `\\,`");
    usage(&["x", "--tick-step", "1,,", "--ticks-pi", "x"], "are given for the same axis");
    usage(&["x", "--axes", "none", "--title", "T"], "also leaves out the title");
    fails(&folder, &["x", "--axes", "frame"], 1, "use --view top or other --axes");
    fails(&folder, &["x", "--log", "x"], 1, "use another range for --x or leave x out of --log");
    usage(&["x", "--samples", "0"], "at least 2 samples are needed");
    usage(&["x", "--samples", "1000000000"], "exceed the limit of 100000000");
    usage(&["x", "--samples", "1x5"], "at least 2 samples are needed");
    usage(&["x", "--lines", "levels", "--levels", "0"], "at least 1 level");
    usage(&["x", "--levels", "3"], "add levels to --lines");
    usage(&["x", "y", "1", "--engine", "max-min"], "use --engine roberts or auto");
    usage(&["--points", "heights", "--lines", "x"], "scattered points have no grid lines");
    let run = |arguments: &[&str], message: &str| fails(&folder, arguments, 1, message);
    run(&["1/0"], "no sample has a height");
    run(&["(x < 100) ? 0/0 : x"], "no sample has a height");
    run(&["x == 0 && y == 0 ? 1 : 0/0"], "no four neighboring samples");
    run(&["--grid", "heights"], "line 2: 2 cells, but the first row has 3");
    run(&["--grid", "missing"], "missing: No such file");
    for (content, message) in [
        (&b"1 2 3\n"[..], "1 sample makes no surface along y"),
        (b"1\n2\n", "1 sample makes no surface along x"),
        (b"nan nan\nnan nan\n", "no sample has a height"),
        (b"", "no heights in the file"),
        (b"\x93NUMPY\x01\x00\xff", "NPY: the file ends early"),
        (b"\x89PNG\r\n\x1a\n", "PNG: "),
        (b"II*\0\xff\xff\xff\xff", "TIFF: "),
        (b"ncols 2\nnrows 2\ncellsize 1\n1 2 3\n", "3 heights for 2 × 2 cells"),
        (b"\xff\xfe\x00", "not rows of numbers"),
    ] {
        fails(&with_file(content), &["--grid", "heights"], 1, message);
    }
    for (content, message) in [
        ("0 0 1\n1 1 1\n2 2 1\n", "3 points make no triangle"),
        (
            "0 0 1\n0 0 2\n1 1 1\n2 5 1\n",
            "heights:1 and heights:2 are both at x = 0, y = 0, with heights 1 and 2; use \
             --duplicates",
        ),
        ("0 0 1\n0 x 2\n", "line 2: expected the three numbers"),
    ] {
        fails(&with_file(content), &["--points", "heights"], 1, message);
    }
}

#[test]
fn a_domain_has_a_smooth_rim_that_is_drawn() {
    let folder = with_file("");
    let disc = ["0.1", "--where", "x^2+y^2<=4", "--x=-3:3", "--y=-3:3", "--samples", "13"];
    let view = ["--eye", "0,0,10", "--target", "0,0,0.1", "--aspect", "data"];
    let (strokes, engine) = drawn(&folder, &[&disc[..], &view].concat());
    assert_eq!(engine, "max-min");
    assert_eq!(kinds(&strokes), ["boundary", "grid"]);
    let mut n_rim = 0;
    for stroke in strokes.iter().filter(|stroke| stroke["kind"] == "boundary") {
        for point in stroke["points"].as_array().expect("points") {
            let (x, y) = (point[0].as_f64().expect("x"), point[1].as_f64().expect("y"));
            // The distance of the eye from the disc is 9.9.
            assert!((x.hypot(y) * 9.9 - 2.0).abs() < 1e-12, "{x} {y}");
            n_rim += 1;
        }
    }
    assert!(n_rim > 40, "{n_rim}");
    fails(&folder, &["x", "--where", "x <"], 2, "in --where, column");
    fails(&folder, &["x", "--where", "x > 9"], 1, "--where `x > 9` holds at none of 81 × 81");
}

#[test]
fn undersides_are_told_apart_by_both_kinds_of_engines() {
    let folder = with_file("");
    // The eye is below the hills' tops and above their feet.
    let hills = ["sin(2*x)*cos(1.7*y)", "--samples", "31x29", "--exact", "--underside"];
    let view = ["--eye", "4,-9,-1", "--target", "0,0,0"];
    let length_below = |engine: &str| -> (f64, f64) {
        let (strokes, _) = drawn(&folder, &[&hills[..], &view, &["--engine", engine]].concat());
        let (below, above): (Vec<_>, Vec<_>) =
            strokes.into_iter().partition(|stroke| stroke["side"] == "lower");
        let length = |list: &[Value]| -> f64 {
            segments(list).iter().map(|s| (s[2] - s[0]).hypot(s[3] - s[1])).sum()
        };
        (length(&below), length(&above))
    };
    let (below, above) = length_below("max-min");
    let (below_mesh, above_mesh) = length_below("appel");
    assert!(below > 0.1 && above > 0.1, "{below} {above}");
    assert!((below - below_mesh).abs() < 1e-6 * below, "{below} {below_mesh}");
    assert!((above - above_mesh).abs() < 1e-6 * above, "{above} {above_mesh}");
    let folder = with_file("");
    let plot = ["x", "--samples", "5", "--underside", "--elevation=-40", "--no-axes"];
    let svg = run(&folder, &plot).stdout;
    let svg = String::from_utf8(svg).expect("an SVG");
    assert!(svg.contains("2 underside"), "{svg}");
}

#[test]
fn lines_follow_the_function_as_closely_as_asked() {
    let folder = with_file("");
    let arc = ["sqrt(100 - x^2)", "--samples", "9", "--aspect", "data", "--lines", "x"];
    let n_points = |smoothness: &str| -> usize {
        let (strokes, _) = drawn(&folder, &[&arc[..], &["--smoothness", smoothness]].concat());
        strokes.iter().map(|s| s["points"].as_array().map_or(0, Vec::len)).sum()
    };
    let (rough, fine, finer) = (n_points("0"), n_points("0.1"), n_points("0.02"));
    assert!(rough < fine && fine < finer, "{rough} {fine} {finer}");
}

#[test]
fn what_the_near_plane_cuts_goes_to_a_mesh_engine() {
    let folder = with_file("");
    let near = ["0*x", "--samples", "9", "--eye", "0,0,1", "--target", "0,4,1", "--near", "0.1"];
    let (_, engine) = drawn(&folder, &[&near[..], &["--exact"]].concat());
    assert_ne!(engine, "max-min");
    let by_grid = [&near[..], &["--exact", "--engine", "max-min"]].concat();
    fails(&folder, &by_grid, 1, "the near plane cuts the surface");
}

fn fails(folder: &TempDir, arguments: &[&str], code: i32, message: &str) {
    let output = run(folder, arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
    assert!(stderr.contains(message), "{arguments:?}: {stderr}");
    assert!(output.stdout.is_empty());
}

#[test]
fn what_is_too_large_to_draw_is_told_before_work_begins() {
    let folder = with_file("-1e308 1e308\n1e308 -1e308\n");
    let run = |arguments: &[&str], message: &str| fails(&folder, arguments, 1, message);
    run(&["x", "--samples", "10000", "--lines", "levels"], "has 199960002 triangles");
    run(&["x", "--lines", "levels", "--levels", "65535"], "use fewer --samples or --levels");
    run(&["x*1e308"], "too far apart to draw");
    run(&["--grid", "heights"], "too far apart to draw");
    run(&["x*1e300", "--aspect", "data", "--z-scale", "1e10"], "too large to draw");
}

#[test]
fn lines_off_the_function_and_lines_that_flow_together_are_told() {
    let folder = with_file("");
    let warnings = |arguments: &[&str]| {
        let output = run(&folder, &[arguments, &["-o", "out.svg"]].concat());
        assert!(output.status.success());
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let off = warnings(&["sin(40*x)", "--aspect", "data", "--z-scale", "2", "--lines", "x"]);
    assert!(off.contains("pieces of lines are not certified, first near ("), "{off}");
    let smooth = warnings(&["x*y"]);
    assert!(!smooth.contains("not certified"), "{smooth}");
    let crowded = warnings(&["x*y", "--samples", "600", "--smoothness", "0"]);
    assert!(crowded.contains("lines run into each other; --every "), "{crowded}");
    let every = crowded.split("--every ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
    let thinned = warnings(&["x*y", "--samples", "600", "--smoothness", "0", "--every", every]);
    assert!(!thinned.contains("run into each other"), "{thinned}");
}

#[test]
fn max_min_by_choice_draws_more_than_grid_lines() {
    let folder = with_file("nan 1 2\n3 4 5\n6 7 8\n");
    let lines = ["sin(x)*cos(y)", "--lines", "both,levels,border,silhouette"];
    let chosen = drawn(&folder, &[&lines[..], &["--engine", "max-min"]].concat());
    assert_eq!(chosen, drawn(&folder, &lines));
    assert_eq!(chosen.1, "max-min");
    let message = "max-min draws one surface z = f(x, y) without holes";
    fails(&folder, &["--grid", "heights", "--engine", "max-min"], 1, message);
}

#[test]
fn sheets_show_where_they_cross() {
    let folder = with_file("");
    // Across cells, and along edges of both sheets.
    for samples in ["4", "5"] {
        let (strokes, _) = drawn(
            &folder,
            &["x", "(-x)", "--samples", samples, "--lines", "intersection", "--view", "top"],
        );
        let [stroke] = &strokes[..] else { panic!("{samples} samples: {strokes:?}") };
        let points = stroke["points"].as_array().expect("points");
        let ends =
            [0, points.len() - 1].map(|k| [0, 1].map(|i| points[k][i].as_f64().expect("a number")));
        assert!(ends.iter().all(|end| end[0].abs() < 1e-12), "{samples} samples: {ends:?}");
        let length = (ends[0][1] - ends[1][1]).abs();
        assert!((length - 10.0).abs() < 1e-12, "{samples} samples: {length}");
    }
}

#[test]
fn both_orders_of_cells_give_the_same_drawing() {
    let folder = with_file("");
    let formula = ["2*sin(x)*cos(1.3*y)", "--samples", "31x19", "--exact", "--eye", "9,-12,5"];
    let by = |order| {
        let (strokes, engine) = drawn(&folder, &[&formula[..], &["--order", order]].concat());
        assert_eq!(engine, "max-min");
        segments(&strokes)
    };
    let (rows, cantor) = (by("rows"), by("cantor"));
    assert!(rows.len() > 100 && rows.len() == cantor.len());
    for (one, other) in rows.iter().zip(&cantor) {
        assert!(one.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-9), "{one:?}, {other:?}");
    }
    let with_order = |more: &[&str]| run(&folder, &[&formula[..], more].concat());
    let refused = with_order(&["--order", "cantor", "--engine", "roberts"]);
    assert_eq!(refused.status.code(), Some(2));
    let refused = with_order(&["--order", "cantor", "--lines", "levels"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("--order needs one surface"));
}

#[test]
fn a_sphere_of_two_sheets_is_drawn_by_max_min_as_by_roberts() {
    let folder = with_file("");
    let sheets = ["sqrt(1-x^2-y^2)", "(-sqrt(1-x^2-y^2))", "--x=-1.2:1.2", "--y=-1.2:1.2"];
    for domain in [&["--where", "r<=1"][..], &[]] {
        let ball =
            [&sheets[..], &["--samples", "16", "--exact", "--eye", "4,-3,2"], domain].concat();
        let (by_horizons, engine) = drawn(&folder, &ball);
        assert_eq!(engine, "max-min", "{domain:?}");
        let (by_roberts, engine) = drawn(&folder, &[&ball[..], &["--engine", "roberts"]].concat());
        assert_eq!(engine, "roberts");
        let length = |strokes: &[Value]| {
            let of = |s: &[f64; 4]| (s[0] - s[2]).hypot(s[1] - s[3]);
            segments(strokes).iter().map(of).sum::<f64>()
        };
        let (found, expected) = (length(&by_horizons), length(&by_roberts));
        assert!((found - expected).abs() < 1e-9 * expected, "{found}, {expected}");
        let output = run(&folder, &[&ball[..], &["--format", "json"]].concat());
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        let lines = told.lines().filter(|line| line.contains("moved to the mean height"));
        assert_eq!(lines.count(), 1, "{told}");
    }
    // Seen from inside, or with a gap along the rim, it is no work for max-min.
    let refuses = |sheets: &[&str], more: &[&str]| {
        let few = ["--samples", "9", "--exact", "--engine", "max-min"];
        run(&folder, &[sheets, &few, more].concat()).status.code() == Some(1)
    };
    assert!(refuses(&sheets, &["--eye", "0.1,0,0.2"]));
    assert!(refuses(&["sqrt(1-r^2)+1", "(-sqrt(1-r^2))", "--where", "r<=1"], &["--eye", "4,-3,2"]));
}

/// The ink of a drawing, in millimeters.
fn ink_mm(folder: &TempDir, arguments: &[&str]) -> f64 {
    let output = run(folder, &[arguments, &["--no-axes", "--stats", "-o", "out.svg"]].concat());
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {stderr}");
    let stats: Value = serde_json::from_str(stderr.lines().last().expect("a line")).expect("JSON");
    stats["plot"]["after"]["down_m"].as_f64().expect("a number") * 1000.0
}

#[test]
fn the_zero_curve_of_a_saddle_is_a_cross() {
    let folder = with_file("");
    let lines = ["--lines", "levels", "--levels", "0,", "--labels", "none", "--view", "top"];
    for samples in ["40", "41", "40x80", "7x41"] {
        let cross = [&["x*y"][..], &lines, &["--samples", samples]].concat();
        let found = ink_mm(&folder, &cross);
        assert!((found - 380.0).abs() < 0.05, "{samples}: {found}");
    }
    // A plateau of whole numbers is outlined once: 4 × 2 cells of 7 × 4, which are 277 mm wide on A4.
    let zeros = "0 0 0 0 0 0 0 0\n";
    let ones = "0 1 1 1 1 1 0 0\n";
    let folder = with_file([zeros, ones, ones, ones, zeros].concat());
    let levels = ["--grid", "heights", "--lines", "levels", "--levels", "1,", "--view", "top"];
    let levels = [&levels[..], &["--labels", "none"]].concat();
    let found = ink_mm(&folder, &levels);
    assert!((found - 12.0 * 277.0 / 7.0).abs() < 0.05, "{found}");
}

#[test]
fn height_files_tell_what_is_odd_about_them() {
    let warned = |content: &str, arguments: &[&str], message: &str| {
        let folder = with_file(content);
        let output = run(&folder, &[arguments, &["-o", "out.svg"]].concat());
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments:?}: {stderr}");
        assert!(stderr.contains(message), "{arguments:?}: {stderr}");
    };
    let grid = ["--grid", "heights"];
    let list: String = (0..20).map(|k| format!("{} {} {}\n", k % 5, k / 5, k * k % 7)).collect();
    warned(&list, &grid, "if so, use --points heights instead of --grid heights");
    warned("some words\n1 2\n3 4\n", &grid, "1 line before the first row of numbers was skipped");
    let points = "0 0 1\n2 0 1\n0 0 3\n0 2 -\n0 2 1\n";
    let arguments = |duplicates| ["--points", "heights", "--duplicates", duplicates];
    let message = "left out 1 point at the place of another and 1 point without a height";
    for duplicates in ["first", "mean", "max"] {
        warned(points, &arguments(duplicates), message);
    }
    let clash = "heights:1 and heights:3 are both at x = 0, y = 0, with heights 1 and 3";
    fails(&with_file(points), &arguments("error"), 1, clash);
    fails(&with_file(""), &["x", "--nodata", "1"], 2, "--nodata");
    fails(&with_file(""), &["x", "--duplicates", "max"], 2, "--duplicates");
    fails(&with_file(""), &["x", "--flip-y"], 2, "--flip-y");
    // A pit that is no pit.
    let pit = "1 2 3\n4 -99 6\n7 8 9\n0 0 0\n1 1 1\n";
    let (with, _) = drawn(&with_file(pit), &["--grid", "heights", "--nodata=-99", "--exact"]);
    let (without, _) = drawn(&with_file(pit), &["--grid", "heights", "--exact"]);
    assert!(with.len() < without.len());
}

#[test]
fn formulas_may_begin_with_a_minus_wherever_they_stand() {
    let folder = with_file("");
    for arguments in [
        &["x", "-x^2"][..],
        &["-x", "-y", "--lines", "both"],
        &["--samples", "9", "-x", "--x=-2:2", "-y^2"],
        &["--exact", "x", "-o", "first.svg", "-sin(x)"],
    ] {
        let rest: &[&str] = if arguments.contains(&"-o") { &[] } else { &["-o", "out.svg"] };
        let output = run(&folder, &[arguments, rest].concat());
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments:?}: {stderr}");
        assert!(stderr.contains(", -"), "both formulas are sheets: {stderr}");
    }
    let output = run(&folder, &["x", "-nope", "-o", "out.svg"]);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(stderr.contains("unknown name `nope`"), "{stderr}");
}

#[test]
fn levels_have_a_round_step_or_one_that_is_given() {
    let folder = with_file("");
    for (levels, n) in
        [(&["--levels"][..], 10), (&["--levels", "every:2.5"], 4), (&["--levels", "every:2:1"], 5)]
    {
        let (strokes, _) =
            drawn(&folder, &[&["x", "--lines", "levels", "--labels", "none"], levels].concat());
        let found = strokes
            .iter()
            .filter(|stroke| {
                ["level", "index"].contains(&stroke["kind"].as_str().unwrap_or_default())
            })
            .count();
        assert_eq!(found, n, "{levels:?}");
    }
}

#[test]
fn pens_are_chosen_by_sheet_and_kind_and_folds_have_only_the_pen_of_folds() {
    let folder = with_file("");
    let layers = |pens: &[&str]| -> Vec<String> {
        let base = ["sin(x)*cos(y)", "x/4", "--x=-3:3", "--y=-3:3", "--samples", "21", "--lines"];
        let base = [&base[..], &["both,levels,silhouette", "--levels", "5", "--no-axes"]].concat();
        let pens = pens.iter().flat_map(|pen| ["--pen", pen]);
        let arguments: Vec<&str> = base.into_iter().chain(pens).chain(["-o", "out.svg"]).collect();
        let output = run(&folder, &arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let svg = std::fs::read_to_string(folder.path().join("out.svg")).expect("a drawing");
        let label = |part: &str| part.split('"').next().unwrap_or_default().to_owned();
        svg.split("inkscape:label=\"").skip(1).map(label).collect()
    };
    let found = layers(&["sheet2=2", "sheet1.level=3", "y=4", "silhouette=5", "visible=1"]);
    for name in ["visible", "sheet2", "sheet1.level", "y", "silhouette"] {
        assert!(found.iter().any(|label| label.contains(name)), "{name}: {found:?}");
    }
    let output = run(&folder, &["x", "--pen", "sheet2=2", "--pen", "level=3", "-o", "out.svg"]);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(
        stderr.contains("--pen sheet2=… draws nothing")
            && stderr.contains("--pen level=… draws nothing"),
        "{stderr}"
    );
}

#[test]
fn heights_outside_a_range_are_cut_off() {
    let folder = tempfile::tempdir().unwrap();
    let run = |more: &[&str]| hiddenline(folder.path(), &[&["surface"], more].concat());
    let cut =
        run(&["1/(x^2+y^2-4)", "--x", "-4:4", "--y", "-4:4", "--z", "-2:2", "-o", "ring.svg"]);
    assert!(cut.status.success(), "{}", text(&cut.stderr));
    assert!(!text(&cut.stderr).contains("grows"), "{}", text(&cut.stderr));
    let empty = run(&["x+y", "--z", "20:30", "-o", "none.svg"]);
    assert_eq!(empty.status.code(), Some(1));
    assert!(text(&empty.stderr).contains("heights from -10 to 10: none is within --z"));
    assert!(!folder.path().join("none.svg").exists());
    let drawn = |more: &[&str]| {
        let output = run(&[&["x+y", "--samples", "9", "-o", "a.svg"], more].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let svg = std::fs::read_to_string(folder.path().join("a.svg")).unwrap();
        (svg, text(&output.stderr))
    };
    let (svg, said) = drawn(&["--z", "3:1", "--pen", "cut=2"]);
    assert!(svg.contains("cut") && !said.contains("warning"), "{said}");
    let (_, said) = drawn(&["--z", "1:3", "--z-outside", "clamp", "--pen", "cut=2"]);
    assert!(said.contains("--pen cut=… draws nothing"), "{said}");
    let (_, said) = drawn(&["--z-outside", "clamp"]);
    assert!(said.contains("--z-outside has no effect without --z"), "{said}");
    let none = run(&["x+y", "--z", "3:3"]);
    assert!(text(&none.stderr).contains("the two numbers must be different"));
}
