//! DXF R12 (AC1009), which every CAD and CAM program reads: polylines on one layer for each pen.
//!
//! Millimeters, y up, origin at the page's bottom left. `$INSUNITS` and `$MEASUREMENT` say so; they
//! are younger than R12, and readers that do not know them skip them. The `dxf` crate brings 35
//! others for what is 80 lines here.

use std::io;

use glam::{DVec2, dvec2};

use super::decimal::Decimal;
use super::{Format, only_lines};
use crate::plot::{Layer, Plot};

/// Decimals of a millimeter.
const DECIMALS: u32 = 4;
/// The value of `$INSUNITS` for millimeters.
const MILLIMETERS: &str = "4";

/// Writes `plot` as DXF R12. Strokes without extent are points.
///
/// # Errors
/// Those of `out`.
pub fn write(plot: &Plot, out: &mut dyn io::Write) -> io::Result<()> {
    only_lines(plot, Format::Dxf)?;
    let mut out = Groups(out);
    out.text(0, "SECTION")?;
    out.text(2, "HEADER")?;
    out.text(9, "$ACADVER")?;
    out.text(1, "AC1009")?;
    out.text(9, "$INSUNITS")?;
    out.text(70, MILLIMETERS)?;
    out.text(9, "$MEASUREMENT")?;
    out.text(70, "1")?;
    out.text(9, "$EXTMIN")?;
    out.point(DVec2::ZERO)?;
    out.text(9, "$EXTMAX")?;
    out.point(dvec2(plot.width_mm, plot.height_mm))?;
    out.text(0, "ENDSEC")?;
    out.text(0, "SECTION")?;
    out.text(2, "TABLES")?;
    out.text(0, "TABLE")?;
    out.text(2, "LAYER")?;
    out.text(70, &plot.plotted_layers().count().to_string())?;
    for layer in plot.plotted_layers() {
        out.text(0, "LAYER")?;
        out.text(2, &layer_name(layer))?;
        out.text(70, "0")?;
        out.text(62, &color_index(&layer.pen.color).to_string())?;
        out.text(6, "CONTINUOUS")?;
    }
    out.text(0, "ENDTAB")?;
    out.text(0, "ENDSEC")?;
    out.text(0, "SECTION")?;
    out.text(2, "ENTITIES")?;
    for layer in plot.plotted_layers() {
        let name = layer_name(layer);
        for line in layer.lines.iter().filter(|line| line.iter().all(|p| p.is_finite())) {
            write_stroke(line, &name, plot.height_mm, &mut out)?;
        }
    }
    out.text(0, "ENDSEC")?;
    out.text(0, "EOF")
}

fn write_stroke(
    line: &[DVec2],
    layer: &str,
    height_mm: f64,
    out: &mut Groups<'_>,
) -> io::Result<()> {
    let up = |p: &DVec2| dvec2(p.x, height_mm - p.y);
    let (Some(first), Some(last)) = (line.first(), line.last()) else { return Ok(()) };
    if line.iter().all(|p| p == first) {
        out.text(0, "POINT")?;
        out.text(8, layer)?;
        return out.point(up(first));
    }
    let closed = line.len() > 3 && first == last;
    out.text(0, "POLYLINE")?;
    out.text(8, layer)?;
    out.text(66, "1")?;
    out.point(DVec2::ZERO)?;
    out.text(70, if closed { "1" } else { "0" })?;
    for p in &line[..line.len() - usize::from(closed)] {
        out.text(0, "VERTEX")?;
        out.text(8, layer)?;
        out.point(up(p))?;
    }
    out.text(0, "SEQEND")?;
    out.text(8, layer)
}

/// Pairs of group code and value, a line each.
struct Groups<'a>(&'a mut dyn io::Write);

impl Groups<'_> {
    fn text(&mut self, code: u32, value: &str) -> io::Result<()> {
        write!(self.0, "{code:>3}\r\n{value}\r\n")
    }

    fn point(&mut self, p: DVec2) -> io::Result<()> {
        self.text(10, &Decimal::new(p.x, DECIMALS).to_string())?;
        self.text(20, &Decimal::new(p.y, DECIMALS).to_string())?;
        self.text(30, "0")
    }
}

/// R12 takes 31 letters, digits, `$`, `-` and `_`.
fn layer_name(layer: &Layer) -> String {
    let text = format!("{}_{}", layer.number, layer.name);
    let allowed = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
    text.chars().take(31).map(|c| allowed(c).to_ascii_uppercase()).collect()
}

/// The nearest of AutoCAD's first colors; 7 is black on white and white on black.
fn color_index(color: &str) -> u32 {
    let channel = |i: usize| {
        color.get(i..i + 2).and_then(|hex| i64::from_str_radix(hex, 16).ok()).unwrap_or(0)
    };
    let (r, g, b) = (channel(1), channel(3), channel(5));
    const COLORS: [(u32, [i64; 3]); 9] = [
        (7, [0, 0, 0]),
        (7, [255, 255, 255]),
        (1, [255, 0, 0]),
        (2, [255, 255, 0]),
        (3, [0, 255, 0]),
        (4, [0, 255, 255]),
        (5, [0, 0, 255]),
        (6, [255, 0, 255]),
        (8, [128, 128, 128]),
    ];
    let distance = |c: [i64; 3]| (c[0] - r).pow(2) + (c[1] - g).pow(2) + (c[2] - b).pow(2);
    COLORS.iter().min_by_key(|(_, c)| distance(*c)).map_or(7, |&(index, _)| index)
}
