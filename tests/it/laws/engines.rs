//! The line engines of the library, as the tests see them.

use crate::laws::invariance::Solve;
use crate::oracle::compare::{EngineEdge, EngineSpan, compare, truth_of};
use crate::oracle::{EdgeTruth, Kind, Settings as TruthSettings, truth};
use crate::scenes::{Scene as TestScene, number_of_scenes, random};
use glam::DVec3;
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::classify::{LineSelection, ViewedScene};
use hiddenline::stages::engines::edge::{LineEngine, VisibilityOptions, solve};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::strokes::StrokeKind;

pub(crate) fn mesh(scene: &TestScene) -> Mesh {
    let mut soup = PolygonSoup {
        positions: scene.positions.iter().map(|&p| DVec3::from(p)).collect(),
        ..PolygonSoup::default()
    };
    for face in &scene.faces {
        soup.push_face(face);
    }
    Mesh::new(soup).unwrap().0
}

pub(crate) fn camera(scene: &TestScene) -> Camera {
    let sight = &scene.sight;
    let projection = match sight.near {
        Some(near) => Projection::Perspective { fov_deg: 40.0, near },
        None => Projection::Orthographic,
    };
    Camera::new(sight.eye.into(), sight.target.into(), sight.up.into(), projection).unwrap()
}

/// The drawn edges of a scene with their kinds.
pub(crate) fn solve_with(
    scene: &TestScene,
    engine: LineEngine,
    lines: LineSelection,
    settings: &VisibilityOptions,
) -> Vec<(StrokeKind, EngineEdge)> {
    let built = Scene::new(mesh(scene));
    let view = ViewedScene::new(&built, &camera(scene), lines, 30.0);
    let (visibility, counts, _) = solve(&view, engine, settings);
    assert_eq!((counts.checksum_failures, counts.fallback_edges), (0, 0), "{}", scene.name);
    assert_eq!(visibility.len(), view.selected().len());
    let position = |v: u32| built.mesh().positions()[v as usize].to_array();
    view.selected()
        .iter()
        .enumerate()
        .map(|(i, drawn)| {
            let mut spans: Vec<EngineSpan> = Vec::new();
            for s in visibility.spans(i) {
                match spans.last_mut() {
                    // Told apart by `doubled` alone.
                    Some(last) if last.qi == s.qi && settings.find_doubled => last.t1 = s.t1,
                    _ => spans.push(EngineSpan { t0: s.t0, t1: s.t1, qi: s.qi }),
                }
            }
            let ends = built.topology().edge(drawn.edge).map(position);
            (drawn.kind, EngineEdge { ends, spans })
        })
        .collect()
}

const COUNTED: VisibilityOptions =
    VisibilityOptions { count_layers: true, ..VisibilityOptions::EXACT };

fn all_edges(scene: &TestScene, engine: LineEngine) -> Option<Vec<EngineEdge>> {
    let drawn = solve_with(scene, engine, LineSelection::all_edges(), &COUNTED);
    Some(drawn.into_iter().map(|(_, edge)| edge).collect())
}

/// All engines by name.
pub(crate) const ALL: [(&str, Solve); 3] =
    [("roberts", roberts), ("all pairs", all_pairs), ("appel", appel)];

/// Roberts with its index over the image.
pub(crate) fn roberts(scene: &TestScene) -> Option<Vec<EngineEdge>> {
    all_edges(scene, LineEngine::Roberts)
}

/// Roberts with all pairs.
pub(crate) fn all_pairs(scene: &TestScene) -> Option<Vec<EngineEdge>> {
    all_edges(scene, LineEngine::AllPairs)
}

/// Appel's quantitative invisibility.
pub(crate) fn appel(scene: &TestScene) -> Option<Vec<EngineEdge>> {
    all_edges(scene, LineEngine::Appel)
}

/// Compares `n` random scenes and reports the smallest that differs.
pub(crate) fn assert_truth(
    first: u64,
    n: u64,
    check: impl Fn(&TestScene, &[EdgeTruth]) -> Result<(), String>,
) {
    let mut failures: Vec<(usize, String)> = Vec::new();
    let mut n_checked = 0;
    for seed in first..first + number_of_scenes(n) {
        let scene = random(seed);
        let Some(edges) = truth_of(&scene) else {
            continue;
        };
        n_checked += 1;
        if let Err(problem) = check(&scene, &edges) {
            let size = scene.positions.len();
            let scene = smallest(&scene, &check);
            failures.push((size, format!("{}: {problem}\nsmallest: {scene:?}", scene.name)));
        }
        if failures.len() >= 20 {
            break;
        }
    }
    failures.sort();
    if let Some((_, failure)) = failures.first() {
        panic!("{} of {n_checked} scenes differ, the smallest:\n{failure}", failures.len());
    }
}

/// Takes faces away as long as the check still fails.
fn smallest(
    scene: &TestScene,
    check: &impl Fn(&TestScene, &[EdgeTruth]) -> Result<(), String>,
) -> TestScene {
    let mut scene = scene.clone();
    let mut i = 0;
    while i < scene.faces.len() {
        let mut less = scene.clone();
        less.faces.remove(i);
        if truth_of(&less).is_some_and(|edges| check(&less, &edges).is_err()) {
            scene = less;
        } else {
            i += 1;
        }
    }
    let faces = scene.faces.clone();
    scene.positions = faces.iter().flatten().map(|&v| scene.positions[v as usize]).collect();
    let mut next = 0..;
    for v in scene.faces.iter_mut().flatten() {
        *v = next.next().unwrap();
    }
    scene
}

fn hides_as_the_truth_says(solve: Solve, first: u64) {
    assert_truth(first, 4000, |scene, edges| {
        let Some(spans) = solve(scene) else {
            return Ok(());
        };
        compare(&scene.sight, edges, &spans).map(|_| ())
    });
}

#[test]
fn roberts_hides_as_the_truth_says() {
    hides_as_the_truth_says(roberts, 0);
}

#[test]
fn appel_hides_as_the_truth_says() {
    hides_as_the_truth_says(appel, 50_000);
}

#[test]
fn all_pairs_hide_as_the_truth_says() {
    hides_as_the_truth_says(all_pairs, 10_000);
}

/// Spans without counting layers, and with doubled lines marked, as drawings use them.
#[test]
fn drawings_hide_as_the_truth_says_without_counting() {
    assert_truth(20_000, 2000, |scene, edges| {
        let mut flat = edges.to_vec();
        for edge in &mut flat {
            edge.pieces.iter_mut().for_each(|p| p.qi = p.qi.min(1));
        }
        let settings = VisibilityOptions { find_doubled: true, ..VisibilityOptions::default() };
        for engine in [LineEngine::Roberts, LineEngine::Appel] {
            let drawn = solve_with(scene, engine, LineSelection::all_edges(), &settings);
            let mut spans: Vec<EngineEdge> = drawn.into_iter().map(|(_, edge)| edge).collect();
            for span in spans.iter_mut().flat_map(|e| &mut e.spans) {
                span.qi = span.qi.min(1);
            }
            compare(&scene.sight, &flat, &spans).map_err(|e| format!("{engine:?}: {e}"))?;
        }
        Ok(())
    });
}

#[test]
fn contact_within_the_tolerance_hides_nothing() {
    for tolerance in [1e-9, 0.5, 1.0] {
        let settings = VisibilityOptions { contact_tolerance: tolerance, ..COUNTED };
        for seed in 30_000..30_000 + number_of_scenes(400) {
            let scene = random(seed);
            let of_truth = TruthSettings { contact_tolerance: tolerance, ..Default::default() };
            let Ok(edges) = truth(&scene.positions, &scene.faces, &scene.sight, of_truth) else {
                continue;
            };
            for engine in [LineEngine::Roberts, LineEngine::Appel] {
                let drawn = solve_with(&scene, engine, LineSelection::all_edges(), &settings);
                let spans: Vec<EngineEdge> = drawn.into_iter().map(|(_, edge)| edge).collect();
                compare(&scene.sight, &edges, &spans).unwrap_or_else(|e| {
                    panic!("{engine:?}, {}, tolerance {tolerance}: {e}", scene.name)
                });
            }
        }
    }
}

fn name(kind: Kind) -> StrokeKind {
    match kind {
        Kind::Boundary => StrokeKind::Boundary,
        Kind::Nonmanifold => StrokeKind::Nonmanifold,
        Kind::Silhouette => StrokeKind::Silhouette,
        Kind::Crease => StrokeKind::Crease,
        Kind::Mesh => StrokeKind::Mesh,
    }
}

#[test]
fn edges_are_of_the_kind_the_truth_says_and_selected_by_any() {
    let selections = [
        vec![Kind::Boundary, Kind::Nonmanifold, Kind::Silhouette, Kind::Crease],
        vec![Kind::Crease],
        vec![Kind::Silhouette, Kind::Boundary],
        vec![Kind::Boundary, Kind::Nonmanifold, Kind::Silhouette, Kind::Crease, Kind::Mesh],
    ];
    assert_truth(40_000, 2000, |scene, edges| {
        for selection in &selections {
            let lines = selection.iter().fold(LineSelection::NONE, |l, &k| l.with(name(k)));
            let drawn = solve_with(scene, LineEngine::Roberts, lines, &COUNTED);
            for edge in edges.iter().filter(|e| !e.pieces.is_empty()) {
                let Some(kinds) = edge.kinds(30.0) else {
                    continue;
                };
                let all = selection.contains(&Kind::Mesh);
                let expected =
                    (all || kinds.iter().any(|k| selection.contains(k))).then(|| name(kinds[0]));
                let got = drawn
                    .iter()
                    .find(|(_, d)| d.ends == edge.ends || d.ends == [edge.ends[1], edge.ends[0]])
                    .map(|(kind, _)| *kind);
                if got != expected {
                    return Err(format!("{:?} is {got:?}, not {expected:?}", edge.ends));
                }
            }
        }
        Ok(())
    });
}
