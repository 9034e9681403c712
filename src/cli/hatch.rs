//! Hatching: from command-line options to hatch options.

use clap::{Args, ValueEnum};
use glam::DVec3;
use hiddenline::stages::hatch::{
    DEFAULT_BLACK, DEFAULT_HATCH_GAP_MM, DEFAULT_SMOOTH_DEG, DEFAULT_WHITE, Ground, HatchError,
    HatchLevels, HatchMaterial, HatchMethod, HatchOptions, HatchShadows, LEVELS,
};
use hiddenline::stages::shading::light::{AMBIENT, LightError, LightSource};

use super::{config, values};

#[derive(Args)]
#[command(next_help_heading = "Hatching")]
pub(super) struct HatchArgs {
    /// Shade faces with hatch lines: sections of the model (default), or straight lines on paper
    #[arg(long, value_name = "METHOD", value_enum, num_args = 0..=1)]
    #[arg(default_missing_value = "sections")]
    hatch: Option<Method>,
    /// Line angles in degrees, one family for each; sections have them on faces toward the viewer
    ///
    /// The default is 45 for straight lines. Sections lean with the light unless angles are given.
    #[arg(long, value_name = "DEG,…", value_delimiter = ',', value_parser = values::number)]
    #[arg(allow_negative_numbers = true)]
    hatch_angles: Vec<f64>,
    /// Add a second, crossing family of lines in dark places
    #[arg(long, conflicts_with = "hatch_angles")]
    hatch_cross: bool,
    /// Normal of the section planes
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    #[arg(conflicts_with = "hatch_angles")]
    hatch_normal: Option<DVec3>,
    /// How lines thin out: halving, a number of levels from 2 to 6, or continuous
    ///
    ///   halving     every second line ends where half the ink is enough
    ///   2 to 6      the same, with this many levels of darkness; for flat faces
    ///   continuous  lines end one after another
    #[arg(long, value_name = "LEVELS", value_parser = levels, default_value = "halving")]
    #[arg(verbatim_doc_comment)]
    hatch_levels: HatchLevels,
    /// Shadows to hatch [default: cast]
    #[arg(long, value_enum)]
    hatch_shadows: Option<Shadows>,
    /// Add a ground plane that catches shadows, at Z or at the model's lowest point
    #[arg(long, value_name = "Z", num_args = 0..=1, allow_negative_numbers = true)]
    #[arg(default_missing_value = "lowest", value_parser = ground)]
    ground: Option<Ground>,
    /// White margin between hatching and nearer outlines
    #[arg(long, value_name = "MM", value_parser = values::length)]
    #[arg(default_value_t = DEFAULT_HATCH_GAP_MM)]
    hatch_gap: f64,
    /// Leave tones white that are at least this light, from 0 to 1
    #[arg(long, value_name = "PART", value_parser = positive_part, default_value_t = DEFAULT_WHITE)]
    hatch_white: f64,
    /// Share of the paper that ink covers in the darkest places, from 0 to 1
    #[arg(long, value_name = "PART", value_parser = positive_part, default_value_t = DEFAULT_BLACK)]
    hatch_black: f64,
    /// Tone where no light reaches, from 0 to 1
    #[arg(long, value_name = "PART", value_parser = values::part, default_value_t = AMBIENT)]
    hatch_ambient: f64,
    /// Shortest hatch stroke [default: 1, or three pen widths if that is more]
    #[arg(long, value_name = "MM", value_parser = values::length)]
    hatch_shortest: Option<f64>,
    /// Shade faces that meet at this angle or less as one curved surface; 0 for flat faces
    #[arg(long, value_name = "DEG", value_parser = values::crease)]
    #[arg(default_value_t = DEFAULT_SMOOTH_DEG)]
    hatch_smooth: f64,
    /// Angle and darkness of one material: NAME=ANGLE:BLACK; may be repeated
    #[arg(long = "hatch-material", value_name = "MATERIAL", value_parser = material)]
    hatch_materials: Vec<HatchMaterial>,
}

/// The light, for commands that have none otherwise.
#[derive(Args)]
#[command(next_help_heading = "Hatching")]
pub(super) struct LightArgs {
    /// Direction toward the light [default: over the viewer's left shoulder]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    light: Option<DVec3>,
    /// Position of the light: a point outside the model
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    #[arg(conflicts_with = "light")]
    light_at: Option<DVec3>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Method {
    /// Sections by parallel planes: lines wrap around the form
    Sections,
    /// Parallel lines on paper
    Straight,
}

#[derive(Clone, Copy, ValueEnum)]
enum Shadows {
    /// Faces turned away from the light, and shadows cast by other faces
    Cast,
    /// Only faces turned away from the light
    Own,
    /// No shadows: tone falls off evenly on all sides
    None,
    /// Only shadows
    Only,
}

/// The light by its direction or its place.
pub(super) fn light_source(direction: Option<DVec3>, place: Option<DVec3>) -> LightSource {
    match (direction, place) {
        (_, Some(place)) => LightSource::At(place),
        (Some(direction), None) => LightSource::From(direction),
        (None, None) => LightSource::Shoulder,
    }
}

impl LightArgs {
    pub(super) fn source(&self) -> LightSource {
        light_source(self.light, self.light_at)
    }
}

impl HatchArgs {
    /// What is hatched; `None` when nothing is.
    pub(super) fn options(self, light: LightSource) -> Option<HatchOptions> {
        let method = match self.hatch? {
            Method::Sections => HatchMethod::Sections,
            Method::Straight => HatchMethod::Straight,
        };
        Some(HatchOptions {
            method,
            light,
            angles_deg: self.hatch_angles,
            normal: self.hatch_normal,
            cross: self.hatch_cross,
            levels: self.hatch_levels,
            white: self.hatch_white,
            black: self.hatch_black,
            ambient: self.hatch_ambient,
            shortest_mm: self.hatch_shortest,
            smooth_deg: self.hatch_smooth,
            shadows: match self.hatch_shadows {
                None | Some(Shadows::Cast) => HatchShadows::Cast,
                Some(Shadows::Own) => HatchShadows::Own,
                Some(Shadows::None) => HatchShadows::None,
                Some(Shadows::Only) => HatchShadows::Only,
            },
            gap_mm: self.hatch_gap,
            ground: self.ground,
            materials: self.hatch_materials,
        })
    }

    /// The plane that takes shadows.
    pub(super) fn ground(&self) -> Option<Ground> {
        self.ground
    }

    /// Warnings about what was typed but has no effect; `others` are options that only hatching uses, and
    /// outlines of shadows, if there are any, which need the ground too.
    pub(super) fn without_effect(&self, has_outlines: bool, others: &[&str]) -> Vec<String> {
        let own = [
            "--hatch-angles",
            "--hatch-cross",
            "--hatch-normal",
            "--hatch-levels",
            "--hatch-shadows",
            "--hatch-gap",
            "--hatch-white",
            "--hatch-black",
            "--hatch-ambient",
            "--hatch-shortest",
            "--hatch-smooth",
            "--hatch-material",
        ];
        if self.hatch.is_none() {
            let others = others.iter().chain(&["--ground"]).filter(|_| !has_outlines);
            let typed = own.iter().chain(others).filter(|option| config::is_typed(option));
            return typed.map(|option| format!("{option} has no effect without --hatch")).collect();
        }
        let takes_no_shadows = matches!(self.hatch_shadows, Some(Shadows::Own | Shadows::None));
        let mut warnings = Vec::new();
        if self.ground.is_some() && takes_no_shadows && !has_outlines {
            warnings.push("--ground has no effect without cast shadows".to_owned());
        }
        if matches!(self.hatch, Some(Method::Straight)) && self.hatch_normal.is_some() {
            warnings.push("--hatch-normal has no effect with --hatch straight".to_owned());
        }
        warnings
    }
}

/// An error of hatching, with the options that mend it.
pub(super) fn with_remedy(error: &HatchError) -> String {
    match error {
        HatchError::Light(LightError::Inside(..)) => {
            format!("{error}; use --light-at with a point outside, or --light with a direction")
        }
        HatchError::Horizon => {
            format!("{error}; use a --light with a positive z, or leave out --ground")
        }
        HatchError::TooMany(_) => {
            format!("{error}: use a smaller --drawing-scale or a larger --pen-width")
        }
        _ => error.to_string(),
    }
}

fn positive_part(text: &str) -> Result<f64, String> {
    values::part(text).and_then(|x| if x > 0.0 { Ok(x) } else { Err("must be above 0".into()) })
}

fn levels(text: &str) -> Result<HatchLevels, String> {
    match text.trim() {
        "halving" => Ok(HatchLevels::Halving),
        "continuous" => Ok(HatchLevels::Continuous),
        number => {
            let number = number.parse().ok().filter(|n| LEVELS.contains(n));
            number.map(HatchLevels::Steps).ok_or_else(|| {
                "expected halving, continuous, or a number of levels from 2 to 6".to_owned()
            })
        }
    }
}

fn ground(text: &str) -> Result<Ground, String> {
    if text == "lowest" { Ok(Ground::Lowest) } else { values::number(text).map(Ground::At) }
}

/// A material as `brick=30:0.4`; angle or darkness may be left out.
fn material(text: &str) -> Result<HatchMaterial, String> {
    let example = || "expected a material such as brick=30:0.4".to_owned();
    let (name, how) = text.rsplit_once('=').ok_or_else(example)?;
    let (angle, black) = how.split_once(':').unwrap_or((how, ""));
    let given = |text: &str| Some(text.trim().to_owned()).filter(|text| !text.is_empty());
    let angle_deg = given(angle).map(|angle| values::number(&angle)).transpose()?;
    let black = given(black).map(|black| positive_part(&black)).transpose()?;
    Ok(HatchMaterial { name: name.to_owned(), angle_deg, black })
}
