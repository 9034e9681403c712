//! Which areas are filled, and with what.

use clap::{Args, ValueEnum};
use glam::DVec3;
use hiddenline::stages::engines::face::warnock::Subdivision;
use hiddenline::stages::engines::face::{FaceEngine, FaceOptions};
use hiddenline::stages::shading::fill::{DEFAULT_SEAM_MM, FillOptions, Palette, Show};

use crate::cli::values;

#[derive(Args)]
#[command(next_help_heading = "Areas")]
pub(super) struct AreaArgs {
    /// Visible-surface algorithm
    #[arg(long, value_enum, default_value = "auto")]
    engine: EngineName,
    /// Where the light comes from: a direction in the scene [default: the viewer's left shoulder]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    light: Option<DVec3>,
    /// How much of the farthest face's color becomes paper, from 0 to 1
    #[arg(long, value_name = "PART", value_parser = values::part, default_value_t = 0.0)]
    depth_cue: f64,
    /// Color of faces whose material has none
    ///
    /// Materials of OBJ files have the color Kd of the MTL file that is named there.
    #[arg(long, value_name = "COLOR", value_parser = values::rgb)]
    #[arg(default_value = "#d8d4c8")]
    paint: Rgb,
    /// Use so many grays only, or these colors, as in 4 or navy,#e07020,ivory
    ///
    /// Each face gets the nearest one. Each ink is a layer, and inks never overlap.
    #[arg(long, value_name = "N|COLORS", value_parser = palette)]
    palette: Option<Palette>,
    /// Areas beside each other instead of over each other, whatever the engine; with --palette always
    #[arg(long)]
    disjoint: bool,
    /// Width of the outline, in its own color, that closes the seams around each area
    ///
    /// Screens and printers smooth borders, so that the paper shines through between two areas without
    /// it. 0 leaves areas as they are, for machines that cut.
    #[arg(long, value_name = "MM", value_parser = values::length, default_value_t = DEFAULT_SEAM_MM)]
    pub(super) seam: f64,
    /// Remove hidden lines by painting over them: faces in white from far to near, each with its edges
    ///
    /// For screen and print only. On a plotter white paint covers nothing: it would draw all hidden
    /// lines too, so plot the lines of `draw`. Engines: depth-sort, bsp (the default here), octree.
    #[arg(long, conflicts_with_all = [
        "palette", "debug", "disjoint", "no_edges", "light", "depth_cue", "paint", "leaf", "subdivision",
    ])]
    pub(super) white: bool,
    /// Color areas by what the engine did instead
    #[arg(long, value_enum, conflicts_with = "palette")]
    debug: Option<DebugName>,
    /// Width of the smallest windows of warnock on paper [default: the pen's]
    #[arg(long, value_name = "MM", value_parser = values::positive_length)]
    pub(super) leaf: Option<f64>,
    /// How warnock divides windows
    #[arg(long, value_enum, default_value = "regular")]
    subdivision: SubdivisionName,
    /// Make N pictures on the way once around the target, NAME-001 to NAME-N, all at one scale
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=999))]
    pub(super) turntable: Option<u16>,
}

/// A color.
type Rgb = [u8; 3];

#[derive(Clone, Copy, ValueEnum)]
enum EngineName {
    /// Chooses by the size of the model
    Auto,
    /// Over each other from far to near; few splits, for models of one view
    DepthSort,
    /// Over each other by a tree of planes; large models, and many views of one
    Bsp,
    /// Over each other by a tree of boxes; large models of small faces
    Octree,
    /// By windows of the image down to a leaf; few, large faces
    Warnock,
    /// Exact regions beside each other; cutters, engravers, inks; up to 10,000 faces
    WeilerAtherton,
}

#[derive(Clone, Copy, ValueEnum)]
enum DebugName {
    /// Blue is painted first, green, red last
    Order,
    /// What is nearer is lighter
    Depth,
    /// A color for each piece that faces were split into
    Splits,
}

#[derive(Clone, Copy, ValueEnum)]
enum SubdivisionName {
    /// Into quarters
    Regular,
    /// At vertices near the middle
    Vertices,
}

impl AreaArgs {
    pub(super) fn options(&self) -> FillOptions {
        FillOptions {
            engine: match self.engine {
                EngineName::Auto if self.white => FaceEngine::Bsp,
                EngineName::Auto => FaceEngine::Auto,
                EngineName::DepthSort => FaceEngine::DepthSort,
                EngineName::Bsp => FaceEngine::Bsp,
                EngineName::Octree => FaceEngine::Octree,
                EngineName::Warnock => FaceEngine::Warnock,
                EngineName::WeilerAtherton => FaceEngine::WeilerAtherton,
            },
            settings: FaceOptions {
                leaf: None,
                subdivision: match self.subdivision {
                    SubdivisionName::Regular => Subdivision::Regular,
                    SubdivisionName::Vertices => Subdivision::Vertices,
                },
            },
            disjoint: self.disjoint,
            show: match self.debug {
                None => Show::Shaded,
                Some(DebugName::Order) => Show::Order,
                Some(DebugName::Depth) => Show::Depth,
                Some(DebugName::Splits) => Show::Splits,
            },
            light: self.light,
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
