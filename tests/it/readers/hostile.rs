//! Files that say what is not so: vertices that are missing, counts that are too large, early ends.

use std::path::PathBuf;

use hiddenline::stages::read::{Fault, Notice, read_file};

use super::cube::{binary_stl, text_stl};
use super::{assert_message, good, read, refused};

#[test]
fn missing_vertices_are_named_in_every_format() {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for index in ["4", "-4", "99999999999999999999999", "-99999999999999999999999", "4/1/1"] {
        let index_shown = index.trim_end_matches("/1/1");
        for face in [format!("f 1 2 {index}"), format!("f 1 {index} # note"), format!("f\t{index}")]
        {
            let error = refused("x.obj", format!("{obj}{face}\nf 1 2 3\n"));
            assert_message(
                &error,
                "x.obj:4: ",
                &format!("vertex {index_shown}, but there are only 3"),
            );
        }
    }
    assert_message(&refused("x.obj", format!("{obj}f 1 2 0/1")), "x.obj:4: ", "vertex 0");
    assert_message(&refused("x.obj", format!("{obj}f 1 2 /3")), "x.obj:4: ", "`/3`");
    let off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
    assert_message(&refused("x.off", format!("{off}3 0 1 3")), "x.off:6: ", "vertex 3");
    assert_message(&refused("x.off", format!("{off}3 0 1 -1")), "x.off:6: ", "`-1`");
    assert_message(&refused("x.off", format!("{off}3 0 1")), "x.off:6: ", "3 numbers expected");
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
               property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n\
               0 0 0\n1 0 0\n0 1 0\n";
    assert_message(&refused("x.ply", format!("{ply}3 0 1 3\n")), "x.ply:13: ", "vertex 3");
    assert_message(&refused("x.ply", format!("{ply}3 0 1 -1\n")), "x.ply:13: ", "vertex -1");
    assert_message(&refused("x.ply", format!("{ply}3 0 1\n")), "x.ply:13: ", "");
    assert_message(&refused("x.ply", ply), "x.ply", "1 elements `face` expected");
    assert_message(
        &refused("x.ply", ply.replace("1 0 0", "1 1e999 0") + "3 0 1 2\n"),
        "x.ply:11: ",
        "not finite",
    );
    assert_message(
        &refused("x.ply", ply.replace("1 0 0", "1 nan 0") + "3 0 1 2\n"),
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
        refused("x.ply", ply("1", count, "uchar int", "ascii", b"0 0 0\n3 0 0 0\n"));
    }
    refused("x.ply", ply("99999999999999999999999", "1", "uchar int", "ascii", b"0 0 0\n"));
    refused("x.ply", ply("1", "1", "uint int", binary, &[0xFF; 40]));
    refused("x.ply", ply("1", "1", "int int", binary, &[0xFF; 40]));
    refused("x.ply", ply("1", "1", "uint int", "ascii", b"0 0 0\n4294967295 0\n"));
    refused("x.ply", ply("1", "1", "uint float", "ascii", b"0 0 0\n3 0 0 0\n"));
    for counts in ["4294967295 1 0", "1 4294967295 0", "18446744073709551615 1", "-1 1 0", "1"] {
        refused("x.off", format!("OFF\n{counts}\n0 0 0\n3 0 0 0\n"));
    }
    refused("x.off", "OFF\n1 1 0\n0 0 0\n18446744073709551615 0 0\n");
    let mut stl = binary_stl(b"");
    stl[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let present = Notice::WrongCount { stated: 4_294_967_295, present: 12, element: "triangle" };
    assert_eq!(good("x.stl", &stl).warnings[0].notice, present);
    refused("x.stl", &stl[..84]);
    stl[80..84].copy_from_slice(&11_u32.to_le_bytes());
    let expected = Notice::WrongCount { stated: 11, present: 12, element: "triangle" };
    assert_eq!(good("x.stl", &stl).warnings[0].notice, expected);
}

#[test]
fn stl_text_that_ends_early_is_refused() {
    let text = text_stl(1);
    for cut in (1..text.len() - 9).filter(|&cut| text.is_char_boundary(cut)) {
        let error = match read("x.stl", &text[..cut]) {
            Err(error) => error,
            // Between two facets the rest may as well be missing.
            Ok(model) => {
                let last = text[..cut].trim_end();
                let is_between = last.ends_with("endfacet") || cut > text.len() - 10;
                assert!(is_between && model.warnings.len() == 1, "{:?}", model.warnings);
                continue;
            }
        };
        assert!(
            matches!(
                error.fault,
                Fault::Truncated { .. }
                    | Fault::Unexpected { .. }
                    | Fault::BadNumber(_)
                    | Fault::NoFaces { .. }
            ),
            "{error}"
        );
    }
    let model = good("x.stl", format!("{text}\x1A"));
    assert_eq!(model.warnings[0].notice, Notice::TrailingBytes { count: 1 });
    let error = refused("x.stl", text.replacen("endloop", "endlop", 1));
    assert_message(&error, "x.stl:7: ", "`vertex` or `endloop` expected, `endlop` found");
}

#[test]
fn errors_and_names_stay_on_one_line() {
    let error = refused("a\nb.obj", "v 0 0 \x07\x1B[31m\n");
    assert_message(&error, "a b.obj:1: ", "");
    assert!(!error.to_string().contains('\x1B'));
    let error = read_file(&PathBuf::from("no/such/file.obj"), None).expect_err("no file");
    assert_message(&error, "no/such/file.obj: ", "cannot be read");
}

#[test]
fn names_of_numbers_in_ply_matter_only_where_they_are_used() {
    let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty double y\n\
                  property float z\nelement face 1\nproperty list uchar int vertex_index\n\
                  end_header\n";
    for name in ["nan", "NaN", "-nan", "inf", "-inf", "Infinity", "+INF"] {
        for unused in [format!("{name} 0 0"), format!("0 {name} 0"), format!("0 0 {name}")] {
            let vertices = format!("{header}0 0 0\n1 0 0\n1 1 0\n{unused}\n");
            let model = good("x.ply", format!("{vertices}3 0 1 2\n"));
            assert_eq!((model.mesh.n_faces(), model.repairs.unused_vertices), (1, 1), "{unused}");
            let error = refused("x.ply", format!("{vertices}3 0 1 3\n"));
            assert_message(&error, "x.ply:13: ", "not finite");
        }
    }
}
