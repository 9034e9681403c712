//! The input: models, or a surface instead.

use std::error::Error;
use std::path::PathBuf;

use clap::Args;
use hiddenline::stages::model::mesh::Mesh;

use super::models::{ModelArgs, ModelFiles};
use super::paper::Notes;
use super::progress::Progress;
use super::surface::{SurfaceInput, SurfaceInputArgs};

#[derive(Args)]
#[command(mut_arg("models", |models| {
    let instead = ["expression", "grid", "points", "parametric"];
    models.required(false).conflicts_with_all(instead)
}))]
pub(super) struct InputArgs {
    #[command(flatten)]
    model: ModelArgs,
    #[command(flatten)]
    surface: FormulaArgs,
}

#[derive(Args)]
#[command(next_help_heading = "Surface")]
struct FormulaArgs {
    /// Show the surface z = EXPR, a formula in x, y, r and theta, instead of models; repeat it for more
    /// sheets
    #[arg(long = "expr", value_name = "EXPR", allow_hyphen_values = true)]
    expression: Vec<String>,
    #[command(flatten)]
    sheets: SurfaceInputArgs,
}

/// What is shown.
pub(super) enum Input {
    Files(ModelFiles),
    Surface(SurfaceInput),
}

impl InputArgs {
    /// Checks what clap cannot; the error is a message about usage.
    pub(super) fn input(self, default_samples: usize) -> Result<Input, String> {
        let FormulaArgs { expression, sheets } = self.surface;
        if let Some(sheets) = sheets.sheets(expression, default_samples)? {
            return Ok(Input::Surface(sheets));
        }
        let files = self.model.files()?;
        if files.models.is_empty() {
            return Err(
                "specify models, or a surface with --expr, --grid, --points or --parametric".into(),
            );
        }
        Ok(Input::Files(files))
    }
}

impl Input {
    /// The same with models in units of `unit_mm` millimeters, whatever their files say.
    #[must_use]
    pub(super) fn in_unit(self, unit_mm: Option<f64>) -> Self {
        match self {
            Self::Files(files) => Self::Files(files.in_unit(unit_mm)),
            sheets => sheets,
        }
    }

    pub(super) fn mesh(&self, progress: &Progress) -> Result<(Mesh, Notes), Box<dyn Error>> {
        match self {
            Self::Files(files) => files.read(progress),
            Self::Surface(sheets) => sheets.mesh(),
        }
    }

    /// What a picture of it is called.
    pub(super) fn title(&self) -> String {
        match self {
            Self::Files(files) => files.title(),
            Self::Surface(sheets) => sheets.title(),
        }
    }

    /// All files that are read.
    pub(super) fn inputs(&self) -> Box<dyn Iterator<Item = PathBuf> + '_> {
        match self {
            Self::Files(files) => Box::new(files.inputs()),
            Self::Surface(sheets) => Box::new(sheets.file().into_iter()),
        }
    }

    /// The models' files.
    pub(super) fn models(&self) -> &[PathBuf] {
        match self {
            Self::Files(files) => &files.models,
            Self::Surface(_) => &[],
        }
    }
}
