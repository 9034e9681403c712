//! From model files, or faces in memory, to a scene.

use std::path::Path;

use glam::DVec3;

use super::Error;
use crate::model::arrange::{Arrangement, Pose, UpAxis};
use crate::model::mesh::{Mesh, PolygonSoup};
use crate::model::scene::Scene;
use crate::read::{ModelFormat, Warning, read_bytes, read_file};

impl Scene {
    /// Reads one model file, z up. The extension says its format, or else the content.
    ///
    /// [`Scene::builder`] puts several models together, turns models made with y up, and merges
    /// vertices.
    ///
    /// # Errors
    /// The file cannot be read, is damaged, or has no faces.
    ///
    /// ```
    /// let scene = hiddenline::Scene::open("examples/models/spot.obj")?;
    /// assert_eq!(scene.mesh().n_faces(), 5856);
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::builder().open(path)?.build()
    }

    /// Makes a scene of faces in memory: each face lists its corners as indices of `positions`,
    /// counter-clockwise seen from outside.
    ///
    /// # Errors
    /// An index is out of range, a coordinate is not finite, or there are too many.
    ///
    /// ```
    /// use glam::dvec3;
    ///
    /// let corners = [dvec3(0., 0., 0.), dvec3(1., 0., 0.), dvec3(0., 1., 0.), dvec3(0., 0., 1.)];
    /// let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    /// let scene = hiddenline::Scene::from_faces(&corners, faces)?;
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    pub fn from_faces<F: AsRef<[u32]>>(
        positions: &[DVec3],
        faces: impl IntoIterator<Item = F>,
    ) -> Result<Self, Error> {
        let mut soup = PolygonSoup { positions: positions.to_vec(), ..PolygonSoup::default() };
        for face in faces {
            soup.push_face(face.as_ref());
        }
        Self::from_polygons(soup)
    }

    /// Makes a scene of polygons in memory, and of polylines, which are drawn but hide nothing.
    ///
    /// # Errors
    /// An index is out of range, a coordinate is not finite, or there are too many.
    pub fn from_polygons(polygons: PolygonSoup) -> Result<Self, Error> {
        Ok(complete(Mesh::new(polygons)?.0))
    }

    /// Starts a scene of one or more models.
    pub fn builder() -> SceneBuilder {
        SceneBuilder::default()
    }
}

/// Models on their way into one [`Scene`].
///
/// ```
/// use hiddenline::{Scene, UpAxis};
///
/// let scene = Scene::builder()
///     .up_axis(UpAxis::Y)
///     .open("examples/models/spot.obj")?
///     .open("examples/models/spot.obj")?
///     .moved(1.5, 0.0, 0.0)
///     .build()?;
/// # Ok::<(), hiddenline::Error>(())
/// ```
#[derive(Debug, Default)]
#[must_use]
pub struct SceneBuilder {
    arrangement: Arrangement,
    models: Vec<(Mesh, Pose)>,
    warnings: Vec<Warning>,
}

impl SceneBuilder {
    /// Which axis points up in the models; z unless set.
    pub fn up_axis(mut self, axis: UpAxis) -> Self {
        self.arrangement.up_axis = axis;
        self
    }

    /// Merges vertices closer together than `distance`, in model units.
    pub fn weld(mut self, distance: f64) -> Self {
        self.arrangement.weld_distance = distance;
        self
    }

    /// Adds a model file.
    ///
    /// # Errors
    /// The file cannot be read, is damaged, or has no faces.
    pub fn open(mut self, path: impl AsRef<Path>) -> Result<Self, Error> {
        let model = read_file(path.as_ref(), None)?;
        self.warnings.extend(model.warnings);
        self.models.push((model.mesh, Pose::default()));
        Ok(self)
    }

    /// Adds a model from memory; `name` is for messages.
    ///
    /// # Errors
    /// The bytes are damaged or have no faces.
    pub fn bytes(mut self, name: &str, bytes: &[u8], format: ModelFormat) -> Result<Self, Error> {
        let model = read_bytes(name, bytes, Some(format))?;
        self.warnings.extend(model.warnings);
        self.models.push((model.mesh, Pose::default()));
        Ok(self)
    }

    /// Adds a mesh.
    pub fn mesh(mut self, mesh: Mesh) -> Self {
        self.models.push((mesh, Pose::default()));
        self
    }

    /// Scales the model added last.
    pub fn scaled(self, factor: f64) -> Self {
        self.posed(|pose| pose.scale = factor)
    }

    /// Rotates the model added last by angles in degrees around x, then y, then z.
    pub fn rotated(self, x_deg: f64, y_deg: f64, z_deg: f64) -> Self {
        self.posed(|pose| pose.rotate_deg = DVec3::new(x_deg, y_deg, z_deg))
    }

    /// Moves the model added last, after scaling and rotating.
    pub fn moved(self, x: f64, y: f64, z: f64) -> Self {
        self.posed(|pose| pose.move_by = DVec3::new(x, y, z))
    }

    fn posed(mut self, change: impl FnOnce(&mut Pose)) -> Self {
        if let Some((_, pose)) = self.models.last_mut() {
            change(pose);
        }
        self
    }

    /// What the readers skipped or repaired so far.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Puts the models together and finds everything that no view changes: edges, triangles, lines
    /// of intersection.
    ///
    /// # Errors
    /// A coordinate becomes infinite, or there are too many faces for one mesh.
    pub fn build(self) -> Result<Scene, Error> {
        Ok(complete(self.arrangement.arrange(self.models)?.0))
    }
}

/// The scene with all lines that can be asked for.
fn complete(mesh: Mesh) -> Scene {
    Scene::new(mesh).with_bends().with_intersections()
}
