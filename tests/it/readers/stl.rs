//! STL as programs really write it: nearly right, miscounted, colored.

use hiddenline::stages::read::{Fault, Notice};

use super::cube::{binary_stl, text_stl};
use super::{assert_message, good, refused};

/// Everything a model's warnings say.
fn said(name: &str, bytes: impl AsRef<[u8]>) -> Vec<String> {
    good(name, bytes).warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn odd_ends_and_beginnings_of_text_are_read_with_a_warning() {
    let text = text_stl(1);
    let expected = good("x.stl", &text).mesh;
    for (odd, warning) in [
        (text.replace("endsolid", "endsolidcube"), "a name joined to `endsolid`"),
        (text.replace("endsolid", "ENDSOLIDcube"), "a name joined to `endsolid`"),
        (text.replace("endsolid", "end solid"), "`end solid` is read as `endsolid`"),
        (text.replace("endsolid", "End Solid cube"), "`end solid` is read as `endsolid`"),
        (text.replace("endsolid", "end"), "`end solid` is read as `endsolid`"),
        (text.replace("endsolid", ""), "`endsolid` is missing at the end"),
        (format!("; made by x\n{text}"), "a comment before `solid` is skipped (line 1)"),
        (format!("\n# a\n# solid\n{text}"), "a comment before `solid` is skipped (line 2)"),
        (format!("// a\n{text}"), "a comment before `solid` is skipped (line 1)"),
    ] {
        for odd in [odd.clone(), odd.replace('\n', "\r\n")] {
            let model = good("x.stl", &odd);
            assert_eq!(model.mesh, expected, "{odd:?}");
            let warnings: Vec<_> = model.warnings.iter().map(ToString::to_string).collect();
            assert!(warnings.len() == 1 && warnings[0].contains(warning), "{warnings:?}");
        }
    }
    let two = text_stl(2).replacen("endsolid", "", 1);
    assert_eq!(good("x.stl", &two).mesh.n_faces(), 12);
    assert!(said("x.stl", two)[0].contains("`endsolid` is missing before `solid`"));
    // In the middle of a facet nothing is beyond doubt.
    let error = refused("x.stl", text.replacen("endloop", "", 1));
    assert_message(&error, "x.stl:8: ", "`endfacet` found");
    refused("x.stl", text.replacen("endsolid", "end loop", 1));
}

#[test]
fn text_is_never_taken_for_binary() {
    for text in ["hello world, this is no model at all", "<svg/>", "v 0 0 0\nf 1 1 1\n", "facet"] {
        let long = text.repeat(20);
        for text in [text, &long] {
            let error = refused("x.stl", text);
            assert_message(&error, "x.stl:1: ", "`solid` expected");
        }
    }
    for page in ["<!DOCTYPE html><html>", "\n<html lang=en>", "<!doctype HTML>"] {
        for name in ["x.stl", "x.obj", "x.glb", "x"] {
            assert!(matches!(refused(name, page).fault, Fault::WebPage), "{name}");
        }
    }
    let pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n";
    assert!(matches!(refused("x.stl", pointer).fault, Fault::LfsPointer));
}

#[test]
fn step_files_say_how_to_make_a_glb() {
    for (name, bytes) in [("part.step", "anything"), ("PART.STP", ""), ("part", "ISO-10303-21;\n")]
    {
        let bytes = if bytes.is_empty() { "x" } else { bytes };
        let error = refused(name, bytes);
        assert!(matches!(error.fault, Fault::Step));
        assert!(error.to_string().contains("FreeCAD"), "{error}");
        assert!(error.to_string().contains("cascadio.step_to_glb("), "{error}");
    }
}

#[test]
fn counts_that_disagree_with_the_size_are_told() {
    let with_count = |count: u32, n: usize| {
        let mut bytes = binary_stl(b"")[..84 + 50 * n].to_vec();
        bytes[80..84].copy_from_slice(&count.to_le_bytes());
        bytes
    };
    for (count, n) in [(0, 12), (12, 5), (u32::MAX, 1)] {
        let model = good("x.stl", with_count(count, n));
        assert_eq!(model.mesh.n_faces(), n);
        let (stated, present) = (u64::from(count), n as u64);
        let expected = Notice::WrongCount { stated, present, element: "triangle" };
        assert_eq!(model.warnings[0].notice, expected);
    }
    assert_eq!(
        said("x.stl", with_count(0, 12)),
        ["x.stl: the header says 0 triangles, the file holds 12; all of these are read"]
    );
    // Fewer than there are: facets like the others are read, anything else is not.
    let model = good("x.stl", with_count(10, 12));
    assert_eq!(model.mesh.n_faces(), 12);
    for junk in [[0x20; 100], [0; 100], [0x41; 100], std::array::from_fn(|k| (37 * k % 256) as u8)]
    {
        let model = good("x.stl", [with_count(12, 12), junk.to_vec()].concat());
        assert_eq!(model.mesh.n_faces(), 12);
        assert_eq!(model.warnings[0].notice, Notice::TrailingBytes { count: 100 });
    }
    let odd = [with_count(10, 12), vec![7]].concat();
    assert_eq!(good("x.stl", odd).mesh.n_faces(), 10);
    refused("x.stl", with_count(0, 0));
    let mut cut = with_count(12, 12);
    cut.truncate(84 + 50 * 7 + 20);
    let model = good("x.stl", cut);
    assert_eq!(model.mesh.n_faces(), 7);
    assert_eq!(model.warnings.len(), 2, "{:?}", model.warnings);
}

#[test]
fn degenerate_facets_are_told() {
    let text = text_stl(1);
    let facet = "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n";
    let short = text.replacen("solid\n", &format!("solid\n{facet}"), 1);
    let model = good("x.stl", &short);
    assert_eq!((model.mesh.n_faces(), model.repairs.degenerate_faces), (12, 1));
    assert_eq!(
        said("x.stl", short),
        ["x.stl: 1 face with fewer than three different corners left out, first on line 3"]
    );
    let equal = facet.replace("endloop", "vertex 0 0 0\nendloop");
    let equal = text.replacen("solid\n", &format!("solid\n{equal}"), 1);
    assert_eq!(
        said("x.stl", equal),
        ["x.stl: 1 face with fewer than three different corners left out"]
    );
    let mut binary = binary_stl(b"");
    binary.copy_within(84 + 12..84 + 24, 84 + 24);
    assert_eq!(good("x.stl", &binary).mesh.n_faces(), 11);
    assert_eq!(said("x.stl", binary).len(), 1);
}
