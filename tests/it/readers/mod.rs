//! Files and formulas: what is read, what is refused, what is left out with a warning.

mod colors;
mod cube;
mod damage;
mod diagnosis;
mod equal_faces;
pub(crate) mod export;
mod folder;
mod formula;
mod formula_jets;
#[cfg(feature = "gltf")]
mod gltf;
mod hostile;
mod obj;
mod stl;
mod svg;
mod svg_shown;
#[cfg(feature = "3mf")]
mod three_mf;
mod weld;
mod wires;

use hiddenline::stages::read::{Model, ReadError, read_bytes};

fn read(name: &str, bytes: impl AsRef<[u8]>) -> Result<Model, ReadError> {
    read_bytes(name, bytes.as_ref(), None)
}

#[track_caller]
fn good(name: &str, bytes: impl AsRef<[u8]>) -> Model {
    read(name, bytes).unwrap_or_else(|error| panic!("refused: {error}"))
}

#[track_caller]
fn refused(name: &str, bytes: impl AsRef<[u8]>) -> ReadError {
    match read(name, bytes) {
        Ok(model) => panic!("{name} was read: {} faces", model.mesh.n_faces()),
        Err(error) => error,
    }
}

#[track_caller]
fn assert_message(error: &ReadError, begin: &str, part: &str) {
    let message = error.to_string();
    assert!(message.starts_with(begin), "`{message}` does not begin with `{begin}`");
    assert!(message.contains(part), "`{message}` does not say `{part}`");
    assert!(!message.contains('\n'), "`{message}` has more than one line");
}
