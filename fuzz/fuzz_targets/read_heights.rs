//! Any bytes as a height file, placed and cut in several ways: an error on one line, or a sound
//! grid, never a panic.
#![no_main]

use hiddenline::stages::surface::{HeightOptions, read_heights};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Some((&first, bytes)) = bytes.split_first() else { return };
    let options = HeightOptions {
        x: (first & 1 != 0).then_some((-3.0, 5.0)),
        y: (first & 2 != 0).then_some((1.0, 1e300)),
        flip_y: first & 4 != 0,
        nodata: (first & 8 != 0).then_some(-9999.0),
    };
    match read_heights(bytes, &options) {
        Ok(field) => {
            assert!(field.grid.zs().iter().all(|z| z.is_nan() || z.is_finite()));
            assert!(field.notes.iter().all(|note| !note.to_string().contains('\n')));
        }
        Err(error) => assert!(!error.to_string().contains('\n')),
    }
});
