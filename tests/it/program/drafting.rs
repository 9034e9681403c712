//! Options for lines on paper: widths, room between lines, what lies on other ink.

use std::path::Path;

use tempfile::TempDir;

use super::{hiddenline, text};

/// The pens in an SVG as (label, stroke width), and what was said on standard error.
fn drawn(folder: &Path, arguments: &[&str]) -> (Vec<(String, String)>, String) {
    let all = [&["draw", "-o", "x.svg"], arguments].concat();
    let run = hiddenline(folder, &all);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let svg = std::fs::read_to_string(folder.join("x.svg")).unwrap();
    let document = roxmltree::Document::parse(&svg).unwrap();
    let layers = document.descendants().filter(|node| node.has_tag_name("g"));
    let pens = layers.filter_map(|layer| {
        let id = layer.attribute("id")?;
        Some((id.to_owned(), layer.attribute("stroke-width")?.to_owned()))
    });
    (pens.collect(), text(&run.stderr))
}

/// Upright rods in two rows, so close that lines crowd each other.
fn fence() -> String {
    let mut obj = String::new();
    for k in 0..30 {
        let (x, first) = (f64::from(k) * 0.008, 4 * k + 1);
        for (x, z) in [(x, 0.0), (x + 0.004, 0.0), (x + 0.004, 9.0), (x, 9.0)] {
            obj.push_str(&format!("v {x} 0 {z}\n"));
        }
        obj.push_str(&format!("f {first} {} {} {}\n", first + 1, first + 2, first + 3));
    }
    obj
}

fn with_fence() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("fence.obj"), fence()).unwrap();
    folder
}

#[test]
fn styles_are_what_pens_and_the_outline_make() {
    let folder = with_fence();
    let widths = |arguments: &[&str]| {
        let (pens, _) = drawn(folder.path(), arguments);
        let mut widths: Vec<String> = pens.into_iter().map(|pen| pen.1).collect();
        widths.sort();
        widths
    };
    assert_eq!(widths(&["fence.obj", "--view", "front"]), ["0.3"]);
    let technical = widths(&["fence.obj", "--view", "front", "--style", "technical"]);
    assert!(technical.contains(&"0.6".to_owned()), "{technical:?}");
    let bold = widths(&["fence.obj", "--view", "front", "--style", "bold"]);
    assert!(bold.contains(&"1.2".to_owned()), "{bold:?}");
}

#[test]
fn crowded_drawings_get_a_hint_and_thin_follows_it() {
    let folder = with_fence();
    let view = ["fence.obj", "--view", "front", "--overlap", "keep"];
    let (_, said) = drawn(folder.path(), &view);
    assert!(said.contains("--thin leaves room"), "{said}");
    let number = |said: &str, before: &str| {
        let rest = said.split_once(before).unwrap().1;
        rest.split(' ').next().unwrap().parse::<f64>().unwrap()
    };
    let saved = number(&said, "and saves ");
    let (_, said) = drawn(folder.path(), &[&view[..], &["--thin"]].concat());
    assert!(said.contains("thinned out") && !said.contains("--thin"), "{said}");
    assert!((number(&said, "lines: ") - saved).abs() <= 1.0, "{saved}: {said}");
    let (_, said) = drawn(folder.path(), &[&view[..], &["--thin", "--stats"]].concat());
    let json = said.lines().find(|line| line.starts_with('{')).unwrap();
    let stats: serde_json::Value = serde_json::from_str(json).unwrap();
    assert!((stats["drafted"]["thinned_mm"].as_f64().unwrap() - saved).abs() <= 1.0);
    assert!(stats["drafted"]["farthest_mm"].as_f64().unwrap() <= 0.3, "a pen width");
    assert!(stats["smoothed"].is_null());
    let (_, said) = drawn(folder.path(), &[&view[..], &["--exact", "--stats"]].concat());
    assert!(!said.contains("drafted"), "{said}");
    let (_, said) = drawn(folder.path(), &[&view[..], &["--thin=0.9mm"]].concat());
    assert!(said.contains("thinned out"), "{said}");
    let (_, said) = drawn(folder.path(), &["fence.obj", "--view", "front"]);
    assert!(said.contains("of overlapping ink left out"), "{said}");
}
