//! Exact hidden-line drawings of 3D models and surfaces, for print and pen plotters.
//!
//! ```no_run
//! use hiddenline::{DrawOptions, Paper, Scene, View};
//!
//! let scene = Scene::open("cow.obj")?;
//! let drawing = scene.draw(&View::isometric(), &DrawOptions::default());
//! drawing.on(Paper::A4)?.optimized().save("cow.svg")?;
//! # Ok::<(), hiddenline::Error>(())
//! ```
//!
//! A [`Scene`] is read once and drawn from any number of views. A [`Drawing`] goes onto paper, and the
//! resulting [`Sheet`] into a file: SVG, PDF, DXF, PNG, HPGL or G-code. The program `hiddenline` does the
//! same from the command line.
//!
//! Scenes come from files or from arrays in memory, and you can also get the strokes as points. Here azimuth
//! and elevation, in degrees, give the view:
//!
//! ```
//! use hiddenline::{DrawOptions, HiddenLines, Paper, Scene, View};
//! use hiddenline::glam::dvec3;
//!
//! let corners = [dvec3(0., 0., 0.), dvec3(1., 0., 0.), dvec3(0., 1., 0.), dvec3(0., 0., 1.)];
//! let scene = Scene::from_faces(&corners, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])?;
//! let lines = DrawOptions::default().hidden(HiddenLines::Dashed);
//! let (strokes, page) = scene.draw(&View::from_angles(30., 25.), &lines).strokes(Paper::A4)?;
//! for stroke in strokes.iter() {
//!     let mm = stroke.points.iter().map(|&p| page.page_from_image.transform_point2(p));
//!     println!("{} {:?}", stroke.kind.name(), mm.collect::<Vec<_>>());
//! }
//! # Ok::<(), hiddenline::Error>(())
//! ```
//!
//! Models are z up by default. Hatch lines shade a drawing, with exact shadows:
//!
//! ```
//! use hiddenline::{DrawOptions, Ground, HatchOptions, Paper, Scene, UpAxis, View};
//!
//! let spot = Scene::builder().up_axis(UpAxis::Y).open("examples/models/spot.obj")?.build()?;
//! let drawing = spot.draw(&View::from_angles(215.0, 25.0), &DrawOptions::default());
//! let hatching = HatchOptions::default().ground(Ground::Lowest);
//! # if false {
//! drawing.hatched(hatching).on(Paper::A4)?.optimized().save("spot.svg")?;
//! # }
//! # Ok::<(), hiddenline::Error>(())
//! ```
//!
//! Many views of one scene are drawn in parallel:
//!
//! ```
//! use hiddenline::{DrawOptions, Paper, Scene, View};
//!
//! let scene = Scene::open("examples/models/benchy_wheel.stl")?;
//! let views = [View::front(), View::right(), View::isometric()];
//! let sheets = scene.draw_views(&views, &DrawOptions::default(), Paper::A4)?;
//! for (n, sheet) in sheets.iter().enumerate() {
//!     # if false {
//!     sheet.save(format!("wheel-{n}.svg"))?;
//!     # }
//! }
//! # Ok::<(), hiddenline::Error>(())
//! ```
//!
//! A [`Surface`], either z = f(x, y) or parametric in space, is drawn in the same way from a formula, a
//! function, a file of heights, or points:
//!
//! ```
//! use hiddenline::{Paper, Surface, SurfaceLines, View};
//!
//! let hat = Surface::formula("sinc(r)")?.x(-12.0, 12.0).y(-12.0, 12.0);
//! let drawing = hat.draw(&View::from_angles(-60.0, 28.0), &SurfaceLines::default());
//! # if false {
//! drawing.on(Paper::A4)?.optimized().save("hat.svg")?;
//! # }
//! # Ok::<(), hiddenline::Error>(())
//! ```
//!
//! # How it works
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
//!       │                          ▼        │
//!       │                       drafting: the lines a drafter would draw
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
//! `draw` runs the stages from a scene to strokes, and `draw::surface` those from a surface. The page is
//! placed first: it needs only the `extent` of the drawing, so lengths on paper are known before any line is
//! chosen. `predicates` makes every decision along the way. `engines::image` finds the face that each pixel
//! shows; `shading::preview` shades it. `hatch` cuts the faces with families of planes and asks
//! `engines::edge` twice about each segment: from the eye, and from the light. To read the code, follow the
//! order of `stages` in `src/lib.rs`: no module uses a later one, and files do not depend on each other in a
//! circle. `cargo test --test it laws::layers` checks that.
//!
//! # What is exact
//!
//! Vertices as read (`f64`) *are* the scene. Every decision (which side, in front or behind, front or back
//! face, the order of two cuts) is the sign of a polynomial in those numbers and is decided exactly by
//! `predicates`; nothing is compared against a tolerance. Only endpoints of visible pieces and image
//! coordinates are rounded, each once. Points where faces cross are not vertices, but decisions use them
//! unrounded as well.
//!
//! # Features
//!
//! All features are on by default, for the program. A library that only draws can turn them off with
//! `default-features = false`: OBJ, STL and OFF can always be read, and SVG and DXF written.
//!
//! | feature | adds |
//! |---|---|
//! | `3mf`, `gltf`, `ply` | model files of these formats |
//! | `npz`, `tiff`, `png` | height files of these formats; `png` also writes PNG and shades previews |
//! | `points` | surfaces through scattered points |
//! | `pdf`, `json` | output of these formats |
//! | `plotters` | HPGL and G-code, for machines described in TOML |
//! | `svg-in` | reading line drawings from SVG, to optimize them |
//! | `cli`, `view` | the program, and its viewer in the browser |
//!
//! # Units and frames
//!
//! World: model units, right-handed, z up. Image: see `camera`. Page: millimeters, see `plot`.
//! Angles are in radians unless a name ends in `_deg`.

/// The stages, in the order of the data flow. They are for the program and the tests of this crate, and may
/// change at any time.
#[doc(hidden)]
#[path = ""]
pub mod stages {
    pub mod timing;

    pub mod camera;

    pub mod predicates;

    pub mod extent;

    pub mod disjoint_sets;

    pub mod groups;

    pub mod links;

    pub mod model;

    pub mod read;

    pub mod strokes;

    pub mod classify;

    pub mod surface;

    pub mod engines;

    pub mod chain;

    pub mod drafting;

    pub mod axes;

    pub mod plot;

    pub mod page;

    pub mod draw;

    pub mod shading;

    pub mod hatch;

    pub mod optimize;

    #[cfg(feature = "svg-in")]
    pub mod read_svg;

    pub mod write;

    pub mod api;
}

use stages::{
    api, axes, camera, chain, classify, disjoint_sets, drafting, draw, engines, extent, groups,
    hatch, links, model, optimize, page, plot, predicates, read, shading, strokes, surface, timing,
    write,
};

// Points and vectors, as this crate uses them.
pub use glam;

// A scene.
pub use api::{Error, SceneBuilder};
pub use model::arrange::UpAxis;
pub use model::mesh::{Mesh, PolygonSoup};
pub use model::scene::Scene;
pub use model::smooth::SmoothParts;
pub use read::{ModelFormat, Warning};

// A surface.
pub use axes::{Axes, AxesStyle, BoxFront, LegendPlace, TickRule, Titles, ZAxis};
pub use draw::surface::{
    Certificate, LabelSide, Labels, Legend, Levels, SurfaceEngine, SurfaceLines, SurfaceNote,
};
pub use engines::surface::CellOrder;
pub use surface::formula::{Formula, Parameter, ParameterList, Variables};
pub use surface::{
    Aspect, FormulaSheet, Grid, HeightField, HeightOptions, Outside, SampledSurface, Surface,
};

// A view of it.
pub use camera::Camera;
pub use camera::framing::{NamedView, ProjectionKind, Standpoint, View};

// The lines.
pub use api::{Drawing, SurfaceDrawing};
pub use classify::LineSelection;
pub use draw::DrawOptions;
pub use engines::edge::LineEngine;
pub use engines::face::FaceEngine;
pub use hatch::{Ground, HatchLevels, HatchMaterial, HatchMethod, HatchOptions, HatchShadows};
pub use shading::fill::{FillOptions, Palette};
pub use shading::light::LightSource;
pub use strokes::{GridFamily, HiddenLines, Stroke, StrokeKind, Strokes, SurfacePart};

// The paper.
pub use api::Sheet;
pub use page::{Dash, Orientation, Page, PageOptions, Paper, PenRole, PenRule, Placement};
pub use plot::{Layer, Pen, Plot, Polylines};

// The plotter.
pub use optimize::{Effort, OptimizeOptions};
pub use write::{Format, Target};

/// The errors inside each kind of [`Error`].
pub mod errors {
    pub use crate::camera::framing::ViewError;
    pub use crate::draw::surface::SurfaceError;
    pub use crate::hatch::HatchError;
    pub use crate::model::mesh::MeshError;
    pub use crate::page::PageError;
    pub use crate::read::ReadError;
    pub use crate::shading::fill::FillError;
    #[cfg(feature = "points")]
    pub use crate::surface::PointsError;
    pub use crate::surface::formula::{FormulaError, ParameterError};
    pub use crate::surface::{FamilyError, GridError, HeightError};
    pub use crate::write::WriteError;
}
