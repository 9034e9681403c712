//! The camera, from options or from a file.

use std::error::Error;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use clap::Args;
use glam::DVec3;
use hiddenline::stages::camera::framing::{
    DEFAULT_AZIMUTH_DEG, DEFAULT_ELEVATION_DEG, NamedView, ProjectionKind, Standpoint, View,
    ViewError,
};
use hiddenline::stages::camera::{Camera, CameraError, DEFAULT_FOV_DEG, DEFAULT_NEAR};
use hiddenline::stages::write::json::{self, ReadCameraError};

use super::choice::one_of;
use super::paths::is_dash;
use super::values;

#[derive(Args, Clone)]
#[command(next_help_heading = "Camera")]
pub(super) struct CameraArgs {
    /// Position of the eye
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    eye: Option<DVec3>,
    /// Point to look at [default: the center of the bounding box]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    target: Option<DVec3>,
    /// Direction that points up on the page [default: 0,0,1, or 0,1,0 when looking along z]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    up: Option<DVec3>,
    /// Degrees around the vertical: 0 from the front, 90 from the right [default: 30]
    #[arg(long, value_name = "DEG", value_parser = values::number, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["eye", "view"])]
    azimuth: Option<f64>,
    /// Degrees above the horizontal [default: 25]
    #[arg(long, value_name = "DEG", value_parser = values::number, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["eye", "view"])]
    elevation: Option<f64>,
    /// Distance from target to eye [default: far enough to see the whole scene]
    #[arg(long, value_name = "D", value_parser = values::positive, conflicts_with = "eye")]
    distance: Option<f64>,
    /// Named view; orthographic unless --projection says otherwise
    #[arg(long, value_parser = one_of::<NamedView>(), conflicts_with = "eye")]
    view: Option<NamedView>,
    /// Projection [default: perspective, but orthographic with --view]
    #[arg(long, value_parser = one_of::<ProjectionKind>())]
    projection: Option<ProjectionKind>,
    /// Vertical field of view in degrees [default: 30]
    ///
    /// It only affects the automatic camera distance and --fit-fov.
    #[arg(long, value_name = "DEG", value_parser = values::field_of_view)]
    fov: Option<f64>,
    /// Distance of the near plane from the eye, as a fraction of the distance to the target [default:
    /// 0.000001]
    #[arg(long, value_name = "PART", value_parser = values::positive)]
    near: Option<f64>,
    /// Use the camera from a file written by --format json
    #[arg(long, value_name = "FILE")]
    #[arg(conflicts_with_all = ["eye", "target", "up", "azimuth", "elevation", "distance", "view",
        "projection", "fov", "near"])]
    camera: Option<PathBuf>,
}

/// Where the camera comes from.
pub(super) enum ViewSource {
    /// A strokes file.
    File(PathBuf),
    /// Options.
    View(View),
}

impl CameraArgs {
    /// The same with options that are not given taken from `base`, unless what is given rules them out.
    pub(super) fn or(self, base: &Self) -> Self {
        let has_angles = self.azimuth.is_some() || self.elevation.is_some();
        let (has_eye, has_view) = (self.eye.is_some(), self.view.is_some());
        Self {
            eye: self.eye.or(base.eye.filter(|_| !has_angles && !has_view)),
            target: self.target.or(base.target),
            up: self.up.or(base.up),
            azimuth: self.azimuth.or(base.azimuth),
            elevation: self.elevation.or(base.elevation),
            distance: self.distance.or(base.distance),
            view: self.view.or(base.view.filter(|_| !has_angles && !has_eye)),
            projection: self.projection.or(base.projection),
            fov: self.fov.or(base.fov),
            near: self.near.or(base.near),
            camera: None,
        }
    }

    /// The file that the camera is read from.
    pub(super) fn input(&self) -> Option<PathBuf> {
        self.camera.clone()
    }

    pub(super) fn view_source(self) -> ViewSource {
        if let Some(path) = self.camera {
            return ViewSource::File(path);
        }
        let standpoint = match (self.eye, self.view) {
            (Some(eye), _) => Standpoint::Eye(eye),
            (None, Some(view)) => Standpoint::Named { view, distance: self.distance },
            (None, None) => Standpoint::Angles {
                azimuth_deg: self.azimuth.unwrap_or(DEFAULT_AZIMUTH_DEG),
                elevation_deg: self.elevation.unwrap_or(DEFAULT_ELEVATION_DEG),
                distance: self.distance,
            },
        };
        ViewSource::View(View {
            standpoint,
            target: self.target,
            up: self.up,
            projection: self.projection,
            fov_deg: self.fov.unwrap_or(DEFAULT_FOV_DEG),
            near: self.near.unwrap_or(DEFAULT_NEAR),
        })
    }
}

impl ViewSource {
    /// The file that it is read from.
    pub(super) fn input(&self) -> Option<PathBuf> {
        match self {
            Self::File(path) => Some(path.clone()),
            Self::View(_) => None,
        }
    }

    /// What was requested, the camera of a file included.
    pub(super) fn framing(&self) -> Result<View, Box<dyn Error>> {
        match self {
            Self::File(path) => Ok(View::from(&read_camera(path)?)),
            Self::View(framing) => Ok(*framing),
        }
    }

    /// The camera, for a scene with these least and greatest coordinates.
    pub(super) fn camera(&self, bounds: (DVec3, DVec3)) -> Result<Camera, Box<dyn Error>> {
        match self {
            Self::File(path) => read_camera(path),
            Self::View(framing) => {
                framing.camera(bounds).map_err(|error| with_remedy(&error).into())
            }
        }
    }
}

/// An error about the point of view, with the options that mend it.
pub(super) fn with_remedy(error: &ViewError) -> String {
    let remedy = match error {
        ViewError::Camera(CameraError::UpParallel) => "; use another --up",
        ViewError::Camera(CameraError::NoDirection | CameraError::TooFarApart) => {
            "; use another --eye or --target"
        }
        _ => "",
    };
    format!("{error}{remedy}")
}

fn read_camera(path: &Path) -> Result<Camera, Box<dyn Error>> {
    let failed = |error: &dyn Error| format!("--camera {}: {error}", path.display());
    let mut bytes = Vec::new();
    if is_dash(path) {
        io::stdin().lock().read_to_end(&mut bytes).map_err(|error| failed(&error))?;
    } else {
        bytes = std::fs::read(path).map_err(|error| failed(&error))?;
    }
    // Bytes that are not text are not JSON either.
    let read = json::read_camera(&String::from_utf8_lossy(&bytes));
    Ok(read.map_err(|error| match error {
        ReadCameraError::Json(_) => {
            format!("{}; use a file written by --format json", failed(&error))
        }
        ReadCameraError::Camera(_) => failed(&error),
    })?)
}
