//! Function surfaces: engines against brute force and closed forms.

mod brute;
mod max_min;
