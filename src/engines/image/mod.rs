//! Image-space engines: which triangle each pixel of a picture shows.
//!
//! ```text
//!  scene, camera ─► raster: triangles in pixels, listed strip by strip
//!                     │
//!                     │    z_buffer   scan_line   spanning   watkins   ray_cast   painter
//!                     ├──► a strip of rows at a time, strips in parallel ──► items ─► preview
//!                     │
//!                     └──► a_buffer: 16 samples per pixel ► shares of each pixel ───► preview
//! ```
//!
//! | engine | keeps | decides | cost |
//! |---|---|---|---|
//! | [`z_buffer`] | a depth for each pixel of the strip | at every pixel of every triangle | pixels covered |
//! | [`scan_line`] | a depth for each pixel of one row | the same, row by row | pixels covered |
//! | [`spanning`] | edges and in/out flags | at both ends of every span | spans × triangles there |
//! | [`watkins`] | lists S, A, H | where an edge, real or artificial, is met | edges met |
//! | [`ray_cast`] | a tree of boxes | along one ray for each pixel | rays × log triangles |
//! | [`painter`] | nothing | by the order of the faces' fragments | pixels covered |
//! | [`a_buffer`] | fragments of each pixel | where fragments overlap | pixels covered × 4 |
//!
//! # The pixel rule
//!
//! All engines answer the same question, so all give the same picture:
//!
//! - A pixel shows what its *center* shows; the pixel in column `i` of row `j` has its center at
//!   (i + ½, j + ½), x to the right and y downward (see [`raster`]).
//! - A triangle covers a center when the ray from it to the left crosses the triangle's border an
//!   odd number of times. An edge that runs from `a` down to `b` is crossed when
//!   `a.y ≤ y < b.y` and the center is right of the edge or on it (see [`edge`]). So a center on a
//!   border that two triangles share belongs to exactly one of them: left and upper borders belong
//!   to the triangle, right and lower ones do not. Both conditions are decided exactly for the
//!   corners' rounded images. Triangles that are edge-on cover nothing.
//! - The nearest of the covering triangles is seen, by the depth of its plane at the center; at equal
//!   depths the one with the lowest number, so that of the lowest face (see [`depth`]).
//!
//! Each module says which coherence it uses: what it carries over from one pixel, row or face to the next.

pub mod depth;
pub mod edge;
pub mod raster;

mod active;

pub mod a_buffer;
pub mod painter;
pub mod ray_cast;
pub mod scan_line;
pub mod spanning;
pub mod watkins;
pub mod z_buffer;

use rayon::prelude::*;

pub use self::raster::{PixelMap, Raster, RowStrip};

/// The number of no triangle: the background.
pub const NOTHING: u32 = u32::MAX;

/// The image-space engines by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ImageEngine {
    /// A depth for each pixel: fast, whatever the scene.
    #[default]
    ZBuffer,
    /// The same with one row of memory.
    ScanLine,
    /// Rows in spans between edges.
    Spanning,
    /// Rows from edge to edge, with a list of triangles in order of depth.
    Watkins,
    /// One ray for each pixel.
    RayCast,
    /// Faces from far to near, each over the last; for pictures that [`painter::raster`] made.
    Painter,
}

impl ImageEngine {
    /// Every engine, in the order of the documentation.
    pub const ALL: [Self; 6] = [
        Self::ZBuffer,
        Self::ScanLine,
        Self::Spanning,
        Self::Watkins,
        Self::RayCast,
        Self::Painter,
    ];
}

/// The triangle that each pixel shows, row by row, or [`NOTHING`].
///
/// Keeps the whole picture; [`solve_strip`] does a part of it.
pub fn solve(raster: &Raster, engine: ImageEngine) -> Vec<u32> {
    let mut items = vec![NOTHING; raster.width() as usize * raster.height() as usize];
    solve_strips(raster, engine, 0, &mut items);
    items
}

/// Fills `items`, which are whole strips beginning with number `first`, in parallel.
pub fn solve_strips(raster: &Raster, engine: ImageEngine, first: usize, items: &mut [u32]) {
    let of_strip = raster.width() as usize * raster::STRIP_ROWS as usize;
    items.par_chunks_mut(of_strip.max(1)).enumerate().for_each(|(k, items)| {
        solve_strip(raster, &raster.strip(first + k), engine, items);
    });
}

/// Fills the `items` of one strip.
pub fn solve_strip(raster: &Raster, strip: &RowStrip, engine: ImageEngine, items: &mut [u32]) {
    items.fill(NOTHING);
    match engine {
        ImageEngine::ZBuffer => z_buffer::solve(raster, strip, items),
        ImageEngine::ScanLine => scan_line::solve(raster, strip, items),
        ImageEngine::Spanning => spanning::solve(raster, strip, items),
        ImageEngine::Watkins => watkins::solve(raster, strip, items),
        ImageEngine::RayCast => ray_cast::solve(raster, strip, items),
        ImageEngine::Painter => painter::solve(raster, strip, items),
    }
}
