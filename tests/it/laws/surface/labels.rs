//! Labels of level curves: they touch nothing, and each level of some length has one.

use std::collections::BTreeMap;

use glam::DVec2;
use hiddenline::stages::draw::surface::{
    LabelSide, Labels, Levels, SurfaceLines, SurfaceNote, SurfaceOutput, draw_surface,
};
use hiddenline::stages::strokes::StrokeKind;
use hiddenline::stages::surface::formula::{Formula, Variables};
use hiddenline::stages::surface::{Grid, HeightOptions, read_heights};
use hiddenline::{PageOptions, Surface, View};

/// What is drawn on A4 of level curves from above.
fn map(grid: Grid, step: f64, labels: Labels, side: LabelSide) -> SurfaceOutput {
    let levels = Levels::Every { step, offset: 0.0 };
    let lines = SurfaceLines { label_side: side, ..SurfaceLines::default() };
    let lines = lines.no_grid_lines().levels(levels).labels(labels);
    let page = PageOptions::default();
    draw_surface(&Surface::grid(grid), &View::top(), &lines, &page).expect("a drawing")
}

fn segments(points: &[DVec2], mm: f64) -> Vec<[DVec2; 2]> {
    points.windows(2).map(|pair| [pair[0] * mm, pair[1] * mm]).collect()
}

fn from_segment(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    if t.is_nan() { p.distance(a) } else { p.distance(a + t * (b - a)) }
}

/// How far two segments are from each other.
fn distance(s: [DVec2; 2], t: [DVec2; 2]) -> f64 {
    let side = |[a, b]: [DVec2; 2], p: DVec2| (b - a).perp_dot(p - a);
    let crosses = side(s, t[0]) * side(s, t[1]) < 0.0 && side(t, s[0]) * side(t, s[1]) < 0.0;
    if crosses {
        return 0.0;
    }
    let ends = [
        from_segment(s[0], t),
        from_segment(s[1], t),
        from_segment(t[0], s),
        from_segment(t[1], s),
    ];
    ends.into_iter().fold(f64::INFINITY, f64::min)
}

/// Segments by squares of 10 mm, and long ones apart.
#[derive(Default)]
struct Ink {
    squares: BTreeMap<[i32; 2], Vec<[DVec2; 2]>>,
    long: Vec<[DVec2; 2]>,
}

impl Ink {
    fn square(p: DVec2) -> [i32; 2] {
        [(p.x / 10.0).floor() as i32, (p.y / 10.0).floor() as i32]
    }

    fn push(&mut self, [a, b]: [DVec2; 2]) {
        if a.distance(b) > 5.0 {
            self.long.push([a, b]);
        } else {
            self.squares.entry(Self::square(0.5 * (a + b))).or_default().push([a, b]);
        }
    }

    /// All that is within 5 mm.
    fn near(&self, p: DVec2) -> impl Iterator<Item = &[DVec2; 2]> {
        let [x, y] = Self::square(p);
        let around = (x - 1..=x + 1).flat_map(move |x| (y - 1..=y + 1).map(move |y| [x, y]));
        around.filter_map(|square| self.squares.get(&square)).flatten().chain(&self.long)
    }
}

/// Checks that no label touches anything, and that each level with more than 40 mm has one.
fn check(name: &str, output: &SurfaceOutput) {
    let mm = output.page.mm_per_image_unit();
    let strokes: Vec<_> = output.drawn.drawing.iter().collect();
    let (mut lengths, mut labelled) = (BTreeMap::<u16, f64>::new(), Vec::new());
    let mut letters = Vec::new();
    let mut ink = Ink::default();
    for stroke in &strokes {
        let parts = segments(stroke.points, mm);
        if stroke.kind == StrokeKind::Label {
            labelled.push(stroke.part.level);
            letters.push((stroke.part.level, parts));
            continue;
        }
        if matches!(stroke.kind, StrokeKind::Level | StrokeKind::Index) {
            let length: f64 = parts.iter().map(|[a, b]| a.distance(*b)).sum();
            *lengths.entry(stroke.part.level).or_default() += length;
        }
        parts.into_iter().for_each(|part| ink.push(part));
    }
    for (level, length) in lengths {
        assert!(length <= 40.0 || labelled.contains(&level), "{name}: level {level}, {length} mm");
    }
    for (k, (level, parts)) in letters.iter().enumerate() {
        for part in parts {
            for other in ink.near(0.5 * (part[0] + part[1])) {
                let gap = distance(*part, *other);
                assert!(gap > 0.3, "{name}: label of level {level} is {gap} mm from ink");
            }
            for (other_level, other) in letters[..k].iter().filter(|other| other.0 != *level) {
                for other in other {
                    let gap = distance(*part, *other);
                    assert!(
                        gap > 0.5,
                        "{name}: labels of {level} and {other_level} are {gap} mm apart"
                    );
                }
            }
        }
    }
    let left = output.notes.iter().any(|note| matches!(note, SurfaceNote::Unlabelled(_)));
    assert!(!left, "{name}: {:?}", output.notes);
}

fn of_formula(text: &str, n: usize) -> Grid {
    let formula = Formula::parse(text, Variables::Plane).expect("a formula");
    Grid::sample(&formula, (-5.0, 5.0), (-3.5, 3.5), (n, n * 7 / 10)).expect("a grid")
}

const HILLS: &str =
    "90*exp(-((x-2)^2+(y+1)^2)/4) + 70*exp(-((x+2)^2+y^2)/3) - 40*exp(-((x-1)^2+(y-2)^2))";
const RIDGES: &str = "100*abs(sin(x) + cos(1.3*y)) + 8*x";

#[test]
fn labels_touch_nothing_and_each_long_level_has_one() {
    for (name, text, step) in
        [("hills", HILLS, 5.0), ("ridges", RIDGES, 10.0), ("dense", HILLS, 2.0)]
    {
        for labels in [Labels::All, Labels::Index] {
            let output = map(of_formula(text, 81), step, labels, LabelSide::Upright);
            if labels == Labels::All {
                check(name, &output);
            }
            let drawing = &output.drawn.drawing;
            let count = |kind| drawing.iter().filter(|stroke| stroke.kind == kind).count();
            assert!(count(StrokeKind::Index) > 0 && count(StrokeKind::Label) > 0, "{name}");
        }
    }
}

#[test]
fn maps_of_height_files_are_labelled() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/models/heightfields/");
    let files = [("volcano_61x87.csv", [5.0, 2.0]), ("jacksboro_344x403.csv", [50.0, 25.0])];
    for (file, steps) in files {
        let Ok(bytes) = std::fs::read(format!("{folder}{file}")) else {
            eprintln!("not run without {file}");
            continue;
        };
        let grid = read_heights(&bytes, &HeightOptions::default()).expect("heights").grid;
        for step in steps {
            check(file, &map(grid.clone(), step, Labels::All, LabelSide::Upright));
        }
    }
}

#[test]
fn labels_are_upright_or_have_their_tops_uphill() {
    // Around a peak, labels with their tops uphill are upside down above the peak.
    for side in [LabelSide::Upright, LabelSide::Uphill] {
        let output = map(of_formula("100 - r^2", 61), 2.0, Labels::All, side);
        let mm = output.page.mm_per_image_unit();
        let (low, high) = output.drawn.drawing.bounds().expect("ink");
        let center = 0.5 * (low + high) * mm;
        // The first stroke of a label is that of its first digit, 8 or 9, at its left end.
        let mut labels: BTreeMap<u16, Vec<DVec2>> = BTreeMap::new();
        for stroke in output.drawn.drawing.iter().filter(|s| s.kind == StrokeKind::Label) {
            let places = stroke.points.iter().map(|p| *p * mm);
            labels.entry(stroke.part.level).or_default().extend(places);
        }
        assert!(labels.len() > 10, "{}", labels.len());
        let mut n_left_to_right = [0, 0];
        for points in labels.values() {
            let (first, last) = (points[0], points[points.len() - 1]);
            // Several labels of a level are not one after the other.
            if first.distance(last) < 8.0 {
                let is_above = first.y > center.y;
                n_left_to_right[usize::from(is_above)] += usize::from(first.x < last.x);
            }
        }
        let [below, above] = n_left_to_right;
        assert!(below + above > 0);
        if side == LabelSide::Uphill {
            assert_eq!(above, 0, "labels above the peak are turned over");
        }
    }
}

#[test]
fn curves_below_zero_are_dashed_and_the_others_are_not() {
    let lines = SurfaceLines { axes: None, ..SurfaceLines::default() }.no_grid_lines();
    let lines = lines.levels(Levels::At(vec![-1.0, 1.0])).labels(Labels::None).negative_dashed();
    let surface = Surface::formula("x").expect("a formula");
    let output = draw_surface(&surface, &View::top(), &lines, &PageOptions::default());
    let output = output.expect("a drawing");
    let mm = output.page.mm_per_image_unit();
    let lengths = |level: u16| -> Vec<f64> {
        let strokes = output.drawn.drawing.iter().filter(|s| s.part.level == level);
        strokes.map(|s| s.points[0].distance(s.points[s.points.len() - 1]) * mm).collect()
    };
    assert_eq!(lengths(2).len(), 1);
    let (dashes, whole) = (lengths(1), lengths(2)[0]);
    assert!(dashes.len() > 10);
    assert!(
        dashes.iter().all(|dash| (dash - dashes[0]).abs() < 1e-6 && *dash > 2.0 && *dash < 3.0)
    );
    let drawn: f64 = dashes.iter().sum();
    assert!((drawn / whole - 2.0 / 3.0).abs() < 0.02, "{drawn} of {whole}");
}

/// The labels of a map: the strokes of each, in millimeters, one after the other.
fn labels_of(output: &SurfaceOutput) -> Vec<(u16, Vec<Vec<DVec2>>)> {
    let mm = output.page.mm_per_image_unit();
    let mut labels: Vec<(u16, Vec<Vec<DVec2>>)> = Vec::new();
    for stroke in output.drawn.drawing.iter().filter(|s| s.kind == StrokeKind::Label) {
        let points: Vec<DVec2> = stroke.points.iter().map(|p| *p * mm).collect();
        let level = stroke.part.level;
        match labels.last_mut() {
            // Labels of one level are 20 mm apart or more.
            Some((last, strokes)) if *last == level && strokes[0][0].distance(points[0]) < 12.0 => {
                strokes.push(points);
            }
            _ => labels.push((level, vec![points])),
        }
    }
    labels
}

#[test]
fn upright_labels_are_read_from_the_left_or_from_below() {
    for (text, step) in [("100 - r^2", 2.0), (HILLS, 5.0)] {
        let output = map(of_formula(text, 81), step, Labels::All, LabelSide::Upright);
        let mut n_checked = 0;
        for (level, strokes) in labels_of(&output) {
            let middle = |points: &[DVec2]| points.iter().sum::<DVec2>() / points.len() as f64;
            let way = middle(&strokes[strokes.len() - 1]) - middle(&strokes[0]);
            // One digit has no direction.
            if way.length() > 1.5 {
                let is_upright = way.x > -0.1 * way.length() && (way.x > 0.1 || way.y > 0.0);
                assert!(is_upright, "{text}: level {level} runs along {way}");
                n_checked += 1;
            }
        }
        assert!(n_checked > 10, "{text}: {n_checked}");
    }
}

#[test]
fn labels_in_dense_maps_cut_the_curves_that_they_cross() {
    for (text, step) in [("30*sin(x)*cos(y) + 4*x", 0.5), (HILLS, 1.0)] {
        let output = map(of_formula(text, 61), step, Labels::All, LabelSide::Upright);
        let mm = output.page.mm_per_image_unit();
        let mut ink = Ink::default();
        for stroke in output.drawn.drawing.iter().filter(|s| s.kind != StrokeKind::Label) {
            segments(stroke.points, mm).into_iter().for_each(|part| ink.push(part));
        }
        let labels = labels_of(&output);
        for part in labels.iter().flat_map(|(_, strokes)| strokes).flat_map(|s| segments(s, 1.0)) {
            for other in ink.near(0.5 * (part[0] + part[1])) {
                let gap = distance(part, *other);
                assert!(gap > 0.2, "{text}: a label is {gap} mm from ink");
            }
        }
        assert!(labels.len() > 10, "{text}: {}", labels.len());
    }
}
