//! Model files to meshes: OBJ, STL, PLY and OFF.
//!
//! ```text
//!  bytes ─► decode ─► obj │ stl │ ply │ off ─► PolygonSoup ─► Mesh::new ─► Model
//! ```
//!
//! Positions are the doubles nearest to what the file says; single precision in binary files is
//! widened, which is exact. Polygons stay whole. Colors, normals and texture coordinates are not
//! looked at, so nothing wrong with them matters.
//!
//! A reader refuses a file where geometry is lost (a bad or missing index, a number that is not
//! finite, a wrong count, an early end) and where no face is left. What it merely does not know it
//! skips with a [`Warning`]. Memory stays within a small multiple of the file's size, whatever
//! counts a header claims.

mod error;
mod materials;
mod obj;
mod obj_filter;
mod off;
#[cfg(feature = "ply")]
mod ply;
mod stl;
mod text;
mod warning;

use std::io::Read;
use std::path::Path;

pub use error::{Fault, FeatureOff, ReadError};
pub use materials::{MaterialColors, material_colors, material_files};
pub use warning::{Notice, Warning};

use crate::model::mesh::{Mesh, PolygonSoup, Repairs};
use error::Located;

/// The formats that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ModelFormat {
    /// Wavefront OBJ, text.
    Obj,
    /// STL, text or binary.
    Stl,
    /// Stanford PLY, text or binary of either byte order.
    Ply,
    /// Object File Format, text.
    Off,
}

impl ModelFormat {
    /// The format that a file name's extension stands for, in any letter case.
    pub fn from_name(path: &Path) -> Option<Self> {
        Self::from_word(path.extension()?.to_str()?)
    }

    /// The format of this name: `obj`, `stl`, `ply` or `off`, in any letter case.
    pub fn from_word(word: &str) -> Option<Self> {
        match word.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "ply" => Some(Self::Ply),
            "off" => Some(Self::Off),
            _ => None,
        }
    }

    /// The format that the first bytes look like.
    pub fn from_content(bytes: &[u8]) -> Option<Self> {
        let text = text::decode(bytes);
        if text.starts_with(b"ply\n") || text.starts_with(b"ply\r") {
            Some(Self::Ply)
        } else if stl::looks_like(&text) {
            Some(Self::Stl)
        } else if off::looks_like(&text) {
            Some(Self::Off)
        } else if obj_filter::looks_like(&text) {
            Some(Self::Obj)
        } else {
            None
        }
    }
}

/// A model as read: its mesh, and what was changed or left out on the way.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// The polygons.
    pub mesh: Mesh,
    /// The format that was read.
    pub format: ModelFormat,
    /// What was welded and dropped.
    pub repairs: Repairs,
    /// What was skipped or is otherwise worth telling; a few at most.
    pub warnings: Vec<Warning>,
}

/// Reads a model file; `-` is standard input.
///
/// Without `format`, the name's extension says what it is, and where that says nothing, the
/// content does.
///
/// # Errors
/// The file cannot be opened or read, or [`read_bytes`] fails.
pub fn read_file(path: &Path, format: Option<ModelFormat>) -> Result<Model, ReadError> {
    let is_stdin = path.as_os_str() == "-";
    let name = if is_stdin { "<stdin>".to_owned() } else { path.display().to_string() };
    let bytes = if is_stdin {
        let mut bytes = Vec::new();
        std::io::stdin().lock().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        std::fs::read(path)
    };
    match bytes {
        Ok(bytes) => read_bytes(&name, &bytes, format),
        Err(error) => Err(ReadError { name, line: None, fault: Fault::Io(error) }),
    }
}

/// Reads a model from memory; `name` is for messages, and for its extension.
///
/// # Errors
/// The format is unknown, the content is at fault (see [`Fault`]), or no face is left.
pub fn read_bytes(
    name: &str,
    bytes: &[u8],
    format: Option<ModelFormat>,
) -> Result<Model, ReadError> {
    read_draft(bytes, format.or_else(|| ModelFormat::from_name(Path::new(name)))).map_or_else(
        |Located { line, fault }| Err(ReadError { name: name.to_owned(), line, fault }),
        |(format, mesh, repairs, notices)| {
            let warnings = notices
                .into_iter()
                .map(|notice| Warning { name: name.to_owned(), notice })
                .collect();
            Ok(Model { mesh, format, repairs, warnings })
        },
    )
}

/// What a reader hands over.
#[derive(Debug, Default)]
struct Draft {
    soup: PolygonSoup,
    notices: Vec<Notice>,
    /// Faces of fewer than three corners that are not in the soup, and the line of the first.
    degenerate_faces: usize,
    first_degenerate_line: Option<usize>,
    /// Vertices that are not in the soup because no face uses them.
    unused_vertices: usize,
    /// Line records that were left out.
    n_lines: usize,
}

impl Draft {
    /// Notes a face of fewer than three corners that is left out.
    fn leave_out_face(&mut self, line: Option<usize>) {
        if self.degenerate_faces == 0 {
            self.first_degenerate_line = line;
        }
        self.degenerate_faces += 1;
    }
}

fn read_draft(
    bytes: &[u8],
    format: Option<ModelFormat>,
) -> Result<(ModelFormat, Mesh, Repairs, Vec<Notice>), Located> {
    if bytes.is_empty() {
        return Err(Fault::Empty.into());
    }
    let format = format.or_else(|| ModelFormat::from_content(bytes)).ok_or(Fault::UnknownFormat)?;
    let draft = match format {
        ModelFormat::Obj => obj::read(&text::decode(bytes)),
        ModelFormat::Stl => stl::read(bytes),
        #[cfg(feature = "ply")]
        ModelFormat::Ply => ply::read(bytes),
        #[cfg(not(feature = "ply"))]
        ModelFormat::Ply => Err(Fault::from(FeatureOff { format: "PLY", feature: "ply" }).into()),
        ModelFormat::Off => off::read(&text::decode(bytes)),
    }?;
    let vertices = draft.soup.positions.len() + draft.unused_vertices;
    let (mesh, mut repairs) = Mesh::new(draft.soup).map_err(Fault::from)?;
    repairs.degenerate_faces += draft.degenerate_faces;
    repairs.unused_vertices += draft.unused_vertices;
    if mesh.n_faces() == 0 {
        let degenerate = repairs.degenerate_faces;
        return Err(Fault::NoFaces { vertices, lines: draft.n_lines, degenerate }.into());
    }
    let mut notices = draft.notices;
    if repairs.degenerate_faces > 0 {
        // A line is only known to be the first when all degenerate faces have one.
        let first_line = draft
            .first_degenerate_line
            .filter(|_| repairs.degenerate_faces == draft.degenerate_faces);
        notices.push(Notice::DegenerateFaces { count: repairs.degenerate_faces, first_line });
    }
    Ok((format, mesh, repairs, notices))
}
