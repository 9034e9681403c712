//! Any bytes under no telling name: the format is found by content, or refused.
#![no_main]

use hiddenline::stages::read::read_bytes;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match read_bytes("fuzzed", bytes, None) {
        Ok(model) => assert!(model.mesh.n_faces() > 0),
        Err(error) => assert!(!error.to_string().contains('\n')),
    }
});
