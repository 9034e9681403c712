//! How long each stage takes on a bumpy sphere of 10 thousand, 100 thousand and a million
//! triangles.
//!
//! `cargo bench` runs all; `cargo bench --bench stages -- visibility` only some.

use std::f64::consts::{PI, TAU};
use std::io::{Write, sink};

use divan::{Bencher, black_box};
use glam::{DVec3, dvec3};
use libm::{cos, sin};

use hiddenline::stages::camera::{Camera, DEFAULT_FOV_DEG, DEFAULT_NEAR, Projection};
use hiddenline::stages::chain::{ChainOptions, chain};
use hiddenline::stages::classify::{LineSelection, ViewedScene};
use hiddenline::stages::engines::edge::{LineEngine, VisibilityOptions, solve};
use hiddenline::stages::engines::image::raster::Corners;
use hiddenline::stages::engines::image::{self, PixelMap, Raster};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::model::topology::Topology;
use hiddenline::stages::page::{Page, PageOptions, PlotOptions};
use hiddenline::stages::read::{ModelFormat, read_bytes};
use hiddenline::stages::strokes::HiddenLines;
use hiddenline::stages::strokes::StrokeKind;
use hiddenline::stages::write::svg::{self, StrokeElement};

fn main() {
    divan::main();
}

/// Numbers of points along the equator; the mesh has about as many triangles as its square.
const SIZES: [u32; 3] = [100, 316, 1000];

/// A sphere with bumps, open at its poles: `n (n − 2)` triangles, as an OBJ file.
fn bumpy_sphere(n: u32) -> Vec<u8> {
    let rows = n / 2;
    let mut obj = Vec::new();
    for i in 0..n {
        let u = TAU * f64::from(i) / f64::from(n);
        for j in 0..rows {
            let v = 0.02 + (PI - 0.04) * f64::from(j) / f64::from(rows - 1);
            let r = 1.0 + 0.12 * sin(9.0 * u) * sin(7.0 * v) + 0.04 * sin(31.0 * u + 3.0 * v);
            let DVec3 { x, y, z } = r * dvec3(sin(v) * cos(u), sin(v) * sin(u), cos(v));
            writeln!(obj, "v {x:.9} {y:.9} {z:.9}").expect("memory takes everything");
        }
    }
    for i in 0..n {
        for j in 1..rows {
            // OBJ counts from 1.
            let (a, b) = (i * rows + j, (i + 1) % n * rows + j);
            writeln!(obj, "f {a} {} {}\nf {a} {} {b}", a + 1, b + 1, b + 1)
                .expect("memory takes everything");
        }
    }
    obj
}

fn read(obj: &[u8]) -> Mesh {
    read_bytes("sphere.obj", obj, Some(ModelFormat::Obj)).expect("a sphere").mesh
}

fn camera() -> Camera {
    let projection = Projection::Perspective { fov_deg: DEFAULT_FOV_DEG, near: DEFAULT_NEAR };
    Camera::new(dvec3(4.0, -3.0, 2.0), DVec3::ZERO, DVec3::Z, projection).expect("a camera")
}

fn outlines() -> LineSelection {
    LineSelection::NONE.with(StrokeKind::Silhouette).with(StrokeKind::Boundary)
}

fn settings() -> VisibilityOptions {
    VisibilityOptions { find_doubled: true, ..VisibilityOptions::EXACT }
}

fn chaining() -> ChainOptions {
    ChainOptions {
        hidden: false,
        hidden_levels: None,
        exact: false,
        apart_by_kind: false,
        shortest: 0.0,
    }
}

fn view(scene: &Scene, lines: LineSelection) -> ViewedScene<'_> {
    ViewedScene::new(scene, &camera(), lines, 30.0)
}

#[divan::bench(args = SIZES)]
fn a_read_obj(bencher: Bencher, n: u32) {
    let obj = bumpy_sphere(n);
    bencher.bench_local(|| read(black_box(&obj)));
}

#[divan::bench(args = SIZES)]
fn b_topology(bencher: Bencher, n: u32) {
    let mesh = read(&bumpy_sphere(n));
    bencher.bench_local(|| Topology::new(black_box(&mesh)));
}

#[divan::bench(args = SIZES)]
fn c_classify(bencher: Bencher, n: u32) {
    let scene = Scene::new(read(&bumpy_sphere(n)));
    bencher.bench_local(|| view(black_box(&scene), outlines()));
}

#[divan::bench(args = SIZES)]
fn d_visibility_of_outlines(bencher: Bencher, n: u32) {
    let scene = Scene::new(read(&bumpy_sphere(n)));
    let view = view(&scene, outlines());
    bencher.bench_local(|| solve(black_box(&view), LineEngine::default(), &settings()));
}

#[divan::bench(args = SIZES)]
fn e_visibility_of_all_edges(bencher: Bencher, n: u32) {
    let scene = Scene::new(read(&bumpy_sphere(n)));
    let view = view(&scene, LineSelection::all_edges());
    bencher.bench_local(|| solve(black_box(&view), LineEngine::default(), &settings()));
}

/// Sheets of 40 × 40 squares, one behind the other, of which only the first shows.
fn sheets(n: u32) -> Scene {
    const SIDE: u32 = 40;
    let mut soup = PolygonSoup::default();
    for sheet in 0..n {
        let first = soup.positions.len() as u32;
        let at = |i: u32, j: u32| first + i * (SIDE + 1) + j;
        for i in 0..=SIDE {
            for j in 0..=SIDE {
                let [x, z] = [i, j].map(|k| 2.0 * f64::from(k) / f64::from(SIDE) - 1.0);
                soup.positions.push(dvec3(x, 0.01 * f64::from(sheet), z));
            }
        }
        for i in 0..SIDE {
            for j in 0..SIDE {
                soup.push_face(&[at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                soup.push_face(&[at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }
    Scene::new(Mesh::new(soup).expect("finite points").0)
}

#[divan::bench(args = [10, 100])]
fn e_visibility_of_sheets(bencher: Bencher, n: u32) {
    let scene = sheets(n);
    let camera =
        Camera::new(dvec3(0.0, -5.0, 0.0), DVec3::ZERO, DVec3::Z, Projection::Orthographic)
            .expect("a camera");
    let view = ViewedScene::new(&scene, &camera, LineSelection::all_edges(), 30.0);
    bencher.bench_local(|| solve(black_box(&view), LineEngine::default(), &settings()));
}

#[divan::bench(args = SIZES)]
fn f_strokes_of_all_edges(bencher: Bencher, n: u32) {
    let scene = Scene::new(read(&bumpy_sphere(n)));
    let view = view(&scene, LineSelection::all_edges());
    let (visibility, ..) = solve(&view, LineEngine::default(), &settings());
    bencher.bench_local(|| chain(black_box(&view), &visibility, None, &chaining()));
}

#[divan::bench(args = SIZES)]
fn h_z_buffer_of_2000_x_2000_pixels(bencher: Bencher, n: u32) {
    const SIZE: (u32, u32) = (2000, 2000);
    let scene = Scene::new(read(&bumpy_sphere(n)));
    let bounds = Corners::new(&scene, &camera()).bounds().expect("something to see");
    let map = PixelMap::fitting(bounds, SIZE, 80.0);
    bencher.bench_local(|| {
        let raster = Raster::new(black_box(&scene), &camera(), &map, SIZE);
        image::solve(&raster, image::ImageEngine::ZBuffer)
    });
}

#[divan::bench(args = SIZES)]
fn g_write_svg_of_all_edges(bencher: Bencher, n: u32) {
    let scene = Scene::new(read(&bumpy_sphere(n)));
    let view = view(&scene, LineSelection::all_edges());
    let (visibility, ..) = solve(&view, LineEngine::default(), &settings());
    let drawing = chain(&view, &visibility, None, &chaining());
    bencher.bench_local(|| {
        let page = Page::place(&drawing.extent(&camera()), &camera(), &PageOptions::default())
            .expect("a page");
        let options = PlotOptions {
            pen_width_mm: 0.3,
            pens: Vec::new(),
            hidden: HiddenLines::None,
            dash: None,
            keep_dashes_whole: false,
            title: String::new(),
            source: String::new(),
        };
        let plot = page.plot(black_box(&drawing), options).plot;
        svg::write(&plot, StrokeElement::Path, &mut sink()).expect("it takes everything");
    });
}
