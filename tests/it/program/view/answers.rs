//! Drawings, drafts and files as the page gets them.

use std::collections::BTreeSet;
use std::fs;

use serde_json::{Value, json};

use super::{Viewer, exact, shell_words, written_by};

/// Options of every kind.
fn options() -> [Value; 4] {
    [
        json!({}),
        json!({ "hidden": "dashed", "page": "a3", "margin": "20", "crease": 45 }),
        json!({ "lines": "mesh", "pen": ["visible=1:0.5mm:red", "mesh=2:0.2mm"], "landscape": true }),
        json!({ "scale": ["2"], "rotate": "0,0,-30", "exact": true, "hidden": null, "landscape": false }),
    ]
}

#[test]
fn what_is_saved_has_the_bytes_of_the_command_that_is_shown() {
    let viewer = Viewer::start(&["cube.obj"]);
    let camera =
        json!({ "azimuth": "-12.5", "elevation": 33, "view-height": "2.5", "target": "0,0.5,0" });
    for options in options() {
        let mut asked = exact(options.clone());
        asked["camera"] = camera.clone();
        let shown = viewer.draw(&asked).facts()["command"].as_str().unwrap().to_owned();
        assert!(shown.contains("--azimuth=-12.5"), "{shown}");
        for format in ["svg", "pdf", "hpgl", "gcode", "dxf", "png", "json"] {
            let asked =
                json!({ "camera": camera, "options": options, "format": format, "page": "test" });
            let reply = viewer.post("/api/file", asked.to_string().as_bytes());
            let name = reply.facts()["name"].as_str().unwrap().to_owned();
            let shown = shown.replace("cube.svg", &name);
            assert!(reply.body == written_by(viewer.path(), &shown), "{format}: {shown}");
        }
    }
}

#[test]
fn the_page_shows_the_strokes_that_are_saved() {
    let viewer = Viewer::start(&["cube.obj"]);
    for options in options() {
        let reply = viewer.draw(&exact(options.clone()));
        let facts = reply.facts();
        let command = facts["command"].as_str().unwrap();
        let svg = String::from_utf8(written_by(viewer.path(), command)).unwrap();
        let document = roxmltree::Document::parse(&svg).unwrap();
        let paths = document.descendants().filter(|node| node.tag_name().name() == "path");
        let saved: Vec<Vec<f64>> = paths
            .map(|path| {
                let data = path.attribute("d").unwrap().replace(['M', 'L', 'Z', ','], " ");
                data.split_whitespace().map(|number| number.parse().unwrap()).collect()
            })
            .collect();
        let shown: Vec<Vec<f64>> =
            reply.strokes::<2>().into_iter().map(|stroke| stroke.concat()).collect();
        assert_eq!(saved.len(), shown.len(), "{command}");
        // Each group is a layer, in its pen.
        let layers = document.descendants().filter(|node| node.tag_name().name() == "g");
        let in_layer = |layer: roxmltree::Node| {
            layer.descendants().filter(|node| node.tag_name().name() == "path").count()
        };
        let counts: Vec<usize> = layers.clone().map(in_layer).collect();
        let firsts: Vec<usize> =
            (0..counts.len()).map(|layer| counts[..layer].iter().sum()).collect();
        let words = reply.words();
        assert_eq!(words[3] as usize, counts.len());
        let groups = words[6..6 + 4 * counts.len()].chunks(4);
        let found: Vec<usize> = groups.clone().map(|group| group[3] as usize).collect();
        assert_eq!(found, firsts, "{command}");
        for (group, layer) in groups.zip(layers) {
            let pen = &facts["pens"][group[0] as usize];
            assert_eq!(pen["color"].as_str(), layer.attribute("stroke"), "{pen}");
            let width = pen["width"].as_f64().unwrap().to_string();
            assert_eq!(Some(width.as_str()), layer.attribute("stroke-width"), "{pen}");
        }
        for (saved, shown) in saved.iter().zip(&shown) {
            // Closed strokes may repeat their first point or not.
            for (a, b) in saved.iter().zip(shown) {
                assert!((a - b).abs() < 0.001, "{a} {b} {command}");
            }
        }
        assert_eq!(facts["strokes"], json!(shown.len()));
        assert_eq!(facts["exact"], json!(true));
        let width = document.root_element().attribute("width").unwrap();
        assert_eq!(width, format!("{}mm", facts["page"]["width"].as_f64().unwrap()));
    }
}

#[test]
fn a_draft_has_the_visible_edges_of_the_cube_in_space() {
    let viewer = Viewer::start(&["cube.obj"]);
    for (camera, n_edges) in [
        (json!({ "azimuth": 30, "elevation": 25 }), 9.0),
        (json!({ "azimuth": 0, "elevation": 0 }), 4.0),
    ] {
        let asked =
            json!({ "seq": 5, "page": "p", "camera": camera, "options": {}, "want": "drag" });
        let reply = viewer.draw(&asked);
        assert_eq!(reply.words()[1], 5);
        let facts = reply.facts();
        let target = &facts["camera"]["target"];
        assert_eq!(*target, json!([0.0, 0.0, 0.0]));
        let mut length = 0.0;
        for stroke in reply.strokes::<3>() {
            for pair in stroke.windows(2) {
                let [a, b] = [pair[0], pair[1]];
                // Along an edge two coordinates are ±1 and stay.
                let fixed = (0..3)
                    .filter(|&k| (a[k].abs() - 1.0).abs() < 1e-6 && (a[k] - b[k]).abs() < 1e-6);
                assert_eq!(fixed.count(), 2, "{a:?} {b:?}");
                length += (0..3).map(|k| (a[k] - b[k]).abs()).sum::<f64>();
            }
        }
        assert!((length - 2.0 * n_edges).abs() < 1e-5, "{length}");
    }
}

#[test]
fn drafts_turn_into_the_exact_drawing() {
    let viewer = Viewer::start(&["cube.obj"]);
    let camera = json!({ "azimuth": 77.7, "elevation": -12, "fov": "50" });
    let mut asked = json!({ "page": "p", "camera": camera, "options": {}, "want": "drag" });
    let draft = viewer.draw(&asked);
    asked["want"] = json!("exact");
    let drawing = viewer.draw(&asked);
    let facts = draft.facts();
    assert_eq!(facts["camera"], drawing.facts()["camera"]);
    assert_eq!(facts["page"], drawing.facts()["page"]);
    let vector =
        |name: &str| -> Vec<f64> { serde_json::from_value(facts["camera"][name].clone()).unwrap() };
    let (eye, target, up) = (vector("eye"), vector("target"), vector("up"));
    let vec = |v: &[f64]| glam::DVec3::new(v[0], v[1], v[2]);
    let forward = (vec(&target) - vec(&eye)).normalize();
    let right = forward.cross(vec(&up)).normalize();
    let upward = right.cross(forward);
    let scale = facts["page"]["scale"].as_f64().unwrap();
    let origin: Vec<f64> = serde_json::from_value(facts["page"]["origin"].clone()).unwrap();
    let on_page = |p: &[f64; 3]| {
        let d = vec(p) + vec(&target) - vec(&eye);
        let (x, y) = (d.dot(right) / d.dot(forward), d.dot(upward) / d.dot(forward));
        [origin[0] + scale * x, origin[1] - scale * y]
    };
    let rounded = |[x, y]: [f64; 2]| ((x * 200.0).round() as i64, (y * 200.0).round() as i64);
    let near = |set: &BTreeSet<(i64, i64)>, (x, y): (i64, i64)| {
        (-1..=1).any(|dx| (-1..=1).any(|dy| set.contains(&(x + dx, y + dy))))
    };
    let exact: BTreeSet<_> = drawing.strokes::<2>().concat().into_iter().map(rounded).collect();
    let turned: BTreeSet<_> =
        draft.strokes::<3>().concat().iter().map(|p| rounded(on_page(p))).collect();
    assert!(exact.iter().all(|&p| near(&turned, p)), "{exact:?} {turned:?}");
    assert!(turned.iter().all(|&p| near(&exact, p)));
}

#[test]
fn the_page_is_told_every_option_of_draw_but_those_of_files() {
    let viewer =
        Viewer::start(&["cube.obj", "--hidden", "dashed", "--azimuth=40", "--pen=visible=3"]);
    let about = viewer.about();
    assert_eq!(about["command"], json!("draw"));
    assert_eq!(
        about["options"],
        json!({ "azimuth": "40", "hidden": "dashed", "pen": "visible=3" })
    );
    let controls = about["controls"].as_array().unwrap();
    let names: BTreeSet<&str> = controls.iter().map(|c| c["name"].as_str().unwrap()).collect();
    let help = crate::program::hiddenline(viewer.path(), &["draw", "--help"]).stdout;
    let help = String::from_utf8(help).unwrap();
    let mut group = String::new();
    let mut n_found = 0;
    for line in help.lines() {
        if let Some(heading) = line.strip_suffix(':').filter(|line| !line.starts_with(' ')) {
            group = heading.to_owned();
        }
        let line = line.trim_start();
        let line = line.split_once(", --").map_or(line, |(_, long)| long);
        let Some(name) = line.strip_prefix("--").or((line != line.trim_start()).then_some(line))
        else {
            continue;
        };
        let name = name.split([' ', '=', '[', '.']).next().unwrap();
        let is_of_files = [
            "output",
            "format",
            "threads",
            "stats",
            "quiet",
            "verbose",
            "strict",
            "preset",
            "help",
            "color",
            "gcode-profile",
            "camera",
            "turntable",
            "views",
            "each",
            "list",
            "shard",
            "skip-existing",
            "keep-going",
        ]
        .contains(&name);
        assert_eq!(names.contains(name), !is_of_files, "--{name}");
        if let Some(control) = controls.iter().find(|c| c["name"] == name) {
            assert_eq!(control["group"], json!(group), "--{name}");
            n_found += 1;
        }
    }
    assert!(n_found > 30, "{n_found}");
    let of = |name: &str| controls.iter().find(|c| c["name"] == name).unwrap();
    assert_eq!(of("landscape")["kind"], json!("flag"));
    assert_eq!(of("crease")["kind"], json!("number"));
    assert_eq!(of("crease")["default"], json!("30"));
    assert_eq!(of("view")["kind"], json!("choice"));
    assert_eq!(of("pen")["kind"], json!("texts"));
}

#[test]
fn what_the_page_asks_for_is_in_the_command_and_on_the_paper() {
    let viewer = Viewer::start(&["cube.obj", "--margin", "15", "--landscape"]);
    let asked = json!({ "margin": "20", "pen": ["visible=3:0.7mm:red"], "hidden": "solid", "crease": "30" });
    let facts = viewer.draw(&exact(asked)).facts();
    // Defaults are left out, and so is what the page has turned off.
    let expected =
        "hiddenline draw cube.obj --hidden=solid --margin=20 --pen=visible=3:0.7mm:red -o cube.svg";
    assert_eq!(facts["command"], json!(expected));
    assert_eq!(facts["page"]["margin"], json!(20.0));
    assert_eq!(facts["pens"][0]["number"], json!(1), "{}", facts["pens"]);
    let pens = facts["pens"].as_array().unwrap();
    let visible = pens.iter().find(|pen| pen["name"] == "visible").unwrap();
    assert_eq!(
        *visible,
        json!({ "number": 3, "name": "visible", "width": 0.7, "color": "#ff0000" })
    );
    // Without options of its own, a page is shown what was typed.
    let typed = viewer.draw(&json!({ "page": "p", "want": "exact" })).facts();
    assert_eq!(typed["page"]["margin"], json!(15.0));
    assert!(typed["command"].as_str().unwrap().contains("--landscape"));
}

#[test]
fn an_option_with_a_wrong_value_is_named() {
    let viewer = Viewer::start(&["cube.obj"]);
    for (options, option, error) in [
        (json!({ "crease": "x" }), "crease", "not a number"),
        (json!({ "page": "a99" }), "page", "not a paper size"),
        (json!({ "hidden": "dotted" }), "hidden", "dotted"),
    ] {
        let reply = viewer.draw(&exact(options));
        assert_eq!(reply.status, 422);
        assert_eq!(reply.json()["option"], json!(option));
        let message = reply.json()["error"].as_str().unwrap().to_owned();
        assert!(message.contains(error), "{message}");
        assert!(!message.contains("--help") && !message.starts_with("error"), "{message}");
    }
    let reply = viewer.draw(&exact(json!({ "margin": "300" })));
    assert!(reply.json()["error"].as_str().unwrap().contains("no room"), "{}", reply.json());
    assert_eq!(viewer.draw(&exact(json!({ "sideways": "1" }))).status, 422);
}

#[test]
fn requests_that_are_none_are_refused_and_the_next_is_answered() {
    let viewer = Viewer::start(&["cube.obj"]);
    let deep = "[".repeat(60_000);
    for body in [
        "{",
        "[]",
        "null",
        "7",
        "\"x\"",
        "{\"seq\": -1}",
        "{\"x\": 1}",
        "{\"seq\": 1e99}",
        &deep,
        "\u{0}",
    ] {
        assert_eq!(viewer.post("/api/draw", body.as_bytes()).status, 400, "{body:.20}");
    }
    assert_eq!(viewer.post("/api/draw", b"\xff\xfe").status, 400);
    assert_eq!(viewer.post("/api/draw", b"").status, 400);
    assert_eq!(viewer.post("/api/draw", b"{}").status, 400);
    assert_eq!(viewer.post("/api/file", b"{\"format\": \"doc\"}").status, 400);
    for options in [
        json!([]),
        json!({ "crease": {} }),
        json!({ "crease": [1, [2]] }),
        json!({ "landscape": "x" }),
    ] {
        assert_eq!(viewer.draw(&exact(options.clone())).status, 422, "{options}");
    }
    assert_eq!(viewer.raw(b"\r\n\r\nnonsense\r\n\r\n").status, 400);
    assert_eq!(viewer.draw(&exact(json!({}))).status, 200);
}

#[test]
fn a_double_click_finds_the_point_of_the_surface() {
    let viewer = Viewer::start(&["cube.obj"]);
    let mut asked = exact(json!({ "page": "200x200" }));
    asked["camera"] = json!({ "view": "front" });
    // The front of the cube is y = -1; from margin to margin it is 180 mm wide.
    asked["pick"] = json!([145.0, 55.0]);
    let picked: Vec<f64> =
        serde_json::from_value(viewer.draw(&asked).facts()["picked"].clone()).unwrap();
    for (found, expected) in picked.iter().zip([0.5, -1.0, 0.5]) {
        assert!((found - expected).abs() < 1e-9, "{picked:?}");
    }
    asked["pick"] = json!([5.0, 5.0]);
    assert_eq!(viewer.draw(&asked).facts()["picked"], Value::Null);
}

#[test]
fn a_dropped_model_is_shown_and_a_broken_one_is_not() {
    let viewer = Viewer::start(&["cube.obj", "--scale", "2"]);
    let mut events = viewer.events("other");
    assert_eq!(events.next().unwrap()["event"], json!("hello"));
    let tetrahedron = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    assert_eq!(viewer.post("/api/model?name=bad.stl", b"solid").status, 422);
    assert_eq!(viewer.post("/api/model?name=", tetrahedron.as_bytes()).status, 400);
    let command = |viewer: &Viewer| {
        viewer.draw(&exact(json!({}))).facts()["command"].as_str().unwrap().to_owned()
    };
    assert!(command(&viewer).contains("cube.obj"));
    let reply = viewer.post("/api/model?name=..%2Ft%C3%A9tra%20.obj", tetrahedron.as_bytes());
    assert_eq!(reply.status, 200, "{}", reply.json());
    assert_eq!(events.next().unwrap()["event"], json!("shown"));
    let shown = command(&viewer);
    assert_eq!(shell_words(&shown)[2], "tétra .obj");
    assert!(!shown.contains("scale"), "{shown}");
    // In a folder that has the file, the command writes the same.
    let asked = json!({ "camera": {}, "options": {}, "format": "svg" });
    let saved = viewer.post("/api/file", asked.to_string().as_bytes()).body;
    fs::write(viewer.path().join("tétra .obj"), tetrahedron).unwrap();
    assert!(saved == written_by(viewer.path(), &shown), "{shown}");
}

#[test]
fn curved_and_hatched_drawings_are_saved_as_their_commands_draw_them() {
    let folder = tempfile::tempdir().unwrap();
    // A cylinder of twelve sides.
    let mut cylinder = String::new();
    for k in 0..12 {
        let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 12.0).sin_cos();
        cylinder += &format!("v {cos} {sin} 0\nv {cos} {sin} 2\n");
    }
    for k in 0..12 {
        let (a, b) = (2 * k + 1, 2 * ((k + 1) % 12) + 1);
        cylinder += &format!("f {a} {b} {} {}\n", b + 1, a + 1);
    }
    let top: Vec<String> = (0..12).map(|k| (2 * k + 2).to_string()).collect();
    cylinder += &format!("f {}\n", top.join(" "));
    fs::write(folder.path().join("round.obj"), cylinder).unwrap();
    let viewer = Viewer::start_in(folder, &["round.obj"]);
    for options in
        [json!({ "smooth": "40" }), json!({ "hatch": "straight" }), json!({ "hatch": true })]
    {
        let mut asked = exact(options.clone());
        let before = viewer.draw(&exact(json!({}))).facts();
        let facts = viewer.draw(&asked).facts();
        assert_ne!((&before["strokes"], &before["meters"]), (&facts["strokes"], &facts["meters"]));
        asked = json!({ "camera": {}, "options": options, "format": "svg" });
        let saved = viewer.post("/api/file", asked.to_string().as_bytes()).body;
        let shown = facts["command"].as_str().unwrap();
        assert!(saved == written_by(viewer.path(), shown), "{shown}");
    }
}
