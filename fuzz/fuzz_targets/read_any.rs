//! Any bytes without a format: it is found by content, or the file is refused.
#![no_main]

use hiddenline_fuzz::read_model;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| read_model(bytes, None));
