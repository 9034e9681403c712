//! Strokes: what the pen draws, as polylines in image coordinates.

pub mod draft;

use glam::DVec2;

use crate::camera::Camera;
use crate::extent::Extent;

/// Why a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum StrokeKind {
    /// Between a front face and one that is not.
    Silhouette,
    /// Between two faces that meet at more than the crease angle.
    Crease,
    /// Edge of only one face.
    Boundary,
    /// Edge of three or more faces.
    Nonmanifold,
    /// Where two faces pierce each other.
    Intersection,
    /// A polyline of the model that borders no face.
    Wire,
    /// Between two materials or groups.
    Material,
    /// Any other edge of a mesh.
    Mesh,
    /// A grid line of a function surface.
    Grid,
    /// A level curve of a function surface.
    Level,
    /// A level curve that is drawn heavier, such as every fifth.
    Index,
    /// An axis or its ticks.
    Axis,
    /// The numbers of an axis, or the words of a legend.
    Text,
    /// Shading.
    Hatch,
    /// The outline of a shadow.
    Shadow,
    /// The height of a level curve, written in a gap.
    Label,
    /// Where a range of heights cuts a surface off.
    Cut,
    /// A level curve drawn on the base of the box around a surface.
    LevelBase,
    /// An edge of that box that is not an axis.
    Box,
    /// The grid and the edges of the box's faces behind the surface.
    Back,
    /// The title of an axis, or of the drawing.
    Title,
}

/// The part of a surface that a line belongs to.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SurfacePart {
    /// The sheet, counted from 1; 0 if the line belongs to none, or to several.
    pub sheet: u16,
    /// The level of a level curve, counted from 1 for the lowest; 0 for other lines.
    pub level: u16,
    /// The family of a grid line.
    pub family: Option<GridFamily>,
}

/// A family of grid lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum GridFamily {
    /// Along x, or u.
    AlongX,
    /// Along y, or v.
    AlongY,
}

impl GridFamily {
    /// Both.
    pub const ALL: [Self; 2] = [Self::AlongX, Self::AlongY];

    /// The name used on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::AlongX => "x",
            Self::AlongY => "y",
        }
    }
}

impl StrokeKind {
    /// All kinds.
    pub const ALL: [Self; 21] = [
        Self::Silhouette,
        Self::Crease,
        Self::Boundary,
        Self::Nonmanifold,
        Self::Intersection,
        Self::Wire,
        Self::Material,
        Self::Mesh,
        Self::Grid,
        Self::Level,
        Self::Index,
        Self::Axis,
        Self::Text,
        Self::Hatch,
        Self::Shadow,
        Self::Label,
        Self::Cut,
        Self::LevelBase,
        Self::Box,
        Self::Back,
        Self::Title,
    ];

    /// The name used on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Silhouette => "silhouette",
            Self::Crease => "crease",
            Self::Boundary => "boundary",
            Self::Nonmanifold => "nonmanifold",
            Self::Intersection => "intersection",
            Self::Wire => "wire",
            Self::Material => "material",
            Self::Mesh => "mesh",
            Self::Grid => "grid",
            Self::Level => "level",
            Self::Index => "index",
            Self::Axis => "axis",
            Self::Text => "text",
            Self::Hatch => "hatch",
            Self::Shadow => "shadow",
            Self::Label => "label",
            Self::Cut => "cut",
            Self::LevelBase => "level-base",
            Self::Box => "box",
            Self::Back => "back",
            Self::Title => "title",
        }
    }
}

/// How hidden lines are drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum HiddenLines {
    /// Not drawn.
    #[default]
    None,
    /// Dashed, on their own layer.
    Dashed,
    /// Solid, on their own layer.
    Solid,
}

impl HiddenLines {
    /// All of them, in the order of the documentation.
    pub const ALL: [Self; 3] = [Self::None, Self::Dashed, Self::Solid];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Dashed => "dashed",
            Self::Solid => "solid",
        }
    }
}

/// One polyline of a [`Strokes`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke<'a> {
    /// Why it is drawn.
    pub kind: StrokeKind,
    /// Quantitative invisibility: how many triangles hide it; 0 is visible.
    pub qi: u32,
    /// Whether it is part of the outline: it is seen against the background. Known only where the
    /// outline was requested.
    pub outline: bool,
    /// Whether it is a line of a surface seen from below. Known only where undersides were requested.
    pub underside: bool,
    /// Whether the light reaches it. Known only for exact hatching.
    pub lit: Option<bool>,
    /// The part of a surface that it belongs to.
    pub part: SurfacePart,
    /// Two points or more in image coordinates; a closed stroke ends at its first point.
    pub points: &'a [DVec2],
}

/// Strokes in image coordinates (see [`crate::camera`]), in a fixed order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Strokes {
    points: Vec<DVec2>,
    heads: Vec<Head>,
}

/// A stroke's attributes and the end of its run in the points; it begins where the last one ends.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Head {
    kind: StrokeKind,
    qi: u32,
    outline: bool,
    underside: bool,
    lit: Option<bool>,
    part: SurfacePart,
    end: u32,
}

impl Strokes {
    /// Appends a stroke. One of fewer than two points is left out.
    pub fn push(&mut self, kind: StrokeKind, qi: u32, points: impl IntoIterator<Item = DVec2>) {
        self.push_with(kind, qi, false, None, points);
    }

    /// Appends a visible stroke of a part of a surface. One of fewer than two points is left out.
    pub fn push_part(
        &mut self,
        kind: StrokeKind,
        part: SurfacePart,
        points: impl IntoIterator<Item = DVec2>,
    ) {
        let n = self.heads.len();
        self.push_with(kind, 0, false, None, points);
        if let Some(head) = self.heads.get_mut(n) {
            head.part = part;
        }
    }

    /// Appends a stroke with the attributes of another, but with other points. One of fewer than two points
    /// is left out.
    pub fn push_like(&mut self, stroke: &Stroke, points: impl IntoIterator<Item = DVec2>) {
        let Stroke { kind, qi, outline, underside, lit, part, .. } = *stroke;
        let n = self.heads.len();
        self.push_with(kind, qi, outline, lit, points);
        if let Some(head) = self.heads.get_mut(n) {
            (head.underside, head.part) = (underside, part);
        }
    }

    /// Appends a visible stroke that the light reaches or not. One of fewer than two points is left out.
    pub fn push_lit(
        &mut self,
        kind: StrokeKind,
        is_lit: bool,
        points: impl IntoIterator<Item = DVec2>,
    ) {
        self.push_with(kind, 0, false, Some(is_lit), points);
    }

    /// Appends a visible stroke of the outline. One of fewer than two points is left out.
    pub fn push_outline(&mut self, kind: StrokeKind, points: impl IntoIterator<Item = DVec2>) {
        self.push_with(kind, 0, true, None, points);
    }

    fn push_with(
        &mut self,
        kind: StrokeKind,
        qi: u32,
        outline: bool,
        lit: Option<bool>,
        points: impl IntoIterator<Item = DVec2>,
    ) {
        let start = self.points.len();
        self.points.extend(points);
        if self.points.len() < start + 2 {
            self.points.truncate(start);
        } else {
            let end = self.points.len() as u32;
            let part = SurfacePart::default();
            self.heads.push(Head { kind, qi, outline, underside: false, lit, part, end });
        }
    }

    /// Appends the strokes of another drawing.
    pub fn append(&mut self, other: &Self) {
        let before = self.points.len() as u32;
        self.points.extend_from_slice(&other.points);
        self.heads.extend(other.heads.iter().map(|head| Head { end: before + head.end, ..*head }));
    }

    /// Appends the strokes of another drawing, as lines on the underside of a surface.
    pub fn append_undersides(&mut self, other: &Self) {
        let before = self.points.len() as u32;
        self.points.extend_from_slice(&other.points);
        let below = |head: &Head| Head { underside: true, end: before + head.end, ..*head };
        self.heads.extend(other.heads.iter().map(below));
    }

    /// Number of strokes.
    pub fn len(&self) -> usize {
        self.heads.len()
    }

    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.heads.is_empty()
    }

    /// Number of points of all strokes.
    pub fn n_points(&self) -> usize {
        self.points.len()
    }

    /// The strokes in order.
    pub fn iter(&self) -> impl Iterator<Item = Stroke<'_>> + Clone {
        self.heads.iter().scan(0, |start, head| {
            let points = &self.points[*start..head.end as usize];
            *start = head.end as usize;
            let Head { kind, qi, outline, underside, lit, part, .. } = *head;
            Some(Stroke { kind, qi, outline, underside, lit, part, points })
        })
    }

    /// The extent of the strokes in the image. O(points).
    pub fn extent(&self, camera: &Camera) -> Extent {
        Extent::of_polylines(self.iter().map(|stroke| stroke.points), camera)
    }

    /// Smallest box around all points as (lowest, highest) corner; `None` without strokes.
    pub fn bounds(&self) -> Option<(DVec2, DVec2)> {
        let (first, rest) = self.points.split_first()?;
        Some(rest.iter().fold((*first, *first), |(low, high), &p| (low.min(p), high.max(p))))
    }
}
