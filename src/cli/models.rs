//! Model files: which, in what format, and how they become one mesh.

use std::error::Error;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use glam::DVec3;
use hiddenline::stages::model::arrange::{Arrangement, Pose, UpAxis};
use hiddenline::stages::model::mesh::{Mesh, Repairs};
use hiddenline::stages::read::{ModelFormat, material_files, read_file};

use super::messages::counted;
use super::paper::Notes;
use super::paths::{is_dash, title};
use super::values;

#[derive(Args)]
#[command(next_help_heading = "Model")]
pub(super) struct ModelArgs {
    /// Files to draw: .obj, .stl, .ply, .off; `-` is standard input
    #[arg(value_name = "MODEL", required = true)]
    models: Vec<PathBuf>,
    /// Format of the models, whatever they are named
    ///
    /// Without it the name's extension decides, and where that says nothing, the content.
    #[arg(long, value_name = "FORMAT", value_enum)]
    input_format: Option<InputFormat>,
    /// Axis that points up in the models
    #[arg(long, value_name = "AXIS", value_enum, default_value = "z")]
    up_axis: Axis,
    /// Factor for all coordinates; once for all models, or once for each in their order
    #[arg(long, value_name = "FACTOR", value_parser = values::positive)]
    scale: Vec<f64>,
    /// Turn by angles in degrees around x, then y, then z; once for all models, or once for each
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    rotate: Vec<DVec3>,
    /// Move by so much, after scaling and turning; once for all models, or once for each
    #[arg(long = "move", value_name = "X,Y,Z", value_parser = values::vector)]
    #[arg(allow_hyphen_values = true)]
    move_by: Vec<DVec3>,
    /// Make one vertex of those closer together than this, in model units
    #[arg(long, value_name = "D", value_parser = values::not_negative, default_value_t = 0.0)]
    weld: f64,
}

#[derive(Clone, Copy, ValueEnum)]
enum InputFormat {
    Obj,
    Stl,
    Ply,
    Off,
}

#[derive(Clone, Copy, ValueEnum)]
enum Axis {
    Y,
    Z,
}

/// The models, and how they become one scene.
pub(super) struct ModelFiles {
    pub(super) models: Vec<PathBuf>,
    /// One for each model.
    poses: Vec<Pose>,
    input_format: Option<ModelFormat>,
    arrangement: Arrangement,
}

impl ModelArgs {
    /// Checks what clap cannot; the error is a message about usage.
    pub(super) fn files(self) -> Result<ModelFiles, String> {
        if self.models.iter().filter(|path| is_dash(path)).count() > 1 {
            return Err("standard input (-) can be read only once".into());
        }
        Ok(ModelFiles {
            poses: self.poses()?,
            input_format: self.input_format.map(InputFormat::format),
            arrangement: Arrangement {
                up_axis: match self.up_axis {
                    Axis::Y => UpAxis::Y,
                    Axis::Z => UpAxis::Z,
                },
                weld_distance: self.weld,
            },
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
            .map(|((scale, rotate_deg), move_by)| Pose { scale, rotate_deg, move_by })
            .collect())
    }
}

impl ModelFiles {
    /// Reads them all into one mesh.
    pub(super) fn read(&self) -> Result<(Mesh, Notes), Box<dyn Error>> {
        let mut notes = Notes::default();
        let mut models = Vec::with_capacity(self.models.len());
        let mut repairs = Repairs::default();
        for (path, &pose) in self.models.iter().zip(&self.poses) {
            let model = read_file(path, self.input_format)?;
            notes.warnings.extend(model.warnings.iter().map(ToString::to_string));
            repairs += model.repairs;
            models.push((model.mesh, pose));
        }
        let (mesh, arranged) = self.arrangement.arrange(models)?;
        repairs += arranged;
        if mesh.n_faces() == 0 {
            return Err("no face is left; give a smaller --weld".into());
        }
        notes.summary = format!(
            "{}: {}, {}{}",
            self.title(),
            counted(mesh.positions().len(), "vertex", "vertices"),
            counted(mesh.n_faces(), "face", "faces"),
            described(repairs)
        );
        Ok((mesh, notes))
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

/// The values of an option that is given not at all, once for all models, or once for each.
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
            "{name} is given {} times for {n_models} models; give it once for all, or once for each",
            given.len()
        )),
    }
}

impl InputFormat {
    fn format(self) -> ModelFormat {
        match self {
            Self::Obj => ModelFormat::Obj,
            Self::Stl => ModelFormat::Stl,
            Self::Ply => ModelFormat::Ply,
            Self::Off => ModelFormat::Off,
        }
    }
}

fn described(repairs: Repairs) -> String {
    [
        (repairs.welded_vertices, "equal vertex merged", "equal vertices merged"),
        (repairs.unused_vertices, "unused vertex left out", "unused vertices left out"),
        (repairs.degenerate_faces, "degenerate face left out", "degenerate faces left out"),
        (repairs.repeated_corners, "repeated corner left out", "repeated corners left out"),
        (
            repairs.dropped_wires,
            "wire without length or given twice left out",
            "wires without length or given twice left out",
        ),
    ]
    .iter()
    .filter(|(count, ..)| *count > 0)
    .map(|&(count, one, many)| format!(", {}", counted(count, one, many)))
    .collect()
}
