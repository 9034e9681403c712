//! Axes that are logarithmic, turned around or of given lengths, against closed forms.

use glam::DVec3;
use hiddenline::stages::draw::surface::{Levels, SurfaceLines, SurfaceNote, draw_surface};
use hiddenline::stages::page::PageOptions;
use hiddenline::stages::strokes::StrokeKind;
use hiddenline::stages::surface::{Aspect, Grid, SampledSurface, SamplingError, Surface};
use hiddenline::{Strokes, View};

fn of(text: &str) -> Surface {
    Surface::formula(text).expect("a formula")
}

fn sampled(surface: &Surface) -> SampledSurface {
    surface.sample().expect("samples")
}

fn size(surface: &Surface) -> DVec3 {
    let (low, high) = sampled(surface).bounds();
    high - low
}

fn drawn(surface: &Surface, view: View, lines: &SurfaceLines) -> Strokes {
    let lines = lines.clone().without_axes();
    let drawing = draw_surface(surface, &view, &lines, &PageOptions::default());
    drawing.expect("a drawing").drawn.drawing
}

#[test]
fn powers_are_planes_on_logarithmic_axes() {
    let surface = of("x^2 / y").x(0.1, 1000.0).y(2.0, 50.0).samples(41, 31);
    let surface = surface.log([true; 3]).aspect(Aspect::Data);
    let sampled = sampled(&surface);
    let lattices = sampled.lattices();
    let lattice = &lattices[0];
    for k in 0..lattice.n_samples {
        let p = lattice.sample(k);
        assert!((p.z - (2.0 * p.x - p.y)).abs() < 1e-12, "{p}");
    }
    // Evenly in the logarithm.
    let xs: Vec<f64> = (0..41).map(|i| lattice.sample(i).x).collect();
    assert!(xs.windows(2).all(|pair| (pair[1] - pair[0] - 0.1).abs() < 1e-12));
    assert_eq!(sampled.ranges()[..2], [(0.1, 1000.0), (2.0, 50.0)]);
}

#[test]
fn turning_an_axis_around_draws_the_mirrored_function() {
    for (text, x_mirrored, y_mirrored) in [
        ("sin(x) + y", "sin(-x) + y", "sin(x) + (-y)"),
        ("x * (y + 2)", "-x * (y + 2)", "x * (-y + 2)"),
    ] {
        let view = View::from_angles(30.0, 25.0);
        let lines = SurfaceLines::default();
        let in_range = |text: &str| of(text).x(-4.0, 3.0).y(-2.0, 5.0).samples(21, 17);
        let mirrored = of(x_mirrored).x(-3.0, 4.0).y(-2.0, 5.0).samples(21, 17);
        let mirrored = drawn(&mirrored, view, &lines);
        assert_eq!(drawn(&in_range(text).x(3.0, -4.0), view, &lines), mirrored);
        assert_eq!(drawn(&in_range(text).reversed([true, false]), view, &lines), mirrored);
        let mirrored = of(y_mirrored).x(-4.0, 3.0).y(-5.0, 2.0).samples(21, 17);
        assert_eq!(
            drawn(&in_range(text).y(5.0, -2.0), view, &lines),
            drawn(&mirrored, view, &lines)
        );
        // Twice is not at all.
        let twice = in_range(text).x(3.0, -4.0).reversed([true, false]);
        assert_eq!(drawn(&twice, view, &lines), drawn(&in_range(text), view, &lines));
    }
}

#[test]
fn domains_see_true_values_on_axes_that_are_turned_around() {
    let disk = |text: &str| of("x + 3*y").domain(text).expect("a domain").samples(31, 31);
    let turned = disk("(x-1)^2 + y^2 < 4").x(5.0, -5.0);
    let mirrored = disk("(-x-1)^2 + y^2 < 4").x(-5.0, 5.0);
    let (low, high) = sampled(&turned).bounds();
    assert!((low.x + 3.0).abs() < 1e-6 && (high.x - 1.0).abs() < 1e-6, "{low} {high}");
    let (other_low, other_high) = sampled(&mirrored).bounds();
    assert!((low - other_low).truncate().length() < 1e-12);
    assert!((high - other_high).truncate().length() < 1e-12);
}

#[test]
fn the_underside_stays_below_when_an_axis_is_turned_around() {
    let lines = SurfaceLines { underside: true, ..SurfaceLines::default() };
    let points = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    let square = Surface::triangles(points, vec![[0, 1, 2], [0, 2, 3]]).expect("triangles");
    let tube = Surface::parametric(["u", "v", "u*v"], (0.0, 1.0), (0.0, 1.0)).expect("formulas");
    for surface in [square, tube.samples(5, 5), of("x*y").samples(5, 5)] {
        for reversed in [[false, false], [true, false], [false, true], [true, true]] {
            let drawing =
                drawn(&surface.clone().reversed(reversed), View::from_angles(30.0, 60.0), &lines);
            assert!(!drawing.is_empty() && drawing.iter().all(|s| !s.underside), "{reversed:?}");
        }
    }
}

#[test]
fn the_box_has_the_lengths_asked_for() {
    let surface = of("x + y").x(0.0, 10.0).y(0.0, 4.0).samples(5, 5);
    assert_eq!(size(&surface), DVec3::new(10.0, 4.0, 4.0));
    let lengths = |x, y, z| size(&surface.clone().aspect(Aspect::Lengths([x, y, z])));
    assert!((lengths(4.0, 4.0, 3.0) - DVec3::new(10.0, 10.0, 7.5)).length() < 1e-12);
    assert!((lengths(1.0, 3.0, 2.0) - DVec3::new(10.0, 30.0, 20.0)).length() < 1e-12);
    // A narrow base is drawn as a square.
    let narrow = of("x + y").x(0.0, 100.0).y(0.0, 4.0).samples(5, 5);
    assert!((size(&narrow) - DVec3::new(100.0, 100.0, 40.0)).length() < 1e-9);
    let log = of("x + y").x(1.0, 100.0).y(0.0, 4.0).samples(5, 5).log([true, false, false]);
    assert!((size(&log) - DVec3::new(4.0, 4.0, 1.6)).length() < 1e-12);
    // The values on the axes are those asked for, to the last bit.
    for (from, to) in [(0.1, 0.7), (-0.3, 1.1), (3.3, 9.9)] {
        let surface = of("x + y").x(from, to).y(0.0, 1.0).aspect(Aspect::Lengths([1.0, 7.0, 3.0]));
        assert_eq!(sampled(&surface).ranges()[..2], [(from, to), (0.0, 1.0)]);
    }
}

#[test]
fn values_without_a_logarithm_are_holes_and_are_counted() {
    let surface = of("x").samples(11, 3).log([false, false, true]);
    assert_eq!(sampled(&surface).n_not_positive(), 6 * 3);
    let grid = Grid::new(vec![0.0, 1.0, 2.0], vec![0.0, 1.0], vec![1., 0., 10., 1., 1., -5.]);
    let grid = Surface::grid(grid.expect("a grid")).log([false, false, true]);
    assert_eq!(sampled(&grid).n_not_positive(), 2);
    let page = PageOptions::default();
    let lines = SurfaceLines { smoothness_mm: 0.0, ..SurfaceLines::default() };
    let drawing = draw_surface(&surface, &View::default(), &lines, &page).expect("a drawing");
    assert!(drawing.notes.contains(&SurfaceNote::NotPositive(18)), "{:?}", drawing.notes);
    let on_x = of("x").log([true, false, false]).sample();
    assert_eq!(on_x.err(), Some(SamplingError::NotPositive { axis: 'x', from: -5.0 }));
}

#[test]
fn level_curves_are_at_true_heights_of_logarithmic_axes() {
    // z = x is 10 where x is 10, in the middle of the logarithm's range from 1 to 100.
    let surface = of("x").x(1.0, 100.0).y(1.0, 2.0).samples(20, 3).log([true, false, true]);
    let lines = SurfaceLines::default().no_grid_lines().levels(Levels::At(vec![10.0]));
    let drawing = drawn(&surface, View::top(), &lines);
    assert!(drawing.iter().all(|stroke| stroke.kind == StrokeKind::Level));
    let points: Vec<f64> = drawing.iter().flat_map(|s| s.points).map(|p| p.x).collect();
    assert!(!points.is_empty());
    // The middle of the base, which is the middle of the view.
    assert!(points.iter().all(|x| x.abs() < 1e-3), "{points:?}");
}
