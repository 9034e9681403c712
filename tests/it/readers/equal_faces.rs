//! Faces that a model gives twice: merged for drawings, kept for comparisons.

use glam::DVec3;
use hiddenline::stages::model::arrange::{Arrangement, Pose};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup, Repairs};
use proptest::prelude::*;

use super::good;

/// A mesh of the given borders over points that all differ.
fn mesh_of(faces: &[Vec<u32>]) -> Mesh {
    let n_points = faces.iter().flatten().max().map_or(0, |&most| most + 1);
    let positions =
        (0..n_points).map(|i| DVec3::new(f64::from(i), f64::from(i * i), 1.0)).collect();
    let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
    faces.iter().for_each(|face| soup.push_face(face));
    Mesh::new(soup).unwrap().0
}

fn merged(faces: &[Vec<u32>]) -> (Vec<Vec<u32>>, usize) {
    let mesh = mesh_of(faces);
    let (merged, repairs) = mesh.clone().merge_equal_faces();
    assert_eq!(repairs, Repairs { equal_faces: repairs.equal_faces, ..Repairs::default() });
    let kept = (0..merged.n_faces() as u32).map(|face| merged.face(face).to_vec()).collect();
    assert_eq!(merged.positions(), mesh.positions());
    (kept, repairs.equal_faces)
}

#[test]
fn borders_are_equal_wherever_they_start_and_whichever_way_they_run() {
    let square = vec![0, 1, 2, 3];
    for other in [vec![0, 1, 2, 3], vec![2, 3, 0, 1], vec![3, 2, 1, 0], vec![0, 3, 2, 1]] {
        assert_eq!(merged(&[square.clone(), other]), (vec![square.clone()], 1));
    }
    for other in [vec![0, 2, 1, 3], vec![0, 1, 2], vec![0, 1, 2, 4], vec![0, 1, 2, 3, 4]] {
        assert_eq!(merged(&[square.clone(), other.clone()]), (vec![square.clone(), other], 0));
    }
    // A keyhole passes two vertices twice.
    let keyhole = vec![0, 1, 2, 0, 3, 4, 5, 3];
    let turned = vec![3, 0, 1, 2, 0, 3, 4, 5];
    let back: Vec<u32> = turned.iter().rev().copied().collect();
    assert_eq!(merged(&[keyhole.clone(), turned, back]), (vec![keyhole], 2));
}

#[test]
fn a_part_given_twice_counts_once_and_keeps_its_first_material() {
    let part = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    let faces = "f 1 2 3\nf 1 2 4\n";
    let text = format!("{part}usemtl red\n{faces}{part}usemtl blue\nf 5 7 6\nf 8 5 6\nf 6 7 8\n");
    let mesh = good("x.obj", text).mesh;
    assert_eq!(mesh.n_faces(), 5, "the reader keeps them");
    let scene = Arrangement { merge_equal_faces: true, ..Arrangement::default() };
    let (mesh, repairs) = scene.arrange(vec![(mesh, Pose::default())]).unwrap();
    assert_eq!((mesh.n_faces(), repairs.equal_faces), (3, 2));
    let material = |face: usize| mesh.parts()[mesh.face_parts()[face] as usize].material.as_str();
    assert_eq!([0, 1, 2].map(material), ["red", "red", "blue"]);
}

proptest! {
    #[test]
    fn merging_keeps_the_first_of_each_border(
        faces in prop::collection::vec(prop::collection::vec(0..4_u32, 3..6), 1..12),
    ) {
        let mesh = mesh_of(&faces);
        // The canonical border: the least of all rotations of both directions.
        let canonical = |face: &[u32]| {
            let n = face.len();
            let ways = (0..n).flat_map(|start| {
                let ahead: Vec<u32> = (0..n).map(|i| face[(start + i) % n]).collect();
                let back: Vec<u32> = (0..n).map(|i| face[(start + n - i) % n]).collect();
                [ahead, back]
            });
            ways.min().unwrap()
        };
        let mut seen = std::collections::HashSet::new();
        let expected: Vec<Vec<u32>> = (0..mesh.n_faces() as u32)
            .map(|face| mesh.face(face).to_vec())
            .filter(|face| seen.insert(canonical(face)))
            .collect();
        let (merged, _) = mesh.merge_equal_faces();
        let kept: Vec<Vec<u32>> =
            (0..merged.n_faces() as u32).map(|face| merged.face(face).to_vec()).collect();
        prop_assert_eq!(kept, expected);
    }
}
