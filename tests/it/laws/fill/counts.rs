//! What engines count, against what is known of scenes.

use super::regions::warnocks_pair;
use super::{built, painted};
use crate::models;
use crate::program::fill::fill;
use crate::program::text;
use crate::scenes::{Model, orthographic, perspective};
use glam::DVec2;
use hiddenline::stages::camera::framing::View;
use hiddenline::stages::engines::face::warnock::{Subdivision, WarnockOptions};
use hiddenline::stages::engines::face::{
    FaceEngine, FaceOptions, FaceWork, Prepared, bsp, octree, warnock,
};
use hiddenline::stages::engines::image::raster::Corners;
use hiddenline::stages::model::scene::Scene;
use serde_json::Value;

/// The `counts` that `fill --stats` prints for a model seen from above.
fn counts(obj: &str, engine: &str) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("model.obj");
    std::fs::write(&file, obj).unwrap();
    let path = file.to_str().unwrap();
    let output = fill(&[path, "--view", "top", "--engine", engine, "--stats"]);
    assert!(output.status.success(), "{engine}: {}", text(&output.stderr));
    let stats: Value = serde_json::from_str(text(&output.stderr).lines().last().unwrap()).unwrap();
    assert_eq!(stats["engine"], engine);
    stats["counts"].clone()
}

/// Three bars, each of which rises over the next one.
const BARS: &str = "v 0 0 0\nv 0 1 0\nv 6 .5 2\nv 5 0 0\nv 6 0 0\nv 2.5 6 2\n\
                    v 3 6 0\nv 4 6 0\nv .5 -1 2\nf 1 2 3\nf 4 5 6\nf 7 8 9\n";

#[test]
fn bars_that_overlap_in_turn_need_one_split() {
    let sorted = &counts(BARS, "depth-sort")["fill"];
    assert_eq!([&sorted["splits"], &sorted["fragments"]], [1, 4], "{sorted}");
    // No order without a split means that some test failed, and that bars were moved.
    assert!(sorted["settled"]["none"].as_u64() >= Some(3), "{sorted}");
    assert!(sorted["moves"].as_u64() >= Some(2), "{sorted}");
    let tree = &counts(BARS, "bsp")["fill"];
    let [splits, fragments, nodes] =
        ["splits", "fragments", "nodes"].map(|key| tree[key].as_u64().unwrap());
    assert!(splits >= 1 && fragments == 3 + splits && nodes <= fragments, "{tree}");
}

#[test]
fn what_edges_take_is_counted_beside() {
    let counts = counts(BARS, "weiler-atherton");
    assert_eq!(counts["fill"]["polygons"], 3);
    assert!(counts["fill"]["regions"].as_u64() >= Some(3));
    assert!(counts["fill"]["comparisons"].as_u64() >= Some(2));
    assert!(counts["candidate_pairs"].as_u64() > Some(0), "the edges are drawn, too: {counts}");
}

#[test]
fn faces_apart_are_settled_by_the_first_tests_and_never_compared() {
    let apart = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 3\nv 6 5 3\nv 5 6 3\nf 1 2 3\nf 4 5 6\n";
    let sorted = &counts(apart, "depth-sort")["fill"];
    assert_eq!([&sorted["splits"], &sorted["tests"], &sorted["fragments"]], [0, 0, 2], "{sorted}");
    assert_eq!(counts(apart, "weiler-atherton")["fill"]["comparisons"], 0);
}

#[test]
fn faces_that_pierce_each_other_cross_once() {
    let pair = "v 0 0 0\nv 4 0 4\nv 4 4 4\nv 0 4 0\nv 0 1 4\nv 4 1 0\nv 4 3 0\nv 0 3 4\n\
                f 1 2 3 4\nf 5 6 7 8\n";
    let found = &counts(pair, "weiler-atherton")["fill"];
    assert_eq!([&found["polygons"], &found["crossings"]], [2, 1], "{found}");
}

#[test]
fn windows_are_quartered_until_each_is_simple() {
    let (scene, camera) = built(&warnocks_pair());
    let window = Some((DVec2::new(-25.5, 9.5), DVec2::new(-9.5, 25.5)));
    let options = WarnockOptions { leaf: Some(1.0), window, subdivision: Subdivision::Regular };
    let (_, counts) = warnock::solve(&scene, &camera, &options).unwrap();
    let warnock::WarnockCounts { windows, divided, empty, covered, single, leaves } = counts;
    // 16 by 16 leaves: every window is one of four parts, but for the first.
    assert_eq!(windows, 1 + 4 * divided, "{counts:?}");
    assert_eq!(windows, divided + empty + covered + single + leaves, "{counts:?}");
    // At most the whole tree; the corners of the window are empty.
    assert!(divided < 1 + 4 + 16 + 64 && empty >= 4 && leaves > 0, "{counts:?}");
    // A window that is a leaf is never divided.
    let options = WarnockOptions { leaf: Some(16.0), ..options };
    let (_, counts) = warnock::solve(&scene, &camera, &options).unwrap();
    assert_eq!([counts.windows, counts.leaves, counts.divided], [1, 1, 0]);
}

#[test]
fn a_window_is_simple_where_one_face_is_in_front_of_all_others() {
    // Each plane cuts the other face, but beside the window; there the first face is nearer: it is at
    // 2 or more, and the second one nowhere above 1.8.
    let mut model = Model::default();
    model.face(&[[0.0, 0.0, 10.0], [8.0, 0.0, 2.0], [8.0, 16.0, 2.0], [0.0, 16.0, 10.0]]);
    let height = |x: f64, y: f64| 0.5 * x + 1.9 * y - 10.0;
    model.face(
        &[[0.0, 0.0], [16.0, 0.0], [16.0, 2.0], [0.0, 2.0]].map(|[x, y]| [x, y, height(x, y)]),
    );
    let sight = orthographic([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    let (scene, camera) = built(&model.seen_by("two slopes", sight));
    let window = Some((DVec2::ZERO, DVec2::splat(8.0)));
    let options = WarnockOptions { leaf: Some(1.0), window, subdivision: Subdivision::Regular };
    let (painting, counts) = warnock::solve(&scene, &camera, &options).unwrap();
    assert_eq!([counts.windows, counts.covered], [1, 1], "{counts:?}");
    assert!(painting.pieces().all(|piece| piece.face == 0));
}

#[test]
fn a_tree_of_planes_grows_as_boxes_beside_each_other_do() {
    let nodes = |n: u32| {
        let mut model = Model::default();
        for k in 0..n {
            let low = 3.0 * f64::from(k);
            model.add_box([low; 3], [low + 1.0; 3]);
        }
        let (scene, camera) =
            built(&model.seen_by("boxes", orthographic([1.0, 2.0, -3.0], [0.0, 0.0, 1.0])));
        let prepared = Prepared::new(&scene, FaceEngine::Bsp).unwrap();
        let (painting, work) = prepared.solve(&camera, &FaceOptions::default()).unwrap();
        let FaceWork::Bsp { counts, nodes, objects, hidden, .. } = work else { panic!("{work:?}") };
        assert_eq!(
            (counts.fragments, counts.splits, objects),
            (u64::from(12 * n), 0, u64::from(n))
        );
        assert_eq!(painting.len() as u64, hidden.painted);
        assert_eq!(hidden.painted + hidden.hidden_fragments, counts.fragments, "{hidden:?}");
        let all = bsp::solve(&scene, &camera).unwrap().0;
        assert_eq!(all.len() as u64, counts.fragments, "no side of a box is edge-on");
        nodes
    };
    // Each side is a plane, and no plane of one box has to cut another.
    assert_eq!(nodes(1), 6);
    for n in [4, 16, 64] {
        let found = nodes(n);
        eprintln!("{n} boxes: {found} nodes");
        assert!((6 * n as u64..8 * n as u64).contains(&found), "{n} boxes: {found} nodes");
    }
}

/// Objects that planes keep apart, and how often their faces are cut.
fn objects(model: Model) -> (u64, u64) {
    let (scene, camera) =
        built(&model.seen_by("objects", orthographic([1.0, 2.0, -3.0], [0.0, 0.0, 1.0])));
    let prepared = Prepared::new(&scene, FaceEngine::Bsp).unwrap();
    let (_, work) = prepared.solve(&camera, &FaceOptions::default()).unwrap();
    let FaceWork::Bsp { counts, objects, .. } = work else { panic!("{work:?}") };
    assert_eq!(counts.fragments, scene.triangles().len() as u64 + counts.splits);
    (objects, counts.splits)
}

#[test]
fn objects_that_a_plane_keeps_apart_are_not_cut() {
    let mut shelf = Model::default();
    for k in 0..60 {
        let [x, y, z] = [k % 4, k / 4 % 5, k / 20].map(|at| 3.0 * f64::from(at));
        shelf.add_box([x, y, z], [x + 2.0, y + 1.0 + z / 9.0, z + 2.5]);
    }
    assert_eq!(objects(shelf), (60, 0));
    // Long bars across: their boxes overlap, but each has another behind one of its sides.
    let mut bars = Model::default();
    for k in 0..8 {
        let low = 1.5 * f64::from(k);
        let across = |x: f64, y: f64, z: f64| [x - y + low, x + y + low, z];
        for z in [0.0, 1.0] {
            bars.face(&[
                across(0.0, -9.0, z),
                across(0.5, -9.0, z),
                across(0.5, 9.0, z),
                across(0.0, 9.0, z),
            ]);
        }
        for (from, to) in [
            ((0.0, -9.0), (0.5, -9.0)),
            ((0.5, -9.0), (0.5, 9.0)),
            ((0.5, 9.0), (0.0, 9.0)),
            ((0.0, 9.0), (0.0, -9.0)),
        ] {
            let side = [(from, 0.0), (to, 0.0), (to, 1.0), (from, 1.0)];
            bars.face(&side.map(|((x, y), z)| across(x, y, z)));
        }
    }
    assert_eq!(objects(bars), (8, 0));
    // Boxes that stand on each other touch; the plane between them is one of their sides.
    let mut tower = Model::default();
    for k in 0..5 {
        let (inset, z) = (0.25 * f64::from(k), f64::from(k));
        tower.add_box([inset, inset, z], [4.0 - inset, 5.0 - inset, z + 1.0]);
    }
    assert_eq!(objects(tower), (5, 0));
    // Two frames through each other like links of a chain.
    let mut chain = Model::default();
    let mut frame = |place: &dyn Fn(f64, f64, f64) -> [f64; 3]| {
        let ring = |r: f64| [(-r, -r), (r, -r), (r, r), (-r, r)];
        for k in 0..4 {
            let next = (k + 1) % 4;
            for (r, q) in [
                ((3.0, 0.0), (3.0, 1.0)),
                ((3.0, 1.0), (2.0, 1.0)),
                ((2.0, 1.0), (2.0, 0.0)),
                ((2.0, 0.0), (3.0, 0.0)),
            ] {
                let at = |(r, z): (f64, f64), k: usize| place(ring(r)[k].0, ring(r)[k].1, z);
                chain.face(&[at(r, k), at(r, next), at(q, next), at(q, k)]);
            }
        }
    };
    frame(&|x, y, z| [x, y, z]);
    frame(&|x, y, z| [x + 2.5, z - 0.5, y + 0.5]);
    let (objects, splits) = objects(chain);
    assert!(objects == 1 && splits > 0, "{objects}, {splits}");
}

#[test]
fn a_wall_hides_the_boxes_behind_it_from_the_tree_of_planes() {
    let mut model = Model::default();
    model.add_box([-20.0, -1.0, -20.0], [20.0, 0.0, 20.0]);
    for k in 0..40 {
        let [x, z] = [k % 8, k / 8].map(|at| 3.0 * f64::from(at) - 8.0);
        model.add_box([x, 3.0, z], [x + 1.0, 4.0, z + 1.0]);
    }
    let sight = perspective([1.0, -30.0, 2.0], [0.0, 0.0, 0.0], 1e-3);
    let (scene, camera) = built(&model.seen_by("a wall", sight));
    let tree = bsp::BspTree::new(&scene).unwrap();
    let (painting, hidden) = tree.paint_seen(&scene, &camera);
    assert!(painting.pieces().all(|piece| piece.face < 6), "{hidden:?}");
    assert!(hidden.hidden_boxes > 0 && hidden.hidden_boxes < 40, "boxes together: {hidden:?}");
    assert!(hidden.hidden_fragments >= 480, "{hidden:?}");
}

/// The cow, which has no face larger than a few squares of the quadtree.
fn cow() -> Scene {
    Scene::new(models::get("spot.obj").unwrap())
}

#[test]
fn a_fine_mesh_hides_its_own_back() {
    let scene = cow();
    let tree = octree::Octree::new(&scene).unwrap();
    let camera = View::default().camera(scene.mesh().bounds().unwrap()).unwrap();
    let (seen, hidden) = tree.paint_seen(&scene, &camera);
    let all = tree.paint(&scene, &camera);
    let n = tree.fragments().len() as u64;
    eprintln!("{n} fragments: {hidden:?}");
    assert_eq!(hidden.painted, seen.len() as u64);
    assert!(hidden.painted + hidden.hidden_fragments <= n);
    // A closed body turns half of its faces away, all of which it hides.
    assert!(hidden.hidden_fragments * 5 > n * 2, "{hidden:?} of {n}");
    assert!(hidden.hidden_boxes > 0, "{hidden:?}");
    let of_planes = bsp::solve(&scene, &camera).unwrap().0;
    let (low, high) = Corners::new(&scene, &camera).bounds().unwrap();
    let mut compared = 0;
    for k in 0..500 {
        // A sequence that fills a square evenly.
        let part = DVec2::new(0.754_877_67 * f64::from(k), 0.569_840_29 * f64::from(k)).fract();
        let at = low + (high - low) * part;
        let [a, b, c] = [&seen, &all, &of_planes].map(|painting| painted(painting, at));
        if a.1.min(b.1).min(c.1) > 1e-9 {
            assert_eq!([a.0, b.0], [c.0; 2], "at {at}");
            compared += u32::from(c.0.is_some());
        }
    }
    assert!(compared > 200, "only {compared} points on the cow");
}

#[test]
fn an_open_mesh_hides_nothing_beyond_its_rim() {
    // A fine sheet with a hole, and one face behind: what shows through the hole stays.
    let mut model = Model::default();
    let n = 60;
    let at = |i: i32, j: i32| [f64::from(i), f64::from(j), 0.0];
    let is_hole = |i: i32, j: i32| (28..32).contains(&i) && (28..32).contains(&j);
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        if !is_hole(i, j) {
            model.face(&[at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    let n_sheet = model.faces.len() as u32;
    for (i, j) in (0..10).flat_map(|i| (0..10).map(move |j| (i, j))) {
        let low = [25.0 + f64::from(i), 25.0 + f64::from(j), -5.0];
        let [x, y, z] = low;
        model.face(&[low, [x + 1.0, y, z], [x + 1.0, y + 1.0, z], [x, y + 1.0, z]]);
    }
    let sight = perspective([30.0, 30.0, 80.0], [30.0, 30.0, 0.0], 1e-3);
    let (scene, camera) = built(&model.seen_by("a sheet with a hole", sight));
    let tree = octree::Octree::new(&scene).unwrap();
    let (seen, hidden) = tree.paint_seen(&scene, &camera);
    let behind = seen.pieces().filter(|piece| piece.face >= n_sheet).count();
    eprintln!("{hidden:?}, {behind} pieces behind");
    assert!(hidden.hidden_fragments >= 60, "{hidden:?}");
    let shown = |x: f64, y: f64| {
        let image = camera.image(glam::DVec3::new(x, y, -5.0));
        painted(&seen, image).0.is_some_and(|face| face >= n_sheet)
    };
    for k in 0..20 {
        let along = 28.2 + 3.6 * f64::from(k) / 19.0;
        assert!(shown(along, 28.1) && shown(31.9, along), "at {along}");
    }
    assert!(!shown(27.5, 27.5) && !shown(33.0, 30.0));
}
