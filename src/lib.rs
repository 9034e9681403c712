//! Exact hidden-line drawings of 3D models and surfaces, for print and pen plotters.
//!
//! ```text
//!  model files            formulas, height files
//!       │                          │
//!     read ─► mesh, arrange     formula, surface ──────────┐
//!                  │               │ (as a mesh)           │
//!                  ▼               ▼                       ▼
//!                scene ◄───────────┘                engines::surface
//!       topology, triangulate,                      horizons over a grid
//!           intersections, bends                           │
//!                  │                                       │
//!   view ──────► classify ─► engines::edge ─► visibility   │
//!   framing    faces, edges  what is hidden   spans of qi  │
//!      │                                           │       │
//!      ├───────► engines::face                   chain     │
//!      │         regions of faces                  ▼       ▼
//!      ▼               │                        strokes: polylines in the image
//!    light ─────────► fill                         │
//!                 colored areas ──────────────► page: placement on paper
//!                                                  ▼
//!  line SVG ─► line_svg ──────────────────────► plot: millimetres, a layer a pen
//!                                                  │
//!                                               optimize: joined, in short order
//!                                                  ▼
//!                                               writers ─► bytes
//! ```
//!
//! Beside it goes a quick way to a picture: [`engines::image`] says which face each pixel shows,
//! [`preview`] shades it.
//!
//! [`draw`] runs the stages from scene to strokes; [`predicates`] make every decision on the way.
//! To read the code, take the modules in the order below.
//!
//! # What is exact
//!
//! Vertices as read (`f64`) *are* the scene. Every decision — which side, in front or not, front
//! or back, the order of two cuts — is the sign of a polynomial in those numbers and is decided
//! exactly by [`predicates`]; nothing is compared against a tolerance. Only end points of visible
//! pieces and image coordinates are rounded, each once. Points where faces cross, which are no
//! vertices, enter decisions unrounded too.
//!
//! # Units and frames
//!
//! World: model units, right-handed, z up. Image: see [`view`]. Page: millimetres, see [`plot`].
//! Angles are in radians unless a name ends in `_deg`.

pub mod read;

pub mod formula;

pub mod surface;

pub mod mesh;

pub mod arrange;

pub mod topology;

pub mod triangulate;

pub mod predicates;

pub mod intersections;

pub mod bends;

pub mod scene;

pub mod view;

pub mod light;

pub mod classify;

pub mod framing;

pub mod visibility;

pub mod engines;

pub mod strokes;

pub mod dressing;

pub mod chain;

pub mod draw;

pub mod plot;

pub mod fill;

pub mod line_svg;

pub mod optimize;

pub mod page;

pub mod writers;

pub mod preview;

pub mod stats;
