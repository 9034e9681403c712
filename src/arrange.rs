//! Models put together: turned upright, scaled, rotated, merged into one mesh, welded.

use glam::{DMat3, DVec3};

use crate::framing::sin_cos_deg;
use crate::mesh::{Mesh, MeshError, Part, PolygonSoup, Repairs};

/// The axis that points up in a model.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum UpAxis {
    /// Models made with y up are turned by a quarter around x.
    Y,
    /// Nothing to do.
    #[default]
    Z,
}

/// What is done to models before they are drawn, in this order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrangement {
    /// Which axis points up.
    pub up_axis: UpAxis,
    /// Factor for all coordinates.
    pub scale: f64,
    /// Angles in degrees around x, then y, then z, each counter-clockwise seen from its tip.
    pub rotate_deg: DVec3,
    /// Vertices closer together than this, in model units after scaling, become one; see
    /// [`Mesh::weld`].
    pub weld_distance: f64,
}

impl Default for Arrangement {
    fn default() -> Self {
        Self { up_axis: UpAxis::Z, scale: 1.0, rotate_deg: DVec3::ZERO, weld_distance: 0.0 }
    }
}

impl Arrangement {
    /// Puts meshes together. A single mesh to which nothing is done stays bit for bit as it is.
    ///
    /// The whole turn is one matrix, applied once; turns by quarters are exact.
    ///
    /// # Errors
    /// A coordinate becomes infinite, the meshes together are too large for one, or the weld
    /// distance is negative.
    pub fn arrange(&self, mut meshes: Vec<Mesh>) -> Result<(Mesh, Repairs), MeshError> {
        if meshes.len() == 1 && *self == Self::default() {
            return Ok((meshes.pop().unwrap_or_default(), Repairs::default()));
        }
        let mut soup = PolygonSoup::default();
        for mesh in &meshes {
            append(&mut soup, mesh)?;
        }
        drop(meshes);
        let matrix = self.matrix();
        if matrix != DMat3::IDENTITY {
            for position in &mut soup.positions {
                *position = matrix * *position;
            }
        }
        let (mesh, mut repairs) = Mesh::new(soup)?;
        let (mesh, welded) = mesh.weld(self.weld_distance)?;
        repairs += welded;
        Ok((mesh, repairs))
    }

    fn matrix(&self) -> DMat3 {
        let upright = match self.up_axis {
            UpAxis::Y => DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y),
            UpAxis::Z => DMat3::IDENTITY,
        };
        let ((sx, cx), (sy, cy), (sz, cz)) = (
            sin_cos_deg(self.rotate_deg.x),
            sin_cos_deg(self.rotate_deg.y),
            sin_cos_deg(self.rotate_deg.z),
        );
        let around_x =
            DMat3::from_cols(DVec3::X, DVec3::new(0.0, cx, sx), DVec3::new(0.0, -sx, cx));
        let around_y =
            DMat3::from_cols(DVec3::new(cy, 0.0, -sy), DVec3::Y, DVec3::new(sy, 0.0, cy));
        let around_z =
            DMat3::from_cols(DVec3::new(cz, sz, 0.0), DVec3::new(-sz, cz, 0.0), DVec3::Z);
        around_z * around_y * around_x * upright * self.scale
    }
}

/// Adds the faces and parts of `mesh` to `soup`.
fn append(soup: &mut PolygonSoup, mesh: &Mesh) -> Result<(), MeshError> {
    let too_large = |_| MeshError::TooLarge;
    let first_vertex = u32::try_from(soup.positions.len()).map_err(too_large)?;
    let n_corners = soup.corners.len() + mesh.corners().len();
    let n_vertices = soup.positions.len() + mesh.positions().len();
    u32::try_from(n_corners.max(n_vertices)).map_err(too_large)?;
    let first_corner = soup.corners.len() as u32;
    let first_part = soup.parts.len() as u32;
    soup.positions.extend_from_slice(mesh.positions());
    soup.corners.extend(mesh.corners().iter().map(|corner| first_vertex + corner));
    soup.face_starts.extend(mesh.face_starts().iter().skip(1).map(|end| first_corner + end));
    if mesh.face_parts().is_empty() {
        soup.parts.push(Part::default());
        soup.face_parts.extend(std::iter::repeat_n(first_part, mesh.n_faces()));
    } else {
        soup.parts.extend_from_slice(mesh.parts());
        soup.face_parts.extend(mesh.face_parts().iter().map(|part| first_part + part));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    fn triangle(at: DVec3) -> Mesh {
        let positions = vec![at, at + DVec3::X, at + DVec3::Y];
        let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
        soup.push_face(&[0, 1, 2]);
        Mesh::new(soup).map(|(mesh, _)| mesh).unwrap_or_default()
    }

    #[test]
    fn y_up_becomes_z_up() {
        let arrangement = Arrangement { up_axis: UpAxis::Y, ..Arrangement::default() };
        let (mesh, _) = arrangement.arrange(vec![triangle(dvec3(1.0, 2.0, 3.0))]).expect("finite");
        let expected = [dvec3(1.0, -3.0, 2.0), dvec3(2.0, -3.0, 2.0), dvec3(1.0, -3.0, 3.0)];
        assert_eq!(mesh.positions(), expected);
    }

    #[test]
    fn quarter_turns_are_exact_and_in_order() {
        let arrangement =
            Arrangement { rotate_deg: dvec3(90.0, 0.0, 90.0), ..Arrangement::default() };
        let (mesh, _) = arrangement.arrange(vec![triangle(dvec3(0.1, 0.2, 0.3))]).expect("finite");
        // Around x: (0.1, −0.3, 0.2); then around z: (0.3, 0.1, 0.2).
        assert_eq!(mesh.positions()[0], dvec3(0.3, 0.1, 0.2));
    }

    #[test]
    fn two_models_share_their_equal_vertices() {
        let meshes = vec![triangle(DVec3::ZERO), triangle(DVec3::X)];
        let (mesh, repairs) = Arrangement::default().arrange(meshes).expect("finite");
        assert_eq!((mesh.n_faces(), mesh.positions().len()), (2, 5));
        assert_eq!(repairs.welded_vertices, 1);
        assert_eq!(mesh.face_parts(), [0, 1]);
    }
}
