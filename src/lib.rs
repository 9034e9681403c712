//! Exact hidden-line drawings of 3D models and surfaces, for print and pen plotters.
//!
//! ```text
//!  model files           formulas, height files
//!       │                        │
//!     read                    surface ─────────────┐
//!       ▼                        │ (as a mesh)     ▼
//!     model ◄────────────────────┘          engines::surface
//!       scene: mesh, topology,              horizons over a grid
//!       triangles, intersections, wires            │
//!       │                                          │ visible pieces
//!  camera ─► extent: the box of the image ──┐      │ of grid lines
//!       │                                   │      │
//!       ├─► classify ─► engines::edge       │      │
//!       │   faces,      spans of            │      │
//!       │   lines       quantitative        │      │
//!       │               invisibility        │      │
//!       │                    └──► chain ◄───┼──────┘
//!       ├─► engines::face          ▼        │
//!       │   visible areas  strokes: polylines in the image ◄─ axes
//!       ▼        │                 │        │
//!    shading ────┘                 ▼        ▼
//!    fill, preview ──────────────► page: placed on paper
//!                                  ▼
//!  line SVG ─► read_svg ────────► plot: millimeters, one layer per pen
//!                                  │
//!                               optimize: joined and ordered
//!                                  ▼
//!                               write ─► bytes
//! ```
//!
//! [`draw`] runs the stages from scene to strokes. The page is placed first: it needs only the
//! [`extent`] of the scene, so lengths on paper are known before any line is chosen. [`predicates`]
//! make every decision on the way. [`engines::image`] finds the face that each pixel shows;
//! [`shading::preview`] shades it. To read the code, take the modules in the order below: no module
//! uses a later one.
//!
//! # What is exact
//!
//! Vertices as read (`f64`) *are* the scene. Every decision — which side, in front or not, front
//! or back, the order of two cuts — is the sign of a polynomial in those numbers and is decided
//! exactly by [`predicates`]; nothing is compared against a tolerance. Only end points of visible
//! pieces and image coordinates are rounded, each once. Points where faces cross are not vertices, but
//! they enter decisions unrounded too.
//!
//! # Units and frames
//!
//! World: model units, right-handed, z up. Image: see [`camera`]. Page: millimeters, see [`plot`].
//! Angles are in radians unless a name ends in `_deg`.

pub mod timing;

pub mod camera;

pub mod predicates;

pub mod extent;

pub mod model;

pub mod read;

pub mod strokes;

pub mod classify;

pub mod surface;

pub mod engines;

pub mod chain;

pub mod axes;

pub mod draw;

pub mod plot;

pub mod shading;

pub mod page;

pub mod optimize;

#[cfg(feature = "svg-in")]
pub mod read_svg;

pub mod write;
