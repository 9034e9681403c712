//! SVG for plotters and print: true millimeters, one Inkscape layer for each pen, strokes and filled areas.
//!
//! The `svg` crate builds the document: root, title, metadata and layers. The strokes of a layer
//! are put in as one prepared text, for two reasons: the crate's path numbers are `f32`, and a node
//! for each of a million strokes takes twenty seconds and a gigabyte where the text takes less
//! than one second. There are no transforms, clip paths, dash arrays or texts, and no fills but of
//! areas, since plotting software ignores or misreads them.

use std::io;

use glam::DVec2;
use rayon::prelude::*;
use svg::Document;
use svg::node::element::{Element, Group, Title};
use svg::node::{Blob, Node, Text};

use crate::plot::{Area, Fills, Layer, Plot};

/// How a stroke is written.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum StrokeElement {
    /// `<path>` with absolute M and L, and Z where it is closed.
    #[default]
    Path,
    /// `<polyline>`; a closed one repeats its first point.
    Polyline,
}

impl StrokeElement {
    /// Both elements.
    pub const ALL: [Self; 2] = [Self::Path, Self::Polyline];

    /// The name used on the command line: that of the element.
    pub fn name(self) -> &'static str {
        match self {
            Self::Path => "path",
            Self::Polyline => "polyline",
        }
    }
}

/// Writes `plot` as SVG. The same plot gives the same bytes.
///
/// Coordinates are millimeters with up to three decimals. Points that are equal after rounding to these are
/// one; a stroke reduced to one point is left out. A dot is a line back to its start, which round caps make
/// visible. O(points).
///
/// # Errors
/// Those of `out`.
pub fn write(plot: &Plot, element: StrokeElement, out: &mut dyn io::Write) -> io::Result<()> {
    let (width, height) = (millimeters(plot.width_mm), millimeters(plot.height_mm));
    let mut document = Document::new()
        .set("xmlns:inkscape", "http://www.inkscape.org/namespaces/inkscape")
        .set("width", format!("{width}mm"))
        .set("height", format!("{height}mm"))
        .set("viewBox", format!("0 0 {width} {height}"))
        .add(Title::new(printable(&plot.title)))
        .add(metadata(&plot.source));
    for layer in &plot.layers {
        document.append(group(layer, element));
    }
    writeln!(out, "{document}")
}

fn metadata(source: &str) -> Element {
    let mut format = Element::new("dc:format");
    format.append(Text::new("image/svg+xml"));
    let mut work = Element::new("cc:Work");
    work.assign("rdf:about", "");
    work.append(format);
    if !source.is_empty() {
        let mut command = Element::new("dc:source");
        command.append(Text::new(printable(source)));
        work.append(command);
    }
    let mut rdf = Element::new("rdf:RDF");
    rdf.assign("xmlns:rdf", "http://www.w3.org/1999/02/22-rdf-syntax-ns#");
    rdf.assign("xmlns:cc", "http://creativecommons.org/ns#");
    rdf.assign("xmlns:dc", "http://purl.org/dc/elements/1.1/");
    rdf.append(work);
    let mut metadata = Element::new("metadata");
    metadata.append(rdf);
    metadata
}

fn group(layer: &Layer, element: StrokeElement) -> Group {
    let mut group = Group::new()
        .set("id", format!("pen{}-{}", layer.number, layer.name))
        .set("inkscape:groupmode", "layer")
        .set("inkscape:label", printable(&layer.label()))
        .set("fill", "none")
        .set("stroke", layer.pen.color.as_str())
        .set("stroke-width", millimeters(layer.pen.width_mm))
        .set("stroke-linecap", "round")
        .set("stroke-linejoin", "round");
    let fills = fills(&layer.fills, element);
    if !fills.is_empty() {
        group.append(Blob::new(fills));
    }
    let strokes = strokes(layer, element);
    if !strokes.is_empty() {
        group.append(Blob::new(strokes));
    }
    group
}

/// All areas of a layer, one a line: a path with a ring after the other, filled by the even-odd rule.
/// The outlines of an area follow it.
fn fills(fills: &Fills, element: StrokeElement) -> String {
    let seam = millimeters(fills.seam_mm);
    let mut text = String::with_capacity(16 * fills.n_points() + 80 * fills.len());
    for area in fills.iter() {
        push_area(&mut text, &area, &seam);
        let outlines = text_of(&area.outlines().collect::<Vec<_>>(), element);
        if !text.is_empty() && !outlines.is_empty() {
            text.push('\n');
        }
        text.push_str(&outlines);
    }
    text
}

fn push_area(text: &mut String, area: &Area, seam: &str) {
    let [r, g, b] = area.color;
    let color = format!("#{r:02x}{g:02x}{b:02x}");
    let mut path = Vec::new();
    for ring in area.rings() {
        let mut points: Vec<[i64; 2]> = ring.iter().map(|&p| micrometers(p)).collect();
        points.dedup();
        if points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        if points.len() < 3 {
            continue;
        }
        for (i, point) in points.iter().enumerate() {
            path.push(if i == 0 { b'M' } else { b'L' });
            push_point(&mut path, point, b' ');
        }
        path.push(b'Z');
    }
    if path.is_empty() {
        return;
    }
    let path = ascii(path);
    if !text.is_empty() {
        text.push('\n');
    }
    let outline = if seam == "0" {
        "stroke=\"none\"".to_owned()
    } else {
        format!("stroke=\"{color}\" stroke-width=\"{seam}\"")
    };
    text.push_str(&format!(
        "<path fill=\"{color}\" fill-rule=\"evenodd\" {outline} d=\"{path}\"/>"
    ));
}

/// Points of strokes that are written at once: enough that sharing the work costs nothing.
const POINTS_AT_ONCE: usize = 1 << 14;

/// This many batches are put together at a time, so that a large drawing is not in memory twice as text.
const BATCHES_AT_ONCE: usize = 64;

/// All strokes of a layer, one a line.
fn strokes(layer: &Layer, element: StrokeElement) -> String {
    let lines: Vec<&[DVec2]> = layer.lines.iter().collect();
    let mut n_points = 0;
    let mut batch = |line: &&[DVec2]| {
        n_points += line.len();
        n_points / POINTS_AT_ONCE
    };
    let numbers: Vec<usize> = lines.iter().map(&mut batch).collect();
    let mut batches = Vec::new();
    let mut rest = &lines[..];
    for of_batch in numbers.chunk_by(|a, b| a == b) {
        let (batch, others) = rest.split_at(of_batch.len());
        batches.push(batch);
        rest = others;
    }
    let mut text = String::new();
    for together in batches.chunks(BATCHES_AT_ONCE) {
        let texts: Vec<String> = together.par_iter().map(|lines| text_of(lines, element)).collect();
        for strokes in texts.iter().filter(|text| !text.is_empty()) {
            if !text.is_empty() {
                text.push('\n');
            }
            text.push_str(strokes);
        }
    }
    text
}

fn text_of(lines: &[&[DVec2]], element: StrokeElement) -> String {
    // A point takes about 16 characters, an element about 16 more.
    let n_points: usize = lines.iter().map(|line| line.len() + 1).sum();
    let mut text = Vec::with_capacity(16 * n_points);
    let mut points: Vec<[i64; 2]> = Vec::new();
    for line in lines {
        points.clear();
        points.extend(line.iter().map(|&p| micrometers(p)));
        points.dedup();
        if points.len() < 2 {
            if line.iter().any(|p| Some(p) != line.first()) {
                continue;
            }
            points.extend_from_within(..);
        }
        if !text.is_empty() {
            text.push(b'\n');
        }
        match element {
            StrokeElement::Path => push_path(&mut text, &points),
            StrokeElement::Polyline => push_polyline(&mut text, &points),
        }
    }
    ascii(text)
}

/// Text of what was pushed, all of it ASCII.
fn ascii(text: Vec<u8>) -> String {
    String::from_utf8(text).unwrap_or_default()
}

fn push_path(text: &mut Vec<u8>, points: &[[i64; 2]]) {
    // A line there and back is not closed: Z would draw the way back once more.
    let closed = points.len() > 3 && points.first() == points.last();
    let drawn = if closed { points.split_last().map_or(points, |(_, rest)| rest) } else { points };
    text.extend(b"<path d=\"");
    for (i, point) in drawn.iter().enumerate() {
        text.push(if i == 0 { b'M' } else { b'L' });
        push_point(text, point, b' ');
    }
    text.extend(if closed { &b"Z\"/>"[..] } else { b"\"/>" });
}

fn push_polyline(text: &mut Vec<u8>, points: &[[i64; 2]]) {
    text.extend(b"<polyline points=\"");
    for (i, point) in points.iter().enumerate() {
        if i > 0 {
            text.push(b' ');
        }
        push_point(text, point, b',');
    }
    text.extend(b"\"/>");
}

fn push_point(text: &mut Vec<u8>, [x, y]: &[i64; 2], separator: u8) {
    push_thousandths(text, *x);
    text.push(separator);
    push_thousandths(text, *y);
}

fn micrometers(p: DVec2) -> [i64; 2] {
    // `as` saturates; pages are at most 100 m, so nothing does.
    [(p.x * 1000.0).round() as i64, (p.y * 1000.0).round() as i64]
}

/// A length in millimeters with up to three decimals.
fn millimeters(value: f64) -> String {
    let mut text = Vec::new();
    push_thousandths(&mut text, (value * 1000.0).round() as i64);
    ascii(text)
}

/// Appends `value / 1000` without trailing zeros.
fn push_thousandths(text: &mut Vec<u8>, value: i64) {
    // A sign, a point and as many digits as such a number can have; filled from the end.
    let mut buffer = [0; 24];
    let mut begin = buffer.len();
    let mut push = |digit: u8| {
        begin -= 1;
        buffer[begin] = digit;
    };
    let mut rest = value.unsigned_abs();
    let thousandths = rest % 1000;
    rest /= 1000;
    if thousandths > 0 {
        let [hundreds, tens, ones] = [100, 10, 1].map(|unit| (thousandths / unit % 10) as u8);
        if ones > 0 {
            push(b'0' + ones);
        }
        if ones > 0 || tens > 0 {
            push(b'0' + tens);
        }
        push(b'0' + hundreds);
        push(b'.');
    }
    loop {
        push(b'0' + (rest % 10) as u8);
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    if value < 0 {
        push(b'-');
    }
    text.extend_from_slice(&buffer[begin..]);
}

/// `text` without the control characters that XML cannot hold.
fn printable(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() || c > '\u{fffd}' && c <= '\u{ffff}' { ' ' } else { c })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_no_trailing_zeros() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (-0.0004, "0"),
            (0.001, "0.001"),
            (0.3, "0.3"),
            (-12.05, "-12.05"),
            (297.0, "297"),
            (1000.25, "1000.25"),
        ] {
            assert_eq!(millimeters(value), text);
        }
    }
}
