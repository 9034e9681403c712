//! Why a model could not be read: what is wrong, where, and how to fix it, in one line.

use std::fmt;

use thiserror::Error;

use crate::model::mesh::MeshError;

/// A model that cannot be read: the file, the line in text formats, and the fault.
///
/// Displays as one line, `file:line: what is wrong; how to fix it`.
#[derive(Debug, Error)]
pub struct ReadError {
    /// File name as given.
    pub name: String,
    /// Line in the file, counted from 1; `None` where no line is known.
    pub line: Option<usize>,
    /// What is wrong.
    #[source]
    pub fault: Fault,
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_one_line(f, &self.name)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        f.write_str(": ")?;
        write_one_line(f, &self.fault.to_string())
    }
}

/// Writes text with control characters, line ends among them, replaced by blanks.
pub(super) fn write_one_line(f: &mut fmt::Formatter<'_>, text: &str) -> fmt::Result {
    text.chars().try_for_each(|c| fmt::Write::write_char(f, if c.is_control() { ' ' } else { c }))
}

/// What is wrong with a model file.
#[derive(Debug, Error)]
pub enum Fault {
    /// The operating system refused.
    #[error("cannot be read: {0}")]
    Io(#[from] std::io::Error),
    /// Neither name nor content reveals the format.
    #[error("cannot tell the format from its name or content")]
    UnknownFormat,
    /// A web page in place of a model.
    #[error("this is a web page, not a model; download the file itself")]
    WebPage,
    /// A Git Large File Storage pointer in place of a file.
    #[error("this is a Git LFS pointer, not a model; fetch the file with `git lfs pull`")]
    LfsPointer,
    /// A STEP file, which holds curved surfaces.
    #[error(
        "STEP files are not supported; convert them to GLB in FreeCAD, or in Python (pip install \
         cascadio): cascadio.step_to_glb(\"part.step\", \"part.glb\", 0.05, 0.2)"
    )]
    Step,
    /// Zero bytes.
    #[error("the file is empty; export the model again")]
    Empty,
    /// Nothing to draw is left.
    #[error("{}", no_faces(*.vertices, *.degenerate))]
    NoFaces {
        /// Vertices that were read.
        vertices: usize,
        /// Faces that were left out for having fewer than three different corners.
        degenerate: usize,
    },
    /// A file in a text format holds bytes that are not text, and no face.
    #[error("this is not {0} text; check the file, or specify its format")]
    NotText(&'static str),
    /// A word that should be a number.
    #[error("`{0}` is not a decimal number; correct it or export the model again")]
    BadNumber(String),
    /// A number that is infinite, not a number, or too large for a double.
    #[error("`{0}` is not a finite number; correct it or export the model again")]
    NotFinite(String),
    /// A binary format holds such a number.
    #[error("{element} {index} has a coordinate that is not finite; export the model again")]
    ElementNotFinite {
        /// "vertex" or "triangle".
        element: &'static str,
        /// Counted from 1.
        index: usize,
    },
    /// Fewer numbers on a line than the record needs.
    #[error("{needed} numbers expected for a {record}, {found} found; correct the line")]
    TooFewNumbers {
        /// What the line describes.
        record: &'static str,
        /// How many numbers it takes.
        needed: usize,
        /// How many are there.
        found: usize,
    },
    /// A word that should be the number of a vertex.
    #[error("`{0}` is not the number of a vertex; correct it or export the model again")]
    BadIndex(String),
    /// Vertex 0 in a format that counts from 1.
    #[error("there is no vertex 0; OBJ counts from 1; correct it or export the model again")]
    ZeroIndex,
    /// A face uses a vertex that does not exist.
    #[error("{}", missing_vertex(.index, *.vertices))]
    MissingVertex {
        /// The vertex as the file names it.
        index: String,
        /// How many vertices there are.
        vertices: usize,
    },
    /// The file ends too early.
    #[error("the file ends early: {expected} expected, {found}; export or copy the model again")]
    Truncated {
        /// What should be there.
        expected: String,
        /// What is there.
        found: String,
    },
    /// A word that the format does not allow here.
    #[error("{expected} expected, `{found}` found; correct the line or export the model again")]
    Unexpected {
        /// What the format expects.
        expected: &'static str,
        /// What is there.
        found: String,
    },
    /// A part of a format that is not read.
    #[error("{what} cannot be read; {remedy}")]
    Unsupported {
        /// What it is.
        what: &'static str,
        /// What to do instead.
        remedy: &'static str,
    },
    /// The format is not in this build.
    #[error(transparent)]
    FeatureOff(#[from] FeatureOff),
    /// A message of a parsing library.
    #[error("{0}; correct the file or export the model again")]
    Parser(String),
    /// The faces do not form a valid mesh.
    #[error("{0}; export the model again")]
    Mesh(#[from] MeshError),
    /// The JSON of a glTF file, or what it refers to, is wrong.
    #[error("this is not valid glTF 2.0: {0}; export the model again")]
    Gltf(String),
    /// A glTF file requires an unsupported extension, usually compression.
    #[error(
        "it requires the glTF extension {0}; write it without: \
         gltf-transform copy model.glb plain.glb (npm install --global @gltf-transform/cli)"
    )]
    RequiredExtension(String),
    /// A glTF buffer is not in the model's folder.
    #[error(
        "its buffer `{0}` is not in the model's folder, and no other folder is read; put it \
         there, or export the model as .glb"
    )]
    BufferElsewhere(String),
    /// A glTF buffer is a file, but the model came without a folder, as from standard input.
    #[error(
        "its buffer `{0}` is a separate file; pass the model by file name, or export it as .glb"
    )]
    BufferWithoutFolder(String),
    /// A glTF buffer's file cannot be read.
    #[error(
        "its buffer `{name}` cannot be read: {error}; put it there, or export the model as .glb"
    )]
    MissingBuffer {
        /// The buffer as the file names it.
        name: String,
        /// What the operating system says.
        #[source]
        error: std::io::Error,
    },
    /// A 3MF archive, or the XML in it, is wrong.
    #[error("this is not valid 3MF: {0}; export the model again")]
    ThreeMf(String),
    /// Something within a part of an archive.
    #[error("part {part}, line {line}: {fault}")]
    InPart {
        /// The part, as the archive names it.
        part: String,
        /// The line in the part, counted from 1.
        line: u32,
        /// What is wrong there.
        fault: Box<Fault>,
    },
    /// An archive that would unpack to far more than a model.
    #[error("it unpacks to far more than a model of its size; export the model again")]
    TooMuchUnpacked,
    /// Nested or repeated references that would make far more of a model than its file holds.
    #[error(
        "it repeats its parts too often, or nests them too deeply; export the model in one piece"
    )]
    TooManyInstances,
}

fn no_faces(vertices: usize, degenerate: usize) -> String {
    let what = if degenerate > 0 {
        format!("all {degenerate} faces have fewer than three different corners")
    } else if vertices > 0 {
        format!("{vertices} points only")
    } else {
        "no vertices either".to_owned()
    };
    format!("no face or line to draw: {what}; export the model as a surface of polygons")
}

fn missing_vertex(index: &str, vertices: usize) -> String {
    let there_are = match vertices {
        0 => "there are no vertices".to_owned(),
        1 => "there is only one vertex".to_owned(),
        _ => format!("there are only {vertices} vertices"),
    };
    format!("a face uses vertex {index}, but {there_are}; correct it or export the model again")
}

/// A format that is not in this build.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("this build cannot read {format}; build it with the feature `{feature}`")]
pub struct FeatureOff {
    /// The format's usual name.
    pub format: &'static str,
    /// The feature of this crate that adds it.
    pub feature: &'static str,
}

/// A fault and its line, before the name of the file is added.
#[derive(Debug)]
pub(super) struct Located {
    pub(super) line: Option<usize>,
    pub(super) fault: Fault,
}

impl Located {
    pub(super) fn at(line: usize, fault: Fault) -> Self {
        Self { line: Some(line), fault }
    }
}

impl From<Fault> for Located {
    fn from(fault: Fault) -> Self {
        Self { line: None, fault }
    }
}
