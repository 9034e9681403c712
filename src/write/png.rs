//! A picture of the page: what the pens would draw, on white paper.
//!
//! `tiny-skia` draws with `f32` coordinates and anti-aliasing, so this is for looking at only. The
//! `png` crate encodes, which is ten times as fast as the encoder that `tiny-skia` brings along.

use std::io;

use glam::DVec2;
use png::{BitDepth, ColorType, Compression, Encoder, PixelDimensions, Unit};
use thiserror::Error;
use tiny_skia::{Color, FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Transform};

use crate::plot::{Fills, Plot};
use crate::shading::light::order_color;

/// Pixels per inch by default.
pub const DEFAULT_DPI: f64 = 150.0;

/// More pixels than this are refused: they would take more than a gigabyte.
const MOST_PIXELS: f64 = 250e6;

const MM_PER_INCH: f64 = 25.4;

/// How fine the picture is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Resolution {
    /// Pixels per inch.
    Dpi(f64),
    /// Pixels from left to right.
    WidthPx(u32),
}

impl Default for Resolution {
    fn default() -> Self {
        Self::Dpi(DEFAULT_DPI)
    }
}

/// What a picture shows of the pens' movements.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Marks {
    /// Pen-up travel, as thin red lines.
    pub travel: bool,
    /// The stroke order, by color: from blue for the first stroke through green to red for the last,
    /// in place of the pens' own colors.
    pub order: bool,
}

/// Width of the lines that show pen-up travel, in millimeters.
const TRAVEL_WIDTH_MM: f64 = 0.15;

/// Color of these lines.
const TRAVEL_COLOR: [u8; 3] = [0xe0, 0x40, 0x40];

/// How many colors show the stroke order.
const ORDER_COLORS: usize = 256;

/// Why there is no picture.
#[derive(Debug, Error)]
pub enum PngError {
    /// No pixels, or too many.
    #[error("a picture of {width_px:.0} x {height_px:.0} pixels cannot be made")]
    Size {
        /// Width requested.
        width_px: f64,
        /// Height that follows.
        height_px: f64,
    },
    /// A color that is not `#rrggbb`.
    #[error("`{0}` is not a color; write colors as #rrggbb")]
    Color(String),
    /// The stream failed.
    #[error(transparent)]
    Write(#[from] io::Error),
}

/// Writes a picture of `plot`. O(pixels + strokes).
///
/// Lines are as wide as their pen, to scale; the file says how many pixels make a meter.
///
/// # Errors
/// See [`PngError`].
pub fn write(plot: &Plot, resolution: Resolution, out: &mut dyn io::Write) -> Result<(), PngError> {
    write_marked(plot, resolution, Marks::default(), out)
}

/// Writes a picture of `plot` that also shows pen movement. O(pixels + strokes).
///
/// # Errors
/// See [`PngError`].
pub fn write_marked(
    plot: &Plot,
    resolution: Resolution,
    marks: Marks,
    out: &mut dyn io::Write,
) -> Result<(), PngError> {
    let px_per_mm = match resolution {
        Resolution::Dpi(dpi) => dpi / MM_PER_INCH,
        Resolution::WidthPx(width) => f64::from(width) / plot.width_mm,
    };
    let (width_px, height_px) =
        ((plot.width_mm * px_per_mm).round(), (plot.height_mm * px_per_mm).round());
    let too_large = || PngError::Size { width_px, height_px };
    if !(width_px >= 1.0 && height_px >= 1.0 && width_px * height_px <= MOST_PIXELS) {
        return Err(too_large());
    }
    let mut pixmap = Pixmap::new(width_px as u32, height_px as u32).ok_or_else(too_large)?;
    pixmap.fill(Color::WHITE);
    let mut gray = !marks.travel && !marks.order;
    let n_strokes: usize = plot.plotted_layers().map(|layer| layer.lines.len()).sum();
    let mut n_drawn = 0;
    for layer in plot.plotted_layers() {
        let color = parse_color(&layer.pen.color)?;
        gray &= is_gray(color) && layer.fills.iter().all(|area| is_gray(area.color));
        let width = layer.pen.width_mm;
        fill(&layer.fills, (width, color), px_per_mm, &mut pixmap);
        if marks.order {
            let strokes: Vec<&[DVec2]> = layer.lines.iter().collect();
            let tone = |i: usize| (n_drawn + i) * ORDER_COLORS / n_strokes.max(1);
            let mut start = 0;
            while start < strokes.len() {
                let n = (start..strokes.len()).take_while(|&i| tone(i) == tone(start)).count();
                let run = strokes[start..start + n].iter().copied();
                draw(
                    run,
                    width,
                    order_color(tone(start) as f64 / (ORDER_COLORS - 1) as f64),
                    px_per_mm,
                    &mut pixmap,
                );
                start += n;
            }
        } else {
            draw(layer.lines.iter(), width, color, px_per_mm, &mut pixmap);
        }
        n_drawn += layer.lines.len();
    }
    if marks.travel {
        for layer in plot.plotted_layers() {
            let (from, to) = (layer.lines.iter(), layer.lines.iter().skip(1));
            let ways: Vec<[DVec2; 2]> =
                from.zip(to).filter_map(|(a, b)| Some([*a.last()?, *b.first()?])).collect();
            let ways = ways.iter().map(<[DVec2; 2]>::as_slice);
            draw(ways, TRAVEL_WIDTH_MM, TRAVEL_COLOR, px_per_mm, &mut pixmap);
        }
    }
    encode(&pixmap, gray, px_per_mm, out)
}

fn draw<'a>(
    lines: impl Iterator<Item = &'a [DVec2]>,
    width_mm: f64,
    [r, g, b]: [u8; 3],
    px_per_mm: f64,
    pixmap: &mut Pixmap,
) {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(r, g, b, 255);
    let stroke = round_stroke((width_mm * px_per_mm) as f32);
    let mut builder = PathBuilder::new();
    for line in lines {
        trace(line, px_per_mm, &mut builder);
        if line.len() > 2 && line.first() == line.last() {
            builder.close();
        }
        let Some(path) = builder.finish() else {
            builder = PathBuilder::new();
            continue;
        };
        pixmap.stroke_path(&path, &paint, &stroke, Transform::identity(), None);
        builder = path.clear();
    }
}

fn is_gray([r, g, b]: [u8; 3]) -> bool {
    r == g && g == b
}

/// A stroke as pens make it.
fn round_stroke(width_px: f32) -> tiny_skia::Stroke {
    tiny_skia::Stroke {
        width: width_px,
        line_cap: LineCap::Round,
        line_join: LineJoin::Round,
        ..tiny_skia::Stroke::default()
    }
}

/// Goes along a line in pixels.
fn trace(line: &[DVec2], px_per_mm: f64, builder: &mut PathBuilder) {
    for (i, &p) in line.iter().enumerate() {
        let p = p * px_per_mm;
        if i == 0 {
            builder.move_to(p.x as f32, p.y as f32);
        } else {
            builder.line_to(p.x as f32, p.y as f32);
        }
    }
}

/// Paints the areas of a layer one over the other, each with its outlines by a pen.
fn fill(fills: &Fills, (width_mm, pen_color): (f64, [u8; 3]), px_per_mm: f64, pixmap: &mut Pixmap) {
    // With less than a pixel, what is behind shines through where two areas share one.
    let seam = round_stroke(((fills.seam_mm * px_per_mm) as f32).max(1.0));
    for area in fills.iter() {
        let mut builder = PathBuilder::new();
        for ring in area.rings() {
            trace(ring, px_per_mm, &mut builder);
            builder.close();
        }
        if let Some(path) = builder.finish() {
            let mut paint = Paint { anti_alias: true, ..Paint::default() };
            let [r, g, b] = area.color;
            paint.set_color_rgba8(r, g, b, 255);
            pixmap.fill_path(&path, &paint, FillRule::EvenOdd, Transform::identity(), None);
            if fills.seam_mm > 0.0 {
                pixmap.stroke_path(&path, &paint, &seam, Transform::identity(), None);
            }
        }
        draw(area.outlines(), width_mm, pen_color, px_per_mm, pixmap);
    }
}

/// Encodes the picture, as gray where nothing is colored.
fn encode(
    pixmap: &Pixmap,
    gray: bool,
    px_per_mm: f64,
    out: &mut dyn io::Write,
) -> Result<(), PngError> {
    let channels = if gray { 1 } else { 3 };
    // Everything is opaque, so premultiplied colors are the colors.
    let bytes: Vec<u8> =
        pixmap.data().chunks_exact(4).flat_map(|rgba| &rgba[..channels]).copied().collect();
    let mut encoder = Encoder::new(out, pixmap.width(), pixmap.height());
    encoder.set_color(if gray { ColorType::Grayscale } else { ColorType::Rgb });
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    let per_meter = (px_per_mm * 1000.0).round() as u32;
    encoder.set_pixel_dims(Some(PixelDimensions {
        xppu: per_meter,
        yppu: per_meter,
        unit: Unit::Meter,
    }));
    let mut writer = encoder.write_header().map_err(io::Error::from)?;
    writer.write_image_data(&bytes).map_err(io::Error::from)?;
    writer.finish().map_err(io::Error::from)?;
    Ok(())
}

fn parse_color(text: &str) -> Result<[u8; 3], PngError> {
    text.strip_prefix('#')
        .filter(|digits| digits.len() == 6)
        .and_then(|digits| u32::from_str_radix(digits, 16).ok())
        .map(|rgb| [(rgb >> 16) as u8, (rgb >> 8) as u8, rgb as u8])
        .ok_or_else(|| PngError::Color(text.to_owned()))
}
