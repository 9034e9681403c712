//! Lines in which faces cross: where they are, and what hides them.

use crate::laws::engines::{camera, mesh};
use crate::oracle::compare::{EngineEdge, EngineSpan, compare};
use crate::oracle::exact::Point;
use crate::oracle::{EdgeTruth, World};
use crate::program::{hiddenline, text};
use crate::scenes::{
    Model, P, Rng, Scene as TestScene, number_of_scenes, orthographic, perspective, random,
};
use glam::DVec3;
use hiddenline::stages::classify::{LineSelection, ViewedScene};
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::engines::edge::{LineEngine, VisibilityOptions, solve};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::strokes::{HiddenLines, StrokeKind};

const INTERSECTIONS: LineSelection = LineSelection::NONE.with(StrokeKind::Intersection);

type Line = [DVec3; 2];

fn built(scene: &TestScene) -> Scene {
    Scene::new(mesh(scene)).with_intersections()
}

/// The lines in space, ends rounded.
fn lines(scene: &Scene) -> Vec<Line> {
    let point = |end: u32| scene.points()[end as usize];
    scene.intersections().lines().iter().map(|line| line.ends.map(point)).collect()
}

fn length([a, b]: Line) -> f64 {
    a.distance(b)
}

/// How much of a line some others cover together.
fn covered(line: Line, by: &[Line]) -> f64 {
    let along = (line[1] - line[0]).normalize();
    let off = |p: DVec3| (p - line[0]).reject_from_normalized(along).length();
    let at = |p: DVec3| (p - line[0]).dot(along).clamp(0.0, length(line));
    let mut parts: Vec<(f64, f64)> = by
        .iter()
        .filter(|other| other.iter().all(|&p| off(p) < 1e-9))
        .map(|other| (at(other[0]).min(at(other[1])), at(other[0]).max(at(other[1]))))
        .collect();
    parts.sort_by(|a, b| a.partial_cmp(b).unwrap());
    let (mut sum, mut end) = (0.0, 0.0);
    for (from, to) in parts {
        sum += (to - from.max(end)).max(0.0);
        end = to.max(end);
    }
    sum
}

/// Some line of `of` that `by` does not cover.
fn uncovered(of: &[Line], by: &[Line]) -> Option<Line> {
    of.iter().copied().find(|&line| length(line) - covered(line, by) > 1e-9)
}

#[track_caller]
fn assert_same_lines(name: &str, a: &[Line], b: &[Line]) {
    assert_eq!(uncovered(a, b), None, "{name}: only in the first");
    assert_eq!(uncovered(b, a), None, "{name}: only in the second");
}

fn from_above() -> crate::oracle::Sight {
    perspective([7.0, -9.0, 8.0], [0.0; 3], 1e-6)
}

fn crossing_boxes() -> TestScene {
    let mut model = Model::default();
    model.add_box([-2.0, -1.0, -1.0], [2.0, 1.0, 1.0]);
    model.add_box([-1.0, -2.0, -0.5], [1.0, 2.0, 1.5]);
    model.seen_by("crossing boxes", from_above())
}

/// Every face cut along the other diagonal, or in four around its middle.
fn cut(scene: &TestScene, in_four: bool) -> TestScene {
    let mut model = Model::default();
    for face in &scene.faces {
        let corners: Vec<P> = face.iter().map(|&v| scene.positions[v as usize]).collect();
        let [a, b, c, d] = corners[..] else {
            model.face(&corners);
            continue;
        };
        let is_parallelogram = (0..3).all(|i| a[i] + c[i] == b[i] + d[i]);
        if in_four && is_parallelogram {
            let middle = [0, 1, 2].map(|i| 0.5 * (a[i] + c[i]));
            for [p, q] in [[a, b], [b, c], [c, d], [d, a]] {
                model.face(&[p, q, middle]);
            }
        } else {
            model.face(&[a, b, d]);
            model.face(&[b, c, d]);
        }
    }
    model.seen_by(scene.name.clone(), scene.sight)
}

#[test]
fn crossing_boxes_meet_in_one_closed_loop_of_eight_lines() {
    let whole = crossing_boxes();
    for scene in [whole.clone(), cut(&whole, false), cut(&whole, true)] {
        let built = built(&scene);
        let found = lines(&built);
        assert_eq!(found.len(), 8);
        let total: f64 = found.iter().copied().map(length).sum();
        assert!((total - 14.0).abs() < 1e-12, "{total}");
        // Walking from line to line by the numbers of their ends leads once around.
        let mut left: Vec<[u32; 2]> =
            built.intersections().lines().iter().map(|line| line.ends).collect();
        let [start, mut here] = left.pop().unwrap();
        while let Some(next) = left.iter().position(|ends| ends.contains(&here)) {
            let [a, b] = left.swap_remove(next);
            here = if a == here { b } else { a };
        }
        assert!(left.is_empty() && here == start);
    }
}

#[test]
fn crossing_boxes_are_drawn_in_full_length_from_everywhere() {
    let boxes = crossing_boxes();
    let views = [
        from_above(),
        perspective([-5.0, -6.0, 1.0], [0.0; 3], 1e-6),
        perspective([0.5, 0.25, 9.0], [0.0; 3], 1e-6),
        orthographic([-1.0, 2.0, -1.5], [0.0, 0.0, 1.0]),
        orthographic([1.0, 1.0, -1.0], [0.0, 0.0, 1.0]),
    ];
    for sight in views {
        let scene = TestScene { sight, ..boxes.clone() };
        let built = built(&scene);
        let camera = camera(&scene);
        for (engine, exact) in [(LineEngine::Roberts, true), (LineEngine::Appel, false)] {
            let options = DrawOptions {
                lines: INTERSECTIONS,
                hidden: HiddenLines::Solid,
                engine,
                exact,
                shortest_stroke_mm: 0.0,
                pen_width_mm: 0.0,
                ..DrawOptions::default()
            };
            let drawing = draw(&built, &camera, &options, 1.0).drawing;
            assert!(drawing.iter().all(|stroke| stroke.kind == StrokeKind::Intersection));
            let drawn: f64 = drawing
                .iter()
                .flat_map(|stroke| stroke.points.windows(2))
                .map(|pair| pair[0].distance(pair[1]))
                .sum();
            let image = crate::oracle::compare::Image::new(&scene.sight);
            let expected: f64 = lines(&built)
                .iter()
                .map(|line| image.length(line.map(|p| p.to_array()), 0.0, 1.0))
                .sum();
            assert!((drawn - expected).abs() < 1e-12 * expected, "{drawn}, not {expected}");
            if !exact {
                let joined = drawing.iter().filter(|stroke| stroke.points.len() > 2).count();
                assert!(joined > 0, "corners join lines");
            }
        }
    }
}

#[test]
fn lines_of_intersection_are_those_of_the_truth() {
    let (mut n_scenes, mut n_lines) = (0, 0);
    for seed in 70_000..70_000 + number_of_scenes(3000) {
        let scene = random(seed);
        let world = World::new(&scene.positions, &scene.faces, &scene.sight);
        let Ok(truth) = world.crossings() else { continue };
        let truth: Vec<Line> = truth
            .iter()
            .map(|crossing| [0, 1].map(|i| DVec3::from(world.rounded(&crossing.ends[i]))))
            .collect();
        let found = lines(&built(&scene));
        assert_same_lines(&scene.name, &found, &truth);
        n_scenes += 1;
        n_lines += found.len();
    }
    assert!(n_lines > n_scenes, "{n_lines} lines in {n_scenes} scenes");
}

/// The lines as an engine sees them, and as the truth does.
fn seen(scene: &TestScene, built: &Scene, engine: LineEngine) -> Vec<EngineEdge> {
    let view = ViewedScene::new(built, &camera(scene), INTERSECTIONS, 30.0);
    let settings = VisibilityOptions { count_layers: true, ..VisibilityOptions::default() };
    let (visibility, counts, _) = solve(&view, engine, &settings);
    assert_eq!(counts.checksum_failures, 0);
    let drawn = view.selected().iter().enumerate();
    drawn
        .map(|(i, drawn)| EngineEdge {
            ends: built.line(drawn.edge).map(|end| built.points()[end as usize].to_array()),
            spans: visibility
                .spans(i)
                .iter()
                .map(|s| EngineSpan { t0: s.t0, t1: s.t1, qi: s.qi })
                .collect(),
        })
        .collect()
}

fn truth_about(scene: &TestScene, lines: &[Line]) -> Option<Vec<EdgeTruth>> {
    let world = World::new(&scene.positions, &scene.faces, &scene.sight);
    let ends = world.crossings().ok()?.into_iter().flat_map(|crossing| crossing.ends);
    let ends: Vec<_> = ends.map(|end| (DVec3::from(world.rounded(&end)), end)).collect();
    // Where tenths make two ends that round to nearly the same point, none of them is meant for
    // certain.
    let exact = |p: DVec3| {
        let mut near = ends.iter().filter(|(q, _)| p.distance(*q) < 1e-9).map(|(_, exact)| exact);
        let first = near.next()?;
        let is_same =
            |other: &Point| (0..3).all(|i| &first[i] * &other[3] == &other[i] * &first[3]);
        near.all(is_same).then_some(first)
    };
    let mut truth = Vec::new();
    for line in lines {
        let [mut a, mut b] = line.map(|p| p.to_array());
        if a > b {
            std::mem::swap(&mut a, &mut b);
        }
        truth.push(world.segment_truth([exact(a.into())?, exact(b.into())?], [a, b]));
    }
    Some(truth)
}

#[test]
fn lines_of_intersection_are_hidden_as_the_truth_says() {
    let (mut n_scenes, mut n_spans) = (0, 0);
    for seed in 80_000..80_000 + number_of_scenes(3000) {
        let scene = random(seed);
        let built = built(&scene);
        let mut all = lines(&built);
        let engines = [LineEngine::Roberts, LineEngine::Appel, LineEngine::AllPairs];
        let mut seen = engines.map(|engine| seen(&scene, &built, engine));
        assert_eq!(seen[0].len(), seen[1].len());
        // Three planes may meet in one line; it is then there several times.
        let once = || {
            let mut known = std::collections::BTreeSet::new();
            move |[a, b]: [P; 2]| {
                let key = if a < b { [a, b] } else { [b, a] };
                known.insert(key.map(|p| p.map(f64::to_bits)))
            }
        };
        for edges in &mut seen {
            let mut is_new = once();
            edges.retain(|edge| is_new(edge.ends));
        }
        let mut is_new = once();
        all.retain(|line| is_new(line.map(|p| p.to_array())));
        let Some(truth) = truth_about(&scene, &all) else { continue };
        for (edges, engine) in seen.iter().zip(engines) {
            compare(&scene.sight, &truth, edges)
                .unwrap_or_else(|e| panic!("{engine:?}, {}: {e}", scene.name));
        }
        n_scenes += 1;
        n_spans += truth.iter().map(|edge| edge.pieces.len()).sum::<usize>();
    }
    assert!(n_spans > n_scenes, "{n_spans} pieces in {n_scenes} scenes");
}

#[test]
fn boxes_that_touch_align_or_coincide_have_no_lines_of_intersection() {
    let low = [0.0; 3];
    let high = [4.0, 4.0, 2.0];
    let others: [(&str, P, P); 7] = [
        ("the same again", low, high),
        ("standing on it", [1.0, 1.0, 2.0], [3.0, 3.0, 5.0]),
        ("standing at its edge", [0.0, 1.0, 2.0], [3.0, 4.0, 5.0]),
        ("as large, on top", [0.0, 0.0, 2.0], [4.0, 4.0, 3.0]),
        ("shifted, on top", [1.0, -1.0, 2.0], [6.0, 3.0, 3.0]),
        ("beside it", [4.0, 1.0, 0.0], [5.0, 2.0, 2.0]),
        ("edge to edge", [4.0, -3.0, 2.0], [6.0, 4.0, 3.0]),
    ];
    for (name, a, b) in others {
        let mut model = Model::default();
        model.add_box(low, high);
        model.add_box(a, b);
        let whole = model.seen_by(name, from_above());
        for scene in [whole.clone(), cut(&whole, false), cut(&whole, true)] {
            assert_eq!(lines(&built(&scene)).len(), 0, "{name}");
        }
    }
}

#[test]
fn a_wall_crosses_a_floor_also_where_that_runs_along_its_edges() {
    let mut model = Model::default();
    let wall = |z: f64| [[0.0, -1.0, z], [0.0, 1.0, z]];
    let [a, b] = wall(0.0);
    let [c, d] = wall(2.0);
    model.face(&[a, b, d, c]);
    model.face(&[[-2.0, -2.0, 0.0], [2.0, -2.0, 0.0], [2.0, 2.0, 0.0], [-2.0, 2.0, 0.0]]);
    let standing = model.seen_by("standing wall", from_above());
    assert_eq!(lines(&built(&standing)).len(), 0);
    let mut model = Model { positions: standing.positions.clone(), faces: standing.faces.clone() };
    let [e, f] = wall(-1.0);
    model.face(&[e, f, b, a]);
    let sunk = model.seen_by("sunk wall", from_above());
    let scene = built(&sunk);
    assert_same_lines("sunk wall", &lines(&scene), &[[a.into(), b.into()]]);
    // DrawOutput once, also with all edges.
    let with_edges = LineSelection::all_edges().with(StrokeKind::Intersection);
    for (selection, n) in [(INTERSECTIONS, 1), (with_edges, 0), (LineSelection::default(), 1)] {
        let view = ViewedScene::new(&scene, &camera(&sunk), selection, 30.0);
        let drawn = view.selected().iter().filter(|d| d.kind == StrokeKind::Intersection).count();
        assert_eq!(drawn, n);
    }
}

/// Both surfaces have edges of their own where they cross, with different ends.
#[test]
fn surfaces_cross_also_where_that_runs_along_edges_of_both() {
    for (reach, expected) in [(2.0, 2.0), (-2.0, 0.0)] {
        let mut model = Model::default();
        let at = |x: f64, y: f64, z: f64| [x, y, z];
        // A V of two faces and another one, through it or leaning on it.
        for x in [-2.0, 2.0] {
            model.face(&[at(0.0, -3.0, 0.0), at(0.0, 3.0, 0.0), at(x, 0.0, 1.0)]);
        }
        for (x, z) in [(-1.0, 3.0), (reach / 4.0, if reach > 0.0 { -3.0 } else { 4.0 })] {
            model.face(&[at(0.0, -1.0, 0.0), at(0.0, 1.0, 0.0), at(x, 0.0, z)]);
        }
        let total: f64 =
            lines(&built(&model.seen_by("", from_above()))).into_iter().map(length).sum();
        assert_eq!(total, expected);
    }
}

#[test]
fn a_mesh_may_cross_itself_at_a_vertex_of_its_own() {
    let scene = TestScene {
        positions: vec![
            [0.0, 0.0, 0.0],
            [4.0, -1.0, 0.0],
            [4.0, 1.0, 0.0],
            [2.0, 0.0, -1.0],
            [2.0, 0.0, 1.0],
        ],
        faces: vec![vec![0, 1, 2], vec![0, 3, 4]],
        ..Model::default().seen_by("bow", from_above())
    };
    let scene = built(&scene);
    assert_eq!(scene.intersections().lines().len(), 1);
    assert_eq!(scene.intersections().points().len(), 1);
    assert_same_lines("bow", &lines(&scene), &[[DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0)]]);
}

/// Edges of more than two faces.
fn shared_edges(scene: &Scene) -> Vec<Line> {
    let topology = scene.topology();
    (0..topology.edges().len() as u32)
        .filter(|&edge| topology.uses(edge).len() > 2)
        .map(|edge| topology.edge(edge).map(|v| scene.points()[v as usize]))
        .collect()
}

#[test]
fn order_of_faces_and_how_they_are_cut_do_not_matter() {
    for seed in 90_000..90_000 + number_of_scenes(1000) {
        let scene = random(seed);
        if scene.is_in_tenths {
            continue;
        }
        let before = lines(&built(&scene));
        let mut shuffled = scene.clone();
        let mut rng = Rng(seed);
        rng.shuffle(&mut shuffled.faces);
        for face in &mut shuffled.faces {
            let start = rng.below(face.len());
            face.rotate_left(start);
        }
        let after = lines(&built(&shuffled));
        assert_same_lines(&scene.name, &before, &after);
        // Where diagonals become edges, two faces may come to share one.
        let cut = built(&cut(&scene, true));
        let with_shared = [lines(&cut), shared_edges(&cut)].concat();
        assert_eq!(uncovered(&before, &with_shared), None, "{}: not after the cut", scene.name);
        let with_shared = [before, shared_edges(&built(&scene))].concat();
        assert_eq!(uncovered(&lines(&cut), &with_shared), None, "{}: by the cut", scene.name);
    }
}

/// Runs the program on two crossing boxes, written apart, the second one where the `moves` put it.
fn draw_boxes(moves: &[&str], lines: &str) -> (String, String) {
    let folder = tempfile::tempdir().unwrap();
    let obj = |a: P, b: P| {
        let mut model = Model::default();
        model.add_box(a, b);
        let vertices: String =
            model.positions.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
        let faces: String = model
            .faces
            .iter()
            .map(|f| format!("f {} {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1, f[3] + 1))
            .collect();
        vertices + &faces
    };
    std::fs::write(folder.path().join("a.obj"), obj([-2.0, -1.0, -1.0], [2.0, 1.0, 1.0])).unwrap();
    std::fs::write(folder.path().join("b.obj"), obj([-1.0, -2.0, 4.5], [1.0, 2.0, 6.5])).unwrap();
    let mut arguments = vec!["draw", "a.obj", "b.obj", "--exact", "--hidden", "solid", "--stats"];
    arguments.extend(["--format", "json", "--lines", lines]);
    arguments.extend(moves.iter().flat_map(|by| ["--move", by]));
    let output = hiddenline(folder.path(), &arguments);
    (text(&output.stdout), text(&output.stderr))
}

#[test]
fn models_cross_where_they_are_moved_to() {
    let kinds = |json: &str, kind: &str| json.matches(&format!("\"kind\":\"{kind}\"")).count();
    let (json, stats) = draw_boxes(&["0,0,0", "0,0,-5"], "intersection");
    assert_eq!(kinds(&json, "intersection"), 8, "{json}");
    assert!(stats.contains("\"intersections\":8"), "{stats}");
    let (json, _) = draw_boxes(&["0,0,0", "0,0,-5"], "all,intersection");
    assert!(kinds(&json, "intersection") >= 8 && kinds(&json, "crease") > 0, "{json}");
    // Moved alike they do not meet; and nothing is looked for that is not asked for.
    let (json, stats) = draw_boxes(&["0,0,-5"], "intersection");
    assert_eq!((kinds(&json, "intersection"), json.matches("\"kind\"").count()), (0, 0));
    assert!(stats.contains("\"intersections\":0"), "{stats}");
    let (_, stats) = draw_boxes(&["0,0,0", "0,0,-5"], "all");
    assert!(stats.contains("\"intersection_pairs\":0"), "{stats}");
    let (_, message) = draw_boxes(&["0,0,0", "0,0,-5", "1,0,0"], "all");
    assert!(message.contains("--move is given 3 times for 2 models"), "{message}");
}

#[test]
fn sizes_beyond_single_precision_change_nothing() {
    let mut n_lines = 0;
    for seed in 0..30 {
        let scene = random(seed);
        let expected = lines(&built(&scene));
        n_lines += expected.len();
        for exponent in [-400, -140, 127, 140, 400] {
            let factor = 2f64.powi(exponent);
            let mut scaled = random(seed);
            scaled.positions.iter_mut().flatten().for_each(|x| *x *= factor);
            let found = lines(&built(&scaled));
            assert_eq!(found.len(), expected.len(), "{seed}, 2^{exponent}");
            for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
                let off = (*found / factor - *expected).length();
                assert!(off < 1e-12, "{seed}, 2^{exponent}: {off}");
            }
        }
    }
    assert!(n_lines > 40, "{n_lines}");
}
