//! Refined meshes: circles, cylinders and spheres come out as such, flat things stay, nothing cracks.

use glam::{DVec3, dvec3};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::smooth::{SmoothParts, smooth};
use hiddenline::stages::model::topology::Topology;

use crate::models;

const EXACT: SmoothParts = SmoothParts::ByNormals;

/// A sphere of so many rings, or a torus's like; normals are given as they are on the sphere.
fn sphere(rings: u32, with_normals: bool) -> Mesh {
    let segments = 2 * rings;
    let mut soup = PolygonSoup::default();
    for i in 0..=rings {
        for j in 0..segments {
            let theta = std::f64::consts::PI * f64::from(i) / f64::from(rings);
            let phi = std::f64::consts::TAU * f64::from(j) / f64::from(segments);
            // Poles are one point each.
            let phi = if i == 0 || i == rings { 0.0 } else { phi };
            let sin = if i == 0 || i == rings { 0.0 } else { theta.sin() };
            let p = dvec3(sin * phi.cos(), sin * phi.sin(), theta.cos());
            soup.positions.push(if i == rings { dvec3(0.0, 0.0, -1.0) } else { p.normalize() });
        }
    }
    let at = |i: u32, j: u32| i * segments + j % segments;
    for i in 0..rings {
        for j in 0..segments {
            if i > 0 {
                soup.push_face(&[at(i, j), at(i + 1, j), at(i, j + 1)]);
            }
            if i + 1 < rings {
                soup.push_face(&[at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)]);
            }
        }
    }
    if with_normals {
        let normal = |&c: &u32| soup.positions[c as usize].to_array().map(|x| x as f32);
        soup.corner_normals = soup.corners.iter().map(normal).collect();
    }
    Mesh::new(soup).unwrap().0
}

fn volume(mesh: &Mesh) -> f64 {
    let at = |v: u32| mesh.positions()[v as usize];
    (0..mesh.n_faces() as u32)
        .map(|face| {
            let corners = mesh.face(face);
            let fan = corners[1..].windows(2);
            fan.map(|p| at(corners[0]).dot(at(p[0]).cross(at(p[1]))) / 6.0).sum::<f64>()
        })
        .sum()
}

/// A cylinder with caps, its axis along z.
fn cylinder(n: u32, radius: f64, height: f64) -> Mesh {
    let mut soup = PolygonSoup::default();
    for k in 0..n {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(n);
        let (x, y) = (radius * angle.cos(), radius * angle.sin());
        soup.positions.extend([dvec3(x, y, 0.0), dvec3(x, y, height)]);
    }
    for k in 0..n {
        let (a, b) = (2 * k, 2 * ((k + 1) % n));
        soup.push_face(&[a, b, b + 1, a + 1]);
    }
    soup.push_face(&(0..n).map(|k| 2 * k + 1).collect::<Vec<_>>());
    soup.push_face(&(0..n).rev().map(|k| 2 * k).collect::<Vec<_>>());
    Mesh::new(soup).unwrap().0
}

fn is_closed(mesh: &Mesh) -> bool {
    let topology = Topology::new(mesh);
    let counts = topology.count_edges();
    counts.boundary == 0 && counts.nonmanifold == 0 && counts.inconsistent == 0
}

#[test]
fn new_vertices_of_a_sphere_with_its_normals_lie_on_it() {
    let mesh = sphere(8, true);
    let mut last = volume(&mesh);
    for tolerance in [1e-2, 1e-3, 1e-4] {
        let (refined, smoothed) = smooth(&mesh, EXACT, tolerance).unwrap();
        assert!(smoothed.triangles[1] > 2 * smoothed.triangles[0]);
        for p in refined.positions() {
            // The normals given are singles.
            assert!((p.length() - 1.0).abs() < 2e-7, "{p}");
        }
        assert!(is_closed(&refined));
        let counts =
            (refined.positions().len() as i64) - Topology::new(&refined).edges().len() as i64;
        assert_eq!(counts + refined.n_faces() as i64, 2);
        let now = volume(&refined);
        assert!(now > last && now < 4.0 / 3.0 * std::f64::consts::PI, "{last} {now}");
        last = now;
        assert!(smoothed.farthest <= tolerance);
    }
    assert!(4.0 / 3.0 * std::f64::consts::PI - last < 2e-3);
}

#[test]
fn rims_and_walls_of_a_cylinder_lie_on_it_and_its_caps_stay_flat() {
    for n in [8, 12, 20, 64] {
        let mesh = cylinder(n, 3.0, 5.0);
        let (refined, smoothed) = smooth(&mesh, SmoothParts::Below(46.0), 1e-4).unwrap();
        assert!(smoothed.triangles[1] > smoothed.triangles[0]);
        for p in refined.positions() {
            let radius = p.truncate().length();
            assert!((radius - 3.0).abs() < 1e-14, "{n}: {radius}");
            assert!(p.z == 0.0 || p.z == 5.0 || (p.z > 0.0 && p.z < 5.0));
        }
        assert!(is_closed(&refined));
        // What is left is a polygon whose sides are that near to the circle.
        let rim = refined.positions().iter().filter(|p| p.z == 5.0).count() as f64;
        assert!(3.0 * (1.0 - (std::f64::consts::PI / rim).cos()) <= 1e-4);
        // The caps are the polygons of the rim, in one plane each.
        let area = 0.5 * rim * 9.0 * (std::f64::consts::TAU / rim).sin();
        assert!((volume(&refined) - 5.0 * area).abs() < 1e-9, "{n}: {}", volume(&refined));
    }
}

#[test]
fn a_box_and_a_model_of_flat_parts_come_back_unchanged() {
    let mut model = crate::scenes::Model::default();
    model.add_box([0.0; 3], [4.0, 2.0, 7.0]);
    let mut soup = PolygonSoup::default();
    soup.positions.extend(model.positions.iter().map(|&p| DVec3::from_array(p)));
    model.faces.iter().for_each(|face| soup.push_face(face));
    let mesh = Mesh::new(soup).unwrap().0;
    assert_eq!(smooth(&mesh, SmoothParts::Below(30.0), 1e-9).unwrap().0, mesh);
    // Without normals of its own nothing says that a model is smooth.
    let plain = sphere(6, false);
    assert_eq!(smooth(&plain, EXACT, 1e-9).unwrap().0, plain);
}

/// A block with a quarter-round fillet along one edge, in strips.
#[test]
fn flat_faces_beside_a_fillet_keep_every_vertex_in_their_plane() {
    const STRIPS: u32 = 4;
    // The profile, counter-clockwise seen from y > 0: x, z.
    let mut profile = vec![(0.0, 0.0), (0.0, 10.0), (9.0, 10.0)];
    for k in 1..=STRIPS {
        let angle = std::f64::consts::FRAC_PI_2 * (1.0 - f64::from(k) / f64::from(STRIPS));
        profile.push((9.0 + angle.cos(), 9.0 + angle.sin()));
    }
    profile.push((10.0, 0.0));
    let n = profile.len() as u32;
    let mut soup = PolygonSoup::default();
    for &(x, z) in &profile {
        soup.positions.extend([dvec3(x, 0.0, z), dvec3(x, 20.0, z)]);
    }
    for k in 0..n {
        let (a, b) = (2 * k, 2 * ((k + 1) % n));
        soup.push_face(&[a, a + 1, b + 1, b]);
    }
    soup.push_face(&(0..n).map(|k| 2 * k).collect::<Vec<_>>());
    soup.push_face(&(0..n).rev().map(|k| 2 * k + 1).collect::<Vec<_>>());
    let mesh = Mesh::new(soup).unwrap().0;
    assert!(volume(&mesh).abs() > 1.0);
    let (refined, smoothed) = smooth(&mesh, SmoothParts::Below(30.0), 1e-5).unwrap();
    assert!(smoothed.triangles[1] > smoothed.triangles[0]);
    assert!(is_closed(&refined));
    for p in refined.positions() {
        let in_corner = p.x > 9.0 + 1e-9 && p.z > 9.0 + 1e-9;
        if in_corner {
            let radius = ((p.x - 9.0).powi(2) + (p.z - 9.0).powi(2)).sqrt();
            assert!((radius - 1.0).abs() < 1e-6, "{p}: {radius}");
        } else {
            let planes = [p.x, p.z, p.x - 10.0, p.z - 10.0, p.y, p.y - 20.0];
            assert!(planes.iter().any(|d| d.abs() < 1e-12), "{p}");
        }
    }
}

#[test]
fn a_finer_tolerance_is_kept_and_nothing_cracks() {
    let ball = sphere(8, false);
    let Some(cow) = models::get("spot.obj") else { return };
    let mut last = 0;
    for tolerance in [4e-3, 1e-3, 2.5e-4] {
        let (_, smoothed) = smooth(&ball, SmoothParts::Below(60.0), tolerance).unwrap();
        // Where normals are only estimated, a few edges stay a little farther off.
        assert!(smoothed.farthest <= 3.0 * tolerance, "{smoothed:?}");
        let (refined, smoothed) = smooth(&cow, SmoothParts::Below(60.0), tolerance).unwrap();
        assert!(smoothed.triangles[1] > last);
        last = smoothed.triangles[1];
        assert_eq!(Topology::new(&refined).count_edges(), Topology::new(&cow).count_edges());
        // Old vertices stay where they are.
        assert_eq!(refined.positions()[..cow.positions().len()], *cow.positions());
    }
}

#[test]
fn models_without_normals_are_smoothed_by_their_angles_beside_one_that_has_some() {
    // The same sphere twice, side by side, once with normals.
    let (given, plain) = (sphere(8, true), sphere(8, false));
    let mut soup = PolygonSoup::default();
    for (mesh, offset) in [(&given, 0.0), (&plain, 4.0)] {
        let first = soup.positions.len() as u32;
        soup.positions.extend(mesh.positions().iter().map(|&p| p + dvec3(offset, 0.0, 0.0)));
        for face in 0..mesh.n_faces() as u32 {
            let corners: Vec<u32> = mesh.face(face).iter().map(|&v| first + v).collect();
            soup.push_face(&corners);
        }
    }
    soup.corner_normals = given.corner_normals().to_vec();
    soup.corner_normals.resize(soup.corners.len(), [0.0; 3]);
    let both = Mesh::new(soup).unwrap().0;
    let radii = |parts: SmoothParts| {
        let (refined, _) = smooth(&both, parts, 1e-3).unwrap();
        let new = &refined.positions()[both.positions().len()..];
        let far = new.iter().filter(|p| p.x > 2.0);
        assert!(new.iter().filter(|p| p.x <= 2.0).all(|p| (p.length() - 1.0).abs() < 1e-3));
        far.map(|&p| (p - dvec3(4.0, 0.0, 0.0)).length()).collect::<Vec<f64>>()
    };
    assert!(radii(SmoothParts::ByNormals).is_empty(), "nothing is known of the second one");
    let by_angle = radii(SmoothParts::Below(60.0));
    assert!(
        by_angle.len() > 100 && by_angle.iter().all(|r| (r - 1.0).abs() < 0.02),
        "{by_angle:?}"
    );
}
