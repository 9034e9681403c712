//! DXF R12 (AC1009), which every CAD and CAM program reads: polylines, one layer for each layer of the
//! plot.
//!
//! Y up, origin at the page's bottom left. Coordinates are page millimeters, or model units if the
//! drawing has a scale; `$INSUNITS` and `$MEASUREMENT` name the unit. These two variables are younger
//! than R12, and readers that do not know them skip them. A layer with a dash pattern gets a linetype
//! (`LTYPE`) for it. The `dxf` crate would bring 35 others to replace 150 lines.

use std::io;

use glam::{DVec2, dvec2};

use super::decimal::Decimal;
use super::{Format, only_lines};
use crate::plot::{Layer, Plot};

/// Decimals of a millimeter on paper.
const DECIMALS: i32 = 4;
/// In the flags of a polyline: its linetype runs on around corners. Without it each segment would
/// start its own dash, and short segments would be solid.
const CONTINUOUS_LINETYPE: u32 = 128;

/// What the numbers in the file mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DxfScale {
    /// Millimeters on paper for one drawing unit.
    pub mm_per_unit: f64,
    /// The unit that the file names.
    pub unit: DxfUnit,
}

impl Default for DxfScale {
    /// Millimeters on paper.
    fn default() -> Self {
        Self { mm_per_unit: 1.0, unit: DxfUnit::Millimeter }
    }
}

/// A unit that DXF has a number for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DxfUnit {
    /// 25.4 mm.
    Inch,
    /// 1 mm.
    Millimeter,
    /// 10 mm.
    Centimeter,
    /// 1000 mm.
    Meter,
}

impl DxfUnit {
    /// All units.
    pub const ALL: [Self; 4] = [Self::Millimeter, Self::Centimeter, Self::Meter, Self::Inch];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Millimeter => "mm",
            Self::Centimeter => "cm",
            Self::Meter => "m",
            Self::Inch => "in",
        }
    }

    /// Its length in millimeters.
    pub fn mm(self) -> f64 {
        match self {
            Self::Millimeter => 1.0,
            Self::Centimeter => 10.0,
            Self::Meter => 1000.0,
            Self::Inch => 25.4,
        }
    }

    /// The value of `$INSUNITS`.
    fn number(self) -> &'static str {
        match self {
            Self::Inch => "1",
            Self::Millimeter => "4",
            Self::Centimeter => "5",
            Self::Meter => "6",
        }
    }
}

/// Writes `plot` as DXF R12. Strokes of a single point become `POINT`s.
///
/// # Errors
/// Those of `out`.
pub fn write(plot: &Plot, scale: DxfScale, out: &mut dyn io::Write) -> io::Result<()> {
    only_lines(plot, Format::Dxf)?;
    let linetypes = Linetypes::of(plot);
    let digits = libm::ceil(libm::log10(scale.mm_per_unit)) as i32;
    let decimals = DECIMALS.saturating_add(digits).max(0) as u32;
    let mut out = DxfGroups { out, decimals, scale: scale.mm_per_unit };
    out.text(0, "SECTION")?;
    out.text(2, "HEADER")?;
    out.text(9, "$ACADVER")?;
    out.text(1, "AC1009")?;
    out.text(9, "$INSUNITS")?;
    out.text(70, scale.unit.number())?;
    out.text(9, "$MEASUREMENT")?;
    out.text(70, if scale.unit == DxfUnit::Inch { "0" } else { "1" })?;
    out.text(9, "$EXTMIN")?;
    out.point(DVec2::ZERO)?;
    out.text(9, "$EXTMAX")?;
    out.point(dvec2(plot.width_mm, plot.height_mm))?;
    out.text(0, "ENDSEC")?;
    out.text(0, "SECTION")?;
    out.text(2, "TABLES")?;
    linetypes.write(&mut out)?;
    out.text(0, "TABLE")?;
    out.text(2, "LAYER")?;
    out.text(70, &plot.plotted_layers().count().to_string())?;
    for layer in plot.plotted_layers() {
        out.text(0, "LAYER")?;
        out.text(2, &layer_name(layer))?;
        out.text(70, "0")?;
        out.text(62, &color_index(&layer.pen.color).to_string())?;
        out.text(6, &linetypes.name(layer))?;
    }
    out.text(0, "ENDTAB")?;
    out.text(0, "ENDSEC")?;
    out.text(0, "SECTION")?;
    out.text(2, "ENTITIES")?;
    for layer in plot.plotted_layers() {
        for line in layer.lines.iter().filter(|line| line.iter().all(|p| p.is_finite())) {
            write_stroke(line, layer, plot.height_mm, &mut out)?;
        }
    }
    out.text(0, "ENDSEC")?;
    out.text(0, "EOF")
}

/// The dash patterns of a plot: each gets a linetype.
struct Linetypes(Vec<[f64; 2]>);

impl Linetypes {
    fn of(plot: &Plot) -> Self {
        let mut patterns = Vec::new();
        for pattern in plot.plotted_layers().filter_map(|layer| layer.dash_mm) {
            if !patterns.contains(&pattern) {
                patterns.push(pattern);
            }
        }
        Self(patterns)
    }

    /// The linetype of a layer.
    fn name(&self, layer: &Layer) -> String {
        let index = layer.dash_mm.and_then(|dash| self.0.iter().position(|&known| known == dash));
        index.map_or("CONTINUOUS".to_owned(), Self::numbered)
    }

    fn numbered(index: usize) -> String {
        match index {
            0 => "DASHED".to_owned(),
            _ => format!("DASHED_{}", index + 1),
        }
    }

    fn write(&self, out: &mut DxfGroups<'_>) -> io::Result<()> {
        out.text(0, "TABLE")?;
        out.text(2, "LTYPE")?;
        out.text(70, &(self.0.len() + 1).to_string())?;
        out.linetype("CONTINUOUS", "Solid line", &[])?;
        for (index, &[dash, gap]) in self.0.iter().enumerate() {
            out.linetype(&Self::numbered(index), "Dashed __ __ __", &[dash, -gap])?;
        }
        out.text(0, "ENDTAB")
    }
}

fn write_stroke(
    line: &[DVec2],
    layer: &Layer,
    height_mm: f64,
    out: &mut DxfGroups<'_>,
) -> io::Result<()> {
    let name = &layer_name(layer);
    let up = |p: &DVec2| dvec2(p.x, height_mm - p.y);
    let (Some(first), Some(last)) = (line.first(), line.last()) else { return Ok(()) };
    if line.iter().all(|p| p == first) {
        out.text(0, "POINT")?;
        out.text(8, name)?;
        return out.point(up(first));
    }
    let closed = line.len() > 3 && first == last;
    out.text(0, "POLYLINE")?;
    out.text(8, name)?;
    out.text(66, "1")?;
    out.point(DVec2::ZERO)?;
    let flags = u32::from(closed) | if layer.dash_mm.is_some() { CONTINUOUS_LINETYPE } else { 0 };
    out.text(70, &flags.to_string())?;
    for p in &line[..line.len() - usize::from(closed)] {
        out.text(0, "VERTEX")?;
        out.text(8, name)?;
        out.point(up(p))?;
    }
    out.text(0, "SEQEND")?;
    out.text(8, name)
}

/// Pairs of group code and value, a line each.
struct DxfGroups<'a> {
    out: &'a mut dyn io::Write,
    decimals: u32,
    /// Millimeters on paper for one drawing unit.
    scale: f64,
}

impl DxfGroups<'_> {
    fn text(&mut self, code: u32, value: &str) -> io::Result<()> {
        write!(self.out, "{code:>3}\r\n{value}\r\n")
    }

    /// A length on paper, in drawing units.
    fn length(&mut self, code: u32, mm: f64) -> io::Result<()> {
        self.text(code, &Decimal::new(mm / self.scale, self.decimals).to_string())
    }

    fn point(&mut self, p: DVec2) -> io::Result<()> {
        self.length(10, p.x)?;
        self.length(20, p.y)?;
        self.text(30, "0")
    }

    /// A linetype of lengths in millimeters; gaps are negative.
    fn linetype(&mut self, name: &str, description: &str, lengths: &[f64]) -> io::Result<()> {
        self.text(0, "LTYPE")?;
        self.text(2, name)?;
        self.text(70, "0")?;
        self.text(3, description)?;
        // R12 knows only "A" for alignment: patterns begin and end with a dash.
        self.text(72, "65")?;
        self.text(73, &lengths.len().to_string())?;
        self.length(40, lengths.iter().map(|length| length.abs()).sum::<f64>() + 0.0)?;
        lengths.iter().try_for_each(|&length| self.length(49, length))
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
