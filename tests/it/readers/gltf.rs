//! glTF and GLB: geometry of all kinds, colors, buffers, and files made to hurt.

use std::fmt::Write as _;

use base64::Engine as _;
use glam::dvec3;
use hiddenline::stages::read::{Fault, ModelFormat, read_file};

use super::export::{Triangles, glb};
use super::{assert_message, good, refused};

/// A file over one buffer: a list of (JSON of a bufferView without buffer and offset, bytes).
#[derive(Default)]
struct Builder {
    buffer: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl Builder {
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.buffer.resize(self.buffer.len().next_multiple_of(4), 0);
        self.views.push(format!(
            r#"{{"buffer":0,"byteOffset":{},"byteLength":{}}}"#,
            self.buffer.len(),
            bytes.len()
        ));
        self.buffer.extend(bytes);
        self.views.len() - 1
    }

    fn accessor(&mut self, bytes: &[u8], component: u32, count: usize, kind: &str) -> usize {
        let view = self.view(bytes);
        self.accessors.push(format!(
            r#"{{"bufferView":{view},"componentType":{component},"count":{count},"type":"{kind}"}}"#
        ));
        self.accessors.len() - 1
    }

    fn points(&mut self, points: &[[f32; 3]]) -> usize {
        let bytes: Vec<u8> = points.as_flattened().iter().flat_map(|c| c.to_le_bytes()).collect();
        self.accessor(&bytes, 5126, points.len(), "VEC3")
    }

    fn finish(self, rest: &str) -> Vec<u8> {
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{}}}],
            "bufferViews":[{}],"accessors":[{}],{rest}}}"#,
            self.buffer.len(),
            self.views.join(","),
            self.accessors.join(",")
        );
        glb(&json, &self.buffer)
    }
}

const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// A file with one primitive over [`SQUARE`], given its attributes and more.
fn primitive(indices: Option<(&[u8], u32, usize)>, mode: u32) -> Vec<u8> {
    let mut builder = Builder::default();
    let points = builder.points(&SQUARE);
    let indices = indices.map(|(bytes, component, count)| {
        format!(r#","indices":{}"#, builder.accessor(bytes, component, count, "SCALAR"))
    });
    builder.finish(&format!(
        r#""nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[
        {{"attributes":{{"POSITION":{points}}},"mode":{mode}{}}}]}}]"#,
        indices.unwrap_or_default()
    ))
}

#[test]
fn indices_of_every_width_and_none_give_the_same_triangles() {
    let bytes = [0_u8, 1, 2, 0, 2, 3];
    let shorts: Vec<u8> = bytes.iter().flat_map(|&b| u16::from(b).to_le_bytes()).collect();
    let words: Vec<u8> = bytes.iter().flat_map(|&b| u32::from(b).to_le_bytes()).collect();
    let expected = good("x.glb", primitive(Some((&bytes, 5121, 6)), 4)).mesh;
    assert_eq!(expected.corners(), [0, 1, 2, 0, 2, 3]);
    // y up becomes z up.
    assert_eq!(expected.positions()[2], dvec3(1.0, 0.0, 1.0));
    assert_eq!(good("x.glb", primitive(Some((&shorts, 5123, 6)), 4)).mesh, expected);
    assert_eq!(good("x.glb", primitive(Some((&words, 5125, 6)), 4)).mesh, expected);
    assert_eq!(good("x.glb", primitive(None, 4)).mesh.corners(), [0, 1, 2]);
    let odd = Some((&words[..], 5126, 6));
    assert_message(&refused("x.glb", primitive(odd, 4)), "x.glb: ", "not unsigned integers");
}

#[test]
fn strips_fans_and_lines_of_all_modes_are_read() {
    assert_eq!(good("x.glb", primitive(None, 5)).mesh.corners(), [0, 1, 2, 2, 1, 3]);
    assert_eq!(good("x.glb", primitive(None, 6)).mesh.corners(), [0, 1, 2, 0, 2, 3]);
    assert_eq!(good("x.glb", primitive(None, 1)).mesh.wires(), [[0, 1], [2, 3]]);
    assert_eq!(good("x.glb", primitive(None, 2)).mesh.wires(), [[0, 1], [1, 2], [2, 3], [3, 0]]);
    assert_eq!(good("x.glb", primitive(None, 3)).mesh.wires(), [[0, 1], [1, 2], [2, 3]]);
    assert_message(&refused("x.glb", primitive(None, 0)), "x.glb: ", "4 points only");
    assert_message(&refused("x.glb", primitive(None, 7)), "x.glb: ", "unknown mode");
}

#[test]
fn nodes_are_placed_by_all_transforms_on_the_way_to_them() {
    let house = Triangles::house();
    let plain = good("x.glb", house.glb()).mesh;
    let place =
        |node: &str| good("x.glb", glb(&house.gltf_json(node, ""), &house.glb_buffer())).mesh;
    assert_eq!(place(r#","translation":[0,0,0],"rotation":[0,0,0,1],"scale":[1,1,1]"#), plain);
    let moved = place(r#","translation":[1,2,4]"#);
    assert_eq!(moved.positions()[0], plain.positions()[0] + dvec3(1.0, -4.0, 2.0));
    // A quarter turn around glTF's y is one around our z.
    let turned = place(r#","rotation":[0,0.70710678,0,0.70710678]"#);
    let at = plain.positions()[0];
    assert_eq!(turned.positions()[0], dvec3(-at.y, at.x, at.z));
    let scaled = place(r#","matrix":[2,0,0,0, 0,2,0,0, 0,0,2,0, 0,0,0,1]"#);
    assert_eq!(scaled.positions()[0], 2.0 * at);
    assert_eq!(scaled.corners(), plain.corners());
    // Mirrored bodies keep their outside.
    let mirrored = place(r#","scale":[-1,1,1]"#);
    assert_eq!(mirrored.positions()[0], at * dvec3(-1.0, 1.0, 1.0));
    let [a, b, c] = *mirrored.face(0).first_chunk::<3>().unwrap();
    let [p, q, r] = [a, b, c].map(|v| mirrored.positions()[v as usize]);
    assert!((q - p).cross(r - p).z < 0.0, "the floor looks down");
    let json = house.gltf_json(r#","translation":[1,0,0],"children":[1]"#, "");
    let json = json.replace(r#""meshes""#, r#""x":0,"meshes""#);
    let child = r#"{"mesh":0,"scale":[2,2,2],"name":"child"}],"x""#;
    let json = json.replace(
        r#"}],
            "x""#,
        &format!("}},{child}"),
    );
    let both = good("x.glb", glb(&json, &house.glb_buffer())).mesh;
    assert_eq!(both.n_faces(), 2 * plain.n_faces());
    let n = plain.positions().len();
    assert_eq!(both.positions()[n], 2.0 * at + dvec3(1.0, 0.0, 0.0));
    assert_eq!(both.parts()[1].group, "child");
}

#[test]
fn sparse_and_normalized_accessors_are_resolved() {
    let mut builder = Builder::default();
    let points = builder.points(&SQUARE);
    let places = builder.view(&[3, 0, 1, 0]);
    let values: Vec<u8> =
        [7.0_f32, 0.0, 0.0, 0.0, 9.0, 0.0].iter().flat_map(|c| c.to_le_bytes()).collect();
    let values = builder.view(&values);
    let sparse = format!(
        r#","sparse":{{"count":2,"indices":{{"bufferView":{places},"componentType":5123}},
        "values":{{"bufferView":{values}}}}}}}"#
    );
    let accessor = builder.accessors[points].trim_end_matches('}').to_owned();
    builder.accessors[points] = accessor + &sparse;
    let rest = r#""nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":6}]}]"#;
    let mesh = good("x.glb", builder.finish(rest)).mesh;
    assert_eq!(mesh.positions()[3], dvec3(7.0, 0.0, 0.0));
    assert_eq!(mesh.positions()[1], dvec3(0.0, 0.0, 9.0));

    let mut builder = Builder::default();
    let shorts: Vec<u8> =
        [0_i16, 0, 0, 32767, 0, 0, 0, -32768, 0].iter().flat_map(|c| c.to_le_bytes()).collect();
    let points = builder.accessor(&shorts, 5122, 3, "VEC3");
    builder.accessors[points] =
        builder.accessors[points].replace(r#""count""#, r#""normalized":true,"count""#);
    let rest = r#""extensionsRequired":["KHR_mesh_quantization"],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]"#;
    let mesh = good("x.glb", builder.finish(rest)).mesh;
    assert_eq!(mesh.positions()[1..], [dvec3(1.0, 0.0, 0.0), dvec3(0.0, 0.0, -1.0)]);
}

#[test]
fn materials_and_normals_are_kept() {
    let mut builder = Builder::default();
    builder.points(&SQUARE);
    let normals =
        builder.points(&[[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 3.0, 4.0], [0.0, 1.0, 0.0]]);
    let rest = format!(
        r#""materials":[{{"name":"red","pbrMetallicRoughness":{{"baseColorFactor":[1,0.2158605,0,1]}}}},
        {{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],
        "nodes":[{{"mesh":0,"name":"plate"}}],"meshes":[{{"name":"m","primitives":[
        {{"attributes":{{"POSITION":0,"NORMAL":{normals}}},"mode":6,"material":0}},
        {{"attributes":{{"POSITION":0}},"mode":6,"material":1}},
        {{"attributes":{{"POSITION":0}},"mode":6}}]}}]"#
    );
    let model = good("x.glb", builder.finish(&rest));
    let parts: Vec<_> = model
        .mesh
        .parts()
        .iter()
        .map(|part| (part.group.as_str(), part.material.as_str(), part.color))
        .collect();
    let expected =
        [("plate", "red", Some([255, 128, 0])), ("plate", "material 1", None), ("plate", "", None)];
    assert_eq!(parts, expected);
    assert_eq!(model.mesh.face_parts(), [0, 0, 1, 1, 2, 2]);
    assert_eq!(model.unit_mm, Some(1000.0));
    let normals = model.mesh.corner_normals();
    assert_eq!(normals.len(), model.mesh.corners().len());
    // The third point's normal, at length one and z up.
    assert_eq!(normals[2], [0.0, -0.8, 0.6]);
    assert_eq!(normals[6..], [[0.0; 3]; 12]);
}

#[test]
fn normals_stay_at_right_angles_to_faces_that_are_stretched_and_turned() {
    let corners = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0_f32]];
    let normal = [6.0 / 7.0, 3.0 / 7.0, 2.0 / 7.0_f32];
    for transform in [
        r#""scale":[1,1,5]"#,
        r#""scale":[0.5,3,2],"rotation":[0.1,0.2,0.3,0.9]"#,
        r#""matrix":[1,0,0,0, 0.7,1,0,0, -0.4,0.9,1,0, 0,0,0,1]"#,
    ] {
        let mut builder = Builder::default();
        builder.points(&corners);
        let normals = builder.points(&[normal; 3]);
        let model = good(
            "x.glb",
            builder.finish(&format!(
                r#""nodes":[{{"mesh":0,{transform}}}],"meshes":[{{"primitives":[
                {{"attributes":{{"POSITION":0,"NORMAL":{normals}}}}}]}}]"#
            )),
        );
        let positions = model.mesh.positions();
        let [a, b, c] = [0, 1, 2].map(|k| positions[model.mesh.face(0)[k] as usize]);
        let expected = (b - a).cross(c - a).normalize();
        for found in model.mesh.corner_normals() {
            let found = dvec3(found[0].into(), found[1].into(), found[2].into());
            assert!(found.distance(expected) < 1e-6, "{transform}: {found}, not {expected}");
        }
        assert_eq!(model.mesh.corner_normals().len(), 3);
    }
}

#[test]
fn buffers_are_read_from_data_and_from_the_folder_of_the_model_only() {
    let house = Triangles::house();
    let expected = good("x.glb", house.glb()).mesh;
    let encoded = base64::engine::general_purpose::STANDARD.encode(house.glb_buffer());
    for media in ["application/octet-stream", "application/gltf-buffer"] {
        let uri = format!(r#","uri":"data:{media};base64,{encoded}""#);
        let model = good("x.gltf", house.gltf_json("", &uri));
        assert_eq!((model.mesh, model.format), (expected.clone(), ModelFormat::Gltf));
    }
    let bad = house.gltf_json("", r#","uri":"data:text/plain,hello""#);
    assert_message(&refused("x.gltf", bad), "x.gltf: ", "not base64");

    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir(at("in")).unwrap();
    std::fs::create_dir(at("in/sub")).unwrap();
    for place in ["outside.bin", "in/a b.bin", "in/sub/b.bin"] {
        std::fs::write(at(place), house.glb_buffer()).unwrap();
    }
    let read = |uri: &str| {
        let json = house.gltf_json("", &format!(r#","uri":"{uri}""#));
        std::fs::write(at("in/model.gltf"), json).unwrap();
        read_file(&at("in/model.gltf"), None)
    };
    assert_eq!(read("a%20b.bin").unwrap().mesh, expected);
    assert_eq!(read("sub/b.bin").unwrap().mesh, expected);
    let absolute = at("outside.bin").display().to_string();
    for uri in [
        "../outside.bin",
        "sub/../../outside.bin",
        "%2e%2e/outside.bin",
        &absolute,
        "http://example.com/a.bin",
        "file:///etc/passwd",
    ] {
        let error = read(uri).unwrap_err();
        assert!(matches!(error.fault, Fault::BufferElsewhere(_)), "{error}");
    }
    for uri in ["missing.bin", "sub"] {
        let error = read(uri).unwrap_err();
        assert!(matches!(error.fault, Fault::MissingBuffer { .. }), "{error}");
        assert!(error.to_string().contains("put it there, or export the model as .glb"));
    }
    let json = house.gltf_json("", r#","uri":"a%20b.bin""#);
    assert!(matches!(refused("x.gltf", json).fault, Fault::BufferWithoutFolder(_)));
}

#[test]
fn compressed_files_name_what_to_do() {
    let house = Triangles::house();
    for extension in ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_future"] {
        let required = format!(r#"{{"extensionsRequired":["{extension}"],"#);
        let json = house.gltf_json("", "").replacen('{', &required, 1);
        let error = refused("x.glb", glb(&json, &house.glb_buffer()));
        assert_message(&error, "x.glb: ", extension);
        assert_message(&error, "x.glb: ", "gltf-transform copy");
    }
    let harmless = r#"{"extensionsRequired":["KHR_materials_unlit","KHR_texture_transform"],"#;
    let json = house.gltf_json("", "").replacen('{', harmless, 1);
    good("x.glb", glb(&json, &house.glb_buffer()));
    // A fallback buffer without data.
    let json = house.gltf_json("", "").replacen(r#""bufferView":0,"#, "", 1);
    assert_message(&refused("x.glb", glb(&json, &house.glb_buffer())), "x.glb: ", "compressed");
}

#[test]
fn references_and_counts_beyond_what_is_there_are_refused() {
    let house = Triangles::house();
    let buffer = house.glb_buffer();
    let json = house.gltf_json("", "");
    for (from, to) in [
        (r#""scene":0"#, r#""scene":7"#),
        (r#""nodes":[0]"#, r#""nodes":[7]"#),
        (r#""nodes":[0]"#, r#""nodes":[0,0]"#),
        (r#""mesh":0"#, r#""mesh":7"#),
        (r#""mesh":0"#, r#""mesh":0,"children":[0]"#),
        (r#""mesh":0"#, r#""mesh":0,"children":[9]"#),
        (r#""POSITION":0"#, r#""POSITION":7"#),
        (r#""POSITION":0"#, r#""POSITION":1"#),
        (r#""indices":1"#, r#""indices":0"#),
        (r#""indices":1"#, r#""indices":1,"material":3"#),
        (r#""bufferView":1"#, r#""bufferView":9"#),
        (r#""buffer":0"#, r#""buffer":9"#),
        (r#""count":10"#, r#""count":9"#),
        (r#""count":10"#, r#""count":4000000000"#),
        (r#""count":10"#, r#""count":18446744073709551615"#),
        (r#""bufferView":0"#, r#""bufferView":0,"byteOffset":18446744073709551615"#),
        (r#""bufferView":0"#, r#""bufferView":0,"byteOffset":4"#),
        (r#""buffer":0,"#, r#""buffer":0,"byteStride":252,"#),
        (r#""buffer":0,"#, r#""buffer":0,"byteOffset":9999999999999999,"#),
        (r#""type":"VEC3""#, r#""type":"VEC9""#),
        (r#""componentType":5126"#, r#""componentType":1"#),
        (r#""version":"2.0""#, r#""version":"1.0""#),
    ] {
        assert!(json.contains(from), "{from}");
        let bytes = glb(&json.replacen(from, to, 1), &buffer);
        assert_message(&refused("x.glb", bytes), "x.glb: ", "");
    }
    // Many nodes of one mesh are fine; a flood of them is not read.
    let nodes = |n: usize| {
        let mut list = "[".to_owned();
        (0..n).for_each(|i| write!(list, "{i}{}", if i + 1 < n { "," } else { "]" }).unwrap());
        let nodes = vec![r#"{"mesh":0}"#; n].join(",");
        let json = json.replace(r#""nodes":[0]"#, &format!(r#""nodes":{list}"#));
        glb(&json.replace(r#"[{"mesh":0}]"#, &format!("[{nodes}]")), &buffer)
    };
    assert_eq!(good("x.glb", nodes(100)).mesh.n_faces(), 1600);
    let error = refused("x.glb", nodes(300_000));
    assert!(matches!(error.fault, Fault::TooManyInstances), "{error}");
}

#[test]
fn what_is_left_out_is_told_and_a_count_that_is_too_large_is_named() {
    let told = |bytes: Vec<u8>| {
        good("x.glb", bytes).warnings.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let one =
        "x.glb: 1 vertex number at the end of a list left out: they make no whole triangle or line";
    assert_eq!(told(primitive(None, 4)), [one]);
    assert!(told(primitive(None, 1)).is_empty() && told(primitive(None, 5)).is_empty());
    let house = Triangles::house();
    let json = house.gltf_json("", "");
    let used = json.replacen('{', r#"{"extensionsUsed":["EXT_mesh_gpu_instancing"],"#, 1);
    let told = told(glb(&used, &house.glb_buffer()));
    assert!(told.len() == 1 && told[0].contains("EXT_mesh_gpu_instancing is not read"), "{told:?}");
    for count in ["4000000000", "18446744073709551615"] {
        let json = json.replacen(r#""count":10"#, &format!(r#""count":{count}"#), 1);
        let error = refused("x.glb", glb(&json, &house.glb_buffer()));
        assert!(matches!(error.fault, Fault::Truncated { .. }), "{error}");
    }
}

#[test]
fn glb_chunks_may_be_cut_but_not_short() {
    let whole = Triangles::house().glb();
    for cut in 0..whole.len() {
        let result = super::read("x.glb", &whole[..cut]);
        assert!(result.is_err() || cut >= whole.len() - 3, "{cut} of {}", whole.len());
    }
    let mut version = whole.clone();
    version[4] = 1;
    assert_message(&refused("x.glb", version), "x.glb: ", "version 1");
    let json = Triangles::house().gltf_json("", "");
    assert_eq!(good("model", &whole).format, ModelFormat::Gltf);
    assert_message(&refused("model", json), "model: ", "holds 0 bytes");
}
