//! What is drawn around a surface.

use super::ticks::TickRule;

/// Axes around a surface: which lines, which numbers, and the titles.
#[derive(Debug, Clone, PartialEq)]
pub struct Axes {
    /// Which lines; `None` for [`AxesStyle::Edges`], or [`AxesStyle::Frame`] in orthographic views from
    /// straight above or below.
    pub style: Option<AxesStyle>,
    /// The titles.
    pub titles: Titles,
    /// How [`AxesStyle::Box`] draws the edges in front of the surface.
    pub box_front: BoxFront,
    /// The side of the drawing with the z axis.
    pub z_axis: ZAxis,
    /// The numbers on the x, y and z axes.
    pub ticks: [TickRule; 3],
    /// Height of numbers, in millimeters on paper; `None` to suit the page and the pen.
    pub text_height_mm: Option<f64>,
    /// Line width of the pen that draws text, in millimeters: small text needs a fine pen.
    pub pen_width_mm: f64,
}

impl Default for Axes {
    fn default() -> Self {
        Self::from(Titles::default())
    }
}

impl From<Titles> for Axes {
    fn from(titles: Titles) -> Self {
        Self {
            style: None,
            titles,
            box_front: BoxFront::default(),
            z_axis: ZAxis::default(),
            ticks: [TickRule::default(); 3],
            text_height_mm: None,
            pen_width_mm: 0.3,
        }
    }
}

impl Axes {
    /// Axes of a style with the default titles.
    pub fn new(style: AxesStyle) -> Self {
        Self { style: Some(style), ..Self::default() }
    }

    /// Titles of the axes and of the drawing.
    #[must_use]
    pub fn titles(self, titles: Titles) -> Self {
        Self { titles, ..self }
    }

    /// The numbers on the x, y and z axes.
    #[must_use]
    pub fn ticks(self, ticks: [TickRule; 3]) -> Self {
        Self { ticks, ..self }
    }
}

/// Which lines are drawn around a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AxesStyle {
    /// Three edges of the box, on the outline, with ticks and numbers.
    Edges,
    /// The same, and the rectangle that the box stands on.
    Base,
    /// The three faces behind the surface, with a grid.
    Back,
    /// The same, and the other edges of the box.
    Box,
    /// The four sides of a map, for views from straight above or below.
    Frame,
}

/// How edges of the box in front of the surface are drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum BoxFront {
    /// Dashes of 1 mm with gaps of 1 mm.
    #[default]
    Dashed,
    /// Solid.
    Solid,
    /// Not at all.
    None,
}

impl BoxFront {
    /// All of them, in the order of the documentation.
    pub const ALL: [Self; 3] = [Self::Dashed, Self::Solid, Self::None];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dashed => "dashed",
            Self::Solid => "solid",
            Self::None => "none",
        }
    }
}

/// The side of the drawing with the z axis.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum ZAxis {
    /// Left of the surface.
    #[default]
    Left,
    /// Right of it.
    Right,
}

impl ZAxis {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Left, Self::Right];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

/// The titles of the axes and of the drawing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Titles {
    /// Titles of the x, y and z axes; an empty one is left out.
    pub axes: [String; 3],
    /// Title above the drawing; left out if empty.
    pub drawing: String,
}

impl Titles {
    /// The default titles of the axes, and a title above the drawing.
    pub fn of_drawing(title: impl Into<String>) -> Self {
        Self { drawing: title.into(), ..Self::default() }
    }
}

impl Default for Titles {
    fn default() -> Self {
        Self { axes: ["x", "y", "z"].map(str::to_owned), drawing: String::new() }
    }
}
