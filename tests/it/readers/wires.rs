//! Polylines of OBJ and edges of PLY: wires over the vertices of the mesh.

use glam::{DVec3, dvec3};
use hiddenline::stages::model::arrange::{Arrangement, Pose};
use hiddenline::stages::model::mesh::{Mesh, MeshError, PolygonSoup};

use super::{assert_message, good, refused};

const POINTS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 5\n";

/// The ends of all wires.
fn ends(mesh: &Mesh) -> Vec<[DVec3; 2]> {
    mesh.wires().iter().map(|wire| wire.map(|v| mesh.positions()[v as usize])).collect()
}

#[test]
fn obj_polylines_become_segments() {
    let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::Y, dvec3(0.0, 0.0, 5.0)];
    for (lines, expected) in [
        ("l 1 2\n", vec![[a, b]]),
        ("l 1 2 3 4\n", vec![[a, b], [b, c], [c, d]]),
        ("l -1/7 \\\n 1/9 # note\n", vec![[d, a]]),
        ("l 4 4\nl 3\nl\nl 4 1\n", vec![[d, a]]),
    ] {
        for text in [
            format!("{POINTS}f 1 2 3\n{lines}"),
            format!("{POINTS}{lines}f 1 2 3\n"),
            format!("{POINTS}usemtl a\nf 1 2 3\n{lines}"),
        ] {
            let model = good("x.obj", &text);
            assert_eq!((ends(&model.mesh), model.mesh.n_faces()), (expected.clone(), 1), "{text}");
            assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        }
        let alone = good("x.obj", format!("{POINTS}{lines}")).mesh;
        assert_eq!((ends(&alone), alone.n_faces()), (expected, 0));
    }
    for (line, part) in
        [("l 1 9", "vertex 9"), ("l 1 0", "no vertex 0"), ("l 1 x", "`x`"), ("l -5 1", "vertex -5")]
    {
        assert_message(&refused("x.obj", format!("{POINTS}{line}\n")), "x.obj:5: ", part);
    }
    assert_message(&refused("x.obj", format!("{POINTS}l 1 1\n")), "x.obj: ", "4 points only");
}

#[test]
fn ply_edges_become_wires() {
    let ply = |faces: usize, edges: &[[i32; 2]]| {
        let mut text = format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
             property float z\nelement edge {}\nproperty int vertex1\nproperty int vertex2\n\
             property uchar red\n",
            edges.len()
        );
        if faces > 0 {
            text += "element face 1\nproperty list uchar int vertex_indices\n";
        }
        text += "end_header\n0 0 0\n1 0 0\n0 1 0\n";
        edges.iter().for_each(|[a, b]| text += &format!("{a} {b} 7\n"));
        if faces > 0 { text + "3 0 1 2\n" } else { text }
    };
    let model = good("x.ply", ply(1, &[[0, 2], [2, 1]]));
    assert_eq!(ends(&model.mesh), [[DVec3::ZERO, DVec3::Y], [DVec3::Y, DVec3::X]]);
    assert_eq!(good("x.ply", ply(0, &[[0, 1]])).mesh.wires().len(), 1);
    assert_message(&refused("x.ply", ply(1, &[[0, 3]])), "x.ply:17: ", "vertex 3");
    assert_message(&refused("x.ply", ply(1, &[[0, -1]])), "x.ply:17: ", "vertex -1");
    assert_message(&refused("x.ply", ply(0, &[])), "x.ply: ", "3 points only");
}

#[test]
fn wires_keep_their_vertices_through_merging_and_arranging() {
    let wire = good("x.obj", "v 5 5 5\nv 0 0 0\nv 1 0 0\nl 2 3\n").mesh;
    let triangle = good("x.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n").mesh;
    let moved = Pose { scale: 2.0, move_by: dvec3(-1.0, 0.0, 0.0), ..Pose::default() };
    let models = vec![(triangle, Pose::default()), (wire.clone(), moved)];
    let (mesh, repairs) = Arrangement::default().arrange(models).unwrap();
    assert_eq!(ends(&mesh), [[dvec3(-1.0, 0.0, 0.0), DVec3::X]]);
    assert_eq!((mesh.positions().len(), repairs.welded_vertices), (4, 1));
    let (welded, repairs) = wire.weld(2.0).unwrap();
    assert_eq!((welded.wires().len(), repairs.dropped_wires), (0, 1));
    let soup = PolygonSoup {
        positions: vec![DVec3::ZERO, DVec3::NAN],
        wires: vec![[0, 1]],
        ..PolygonSoup::default()
    };
    assert_eq!(Mesh::new(soup).unwrap_err(), MeshError::NotFinite { vertex: 1 });
}

#[test]
fn vertices_that_are_not_finite_matter_only_where_they_are_used() {
    for number in ["nan", "inf", "-Inf", "NaN", "1e999", "1.#IND", "-1.#QNAN", "1.#INF00"] {
        let points = format!("{POINTS}v 1 {number} 0\n");
        let model = good("x.obj", format!("{points}f 1 2 3\nl 3 4\n"));
        assert_eq!(model.repairs.unused_vertices, 1, "{number}");
        for uses in ["f 1 2 5", "l 1 5", "f 1 2 -1", "f 5/1 1 2"] {
            let error = refused("x.obj", format!("{points}f 1 2 3\n{uses}\n"));
            assert_message(&error, "x.obj:5: ", &format!("`{number}` is not a finite number"));
        }
    }
    let off = |face: &str| format!("OFF\n4 1 0\n0 0 0\n1 0 0\nnan 0 1e999\n0 1 0\n{face}\n");
    assert_eq!(good("x.off", off("3 0 1 3")).repairs.unused_vertices, 1);
    assert_message(&refused("x.off", off("3 0 1 2")), "x.off:5: ", "`nan` is not a finite");
    let ply = |corner: u8| {
        let mut bytes =
            b"ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n\
            property float y\nproperty float z\nelement face 1\n\
            property list uchar uchar vertex_indices\nend_header\n"
                .to_vec();
        let points = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, f32::NAN, 0.0, 0.0, 1.0, 0.0];
        bytes.extend(points.iter().flat_map(|c| c.to_le_bytes()));
        bytes.extend([3, 0, 1, corner]);
        bytes
    };
    assert_eq!(good("x.ply", ply(3)).repairs.unused_vertices, 1);
    assert_message(&refused("x.ply", ply(2)), "x.ply: ", "vertex 3 has a coordinate");
}

#[test]
fn off_keywords_may_be_joined_to_counts_and_in_any_case() {
    let rest = " 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for head in ["OFF3", "off\n3", "Off 3", "COFF3", "coff # c\n3", "OFF\n\n3", "off3"] {
        assert_eq!(good("x.off", format!("{head}{rest}")).mesh.n_faces(), 1, "{head}");
        assert_eq!(good("x", format!("{head}{rest}")).mesh.n_faces(), 1, "{head}");
    }
    for head in ["OFFx3", "xOFF 3", "4OFF 3", "OFF BINARY\n3", "nOFF3"] {
        refused("x.off", format!("{head}{rest}"));
    }
}
