//! OBJ text reduced to what tobj reads reliably: `v` with three numbers and `f` with vertex numbers.
//!
//! tobj itself fails on byte order marks, comments after a record, continued lines, colors
//! on some vertices only, and numbers of normals or texture coordinates that do not exist. It
//! reports no line numbers, and some input makes it panic. This filter, one pass over the bytes into one
//! buffer, keeps only vertices and faces known to be valid. Names of groups and materials,
//! and normals, are kept separately, so tobj sees a single object and shared vertices stay shared.
//!
//! Polylines (`l`) become segments at the end of the text, as faces of two corners. A vertex that is
//! not finite becomes `v NaN N 0`, where N says which one: tobj drops unused vertices, so only those in
//! use come back.
//!
//! A comment ends at its line's end, *before* lines that end in a backslash are joined.

use std::io::Write as _;

use super::error::{Fault, Located};
use super::obj_normals::Normals;
use super::parts::PartTable;
use super::text::{after_line_end, is_blank, is_line_end, name, number, shown};
use super::warning::Notice;
use super::watch::Watch;
use crate::model::mesh::MeshPart;

/// Records that affect neither shape nor names: skipped silently.
const IRRELEVANT: [&[u8]; 15] = [
    b"vt",
    b"s",
    b"mg",
    b"mtllib",
    b"maplib",
    b"usemap",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"shadow_obj",
    b"trace_obj",
    b"ctech",
    b"stech",
    b"end",
];

/// Kinds of unknown records that are reported one by one; further kinds are counted together.
const MOST_UNKNOWN_KINDS: usize = 6;

/// An OBJ file reduced to what tobj needs.
#[derive(Debug, Default)]
pub(super) struct Filtered {
    /// `v x y z` and `f i j k …` in any order, then `f i j` for segments: ASCII, with all numbers decimal
    /// and in range.
    pub(super) text: Vec<u8>,
    /// Vertices that are not finite: line and fault of each.
    pub(super) unsound: Vec<(usize, Fault)>,
    /// Segments of polylines.
    pub(super) n_segments: usize,
    pub(super) n_vertices: usize,
    pub(super) n_faces: usize,
    pub(super) n_corners: usize,
    /// Normals, for the corners of faces.
    pub(super) normals: Normals,
    /// Groups and materials, in order of their first face; empty when the file names none.
    pub(super) parts: Vec<MeshPart>,
    /// The first face of each run of faces that have the same part, and that part.
    pub(super) runs: Vec<(usize, u32)>,
    /// How many faces of one or two corners were left out, and the line of the first.
    pub(super) n_degenerate: usize,
    pub(super) first_degenerate_line: Option<usize>,
    pub(super) notices: Vec<Notice>,
}

/// Whether the first record of a text is one of OBJ.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    let mut records = Records::new(bytes);
    let known: [&[u8]; 8] = [b"v", b"vn", b"f", b"o", b"g", b"l", b"p", b"usemtl"];
    while !records.at_end() {
        if let Some(keyword) = records.word(true) {
            return known.contains(&keyword) || IRRELEVANT.contains(&keyword);
        }
        records.finish();
    }
    false
}

/// Reduces an OBJ file.
///
/// # Errors
/// A vertex with fewer than three finite numbers, or a face with an invalid vertex.
pub(super) fn filter(bytes: &[u8], watch: &Watch<'_>) -> Result<Filtered, Located> {
    let mut out = Filtered { text: Vec::with_capacity(bytes.len() + 1), ..Filtered::default() };
    let mut records = Records::new(bytes);
    let mut naming = Naming::default();
    let mut skipped = Skipped::default();
    let mut largest = Largest::default();
    let mut segments = Vec::new();
    while !records.at_end() {
        watch.at(records.at);
        if copy_plain_vertex(&mut records, &mut out)
            || copy_plain_face(&mut records, &mut out, &mut largest, &mut naming)
        {
            records.finish();
            continue;
        }
        let line = records.line;
        match records.word(true) {
            None => {}
            Some(b"v") => copy_vertex(&mut records, &mut out)?,
            Some(b"vn") => read_normal(&mut records, &mut out.normals),
            Some(b"f") => copy_face(&mut records, &mut out, &mut largest, &mut naming)?,
            Some(b"o" | b"g") => naming.set_group(records.words_of_name()),
            Some(b"usemtl") => naming.set_material(records.words_of_name()),
            Some(b"l") => read_polyline(&mut records, &mut out, &mut largest, &mut segments)?,
            Some(b"p") => {
                skipped.first_point_record.get_or_insert(line);
                skipped.n_points += 1;
            }
            Some(keyword) if IRRELEVANT.contains(&keyword) => {}
            Some(keyword) => skipped.note_unknown(keyword, line),
        }
        records.finish();
    }
    if largest.index > out.n_vertices as u64 {
        let index = shown(&bytes[largest.word.0..largest.word.1]);
        return Err(Located::at(
            largest.line,
            Fault::MissingVertex { index, vertices: out.n_vertices },
        ));
    }
    if naming.any {
        out.parts = naming.table.into_parts();
    }
    if out.parts.is_empty() {
        out.runs.clear();
    }
    out.normals.end(out.n_corners);
    out.n_segments = segments.len();
    out.n_corners += 2 * segments.len();
    for [from, to] in segments {
        // Writing to memory cannot fail.
        let _ = writeln!(out.text, "f {from} {to}");
    }
    skipped.report(&mut out.notices);
    Ok(out)
}

/// Copies a vertex of three numbers without exponents, alone on its line: the usual case. Returns false,
/// with nothing changed, for any other line.
fn copy_plain_vertex(records: &mut Records<'_>, out: &mut Filtered) -> bool {
    const MOST_DIGITS: usize = 300;
    let rest = &records.bytes[records.at..];
    if !rest.starts_with(b"v ") {
        return false;
    }
    let mut at = 1;
    for _ in 0..3 {
        if rest.get(at) != Some(&b' ') {
            return false;
        }
        while rest.get(at) == Some(&b' ') {
            at += 1;
        }
        at += usize::from(rest.get(at) == Some(&b'-'));
        let start = at;
        let mut n_points = 0;
        while let Some(&byte @ (b'0'..=b'9' | b'.')) = rest.get(at) {
            n_points += usize::from(byte == b'.');
            at += 1;
        }
        if n_points > 1 || at - start == n_points || at - start > MOST_DIGITS {
            return false;
        }
    }
    if rest.get(at).is_some_and(|&byte| !is_line_end(byte)) {
        return false;
    }
    out.text.extend_from_slice(&rest[..at]);
    out.text.push(b'\n');
    out.n_vertices += 1;
    records.at += at;
    true
}

/// Copies a face whose line consists of positive vertex numbers, each optionally with numbers of texture
/// coordinates and a normal. Returns false, with nothing changed, for any other line.
fn copy_plain_face(
    records: &mut Records<'_>,
    out: &mut Filtered,
    largest: &mut Largest,
    naming: &mut Naming,
) -> bool {
    const MOST_DIGITS: usize = 10;
    let rest = &records.bytes[records.at..];
    if !rest.starts_with(b"f ") {
        return false;
    }
    let text_before = out.text.len();
    out.text.push(b'f');
    let mut line_largest = (0, 0, 0);
    let mut n_corners = 0;
    let mut at = 1;
    loop {
        while rest.get(at) == Some(&b' ') {
            at += 1;
        }
        if rest.get(at).is_none_or(|&byte| is_line_end(byte)) {
            break;
        }
        let start = at;
        let mut index = 0;
        while let Some(&digit @ b'0'..=b'9') = rest.get(at) {
            index = (10 * index).min(u64::MAX / 20) + u64::from(digit - b'0');
            at += 1;
        }
        let end = at;
        while let Some(b'0'..=b'9' | b'/') = rest.get(at)
            && rest[end] == b'/'
        {
            at += 1;
        }
        let is_plain = index > 0
            && end - start <= MOST_DIGITS
            && rest.get(at).is_none_or(|&byte| byte == b' ' || is_line_end(byte));
        if !is_plain {
            break;
        }
        if index > line_largest.0 {
            line_largest = (index, start, end);
        }
        out.normals.note(out.n_corners + n_corners, &rest[end..at]);
        out.text.push(b' ');
        out.text.extend_from_slice(&rest[start..end]);
        n_corners += 1;
    }
    if n_corners < 3 || rest.get(at).is_some_and(|&byte| !is_line_end(byte)) {
        out.text.truncate(text_before);
        out.normals.truncate(out.n_corners);
        return false;
    }
    let (index, start, end) = line_largest;
    if index > largest.index {
        let word = (records.at + start, records.at + end);
        *largest = Largest { index, line: records.line, word };
    }
    finish_face(n_corners, out, naming);
    records.at += at;
    true
}

/// Ends a face that has been copied.
fn finish_face(n_corners: usize, out: &mut Filtered, naming: &mut Naming) {
    out.text.push(b'\n');
    let part = naming.part();
    if out.runs.last().is_none_or(|&(_, last)| last != part) {
        out.runs.push((out.n_faces, part));
    }
    out.n_faces += 1;
    out.n_corners += n_corners;
}

fn copy_vertex(records: &mut Records<'_>, out: &mut Filtered) -> Result<(), Located> {
    let (line, start) = (records.line, out.text.len());
    let mut not_finite = None;
    out.text.push(b'v');
    for found in 0..3 {
        let Some(word) = records.word(false) else {
            let fault = Fault::TooFewNumbers { record: "vertex", needed: 3, found };
            return Err(Located::at(records.line, fault));
        };
        if let Some(word) = records.rest_of_not_finite(word) {
            not_finite.get_or_insert(Fault::NotFinite(shown(word)));
        } else if !is_surely_finite(word) {
            match number(word) {
                Err(fault @ Fault::NotFinite(_)) => drop(not_finite.get_or_insert(fault)),
                Err(fault) => return Err(Located::at(records.line, fault)),
                Ok(_) => {}
            }
        }
        out.text.push(b' ');
        out.text.extend_from_slice(word);
    }
    if let Some(fault) = not_finite {
        out.text.truncate(start);
        // Writing to memory cannot fail.
        let _ = write!(out.text, "v NaN {} 0", out.unsound.len());
        out.unsound.push((line, fault));
    }
    out.text.push(b'\n');
    out.n_vertices += 1;
    Ok(())
}

/// Whether a word is a decimal number that cannot overflow: digits, at most one point, and no
/// exponent. False means that it needs a closer look.
fn is_surely_finite(word: &[u8]) -> bool {
    const MOST_DIGITS: usize = 300;
    let unsigned = match word {
        [b'-' | b'+', rest @ ..] => rest,
        _ => word,
    };
    let mut n_digits = 0;
    let mut n_points = 0;
    for byte in unsigned {
        n_digits += usize::from(byte.is_ascii_digit());
        n_points += usize::from(*byte == b'.');
    }
    n_digits > 0 && n_points <= 1 && n_digits + n_points == unsigned.len() && n_digits < MOST_DIGITS
}

/// The largest vertex number of all faces, and where it occurs.
#[derive(Debug, Default)]
struct Largest {
    index: u64,
    line: usize,
    word: (usize, usize),
}

fn copy_face(
    records: &mut Records<'_>,
    out: &mut Filtered,
    largest: &mut Largest,
    naming: &mut Naming,
) -> Result<(), Located> {
    let line = records.line;
    let start = out.text.len();
    let mut n_corners = 0;
    out.text.push(b'f');
    while let Some(word) = records.word(false) {
        read_index(records, word, out.n_vertices, largest)?;
        let length = word.iter().position(|&byte| byte == b'/').unwrap_or(word.len());
        out.text.push(b' ');
        out.text.extend_from_slice(&word[..length]);
        out.normals.note(out.n_corners + n_corners, &word[length..]);
        n_corners += 1;
    }
    if n_corners < 3 {
        out.text.truncate(start);
        out.normals.truncate(out.n_corners);
        out.first_degenerate_line.get_or_insert(line);
        out.n_degenerate += 1;
        return Ok(());
    }
    finish_face(n_corners, out, naming);
    Ok(())
}

/// Reads a `vn` record. One that is not three numbers is not a normal, which costs the faces nothing.
fn read_normal(records: &mut Records<'_>, normals: &mut Normals) {
    let mut next = || records.word(false).and_then(|word| number(word).ok());
    let [x, y, z] = [next(), next(), next()];
    let normal = x.zip(y).zip(z).map(|((x, y), z)| [x, y, z].map(|part| part as f32));
    normals.push(normal.unwrap_or_default());
}

/// Reads an `l` record into segments of vertex numbers counted from 1.
fn read_polyline(
    records: &mut Records<'_>,
    out: &mut Filtered,
    largest: &mut Largest,
    segments: &mut Vec<[u64; 2]>,
) -> Result<(), Located> {
    let mut before = None;
    while let Some(word) = records.word(false) {
        let vertex = read_index(records, word, out.n_vertices, largest)?;
        if let Some(before) = before {
            segments.push([before, vertex]);
        }
        before = Some(vertex);
    }
    Ok(())
}

/// The vertex number, counted from 1, that a word like `-1/2/3` begins with.
fn read_index(
    records: &Records<'_>,
    word: &[u8],
    n_vertices: usize,
    largest: &mut Largest,
) -> Result<u64, Located> {
    let length = word.iter().position(|&byte| byte == b'/').unwrap_or(word.len());
    let position = &word[..length];
    let (is_relative, digits) = match position {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    let fail = |fault| Err(Located::at(records.line, fault));
    if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
        return fail(Fault::BadIndex(shown(word)));
    }
    let index = digits.iter().fold(0_u64, |value, digit| {
        value.saturating_mul(10).saturating_add(u64::from(digit - b'0'))
    });
    if index == 0 {
        return fail(Fault::ZeroIndex);
    }
    if is_relative {
        return match (n_vertices as u64 + 1).checked_sub(index) {
            Some(vertex) if vertex > 0 => Ok(vertex),
            _ => fail(Fault::MissingVertex { index: shown(position), vertices: n_vertices }),
        };
    }
    // Faces may come before their vertices, so a number is checked when all are known.
    if index > largest.index {
        let begin = records.at - word.len();
        *largest = Largest { index, line: records.line, word: (begin, begin + length) };
    }
    Ok(index)
}

/// The group and material in force, and all parts so far.
#[derive(Debug, Default)]
struct Naming {
    current: MeshPart,
    /// The current part's index, once a face needed it.
    index: Option<u32>,
    table: PartTable,
    any: bool,
}

impl Naming {
    fn set_group(&mut self, group: String) {
        self.current.group = group;
        (self.index, self.any) = (None, true);
    }

    fn set_material(&mut self, material: String) {
        self.current.material = material;
        (self.index, self.any) = (None, true);
    }

    fn part(&mut self) -> u32 {
        *self.index.get_or_insert_with(|| self.table.index(&self.current))
    }
}

/// Skipped records that are worth reporting.
#[derive(Debug, Default)]
struct Skipped {
    n_points: usize,
    first_point_record: Option<usize>,
    /// Keyword, count, first line.
    kinds: Vec<(Vec<u8>, usize, usize)>,
    n_others: usize,
}

impl Skipped {
    fn note_unknown(&mut self, keyword: &[u8], line: usize) {
        if let Some(kind) = self.kinds.iter_mut().find(|kind| kind.0 == keyword) {
            kind.1 += 1;
        } else if self.kinds.len() < MOST_UNKNOWN_KINDS {
            self.kinds.push((keyword.to_vec(), 1, line));
        } else {
            self.n_others += 1;
        }
    }

    fn report(self, notices: &mut Vec<Notice>) {
        if self.n_points > 0 {
            let first_line = self.first_point_record;
            notices.push(Notice::Points { count: self.n_points, first_line });
        }
        notices.extend(self.kinds.into_iter().map(|(keyword, count, first_line)| {
            Notice::UnknownRecord { keyword: shown(&keyword), count, first_line }
        }));
        if self.n_others > 0 {
            notices.push(Notice::OtherUnknownRecords { count: self.n_others });
        }
    }
}

/// Walks through the words of records: lines joined where they end in a backslash.
#[derive(Debug)]
struct Records<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl<'a> Records<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, line: 1 }
    }

    fn at_end(&self) -> bool {
        self.at >= self.bytes.len()
    }

    /// The next word of this record. Where names may hold it, `#` begins a comment only at the
    /// start of a word.
    fn word(&mut self, in_names: bool) -> Option<&'a [u8]> {
        loop {
            match *self.bytes.get(self.at)? {
                byte if is_blank(byte) => self.at += 1,
                byte if is_line_end(byte) || byte == b'#' => return None,
                b'\\' => match self.continuation(self.at) {
                    Some(next) => {
                        self.at = next;
                        self.line += 1;
                    }
                    None => break,
                },
                _ => break,
            }
        }
        let start = self.at;
        while let Some(&byte) = self.bytes.get(self.at) {
            let ends = is_blank(byte)
                || is_line_end(byte)
                || (byte == b'#' && !in_names)
                || (byte == b'\\' && self.continuation(self.at).is_some());
            if ends {
                break;
            }
            self.at += 1;
        }
        Some(&self.bytes[start..self.at])
    }

    /// All of a number like `1.#IND` or `-1.#INF`, as some programs write numbers that are not finite, if
    /// `word` is the part before the `#`; the number is then consumed.
    fn rest_of_not_finite(&mut self, word: &[u8]) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        let is_spelled = [&b"#IND"[..], b"#INF", b"#QNAN", b"#SNAN"].iter().any(|spelling| {
            rest.get(..spelling.len()).is_some_and(|start| start.eq_ignore_ascii_case(spelling))
        });
        if !is_spelled {
            return None;
        }
        let start = self.at - word.len();
        let ends = |&byte: &u8| is_blank(byte) || is_line_end(byte);
        let length = rest.iter().position(ends).unwrap_or(rest.len());
        self.at = start + word.len() + length;
        Some(&self.bytes[start..self.at])
    }

    /// Where the next line begins if the backslash at `at` is the last character of its line.
    fn continuation(&self, at: usize) -> Option<usize> {
        let mut next = at + 1;
        while self.bytes.get(next).is_some_and(|&byte| is_blank(byte)) {
            next += 1;
        }
        match self.bytes.get(next) {
            None => Some(next),
            Some(&byte) => is_line_end(byte).then(|| after_line_end(self.bytes, next)),
        }
    }

    /// The words left in this record, one blank between them.
    fn words_of_name(&mut self) -> String {
        let mut joined = Vec::new();
        while let Some(word) = self.word(true) {
            if !joined.is_empty() {
                joined.push(b' ');
            }
            joined.extend_from_slice(word);
        }
        name(&joined)
    }

    /// Goes to the start of the next record.
    fn finish(&mut self) {
        while self.word(true).is_some() {}
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&byte| is_line_end(byte)).unwrap_or(rest.len());
        self.at += length;
        if !self.at_end() {
            self.at = after_line_end(self.bytes, self.at);
            self.line += 1;
        }
    }
}
