//! A picture of the page: what the pens would draw, on white paper.
//!
//! `tiny-skia` draws with `f32` coordinates and anti-aliasing, so this is for looking at only. The
//! `png` crate encodes, which is ten times as fast as the encoder that `tiny-skia` brings along.

use std::io;

use glam::DVec2;
use png::{BitDepth, ColorType, Compression, Encoder, PixelDimensions, Unit};
use thiserror::Error;
use tiny_skia::{Color, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Transform};

use crate::plot::{Pen, Plot};

/// Pixels per inch, unless set otherwise.
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

/// Why there is no picture.
#[derive(Debug, Error)]
pub enum PngError {
    /// No pixels, or too many.
    #[error(
        "a picture of {width_px:.0} x {height_px:.0} pixels cannot be made; \
             give another --dpi or --png-width"
    )]
    Size {
        /// Width asked for.
        width_px: f64,
        /// Height that follows.
        height_px: f64,
    },
    /// A color that is not `#rrggbb`.
    #[error("`{0}` is no color; colors are written #rrggbb")]
    Color(String),
    /// The stream failed.
    #[error(transparent)]
    Write(#[from] io::Error),
}

/// Writes a picture of `plot`. O(pixels + strokes).
///
/// Lines are as wide as their pen, to scale; the file says how many pixels make a metre.
///
/// # Errors
/// See [`PngError`].
pub fn write(plot: &Plot, resolution: Resolution, out: &mut dyn io::Write) -> Result<(), PngError> {
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
    let mut gray = true;
    for layer in &plot.layers {
        let color = parse_color(&layer.pen.color)?;
        gray &= color[0] == color[1] && color[1] == color[2];
        draw(layer.lines.iter(), &layer.pen, color, px_per_mm, &mut pixmap);
    }
    encode(&pixmap, gray, px_per_mm, out)
}

fn draw<'a>(
    lines: impl Iterator<Item = &'a [DVec2]>,
    pen: &Pen,
    [r, g, b]: [u8; 3],
    px_per_mm: f64,
    pixmap: &mut Pixmap,
) {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(r, g, b, 255);
    let stroke = tiny_skia::Stroke {
        width: (pen.width_mm * px_per_mm) as f32,
        line_cap: LineCap::Round,
        line_join: LineJoin::Round,
        ..tiny_skia::Stroke::default()
    };
    let mut builder = PathBuilder::new();
    for line in lines {
        for (i, &p) in line.iter().enumerate() {
            let p = p * px_per_mm;
            if i == 0 {
                builder.move_to(p.x as f32, p.y as f32);
            } else {
                builder.line_to(p.x as f32, p.y as f32);
            }
        }
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
    let per_metre = (px_per_mm * 1000.0).round() as u32;
    encoder.set_pixel_dims(Some(PixelDimensions {
        xppu: per_metre,
        yppu: per_metre,
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
