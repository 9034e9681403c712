//! What the program writes, compared with the truth as unions of points in the image.

use crate::laws::engines;
use crate::models;
use crate::oracle::compare::{compare, compare_strokes, truth_of, visible_segments};
use crate::oracle::{EdgeTruth, Kind, Settings, Sight, World, truth};
use crate::program::command;
use crate::scenes::{Scene, number_of_scenes, perspective, random};
use std::fmt::Write as _;
use std::path::Path;

fn obj(scene: &Scene) -> String {
    let mut text = String::new();
    for [x, y, z] in &scene.positions {
        writeln!(text, "v {x:?} {y:?} {z:?}").unwrap();
    }
    for face in &scene.faces {
        let corners: Vec<String> = face.iter().map(|v| (v + 1).to_string()).collect();
        writeln!(text, "f {}", corners.join(" ")).unwrap();
    }
    text
}

/// The visible strokes of `hiddenline draw --exact`.
fn strokes_of(scene: &Scene, folder: &Path, lines: &str) -> Result<Vec<Vec<[f64; 2]>>, String> {
    let model = folder.join(format!("{}.obj", scene.name.replace(' ', "_")));
    std::fs::write(&model, obj(scene)).unwrap();
    let vector = |p: [f64; 3]| format!("{:?},{:?},{:?}", p[0], p[1], p[2]);
    let sight = &scene.sight;
    let mut command = command(folder, &["draw"]);
    command.arg(&model).args(["--exact", "--format", "json", "-o", "-", "--quiet"]);
    command.args(["--lines", lines]);
    command.arg(format!("--eye={}", vector(sight.eye)));
    command.arg(format!("--target={}", vector(sight.target)));
    command.arg(format!("--up={}", vector(sight.up)));
    match sight.near {
        Some(near) => command.args(["--projection", "perspective", "--near", &format!("{near:?}")]),
        None => command.args(["--projection", "orthographic"]),
    };
    let output = command.output().unwrap();
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    let json: serde_json::Value =
        serde_json::from_slice(&output.stdout).map_err(|e| format!("JSON: {e}"))?;
    let numbers = |v: &serde_json::Value| -> Vec<f64> {
        v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
    };
    for (name, p) in [("eye", sight.eye), ("target", sight.target), ("up", sight.up)] {
        let written = numbers(&json["camera"][name]);
        if written != p {
            return Err(format!("{name} is written as {written:?}, not {p:?}"));
        }
    }
    let strokes = json["strokes"].as_array().unwrap().iter();
    Ok(strokes
        .filter(|s| s["visible"] == true)
        .map(|s| {
            let points = s["points"].as_array().unwrap().iter();
            points.map(|p| [p[0].as_f64().unwrap(), p[1].as_f64().unwrap()]).collect()
        })
        .collect())
}

const FEATURES: [Kind; 4] = [Kind::Silhouette, Kind::Crease, Kind::Boundary, Kind::Nonmanifold];

fn is_feature(edge: &EdgeTruth) -> Option<bool> {
    edge.kinds(30.0).map(|kinds| kinds.iter().any(|k| FEATURES.contains(k)))
}

fn assert_drawn(first: u64, lines: &str, is_selected: fn(&EdgeTruth) -> Option<bool>) {
    let folder = tempfile::tempdir().unwrap();
    for seed in first..first + number_of_scenes(120) {
        let scene = random(seed);
        let Some(edges) = truth_of(&scene).filter(|e| !e.is_empty()) else { continue };
        let strokes = strokes_of(&scene, folder.path(), lines)
            .unwrap_or_else(|e| panic!("{}: {e}", scene.name));
        let of = |answer: Option<bool>| {
            visible_segments(&scene.sight, &edges, |e| is_selected(e) == answer)
        };
        let difference = compare_strokes(&of(Some(true)), &strokes, &of(None));
        assert!(difference.is_small(), "{}: {difference:?}", scene.name);
    }
}

#[test]
fn all_lines_drawn_exactly_are_the_visible_ones() {
    assert_drawn(50_000, "all", |_| Some(true));
}

#[test]
fn feature_lines_drawn_exactly_are_the_visible_ones() {
    assert_drawn(60_000, "silhouette,crease,boundary,nonmanifold", is_feature);
}

/// A model of the shared folder, polygons that are not flat cut into fans.
fn model(path: &Path, sight: Sight) -> Scene {
    let mesh = hiddenline::stages::read::read_file(path, None).unwrap().mesh;
    let positions: Vec<[f64; 3]> = mesh.positions().iter().map(|p| p.to_array()).collect();
    let mut faces = Vec::new();
    for f in 0..mesh.n_faces() as u32 {
        let face = mesh.face(f).to_vec();
        // The corners alone, so that a large model is not turned into integers for each face.
        let corners: Vec<[f64; 3]> = face.iter().map(|&v| positions[v as usize]).collect();
        let border = vec![(0..face.len() as u32).collect()];
        let alone = World::new(&corners, &border, &sight);
        if alone.triangles().is_ok() {
            faces.push(face);
        } else {
            faces.extend((1..face.len() - 1).map(|i| vec![face[0], face[i], face[i + 1]]));
        }
    }
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    Scene { name, positions, faces, sight, is_in_tenths: false }
}

#[test]
fn small_models_hide_as_the_truth_says() {
    let Some(folder) = models::folder() else { return };
    let boxed = Settings { reject_by_boxes: true, ..Settings::default() };
    for name in [
        "platonic_shelf_ngons.obj",
        "concave_66gon.obj",
        "cornell_box_negidx.obj",
        "far_offset_tiny_cube.obj",
        "spot_control_quads.obj",
        "moebius.obj",
        "openscad_example016.stl",
        "cad_angle_block_open.stl",
    ] {
        let path = folder.join(name);
        let mesh = hiddenline::stages::read::read_file(&path, None).unwrap().mesh;
        let (low, high) = mesh.bounds().unwrap();
        let (middle, size) = ((low + high) / 2.0, (high - low).max_element());
        let away = glam::dvec3(1.0, -2.0, 1.5) * size;
        let general = perspective((middle + away).into(), middle.into(), 1e-6);
        let front = glam::dvec3(0.0, -1.0, 0.0) * size;
        let along_y =
            Sight { near: None, ..perspective((middle + front).into(), middle.into(), 1.0) };
        for sight in [general, along_y] {
            let scene = model(&path, sight);
            let edges = truth(&scene.positions, &scene.faces, &sight, boxed)
                .unwrap_or_else(|e| panic!("{name}: {e}"));
            let spans = engines::roberts(&scene).unwrap();
            if let Err(problem) = compare(&sight, &edges, &spans) {
                panic!("{name}, {sight:?}: {problem}");
            }
        }
    }
}
