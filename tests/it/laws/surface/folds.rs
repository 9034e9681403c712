//! Folds against closed forms in both projections, and what ends on them.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, dvec3};
use hiddenline::stages::camera::framing::{Standpoint, View};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::draw::surface::{SurfaceEngine, SurfaceLines, SurfaceOutput, draw_surface};
use hiddenline::stages::page::{PageOptions, Paper};
use hiddenline::stages::strokes::StrokeKind;
use hiddenline::stages::surface::{Aspect, Surface};
use hiddenline::{ProjectionKind, Strokes};

/// How far lines may be from the functions on paper.
const SMOOTHNESS_MM: f64 = 0.1;

/// How far triangles go beyond a fold where sight lines nearly run along the surface: a cell.
const BEYOND_MM: f64 = 4.0;

fn views() -> Vec<View> {
    let angles = [(30.0, 25.0), (205.0, 12.0)];
    let kinds = [ProjectionKind::Perspective, ProjectionKind::Orthographic];
    let view = |(azimuth_deg, elevation_deg), projection| View {
        standpoint: Standpoint::Angles { azimuth_deg, elevation_deg, distance: None },
        projection,
        ..View::default()
    };
    angles.into_iter().flat_map(|angle| kinds.map(|kind| view(angle, Some(kind)))).collect()
}

fn drawn(surface: &Surface, view: &View, lines: SurfaceLines) -> SurfaceOutput {
    let lines = SurfaceLines { apart_by_kind: true, ..lines.silhouette().without_axes() };
    draw_surface(surface, view, &lines, &PageOptions::from(Paper::A4)).expect("a drawing")
}

/// The points of strokes of a kind in millimeters, a tenth of a millimeter apart.
pub(super) fn points(drawn: &SurfaceOutput, kind: StrokeKind) -> Vec<DVec2> {
    let scale = drawn.page.mm_per_image_unit();
    let mut points = Vec::new();
    for stroke in drawn.drawn.drawing.iter().filter(|stroke| stroke.kind == kind) {
        dense(&stroke.points.iter().map(|p| *p * scale).collect::<Vec<_>>(), &mut points);
    }
    points
}

fn dense(line: &[DVec2], out: &mut Vec<DVec2>) {
    for pair in line.windows(2) {
        let n = (pair[0].distance(pair[1]) / 0.1).ceil().max(1.0);
        out.extend((0..n as usize).map(|k| pair[0].lerp(pair[1], k as f64 / n)));
    }
    out.extend(line.last());
}

/// The distances of points from the nearest of the others, in rising order.
pub(super) fn distances(points: &[DVec2], others: &[DVec2]) -> Vec<f64> {
    const CELL: f64 = 2.0;
    let cell = |p: DVec2| (p / CELL).floor().to_array().map(|x| x as i32);
    let mut cells = std::collections::HashMap::<_, Vec<DVec2>>::new();
    for p in others {
        cells.entry(cell(*p)).or_default().push(*p);
    }
    let nearest = |p: &DVec2| {
        let [x, y] = cell(*p);
        let around = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| [x, y]));
        let near = around.filter_map(|cell| cells.get(&cell)).flatten();
        near.map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min)
    };
    let mut distances: Vec<f64> = points.iter().map(nearest).collect();
    distances.sort_by(f64::total_cmp);
    distances
}

/// The greatest distance of any point from the nearest of the others.
fn farthest(points: &[DVec2], others: &[DVec2]) -> f64 {
    distances(points, others).last().copied().unwrap_or(0.0)
}

/// Folds are smooth but for where sight lines nearly run along the surface.
fn assert_smooth(found: &[DVec2], expected: &[DVec2], what: &str) {
    let off = distances(found, expected);
    let most = off.last().copied().unwrap_or(0.0);
    let usual = off.get(off.len() * 9 / 10).copied().unwrap_or(0.0);
    assert!(usual < SMOOTHNESS_MM && most < BEYOND_MM, "{what}: {usual} mm, at most {most} mm");
}

/// Toward the eye from a point.
fn to_eye(camera: &Camera, p: DVec3) -> DVec3 {
    match camera.projection() {
        Projection::Perspective { .. } => camera.eye() - p,
        Projection::Orthographic => -camera.forward(),
    }
}

fn on_paper(drawn: &SurfaceOutput, curve: impl IntoIterator<Item = DVec3>) -> Vec<DVec2> {
    let scale = drawn.page.mm_per_image_unit();
    let line: Vec<DVec2> = curve.into_iter().map(|p| drawn.camera.image(p) * scale).collect();
    let mut points = Vec::new();
    dense(&line, &mut points);
    points
}

#[test]
fn the_outline_of_a_sphere_is_its_circle() {
    let sphere = ["2*cos(u)*sin(v)", "2*sin(u)*sin(v)", "2*cos(v)"];
    for view in views() {
        for n in [21, 32] {
            let surface = Surface::parametric(sphere, (0.0, TAU), (0.0, PI)).expect("formulas");
            let surface = surface.samples(n, n);
            let drawn = drawn(&surface, &view, SurfaceLines::default());
            // The circle of contact, from the pole of the sight lines.
            let eye = to_eye(&drawn.camera, DVec3::ZERO);
            let (distance, axis) = (eye.length(), eye.normalize());
            let (radius, height) = match drawn.camera.projection() {
                Projection::Orthographic => (2.0, 0.0),
                Projection::Perspective { .. } => {
                    (2.0 * (1.0 - 4.0 / (distance * distance)).sqrt(), 4.0 / distance)
                }
            };
            let (one, other) = axis.any_orthonormal_pair();
            let circle = (0..=4000).map(|k| {
                let (sin, cos) = (TAU * f64::from(k) / 4000.0).sin_cos();
                height * axis + radius * (cos * one + sin * other)
            });
            let (circle, found) =
                (on_paper(&drawn, circle), points(&drawn, StrokeKind::Silhouette));
            let off = farthest(&found, &circle).max(farthest(&circle, &found));
            assert!(off < 1.2 * SMOOTHNESS_MM, "{n} samples, {view:?}: {off} mm");
        }
    }
}

#[test]
fn the_folds_of_a_torus_are_where_sight_lines_touch_it() {
    let torus = ["(3+cos(v))*cos(u)", "(3+cos(v))*sin(u)", "sin(v)"];
    for view in views() {
        for n in [31] {
            let surface = Surface::parametric(torus, (0.0, TAU), (0.0, TAU)).expect("formulas");
            let drawn = drawn(&surface.samples(n, n), &view, SurfaceLines::default());
            let eye = drawn.camera.eye();
            // N · (E − X) = 0 for N = (cos v, sin v) in the half plane of u: two v for each u.
            let fold = |u: f64, side: f64| {
                let around = dvec3(u.cos(), u.sin(), 0.0);
                let v = match drawn.camera.projection() {
                    Projection::Orthographic => {
                        let d = -drawn.camera.forward();
                        d.z.atan2(d.dot(around)) + side * PI / 2.0
                    }
                    Projection::Perspective { .. } => {
                        let (out, up) = (eye.dot(around) - 3.0, eye.z);
                        up.atan2(out) + side * (1.0 / out.hypot(up)).acos()
                    }
                };
                around * (3.0 + v.cos()) + DVec3::Z * v.sin()
            };
            let mut all = Vec::new();
            for side in [-1.0, 1.0] {
                let around = (0..=4000).map(|k| fold(TAU * f64::from(k) / 4000.0, side));
                all.extend(on_paper(&drawn, around));
            }
            let found = points(&drawn, StrokeKind::Silhouette);
            assert_smooth(&found, &all, &format!("{n} samples, {view:?}"));
            let outer: Vec<DVec2> = outline(&all);
            let off = farthest(&outer, &found);
            assert!(off < 2.0 * SMOOTHNESS_MM, "{n} samples, {view:?}: {off} mm without a fold");
        }
    }
}

/// Those points that are the outermost in their directions from the middle.
fn outline(points: &[DVec2]) -> Vec<DVec2> {
    let middle = points.iter().sum::<DVec2>() / points.len() as f64;
    let mut outermost = [DVec2::ZERO; 360];
    for p in points {
        let d = *p - middle;
        let k = ((d.to_angle() + PI) / TAU * 360.0) as usize % 360;
        if d.length() > outermost[k].length() {
            outermost[k] = d;
        }
    }
    outermost.map(|d| d + middle).to_vec()
}

#[test]
fn the_folds_of_a_cubic_are_straight() {
    for view in views() {
        for (x, n) in [((-2.0, 1.5), 41), ((-1.7, 2.1), 56)] {
            let surface = Surface::formula("x^3 - 3*x").expect("a formula");
            let surface = surface.x(x.0, x.1).y(-2.0, 1.0).samples(n, n).aspect(Aspect::Data);
            let drawn = drawn(&surface, &view, SurfaceLines::default());
            let height = |x: f64| x.powi(3) - 3.0 * x;
            let facing = |x: f64| {
                let d = to_eye(&drawn.camera, dvec3(x, 0.0, height(x)));
                d.z - (3.0 * x * x - 3.0) * d.x
            };
            let mut all = Vec::new();
            for k in 0..10_000 {
                let [a, b] = [k, k + 1].map(|k| x.0 + (x.1 - x.0) * f64::from(k) / 10_000.0);
                if (facing(a) >= 0.0) != (facing(b) >= 0.0) {
                    let at = a + (b - a) * facing(a) / (facing(a) - facing(b));
                    all.extend(on_paper(&drawn, [-2.0, 1.0].map(|y| dvec3(at, y, height(at)))));
                }
            }
            let found = points(&drawn, StrokeKind::Silhouette);
            assert_smooth(&found, &all, &format!("{n} samples, {view:?}"));
            let (ink, length) = (found.len(), all.len());
            assert!(length == 0 || ink > 0, "{n} samples, {view:?}: {ink} of {length}");
        }
    }
}

/// How far the ends of grid lines are from other strokes, in millimeters.
fn loose_ends(strokes: &Strokes, scale: f64) -> Vec<f64> {
    let all: Vec<_> = strokes.iter().collect();
    let mut off = Vec::new();
    for (k, stroke) in all.iter().enumerate().filter(|(_, s)| s.kind == StrokeKind::Grid) {
        let (first, last) = (stroke.points[0], stroke.points[stroke.points.len() - 1]);
        for end in [first, last] {
            let others = all.iter().enumerate().filter(|(other, _)| *other != k);
            let segments = others.flat_map(|(_, other)| other.points.windows(2));
            let nearest = segments.map(|pair| {
                let along = pair[1] - pair[0];
                let t = ((end - pair[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0);
                end.distance(pair[0] + t * along)
            });
            off.push(scale * nearest.fold(f64::INFINITY, f64::min));
        }
    }
    off
}

const PEAKS: &str = "3*(1-x)^2*exp(-x^2-(y+1)^2) - 10*(x/5-x^3-y^5)*exp(-x^2-y^2) \
                     - exp(-(x+1)^2-y^2)/3";

fn hat_and_peaks(n: usize) -> [Surface; 3] {
    let of = |text: &str, most: f64| {
        let surface = Surface::formula(text).expect(text);
        surface.x(-most, most).y(-most, most).samples(n, n)
    };
    [of("sinc(r)", 12.0), of(PEAKS, 3.0), of("x^3 - 3*x + 0.3*y^2", 2.0)]
}

#[test]
fn no_grid_line_ends_in_the_air() {
    let mut n_ends = 0;
    for n in [61, 80] {
        for surface in hat_and_peaks(n) {
            let drawn = drawn(&surface, &View::default(), SurfaceLines::default());
            let ends = loose_ends(&drawn.drawn.drawing, drawn.page.mm_per_image_unit());
            let most = ends.iter().copied().fold(0.0, f64::max);
            assert!(most < 1e-2, "{most} mm of {} ends", ends.len());
            n_ends += ends.len();
        }
    }
    assert!(n_ends > 1_804, "{n_ends}");
}

#[test]
fn engines_draw_the_same_folds() {
    for surface in hat_and_peaks(31) {
        let length = |engine: SurfaceEngine| {
            let whole = SurfaceLines { shortest_stroke_mm: 0.0, ..SurfaceLines::default() };
            let drawn = drawn(&surface, &View::default(), whole.engine(engine));
            let of = |kind: StrokeKind| -> f64 {
                let strokes = drawn.drawn.drawing.iter().filter(|s| s.kind == kind);
                let pairs = strokes.flat_map(|stroke| stroke.points.windows(2));
                pairs.map(|pair| pair[0].distance(pair[1])).sum()
            };
            [of(StrokeKind::Silhouette), of(StrokeKind::Grid)]
        };
        let expected = length(SurfaceEngine::Auto);
        for engine in [SurfaceEngine::Roberts, SurfaceEngine::Appel] {
            let found = length(engine);
            for k in 0..2 {
                let difference = (found[k] - expected[k]).abs();
                assert!(difference < 1e-9, "{engine:?}: {found:?} instead of {expected:?}");
            }
        }
    }
}
