//! A picture of a scene: shaded faces, their numbers, depth or normals, as PNG.
//!
//! ```text
//!  engines::image ─► triangle of each pixel ─► shade ─► overlay ─► rows of a PNG
//!                    (a strip of rows)         color    strokes    strip after strip
//! ```
//!
//! Only the current strips are in memory, so memory does not depend on the height of the picture.

mod overlay;
mod shade;
mod shadow;

use std::io::{self, Write};

use glam::DVec2;
use png::{BitDepth, ColorType, Compression, Encoder};
use rayon::prelude::*;
use thiserror::Error;

use self::overlay::Overlay;
use self::shade::Shader;
use crate::camera::{Camera, Projection};
use crate::engines::image::edge::center;
use crate::engines::image::raster::STRIP_ROWS;
use crate::engines::image::{
    ImageEngine, NOTHING, PixelMap, Raster, a_buffer, painter, solve_strip,
};
use crate::model::scene::Scene;
use crate::shading::light::{DEFAULT_PAINT, LightError, LightSource, to_bytes};
use crate::strokes::Strokes;
use crate::timing::{Seconds, timed};

/// Columns and rows of a picture, by default.
pub const DEFAULT_SIZE: (u32, u32) = (1200, 900);

/// More columns or rows than this are refused.
pub const LARGEST_SIDE: u32 = 1 << 16;

/// Empty border around the picture, as a fraction of its shorter side.
const MARGIN: f64 = 0.04;

/// How the triangles in each pixel are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pixels {
    /// What its center shows.
    Centers(ImageEngine),
    /// The share of each triangle in it, for anti-aliased and transparent pictures; `opacity` is from 0 to
    /// 1.
    Shares {
        /// How much of the light behind it a triangle stops.
        opacity: f64,
    },
}

/// What a picture shows of the triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Show {
    /// Their color in the light.
    #[default]
    Shaded,
    /// How light they are, as gray: 0 black, 255 white; without color. The background is white. Where
    /// something casts a shadow, the tone is that of faces turned away from the light.
    Tone,
    /// How near they are: the nearest point of the scene white, the farthest dark.
    Depth,
    /// Which face they are part of: each face has its own color.
    Faces,
    /// Their normal, turned to the viewer: red is right, green is up, blue is toward the viewer.
    Normals,
}

impl Show {
    /// All of them, in the order of the documentation.
    pub const ALL: [Self; 5] = [Self::Shaded, Self::Tone, Self::Depth, Self::Faces, Self::Normals];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shaded => "shaded",
            Self::Tone => "tone",
            Self::Depth => "depth",
            Self::Faces => "faces",
            Self::Normals => "normals",
        }
    }
}

impl Show {
    /// The color where no face is seen, by default.
    fn background(self) -> [u8; 3] {
        match self {
            Self::Shaded | Self::Tone => [255; 3],
            Self::Depth | Self::Faces | Self::Normals => [0; 3],
        }
    }
}

/// How a picture is made.
#[derive(Debug, Clone, PartialEq)]
pub struct PreviewOptions {
    /// Columns and rows.
    pub size: (u32, u32),
    /// How pixels are decided.
    pub pixels: Pixels,
    /// What is shown.
    pub show: Show,
    /// Faces that meet at this angle, in degrees, or less look like one curved surface; `None` for
    /// flat faces.
    pub smooth_deg: Option<f64>,
    /// Where the light comes from.
    pub light: LightSource,
    /// Color of the faces.
    pub color: [u8; 3],
    /// Color where no face is seen; `None` to suit what is shown.
    pub background: Option<[u8; 3]>,
    /// Show exactly the vertical field of view instead of the whole scene; for perspective only.
    pub fit_fov: bool,
    /// Width of the strokes laid over it, in pixels.
    pub stroke_px: f64,
}

impl Default for PreviewOptions {
    fn default() -> Self {
        Self {
            size: DEFAULT_SIZE,
            pixels: Pixels::Centers(ImageEngine::default()),
            show: Show::default(),
            smooth_deg: None,
            light: LightSource::default(),
            color: DEFAULT_PAINT,
            background: None,
            fit_fov: false,
            stroke_px: 1.5,
        }
    }
}

/// Why a picture cannot be made.
#[derive(Debug, Error)]
pub enum PreviewError {
    /// No pixels, or too many.
    #[error("a picture of {0} x {1} pixels cannot be made; sides are from 1 to 65536")]
    Size(u32, u32),
    /// [`PreviewOptions::fit_fov`] with an orthographic camera.
    #[error("an orthographic view has no field of view to fit")]
    NoFieldOfView,
    /// The painter cannot order the faces.
    #[error(transparent)]
    NoOrder(#[from] painter::NoOrder),
    /// The light cannot cast shadows.
    #[error(transparent)]
    Light(#[from] LightError),
    /// The stream failed.
    #[error(transparent)]
    Write(#[from] io::Error),
}

impl PreviewOptions {
    /// Where points of the image are in the picture. It is fitted by the scene's extent, as drawings are.
    pub fn pixel_map(&self, scene: &Scene, camera: &Camera) -> PixelMap {
        let of_view = if self.fit_fov { PixelMap::field_of_view(camera, self.size) } else { None };
        of_view.unwrap_or_else(|| {
            let bounds = scene.extent(camera).corners().unwrap_or((DVec2::NEG_ONE, DVec2::ONE));
            let margin = f64::from(self.size.0.min(self.size.1)) * MARGIN;
            PixelMap::fitting(bounds, self.size, margin)
        })
    }
}

/// Writes a picture of `scene` as `camera` sees it, with the visible strokes of `edges` on it. Returns
/// the wall time of classification, visibility and writing.
///
/// # Errors
/// See [`PreviewError`].
pub fn write(
    scene: &Scene,
    camera: &Camera,
    options: &PreviewOptions,
    edges: Option<&Strokes>,
    out: &mut dyn Write,
) -> Result<Seconds, PreviewError> {
    let mut seconds = Seconds::default();
    let (width, height) = options.size;
    let sides = 1..=LARGEST_SIDE;
    if !(sides.contains(&width) && sides.contains(&height)) {
        return Err(PreviewError::Size(width, height));
    }
    if options.fit_fov && camera.projection() == Projection::Orthographic {
        return Err(PreviewError::NoFieldOfView);
    }
    let map = options.pixel_map(scene, camera);
    // Pixels of the raster along each side of a pixel of the picture.
    let samples = match options.pixels {
        Pixels::Centers(_) => 1,
        Pixels::Shares { .. } => a_buffer::SIDE,
    };
    let fine = map.finer(samples);
    let raster = timed(&mut seconds.classify, || {
        let size = (width * samples, height * samples);
        match options.pixels {
            Pixels::Centers(ImageEngine::Painter) => painter::raster(scene, camera, &fine, size),
            _ => Ok(Raster::new(scene, camera, &fine, size)),
        }
    })?;
    let shader =
        timed(&mut seconds.classify, || Shader::new(scene, camera, &fine, &raster, options))?;
    let rows_of_strip = STRIP_ROWS / samples;
    let overlay =
        edges.map(|edges| Overlay::new(edges, &map, options.stroke_px, height, rows_of_strip));
    let is_gray = matches!(options.show, Show::Tone | Show::Depth) && options.background.is_none();

    let of_strip = |number: usize| -> Vec<u8> {
        let mut colors = match options.pixels {
            Pixels::Shares { opacity } => shares(&raster, number, opacity, &shader),
            Pixels::Centers(engine) => centers(&raster, number, engine, &shader),
        };
        if let Some(overlay) = &overlay {
            overlay.draw(number, width, &mut colors);
        }
        if is_gray { colors.iter().map(|color| color[0]).collect() } else { colors.concat() }
    };

    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(if is_gray { ColorType::Grayscale } else { ColorType::Rgb });
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    let mut writer = encoder.write_header().map_err(io::Error::from)?;
    let mut rows = writer.stream_writer().map_err(io::Error::from)?;
    let n_strips = height.div_ceil(rows_of_strip) as usize;
    let at_work = rayon::current_num_threads() * STRIPS_A_THREAD;
    for first in (0..n_strips).step_by(at_work) {
        let last = (first + at_work).min(n_strips);
        let strips: Vec<Vec<u8>> = timed(&mut seconds.visibility, || {
            (first..last).into_par_iter().map(of_strip).collect()
        });
        timed(&mut seconds.write, || strips.iter().try_for_each(|strip| rows.write_all(strip)))?;
    }
    timed(&mut seconds.write, || rows.finish()).map_err(io::Error::from)?;
    timed(&mut seconds.write, || writer.finish()).map_err(io::Error::from)?;
    Ok(seconds)
}

/// Strips made at once for each thread: more share the work better, fewer take less memory.
const STRIPS_A_THREAD: usize = 4;

/// The colors of a strip by pixel centers.
fn centers(raster: &Raster, number: usize, engine: ImageEngine, shader: &Shader) -> Vec<[u8; 3]> {
    let strip = raster.strip(number);
    let width = raster.width();
    let mut items = vec![0; width as usize * strip.rows.len()];
    solve_strip(raster, &strip, engine, &mut items);
    let mut colors = Vec::with_capacity(items.len());
    // Along a row often the same triangle is seen.
    let mut last = (NOTHING, to_bytes(shader.background()));
    for (row, items) in strip.rows.zip(items.chunks_exact(width as usize)) {
        for (column, &item) in (0..).zip(items) {
            if item != last.0 || !shader.is_even() {
                let center = DVec2::new(center(column), center(row));
                last = (item, to_bytes(shader.color(item, center)));
            }
            colors.push(last.1);
        }
    }
    colors
}

/// The colors of a strip by shares.
fn shares(fine: &Raster, number: usize, opacity: f64, shader: &Shader) -> Vec<[u8; 3]> {
    let strip = fine.strip(number);
    let width = fine.width() / a_buffer::SIDE;
    let (mut column, mut row) = (0, strip.rows.start / a_buffer::SIDE);
    let mut colors = Vec::new();
    a_buffer::solve(fine, &strip, opacity, |shares| {
        let center = DVec2::new(center(column), center(row)) * f64::from(a_buffer::SIDE);
        let rest = 1.0 - shares.iter().map(|share| share.weight).sum::<f64>();
        let color = shares
            .iter()
            .map(|share| shader.color(share.triangle, center) * share.weight)
            .fold(shader.background() * rest.max(0.0), |sum, color| sum + color);
        colors.push(to_bytes(color));
        column += 1;
        if column == width {
            (column, row) = (0, row + 1);
        }
    });
    colors
}
