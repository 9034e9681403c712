//! Axes on paper: how large their text is, and how much room it may take up.

use glam::DVec2;
use hiddenline::stages::draw::surface::{SurfaceNote, SurfaceOutput, draw_surface};
use hiddenline::stages::strokes::StrokeKind;
use hiddenline::{Axes, AxesStyle, PageOptions, Paper, Surface, SurfaceLines, Titles, View};

fn drawn(axes: Axes, paper: Paper, view: &View) -> SurfaceOutput {
    let surface = Surface::formula("x*y/10").expect("a formula").samples(9, 9);
    let lines = SurfaceLines { axes: Some(axes), ..SurfaceLines::default() }.smoothness_mm(0.0);
    let page = PageOptions { paper, ..PageOptions::default() };
    draw_surface(&surface, view, &lines, &page).expect("a drawing")
}

/// The extent on paper of the strokes of some kinds.
fn extents(output: &SurfaceOutput, kinds: &[StrokeKind]) -> Vec<DVec2> {
    let mm = output.page.mm_per_image_unit();
    let strokes = output.drawn.drawing.iter().filter(|stroke| kinds.contains(&stroke.kind));
    let of = |points: &[DVec2]| {
        let first = points[0];
        let around = |(low, high): (DVec2, DVec2), p: &DVec2| (low.min(*p), high.max(*p));
        let (low, high) = points.iter().fold((first, first), around);
        (high - low) * mm
    };
    strokes.map(|stroke| of(stroke.points)).collect()
}

#[test]
fn numbers_are_as_high_as_page_and_pen_ask_for() {
    for paper in [Paper::A3, Paper::A4, Paper::A5] {
        for pen_width_mm in [0.1, 0.3, 0.5, 0.8] {
            let axes = Axes { pen_width_mm, ..Axes::new(AxesStyle::Edges) };
            let output = drawn(axes, paper, &View::isometric());
            let diagonal = paper.width_mm.hypot(paper.height_mm);
            // A hundredth of the diagonal within limits, and six widths of the pen.
            let expected = (0.01 * diagonal).clamp(1.8, 3.5).max(6.0 * pen_width_mm);
            let found = extents(&output, &[StrokeKind::Text]);
            let highest = found.iter().fold(0.0, |highest: f64, size| highest.max(size.y));
            let off = (highest / expected - 1.0).abs();
            assert!(off < 0.01, "{paper:?} {pen_width_mm}: {highest}, not {expected}");
        }
    }
}

#[test]
fn text_that_takes_up_much_room_takes_up_less_or_is_told() {
    let text = "a title of many words that says all of it".to_owned();
    let titles = Titles { axes: [0; 3].map(|_| text.clone()), drawing: text };
    let mut n_told = [0; 2];
    for text_mm in [2.5, 3.5, 5.0, 8.0] {
        for (paper, azimuth) in [(Paper::A4, 30.0), (Paper::A5, 110.0)] {
            let axes = Axes {
                text_height_mm: Some(text_mm),
                ..Axes::new(AxesStyle::Box).titles(titles.clone())
            };
            let output = drawn(axes, paper, &View::from_angles(azimuth, 25.0));
            // How large the box is, and how large it could be.
            let kinds = [StrokeKind::Axis, StrokeKind::Box, StrokeKind::Back];
            let on_paper = output.drawn.drawing.iter().filter(|s| kinds.contains(&s.kind));
            let points = on_paper.flat_map(|stroke| stroke.points);
            let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
            let (low, high) = points.fold(none, |(low, high), p| (low.min(*p), high.max(*p)));
            let size = (high - low) * output.page.mm_per_image_unit();
            let room = DVec2::new(output.page.paper.width_mm, output.page.paper.height_mm) - 20.0;
            let part = (size / room).max_element();
            let is_told = output.notes.contains(&SurfaceNote::LittleRoom);
            // Ticks make the box seem slightly larger.
            assert!(is_told || part > 0.75, "{text_mm} mm: {part} of the room");
            assert!(!is_told || part < 0.8, "{text_mm} mm: {part} of the room");
            n_told[usize::from(is_told)] += 1;
        }
    }
    assert!(n_told[0] > 2 && n_told[1] > 0, "{n_told:?}");
}
