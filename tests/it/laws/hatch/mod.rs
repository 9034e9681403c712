//! Hatching against brute force in exact numbers, and against closed forms.

mod closed_forms;
mod outlines;
mod truth;
