//! The library's front door, against the stages behind it and against closed forms.

use std::f64::consts::TAU;

use glam::{DVec2, dvec2, dvec3};
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::shading::preview::PreviewOptions;
use hiddenline::stages::strokes::Strokes;
use hiddenline::{
    Aspect, Error, HeightField, HeightOptions, Levels, LineSelection, Mesh, PageOptions, Paper,
    PolygonSoup, Scene, StrokeKind, Surface, SurfaceLines, SurfaceNote, Target, View,
};

/// Total length of the strokes of one kind.
fn length(strokes: &Strokes, kind: StrokeKind) -> f64 {
    let of_kind = strokes.iter().filter(|stroke| stroke.kind == kind);
    of_kind.map(|s| s.points.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>()).sum()
}

/// A wall: a plank over two shorter boards.
fn wall() -> PolygonSoup {
    let at = |x: f64, z: f64| dvec3(x, 0.0, z);
    let mut soup = PolygonSoup::default();
    for face in [
        [at(0., 1.), at(5., 1.), at(5., 2.), at(0., 2.)],
        [at(0., 0.), at(1., 0.), at(1., 1.), at(0., 1.)],
        [at(1., 0.), at(4., 0.), at(4., 1.), at(1., 1.)],
    ] {
        let first = soup.positions.len() as u32;
        soup.positions.extend(face);
        soup.push_face(&[first, first + 1, first + 2, first + 3]);
    }
    soup
}

/// A bumpy net of bent quadrilaterals.
fn bumps() -> PolygonSoup {
    let n = 7;
    let height = |k: u32| f64::from(k.wrapping_mul(0x9e37_79b9) >> 24) / 100.0;
    let at = |k: u32| dvec3(f64::from(k % n), f64::from(k / n), height(k));
    let positions = (0..n * n).map(at).collect();
    let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
    for k in (0..n * (n - 1)).filter(|k| k % n + 1 < n) {
        soup.push_face(&[k, k + 1, k + n + 1, k + n]);
    }
    soup
}

#[test]
fn exact_drawings_take_faces_as_given() {
    let front = View::front();
    let scene = Scene::from_polygons(wall()).unwrap();
    let boundaries = DrawOptions::default().lines(LineSelection::NONE.with(StrokeKind::Boundary));
    let (tidied, _) = scene.draw(&front, &boundaries).strokes(Paper::A4).unwrap();
    let (exact, _) = scene.draw(&front, &boundaries.exact()).strokes(Paper::A4).unwrap();
    // The rim of the wall; then the rims of the plank and of the boards.
    assert!((length(&tidied, StrokeKind::Boundary) - 14.0).abs() < 1e-9);
    assert!((length(&exact, StrokeKind::Boundary) - (12.0 + 10.0)).abs() < 1e-9);
    // A scene without any of that knowledge draws the same.
    for soup in [wall(), bumps()] {
        let scene = Scene::from_polygons(soup.clone()).unwrap();
        let plain = Scene::new(Mesh::new(soup).unwrap().0).with_intersections();
        for lines in [LineSelection::default(), LineSelection::all_edges()] {
            for (azimuth, elevation) in [(0.0, 0.0), (30.0, 25.0), (160.0, -10.0), (75.0, 8.0)] {
                let view = View::from_angles(azimuth, elevation);
                let camera = view.camera(plain.mesh().bounds().unwrap()).unwrap();
                let options = DrawOptions::default().lines(lines).exact();
                let drawn = |scene: &Scene| draw(scene, &camera, &options, 1.0).drawing;
                assert_eq!(drawn(&scene), drawn(&plain));
            }
        }
    }
}

#[test]
fn equal_faces_are_kept_on_request() {
    let square = |soup: &mut PolygonSoup| {
        let first = soup.positions.len() as u32;
        soup.positions
            .extend([[0., 0.], [1., 0.], [1., 1.], [0., 1.]].map(|[x, z]| dvec3(x, 0., z)));
        soup.push_face(&[first, first + 1, first + 2, first + 3]);
    };
    let mut soup = PolygonSoup::default();
    square(&mut soup);
    square(&mut soup);
    let mesh = || Mesh::new(soup.clone()).unwrap().0;
    let faces = |scene: Scene| scene.mesh().n_faces();
    assert_eq!(faces(Scene::builder().mesh(mesh()).build().unwrap()), 1);
    assert_eq!(faces(Scene::builder().mesh(mesh()).keep_equal_faces().build().unwrap()), 2);
}

/// Grid lines of a plane are straight: their lengths are known.
#[test]
fn surfaces_come_from_formulas_functions_and_files() {
    let lines = SurfaceLines::default().without_axes().every(5).border();
    let top = View::top();
    let length_of = |surface: &Surface| {
        let (strokes, _) = surface.draw(&top, &lines).strokes(Paper::A4).unwrap();
        length(&strokes, StrokeKind::Grid) + length(&strokes, StrokeKind::Boundary)
    };
    // Lines 0, 5 and 10 of both families, each 2 or 4 long.
    let expected = 3.0 * 2.0 + 3.0 * 4.0;
    let formula = Surface::formula("x/2 - y").unwrap().x(-1.0, 1.0).y(0.0, 4.0).samples(11, 11);
    assert!((length_of(&formula) - expected).abs() < 1e-9);
    let plane = |x: f64, y: f64| x / 2.0 - y;
    let function = Surface::from_fn((-1.0, 1.0), (0.0, 4.0), (11, 11), plane).unwrap();
    assert!((length_of(&function) - expected).abs() < 1e-9);
    let space =
        Surface::parametric_fn((-1.0, 1.0), (0.0, 4.0), (11, 11), |u, v| dvec3(u, v, plane(u, v)));
    let space = space.unwrap();
    assert!((length_of(&space) - expected).abs() < 1e-9);
    let slanted = |surface: Surface| {
        let surface = surface.aspect(Aspect::Data);
        let drawing = surface.draw(&View::isometric(), &lines);
        length(&drawing.strokes(Paper::A4).unwrap().0, StrokeKind::Grid)
    };
    let [a, b, c] = [formula, function, space].map(slanted);
    assert!((a - b).abs() < 1e-9 && (a - c).abs() < 1e-9, "{a} {b} {c}");

    let path = std::env::temp_dir().join(format!("hiddenline-heights-{}.csv", std::process::id()));
    let row = |y: usize| (0..11).map(move |x| format!("{}", x + y)).collect::<Vec<_>>().join(",");
    std::fs::write(&path, (0..11).map(row).collect::<Vec<_>>().join("\n")).unwrap();
    let options = HeightOptions { x: Some((-1.0, 1.0)), y: Some((0.0, 4.0)), ..Default::default() };
    let field = HeightField::open(&path, &options).unwrap();
    let plain = Surface::open(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    assert!((length_of(&Surface::grid(field.grid)) - expected).abs() < 1e-9);
    assert!((length_of(&plain) - 6.0 * 10.0).abs() < 1e-9);
    let error = Surface::open("no such file").unwrap_err();
    assert_eq!(error.to_string().split(':').next(), Some("cannot read no such file"));
}

/// The two ends of each parameter are joined: a torus has no border.
#[test]
fn parametric_functions_close() {
    let torus = |samples| {
        Surface::parametric_fn((0.0, TAU), (0.0, TAU), samples, |u: f64, v: f64| {
            let r = 3.0 + v.cos();
            dvec3(r * u.cos(), r * u.sin(), v.sin())
        })
    };
    let surface = torus((49, 25)).unwrap();
    let edges = surface.scene().unwrap();
    let edges = edges.topology();
    assert!((0..edges.edges().len() as u32).all(|edge| edges.uses(edge).len() == 2));
    assert!(matches!(torus((1, 25)), Err(error) if error.to_string().contains("along u")));
    assert!(torus((usize::MAX, 2)).is_err());
    assert!(Surface::from_fn((1.0, 0.0), (0.0, 1.0), (9, 9), |_, _| 0.0).is_err());
}

#[test]
fn sheets_of_surfaces_say_what_is_worth_knowing() {
    let page = PageOptions::from(Paper::A5);
    let waves = Surface::formula("sin(900*x)").unwrap().samples(9, 9);
    let sheet = waves.draw(&View::default(), &SurfaceLines::default()).on(page).unwrap();
    assert!(matches!(sheet.notes(), [SurfaceNote::Uncertified(_)]), "{:?}", sheet.notes());
    let smooth = Surface::formula("x + y").unwrap();
    let sheet = smooth.draw(&View::default(), &SurfaceLines::default()).on(page).unwrap();
    assert_eq!(sheet.notes(), []);
    let level = SurfaceLines::default().no_grid_lines().levels(Levels::At(vec![99.0]));
    let error = smooth.draw(&View::default(), &level).on(page).unwrap_err();
    assert!(matches!(error, Error::Surface(_)), "{error}");
}

#[test]
fn machines_are_known_by_name() {
    let target = |name| Target::machine(name);
    assert!(matches!(target("hp7475a"), Ok(Target::Hpgl(plotter)) if plotter.name == "hp7475a"));
    assert!(matches!(target("grbl-z"), Ok(Target::Gcode(_))));
    let message = target("grbl").unwrap_err().to_string();
    assert!(message.starts_with("unknown machine `grbl`; choose from "), "{message}");
    assert!(message.contains("hp7550") && message.contains("marlin"), "{message}");
}

/// A picture shows what a drawing is fitted to: wires, and no more than 60° to each side.
#[test]
fn previews_are_fitted_by_the_extent_of_drawings() {
    let mut soup = wall();
    let first = soup.positions.len() as u32;
    soup.positions.extend([dvec3(-9.0, 0.0, 0.0), dvec3(2.0, 0.0, 7.0)]);
    soup.push_wire(&[first, first + 1]);
    let scene = Scene::from_polygons(soup).unwrap();
    let bounds = scene.mesh().bounds().unwrap();
    let near_by = View::from_eye(dvec3(1.0, -0.5, 1.0)).target(dvec3(1.0, 0.0, 1.0));
    for view in [View::front(), View::isometric(), near_by] {
        let camera = view.camera(bounds).unwrap();
        let options = PreviewOptions { size: (400, 300), ..PreviewOptions::default() };
        let map = options.pixel_map(&scene, &camera);
        let (low, high) = scene.extent(&camera).corners().unwrap();
        let [a, b] = [dvec2(low.x, high.y), dvec2(high.x, low.y)].map(|p| map.pixel(p));
        let (margin, end) = (DVec2::splat(12.0), dvec2(388.0, 288.0));
        assert!((a - margin).min_element() > -1e-9 && (end - b).min_element() > -1e-9, "{a} {b}");
        assert!((a - margin).min_element().abs() < 1e-9, "{a}");
    }
}
