//! What to hatch, and how.

use glam::DVec3;
use thiserror::Error;

use crate::page::Page;
use crate::shading::light::{AMBIENT, LightError, LightSource};

/// By default, tones at least this light stay white.
pub const DEFAULT_WHITE: f64 = 0.85;

/// The default share of the paper that ink covers in the darkest places. More gives a muddy gray and soaks
/// the paper.
pub const DEFAULT_BLACK: f64 = 0.6;

/// The default length of the shortest hatch stroke in millimeters, unless the pen is wide.
pub const DEFAULT_SHORTEST_HATCH_MM: f64 = 1.0;

/// The default white margin beside nearer outlines in millimeters.
pub const DEFAULT_HATCH_GAP_MM: f64 = 0.5;

/// By default, faces that meet at this angle in degrees or less are shaded as one curved surface.
pub const DEFAULT_SMOOTH_DEG: f64 = 30.0;

/// The maximum number of families of lines.
pub const MOST_FAMILIES: usize = 8;

/// Fewest and most levels of darkness; see [`HatchLevels::Steps`].
pub const LEVELS: std::ops::RangeInclusive<u32> = 2..=6;

/// What hatch lines are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum HatchMethod {
    /// Parallel planes in space cut through the model, so lines wrap around its form.
    #[default]
    Sections,
    /// Parallel lines on paper.
    Straight,
}

/// How the spacing of lines follows the tone.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum HatchLevels {
    /// Every second line ends where half the ink is enough. Darkness is right to a factor of √2.
    #[default]
    Halving,
    /// The same, with darkness rounded to this many steps first; for flat faces.
    Steps(u32),
    /// Lines end one after another, so the mean darkness is right everywhere; even tones look striped.
    Continuous,
}

/// Which shadows are hatched.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum HatchShadows {
    /// Faces turned away from the light, and shadows cast by other faces.
    #[default]
    Cast,
    /// Only faces turned away from the light.
    Own,
    /// No shadows: tone falls off evenly on all sides.
    None,
    /// Only shadows, of both kinds.
    Only,
}

/// A horizontal plane that catches shadows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ground {
    /// At the lowest point of the scene.
    Lowest,
    /// At this z, in model units.
    At(f64),
}

/// How the faces of one material are hatched.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct HatchMaterial {
    /// The name of the material.
    pub name: String,
    /// The angle of the first family of lines in degrees; others turn with it.
    pub angle_deg: Option<f64>,
    /// Share of the paper that ink covers in the darkest places.
    pub black: Option<f64>,
}

/// What to hatch, and how.
///
/// ```
/// use hiddenline::{Ground, HatchOptions, LightSource};
/// use hiddenline::glam::dvec3;
///
/// let hatch = HatchOptions::default()
///     .light(LightSource::From(dvec3(-1.0, -2.0, 3.0)))
///     .cross()
///     .ground(Ground::Lowest);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct HatchOptions {
    /// What the lines are.
    pub method: HatchMethod,
    /// Where the light comes from.
    pub light: LightSource,
    /// The angle on paper of each family of lines in degrees, counter-clockwise from the right, on faces that
    /// are square to the viewer; empty for the default.
    pub angles_deg: Vec<f64>,
    /// The normal of the planes of [`HatchMethod::Sections`]; `None` for up, turned slightly toward the light
    /// and the viewer.
    pub normal: Option<DVec3>,
    /// Whether a second family crosses the first one, unless angles are given.
    pub cross: bool,
    /// How the spacing follows the tone.
    pub levels: HatchLevels,
    /// Leave tones white that are at least this light, from 0 to 1.
    pub white: f64,
    /// Share of the paper that ink covers in the darkest places, from 0 to 1.
    pub black: f64,
    /// The tone where no light reaches, from 0 to 1.
    pub ambient: f64,
    /// Strokes are at least this long; `None` for a millimeter, or three pen widths if that is more.
    pub shortest_mm: Option<f64>,
    /// Faces that meet at this angle or less are shaded as one curved surface.
    pub smooth_deg: f64,
    /// Which shadows are hatched.
    pub shadows: HatchShadows,
    /// White margin beside nearer outlines; zero for none.
    pub gap_mm: f64,
    /// A plane that catches shadows.
    pub ground: Option<Ground>,
    /// Materials with their own hatching.
    pub materials: Vec<HatchMaterial>,
}

impl Default for HatchOptions {
    fn default() -> Self {
        Self {
            method: HatchMethod::default(),
            light: LightSource::default(),
            angles_deg: Vec::new(),
            normal: None,
            cross: false,
            levels: HatchLevels::default(),
            white: DEFAULT_WHITE,
            black: DEFAULT_BLACK,
            ambient: AMBIENT,
            shortest_mm: None,
            smooth_deg: DEFAULT_SMOOTH_DEG,
            shadows: HatchShadows::default(),
            gap_mm: DEFAULT_HATCH_GAP_MM,
            ground: None,
            materials: Vec::new(),
        }
    }
}

impl HatchOptions {
    /// Parallel lines on paper instead of sections.
    #[must_use]
    pub fn straight(self) -> Self {
        Self { method: HatchMethod::Straight, ..self }
    }

    /// Where the light comes from.
    #[must_use]
    pub fn light(self, light: LightSource) -> Self {
        Self { light, ..self }
    }

    /// Two families of lines that cross.
    #[must_use]
    pub fn cross(self) -> Self {
        Self { cross: true, ..self }
    }

    /// The angles of the families in degrees.
    #[must_use]
    pub fn angles_deg(self, angles_deg: impl Into<Vec<f64>>) -> Self {
        Self { angles_deg: angles_deg.into(), ..self }
    }

    /// How the spacing follows the tone.
    #[must_use]
    pub fn levels(self, levels: HatchLevels) -> Self {
        Self { levels, ..self }
    }

    /// Which shadows are hatched.
    #[must_use]
    pub fn shadows(self, shadows: HatchShadows) -> Self {
        Self { shadows, ..self }
    }

    /// A plane that catches shadows.
    #[must_use]
    pub fn ground(self, ground: Ground) -> Self {
        Self { ground: Some(ground), ..self }
    }

    /// Checks that all numbers are in range.
    pub(super) fn check(&self, page: &HatchPage) -> Result<(), HatchError> {
        let is_part = |x: f64| (0.0..=1.0).contains(&x);
        let is_positive_part = |x: f64| x > 0.0 && x <= 1.0;
        let blacks = self.materials.iter().filter_map(|material| material.black);
        if !is_positive_part(self.white) {
            return Err(HatchError::White(self.white));
        }
        if let Some(black) = blacks.chain([self.black]).find(|&black| !is_positive_part(black)) {
            return Err(HatchError::Black(black));
        }
        if !is_part(self.ambient) {
            return Err(HatchError::Ambient(self.ambient));
        }
        if self.angles_deg.len() > MOST_FAMILIES {
            return Err(HatchError::Families(self.angles_deg.len()));
        }
        let turned = self.materials.iter().filter_map(|material| material.angle_deg);
        if self.angles_deg.iter().copied().chain(turned).any(|angle| !angle.is_finite()) {
            return Err(HatchError::Angle);
        }
        if let HatchLevels::Steps(n) = self.levels
            && !LEVELS.contains(&n)
        {
            return Err(HatchError::Levels(n));
        }
        if self.normal.is_some_and(|n| !n.is_finite() || n == DVec3::ZERO) {
            return Err(HatchError::Normal);
        }
        let lengths = [self.gap_mm, self.shortest_mm.unwrap_or(0.0), self.smooth_deg];
        if lengths.iter().any(|x| !(x.is_finite() && *x >= 0.0)) {
            return Err(HatchError::Length);
        }
        if !(page.pen_width_mm > 0.0 && page.pen_width_mm.is_finite()) {
            return Err(HatchError::PenWidth(page.pen_width_mm));
        }
        Ok(())
    }
}

/// The part of the image that is on paper, its scale, and the pen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HatchPage {
    /// Millimeters on paper for one unit of the image.
    pub mm_per_image_unit: f64,
    /// The lowest and the highest corner of the area between the margins, in image coordinates.
    pub window: (glam::DVec2, glam::DVec2),
    /// Line width of the pen on paper.
    pub pen_width_mm: f64,
}

impl HatchPage {
    /// A page, and the pen that hatches.
    pub fn new(page: &Page, pen_width_mm: f64) -> Self {
        let mm_per_image_unit = page.mm_per_image_unit();
        Self { mm_per_image_unit, window: page.window_in_image(), pen_width_mm }
    }
}

/// Why hatching failed.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum HatchError {
    /// The light cannot cast shadows.
    #[error(transparent)]
    Light(#[from] LightError),
    /// The light does not shine on the ground.
    #[error("the light is not above the ground, so nothing casts a shadow on it")]
    Horizon,
    /// A number out of range.
    #[error("the tone that stays white must be above 0 and at most 1, not {0}")]
    White(f64),
    /// A number out of range.
    #[error(
        "the ink must cover more than 0 and at most 1 of the darkest places, not {0}: lines cannot be \
         closer together than the pen is wide"
    )]
    Black(f64),
    /// A number out of range.
    #[error("the tone of shadows must be from 0 to 1, not {0}")]
    Ambient(f64),
    /// Too many angles.
    #[error("hatching takes at most {MOST_FAMILIES} families of lines, not {0}")]
    Families(usize),
    /// An angle is not finite.
    #[error("angles of hatch lines must be finite")]
    Angle,
    /// Too few or too many levels.
    #[error("hatching has from {start} to {end} levels, not {0}", start = LEVELS.start(), end = LEVELS.end())]
    Levels(u32),
    /// The normal has no direction.
    #[error("the normal of the planes must be finite and not zero")]
    Normal,
    /// A length or an angle is negative.
    #[error("lengths and angles must be 0 or more")]
    Length,
    /// The pen has no width.
    #[error("hatching needs the width of the pen, above 0, not {0} mm")]
    PenWidth(f64),
    /// More pieces than fit in memory.
    #[error(
        "there would be more than {0} pieces of hatch lines; draw the model smaller, or with a wider pen"
    )]
    TooMany(usize),
}
