//! Which areas are filled, and with what.

use clap::Args;
use glam::DVec3;
use hiddenline::stages::engines::face::warnock::Subdivision;
use hiddenline::stages::engines::face::{FaceEngine, FaceOptions};
use hiddenline::stages::shading::fill::{Coloring, DEFAULT_SEAM_MM, FillOptions, Palette};

use crate::cli::choice::{one_of, one_of_these};
use crate::cli::hatch::light_source;
use crate::cli::values;

#[derive(Args)]
#[command(next_help_heading = "Areas")]
pub(super) struct AreaArgs {
    /// Visible-surface algorithm
    #[arg(long, value_parser = one_of::<FaceEngine>(), default_value = FaceEngine::Auto.name())]
    engine: FaceEngine,
    /// Direction toward the light [default: over the viewer's left shoulder]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    light: Option<DVec3>,
    /// Position of the light: a point outside the model
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    #[arg(conflicts_with = "light")]
    light_at: Option<DVec3>,
    /// How much the farthest face fades into the paper, from 0 to 1
    #[arg(long, value_name = "PART", value_parser = values::part, default_value_t = 0.0)]
    depth_cue: f64,
    /// Color of faces whose material has none
    ///
    /// Materials of OBJ files take their color from Kd in the MTL file.
    #[arg(long, value_name = "COLOR", value_parser = values::rgb)]
    #[arg(default_value = "#d8d4c8")]
    paint: Rgb,
    /// Use only N grays, or only these inks, as in 4 or navy,#e07020,ivory
    ///
    /// Each face gets the nearest ink. Each ink is a layer, and inks never overlap.
    #[arg(long, value_name = "N|COLORS", value_parser = palette)]
    palette: Option<Palette>,
    /// Never let areas overlap, whatever the engine; implied by --palette
    #[arg(long)]
    disjoint: bool,
    /// Width of an outline around each area, in the same color, to close seams
    ///
    /// Screens and printers antialias edges, so without it paper shows through between areas. 0 leaves areas
    /// unchanged, for cutters.
    #[arg(long, value_name = "MM", value_parser = values::length, default_value_t = DEFAULT_SEAM_MM)]
    pub(super) seam: f64,
    /// Remove hidden lines by painting over them: faces in white from far to near, each with its edges
    ///
    /// For screen and print only. A plotter cannot cover ink with white and would draw all hidden lines too,
    /// so plot the lines of `draw` instead. Engines: depth-sort, bsp (the default here), octree.
    #[arg(long, conflicts_with_all = [
        "palette", "debug", "disjoint", "no_edges", "light", "light_at", "depth_cue", "paint", "leaf",
        "subdivision",
    ])]
    pub(super) white: bool,
    /// Color areas to show how the engine worked
    #[arg(long, value_name = "BY", value_parser = one_of_these(&DEBUGS), conflicts_with = "palette")]
    debug: Option<Coloring>,
    /// Width of the smallest windows of warnock, on paper [default: the pen width]
    #[arg(long, value_name = "MM", value_parser = values::positive_length)]
    pub(super) leaf: Option<f64>,
    /// How warnock divides windows
    #[arg(long, value_name = "HOW", value_parser = one_of::<Subdivision>())]
    #[arg(default_value = Subdivision::Regular.name())]
    subdivision: Subdivision,
    /// Make N pictures around the target, NAME-001 to NAME-N, all at the same scale
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=999))]
    pub(super) turntable: Option<u16>,
}

/// What `--debug` shows.
const DEBUGS: [Coloring; 3] = [Coloring::Order, Coloring::Depth, Coloring::Splits];

/// A color.
type Rgb = [u8; 3];

impl AreaArgs {
    pub(super) fn options(&self) -> FillOptions {
        FillOptions {
            engine: match self.engine {
                FaceEngine::Auto if self.white => FaceEngine::Bsp,
                engine => engine,
            },
            settings: FaceOptions { leaf: None, subdivision: self.subdivision },
            disjoint: self.disjoint,
            show: self.debug.unwrap_or_default(),
            light: light_source(self.light, self.light_at),
            depth_cue: self.depth_cue,
            paint: Some(self.paint),
            palette: self.palette.clone(),
            ..FillOptions::default()
        }
    }
}

/// A number of grays, or colors with commas between them.
fn palette(text: &str) -> Result<Palette, String> {
    if let Ok(n) = text.trim().parse::<usize>() {
        return Ok(Palette::Grays(n));
    }
    // Commas within parentheses are part of a color.
    let mut depth = 0;
    let parts = text.split(|c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        c == ',' && depth == 0
    });
    Ok(Palette::Inks(parts.map(|part| values::rgb(part.trim())).collect::<Result<_, _>>()?))
}
