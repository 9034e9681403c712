//! What every reader promises, whatever bytes it gets.

use hiddenline::stages::model::mesh::Mesh;
use hiddenline::stages::read::{ModelFormat, read_bytes};

/// Reads bytes in a format, or in the one that they look like, and checks the outcome: an error on
/// one line, or a sound mesh.
pub fn read_model(bytes: &[u8], format: Option<ModelFormat>) {
    match read_bytes("fuzzed", bytes, format) {
        Ok(model) => {
            check(&model.mesh);
            assert!(model.warnings.iter().all(|warning| !warning.to_string().contains('\n')));
        }
        Err(error) => assert!(!error.to_string().contains('\n')),
    }
}

fn check(mesh: &Mesh) {
    let n_vertices = mesh.positions().len();
    let mut used = mesh.corners().iter().chain(mesh.wires().as_flattened());
    assert!(mesh.n_faces() > 0 || !mesh.wires().is_empty());
    assert!(mesh.positions().iter().all(|position| position.is_finite()));
    assert!(used.all(|&vertex| (vertex as usize) < n_vertices));
    assert!((0..mesh.n_faces() as u32).all(|face| mesh.face(face).len() >= 3));
    assert!(mesh.face_parts().iter().all(|&part| (part as usize) < mesh.parts().len()));
}
