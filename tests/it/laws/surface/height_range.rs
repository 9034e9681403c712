//! Ranges of heights: cuts and plateaus against closed forms, and the box that they make.

use std::f64::consts::PI;

use hiddenline::glam::{DVec2, DVec3};
use hiddenline::stages::draw::surface::axes_box;
use hiddenline::stages::surface::{SamplingError, ScatteredPoints};
use hiddenline::{Aspect, Outside, Paper, StrokeKind, Strokes, Surface, SurfaceLines, View};

const NO_LINES: hiddenline::stages::surface::LatticeLines =
    hiddenline::stages::surface::LatticeLines {
        along_rows: false,
        along_columns: false,
        every: 1,
        triangles: false,
    };

/// The triangles of a surface to the scale of its data.
fn triangles(surface: &Surface) -> Vec<[DVec3; 3]> {
    let sampled = surface.clone().aspect(Aspect::Data).sample().expect("samples");
    let mesh = sampled.lined(&NO_LINES, &[], None).into_mesh().expect("a mesh");
    let at = |v: u32| mesh.positions()[v as usize];
    (0..mesh.n_faces()).map(|face| [0, 1, 2].map(|k| at(mesh.face(face as u32)[k]))).collect()
}

fn area(triangles: &[[DVec3; 3]]) -> f64 {
    triangles.iter().map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0).sum()
}

/// Paraboloids z = x² + y² over a square of side 4 as a formula, a grid, points and a patch.
fn paraboloids(n: usize) -> [Surface; 4] {
    let side = (-2.0, 2.0);
    let formula = Surface::formula("x^2 + y^2").expect("a formula").x(-2.0, 2.0).y(-2.0, 2.0);
    let grid = Surface::from_fn(side, side, (n, n), |x, y| x * x + y * y).expect("a grid");
    let at = |k: usize| -2.0 + 4.0 * k as f64 / (n - 1) as f64;
    let mut text = String::new();
    for j in 0..n {
        for i in 0..n {
            let (x, y) = (at(i), at(j));
            text += &format!("{x} {y} {}\n", x * x + y * y);
        }
    }
    let points = ScatteredPoints::read(&text, None).expect("points").points;
    let patch = Surface::parametric(["u", "v", "u^2 + v^2"], side, side).expect("formulas");
    [formula.samples(n, n), grid, Surface::points(points).expect("a surface"), patch.samples(n, n)]
}

#[test]
fn cut_paraboloids_have_the_area_of_their_closed_form() {
    for (low, high) in [(-1.0, 3.0), (0.5, 2.25), (1.0, 3.9)] {
        let of = |c: f64| PI * ((1.0 + 4.0 * f64::max(c, 0.0)).powf(1.5) - 1.0) / 6.0;
        for (k, surface) in paraboloids(161).into_iter().enumerate() {
            let cut = triangles(&surface.z(low, high));
            let off = (area(&cut) / (of(high) - of(low)) - 1.0).abs();
            assert!(off < 2e-3, "{k}: {off}");
            let is_in = |p: &DVec3| (low..=high).contains(&p.z);
            assert!(cut.iter().flatten().all(is_in), "{k}");
        }
    }
}

#[test]
fn plateaus_fill_what_is_beyond() {
    for (k, surface) in paraboloids(81).into_iter().enumerate() {
        let clamped = triangles(&surface.z(1.0, 3.0).outside(Outside::Clamp));
        // In plan nothing is lost.
        let flat = |t: &[DVec3; 3]| {
            let [a, b, c] = t.map(|p| p.truncate());
            (b - a).perp_dot(c - a).abs() / 2.0
        };
        let plan: f64 = clamped.iter().map(flat).sum();
        assert!((plan - 16.0).abs() < 1e-9, "{k}: {plan}");
        let level =
            |z: f64| clamped.iter().filter(|t| t.iter().all(|p| p.z == z)).map(flat).sum::<f64>();
        assert!((level(1.0) / PI - 1.0).abs() < 0.06, "{k}: {}", level(1.0));
        assert!((level(3.0) / (16.0 - 3.0 * PI) - 1.0).abs() < 0.06, "{k}: {}", level(3.0));
    }
}

fn strokes(surface: &Surface, lines: &SurfaceLines) -> Strokes {
    surface.draw(&View::from_angles(30.0, 25.0), lines).strokes(Paper::A4).expect("strokes").0
}

#[test]
fn a_range_turned_around_is_the_surface_upside_down() {
    let lines = SurfaceLines::default().without_axes();
    let of = |text: &str, from: f64, to: f64| {
        strokes(&Surface::formula(text).expect(text).samples(31, 31).z(from, to), &lines)
    };
    assert_eq!(of("x*y + x", 7.0, -12.0), of("-(x*y + x)", -7.0, 12.0));
    assert_ne!(of("x*y + x", 7.0, -12.0), of("x*y + x", -12.0, 7.0));
    let heights = |x: f64, y: f64| (x * 1.3).sin() + y;
    let side = (-2.0, 2.0);
    let one = Surface::from_fn(side, side, (21, 21), heights).expect("a grid");
    let other = Surface::from_fn(side, side, (21, 21), |x, y| -heights(x, y)).expect("a grid");
    assert_eq!(strokes(&one.z(1.5, -2.0), &lines), strokes(&other.z(-1.5, 2.0), &lines));
}

#[test]
fn plateaus_of_formulas_are_those_of_clamp() {
    let lines = SurfaceLines::default();
    let given = Surface::formula("3*x - y^2").expect("a formula").samples(21, 21);
    let clamped = given.clone().z(-6.0, 4.0).outside(Outside::Clamp);
    let typed = Surface::formula("clamp(3*x - y^2, -6, 4)").expect("a formula").samples(21, 21);
    assert_eq!(strokes(&clamped, &lines), strokes(&typed.clone().z(-6.0, 4.0), &lines));
    assert_ne!(strokes(&clamped, &lines), strokes(&given.z(-6.0, 4.0), &lines));
}

#[test]
fn the_box_has_the_heights_that_are_asked_for() {
    for (k, surface) in paraboloids(21).into_iter().enumerate() {
        for (from, to) in [(-20.0, 10.0), (0.5, 2.0), (1.0, 30.0), (10.0, -20.0)] {
            let sampled = surface.clone().z(from, to).sample().expect("samples");
            let bounds = axes_box(&sampled);
            assert!(!bounds.z_may_grow);
            assert_eq!(bounds.ranges[2], (f64::min(from, to), f64::max(from, to)), "{k}");
            let [a, b] = [from, to].map(|z| bounds.scales[2].drawn(z));
            let tall = (b - a).abs();
            assert!((a.min(b) - bounds.low.z).abs() < 1e-12 * tall, "{k}");
            assert!((a.max(b) - bounds.high.z).abs() < 1e-12 * tall, "{k}");
            assert!(a < b, "the first number is below: {k}");
            // The patch is to scale.
            if k < 3 {
                let wide = (bounds.high - bounds.low).truncate().max_element();
                assert!((tall / wide - 0.4).abs() < 1e-12, "{k}: {tall}");
            }
        }
    }
}

#[test]
fn cuts_are_lines_of_their_own_kind_at_the_height_asked_for() {
    let view = View::top();
    for (k, surface) in paraboloids(41).into_iter().enumerate() {
        let lines = SurfaceLines::default().without_axes();
        // Scattered points have lines along their triangles.
        let lines =
            if k == 2 { SurfaceLines { mesh: true, ..lines.no_grid_lines() } } else { lines };
        let cut = surface.z(0.5, 2.25);
        let (drawn, page) = cut.draw(&view, &lines).strokes(Paper::A4).expect("strokes");
        let of = drawn.iter().filter(|stroke| stroke.kind == StrokeKind::Cut);
        let mm = page.mm_per_image_unit();
        // The disc of radius 1.5 fills the height of the page.
        let unit = 190.0 / 3.0;
        let length: f64 = of
            .clone()
            .flat_map(|stroke| stroke.points.windows(2))
            .map(|pair| pair[0].distance(pair[1]) * mm)
            .sum();
        let expected = 2.0 * PI * (1.5 + 0.5_f64.sqrt()) * unit;
        assert!((length / expected - 1.0).abs() < 0.01, "{k}: {length} of {expected}");
        let (low, high) = drawn.bounds().expect("strokes");
        let middle: DVec2 = (low + high) / 2.0;
        for p in of.flat_map(|stroke| stroke.points) {
            let r = (*p - middle).length() * mm / unit;
            let off = (r - 1.5).abs().min((r - 0.5_f64.sqrt()).abs());
            assert!(off < 0.01, "{k}: {r}");
        }
    }
}

#[test]
fn a_range_without_heights_is_refused_with_those_there_are() {
    for surface in paraboloids(21) {
        let refused = surface.z(9.0, 12.0).sample().expect_err("nothing to draw");
        let SamplingError::OutOfRange { low, high } = refused else {
            panic!("{refused}");
        };
        assert!(low.abs() < 1e-9 && (high - 8.0).abs() < 1e-9, "{low} {high}");
    }
}

#[test]
fn the_box_has_the_values_of_the_axes_whatever_they_are_drawn_at() {
    let surface = Surface::formula("x + 2*y").expect("a formula").x(1.0, 3.0).y(10.0, 60.0);
    for surface in [surface.clone().aspect(Aspect::Data).z_scale(5.0), surface] {
        let sampled = surface.samples(5, 7).sample().expect("samples");
        assert_ne!(axes_box(&sampled).high.z, 123.0, "drawn as it is");
        for ((low, high), expected) in
            axes_box(&sampled).ranges.into_iter().zip([(1.0, 3.0), (10.0, 60.0), (21.0, 123.0)])
        {
            assert!(
                (low - expected.0).abs() < 1e-9 && (high - expected.1).abs() < 1e-9,
                "{low} to {high}"
            );
        }
    }
}
