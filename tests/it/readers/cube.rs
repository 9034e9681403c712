//! One cube in every format and many ways of writing it.

use std::fmt::Write as _;

use glam::DVec3;
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::read::{ModelFormat, read_bytes};

use super::{assert_message, good, refused};

const CUBE: [[f64; 3]; 8] = [
    [0.1, -1.5, 0.0],
    [1.0, -1.5, 0.0],
    [1.0, 2.25, 0.0],
    [0.1, 2.25, 0.0],
    [0.1, -1.5, 1e-3],
    [1.0, -1.5, 1e-3],
    [1.0, 2.25, 1e-3],
    [0.1, 2.25, 1e-3],
];

/// Quads, named so that vertices are first used in their own order.
const CUBE_FACES: [[u32; 4]; 6] =
    [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

fn cube() -> Mesh {
    let mut soup =
        PolygonSoup { positions: CUBE.map(DVec3::from_array).to_vec(), ..PolygonSoup::default() };
    CUBE_FACES.iter().for_each(|face| soup.push_face(face));
    Mesh::new(soup).expect("a cube").0
}

/// The cube with positions as single precision has them, each quad cut into two triangles.
fn single_precision_triangles() -> Mesh {
    let positions = CUBE.map(|p| DVec3::from_array(p.map(|c| f64::from(c as f32)))).to_vec();
    let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
    for [a, b, c, d] in CUBE_FACES {
        soup.push_face(&[a, b, c]);
        soup.push_face(&[a, c, d]);
    }
    Mesh::new(soup).expect("a cube").0
}

fn obj_cube(line_end: &str, corner: impl Fn(u32) -> String) -> String {
    let mut text = String::new();
    for [x, y, z] in CUBE {
        write!(text, "v {x} {y} {z:e}{line_end}").expect("text");
    }
    for face in CUBE_FACES {
        write!(text, "f {}{line_end}", face.map(&corner).join(" ")).expect("text");
    }
    text
}

#[test]
fn one_cube_written_in_many_ways_is_one_mesh() {
    let cube = cube();
    let absolute = |c: u32| format!("{}", c + 1);
    let mut texts = vec![
        obj_cube("\n", absolute),
        obj_cube("\r\n", absolute),
        obj_cube("\r", absolute),
        obj_cube("  # comment\n", absolute),
        obj_cube(" \\\n\n", absolute),
        obj_cube("\n", |c| format!("{}", i64::from(c) - 8)),
        obj_cube("\n", |c| format!("{}/99/-7", c + 1)),
        obj_cube("\n", |c| format!("{}//1", c + 1)),
        obj_cube("\n", |c| format!("\\\n +{}/", c + 1)),
        obj_cube("\n", absolute).replace(' ', "\t \t"),
        obj_cube("\nvn nan 0\nvt\nmtllib a b\ns off\n", absolute),
        obj_cube(" # \\\n", absolute),
        format!("\u{FEFF}{}", obj_cube("\n", absolute)),
        obj_cube("\n", absolute).trim_end().to_owned(),
    ];
    let (vertices, faces) = texts[0].split_at(texts[0].find('f').expect("a face"));
    texts.push(format!("{faces}{vertices}"));
    for text in texts {
        assert_eq!(good("cube.obj", &text).mesh, cube, "{text:?}");
        let marked = format!("\u{FEFF}{}", text.trim_start_matches('\u{FEFF}'));
        let utf16: Vec<u8> = marked.encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!(good("cube.obj", utf16).mesh, cube, "{text:?} in UTF-16");
    }
    for line_end in ["\n", "\r\n", "\r", "# comment\n", "\n\n"] {
        let mut body = String::new();
        for [x, y, z] in CUBE {
            write!(body, "{x} {y} {z:e}{line_end}").expect("text");
        }
        for face in CUBE_FACES {
            let [a, b, c, d] = face;
            write!(body, "4 {a} {b} {c} {d}{line_end}").expect("text");
        }
        for head in ["OFF\n8 6 12", "OFF 8 6 12", "COFF\n# comment\n\n8 6 0", "8 6"] {
            let text = format!("{head}{line_end}{body}");
            assert_eq!(good("cube.off", &text).mesh, cube, "{text:?}");
        }
    }
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for list in ["uchar int vertex_indices", "uint uchar vertex_index"] {
            assert_eq!(good("cube.ply", ply_cube(encoding, list)).mesh, cube, "{encoding} {list}");
        }
    }
    let from_text = ply_cube("ascii", "uchar int vertex_indices");
    let carriage_returns = from_text.iter().map(|&c| if c == b'\n' { b'\r' } else { c });
    assert_eq!(good("cube.ply", carriage_returns.collect::<Vec<_>>()).mesh, cube);
}

pub(super) fn ply_cube(encoding: &str, list: &str) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {encoding} 1.0\ncomment a cube\nelement vertex 8\nproperty uchar red\n\
         property double x\nproperty double y\nproperty double z\nelement face 6\n\
         property list {list}\nproperty float quality\nelement nothing 3000000000\nend_header\n"
    )
    .into_bytes();
    if encoding == "ascii" {
        let text =
            String::from_utf8(bytes).expect("text").replace("element nothing 3000000000\n", "");
        bytes = text.replace("double", "float").into_bytes();
        for [x, y, z] in CUBE {
            bytes.extend(format!("255 {x} {y} {z:e}\n").bytes());
        }
        for [a, b, c, d] in CUBE_FACES {
            bytes.extend(format!("4 {a} {b} {c} {d} 0.5\n").bytes());
        }
        return bytes;
    }
    let is_little = encoding == "binary_little_endian";
    let mut put = |number: &[u8]| {
        let mut number = number.to_vec();
        if !is_little {
            number.reverse();
        }
        bytes.extend(number);
    };
    for point in CUBE {
        put(&[255]);
        point.iter().for_each(|c| put(&c.to_le_bytes()));
    }
    for face in CUBE_FACES {
        if list.starts_with("uchar") {
            put(&[4]);
            face.iter().for_each(|c| put(&c.to_le_bytes()));
        } else {
            put(&4_u32.to_le_bytes());
            face.iter().for_each(|&c| put(&[c as u8]));
        }
        put(&0.5_f32.to_le_bytes());
    }
    bytes
}

pub(super) fn binary_stl(header: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(12_u32.to_le_bytes());
    for [a, b, c, d] in CUBE_FACES {
        for triangle in [[a, b, c], [a, c, d]] {
            bytes.extend([0xFF; 12]);
            for corner in triangle {
                CUBE[corner as usize].iter().for_each(|&c| bytes.extend((c as f32).to_le_bytes()));
            }
            bytes.extend([0, 0]);
        }
    }
    bytes
}

pub(super) fn text_stl(solids: usize) -> String {
    let mut text = String::new();
    for (i, [a, b, c, d]) in CUBE_FACES.into_iter().enumerate() {
        if i % (6 / solids) == 0 {
            text.push_str("solid\n");
        }
        for triangle in [[a, b, c], [a, c, d]] {
            text.push_str(" facet normal nan 0 -0\n  outer loop\n");
            for [x, y, z] in triangle.map(|corner| CUBE[corner as usize]) {
                let (x, y, z) = (f64::from(x as f32), f64::from(y as f32), f64::from(z as f32));
                writeln!(text, "   vertex {x} {y} {z:E}").expect("text");
            }
            text.push_str("  endloop\n endfacet\n");
        }
        if i % (6 / solids) == 6 / solids - 1 {
            text.push_str("endsolid\n");
        }
    }
    text
}

#[test]
fn one_cube_written_as_stl_of_any_kind_is_one_mesh() {
    let cube = single_precision_triangles();
    for header in [&b""[..], b"solid", b"solid facet normal 0 0 0\n", b"\0\xFF"] {
        assert_eq!(good("cube.stl", binary_stl(header)).mesh, cube, "{header:?}");
    }
    let text = text_stl(1);
    for text in [
        text.clone(),
        text.to_uppercase().replace("NAN", "1.#IND"),
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        text.replace('\n', " \t\n\n"),
        text.trim_end().to_owned(),
    ] {
        assert_eq!(good("cube.stl", &text).mesh, cube, "{text:?}");
    }
    for solids in [2, 3] {
        let mesh = good("cube.stl", text_stl(solids)).mesh;
        assert_eq!((mesh.positions(), mesh.corners()), (cube.positions(), cube.corners()));
        assert_eq!(mesh.parts().len(), solids);
        assert_eq!(mesh.face_parts()[11] as usize, solids - 1);
    }
}

#[test]
fn content_tells_the_format_where_the_name_does_not() {
    let one = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let ply = ply_cube("ascii", "uchar int vertex_indices");
    for (bytes, format) in [
        (binary_stl(b""), ModelFormat::Stl),
        (text_stl(1).into_bytes(), ModelFormat::Stl),
        (ply, ModelFormat::Ply),
        (b"# a comment\nNOFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n".to_vec(), ModelFormat::Off),
        (one.as_bytes().to_vec(), ModelFormat::Obj),
        (format!("\n# OFF\n\nmtllib x\n{one}").into_bytes(), ModelFormat::Obj),
    ] {
        for name in ["<stdin>", "model", "model.txt", "obj"] {
            assert_eq!(good(name, &bytes).format, format);
        }
    }
    assert_message(&refused("x", "hello world"), "x: ", "cannot tell the format");
    assert_message(&refused("x", "\0\0\0"), "x: ", "cannot tell the format");
    assert_eq!(good("MODEL.OBJ", one).format, ModelFormat::Obj);
    assert!(read_bytes("x.stl", one.as_bytes(), Some(ModelFormat::Obj)).is_ok());
}

#[test]
fn whole_numbers_in_ply_keep_their_range() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty ushort x\nproperty short y\n\
                property uchar z\nelement face 1\nproperty list uchar ushort vertex_indices\n\
                end_header\n40000 -5 200\n65535 1 0\n0 -30000 255\n3 0 1 2\n";
    let mesh = good("range.ply", text).mesh;
    let expected = [[40000.0, -5.0, 200.0], [65535.0, 1.0, 0.0], [0.0, -30000.0, 255.0]];
    assert_eq!(mesh.positions(), expected.map(DVec3::from_array));
}
