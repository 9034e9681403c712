//! The front door: a scene, a view of it, a drawing, a sheet of paper, a file.
//!
//! ```text
//!   Scene ──── draw(&view, &lines) ─► Drawing ────────┬─ on(paper) ─► Sheet ── save(path) ─► file
//!   Surface ── draw(&view, &lines) ─► SurfaceDrawing ─┤                │
//!                                                     └─ strokes(paper)└─ optimized()
//! ```

mod drawing;
mod error;
mod models;
mod sheet;
mod surfaces;

pub use self::drawing::Drawing;
pub use self::error::Error;
pub use self::models::SceneBuilder;
pub use self::sheet::Sheet;
pub use self::surfaces::SurfaceDrawing;
