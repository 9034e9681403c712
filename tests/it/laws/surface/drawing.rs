//! Drawings of surfaces by `draw_surface`: engines against each other, and closed forms.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, dvec3};
use hiddenline::stages::camera::Camera;
use hiddenline::stages::camera::framing::{NamedView, Standpoint, View};
use hiddenline::stages::draw::surface::{
    Labels, Levels, NoLevels, SurfaceEngine, SurfaceError, SurfaceLines, SurfaceNote,
    SurfaceOutput, draw_surface,
};
use hiddenline::stages::engines::surface::{CellOrder, HorizonError};
use hiddenline::stages::model::mesh::MeshError;
use hiddenline::stages::page::PageOptions;
use hiddenline::stages::strokes::StrokeKind;
use hiddenline::stages::surface::{Aspect, Grid, SamplingError, Surface};

fn named(view: NamedView) -> View {
    View { standpoint: Standpoint::Named { view, distance: None }, ..View::default() }
}

fn bare() -> SurfaceLines {
    SurfaceLines { axes: None, ..SurfaceLines::default() }
}

fn drawn(surface: &Surface, view: NamedView, lines: &SurfaceLines) -> SurfaceOutput {
    draw_surface(surface, &named(view), lines, &PageOptions::default()).expect("a drawing")
}

fn refused(surface: &Surface, lines: &SurfaceLines) -> SurfaceError {
    match draw_surface(surface, &View::default(), lines, &PageOptions::default()) {
        Err(error) => error,
        Ok(drawn) => panic!("drawn by {}", drawn.drawn.engine),
    }
}

/// The length of all strokes of a kind, in units of the image.
fn length(drawing: &SurfaceOutput, kind: StrokeKind) -> f64 {
    let strokes = drawing.drawn.drawing.iter().filter(|stroke| stroke.kind == kind);
    strokes.flat_map(|stroke| stroke.points.windows(2)).map(|p| p[0].distance(p[1])).sum()
}

fn of(text: &str) -> Surface {
    Surface::formula(text).expect("a formula")
}

#[test]
fn engines_for_grids_and_for_meshes_draw_the_same_lines() {
    let surface = of("sin(x) * cos(y)").samples(23, 19);
    let view = View::default();
    let exact = SurfaceLines { exact: true, smoothness_mm: 0.0, ..bare() };
    let all = [SurfaceEngine::Auto, SurfaceEngine::Roberts, SurfaceEngine::Appel].map(|engine| {
        let lines = SurfaceLines { engine, ..exact.clone() };
        let drawing = draw_surface(&surface, &view, &lines, &PageOptions::default());
        drawing.expect("a drawing")
    });
    assert_eq!(all.each_ref().map(|d| d.drawn.engine), ["max-min", "roberts", "appel"]);
    let lengths = all.each_ref().map(|drawing| length(drawing, StrokeKind::Grid));
    assert!(lengths[0] > 5.0, "{lengths:?}");
    for other in lengths {
        assert!((other - lengths[0]).abs() < 1e-9 * lengths[0], "{lengths:?}");
    }
    // Both triangles of each cell, and an edge along each side and each diagonal.
    for drawing in &all {
        let size = drawing.size;
        assert_eq!((size.vertices, size.triangles), (23 * 19, 2 * 22 * 18));
        assert_eq!(size.edges, 22 * 19 + 23 * 18 + 22 * 18);
    }
}

#[test]
fn lines_are_as_smooth_on_paper_as_asked_for() {
    let surface = of("cos(x)").x(0.0, TAU).y(0.0, 1.0).samples(9, 2).aspect(Aspect::Data);
    let off = |smoothness_mm: f64| {
        let lines = SurfaceLines { along_y: false, smoothness_mm, ..bare() };
        let drawing = drawn(&surface, NamedView::Front, &lines);
        let scale = drawing.page.mm_per_image_unit();
        let origin = drawing.camera.image(DVec3::ZERO);
        let n_strokes = drawing.drawn.drawing.len();
        assert!((1..=2).contains(&n_strokes), "{n_strokes}");
        // Between two points a line is farthest from the curve in the middle, up to a few percent.
        let middles = drawing.drawn.drawing.iter().flat_map(|stroke| stroke.points.windows(2));
        let off = middles.map(|p| {
            let middle = (p[0] + p[1]) / 2.0 - origin;
            (middle.y - libm::cos(middle.x)).abs() * scale
        });
        off.fold(0.0, f64::max)
    };
    let coarse = off(0.0);
    assert!(coarse > 2.0, "{coarse}");
    for allowed in [0.5, 0.1] {
        let found = off(allowed);
        assert!(found < allowed * 1.3 && found > allowed / 8.0, "{allowed}: {found}");
    }
}

#[test]
fn level_curves_of_a_paraboloid_are_circles() {
    let surface = of("r^2").x(-3.0, 3.0).y(-3.0, 3.0).samples(241, 241);
    let levels = |levels| SurfaceLines {
        along_x: false,
        along_y: false,
        levels: Some(levels),
        labels: Some(Labels::None),
        ..bare()
    };
    let at = levels(Levels::At(vec![1.0, 4.0]));
    let found = length(&drawn(&surface, NamedView::Top, &at), StrokeKind::Level);
    let expected = TAU * (1.0 + 2.0);
    assert!((found - expected).abs() < 1e-3 * expected, "{found}");
    // Scaled heights leave the curves where they are.
    let scaled = surface.clone().z_scale(-3.0);
    let found = length(&drawn(&scaled, NamedView::Bottom, &at), StrokeKind::Level);
    assert!((found - expected).abs() < 1e-3 * expected, "{found}");
    // Two levels between 0 and 18: circles of radius sqrt(6), and of sqrt(12) in four corners, where
    // an arc of cos⁻¹(3/sqrt 12) = 30° is cut off on either side of each axis.
    let found =
        length(&drawn(&surface, NamedView::Top, &levels(Levels::Count(2))), StrokeKind::Level);
    let expected = TAU * 6f64.sqrt() + 12f64.sqrt() * (TAU - 8.0 * PI / 6.0);
    assert!((found - expected).abs() < 1e-3 * expected, "{found}, not {expected}");
}

#[test]
fn a_box_is_two_fifths_as_high_as_its_base_is_long() {
    for (surface, expected) in [
        (of("x").x(0.0, 10.0).y(0.0, 3.0), 4.0),
        (of("x").x(0.0, 10.0).y(0.0, 20.0), 8.0),
        (of("x").x(0.0, 10.0).y(0.0, 3.0).z_scale(0.5), 2.0),
        (of("x").x(0.0, 10.0).y(0.0, 3.0).aspect(Aspect::Data), 10.0),
        (of("7").aspect(Aspect::Box), 0.0),
    ] {
        let sampled = surface.samples(5, 5).sample().expect("samples");
        let (low, high) = sampled.bounds();
        assert!((high.z - low.z - expected).abs() < 1e-12, "{low} {high}");
    }
}

#[test]
fn a_torus_closes_and_two_half_spheres_meet() {
    let lines = SurfaceLines { border: true, along_x: false, along_y: false, ..bare() };
    let texts = ["(3 + cos(v)) * cos(u)", "(3 + cos(v)) * sin(u)", "sin(v)"];
    let torus = Surface::parametric(texts, (0.0, TAU), (0.0, TAU)).expect("formulas");
    let torus = torus.samples(25, 17);
    let drawing = drawn(&torus, NamedView::Isometric, &lines);
    assert_eq!(length(&drawing, StrokeKind::Boundary), 0.0);
    // A closed surface of genus 1: V − E + F = 0.
    let size = drawing.size;
    assert_eq!(size.vertices + size.faces, size.edges);
    let ball = of("sqrt(9 - r^2)").sheet("-sqrt(9 - r^2)").expect("a formula");
    let ball = ball.x(-4.0, 4.0).y(-4.0, 4.0).samples(31, 31).domain("r <= 3").expect("a formula");
    let drawing = drawn(&ball, NamedView::Isometric, &lines);
    let size = drawing.size;
    assert_eq!(size.vertices + size.faces, size.edges + 2);
    assert_eq!(length(&drawing, StrokeKind::Boundary), 0.0);
}

#[test]
fn scattered_points_are_drawn_by_the_edges_of_their_triangles() {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0]];
    let points = corners.map(|[x, y]| dvec3(x, y, 0.0)).to_vec();
    let surface = Surface::points(points).expect("a triangulation");
    let drawing = drawn(&surface, NamedView::Top, &bare());
    let expected = 8.0 + 4.0 * 2f64.sqrt();
    assert!((length(&drawing, StrokeKind::Mesh) - expected).abs() < 1e-12);
    assert_eq!(drawing.samples, "5 points, 4 triangles");
}

#[test]
fn triangles_over_given_points_may_leave_holes_out_but_not_use_them() {
    let hole = DVec3::NAN;
    let points = || vec![dvec3(0.0, 0.0, 0.0), dvec3(2.0, 0.0, 0.0), dvec3(0.0, 2.0, 0.0), hole];
    let surface = Surface::triangles(points(), vec![[0, 1, 2]]).expect("a surface");
    let drawing = drawn(&surface, NamedView::Top, &bare());
    assert!((length(&drawing, StrokeKind::Mesh) - (4.0 + 8f64.sqrt())).abs() < 1e-12);
    let refused = |corners| Surface::triangles(points(), vec![[0, 1, 2], corners]).unwrap_err();
    assert_eq!(refused([0, 1, 3]), MeshError::NotFinite { vertex: 3 });
    let missing = MeshError::MissingVertex { face: 1, vertex: 4, n_vertices: 4 };
    assert_eq!(refused([4, 1, 0]), missing);
}

#[test]
fn refinement_draws_the_lines_of_the_samples_only() {
    // So flat that nothing is hidden.
    let surface = of("sin(x) / 10").samples(11, 6).aspect(Aspect::Data);
    for (every, expected) in [(1, 11 + 6), (2, 6 + 4), (4, 4 + 3)] {
        let lines = SurfaceLines { every, ..bare() };
        let drawing = drawn(&surface, NamedView::Isometric, &lines);
        assert!(drawing.samples.ends_with("samples") && drawing.samples != "11 × 6 samples");
        let n_strokes = drawing.drawn.drawing.len();
        assert_eq!(n_strokes, expected, "every {every}");
    }
}

#[test]
fn lines_that_flow_together_are_told_with_a_number_that_draws_them_apart() {
    let surface = of("x + y").samples(401, 401);
    let crowded = drawn(&surface, NamedView::Top, &bare());
    let every = crowded.crowded(0.3).expect("too many lines");
    assert!(every > 1);
    let apart = drawn(&surface, NamedView::Top, &SurfaceLines { every, ..bare() });
    assert_eq!(apart.crowded(0.3), None);
    let scale = apart.page.mm_per_image_unit();
    let covered = length(&apart, StrokeKind::Grid) * scale * 0.3;
    let (low, high) = apart.extent.corners().expect("a box");
    let DVec2 { x, y } = (high - low) * scale;
    assert!((0.1..0.3).contains(&(covered / (x * y))), "{}", covered / (x * y));
    assert_eq!(crowded.crowded(0.0), None);
}

#[test]
fn what_cannot_be_drawn_is_refused_for_its_own_reason() {
    let surface = of("x * y").samples(9, 9);
    let holes = of("sqrt(r - 2)").samples(9, 9);
    let no_grid = SurfaceLines { along_x: false, along_y: false, ..bare() };
    let one = |engine| SurfaceLines { along_y: false, engine, ..bare() };
    let floating = one(SurfaceEngine::FloatingHorizon);
    let domain = surface.clone().domain("r < 2").expect("a formula");
    let outside = surface.clone().domain("r < 0").expect("a formula");
    let high = of("x").aspect(Aspect::Data).z_scale(1e308);
    for (surface, lines, expected) in [
        (&of("sqrt(-1)"), bare(), SamplingError::NoHeights { outside_domain: false }.into()),
        (&outside, bare(), SamplingError::NoHeights { outside_domain: true }.into()),
        (&high, bare(), SamplingError::TooHigh { factor: 1e308 }.into()),
        (&holes, floating.clone(), HorizonError::Holes.into()),
        (&surface, SurfaceLines { along_y: true, ..floating.clone() }, SurfaceError::OneFamily),
        (&surface, SurfaceLines { border: true, ..floating.clone() }, SurfaceError::OneFamily),
        (&domain, floating, SurfaceError::OneGrid),
        (&holes, one(SurfaceEngine::MaxMin), SurfaceError::MaxMin),
        (&holes, SurfaceLines { order: Some(CellOrder::Rows), ..bare() }, SurfaceError::Order),
        (
            &of("2.5"),
            SurfaceLines { levels: Some(Levels::Count(3)), ..no_grid.clone() },
            NoLevels::Level { height: 2.5 }.into(),
        ),
        (
            &of("x").samples(2, 2).z_scale(7.0),
            SurfaceLines { levels: Some(Levels::At(vec![6.0])), ..no_grid },
            NoLevels::OutOfRange { low: -5.0, high: 5.0 }.into(),
        ),
        (
            &of("x").samples(4001, 4001),
            SurfaceLines { mesh: true, ..bare() },
            SurfaceError::TooManyTriangles(32_000_000),
        ),
        (&of("x == 0 ? 1 : 0/0").samples(3, 3), bare(), SurfaceError::NoCells),
    ] {
        assert_eq!(refused(surface, &lines), expected);
    }
}

#[test]
fn what_is_odd_about_a_drawing_is_noted() {
    let axes = |name: &str| {
        let titles = ["x", "y", name].map(str::to_owned);
        let titles = hiddenline::stages::axes::Titles { axes: titles, drawing: String::new() };
        SurfaceLines { axes: Some(titles.into()), ..bare() }
    };
    let plane = of("x").samples(3, 3);
    assert_eq!(drawn(&plane, NamedView::Isometric, &axes("z")).notes, []);
    let missing = SurfaceNote::MissingLetters(vec!['漢']);
    assert_eq!(drawn(&plane, NamedView::Isometric, &axes("漢")).notes, [missing]);
    let levels = SurfaceLines { levels: Some(Levels::At(vec![6.0])), ..bare() };
    let none = SurfaceNote::NoLevels(NoLevels::OutOfRange { low: -5.0, high: 5.0 });
    assert_eq!(drawn(&plane, NamedView::Isometric, &levels).notes, [none]);
    let waves = of("sin(900*x)").samples(9, 9);
    let notes = drawn(&waves, NamedView::Isometric, &bare()).notes;
    assert!(matches!(notes[..], [SurfaceNote::Uncertified(_)]), "{notes:?}");
}

#[test]
fn a_surface_can_be_drawn_through_a_camera() {
    let surface = Surface::grid(
        Grid::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0], vec![0.0, 1.0, 0.0, 2.0, 0.0, 1.0])
            .expect("a grid"),
    );
    let view = View::default();
    let by_view = draw_surface(&surface, &view, &bare(), &PageOptions::default()).unwrap();
    let camera: Camera = by_view.camera;
    let view = View::from(&camera);
    let by_camera = draw_surface(&surface, &view, &bare(), &PageOptions::default()).unwrap();
    assert_eq!(by_camera.camera, camera);
    assert_eq!(by_camera.drawn.drawing, by_view.drawn.drawing);
}
