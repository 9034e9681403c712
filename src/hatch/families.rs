//! Families of hatch lines: where planes in space cut the scene.
//!
//! ```text
//!   sections                          straight
//!   ╱╲ ╲ ╲   parallel planes          eye ◁═══ planes through the eye, each of which is
//!  ╱ ╱╲ ╲ ╲  wrap the form                ╲══╲ one line on paper
//! ```
//!
//! Lines of a family are numbered. Their base distance is an eighth of the least one that the darkest tone
//! needs on a face square to the viewer, so that slanted faces get lines close enough together. Their ranks
//! say which of them are drawn where: a darker place keeps every line of a lighter one.

use glam::{DVec2, DVec3};

use super::options::{HatchLevels, HatchMethod, HatchOptions, HatchPage};
use crate::camera::framing::sin_cos_deg;
use crate::camera::{Camera, Frame, Projection};
use crate::predicates::FreePlane;
use crate::shading::light::Light;

/// This many lines at base distance make the least distance of lines that are drawn.
const BASE_LINES: f64 = 8.0;

/// Sections are turned so far from upright toward the light, across the view, in degrees.
const TOWARDS_LIGHT_DEG: f64 = 30.0;

/// And so far toward the viewer.
const TOWARDS_VIEWER_DEG: f64 = 10.0;

/// Where a face's normal is this near to the planes' own, as a cosine, lines are far apart and wander;
/// there the planes of the alternate family cut it. 20 degrees.
const ALONG_NORMAL: f64 = 0.94;

/// The usual angles of straight lines in degrees.
const STRAIGHT_DEG: [f64; 2] = [45.0, -45.0];

/// The planes of a family.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Planes {
    /// Parallel planes, the first one at `origin` along the normal.
    Parallel { normal: DVec3, origin: f64, step: f64 },
    /// Planes through the eye; `across` is the unit vector across the lines in the image.
    ThroughEye { eye: DVec3, across: DVec3, forward: DVec3, origin: f64, step: f64 },
}

/// On which faces a family draws.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Faces {
    All,
    /// Those whose normal is not along this one.
    NotAlong(DVec3),
    /// Those whose normal is.
    Along(DVec3),
}

impl Planes {
    /// Between which places the lines on the page are; without bounds for planes that are not lines on
    /// paper.
    fn on_page(&self, camera: &Camera, page: &HatchPage) -> [f64; 2] {
        let Self::ThroughEye { across, origin, step, .. } = *self else {
            return [f64::NEG_INFINITY, f64::INFINITY];
        };
        let frame = camera.frame();
        let across = DVec2::new(across.dot(frame.right), across.dot(frame.upward));
        let (low, high) = page.window;
        let corners = [low, high, DVec2::new(low.x, high.y), DVec2::new(high.x, low.y)];
        let places = corners.map(|corner| (across.dot(corner) - origin) / step);
        let least = places.iter().copied().fold(f64::INFINITY, f64::min);
        [least, places.iter().copied().fold(f64::NEG_INFINITY, f64::max)]
    }
}

/// A family of lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Family {
    planes: Planes,
    faces: Faces,
    /// The least and the greatest place on the page, for lines on paper.
    on_page: [f64; 2],
    /// The materials that it is for: a number in [`Families::class`].
    pub(super) class: u16,
    /// Coverage by the families before it, where it begins.
    pub(super) from: f64,
    /// The most that it covers itself.
    pub(super) most: f64,
    /// The most that all families cover.
    pub(super) black: f64,
}

/// All families, in the order in which they share the darkness.
#[derive(Debug)]
pub(super) struct Families {
    pub(super) all: Vec<Family>,
    /// For each part of the mesh the class of its material; 0 for those that are not named.
    class_of_part: Vec<u16>,
}

/// The image's frame and scale, to measure distances of lines on paper.
#[derive(Debug, Clone, Copy)]
pub(super) struct Paper {
    eye: DVec3,
    frame: Frame,
    is_perspective: bool,
    mm_per_image_unit: f64,
}

impl Paper {
    pub(super) fn new(camera: &Camera, page: &HatchPage) -> Self {
        Self {
            eye: camera.eye(),
            frame: camera.frame(),
            is_perspective: matches!(camera.projection(), Projection::Perspective { .. }),
            mm_per_image_unit: page.mm_per_image_unit,
        }
    }

    /// The sight line through a point, one unit long along the direction of view, and the divisor of
    /// its image.
    #[inline]
    fn sight(&self, at: DVec3) -> (DVec3, f64) {
        if self.is_perspective {
            let d = at - self.eye;
            let depth = d.dot(self.frame.forward);
            (d / depth, depth)
        } else {
            (self.frame.forward, 1.0)
        }
    }

    /// How a direction in space looks in the image.
    fn across(&self, v: DVec3) -> DVec2 {
        DVec2::new(v.dot(self.frame.right), v.dot(self.frame.upward))
    }
}

impl Families {
    pub(super) fn new(
        options: &HatchOptions,
        camera: &Camera,
        light: &Light,
        page: &HatchPage,
        parts: &[crate::model::mesh::MeshPart],
    ) -> Self {
        let mut all = Vec::new();
        for class in 0..=options.materials.len() {
            let material = class.checked_sub(1).and_then(|k| options.materials.get(k));
            let black = material.and_then(|m| m.black).unwrap_or(options.black);
            let turn_deg = material.and_then(|m| m.angle_deg);
            let step_mm = page.pen_width_mm / options.black / BASE_LINES;
            let planes = match options.method {
                HatchMethod::Straight => straight(options, camera, page, step_mm, turn_deg),
                HatchMethod::Sections => sections(options, camera, light, page, step_mm, turn_deg),
            };
            let n = planes.iter().map(|(share, ..)| share + 1).max().unwrap_or(1);
            for (share, planes, faces) in planes {
                let from = black * share as f64 / n as f64;
                let to = black * (share + 1) as f64 / n as f64;
                let most = 1.0 - (1.0 - to) / (1.0 - from);
                let on_page = planes.on_page(camera, page);
                all.push(Family { planes, faces, on_page, class: class as u16, from, most, black });
            }
        }
        let class = |name: &str| {
            let named = options.materials.iter().position(|material| material.name == name);
            named.map_or(0, |k| k as u16 + 1)
        };
        Self { all, class_of_part: parts.iter().map(|part| class(&part.material)).collect() }
    }

    /// The class of a part of the mesh.
    pub(super) fn class(&self, part: Option<u32>) -> u16 {
        part.and_then(|part| self.class_of_part.get(part as usize)).copied().unwrap_or(0)
    }
}

/// The angles to draw at, in degrees; empty for the usual ones.
fn angles(options: &HatchOptions, turn_deg: Option<f64>, usual: &[f64]) -> Vec<f64> {
    let given = if options.angles_deg.is_empty() { usual } else { &options.angles_deg };
    let Some(turn) = turn_deg else { return given.to_vec() };
    let first = given.first().copied().unwrap_or(0.0);
    let turned = given.iter().map(|angle| angle - first + turn);
    if given.is_empty() { vec![turn] } else { turned.collect() }
}

/// Planes that are lines on paper, with the number of their share of the darkness.
fn straight(
    options: &HatchOptions,
    camera: &Camera,
    page: &HatchPage,
    step_mm: f64,
    turn_deg: Option<f64>,
) -> Vec<(usize, Planes, Faces)> {
    let usual = if options.cross { &STRAIGHT_DEG[..] } else { &STRAIGHT_DEG[..1] };
    let Frame { right, upward, forward } = camera.frame();
    let step = step_mm / page.mm_per_image_unit;
    let middle = (page.window.0 + page.window.1) / 2.0;
    let angles = angles(options, turn_deg, usual);
    let families = angles.into_iter().enumerate().map(|(share, angle)| {
        let (sin, cos) = sin_cos_deg(angle);
        let across = upward * cos - right * sin;
        let origin = DVec2::new(-sin, cos).dot(middle);
        let planes = match camera.projection() {
            Projection::Perspective { .. } => {
                Planes::ThroughEye { eye: camera.eye(), across, forward, origin, step }
            }
            Projection::Orthographic => {
                let origin = across.dot(camera.eye()) + origin;
                Planes::Parallel { normal: across, origin, step }
            }
        };
        (share, planes, Faces::All)
    });
    families.collect()
}

/// Parallel planes in space, and others for faces along them.
fn sections(
    options: &HatchOptions,
    camera: &Camera,
    light: &Light,
    page: &HatchPage,
    step_mm: f64,
    turn_deg: Option<f64>,
) -> Vec<(usize, Planes, Faces)> {
    let depth = match camera.projection() {
        Projection::Perspective { .. } => camera.forward().length(),
        Projection::Orthographic => 1.0,
    };
    let step = step_mm / page.mm_per_image_unit * depth;
    let frame = camera.frame();
    let angles = angles(options, turn_deg, &[]);
    let normals: Vec<DVec3> = if angles.is_empty() {
        let given = options.normal.and_then(DVec3::try_normalize);
        let first = given.unwrap_or_else(|| usual_normal(camera, light));
        if options.cross { vec![first, turned(first, &frame)] } else { vec![first] }
    } else {
        let normal = |angle: &f64| {
            let (sin, cos) = sin_cos_deg(*angle);
            towards_viewer(frame.upward * cos - frame.right * sin, &frame)
        };
        angles.iter().map(normal).collect()
    };
    let planes = |normal| Planes::Parallel { normal, origin: 0.0, step };
    let mut families = Vec::new();
    for (share, &normal) in normals.iter().enumerate() {
        // With a second family the alternate must cross that one too.
        let alternate = match normals.iter().find(|other| other.dot(normal).abs() < ALONG_NORMAL) {
            Some(other) => normal.cross(*other).normalize_or_zero(),
            None => turned(normal, &frame),
        };
        families.push((share, planes(normal), Faces::NotAlong(normal)));
        families.push((share, planes(alternate), Faces::Along(normal)));
    }
    families
}

/// Up, turned toward the light and the viewer.
fn usual_normal(camera: &Camera, light: &Light) -> DVec3 {
    let frame = camera.frame();
    let is_up_along_view = frame.forward.dot(DVec3::Z).abs() > ALONG_NORMAL;
    let up = if is_up_along_view { frame.upward } else { DVec3::Z };
    let side = if light.towards(camera.target()).dot(frame.right) < 0.0 { -1.0 } else { 1.0 };
    let (sin, cos) = sin_cos_deg(TOWARDS_LIGHT_DEG);
    let across = up.cross(frame.forward).normalize_or_zero();
    let right = if across.dot(frame.right) < 0.0 { -across } else { across };
    towards_viewer(up * cos + right * (sin * side), &frame)
}

fn towards_viewer(normal: DVec3, frame: &Frame) -> DVec3 {
    let (sin, cos) = sin_cos_deg(TOWARDS_VIEWER_DEG);
    (normal * cos - frame.forward * sin).normalize_or_zero()
}

/// A normal turned by a right angle about the view.
fn turned(normal: DVec3, frame: &Frame) -> DVec3 {
    let (x, y, z) = (normal.dot(frame.right), normal.dot(frame.upward), normal.dot(frame.forward));
    (frame.upward * x - frame.right * y + frame.forward * z).normalize_or_zero()
}

impl Family {
    /// The plane of a line.
    pub(super) fn plane(&self, line: i32) -> FreePlane {
        match self.planes {
            Planes::Parallel { normal, origin, step } => {
                FreePlane { normal, offset: origin + f64::from(line) * step }
            }
            Planes::ThroughEye { eye, across, forward, origin, step } => {
                let normal = across - forward * (origin + f64::from(line) * step);
                FreePlane { normal, offset: normal.dot(eye) }
            }
        }
    }

    /// Between which lines a point lies, as a number of lines, or the nearest such place on the page;
    /// rounded. In perspective the point must be in front of the eye.
    #[inline]
    pub(super) fn place(&self, at: DVec3) -> f64 {
        match self.planes {
            Planes::Parallel { normal, origin, step } => (normal.dot(at) - origin) / step,
            Planes::ThroughEye { eye, across, forward, origin, step } => {
                let d = at - eye;
                let place = (d.dot(across) / d.dot(forward) - origin) / step;
                place.clamp(self.on_page[0], self.on_page[1])
            }
        }
    }

    /// Lines in each millimeter on paper, all of base distance, where a face with this normal is seen
    /// at a point.
    #[inline]
    pub(super) fn density(&self, paper: &Paper, at: DVec3, normal: DVec3) -> f64 {
        match self.planes {
            Planes::ThroughEye { step, .. } => 1.0 / (step * paper.mm_per_image_unit),
            Planes::Parallel { normal: across, step, .. } => {
                let (sight, divisor) = paper.sight(at);
                // Smooth normals may be turned away from the viewer where the face is not.
                let facing = normal.dot(sight).min(-LEAST_FACING * sight.length());
                let slant = across.dot(sight) / facing;
                let gradient = paper.across(across) - paper.across(normal) * slant;
                gradient.length() * divisor / (step * paper.mm_per_image_unit)
            }
        }
    }

    /// Above 0 where a face with this normal is drawn on.
    #[inline]
    pub(super) fn draws_on(&self, normal: DVec3) -> f64 {
        match self.faces {
            Faces::All => 1.0,
            Faces::NotAlong(along) => ALONG_NORMAL - normal.dot(along).abs(),
            Faces::Along(along) => normal.dot(along).abs() - ALONG_NORMAL,
        }
    }

    /// Whether it draws where another one does not.
    pub(super) fn is_alternate(&self) -> bool {
        matches!(self.faces, Faces::Along(_))
    }

    /// Whether it draws on a face with this normal.
    pub(super) fn draws_on_flat(&self, normal: DVec3) -> bool {
        self.draws_on(normal) > 0.0
    }
}

/// A face square to the viewer has 1, one seen from its edge 0; less than this counts as this. It
/// bounds how dense lines can be.
const LEAST_FACING: f64 = 1e-3;

/// When a line starts to be drawn as it gets darker: a line is drawn where the part of all lines that the
/// tone needs is above its rank, from 0 for the first line to 1 for the last.
///
/// With [`HatchLevels::Halving`] a line whose number is divisible by 2ᵛ and not by more has rank
/// 2⁻ᵛ / (2 ln 2): the number of lines that are drawn halves at once, where that is nearest to what is
/// needed on a scale of ratios, and so that the mean over all tones is right. (At 2⁻ᵛ √½, in the middle of
/// that scale, it would be 2 % too dark.) With [`HatchLevels::Continuous`] it is the radical inverse of the
/// number (van der Corput): line after line is left out.
pub(super) fn rank(levels: HatchLevels, line: i32) -> f64 {
    match levels {
        HatchLevels::Continuous => f64::from((line as u32).reverse_bits()) / 4_294_967_296.0,
        _ if line == 0 => 0.0,
        _ => HALVING * libm::exp2(-f64::from(line.trailing_zeros())),
    }
}

/// The least number `v` for which lines divisible by 2ᵛ may have a rank below `limit`.
pub(super) fn least_halvings(levels: HatchLevels, limit: f64) -> u32 {
    if levels == HatchLevels::Continuous || limit > 1.0 {
        return 0;
    }
    // Line 0 is drawn wherever any line is.
    (-libm::log2(limit / HALVING)).ceil().clamp(0.0, 30.0) as u32
}

/// 1 / (2 ln 2).
const HALVING: f64 = std::f64::consts::LOG2_E / 2.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn continuous_lines_thin_out_evenly() {
        for exponent in 0..8 {
            let n = 1 << exponent;
            for first in [-300, -5, 0, 3, 1000] {
                for part in 1..50 {
                    let part = f64::from(part) / 50.0;
                    let is_drawn = |line: &i32| rank(HatchLevels::Continuous, *line) < part;
                    let drawn = (first..first + n).filter(is_drawn).count() as f64;
                    let expected = part * f64::from(n);
                    assert!((drawn - expected).abs() < 1.0, "{drawn} of {n} from {first}: {part}");
                }
            }
        }
    }

    #[test]
    fn every_second_line_goes_at_once_and_the_others_stay() {
        let drawn = |limit: f64| -> Vec<i32> {
            (-64..64).filter(|&line| rank(HatchLevels::Halving, line) < limit).collect()
        };
        for halvings in 0..6 {
            // Just before and just after the number of lines halves.
            let limit = HALVING * libm::exp2(-f64::from(halvings));
            let (more, fewer) = (drawn(limit * 1.0001), drawn(limit * 0.9999));
            assert_eq!(more.len(), 128 >> halvings);
            assert_eq!(fewer.len(), 128 >> (halvings + 1));
            assert!(fewer.iter().all(|line| more.contains(line)));
        }
        for line in -100..100 {
            for limit in [0.01, 0.1, 0.2, 0.5, 0.8, 1.5] {
                let step = 1 << least_halvings(HatchLevels::Halving, limit);
                assert!(rank(HatchLevels::Halving, line) >= limit || line % step == 0);
            }
        }
    }
}
