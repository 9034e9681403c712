//! Writers of model files, each after its format's specification and without the readers' code.

use std::fmt::Write as _;

/// Triangles over shared points, z up.
#[derive(Debug, Clone)]
pub(crate) struct Triangles {
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Triangles {
    /// A solid like a gable roof over a box, its coordinates singles that are not round.
    pub(crate) fn house() -> Self {
        let xyz = |x: f32, y: f32, z: f32| [x, y, z].map(f64::from);
        let points = vec![
            xyz(0.1, -1.7, 0.3),
            xyz(4.2, -1.7, 0.3),
            xyz(4.2, 2.9, 0.3),
            xyz(0.1, 2.9, 0.3),
            xyz(0.1, -1.7, 2.6),
            xyz(4.2, -1.7, 2.6),
            xyz(4.2, 2.9, 2.6),
            xyz(0.1, 2.9, 2.6),
            xyz(2.15, -1.7, 4.4),
            xyz(2.15, 2.9, 4.4),
        ];
        let triangles = vec![
            [0, 2, 1],
            [0, 3, 2],
            [0, 1, 5],
            [0, 5, 4],
            [1, 2, 6],
            [1, 6, 5],
            [2, 3, 7],
            [2, 7, 6],
            [3, 0, 4],
            [3, 4, 7],
            [4, 5, 8],
            [6, 7, 9],
            [5, 6, 9],
            [5, 9, 8],
            [7, 4, 8],
            [7, 8, 9],
        ];
        Self { points, triangles }
    }

    /// The same scaled by a factor, so that coordinates need all digits of doubles.
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        let points = self.points.iter().map(|p| p.map(|c| c * factor)).collect();
        Self { points, triangles: self.triangles.clone() }
    }

    pub(crate) fn obj(&self) -> Vec<u8> {
        let mut text = String::new();
        for [x, y, z] in &self.points {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
        for [a, b, c] in &self.triangles {
            writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap();
        }
        text.into_bytes()
    }

    pub(crate) fn off(&self) -> Vec<u8> {
        let mut text = format!("OFF\n{} {} 0\n", self.points.len(), self.triangles.len());
        for [x, y, z] in &self.points {
            writeln!(text, "{x} {y} {z}").unwrap();
        }
        for [a, b, c] in &self.triangles {
            writeln!(text, "3 {a} {b} {c}").unwrap();
        }
        text.into_bytes()
    }

    pub(crate) fn ply(&self) -> Vec<u8> {
        let mut bytes = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\n\
             property double y\nproperty double z\nelement face {}\n\
             property list uchar uint vertex_indices\nend_header\n",
            self.points.len(),
            self.triangles.len()
        )
        .into_bytes();
        for coordinate in self.points.as_flattened() {
            bytes.extend(coordinate.to_le_bytes());
        }
        for triangle in &self.triangles {
            bytes.push(3);
            bytes.extend(triangle.iter().flat_map(|corner| corner.to_le_bytes()));
        }
        bytes
    }

    pub(crate) fn stl(&self) -> Vec<u8> {
        let mut bytes = vec![b' '; 80];
        bytes.extend((self.triangles.len() as u32).to_le_bytes());
        for triangle in &self.triangles {
            bytes.extend([0; 12]);
            for coordinate in triangle.iter().flat_map(|&corner| self.points[corner as usize]) {
                bytes.extend((coordinate as f32).to_le_bytes());
            }
            bytes.extend([0, 0]);
        }
        bytes
    }

    pub(crate) fn stl_text(&self) -> Vec<u8> {
        let mut text = "solid house\n".to_owned();
        for triangle in &self.triangles {
            text.push_str("facet normal 0 0 0\nouter loop\n");
            for [x, y, z] in triangle.map(|corner| self.points[corner as usize]) {
                writeln!(text, "vertex {x} {y} {z}").unwrap();
            }
            text.push_str("endloop\nendfacet\n");
        }
        text.push_str("endsolid house\n");
        text.into_bytes()
    }

    /// Positions as glTF has them, y up, and indices of 16 bits.
    pub(crate) fn glb_buffer(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        for [x, y, z] in &self.points {
            let y_up = [*x, *z, -*y];
            bytes.extend(y_up.iter().flat_map(|c| (*c as f32).to_le_bytes()));
        }
        let corners = self.triangles.as_flattened();
        bytes.extend(corners.iter().flat_map(|&corner| (corner as u16).to_le_bytes()));
        bytes
    }

    /// The JSON of a glTF file with one node, into which `node` is put, over one buffer.
    pub(crate) fn gltf_json(&self, node: &str, uri: &str) -> String {
        let n_points = self.points.len();
        let n_corners = 3 * self.triangles.len();
        let (split, length) = (12 * n_points, 12 * n_points + 2 * n_corners);
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
            "nodes":[{{"mesh":0{node}}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
            "accessors":[
              {{"bufferView":0,"componentType":5126,"count":{n_points},"type":"VEC3"}},
              {{"bufferView":1,"componentType":5123,"count":{n_corners},"type":"SCALAR"}}],
            "bufferViews":[{{"buffer":0,"byteLength":{split}}},
              {{"buffer":0,"byteOffset":{split},"byteLength":{}}}],
            "buffers":[{{"byteLength":{length}{uri}}}]}}"#,
            2 * n_corners
        )
    }

    pub(crate) fn glb(&self) -> Vec<u8> {
        glb(&self.gltf_json("", ""), &self.glb_buffer())
    }

    /// The XML of a 3MF model with one object.
    pub(crate) fn model_xml(&self, unit: &str) -> String {
        let mut text = format!(
            "<?xml version=\"1.0\"?>\n<model unit=\"{unit}\" \
             xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>\
             <object id=\"1\" type=\"model\"><mesh><vertices>"
        );
        for [x, y, z] in &self.points {
            write!(text, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>").unwrap();
        }
        text.push_str("</vertices><triangles>");
        for [a, b, c] in &self.triangles {
            write!(text, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>").unwrap();
        }
        text.push_str(
            "</triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>",
        );
        text
    }

    pub(crate) fn three_mf(&self) -> Vec<u8> {
        three_mf(&[("3D/3dmodel.model", &self.model_xml("millimeter"))])
    }
}

/// A GLB file of two chunks.
pub(crate) fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut binary = binary.to_vec();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = 12 + 8 + json.len() + 8 + binary.len();
    let mut bytes = b"glTF".to_vec();
    bytes.extend([2, length as u32].iter().flat_map(|word| word.to_le_bytes()));
    for (chunk, kind) in [(json, b"JSON"), (binary, b"BIN\0")] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

/// A 3MF archive of these parts and the relationship to the first of them.
pub(crate) fn three_mf(parts: &[(&str, &str)]) -> Vec<u8> {
    let rels = format!(
        "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\
         <Relationship Target=\"/{}\" Id=\"rel0\" \
         Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>",
        parts[0].0
    );
    let mut files = vec![("_rels/.rels", rels.as_bytes())];
    files.extend(parts.iter().map(|(name, text)| (*name, text.as_bytes())));
    zip(&files)
}

/// A ZIP archive in which files are stored as they are.
fn zip(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut directory = Vec::new();
    for (name, content) in files {
        let offset = bytes.len() as u32;
        let mut fields = Vec::new();
        // Version needed, flags, method, time, date.
        fields.extend([20_u16, 0, 0, 0, 0x21].iter().flat_map(|field| field.to_le_bytes()));
        fields.extend(crc32(content).to_le_bytes());
        fields.extend([content.len() as u32; 2].iter().flat_map(|field| field.to_le_bytes()));
        fields.extend([name.len() as u16, 0].iter().flat_map(|field| field.to_le_bytes()));
        bytes.extend(b"PK\x03\x04");
        bytes.extend(&fields);
        bytes.extend(name.bytes());
        bytes.extend(*content);
        directory.extend(b"PK\x01\x02\x14\0");
        directory.extend(&fields);
        // Comment, disk, attributes.
        directory.extend([0; 10]);
        directory.extend(offset.to_le_bytes());
        directory.extend(name.bytes());
    }
    let (start, n_files) = (bytes.len() as u32, files.len() as u16);
    bytes.extend(&directory);
    bytes.extend(b"PK\x05\x06\0\0\0\0");
    bytes.extend([n_files; 2].iter().flat_map(|field| field.to_le_bytes()));
    bytes.extend([directory.len() as u32, start].iter().flat_map(|field| field.to_le_bytes()));
    bytes.extend([0, 0]);
    bytes
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| {
            if crc & 1 == 1 { crc >> 1 ^ 0xEDB8_8320 } else { crc >> 1 }
        })
    })
}

#[test]
fn the_library_brings_models_of_known_units_to_the_first_one_and_upright() {
    use hiddenline::{ModelFormat, Scene, UpAxis};
    let house = Triangles::house();
    let bounds =
        |builder: hiddenline::SceneBuilder| builder.build().unwrap().mesh().bounds().unwrap();
    let (low, high) =
        bounds(Scene::builder().bytes("b.glb", &house.glb(), ModelFormat::Gltf).unwrap());
    let both = |builder: hiddenline::SceneBuilder| {
        let first = builder.bytes("a.3mf", &house.three_mf(), ModelFormat::ThreeMf).unwrap();
        bounds(first.bytes("b.glb", &house.glb(), ModelFormat::Gltf).unwrap())
    };
    // The 3MF is in millimeters, the GLB in meters and so a thousand times as large.
    let found = both(Scene::builder());
    assert_eq!(found, (low.min(1000.0 * low), high.max(1000.0 * high)));
    // Taken as z-up, the GLB lies on its back.
    let (lying_low, lying_high) = both(Scene::builder().up_axis(UpAxis::Z));
    let height = 1000.0 * (high.z - low.z);
    assert!((lying_high.y - lying_low.y - height).abs() < 0.1 * height);
}
