//! OFF, the text format of Geomview: `OFF`, counts, one vertex a line, one face a line.
//!
//! There is no crate for this format alone; mesh toolkits that read it bring their own mesh types and
//! single precision.
//!
//! Prefixes (`C`, `N`, `ST`: colors, normals, texture coordinates) add numbers after the position.
//! Colors count, those after the corners of a face before those of its vertices: whole numbers from 0
//! to 255, or decimal fractions from 0 to 1. A single whole number is an index into a color map that
//! is not part of the file, so it is ignored.

use glam::DVec3;

use super::Parsed;
use super::error::{Fault, Located};
use super::parts::{PartTable, color_of_parts, mean_color};
use super::text::{Words, number, shown};
use super::warning::Notice;
use super::watch::Watch;
use crate::model::mesh::MeshError;

/// Whether the first word of a text is a keyword of the format, perhaps with a count stuck to it.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    Words::new(bytes, Some(b'#')).next().and_then(keyword).is_some()
}

/// The prefix of a word like `COFF` or `off8`, and what follows it.
fn keyword(word: &[u8]) -> Option<(&[u8], &[u8])> {
    let at = word.windows(3).position(|window| window.eq_ignore_ascii_case(b"OFF"))?;
    let (prefix, rest) = (&word[..at], &word[at + 3..]);
    let is_keyword =
        prefix.iter().all(|c| b"STCN4nstc".contains(c)) && rest.iter().all(|c| c.is_ascii_digit());
    is_keyword.then_some((prefix, rest))
}

/// Reads decoded text.
pub(super) fn read(bytes: &[u8], watch: &Watch<'_>) -> Result<Parsed, Located> {
    let mut words = Words::new(bytes, Some(b'#'));
    let header = read_header(&mut words)?;
    let mut parsed = Parsed::default();
    let mut vertex_colors = Vec::new();
    for vertex in 0..header.n_vertices {
        watch.at(bytes.len() - words.rest().len());
        let first = first_on_line(&mut words, "vertices", header.n_vertices, vertex)?;
        read_vertex(&mut words, first, &mut parsed).map_err(|f| Located::at(words.line(), f))?;
        if header.has_vertex_colors {
            for _ in 0..header.n_between {
                words.next_on_line();
            }
            vertex_colors.push(read_color(&mut words));
        }
        words.skip_line();
    }
    let mut parts = PartTable::default();
    for face in 0..header.n_faces {
        watch.at(bytes.len() - words.rest().len());
        let first = first_on_line(&mut words, "faces", header.n_faces, face)?;
        let start = parsed.soup.corners.len();
        read_face(&mut words, first, &mut parsed).map_err(|f| Located::at(words.line(), f))?;
        let corners = parsed.soup.corners[start..].iter();
        if corners.len() > 0 {
            let color = read_color(&mut words).or_else(|| {
                mean_color(
                    corners.filter_map(|&v| vertex_colors.get(v as usize).copied().flatten()),
                )
            });
            parsed.soup.face_parts.push(parts.index_of_color(color));
        }
        words.skip_line();
    }
    parsed.set_parts(parts);
    let start = words.clone();
    if words.next().is_some() {
        parsed.notices.push(Notice::TrailingBytes { count: start.rest().trim_ascii().len() });
    }
    Ok(parsed)
}

/// What the first lines say.
struct OffHeader {
    n_vertices: u64,
    n_faces: u64,
    has_vertex_colors: bool,
    /// Numbers between a vertex's position and its color.
    n_between: usize,
}

/// Reads the keyword, which may be missing, and the counts; refuses variants that mean other numbers.
fn read_header(words: &mut Words<'_>) -> Result<OffHeader, Located> {
    let start = words.clone();
    let word = words.next().unwrap_or_default();
    let Some((prefix, stuck_count)) = keyword(word) else {
        *words = start;
        if word.first().is_some_and(u8::is_ascii_digit) {
            return read_counts(words, None, b"");
        }
        let fault = Fault::Unexpected { expected: "the word `OFF`", found: shown(word) };
        return Err(Located::at(1, fault));
    };
    let after_keyword = words.clone();
    let is_binary = words.next_on_line().is_some_and(|word| word.eq_ignore_ascii_case(b"BINARY"));
    *words = after_keyword;
    let what = if is_binary {
        "binary OFF"
    } else if prefix.iter().any(|c| b"4n".contains(c)) {
        "OFF with four or more coordinates a vertex"
    } else {
        let stuck_count = (!stuck_count.is_empty()).then_some(stuck_count);
        return read_counts(words, stuck_count, prefix);
    };
    let remedy = "export the model as OFF text with three coordinates a vertex, or as PLY";
    Err(Located::at(words.line(), Fault::Unsupported { what, remedy }))
}

fn read_counts(
    words: &mut Words<'_>,
    n_vertices: Option<&[u8]>,
    prefix: &[u8],
) -> Result<OffHeader, Located> {
    let n_vertices = match n_vertices {
        Some(word) => count(words, word, "the number of vertices")?,
        None => read_count(words, "the number of vertices")?,
    };
    let n_faces = read_count(words, "the number of faces")?;
    words.skip_line();
    Ok(OffHeader {
        n_vertices,
        n_faces,
        has_vertex_colors: prefix.iter().any(|c| b"Cc".contains(c)),
        n_between: if prefix.contains(&b'N') { 3 } else { 0 },
    })
}

/// The color in what is left of a line.
fn read_color(words: &mut Words<'_>) -> Option<[u8; 3]> {
    let mut color = [0.0; 3];
    let mut is_whole = true;
    for part in &mut color {
        let word = words.next_on_line()?;
        is_whole &= natural(word).is_some();
        *part = number(word).ok()?;
    }
    Some(color_of_parts(if is_whole { color.map(|part| part / 255.0) } else { color }))
}

fn read_vertex(words: &mut Words<'_>, first: &[u8], parsed: &mut Parsed) -> Result<(), Fault> {
    let mut point = [0.0; 3];
    let mut not_finite = None;
    for (i, coordinate) in point.iter_mut().enumerate() {
        let word = if i == 0 { Some(first) } else { words.next_on_line() };
        let word = word.ok_or(Fault::TooFewNumbers { record: "vertex", needed: 3, found: i })?;
        *coordinate = match number(word) {
            Err(fault @ Fault::NotFinite(_)) => {
                not_finite.get_or_insert(fault);
                f64::NAN
            }
            other => other?,
        };
    }
    if let Some(fault) = not_finite {
        parsed.leave_unsound_vertex(Some(words.line()), fault);
    }
    parsed.soup.positions.push(DVec3::from_array(point));
    Ok(())
}

fn read_count(words: &mut Words<'_>, expected: &'static str) -> Result<u64, Located> {
    let word = words.next().unwrap_or_default();
    count(words, word, expected)
}

fn count(words: &Words<'_>, word: &[u8], expected: &'static str) -> Result<u64, Located> {
    natural(word).ok_or_else(|| {
        Located::at(words.line(), Fault::Unexpected { expected, found: shown(word) })
    })
}

fn natural(word: &[u8]) -> Option<u64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// The first word of the next line that has one.
fn first_on_line<'a>(
    words: &mut Words<'a>,
    what: &str,
    expected: u64,
    present: u64,
) -> Result<&'a [u8], Located> {
    words.next().ok_or_else(|| {
        let fault = Fault::Truncated {
            expected: format!("{expected} {what}"),
            found: format!("there are {present}"),
        };
        Located::at(words.line(), fault)
    })
}

fn read_face(words: &mut Words<'_>, first: &[u8], parsed: &mut Parsed) -> Result<(), Fault> {
    let n_corners = natural(first).ok_or_else(|| Fault::Unexpected {
        expected: "the number of corners of a face",
        found: shown(first),
    })?;
    let soup = &mut parsed.soup;
    let start = soup.corners.len();
    let vertices = soup.positions.len();
    for found in 0..n_corners {
        let Some(word) = words.next_on_line() else {
            let needed = usize::try_from(n_corners).unwrap_or(usize::MAX);
            return Err(Fault::TooFewNumbers { record: "face", needed, found: found as usize });
        };
        let index = natural(word).ok_or_else(|| Fault::BadIndex(shown(word)))?;
        let corner = u32::try_from(index).ok().filter(|&corner| (corner as usize) < vertices);
        let missing = || Fault::MissingVertex { index: shown(word), vertices };
        soup.corners.push(corner.ok_or_else(missing)?);
    }
    if soup.corners.len() >= u32::MAX as usize {
        return Err(Fault::Mesh(MeshError::TooLarge));
    }
    if n_corners < 3 {
        soup.corners.truncate(start);
        parsed.leave_out_face(Some(words.line()));
    } else {
        soup.face_starts.push(soup.corners.len() as u32);
    }
    Ok(())
}
