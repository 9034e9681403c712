//! Models that people bring, from file to strokes.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use super::{hiddenline, text};
use crate::readers::export::Triangles;

/// A folder with these files in it.
fn folder_of<const N: usize>(files: [(&str, &[u8]); N]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

/// The strokes and the messages of `draw` with these arguments.
fn draw(folder: &Path, arguments: &[&str]) -> (Value, String) {
    let all = [&["draw", "--format", "json"], arguments].concat();
    let output = hiddenline(folder, &all);
    let stderr = text(&output.stderr);
    assert!(output.status.success(), "{stderr}");
    (serde_json::from_slice(&output.stdout).unwrap(), stderr)
}

/// How many strokes there are of a kind.
fn count(drawing: &Value, kind: &str) -> usize {
    let strokes = drawing["strokes"].as_array().unwrap();
    strokes.iter().filter(|stroke| stroke["kind"] == kind).count()
}

/// A prism with vertical sides over a polygon.
fn prism(corners: &[[f64; 2]], height: f64) -> String {
    let n = corners.len();
    let mut obj = String::new();
    for z in [0.0, height] {
        corners.iter().for_each(|[x, y]| writeln!(obj, "v {x:.9} {y:.9} {z}").unwrap());
    }
    let ring = |first: usize| (first..first + n).map(|i| i.to_string()).collect::<Vec<_>>();
    let below: Vec<String> = ring(1).into_iter().rev().collect();
    writeln!(obj, "f {}\nf {}", below.join(" "), ring(n + 1).join(" ")).unwrap();
    for i in 0..n {
        let next = (i + 1) % n;
        writeln!(obj, "f {} {} {} {}", i + 1, next + 1, n + next + 1, n + i + 1).unwrap();
    }
    obj
}

fn regular(n: usize, radius: f64, turn: f64) -> Vec<[f64; 2]> {
    let angle = |i: usize| turn + std::f64::consts::TAU * i as f64 / n as f64;
    (0..n).map(|i| [radius * angle(i).cos(), radius * angle(i).sin()]).collect()
}

#[test]
fn one_model_in_six_formats_gives_the_same_strokes() {
    let house = Triangles::house();
    let files = |house: &Triangles| {
        folder_of([
            ("a.obj", &house.obj()),
            ("a.off", &house.off()),
            ("a.ply", &house.ply()),
            ("a.stl", &house.stl()),
            ("text.stl", &house.stl_text()),
            ("a.3mf", &house.three_mf()),
            ("a.glb", &house.glb()),
        ])
    };
    let strokes = |folder: &TempDir, name: &str| {
        let (drawing, stderr) = draw(folder.path(), &[name, "--hidden", "solid"]);
        assert!(!stderr.contains("warning"), "{name}: {stderr}");
        drawing["strokes"].clone()
    };
    let singles = files(&house);
    let expected = strokes(&singles, "a.obj");
    assert!(expected.as_array().unwrap().len() >= 4, "{expected}");
    for name in ["a.off", "a.ply", "a.stl", "text.stl", "a.3mf", "a.glb"] {
        assert_eq!(strokes(&singles, name), expected, "{name}");
    }
    // Coordinates that single precision rounds: the same strokes, up to that.
    let doubles = files(&house.scaled(1.0 / 3.0));
    let expected = strokes(&doubles, "a.obj");
    for name in ["a.off", "a.ply", "text.stl", "a.3mf"] {
        assert_eq!(strokes(&doubles, name), expected, "{name}");
    }
    for name in ["a.stl", "a.glb"] {
        let found = strokes(&doubles, name);
        let pairs = expected.as_array().unwrap().iter().zip(found.as_array().unwrap());
        assert_eq!(expected.as_array().unwrap().len(), found.as_array().unwrap().len());
        for (a, b) in pairs {
            assert_eq!((&a["kind"], &a["qi"]), (&b["kind"], &b["qi"]), "{name}");
            let numbers = |stroke: &Value| -> Vec<f64> {
                let points = stroke["points"].as_array().unwrap();
                points
                    .iter()
                    .flat_map(|p| p.as_array().unwrap())
                    .map(|c| c.as_f64().unwrap())
                    .collect()
            };
            let (a, b) = (numbers(a), numbers(b));
            assert_eq!(a.len(), b.len());
            let far = a.iter().zip(&b).any(|(a, b)| (a - b).abs() > 1e-5 * (1.0 + a.abs()));
            assert!(!far, "{name}: {a:?} {b:?}");
        }
    }
}

#[test]
fn faces_given_twice_count_once_and_are_told() {
    let once = prism(&regular(7, 10.0, 0.1), 12.0);
    let faces: Vec<&str> = once.lines().filter(|line| line.starts_with('f')).collect();
    let turned_back = faces.iter().map(|face| {
        let corners: Vec<&str> = face.split(' ').skip(1).collect();
        format!("f {}\n", corners.into_iter().rev().collect::<Vec<_>>().join(" "))
    });
    let twice = once.clone() + &turned_back.collect::<String>();
    let again: String = once
        .lines()
        .map(|line| match line.strip_prefix("f ") {
            None => format!("{line}\n"),
            Some(corners) => {
                let shifted =
                    corners.split(' ').map(|c| (c.parse::<u32>().unwrap() + 14).to_string());
                format!("f {}\n", shifted.collect::<Vec<_>>().join(" "))
            }
        })
        .collect();
    let given_twice = once.clone() + &again;
    let folder = folder_of([
        ("once.obj", once.as_bytes()),
        ("both.obj", twice.as_bytes()),
        ("again.obj", given_twice.as_bytes()),
    ]);
    for kinds in ["silhouette,crease,boundary,nonmanifold", "silhouette,crease,boundary"] {
        let (expected, stderr) = draw(folder.path(), &["once.obj", "--lines", kinds]);
        assert!(!stderr.contains("equal face"), "{stderr}");
        for model in ["both.obj", "again.obj"] {
            let (found, stderr) = draw(folder.path(), &[model, "--lines", kinds]);
            assert_eq!(found["strokes"], expected["strokes"], "{model}");
            assert!(stderr.contains("9 equal faces merged"), "{stderr}");
        }
    }
    let (found, _) = draw(folder.path(), &["once.obj", "once.obj"]);
    assert_eq!(found["strokes"], draw(folder.path(), &["once.obj"]).0["strokes"]);
    let (exact, stderr) = draw(folder.path(), &["both.obj", "--exact"]);
    assert!(!stderr.contains("merged") || stderr.contains("equal vertices merged"), "{stderr}");
    assert!(count(&exact, "nonmanifold") > 0);
}

#[test]
fn loose_triangles_get_a_hint_at_weld_and_the_value_helps() {
    let solid = prism(&regular(9, 15.0, 0.2), 20.0);
    let vertices: Vec<Vec<f64>> = solid
        .lines()
        .filter_map(|line| line.strip_prefix("v "))
        .map(|line| line.split(' ').map(|c| c.parse().unwrap()).collect())
        .collect();
    let mut loose = String::new();
    let mut n = 0_u32;
    for face in solid.lines().filter_map(|line| line.strip_prefix("f ")) {
        let corners: Vec<usize> =
            face.split(' ').map(|c| c.parse::<usize>().unwrap() - 1).collect();
        for triangle in corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]) {
            for corner in triangle {
                n += 1;
                let noise = |axis: u32| f64::from((n * 7919 + axis * 104_729) % 1000) * 1e-8;
                let [x, y, z] = *vertices[corner].first_chunk::<3>().unwrap();
                writeln!(loose, "v {} {} {}", x + noise(0), y + noise(1), z + noise(2)).unwrap();
            }
            writeln!(loose, "f {} {} {}", n - 2, n - 1, n).unwrap();
        }
    }
    let folder = folder_of([("loose.obj", loose.as_bytes()), ("solid.obj", solid.as_bytes())]);
    let (net, _) = draw(folder.path(), &["loose.obj", "--exact"]);
    let (_, stderr) = draw(folder.path(), &["loose.obj"]);
    let hint = stderr.lines().find(|line| line.starts_with("hint: ")).expect("a hint");
    let value = hint.split("--weld ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
    assert!(count(&net, "boundary") > 20);
    let (welded, stderr) = draw(folder.path(), &["loose.obj", "--weld", value]);
    assert!(!stderr.contains("hint"), "{stderr}");
    let (expected, stderr) = draw(folder.path(), &["solid.obj"]);
    assert!(!stderr.contains("hint"), "{stderr}");
    for kind in ["boundary", "silhouette", "crease"] {
        assert_eq!(count(&welded, kind), count(&expected, kind), "{kind}");
    }
}

#[test]
fn equal_angles_are_creases_together_or_not_at_all() {
    for (n, crease) in [(12, 30.0), (8, 45.0), (24, 15.0), (36, 10.0), (7, 360.0 / 7.0)] {
        for (radius, turn) in [(8.0, 0.0), (3.7, 0.4), (1234.5, 1.1), (0.011, 2.2)] {
            let obj = prism(&regular(n, radius, turn), 2.0 * radius);
            let folder = folder_of([("prism.obj", obj.as_bytes())]);
            let creases = |crease: f64, more: &[&str]| {
                let crease = crease.to_string();
                let arguments = ["prism.obj", "--lines", "crease", "--crease", &crease];
                let (drawing, _) = draw(folder.path(), &[&arguments[..], more].concat());
                let strokes = drawing["strokes"].as_array().unwrap();
                // The edges along the prism run up on paper when seen from the front.
                let is_upright = |stroke: &&Value| {
                    let points = stroke["points"].as_array().unwrap();
                    points.windows(2).any(|pair| {
                        let d =
                            |i: usize| pair[1][i].as_f64().unwrap() - pair[0][i].as_f64().unwrap();
                        d(0).abs() < 1e-6 * d(1).abs()
                    })
                };
                strokes.iter().filter(is_upright).count()
            };
            let view = ["--view", "front", "--exact", "--hidden", "solid"];
            assert_eq!(creases(crease, &view), 0, "{n}-gon of {radius} at {crease}");
            let all = creases(crease - 1.0, &view);
            assert_eq!(all, n, "{n}-gon of {radius}");
        }
    }
}

#[test]
fn coplanar_faces_that_meet_at_a_t_junction_show_no_line() {
    let folder = |top: &str| {
        let base = "v 0 0 0\nv 40 0 0\nv 40 20 0\nv 0 20 0\nv 0 0 10\nv 40 0 10\nv 40 20 10\nv 0 20 10\n\
                    v 20 0 10\nv 20 20 10\nv 20 10 10\nv 40 10 10\nv 30 5 10\nv 35 5 10\nv 35 15 10\n\
                    v 30 15 10\nv 20 5 10\nv 10 0 10\nv 10 20 10\n\
                    f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
        folder_of([("t.obj", format!("{base}{top}").as_bytes())])
    };
    // Seen from above, only the rim of the top is left to see; the walls have corners elsewhere, so
    // part of the rim is boundary, too. Inside, between x = 1 and 39 and y = 1 and 19, is nothing.
    let inner = |folder: &TempDir, more: &[&str]| {
        let view = ["t.obj", "--view", "top", "--drawing-scale", "1:1", "--page", "80x60"];
        let kinds = ["--landscape", "--lines", "silhouette,crease,boundary,nonmanifold"];
        let (drawing, _) = draw(folder.path(), &[&view[..], &kinds, more].concat());
        let strokes = drawing["strokes"].as_array().unwrap();
        let at = |p: &Value| [p[0].as_f64().unwrap(), p[1].as_f64().unwrap()];
        let all: Vec<[f64; 2]> =
            strokes.iter().flat_map(|s| s["points"].as_array().unwrap()).map(at).collect();
        let low = all.iter().fold([f64::MAX; 2], |a, b| [a[0].min(b[0]), a[1].min(b[1])]);
        let high = all.iter().fold([f64::MIN; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])]);
        let size = [high[0] - low[0], high[1] - low[1]];
        let pairs = strokes.iter().flat_map(|s| s["points"].as_array().unwrap().windows(2));
        pairs
            .filter(|pair| {
                let (a, b) = (at(&pair[0]), at(&pair[1]));
                (0..2).all(|i| {
                    let middle = ((a[i] + b[i]) / 2.0 - low[i]) / size[i];
                    (0.02..0.98).contains(&middle)
                })
            })
            .count()
    };
    for top in [
        // Two beside one; three in a row, each cut elsewhere; a plate that lies in another.
        "f 5 9 10 8\nf 9 6 12 11\nf 11 12 7 10\n",
        "f 5 9 10 8\nf 9 6 12 17\nf 17 12 7 10\n",
        "f 5 18 19 8\nf 18 9 17 11 10 19\nf 9 6 7 10\n",
        "f 5 6 7 8\nf 13 14 15 16\n",
        "f 5 6 7\nf 5 7 8\nf 13 14 15 16\n",
    ] {
        let folder = folder(top);
        assert_eq!(inner(&folder, &[]), 0, "{top}");
        assert!(inner(&folder, &["--exact"]) > 0, "--exact keeps them: {top}");
    }
    // A hair above the plane, or not all along the edge, a face ends there.
    for top in ["f 5 9 10 8\nf 9 6 12 11\n", "f 5 18 19 8\nf 9 6 7 10\n"] {
        assert!(inner(&folder(top), &[]) > 0, "{top}");
    }
    let bent = folder("v 20 10 10.000001\nf 5 9 10 8\nf 9 6 12 20\nf 20 12 7 10\n");
    assert!(inner(&bent, &[]) > 0);
}

#[test]
fn units_of_files_set_the_scale_unless_unit_is_given() {
    let house = Triangles::house();
    let small = house.scaled(0.01);
    let inches = crate::readers::export::three_mf(&[("m", &house.model_xml("inch"))]);
    let folder = folder_of([
        ("a.obj", &house.obj()[..]),
        ("a.glb", &house.glb()),
        ("in.3mf", &inches),
        ("small.glb", &small.glb()),
    ]);
    let width = |arguments: &[&str]| {
        let view = ["--view", "front", "--page", "2000x2000"];
        let (drawing, stderr) = draw(folder.path(), &[arguments, &view].concat());
        let strokes = drawing["strokes"].as_array().unwrap();
        let points = strokes.iter().flat_map(|stroke| stroke["points"].as_array().unwrap());
        let xs: Vec<f64> = points.map(|p| p[0].as_f64().unwrap()).collect();
        let extent =
            xs.iter().fold(f64::MIN, |a, &b| a.max(b)) - xs.iter().fold(f64::MAX, |a, &b| a.min(b));
        let mm_per_unit = drawing["page_from_image"][0].as_f64().unwrap();
        (extent * mm_per_unit, stderr)
    };
    let mm = width(&["a.obj", "--drawing-scale", "1:1"]).0;
    let close = |a: f64, b: f64| (a - b).abs() < 1e-4 * b.abs();
    let meters = width(&["a.glb", "--drawing-scale", "1:50"]).0;
    assert!(close(meters, 20.0 * mm), "{meters} {mm}");
    assert!(close(width(&["in.3mf", "--drawing-scale", "1:1"]).0, 25.4 * mm));
    for unit in ["mm", "cm"] {
        let (of_obj, ..) = width(&["a.obj", "--drawing-scale", "1:1", "--unit", unit]);
        let (of_glb, ..) = width(&["a.glb", "--drawing-scale", "1:1", "--unit", unit]);
        assert!(close(of_obj, of_glb), "{unit}");
    }
    // Files in other units are converted to the unit of the first one, with a message.
    let (both, stderr) = width(&["in.3mf", "small.glb", "--drawing-scale", "1:1"]);
    assert!(close(both, 4.2 * 25.4 - 0.001 * 1000.0), "{both}");
    assert!(stderr.contains("small.glb is in units of 1000 mm and was scaled by"), "{stderr}");
    let (_, stderr) = width(&["in.3mf", "small.glb", "--drawing-scale", "1:1", "--unit", "cm"]);
    assert!(!stderr.contains("scaled"), "{stderr}");
    // Coordinates in DXF are in the model's own unit.
    let dxf = |arguments: &[&str]| {
        let draw = ["draw", "a.glb", "--drawing-scale", "1:50", "--format", "dxf"];
        text(&hiddenline(folder.path(), &[&draw[..], arguments].concat()).stdout)
            .replace("\r\n", "\n")
    };
    assert!(dxf(&[]).contains("$INSUNITS\n 70\n6\n"), "meters");
    assert_eq!(dxf(&[]), dxf(&["--unit", "m"]));
}

#[test]
fn models_that_seem_to_lie_on_their_backs_get_a_hint() {
    let standing: String = prism(&regular(6, 2.0, 0.3), 5.0)
        .lines()
        .map(|line| match line.strip_prefix("v ") {
            None => format!("{line}\n"),
            Some(xyz) => {
                let xyz: Vec<&str> = xyz.split(' ').collect();
                format!("v {} {} -{}\n", xyz[0], xyz[2], xyz[1]).replace("--", "")
            }
        })
        .collect();
    let folder = folder_of([("up.obj", standing.as_bytes()), ("a.glb", &Triangles::house().glb())]);
    let (_, stderr) = draw(folder.path(), &["up.obj"]);
    assert!(stderr.contains("hint: up.obj seems to be modeled with y up; if so, use --up-axis y"));
    for arguments in [&["up.obj", "--up-axis", "y"][..], &["up.obj", "--up-axis", "z"], &["a.glb"]]
    {
        assert!(!draw(folder.path(), arguments).1.contains("hint"), "{arguments:?}");
    }
    let strict = hiddenline(folder.path(), &["draw", "up.obj", "--strict", "-o", "up.svg"]);
    assert!(strict.status.success(), "a hint is no warning");
    // glTF says itself which way is up; z takes that back.
    let (given, _) = draw(folder.path(), &["a.glb", "--up-axis", "y"]);
    assert_eq!(given["strokes"], draw(folder.path(), &["a.glb"]).0["strokes"]);
    let lying = draw(folder.path(), &["a.glb", "--up-axis", "z"]).0;
    let turned = draw(folder.path(), &["a.glb", "--rotate=-90,0,0"]).0;
    assert_eq!(lying["strokes"], turned["strokes"]);
    assert_ne!(lying["strokes"], given["strokes"]);
}

#[test]
fn what_is_no_model_is_named_with_the_remedy() {
    let folder = folder_of([
        ("part.step", &b"ISO-10303-21;\n"[..]),
        ("page.stl", b"<!DOCTYPE html><html></html>"),
        ("unknown", b"what is this"),
    ]);
    for (file, part) in [
        ("part.step", "cascadio.step_to_glb("),
        ("page.stl", "this is a web page"),
        ("unknown", "use --input-format obj, stl, ply, off, gltf or 3mf"),
    ] {
        let output = hiddenline(folder.path(), &["draw", file, "-o", "x.svg"]);
        super::assert_fails(&output, 1, part);
        assert!(!folder.path().join("x.svg").exists());
    }
}
