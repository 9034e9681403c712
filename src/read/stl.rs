//! STL, binary and text.
//!
//! Of the crates, stl_io takes a binary file whose header begins with "solid" for text (many
//! programs write such headers) and refuses text in capitals; nom_stl reads single precision only
//! and is no longer kept up.
//!
//! ```text
//!  binary: 80 bytes of anything │ n: u32 │ n × (normal, 3 corners: 12 × f32 │ 2 bytes)
//! ```

use glam::DVec3;

use super::Draft;
use super::error::{Fault, Located};
use super::text::{Words, decode, name, number, shown};
use super::warning::Notice;
use crate::model::mesh::{MeshError, Part, PolygonSoup};

const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Whether bytes are surely STL: binary of just the right length, or text that begins as it must.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    let is_whole = triangle_count(bytes).is_some_and(|count| {
        count > 0 && HEADER as u64 + TRIANGLE as u64 * count == bytes.len() as u64
    });
    is_whole || is_text(bytes)
}

/// Reads STL of either kind.
///
/// The length decides first: a file just as long as its count of triangles asks is binary, even
/// when it begins with "solid".
pub(super) fn read(bytes: &[u8]) -> Result<Draft, Located> {
    let is_whole = triangle_count(bytes)
        .is_some_and(|count| HEADER as u64 + TRIANGLE as u64 * count == bytes.len() as u64);
    let text = decode(bytes);
    if !is_whole && is_text(&text) {
        read_text(&text)
    } else {
        read_binary(bytes).map_err(Into::into)
    }
}

/// The number of triangles that the header of a binary file states.
fn triangle_count(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER - 4..HEADER)?.first_chunk::<4>()?;
    Some(u64::from(u32::from_le_bytes(*count)))
}

/// Text begins with the word "solid"; a binary file has a zero byte in its header or count.
fn is_text(bytes: &[u8]) -> bool {
    let first = Words::new(bytes, None).next();
    first.is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
        && !bytes[..bytes.len().min(HEADER)].contains(&0)
}

fn read_binary(bytes: &[u8]) -> Result<Draft, Fault> {
    let Some(count) = triangle_count(bytes) else {
        return Err(Fault::Truncated {
            expected: format!("at least {HEADER} bytes of a binary STL or the word `solid`"),
            found: format!("{} bytes found", bytes.len()),
        });
    };
    let (triangles, rest) = bytes[HEADER..].as_chunks::<TRIANGLE>();
    let present = triangles.len() as u64;
    if count > present {
        return Err(Fault::Truncated {
            expected: format!("{count} triangles"),
            found: format!("there are bytes for {present}"),
        });
    }
    let triangles = &triangles[..count as usize];
    if triangles.len() >= (u32::MAX / 3) as usize {
        return Err(Fault::Mesh(MeshError::TooLarge));
    }
    let mut draft = Draft::default();
    let trailing = (present - count) as usize * TRIANGLE + rest.len();
    if trailing > 0 {
        draft.notices.push(Notice::TrailingBytes { count: trailing });
    }
    let n_corners = 3 * triangles.len() as u32;
    let mut positions = Vec::with_capacity(n_corners as usize);
    for (index, triangle) in triangles.iter().enumerate() {
        let (floats, _) = triangle.as_chunks::<4>();
        let coordinate = |i: usize| f64::from(f32::from_le_bytes(floats[i]));
        let corner = |i| DVec3::new(coordinate(i), coordinate(i + 1), coordinate(i + 2));
        let corners = [corner(3), corner(6), corner(9)];
        if !corners.iter().all(|corner| corner.is_finite()) {
            return Err(Fault::ElementNotFinite { element: "triangle", index: index + 1 });
        }
        positions.extend_from_slice(&corners);
    }
    draft.soup = PolygonSoup {
        positions,
        corners: (0..n_corners).collect(),
        face_starts: (0..=n_corners).step_by(3).collect(),
        ..PolygonSoup::default()
    };
    Ok(draft)
}

/// Reads any number of `solid NAME … endsolid`, in any letter case.
fn read_text(bytes: &[u8]) -> Result<Draft, Located> {
    let mut draft = Draft::default();
    let mut words = Words::new(bytes, None);
    let mut solids = Vec::new();
    loop {
        let start = words.clone();
        let Some(word) = words.next() else { break };
        if !word.eq_ignore_ascii_case(b"solid") {
            if solids.is_empty() {
                return Err(unexpected(&words, "`solid`", word));
            }
            let count = start.rest().trim_ascii().len();
            draft.notices.push(Notice::TrailingBytes { count });
            break;
        }
        let group = name(words.rest_of_line());
        read_solid(&mut words, &mut draft)?;
        draft.soup.face_parts.resize(draft.soup.n_faces(), solids.len() as u32);
        solids.push(Part { group, ..Part::default() });
    }
    if solids.len() == 1 && solids.iter().all(|solid| solid.group.is_empty()) {
        draft.soup.face_parts.clear();
    } else {
        draft.soup.parts = solids;
    }
    Ok(draft)
}

/// Reads facets up to and including the line of `endsolid`.
fn read_solid(words: &mut Words<'_>, draft: &mut Draft) -> Result<(), Located> {
    loop {
        let word = required(words, "`facet` or `endsolid`")?;
        if word.eq_ignore_ascii_case(b"endsolid") {
            words.rest_of_line();
            return Ok(());
        }
        if !word.eq_ignore_ascii_case(b"facet") {
            return Err(unexpected(words, "`facet` or `endsolid`", word));
        }
        // The normal is not needed, and often wrong or not even a number.
        while !required(words, "`outer loop`")?.eq_ignore_ascii_case(b"outer") {}
        keyword(words, "`loop`", b"loop")?;
        read_loop(words, draft)?;
        keyword(words, "`endfacet`", b"endfacet")?;
    }
}

/// Reads the corners of one facet up to and including `endloop`.
fn read_loop(words: &mut Words<'_>, draft: &mut Draft) -> Result<(), Located> {
    let line = words.line();
    let soup = &mut draft.soup;
    let first = soup.positions.len();
    loop {
        let word = required(words, "`vertex` or `endloop`")?;
        if word.eq_ignore_ascii_case(b"endloop") {
            break;
        }
        if !word.eq_ignore_ascii_case(b"vertex") {
            return Err(unexpected(words, "`vertex` or `endloop`", word));
        }
        let mut point = [0.0; 3];
        for coordinate in &mut point {
            let word = required(words, "a coordinate")?;
            *coordinate = number(word).map_err(|fault| Located::at(words.line(), fault))?;
        }
        soup.positions.push(DVec3::from_array(point));
    }
    if soup.positions.len() >= u32::MAX as usize {
        return Err(Fault::Mesh(MeshError::TooLarge).into());
    }
    if soup.positions.len() < first + 3 {
        soup.positions.truncate(first);
        draft.leave_out_face(Some(line));
    } else {
        soup.corners.extend(first as u32..soup.positions.len() as u32);
        soup.face_starts.push(soup.corners.len() as u32);
    }
    Ok(())
}

fn required<'a>(words: &mut Words<'a>, expected: &'static str) -> Result<&'a [u8], Located> {
    words.next().ok_or_else(|| {
        let fault = Fault::Truncated {
            expected: expected.to_owned(),
            found: "nothing more found".to_owned(),
        };
        Located::at(words.line(), fault)
    })
}

fn keyword(words: &mut Words<'_>, shown: &'static str, expected: &[u8]) -> Result<(), Located> {
    let word = required(words, shown)?;
    if word.eq_ignore_ascii_case(expected) { Ok(()) } else { Err(unexpected(words, shown, word)) }
}

fn unexpected(words: &Words<'_>, expected: &'static str, found: &[u8]) -> Located {
    Located::at(words.line(), Fault::Unexpected { expected, found: shown(found) })
}
