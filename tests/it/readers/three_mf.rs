//! 3MF: placement, units, colors, and archives made to hurt.

use std::io::Write as _;

use glam::dvec3;
use hiddenline::stages::read::{Fault, ModelFormat};

use super::export::{Triangles, three_mf};
use super::{assert_message, good, refused};

const HEAD: &str = "<model xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
                    xmlns:m=\"m\" xmlns:p=\"p\" unit=\"inch\">";

const TETRA: &str = "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>\
                     <vertex x=\"0\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices>\
                     <triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\" \
                     pid=\"5\" p1=\"1\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\" pid=\"6\" p1=\"0\"/>\
                     <triangle v1=\"2\" v2=\"0\" v3=\"3\" p1=\"1\"/></triangles></mesh>";

fn archive(resources: &str, build: &str) -> Vec<u8> {
    let text = format!("{HEAD}<resources>{resources}</resources><build>{build}</build></model>");
    three_mf(&[("3D/3dmodel.model", &text)])
}

fn tetra(id: u32) -> String {
    format!("<object id=\"{id}\" name=\"tetra\" pid=\"5\" pindex=\"0\">{TETRA}</object>")
}

#[test]
fn items_and_components_are_placed_by_their_transforms() {
    let resources = tetra(1)
        + "<object id=\"2\"><components>\
           <component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 10 0 0\"/>\
           <component objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/></components></object>";
    let build =
        "<item objectid=\"2\" transform=\"0 2 0 -2 0 0 0 0 2 0 0 5\"/><item objectid=\"1\"/>";
    let model = good("x.3mf", archive(&resources, build));
    assert_eq!((model.format, model.unit_mm), (ModelFormat::ThreeMf, Some(25.4)));
    let mesh = model.mesh;
    assert_eq!(mesh.n_faces(), 12);
    // The vertex (1, 0, 0): moved to (11, 0, 0), then x becomes 2 y.
    assert!(mesh.positions().contains(&dvec3(0.0, 22.0, 5.0)));
    assert!(mesh.positions().contains(&dvec3(-2.0, 20.0, 5.0)));
    // All bodies look outwards, the mirrored one too.
    let volume: Vec<f64> = (0..3)
        .map(|body| {
            let faces = 4 * body..4 * body + 4;
            faces
                .map(|face| {
                    let [a, b, c] = *mesh.face(face).first_chunk::<3>().unwrap();
                    let [a, b, c] = [a, b, c].map(|v| mesh.positions()[v as usize]);
                    a.dot(b.cross(c)) / 6.0
                })
                .sum()
        })
        .collect();
    for (found, expected) in volume.iter().zip([8.0 / 6.0, 8.0 / 6.0, 1.0 / 6.0]) {
        assert!((found - expected).abs() < 1e-9, "{volume:?}");
    }
}

#[test]
fn base_materials_and_color_groups_give_colors() {
    let resources = "<basematerials id=\"5\"><base name=\"red\" displaycolor=\"#FF0000\"/>\
                     <base name=\"half\" displaycolor=\"#00FF0080\"/></basematerials>\
                     <m:colorgroup id=\"6\"><m:color color=\"#0000FFFF\"/></m:colorgroup>"
        .to_owned()
        + &tetra(1);
    let mesh = good("x.3mf", archive(&resources, "<item objectid=\"1\"/>")).mesh;
    let of = |face: usize| {
        let part = &mesh.parts()[mesh.face_parts()[face] as usize];
        (part.group.as_str(), part.material.as_str(), part.color)
    };
    assert_eq!(of(0), ("tetra", "red", Some([255, 0, 0])));
    assert_eq!(of(1), ("tetra", "half", Some([0, 255, 0])));
    assert_eq!(of(2), ("tetra", "", Some([0, 0, 255])));
    assert_eq!(of(3), of(1), "without a group the object's counts");
}

#[test]
fn units_are_those_of_the_file() {
    for (unit, mm) in [
        ("micron", 0.001),
        ("millimeter", 1.0),
        ("centimeter", 10.0),
        ("inch", 25.4),
        ("foot", 304.8),
        ("meter", 1000.0),
    ] {
        let text = Triangles::house().model_xml(unit);
        assert_eq!(good("x.3mf", three_mf(&[("3D/m.model", &text)])).unit_mm, Some(mm));
    }
    let text = Triangles::house().model_xml("cubit");
    assert_message(&refused("x.3mf", three_mf(&[("m", &text)])), "x.3mf: ", "`cubit`");
}

#[test]
fn objects_may_be_in_parts_of_their_own() {
    let root = format!(
        "{HEAD}<resources><object id=\"9\"><components><component objectid=\"1\" \
         p:path=\"/3D/Objects/o.model\"/></components></object></resources>\
         <build><item objectid=\"9\"/></build></model>"
    );
    let other = Triangles::house().model_xml("millimeter");
    let parts = [("3D/3dmodel.model", root.as_str()), ("3D/Objects/o.model", &other)];
    let mesh = good("x", three_mf(&parts)).mesh;
    assert_eq!(mesh.n_faces(), 16);
    assert_message(&refused("x", three_mf(&parts[..1])), "x: ", "3D/Objects/o.model is missing");
}

#[test]
fn cycles_and_floods_of_components_are_refused() {
    let component = |id: u32| format!("<component objectid=\"{id}\"/>");
    let object = |id: u32, components: &str| {
        format!("<object id=\"{id}\"><components>{components}</components></object>")
    };
    let item = "<item objectid=\"2\"/>";
    let own = object(2, &component(2));
    assert_message(&refused("x.3mf", archive(&own, item)), "x.3mf: ", "object 2 contains itself");
    let two = object(2, &component(3)) + &object(3, &component(2));
    assert_message(&refused("x.3mf", archive(&two, item)), "x.3mf: ", "object 2 contains itself");
    assert_message(&refused("x.3mf", archive("", item)), "x.3mf: ", "there is no object 2");
    // Ten of ten of ten …: a laugh of a billion.
    let flood: String =
        (2..14).map(|id| object(id, &component(id + 1).repeat(10))).collect::<String>()
            + &tetra(14);
    let error = refused("x.3mf", archive(&flood, item));
    assert!(matches!(error.fault, Fault::TooManyInstances), "{error}");
    let deep: String =
        (2..500).map(|id| object(id, &component(id + 1))).collect::<String>() + &tetra(500);
    let error = refused("x.3mf", archive(&deep, item));
    assert!(matches!(error.fault, Fault::TooManyInstances), "{error}");
}

#[test]
fn bombs_are_refused() {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Deflated);
    archive.start_file("3D/3dmodel.model", options).unwrap();
    archive.write_all(HEAD.as_bytes()).unwrap();
    for _ in 0..300 {
        archive.write_all(&[b' '; 1 << 18]).unwrap();
    }
    let bytes = archive.finish().unwrap().into_inner();
    assert!(bytes.len() < 1 << 18);
    let error = refused("x.3mf", &bytes);
    assert!(matches!(error.fault, Fault::TooMuchUnpacked), "{error}");

    let entities: String =
        (1..20).map(|i| format!("<!ENTITY e{i} \"&e{};&e{};\">", i - 1, i - 1)).collect();
    let text = format!("<!DOCTYPE m [<!ENTITY e0 \"ha\">{entities}]><model>&e19;</model>");
    assert_message(&refused("x.3mf", three_mf(&[("m", &text)])), "x.3mf: ", "not valid 3MF");
    let nested = "<a>".repeat(100_000) + &"</a>".repeat(100_000);
    let nested = format!("{HEAD}{nested}</model>");
    refused("x.3mf", three_mf(&[("m", &nested)]));
}

#[test]
fn extensions_that_add_to_the_shape_are_told() {
    let with = |attributes: &str| {
        let head = HEAD.replace("<model ", &format!("<model {attributes} "));
        let text = format!(
            "{head}<resources>{}</resources><build><item objectid=\"2\"/></build></model>",
            tetra(2)
        );
        let read = good("x.3mf", three_mf(&[("3D/3dmodel.model", &text)]));
        read.warnings.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let of =
        |name: &str| format!("xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/{name}\"");
    let beams = of("beamlattice/2017/02");
    let told = with(&format!("{beams} requiredextensions=\"p b\""));
    assert!(
        told.len() == 1 && told[0].contains("the extension Beam Lattice is not read"),
        "{told:?}"
    );
    assert!(with(&beams).is_empty());
    let production = of("production/2015/06");
    assert!(with(&format!("{production} requiredextensions=\"b m\"")).is_empty());
}

#[test]
fn what_is_missing_or_wrong_is_named() {
    // With the part and the line in it.
    let object =
        tetra(2).replacen("v1=\"0\"", "v1=\"4\"", 1).replace("<triangles>", "\n\n<triangles>");
    let error = refused("x.3mf", archive(&object, "<item objectid=\"2\"/>"));
    assert_message(&error, "x.3mf: ", "part 3D/3dmodel.model, line 3: ");
    for (from, to, part) in [
        ("v1=\"0\"", "v1=\"4\"", "vertex 4, but there are only 4"),
        ("v1=\"0\"", "v1=\"-1\"", "`-1` is not the number of a vertex"),
        ("v1=\"0\"", "w=\"0\"", "an element `triangle` lacks `v1`"),
        ("vertex x=\"0\"", "vertex x=\"wide\"", "`wide` is not a decimal number"),
        ("x=\"1\"", "x=\"nan\"", "`nan` is not a finite number"),
    ] {
        let object = tetra(2).replacen(from, to, 1);
        let error = refused("x.3mf", archive(&object, "<item objectid=\"2\"/>"));
        assert_message(&error, "x.3mf: ", part);
    }
    let item = "<item objectid=\"2\" transform=\"1 2 3\"/>";
    assert_message(&refused("x.3mf", archive(&tetra(2), item)), "x.3mf: ", "12 numbers expected");
    assert_message(&refused("x.3mf", archive(&tetra(2), "")), "x.3mf: ", "no vertices either");
    assert_message(&refused("x.3mf", b"PK\x03\x04"), "x.3mf: ", "not valid 3MF");
    assert_message(&refused("x.3mf", three_mf(&[("m", "<model")])), "x.3mf: ", "part m: ");
    let whole = archive(&tetra(2), "<item objectid=\"2\"/>");
    for cut in (0..whole.len()).step_by(7) {
        refused("x.3mf", &whole[..cut]);
    }
}
