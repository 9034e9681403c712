//! Lengths, areas and borders that are known in closed form.

use std::f64::consts::PI;

use glam::{DVec2, DVec3, Vec2Swizzles, dvec2, dvec3};
use hiddenline::Scene;
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::draw::DrawOptions;
use hiddenline::stages::hatch::{
    Ground, HatchError, HatchLevels, HatchMethod, HatchOptions, HatchPage, HatchShadows, hatch,
};
use hiddenline::stages::shading::light::LightSource;
use hiddenline::stages::strokes::Strokes;

const PEN_MM: f64 = 0.3;

/// A page large enough for everything.
fn page(mm_per_image_unit: f64) -> HatchPage {
    let all = DVec2::splat(1e4);
    HatchPage { mm_per_image_unit, window: (-all, all), pen_width_mm: PEN_MM }
}

/// Looking along a direction, from far away.
fn along(forward: DVec3) -> Camera {
    let up = if forward.x == 0.0 && forward.y == 0.0 { DVec3::Y } else { DVec3::Z };
    Camera::new(-forward * 10.0, DVec3::ZERO, up, Projection::Orthographic).unwrap()
}

fn hatched(scene: &Scene, camera: &Camera, options: &HatchOptions, mm: f64) -> Strokes {
    hatch(scene, camera, options, &DrawOptions::default(), &page(mm)).unwrap()
}

fn length(strokes: &Strokes) -> f64 {
    let of = |points: &[DVec2]| points.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>();
    strokes.iter().map(|stroke| of(stroke.points)).sum()
}

/// A sphere of radius one.
fn sphere(n_rings: u32) -> Scene {
    let n = 2 * n_rings;
    let mut positions = vec![DVec3::NEG_Z, DVec3::Z];
    for ring in 1..n_rings {
        let polar = PI * f64::from(ring) / f64::from(n_rings);
        for k in 0..n {
            // Turned by an odd angle, so that no plane goes through many vertices.
            let (sin, cos) = (2.0 * PI * (f64::from(k) + 0.3) / f64::from(n)).sin_cos();
            positions.push(dvec3(polar.sin() * cos, polar.sin() * sin, -polar.cos()));
        }
    }
    let at = |ring: u32, k: u32| 2 + (ring - 1) * n + k % n;
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for k in 0..n {
        faces.push(vec![0, at(1, k + 1), at(1, k)]);
        for ring in 1..n_rings - 1 {
            faces.push(vec![at(ring, k), at(ring, k + 1), at(ring + 1, k + 1)]);
            faces.push(vec![at(ring, k), at(ring + 1, k + 1), at(ring + 1, k)]);
        }
        faces.push(vec![1, at(n_rings - 1, k), at(n_rings - 1, k + 1)]);
    }
    Scene::from_faces(&positions, faces).unwrap()
}

/// A box from the origin.
fn cuboid(size: DVec3) -> Scene {
    let corner =
        |i: u32| size * dvec3(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1));
    let corners: Vec<DVec3> = (0..8).map(corner).collect();
    let faces: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Scene::from_faces(&corners, faces).unwrap()
}

/// A square of side 1 that faces up.
fn square() -> Scene {
    let corners = [DVec3::ZERO, DVec3::X, dvec3(1.0, 1.0, 0.0), DVec3::Y];
    Scene::from_faces(&corners, [[0, 1, 2, 3]]).unwrap()
}

/// No ambient light, everything but the lightest hatched, nothing dropped.
fn plain(method: HatchMethod) -> HatchOptions {
    HatchOptions {
        method,
        ambient: 0.0,
        white: 1.0,
        shortest_mm: Some(0.0),
        gap_mm: 0.0,
        ..HatchOptions::default()
    }
}

const METHODS: [HatchMethod; 2] = [HatchMethod::Sections, HatchMethod::Straight];

#[test]
fn a_sphere_in_its_own_light_has_the_length_of_the_integral() {
    let (scene, radius) = (sphere(32), 43.3);
    let forward = dvec3(0.3, 1.0, -0.4);
    // Where the number of lines halves at once, darkness is right on the average over all tones only.
    let exactness = [(HatchLevels::Continuous, 0.02), (HatchLevels::Halving, 0.04)];
    for (method, (levels, part)) in METHODS.iter().flat_map(|&m| exactness.map(|e| (m, e))) {
        let light = LightSource::From(-forward);
        let options = HatchOptions { light, levels, ..plain(method) };
        let expected = options.black * PI * radius * radius / (3.0 * PEN_MM);
        let got = length(&hatched(&scene, &along(forward), &options, radius)) * radius;
        assert!((got / expected - 1.0).abs() < part, "{method:?}: {got} against {expected}");
    }
}

#[test]
fn a_sphere_in_the_light_from_aside_has_the_length_of_the_integral() {
    let (scene, radius) = (sphere(32), 43.3);
    let forward = DVec3::Y;
    for cosine in [0.6, -0.3_f64] {
        let angle = cosine.acos();
        let light = LightSource::From(dvec3(-angle.sin(), -cosine, 0.0));
        for method in METHODS {
            let levels = HatchLevels::Continuous;
            let options = HatchOptions { light, levels, ..plain(method) };
            let dark = PI - 2.0 / 3.0 * (angle.sin() + (PI - angle) * angle.cos());
            let expected = options.black / PEN_MM * radius * radius * dark;
            let got = length(&hatched(&scene, &along(forward), &options, radius)) * radius;
            assert!((got / expected - 1.0).abs() < 0.02, "{method:?}: {got} against {expected}");
        }
    }
}

#[test]
fn a_cube_casts_its_shadow_polygon_on_the_ground() {
    let side = 2.0;
    let from = dvec3(-1.0, -0.5, 2.0);
    let scene = cuboid(DVec3::splat(side));
    let options = HatchOptions {
        light: LightSource::From(from),
        shadows: HatchShadows::Only,
        // Far from where the number of lines halves.
        ambient: 0.1,
        ..HatchOptions::default()
    }
    .straight()
    .ground(Ground::Lowest);
    let (p, q) = (-side * from.x / from.z, -side * from.y / from.z);
    let camera = along(DVec3::NEG_Z);
    // Where the camera has the origin.
    let origin = camera.image(DVec3::ZERO);
    let corners = [(side, 0.0), (side + p, q), (side + p, side + q), (p, side + q), (0.0, side)];
    let corners = corners.map(|(x, y)| dvec2(x, y) + origin);
    let all: Vec<DVec2> = corners.iter().copied().chain([dvec2(side, side) + origin]).collect();
    let is_near = |x: DVec2| {
        (0..all.len()).any(|i| {
            let (a, b) = (all[i], all[(i + 1) % all.len()]);
            let (d, e) = (b - a, x - a);
            let t = (d.dot(e) / d.length_squared()).clamp(0.0, 1.0);
            (e - d * t).length() < 1e-9
        })
    };
    let exact = DrawOptions::default().exact();
    let mm = 30.0;
    let lines = hatch(&scene, &camera, &options, &exact, &page(mm)).unwrap();
    let dark: Vec<_> = lines.iter().filter(|stroke| stroke.lit == Some(false)).collect();
    assert!(dark.len() > 100);
    assert!(dark.iter().all(|stroke| stroke.points.iter().all(|&x| is_near(x))));

    // Half of the darkness on the ground, and nothing on the cube, whose top is all that is seen.
    let drawn = length(&hatched(&scene, &camera, &options, mm)) * mm;
    let area = side * side * (from.x.abs() + from.y.abs()) / from.z * mm * mm;
    let coverage = options.black * (options.white - options.ambient) / options.white / 2.0;
    // Only halvings of the finest distance are drawn.
    let base = PEN_MM / options.black / 8.0;
    let level = (PEN_MM / coverage / base).log2().round();
    let distance = base * level.exp2();
    let strokes = hatched(&scene, &camera, &options, mm);
    let mut places: Vec<f64> =
        strokes.iter().map(|s| (s.points[0].y - s.points[0].x) / 2f64.sqrt() * mm).collect();
    places.sort_by(f64::total_cmp);
    let steps = places.windows(2).map(|pair| (pair[1] - pair[0]) / distance);
    assert!(steps.clone().all(|step| (step - step.round()).abs() < 1e-6));
    assert!(steps.filter(|step| step.round() == 1.0).count() > 10);
    let perimeter = (2.0 * side + 2.0 * p.hypot(q)) * mm * 2.0;
    assert!((drawn - area / distance).abs() < perimeter, "{drawn}, {}", area / distance);
    assert!(drawn > 0.9 * area / distance && drawn < 1.1 * area / distance);
}

/// The part of a square of paper that strokes as wide as the pen cover, by points 0.02 mm apart, without
/// a border.
fn covered(strokes: &Strokes, mm: f64, low: DVec2) -> f64 {
    const STEP_MM: f64 = 0.02;
    let n = (mm / STEP_MM) as usize;
    let mut is_covered = vec![false; n * n];
    let cell = |x: f64| ((x / STEP_MM - 0.5).ceil().max(0.0) as usize).min(n);
    for stroke in strokes.iter() {
        for pair in stroke.points.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|p| (p - low) * mm);
            // Rows of a steep stroke, columns of a flat one.
            let is_flat = (b - a).x.abs() > (b - a).y.abs();
            let [a, b] = if is_flat { [a.yx(), b.yx()] } else { [a, b] };
            let half_width = PEN_MM / 2.0 * (b - a).length() / (b - a).y.abs();
            for y in cell(a.y.min(b.y))..cell(a.y.max(b.y)) {
                let t = ((y as f64 + 0.5) * STEP_MM - a.y) / (b.y - a.y);
                let x = a.x + (b.x - a.x) * t;
                for x in cell(x - half_width)..cell(x + half_width) {
                    is_covered[if is_flat { x * n + y } else { y * n + x }] = true;
                }
            }
        }
    }
    let border = (2.0 / STEP_MM) as usize;
    let inner = || (border..n - border).flat_map(|y| (border..n - border).map(move |x| (x, y)));
    let inked = inner().filter(|(x, y)| is_covered[y * n + x]).count();
    inked as f64 / inner().count() as f64
}

#[test]
fn ink_covers_as_much_as_the_tone_says() {
    let scene = square();
    let camera = along(DVec3::NEG_Z);
    let low = camera.image(DVec3::ZERO);
    for method in METHODS {
        for cross in [false, true] {
            for cosine in [0.0, 0.2, 0.5, 0.8] {
                let sine = (1.0_f64 - cosine * cosine).sqrt();
                let light = LightSource::From(dvec3(-sine, 0.0, cosine));
                let levels = HatchLevels::Continuous;
                let options = HatchOptions { light, cross, levels, ..plain(method) };
                let expected = options.black * (1.0 - cosine);
                let got = covered(&hatched(&scene, &camera, &options, 24.0), 24.0, low);
                assert!((got - expected).abs() < 0.03, "{method:?} {cross} {got} {expected}");
            }
        }
    }
}

#[test]
fn a_darker_place_keeps_the_lines_of_a_lighter_one() {
    let scene = square();
    let camera = along(DVec3::NEG_Z);
    for levels in [HatchLevels::Halving, HatchLevels::Continuous, HatchLevels::Steps(4)] {
        let mut last: Vec<Vec<[u64; 2]>> = Vec::new();
        for cosine in [0.9, 0.7, 0.5, 0.2, 0.0] {
            let sine = (1.0_f64 - cosine * cosine).sqrt();
            let light = LightSource::From(dvec3(-sine, 0.0, cosine));
            let normal = Some(dvec3(1.0, 2.0, 0.5));
            let options = HatchOptions { light, levels, normal, ..plain(HatchMethod::Sections) };
            let strokes = hatched(&scene, &camera, &options, 30.0);
            let mut lines: Vec<Vec<[u64; 2]>> = strokes
                .iter()
                .map(|stroke| {
                    let mut ends: Vec<[u64; 2]> =
                        stroke.points.iter().map(|p| p.to_array().map(f64::to_bits)).collect();
                    ends.sort_unstable();
                    ends
                })
                .collect();
            lines.sort_unstable();
            assert!(last.iter().all(|line| lines.binary_search(line).is_ok()), "{levels:?}");
            assert!(lines.len() >= last.len());
            last = lines;
        }
        assert!(last.len() > 10);
    }
}

#[test]
fn both_methods_ink_a_face_alike() {
    let scene = cuboid(dvec3(1.0, 1.0, 1.0));
    let camera = along(dvec3(1.0, 1.5, -1.0));
    let mm = 40.0;
    let lengths = METHODS.map(|method| {
        let levels = HatchLevels::Continuous;
        let light = LightSource::From(dvec3(1.0, -1.0, 0.4));
        let options = HatchOptions { light, levels, smooth_deg: 0.0, ..plain(method) };
        length(&hatched(&scene, &camera, &options, mm)) * mm
    });
    assert!((lengths[0] / lengths[1] - 1.0).abs() < 0.06, "{lengths:?}");
}

#[test]
fn light_along_the_edges_of_a_box_loses_no_line() {
    // Lit straight from above, the sides are in the light's own planes: they face it no more than away.
    let scene = cuboid(DVec3::ONE);
    let camera = along(dvec3(1.0, 1.5, -1.0));
    let exact = DrawOptions::default().exact();
    for from in [DVec3::Z, DVec3::NEG_Y, DVec3::NEG_X] {
        let options = HatchOptions { light: LightSource::From(from), ..HatchOptions::default() };
        let lines = hatch(&scene, &camera, &options, &exact, &page(40.0)).unwrap();
        let own = HatchOptions { shadows: HatchShadows::Own, ..options };
        let by_facing = hatch(&scene, &camera, &own, &exact, &page(40.0)).unwrap();
        assert_eq!(lines, by_facing, "a single box throws no shadow on itself");
        let is_lit = |lit: bool| lines.iter().filter(|s| s.lit == Some(lit)).count();
        assert!(is_lit(true) > 0 && is_lit(false) > is_lit(true));
    }
}

#[test]
fn threads_change_nothing() {
    let scene = sphere(12);
    let camera = along(dvec3(0.3, 1.0, -0.4));
    let options = HatchOptions::default().cross().ground(Ground::At(-1.2));
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| hatched(&scene, &camera, &options, 40.0))
    };
    let one = with(1);
    assert!(one.len() > 20);
    assert_eq!(one, with(3));
}

#[test]
fn the_ground_is_not_seen_from_below_and_needs_light_from_above() {
    let scene = cuboid(DVec3::ONE);
    let light = LightSource::From(dvec3(1.0, 1.0, 2.0));
    let only = HatchOptions { light, shadows: HatchShadows::Only, ..HatchOptions::default() };
    let with = only.clone().ground(Ground::Lowest);
    let from_below = along(dvec3(1.0, 1.0, 1.0));
    assert_eq!(
        hatched(&scene, &from_below, &with, 40.0),
        hatched(&scene, &from_below, &only, 40.0)
    );
    let from_above = along(dvec3(1.0, 1.0, -1.0));
    let more = length(&hatched(&scene, &from_above, &with, 40.0));
    assert!(more > length(&hatched(&scene, &from_above, &only, 40.0)) + 1.0);
    for from in [DVec3::X, dvec3(1.0, 0.0, -1.0)] {
        let options = HatchOptions { light: LightSource::From(from), ..with.clone() };
        let lines = DrawOptions::default();
        let error = hatch(&scene, &from_above, &options, &lines, &page(40.0)).unwrap_err();
        assert_eq!(error, HatchError::Horizon);
    }
}

#[test]
fn numbers_out_of_range_are_refused() {
    let scene = cuboid(DVec3::ONE);
    let camera = along(dvec3(1.0, 1.0, -1.0));
    let error = |options: HatchOptions, page: HatchPage| {
        hatch(&scene, &camera, &options, &DrawOptions::default(), &page).unwrap_err()
    };
    let usual = HatchOptions::default();
    let inside = LightSource::At(DVec3::splat(0.5));
    let large = page(40.0);
    assert!(matches!(error(usual.clone().light(inside), large), HatchError::Light(_)));
    assert_eq!(error(HatchOptions { black: 1.5, ..usual.clone() }, large), HatchError::Black(1.5));
    let white = HatchOptions { white: f64::NAN, ..usual.clone() };
    assert!(matches!(error(white, large), HatchError::White(_)));
    let million = usual.clone().angles_deg(vec![1.0; 1_000_000]);
    assert_eq!(error(million, large), HatchError::Families(1_000_000));
    let steps = usual.clone().levels(HatchLevels::Steps(1));
    assert_eq!(error(steps, large), HatchError::Levels(1));
    let no_pen = HatchPage { pen_width_mm: 0.0, ..large };
    assert_eq!(error(usual.clone(), no_pen), HatchError::PenWidth(0.0));
    assert!(matches!(error(usual, page(1e9)), HatchError::TooMany(_)));
}

#[test]
fn hatching_keeps_off_outlines_of_what_is_nearer_but_not_off_its_own() {
    let square = |from: f64, to: f64, z: f64| {
        [dvec3(from, from, z), dvec3(to, from, z), dvec3(to, to, z), dvec3(from, to, z)]
    };
    let corners = [square(0.0, 10.0, 0.0), square(4.0, 6.0, 3.0)].concat();
    let scene = Scene::from_faces(&corners, [[0, 1, 2, 3], [4, 5, 6, 7]]).unwrap();
    let camera = along(DVec3::NEG_Z);
    let mm = 10.0;
    let low = camera.image(DVec3::ZERO);
    let light = LightSource::From(dvec3(-1.0, 0.0, 0.5));
    let shadows = HatchShadows::Own;
    for gap_mm in [0.0, 0.5, 2.0] {
        let options = HatchOptions { light, shadows, gap_mm, ..plain(HatchMethod::Straight) };
        let strokes = hatched(&scene, &camera, &options, mm);
        // How far each end is outside the near square, in millimeters; inside is negative.
        let outside = |p: DVec2| {
            let d = ((p - low) - 5.0).abs() - 1.0;
            let beyond = d.max(DVec2::ZERO).length();
            mm * if beyond > 0.0 { beyond } else { d.max_element() }
        };
        let ends: Vec<f64> = strokes.iter().flat_map(|s| s.points).map(|&p| outside(p)).collect();
        let least = |mut of: Box<dyn FnMut(f64) -> Option<f64>>| {
            ends.iter().filter_map(|&x| of(x)).fold(f64::INFINITY, f64::min)
        };
        let beside = least(Box::new(|x| (x > 1e-9).then_some(x)));
        let within = least(Box::new(|x| (x <= 1e-9).then_some(-x)));
        assert!(within < 1e-9, "the near square is hatched up to its own outline: {within}");
        if gap_mm == 0.0 {
            assert!(ends.iter().filter(|x| x.abs() < 1e-9).count() > 100);
        } else {
            assert!((beside - gap_mm).abs() < 1e-6, "{beside} against {gap_mm}");
        }
    }
}

#[test]
fn margins_are_as_wide_in_perspective() {
    let square = |from: f64, to: f64, z: f64| {
        [dvec3(from, from, z), dvec3(to, from, z), dvec3(to, to, z), dvec3(from, to, z)]
    };
    let corners = [square(0.0, 10.0, 0.0), square(4.0, 6.0, 3.0)].concat();
    let scene = Scene::from_faces(&corners, [[0, 1, 2, 3], [4, 5, 6, 7]]).unwrap();
    let light = LightSource::From(dvec3(-1.0, 0.0, 0.5));
    for distance in [100.0, 1e4] {
        // Ten millimeters to the unit of the model.
        let mm = 10.0 * distance;
        let projection = Projection::Perspective { fov_deg: 20.0, near: 1e-6 };
        let eye = dvec3(5.0, 5.0, distance);
        let camera = Camera::new(eye, eye - DVec3::Z, DVec3::Y, projection).unwrap();
        let of = |gap_mm: f64| {
            let shadows = HatchShadows::Own;
            let options = HatchOptions { light, shadows, gap_mm, ..plain(HatchMethod::Straight) };
            length(&hatched(&scene, &camera, &options, mm)) / of_all(&scene, &camera, light, mm)
        };
        // The tone is even, so the part that is lost is that of the margin.
        let (side, gap) = (20.0 / (1.0 - 3.0 / distance), 1.5);
        let expected = (4.0 * side * gap + PI * gap * gap) / (100.0 * 100.0);
        let lost = of(0.0) - of(gap);
        assert!((lost / expected - 1.0).abs() < 0.1, "{distance}: {lost}, not {expected}");
    }
}

/// The length of all hatching of the largest square alone.
fn of_all(scene: &Scene, camera: &Camera, light: LightSource, mm: f64) -> f64 {
    let corners = &scene.mesh().positions()[..4];
    let alone = Scene::from_faces(corners, [[0, 1, 2, 3]]).unwrap();
    let shadows = HatchShadows::Own;
    let options = HatchOptions { light, shadows, ..plain(HatchMethod::Straight) };
    length(&hatched(&alone, camera, &options, mm))
}

#[test]
fn a_face_seen_at_a_flat_angle_is_hatched_up_to_its_own_outline() {
    let scene = square();
    let light = LightSource::From(dvec3(-1.0, 0.3, 0.2));
    for forward in [dvec3(0.0, 1.0, -0.15), dvec3(0.8, 0.5, -0.1), dvec3(-0.3, -1.0, -0.2)] {
        let of = |gap_mm: f64| {
            let options = HatchOptions {
                light,
                shadows: HatchShadows::Own,
                gap_mm,
                ..plain(HatchMethod::Straight)
            };
            length(&hatched(&scene, &along(forward), &options, 150.0))
        };
        assert!(of(0.0) > 0.0);
        assert_eq!(of(0.5), of(0.0), "{forward}");
    }
}

#[test]
fn steps_of_tone_are_the_nearest_ones() {
    let scene = square();
    let camera = along(DVec3::NEG_Z);
    let low = camera.image(DVec3::ZERO);
    // Steps that halving can make: quarters, halves and the whole.
    let cases = [(2, 0.1), (2, 0.4), (2, 0.6), (2, 0.7), (2, 0.9), (4, 0.05), (4, 0.45), (4, 0.7)];
    for (n, cosine) in cases {
        let sine = (1.0_f64 - cosine * cosine).sqrt();
        let light = LightSource::From(dvec3(-sine, 0.0, cosine));
        let levels = HatchLevels::Steps(n);
        let options = HatchOptions { light, levels, ..plain(HatchMethod::Straight) };
        let n = f64::from(n);
        let expected = options.black * ((1.0 - cosine) * n).round() / n;
        let got = covered(&hatched(&scene, &camera, &options, 24.0), 24.0, low);
        assert!((got - expected).abs() < 0.04, "{n} {cosine}: {got}, not {expected}");
    }
}

#[test]
fn hatching_goes_up_to_a_face_that_goes_on_beside_it() {
    let square = |from: f64, to: f64, z: f64| {
        [dvec3(from, 0.0, z), dvec3(to, 0.0, z), dvec3(to, 4.0, z), dvec3(from, 4.0, z)]
    };
    // A step of a fifth of a millimeter on paper.
    let corners = [square(0.0, 4.0, 0.0), square(4.0, 8.0, -0.02)].concat();
    let scene = Scene::from_faces(&corners, [[0, 1, 2, 3], [4, 5, 6, 7]]).unwrap();
    let light = LightSource::From(dvec3(-1.0, 0.0, 0.5));
    let shadows = HatchShadows::Own;
    let of = |gap_mm: f64| {
        let options = HatchOptions { light, shadows, gap_mm, ..plain(HatchMethod::Straight) };
        length(&hatched(&scene, &along(DVec3::NEG_Z), &options, 10.0))
    };
    assert_eq!(of(0.5), of(0.0));
    assert!(of(0.05) < of(0.0), "there it is a step");
}

#[test]
fn faces_are_flat_or_one_curved_surface_by_the_angle_between_them() {
    // Two upright faces, each seen at 45°, with the light from the viewer.
    let wedge = [[-1.0, 1.0], [0.0, 0.0], [1.0, 1.0]];
    let corners: Vec<DVec3> =
        [0.0, 1.0].iter().flat_map(|&z| wedge.map(|[x, y]| dvec3(x, y, z))).collect();
    let scene = Scene::from_faces(&corners, [[0, 1, 4, 3], [1, 2, 5, 4]]).unwrap();
    let mm = 40.0;
    let length_with = |smooth_deg: f64| {
        let (light, levels) = (LightSource::From(DVec3::NEG_Y), HatchLevels::Continuous);
        let options = HatchOptions { light, levels, smooth_deg, ..plain(HatchMethod::Straight) };
        let got = length(&hatched(&scene, &along(DVec3::Y), &options, mm)) * mm;
        got * PEN_MM / (options.black * mm * mm)
    };
    // Each face is a square on paper, as dark as its angle says.
    let flat = 2.0 * (1.0 - 0.5_f64.sqrt());
    for smooth_deg in [0.0, 30.0, 89.0] {
        assert!((length_with(smooth_deg) - flat).abs() < 0.02, "{}", length_with(smooth_deg));
    }
    // Their common edge faces the light, and their far edges do so at 45°: less is dark.
    let curved = length_with(91.0);
    assert!(curved > 0.3 * flat && curved < 0.8 * flat, "{curved} of {flat}");
}

#[test]
fn sections_lie_in_planes_with_the_given_normal() {
    let scene = cuboid(dvec3(2.0, 3.0, 4.0));
    let camera = along(dvec3(0.4, 1.0, 0.0));
    for normal in [DVec3::Z, dvec3(1.0, -2.0, 0.5)] {
        let light = LightSource::From(dvec3(1.0, -0.5, 0.2));
        let normal_of_planes = Some(normal);
        let options =
            HatchOptions { light, normal: normal_of_planes, ..plain(HatchMethod::Sections) };
        let strokes = hatched(&scene, &camera, &options, 20.0);
        assert!(strokes.len() > 10, "{}", strokes.len());
        // Images of the sides' own directions, the x and the y axis of the world, with the height.
        let frame = camera.frame();
        for stroke in strokes.iter() {
            for pair in stroke.points.windows(2) {
                let step = pair[1] - pair[0];
                let is_in_plane = [DVec3::X, DVec3::Y].iter().any(|&side| {
                    // A step along the side and up whose image this is.
                    let along = step.x / side.dot(frame.right);
                    (normal.dot(side * along + DVec3::Z * step.y)).abs() < 1e-9
                });
                assert!(is_in_plane, "{step} of planes across {normal}");
            }
        }
    }
}
