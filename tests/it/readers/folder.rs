//! The folder of real and malformed models beside the repository.

use hiddenline::stages::read::read_file;

use super::assert_message;
use crate::models;

#[test]
fn malformed_files_are_refused_with_place_and_reason() {
    let Some(models) = models::folder() else { return };
    for (file, line, part) in [
        ("ascii_missing_endloop.stl", Some(6), "ends early"),
        ("assimp_malformed.obj", Some(28), "vertex 0"),
        ("binary_junk.obj", None, "not OBJ text"),
        ("draco_inf_nan.obj", Some(1), "`inf` is not a finite number"),
        ("empty.obj", None, "empty"),
        ("empty.stl", None, "empty"),
        ("nan_vertex.stl", None, "not finite"),
        ("overflow_numbers.obj", Some(4), "`0x10` is not a decimal number"),
        ("tinyobj_invalid_face.obj", None, "all 2 faces have fewer than three"),
        ("tinyobj_invalid_relative_index.obj", Some(1), "vertex -4"),
        ("tinyobj_test_nan.obj", Some(12), "`nan` is not a finite number"),
        ("tinyobj_zero_face_index.obj", Some(16), "vertex 0"),
        ("tobj_invalid_index.obj", Some(12), "vertex 7, but there are only 6"),
        ("trimesh_points_only.obj", None, "8 points only"),
    ] {
        let path = models.join("malformed").join(file);
        let error = read_file(&path, None).expect_err(file);
        let place = line.map_or(String::new(), |line| format!(":{line}"));
        assert_message(&error, &format!("{}{place}: ", path.display()), part);
    }
}

#[test]
fn odd_but_sound_files_are_drawn() {
    let Some(models) = models::folder() else { return };
    for (file, vertices, faces, warnings) in [
        ("cr_only_lines.obj", 3, 1, &[][..]),
        ("line_continuation.obj", 3, 1, &[]),
        ("utf16_bom.obj", 3, 1, &[]),
        ("solid_header_binary.stl", 4, 4, &[]),
        ("trailing_bytes.stl", 4, 4, &["100 bytes after the end of the model ignored"]),
        (
            "two_vertex_face.obj",
            3,
            1,
            &["2 faces with fewer than three different corners left out, first on line 4"],
        ),
        (
            "truncated_binary.stl",
            4,
            2,
            &[
                "the header says 4 triangles, the file holds 2; all of these are read",
                "25 bytes after the end of the model ignored",
            ],
        ),
        ("trimesh_wireframe_only.obj", 8, 0, &[]),
        ("draco_deg_faces.obj", 5, 3, &["1 face with fewer than three different corners left out"]),
    ] {
        let path = models.join("malformed").join(file);
        let model = read_file(&path, None).unwrap_or_else(|error| panic!("refused: {error}"));
        assert_eq!(
            (model.mesh.positions().len(), model.mesh.n_faces()),
            (vertices, faces),
            "{file}"
        );
        let said: Vec<_> = model.warnings.iter().map(ToString::to_string).collect();
        let expected: Vec<_> =
            warnings.iter().map(|text| format!("{}: {text}", path.display())).collect();
        assert_eq!(said, expected, "{file}");
    }
}

#[test]
fn every_malformed_file_has_an_expectation() {
    let Some(models) = models::folder() else { return };
    let n_files = std::fs::read_dir(models.join("malformed")).map(Iterator::count);
    assert_eq!(n_files.ok(), Some(14 + 10));
}

#[test]
fn real_models_have_the_counts_of_their_index() {
    let Some(models) = models::folder() else { return };
    let index = std::fs::read_to_string(models.join("index.tsv")).expect("index.tsv");
    let mut n_models = 0;
    for row in index.lines().skip(1) {
        let columns: Vec<_> = row.split('\t').collect();
        let (Ok(vertices), Ok(faces)) = (columns[3].parse::<usize>(), columns[4].parse::<usize>())
        else {
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
        assert_eq!(n_vertices, distinct.unwrap_or(vertices), "vertices of {}", columns[0]);
        // Zero-area triangles with two equal corners are dropped.
        let dropped = model.repairs.degenerate_faces;
        assert_eq!(model.mesh.n_faces() + dropped, faces, "faces of {}", columns[0]);
        assert_eq!(model.repairs.unused_vertices, unused.unwrap_or(0), "unused in {}", columns[0]);
        assert_eq!(model.warnings.is_empty(), dropped == 0, "{:?}", model.warnings);
        n_models += 1;
    }
    assert_eq!(n_models, 27);
}
