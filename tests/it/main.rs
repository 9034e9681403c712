//! All integration tests, in one binary.

mod cli;
mod views;
mod writers;
