//! Laws that hold for every line engine: what may be done to a scene without changing its drawing.
//!
//! The exact oracle is subjected to them as well, under the name `oracle`.

use crate::oracle::compare::{EngineEdge, EngineSpan, truth_of};
use crate::oracle::{Kind, Sight};
use crate::scenes::{Model, P, Rng, Scene, number_of_scenes, random};
use std::collections::BTreeMap;

/// What an engine says about a scene; `None` when it cannot take it.
pub(crate) type Solve = fn(&Scene) -> Option<Vec<EngineEdge>>;

type Bits = [u64; 3];

/// Spans by edge, t from the smaller end.
type Picture = BTreeMap<[Bits; 2], Vec<EngineSpan>>;

const TINY: f64 = 1e-9;

fn bits(p: P) -> Bits {
    p.map(|x| if x == 0.0 { 0 } else { x.to_bits() })
}

/// The picture with every vertex moved back by `back`.
fn picture(edges: Vec<EngineEdge>, back: impl Fn(P) -> P) -> Picture {
    edges
        .into_iter()
        .filter(|e| !e.spans.is_empty())
        .map(|e| {
            let [a, b] = e.ends.map(&back);
            let turned = |s: &EngineSpan| EngineSpan { t0: 1.0 - s.t1, t1: 1.0 - s.t0, qi: s.qi };
            if a < b {
                ([bits(a), bits(b)], e.spans)
            } else {
                ([bits(b), bits(a)], e.spans.iter().rev().map(turned).collect())
            }
        })
        .collect()
}

fn is_same(a: &[EngineSpan], b: &[EngineSpan]) -> bool {
    let long = |spans: &[EngineSpan]| -> Vec<EngineSpan> {
        spans.iter().copied().filter(|s| s.t1 - s.t0 > TINY).collect()
    };
    let (a, b) = (long(a), long(b));
    a.len() == b.len()
        && a.iter()
            .zip(&b)
            .all(|(x, y)| x.qi == y.qi && (x.t0 - y.t0).abs() < TINY && (x.t1 - y.t1).abs() < TINY)
}

fn assert_same(scene: &Scene, before: &Picture, after: &Picture) {
    for (edge, spans) in before {
        let ends = edge.map(|p| p.map(f64::from_bits));
        let other = after.get(edge).map_or(&[][..], |s| s);
        assert!(is_same(spans, other), "{}: {ends:?}\n{spans:?}\n{other:?}", scene.name);
    }
    let extra = after.keys().find(|e| !before.contains_key(*e));
    let extra = extra.map(|e| e.map(|p| p.map(f64::from_bits)));
    assert_eq!(extra, None, "{}: an edge appears", scene.name);
}

fn moved(scene: &Scene, place: impl Fn(P) -> P, turn: impl Fn(P) -> P) -> Scene {
    let sight = Sight {
        eye: place(scene.sight.eye),
        target: place(scene.sight.target),
        up: turn(scene.sight.up),
        near: scene.sight.near,
    };
    Scene { positions: scene.positions.iter().map(|&p| place(p)).collect(), sight, ..scene.clone() }
}

/// Draws `n` scenes before and after `change`; `back` undoes what it does to a vertex.
fn assert_unchanged(
    solve: Solve,
    first: u64,
    change: impl Fn(&Scene, &mut Rng) -> Scene,
    back: impl Fn(P) -> P,
) {
    let mut n_drawn = 0;
    let n = number_of_scenes(60);
    for seed in first..first + n {
        let scene = random(seed);
        if scene.is_in_tenths {
            continue; // turning and splitting would round
        }
        let after = change(&scene, &mut Rng(seed));
        let (Some(a), Some(b)) = (solve(&scene), solve(&after)) else {
            continue;
        };
        n_drawn += 1;
        assert_same(&scene, &picture(a, |p| p), &picture(b, &back));
    }
    assert!(n_drawn > n / 2, "only {n_drawn} of {n} scenes were drawn");
}

pub(crate) fn turning_scene_and_camera_by_a_right_angle_changes_nothing(solve: Solve) {
    let turn = |p: P| [-p[1], p[0], p[2]];
    assert_unchanged(solve, 1000, |s, _| moved(s, turn, turn), |p| [p[1], -p[0], p[2]]);
    let cycle = |p: P| [p[2], p[0], p[1]];
    assert_unchanged(solve, 1100, |s, _| moved(s, cycle, cycle), |p| [p[1], p[2], p[0]]);
}

pub(crate) fn scaling_by_a_power_of_two_changes_nothing(solve: Solve) {
    for k in [-400, -345, -40, 3, 35, 400] {
        let (up, down) = (2f64.powi(k), 2f64.powi(-k));
        let scale = |p: P| p.map(|x| x * up);
        assert_unchanged(solve, 2000, |s, _| moved(s, scale, |p| p), |p| p.map(|x| x * down));
    }
}

pub(crate) fn mirroring_scene_and_camera_changes_nothing(solve: Solve) {
    let mirror = |p: P| [-p[0], p[1], p[2]];
    assert_unchanged(solve, 3000, |s, _| moved(s, mirror, mirror), mirror);
}

pub(crate) fn moving_by_integers_changes_nothing(solve: Solve) {
    let far = [1024.0, -4096.0, 65536.0];
    let place = |p: P| [0, 1, 2].map(|i| p[i] + far[i]);
    let back = |p: P| [0, 1, 2].map(|i| p[i] - far[i]);
    assert_unchanged(solve, 3500, |s, _| moved(s, place, |p| p), back);
}

pub(crate) fn face_order_does_not_matter(solve: Solve) {
    let shuffled = |s: &Scene, rng: &mut Rng| {
        let mut s = s.clone();
        rng.shuffle(&mut s.faces);
        s
    };
    assert_unchanged(solve, 4000, shuffled, |p| p);
}

pub(crate) fn vertex_order_does_not_matter(solve: Solve) {
    let renumbered = |s: &Scene, rng: &mut Rng| {
        let mut order: Vec<u32> = (0..s.positions.len() as u32).collect();
        rng.shuffle(&mut order);
        let mut s = s.clone();
        let old = s.positions.clone();
        for (from, &to) in order.iter().enumerate() {
            s.positions[to as usize] = old[from];
        }
        for face in &mut s.faces {
            for v in face.iter_mut() {
                *v = order[*v as usize];
            }
            let start = rng.below(face.len());
            face.rotate_left(start);
        }
        s
    };
    assert_unchanged(solve, 5000, renumbered, |p| p);
}

pub(crate) fn winding_does_not_matter_to_what_is_hidden(solve: Solve) {
    let turned_over = |s: &Scene, rng: &mut Rng| {
        let mut s = s.clone();
        for face in &mut s.faces {
            if rng.one_in(2) {
                face.reverse();
            }
        }
        s
    };
    assert_unchanged(solve, 6000, turned_over, |p| p);
}

pub(crate) fn a_wall_behind_everything_changes_nothing(solve: Solve) {
    let n = number_of_scenes(60);
    for seed in 7000..7000 + n {
        let scene = random(seed);
        // Across the view, a thousand times the way from eye to target behind it.
        let forward = scene.sight.forward();
        let up = scene.sight.up;
        let cross = |a: P, b: P| {
            [0, 1, 2].map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                a[j] * b[k] - a[k] * b[j]
            })
        };
        let right = cross(forward, up);
        let upward = cross(right, forward);
        let corner = |x: f64, y: f64| {
            [0, 1, 2]
                .map(|i| scene.sight.target[i] + 1000.0 * forward[i] + x * right[i] + y * upward[i])
        };
        let mut walled = scene.clone();
        let first = walled.positions.len() as u32;
        let corners = [(-1e6, -1e6), (1e6, -1e6), (0.0, 1e6)].map(|(x, y)| corner(x, y));
        walled.positions.extend(corners);
        walled.faces.push(vec![first, first + 1, first + 2]);
        let (Some(a), Some(b)) = (solve(&scene), solve(&walled)) else {
            continue;
        };
        let mut after = picture(b, |p| p);
        after.retain(|e, _| !e.iter().all(|p| corners.iter().any(|&c| bits(c) == *p)));
        assert_same(&scene, &picture(a, |p| p), &after);
    }
}

/// Every face of a box in four, meeting in its middle; counts are those of the whole faces.
pub(crate) fn splitting_coplanar_faces_changes_nothing(solve: Solve) {
    let split = |s: &Scene, rng: &mut Rng| {
        let mut model = Model::default();
        for face in &s.faces {
            let corners: Vec<P> = face.iter().map(|&v| s.positions[v as usize]).collect();
            let is_parallelogram = corners.len() == 4
                && (0..3).all(|i| corners[0][i] + corners[2][i] == corners[1][i] + corners[3][i]);
            if is_parallelogram && !rng.one_in(4) {
                let middle = [0, 1, 2].map(|i| 0.5 * (corners[0][i] + corners[2][i]));
                for k in 0..4 {
                    model.face(&[corners[k], corners[(k + 1) % 4], middle]);
                }
            } else {
                model.face(&corners);
            }
        }
        model.seen_by(s.name.clone(), s.sight)
    };
    let n = number_of_scenes(60);
    for seed in 8000..8000 + n {
        let scene = random(seed);
        if scene.is_in_tenths {
            continue;
        }
        let after = split(&scene, &mut Rng(seed));
        let (Some(a), Some(b)) = (solve(&scene), solve(&after)) else {
            continue;
        };
        let before = picture(a, |p| p);
        let mut after = picture(b, |p| p);
        after.retain(|edge, _| before.contains_key(edge));
        assert_same(&scene, &before, &after);
    }
}

pub(crate) fn spans_follow_each_other_without_gaps(solve: Solve) {
    for seed in 9000..9000 + number_of_scenes(100) {
        let scene = random(seed);
        let Some(edges) = solve(&scene) else { continue };
        for e in &edges {
            for pair in e.spans.windows(2) {
                assert_eq!(pair[0].t1, pair[1].t0, "{}: {e:?}", scene.name);
                assert_ne!(pair[0].qi, pair[1].qi, "{}: {e:?}", scene.name);
            }
            let Some((first, last)) = e.spans.first().zip(e.spans.last()) else {
                continue;
            };
            assert!(first.t0 >= 0.0 && last.t1 <= 1.0, "{}: {e:?}", scene.name);
            if scene.sight.near.is_none() {
                assert_eq!((first.t0, last.t1), (0.0, 1.0), "{}: {e:?}", scene.name);
            }
        }
    }
}

fn by_the_oracle(scene: &Scene) -> Option<Vec<EngineEdge>> {
    let span =
        |p: &crate::oracle::Piece| EngineSpan { t0: p.t0.to_f64(), t1: p.t1.to_f64(), qi: p.qi };
    let edges = truth_of(scene)?;
    Some(
        edges
            .iter()
            .map(|e| EngineEdge { ends: e.ends, spans: e.pieces.iter().map(span).collect() })
            .collect(),
    )
}

#[test]
fn kinds_do_not_depend_on_the_winding_of_the_whole() {
    for seed in 0..60 {
        let scene = random(seed);
        let mut inside_out = scene.clone();
        inside_out.faces.iter_mut().for_each(|f| f.reverse());
        let (Some(a), Some(b)) = (truth_of(&scene), truth_of(&inside_out)) else {
            continue;
        };
        for (x, y) in a.iter().zip(&b) {
            // An edge-on face is "not front" on either side, so only the others are compared.
            let crease = |e: &crate::oracle::EdgeTruth| e.crease(30.0);
            assert_eq!((x.n_uses, crease(x)), (y.n_uses, crease(y)), "{}", scene.name);
            assert!(x.n_uses != 1 || x.kinds(30.0) == Some(vec![Kind::Boundary]));
        }
    }
}

/// All laws for one engine.
macro_rules! laws {
    ($engine:ident, $solve:expr) => {
        laws!($engine, $solve;
            turning_scene_and_camera_by_a_right_angle_changes_nothing,
            scaling_by_a_power_of_two_changes_nothing,
            mirroring_scene_and_camera_changes_nothing,
            moving_by_integers_changes_nothing,
            face_order_does_not_matter,
            vertex_order_does_not_matter,
            winding_does_not_matter_to_what_is_hidden,
            a_wall_behind_everything_changes_nothing,
            splitting_coplanar_faces_changes_nothing,
            spans_follow_each_other_without_gaps
        );
    };
    ($engine:ident, $solve:expr; $($law:ident),*) => {
        mod $engine {
            $(
                #[test]
                fn $law() {
                    super::$law($solve);
                }
            )*
        }
    };
}

laws!(oracle, super::by_the_oracle);
laws!(roberts, crate::laws::engines::roberts);
laws!(appel, crate::laws::engines::appel);
laws!(all_pairs, crate::laws::engines::all_pairs);
