//! Where pictures are seen from.

use hiddenline::camera::framing::{Framing, Standpoint};

/// Seen from an azimuth and an elevation in degrees.
pub(crate) fn seen_from(azimuth_deg: f64, elevation_deg: f64) -> Framing {
    Framing {
        standpoint: Standpoint::Angles { azimuth_deg, elevation_deg, distance: None },
        ..Framing::default()
    }
}
