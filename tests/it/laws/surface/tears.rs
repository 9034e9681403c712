//! Surfaces are left open where their formulas jump or have poles, and nowhere else.

use hiddenline::glam::DVec2;
use hiddenline::stages::camera::Projection;
use hiddenline::stages::draw::surface::{SurfaceNote, SurfaceOutput, draw_surface};
use hiddenline::stages::engines::surface::max_min;
use hiddenline::{PageOptions, Surface, SurfaceLines, View};

/// Points this close to a border are on it: less than 10⁻³ mm on paper.
const ON_BORDER: f64 = 1e-6;

fn drawn(text: &str, samples: usize, view: &View) -> SurfaceOutput {
    let surface = Surface::formula(text).expect(text).samples(samples, samples);
    let lines = SurfaceLines::default().without_axes();
    draw_surface(&surface, view, &lines, &PageOptions::default()).expect(text)
}

/// The strokes of a map, by x and y.
fn map(output: &SurfaceOutput) -> Vec<Vec<DVec2>> {
    assert_eq!(output.camera.projection(), Projection::Orthographic);
    let origin = output.camera.eye().truncate();
    let strokes = output.drawn.drawing.iter();
    strokes.map(|stroke| stroke.points.iter().map(|p| *p + origin).collect()).collect()
}

#[test]
fn no_stroke_has_points_on_both_sides_of_a_jump_or_pole() {
    type Side = fn(DVec2) -> f64;
    // The number of the side that a place is on, growing by 1 at each border.
    let cases: [(&str, Side); 6] = [
        ("1/x", |p| p.x / 100.0),
        ("1/(x - y/3)", |p| (p.x - p.y / 3.0) / 100.0),
        ("tan(x*y/4)", |p| p.x * p.y / (4.0 * std::f64::consts::PI) + 0.5),
        ("1/(x^2 + y^2 - 4)", |p| (p.length() - 2.0) / 100.0),
        ("floor(x/2 + y/5)", |p| p.x / 2.0 + p.y / 5.0),
        ("x < 0.3 ? 0 : 1 + x", |p| (p.x - 0.3) / 100.0),
    ];
    for (text, side) in cases {
        for samples in [20, 21] {
            let output = drawn(text, samples, &View::top());
            let mut strokes_on = [0, 0];
            for stroke in map(&output) {
                for pair in stroke.windows(2) {
                    let [a, b] = [side(pair[0]), side(pair[1])];
                    let (low, high) = (a.min(b), a.max(b));
                    let is_across = (low + ON_BORDER).floor() < (high - ON_BORDER).floor();
                    assert!(!is_across, "{text}: from {} to {}", pair[0], pair[1]);
                }
                let is_far = stroke.iter().any(|p| side(*p) > ON_BORDER);
                strokes_on[usize::from(is_far)] += 1;
            }
            assert!(strokes_on.iter().all(|n| *n > 10), "{text}: {strokes_on:?}");
            let certificate = output.certificate.expect("a certificate");
            assert!(
                certificate.tears > 0 || text.starts_with('1') || text.starts_with('t'),
                "{text}"
            );
        }
    }
}

#[test]
fn the_cut_of_an_angle_is_an_open_edge() {
    for samples in [40, 41] {
        let output = drawn("atan2(y, x)", samples, &View::top());
        for stroke in map(&output) {
            for pair in stroke.windows(2) {
                let is_left = pair[0].x.max(pair[1].x) < -ON_BORDER;
                let [a, b] = [pair[0].y, pair[1].y];
                let is_across = a.min(b) < -ON_BORDER && a.max(b) > ON_BORDER;
                assert!(!(is_left && is_across), "from {} to {}", pair[0], pair[1]);
            }
        }
        // From above, both sides of the cut are drawn where it is.
        let ends =
            map(&output).into_iter().flatten().filter(|p| p.y.abs() < ON_BORDER && p.x < -1.0);
        assert!(ends.count() > samples / 2);
    }
}

#[test]
fn gaps_between_equal_heights_are_closed() {
    for (text, same) in [
        ("sin(r)/r", "sinc(r)"),
        ("x == 0 ? 1 : sin(x)/x", "sinc(x)"),
        ("x > 0 ? x : -x", "abs(x)"),
        ("sin(theta)*r", "y"),
    ] {
        for samples in [20, 21] {
            let [output, same] = [text, same].map(|text| drawn(text, samples, &View::default()));
            let certificate = output.certificate.expect("a certificate");
            assert_eq!(certificate.tears, 0, "{text}: {certificate:?}");
            assert_eq!(output.drawn.engine, max_min::NAME, "{text}");
            assert!(output.notes.iter().all(|n| !matches!(n, SurfaceNote::Poles { .. })), "{text}");
            let [strokes, others] = [&output, &same].map(|output| output.drawn.drawing.len());
            assert!(
                strokes.abs_diff(others) <= others / 3,
                "{text}: {strokes} strokes, not {others}"
            );
        }
    }
}

#[test]
fn a_slit_without_heights_stays_open_between_equal_heights() {
    // Narrower than a cell, so that no sample lies in it.
    for samples in [20, 30] {
        let output = drawn("abs(x) < 0.1 ? nan : y/10", samples, &View::top());
        let (mut n_up_to, mut n_all) = (0, 0);
        for stroke in map(&output) {
            for pair in stroke.windows(2) {
                let [a, b] = [pair[0].x, pair[1].x];
                let (low, high) = (a.min(b), a.max(b));
                assert!(low > 0.1 - ON_BORDER || high < ON_BORDER - 0.1, "from {low} to {high}");
            }
            n_all += 1;
            n_up_to += usize::from(stroke.iter().any(|p| (p.x.abs() - 0.1).abs() < ON_BORDER));
        }
        assert!(n_up_to >= samples && n_all > n_up_to, "{n_up_to} of {n_all}");
    }
}

#[test]
fn usual_heights_are_drawn_of_what_grows_without_end() {
    for (text, least, most) in [
        ("1/x", 2.0, 6.0),
        ("1/(x^2 + y^2 - 4)", 0.5, 4.0),
        ("tan(x*y)", 3.0, 15.0),
        ("ln(x^2 + y^2)", 2.0, 5.0),
    ] {
        for samples in [80, 81] {
            let output = drawn(text, samples, &View::default());
            let Some(SurfaceNote::Poles { low, high }) =
                output.notes.iter().find(|n| matches!(n, SurfaceNote::Poles { .. }))
            else {
                panic!("{text}: {:?}", output.notes)
            };
            let largest = low.abs().max(high.abs());
            assert!((least..most).contains(&largest), "{text}: {low} to {high}");
        }
    }
    for text in ["sinc(r)", "sqrt(9 - r^2)", "floor(x)", "exp(x)", "1 - sqrt(x)", "x^2 - sqrt(x)"] {
        let output = drawn(text, 41, &View::default());
        assert!(output.notes.iter().all(|n| !matches!(n, SurfaceNote::Poles { .. })), "{text}");
    }
}

#[test]
fn a_surface_ends_smoothly_where_its_formula_has_no_value() {
    let output = drawn("sqrt(9 - r^2)", 30, &View::top());
    let radius = |p: &DVec2| p.length();
    let largest = map(&output).iter().flatten().map(radius).fold(0.0, f64::max);
    assert!((largest - 3.0).abs() < 1e-9, "{largest}");
    let rim: Vec<DVec2> =
        map(&output).into_iter().flatten().filter(|p| p.length() > 2.9999).collect();
    assert!(rim.len() > 60, "{}", rim.len());
}
