//! Vertices that are made one because they are near each other.

use glam::{DVec3, dvec3};
use hiddenline::stages::model::mesh::{Mesh, MeshError, PolygonSoup};
use proptest::prelude::*;

fn soup_of_points(points: &[DVec3]) -> Mesh {
    // Each point becomes the tip of its own triangle, far from all others.
    let mut soup = PolygonSoup::default();
    for (i, &point) in points.iter().enumerate() {
        let far = 1e6 * (1 + i) as f64;
        let first = soup.positions.len() as u32;
        soup.positions.extend([point, dvec3(far, 2e6, 0.0), dvec3(far, 0.0, 2e6)]);
        soup.push_face(&[first, first + 1, first + 2]);
    }
    Mesh::new(soup).expect("finite").0
}

#[test]
fn near_vertices_become_the_first_of_them_over_chains_too() {
    let chain: Vec<_> = (0..10).map(|i| dvec3(f64::from(i) * 0.75, 0.0, 0.0)).collect();
    let count = |points: &[DVec3], distance| {
        let mesh = soup_of_points(points);
        let before = mesh.positions().len();
        let (mesh, repairs) = mesh.weld(distance).expect("welds");
        assert_eq!(before - mesh.positions().len(), repairs.welded_vertices);
        (mesh, repairs.welded_vertices)
    };
    let (mesh, welded) = count(&chain, 0.76);
    assert_eq!((welded, mesh.positions()[0]), (9, DVec3::ZERO));
    assert_eq!(count(&chain, 0.75).1, 0, "closer means strictly closer");
    assert_eq!(count(&chain, 0.0).1, 0);
    let reversed: Vec<_> = chain.iter().rev().copied().collect();
    assert_eq!(count(&reversed, 0.76).0.positions()[0], chain[9]);
    assert_eq!(count(&chain.iter().map(|p| p * 1e-200).collect::<Vec<_>>(), 0.76e-200).1, 9);
    let huge: Vec<_> = chain.iter().map(|p| p * 1e300).collect();
    let (_, repairs) = soup_of_points(&huge).weld(0.76e300).expect("welds");
    // The far corners, which are small beside this distance, join as well.
    assert_eq!(repairs.welded_vertices, 29);
    for distance in [-1.0, f64::NAN, f64::INFINITY] {
        let error = soup_of_points(&chain).weld(distance);
        assert!(matches!(error, Err(MeshError::BadDistance { .. })));
    }
}

/// Groups by comparing all pairs again and again.
fn groups_by_all_pairs(points: &[DVec3], distance: f64) -> Vec<usize> {
    let mut group: Vec<usize> = (0..points.len()).collect();
    loop {
        let before = group.clone();
        for i in 0..points.len() {
            for j in 0..points.len() {
                if points[i].distance_squared(points[j]) < distance * distance {
                    group[i] = group[i].min(group[j]);
                }
            }
        }
        if group == before {
            return group;
        }
    }
}

#[test]
fn crowded_vertices_weld_in_reasonable_time() {
    // Two crowds just not near each other, all pairs between them nearly at the limit.
    let crowd = |x: f64| {
        (0..20_000).map(move |i| dvec3(x, 1e-7 * f64::from(i % 141), 1e-7 * f64::from(i / 141)))
    };
    let points: Vec<_> = crowd(0.0).chain(crowd(1.0)).collect();
    let start = std::time::Instant::now();
    let (mesh, repairs) = soup_of_points(&points).weld(1.0).expect("welds");
    assert_eq!(repairs.welded_vertices, 2 * 19_999);
    assert_eq!(mesh.n_faces(), 40_000);
    assert!(start.elapsed().as_secs() < 20, "took {:?}", start.elapsed());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, ..ProptestConfig::default() })]

    #[test]
    fn welding_joins_just_what_all_pairs_join(
        coordinates in prop::collection::vec((0..12_i32, 0..6_i32, 0..3_i32), 1..60),
        tenths in 1..40_i32,
    ) {
        let distance = f64::from(tenths) / 10.0;
        let mut points: Vec<DVec3> = Vec::new();
        for (x, y, z) in coordinates {
            let point = dvec3(f64::from(x), f64::from(y), f64::from(z));
            if !points.contains(&point) {
                points.push(point);
            }
        }
        let (mesh, _) = soup_of_points(&points).weld(distance).expect("welds");
        let tips: Vec<_> = (0..points.len() as u32)
            .map(|face| mesh.positions()[mesh.face(face)[0] as usize])
            .collect();
        let expected: Vec<_> =
            groups_by_all_pairs(&points, distance).into_iter().map(|i| points[i]).collect();
        prop_assert_eq!(tips, expected);
    }
}
