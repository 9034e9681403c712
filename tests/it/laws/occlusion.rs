//! Occlusion culling: whatever is left out, the strokes are the same, to the last bit.
//!
//! The judge is the engine without culling; the oracle judges that one elsewhere.

use crate::models;
use crate::scenes::{Rng, number_of_scenes};
use glam::{DVec3, dvec3};
use hiddenline::stages::camera::{Camera, DEFAULT_NEAR, Projection};
use hiddenline::stages::chain::{ChainOptions, chain};
use hiddenline::stages::classify::{LineSelection, ViewedScene};
use hiddenline::stages::engines::edge::{
    LineCounts, LineEngine, OcclusionCulling, VisibilityOptions, solve,
};
use hiddenline::stages::engines::visibility::Visibility;
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::read::read_file;
use hiddenline::stages::strokes::StrokeKind;

const PERSPECTIVE: Projection = Projection::Perspective { fov_deg: 30.0, near: DEFAULT_NEAR };

fn solved(
    view: &ViewedScene,
    options: VisibilityOptions,
    occlusion_culling: OcclusionCulling,
) -> (Visibility, LineCounts) {
    let options = VisibilityOptions { occlusion_culling, ..options };
    let (visibility, counts, _) = solve(view, LineEngine::Appel, &options);
    assert_eq!(counts.checksum_failures, 0);
    (visibility, counts)
}

/// Draws a view with and without culling, exactly and tidied; returns what was culled.
fn assert_same_strokes(name: &str, view: &ViewedScene, tolerance: f64) -> LineCounts {
    let exact = VisibilityOptions::EXACT;
    let tidied = VisibilityOptions { contact_tolerance: tolerance, find_doubled: true, ..exact };
    let mut culled = LineCounts::default();
    for options in [exact, tidied] {
        let (expected, none) = solved(view, options, OcclusionCulling::Never);
        assert_eq!((none.culled_edges, none.culled_triangles), (0, 0));
        let (found, counts) = solved(view, options, OcclusionCulling::Always);
        assert_eq!(expected.len(), found.len(), "{name}");
        let chaining = ChainOptions {
            hidden: false,
            hidden_levels: None,
            exact: options == exact,
            apart_by_kind: true,
            shortest: 0.0,
        };
        let [a, b] = [&expected, &found].map(|spans| chain(view, spans, None, &chaining));
        assert!(a == b, "{name}, tolerance {}: the strokes differ", options.contact_tolerance);
        culled.culled_edges += counts.culled_edges;
        culled.culled_triangles += counts.culled_triangles;
    }
    culled
}

/// From the upper front right, from the side, and from near by.
fn cameras(scene: &Scene) -> [Camera; 3] {
    let (low, high) = scene.mesh().bounds().unwrap();
    let (middle, size) = (0.5 * (low + high), (high - low).length());
    let from = |direction: DVec3, projection| {
        Camera::new(middle + size * direction, middle, DVec3::Z, projection).unwrap()
    };
    [
        from(dvec3(1.0, -2.0, 1.0), PERSPECTIVE),
        from(dvec3(0.0, -1.0, 0.0), Projection::Orthographic),
        from(dvec3(-0.5, -0.4, 0.3), PERSPECTIVE),
    ]
}

#[test]
fn models_are_drawn_the_same() {
    let (paths, least) = models::all();
    let is_run_at_length = number_of_scenes(0) > 0;
    let (mut n_models, mut n_culled) = (0, 0);
    for path in &paths {
        let mesh = read_file(path, None).unwrap().mesh;
        let tolerance = mesh.positions().iter().map(|p| p.abs().max_element()).fold(0.0, f64::max)
            * hiddenline::stages::draw::DEFAULT_CONTACT_TOLERANCE;
        n_models += 1;
        let scene = Scene::new(mesh);
        if scene.triangles().len() > 1_500 && !is_run_at_length {
            continue;
        }
        let scene = scene.with_bends().with_flush_edges().with_intersections();
        for (i, camera) in cameras(&scene).iter().enumerate() {
            let all = LineSelection::all_edges().with(StrokeKind::Intersection);
            for lines in [all, LineSelection::default()] {
                let view = ViewedScene::new(&scene, camera, lines, 30.0);
                let name = format!("{}, camera {i}", models::name(path));
                let culled = assert_same_strokes(&name, &view, tolerance);
                n_culled += u64::from(culled.culled_edges > 0);
            }
        }
    }
    assert!(n_models >= least);
    assert!(n_culled >= 4, "{n_culled} drawings of {n_models} models");
}

/// A surface of `n × n` squares over a square of 8 units, y away from the eye; `keep` says which squares
/// there are.
fn sheet(
    soup: &mut PolygonSoup,
    n: u32,
    in_triangles: bool,
    depth: impl Fn(f64, f64) -> f64,
    mut keep: impl FnMut() -> bool,
) {
    let first = soup.positions.len() as u32;
    for i in 0..=n {
        for j in 0..=n {
            let (x, z) = (8.0 * f64::from(i) / f64::from(n), 8.0 * f64::from(j) / f64::from(n));
            soup.positions.push(dvec3(x, depth(x, z), z));
        }
    }
    for i in 0..n {
        for j in 0..n {
            let at = |i: u32, j: u32| first + i * (n + 1) + j;
            let square = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            match (keep(), in_triangles) {
                (true, true) => {
                    soup.push_face(&[square[0], square[1], square[2]]);
                    soup.push_face(&[square[0], square[2], square[3]]);
                }
                (true, false) => soup.push_face(&square),
                (false, _) => {}
            }
        }
    }
}

fn unit(rng: &mut Rng) -> f64 {
    (rng.next() >> 11) as f64 / (1u64 << 53) as f64
}

/// Sheets behind and through each other, with holes, slits and folds, and loose triangles: more than a
/// thousand triangles.
fn layers(rng: &mut Rng) -> PolygonSoup {
    let mut soup = PolygonSoup::default();
    let is_on_lattice = rng.one_in(3);
    for layer in 0..2 + rng.below(3) {
        let n = if is_on_lattice { rng.pick(&[8, 16]) } else { 12 + rng.below(12) as u32 };
        // Few holes in front, where there is much to hide.
        let missing = rng.pick(&[0, 0, 200, 40]);
        let (slope, wave) = (rng.integer(-2, 2) / 4.0, rng.pick(&[0.0, 0.0, 0.4, 1.5]));
        let in_triangles = rng.one_in(2) || wave != 0.0 && !is_on_lattice;
        let start = if is_on_lattice { layer as f64 } else { 1.5 * layer as f64 + unit(rng) };
        let shape = move |x: f64, z: f64| match is_on_lattice {
            true => start + slope * (x - z),
            false => start + slope * x + wave * (1.3 * x + 0.7 * z).sin(),
        };
        let mut holes = Rng(rng.next());
        sheet(&mut soup, n, in_triangles, shape, || missing == 0 || !holes.one_in(missing));
    }
    let first = soup.positions.len() as u32;
    for k in 0..700 {
        let corner = dvec3(8.0 * unit(rng), 10.0 * unit(rng), 8.0 * unit(rng));
        let corner = if is_on_lattice { (2.0 * corner).round() / 2.0 } else { corner };
        soup.positions.push(corner);
        for _ in 0..2 {
            let offset = dvec3(unit(rng) - 0.5, unit(rng) - 0.5, unit(rng) - 0.5);
            let offset = if is_on_lattice { (4.0 * offset).round() / 2.0 } else { offset };
            soup.positions.push(corner + offset);
        }
        soup.push_face(&[3 * k, 3 * k + 1, 3 * k + 2].map(|corner| first + corner));
    }
    soup
}

#[test]
fn layers_with_holes_and_folds_are_drawn_the_same() {
    let n_scenes = number_of_scenes(2);
    let (mut n_culled, mut n_drawn) = (0, 0);
    for seed in 0..n_scenes {
        let mut rng = Rng(7000 + seed);
        let scene = Scene::new(Mesh::new(layers(&mut rng)).unwrap().0);
        assert!(scene.triangles().len() >= 1000);
        let scene = if rng.one_in(2) { scene.with_intersections() } else { scene };
        let from = dvec3(rng.integer(-4, 12), -rng.integer(2, 30), rng.integer(-4, 12));
        let projection = rng.pick(&[Projection::Orthographic, PERSPECTIVE]);
        let straight =
            Camera::new(dvec3(4.0, -30.0, 4.0), dvec3(4.0, 0.0, 4.0), DVec3::Z, projection);
        let askew = Camera::new(from, dvec3(4.0, 3.0, 4.0), DVec3::Z, projection);
        let tolerance = rng.pick(&[1e-6, 0.05, 0.3]);
        for (camera, lines) in [
            (straight, LineSelection::all_edges().with(StrokeKind::Intersection)),
            (askew, LineSelection::all_edges().with_outline()),
            (askew, LineSelection::default()),
        ] {
            let view = ViewedScene::new(&scene, &camera.unwrap(), lines, 30.0);
            let name = format!("seed {seed}, {projection:?}, tolerance {tolerance}");
            let culled = assert_same_strokes(&name, &view, tolerance);
            n_culled += culled.culled_edges;
            n_drawn += 2 * view.selected().len() as u64;
        }
    }
    eprintln!("{n_culled} of {n_drawn} edges were culled");
    assert!(n_culled > n_drawn / 5, "{n_culled} of {n_drawn}");
}

/// A wall of 20 × 20 squares in triangles, and a small triangle behind its middle.
fn walled(behind: f64, keep: impl FnMut() -> bool) -> Scene {
    let mut soup = PolygonSoup::default();
    sheet(&mut soup, 20, true, |_, _| 0.0, keep);
    let first = soup.positions.len() as u32;
    soup.positions.extend([(4.1, 4.1), (4.3, 4.1), (4.1, 4.3)].map(|(x, z)| dvec3(x, behind, z)));
    soup.push_face(&[first, first + 1, first + 2]);
    Scene::new(Mesh::new(soup).unwrap().0)
}

/// What is culled, looking straight at the wall.
fn culled(scene: &Scene, contact_tolerance: f64, projection: Projection) -> LineCounts {
    let camera = Camera::new(dvec3(4.0, -30.0, 4.0), dvec3(4.0, 0.0, 4.0), DVec3::Z, projection);
    let view = ViewedScene::new(scene, &camera.unwrap(), LineSelection::all_edges(), 30.0);
    assert_same_strokes("a wall", &view, contact_tolerance);
    let options = VisibilityOptions { contact_tolerance, ..VisibilityOptions::EXACT };
    solved(&view, options, OcclusionCulling::Always).1
}

#[test]
fn what_is_behind_a_wall_is_culled_unless_in_contact_or_seen_through_a_hole() {
    for projection in [Projection::Orthographic, PERSPECTIVE] {
        let whole = |behind| walled(behind, || true);
        let counts = culled(&whole(0.5), 0.0, projection);
        assert_eq!((counts.culled_triangles, counts.culled_edges), (1, 3));
        let counts = culled(&whole(0.5), 0.05, projection);
        assert_eq!((counts.culled_triangles, counts.culled_edges), (1, 3));
        // In contact with the wall it is not hidden by it.
        let counts = culled(&whole(0.04), 0.05, projection);
        assert_eq!((counts.culled_triangles, counts.culled_edges), (0, 0));
        let counts = culled(&whole(-0.5), 0.0, projection);
        assert_eq!((counts.culled_triangles, counts.culled_edges), (0, 0));
        // The square from (4, 4) to (4.4, 4.4) is number 210.
        let mut n = 0;
        let holed = walled(0.5, || {
            n += 1;
            n != 211
        });
        let counts = culled(&holed, 0.0, projection);
        assert_eq!((counts.culled_triangles, counts.culled_edges), (0, 0));
    }
}

#[test]
fn sheets_behind_a_sheet_cost_nothing() {
    let with_sheets = |n: u32| {
        let mut soup = PolygonSoup::default();
        for k in 0..n {
            let shape = |x: f64, z: f64| f64::from(k) + 0.2 * (x + f64::from(k)).sin() * z.cos();
            sheet(&mut soup, 24, true, shape, || true);
        }
        Scene::new(Mesh::new(soup).unwrap().0)
    };
    let figures = [2, 4, 16].map(|n| {
        let scene = with_sheets(n);
        let camera =
            Camera::new(dvec3(4.0, -60.0, 4.0), dvec3(4.0, 0.0, 4.0), DVec3::Z, PERSPECTIVE);
        let view = ViewedScene::new(&scene, &camera.unwrap(), LineSelection::all_edges(), 30.0);
        assert_same_strokes("sheets", &view, 1e-6);
        solved(&view, VisibilityOptions::EXACT, OcclusionCulling::Always).1.candidate_pairs
    });
    // Around the first sheet a little of the others is seen.
    assert!(figures[2] < 3 * figures[0], "{figures:?}");
}

#[test]
fn large_scenes_are_culled_unasked_and_layers_are_counted_in_full() {
    let mut soup = PolygonSoup::default();
    for k in 0..3 {
        sheet(&mut soup, 60, true, |x, _| f64::from(3 * k) + (0.5 * x).sin(), || true);
    }
    let scene = Scene::new(Mesh::new(soup).unwrap().0);
    let camera = Camera::new(dvec3(4.0, -60.0, 4.0), dvec3(4.0, 0.0, 4.0), DVec3::Z, PERSPECTIVE);
    let view = ViewedScene::new(&scene, &camera.unwrap(), LineSelection::all_edges(), 30.0);
    let (_, counts) = solved(&view, VisibilityOptions::EXACT, OcclusionCulling::Auto);
    assert!(counts.culled_edges as usize > view.selected().len() / 2, "{counts:?}");
    let counted = VisibilityOptions { count_layers: true, ..VisibilityOptions::EXACT };
    let (visibility, counts) = solved(&view, counted, OcclusionCulling::Always);
    assert_eq!(counts.culled_edges, 0);
    let deepest = (0..visibility.len()).flat_map(|i| visibility.spans(i)).map(|span| span.qi);
    assert!(deepest.max() >= Some(2));
}
