//! Borders of exact regions are the visible lines of exact drawings.

use super::built;
use crate::oracle::sight_lines::SightLines;
use crate::scenes::{
    Model, Scene as TestScene, number_of_scenes, orthographic, perspective, random,
};
use glam::{DVec2, DVec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::engines::face::images::Images;
use hiddenline::stages::engines::face::weiler_atherton::solve;
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::strokes::StrokeKind;

type Segment = [DVec2; 2];

/// The visible strokes of `draw --exact --lines all,intersection`.
fn strokes(scene: Scene, camera: &Camera) -> Vec<Segment> {
    let lines = LineSelection::all_edges().with(StrokeKind::Intersection);
    let options = DrawOptions { lines, exact: true, ..DrawOptions::default() };
    let scene = scene.with_intersections();
    let drawing = draw(&scene, camera, &options, 1.0).drawing;
    drawing.iter().map(|stroke| [stroke.points[0], stroke.points[1]]).collect()
}

/// All sides of all regions.
fn borders(scene: &Scene, camera: &Camera) -> Vec<Segment> {
    let painting = solve(scene, camera).unwrap().0;
    let rings = painting.pieces().flat_map(|piece| piece.rings().collect::<Vec<_>>());
    rings
        .flat_map(|ring| {
            let n = ring.points.len();
            (0..n).map(move |k| [ring.points[k], ring.points[(k + 1) % n]])
        })
        .collect()
}

/// How much of `these` lies farther than `slack` from all of `those`: judged by points on them.
fn uncovered(these: &[Segment], those: &[Segment], slack: f64) -> Option<DVec2> {
    const POINTS: u32 = 17;
    for &[a, b] in these {
        for k in 0..POINTS {
            let point = a.lerp(b, (f64::from(k) + 0.5) / f64::from(POINTS));
            let is_near = |&[c, d]: &Segment| super::distance(point, c, d) <= slack;
            if a.distance(b) > 4.0 * slack && !those.iter().any(is_near) {
                return Some(point);
            }
        }
    }
    None
}

/// Both ways; `slack` as a part of the image's diagonal.
fn are_the_same(scene: &TestScene, slack: f64) {
    let (built_scene, camera) = built(scene);
    let bounds = Images::new(&built_scene, &camera).bounds;
    let slack = slack * (bounds.1 - bounds.0).length();
    let borders = borders(&built_scene, &camera);
    let strokes = strokes(built_scene, &camera);
    assert!(!strokes.is_empty() && !borders.is_empty(), "{}", scene.name);
    let point = uncovered(&borders, &strokes, slack);
    assert!(point.is_none(), "{}: the border at {point:?} is no stroke", scene.name);
    let point = uncovered(&strokes, &borders, slack);
    assert!(point.is_none(), "{}: the stroke at {point:?} is no border", scene.name);
}

#[test]
fn borders_are_the_strokes_of_known_scenes() {
    let sights = [
        orthographic([-3.0, 5.0, -4.0], [0.0, 0.0, 1.0]),
        perspective([9.0, -11.0, 7.0], [2.0, 2.0, 1.0], 1e-6),
        perspective([-7.0, -9.0, 12.0], [2.0, 2.0, 1.0], 1e-6),
    ];
    are_the_same(&super::regions::warnocks_pair(), 1e-12);
    for (k, sight) in sights.into_iter().enumerate() {
        let mut cube = Model::default();
        cube.add_box([0.0; 3], [2.0, 3.0, 1.0]);
        are_the_same(&cube.seen_by(format!("a box, {k}"), sight), 1e-12);
        let mut crossing = Model::default();
        crossing.add_box([0.0, 1.0, 1.0], [6.0, 3.0, 3.0]);
        crossing.add_box([2.0, 0.0, 0.0], [4.0, 5.0, 2.0]);
        are_the_same(&crossing.seen_by(format!("crossing boxes, {k}"), sight), 1e-12);
        let mut pair = Model::default();
        pair.face(&[[0.0, 0.0, 0.0], [5.0, 0.0, 1.0], [1.0, 5.0, 3.0]]);
        pair.face(&[[1.0, 1.0, -3.0], [4.0, 2.0, 4.0], [0.0, 4.0, 3.0]]);
        are_the_same(&pair.seen_by(format!("a penetrating pair, {k}"), sight), 1e-12);
        let mut bars = Model::default();
        bars.face(&[[0.0, 0.0, 0.0], [6.0, 0.0, 2.0], [6.0, 1.0, 2.0], [0.0, 1.0, 0.0]]);
        bars.face(&[[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [3.0, 6.0, 2.0], [2.0, 6.0, 2.0]]);
        bars.face(&[[3.0, 6.0, 0.0], [4.0, 6.0, 0.0], [1.0, -1.0, 2.0], [0.0, -1.0, 2.0]]);
        are_the_same(&bars.seen_by(format!("cyclic bars, {k}"), sight), 1e-12);
    }
}

/// How borders and strokes of a scene agree, in points on them.
#[derive(Debug, Default)]
struct Agreement {
    /// Points of borders on strokes.
    borders: u32,
    /// Points of borders that the near plane made.
    near_plane: u32,
    /// Points of strokes on borders.
    strokes: u32,
    /// Points of strokes with one face, or nothing, on both sides.
    amid: u32,
}

/// Points evenly along a segment.
fn points([a, b]: Segment) -> impl Iterator<Item = DVec2> {
    const POINTS: u32 = 9;
    (0..POINTS).map(move |k| a.lerp(b, (f64::from(k) + 0.5) / f64::from(POINTS)))
}

fn nearest(point: DVec2, segments: &[Segment]) -> f64 {
    let distances = segments.iter().map(|&[a, b]| super::distance(point, a, b));
    distances.fold(f64::INFINITY, f64::min)
}

/// Whether the near plane cuts a triangle at a point of the image, within `slack` of it.
fn is_cut(scene: &Scene, camera: &Camera, at: DVec2, slack: f64) -> bool {
    let Projection::Perspective { near, .. } = camera.projection() else { return false };
    let frame = camera.frame();
    let depth = near * camera.forward().length();
    let on_plane = |p: DVec3| (p - camera.eye()).dot(frame.forward) - depth;
    let positions = scene.mesh().positions();
    scene.triangles().iter().any(|triangle| {
        let corners = triangle.map(|vertex| positions[vertex as usize]);
        // The image of where the plane cuts the sides.
        let sides = [(0, 1), (1, 2), (2, 0)].into_iter().filter_map(|(i, k)| {
            let (p, q) = (on_plane(corners[i]), on_plane(corners[k]));
            let is_cut = (p < 0.0) != (q < 0.0);
            is_cut.then(|| camera.image(corners[i].lerp(corners[k], p / (p - q))))
        });
        match sides.collect::<Vec<DVec2>>()[..] {
            [a, b] => super::distance(at, a, b) <= slack,
            _ => false,
        }
    })
}

/// Borders and strokes are the same set of points but for borders that the near plane makes, and for
/// strokes with one face on both sides, as exact rays say: edges of faces edge-on, or that touch
/// another face.
fn agreement(scene: &Scene, camera: &Camera, slack: f64) -> Result<Agreement, String> {
    let bounds = Images::new(scene, camera).bounds;
    let slack = slack * (bounds.1 - bounds.0).length();
    let borders = borders(scene, camera);
    let strokes = strokes(Scene::new(scene.mesh().clone()), camera);
    let world = SightLines::new(scene, camera);
    let mut found = Agreement::default();
    let long = |[a, b]: &&Segment| a.distance(*b) > 4.0 * slack;
    for point in borders.iter().filter(long).flat_map(|&border| points(border)) {
        if nearest(point, &strokes) <= slack {
            found.borders += 1;
        } else if is_cut(scene, camera, point, slack) {
            found.near_plane += 1;
        } else {
            return Err(format!("the border at {point} is no stroke"));
        }
    }
    for &stroke in strokes.iter().filter(long) {
        let aside = (stroke[1] - stroke[0]).normalize().perp();
        for point in points(stroke) {
            let distance = nearest(point, &borders);
            if distance <= slack {
                found.strokes += 1;
                continue;
            }
            // No border between the point and these, so each side is of one region.
            let aside = aside * distance.min((bounds.1 - bounds.0).length()) / 4.0;
            let [left, right] = [point - aside, point + aside].map(|at| world.seen(at));
            if left != right {
                return Err(format!("the stroke at {point}, {left:?} | {right:?}, is no border"));
            }
            found.amid += 1;
        }
    }
    Ok(found)
}

#[test]
fn borders_of_random_scenes_are_strokes_and_strokes_are_borders() {
    let mut sum = Agreement::default();
    let mut n_cut = 0;
    for seed in 0..number_of_scenes(300) {
        let test = random(seed);
        let (scene, camera) = built(&test);
        let found = agreement(&scene, &camera, 1e-9)
            .unwrap_or_else(|problem| panic!("{}: {problem}\n{test:?}", test.name));
        n_cut += u32::from(found.near_plane > 0);
        sum.borders += found.borders;
        sum.near_plane += found.near_plane;
        sum.strokes += found.strokes;
        sum.amid += found.amid;
    }
    eprintln!("{sum:?}; {n_cut} scenes cut at the near plane");
    assert!(sum.borders > 10_000 && sum.strokes > 10_000 && sum.near_plane > 100, "{sum:?}");
    assert!(sum.amid * 5 < sum.strokes, "{sum:?}");
}
