//! Colors, inks, and areas on the page.

use super::built;
use crate::models;
use crate::scenes::{Model, Scene as TestScene, orthographic};
use glam::{DVec2, DVec3, dvec2};
use hiddenline::LightSource;
use hiddenline::stages::camera::Camera;
use hiddenline::stages::camera::framing::View;
use hiddenline::stages::engines::face::FaceEngine;
use hiddenline::stages::extent::Extent;
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::page::{Page, PageOptions, Placement, PlotOptions};
use hiddenline::stages::plot::{Fills, Plot};
use hiddenline::stages::shading::fill::{Coloring, FillError, FillOptions, Filled, Palette, fill};
use hiddenline::stages::strokes::Strokes;
use hiddenline::stages::write::png::Resolution;
use hiddenline::stages::write::{dxf, gcode, pdf, png};

/// A unit cube with its front, right and top in view.
fn cube() -> TestScene {
    let mut model = Model::default();
    model.add_box([0.0; 3], [1.0; 3]);
    model.seen_by("a cube", orthographic([-1.0, 2.0, -1.5], [0.0, 0.0, 1.0]))
}

fn area(fills: &Fills) -> f64 {
    let of_ring = |ring: &[DVec2]| -> f64 {
        let n = ring.len();
        (0..n).map(|k| ring[k].perp_dot(ring[(k + 1) % n])).sum::<f64>() / 2.0
    };
    fills.iter().map(|area| area.rings().map(of_ring).sum::<f64>().abs()).sum()
}

fn plot(filled: &Filled, camera: &Camera, options: &PageOptions, seam_mm: f64) -> (Plot, bool) {
    let areas = || filled.layers.iter().flat_map(|layer| layer.fills.iter());
    let rings: Vec<&[DVec2]> = areas().flat_map(|area| area.rings()).collect();
    let extent = Extent::of_polylines(rings.iter().copied(), camera);
    let page = Page::place(&extent, camera, options).unwrap();
    let plot = PlotOptions {
        pen_width_mm: 0.3,
        pens: Vec::new(),
        hidden: Default::default(),
        dash: None,
        keep_dashes_whole: false,
        title: String::new(),
        source: String::new(),
    };
    let placed = page.plot(&Strokes::default(), plot).with_fills(&page, &filled.layers, seam_mm);
    (placed.plot, placed.cropped)
}

#[test]
fn faces_towards_the_light_have_the_paint_and_those_turned_away_a_quarter_of_it() {
    let (scene, camera) = built(&cube());
    let paint = [200, 100, 40];
    let light = LightSource::From(DVec3::Z);
    let options = FillOptions { light, paint: Some(paint), ..FillOptions::default() };
    let filled = fill(&scene, &camera, &options).unwrap();
    let mut colors: Vec<[u8; 3]> = filled.layers[0].fills.iter().map(|area| area.color).collect();
    colors.sort();
    assert_eq!(colors, [[50, 25, 10], [50, 25, 10], paint]);
}

#[test]
fn the_farthest_face_becomes_paper_with_a_full_depth_cue() {
    let (scene, camera) = built(&cube());
    let filled = fill(&scene, &camera, &FillOptions { depth_cue: 1.0, ..Default::default() });
    let filled = filled.unwrap();
    assert!(filled.layers[0].fills.iter().any(|area| area.color == [255; 3]));
    assert!(filled.layers[0].fills.iter().any(|area| area.color != [255; 3]));
}

/// Two squares over each other, seen from above: 10 by 10 at height 0, and 2 by 2 at height 5 and
/// more, tilted by `tilt`, wound the other way round if `is_turned`.
fn squares(tilt: f64, is_turned: bool) -> TestScene {
    let mut model = Model::default();
    model.face(&[[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 10.0, 0.0], [0.0, 10.0, 0.0]]);
    let high = 5.0 + 2.0 * tilt;
    let mut corners = [[4.0, 4.0, 5.0], [6.0, 4.0, high], [6.0, 6.0, high], [4.0, 6.0, 5.0]];
    if is_turned {
        corners.reverse();
    }
    model.face(&corners);
    model.seen_by("squares", orthographic([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]))
}

/// Color and area of each area.
fn colored(scene: &TestScene, options: FillOptions) -> Vec<([u8; 3], f64)> {
    let (scene, camera) = built(scene);
    let light = LightSource::From(DVec3::Z);
    let filled = fill(&scene, &camera, &FillOptions { light, ..options }).unwrap();
    let layers = filled.layers.iter();
    layers.map(|layer| (layer.color, area(&layer.fills))).collect()
}

#[test]
fn an_ink_has_a_hole_where_another_is_seen() {
    let palette = Some(Palette::Grays(2));
    let found = colored(&squares(1.0, false), FillOptions { palette, ..FillOptions::default() });
    let areas: Vec<f64> = found.iter().map(|(_, area)| (area * 1e9).round() / 1e9).collect();
    assert_eq!(areas, [4.0, 96.0]);
}

#[test]
fn what_is_near_keeps_its_color_and_what_is_far_pales() {
    let (scene, camera) = built(&squares(0.0, false));
    let (light, paint) = (LightSource::From(DVec3::Z), Some([200, 100, 40]));
    for (depth_cue, far) in [(0.0, [200, 100, 40]), (1.0, [255; 3])] {
        let options = FillOptions { light, paint, depth_cue, ..FillOptions::default() };
        let filled = fill(&scene, &camera, &options).unwrap();
        let colors: Vec<[u8; 3]> = filled.layers[0].fills.iter().map(|area| area.color).collect();
        assert_eq!(colors, [far, [200, 100, 40]]);
    }
}

#[test]
fn faces_pale_evenly_with_their_distance() {
    let mut model = Model::default();
    for (k, z) in [0.0, 6.0, 8.0].into_iter().enumerate() {
        let x = 3.0 * k as f64;
        model.face(&[[x, 0.0, z], [x + 2.0, 0.0, z], [x + 2.0, 2.0, z], [x, 2.0, z]]);
    }
    let (scene, camera) =
        built(&model.seen_by("steps", orthographic([0.0, 0.0, -1.0], [0.0, 1.0, 0.0])));
    let (light, paint) = (LightSource::From(DVec3::Z), Some([55, 0, 155]));
    let options = FillOptions { light, paint, depth_cue: 0.8, ..FillOptions::default() };
    let filled = fill(&scene, &camera, &options).unwrap();
    let mut colors: Vec<[u8; 3]> = filled.layers[0].fills.iter().map(|area| area.color).collect();
    colors.sort();
    // Eight tenths of the way to white at the farthest, and a quarter of that two steps of eight away.
    assert_eq!(colors, [[55, 0, 155], [95, 51, 175], [215, 204, 235]]);
}

#[test]
fn both_sides_of_a_face_are_lit_alike() {
    let palette = Some(Palette::Grays(2));
    let options = FillOptions { palette, ..FillOptions::default() };
    let [front, back] = [false, true].map(|side| colored(&squares(1.0, side), options.clone()));
    assert_eq!(front, back);
}

#[test]
fn inks_lie_beside_each_other_whatever_the_engine() {
    let Some(mesh) = models::get("spot_control_quads.obj") else { return };
    let scene = Scene::new(mesh);
    let camera = View::default().camera(scene.mesh().bounds().unwrap()).unwrap();
    let sum = |filled: &Filled| filled.layers.iter().map(|layer| area(&layer.fills)).sum::<f64>();
    let exact = FillOptions { engine: FaceEngine::WeilerAtherton, ..FillOptions::default() };
    let expected = sum(&fill(&scene, &camera, &exact).unwrap());
    let engines =
        [FaceEngine::WeilerAtherton, FaceEngine::Bsp, FaceEngine::Octree, FaceEngine::DepthSort];
    for engine in engines {
        let inks = vec![[0, 0, 128], [230, 120, 30], [250, 250, 240], [255, 0, 0]];
        let palette = Some(Palette::Inks(inks.clone()));
        let options = FillOptions { engine, palette, ..FillOptions::default() };
        let filled = fill(&scene, &camera, &options).unwrap();
        // No face is nearest to red.
        assert_eq!(filled.layers.len(), 3, "{engine:?}");
        for layer in &filled.layers {
            assert!(inks.contains(&layer.color));
            assert!(layer.fills.iter().all(|area| area.color == layer.color));
        }
        let found = sum(&filled);
        assert!((found / expected - 1.0).abs() < 1e-9, "{engine:?}: {found}, not {expected}");
        let disjoint = FillOptions { engine, disjoint: true, ..FillOptions::default() };
        let found = sum(&fill(&scene, &camera, &disjoint).unwrap());
        assert!((found / expected - 1.0).abs() < 1e-9, "{engine:?}: {found}, not {expected}");
    }
}

/// Layers of the cube from above, its top in `paint` and two sides in a quarter of that.
fn inked(paint: [u8; 3], palette: Palette) -> Vec<(String, [u8; 3], usize)> {
    let (scene, camera) = built(&cube());
    let light = LightSource::From(DVec3::Z);
    let (paint, palette) = (Some(paint), Some(palette));
    let options = FillOptions { light, paint, palette, ..FillOptions::default() };
    let layers = fill(&scene, &camera, &options).unwrap().layers;
    layers.into_iter().map(|layer| (layer.name, layer.color, layer.fills.len())).collect()
}

#[test]
fn each_face_has_the_nearest_ink_and_of_two_the_first() {
    let layer = |name: &str, color, n| (name.to_owned(), color, n);
    // 10 from both; what is left of the sides is nearest to black.
    let inks = vec![[90, 100, 100], [110, 100, 100], [0, 0, 0]];
    let found = inked([100; 3], Palette::Inks(inks));
    // The sides meet, and are one area.
    assert_eq!(found, [layer("ink1", [90, 100, 100], 1), layer("ink3", [0, 0, 0], 1)]);
    // Once 30 is farther than three times 12.
    let inks = vec![[130, 100, 100], [112, 112, 112], [0, 0, 0]];
    let found = inked([100; 3], Palette::Inks(inks));
    assert_eq!(found, [layer("ink2", [112; 3], 1), layer("ink3", [0; 3], 1)]);
}

#[test]
fn grays_go_from_the_darkest_tone_to_the_lightest() {
    // The mean of the top's is 200, that of the sides' 50.
    let found = |n| -> Vec<(String, [u8; 3])> {
        let layers = inked([220, 190, 190], Palette::Grays(n)).into_iter();
        layers.map(|(name, color, _)| (name, color)).collect()
    };
    let layer = |name: &str, gray| (name.to_owned(), [gray; 3]);
    assert_eq!(found(1), [layer("ink1", 125)]);
    assert_eq!(found(2), [layer("ink1", 50), layer("ink2", 200)]);
    assert_eq!(found(3), [layer("ink1", 50), layer("ink3", 200)]);
    assert_eq!(found(4), [layer("ink1", 50), layer("ink4", 200)]);
}

#[test]
fn grays_are_counted_and_a_palette_does_not_go_with_debugging() {
    let (scene, camera) = built(&cube());
    let with = |palette, show| {
        fill(&scene, &camera, &FillOptions { palette: Some(palette), show, ..Default::default() })
    };
    assert_eq!(with(Palette::Grays(2), Coloring::Shaded).unwrap().layers.len(), 2);
    for n in [0, 1000] {
        assert_eq!(with(Palette::Grays(n), Coloring::Shaded), Err(FillError::Inks(n)));
    }
    assert_eq!(with(Palette::Grays(3), Coloring::Order), Err(FillError::DebugInks));
}

#[test]
fn areas_are_cropped_at_the_margins() {
    let (scene, camera) = built(&cube());
    let filled = fill(&scene, &camera, &FillOptions::default()).unwrap();
    let whole = PageOptions::default();
    let (fitted, cropped) = plot(&filled, &camera, &whole, 0.05);
    assert!(!cropped && fitted.layers[0].fills.len() == 3);
    let large = PageOptions { placement: Placement::Scale { mm_per_unit: 1e4 }, ..whole };
    let (plot, cropped) = plot(&filled, &camera, &large, 0.0);
    assert!(cropped);
    let (low, high) = (dvec2(10.0, 10.0), dvec2(plot.width_mm - 10.0, plot.height_mm - 10.0));
    for area in plot.layers[0].fills.iter() {
        assert!(area.rings().flatten().all(|p| p.cmpge(low).all() && p.cmple(high).all()));
    }
    // The cube covers all of the sheet.
    let usable = (high - low).element_product();
    assert!((area(&plot.layers[0].fills) / usable - 1.0).abs() < 1e-9);
}

#[test]
fn no_paper_shines_through_between_areas() {
    let Some(mesh) = models::get("spot_control_quads.obj") else { return };
    let scene = Scene::new(mesh);
    let camera = View::default().camera(scene.mesh().bounds().unwrap()).unwrap();
    let options = FillOptions { paint: Some([0, 0, 255]), ..FillOptions::default() };
    let filled = fill(&scene, &camera, &options).unwrap();
    let (plot, _) = plot(&filled, &camera, &PageOptions::default(), 0.05);
    let mut bytes = Vec::new();
    png::write(&plot, Resolution::WidthPx(400), &mut bytes).unwrap();
    let mut reader = ::png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    let (width, height) = (info.width as usize, info.height as usize);
    // Paint has no red: all red is paper. Inside, where all around is painted, there is none.
    let red = |x: usize, y: usize| pixels[3 * (y * width + x)];
    let mut inside = 0;
    for y in 2..height - 2 {
        for x in 2..width - 2 {
            let around = [(x - 2, y), (x + 2, y), (x, y - 2), (x, y + 2)];
            if around.iter().all(|&(x, y)| red(x, y) == 0) {
                assert!(red(x, y) < 16, "paper shines through at {x}, {y}: {}", red(x, y));
                inside += 1;
            }
        }
    }
    assert!(inside > 10_000, "only {inside} pixels inside");
}

#[test]
fn formats_without_areas_refuse_them_and_others_have_them() {
    let (scene, camera) = built(&cube());
    let filled = fill(&scene, &camera, &FillOptions::default()).unwrap();
    let (plot, _) = plot(&filled, &camera, &PageOptions::default(), 0.05);
    let mut out = Vec::new();
    let profile = gcode::GcodeProfile::named("grbl-servo").unwrap();
    for result in [
        dxf::write(&plot, dxf::DxfScale::default(), &mut out),
        gcode::write(&plot, &profile, &mut out),
    ] {
        let message = result.unwrap_err().to_string();
        assert!(message.contains("no filled areas; SVG, PDF and PNG hold both"), "{message}");
    }
    assert!(out.is_empty());
    pdf::write(&plot, &mut out).unwrap();
    let text = String::from_utf8_lossy(&out);
    assert_eq!(text.lines().filter(|line| line.trim() == "B*").count(), 3);
}

#[test]
fn a_lamp_lights_each_face_by_the_way_to_its_middle() {
    // Two squares on the ground; the lamp stands over the first one's middle.
    let mut model = Model::default();
    for x in [0.0, 6.0] {
        model.face(&[[x, 0.0, 0.0], [x + 2.0, 0.0, 0.0], [x + 2.0, 2.0, 0.0], [x, 2.0, 0.0]]);
    }
    let scene = model.seen_by("floor", orthographic([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]));
    let (scene, camera) = built(&scene);
    let light = LightSource::At(glam::dvec3(1.0, 1.0, 8.0));
    let options = FillOptions { light, paint: Some([200; 3]), ..FillOptions::default() };
    let filled = fill(&scene, &camera, &options).unwrap();
    let mut grays: Vec<u8> = filled.layers[0].fills.iter().map(|area| area.color[0]).collect();
    grays.sort_unstable();
    // Six to the side of a lamp eight above: the cosine is 0.8, and a quarter of the tone is ambient.
    assert_eq!(grays, [170, 200]);
}
