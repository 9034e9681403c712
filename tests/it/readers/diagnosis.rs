//! Hints about models that were probably not meant as they are.

use std::f64::consts::FRAC_PI_8;

use glam::{DVec3, dvec3};
use hiddenline::stages::model::arrange::{Arrangement, Pose, UpAxis};
use hiddenline::stages::model::diagnosis::{open_seams, seems_y_up};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};

fn turned(mesh: &Mesh) -> Mesh {
    let pose = Pose { up_axis: UpAxis::Y, ..Pose::default() };
    Arrangement::default().arrange(vec![(mesh.clone(), pose)]).unwrap().0
}

/// Triangles between the points of a grid over x and z, as high as `height` says; y is up.
fn terrain(height: impl Fn(f64, f64) -> f64) -> Mesh {
    let n = 12;
    let mut soup = PolygonSoup::default();
    for i in 0..=n {
        for k in 0..=n {
            let (x, z) = (f64::from(i), f64::from(k));
            soup.positions.push(dvec3(x + 3.0, height(x, z), z + 5.0));
        }
    }
    for i in 0..n as u32 {
        for k in 0..n as u32 {
            let a = i * 13 + k;
            soup.push_face(&[a, a + 1, a + 14, a + 13]);
        }
    }
    Mesh::new(soup).unwrap().0
}

/// A box between two corners.
fn cuboid(low: DVec3, high: DVec3) -> Mesh {
    let corner = |i: u32| {
        let pick = |bit: u32, axis: usize| if i >> bit & 1 == 1 { high[axis] } else { low[axis] };
        dvec3(pick(0, 0), pick(1, 1), pick(2, 2))
    };
    let mut soup = PolygonSoup { positions: (0..8).map(corner).collect(), ..Default::default() };
    for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    {
        soup.push_face(&face);
    }
    Mesh::new(soup).unwrap().0
}

/// A pyramid with its base at the given height of y.
fn pyramid(bottom: f64, tip: f64) -> Mesh {
    let mut soup = PolygonSoup::default();
    for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        soup.positions.push(dvec3(x, bottom, z));
    }
    soup.positions.push(dvec3(0.0, tip, 0.0));
    soup.push_face(&[0, 1, 2, 3]);
    for [a, b] in [[1, 0], [2, 1], [3, 2], [0, 3]] {
        soup.push_face(&[a, b, 4]);
    }
    Mesh::new(soup).unwrap().0
}

#[test]
fn models_made_with_y_up_are_recognized_and_turned_ones_are_not() {
    let hills = terrain(|x, z| 0.5 * (x * 0.9).sin() * (z * 0.7).cos());
    let base = pyramid(7.0, 10.0);
    let standing = cuboid(dvec3(-1.0, 0.0, -1.0), dvec3(1.0, 3.0, 1.0));
    for (name, mesh) in [("hills", &hills), ("base", &base), ("standing", &standing)] {
        assert!(seems_y_up(mesh), "{name}");
        assert!(!seems_y_up(&turned(mesh)), "{name}, turned");
    }
    // Nothing says y: a box in the middle of space, a closed body around its origin, a steep sheet.
    assert!(!seems_y_up(&cuboid(DVec3::splat(3.0), DVec3::splat(5.0))));
    assert!(!seems_y_up(&cuboid(DVec3::splat(-1.0), DVec3::splat(1.0))));
    assert!(!seems_y_up(&terrain(|x, z| 30.0 * (x * 2.9).sin() * (z * 2.7).cos())));
    // Both axes say that they are up.
    assert!(!seems_y_up(&terrain(|x, z| x + z)));
    assert!(!seems_y_up(&Mesh::default()));
}

/// The triangles of a ball, each with its own corners, displaced by up to `noise` model units.
fn loose_ball(size: f64, noise: f64) -> Mesh {
    let mut state = 1_u64;
    let mut random = move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
    };
    let point = |i: u32, k: u32| {
        let (a, b) = (f64::from(i) * FRAC_PI_8, f64::from(k) * FRAC_PI_8);
        size * dvec3(a.cos() * b.sin(), a.sin() * b.sin(), b.cos())
    };
    let mut soup = PolygonSoup::default();
    for i in 0..16 {
        for k in 0..8 {
            for corners in
                [[(i, k), (i, k + 1), (i + 1, k + 1)], [(i, k), (i + 1, k + 1), (i + 1, k)]]
            {
                let is_at_pole = |k: u32| k == 0 || k == 8;
                if corners.iter().filter(|(_, k)| is_at_pole(*k)).count() > 1 {
                    continue;
                }
                let first = soup.positions.len() as u32;
                for (i, k) in corners {
                    let shift = dvec3(random(), random(), random());
                    soup.positions.push(point(i % 16, k) + noise * shift);
                }
                soup.push_face(&[first, first + 1, first + 2]);
            }
        }
    }
    Mesh::new(soup).unwrap().0
}

#[test]
fn loose_triangles_give_the_distance_that_joins_them() {
    for (size, noise) in [(15.0, 1e-5), (1.0, 1e-4), (1e6, 3.0), (1e-3, 1e-9)] {
        let mesh = loose_ball(size, noise);
        let seams = open_seams(&mesh).expect("loose");
        assert_eq!([seams.n_open, seams.n_edges], [3 * mesh.n_faces(); 2]);
        assert!(seams.distance > noise && seams.distance < 100.0 * noise, "{seams:?}");
        let welded = mesh.weld(seams.distance).unwrap().0;
        // Corners at the poles fall together as well.
        assert_eq!(welded.positions().len(), 16 * 7 + 2);
    }
}

#[test]
fn sound_and_truly_open_models_give_no_distance() {
    assert_eq!(open_seams(&cuboid(DVec3::ZERO, DVec3::ONE)), None);
    assert_eq!(open_seams(&terrain(|x, _| x)), None);
    // Separate plates: nothing is near.
    let mut soup = PolygonSoup::default();
    for i in 0..20 {
        let first = soup.positions.len() as u32;
        let at = dvec3(10.0 * f64::from(i), 0.0, 0.0);
        soup.positions.extend([at, at + DVec3::X, at + DVec3::Y]);
        soup.push_face(&[first, first + 1, first + 2]);
    }
    assert_eq!(open_seams(&Mesh::new(soup).unwrap().0), None);
}
