//! Model files to meshes: OBJ, STL, PLY, OFF, glTF and 3MF.
//!
//! ```text
//!  bytes ─► decode ─► obj │ stl │ ply │ off │ gltf │ three_mf ─► PolygonSoup ─► Mesh::new ─► Model
//! ```
//!
//! Positions are the doubles nearest to the numbers in the file; single precision in binary files is
//! widened, which is exact. Polygons stay whole. Polylines become wires. Texture coordinates are
//! ignored, so errors in them do not matter.
//!
//! A reader refuses a file where geometry is lost (a bad or missing index, a number in use that is not
//! finite, a wrong count, an early end) and where neither a face nor a wire is left. Unknown records are
//! skipped with a [`Warning`]. Memory stays within a small multiple of the file's size, whatever counts a
//! header claims.

mod error;
#[cfg(feature = "gltf")]
mod gltf;
mod materials;
mod mtl;
mod obj;
mod obj_filter;
mod obj_normals;
mod off;
mod parts;
#[cfg(feature = "ply")]
mod ply;
mod stl;
mod text;
#[cfg(feature = "3mf")]
mod three_mf;
mod warning;
mod watch;

use std::io::Read;
use std::path::Path;

pub use error::{Fault, FeatureOff, ReadError};
pub use materials::{MaterialColors, material_colors, material_files};
pub use mtl::{MaterialFile, read_materials};
pub use warning::{Notice, Warning};

use crate::model::arrange::UpAxis;
use crate::model::mesh::{Mesh, PolygonSoup, Repairs};
use error::Located;
use parts::PartTable;
use watch::Watch;

/// Model formats.
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
    /// glTF 2.0, as JSON or as one binary file (GLB).
    Gltf,
    /// 3D Manufacturing Format, the ZIP archive that slicers save.
    ThreeMf,
}

impl ModelFormat {
    /// All formats.
    pub const ALL: [Self; 6] =
        [Self::Obj, Self::Stl, Self::Ply, Self::Off, Self::Gltf, Self::ThreeMf];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Stl => "stl",
            Self::Ply => "ply",
            Self::Off => "off",
            Self::Gltf => "gltf",
            Self::ThreeMf => "3mf",
        }
    }

    /// The format of a file name's extension, in any letter case.
    pub fn from_name(path: &Path) -> Option<Self> {
        Self::from_word(path.extension()?.to_str()?)
    }

    /// The format of this name: `obj`, `stl`, `ply`, `off`, `gltf`, `glb` or `3mf`, in any letter
    /// case.
    pub fn from_word(word: &str) -> Option<Self> {
        match word.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "ply" => Some(Self::Ply),
            "off" => Some(Self::Off),
            "gltf" | "glb" => Some(Self::Gltf),
            "3mf" => Some(Self::ThreeMf),
            _ => None,
        }
    }

    /// The axis that points up in a mesh as it was read, if `in_file` does in its file.
    ///
    /// Only glTF defines that axis, y, and is turned to z-up when it is read. Without `in_file` the
    /// format decides: all meshes are then z-up.
    pub fn up_axis_as_read(self, in_file: Option<UpAxis>) -> UpAxis {
        match (self, in_file) {
            (_, None) | (Self::Gltf, Some(UpAxis::Y)) => UpAxis::Z,
            (Self::Gltf, Some(UpAxis::Z)) => UpAxis::NegativeY,
            (Self::Gltf, Some(UpAxis::NegativeY)) => UpAxis::NegativeZ,
            (Self::Gltf, Some(UpAxis::NegativeZ)) => UpAxis::Y,
            (_, Some(axis)) => axis,
        }
    }

    /// The format that the content suggests.
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
            Self::from_container(bytes)
        }
    }

    /// The format of a file that is not plain text.
    fn from_container(bytes: &[u8]) -> Option<Self> {
        #[cfg(feature = "gltf")]
        if gltf::looks_like(bytes) {
            return Some(Self::Gltf);
        }
        #[cfg(feature = "3mf")]
        if three_mf::looks_like(bytes) {
            return Some(Self::ThreeMf);
        }
        let _ = bytes;
        None
    }
}

/// A model as read: its mesh, and what was changed or left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// The polygons.
    pub mesh: Mesh,
    /// The format that was read.
    pub format: ModelFormat,
    /// What was merged and left out.
    pub repairs: Repairs,
    /// Millimeters per model unit, where the format defines it: 1000 in glTF, as written in 3MF.
    pub unit_mm: Option<f64>,
    /// What was skipped, and other remarks; a few at most.
    pub warnings: Vec<Warning>,
}

/// Reads a model file; `-` is standard input.
///
/// Without `format`, the format follows from the extension, or else from the content.
///
/// # Errors
/// The file cannot be opened or read, or [`read_bytes`] fails.
pub fn read_file(path: &Path, format: Option<ModelFormat>) -> Result<Model, ReadError> {
    read_file_watched(path, format, &|_| {})
}

/// The same, and tells `watch` now and then which share of the file has been read.
///
/// # Errors
/// As [`read_file`].
pub fn read_file_watched(
    path: &Path,
    format: Option<ModelFormat>,
    watch: &dyn Fn(f64),
) -> Result<Model, ReadError> {
    let is_stdin = path.as_os_str() == "-";
    let name = if is_stdin { "<stdin>".to_owned() } else { path.display().to_string() };
    let bytes = if is_stdin {
        let mut bytes = Vec::new();
        std::io::stdin().lock().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        std::fs::read(path)
    };
    let folder = if is_stdin { None } else { Some(path.parent().unwrap_or(Path::new(""))) };
    match bytes {
        Ok(bytes) => read_named(&name, &bytes, format, folder, watch),
        Err(error) => Err(ReadError { name, line: None, fault: Fault::Io(error) }),
    }
}

/// Reads a model from memory; `name` is for messages, and its extension gives the format.
///
/// # Errors
/// The format is unknown, the content is faulty (see [`Fault`]), or neither a face nor a wire is left.
pub fn read_bytes(
    name: &str,
    bytes: &[u8],
    format: Option<ModelFormat>,
) -> Result<Model, ReadError> {
    read_named(name, bytes, format, None, &|_| {})
}

/// Reads a model; files that it refers to are looked for in `folder`.
fn read_named(
    name: &str,
    bytes: &[u8],
    format: Option<ModelFormat>,
    folder: Option<&Path>,
    watch: &dyn Fn(f64),
) -> Result<Model, ReadError> {
    let path = Path::new(name);
    read_model(path, bytes, format.or_else(|| ModelFormat::from_name(path)), folder, watch)
        .map_err(|Located { line, fault }| ReadError { name: name.to_owned(), line, fault })
}

/// What a reader found in a file.
#[derive(Debug, Default)]
struct Parsed {
    soup: PolygonSoup,
    notices: Vec<Notice>,
    /// Vertices of the soup with a coordinate that is not finite: index, line, fault.
    unsound_vertices: Vec<(usize, Option<usize>, Fault)>,
    /// Millimeters in a model unit, if the format says so.
    unit_mm: Option<f64>,
    /// Faces of fewer than three corners that are not in the soup, and the line of the first.
    degenerate_faces: usize,
    first_degenerate_line: Option<usize>,
    /// Vertices that are not in the soup because nothing uses them.
    unused_vertices: usize,
}

impl Parsed {
    /// Notes a face of fewer than three corners that is left out.
    fn leave_out_face(&mut self, line: Option<usize>) {
        if self.degenerate_faces == 0 {
            self.first_degenerate_line = line;
        }
        self.degenerate_faces += 1;
    }

    /// Notes that the next vertex of the soup is not finite, which matters only if it is used.
    fn leave_unsound_vertex(&mut self, line: Option<usize>, fault: Fault) {
        self.unsound_vertices.push((self.soup.positions.len(), line, fault));
    }

    /// Completes the parts that the faces refer to.
    fn set_parts(&mut self, parts: PartTable) {
        self.soup.parts = parts.into_parts();
        if self.soup.parts.is_empty() {
            self.soup.face_parts.clear();
        }
    }

    /// Refuses a vertex in use that is not finite.
    fn check_vertices(&mut self) -> Result<(), Located> {
        if self.unsound_vertices.is_empty() {
            return Ok(());
        }
        let mut is_used = vec![false; self.soup.positions.len()];
        for &vertex in self.soup.corners.iter().chain(self.soup.wires.as_flattened()) {
            if let Some(is_used) = is_used.get_mut(vertex as usize) {
                *is_used = true;
            }
        }
        let unsound = std::mem::take(&mut self.unsound_vertices);
        match unsound.into_iter().find(|(vertex, ..)| is_used[*vertex]) {
            Some((_, line, fault)) => Err(Located { line, fault }),
            None => Ok(()),
        }
    }
}

fn read_model(
    path: &Path,
    bytes: &[u8],
    format: Option<ModelFormat>,
    folder: Option<&Path>,
    watch: &dyn Fn(f64),
) -> Result<Model, Located> {
    if bytes.is_empty() {
        return Err(Fault::Empty.into());
    }
    refuse_other_files(path, bytes, format)?;
    let format = format.or_else(|| ModelFormat::from_content(bytes)).ok_or(Fault::UnknownFormat)?;
    let watch = Watch::new(watch, bytes.len());
    let mut parsed = match format {
        ModelFormat::Obj => obj::read(&text::decode(bytes), watch),
        ModelFormat::Stl => stl::read(bytes, &watch),
        #[cfg(feature = "ply")]
        ModelFormat::Ply => ply::read(bytes, &watch),
        #[cfg(not(feature = "ply"))]
        ModelFormat::Ply => Err(Fault::from(FeatureOff { format: "PLY", feature: "ply" }).into()),
        ModelFormat::Off => off::read(&text::decode(bytes), &watch),
        #[cfg(feature = "gltf")]
        ModelFormat::Gltf => gltf::read(bytes, folder),
        #[cfg(not(feature = "gltf"))]
        ModelFormat::Gltf => {
            let _ = folder;
            Err(Fault::from(FeatureOff { format: "glTF", feature: "gltf" }).into())
        }
        #[cfg(feature = "3mf")]
        ModelFormat::ThreeMf => three_mf::read(bytes),
        #[cfg(not(feature = "3mf"))]
        ModelFormat::ThreeMf => {
            Err(Fault::from(FeatureOff { format: "3MF", feature: "3mf" }).into())
        }
    }?;
    parsed.check_vertices()?;
    let vertices = parsed.soup.positions.len() + parsed.unused_vertices;
    let (mesh, mut repairs) = Mesh::new(parsed.soup.in_order_of_use()).map_err(Fault::from)?;
    repairs.degenerate_faces += parsed.degenerate_faces;
    repairs.unused_vertices += parsed.unused_vertices;
    if mesh.n_faces() == 0 && mesh.wires().is_empty() {
        let degenerate = repairs.degenerate_faces;
        return Err(Fault::NoFaces { vertices, degenerate }.into());
    }
    let mut notices = parsed.notices;
    if repairs.degenerate_faces > 0 {
        // A line is only known to be the first when all degenerate faces have one.
        let first_line = parsed
            .first_degenerate_line
            .filter(|_| repairs.degenerate_faces == parsed.degenerate_faces);
        notices.push(Notice::DegenerateFaces { count: repairs.degenerate_faces, first_line });
    }
    let name = path.display().to_string();
    let warnings = notices.into_iter().map(|notice| Warning { name: name.clone(), notice });
    let warnings = warnings.collect();
    Ok(Model { mesh, format, repairs, unit_mm: parsed.unit_mm, warnings })
}

/// Refuses files passed by mistake: web pages, Git LFS pointers, STEP files.
fn refuse_other_files(path: &Path, bytes: &[u8], format: Option<ModelFormat>) -> Result<(), Fault> {
    let text = text::decode(&bytes[..bytes.len().min(1 << 12)]);
    let text = text.trim_ascii_start();
    let begins = |start: &[u8]| {
        text.get(..start.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(start))
    };
    let is_step_name = || {
        let extension = path.extension().and_then(|extension| extension.to_str());
        extension.is_some_and(|e| ["step", "stp"].iter().any(|name| e.eq_ignore_ascii_case(name)))
    };
    if begins(b"<!doctype html") || begins(b"<html") {
        Err(Fault::WebPage)
    } else if begins(b"version https://git-lfs") {
        Err(Fault::LfsPointer)
    } else if begins(b"ISO-10303-21") || format.is_none() && is_step_name() {
        Err(Fault::Step)
    } else {
        Ok(())
    }
}
