//! Sound files with random damage.

use hiddenline::stages::read::read_bytes;
use proptest::prelude::*;

use super::cube::{binary_stl, ply_cube, text_stl};

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
        ("x.ply", ply_cube("binary_little_endian", "uchar int vertex_indices")),
        ("x.ply", ply_cube("binary_big_endian", "uint uchar vertex_index")),
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
}
