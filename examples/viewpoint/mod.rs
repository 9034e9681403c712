//! Where pictures are seen from.

use hiddenline::stages::camera::framing::{Standpoint, View};

/// Seen from an azimuth and an elevation in degrees.
pub(crate) fn seen_from(azimuth_deg: f64, elevation_deg: f64) -> View {
    View {
        standpoint: Standpoint::Angles { azimuth_deg, elevation_deg, distance: None },
        ..View::default()
    }
}
