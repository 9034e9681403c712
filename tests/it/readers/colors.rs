//! Colors of faces and vertices in PLY, OFF and STL.

use hiddenline::stages::model::mesh::Mesh;

use super::cube::binary_stl;
use super::good;

type Color = Option<[u8; 3]>;

fn colors(mesh: &Mesh) -> Vec<Color> {
    mesh.face_parts().iter().map(|&part| mesh.parts()[part as usize].color).collect()
}

#[test]
fn off_colors_of_faces_go_before_those_of_vertices() {
    let off = |head: &str, color: &str, faces: [&str; 2]| {
        let text = format!(
            "{head}\n4 2 0\n0 0 0 {color}\n1 0 0 {color}\n0 1 0 {color}\n1 1 0 255 255 255 9\n\
             3 0 1 2{}\n3 1 3 2{}\n",
            faces[0], faces[1]
        );
        colors(&good("x.off", text).mesh)
    };
    assert_eq!(off("OFF", "", ["", ""]), []);
    assert_eq!(off("OFF", "", [" 255 128 0", " 1.0 0.5 0 1"]), [Some([255, 128, 0]); 2]);
    assert_eq!(off("OFF", "", [" 7", " 0 0 9 255 # note"]), [None, Some([0, 0, 9])]);
    let mixed = Some([85, 255, 85]);
    assert_eq!(off("COFF", "0 255 0 255", ["", ""]), [Some([0, 255, 0]), mixed]);
    assert_eq!(off("COFF", "0 255 0", [" 1 2 3", ""]), [Some([1, 2, 3]), mixed]);
    assert_eq!(off("CNOFF", "0 0 1 0.0 1.0 0.0", ["", ""])[0], Some([0, 255, 0]));
    assert_eq!(off("OFF", "0 255 0", ["", ""]), [], "not announced");
}

#[test]
fn ply_colors_are_bytes_or_parts_of_one() {
    let ply = |of_vertex: &str, of_face: &str, vertex: [&str; 3], face: &str| {
        let properties = |list: &str| {
            let lines = list.split_whitespace().collect::<Vec<_>>();
            lines.chunks(2).map(|p| format!("property {} {}\n", p[0], p[1])).collect::<String>()
        };
        let [a, b, c] = vertex;
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
             property float z\n{}element face 1\nproperty list uchar int vertex_indices\n{}\
             end_header\n0 0 0 {a}\n1 0 0 {b}\n0 1 0 {c}\n3 0 1 2 {face}\n",
            properties(of_vertex),
            properties(of_face)
        );
        colors(&good("x.ply", text).mesh)
    };
    let bytes = "uchar red uchar green uchar blue";
    assert_eq!(ply("", bytes, ["", "", ""], "1 2 3"), [Some([1, 2, 3])]);
    assert_eq!(ply("", &format!("{bytes} uchar alpha"), [""; 3], "1 2 3 4"), [Some([1, 2, 3])]);
    let parts = "float red float green float blue";
    assert_eq!(ply("", parts, [""; 3], "1 0.5 0"), [Some([255, 128, 0])]);
    assert_eq!(ply(bytes, "", ["30 0 0", "0 60 0", "0 0 90"], ""), [Some([10, 20, 30])]);
    assert_eq!(ply(bytes, bytes, ["30 0 0"; 3], "7 8 9"), [Some([7, 8, 9])]);
    assert_eq!(ply("uchar red uchar green", "", ["1 2"; 3], ""), []);
    let diffuse = "uchar diffuse_red uchar diffuse_green uchar diffuse_blue";
    assert_eq!(ply(diffuse, "", ["3 3 3"; 3], ""), [Some([3, 3, 3])]);
}

#[test]
fn stl_colors_are_those_of_viscam_or_of_magics() {
    let colored = |header: &[u8], attributes: [u16; 3]| {
        let mut bytes = binary_stl(header);
        for (i, attribute) in attributes.into_iter().enumerate() {
            let at = 84 + 50 * i + 48;
            bytes[at..at + 2].copy_from_slice(&attribute.to_le_bytes());
        }
        colors(&good("x.stl", bytes).mesh)
    };
    assert_eq!(colored(b"", [0, 0, 0]), []);
    // Red is highest where the highest bit says that there is a color.
    let viscam = colored(b"", [0x8000 | 31 << 10, 0x8000 | 31, 31]);
    assert_eq!(viscam[..4], [Some([255, 0, 0]), Some([0, 0, 255]), None, None]);
    // Red is lowest where that bit is clear.
    let magics = colored(b"COLOR=\x10\x20\x30\xFF,MATERIAL=", [31, 31 << 10, 0x8000 | 31]);
    let expected = [Some([255, 0, 0]), Some([0, 0, 255]), Some([16, 32, 48]), Some([0, 0, 0])];
    assert_eq!(magics[..4], expected);
    assert_eq!(colored(b"", [0x8000 | 16, 0, 0])[0], Some([0, 0, 132]));
}
