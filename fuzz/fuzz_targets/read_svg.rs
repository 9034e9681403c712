//! Any bytes as an SVG drawing, with and without fills that hide: an error on one line, or finite
//! lines, never a panic.
#![no_main]

use hiddenline::stages::read_svg::{SvgOptions, read_bytes};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Some((&first, bytes)) = bytes.split_first() else { return };
    let options = SvgOptions {
        occlude: first % 2 == 1,
        max_segments: 20_000,
        max_elements: 5_000,
        ..SvgOptions::default()
    };
    match read_bytes(bytes, &options) {
        Ok(file) => {
            let lines = file.plot.layers.iter().map(|layer| &layer.lines);
            assert!(lines.flat_map(|lines| lines.iter().flatten()).all(|point| point.is_finite()));
            assert!(file.warnings.iter().all(|warning| !warning.to_string().contains('\n')));
        }
        Err(error) => assert!(!error.to_string().contains('\n')),
    }
});
