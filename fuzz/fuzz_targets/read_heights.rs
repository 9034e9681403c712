//! Any bytes as a height file: an error or a sound grid, never a panic.
#![no_main]

use hiddenline::stages::surface::{HeightOptions, read_heights};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match read_heights(bytes, &HeightOptions::default()) {
        Ok(field) => assert!(field.grid.zs().iter().all(|z| z.is_nan() || z.is_finite())),
        Err(error) => assert!(!error.to_string().contains('\n')),
    }
});
