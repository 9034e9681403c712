//! Which edges are creases: every bent edge of constructed models, and in organic ones chains that stand out.

use std::collections::BTreeMap;

use glam::{DVec3, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::model::creases::{CreaseAngle, CreaseChains, looseness};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::strokes::StrokeKind;

use crate::models;
use crate::scenes::Rng;

fn camera() -> Camera {
    Camera::new(dvec3(40.0, -60.0, 50.0), DVec3::ZERO, DVec3::Z, Projection::Orthographic).unwrap()
}

/// A square of triangles with these heights, as a height field of `n + 1` by `n + 1` points.
fn field(n: usize, height: impl Fn(usize, usize) -> f64) -> Scene {
    let mut soup = PolygonSoup::default();
    for j in 0..=n {
        for i in 0..=n {
            soup.positions.push(dvec3(i as f64, j as f64, height(i, j)));
        }
    }
    let at = |i: usize, j: usize| (j * (n + 1) + i) as u32;
    for j in 0..n {
        for i in 0..n {
            soup.push_face(&[at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            soup.push_face(&[at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    Scene::new(Mesh::new(soup).unwrap().0)
}

/// Noise with a ridge along `x = n / 2`.
fn rough_with_ridge(n: usize, roughness: f64, ridge: f64) -> Scene {
    let noise = |i: usize, j: usize| Rng((i * 1000 + j) as u64).integer(-1000, 1000) / 1000.0;
    let across = |i: usize| (i as f64 - n as f64 / 2.0).abs();
    field(n, |i, j| roughness * noise(i, j) - ridge * across(i))
}

/// Strips bent edges with a loose end one by one, and returns the share that was stripped.
fn loose_share_by_hand(scene: &Scene) -> f64 {
    let topology = scene.topology();
    let bent = CreaseAngle::from_degrees(30.0);
    let positions = scene.mesh().positions();
    let n = topology.edges().len() as u32;
    let mut creases: Vec<u32> = (0..n).filter(|&e| bent.is_exceeded(scene, e)).collect();
    let borders: Vec<u32> = (0..n).filter(|&e| topology.uses(e).len() != 2).collect();
    let length = |e: u32| {
        let [a, b] = topology.edge(e);
        positions[a as usize].distance(positions[b as usize])
    };
    let all: f64 = creases.iter().map(|&e| length(e)).sum();
    loop {
        let mut degrees: BTreeMap<u32, usize> = BTreeMap::new();
        for &e in creases.iter().chain(&borders) {
            topology.edge(e).into_iter().for_each(|v| *degrees.entry(v).or_default() += 1);
        }
        let is_loose = |&e: &u32| topology.edge(e).iter().any(|v| degrees[v] == 1);
        let before = creases.len();
        creases.retain(|e| !is_loose(e));
        if creases.len() == before {
            break;
        }
    }
    let closed: f64 = creases.iter().map(|&e| length(e)).sum();
    if all > 0.0 { (all - closed) / all } else { 0.0 }
}

#[test]
fn how_grown_a_model_is_is_the_share_of_loose_creases() {
    let grown = |share: f64| ((share - 0.08) / 0.22).clamp(0.0, 1.0);
    let mut n_between = 0;
    for (roughness, ridge) in
        [(0.2, 0.0), (0.28, 0.0), (0.35, 0.0), (0.5, 0.0), (0.9, 0.0), (0.2, 0.5)]
    {
        let scene = rough_with_ridge(24, roughness, ridge);
        let share = loose_share_by_hand(&scene);
        let expected = grown(share);
        n_between += usize::from(share > 0.0 && share < 1.0);
        let found = looseness(&scene).of_scene();
        assert!((found - expected).abs() < 1e-12, "{roughness} {ridge}: {found} {expected}");
    }
    assert!(n_between > 2);
    let mut model = crate::scenes::Model::default();
    model.add_box([0.0; 3], [1.0, 2.0, 3.0]);
    let mut soup = PolygonSoup::default();
    soup.positions.extend(model.positions.iter().map(|&p| DVec3::from_array(p)));
    model.faces.iter().for_each(|face| soup.push_face(face));
    let scene = Scene::new(Mesh::new(soup).unwrap().0);
    assert!(looseness(&scene).is_constructed());
}

#[test]
fn a_ridge_in_noise_is_one_crease_and_the_noise_none() {
    let scene = rough_with_ridge(60, 0.17, 0.5);
    assert!(looseness(&scene).of_scene() > 0.5, "{}", looseness(&scene).of_scene());
    let chains = CreaseChains::new(&scene, 30.0);
    let is_crease = chains.of_view(&scene, &camera(), 2.0, 0.3);
    let above = CreaseAngle::from_degrees(30.0);
    let positions = scene.mesh().positions();
    let (mut on_ridge, mut beside, mut bent_beside) = (0.0, 0.0, 0.0);
    for edge in 0..scene.topology().edges().len() as u32 {
        let [a, b] = scene.topology().edge(edge).map(|v| positions[v as usize]);
        let is_on_ridge = a.x == 30.0 && b.x == 30.0;
        let length = a.distance(b);
        if is_crease[edge as usize] {
            *(if is_on_ridge { &mut on_ridge } else { &mut beside }) += length;
        }
        if !is_on_ridge && above.is_exceeded(&scene, edge) {
            bent_beside += length;
        }
    }
    assert!(on_ridge > 50.0, "{on_ridge}");
    assert!(beside < 0.6 * bent_beside && bent_beside > 30.0, "{beside} of {bent_beside}");
}

#[test]
fn chains_grow_with_the_paper_and_shrink_to_nothing() {
    let scene = rough_with_ridge(40, 0.25, 0.4);
    let chains = CreaseChains::new(&scene, 30.0);
    let n = |scale: f64| {
        let is_crease = chains.of_view(&scene, &camera(), scale, 0.0);
        is_crease.iter().filter(|&&is| is).count()
    };
    assert_eq!(n(1e-6), 0);
    let counts: Vec<usize> = [0.1, 0.5, 2.0, 10.0, 100.0].map(n).to_vec();
    assert!(counts.windows(2).all(|pair| pair[0] <= pair[1]), "{counts:?}");
    assert!(counts[4] > 100);
}

/// All sides of a prism are bent alike; at a crease angle of exactly that, none is a crease, and a hair
/// below, all are.
#[test]
fn sides_of_regular_prisms_are_creases_all_or_none_in_every_pose() {
    let mut rng = Rng(7);
    let mut fraction = || rng.integer(-1_000_000, 1_000_000) / 1e6;
    for n in 5..=40u32 {
        for _ in 0..4 {
            let axis = dvec3(fraction(), fraction(), fraction()).normalize();
            let turn = glam::DQuat::from_axis_angle(axis, 3.0 * fraction());
            let (size, offset) = (10f64.powf(2.0 * fraction()), 100.0 * fraction());
            let corner = |k: u32, z: f64| {
                let angle = std::f64::consts::TAU * f64::from(k) / f64::from(n);
                let p = turn * (size * dvec3(angle.cos(), angle.sin(), z))
                    + DVec3::splat(offset * size);
                // As a file in single precision has it.
                p.as_vec3().as_dvec3()
            };
            let mut soup = PolygonSoup::default();
            for k in 0..n {
                soup.positions.extend([corner(k, -1.0), corner(k, 1.0)]);
            }
            for k in 0..n {
                let (a, b) = (2 * k, 2 * ((k + 1) % n));
                soup.push_face(&[a, b, b + 1]);
                soup.push_face(&[a, b + 1, a + 1]);
            }
            let scene = Scene::new(Mesh::new(soup).unwrap().0);
            let n_sides = |degrees: f64| {
                let angle = CreaseAngle::from_degrees(degrees);
                let edges = 0..scene.topology().edges().len() as u32;
                edges.filter(|&edge| angle.is_exceeded(&scene, edge)).count() as u32
            };
            let nominal = 360.0 / f64::from(n);
            assert_eq!(n_sides(nominal), 0, "{n} sides");
            assert_eq!(n_sides(nominal - 0.6), n, "{n} sides");
        }
    }
}

#[test]
fn drawings_of_constructed_models_have_every_bent_edge() {
    let Some(mesh) = models::get("benchy_wheel.stl") else { return };
    let scene = Scene::new(mesh);
    assert!(looseness(&scene).is_constructed());
    let [tidy, exact] = [false, true].map(|exact| {
        let lines = hiddenline::stages::classify::LineSelection::NONE.with(StrokeKind::Crease);
        let options = DrawOptions { exact, lines, ..DrawOptions::default() };
        let drawing = draw(&scene, &camera(), &options, 5.0).drawing;
        drawing.iter().map(|s| s.points.to_vec()).collect::<Vec<_>>()
    });
    // Within half a pen's width, but for what is shorter than the shortest stroke.
    let segments: Vec<_> = tidy.iter().flat_map(|s| s.windows(2)).collect();
    for pair in exact.iter().flat_map(|s| s.windows(2)).filter(|p| p[0].distance(p[1]) * 5.0 > 0.25)
    {
        let at = 0.5 * (pair[0] + pair[1]);
        let distance = |p: &&[glam::DVec2]| {
            let along = p[1] - p[0];
            let t = ((at - p[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            5.0 * at.distance(p[0].lerp(p[1], t))
        };
        let nearest = segments.iter().map(distance).fold(f64::INFINITY, f64::min);
        assert!(nearest <= 0.15 + 1e-9, "{at} is {nearest} mm from ink");
    }
}

/// A plate with a band of strips in its middle, each `width` wide, that are bent to and fro by twice `slope_deg`.
fn plate_with_strips(width: f64, slope_deg: f64, n: usize) -> Scene {
    let rise = width * slope_deg.to_radians().tan();
    let inner = (0..=n).map(|k| (k as f64 * width, if k % 2 == 1 { rise } else { 0.0 }));
    let end = n as f64 * width + 100.0;
    extruded(&[(-100.0, 0.0)].into_iter().chain(inner).chain([(end, 0.0)]).collect::<Vec<_>>())
}

/// A profile along y.
fn extruded(profile: &[(f64, f64)]) -> Scene {
    let mut soup = PolygonSoup::default();
    for y in [0.0, 50.0] {
        soup.positions.extend(profile.iter().map(|&(x, z)| DVec3::new(x, y, z)));
    }
    let m = profile.len() as u32;
    for k in 0..m - 1 {
        // Some faces are wound against their neighbors.
        let face = [k, k + 1, m + k + 1, m + k];
        let turned = [m + k, m + k + 1, k + 1, k];
        soup.push_face(if k % 3 == 1 { &turned } else { &face });
    }
    Scene::new(Mesh::new(soup).unwrap().0)
}

#[test]
fn strips_bent_to_and_fro_are_no_creases_where_the_pen_is_wider() {
    let n_creases = |scene: &Scene, mm_per_unit: f64, pen_mm: f64| {
        CreaseChains::of_scene(scene, 30.0).map(|creases| {
            let is_crease = creases.of_view(scene, &camera(), mm_per_unit, pen_mm);
            is_crease.iter().filter(|&&is| is).count()
        })
    };
    // Bent by 20, 40, −40 … 20 degrees: eleven edges above 30, each undone
    // after one strip of 0.106.
    let strips = plate_with_strips(0.1, 20.0, 12);
    assert_eq!(n_creases(&strips, 1.0, 0.22), Some(0));
    assert_eq!(n_creases(&strips, 1.0, 0.21), Some(11));
    assert_eq!(n_creases(&strips, 2.0, 0.22), Some(11));
    // The two edges of a single step stay.
    let step = extruded(&[(-9.0, 0.0), (0.0, 0.0), (0.1, 0.1), (9.0, 0.1)]);
    assert_eq!(n_creases(&step, 1.0, 10.0), None);
    // Of three strips, bent by 20, −40, 40 and −20 degrees, the third one is wide: its edge stays.
    let rise = |width: f64| width * 20.0_f64.to_radians().tan();
    let three =
        [(-9.0, 0.0), (0.0, 0.0), (0.1, rise(0.1)), (0.2, 0.0), (0.6, rise(0.4)), (9.0, rise(0.4))];
    assert_eq!(n_creases(&extruded(&three), 1.0, 0.3), Some(1));
    assert_eq!(n_creases(&extruded(&three), 1.0, 1.0), Some(0));
    // Sharper ones stay, and so do the two sides of a chamfer, whose bend goes on.
    assert_eq!(n_creases(&plate_with_strips(0.1, 31.0, 12), 1.0, 10.0), None);
    let chamfer = extruded(&[(-9.0, 0.0), (0.0, 0.0), (0.1, -0.1), (0.1, -9.0)]);
    assert_eq!(n_creases(&chamfer, 1.0, 10.0), None);
    // Around a thin rod the bends add up to a full turn, which undoes nothing.
    let mut soup = PolygonSoup::default();
    for y in [0.0, 50.0] {
        let corner = |k: u32| f64::from(k) * std::f64::consts::FRAC_PI_3;
        let at = |k: u32| DVec3::new(0.01 * corner(k).cos(), y, 0.01 * corner(k).sin());
        soup.positions.extend((0..6).map(at));
    }
    (0..6).for_each(|k| soup.push_face(&[k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k]));
    assert_eq!(n_creases(&Scene::new(Mesh::new(soup).unwrap().0), 1.0, 10.0), None);
}
