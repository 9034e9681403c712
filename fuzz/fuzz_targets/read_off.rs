//! Any bytes as OFF: an error or a sound mesh, never a panic.
#![no_main]

use hiddenline::stages::read::{ModelFormat, read_bytes};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let format = ModelFormat::from_word("off");
    if let Ok(model) = read_bytes("fuzzed", bytes, format) {
        assert!(model.mesh.n_faces() > 0);
        assert!(model.mesh.positions().iter().all(|p| p.is_finite()));
    }
});
