//! Models put together: turned upright, scaled, rotated, merged into one mesh, welded.

use glam::{DMat3, DVec3};
use rustc_hash::FxHashMap;

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
    /// Vertices closer together than this, in model units after scaling, become one; 0 for only
    /// those that are equal.
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
    /// A coordinate becomes infinite, or the meshes together are too large for one.
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
        let mut n_welded = 0;
        if self.weld_distance > 0.0 && soup.positions.iter().all(|p| p.is_finite()) {
            let nearby = first_nearby(&soup.positions, self.weld_distance);
            n_welded = nearby.iter().enumerate().filter(|&(i, &n)| i as u32 != n).count();
            for corner in &mut soup.corners {
                if let Some(&vertex) = nearby.get(*corner as usize) {
                    *corner = vertex;
                }
            }
        }
        let (mesh, mut repairs) = Mesh::new(soup)?;
        repairs.welded_vertices += n_welded;
        repairs.unused_vertices = repairs.unused_vertices.saturating_sub(n_welded);
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

/// For each position the first one kept that is closer than `distance`, or itself.
///
/// Positions are taken in order and kept unless one that was kept before is near, so chains of
/// near positions do not pull each other together over more than the distance. A grid of cells of
/// that size leaves 27 cells to look into. O(positions).
fn first_nearby(positions: &[DVec3], distance: f64) -> Vec<u32> {
    let cell_of = |p: DVec3| (p / distance).floor().to_array().map(|x| x as i64);
    let mut kept: FxHashMap<[i64; 3], Vec<u32>> = FxHashMap::default();
    let mut nearby = Vec::with_capacity(positions.len());
    for (i, &p) in positions.iter().enumerate() {
        let [x, y, z] = cell_of(p);
        let mut first = i as u32;
        for dx in -1..=1 {
            for dy in -1..=1 {
                for dz in -1..=1 {
                    let cell = [x.saturating_add(dx), y.saturating_add(dy), z.saturating_add(dz)];
                    for &other in kept.get(&cell).map_or(&[][..], Vec::as_slice) {
                        let q = positions.get(other as usize).copied().unwrap_or(p);
                        if other < first && q.distance(p) < distance {
                            first = other;
                        }
                    }
                }
            }
        }
        if first == i as u32 {
            kept.entry([x, y, z]).or_default().push(first);
        }
        nearby.push(first);
    }
    nearby
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

    #[test]
    fn welding_joins_what_is_closer_than_the_distance() {
        let arrangement = |weld_distance| Arrangement { weld_distance, ..Arrangement::default() };
        let meshes = || vec![triangle(DVec3::ZERO), triangle(dvec3(1.0625, 0.0, 0.0))];
        let vertices = |weld| {
            arrangement(weld)
                .arrange(meshes())
                .map(|(m, r)| (m.positions().len(), r.welded_vertices))
        };
        assert_eq!(vertices(0.0), Ok((6, 0)));
        assert_eq!(vertices(0.0625), Ok((6, 0)));
        assert_eq!(vertices(0.07), Ok((5, 1)));
    }
}
