//! What a reader left out or reinterpreted in a model that can still be drawn.

use std::fmt;

use super::error::write_one_line;

/// A notice about a model, with its file name.
///
/// Displays as one line, `file: what`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// File name as given.
    pub name: String,
    /// What happened.
    pub notice: Notice,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_one_line(f, &self.name)?;
        f.write_str(": ")?;
        write_one_line(f, &self.notice.to_string())
    }
}

/// What was left out or reinterpreted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Notice {
    /// Faces with fewer than three different corners.
    DegenerateFaces {
        /// How many.
        count: usize,
        /// Line of the first, where the reader knows it.
        first_line: Option<usize>,
    },
    /// Points, which are not drawn: `p` records of OBJ, points of glTF.
    Points {
        /// How many records, or points in glTF.
        count: usize,
        /// Line of the first, in text formats.
        first_line: Option<usize>,
    },
    /// Text that departs from the format but whose meaning is clear.
    Irregular {
        /// Line of it.
        line: usize,
        /// What was found, and how it was handled.
        what: &'static str,
    },
    /// A count in a header that disagrees with the size of the file; everything in the file is read.
    WrongCount {
        /// The count in the header.
        stated: u64,
        /// How many there are.
        present: u64,
        /// What is counted.
        element: &'static str,
    },
    /// Records of one unknown kind.
    UnknownRecord {
        /// Their first word.
        keyword: String,
        /// How many.
        count: usize,
        /// Line of the first.
        first_line: usize,
    },
    /// Records of further unknown kinds.
    OtherUnknownRecords {
        /// How many.
        count: usize,
    },
    /// Bytes after the end of the model.
    TrailingBytes {
        /// How many.
        count: usize,
    },
    /// Indices at the end of a list that make no whole triangle or line.
    LeftoverIndices {
        /// How many.
        count: usize,
    },
    /// An extension of the format that adds to the shape and is not read.
    Extension {
        /// Its name.
        name: String,
    },
}

impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let first = |line: &Option<usize>| match line {
            Some(line) => format!(", first on line {line}"),
            None => String::new(),
        };
        match self {
            Self::DegenerateFaces { count, first_line } => write!(
                f,
                "{} with fewer than three different corners left out{}",
                counted(*count, "face"),
                first(first_line)
            ),
            Self::Points { count, first_line } => {
                write!(f, "{} left out{}", counted(*count, "point"), first(first_line))
            }
            Self::Irregular { line, what } => write!(f, "{what} (line {line})"),
            Self::WrongCount { stated, present, element } => write!(
                f,
                "the header says {}, the file holds {present}; all of these are read",
                counted(*stated as usize, element)
            ),
            Self::UnknownRecord { keyword, count, first_line } => write!(
                f,
                "unknown record `{keyword}` skipped ({}, first on line {first_line})",
                counted(*count, "time")
            ),
            Self::OtherUnknownRecords { count } => {
                write!(f, "{} of other unknown kinds skipped", counted(*count, "record"))
            }
            Self::TrailingBytes { count } => {
                write!(f, "{} after the end of the model ignored", counted(*count, "byte"))
            }
            Self::LeftoverIndices { count } => write!(
                f,
                "{} at the end of a list left out: they make no whole triangle or line",
                counted(*count, "vertex number")
            ),
            Self::Extension { name } => write!(
                f,
                "the extension {name} is not read: parts of the model may be missing; export the \
                 model without it"
            ),
        }
    }
}

fn counted(count: usize, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{plural}")
}
