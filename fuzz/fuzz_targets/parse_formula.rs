//! Any text as a formula: an error with a column in the text or values, never a panic.
#![no_main]

use hiddenline::stages::surface::formula::{Formula, Variables};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    match Formula::parse(text, Variables::Plane) {
        Ok(formula) => drop(formula.value(0.5, -1.5)),
        Err(error) => assert!((1..=text.chars().count() + 1).contains(&error.column)),
    }
});
