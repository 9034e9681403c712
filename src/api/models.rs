//! From model files, or faces in memory, to a scene.

use std::path::Path;

use glam::DVec3;

use super::Error;
use crate::model::arrange::{Arrangement, Pose, UpAxis};
use crate::model::mesh::{Mesh, PolygonSoup};
use crate::model::scene::Scene;
use crate::model::smooth::{SmoothParts, smooth as refine};
use crate::read::{Model, ModelFormat, Warning, read_bytes, read_file};

impl Scene {
    /// Reads one model file, z up. The format follows from the extension, or else from the content.
    ///
    /// [`Scene::builder`] combines several models, turns models made with y up, and merges vertices.
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
    /// use hiddenline::glam::dvec3;
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
    up_axis: Option<UpAxis>,
    weld_distance: f64,
    keeps_equal_faces: bool,
    /// What is refined, and to which distance.
    smooth: Option<(SmoothParts, f64)>,
    /// Millimeters in a unit of the scene, once a model says so.
    unit_mm: Option<f64>,
    /// Each model, its place, and its format if it came in one.
    models: Vec<(Mesh, Pose, Option<ModelFormat>)>,
    warnings: Vec<Warning>,
}

impl SceneBuilder {
    /// Which axis points up in the models; unless set, y in glTF and z in all other formats.
    pub fn up_axis(mut self, axis: UpAxis) -> Self {
        self.up_axis = Some(axis);
        self
    }

    /// Merges vertices closer together than `distance`, in model units.
    pub fn weld(mut self, distance: f64) -> Self {
        self.weld_distance = distance;
        self
    }

    /// Keeps duplicate faces, for exact drawings. Unless set, only one of each is kept.
    pub fn keep_equal_faces(mut self) -> Self {
        self.keeps_equal_faces = true;
        self
    }

    /// Refines curved parts until no edge midpoint is farther than `tolerance`, in model units, from the
    /// curved surface: facets no longer show in silhouettes. Flat faces stay flat.
    ///
    /// It stops at four million triangles. A quarter of the pen width, divided by the millimeters per model
    /// unit on paper, is a tolerance too small to see.
    ///
    /// ```
    /// use hiddenline::{Scene, SmoothParts, UpAxis};
    ///
    /// let model = "examples/models/spot.obj";
    /// let faceted = Scene::builder().up_axis(UpAxis::Y).open(model)?.build()?;
    /// let curved =
    ///     Scene::builder().up_axis(UpAxis::Y).open(model)?.smooth(SmoothParts::Below(60.0), 1e-3).build()?;
    /// assert!(curved.mesh().n_faces() > 2 * faceted.mesh().n_faces());
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    pub fn smooth(mut self, parts: SmoothParts, tolerance: f64) -> Self {
        self.smooth = Some((parts, tolerance));
        self
    }

    /// Adds a model file.
    ///
    /// Formats that define a unit (glTF, 3MF) are scaled to that of the first such model.
    ///
    /// # Errors
    /// The file cannot be read, is damaged, or has no faces.
    pub fn open(mut self, path: impl AsRef<Path>) -> Result<Self, Error> {
        self.push(read_file(path.as_ref(), None)?);
        Ok(self)
    }

    /// Adds a model from memory; `name` is for messages.
    ///
    /// # Errors
    /// The bytes are damaged or have no faces.
    pub fn bytes(mut self, name: &str, bytes: &[u8], format: ModelFormat) -> Result<Self, Error> {
        self.push(read_bytes(name, bytes, Some(format))?);
        Ok(self)
    }

    /// Adds a mesh.
    pub fn mesh(mut self, mesh: Mesh) -> Self {
        self.models.push((mesh, Pose::default(), None));
        self
    }

    fn push(&mut self, model: Model) {
        self.warnings.extend(model.warnings);
        let scale = match model.unit_mm {
            Some(unit_mm) => unit_mm / *self.unit_mm.get_or_insert(unit_mm),
            None => 1.0,
        };
        let pose = Pose { scale, ..Pose::default() };
        self.models.push((model.mesh, pose, Some(model.format)));
    }

    /// Scales the model added last.
    pub fn scaled(self, factor: f64) -> Self {
        self.posed(|pose| pose.scale *= factor)
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
        if let Some((_, pose, _)) = self.models.last_mut() {
            change(pose);
        }
        self
    }

    /// What the readers skipped or repaired so far.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Combines the models, merges equal faces, and finds everything that does not depend on the view: edges,
    /// triangles, intersection lines.
    ///
    /// # Errors
    /// A coordinate becomes infinite, or there are too many faces for one mesh.
    pub fn build(self) -> Result<Scene, Error> {
        let Self { up_axis, weld_distance, keeps_equal_faces, smooth, models, .. } = self;
        let upright = |(mesh, pose, format): (Mesh, Pose, Option<ModelFormat>)| {
            let up_axis = match format {
                Some(format) => format.up_axis_as_read(up_axis),
                None => up_axis.unwrap_or_default(),
            };
            (mesh, Pose { up_axis, ..pose })
        };
        let arrangement = Arrangement { weld_distance, merge_equal_faces: !keeps_equal_faces };
        let mesh = arrangement.arrange(models.into_iter().map(upright).collect())?.0;
        Ok(complete(match smooth {
            Some((parts, tolerance)) => refine(&mesh, parts, tolerance)?.0,
            None => mesh,
        }))
    }
}

/// The scene with all lines that a drawing can select.
fn complete(mesh: Mesh) -> Scene {
    Scene::new(mesh).with_bends().with_flush_edges().with_intersections()
}
