//! The algorithms that decide what is hidden.
//!
//! | family | from | to |
//! |---|---|---|
//! | [`edge`] | a viewed scene | spans of quantitative invisibility along its edges |

pub mod edge;
//! The engines: what is visible, each method in a file of its own.

pub mod surface;
