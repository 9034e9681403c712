//! Axes with ticks, numbers and titles around a surface, as strokes.
//!
//! ```text
//!      ╱▔▔▔╲            Each axis runs along an edge of the bounding box between a front face and
//!  2 ─┤     ╲           a back face, that is, along the outline of the box. Nothing in the box can
//!     │      ▏          hide such an edge or anything drawn outside it, so axes need no visibility
//!  0 ─╲     ╱           algorithm, and the lettering never covers the surface.
//!    ┼ ╲┼┼┼╱
//! ```

mod axis;
mod font;
mod glyphs;
mod letters;
mod script;
mod ticks;

pub use font::{missing, text};

use glam::{DVec2, DVec3, dvec2};

use self::axis::{Axis, Laid, write_centered};
use crate::camera::{Camera, Projection};
use crate::extent::Extent;
use crate::strokes::Strokes;

/// Height of numbers as a fraction of the longer side of the box in the image: 4.6 mm on A4
/// landscape.
const TEXT_HEIGHT: f64 = 1.0 / 60.0;

/// The titles of the axes and of the drawing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Titles {
    /// Titles of the x, y and z axes; an empty one is left out.
    pub axes: [String; 3],
    /// Title above the drawing; left out if empty.
    pub drawing: String,
}

impl Titles {
    /// The usual titles of the axes, and one above the drawing.
    pub fn of_drawing(title: impl Into<String>) -> Self {
        Self { drawing: title.into(), ..Self::default() }
    }
}

impl Default for Titles {
    fn default() -> Self {
        Self { axes: ["x", "y", "z"].map(str::to_owned), drawing: String::new() }
    }
}

/// Draws axes around `bounds`, the lowest and highest corner of the surface in model units, and a title
/// above `extent`, the part of the image that the surface takes up.
///
/// The numbers on the z axis are heights divided by `z_factor`, so a surface whose heights were
/// multiplied by that factor shows its original heights. An axis without an edge on the outline of the
/// box is left out. If any corner of the box is in front of the near plane, all axes are left out.
pub fn axes(
    extent: &Extent,
    bounds: (DVec3, DVec3),
    z_factor: f64,
    camera: &Camera,
    titles: &Titles,
) -> Strokes {
    let mut drawing = Strokes::default();
    let Some((axes, (low, high), height)) = lay(bounds, z_factor, camera, titles) else {
        return drawing;
    };
    axes.iter().for_each(|axis| axis.draw(&mut drawing));
    if !titles.drawing.is_empty() {
        let tops =
            [extent.corners(), drawing.bounds()].map(|corners| corners.map(|(_, high)| high.y));
        let top = tops.into_iter().flatten().fold(high.y, f64::max);
        let at = dvec2(low.x / 2.0 + high.x / 2.0, top + 3.0 * height);
        write_centered(&mut drawing, &titles.drawing, 1.5 * height, at);
    }
    drawing
}

/// The axes, the lower and upper corner of the box in the image, and the height of numbers in the
/// image.
type Layout = (Vec<Laid>, (DVec2, DVec2), f64);

fn lay(bounds: (DVec3, DVec3), z_factor: f64, camera: &Camera, titles: &Titles) -> Option<Layout> {
    let bbox = BoundingBox { low: bounds.0, high: bounds.1, camera };
    let corners = (0..8).map(|k| bbox.corner([k & 1, k >> 1 & 1, k >> 2 & 1].map(|b| b == 1)));
    let near = camera.near_distance().unwrap_or(f64::NEG_INFINITY);
    let forward = camera.frame().forward;
    let corners: Vec<DVec3> = corners.collect();
    let depth = |p: &DVec3| (*p - camera.eye()).dot(forward);
    if !corners.iter().all(|p| p.is_finite() && depth(p) > near) {
        return None;
    }
    let images: Vec<DVec2> = corners.iter().map(|p| camera.image(*p)).collect();
    let low = images.iter().fold(DVec2::INFINITY, |low, p| low.min(*p));
    let high = images.iter().fold(DVec2::NEG_INFINITY, |high, p| high.max(*p));
    let height = (high - low).max_element() * TEXT_HEIGHT;
    if !(height > 0.0 && height.is_finite()) {
        return None;
    }
    let center = images.iter().sum::<DVec2>() / 8.0;
    let (mut axes, mut laid) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        let Some([a, b]) = bbox.axis_edge(axis) else { continue };
        let factor = if axis == 2 { z_factor } else { 1.0 };
        let axis = Axis { axis, a, b, factor, center, height, title: &titles.axes[axis] };
        if let Some(place) = axis.lay(camera, &laid) {
            laid.push(place);
            axes.push(axis);
        }
    }
    // Numbers first, since titles can move farther out.
    for (k, axis) in axes.iter().enumerate() {
        let title = axis.place_title(k, &laid);
        laid[k].set_title(title);
    }
    Some((laid, (low, high), height))
}

struct BoundingBox<'a> {
    low: DVec3,
    high: DVec3,
    camera: &'a Camera,
}

impl BoundingBox<'_> {
    fn corner(&self, is_high: [bool; 3]) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|k| if is_high[k] { self.high[k] } else { self.low[k] }))
    }

    /// Whether the eye is in front of a face.
    fn is_front(&self, axis: usize, is_high: bool) -> bool {
        match (self.camera.projection(), is_high) {
            (Projection::Perspective { .. }, false) => self.camera.eye()[axis] < self.low[axis],
            (Projection::Perspective { .. }, true) => self.camera.eye()[axis] > self.high[axis],
            (Projection::Orthographic, false) => self.camera.forward()[axis] > 0.0,
            (Projection::Orthographic, true) => self.camera.forward()[axis] < 0.0,
        }
    }

    /// The edge of the outline along an axis that is lowest in the image, or leftmost for z.
    fn axis_edge(&self, axis: usize) -> Option<[DVec3; 2]> {
        if self.low[axis] >= self.high[axis] {
            return None;
        }
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut best: Option<(f64, [DVec3; 2])> = None;
        for sides in [[false, false], [true, false], [true, true], [false, true]] {
            if self.is_front(b, sides[0]) == self.is_front(c, sides[1]) {
                continue;
            }
            let mut is_high = [false; 3];
            (is_high[b], is_high[c]) = (sides[0], sides[1]);
            let from = self.corner(is_high);
            is_high[axis] = true;
            let ends = [from, self.corner(is_high)];
            let middle = ends.map(|p| self.camera.image(p)).iter().sum::<DVec2>() / 2.0;
            let key = if axis == 2 { middle.x } else { middle.y };
            if best.is_none_or(|(least, _)| key < least) {
                best = Some((key, ends));
            }
        }
        best.map(|(_, ends)| ends)
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;

    /// The axes of a box around the origin, seen from `eye`.
    fn laid(size: DVec3, eye: DVec3, titles: &Titles) -> Vec<Laid> {
        let camera = Camera::new(
            eye,
            DVec3::ZERO,
            DVec3::Z,
            Projection::Perspective { fov_deg: 30.0, near: 1e-3 },
        );
        lay((-size / 2.0, size / 2.0), 1.0, &camera.expect("a camera"), titles)
            .map_or(Vec::new(), |(laid, ..)| laid)
    }

    #[test]
    fn no_text_touches_another() {
        let long = ["the first direction", "the second direction", "height"].map(str::to_owned);
        let titles = Titles { axes: long, drawing: String::new() };
        let mut n_texts = 0;
        for size in [[1.0, 1.0, 1.0], [10.0, 1.0, 0.3], [1.0, 20.0, 3.0], [2e4, 2e4, 0.7]] {
            let size = DVec3::from_array(size);
            for step in 0..40 {
                let azimuth = f64::from(step) * 0.17;
                for elevation in [0.1, 0.4, 0.9, 1.4] {
                    let (sin, cos) = (libm::sin(elevation), libm::cos(elevation));
                    let way = dvec3(libm::sin(azimuth) * cos, -libm::cos(azimuth) * cos, sin);
                    let laid = laid(size, way * 4.0 * size.length(), &titles);
                    let boxes: Vec<(DVec2, DVec2)> =
                        laid.iter().flat_map(Laid::labels).map(|label| label.drawn_box()).collect();
                    n_texts += boxes.len();
                    for (k, (low, high)) in boxes.iter().enumerate() {
                        for (other_low, other_high) in &boxes[..k] {
                            let apart = (*low - *other_high).max(*other_low - *high);
                            assert!(apart.max_element() > 0.0, "{size} {azimuth} {elevation}");
                        }
                    }
                }
            }
        }
        assert!(n_texts > 4000, "{n_texts}");
    }

    #[test]
    fn a_short_axis_has_fewer_ticks_than_a_long_one() {
        let count = |laid: &[Laid], k: usize| laid[k].labels().count();
        let titles = Titles { axes: Default::default(), drawing: String::new() };
        let flat = laid(dvec3(10.0, 10.0, 0.2), dvec3(8.0, -30.0, 12.0), &titles);
        assert!(count(&flat, 0) >= 4 && (1..=2).contains(&count(&flat, 2)));
    }
}
