//! Chooses a camera from a named view, from angles, or from the scene alone.
//!
//! ```text
//!            z                          azimuth: the eye moves around the target, counterclockwise
//!            │      ● eye               seen from above: 0 in front of it (looking along +y), 90 to
//!            │    ╱ ╎ elevation         its right (looking along −x)
//!     target ●──────╎──── x
//!           ╱ ╲     ╎                   eye = target + D (sin az · cos el, −cos az · cos el, sin el)
//!          y   ╲ ╌╌╌╎ azimuth, from −y
//! ```
//!
//! Symmetric views are symmetric to the last bit. Sines and cosines of multiples of 30° and 45° are
//! correctly rounded, and automatic targets and distances lie on a coarse binary grid, so `target − eye`
//! is exactly the intended direction. (A target given by the user may have more bits than the grid, and
//! then the difference may be rounded.)

use glam::DVec3;
use thiserror::Error;

use crate::camera::{Camera, CameraError, DEFAULT_FOV_DEG, DEFAULT_NEAR, Projection};

/// Default azimuth in degrees.
pub const DEFAULT_AZIMUTH_DEG: f64 = 30.0;

/// Default elevation in degrees.
pub const DEFAULT_ELEVATION_DEG: f64 = 25.0;

/// Automatic targets are multiples of the scene's size times two to this power.
const TARGET_GRID_EXPONENT: i32 = -20;

/// Number of significant bits of an automatic distance.
const DISTANCE_BITS: i32 = 6;

/// Eye minus target is a multiple of its size times two to this power. That is three bits fewer than an
/// `f64` has, so adding it to the target does not round.
const OFFSET_GRID_EXPONENT: i32 = -49;

/// A named view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NamedView {
    /// Looking along +y.
    Front,
    /// Looking along −x.
    Right,
    /// Looking along −y.
    Back,
    /// Looking along +x.
    Left,
    /// Looking down, with +y up on the page.
    Top,
    /// Looking up, with −y up on the page.
    Bottom,
    /// From the upper front right; x, y and z are equally foreshortened.
    Isometric,
    /// Azimuth 20.705°, elevation 19.471°; x and z are equally foreshortened, and y appears half as long.
    Dimetric,
    /// Azimuth 30°, elevation 25°; each axis is foreshortened differently.
    Trimetric,
}

/// Where the eye is relative to the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Standpoint {
    /// At a point in model coordinates.
    Eye(DVec3),
    /// In a direction given by two angles.
    Angles {
        /// Angle around the z axis in degrees; 0 is in front.
        azimuth_deg: f64,
        /// Angle above the horizontal plane in degrees.
        elevation_deg: f64,
        /// Distance in model units; `None` fits the whole scene into the field of view.
        distance: Option<f64>,
    },
    /// In the direction of a named view.
    Named {
        /// Which view.
        view: NamedView,
        /// Distance in model units; `None` fits the whole scene into the field of view.
        distance: Option<f64>,
    },
}

/// Perspective or orthographic projection, without parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProjectionKind {
    /// Lines of sight meet at the eye.
    Perspective,
    /// Lines of sight are parallel.
    Orthographic,
}

impl ProjectionKind {
    /// Both kinds.
    pub const ALL: [Self; 2] = [Self::Perspective, Self::Orthographic];

    /// The name used on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Perspective => "perspective",
            Self::Orthographic => "orthographic",
        }
    }
}

/// A request for a camera. Fields that are `None` are chosen to suit the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Where the eye is.
    pub standpoint: Standpoint,
    /// The point to look at; by default the center of the scene's bounding box.
    pub target: Option<DVec3>,
    /// The direction that points up on the page; by default +z, or +y when looking along z.
    pub up: Option<DVec3>,
    /// By default, orthographic for named views and perspective otherwise.
    pub projection: Option<ProjectionKind>,
    /// Vertical field of view in degrees.
    pub fov_deg: f64,
    /// The near plane, see [`Projection::Perspective`].
    pub near: f64,
}

impl Default for View {
    fn default() -> Self {
        Self {
            standpoint: Standpoint::Angles {
                azimuth_deg: DEFAULT_AZIMUTH_DEG,
                elevation_deg: DEFAULT_ELEVATION_DEG,
                distance: None,
            },
            target: None,
            up: None,
            projection: None,
            fov_deg: DEFAULT_FOV_DEG,
            near: DEFAULT_NEAR,
        }
    }
}

impl From<&Camera> for View {
    /// The view that gives exactly this camera, whatever the scene.
    fn from(camera: &Camera) -> Self {
        let (projection, fov_deg, near) = match camera.projection() {
            Projection::Perspective { fov_deg, near } => {
                (ProjectionKind::Perspective, fov_deg, near)
            }
            Projection::Orthographic => {
                (ProjectionKind::Orthographic, DEFAULT_FOV_DEG, DEFAULT_NEAR)
            }
        };
        Self {
            standpoint: Standpoint::Eye(camera.eye()),
            target: Some(camera.target()),
            up: Some(camera.up()),
            projection: Some(projection),
            fov_deg,
            near,
        }
    }
}

/// Why a view is not a valid camera.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ViewError {
    /// The distance is not positive and finite.
    #[error("the distance must be above 0, not {0}")]
    Distance(f64),
    /// An angle is not finite.
    #[error("azimuth and elevation must be finite")]
    Angle,
    /// The scene is so large that no eye with finite coordinates sees all of it.
    #[error(
        "coordinates of {0:e} are too large for any camera to show the whole scene; scale the model down"
    )]
    TooLarge(f64),
    /// The scene is so small that products of its coordinates are 0.
    #[error("a size of {0:e} is too small for any drawing; scale the model up")]
    TooSmall(f64),
    /// The scene is so far from the origin that an eye as far from it as it is large gets other coordinates.
    #[error(
        "coordinates of {0:e} are too large for a model of this size: it is lost in their rounding; move \
         it to the origin"
    )]
    TooFarOut(f64),
    /// The parameters do not define a valid camera.
    #[error(transparent)]
    Camera(#[from] CameraError),
}

/// Smaller scenes are not drawn: products of their coordinates have no digits left.
const SMALLEST_SIZE: f64 = 1e-150;

/// Most of the distance between eye and target that may be lost in rounding.
const LOST_IN_ROUNDING: f64 = 0.01;

impl View {
    /// A named view, orthographic by default.
    pub fn named(view: NamedView) -> Self {
        let standpoint = Standpoint::Named { view, distance: None };
        Self { standpoint, ..Self::default() }
    }

    /// Looking along +y.
    pub fn front() -> Self {
        Self::named(NamedView::Front)
    }

    /// Looking along −x.
    pub fn right() -> Self {
        Self::named(NamedView::Right)
    }

    /// Looking down, with +y up on the page.
    pub fn top() -> Self {
        Self::named(NamedView::Top)
    }

    /// From the upper front right; x, y and z are equally foreshortened.
    pub fn isometric() -> Self {
        Self::named(NamedView::Isometric)
    }

    /// In perspective, from an azimuth (0 is in front, 90 to the right) and an elevation above the
    /// horizontal plane, both in degrees. The distance fits the whole scene into the field of view.
    pub fn from_angles(azimuth_deg: f64, elevation_deg: f64) -> Self {
        let standpoint = Standpoint::Angles { azimuth_deg, elevation_deg, distance: None };
        Self { standpoint, ..Self::default() }
    }

    /// In perspective, from a point toward the center of the scene.
    pub fn from_eye(eye: DVec3) -> Self {
        Self { standpoint: Standpoint::Eye(eye), ..Self::default() }
    }

    /// Looks at `target` instead of the center of the scene.
    #[must_use]
    pub fn target(self, target: DVec3) -> Self {
        Self { target: Some(target), ..self }
    }

    /// Sets the direction that points up on the page.
    #[must_use]
    pub fn up(self, up: DVec3) -> Self {
        Self { up: Some(up), ..self }
    }

    /// Uses perspective projection.
    #[must_use]
    pub fn perspective(self) -> Self {
        Self { projection: Some(ProjectionKind::Perspective), ..self }
    }

    /// Uses orthographic projection.
    #[must_use]
    pub fn orthographic(self) -> Self {
        Self { projection: Some(ProjectionKind::Orthographic), ..self }
    }

    /// Sets the vertical field of view in degrees. A wider field of view moves an automatic eye closer.
    #[must_use]
    pub fn fov_deg(self, fov_deg: f64) -> Self {
        Self { fov_deg, ..self }
    }

    /// Sets the distance from the target in model units. A view from a given point ignores it.
    #[must_use]
    pub fn distance(mut self, model_units: f64) -> Self {
        match &mut self.standpoint {
            Standpoint::Eye(_) => {}
            Standpoint::Angles { distance, .. } | Standpoint::Named { distance, .. } => {
                *distance = Some(model_units);
            }
        }
        self
    }

    /// Chooses the camera for a scene with the given `bounds`, its lowest and highest corner.
    ///
    /// # Errors
    /// See [`ViewError`].
    pub fn camera(&self, bounds: (DVec3, DVec3)) -> Result<Camera, ViewError> {
        let target = self.target.unwrap_or_else(|| middle(bounds));
        let eye = match self.standpoint {
            Standpoint::Eye(eye) => eye,
            Standpoint::Angles { azimuth_deg, elevation_deg, distance } => {
                if !(azimuth_deg.is_finite() && elevation_deg.is_finite()) {
                    return Err(ViewError::Angle);
                }
                let towards_eye = direction(azimuth_deg, elevation_deg);
                target + self.offset(towards_eye, target, distance, bounds)?
            }
            Standpoint::Named { view, distance } => {
                target + self.offset(view.towards_eye(), target, distance, bounds)?
            }
        };
        let projection = match self.projection_kind() {
            ProjectionKind::Perspective => {
                Projection::Perspective { fov_deg: self.fov_deg, near: self.near }
            }
            ProjectionKind::Orthographic => Projection::Orthographic,
        };
        let up = self.up.unwrap_or_else(|| self.default_up(target - eye));
        Ok(Camera::new(eye, target, up, projection)?)
    }

    fn projection_kind(&self) -> ProjectionKind {
        self.projection.unwrap_or(match self.standpoint {
            Standpoint::Named { .. } => ProjectionKind::Orthographic,
            Standpoint::Eye(_) | Standpoint::Angles { .. } => ProjectionKind::Perspective,
        })
    }

    fn default_up(&self, forward: DVec3) -> DVec3 {
        match self.standpoint {
            Standpoint::Named { view: NamedView::Bottom, .. } => DVec3::NEG_Y,
            _ if forward.x == 0.0 && forward.y == 0.0 => DVec3::Y,
            _ => DVec3::Z,
        }
    }

    /// Eye minus target.
    fn offset(
        &self,
        towards_eye: DVec3,
        target: DVec3,
        distance: Option<f64>,
        bounds: (DVec3, DVec3),
    ) -> Result<DVec3, ViewError> {
        let distance = match distance {
            Some(distance) if distance > 0.0 && distance.is_finite() => distance,
            Some(distance) => return Err(ViewError::Distance(distance)),
            None => self.distance_that_shows(bounds, target)?,
        };
        let size = distance.max(target.abs().max_element());
        let wanted = towards_eye * distance;
        let offset = on_grid(wanted, power_of_two_at(size), OFFSET_GRID_EXPONENT);
        if (target + offset - target - wanted).abs().max_element() > LOST_IN_ROUNDING * distance {
            return Err(ViewError::TooFarOut(target.abs().max_element()));
        }
        Ok(offset)
    }

    /// The distance from which the sphere around the bounding box fills the field of view.
    fn distance_that_shows(
        &self,
        (low, high): (DVec3, DVec3),
        target: DVec3,
    ) -> Result<f64, ViewError> {
        let farthest = (high - target).abs().max((low - target).abs());
        let radius = farthest.length();
        let half_angle = self.fov_deg.clamp(0.0, 180.0).to_radians() / 2.0;
        let distance = radius / libm::sin(half_angle);
        let step = power_of_two_at(distance) * libm::exp2(f64::from(1 - DISTANCE_BITS));
        let rounded_up = (distance / step).ceil() * step;
        let size = farthest.max_element();
        if size > 0.0 && size < SMALLEST_SIZE {
            return Err(ViewError::TooSmall(size));
        }
        if !radius.is_finite() || distance.is_infinite() && half_angle > 0.0 {
            let largest = low.abs().max(high.abs()).max_element();
            return Err(ViewError::TooLarge(largest));
        }
        Ok(if rounded_up > 0.0 { rounded_up } else { 1.0 })
    }
}

impl NamedView {
    /// Every view, in the order of the documentation.
    pub const ALL: [Self; 9] = [
        Self::Front,
        Self::Right,
        Self::Back,
        Self::Left,
        Self::Top,
        Self::Bottom,
        Self::Isometric,
        Self::Dimetric,
        Self::Trimetric,
    ];

    /// The name used on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Right => "right",
            Self::Back => "back",
            Self::Left => "left",
            Self::Top => "top",
            Self::Bottom => "bottom",
            Self::Isometric => "isometric",
            Self::Dimetric => "dimetric",
            Self::Trimetric => "trimetric",
        }
    }

    /// Direction from the target to the eye, of unit length up to rounding.
    fn towards_eye(self) -> DVec3 {
        match self {
            Self::Front => direction(0.0, 0.0),
            Self::Right => direction(90.0, 0.0),
            Self::Back => direction(180.0, 0.0),
            Self::Left => direction(270.0, 0.0),
            Self::Top => direction(0.0, 90.0),
            Self::Bottom => direction(0.0, -90.0),
            Self::Isometric => DVec3::new(1.0, -1.0, 1.0) / 3f64.sqrt(),
            Self::Dimetric => direction(20.705, 19.471),
            Self::Trimetric => direction(30.0, 25.0),
        }
    }
}

/// The direction from the target to the eye for two angles in degrees.
fn direction(azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
    let (sin_azimuth, cos_azimuth) = sin_cos_deg(azimuth_deg);
    let (sin_elevation, cos_elevation) = sin_cos_deg(elevation_deg);
    DVec3::new(sin_azimuth * cos_elevation, -cos_azimuth * cos_elevation, sin_elevation)
}

/// Sine and cosine of an angle in degrees, correctly rounded for all multiples of 30° and 45°.
///
/// The angle is first reduced to 0°–45°, which is exact, so the identities between quadrants hold to the
/// last bit: `sin(180° − a) = sin a`, `cos a = sin(90° − a)` and so on.
pub fn sin_cos_deg(angle_deg: f64) -> (f64, f64) {
    let turn = angle_deg.abs() % 360.0;
    let (half, below) = if turn > 180.0 { (360.0 - turn, true) } else { (turn, false) };
    let (quarter, behind) = if half > 90.0 { (180.0 - half, true) } else { (half, false) };
    let (eighth, swapped) = if quarter > 45.0 { (90.0 - quarter, true) } else { (quarter, false) };
    let (sin, cos) = if eighth == 30.0 {
        (0.5, 3f64.sqrt() / 2.0)
    } else if eighth == 45.0 {
        (std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2)
    } else {
        let radians = eighth.to_radians();
        (libm::sin(radians), libm::cos(radians))
    };
    let (sin, cos) = if swapped { (cos, sin) } else { (sin, cos) };
    let sin = if below != (angle_deg < 0.0) { -sin } else { sin };
    let cos = if behind { -cos } else { cos };
    // Adding 0 turns −0 into 0.
    (sin + 0.0, cos + 0.0)
}

/// The center of a box, rounded to a grid of about a millionth of its size.
fn middle((low, high): (DVec3, DVec3)) -> DVec3 {
    let middle = low / 2.0 + high / 2.0;
    on_grid(middle, power_of_two_at((high - low).max_element()), TARGET_GRID_EXPONENT)
}

/// Rounds `v` to multiples of `size · 2^exponent`, where `size` is a power of two.
fn on_grid(v: DVec3, size: f64, exponent: i32) -> DVec3 {
    let step = size * libm::exp2(f64::from(exponent));
    let rounded = (v / step).round() * step;
    if rounded.is_finite() { rounded + DVec3::ZERO } else { v }
}

/// The largest power of two that is at most `x`; 0 if there is none.
fn power_of_two_at(x: f64) -> f64 {
    if x > 0.0 && x.is_finite() { libm::ldexp(1.0, libm::ilogb(x)) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_of_round_angles_are_the_right_numbers() {
        let half_sqrt_3 = 0.866_025_403_784_438_6;
        let half_sqrt_2 = std::f64::consts::FRAC_1_SQRT_2;
        for (angle, sin, cos) in [
            (0.0, 0.0, 1.0),
            (30.0, 0.5, half_sqrt_3),
            (45.0, half_sqrt_2, half_sqrt_2),
            (60.0, half_sqrt_3, 0.5),
            (90.0, 1.0, 0.0),
            (120.0, half_sqrt_3, -0.5),
            (135.0, half_sqrt_2, -half_sqrt_2),
            (180.0, 0.0, -1.0),
            (210.0, -0.5, -half_sqrt_3),
            (270.0, -1.0, 0.0),
            (315.0, -half_sqrt_2, half_sqrt_2),
            (-90.0, -1.0, 0.0),
            (-30.0, -0.5, half_sqrt_3),
            (-240.0, half_sqrt_3, -0.5),
            (750.0, 0.5, half_sqrt_3),
        ] {
            assert_eq!(sin_cos_deg(angle), (sin, cos), "{angle}°");
        }
    }

    #[test]
    fn other_sines_agree_with_radians() {
        for step in -500..500 {
            let angle = f64::from(step) * 1.37;
            let (sin, cos) = sin_cos_deg(angle);
            assert!((sin - angle.to_radians().sin()).abs() < 1e-14, "sin {angle}°");
            assert!((cos - angle.to_radians().cos()).abs() < 1e-14, "cos {angle}°");
        }
    }
}
