//! Hidden-line and visible-surface algorithms.
//!
//! | family | from | to |
//! |---|---|---|
//! | [`edge`] | a viewed scene | spans of quantitative invisibility along its edges |
//! | [`face`] | a scene and a camera | polygons: the visible region of each face |
//! | [`image`] | the triangles in pixels | the triangle that each pixel shows |
//! | [`surface`] | a grid of heights | visible pieces of its grid lines |

pub mod visibility;

pub mod edge;

pub mod face;

pub mod image;

pub mod surface;
