//! `hiddenline fill` as a program.

use std::path::Path;
use std::process::Output;

use super::{hiddenline, text};
use crate::models::SPOT;

pub(crate) fn fill(arguments: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    hiddenline(folder.path(), &[&["fill"], arguments].concat())
}

#[test]
fn the_svg_has_an_area_for_each_face_below_the_lines() {
    let output = fill(&[SPOT, "--up-axis", "y", "--stats"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let svg = text(&output.stdout);
    let document = roxmltree::Document::parse(&svg).unwrap();
    let layers: Vec<_> = document
        .descendants()
        .filter(|node| {
            node.attribute(("http://www.inkscape.org/namespaces/inkscape", "groupmode")).is_some()
        })
        .collect();
    let ids: Vec<_> = layers.iter().filter_map(|layer| layer.attribute("id")).collect();
    assert_eq!(ids, ["pen1-fills", "pen2-visible"]);
    let areas: Vec<_> = layers[0].children().filter(|node| node.is_element()).collect();
    assert!(areas.len() > 1000);
    assert!(areas.iter().all(|area| area.attribute("fill") == area.attribute("stroke")));
    assert!(layers[1].children().all(|line| line.attribute("fill").is_none()));
    let stats: serde_json::Value =
        serde_json::from_str(text(&output.stderr).lines().last().unwrap()).unwrap();
    assert_eq!(stats["engine"], "weiler-atherton");
    assert_eq!(stats["triangles"], 5856);
}

#[test]
fn every_engine_fills_and_draws_no_edges_when_told() {
    let engines = ["auto", "depth-sort", "bsp", "octree", "warnock", "weiler-atherton"];
    for engine in engines {
        let output =
            fill(&[SPOT, "--up-axis", "y", "--engine", engine, "--no-edges", "--leaf", "1"]);
        assert!(output.status.success(), "{engine}: {}", text(&output.stderr));
        let svg = text(&output.stdout);
        assert!(svg.contains("pen1-fills") && !svg.contains("visible"), "{engine}");
    }
}

#[test]
fn each_ink_is_a_layer_and_cutters_get_no_outline() {
    let arguments = [SPOT, "--palette", "navy,rgb(230,120,30),ivory", "--seam", "0", "--no-edges"];
    let output = fill(&arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let svg = text(&output.stdout);
    for ink in ["pen1-ink1", "pen2-ink2", "pen3-ink3"] {
        assert!(svg.contains(ink), "{ink}");
    }
    assert!(svg.contains("fill=\"#e6781e\" fill-rule=\"evenodd\" stroke=\"none\""));
}

#[test]
fn a_turntable_makes_numbered_files_of_one_scale() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("turn.svg");
    let name = file.to_str().unwrap();
    let output = fill(&[SPOT, "--up-axis", "y", "--turntable", "3", "--engine", "bsp", "-o", name]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let pictures: Vec<String> = (1..=3)
        .map(|k| std::fs::read_to_string(folder.path().join(format!("turn-00{k}.svg"))).unwrap())
        .collect();
    assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2]);
    assert!(!file.exists());
    assert_eq!(fill(&[SPOT, "--turntable", "3"]).status.code(), Some(2));
}

#[test]
fn what_cannot_be_filled_is_refused_and_leaves_files_alone() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("kept.svg");
    std::fs::write(&file, "kept").unwrap();
    let name = file.to_str().unwrap();
    for (arguments, code, message) in [
        (vec![SPOT, "--no-edges", "--format", "hpgl", "-o", name], 2, "no filled areas"),
        (vec![SPOT, "--palette", "0", "-o", name], 2, "from 1 to 64 inks"),
        (vec![SPOT, "--palette", "nocolor", "-o", name], 2, "is not a color"),
        (vec![SPOT, "--palette", "3", "--debug", "order", "-o", name], 2, "cannot be used"),
        (vec![SPOT, "--engine", "warnock", "--leaf", "0.001", "-o", name], 1, "too many"),
        (vec!["missing.obj", "-o", name], 1, "missing.obj"),
        (vec![SPOT, "--margin", "500", "-o", name], 1, "margin"),
    ] {
        let output = fill(&arguments);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        let error = text(&output.stderr);
        assert!(error.contains(message), "{arguments:?}: {error}");
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "kept", "{arguments:?}");
    }
}

#[test]
fn materials_have_the_colors_of_their_file() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl other\nKd 0 1 0\n");
    write(
        "a.obj",
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n\
         usemtl red\nf 1 2 3 4\nusemtl none\nf 2 5 6 3\n",
    );
    let model = folder.path().join("a.obj");
    let run = |path: &Path| {
        fill(&[
            path.to_str().unwrap(),
            "--view",
            "top",
            "--light",
            "0,0,1",
            "--paint",
            "#0000ff",
            "--no-edges",
        ])
    };
    let svg = text(&run(&model).stdout);
    assert!(svg.contains("fill=\"#ff0000\"") && svg.contains("fill=\"#0000ff\""), "{svg}");
    std::fs::remove_file(folder.path().join("a.mtl")).unwrap();
    let output = run(&model);
    assert!(text(&output.stderr).contains("a.mtl"));
    assert!(!text(&output.stdout).contains("#ff0000"));
}

#[test]
fn materials_of_one_name_in_several_models_keep_their_colors() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    for (name, color, x) in [("a", "1 0 0", 0), ("b", "0 0 1", 2)] {
        write(&format!("{name}.mtl"), &format!("newmtl Material\nKd {color}\n"));
        let corners = format!("v {x} 0 0\nv {} 0 0\nv {x} 1 0\n", x + 1);
        write(
            &format!("{name}.obj"),
            &format!("mtllib {name}.mtl\n{corners}usemtl Material\nf 1 2 3\n"),
        );
    }
    let models = ["a.obj", "b.obj"].map(|name| folder.path().join(name));
    let [a, b] = models.each_ref().map(|path| path.to_str().unwrap());
    let svg = text(&fill(&[a, b, "--view", "top", "--light", "0,0,1", "--no-edges"]).stdout);
    assert!(svg.contains("fill=\"#ff0000\"") && svg.contains("fill=\"#0000ff\""), "{svg}");
}

#[test]
fn quarter_turns_of_a_turntable_are_exact() {
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("cube.off");
    std::fs::write(
        &model,
        "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n\
         4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n",
    )
    .unwrap();
    let file = folder.path().join("turn.svg");
    let (model, name) = (model.to_str().unwrap(), file.to_str().unwrap());
    let output = fill(&[model, "--view", "front", "--turntable", "4", "-o", name]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    for k in 1..=4 {
        let path = folder.path().join(format!("turn-00{k}.svg"));
        let svg = std::fs::read_to_string(path).unwrap();
        // A square, filled and with one line around it.
        assert_eq!(svg.matches("<path").count(), 2, "{k}: {svg}");
    }
}

#[test]
fn settings_hold_for_fill_and_preview() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("hiddenline.toml"),
        "[defaults]\npage = 'a6'\nview = 'top'\nformat = 'hpgl'\n",
    )
    .unwrap();
    let run = |arguments: &[&str]| hiddenline(folder.path(), arguments);
    let filled = run(&["fill", SPOT, "--engine", "bsp"]);
    assert!(filled.status.success(), "{}", text(&filled.stderr));
    assert!(text(&filled.stdout).contains("width=\"105mm\""));
    let typed = run(&["preview", SPOT, "--view", "top", "-o", "typed.png"]);
    let set = run(&["preview", SPOT, "-o", "set.png"]);
    assert!(typed.status.success() && set.status.success(), "{}", text(&set.stderr));
    let picture = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert!(picture("typed.png") == picture("set.png"));
    for command in ["fill", "preview"] {
        let unknown = run(&[command, SPOT, "--preset", "nosuch", "-o", "set.png"]);
        assert_eq!(unknown.status.code(), Some(2), "{command}: {}", text(&unknown.stderr));
    }
}

#[test]
fn the_order_of_painting_can_be_seen() {
    let output = fill(&[SPOT, "--engine", "bsp", "--debug", "order", "--no-edges"]);
    let svg = text(&output.stdout);
    let first = svg.find("fill=\"#0000d0\"").unwrap();
    let last = svg.rfind("fill=\"#d00000\"").unwrap();
    assert!(first < last);
}

#[test]
fn surfaces_are_filled_as_models_are() {
    let folder = tempfile::tempdir().unwrap();
    let heights = folder.path().join("heights");
    std::fs::write(&heights, "4 2 0 -2 -4\n2 1 0 -1 -2\n0 0 0 0 0\n-2 -1 0 1 2\n-4 -2 0 2 4\n")
        .unwrap();
    let ranges = ["--x=-2:2", "--y=-2:2", "--stats"];
    let areas = |given: &[&str]| -> Vec<String> {
        let output = fill(&[given, &ranges].concat());
        let stderr = text(&output.stderr);
        assert!(output.status.success(), "{given:?}: {stderr}");
        let stats: serde_json::Value =
            serde_json::from_str(stderr.lines().last().unwrap()).unwrap();
        assert_eq!(stats["triangles"], 32);
        let svg = text(&output.stdout);
        svg.lines().filter(|line| line.contains("<path")).map(str::to_owned).collect()
    };
    let by_formula = areas(&["--expr", "x*y", "--samples", "5"]);
    assert!(by_formula.len() > 20, "{}", by_formula.len());
    assert_eq!(areas(&["--grid", heights.to_str().unwrap()]), by_formula);
    let two =
        fill(&["--expr", "1", "--expr=-1", "--samples", "3", "--no-edges", "--engine", "bsp"]);
    let areas = text(&two.stdout).matches("fill-rule").count();
    assert_eq!(areas, 16, "{}", text(&two.stderr));
    assert_eq!(fill(&[SPOT, "--expr", "x"]).status.code(), Some(2));
    assert_eq!(fill(&[]).status.code(), Some(2));
}

#[test]
fn white_faces_hide_the_lines_behind_them() {
    let folder = tempfile::tempdir().unwrap();
    // Two squares, one above the other; from above only the upper one is seen.
    std::fs::write(
        folder.path().join("squares.off"),
        "OFF\n8 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n-1 -1 1\n2 -1 1\n2 2 1\n-1 2 1\n4 0 1 2 3\n4 4 5 6 7\n",
    )
    .unwrap();
    let run = |arguments: &[&str]| {
        let all = [&["fill", "squares.off", "--view", "top", "--white"], arguments].concat();
        hiddenline(folder.path(), &all)
    };
    let output = run(&["--engine", "depth-sort", "--pen-width", "0.5"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let svg = text(&output.stdout);
    let document = roxmltree::Document::parse(&svg).unwrap();
    let layer = document.descendants().find(|n| n.attribute("id") == Some("pen1-white")).unwrap();
    assert_eq!(layer.attribute("stroke"), Some("#000000"));
    assert_eq!(layer.attribute("stroke-width"), Some("0.5"));
    let fills: Vec<_> =
        layer.children().filter(|n| n.is_element()).map(|n| n.attribute("fill")).collect();
    // Each square is a white area with its outline on it, in two triangles.
    let (white, line) = (Some("#ffffff"), None);
    assert_eq!(fills, [white, line, white, line, white, line, white, line]);
    assert!(!svg.contains("visible"));
    // The default leaves out what is surely hidden.
    assert_eq!(text(&run(&[]).stdout).matches("fill=\"#ffffff\"").count(), 2);
    // In print what is left is what `draw` draws.
    let picture = |arguments: &[&str], name: &str| {
        let output = hiddenline(folder.path(), &[arguments, &["-o", name]].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let file = std::fs::File::open(folder.path().join(name)).unwrap();
        let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        pixels
    };
    let drawn = picture(&["draw", "squares.off", "--view", "top"], "drawn.png");
    let painted = picture(
        &["fill", "squares.off", "--view", "top", "--white", "--engine", "depth-sort"],
        "painted.png",
    );
    assert_eq!(drawn.len(), painted.len());
    let n_differ = drawn.iter().zip(&painted).filter(|(a, b)| a.abs_diff(**b) > 100).count();
    let n_dark = drawn.iter().filter(|&&pixel| pixel < 128).count();
    assert!(n_dark > 5000 && n_differ * 100 < n_dark, "{n_differ} of {n_dark}");
    // PDF: each line is drawn with the pen, as wide as that is, right after the area that it borders.
    let pdf = run(&["--engine", "depth-sort", "--format", "pdf", "--pen-width", "0.5"]).stdout;
    let pdf = lopdf::Document::load_mem(&pdf).unwrap();
    let page = pdf.page_iter().next().unwrap();
    let content = lopdf::content::Content::decode(&pdf.get_page_content(page)).unwrap();
    let (mut width, mut painted) = (0.0, Vec::new());
    for operation in &content.operations {
        match operation.operator.as_str() {
            "w" => width = operation.operands[0].as_float().unwrap(),
            "S" | "s" => painted.push(width),
            "B*" => painted.push(-width),
            _ => {}
        }
    }
    assert_eq!(painted, [[-0.05, 0.5]; 4].concat());
    for (arguments, message) in [
        (vec!["--palette", "3"], "cannot be used"),
        (vec!["--no-edges"], "cannot be used"),
        (vec!["--lines", "outline"], "whole edges"),
        (vec!["--engine", "warnock"], "--engine bsp"),
    ] {
        let output = run(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let error = text(&output.stderr);
        assert!(error.contains(message), "{arguments:?}: {error}");
    }
}

#[test]
fn filled_surfaces_have_the_axes_of_their_drawings() {
    let draw = |arguments: &[&str]| {
        let output = fill(arguments);
        assert!(output.status.success(), "{}", text(&output.stderr));
        (text(&output.stdout), text(&output.stderr))
    };
    let surface = ["--expr", "x*y", "--samples", "6", "--no-edges"];
    let n_paths =
        |arguments: &[&str]| draw(&[&surface[..], arguments].concat()).0.matches("<path").count();
    let bare = n_paths(&["--axes", "none"]);
    let edges = n_paths(&[]);
    let back = n_paths(&["--axes", "back"]);
    assert!(bare + 60 < edges && edges + 20 < back, "{bare} {edges} {back}");
    assert_eq!(n_paths(&["--no-axes"]), bare);
    let (_, said) = draw(&["--expr", "x*y", "--axes", "box", "--turntable", "2", "-o", "o.svg"]);
    assert!(said.contains("--axes has no effect with --turntable"), "{said}");
}

#[test]
fn plotters_get_the_edges_and_hatching_without_the_areas() {
    let keep = tempfile::tempdir().unwrap();
    let folder = keep.path();
    std::fs::write(folder.join("cube.obj"), super::CUBE).unwrap();
    for (format, machine) in [("plt", "hp7475a"), ("gcode", ""), ("dxf", "")] {
        let (filled, drawn) = (format!("filled.{format}"), format!("drawn.{format}"));
        let machine = if machine.is_empty() { vec![] } else { vec!["--machine", machine] };
        let fill = [&["fill", "cube.obj", "--edges", "-o", &filled], &machine[..]].concat();
        let output = hiddenline(folder, &fill);
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{stderr}");
        assert!(stderr.contains("holds lines only: 3 areas are left out"), "{stderr}");
        let draw = [&["draw", "cube.obj", "-o", &drawn], &machine[..]].concat();
        assert_eq!(hiddenline(folder, &draw).status.code(), Some(0));
        let [filled, drawn] =
            [&filled, &drawn].map(|name| std::fs::read(folder.join(name)).unwrap());
        let body =
            |bytes: &[u8]| text(bytes).lines().skip(1).map(str::to_owned).collect::<Vec<_>>();
        if format == "plt" {
            assert_eq!(body(&filled), body(&drawn));
        }
        let strict = [&fill[..], &["--strict"]].concat();
        assert_eq!(hiddenline(folder, &strict).status.code(), Some(1));
        let areas = ["fill", "cube.obj", "--no-edges", "-o", fill[4]];
        assert_ne!(hiddenline(folder, &areas).status.code(), Some(0));
    }
}
