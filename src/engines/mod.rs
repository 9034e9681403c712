//! The algorithms that decide what is hidden.
//!
//! | family | from | to |
//! |---|---|---|
//! | [`edge`] | a viewed scene | spans of quantitative invisibility along its edges |
//! | [`image`] | the triangles in pixels | the triangle that each pixel shows |
//! | [`surface`] | a grid of heights | visible pieces of its grid lines |

pub mod edge;

pub mod image;

pub mod surface;
