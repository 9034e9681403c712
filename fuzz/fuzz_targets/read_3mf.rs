//! Any bytes as 3MF: an error or a sound mesh, never a panic.
#![no_main]

use hiddenline::stages::read::ModelFormat;
use hiddenline_fuzz::read_model;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| read_model(bytes, Some(ModelFormat::ThreeMf)));
