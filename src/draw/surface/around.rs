//! Axes around a surface, and the page that both fit on.
//!
//! ```text
//!   scale of the page ─► size of text in the image ─► layout ─► what all takes up ─┐
//!          ▲                                                                       │
//!          └───────────────────────────────────────────────────────────────────────┘
//! ```
//!
//! Text is a few millimeters high whatever the scale, so each layout depends on the scale of the page that it
//! was made for; a few rounds make them agree.

use glam::{DVec2, DVec3};

use super::error::{SurfaceError, SurfaceNote};
use super::legend::LegendText;
use crate::axes::{
    Axes, AxesBox, AxesLayout, AxesSize, AxesStyle, Economy, Wire, base_height, is_straight_down,
    legend, missing,
};
use crate::camera::Camera;
use crate::classify::{LineSelection, ViewSegments, ViewedScene};
use crate::engines::edge::{VisibilityOptions, roberts};
use crate::extent::Extent;
use crate::model::scene::Scene;
use crate::page::{DEFAULT_PEN_WIDTH_MM, Page, PageOptions, Placement};
use crate::predicates::PiercePoint;
use crate::strokes::Strokes;
use crate::surface::SampledSurface;

/// Height of numbers as a part of the page's diagonal.
const TEXT_HEIGHT: f64 = 0.01;

/// Least and greatest height of numbers, in millimeters.
const TEXT_HEIGHTS_MM: (f64, f64) = (1.8, 3.5);

/// Least height of numbers as a multiple of the pen width.
const PEN_WIDTHS: f64 = 6.0;

/// Text is made to take up less room if the drawing is smaller than this part of what it would be
/// without any.
const LEAST_PART: f64 = 0.75;

/// How often a layout is repeated at most.
const MOST_ROUNDS: usize = 5;

/// Rounds end when the scale changes by less than this part.
const SETTLED: f64 = 1e-3;

/// What is around a surface.
#[derive(Debug, Clone, Default)]
pub struct Around {
    pub(super) layout: AxesLayout,
    pub(super) strokes: Strokes,
    /// The height of the face that the box stands on, seen from above, or hangs from, seen from below.
    pub(super) base: f64,
    /// What is worth knowing about it.
    pub notes: Vec<SurfaceNote>,
}

/// What is to be around a surface.
#[derive(Debug, Clone, Copy)]
pub struct Surroundings<'a> {
    /// The axes.
    pub axes: Option<&'a Axes>,
    /// The legend.
    pub legend: Option<&'a LegendText>,
}

impl Surroundings<'_> {
    fn pen_width_mm(&self) -> f64 {
        let of_legend = self.legend.map(|legend| legend.pen_width_mm);
        self.axes.map(|axes| axes.pen_width_mm).or(of_legend).unwrap_or(DEFAULT_PEN_WIDTH_MM)
    }
}

/// Lays axes and a legend out around a surface, and places all on the page: what it takes up of the image,
/// and the page. `extent` is what the surface takes up.
///
/// # Errors
/// The page has no room, or a frame is requested around a surface that is not seen as a map.
pub fn surround(
    bounds: &AxesBox,
    extent: Extent,
    camera: &Camera,
    wanted: Surroundings,
    options: &PageOptions,
) -> Result<(Around, Extent, Page), SurfaceError> {
    let base = base_height(bounds, camera);
    let mut around = Around { base, ..Around::default() };
    let bare = Page::place(&extent, camera, options)?;
    let Surroundings { axes, legend } = wanted;
    if axes.is_none() && legend.is_none() {
        return Ok((around, extent, bare));
    }
    if axes.is_some_and(|axes| axes.style == Some(AxesStyle::Frame)) && !is_straight_down(camera) {
        return Err(SurfaceError::Frame);
    }
    let text_mm = axes.and_then(|axes| axes.text_height_mm);
    let text_mm = text_mm.unwrap_or_else(|| text_height_mm(&bare, wanted.pen_width_mm()));
    let mut placed = None;
    for economy in Economy::ALL {
        let size = AxesSize { text_mm, mm_per_unit: bare.mm_per_image_unit(), economy };
        let Some(settled) = settled(bounds, extent, camera, wanted, options, size)? else {
            let (mut around, extent, page) =
                surround(bounds, extent, camera, Surroundings { axes: None, legend }, options)?;
            around.notes.insert(0, SurfaceNote::NoAxes);
            return Ok((around, extent, page));
        };
        // What axes have to answer for is their own text only.
        let drawn = extent.union(box_extent(&settled.layout, camera));
        let bare = Page::place(&drawn.union(settled.legend.extent(camera)), camera, options)?;
        let part = settled.page.mm_per_image_unit() / bare.mm_per_image_unit();
        let is_large = options.placement != Placement::Fit || part >= LEAST_PART;
        placed = Some((settled, is_large));
        if is_large {
            break;
        }
    }
    let Some((settled, is_large)) = placed else { return Ok((around, extent, bare)) };
    let Settled { layout, legend: legend_strokes, page } = settled;
    if !is_large {
        around.notes.push(SurfaceNote::LittleRoom);
    }
    if layout.has_too_many_ticks() {
        around.notes.push(SurfaceNote::TooManyTicks);
    }
    let mut texts: Vec<&str> = Vec::new();
    if let Some(axes) = axes {
        texts.extend(axes.titles.axes.iter().map(String::as_str));
        texts.push(&axes.titles.drawing);
    }
    if let Some(legend) = legend {
        texts.extend(legend.entries.iter().map(|entry| entry.text.as_str()));
    }
    let missing = missing(&texts.concat());
    if !missing.is_empty() {
        around.notes.push(SurfaceNote::MissingLetters(missing));
    }
    around.strokes = layout.strokes();
    around.strokes.append(&legend_strokes);
    let extent = extent.union(box_extent(&layout, camera)).union(around.strokes.extent(camera));
    around.base = layout.base().unwrap_or(base);
    around.layout = layout;
    Ok((around, extent, page))
}

/// Axes and a legend that suit the scale of their page.
struct Settled {
    layout: AxesLayout,
    legend: Strokes,
    page: Page,
}

/// A layout made for the scale that the page then has.
fn settled(
    bounds: &AxesBox,
    extent: Extent,
    camera: &Camera,
    wanted: Surroundings,
    options: &PageOptions,
    mut size: AxesSize,
) -> Result<Option<Settled>, SurfaceError> {
    let mut found = None;
    for _ in 0..MOST_ROUNDS {
        let layout = match wanted.axes {
            Some(axes) => AxesLayout::new(bounds, camera, axes, &size),
            None => Some(AxesLayout::default()),
        };
        let Some(layout) = layout else { return Ok(None) };
        let all = extent.union(box_extent(&layout, camera)).union(layout.strokes().extent(camera));
        let beside = all.corners().unwrap_or_default();
        let legend = wanted.legend.map_or(Strokes::default(), |wanted| {
            legend(&wanted.entries, wanted.place, beside, size.text(), 1.0 / size.mm_per_unit)
        });
        let page = Page::place(&all.union(legend.extent(camera)), camera, options)?;
        let scale = page.mm_per_image_unit();
        let change = (scale / size.mm_per_unit - 1.0).abs();
        found = Some(Settled { layout, legend, page });
        if change < SETTLED {
            break;
        }
        size.mm_per_unit = scale;
    }
    Ok(found)
}

fn box_extent(layout: &AxesLayout, camera: &Camera) -> Extent {
    Extent::of_polylines(std::iter::once(layout.box_in_image()), camera)
}

fn text_height_mm(page: &Page, pen_width_mm: f64) -> f64 {
    let diagonal = DVec2::new(page.paper.width_mm, page.paper.height_mm).length();
    let (least, most) = TEXT_HEIGHTS_MM;
    (TEXT_HEIGHT * diagonal).clamp(least, most).max(PEN_WIDTHS * pen_width_mm)
}

/// The box around a surface with the values on its axes.
pub fn axes_box(surface: &SampledSurface) -> AxesBox {
    let (low, high) = surface.box_bounds();
    let (scales, mut ranges) = (*surface.scales(), *surface.ranges());
    if let Some((least, most)) = surface.given_range() {
        // A logarithmic axis begins at the lowest height if it is to begin at 0 or below.
        let least = if scales[2].is_log && least <= 0.0 { ranges[2].0 } else { least };
        ranges[2] = (least, most);
    }
    AxesBox { low, high, scales, ranges, z_may_grow: !surface.has_given_heights() }
}

impl Around {
    /// The axes, with those parts of the lines behind the surface that `scene` does not hide.
    pub fn with_wires(self, scene: &Scene, camera: &Camera) -> Strokes {
        let parts = visible_parts(self.layout.wires(), scene, camera);
        self.with_visible(&parts, camera)
    }

    /// The axes, with the visible parts of each line behind the surface, from 0 at its first end to 1 at
    /// the other.
    pub(super) fn with_visible(mut self, parts: &[Vec<[f64; 2]>], camera: &Camera) -> Strokes {
        for (wire, parts) in self.layout.wires().iter().zip(parts) {
            let at = |t: f64| camera.image(DVec3::lerp(wire.ends[0], wire.ends[1], t));
            for part in parts {
                self.strokes.push(wire.kind, 0, part.map(at));
            }
        }
        self.strokes
    }
}

/// The parts of wires that `scene` does not hide, from 0 at the first end to 1 at the other.
pub(super) fn visible_parts(wires: &[Wire], scene: &Scene, camera: &Camera) -> Vec<Vec<[f64; 2]>> {
    let mut segments = ViewSegments::new(scene);
    for wire in wires {
        let ends = wire.ends.map(|p| segments.push_point(PiercePoint::at(p)));
        segments.push(ends, wire.kind);
    }
    let none = LineSelection::NONE;
    let view = ViewedScene::with_segments(scene, camera, none, 180.0, &segments);
    let (visibility, _) = roberts::solve(&view, &VisibilityOptions::EXACT);
    let first = scene.n_lines() as u32;
    let mut parts = vec![Vec::new(); wires.len()];
    for (number, drawn) in view.selected().iter().enumerate() {
        let visible = visibility.spans(number).iter().filter(|span| span.qi == 0);
        parts[(drawn.edge - first) as usize] = visible.map(|span| [span.t0, span.t1]).collect();
    }
    parts
}
