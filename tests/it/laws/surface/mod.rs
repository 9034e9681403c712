//! Function surfaces: engines against brute force and closed forms.

mod brute;
mod floating_horizon;
mod max_min;
mod meshed;
mod pen_path;
mod tin;
