//! PDF for print: one page of the sheet size, with filled areas, and strokes as lines of pen width.
//!
//! Written with `pdf-writer`, whose numbers are `f32`: a hundredth of a micrometer on a large
//! sheet. Coordinates are rounded to micrometers before.

use std::io;

use glam::DVec2;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Finish, Pdf, Rect, Ref, TextStr};

use crate::plot::{Fills, Layer, Plot};

/// Points in a millimeter.
const POINTS_PER_MM: f32 = 72.0 / 25.4;

/// Writes `plot` as PDF. The whole file is made in memory first.
///
/// # Errors
/// Those of `out`.
pub fn write(plot: &Plot, out: &mut dyn io::Write) -> io::Result<()> {
    let [catalog, pages, page, strokes, info] = [1, 2, 3, 4, 5].map(Ref::new);
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(pages);
    pdf.pages(pages).kids([page]).count(1);
    let (width, height) = (plot.width_mm as f32, plot.height_mm as f32);
    let mut sheet = pdf.page(page);
    sheet.parent(pages).contents(strokes);
    sheet.media_box(Rect::new(0.0, 0.0, width * POINTS_PER_MM, height * POINTS_PER_MM));
    sheet.resources().finish();
    sheet.finish();
    if !plot.title.is_empty() {
        pdf.document_info(info).title(TextStr(&plot.title));
    }
    pdf.stream(strokes, content(plot).finish().as_slice());
    out.write_all(&pdf.finish())
}

fn content(plot: &Plot) -> Content {
    let height = plot.height_mm as f32 * POINTS_PER_MM;
    let mut content = Content::new();
    // Page millimeters with y down from here on.
    content.transform([POINTS_PER_MM, 0.0, 0.0, -POINTS_PER_MM, 0.0, height]);
    content.set_line_cap(LineCapStyle::RoundCap).set_line_join(LineJoinStyle::RoundJoin);
    for layer in plot.plotted_layers() {
        let pen = LinePen::of(layer);
        fill(&layer.fills, &pen, &mut content);
        pen.take(&mut content);
        for line in layer.lines.iter() {
            stroke(line, &mut content);
        }
    }
    content
}

/// How wide and in what color lines are drawn.
struct LinePen {
    width_mm: f32,
    rgb: [f32; 3],
}

impl LinePen {
    fn of(layer: &Layer) -> Self {
        let rgb = [1, 3, 5].map(|i| {
            let hex = layer.pen.color.get(i..i + 2);
            let value = hex.and_then(|hex| u8::from_str_radix(hex, 16).ok()).unwrap_or(0);
            f32::from(value) / 255.0
        });
        Self { width_mm: layer.pen.width_mm as f32, rgb }
    }

    fn take(&self, content: &mut Content) {
        let [r, g, b] = self.rgb;
        content.set_stroke_rgb(r, g, b).set_line_width(self.width_mm);
    }
}

/// Draws a polyline; a closed one ends at its first point.
fn stroke(line: &[DVec2], content: &mut Content) {
    if !line.iter().all(|p| p.is_finite()) {
        return;
    }
    let closed = line.len() > 3 && line.first() == line.last();
    trace(&line[..line.len() - usize::from(closed)], content);
    if closed {
        content.close_and_stroke();
    } else {
        content.stroke();
    }
}

fn trace(line: &[DVec2], content: &mut Content) {
    for (i, p) in line.iter().enumerate() {
        let [x, y] = rounded(*p);
        if i == 0 {
            content.move_to(x, y);
        } else {
            content.line_to(x, y);
        }
    }
}

/// Paints areas one over the other, each with its outlines.
fn fill(fills: &Fills, pen: &LinePen, content: &mut Content) {
    for area in fills.iter() {
        let [r, g, b] = area.color.map(|part| f32::from(part) / 255.0);
        content.set_fill_rgb(r, g, b).set_stroke_rgb(r, g, b);
        content.set_line_width(fills.seam_mm as f32);
        let mut is_empty = true;
        for ring in area.rings() {
            trace(ring, content);
            content.close_path();
            is_empty = false;
        }
        if !is_empty && fills.seam_mm > 0.0 {
            content.fill_even_odd_and_stroke();
        } else if !is_empty {
            content.fill_even_odd();
        }
        let mut outlines = area.outlines().peekable();
        if outlines.peek().is_some() {
            pen.take(content);
        }
        for outline in outlines {
            stroke(outline, content);
        }
    }
}

/// A point in whole micrometers.
fn rounded(p: DVec2) -> [f32; 2] {
    [p.x, p.y].map(|v| ((v * 1e3).round() / 1e3) as f32)
}
