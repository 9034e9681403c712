//! OBJ text reduced to what tobj reads well: `v` with three numbers and `f` with vertex numbers.
//!
//! tobj itself stumbles over byte order marks, comments behind a record, continued lines, colors
//! on some vertices only, and numbers of normals or texture coordinates that do not exist; it
//! takes `l` records for faces and says no line. This filter, one pass over the bytes into one
//! buffer no longer than the file, leaves it nothing of that. Names of groups and materials are
//! kept aside, so that tobj sees a single object and shared vertices stay shared.
//!
//! A comment ends at its line's end, *before* lines that end in a backslash are joined.

use rustc_hash::FxHashMap;

use super::error::{Fault, Located};
use super::text::{after_line_end, is_blank, is_line_end, name, number, shown};
use super::warning::Notice;
use crate::model::mesh::Part;

/// Records that concern neither shape nor names: skipped without a word.
const IRRELEVANT: [&[u8]; 16] = [
    b"vn",
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

/// Unknown records that are told apart; the kinds after these are only counted together.
const MOST_UNKNOWN_KINDS: usize = 6;

/// An OBJ file without all that tobj need not see.
#[derive(Debug, Default)]
pub(super) struct Filtered {
    /// `v x y z` and `f i j k …` lines, ASCII; all numbers are decimal, finite and in range.
    pub(super) text: Vec<u8>,
    pub(super) n_vertices: usize,
    pub(super) n_faces: usize,
    pub(super) n_corners: usize,
    /// Groups and materials, in order of their first face; empty when the file names none.
    pub(super) parts: Vec<Part>,
    /// The first face of each run of faces that have the same part, and that part.
    pub(super) runs: Vec<(usize, u32)>,
    /// Faces of one or two corners, left out, and the line of the first.
    pub(super) n_degenerate: usize,
    pub(super) first_degenerate_line: Option<usize>,
    /// `l` and `p` records.
    pub(super) n_lines: usize,
    pub(super) notices: Vec<Notice>,
}

/// Whether the first record of a text is one of OBJ.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    let mut records = Records::new(bytes);
    let known: [&[u8]; 7] = [b"v", b"f", b"o", b"g", b"l", b"p", b"usemtl"];
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
/// A vertex with fewer than three finite numbers, or a face with a vertex that is none.
pub(super) fn filter(bytes: &[u8]) -> Result<Filtered, Located> {
    let mut out = Filtered { text: Vec::with_capacity(bytes.len() + 1), ..Filtered::default() };
    let mut records = Records::new(bytes);
    let mut naming = Naming::default();
    let mut skipped = Skipped::default();
    let mut largest = Largest::default();
    while !records.at_end() {
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
            Some(b"f") => copy_face(&mut records, &mut out, &mut largest, &mut naming)?,
            Some(b"o" | b"g") => naming.set_group(records.words_of_name()),
            Some(b"usemtl") => naming.set_material(records.words_of_name()),
            Some(b"l" | b"p") => {
                skipped.first_line_record.get_or_insert(line);
                out.n_lines += 1;
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
        out.parts = naming.parts;
    } else {
        out.runs.clear();
    }
    skipped.report(out.n_lines, &mut out.notices);
    Ok(out)
}

/// Copies a vertex of three numbers without exponents, alone on its line: nearly all are such.
/// False, with nothing changed, when the line is anything else.
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

/// Copies a face whose line holds nothing but vertex numbers above zero, each perhaps with those of
/// its texture coordinates and normal. False, with nothing changed, when the line is anything else.
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
        out.text.push(b' ');
        out.text.extend_from_slice(&rest[start..end]);
        n_corners += 1;
    }
    if n_corners < 3 || rest.get(at).is_some_and(|&byte| !is_line_end(byte)) {
        out.text.truncate(text_before);
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
    out.text.push(b'v');
    for found in 0..3 {
        let Some(word) = records.word(false) else {
            let fault = Fault::TooFewNumbers { record: "vertex", needed: 3, found };
            return Err(Located::at(records.line, fault));
        };
        if !is_surely_finite(word) {
            number(word).map_err(|fault| Located::at(records.line, fault))?;
        }
        out.text.push(b' ');
        out.text.extend_from_slice(word);
    }
    out.text.push(b'\n');
    out.n_vertices += 1;
    Ok(())
}

/// Whether a word is a decimal number that cannot overflow: digits, at most one point, and no
/// exponent. False means that it has to be looked at more closely.
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

/// The largest vertex number of all faces, and where it stands.
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
        if is_relative && index > out.n_vertices as u64 {
            let index = shown(position);
            return fail(Fault::MissingVertex { index, vertices: out.n_vertices });
        }
        // Faces may come before their vertices, so a number is checked when all are known.
        if !is_relative && index > largest.index {
            let begin = records.at - word.len();
            *largest = Largest { index, line: records.line, word: (begin, begin + length) };
        }
        out.text.push(b' ');
        out.text.extend_from_slice(position);
        n_corners += 1;
    }
    if n_corners < 3 {
        out.text.truncate(start);
        out.first_degenerate_line.get_or_insert(line);
        out.n_degenerate += 1;
        return Ok(());
    }
    finish_face(n_corners, out, naming);
    Ok(())
}

/// The group and material in force, and all parts so far.
#[derive(Debug, Default)]
struct Naming {
    current: Part,
    /// The current part's place in `parts`, once a face needed it.
    place: Option<u32>,
    parts: Vec<Part>,
    places: FxHashMap<Part, u32>,
    any: bool,
}

impl Naming {
    fn set_group(&mut self, group: String) {
        self.current.group = group;
        (self.place, self.any) = (None, true);
    }

    fn set_material(&mut self, material: String) {
        self.current.material = material;
        (self.place, self.any) = (None, true);
    }

    fn part(&mut self) -> u32 {
        if let Some(place) = self.place {
            return place;
        }
        let next = self.parts.len() as u32;
        let place = *self.places.entry(self.current.clone()).or_insert(next);
        if place == next {
            self.parts.push(self.current.clone());
        }
        self.place = Some(place);
        place
    }
}

/// Records that were skipped and deserve a word.
#[derive(Debug, Default)]
struct Skipped {
    first_line_record: Option<usize>,
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

    fn report(self, n_lines: usize, notices: &mut Vec<Notice>) {
        if n_lines > 0 {
            notices.push(Notice::LinesAndPoints {
                count: n_lines,
                first_line: self.first_line_record,
            });
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

    /// Where the next line begins if the backslash at `at` is the last thing on its own.
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
