//! Any bytes as MTL: colors and warnings, never a panic.
#![no_main]

use hiddenline::stages::read::read_materials;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let file = read_materials(bytes);
    assert!(file.warnings.iter().all(|(line, text)| *line > 0 && !text.contains('\n')));
});
