//! Hidden lines by how many triangles cover them, each level with a pen of its own.

use std::collections::BTreeMap;
use std::path::Path;

use super::{hiddenline, text};

/// Three plates one behind the other, each a little lower and smaller, seen from the front.
const PLATES: &str = "\
v -9 0 -9\nv 9 0 -9\nv 9 0 9\nv -9 0 9\nf 1 2 3 4
v -6 3 -6\nv 6 3 -6\nv 6 3 6\nv -6 3 6\nf 5 6 7 8
v -3 6 -3\nv 3 6 -3\nv 3 6 3\nv -3 6 3\nf 9 10 11 12
";

fn draw(folder: &Path, arguments: &[&str]) -> String {
    std::fs::write(folder.join("plates.obj"), PLATES).unwrap();
    let output =
        hiddenline(folder, &[&["draw", "plates.obj", "--view", "front"], arguments].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stdout)
}

/// Labels of the layers with their number of paths.
fn layers(svg: &str) -> Vec<(String, usize)> {
    let document = roxmltree::Document::parse(svg).unwrap();
    let groups = document.root_element().children().filter(|node| node.has_tag_name((SVG, "g")));
    let label = |group: &roxmltree::Node| group.attribute((INKSCAPE, "label")).unwrap().to_owned();
    groups.map(|g| (label(&g), g.children().filter(|n| n.is_element()).count())).collect()
}

const SVG: &str = "http://www.w3.org/2000/svg";
const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";

fn named(layers: &[(String, usize)]) -> Vec<&str> {
    layers.iter().map(|(label, _)| label.as_str()).collect()
}

#[test]
fn each_level_has_a_layer_and_what_lies_deeper_is_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let svg = |more: &[&str]| layers(&draw(folder.path(), more));
    let two = svg(&["--hidden-levels", "2", "--hidden", "solid"]);
    assert_eq!(named(&two), ["1 visible", "2 hidden1", "3 hidden2"]);
    // A square is covered once, by the first plate; the last by it and the second.
    assert!(two.iter().all(|(_, n)| *n == 1), "{two:?}");
    let one = svg(&["--hidden-levels", "1"]);
    assert_eq!(named(&one), ["1 visible", "2 hidden1"]);
    assert!(one[1].1 > 4, "dashed unless said otherwise: {one:?}");
    assert_eq!(named(&svg(&["--hidden", "solid"])), ["1 visible", "2 hidden"]);
}

#[test]
fn each_level_can_have_its_pen() {
    let folder = tempfile::tempdir().unwrap();
    let pens = ["--pen", "hidden2=7:0.1mm:red", "--pen", "hidden=4"];
    let svg = draw(folder.path(), &[&["--hidden", "solid"], &pens[..]].concat());
    assert_eq!(named(&layers(&svg)), ["1 visible", "4 hidden", "7 hidden2"]);
    assert!(svg.contains("#ff0000"), "{svg}");
    let svg = draw(folder.path(), &["--hidden-levels", "2", "--pen", "hidden1=9"]);
    assert_eq!(named(&layers(&svg)), ["1 visible", "2 hidden2", "9 hidden1"]);
}

#[test]
fn strokes_say_how_often_they_are_covered() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, levels) in [
        (&["--hidden-levels", "1"][..], vec![(0, 1), (1, 1)]),
        (&["--hidden-levels", "5"], vec![(0, 1), (1, 1), (2, 1)]),
        (&["--hidden-levels", "2", "--exact"], vec![(0, 4), (1, 4), (2, 4)]),
        (&["--hidden", "solid", "--exact"], vec![(0, 4), (1, 4), (2, 4)]),
    ] {
        let json = draw(folder.path(), &[arguments, &["--format", "json"]].concat());
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        let mut found = BTreeMap::new();
        for stroke in json["strokes"].as_array().unwrap() {
            assert_eq!(stroke["visible"] == true, stroke.get("qi").is_none());
            *found.entry(stroke["qi"].as_u64().unwrap_or(0)).or_insert(0) += 1;
        }
        assert_eq!(found.into_iter().collect::<Vec<_>>(), levels, "{arguments:?}");
    }
}

#[test]
fn the_outline_has_a_wide_pen_of_its_own_among_others() {
    let folder = tempfile::tempdir().unwrap();
    let svg = draw(folder.path(), &["--lines", "outline,boundary", "--hidden-levels", "1"]);
    assert_eq!(named(&layers(&svg)), ["2 outline", "3 hidden1"]);
    assert!(svg.contains("#101010") && svg.contains(r#"stroke-width="0.6""#), "{svg:.900}");
    let alone = draw(folder.path(), &["--lines", "outline"]);
    assert_eq!(layers(&alone), [("1 visible".to_owned(), 1)]);
    let json =
        draw(folder.path(), &["--lines", "outline,mesh", "--format", "json", "--hidden", "solid"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    for stroke in json["strokes"].as_array().unwrap() {
        assert_eq!(stroke["kind"], "boundary");
        assert_eq!(stroke["visible"] == true, stroke["outline"] == true);
    }
}
