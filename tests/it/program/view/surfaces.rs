//! Formulas on the page: their errors, parameters, and the command that is shown.

use serde_json::{Value, json};

use super::{Viewer, exact, shell_words, written_by};

#[test]
fn a_formula_is_drawn_as_surface_draws_it() {
    let viewer = Viewer::start(&["--expr", "sin(x)*cos(y)", "--samples=21", "--x=-3:3"]);
    let about = viewer.about();
    assert_eq!(about["command"], json!("surface"));
    assert_eq!(about["subjects"], json!(["sin(x)*cos(y)"]));
    assert_eq!(about["formulas"], json!(true));
    for options in [
        json!({ "samples": "21", "x": "-3:3" }),
        json!({ "expr": ["-x^2"], "lines": "levels,border", "levels": "5" }),
        json!({ "expr": ["x*y", "-x"], "samples": 11, "lines": "both,intersection", "title": "it's z" }),
        json!({ "expr": ["a*x+b"], "set": ["a=2*pi", "b=-1"], "samples": "5" }),
    ] {
        let reply = viewer.draw(&exact(options.clone()));
        let shown = reply.facts()["command"].as_str().unwrap().to_owned();
        assert_eq!(shell_words(&shown)[1], "surface");
        let asked = json!({ "camera": {}, "options": options, "format": "svg" });
        let saved = viewer.post("/api/file", asked.to_string().as_bytes()).body;
        assert!(saved == written_by(viewer.path(), &shown), "{shown}");
    }
}

#[test]
fn an_error_in_a_formula_has_its_character_and_the_next_formula_is_drawn() {
    let viewer = Viewer::start(&["--expr", "x", "--samples", "5"]);
    for (expr, index, column) in [
        (json!("x +"), 0, 4),
        (json!("2x"), 0, 2),
        (json!(["x", "sin(y"]), 1, 6),
        (json!("1 + sine(x)"), 0, 5),
    ] {
        let reply = viewer.draw(&exact(json!({ "expr": expr })));
        assert_eq!(reply.status, 422);
        let fault = reply.json();
        assert_eq!((&fault["option"], &fault["index"]), (&json!("expr"), &json!(index)));
        assert_eq!(fault["column"], json!(column), "{fault}");
        assert_eq!(fault["parameter"], Value::Null, "{fault}");
    }
    assert_eq!(viewer.draw(&exact(json!({ "expr": "x*y", "samples": 5 }))).status, 200);
}

#[test]
fn a_free_letter_is_told_as_a_parameter() {
    let viewer = Viewer::start(&["--expr", "x", "--samples", "5"]);
    let reply = viewer.draw(&exact(json!({ "expr": "a*sin(x)" })));
    assert_eq!(reply.json()["parameter"], json!("a"));
    let options = json!({ "expr": "a*sin(x)", "set": ["a=2"], "samples": 5 });
    let facts = viewer.draw(&exact(options)).facts();
    assert!(facts["command"].as_str().unwrap().contains("--set=a=2"), "{facts}");
    let clash = viewer.draw(&exact(json!({ "expr": "x", "set": ["x=2"] })));
    assert_eq!(clash.json()["option"], json!("set"));
}

#[test]
fn grids_points_and_parametric_surfaces_are_shown() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("h.csv"), "0,1,0\n1,2,1\n0,1,0\n").unwrap();
    std::fs::write(folder.path().join("p.xyz"), "0 0 0\n1 0 1\n0 1 2\n1 1 0\n.5 .4 3\n").unwrap();
    let path = folder.path().to_owned();
    let mut folder = Some(folder);
    for arguments in [
        &["--grid", "h.csv"][..],
        &["--points", "p.xyz"],
        &["--parametric", "cos(u)", "sin(u)", "v", "--u=0:6", "--samples=9"],
    ] {
        let keep = folder.take().unwrap_or_else(|| {
            let again = tempfile::tempdir().unwrap();
            for name in ["h.csv", "p.xyz"] {
                std::fs::copy(path.join(name), again.path().join(name)).unwrap();
            }
            again
        });
        let viewer = Viewer::start_in(keep, arguments);
        let asked = json!({ "page": "p", "want": "exact" });
        let facts = viewer.draw(&asked).facts();
        let shown = facts["command"].as_str().unwrap();
        assert!(written_by(viewer.path(), shown).starts_with(b"<svg"), "{shown}");
        let drag = viewer.draw(&json!({ "page": "p", "want": "drag" }));
        assert!(!drag.strokes::<3>().is_empty(), "{arguments:?}");
        // What names a file stays as it was typed.
        let other = viewer.draw(&exact(json!({ "grid": "other.csv" })));
        assert_eq!(other.status, 422);
        folder = Some(tempfile::tempdir().unwrap());
        let next = folder.as_ref().unwrap().path();
        for name in ["h.csv", "p.xyz"] {
            std::fs::copy(viewer.path().join(name), next.join(name)).unwrap();
        }
    }
}

#[test]
fn a_draft_of_a_surface_lies_on_it() {
    let viewer =
        Viewer::start(&["--expr", "x*y", "--samples", "11", "--aspect", "data", "--no-axes"]);
    let reply = viewer.draw(&json!({ "page": "p", "want": "drag" }));
    let target: Vec<f64> =
        serde_json::from_value(reply.facts()["camera"]["target"].clone()).unwrap();
    let points = reply.strokes::<3>().concat();
    assert!(points.len() > 50);
    for point in points {
        let [x, y, z] = [0, 1, 2].map(|k| point[k] + target[k]);
        // Grid lines of x·y are straight, so all of their points lie on the function.
        assert!((z - x * y).abs() < 1e-4, "{x} {y} {z}");
    }
}
