//! `--set` for formulas, and `--view-height` for the page.

use std::fs;
use std::path::Path;

use hiddenline::stages::surface::formula::{Formula, Parameter, ParameterError, Variables};

use super::{CUBE, assert_fails, hiddenline, text};

/// What `surface` writes as JSON.
fn drawn(folder: &Path, arguments: &[&str]) -> Vec<u8> {
    let all = [&["surface", "--samples", "9", "--format", "json"], arguments].concat();
    let output = hiddenline(folder, &all);
    assert!(output.status.success(), "{}", text(&output.stderr));
    output.stdout
}

#[test]
fn a_parameter_is_the_number_that_it_stands_for() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = |arguments: &[&str]| drawn(folder.path(), arguments);
    let in_numbers = drawn(&["1.5*sin(x)-(-0.25)*y", "--where", "x<1.5"]);
    let set = ["--set", "a=1.5", "--set", "off_set2=-1/4"];
    let named = drawn(&[&["a*sin(x)-off_set2*y", "--where", "x<a"][..], &set].concat());
    assert!(in_numbers == named);
    let ring = ["--u=0:6", "--parametric", "3*cos(u)", "3*sin(u)", "v"];
    let named = ["--u=0:6", "--set=Q=3", "--parametric", "Q*cos(u)", "q*sin(u)", "v"];
    assert!(drawn(&ring) == drawn(&named));
    // `fill` and `preview` take it, too.
    for command in ["fill", "preview"] {
        let picture = |arguments: &[&str]| {
            let size =
                if command == "preview" { &["--size", "40x30"][..] } else { &["--png-width=40"] };
            let all = [&[command, "--samples", "9", "-o", "a.png"], size, arguments].concat();
            let output = hiddenline(folder.path(), &all);
            assert!(output.status.success(), "{}", text(&output.stderr));
            fs::read(folder.path().join("a.png")).unwrap()
        };
        assert!(
            picture(&["--expr", "2*x"]) == picture(&["--expr", "k*x", "--set", "k=2"]),
            "{command}"
        );
    }
}

#[test]
fn each_value_of_a_parameter_is_a_sheet() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = |arguments: &[&str]| drawn(folder.path(), arguments);
    let sheets = drawn(&["1+sin(x)", "2+sin(x)", "3+sin(x)"]);
    assert!(sheets == drawn(&["a+sin(x)", "--for", "a=1,2,3"]));
    assert!(sheets == drawn(&["--for=a=1:3:1", "a+sin(x)"]));
    assert!(sheets == drawn(&["a+sin(x)+k", "--for", "a=1,2,3", "--set", "k=0"]));
    // Several multiply, the last one first, and formulas come one after the other.
    let product = drawn(&["1+3*x", "1+4*x", "2+3*x", "2+4*x", "-1", "-1", "-2", "-2"]);
    let lists = ["--for", "a=1,2", "--for", "b=3,4"];
    assert!(product == drawn(&[&["a+b*x", "-a"], &lists[..]].concat()));
    // Each sheet has its own domain.
    let where_ = drawn(&["--where", "x<1", "1+0*x"]);
    assert!(where_ == drawn(&["--where", "x<a", "a+0*x", "--for", "a=1"]));
    let both = drawn(&["--where", "x<a", "a+0*x", "--for", "a=1,2"]);
    for other in ["x<1", "x<2"] {
        assert!(both != drawn(&["--where", other, "a+0*x", "--for", "a=1,2"]), "{other}");
    }
}

#[test]
fn legends_name_sheets_by_formulas_values_or_names() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| {
        let all = [&["surface", "--samples", "9", "-o", "a.svg"], arguments].concat();
        let output = hiddenline(folder.path(), &all);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let svg = fs::read_to_string(folder.path().join("a.svg")).unwrap();
        // What was typed is in the file, too.
        let svg = svg.lines().filter(|line| !line.contains("surface")).collect::<Vec<_>>();
        (svg.join("\n"), text(&output.stderr))
    };
    let (named, _) = run(&["a*x", "--for", "a=1,-2", "--legend", "--names", "a = 1,a = −2"]);
    assert!(run(&["a*x", "--for", "a=1,-2", "--legend"]).0 == named);
    assert!(run(&["--legend", "a*x", "--for", "a=1,-2", "--names", "a = {a}"]).0 != named);
    let braces = ["--names", "a = {a}"];
    let (typed, _) = run(&[&["a*x", "--for", "a=1,pi/2", "--legend"], &braces[..]].concat());
    assert!(typed == run(&["a*x", "--for", "a=1,pi/2", "--legend=right"]).0);
    let (formulas, _) = run(&["-x^2*y", "x", "--legend", "--names", "−x²·y,x"]);
    assert!(run(&["-x^2*y", "x", "--legend"]).0 == formulas);
    assert!(run(&["-x^2*y", "x", "--legend", "left"]).0 != formulas);
    let (none, said) = run(&["-x^2*y", "x", "--legend", "none", "--names", "a,b"]);
    assert!(said.contains("--names has no effect without --legend"), "{said}");
    assert!(none == run(&["-x^2*y", "x"]).0);
    let fails = |arguments: &[&str], message: &str| {
        assert_fails(&hiddenline(folder.path(), &[&["surface"], arguments].concat()), 2, message);
    };
    fails(&["x", "y", "--names", "a,b,c"], "--names gives 3 names for 2 sheets");
    fails(&["x", "--for", "x=1,2"], "already has a meaning in formulas");
    fails(&["x", "--for", "a"], "as in a=1,2,3");
    fails(&["x", "--for", "a=1:2"], "from, to and step");
    fails(&["x", "--for", "a=1:0:1"], "do not lead from its first to its last value");
    fails(&["x", "--for", "a=1:33:1"], "more than 32");
    fails(&["x", "y", "--for", "a=1:17:1"], "--for makes 34 sheets; the limit is 32");
    fails(&["x", "--for", "a=1", "--for", "a=2"], "`a` is given two lists of values");
    fails(&["x", "--for", "a=1", "--set", "a=2"], "`a` is given by --set and by --for");
}

#[test]
fn a_parameter_must_not_hide_a_name_of_the_language() {
    for taken in [
        "x", "y", "r", "theta", "u", "v", "pi", "e", "tau", "nan", "sin", "min", "if", "and", "or",
        "not", "R", "Sin",
    ] {
        assert_eq!(Parameter::new(taken, 1.0), Err(ParameterError::Taken(taken.to_owned())));
    }
    for none in ["", " ", "2a", "a b", "a+b", "_a", "(", "a.b", "-"] {
        assert_eq!(
            Parameter::new(none, 1.0),
            Err(ParameterError::Name(none.to_owned())),
            "{none:?}"
        );
    }
    assert!(matches!(Parameter::new("a", f64::INFINITY), Err(ParameterError::NotFinite(_))));
    let omega = Parameter::new("ω", 2.0).unwrap();
    let formula = Formula::parse_with("ω*x", Variables::Plane, &[omega]).unwrap();
    assert_eq!(formula.value(3.0, 0.0), 6.0);
    assert!(Formula::parse("ω*x", Variables::Plane).is_err());
}

#[test]
fn wrong_parameters_are_bad_usage() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, message) in [
        (&["a*x", "--set", "a"][..], "as in a=2"),
        (&["a*x", "--set", "a=b"], "unknown name `b`"),
        (&["a*x", "--set", "a=1/0"], "not a finite number"),
        (&["a*x", "--set", "x=1"], "already has a meaning in formulas"),
        (&["a*x", "--set", "a=1", "--set", "a=2"], "--set gives `a` two values"),
        (&["a*x"], "unknown name `a`"),
        (&["--grid", "h.csv", "--set", "a=1"], "cannot be used with"),
    ] {
        assert_fails(&hiddenline(folder.path(), &[&["surface"], arguments].concat()), 2, message);
    }
}

#[test]
fn a_view_height_fills_the_page_between_the_margins_around_the_target() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    let drawn = |arguments: &[&str]| {
        let all =
            [&["draw", "cube.obj", "--page", "260x200", "--view-height", "4"], arguments].concat();
        let output = hiddenline(folder.path(), &[&all[..], &["--format", "json"]].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let drawing: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let map: Vec<f64> = serde_json::from_value(drawing["page_from_image"].clone()).unwrap();
        let mut points = Vec::new();
        for stroke in drawing["strokes"].as_array().unwrap() {
            let image: Vec<[f64; 2]> = serde_json::from_value(stroke["points"].clone()).unwrap();
            points.extend(image.iter().map(|[x, y]| [map[0] * x + map[4], map[3] * y + map[5]]));
        }
        let bound = |k: usize, f: fn(f64, f64) -> f64| {
            points.iter().map(|p: &[f64; 2]| p[k]).reduce(f).unwrap()
        };
        [bound(0, f64::min), bound(1, f64::min), bound(0, f64::max), bound(1, f64::max)]
    };
    let near = |found: [f64; 4], expected: [f64; 4]| {
        let worst = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-9, "{found:?}");
    };
    // 180 mm show 4 units: the cube of 2 units is 90 mm wide, in the middle of the page.
    near(drawn(&["--view", "front"]), [85.0, 55.0, 175.0, 145.0]);
    // Looking at its upper edge, that is in the middle.
    near(drawn(&["--view", "front", "--target", "0,0,1"]), [85.0, 100.0, 175.0, 190.0]);
    // In perspective the height counts at the target: the front, at half the distance, is twice as large.
    let near_front = ["--view", "front", "--projection", "perspective", "--distance", "2"];
    near(drawn(&near_front), [40.0, 10.0, 220.0, 190.0]);
    let both = ["draw", "cube.obj", "--view-height", "4", "--fit-fov"];
    assert_fails(&hiddenline(folder.path(), &both), 2, "cannot be used with");
    let zero = ["draw", "cube.obj", "--view-height", "0"];
    assert_fails(&hiddenline(folder.path(), &zero), 2, "must be above 0");
}
