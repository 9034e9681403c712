//! Model files: what is read, what is refused, what is skipped with a word.

use std::fmt::Write as _;
use std::path::PathBuf;

use glam::{DVec3, dvec3};
use hiddenline::mesh::{Mesh, MeshError, PolygonSoup};
use hiddenline::read::{Fault, Model, ModelFormat, Notice, ReadError, read_bytes, read_file};
use proptest::prelude::*;

fn read(name: &str, bytes: impl AsRef<[u8]>) -> Result<Model, ReadError> {
    read_bytes(name, bytes.as_ref(), None)
}

#[track_caller]
fn good(name: &str, bytes: impl AsRef<[u8]>) -> Model {
    read(name, bytes).unwrap_or_else(|error| panic!("refused: {error}"))
}

#[track_caller]
fn refused(name: &str, bytes: impl AsRef<[u8]>) -> ReadError {
    match read(name, bytes) {
        Ok(model) => panic!("{name} was read: {} faces", model.mesh.n_faces()),
        Err(error) => error,
    }
}

#[track_caller]
fn assert_message(error: &ReadError, begin: &str, part: &str) {
    let message = error.to_string();
    assert!(
        message.starts_with(begin),
        "`{message}` does not begin with `{begin}`"
    );
    assert!(message.contains(part), "`{message}` does not say `{part}`");
    assert!(
        !message.contains('\n'),
        "`{message}` has more than one line"
    );
}

/// The folder of real models beside the repository, if it is there.
fn models() -> Option<PathBuf> {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/models"));
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: {} is missing", folder.display());
    None
}

#[test]
fn malformed_files_are_refused_with_place_and_reason() {
    let Some(models) = models() else { return };
    for (file, line, part) in [
        ("ascii_missing_endloop.stl", Some(6), "ends early"),
        ("assimp_malformed.obj", Some(28), "vertex 0"),
        ("binary_junk.obj", None, "not OBJ text"),
        ("count_too_big.stl", None, "4294967295 triangles expected"),
        ("draco_inf_nan.obj", Some(1), "`inf` is not a finite number"),
        ("empty.obj", None, "empty"),
        ("empty.stl", None, "empty"),
        ("nan_vertex.stl", None, "not finite"),
        (
            "overflow_numbers.obj",
            Some(2),
            "`1e400` is not a finite number",
        ),
        (
            "tinyobj_invalid_face.obj",
            None,
            "all 2 faces have fewer than three",
        ),
        ("tinyobj_invalid_relative_index.obj", Some(1), "vertex -4"),
        (
            "tinyobj_test_nan.obj",
            Some(12),
            "`nan` is not a finite number",
        ),
        ("tinyobj_zero_face_index.obj", Some(16), "vertex 0"),
        (
            "tobj_invalid_index.obj",
            Some(12),
            "vertex 7, but there are only 6",
        ),
        ("trimesh_points_only.obj", None, "8 points only"),
        ("trimesh_wireframe_only.obj", None, "12 line records only"),
        (
            "truncated_binary.stl",
            None,
            "4 triangles expected, there are bytes for 2",
        ),
    ] {
        let path = models.join("malformed").join(file);
        let error = read_file(&path, None).expect_err(file);
        let place = line.map_or(String::new(), |line| format!(":{line}"));
        assert_message(&error, &format!("{}{place}: ", path.display()), part);
    }
}

#[test]
fn odd_but_sound_files_are_drawn() {
    let Some(models) = models() else { return };
    for (file, vertices, faces, warnings) in [
        ("cr_only_lines.obj", 3, 1, &[][..]),
        ("line_continuation.obj", 3, 1, &[]),
        ("utf16_bom.obj", 3, 1, &[]),
        ("solid_header_binary.stl", 4, 4, &[]),
        (
            "trailing_bytes.stl",
            4,
            4,
            &["100 bytes after the end of the model ignored"],
        ),
        (
            "two_vertex_face.obj",
            3,
            1,
            &["2 faces with fewer than three different corners left out, first on line 4"],
        ),
        (
            "draco_deg_faces.obj",
            5,
            3,
            &["1 face with fewer than three different corners left out"],
        ),
    ] {
        let path = models.join("malformed").join(file);
        let model = read_file(&path, None).unwrap_or_else(|error| panic!("refused: {error}"));
        assert_eq!(
            (model.mesh.positions().len(), model.mesh.n_faces()),
            (vertices, faces),
            "{file}"
        );
        let said: Vec<_> = model.warnings.iter().map(ToString::to_string).collect();
        let expected: Vec<_> = warnings
            .iter()
            .map(|text| format!("{}: {text}", path.display()))
            .collect();
        assert_eq!(said, expected, "{file}");
    }
}

#[test]
fn every_malformed_file_has_an_expectation() {
    let Some(models) = models() else { return };
    let n_files = std::fs::read_dir(models.join("malformed")).map(Iterator::count);
    assert_eq!(n_files.ok(), Some(17 + 7));
}

#[test]
fn real_models_have_the_counts_of_their_index() {
    let Some(models) = models() else { return };
    let index = std::fs::read_to_string(models.join("index.tsv")).expect("index.tsv");
    let mut n_models = 0;
    for row in index.lines().skip(1) {
        let columns: Vec<_> = row.split('\t').collect();
        let (Ok(vertices), Ok(faces)) = (columns[3].parse(), columns[4].parse::<usize>()) else {
            continue;
        };
        // The index counts the vertices of an OBJ file before equal ones are welded.
        let distinct = columns[6]
            .split("; ")
            .find_map(|property| property.strip_suffix(" distinct positions")?.parse().ok());
        let unused = columns[6]
            .split("; ")
            .find_map(|property| property.strip_suffix(" unused vertices")?.parse().ok());
        let model = read_file(&models.join(columns[0]), None).expect(columns[0]);
        let n_vertices = model.mesh.positions().len();
        assert_eq!(
            n_vertices,
            distinct.unwrap_or(vertices),
            "vertices of {}",
            columns[0]
        );
        // Zero-area triangles with two equal corners are dropped.
        let dropped = model.repairs.degenerate_faces;
        assert_eq!(
            model.mesh.n_faces() + dropped,
            faces,
            "faces of {}",
            columns[0]
        );
        assert_eq!(
            model.repairs.unused_vertices,
            unused.unwrap_or(0),
            "unused in {}",
            columns[0]
        );
        assert_eq!(
            model.warnings.is_empty(),
            dropped == 0,
            "{:?}",
            model.warnings
        );
        n_models += 1;
    }
    assert_eq!(n_models, 27);
}

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
const CUBE_FACES: [[u32; 4]; 6] = [
    [0, 1, 2, 3],
    [4, 5, 6, 7],
    [0, 1, 5, 4],
    [1, 2, 6, 5],
    [2, 3, 7, 6],
    [3, 0, 4, 7],
];

fn cube() -> Mesh {
    let mut soup = PolygonSoup {
        positions: CUBE.map(DVec3::from_array).to_vec(),
        ..PolygonSoup::default()
    };
    CUBE_FACES.iter().for_each(|face| soup.push_face(face));
    Mesh::new(soup).expect("a cube").0
}

/// The cube with positions as single precision has them, each quad cut into two triangles.
fn single_precision_triangles() -> Mesh {
    let positions = CUBE
        .map(|p| DVec3::from_array(p.map(|c| f64::from(c as f32))))
        .to_vec();
    let mut soup = PolygonSoup {
        positions,
        ..PolygonSoup::default()
    };
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
        for head in [
            "OFF\n8 6 12",
            "OFF 8 6 12",
            "COFF\n# comment\n\n8 6 0",
            "8 6",
        ] {
            let text = format!("{head}{line_end}{body}");
            assert_eq!(good("cube.off", &text).mesh, cube, "{text:?}");
        }
    }
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for list in ["uchar int vertex_indices", "uint uchar vertex_index"] {
            assert_eq!(
                good("cube.ply", ply_cube(encoding, list)).mesh,
                cube,
                "{encoding} {list}"
            );
        }
    }
    let from_text = ply_cube("ascii", "uchar int vertex_indices");
    let carriage_returns = from_text
        .iter()
        .map(|&c| if c == b'\n' { b'\r' } else { c });
    assert_eq!(
        good("cube.ply", carriage_returns.collect::<Vec<_>>()).mesh,
        cube
    );
}

fn ply_cube(encoding: &str, list: &str) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {encoding} 1.0\ncomment a cube\nelement vertex 8\nproperty uchar red\n\
         property double x\nproperty double y\nproperty double z\nelement face 6\n\
         property list {list}\nproperty float quality\nelement nothing 3000000000\nend_header\n"
    )
    .into_bytes();
    if encoding == "ascii" {
        let text = String::from_utf8(bytes)
            .expect("text")
            .replace("element nothing 3000000000\n", "");
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

fn binary_stl(header: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(12_u32.to_le_bytes());
    for [a, b, c, d] in CUBE_FACES {
        for triangle in [[a, b, c], [a, c, d]] {
            bytes.extend([0xFF; 12]);
            for corner in triangle {
                CUBE[corner as usize]
                    .iter()
                    .for_each(|&c| bytes.extend((c as f32).to_le_bytes()));
            }
            bytes.extend([0, 0]);
        }
    }
    bytes
}

fn text_stl(solids: usize) -> String {
    let mut text = String::new();
    for (i, [a, b, c, d]) in CUBE_FACES.into_iter().enumerate() {
        if i % (6 / solids) == 0 {
            text.push_str("solid\n");
        }
        for triangle in [[a, b, c], [a, c, d]] {
            text.push_str(" facet normal nan 0 -0\n  outer loop\n");
            for [x, y, z] in triangle.map(|corner| CUBE[corner as usize]) {
                let (x, y, z) = (
                    f64::from(x as f32),
                    f64::from(y as f32),
                    f64::from(z as f32),
                );
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
        assert_eq!(
            good("cube.stl", binary_stl(header)).mesh,
            cube,
            "{header:?}"
        );
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
        assert_eq!(
            (mesh.positions(), mesh.corners()),
            (cube.positions(), cube.corners())
        );
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
        (
            b"# a comment\nNOFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n".to_vec(),
            ModelFormat::Off,
        ),
        (one.as_bytes().to_vec(), ModelFormat::Obj),
        (
            format!("\n# OFF\n\nmtllib x\n{one}").into_bytes(),
            ModelFormat::Obj,
        ),
    ] {
        for name in ["<stdin>", "model", "model.txt", "obj"] {
            assert_eq!(good(name, &bytes).format, format);
        }
    }
    assert_message(
        &refused("x", "hello world"),
        "x: ",
        "cannot tell the format",
    );
    assert_message(&refused("x", "\0\0\0"), "x: ", "cannot tell the format");
    assert_eq!(good("MODEL.OBJ", one).format, ModelFormat::Obj);
    assert!(read_bytes("x.stl", one.as_bytes(), Some(ModelFormat::Obj)).is_ok());
}

#[test]
fn obj_comments_end_before_lines_are_joined() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
    for (faces, expected) in [
        ("f 1 2 3 \\\n4\n", &[4][..]),
        ("f 1 2 3\\\n4\n", &[4]),
        ("f 1 2 3 \\ \t\r\n4\n", &[4]),
        ("f 1 2 3 \\\n\\\n\\\n4", &[4]),
        ("f 1 2 3 \\", &[3]),
        ("f 1 2 3#4 \\\n", &[3]),
        ("f 1 2 3 # \\\nf 1 3 4\n", &[3, 3]),
        ("# \\\nf 1 2 3\n", &[3]),
        ("f \\\n1 2 \\\n# \\\nf 1 2 3\n", &[3]),
        ("xyz \\\nf 1 2 3\nf 2 3 4\n", &[3]),
    ] {
        let model = good("x.obj", format!("{vertices}{faces}"));
        let sizes: Vec<_> = model
            .mesh
            .face_starts()
            .windows(2)
            .map(|w| w[1] - w[0])
            .collect();
        assert_eq!(sizes, expected, "{faces:?}");
    }
    // Lines are counted as the file has them.
    let error = refused(
        "x.obj",
        format!("{vertices}\\\n\\\n# \\\nf 1 2 \\\r\n 3 \\\r\n 5 6"),
    );
    assert_message(&error, "x.obj:10: ", "vertex 6, but there are only 4");
    let error = refused("x.obj", format!("{vertices}f 1 2 3 \\\n\\\nx"));
    assert_message(&error, "x.obj:7: ", "`x` is not the number of a vertex");
}

#[test]
fn obj_numbers_are_the_nearest_doubles() {
    for word in [
        "0.1",
        "+0.1",
        "-.5",
        "5.",
        "1e-400",
        "1E+300",
        "123456789012345678901234567890",
        "0.1000000000000000055511151231257827021181583404541015625001",
        "9007199254740993",
        "2.2250738585072011e-308",
        "1.7976931348623158e308",
        "8.98846567431158e307",
        "6.02214076E23",
    ] {
        let value: f64 = word.parse().expect(word);
        for (name, text) in [
            (
                "x.obj",
                format!("v 3 0 {word}\nv 1 0 0 0.5 7\nv 0 1 0 1 0 0 9\nf 1 2 3\n"),
            ),
            (
                "x.off",
                format!("OFF\n3 1 0\n3 0 {word}\n1 0 0 0.5\n0 1 0 1 0 0\n3 0 1 2 255 0 0\n"),
            ),
            (
                "x.stl",
                format!(
                    "solid\nfacet outer loop vertex 3 0 {word} vertex 1 0 0 vertex 0 1 0 \
                     endloop endfacet endsolid"
                ),
            ),
        ] {
            let positions = good(name, text).mesh.positions().to_vec();
            let expected = [
                dvec3(3.0, 0.0, value),
                dvec3(1.0, 0.0, 0.0),
                dvec3(0.0, 1.0, 0.0),
            ];
            assert_eq!(positions, expected, "{word} in {name}");
        }
    }
    let zeros = "0".repeat(400);
    for (word, part) in [
        ("1e400", "not a finite number"),
        ("-inf", "not a finite number"),
        ("NaN", "not a finite number"),
        (&format!("1{zeros}"), "not a finite number"),
        ("0x10", "not a decimal number"),
        ("1,5", "not a decimal number"),
        ("1e", "not a decimal number"),
        (".", "not a decimal number"),
        ("--1", "not a decimal number"),
        ("1.2.3", "not a decimal number"),
        ("1.#IND", "3 numbers expected"),
    ] {
        // Refused even where no face uses the vertex.
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n\nv 0 {word} 0\nf 1 2 3\n");
        assert_message(&refused("x.obj", text), "x.obj:5: ", part);
    }
    assert_message(
        &refused("x.obj", "v 1 2\nf 1 1 1"),
        "x.obj:1: ",
        "3 numbers expected for a vertex, 2 found",
    );
    let long = good(
        "x.obj",
        format!("v 1{zeros}e-400 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3"),
    );
    assert_eq!(long.mesh.positions()[0], dvec3(1.0, 0.0, 0.0));
}

#[test]
fn obj_groups_and_materials_become_parts_in_file_order() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no  my  box # note\nusemtl red#1\nf 1 2 3\n\
                f 3 2 1\ng lid\nf 1 2 3\no my box\nf 1 2 3\ng unused\n";
    let mesh = good("x.obj", text).mesh;
    let parts: Vec<_> = mesh
        .parts()
        .iter()
        .map(|p| (p.group.as_str(), p.material.as_str()))
        .collect();
    assert_eq!(parts, [("", ""), ("my box", "red#1"), ("lid", "red#1")]);
    assert_eq!(mesh.face_parts(), [0, 1, 1, 2, 1]);
    assert_eq!(mesh.positions().len(), 3);
    let plain = good("x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").mesh;
    assert!(plain.parts().is_empty() && plain.face_parts().is_empty());
}

#[test]
fn what_obj_readers_skip_they_say() {
    let text = "vp 1 2\nl 1 2\ncurv 0 1 \\\n 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvp 3\np 1\nf 1 2 3\n";
    let model = good("x.obj", text);
    let said: Vec<_> = model.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        said,
        [
            "x.obj: 2 records of lines or points left out, first on line 2",
            "x.obj: unknown record `vp` skipped (2 times, first on line 1)",
            "x.obj: unknown record `curv` skipped (1 time, first on line 3)",
        ]
    );
    let many: String = (0..1000).map(|i| format!("junk{i}\n")).collect();
    let model = good(
        "x.obj",
        format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n{many}"),
    );
    assert_eq!(model.warnings.len(), 7);
    assert_eq!(
        model.warnings[6].notice,
        Notice::OtherUnknownRecords { count: 994 }
    );
}

#[test]
fn missing_vertices_are_named_in_every_format() {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for index in [
        "4",
        "-4",
        "99999999999999999999999",
        "-99999999999999999999999",
        "4/1/1",
    ] {
        let index_shown = index.trim_end_matches("/1/1");
        for face in [
            format!("f 1 2 {index}"),
            format!("f 1 {index} # note"),
            format!("f\t{index}"),
        ] {
            let error = refused("x.obj", format!("{obj}{face}\nf 1 2 3\n"));
            assert_message(
                &error,
                "x.obj:4: ",
                &format!("vertex {index_shown}, but there are only 3"),
            );
        }
    }
    assert_message(
        &refused("x.obj", format!("{obj}f 1 2 0/1")),
        "x.obj:4: ",
        "vertex 0",
    );
    assert_message(
        &refused("x.obj", format!("{obj}f 1 2 /3")),
        "x.obj:4: ",
        "`/3`",
    );
    let off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
    assert_message(
        &refused("x.off", format!("{off}3 0 1 3")),
        "x.off:6: ",
        "vertex 3",
    );
    assert_message(
        &refused("x.off", format!("{off}3 0 1 -1")),
        "x.off:6: ",
        "`-1`",
    );
    assert_message(
        &refused("x.off", format!("{off}3 0 1")),
        "x.off:6: ",
        "3 numbers expected",
    );
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
               property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n\
               0 0 0\n1 0 0\n0 1 0\n";
    assert_message(
        &refused("x.ply", format!("{ply}3 0 1 3\n")),
        "x.ply:13: ",
        "vertex 3",
    );
    assert_message(
        &refused("x.ply", format!("{ply}3 0 1 -1\n")),
        "x.ply:13: ",
        "vertex -1",
    );
    assert_message(&refused("x.ply", format!("{ply}3 0 1\n")), "x.ply:13: ", "");
    assert_message(
        &refused("x.ply", ply),
        "x.ply",
        "1 elements `face` expected",
    );
    assert_message(
        &refused("x.ply", ply.replace("1 0 0", "1 1e999 0")),
        "x.ply:11: ",
        "not finite",
    );
    assert_message(
        &refused("x.ply", ply.replace("1 0 0", "1 nan 0")),
        "x.ply:11: ",
        "",
    );
    let model = good("x.ply", format!("{ply}3 0 1 2\n\nmore"));
    assert_eq!(model.warnings[0].notice, Notice::TrailingBytes { count: 4 });
}

#[test]
fn hostile_counts_are_refused_without_memory_for_them() {
    let ply = |vertices: &str, faces: &str, list: &str, format: &str, body: &[u8]| {
        let head = format!(
            "ply\nformat {format} 1.0\nelement vertex {vertices}\nproperty float x\n\
             property float y\nproperty float z\nelement face {faces}\n\
             property list {list} vertex_indices\nend_header\n"
        );
        [head.as_bytes(), body].concat()
    };
    let binary = "binary_little_endian";
    for count in ["4000000000", "4294967295", "18446744073709551615"] {
        refused("x.ply", ply(count, "1", "uchar int", binary, &[0; 100]));
        refused("x.ply", ply(count, "1", "uchar int", "ascii", b"0 0 0\n"));
        refused("x.ply", ply("1", count, "uchar int", binary, &[0; 12]));
        refused("x.ply", ply("1", count, "uchar int", binary, &[0; 100_000]));
        refused(
            "x.ply",
            ply("1", count, "uchar int", "ascii", b"0 0 0\n3 0 0 0\n"),
        );
    }
    refused(
        "x.ply",
        ply(
            "99999999999999999999999",
            "1",
            "uchar int",
            "ascii",
            b"0 0 0\n",
        ),
    );
    refused("x.ply", ply("1", "1", "uint int", binary, &[0xFF; 40]));
    refused("x.ply", ply("1", "1", "int int", binary, &[0xFF; 40]));
    refused(
        "x.ply",
        ply("1", "1", "uint int", "ascii", b"0 0 0\n4294967295 0\n"),
    );
    refused(
        "x.ply",
        ply("1", "1", "uint float", "ascii", b"0 0 0\n3 0 0 0\n"),
    );
    for counts in [
        "4294967295 1 0",
        "1 4294967295 0",
        "18446744073709551615 1",
        "-1 1 0",
        "1",
    ] {
        refused("x.off", format!("OFF\n{counts}\n0 0 0\n3 0 0 0\n"));
    }
    refused("x.off", "OFF\n1 1 0\n0 0 0\n18446744073709551615 0 0\n");
    let mut stl = binary_stl(b"");
    stl[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(matches!(
        refused("x.stl", &stl).fault,
        Fault::Truncated { .. }
    ));
    stl[80..84].copy_from_slice(&0_u32.to_le_bytes());
    assert!(matches!(
        refused("x.stl", &stl).fault,
        Fault::NoFaces { .. }
    ));
    stl[80..84].copy_from_slice(&11_u32.to_le_bytes());
    assert_eq!(
        good("x.stl", &stl).warnings[0].notice,
        Notice::TrailingBytes { count: 50 }
    );
}

#[test]
fn stl_text_that_ends_early_is_refused() {
    let text = text_stl(1);
    for cut in (1..text.len() - 9).filter(|&cut| text.is_char_boundary(cut)) {
        let error = refused("x.stl", &text[..cut]);
        assert!(
            matches!(
                error.fault,
                Fault::Truncated { .. } | Fault::Unexpected { .. } | Fault::BadNumber(_)
            ),
            "{error}"
        );
    }
    let model = good("x.stl", format!("{text}\x1A"));
    assert_eq!(model.warnings[0].notice, Notice::TrailingBytes { count: 1 });
    let error = refused("x.stl", text.replacen("endloop", "endlop", 1));
    assert_message(
        &error,
        "x.stl:7: ",
        "`vertex` or `endloop` expected, `endlop` found",
    );
}

#[test]
fn errors_and_names_stay_on_one_line() {
    let error = refused("a\nb.obj", "v 0 0 \x07\x1B[31m\n");
    assert_message(&error, "a b.obj:1: ", "");
    assert!(!error.to_string().contains('\x1B'));
    let error = read_file(&PathBuf::from("no/such/file.obj"), None).expect_err("no file");
    assert_message(&error, "no/such/file.obj: ", "cannot be read");
}

fn soup_of_points(points: &[DVec3]) -> Mesh {
    // Each point becomes the tip of its own triangle, far from all others.
    let mut soup = PolygonSoup::default();
    for (i, &point) in points.iter().enumerate() {
        let far = 1e6 * (1 + i) as f64;
        let first = soup.positions.len() as u32;
        soup.positions
            .extend([point, dvec3(far, 2e6, 0.0), dvec3(far, 0.0, 2e6)]);
        soup.push_face(&[first, first + 1, first + 2]);
    }
    Mesh::new(soup).expect("finite").0
}

#[test]
fn near_vertices_become_the_first_of_them_over_chains_too() {
    let chain: Vec<_> = (0..10)
        .map(|i| dvec3(f64::from(i) * 0.75, 0.0, 0.0))
        .collect();
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
    assert_eq!(
        count(
            &chain.iter().map(|p| p * 1e-200).collect::<Vec<_>>(),
            0.76e-200
        )
        .1,
        9
    );
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

fn seeds() -> Vec<(&'static str, Vec<u8>)> {
    let obj = "mtllib a.mtl\no a\nusemtl b\nv 0 0 0 # c\nv 1 \\\n 0 0 1 1 1\nv 0 1e0 0\nv .5 -5 +5\n\
               vn 0 0 1\nf 1//1 2/1/1 -2\r\nf 1 2 3 4\nl 1 2\nvp 1\nf 1 2\n";
    vec![
        ("x.obj", obj.as_bytes().to_vec()),
        (
            "x.off",
            b"COFF # c\n4 2 0\n0 0 0 1\n1 0 0\n\n0 1 0\n1 1 1\n4 0 1 3 2 0 0 1\n3 0 1 2\n".to_vec(),
        ),
        ("x.stl", binary_stl(b"solid x")[..84 + 3 * 50].to_vec()),
        ("x.stl", text_stl(3).into_bytes()),
        ("x.ply", ply_cube("ascii", "uchar int vertex_indices")),
        (
            "x.ply",
            ply_cube("binary_little_endian", "uchar int vertex_indices"),
        ),
        (
            "x.ply",
            ply_cube("binary_big_endian", "uint uchar vertex_index"),
        ),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, ..ProptestConfig::default() })]

    #[test]
    fn damaged_files_never_panic(
        seed in 0..7_usize,
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0..5_u8, any::<u8>()), 1..8),
        named in any::<bool>(),
    ) {
        let (name, mut bytes) = seeds().swap_remove(seed);
        for (place, kind, byte) in edits {
            if bytes.is_empty() {
                break;
            }
            let at = place.index(bytes.len());
            let length = usize::from(byte % 32).min(bytes.len() - at);
            match kind {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, *b"0 9-\\\n\r#/e.fv\0\xFF".get(usize::from(byte) % 16).unwrap_or(&b'1')),
                2 => drop(bytes.drain(at..at + length)),
                3 => bytes.extend_from_within(at..at + length),
                _ => bytes.truncate(at),
            }
        }
        let result = read_bytes(if named { name } else { "x" }, &bytes, None);
        match result {
            Ok(model) => {
                prop_assert!(model.mesh.n_faces() > 0);
                prop_assert!(model.mesh.positions().iter().all(|p| p.is_finite()));
                prop_assert!(model.mesh.face_parts().iter().all(|&p| (p as usize) < model.mesh.parts().len()));
                prop_assert!(model.warnings.iter().all(|w| !w.to_string().contains('\n')));
            }
            Err(error) => prop_assert!(!error.to_string().contains('\n')),
        }
    }

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
