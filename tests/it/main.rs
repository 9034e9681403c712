//! Integration tests, one binary. Truth comes from outside the code under test.
#![allow(missing_docs, unreachable_pub, clippy::unwrap_used)]

mod closed_forms;
mod drawings;
mod engines;
mod laws;
mod oracle;
mod scenes;
mod truth;
