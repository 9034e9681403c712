//! What a picture shows, and how.

use clap::{Args, ValueEnum};
use glam::DVec3;
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::engines::image::ImageEngine;
use hiddenline::stages::shading::preview::{Pixels, PreviewOptions, Show};

use crate::cli::choice::one_of;
use crate::cli::hatch::light_source;
use crate::cli::{Refused, values};

#[derive(Args)]
#[command(next_help_heading = "Picture")]
pub(super) struct PictureArgs {
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", value_parser = values::picture_size)]
    #[arg(default_value = "1200x900")]
    size: (u32, u32),
    /// Visible-surface algorithm; all show the same faces
    #[arg(long, value_enum, default_value = "z-buffer")]
    engine: EngineName,
    /// What to show
    #[arg(long, value_name = "WHAT", value_parser = one_of::<Show>(), conflicts_with = "tone")]
    #[arg(default_value = Show::Shaded.name())]
    show: Show,
    /// Show the tone of each point as gray from 0 to 255, with the shadows of `draw --hatch`; the same as
    /// --show tone
    #[arg(long, conflicts_with_all = ["paint", "edges"])]
    tone: bool,
    /// Shade faces as flat or curved
    #[arg(long, value_enum, default_value = "flat")]
    shading: Shading,
    /// With smooth shading, faces that meet at more than this angle keep a sharp edge
    #[arg(long, value_name = "DEG", value_parser = values::crease, default_value_t = 40.0)]
    smooth_angle: f64,
    /// Direction toward the light [default: over the viewer's left shoulder]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    light: Option<DVec3>,
    /// Position of the light: a point outside the model
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    #[arg(conflicts_with = "light")]
    light_at: Option<DVec3>,
    /// Color of the faces
    #[arg(long, value_name = "COLOR", value_parser = values::rgb)]
    #[arg(default_value = "#d8d4c8")]
    paint: Rgb,
    /// Background color [default: white; black for depth, faces and normals]
    #[arg(long, value_name = "COLOR", value_parser = values::rgb)]
    background: Option<Rgb>,
    /// Opacity of faces, from 0 to 1; for a-buffer
    #[arg(long, value_name = "PART", value_parser = values::part)]
    opacity: Option<f64>,
    /// Draw the visible lines on top
    #[arg(long)]
    pub(super) edges: bool,
    /// Kinds of lines for --edges, as for `draw`
    #[arg(long, value_name = "KINDS", value_parser = values::KindsOfLine, requires = "edges")]
    #[arg(hide_possible_values = true)]
    #[arg(default_value = "silhouette,crease,boundary,nonmanifold,intersection,wire")]
    pub(super) lines: LineSelection,
    /// Width of the --edges lines in pixels
    #[arg(long, value_name = "PX", value_parser = values::positive, default_value_t = 1.5)]
    edge_width: f64,
    /// Fit the field of view instead of the scene
    #[arg(long)]
    fit_fov: bool,
}

/// A color.
type Rgb = [u8; 3];

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum EngineName {
    /// A depth for each pixel; any scene
    ZBuffer,
    /// A depth for each pixel of one row; little memory
    ScanLine,
    /// Spans between edges; few, large faces
    Spanning,
    /// From edge to edge, faces in order of depth; writes each pixel once
    Watkins,
    /// 16 samples a pixel: smooth borders, and glass with --opacity
    ABuffer,
    /// One ray for each pixel; checks the others
    RayCast,
    /// Faces from far to near, cut where they cross
    Painter,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Shading {
    /// One tone for each face
    Flat,
    /// Curved surfaces
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
        let shows_numbers = matches!(self.show, Show::Faces);
        if shows_numbers && self.engine == EngineName::ABuffer {
            return Err("face colors cannot be mixed; use another --engine".into());
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
        let show = if self.tone { Show::Tone } else { self.show };
        Ok(PreviewOptions {
            size: self.size,
            pixels,
            show,
            smooth_deg: (self.shading == Shading::Smooth).then_some(self.smooth_angle),
            light: light_source(self.light, self.light_at),
            color: self.paint,
            background: self.background,
            fit_fov: self.fit_fov,
            stroke_px: self.edge_width,
        })
    }
}
