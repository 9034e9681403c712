//! Surfaces that end at a rim inside their range, with their folds: Max-Min against a mesh engine.

use hiddenline::stages::camera::framing::View;
use hiddenline::stages::draw::surface::{SurfaceEngine, SurfaceLines, draw_surface};
use hiddenline::stages::page::{PageOptions, Paper};
use hiddenline::stages::strokes::StrokeKind;
use hiddenline::stages::surface::Surface;

use super::grid_folds::{length, lines, random_view};
use crate::scenes::{Rng, number_of_scenes};

#[test]
fn balls_and_disks_are_drawn_by_max_min_with_their_folds() {
    let mut rng = Rng(62);
    let (mut n_drawn, n_scenes) = (0, number_of_scenes(40) as usize);
    let mut n_with_folds = 0;
    for k in 0..n_scenes {
        // Pythagorean samples lie on the rim but for rounding; others never come near it.
        let (radius, reach) =
            rng.pick(&[(3.0, 3.0), (5.0, 5.0), (3.0, 3.1), (2.5, 3.7), (1.0, 1.0)]);
        let square = radius * radius;
        let flat = rng.pick(&[1.0, 0.4, 2.0]);
        let half = format!("{flat}*sqrt({square}-x^2-y^2)");
        let [first, second] = match rng.below(4) {
            0 => [format!("-{half}"), half],
            1 => [half.clone(), format!("-0.5*{half}")],
            _ => [half.clone(), format!("-{half}")],
        };
        let [nx, ny] = [0, 1].map(|_| match rng.below(3) {
            0 => 9 + rng.below(33),
            _ => 11 + 10 * rng.below(3),
        });
        let is_disk = rng.one_in(3);
        let surface = if is_disk {
            let wave = format!("sin(2*x)*cos(3*y)/{}", 1 + rng.below(3));
            let disk = format!("x^2+y^2<{square}");
            let domain = rng.pick(&[disk.as_str(), "x<1", "y>=-1"]);
            Surface::formula(&wave).and_then(|surface| surface.domain(domain))
        } else {
            Surface::formula(&first).and_then(|surface| surface.sheet(&second))
        };
        let surface = surface.expect("a formula");
        let surface = surface.x(-reach, reach).y(-reach, reach).samples(nx, ny);
        let view = random_view(&mut rng);
        let page = PageOptions::from(Paper::A4);
        let by = |engine| draw_surface(&surface, &view, &lines(engine), &page);
        let what = format!("{k}: {first}, {second}, disk {is_disk}, {nx} x {ny}, {view:?}");
        let other = by(SurfaceEngine::Appel).unwrap_or_else(|error| panic!("{what}: {error}"));
        let Ok(one) = by(SurfaceEngine::MaxMin) else {
            continue;
        };
        n_drawn += 1;
        n_with_folds += usize::from(length(&one, StrokeKind::Silhouette) > 0.0);
        for kind in [StrokeKind::Silhouette, StrokeKind::Grid, StrokeKind::Boundary] {
            let lengths = [&one, &other].map(|drawn| length(drawn, kind));
            assert!((lengths[0] - lengths[1]).abs() < 1e-4, "{what}, {kind:?}: {lengths:?} mm");
        }
    }
    assert!(
        n_drawn + n_scenes / 40 >= n_scenes && 2 * n_with_folds > n_drawn,
        "{n_drawn} {n_with_folds}"
    );
}

#[test]
fn domains_have_their_areas() {
    for (domain, area) in [
        ("x^2+y^2<9", 9.0 * std::f64::consts::PI),
        ("x<1", 24.0),
        ("x-y<1", 36.0 - 12.5),
        // A gap along a row of samples that is narrower than a cell.
        ("y<0 || y>=0.2", 36.0 - 6.0 * 0.2),
        ("x<0 || x>0.2", 36.0 - 6.0 * 0.2),
    ] {
        for n in [13, 31, 61] {
            let surface = Surface::formula("x/4").and_then(|surface| surface.domain(domain));
            let surface = surface.expect("a formula").x(-3.0, 3.0).y(-3.0, 3.0).samples(n, n);
            let lines = SurfaceLines { keep_scene: true, ..lines(SurfaceEngine::Auto) };
            let page = PageOptions::from(Paper::A4);
            let drawn = draw_surface(&surface, &View::default(), &lines, &page).expect(domain);
            let scene = drawn.scene.expect("a scene");
            let plan = |vertex: u32| scene.mesh().positions()[vertex as usize].truncate();
            let found: f64 = scene
                .triangles()
                .iter()
                .map(|triangle| {
                    let [a, b, c] = triangle.map(plan);
                    0.5 * (b - a).perp_dot(c - a)
                })
                .sum();
            // A chord of a circle leaves out some of it.
            let missing = area - found;
            let most = if domain.contains('^') { 30.0 / f64::from(n as u32).powi(2) } else { 1e-5 };
            assert!((-1e-5..most).contains(&missing), "{domain}, {n}: {found}, not {area}");
        }
    }
}
