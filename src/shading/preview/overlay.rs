//! Strokes laid over a picture, strip by strip.

use std::ops::Range;

use glam::DVec2;
use tiny_skia::{LineCap, LineJoin, Paint, PathBuilder, Pixmap, Stroke, Transform};

use crate::engines::image::PixelMap;
use crate::strokes::Strokes;

/// Strokes in pixels, and which of them reach each strip.
pub(super) struct Overlay {
    strokes: Vec<Vec<DVec2>>,
    by_strip: Vec<Vec<u32>>,
    width_px: f64,
    height: u32,
    rows_of_strip: u32,
}

impl Overlay {
    /// The visible strokes of a drawing.
    pub(super) fn new(
        edges: &Strokes,
        map: &PixelMap,
        width_px: f64,
        height: u32,
        rows_of_strip: u32,
    ) -> Self {
        let visible = edges.iter().filter(|stroke| stroke.qi == 0);
        let strokes: Vec<Vec<DVec2>> = visible
            .map(|stroke| stroke.points.iter().map(|&point| map.pixel(point)).collect())
            .collect();
        let mut by_strip = vec![Vec::new(); height.div_ceil(rows_of_strip) as usize];
        for (number, stroke) in (0..).zip(&strokes) {
            for strip in strips(stroke, width_px, height, rows_of_strip) {
                by_strip[strip].push(number);
            }
        }
        Self { strokes, by_strip, width_px, height, rows_of_strip }
    }

    /// Draws the strokes that reach a strip on its pixels.
    pub(super) fn draw(&self, strip: usize, width: u32, colors: &mut [[u8; 3]]) {
        let Some(numbers) = self.by_strip.get(strip).filter(|numbers| !numbers.is_empty()) else {
            return;
        };
        let top = strip as u32 * self.rows_of_strip;
        let rows = self.rows_of_strip.min(self.height - top);
        let Some(mut pixmap) = Pixmap::new(width, rows) else { return };
        let mut paint = Paint { anti_alias: true, ..Paint::default() };
        paint.set_color_rgba8(0, 0, 0, 255);
        let pen = Stroke {
            width: self.width_px as f32,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        for &number in numbers {
            let mut builder = PathBuilder::new();
            let points = &self.strokes[number as usize];
            for (k, point) in points.iter().enumerate() {
                let (x, y) = (point.x as f32, (point.y - f64::from(top)) as f32);
                if k == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
            }
            if let Some(path) = builder.finish() {
                pixmap.stroke_path(&path, &paint, &pen, Transform::identity(), None);
            }
        }
        for (color, drawn) in colors.iter_mut().zip(pixmap.pixels()) {
            // The pen is black: it only takes away.
            let left = 255 - u16::from(drawn.alpha());
            *color = color.map(|part| ((u16::from(part) * left + 127) / 255) as u8);
        }
    }
}

/// The strips that a stroke reaches.
fn strips(stroke: &[DVec2], width_px: f64, height: u32, rows_of_strip: u32) -> Range<usize> {
    let ys = stroke.iter().map(|point| point.y);
    let range = |(low, high): (f64, f64), y: f64| (low.min(y), high.max(y));
    let (low, high) = ys.fold((f64::INFINITY, f64::NEG_INFINITY), range);
    let (low, high) = (low - width_px - 1.0, high + width_px + 1.0);
    if !(low < f64::from(height) && high >= 0.0) {
        return 0..0;
    }
    // The casts turn what is negative into 0.
    let last = (high as u32).min(height - 1);
    (low as u32 / rows_of_strip) as usize..(last / rows_of_strip) as usize + 1
}
