//! Level curves on the base of the box: where they are, and what the surface leaves of them.

use std::f64::consts::TAU;

use hiddenline::glam::{DVec2, DVec3};
use hiddenline::{Camera, Levels, Paper, StrokeKind, Surface, SurfaceLines, View};

/// Heights of x² + y² in a box of data's scale, and the levels that are drawn.
const LEVELS: [f64; 3] = [0.25, 1.0, 2.25];
const BASE: f64 = -3.0;

fn bowl(f: &str) -> Surface {
    let bowl = Surface::formula(f).expect(f).x(-2.0, 2.0).y(-2.0, 2.0).samples(81, 81);
    bowl.z(BASE, 8.0).aspect(hiddenline::Aspect::Data)
}

/// Whether the surface is between a point of the base and the eye.
fn is_hidden(p: DVec3, camera: &Camera, f: impl Fn(f64, f64) -> f64) -> bool {
    let way = camera.eye() - p;
    let n = 4000;
    let above = |k: usize| {
        let q = p + way * (k as f64 / n as f64);
        let is_over = q.x.abs() <= 2.0 && q.y.abs() <= 2.0;
        is_over.then(|| q.z > f(q.x, q.y))
    };
    let mut last = above(0);
    for k in 1..n {
        let next = above(k);
        if let (Some(a), Some(b)) = (last, next)
            && a != b
        {
            return true;
        }
        last = next;
    }
    false
}

#[test]
fn levels_on_the_base_are_below_their_curves_and_drawn_where_nothing_hides_them() {
    let lines = SurfaceLines::default().levels(Levels::At(LEVELS.to_vec())).project_levels();
    let lines = lines.without_axes();
    let f = |x: f64, y: f64| x * x + y * y;
    let bowl = bowl("x^2 + y^2");
    let sampled = bowl.sample().expect("samples");
    for (azimuth, elevation) in [(30.0, 8.0), (200.0, 25.0), (75.0, 3.0), (300.0, 50.0)] {
        let view = View::from_angles(azimuth, elevation);
        let camera = view.camera(sampled.box_bounds()).expect("a camera");
        let (strokes, page) = bowl.draw(&view, &lines).strokes(Paper::A4).expect("strokes");
        let mm = page.mm_per_image_unit();
        let base: Vec<&[DVec2]> = strokes
            .iter()
            .filter(|stroke| stroke.kind == StrokeKind::LevelBase)
            .map(|stroke| stroke.points)
            .collect();
        let distance = |p: DVec2| {
            let to = |a: DVec2, b: DVec2| {
                let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                p.distance(a.lerp(b, t)) * mm
            };
            let pairs = base.iter().flat_map(|points| points.windows(2));
            pairs.map(|pair| to(pair[0], pair[1])).fold(f64::INFINITY, f64::min)
        };
        let (mut n_hidden, mut n_seen) = (0, 0);
        for level in LEVELS {
            let hidden: Vec<bool> = (0..400)
                .map(|k| {
                    let (sin, cos) = (f64::from(k) * TAU / 400.0).sin_cos();
                    let r = level.sqrt();
                    is_hidden(DVec3::new(r * cos, r * sin, BASE), &camera, f)
                })
                .collect();
            for k in 0..400_usize {
                // Not where visibility changes nearby: the surface is made of triangles.
                let near = (0..7).map(|d| hidden[(k + 397 + d) % 400]);
                if near.clone().any(|h| h != hidden[k]) {
                    continue;
                }
                let (sin, cos) = (k as f64 * TAU / 400.0).sin_cos();
                let p = DVec3::new(level.sqrt() * cos, level.sqrt() * sin, BASE);
                let off = distance(camera.image(p));
                if hidden[k] {
                    n_hidden += 1;
                } else {
                    n_seen += 1;
                    assert!(off < 0.1, "{azimuth} {elevation}: {level} {k} is {off} mm off");
                }
            }
        }
        // Nothing is drawn that should be hidden: the visible length agrees.
        let length: f64 = base
            .iter()
            .flat_map(|points| points.windows(2))
            .map(|pair| pair[0].distance(pair[1]) * mm)
            .sum();
        let mut expected = 0.0;
        for level in LEVELS {
            let at = |k: f64| {
                let (sin, cos) = (k * TAU / 4000.0).sin_cos();
                DVec3::new(level.sqrt() * cos, level.sqrt() * sin, BASE)
            };
            for k in 0..4000 {
                let k = f64::from(k);
                if k % 10.0 != 0.0 {
                    continue;
                }
                let [a, b] = [at(k), at(k + 10.0)].map(|p| camera.image(p));
                if !is_hidden(at(k + 5.0), &camera, f) {
                    expected += a.distance(b) * mm;
                }
            }
        }
        assert!(n_seen > 20, "{n_seen} seen, {n_hidden} hidden");
        let off = (length - expected).abs();
        assert!(off < 0.02 * expected + 3.0, "{azimuth} {elevation}: {length} of {expected}");
    }
}

#[test]
fn from_below_levels_are_on_the_upper_face() {
    let lines = SurfaceLines::default().levels(Levels::At(LEVELS.to_vec())).project_levels();
    let lines = lines.without_axes();
    let bowl = bowl("x^2 + y^2");
    let view = View::from_angles(30.0, -60.0);
    let camera = view.camera(bowl.sample().expect("samples").box_bounds()).expect("a camera");
    let (strokes, page) = bowl.draw(&view, &lines).strokes(Paper::A4).expect("strokes");
    let of_kind = |kind| strokes.iter().filter(move |stroke| stroke.kind == kind);
    let mm = page.mm_per_image_unit();
    for stroke in of_kind(StrokeKind::LevelBase) {
        for p in stroke.points {
            let off = LEVELS.map(|level| {
                let of = |k: u32| {
                    let (sin, cos) = (f64::from(k) * TAU / 2000.0).sin_cos();
                    let r = level.sqrt();
                    camera.image(DVec3::new(r * cos, r * sin, 8.0)).distance(*p) * mm
                };
                (0..2000).map(of).fold(f64::INFINITY, f64::min)
            });
            assert!(off.into_iter().fold(f64::INFINITY, f64::min) < 0.5, "{off:?}");
        }
    }
    assert!(of_kind(StrokeKind::LevelBase).count() > 0);
    assert!(of_kind(StrokeKind::Level).count() > 0);
}
