//! Sound files with random damage: a reader may refuse them, but it never panics, hangs or hands over
//! what is no mesh.
//!
//! This is a fuzzer of its own that needs no other tools. It keeps the inputs that lead to messages
//! and shapes not seen before, and damages those further. Each run starts from the same seed; with
//! `FUZZ_SECONDS=180` it goes on for so many seconds of each format, and `FUZZ_SEED` changes the seed.

use std::collections::HashSet;
use std::time::{Duration, Instant};

use base64::Engine as _;
use hiddenline::stages::model::mesh::Mesh;
use hiddenline::stages::read::{ModelFormat, read_bytes, read_materials};

use super::cube::{binary_stl, ply_cube, text_stl};
use super::export::{Triangles, three_mf};

/// Runs of each format without `FUZZ_SECONDS`.
const RUNS: u64 = 400;

/// Inputs grow no longer than this.
const LONGEST: usize = 1 << 14;

/// Pieces that formats are made of, put in at random places.
const PIECES: [&[u8]; 44] = [
    b"nan",
    b"-1",
    b"0",
    b"1e999",
    b"4294967295",
    b"18446744073709551616",
    b"\\\n",
    b"#",
    b"\0",
    b"\n",
    b"\r",
    b"f 1 2 3\n",
    b"v 0 0 0\n",
    b"l 1 2\n",
    b"usemtl a\n",
    b"g b\n",
    b"1/2/3",
    b"1.#IND",
    b"endsolid",
    b"solid\n",
    b"facet ",
    b"vertex ",
    b"outer loop",
    b"endloop",
    b"OFF",
    b"COFF",
    b"element face 9\n",
    b"property list uint int vertex_indices\n",
    b"end_header\n",
    b"\"count\":9",
    b"\"children\":[0],",
    b"\"sparse\":{",
    b"\"byteStride\":1,",
    b"5121",
    b"5125",
    b"\"mode\":3,",
    b"<object id=\"1\">",
    b"<component objectid=\"1\"/>",
    b"transform=\"1 0\"",
    b"v1=\"0\"",
    b"newmtl a\n",
    b"Kd 1 0 0\n",
    b"Kd ",
    b"\xFF\xFE",
];

/// A generator of random numbers: xorshift.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() >> 16) as usize % n.max(1)
    }
}

fn damage(bytes: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    let at = random.below(bytes.len() + 1);
    let length = random.below(32).min(bytes.len() - at);
    match random.below(9) {
        0 if at < bytes.len() => bytes[at] = random.next() as u8,
        1 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
        2 => bytes.insert(at, random.next() as u8),
        3 => drop(bytes.drain(at..at + length)),
        4 => bytes.extend_from_within(at..at + length),
        5 => bytes.truncate(at),
        6 => {
            let piece = PIECES[random.below(PIECES.len())];
            bytes.splice(at..at, piece.iter().copied());
        }
        7 => {
            let piece = PIECES[random.below(PIECES.len())];
            let end = (at + piece.len()).min(bytes.len());
            bytes.splice(at..end, piece.iter().copied());
        }
        _ => {
            let from = random.below(other.len());
            let length = random.below(64).min(other.len() - from);
            bytes.splice(at..at, other[from..from + length].iter().copied());
        }
    }
    bytes.truncate(LONGEST);
}

/// What a run showed, to tell inputs apart: a short description of the outcome.
fn outcome_of_model(bytes: &[u8], format: Option<ModelFormat>) -> String {
    match read_bytes("x", bytes, format) {
        Ok(model) => {
            check(&model.mesh);
            assert!(model.warnings.iter().all(|warning| !warning.to_string().contains('\n')));
            let log = |n: usize| usize::BITS - n.leading_zeros();
            format!(
                "{} {} {} {} {:?}",
                log(model.mesh.n_faces()),
                log(model.mesh.wires().len()),
                log(model.mesh.parts().len()),
                model.warnings.len(),
                model.unit_mm
            )
        }
        Err(error) => {
            let message = error.to_string();
            assert!(!message.contains('\n'), "{message}");
            message.chars().filter(|c| !c.is_ascii_digit()).take(60).collect()
        }
    }
}

/// What every mesh promises.
fn check(mesh: &Mesh) {
    let n = mesh.positions().len() as u32;
    assert!(mesh.n_faces() > 0 || !mesh.wires().is_empty());
    assert!(mesh.positions().iter().all(|p| p.is_finite()));
    assert!(mesh.corners().iter().chain(mesh.wires().as_flattened()).all(|&vertex| vertex < n));
    assert!((0..mesh.n_faces() as u32).all(|face| mesh.face(face).len() >= 3));
    assert!(mesh.face_parts().iter().all(|&p| (p as usize) < mesh.parts().len()));
    assert!(mesh.face_parts().is_empty() || mesh.face_parts().len() == mesh.n_faces());
    assert!([0, mesh.corners().len()].contains(&mesh.corner_normals().len()));
    assert!(mesh.coordinate_error().is_finite() && mesh.coordinate_error() >= 0.0);
}

/// Damages `seeds` and what grew from them, and says how many runs there were.
fn fuzz(name: &str, seeds: Vec<Vec<u8>>, outcome: impl Fn(&[u8]) -> String) {
    let setting = |key: &str| std::env::var(key).ok().and_then(|text| text.parse::<u64>().ok());
    let seconds = setting("FUZZ_SECONDS");
    let mut random = Random(setting("FUZZ_SEED").unwrap_or(0x9E37_79B9_7F4A_7C15).max(1));
    let (start, mut n_runs) = (Instant::now(), 0);
    let mut corpus = seeds;
    let mut seen: HashSet<String> = corpus.iter().map(|bytes| outcome(bytes)).collect();
    let goes_on = |n_runs: u64, start: Instant| match seconds {
        Some(seconds) => start.elapsed() < Duration::from_secs(seconds),
        None => n_runs < RUNS,
    };
    while goes_on(n_runs, start) {
        let mut bytes = corpus[random.below(corpus.len())].clone();
        let other = random.below(corpus.len());
        for _ in 0..1 + random.below(6) {
            damage(&mut bytes, &corpus[other], &mut random);
        }
        let before = Instant::now();
        let found = outcome(&bytes);
        assert!(before.elapsed().as_secs() < 20, "{name}: took {:?}", before.elapsed());
        if seen.insert(found) && corpus.len() < 5000 {
            corpus.push(bytes);
        }
        n_runs += 1;
    }
    if seconds.is_some() {
        eprintln!("{name}: {n_runs} runs, {} inputs kept", corpus.len());
    }
}

fn fuzz_format(word: &str, seeds: Vec<Vec<u8>>) {
    let format = ModelFormat::from_word(word);
    fuzz(word, seeds, |bytes| outcome_of_model(bytes, format));
}

fn obj_seeds() -> Vec<Vec<u8>> {
    let obj = "mtllib a.mtl\no a\nusemtl b\nv 0 0 0 # c\nv 1 \\\n 0 0 1 1 1\nv 0 1e0 0\nv .5 -5 +5\n\
               vn 0 0 1\nf 1//1 2/1/1 -2\r\nf 1 2 3 4\nl 1 2 3\nvp 1\nf 1 2\nv nan 0 0\np 1\n";
    vec![obj.as_bytes().to_vec(), Triangles::house().obj()]
}

fn stl_seeds() -> Vec<Vec<u8>> {
    let colored = binary_stl(b"COLOR=abcd");
    vec![
        binary_stl(b"solid x")[..84 + 3 * 50].to_vec(),
        colored,
        text_stl(3).into_bytes(),
        Triangles::house().stl_text(),
    ]
}

fn ply_seeds() -> Vec<Vec<u8>> {
    vec![
        ply_cube("ascii", "uchar int vertex_indices"),
        ply_cube("binary_little_endian", "uchar int vertex_indices"),
        ply_cube("binary_big_endian", "uint uchar vertex_index"),
        Triangles::house().ply(),
    ]
}

fn off_seeds() -> Vec<Vec<u8>> {
    let off =
        b"COFF # c\n4 2 0\n0 0 0 1\n1 0 0\n\n0 1 0\n1 1 1\n4 0 1 3 2 0 0 1\n3 0 1 2\n".to_vec();
    vec![off, Triangles::house().off()]
}

fn gltf_seeds() -> Vec<Vec<u8>> {
    let house = Triangles::house();
    let node = r#","translation":[1,0,0],"rotation":[0,0.6,0,0.8],"scale":[1,2,1]"#;
    let encoded = base64::engine::general_purpose::STANDARD.encode(house.glb_buffer());
    let json = house.gltf_json(node, &format!(r#","uri":"data:x;base64,{encoded}""#));
    vec![house.glb(), json.into_bytes()]
}

fn three_mf_seeds() -> Vec<Vec<u8>> {
    let text = "<model unit=\"inch\"><resources><basematerials id=\"5\"><base name=\"a\" \
                displaycolor=\"#FF0000\"/></basematerials><object id=\"1\" pid=\"5\" pindex=\"0\"><mesh>\
                <vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>\
                <vertex x=\"0\" y=\"1\" z=\"0\"/></vertices><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\" \
                p1=\"0\"/></triangles></mesh></object><object id=\"2\"><components><component objectid=\"1\" \
                transform=\"1 0 0 0 1 0 0 0 1 2 0 0\"/></components></object></resources><build><item \
                objectid=\"2\"/></build></model>";
    vec![text.as_bytes().to_vec(), Triangles::house().three_mf()]
}

#[test]
fn damaged_obj_never_panics() {
    fuzz_format("obj", obj_seeds());
}

#[test]
fn damaged_stl_never_panics() {
    fuzz_format("stl", stl_seeds());
}

#[test]
fn damaged_ply_never_panics() {
    fuzz_format("ply", ply_seeds());
}

#[test]
fn damaged_off_never_panics() {
    fuzz_format("off", off_seeds());
}

#[test]
fn damaged_gltf_never_panics() {
    fuzz_format("gltf", gltf_seeds());
}

#[test]
fn damaged_3mf_never_panics() {
    // An archive guards its content by a checksum, so most of the damage is done to what goes in.
    fuzz("3mf", three_mf_seeds(), |bytes| {
        let is_archive = bytes.starts_with(b"PK");
        let packed = || three_mf(&[("m", &String::from_utf8_lossy(bytes))]);
        let bytes = if is_archive { bytes } else { &packed() };
        outcome_of_model(bytes, Some(ModelFormat::ThreeMf))
    });
}

#[test]
fn damaged_files_of_unknown_format_never_panic() {
    let seeds =
        [obj_seeds(), stl_seeds(), ply_seeds(), off_seeds(), gltf_seeds(), three_mf_seeds()];
    fuzz("any", seeds.concat(), |bytes| outcome_of_model(bytes, None));
}

#[test]
fn damaged_mtl_never_panics() {
    let seed = "# c\nnewmtl red one\nKd 1 0 0.5\nKa 0 0 0\nmap_Kd a b.png\nnewmtl b # d\n\tKd .5\n";
    fuzz("mtl", vec![seed.as_bytes().to_vec()], |bytes| {
        let file = read_materials(bytes);
        let n_lines = 1 + bytes.iter().filter(|&&byte| byte == b'\n' || byte == b'\r').count();
        assert!(file.warnings.iter().all(|(line, _)| (1..=n_lines).contains(line)));
        let first = file.warnings.first().map_or("", |(_, text)| text.as_str());
        format!("{} {first}", file.colors.len().min(9))
    });
}
