//! Folds that are drawn with the grid, against a mesh engine on the same triangles.

use glam::{DVec2, dvec3};
use hiddenline::ProjectionKind;
use hiddenline::stages::camera::framing::{Standpoint, View};
use hiddenline::stages::draw::surface::{SurfaceEngine, SurfaceLines, SurfaceOutput, draw_surface};
use hiddenline::stages::engines::surface::CellOrder;
use hiddenline::stages::page::{PageOptions, Paper};
use hiddenline::stages::strokes::StrokeKind;
use hiddenline::stages::surface::Surface;

use super::folds::{distances, points};
use crate::scenes::Rng;

/// Rounding of where pieces end, in millimeters.
const ROUNDING_MM: f64 = 1e-5;

pub(super) fn lines(engine: SurfaceEngine) -> SurfaceLines {
    let lines = SurfaceLines { smoothness_mm: 0.0, shortest_stroke_mm: 0.0, ..Default::default() };
    SurfaceLines { apart_by_kind: true, engine, ..lines.silhouette().without_axes() }
}

pub(super) fn length(drawn: &SurfaceOutput, kind: StrokeKind) -> f64 {
    let pairs = |points: &[DVec2]| points.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>();
    let strokes = drawn.drawn.drawing.iter().filter(|stroke| stroke.kind == kind);
    strokes.map(|stroke| pairs(stroke.points)).sum::<f64>() * drawn.page.mm_per_image_unit()
}

fn random_formula(rng: &mut Rng) -> String {
    let mut term = || {
        let [a, b, c] = [rng.integer(1, 4), rng.integer(-3, 3), rng.integer(-3, 3)];
        match rng.below(6) {
            0 => format!("{b}*sin({a}*x+({c})*y)"),
            1 => format!("{b}*cos({a}*r)"),
            2 => format!("({b})*x^2/{a}+({c})*y"),
            3 => format!("x^3-{a}*x+({c})*y^2/4"),
            4 => format!("{a}*exp(-(x-({b})/2)^2-(y-({c})/2)^2)"),
            _ => format!("{a}*sqrt(1.25+x^2+({b})*x*y/4+y^2)"),
        }
    };
    let terms = [term(), term()];
    if rng.one_in(2) { terms[0].clone() } else { format!("{}+({})", terms[0], terms[1]) }
}

pub(super) fn random_view(rng: &mut Rng) -> View {
    let projection = rng.pick(&[ProjectionKind::Perspective, ProjectionKind::Orthographic]);
    let angles = |azimuth_deg, elevation_deg| Standpoint::Angles {
        azimuth_deg,
        elevation_deg,
        distance: None,
    };
    let standpoint = match rng.below(4) {
        // Along lines of the grid, and edge on.
        0 => angles(45.0 * rng.integer(0, 7), rng.pick(&[0.0, 30.0, -45.0, 80.0])),
        // Over the surface, beside it and below it, often in the planes of its lines.
        1 if projection == ProjectionKind::Perspective => {
            let (x, y) = (rng.integer(-8, 8) / 2.0, rng.integer(-8, 8) / 2.0);
            Standpoint::Eye(dvec3(x, y, rng.integer(6, 30) * rng.pick(&[-1.0, 1.0])))
        }
        _ => angles(rng.integer(0, 36_000) / 100.0, rng.integer(-6000, 6000) / 100.0),
    };
    View { standpoint, projection: Some(projection), ..View::default() }
}

#[test]
fn folds_on_the_grid_are_those_of_the_mesh() {
    let mut rng = Rng(19);
    let (mut n_by_grid, mut n_with_folds) = (0, 0);
    for k in 0..60 {
        let formula = random_formula(&mut rng);
        let (nx, ny) = (5 + rng.below(19), 5 + rng.below(19));
        let surface = Surface::formula(&formula).expect("a formula");
        let surface = surface.x(-3.0, 3.0).y(-2.0, 3.0).samples(nx, ny);
        let view = random_view(&mut rng);
        let page = PageOptions::from(Paper::A4);
        let by = |lines: &SurfaceLines| draw_surface(&surface, &view, lines, &page);
        let (Ok(one), Ok(other)) =
            (by(&lines(SurfaceEngine::Auto)), by(&lines(SurfaceEngine::Appel)))
        else {
            continue;
        };
        n_by_grid += usize::from(one.size.vertices == nx * ny);
        n_with_folds += usize::from(length(&one, StrokeKind::Silhouette) > 0.0);
        for kind in [StrokeKind::Silhouette, StrokeKind::Grid] {
            let what = format!("{k}: {formula}, {nx} x {ny}, {kind:?}, {view:?}");
            let lengths = [length(&one, kind), length(&other, kind)];
            let [a, b] = [points(&one, kind), points(&other, kind)];
            let off = [distances(&a, &b), distances(&b, &a)]
                .map(|all| all.last().copied().unwrap_or(0.0));
            // Seen along a grid line, lines lie on each other: the mesh engine draws one of them.
            let is_along = matches!(view.standpoint, Standpoint::Angles { azimuth_deg, .. } if azimuth_deg % 45.0 == 0.0);
            let is_same = (lengths[0] - lengths[1]).abs() < ROUNDING_MM;
            assert!(is_same || is_along, "{what}: {lengths:?} mm, {off:?} mm apart");
            assert!(off.iter().all(|off| *off < 0.1), "{what}: {off:?} mm apart");
        }
        let diagonals =
            SurfaceLines { order: Some(CellOrder::Diagonals), ..lines(SurfaceEngine::Auto) };
        if let Ok(by_diagonals) = by(&diagonals) {
            assert_eq!(by_diagonals.drawn.drawing, one.drawn.drawing, "{k}: {formula}, {view:?}");
        }
    }
    assert!(
        n_by_grid > 40 && n_with_folds > 25,
        "{n_by_grid} by the grid, {n_with_folds} with folds"
    );
}
