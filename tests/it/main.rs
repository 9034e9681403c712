//! All integration tests, in one binary.

<<<<<<< HEAD
mod cli;
mod closed_forms;
mod drawings;
mod engines;
mod laws;
mod oracle;
mod scenes;
mod truth;
mod views;
mod writers;
=======
mod readers;
>>>>>>> 6826fca04af4ff864f78cf00019d31b78c36992e
