//! Strokes as JSON, in image coordinates, for tests, scripts and other tools.
//!
//! Every number reads back as exactly the same `f64`. The camera can be read back with
//! [`read_camera`].

use std::io;

use glam::{DAffine2, DVec3};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::camera::{Camera, CameraError, DEFAULT_FOV_DEG, DEFAULT_NEAR, Projection};
use crate::strokes::{Stroke, Strokes};

/// The value of `format`.
const FORMAT: &str = "hiddenline-strokes";

/// The value of `version`.
const VERSION: u32 = 1;

/// All but the strokes.
#[derive(Serialize)]
struct JsonStroke {
    format: &'static str,
    version: u32,
    camera: CameraRecord,
    page_from_image: [f64; 6],
}

#[derive(Serialize, Deserialize)]
struct CameraRecord {
    projection: JsonProjection,
    eye: [f64; 3],
    target: [f64; 3],
    up: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    fov: Option<f64>,
    near: Option<f64>,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum JsonProjection {
    Perspective,
    Orthographic,
}

#[derive(Serialize)]
struct StrokeRecord<'a> {
    kind: &'static str,
    visible: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    qi: Option<u32>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    outline: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    side: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    lit: Option<bool>,
    #[serde(serialize_with = "serialize_points")]
    points: &'a [glam::DVec2],
}

fn serialize_points<S: serde::Serializer>(
    points: &[glam::DVec2],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(points.iter().map(|p| p.to_array()))
}

/// Writes a drawing, one stroke a line.
///
/// `page_from_image` is written as the six numbers of SVG's `matrix(a b c d e f)`. O(points).
///
/// # Errors
/// Those of `out`.
pub fn write(
    drawing: &Strokes,
    camera: &Camera,
    page_from_image: DAffine2,
    out: &mut dyn io::Write,
) -> io::Result<()> {
    let head = JsonStroke {
        format: FORMAT,
        version: VERSION,
        camera: CameraRecord::from(camera),
        page_from_image: page_from_image.to_cols_array(),
    };
    // The strokes are the last member of the object that the head begins: they are written one by
    // one, since all of them together would take as much memory again.
    let head = serde_json::to_string(&head)?;
    let opened = head.strip_suffix('}').unwrap_or(&head);
    write!(out, "{opened},\"strokes\":[")?;
    for (i, stroke) in drawing.iter().enumerate() {
        out.write_all(if i == 0 { b"\n" } else { b",\n" })?;
        serde_json::to_writer(&mut *out, &StrokeRecord::from(stroke))?;
    }
    writeln!(out, "\n]}}")
}

impl<'a> From<Stroke<'a>> for StrokeRecord<'a> {
    fn from(stroke: Stroke<'a>) -> Self {
        let visible = stroke.qi == 0;
        let qi = (!visible).then_some(stroke.qi);
        let (kind, outline) = (stroke.kind.name(), stroke.outline);
        let side = stroke.underside.then_some("lower");
        Self { kind, visible, qi, outline, side, lit: stroke.lit, points: stroke.points }
    }
}

impl From<&Camera> for CameraRecord {
    fn from(camera: &Camera) -> Self {
        let (projection, fov, near) = match camera.projection() {
            Projection::Perspective { fov_deg, near } => {
                (JsonProjection::Perspective, Some(fov_deg), near)
            }
            Projection::Orthographic => (JsonProjection::Orthographic, None, DEFAULT_NEAR),
        };
        Self {
            projection,
            eye: camera.eye().to_array(),
            target: camera.target().to_array(),
            up: camera.up().to_array(),
            fov,
            near: Some(near),
        }
    }
}

/// Why a camera cannot be read from a text.
#[derive(Debug, Error)]
pub enum ReadCameraError {
    /// It is not JSON, or not a strokes file.
    #[error("this is not a file of strokes as JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The numbers are not a valid camera.
    #[error(transparent)]
    Camera(#[from] CameraError),
}

/// Reads the camera of a strokes file; its strokes are skipped.
///
/// # Errors
/// See [`ReadCameraError`].
pub fn read_camera(text: &str) -> Result<Camera, ReadCameraError> {
    #[derive(Deserialize)]
    struct JsonDrawing {
        camera: CameraRecord,
    }
    let record = serde_json::from_str::<JsonDrawing>(text)?.camera;
    let projection = match record.projection {
        JsonProjection::Perspective => Projection::Perspective {
            fov_deg: record.fov.unwrap_or(DEFAULT_FOV_DEG),
            near: record.near.unwrap_or(DEFAULT_NEAR),
        },
        JsonProjection::Orthographic => Projection::Orthographic,
    };
    let point = DVec3::from_array;
    Ok(Camera::new(point(record.eye), point(record.target), point(record.up), projection)?)
}
