//! OFF, the text format of Geomview: `OFF`, counts, one vertex a line, one face a line.
//!
//! No crate for this format was found in the registry lists at hand; mesh toolkits that know it
//! bring their own mesh types and single precision.
//!
//! Prefixes (`C`, `N`, `ST`: colors, normals, texture coordinates) only add numbers behind the
//! position, which are skipped, as are the colors behind a face.

use glam::DVec3;

use super::Draft;
use super::error::{Fault, Located};
use super::text::{Words, number, shown};
use super::warning::Notice;
use crate::model::mesh::MeshError;

/// Whether the first word of a text is a keyword of the format.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    Words::new(bytes, Some(b'#')).next().is_some_and(|word| {
        word.ends_with(b"OFF") && word[..word.len() - 3].iter().all(|c| b"STCN4n".contains(c))
    })
}

/// Reads decoded text.
pub(super) fn read(bytes: &[u8]) -> Result<Draft, Located> {
    let mut words = Words::new(bytes, Some(b'#'));
    read_keyword(bytes, &mut words)?;
    let n_vertices = read_count(&mut words, "the number of vertices")?;
    let n_faces = read_count(&mut words, "the number of faces")?;
    words.skip_line();

    let mut draft = Draft::default();
    for vertex in 0..n_vertices {
        let first = first_on_line(&mut words, "vertices", n_vertices, vertex)?;
        let mut point = [0.0; 3];
        for (i, coordinate) in point.iter_mut().enumerate() {
            let word = if i == 0 { Some(first) } else { words.next_on_line() };
            let too_few = Fault::TooFewNumbers { record: "vertex", needed: 3, found: i };
            *coordinate = word
                .ok_or(too_few)
                .and_then(number)
                .map_err(|fault| Located::at(words.line(), fault))?;
        }
        draft.soup.positions.push(DVec3::from_array(point));
        words.skip_line();
    }
    for face in 0..n_faces {
        let first = first_on_line(&mut words, "faces", n_faces, face)?;
        read_face(&mut words, first, &mut draft).map_err(|f| Located::at(words.line(), f))?;
        words.skip_line();
    }
    let start = words.clone();
    if words.next().is_some() {
        draft.notices.push(Notice::TrailingBytes { count: start.rest().trim_ascii().len() });
    }
    Ok(draft)
}

/// Reads the keyword, which may be missing, and refuses the variants that mean other numbers.
fn read_keyword(bytes: &[u8], words: &mut Words<'_>) -> Result<(), Located> {
    let start = words.clone();
    let word = words.next().unwrap_or_default();
    if !looks_like(bytes) {
        *words = start;
        return if word.first().is_some_and(u8::is_ascii_digit) {
            Ok(())
        } else {
            let found = shown(word);
            Err(Located::at(1, Fault::Unexpected { expected: "the word `OFF`", found }))
        };
    }
    let after_keyword = words.clone();
    let what = if words.next_on_line().is_some_and(|word| word.eq_ignore_ascii_case(b"BINARY")) {
        "binary OFF"
    } else if word.iter().any(|c| b"4n".contains(c)) {
        "OFF with four or more coordinates a vertex"
    } else {
        *words = after_keyword;
        return Ok(());
    };
    let remedy = "export the model as OFF text with three coordinates a vertex, or as PLY";
    Err(Located::at(words.line(), Fault::Unsupported { what, remedy }))
}

fn read_count(words: &mut Words<'_>, expected: &'static str) -> Result<u64, Located> {
    let word = words.next().unwrap_or_default();
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

fn read_face(words: &mut Words<'_>, first: &[u8], draft: &mut Draft) -> Result<(), Fault> {
    let n_corners = natural(first).ok_or_else(|| Fault::Unexpected {
        expected: "the number of corners of a face",
        found: shown(first),
    })?;
    let soup = &mut draft.soup;
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
        draft.leave_out_face(Some(words.line()));
    } else {
        soup.face_starts.push(soup.corners.len() as u32);
    }
    Ok(())
}
