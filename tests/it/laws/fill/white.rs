//! Hidden lines that are painted over are those that line engines find.

use super::{built, distance};
use crate::scenes::{Model, Rng, Scene as TestScene, number_of_scenes, orthographic, perspective};
use glam::DVec2;
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::engines::face::images::Images;
use hiddenline::stages::engines::face::{FaceEngine, FaceOptions, Prepared};
use hiddenline::stages::page::{Page, PageOptions, Placement, PlotOptions};
use hiddenline::stages::plot::{Area, Fills};
use hiddenline::stages::shading::fill::FillError;
use hiddenline::stages::shading::white::paint_over;
use hiddenline::stages::strokes::{HiddenLines, Strokes};

/// The engines that paint faces over each other.
const ENGINES: [FaceEngine; 3] = [FaceEngine::Bsp, FaceEngine::DepthSort, FaceEngine::Octree];

/// How an area changes what is seen at a point.
enum Change {
    Erased,
    Drawn,
    /// Too near to the border to say.
    Unsure,
    Nothing,
}

fn change(area: &Area, at: DVec2, slack: f64) -> Change {
    let is_near = |points: &[DVec2]| points.windows(2).any(|s| distance(at, s[0], s[1]) <= slack);
    if area.outlines().any(is_near) {
        return Change::Drawn;
    }
    let mut is_inside = false;
    for ring in area.rings() {
        for (k, &a) in ring.iter().enumerate() {
            let b = ring[(k + 1) % ring.len()];
            if distance(at, a, b) <= slack {
                return Change::Unsure;
            }
            if (a.y > at.y) != (b.y > at.y) {
                is_inside ^= at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x);
            }
        }
    }
    if is_inside { Change::Erased } else { Change::Nothing }
}

/// Whether a line is left to see at a point; `None` where rounding might decide.
fn is_shown(fills: &Fills, at: DVec2, slack: f64) -> Option<bool> {
    let mut shown = Some(false);
    for area in fills.iter() {
        match change(&area, at, slack) {
            Change::Drawn => shown = Some(true),
            Change::Erased => shown = Some(false),
            Change::Unsure if shown == Some(true) => shown = None,
            Change::Unsure | Change::Nothing => {}
        }
    }
    shown
}

/// Compares points of visible and of hidden strokes with what is left to see; how many of each.
fn agreement(test: &TestScene, engine: FaceEngine) -> Result<[u32; 2], String> {
    let (scene, camera) = built(test);
    let lines = LineSelection::all_edges();
    let prepared = Prepared::new(&scene, engine).map_err(|error| error.to_string())?;
    let painted = paint_over(&prepared, &camera, &FaceOptions::default(), lines, 30.0);
    let painted = painted.map_err(|error| error.to_string())?;
    assert_eq!((painted.n_left_out, painted.filled.engine), (0, engine));
    let fills = &painted.filled.layers[0].fills;
    let bounds = Images::new(&scene, &camera).bounds;
    let slack = 1e-9 * (bounds.1 - bounds.0).length();
    let options =
        DrawOptions { lines, exact: true, hidden: HiddenLines::Solid, ..DrawOptions::default() };
    let drawing = draw(&scene, &camera, &options, 1.0).drawing;
    let mut n = [0; 2];
    for stroke in drawing.iter() {
        let [a, b] = [stroke.points[0], stroke.points[1]];
        if a.distance(b) < 1e4 * slack {
            continue;
        }
        for part in [0.0103, 0.257, 0.618, 0.9891] {
            let at = a.lerp(b, part);
            // A hidden line and a visible one may have one image.
            let is_elsewhere = |other: &hiddenline::stages::strokes::Stroke| {
                other.qi == 0 && distance(at, other.points[0], other.points[1]) < 1e3 * slack
            };
            let is_visible = stroke.qi == 0;
            if !is_visible && drawing.iter().any(|other| is_elsewhere(&other)) {
                continue;
            }
            let Some(found) = is_shown(fills, at, slack) else { continue };
            if found != is_visible {
                return Err(format!("at {at}: shown {found}, visible {is_visible}"));
            }
            n[usize::from(is_visible)] += 1;
        }
    }
    Ok(n)
}

fn agree(test: &TestScene) -> [u32; 2] {
    let mut sum = [0; 2];
    for engine in ENGINES {
        let n = agreement(test, engine)
            .unwrap_or_else(|problem| panic!("{}, {}: {problem}", test.name, engine.name()));
        sum = [sum[0] + n[0], sum[1] + n[1]];
    }
    sum
}

#[test]
fn what_is_painted_over_is_what_line_engines_find_hidden() {
    let mut sum = [0; 2];
    for seed in 0..number_of_scenes(30) {
        let mut rng = Rng(seed ^ 0x3417e);
        let mut model = Model::default();
        model.add_box([-1.0, -1.0, -2.0], [2.0, 1.0, 1.0]);
        for _ in 0..10 {
            // Every bit in use, so that nothing coincides.
            let corner =
                |rng: &mut Rng| [0; 3].map(|_| (rng.next() >> 11) as f64 / 2f64.powi(50) - 4.0);
            let corners = [0; 3].map(|_| corner(&mut rng));
            model.face(&corners);
        }
        let sight = match seed % 3 {
            0 => orthographic([0.31, -0.72, -0.53], [0.0, 0.0, 1.0]),
            1 => perspective([9.1, -11.3, 7.7], [0.2, 0.1, 0.3], 1e-6),
            // The near plane cuts.
            _ => perspective([3.1, -2.3, 1.7], [0.2, 0.1, 0.3], 0.9),
        };
        let n = agree(&model.seen_by(format!("seed {seed}"), sight));
        sum = [sum[0] + n[0], sum[1] + n[1]];
    }
    eprintln!("{} points of hidden lines, {} of visible ones", sum[0], sum[1]);
    assert!(sum[0] > 5_000 && sum[1] > 5_000, "{sum:?}");
}

#[test]
fn boxes_that_stand_on_each_other_keep_their_lines() {
    for sight in [
        orthographic([-3.0, 5.0, -4.0], [0.0, 0.0, 1.0]),
        perspective([9.0, -11.0, 7.0], [2.0, 2.0, 1.0], 1e-6),
    ] {
        let mut model = Model::default();
        model.add_box([0.0, 0.0, 0.0], [6.0, 5.0, 1.0]);
        model.add_box([2.0, 1.0, 1.0], [4.0, 4.0, 3.0]);
        model.add_box([-3.0, 1.0, 0.0], [-1.0, 4.0, 2.0]);
        let n = agree(&model.seen_by("boxes", sight));
        assert!(n[0] > 50 && n[1] > 100, "{n:?}");
    }
}

#[test]
fn lines_on_no_painted_face_are_counted() {
    // Seen along x, the first face is edge-on; the other two cross.
    let mut model = Model::default();
    model.face(&[[0.0, 5.0, 0.0], [1.0, 5.0, 0.0], [0.0, 5.0, 1.0]]);
    model.face(&[[0.0, 0.0, 0.0], [4.0, 0.0, 4.0], [4.0, 4.0, 4.0], [0.0, 4.0, 0.0]]);
    model.face(&[[0.0, 1.0, 4.0], [4.0, 1.0, 0.0], [4.0, 3.0, 0.0], [0.0, 3.0, 4.0]]);
    let test = model.seen_by("an edge-on face", orthographic([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
    let (scene, camera) = built(&test);
    let scene = scene.with_intersections();
    let prepared = Prepared::new(&scene, FaceEngine::Bsp).unwrap();
    let options = FaceOptions::default();
    let n_left_out = |lines| {
        let painted = paint_over(&prepared, &camera, &options, lines, 30.0).unwrap();
        assert_eq!(
            painted.filled.layers[0].fills.iter().filter(|a| a.outlines().count() > 0).count() > 0,
            lines != LineSelection::NONE
        );
        painted.n_left_out
    };
    assert_eq!(n_left_out(LineSelection::NONE), 0);
    // Of the edge-on triangle one edge is seen end-on; two are lines.
    assert_eq!(n_left_out(LineSelection::all_edges()), 2);
    assert_eq!(n_left_out(LineSelection::default()), 3);
}

#[test]
fn areas_beside_each_other_cannot_be_painted_over() {
    let mut model = Model::default();
    model.add_box([0.0; 3], [1.0; 3]);
    let test = model.seen_by("box", orthographic([-3.0, 5.0, -4.0], [0.0, 0.0, 1.0]));
    let (scene, camera) = built(&test);
    for engine in [FaceEngine::Warnock, FaceEngine::WeilerAtherton] {
        let prepared = Prepared::new(&scene, engine).unwrap();
        let options = FaceOptions::default();
        let refused = paint_over(&prepared, &camera, &options, LineSelection::default(), 30.0);
        assert_eq!(refused, Err(FillError::NotPaintedOver(engine.name())));
    }
}

#[test]
fn outlines_end_at_the_margins() {
    let mut model = Model::default();
    model.add_box([0.0; 3], [1.0, 2.0, 1.0]);
    let test = model.seen_by("box", orthographic([-3.0, 5.0, -4.0], [0.0, 0.0, 1.0]));
    let (scene, camera) = built(&test);
    let prepared = Prepared::new(&scene, FaceEngine::Bsp).unwrap();
    let options = FaceOptions::default();
    let painted = paint_over(&prepared, &camera, &options, LineSelection::all_edges(), 30.0);
    let filled = painted.unwrap().filled;
    let within = |mm_per_unit: f64| {
        let placement = Placement::Scale { mm_per_unit };
        let options = PageOptions { placement, ..PageOptions::default() };
        let page = Page::place(&scene.extent(&camera), &camera, &options).unwrap();
        let options = PlotOptions {
            pen_width_mm: 0.3,
            pens: Vec::new(),
            hidden: HiddenLines::None,
            dash: None,
            keep_dashes_whole: false,
            title: String::new(),
            source: String::new(),
        };
        let placed =
            page.plot(&Strokes::default(), options).with_fills(&page, &filled.layers, 0.05);
        let margin = DVec2::splat(page.margin_mm);
        let end = DVec2::new(placed.plot.width_mm, placed.plot.height_mm) - margin;
        let fills = placed.plot.layers[0].fills.clone();
        let points: Vec<DVec2> = fills
            .iter()
            .flat_map(|area| area.outlines().flatten().copied().collect::<Vec<_>>())
            .collect();
        assert!(points.iter().all(|p| p.cmpge(margin).all() && p.cmple(end).all()), "{points:?}");
        (placed.cropped, points.len())
    };
    let (is_cropped, n_points) = within(50.0);
    assert!(!is_cropped && n_points >= 24, "{n_points}");
    let (is_cropped, n_points) = within(120.0);
    assert!(is_cropped && n_points >= 12, "{n_points}");
}
