//! Comparing an engine with the truth: by intervals of edges, and by the union of images.

use crate::oracle::ray_cast::agrees_with;
use crate::oracle::{EdgeTruth, Settings, Sight, truth};
use crate::scenes::{Scene, number_of_scenes, random};

/// What an engine says about one part of an edge; t runs from the smaller end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EngineSpan {
    pub t0: f64,
    pub t1: f64,
    pub qi: u32,
}

/// What an engine says about one edge.
#[derive(Clone, Debug)]
pub(crate) struct EngineEdge {
    /// Its ends in either order; spans run from the first.
    pub ends: [[f64; 3]; 2],
    pub spans: Vec<EngineSpan>,
}

/// Lengths in the image.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Difference {
    /// Drawn, but hidden in truth.
    pub false_visible: f64,
    /// Visible in truth, but not drawn.
    pub missing: f64,
    /// Visible in truth.
    pub total: f64,
    /// The largest image coordinate: what a rounding error is measured by.
    pub largest: f64,
}

impl Difference {
    pub(crate) fn is_small(&self) -> bool {
        self.false_visible + self.missing <= 1e-9 * self.total + 1e-12 * self.largest
    }
}

/// Image coordinates in `f64`.
pub(crate) struct Image {
    sight: Sight,
    right: [f64; 3],
    upward: [f64; 3],
    forward: [f64; 3],
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

fn normalized(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

impl Image {
    pub(crate) fn new(sight: &Sight) -> Self {
        let forward = normalized(sight.forward());
        let right = normalized(cross(forward, sight.up));
        let upward = cross(right, forward);
        Self { sight: *sight, right, upward, forward }
    }

    pub(crate) fn of(&self, p: [f64; 3]) -> [f64; 2] {
        let d = [0, 1, 2].map(|i| p[i] - self.sight.eye[i]);
        let depth = if self.sight.near.is_some() { dot(d, self.forward) } else { 1.0 };
        [dot(d, self.right) / depth, dot(d, self.upward) / depth]
    }

    pub(crate) fn at(&self, ends: [[f64; 3]; 2], t: f64) -> [f64; 2] {
        // Both ends exact, so that edges meet in the image where they do in space.
        self.of([0, 1, 2].map(|i| ends[0][i] * (1.0 - t) + ends[1][i] * t))
    }

    pub(crate) fn length(&self, ends: [[f64; 3]; 2], t0: f64, t1: f64) -> f64 {
        distance(self.at(ends, t0), self.at(ends, t1))
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Compares intervals edge by edge.
///
/// Every edge of the truth whose image is no point must be there, with the same count of covering
/// triangles everywhere but on 1e-9 of its length in space; the image lengths are summed.
///
/// # Errors
/// What differs, in words.
pub(crate) fn compare(
    sight: &Sight,
    truth: &[EdgeTruth],
    engine: &[EngineEdge],
) -> Result<Difference, String> {
    let image = Image::new(sight);
    let mut found = std::collections::HashMap::new();
    for edge in engine {
        let [a, b] = edge.ends;
        let (key, spans) = if a < b {
            ([a, b], edge.spans.clone())
        } else {
            let turned = |s: &EngineSpan| EngineSpan { t0: 1.0 - s.t1, t1: 1.0 - s.t0, qi: s.qi };
            ([b, a], edge.spans.iter().rev().map(turned).collect())
        };
        if found.insert(key.map(|p| p.map(f64::to_bits)), spans).is_some() {
            return Err(format!("edge {key:?} is there twice"));
        }
    }
    let mut difference = Difference::default();
    let mut problem = None;
    for edge in truth {
        let spans = found.remove(&edge.ends.map(|p| p.map(f64::to_bits))).unwrap_or_default();
        let pieces: Vec<EngineSpan> = edge
            .pieces
            .iter()
            .map(|p| EngineSpan { t0: p.t0.to_f64(), t1: p.t1.to_f64(), qi: p.qi })
            .collect();
        let mut cuts: Vec<f64> = spans.iter().chain(&pieces).flat_map(|s| [s.t0, s.t1]).collect();
        cuts.sort_by(f64::total_cmp);
        let mut wrong = 0.0;
        for pair in cuts.windows(2) {
            let (t0, t1) = (pair[0], pair[1]);
            let at =
                |list: &[EngineSpan]| list.iter().find(|s| s.t0 <= t0 && t1 <= s.t1).map(|s| s.qi);
            let (expected, got) = (at(&pieces), at(&spans));
            if expected != got {
                wrong += t1 - t0;
            }
            let ends = [image.at(edge.ends, t0), image.at(edge.ends, t1)];
            let length = distance(ends[0], ends[1]);
            for x in ends.as_flattened() {
                difference.largest = difference.largest.max(x.abs());
            }
            match (expected == Some(0), got == Some(0)) {
                (true, true) => difference.total += length,
                (true, false) => {
                    difference.total += length;
                    difference.missing += length;
                }
                (false, true) => difference.false_visible += length,
                (false, false) => {}
            }
        }
        if wrong > 1e-9 && problem.is_none() {
            problem = Some(format!(
                "edge {:?}\n  truth  {}\n  engine {}",
                edge.ends,
                in_words(&pieces),
                in_words(&spans)
            ));
        }
    }
    if problem.is_none() && !difference.is_small() {
        problem = Some("lengths in the image".into());
    }
    if let Some(edge) = found.keys().next() {
        problem = Some(format!("no such edge: {:?}", edge.map(|p| p.map(f64::from_bits))));
    }
    match problem {
        None => Ok(difference),
        Some(problem) => Err(format!("{problem}\n{difference:?}")),
    }
}

fn in_words(spans: &[EngineSpan]) -> String {
    let words: Vec<String> =
        spans.iter().map(|s| format!("[{:.9}, {:.9}] qi {}", s.t0, s.t1, s.qi)).collect();
    if words.is_empty() { "nothing".into() } else { words.join(", ") }
}

type Segment = [[f64; 2]; 2];

/// The visible segments of the edges that `selected` takes.
pub(crate) fn visible_segments(
    sight: &Sight,
    truth: &[EdgeTruth],
    selected: impl Fn(&EdgeTruth) -> bool,
) -> Vec<Segment> {
    let image = Image::new(sight);
    let of = |e: &EdgeTruth, t: f64| image.at(e.ends, t);
    truth
        .iter()
        .filter(|e| selected(e))
        .flat_map(|e| {
            let visible = e.pieces.iter().filter(|p| p.qi == 0);
            visible.map(|p| [of(e, p.t0.to_f64()), of(e, p.t1.to_f64())]).collect::<Vec<_>>()
        })
        .collect()
}

/// Compares two drawings as unions of points; points nearer than 1e-9 of the diagonal are one.
/// Segments of `undecided` may be drawn or not.
pub(crate) fn compare_strokes(
    truth: &[Segment],
    strokes: &[Vec<[f64; 2]>],
    undecided: &[Segment],
) -> Difference {
    let drawn: Vec<Segment> = strokes
        .iter()
        .flat_map(|s| s.windows(2).map(|w| [w[0], w[1]]).collect::<Vec<_>>())
        .collect();
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for p in truth.iter().chain(&drawn).flatten() {
        for k in 0..2 {
            (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
        }
    }
    let near = 1e-9 * distance(low, high);
    // Each point of a union once: a segment without what the ones before it cover.
    let beyond = |list: &[Segment], others: [&[Segment]; 2]| -> f64 {
        (0..list.len()).map(|i| uncovered(list[i], [&list[..i], others[0], others[1]], near)).sum()
    };
    Difference {
        false_visible: beyond(&drawn, [truth, undecided]),
        missing: beyond(truth, [&drawn, undecided]),
        total: beyond(truth, [&[], &[]]),
        largest: low.iter().chain(&high).fold(0.0, |a, x| x.abs().max(a)),
    }
}

/// Length of the part of a segment that no other runs along.
fn uncovered(segment: Segment, others: [&[Segment]; 3], near: f64) -> f64 {
    let [a, b] = segment;
    let length = distance(a, b);
    if length <= near {
        return 0.0;
    }
    let along = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
    let mut covered: Vec<[f64; 2]> = Vec::new();
    for other in others.into_iter().flatten() {
        let apart = (0..2).any(|k| {
            other[0][k].max(other[1][k]) < a[k].min(b[k]) - near
                || other[0][k].min(other[1][k]) > a[k].max(b[k]) + near
        });
        if apart {
            continue;
        }
        // (along, across) of both ends, cut where the distance across is `near`.
        let local = other.map(|p| {
            let d = [p[0] - a[0], p[1] - a[1]];
            [d[0] * along[0] + d[1] * along[1], d[1] * along[0] - d[0] * along[1]]
        });
        let [p, q] = local;
        let (mut t0, mut t1) = (0.0f64, 1.0f64);
        for side in [1.0, -1.0] {
            let (at_p, at_q) = (near - side * p[1], near - side * q[1]);
            if at_p < 0.0 && at_q < 0.0 {
                t1 = -1.0;
            } else if at_p < 0.0 {
                t0 = t0.max(at_p / (at_p - at_q));
            } else if at_q < 0.0 {
                t1 = t1.min(at_p / (at_p - at_q));
            }
        }
        if t0 < t1 {
            let u = [p[0] + t0 * (q[0] - p[0]), p[0] + t1 * (q[0] - p[0])];
            covered.push([u[0].min(u[1]), u[0].max(u[1])]);
        }
    }
    covered.sort_by(|x, y| x[0].total_cmp(&y[0]));
    let (mut rest, mut reached) = (0.0, 0.0f64);
    for [from, to] in covered {
        rest += (from.min(length) - reached).max(0.0);
        reached = reached.max(to);
    }
    rest + (length - reached).max(0.0)
}

/// The truth about a scene; `None` with a reason on stderr when it has none.
pub(crate) fn truth_of(scene: &Scene) -> Option<Vec<EdgeTruth>> {
    match truth(&scene.positions, &scene.faces, &scene.sight, Settings::default()) {
        Ok(edges) => Some(edges),
        Err(reason) => {
            eprintln!("{}: {reason}", scene.name);
            None
        }
    }
}

/// The spans an engine without a fault would give, ends turned about for good measure.
fn faultless(truth: &[EdgeTruth]) -> Vec<EngineEdge> {
    truth
        .iter()
        .map(|e| EngineEdge {
            ends: [e.ends[1], e.ends[0]],
            spans: e
                .pieces
                .iter()
                .rev()
                .map(|p| EngineSpan { t0: 1.0 - p.t1.to_f64(), t1: 1.0 - p.t0.to_f64(), qi: p.qi })
                .collect(),
        })
        .collect()
}

#[test]
fn the_oracle_agrees_with_displaced_sight_lines() {
    let mut n_pieces = 0;
    for seed in 0..number_of_scenes(400) {
        let scene = random(seed);
        if scene.is_in_tenths {
            continue; // things pass nearer than the displacement
        }
        let Some(edges) = truth_of(&scene) else {
            continue;
        };
        n_pieces += agrees_with(&scene.positions, &scene.faces, &scene.sight, &edges)
            .unwrap_or_else(|e| panic!("{}: {e}\n{scene:?}", scene.name));
    }
    eprintln!("{n_pieces} pieces");
    assert!(n_pieces > 1000);
}

#[test]
fn boxes_in_the_image_change_nothing() {
    let boxed = Settings { reject_by_boxes: true, ..Settings::default() };
    for seed in 0..number_of_scenes(300) {
        let scene = random(seed);
        let Some(plain) = truth_of(&scene) else {
            continue;
        };
        let quick = truth(&scene.positions, &scene.faces, &scene.sight, boxed).unwrap();
        for (a, b) in plain.iter().zip(&quick) {
            assert_eq!(a.pieces, b.pieces, "{} {:?}", scene.name, a.ends);
        }
    }
}

#[test]
fn almost_every_random_scene_has_a_truth_with_hidden_and_visible_parts() {
    let (mut n_with, mut n_mixed, mut n_kinds) = (0, 0, [0; 5]);
    for seed in 0..300 {
        let Some(edges) = truth_of(&random(seed)) else {
            continue;
        };
        n_with += 1;
        let has = |f: &dyn Fn(u32) -> bool| edges.iter().any(|e| e.pieces.iter().any(|p| f(p.qi)));
        if has(&|qi| qi == 0) && has(&|qi| qi > 0) {
            n_mixed += 1;
        }
        for kind in edges.iter().filter_map(|e| e.kinds(30.0)).flatten() {
            n_kinds[kind as usize] += 1;
        }
    }
    eprintln!("{n_with} with a truth, {n_mixed} mixed, kinds {n_kinds:?}");
    assert!(n_with > 290 && n_mixed > 150 && n_kinds.iter().all(|&n| n > 20));
}

#[test]
fn a_comparison_notices_every_kind_of_error() {
    let mixed = |edges: &Vec<EdgeTruth>| {
        let has = |f: &dyn Fn(u32) -> bool| edges.iter().any(|e| e.pieces.iter().any(|p| f(p.qi)));
        has(&|qi| qi == 0) && has(&|qi| qi > 0)
    };
    let (scene, edges) = (0..)
        .map(random)
        .find_map(|scene| truth_of(&scene).filter(mixed).map(|edges| (scene, edges)))
        .unwrap();
    let good = faultless(&edges);
    assert!(compare(&scene.sight, &edges, &good).is_ok());
    let hidden = good.iter().position(|e| e.spans.iter().any(|s| s.qi > 0)).unwrap();
    let change = |f: &dyn Fn(&mut EngineSpan)| {
        let mut bad = good.clone();
        bad[hidden].spans.iter_mut().filter(|s| s.qi > 0).for_each(f);
        compare(&scene.sight, &edges, &bad)
    };
    assert!(change(&|_| {}).is_ok());
    assert!(change(&|s| s.qi += 1).is_err());
    assert!(change(&|s| s.qi = 0).is_err());
    assert!(change(&|s| s.t1 -= 1e-6).is_err());
    let mut without = good.clone();
    without.remove(hidden);
    assert!(compare(&scene.sight, &edges, &without).is_err());

    let segments = visible_segments(&scene.sight, &edges, |_| true);
    let mut strokes: Vec<Vec<[f64; 2]>> = segments.iter().map(|s| vec![s[1], s[0]]).collect();
    let same = compare_strokes(&segments, &strokes, &[]);
    assert!(same.is_small() && same.total > 0.0, "{same:?}");
    let [a, b] = segments[0];
    let third = [a[0] + (b[0] - a[0]) / 3.0, a[1] + (b[1] - a[1]) / 3.0];
    strokes[0] = vec![a, third, b];
    assert!(compare_strokes(&segments, &strokes, &[]).is_small());
    strokes.push(vec![a, [b[0] + 1.0, b[1] + 2.0]]);
    assert!(compare_strokes(&segments, &strokes, &[]).false_visible > 1.0);
    let alone = compare_strokes(&[[[0.0, 0.0], [4.0, 0.0]]], &[vec![[1.0, 0.0], [2.0, 0.0]]], &[]);
    assert_eq!((alone.missing, alone.false_visible, alone.total), (3.0, 0.0, 4.0));
}
