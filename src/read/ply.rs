//! PLY, read with ply-rs-bw: text, and binary of either byte order.
//!
//! Elements are read in batches into small structs and appended to flat arrays, so memory depends on the
//! data, not on the counts in the header. Faces, edges, and the colors of faces or else of vertices are
//! used; all other properties are ignored.

use std::borrow::Cow;

use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType,
    ScalarType,
};

use super::Parsed;
use super::error::{Fault, Located};
use super::parts::{PartTable, color_of_parts, mean_color};
use super::text::{Words, shown};
use super::warning::Notice;
use super::watch::Watch;
use crate::model::mesh::MeshError;

/// Elements read at a time.
const BATCH: usize = 4096;

/// Names of the list of a face's corners.
const CORNER_LISTS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// A color as it is read, part by part.
#[derive(Debug, Default)]
struct Color {
    parts: [f64; 3],
    n_parts: usize,
}

impl Color {
    /// Takes a property if it is part of a color: bytes, or numbers from 0 to 1.
    fn set(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let part = match name {
            "red" | "diffuse_red" => 0,
            "green" | "diffuse_green" => 1,
            "blue" | "diffuse_blue" => 2,
            _ => return PropertyAccessResult::Ignored,
        };
        self.parts[part] = match value {
            Property::UChar(v) => f64::from(v) / 255.0,
            Property::Float(v) => v.into(),
            Property::Double(v) => v,
            _ => return PropertyAccessResult::Ignored,
        };
        self.n_parts += 1;
        PropertyAccessResult::Set
    }

    fn bytes(&self) -> Option<[u8; 3]> {
        (self.n_parts >= 3).then(|| color_of_parts(self.parts))
    }
}

/// A position as it is read; missing coordinates stay zero.
#[derive(Debug, Default)]
struct Vertex {
    position: DVec3,
    color: Color,
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let coordinate = match name {
            "x" => &mut self.position.x,
            "y" => &mut self.position.y,
            "z" => &mut self.position.z,
            _ => return self.color.set(name, value),
        };
        *coordinate = match value {
            Property::Char(v) => v.into(),
            Property::UChar(v) => v.into(),
            Property::Short(v) => v.into(),
            Property::UShort(v) => v.into(),
            Property::Int(v) => v.into(),
            Property::UInt(v) => v.into(),
            Property::Float(v) => v.into(),
            Property::Double(v) => v,
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// The corners of a face as the file numbers them.
#[derive(Debug, Default)]
struct Face {
    corners: Vec<i64>,
    color: Color,
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        fn widened<T: Into<i64>>(list: Vec<T>) -> Vec<i64> {
            list.into_iter().map(Into::into).collect()
        }
        if !CORNER_LISTS.contains(&name) {
            return self.color.set(name, value);
        }
        self.corners = match value {
            Property::ListChar(list) => widened(list),
            Property::ListUChar(list) => widened(list),
            Property::ListShort(list) => widened(list),
            Property::ListUShort(list) => widened(list),
            Property::ListInt(list) => widened(list),
            Property::ListUInt(list) => widened(list),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// The ends of an edge as the file numbers them; negative while missing.
#[derive(Debug)]
struct Edge {
    ends: [i64; 2],
}

impl PropertyAccess for Edge {
    fn new() -> Self {
        Self { ends: [-1; 2] }
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let end = match name {
            "vertex1" => &mut self.ends[0],
            "vertex2" => &mut self.ends[1],
            _ => return PropertyAccessResult::Ignored,
        };
        *end = match value {
            Property::Char(v) => v.into(),
            Property::UChar(v) => v.into(),
            Property::Short(v) => v.into(),
            Property::UShort(v) => v.into(),
            Property::Int(v) => v.into(),
            Property::UInt(v) => v.into(),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// An element that is skipped.
#[derive(Debug)]
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}

/// Reads PLY of any encoding.
pub(super) fn read(bytes: &[u8], watch: &Watch<'_>) -> Result<Parsed, Located> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let bytes = &*with_line_feeds(bytes);
    let bytes = &*without_names_of_numbers(bytes);
    let mut reader = Reader::new(bytes);
    let mut header = Parser::<Skipped>::new().read_header(&mut reader).map_err(located)?;
    check(&header)?;
    let is_text = header.encoding == Encoding::Ascii;
    if is_text {
        widen_floats(&mut header);
    }
    let n_vertices = header.elements.get("vertex").map_or(0, |element| element.count);
    let mut parsed = Parsed::default();
    let mut vertex_colors = Vec::new();
    let mut face_colors = Vec::new();
    for element in header.elements.values() {
        let mut batches = Batches {
            reader: &mut reader,
            header: &header,
            element,
            done: 0,
            watch,
            n_bytes: bytes.len(),
        };
        match element.name.as_str() {
            "vertex" => read_vertices(&mut batches, &mut parsed, &mut vertex_colors)?,
            "face" => read_faces(&mut batches, n_vertices, &mut parsed, &mut face_colors)?,
            "edge" if has_ends(element) => read_edges(&mut batches, n_vertices, &mut parsed)?,
            _ => batches.skip()?,
        }
    }
    color_faces(&mut parsed, &face_colors, &vertex_colors);
    let rest = if is_text { reader.get_ref().trim_ascii() } else { reader.get_ref() };
    if !rest.is_empty() {
        parsed.notices.push(Notice::TrailingBytes { count: rest.len() });
    }
    Ok(parsed)
}

/// Text whose lines end in CR alone, with LF instead; other text is unchanged.
fn with_line_feeds(bytes: &[u8]) -> Cow<'_, [u8]> {
    let mut words = Words::new(bytes, None);
    let is_text = [&b"ply"[..], b"format", b"ascii"].iter().all(|&w| words.next() == Some(w));
    if is_text && !bytes.contains(&b'\n') {
        Cow::Owned(bytes.iter().map(|&c| if c == b'\r' { b'\n' } else { c }).collect())
    } else {
        Cow::Borrowed(bytes)
    }
}

/// Text in which `nan`, `inf` and their like stand as a number too large for any: the parser does not know
/// them, and a vertex that is not finite matters only if it is used.
fn without_names_of_numbers(bytes: &[u8]) -> Cow<'_, [u8]> {
    const END: &[u8] = b"end_header";
    let is_name = |word: &[u8]| {
        let word = word.strip_prefix(b"-").or(word.strip_prefix(b"+")).unwrap_or(word);
        [&b"nan"[..], b"inf", b"infinity"].iter().any(|name| word.eq_ignore_ascii_case(name))
    };
    let is_space = |c: &u8| c.is_ascii_whitespace();
    let mut words = Words::new(bytes, None);
    let is_text = [&b"ply"[..], b"format", b"ascii"].iter().all(|&w| words.next() == Some(w));
    let data = bytes.windows(END.len()).position(|window| window == END);
    let Some(data) = data.filter(|_| is_text).map(|at| at + END.len()) else {
        return Cow::Borrowed(bytes);
    };
    if !bytes[data..].split(is_space).any(is_name) {
        return Cow::Borrowed(bytes);
    }
    let mut text = bytes[..data].to_vec();
    for word in bytes[data..].split_inclusive(is_space) {
        let (word, space) = match word.split_last() {
            Some((last, rest)) if is_space(last) => (rest, &word[rest.len()..]),
            _ => (word, &[][..]),
        };
        text.extend_from_slice(if is_name(word) { b"1e999" } else { word });
        text.extend_from_slice(space);
    }
    Cow::Owned(text)
}

/// Refuses headers that lack positions or faces.
fn check(header: &Header) -> Result<(), Fault> {
    let Some(vertex) = header.elements.get("vertex") else {
        return Err(Fault::NoFaces { vertices: 0, degenerate: 0 });
    };
    let is_number = |name| {
        vertex.properties.get(name).is_some_and(|p| matches!(p.data_type, PropertyType::Scalar(_)))
    };
    if !["x", "y", "z"].into_iter().all(is_number) {
        return Err(Fault::Unsupported {
            what: "a PLY file whose vertices lack x, y or z",
            remedy: "export it with positions",
        });
    }
    let Some(face) = header.elements.get("face") else {
        if header.elements.get("edge").is_some_and(has_ends) {
            return Ok(());
        }
        if header.elements.contains_key("tristrips") {
            return Err(Fault::Unsupported {
                what: "triangle strips in PLY",
                remedy: "export the faces as polygons",
            });
        }
        return Err(Fault::NoFaces { vertices: vertex.count, degenerate: 0 });
    };
    let is_list = |name| {
        face.properties.get(name).is_some_and(|p| {
            matches!(&p.data_type, PropertyType::List(_, item)
                if !matches!(item, ScalarType::Float | ScalarType::Double))
        })
    };
    if !CORNER_LISTS.into_iter().any(is_list) {
        return Err(Fault::Unsupported {
            what: "a PLY file whose faces have no list of whole numbers named vertex_indices",
            remedy: "export it with such a list",
        });
    }
    Ok(())
}

/// Whether edges say which vertices they join.
fn has_ends(edge: &ElementDef) -> bool {
    ["vertex1", "vertex2"].iter().all(|&name| edge.properties.contains_key(name))
}

/// Reads numbers in text as doubles: their digits need not be single precision.
fn widen_floats(header: &mut Header) {
    let properties =
        header.elements.values_mut().flat_map(|element| element.properties.values_mut());
    for property in properties {
        if property.data_type == PropertyType::Scalar(ScalarType::Float) {
            property.data_type = PropertyType::Scalar(ScalarType::Double);
        }
    }
}

/// Reads one kind of element, a batch at a time.
struct Batches<'r, 'a> {
    reader: &'r mut Reader<&'a [u8]>,
    header: &'r Header,
    element: &'r ElementDef,
    done: usize,
    watch: &'r Watch<'r>,
    n_bytes: usize,
}

impl Batches<'_, '_> {
    /// The next elements and the line of the first; `None` when all have been read.
    fn next<E: PropertyAccess>(&mut self) -> Result<Option<(usize, Vec<E>)>, Located> {
        let count = BATCH.min(self.element.count - self.done);
        if count == 0 {
            return Ok(None);
        }
        let line = self.reader.line();
        let batch = ElementDef { count, ..self.element.clone() };
        let elements = Parser::new()
            .read_payload_for_element(self.reader, &batch, self.header)
            .map_err(|error| self.located(error))?;
        self.done += count;
        self.watch.at(self.n_bytes.saturating_sub(self.reader.get_ref().len()));
        Ok(Some((line, elements)))
    }

    fn skip(&mut self) -> Result<(), Located> {
        // In binary, elements without properties take no bytes: there may be any number of them.
        if self.header.encoding == Encoding::Ascii || !self.element.properties.is_empty() {
            while self.next::<Skipped>()?.is_some() {}
        }
        Ok(())
    }

    fn located(&self, error: ParseError) -> Located {
        let is_text = self.header.encoding == Encoding::Ascii;
        if error.kind() != std::io::ErrorKind::UnexpectedEof {
            let Located { line, fault } = located(error);
            return Located { line: line.filter(|_| is_text), fault };
        }
        Located {
            line: error.line().filter(|_| is_text),
            fault: Fault::Truncated {
                expected: format!("{} elements `{}`", self.element.count, self.element.name),
                found: "there are fewer".to_owned(),
            },
        }
    }

    /// The line of an element of a batch, in text.
    fn line(&self, first: usize, index: usize) -> Option<usize> {
        (self.header.encoding == Encoding::Ascii).then_some(first + index)
    }
}

/// A parser's message on one line, without its quotes from the file, which may be long.
fn located(error: ParseError) -> Located {
    let text = error.to_string();
    let message = text.split_once('\n').map_or(text.as_str(), |(first, _)| first);
    let message = match (error.line(), message.split_once(": ")) {
        (Some(_), Some((_, message))) => message,
        _ => message,
    };
    let message = match text.rsplit_once("Value: '").and_then(|(_, rest)| rest.split_once('\'')) {
        Some((value, _)) => format!("`{}` does not fit its type", shown(value.as_bytes())),
        None => message.trim_end_matches('.').to_owned(),
    };
    Located { line: error.line(), fault: Fault::Parser(message) }
}

fn read_vertices(
    batches: &mut Batches<'_, '_>,
    parsed: &mut Parsed,
    colors: &mut Vec<[u8; 3]>,
) -> Result<(), Located> {
    while let Some((line, vertices)) = batches.next::<Vertex>()? {
        for (i, Vertex { position, color }) in vertices.into_iter().enumerate() {
            if !position.is_finite() {
                let index = parsed.soup.positions.len() + 1;
                let fault = Fault::ElementNotFinite { element: "vertex", index };
                parsed.leave_unsound_vertex(batches.line(line, i), fault);
            }
            parsed.soup.positions.push(position);
            colors.extend(color.bytes());
        }
    }
    Ok(())
}

fn read_edges(
    batches: &mut Batches<'_, '_>,
    n_vertices: usize,
    parsed: &mut Parsed,
) -> Result<(), Located> {
    while let Some((line, edges)) = batches.next::<Edge>()? {
        for (i, Edge { ends }) in edges.into_iter().enumerate() {
            let line = batches.line(line, i);
            let mut wire = [0; 2];
            for (end, number) in wire.iter_mut().zip(ends) {
                *end = vertex_index(number, n_vertices).map_err(|fault| Located { line, fault })?;
            }
            parsed.soup.wires.push(wire);
        }
    }
    Ok(())
}

/// The vertex with this number in the file.
fn vertex_index(number: i64, n_vertices: usize) -> Result<u32, Fault> {
    let index = u32::try_from(number).ok().filter(|&index| (index as usize) < n_vertices);
    index.ok_or_else(|| Fault::MissingVertex { index: number.to_string(), vertices: n_vertices })
}

/// Assigns each face to the part with its color, or with the mean color of its corners.
fn color_faces(parsed: &mut Parsed, of_faces: &[Option<[u8; 3]>], of_vertices: &[[u8; 3]]) {
    let soup = &parsed.soup;
    let has_vertex_colors = !of_vertices.is_empty() && of_vertices.len() == soup.positions.len();
    if !has_vertex_colors && of_faces.iter().all(Option::is_none) {
        return;
    }
    let mut parts = PartTable::default();
    let mut face_parts = Vec::with_capacity(soup.n_faces());
    for (range, of_face) in soup.face_starts.windows(2).zip(of_faces) {
        let corners = &soup.corners[range[0] as usize..range[1] as usize];
        let of_corners = || {
            let colors = corners.iter().map(|&vertex| of_vertices[vertex as usize]);
            has_vertex_colors.then(|| mean_color(colors)).flatten()
        };
        face_parts.push(parts.index_of_color(of_face.or_else(of_corners)));
    }
    parsed.soup.face_parts = face_parts;
    parsed.set_parts(parts);
}

fn read_faces(
    batches: &mut Batches<'_, '_>,
    n_vertices: usize,
    parsed: &mut Parsed,
    colors: &mut Vec<Option<[u8; 3]>>,
) -> Result<(), Located> {
    while let Some((line, faces)) = batches.next::<Face>()? {
        for (i, Face { corners, color }) in faces.into_iter().enumerate() {
            let line = batches.line(line, i);
            let start = parsed.soup.corners.len();
            for corner in corners {
                let index = vertex_index(corner, n_vertices);
                parsed.soup.corners.push(index.map_err(|fault| Located { line, fault })?);
            }
            if parsed.soup.corners.len() >= u32::MAX as usize {
                return Err(Fault::Mesh(MeshError::TooLarge).into());
            }
            if parsed.soup.corners.len() < start + 3 {
                parsed.soup.corners.truncate(start);
                parsed.leave_out_face(line);
            } else {
                parsed.soup.face_starts.push(parsed.soup.corners.len() as u32);
                colors.push(color.bytes());
            }
        }
    }
    Ok(())
}
