//! Model files: which ones, in what format, and how they become one mesh.

use std::collections::HashMap;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use glam::DVec3;
use hiddenline::stages::model::arrange::{Arrangement, Pose, UpAxis};
use hiddenline::stages::model::diagnosis::{open_seams, seems_y_up};
use hiddenline::stages::model::mesh::{Mesh, Repairs};
use hiddenline::stages::read::{
    Fault, Model, ModelFormat, ReadError, material_files, read_bytes, read_file_watched,
};

use super::choice::one_of;
use super::messages::counted;
use super::paper::Notes;
use super::paths::{is_dash, title};
use super::progress::Progress;
use super::values;

#[derive(Args)]
#[command(next_help_heading = "Model")]
pub(super) struct ModelArgs {
    /// Files to draw: .obj, .stl, .ply, .off, .gltf, .glb, .3mf; `-` is standard input
    #[arg(value_name = "MODEL", required = true)]
    models: Vec<PathBuf>,
    /// Format of the models, whatever their file names
    ///
    /// By default the format follows from the file extension, or else from the content.
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<ModelFormat>())]
    input_format: Option<ModelFormat>,
    /// Axis that points up in the models [default: z; y for glTF]
    #[arg(long, value_name = "AXIS", value_parser = one_of::<UpAxis>(), allow_hyphen_values = true)]
    up_axis: Option<UpAxis>,
    /// Scale all coordinates by this factor; give it once for all models, or once per model in order
    #[arg(long, value_name = "FACTOR", value_parser = values::positive)]
    scale: Vec<f64>,
    /// Rotate around x, then y, then z, in degrees; give it once for all models, or once per model
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    rotate: Vec<DVec3>,
    /// Move by this vector, after scaling and rotating; give it once for all models, or once per model
    #[arg(long = "move", value_name = "X,Y,Z", value_parser = values::vector)]
    #[arg(allow_hyphen_values = true)]
    move_by: Vec<DVec3>,
    /// Merge vertices closer than this, in model units
    #[arg(long, value_name = "D", value_parser = values::not_negative, default_value_t = 0.0)]
    weld: f64,
}

/// The models, and how they become one scene.
#[derive(Clone)]
pub(super) struct ModelFiles {
    pub(super) models: Vec<PathBuf>,
    /// One for each model.
    poses: Vec<Pose>,
    input_format: Option<ModelFormat>,
    up_axis: Option<UpAxis>,
    /// Millimeters in a model unit, which overrides the files.
    unit_mm: Option<f64>,
    arrangement: Arrangement,
    held: HeldFiles,
}

/// Contents of files that are not read from disk, by name: standard input, which can be read only once,
/// and files that were dropped on a page.
pub(super) type HeldFiles = Arc<HashMap<PathBuf, Vec<u8>>>;

impl ModelArgs {
    /// Adds models to those that were typed.
    #[must_use]
    pub(super) fn with(mut self, models: Vec<PathBuf>) -> Self {
        self.models.extend(models);
        self
    }

    /// Checks what clap cannot; the error is a message about usage.
    pub(super) fn files(self) -> Result<ModelFiles, String> {
        if self.models.iter().filter(|path| is_dash(path)).count() > 1 {
            return Err("standard input (-) can be read only once".into());
        }
        Ok(ModelFiles {
            poses: self.poses()?,
            input_format: self.input_format,
            up_axis: self.up_axis,
            unit_mm: None,
            arrangement: Arrangement { weld_distance: self.weld, merge_equal_faces: true },
            held: HeldFiles::default(),
            models: self.models,
        })
    }

    /// Where each model goes; the error is a message about usage.
    fn poses(&self) -> Result<Vec<Pose>, String> {
        let n_models = self.models.len();
        let scales = for_each_model("--scale", &self.scale, 1.0, n_models)?;
        let turns = for_each_model("--rotate", &self.rotate, DVec3::ZERO, n_models)?;
        let moves = for_each_model("--move", &self.move_by, DVec3::ZERO, n_models)?;
        let placed = scales.into_iter().zip(turns).zip(moves);
        Ok(placed
            .map(|((scale, rotate_deg), move_by)| Pose {
                scale,
                rotate_deg,
                move_by,
                ..Pose::default()
            })
            .collect())
    }
}

impl ModelFiles {
    /// The same, but equal faces are not merged.
    #[must_use]
    pub(super) fn with_equal_faces(mut self) -> Self {
        self.arrangement.merge_equal_faces = false;
        self
    }

    /// The same with models in units of `unit_mm` millimeters, which overrides the files.
    #[must_use]
    pub(super) fn in_unit(mut self, unit_mm: Option<f64>) -> Self {
        self.unit_mm = unit_mm;
        self
    }

    /// The same with files whose contents are held in memory.
    #[cfg(feature = "view")]
    #[must_use]
    pub(super) fn holding(mut self, held: HeldFiles) -> Self {
        self.held = held;
        self
    }

    /// Each model by itself.
    pub(super) fn each(self) -> Vec<Self> {
        let one = |(model, pose): (&PathBuf, &Pose)| Self {
            models: vec![model.clone()],
            poses: vec![*pose],
            ..self.clone()
        };
        self.models.iter().zip(&self.poses).map(one).collect()
    }

    fn read_one(&self, path: &Path, watch: &dyn Fn(f64)) -> Result<Model, ReadError> {
        match self.held.get(path) {
            Some(bytes) => read_bytes(&path.to_string_lossy(), bytes, self.input_format),
            None => read_file_watched(path, self.input_format, watch),
        }
    }

    /// Reads them all into one mesh.
    pub(super) fn read(&self, progress: &Progress) -> Result<(Mesh, Notes), Box<dyn Error>> {
        let mut notes = Notes::default();
        let mut models = Vec::with_capacity(self.models.len());
        let mut repairs = Repairs::default();
        let n_models = self.models.len() as f64;
        for (path, &pose) in self.models.iter().zip(&self.poses) {
            let n_read = models.len() as f64;
            let watch = |share: f64| progress.share((n_read + share) / n_models);
            let model = self.read_one(path, &watch).map_err(with_remedy)?;
            notes.warnings.extend(model.warnings.iter().map(ToString::to_string));
            notes.hints.extend(self.up_axis_hint(&model, &title(path)));
            repairs += model.repairs;
            let scale = pose.scale * self.unit_factor(&model, &title(path), &mut notes);
            let up_axis = model.format.up_axis_as_read(self.up_axis);
            models.push((model.mesh, Pose { up_axis, scale, ..pose }));
        }
        let (mesh, arranged) = self.arrangement.arrange(models)?;
        repairs += arranged;
        if mesh.n_faces() == 0 && mesh.wires().is_empty() {
            return Err("no face is left; use a smaller --weld".into());
        }
        if self.arrangement.weld_distance == 0.0 && self.arrangement.merge_equal_faces {
            notes.hints.extend(weld_hint(&mesh));
        }
        notes.summary = format!(
            "{}: {}, {}{}{}",
            self.title(),
            counted(mesh.positions().len(), "vertex", "vertices"),
            counted(mesh.n_faces(), "face", "faces"),
            match mesh.wires().len() {
                0 => String::new(),
                n => format!(", {}", counted(n, "wire", "wires")),
            },
            described(repairs)
        );
        Ok((mesh, notes))
    }

    /// A hint when an OBJ file, which cannot say, seems to be made with y up.
    fn up_axis_hint(&self, model: &Model, name: &str) -> Option<String> {
        let is_open = self.up_axis.is_none() && model.format == ModelFormat::Obj;
        (is_open && seems_y_up(&model.mesh))
            .then(|| format!("{name} seems to be modeled with y up; if so, use --up-axis y"))
    }

    /// The factor from a model's unit to that of the scene, the unit of the first model that has one.
    fn unit_factor(&self, model: &Model, name: &str, notes: &mut Notes) -> f64 {
        let (None, Some(unit_mm)) = (self.unit_mm, model.unit_mm) else { return 1.0 };
        let scene_mm = *notes.unit_mm.get_or_insert(unit_mm);
        if scene_mm == unit_mm {
            return 1.0;
        }
        let factor = unit_mm / scene_mm;
        notes.hints.push(format!(
            "{name} is in units of {unit_mm} mm and was scaled by {factor}, to units of \
             {scene_mm} mm; --unit keeps all models as they are"
        ));
        factor
    }

    /// All files that are read: the models, and those that they name.
    pub(super) fn inputs(&self) -> impl Iterator<Item = PathBuf> {
        let named = self.models.iter().flat_map(|path| material_files(path));
        self.models.iter().cloned().chain(named)
    }

    /// The names of the models, without folders.
    pub(super) fn title(&self) -> String {
        self.models.iter().map(|path| title(path)).collect::<Vec<_>>().join(", ")
    }
}

/// The values of an option that may be given once for all models, once for each, or not at all.
fn for_each_model<T: Copy>(
    name: &str,
    given: &[T],
    default: T,
    n_models: usize,
) -> Result<Vec<T>, String> {
    match *given {
        [] => Ok(vec![default; n_models]),
        [one] => Ok(vec![one; n_models]),
        _ if given.len() == n_models => Ok(given.to_vec()),
        _ => Err(format!(
            "{name} is given {} times for {n_models} models; use it once for all, or once for each",
            given.len()
        )),
    }
}

/// An error in a model file with the option that may help.
fn with_remedy(error: ReadError) -> Box<dyn Error> {
    match error.fault {
        Fault::UnknownFormat => {
            let formats = "obj, stl, ply, off, gltf or 3mf";
            format!("{error}; if it is a model, use --input-format {formats}").into()
        }
        _ => error.into(),
    }
}

/// A hint when vertices that should be shared are only nearly equal.
fn weld_hint(mesh: &Mesh) -> Option<String> {
    let seams = open_seams(mesh)?;
    Some(format!(
        "{} of {} edges belong to only one face, perhaps because vertices are only nearly equal; \
         --weld {} merges them",
        seams.n_open, seams.n_edges, seams.distance
    ))
}

fn described(repairs: Repairs) -> String {
    [
        (repairs.welded_vertices, "equal vertex merged", "equal vertices merged"),
        (repairs.unused_vertices, "unused vertex left out", "unused vertices left out"),
        (repairs.degenerate_faces, "degenerate face left out", "degenerate faces left out"),
        (repairs.repeated_corners, "repeated corner left out", "repeated corners left out"),
        (
            repairs.dropped_wires,
            "repeated or zero-length wire left out",
            "repeated or zero-length wires left out",
        ),
        (repairs.equal_faces, "equal face merged", "equal faces merged"),
    ]
    .iter()
    .filter(|(count, ..)| *count > 0)
    .map(|&(count, one, many)| format!(", {}", counted(count, one, many)))
    .collect()
}
