//! STL, binary and text.
//!
//! Of the existing crates, stl_io takes a binary file whose header begins with "solid" for text (many
//! programs write such headers) and refuses text in capitals; nom_stl reads single precision only and is
//! no longer maintained.
//!
//! ```text
//!  binary: 80 bytes of anything │ n: u32 │ n × (normal, 3 corners: 12 × f32 │ 2 bytes)
//! ```
//!
//! The two bytes after a triangle may hold its color: VisCAM and SolidView set the highest bit and
//! put blue lowest; Magics, which writes `COLOR=` into the header, clears that bit and puts red lowest.
//!
//! Many programs write text that is almost STL. Where the meaning is clear it is read, with a notice:
//! `endsolidNAME`, `end solid`, no `endsolid` at all, comments before `solid`.

use glam::DVec3;

use super::Parsed;
use super::error::{Fault, Located};
use super::parts::PartTable;
use super::text::{Words, decode, name, number, shown};
use super::warning::Notice;
use super::watch::Watch;
use crate::model::mesh::{MeshError, MeshPart, PolygonSoup};

const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// How much of a file is examined to see whether it is text.
const LOOKED_AT: usize = 1024;

/// Whether bytes are certainly STL: binary of exactly the right length, or text that begins correctly.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    is_whole(bytes) || is_text(bytes) && begins_with_solid(bytes)
}

/// Reads STL of either kind.
///
/// The length decides first: a file exactly as long as its count of triangles requires is binary, even if
/// it begins with "solid".
pub(super) fn read(bytes: &[u8], watch: &Watch<'_>) -> Result<Parsed, Located> {
    let text = decode(bytes);
    if !is_whole(bytes) && is_text(&text) {
        read_text(&text, watch)
    } else {
        read_binary(bytes, watch).map_err(Into::into)
    }
}

/// Whether a file is exactly as long as its count of triangles requires, and has any.
fn is_whole(bytes: &[u8]) -> bool {
    triangle_count(bytes).is_some_and(|count| {
        count > 0 && HEADER as u64 + TRIANGLE as u64 * count == bytes.len() as u64
    })
}

/// The number of triangles that the header of a binary file states.
fn triangle_count(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER - 4..HEADER)?.first_chunk::<4>()?;
    Some(u64::from(u32::from_le_bytes(*count)))
}

/// Text has no control characters. A binary file has zero bytes in its count, or in its numbers.
fn is_text(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(LOOKED_AT)];
    !start.is_empty()
        && start.iter().all(|byte| *byte >= b' ' || byte.is_ascii_whitespace() || *byte == 0x0B)
}

/// Whether the first line that is not a comment begins with "solid".
fn begins_with_solid(bytes: &[u8]) -> bool {
    let mut words = Words::new(bytes, None);
    loop {
        match words.next() {
            Some(word) if is_comment(word) => words.skip_line(),
            Some(word) => return word.eq_ignore_ascii_case(b"solid"),
            None => return false,
        };
    }
}

fn is_comment(word: &[u8]) -> bool {
    word.starts_with(b"#") || word.starts_with(b";") || word.starts_with(b"//")
}

fn read_binary(bytes: &[u8], watch: &Watch<'_>) -> Result<Parsed, Fault> {
    let Some(stated) = triangle_count(bytes) else {
        return Err(Fault::Truncated {
            expected: format!("at least {HEADER} bytes of a binary STL or the word `solid`"),
            found: format!("{} bytes found", bytes.len()),
        });
    };
    let (triangles, rest) = bytes[HEADER..].as_chunks::<TRIANGLE>();
    let present = triangles.len() as u64;
    let mut parsed = Parsed::default();
    // More facets of its size to the very end are the model's; anything else was put behind it.
    let (first, more) = triangles.split_at(stated.min(present) as usize);
    let size_of_first = first.iter().map(size).fold(0.0, f32::max);
    let is_like_them = |t: &[u8; TRIANGLE]| has_area(t) && size(t) <= MOST_GROWTH * size_of_first;
    let goes_on = rest.is_empty() && !more.is_empty() && more.iter().all(is_like_them);
    let is_exact = stated > 0 && stated <= present && !goes_on;
    let n_triangles = if is_exact { stated } else { present };
    if !is_exact && present > 0 {
        parsed.notices.push(Notice::WrongCount { stated, present, element: "triangle" });
    }
    let triangles = &triangles[..n_triangles as usize];
    if triangles.len() >= (u32::MAX / 3) as usize {
        return Err(Fault::Mesh(MeshError::TooLarge));
    }
    let trailing = (present - n_triangles) as usize * TRIANGLE + rest.len();
    if trailing > 0 {
        parsed.notices.push(Notice::TrailingBytes { count: trailing });
    }
    let n_corners = 3 * triangles.len() as u32;
    let mut positions = Vec::with_capacity(n_corners as usize);
    for (index, triangle) in triangles.iter().enumerate() {
        watch.at(index * TRIANGLE);
        let (floats, _) = triangle.as_chunks::<4>();
        let coordinate = |i: usize| f64::from(f32::from_le_bytes(floats[i]));
        let corner = |i| DVec3::new(coordinate(i), coordinate(i + 1), coordinate(i + 2));
        let corners = [corner(3), corner(6), corner(9)];
        if !corners.iter().all(|corner| corner.is_finite()) {
            return Err(Fault::ElementNotFinite { element: "triangle", index: index + 1 });
        }
        positions.extend_from_slice(&corners);
    }
    parsed.soup = PolygonSoup {
        positions,
        corners: (0..n_corners).collect(),
        face_starts: (0..=n_corners).step_by(3).collect(),
        ..PolygonSoup::default()
    };
    color_triangles(bytes, triangles, &mut parsed.soup);
    Ok(parsed)
}

/// How much farther from the origin than the facets that a header counts the others may be.
const MOST_GROWTH: f32 = 1000.0;

/// The largest coordinate of a triangle's record, infinite if any is not a number.
fn size(triangle: &[u8; TRIANGLE]) -> f32 {
    let (floats, _) = triangle[12..].as_chunks::<4>();
    let sizes = floats.iter().map(|bytes| f32::from_le_bytes(*bytes).abs());
    sizes.fold(0.0, |most, x| if x.is_nan() { f32::INFINITY } else { most.max(x) })
}

/// Whether the corners of a triangle's record differ.
fn has_area(triangle: &[u8; TRIANGLE]) -> bool {
    let [p, q, r] = [12, 24, 36].map(|at| &triangle[at..at + 12]);
    p != q && q != r && r != p
}

/// Assigns each triangle to the part with its color, if any has one.
fn color_triangles(bytes: &[u8], triangles: &[[u8; TRIANGLE]], soup: &mut PolygonSoup) {
    let attribute = |triangle: &[u8; TRIANGLE]| {
        let [.., low, high] = *triangle;
        u16::from_le_bytes([low, high])
    };
    let of_object = magics_color(&bytes[..HEADER - 4]);
    let has_colors = of_object.is_some() || triangles.iter().any(|t| attribute(t) & 0x8000 != 0);
    if !has_colors {
        return;
    }
    let five_bits = |attribute: u16, shift: u16| {
        let part = u32::from(attribute >> shift & 31);
        ((part * 255 + 15) / 31) as u8
    };
    let mut parts = PartTable::default();
    soup.face_parts.reserve_exact(triangles.len());
    for triangle in triangles {
        let bits = attribute(triangle);
        let rising = [0, 5, 10].map(|shift| five_bits(bits, shift));
        let [red, green, blue] = rising;
        let color = match (of_object, bits & 0x8000 != 0) {
            (Some(object), true) => Some(object),
            (Some(_), false) => Some([red, green, blue]),
            (None, true) => Some([blue, green, red]),
            (None, false) => None,
        };
        soup.face_parts.push(parts.index_of_color(color));
    }
    soup.parts = parts.into_parts();
}

/// The color of the whole object, as Magics writes it into the header.
fn magics_color(header: &[u8]) -> Option<[u8; 3]> {
    const KEY: &[u8] = b"COLOR=";
    let at = header.windows(KEY.len()).position(|window| window == KEY)? + KEY.len();
    header.get(at..at + 4)?.first_chunk::<3>().copied()
}

/// Reads any number of `solid NAME … endsolid`, in any letter case.
fn read_text(bytes: &[u8], watch: &Watch<'_>) -> Result<Parsed, Located> {
    let mut parsed = Parsed::default();
    let mut words = Words::new(bytes, None);
    let mut solids = Vec::new();
    skip_comments(&mut words, &mut parsed);
    loop {
        let start = words.clone();
        let Some(word) = words.next() else { break };
        if !word.eq_ignore_ascii_case(b"solid") {
            if solids.is_empty() {
                return Err(unexpected(&words, "`solid`", word));
            }
            let count = start.rest().trim_ascii().len();
            parsed.notices.push(Notice::TrailingBytes { count });
            break;
        }
        let group = name(words.rest_of_line());
        read_solid(&mut words, &mut parsed, &|rest| watch.at(bytes.len() - rest))?;
        parsed.soup.face_parts.resize(parsed.soup.n_faces(), solids.len() as u32);
        solids.push(MeshPart { group, ..MeshPart::default() });
    }
    if solids.len() == 1 && solids.iter().all(|solid| solid.group.is_empty()) {
        parsed.soup.face_parts.clear();
    } else {
        parsed.soup.parts = solids;
    }
    Ok(parsed)
}

/// Skips comment lines at the start, with a notice.
fn skip_comments(words: &mut Words<'_>, parsed: &mut Parsed) {
    let mut first_line = None;
    loop {
        let start = words.clone();
        if !words.next().is_some_and(is_comment) {
            *words = start;
            break;
        }
        first_line.get_or_insert(words.line());
        words.rest_of_line();
    }
    if let Some(line) = first_line {
        parsed
            .notices
            .push(Notice::Irregular { line, what: "a comment before `solid` is skipped" });
    }
}

/// Reads facets up to and including the line of `endsolid`, or to the end of the file. `watch` gets the
/// number of bytes left.
fn read_solid(
    words: &mut Words<'_>,
    parsed: &mut Parsed,
    watch: &dyn Fn(usize),
) -> Result<(), Located> {
    loop {
        watch(words.rest().len());
        let start = words.clone();
        let Some(word) = words.next() else {
            let what = "`endsolid` is missing at the end; the facets found are read";
            parsed.notices.push(Notice::Irregular { line: words.line(), what });
            return Ok(());
        };
        let line = words.line();
        if word.eq_ignore_ascii_case(b"endsolid") {
            words.rest_of_line();
            return Ok(());
        }
        if begins_with(word, b"endsolid") {
            let what = "a name joined to `endsolid` is read as `endsolid`";
            parsed.notices.push(Notice::Irregular { line, what });
            words.rest_of_line();
            return Ok(());
        }
        if word.eq_ignore_ascii_case(b"end") {
            if let Some(next) = words.next_on_line()
                && !begins_with(next, b"solid")
            {
                return Err(unexpected(words, "`endsolid`", next));
            }
            let what = "`end solid` is read as `endsolid`";
            parsed.notices.push(Notice::Irregular { line, what });
            words.rest_of_line();
            return Ok(());
        }
        if word.eq_ignore_ascii_case(b"solid") {
            let what = "`endsolid` is missing before `solid`; the facets found are read";
            parsed.notices.push(Notice::Irregular { line, what });
            *words = start;
            return Ok(());
        }
        if is_comment(word) {
            words.rest_of_line();
            continue;
        }
        if !word.eq_ignore_ascii_case(b"facet") {
            return Err(unexpected(words, "`facet` or `endsolid`", word));
        }
        // The normal is not needed, and often wrong or not even a number.
        while !required(words, "`outer loop`")?.eq_ignore_ascii_case(b"outer") {}
        keyword(words, "`loop`", b"loop")?;
        read_loop(words, parsed)?;
        keyword(words, "`endfacet`", b"endfacet")?;
    }
}

fn begins_with(word: &[u8], start: &[u8]) -> bool {
    word.get(..start.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(start))
}

/// Reads the corners of one facet up to and including `endloop`.
fn read_loop(words: &mut Words<'_>, parsed: &mut Parsed) -> Result<(), Located> {
    let line = words.line();
    let soup = &mut parsed.soup;
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
        parsed.leave_out_face(Some(line));
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
