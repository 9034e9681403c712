//! All integration tests, in one binary.

mod closed_forms;
mod optimize;
