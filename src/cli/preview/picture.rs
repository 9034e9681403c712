//! What a picture shows, and how.

use clap::{Args, ValueEnum};
use glam::DVec3;
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::engines::image::ImageEngine;
use hiddenline::stages::shading::preview::{Pixels, PreviewOptions, Show};

use crate::cli::{Refused, values};

#[derive(Args)]
#[command(next_help_heading = "Picture")]
pub(super) struct PictureArgs {
    /// Columns and rows
    #[arg(long, value_name = "WxH", value_parser = values::picture_size)]
    #[arg(default_value = "1200x900")]
    size: (u32, u32),
    /// How it is found what each pixel shows
    #[arg(long, value_enum, default_value = "z-buffer")]
    engine: EngineName,
    /// What is shown
    #[arg(long, value_enum, default_value = "shaded", conflicts_with = "tone")]
    show: ShowName,
    /// Show how light each point is, as gray from 0 to 255; nothing is white
    #[arg(long, conflicts_with_all = ["paint", "edges"])]
    tone: bool,
    /// Whether faces look flat or curved
    #[arg(long, value_enum, default_value = "flat")]
    shading: Shading,
    /// With smooth shading, faces that meet at more than this angle keep their edge
    #[arg(long, value_name = "DEG", value_parser = values::crease, default_value_t = 40.0)]
    smooth_angle: f64,
    /// Where the light comes from: a direction in the scene [default: the viewer's left shoulder]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    light: Option<DVec3>,
    /// Color of the faces
    #[arg(long, value_name = "COLOR", value_parser = values::rgb)]
    #[arg(default_value = "#d8d4c8")]
    paint: Rgb,
    /// Color where no face is seen [default: white, but black for numbers]
    #[arg(long, value_name = "COLOR", value_parser = values::rgb)]
    background: Option<Rgb>,
    /// How much of the light behind it a face stops, from 0 to 1; for the a-buffer
    #[arg(long, value_name = "PART", value_parser = values::part)]
    opacity: Option<f64>,
    /// Lay the visible lines of `draw` over it
    #[arg(long)]
    pub(super) edges: bool,
    /// Kinds of line for --edges, as for `draw`
    #[arg(long, value_name = "KINDS", value_parser = values::lines, requires = "edges")]
    #[arg(default_value = "silhouette,crease,boundary,nonmanifold,intersection,wire")]
    pub(super) lines: LineSelection,
    /// Width of these lines in pixels
    #[arg(long, value_name = "PX", value_parser = values::positive, default_value_t = 1.5)]
    edge_width: f64,
    /// Show exactly the field of view instead of the whole scene
    #[arg(long)]
    fit_fov: bool,
}

/// A color.
type Rgb = [u8; 3];

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum EngineName {
    /// Keeps a depth for each pixel
    ZBuffer,
    /// The same with one row of memory
    ScanLine,
    /// Decides for spans between edges
    Spanning,
    /// Goes from edge to edge with the faces in order of depth
    Watkins,
    /// 16 samples a pixel: smooth borders, and glass with --opacity
    ABuffer,
    /// One ray for each pixel
    RayCast,
    /// Faces from far to near, cut where they cross
    Painter,
}

#[derive(Clone, Copy, ValueEnum)]
enum ShowName {
    /// Faces in the light
    Shaded,
    /// What is nearer is lighter
    Depth,
    /// A color for each face
    Faces,
    /// Red is right, green is up, blue is towards the viewer
    Normals,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Shading {
    Flat,
    Smooth,
}

impl PictureArgs {
    /// The engine, as it is typed.
    pub(super) fn engine_name(&self) -> String {
        let name = self.engine.to_possible_value();
        name.map(|name| name.get_name().to_owned()).unwrap_or_default()
    }

    pub(super) fn options(&self) -> Result<PreviewOptions, Refused> {
        if self.opacity.is_some() && self.engine != EngineName::ABuffer {
            return Err("--opacity needs --engine a-buffer".into());
        }
        let shows_numbers = matches!(self.show, ShowName::Faces);
        if shows_numbers && self.engine == EngineName::ABuffer {
            return Err("colors of faces cannot be mixed; give another --engine".into());
        }
        let pixels = match self.engine {
            EngineName::ABuffer => Pixels::Shares { opacity: self.opacity.unwrap_or(1.0) },
            EngineName::ZBuffer => Pixels::Centers(ImageEngine::ZBuffer),
            EngineName::ScanLine => Pixels::Centers(ImageEngine::ScanLine),
            EngineName::Spanning => Pixels::Centers(ImageEngine::Spanning),
            EngineName::Watkins => Pixels::Centers(ImageEngine::Watkins),
            EngineName::RayCast => Pixels::Centers(ImageEngine::RayCast),
            EngineName::Painter => Pixels::Centers(ImageEngine::Painter),
        };
        let show = match self.show {
            _ if self.tone => Show::Tone,
            ShowName::Shaded => Show::Shaded,
            ShowName::Depth => Show::Depth,
            ShowName::Faces => Show::Faces,
            ShowName::Normals => Show::Normals,
        };
        Ok(PreviewOptions {
            size: self.size,
            pixels,
            show,
            smooth_deg: (self.shading == Shading::Smooth).then_some(self.smooth_angle),
            light: self.light,
            color: self.paint,
            background: self.background,
            fit_fov: self.fit_fov,
            stroke_px: self.edge_width,
        })
    }
}
