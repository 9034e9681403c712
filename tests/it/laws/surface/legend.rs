//! Legends: clear of all other ink, and sheets told apart.

use hiddenline::glam::DVec2;
use hiddenline::{
    Axes, AxesStyle, Legend, LegendPlace, Levels, Paper, ParameterList, PenRole, PenRule,
    StrokeKind, Surface, SurfaceLines, Titles, View,
};

/// Minimum distance between a legend and anything else, in millimeters.
const CLEARANCE_MM: f64 = 1.5;

fn bells() -> Surface {
    let a = ParameterList::new("a", [1.0, 2.0, 3.0]).expect("values");
    let bells = Surface::formula_for("a + exp(-a*r^2/2)", &[a]).expect("sheets");
    bells.x(-3.0, 3.0).y(-3.0, 3.0).samples(13, 13)
}

fn distance([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> f64 {
    (c - b).max(a - d).max(DVec2::ZERO).length()
}

#[test]
fn a_legend_touches_nothing() {
    let styles = [None, Some(AxesStyle::Edges), Some(AxesStyle::Back), Some(AxesStyle::Box)];
    let mut seed = 9_u32;
    let mut random = move |n: u32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 16) % n
    };
    for k in 0..48 {
        let place = LegendPlace::ALL[random(4) as usize];
        let (azimuth, elevation) = (f64::from(random(360)), f64::from(random(170)) - 85.0);
        let style = styles[k % styles.len()];
        let title = ["", "A drawing"][random(2) as usize];
        let lines = SurfaceLines::default().levels(Levels::Round).smoothness_mm(0.0).legend(place);
        let axes = style.map(|style| Axes::new(style).titles(Titles::of_drawing(title)));
        let lines = SurfaceLines { axes, ..lines };
        let paper = [Paper::A4, Paper::A5][random(2) as usize];
        let view = View::from_angles(azimuth, elevation);
        let surface = bells().names(["short", "a name of several words", "y^{2}"]);
        let (strokes, page) = surface.draw(&view, &lines).strokes(paper).expect("strokes");
        let boxes: Vec<(StrokeKind, u16, [DVec2; 2])> = strokes
            .iter()
            .map(|stroke| {
                let points = stroke.points.iter();
                let on_page = points.map(|p| page.page_from_image.transform_point2(*p));
                let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
                let around = on_page.fold(none, |[a, b], p| [a.min(p), b.max(p)]);
                (stroke.kind, stroke.part.sheet, around)
            })
            .collect();
        // Its samples, two of them for levels, each with its text.
        let is_sample = |kind: StrokeKind, [a, b]: [DVec2; 2]| {
            let width = b.x - a.x;
            kind != StrokeKind::Axis && a.y == b.y && (width - 10.0).abs() < 0.3
        };
        let first = boxes.iter().position(|(kind, sheet, around)| {
            *kind == StrokeKind::Grid && *sheet == 1 && is_sample(*kind, *around)
        });
        let first = first.expect("a sample");
        let behind = [StrokeKind::Back, StrokeKind::Box];
        let tail = boxes[first..].iter().filter(|(kind, ..)| !behind.contains(kind));
        let legend: Vec<[DVec2; 2]> = tail.map(|(_, _, around)| *around).collect();
        assert!(legend.len() > 30, "{}", legend.len());
        let wires = boxes[first..].iter().filter(|(kind, ..)| behind.contains(kind));
        for (kind, _, other) in boxes[..first].iter().chain(wires) {
            for part in &legend {
                let d = distance(*part, *other);
                assert!(
                    d >= CLEARANCE_MM - 1e-6,
                    "{place:?} {azimuth} {elevation} {style:?}: {kind:?} {d}"
                );
            }
        }
        let size = DVec2::new(page.paper.width_mm, page.paper.height_mm);
        for [a, b] in &legend {
            assert!(a.cmpge(DVec2::splat(10.0 - 1e-6)).all());
            assert!(b.cmple(size - DVec2::splat(10.0 - 1e-6)).all());
        }
    }
}

/// The layers by name: number, color, and the lengths of their strokes in millimeters.
fn layers(pens: Vec<PenRule>, lines: &SurfaceLines) -> Vec<(String, u32, String, Vec<f64>)> {
    let bells = bells();
    let drawing = bells.draw(&View::isometric(), lines);
    let sheet = drawing.pens(pens).on(Paper::A4).expect("a sheet");
    let layers = sheet.plot().layers.iter().map(|layer| {
        let of = |stroke: &[DVec2]| stroke.windows(2).map(|p| p[0].distance(p[1])).sum();
        let lengths = layer.lines.iter().map(of).collect();
        (layer.name.clone(), layer.number, layer.pen.color.clone(), lengths)
    });
    layers.collect()
}

#[test]
fn sheets_have_pens_with_a_legend_or_a_rule_for_some_lines() {
    let grid = SurfaceLines::default().without_axes();
    let with_legend = grid.clone().legend(Legend::default());
    let names = |layers: &[(String, u32, String, Vec<f64>)]| {
        layers.iter().map(|(name, number, ..)| format!("{number} {name}")).collect::<Vec<_>>()
    };
    assert_eq!(names(&layers(vec![], &grid)), ["1 visible"]);
    let of_legend = layers(vec![], &with_legend);
    assert_eq!(names(&of_legend), ["1 visible", "2 sheet2", "3 sheet3"]);
    assert_eq!(of_legend[2].2, "#c00000");
    let rule = PenRule::new(PenRole::Sheet(2), 7);
    assert_eq!(names(&layers(vec![rule], &grid)), ["1 visible", "3 sheet3", "7 sheet2"]);
    let visible = PenRule::new(PenRole::Visible, 1);
    assert_eq!(names(&layers(vec![visible], &grid)), ["1 visible"]);
}

#[test]
fn sheets_whose_pens_look_alike_are_dashed() {
    let lines = SurfaceLines::default().without_axes().legend(Legend::default());
    let longest = |lengths: &[f64]| lengths.iter().copied().fold(0.0, f64::max);
    let drawn = layers(vec![], &lines);
    assert!(drawn.iter().all(|(.., lengths)| longest(lengths) > 40.0));
    let alike = |number: u32| {
        let role = if number == 1 { PenRole::Visible } else { PenRole::Sheet(number as u16) };
        PenRule::new(role, number).color("#000000")
    };
    let drawn = layers(vec![alike(1), alike(2), alike(3)], &lines);
    assert!(longest(&drawn[0].3) > 40.0);
    // Dashes of 4 and 1 mm, stretched so that each line ends with a whole one.
    let (second, third) = (longest(&drawn[1].3), longest(&drawn[2].3));
    assert!((4.0..6.5).contains(&second), "{second}");
    assert!((1.0..2.1).contains(&third), "{third}");
    // The same color but not the same width.
    let wide = alike(3).width_mm(0.7);
    let drawn = layers(vec![alike(1), alike(2), wide], &lines);
    assert!(longest(&drawn[1].3) < 6.5 && longest(&drawn[2].3) > 40.0);
    // Without a legend nothing is dashed.
    let plain = SurfaceLines::default().without_axes();
    let drawn = layers(vec![alike(1), alike(2), alike(3)], &plain);
    assert!(drawn.iter().all(|(.., lengths)| longest(lengths) > 40.0));
}
