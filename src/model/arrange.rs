//! Several models as one mesh: each turned upright, scaled, rotated and moved into place; then nearby
//! vertices and equal faces are merged.

use glam::{DMat3, DVec3};

use crate::camera::framing::sin_cos_deg;
use crate::model::mesh::{Mesh, MeshError, MeshPart, PolygonSoup, Repairs};

/// The axis of a mesh that points up.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum UpAxis {
    /// The mesh is turned by a quarter around x.
    Y,
    /// The mesh is turned by a quarter around x, the other way.
    NegativeY,
    /// The mesh is turned by a half around x.
    NegativeZ,
    /// The mesh stays as it is.
    #[default]
    Z,
}

impl UpAxis {
    /// All of them, in the order of the documentation.
    pub const ALL: [Self; 4] = [Self::Y, Self::Z, Self::NegativeY, Self::NegativeZ];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Y => "y",
            Self::Z => "z",
            Self::NegativeY => "-y",
            Self::NegativeZ => "-z",
        }
    }
}

/// How a model is placed in the scene; applied in the order of the fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// The axis that points up before the model is placed.
    pub up_axis: UpAxis,
    /// Factor for all coordinates.
    pub scale: f64,
    /// Angles in degrees around x, then y, then z, each counterclockwise as seen from the tip of
    /// its axis.
    pub rotate_deg: DVec3,
    /// Translation, in model units after scaling.
    pub move_by: DVec3,
}

impl Default for Pose {
    fn default() -> Self {
        Self {
            up_axis: UpAxis::default(),
            scale: 1.0,
            rotate_deg: DVec3::ZERO,
            move_by: DVec3::ZERO,
        }
    }
}

/// Options for the whole scene, once all models are placed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Arrangement {
    /// Vertices closer than this, in model units after scaling, are merged; see [`Mesh::weld`].
    pub weld_distance: f64,
    /// Faces with the same border are merged; see [`Mesh::merge_equal_faces`].
    pub merge_equal_faces: bool,
}

impl Arrangement {
    /// Combines meshes into one, each in its pose. A single mesh that is neither moved nor merged stays
    /// bit for bit the same.
    ///
    /// The rotation of a mesh is one matrix, applied once; quarter turns are exact. Vertices of
    /// different meshes that end up at the same position are merged.
    ///
    /// # Errors
    /// A coordinate overflows, the meshes together are too large for one, or the weld distance is
    /// negative.
    pub fn arrange(&self, mut models: Vec<(Mesh, Pose)>) -> Result<(Mesh, Repairs), MeshError> {
        let is_in_place =
            |models: &[(Mesh, Pose)]| matches!(models, [(_, pose)] if *pose == Pose::default());
        if self.weld_distance == 0.0 && is_in_place(&models) {
            return Ok(self.merged(models.pop().unwrap_or_default().0, Repairs::default()));
        }
        let mut soup = PolygonSoup { coordinate_error: Some(0.0), ..PolygonSoup::default() };
        for (number, (mesh, pose)) in (0..).zip(&models) {
            let (first, first_normal) = (soup.positions.len(), soup.corner_normals.len());
            append(&mut soup, mesh, number)?;
            let error = soup.coordinate_error.unwrap_or_default();
            soup.coordinate_error = Some(error.max(mesh.coordinate_error() * pose.scale));
            let rotation = rotation(pose);
            let matrix = rotation * pose.scale;
            if matrix != DMat3::IDENTITY || pose.move_by != DVec3::ZERO {
                for position in &mut soup.positions[first..] {
                    *position = matrix * *position + pose.move_by;
                }
            }
            if rotation != DMat3::IDENTITY {
                for normal in &mut soup.corner_normals[first_normal..] {
                    let turned = rotation * DVec3::from_array(normal.map(f64::from));
                    *normal = turned.to_array().map(|c| c as f32);
                }
            }
        }
        if !soup.corner_normals.is_empty() {
            soup.corner_normals.resize(soup.corners.len(), [0.0; 3]);
        }
        drop(models);
        let (mesh, mut repairs) = Mesh::new(soup)?;
        let (mesh, welded) = mesh.weld(self.weld_distance)?;
        repairs += welded;
        Ok(self.merged(mesh, repairs))
    }

    /// Merges equal faces if asked to.
    fn merged(&self, mesh: Mesh, mut repairs: Repairs) -> (Mesh, Repairs) {
        if !self.merge_equal_faces {
            return (mesh, repairs);
        }
        let (mesh, merged) = mesh.merge_equal_faces();
        repairs += merged;
        (mesh, repairs)
    }
}

/// The rotation of a mesh, the one that makes it upright included.
fn rotation(pose: &Pose) -> DMat3 {
    let upright = match pose.up_axis {
        UpAxis::Y => DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y),
        UpAxis::NegativeY => DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y),
        UpAxis::NegativeZ => DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z),
        UpAxis::Z => DMat3::IDENTITY,
    };
    let ((sx, cx), (sy, cy), (sz, cz)) = (
        sin_cos_deg(pose.rotate_deg.x),
        sin_cos_deg(pose.rotate_deg.y),
        sin_cos_deg(pose.rotate_deg.z),
    );
    let around_x = DMat3::from_cols(DVec3::X, DVec3::new(0.0, cx, sx), DVec3::new(0.0, -sx, cx));
    let around_y = DMat3::from_cols(DVec3::new(cy, 0.0, -sy), DVec3::Y, DVec3::new(sy, 0.0, cy));
    let around_z = DMat3::from_cols(DVec3::new(cz, sz, 0.0), DVec3::new(-sz, cz, 0.0), DVec3::Z);
    around_z * around_y * around_x * upright
}

/// Adds all that is in `mesh`, the model with this number, to `soup`.
fn append(soup: &mut PolygonSoup, mesh: &Mesh, model: u32) -> Result<(), MeshError> {
    let too_large = |_| MeshError::TooLarge;
    let first_vertex = u32::try_from(soup.positions.len()).map_err(too_large)?;
    let n_corners = soup.corners.len() + mesh.corners().len();
    let n_vertices = soup.positions.len() + mesh.positions().len();
    u32::try_from(n_corners.max(n_vertices)).map_err(too_large)?;
    let first_corner = soup.corners.len() as u32;
    let first_part = soup.parts.len() as u32;
    if !mesh.corner_normals().is_empty() {
        soup.corner_normals.resize(soup.corners.len(), [0.0; 3]);
        soup.corner_normals.extend_from_slice(mesh.corner_normals());
    }
    let wires = mesh.wires().iter();
    soup.wires.extend(wires.map(|ends| ends.map(|end| first_vertex + end)));
    soup.positions.extend_from_slice(mesh.positions());
    soup.corners.extend(mesh.corners().iter().map(|corner| first_vertex + corner));
    soup.face_starts.extend(mesh.face_starts().iter().skip(1).map(|end| first_corner + end));
    if mesh.face_parts().is_empty() {
        soup.parts.push(MeshPart { model, ..MeshPart::default() });
        soup.face_parts.extend(std::iter::repeat_n(first_part, mesh.n_faces()));
    } else {
        soup.parts.extend(mesh.parts().iter().map(|part| MeshPart { model, ..part.clone() }));
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
        let upright = |up_axis, mesh| {
            let models = vec![(mesh, Pose { up_axis, ..Pose::default() })];
            Arrangement::default().arrange(models).expect("finite").0
        };
        let mesh = upright(UpAxis::Y, triangle(dvec3(1.0, 2.0, 3.0)));
        let expected = [dvec3(1.0, -3.0, 2.0), dvec3(2.0, -3.0, 2.0), dvec3(1.0, -3.0, 3.0)];
        assert_eq!(mesh.positions(), expected);
        let back = upright(UpAxis::NegativeY, mesh.clone());
        assert_eq!(back.positions(), triangle(dvec3(1.0, 2.0, 3.0)).positions());
        let around = upright(UpAxis::NegativeZ, upright(UpAxis::NegativeZ, mesh.clone()));
        assert_eq!(around.positions(), mesh.positions());
    }

    #[test]
    fn quarter_turns_are_exact_and_in_order() {
        let pose = Pose { rotate_deg: dvec3(90.0, 0.0, 90.0), ..Pose::default() };
        let models = vec![(triangle(dvec3(0.1, 0.2, 0.3)), pose)];
        let (mesh, _) = Arrangement::default().arrange(models).expect("finite");
        // Around x: (0.1, −0.3, 0.2); then around z: (0.3, 0.1, 0.2).
        assert_eq!(mesh.positions()[0], dvec3(0.3, 0.1, 0.2));
    }

    #[test]
    fn each_model_has_a_place_of_its_own() {
        let moved = Pose {
            scale: 2.0,
            rotate_deg: dvec3(0.0, 0.0, 90.0),
            move_by: dvec3(10.0, 0.0, 0.0),
            ..Pose::default()
        };
        let models =
            vec![(triangle(DVec3::ZERO), Pose::default()), (triangle(dvec3(1.0, 0.0, 0.0)), moved)];
        let (mesh, _) = Arrangement::default().arrange(models).expect("finite");
        assert_eq!(mesh.positions()[0], DVec3::ZERO);
        // Scaled: (2, 0, 0); turned: (0, 2, 0); moved.
        assert_eq!(mesh.positions()[3], dvec3(10.0, 2.0, 0.0));
    }

    #[test]
    fn a_scaled_mesh_is_as_uncertain_as_its_file() {
        let error_of = |scale: f64| {
            let pose = Pose { scale, ..Pose::default() };
            let models = vec![(triangle(dvec3(0.5, 0.25, 8.0)), pose)];
            Arrangement::default().arrange(models).expect("finite").0.coordinate_error()
        };
        assert!(error_of(1.0) > 0.0);
        assert_eq!(error_of(25.4), 25.4 * error_of(1.0));
    }

    #[test]
    fn two_models_share_their_equal_vertices() {
        let models = [triangle(DVec3::ZERO), triangle(DVec3::X)];
        let models = models.map(|mesh| (mesh, Pose::default())).to_vec();
        let (mesh, repairs) = Arrangement::default().arrange(models).expect("finite");
        assert_eq!((mesh.n_faces(), mesh.positions().len()), (2, 5));
        assert_eq!(repairs.welded_vertices, 1);
        assert_eq!(mesh.face_parts(), [0, 1]);
    }
}
