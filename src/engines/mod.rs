//! The algorithms that decide what is hidden.
//!
//! | family | from | to |
//! |---|---|---|
//! | [`edge`] | a viewed scene | spans of quantitative invisibility along its edges |
//! | [`surface`] | a grid of heights | visible pieces of its grid lines |

pub mod edge;

pub mod surface;
