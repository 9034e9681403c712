//! PDF for print: one page of the sheet's size, areas filled, strokes as lines of the pens' widths.
//!
//! Written with `pdf-writer`, whose numbers are `f32`: a hundredth of a micrometer on a large
//! sheet. Coordinates are rounded to micrometers before.

use std::io;

use glam::DVec2;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Finish, Pdf, Rect, Ref, TextStr};

use crate::plot::{Fills, Plot};

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
        fill(&layer.fills, &mut content);
        let [r, g, b] = [1, 3, 5].map(|i| {
            let hex = layer.pen.color.get(i..i + 2);
            let value = hex.and_then(|hex| u8::from_str_radix(hex, 16).ok()).unwrap_or(0);
            f32::from(value) / 255.0
        });
        content.set_stroke_rgb(r, g, b);
        content.set_line_width(layer.pen.width_mm as f32);
        for line in layer.lines.iter().filter(|line| line.iter().all(|p| p.is_finite())) {
            let closed = line.len() > 3 && line.first() == line.last();
            for (i, p) in line[..line.len() - usize::from(closed)].iter().enumerate() {
                let [x, y] = rounded(*p);
                if i == 0 {
                    content.move_to(x, y);
                } else {
                    content.line_to(x, y);
                }
            }
            if closed {
                content.close_and_stroke();
            } else {
                content.stroke();
            }
        }
    }
    content
}

/// Paints areas one over the other.
fn fill(fills: &Fills, content: &mut Content) {
    content.set_line_width(fills.seam_mm as f32);
    for area in fills.iter() {
        let [r, g, b] = area.color.map(|part| f32::from(part) / 255.0);
        content.set_fill_rgb(r, g, b).set_stroke_rgb(r, g, b);
        for ring in area.rings() {
            for (i, &p) in ring.iter().enumerate() {
                let [x, y] = rounded(p);
                if i == 0 {
                    content.move_to(x, y);
                } else {
                    content.line_to(x, y);
                }
            }
            content.close_path();
        }
        if fills.seam_mm > 0.0 {
            content.fill_even_odd_and_stroke();
        } else {
            content.fill_even_odd();
        }
    }
}

/// A point in whole micrometers.
fn rounded(p: DVec2) -> [f32; 2] {
    [p.x, p.y].map(|v| ((v * 1e3).round() / 1e3) as f32)
}
