//! A finished plot on another sheet: moved, scaled, cropped, with nothing lost silently.

use glam::DVec2;

use super::{CROP_SLACK_MM, Orientation, PageError, Paper};
use crate::extent::window::Window;
use crate::plot::{Layer, Plot, Polylines};

/// The sheet that a finished plot is put on, and how.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RefitOptions {
    /// The sheet; `None` keeps the plot's own.
    pub paper: Option<Paper>,
    /// Which way it lies; `None` to suit the ink.
    pub orientation: Option<Orientation>,
    /// Empty border on all four sides in millimeters.
    pub margin_mm: f64,
    /// Whether the ink is scaled to be as large as the margins allow, centered.
    pub fit: bool,
    /// Whether the ink is centered on the sheet.
    pub center: bool,
    /// Where ink is cut off.
    pub crop: Crop,
}

/// Where ink is cut off.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Crop {
    /// At the edges of the sheet.
    #[default]
    Page,
    /// At the margins.
    Margin,
    /// Nowhere.
    None,
}

impl Crop {
    /// All of them, in the order of the documentation.
    pub const ALL: [Self; 3] = [Self::Page, Self::Margin, Self::None];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Page => "page",
            Self::Margin => "margin",
            Self::None => "none",
        }
    }
}

/// A plot, and how much of its ink was cut off.
#[derive(Debug, Clone, PartialEq)]
pub struct Cropped {
    /// What is left.
    pub plot: Plot,
    /// Length of the lines cut off in millimeters, layers that are not plotted left aside.
    pub lost_mm: f64,
    /// Dots cut off.
    pub lost_dots: usize,
}

/// Puts `plot` on another sheet. Pen widths stay. O(points).
///
/// # Errors
/// See [`PageError`].
pub fn refit(plot: Plot, options: &RefitOptions) -> Result<Cropped, PageError> {
    let margin_mm = options.margin_mm;
    if !(margin_mm >= 0.0 && margin_mm.is_finite()) {
        return Err(PageError::NegativeMargin(margin_mm));
    }
    let ink = ink_bounds(&plot);
    let mut plot = plot;
    let [low, high] = ink.unwrap_or([DVec2::ZERO, DVec2::new(plot.width_mm, plot.height_mm)]);
    let own = Paper { width_mm: plot.width_mm, height_mm: plot.height_mm, name: None };
    let suits = match high.y - low.y > high.x - low.x {
        true => Orientation::Portrait,
        false => Orientation::Landscape,
    };
    let paper = options.paper.unwrap_or(own).turned(options.orientation, suits);
    let sheet = DVec2::new(paper.width_mm, paper.height_mm);
    let margin = DVec2::splat(margin_mm);
    let usable = sheet - 2.0 * margin;
    if usable.min_element() <= 0.0 {
        let (width_mm, height_mm) = (paper.width_mm, paper.height_mm);
        return Err(PageError::Margins { margin_mm, width_mm, height_mm });
    }
    (plot.width_mm, plot.height_mm) = (sheet.x, sheet.y);
    if ink.is_some() && (options.fit || options.center) {
        let scale = if options.fit { (usable / (high - low)).min_element() } else { 1.0 };
        // A drawing without extent has no scale of its own.
        let scale = if scale.is_finite() { scale } else { 1.0 };
        let middle = low.midpoint(high);
        plot = mapped(plot, |p| sheet / 2.0 + (p - middle) * scale);
    }
    Ok(match options.crop {
        Crop::None => Cropped { plot, lost_mm: 0.0, lost_dots: 0 },
        Crop::Page => crop_to(plot, [DVec2::ZERO, sheet]),
        Crop::Margin => crop_to(plot, [margin, sheet - margin]),
    })
}

/// Cuts off what lies outside of a rectangle, given by its lowest and highest corner. Points that
/// are outside by rounding only are moved onto its border. O(points).
pub fn crop_to(plot: Plot, [low, high]: [DVec2; 2]) -> Cropped {
    let window = Window { low, high, slack: CROP_SLACK_MM };
    let (mut lost_mm, mut lost_dots) = (0.0, 0);
    let mut points = Vec::new();
    let layers = plot.layers.iter().map(|layer| {
        let mut lines = Polylines::default();
        let mut n_dots = [0, 0];
        let is_dot = |line: &[DVec2]| line.iter().all(|p| Some(p) == line.first());
        for line in layer.lines.iter() {
            points.clear();
            points.extend_from_slice(line);
            n_dots[0] += usize::from(is_dot(line));
            window.crop(&mut points, |piece| {
                n_dots[1] += usize::from(is_dot(line) && is_dot(piece));
                lines.push(piece.iter().copied());
            });
        }
        if layer.is_plotted() {
            lost_mm += (layer.lines.length_mm() - lines.length_mm()).max(0.0);
            lost_dots += n_dots[0] - n_dots[1];
        }
        layer.with_lines(lines)
    });
    let layers = layers.collect();
    // Rounding onto the border and in the sums is no loss.
    let lost_mm = if lost_mm < CROP_SLACK_MM { 0.0 } else { lost_mm };
    Cropped { plot: Plot { layers, ..plot }, lost_mm, lost_dots }
}

/// Box around all ink that is plotted.
fn ink_bounds(plot: &Plot) -> Option<[DVec2; 2]> {
    let points = plot.plotted_layers().flat_map(|layer| layer.lines.iter().flatten());
    points.fold(None, |found: Option<[DVec2; 2]>, &p| {
        Some(found.map_or([p, p], |[low, high]| [low.min(p), high.max(p)]))
    })
}

fn mapped(plot: Plot, map: impl Fn(DVec2) -> DVec2) -> Plot {
    let layers = plot.layers.into_iter().map(|layer| {
        let mut lines = Polylines::default();
        for line in layer.lines.iter() {
            lines.push(line.iter().map(|&p| map(p)));
        }
        Layer { lines, ..layer }
    });
    let layers = layers.collect();
    Plot { layers, ..plot }
}
