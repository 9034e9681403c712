//! The A-buffer: what share each triangle has in a pixel; anti-aliased, and transparent if wanted.
//!
//! ```text
//!   a pixel's 16 samples      a fragment: mask   · · · ·    front to back:
//!                             of the samples     ■ · · ·    ■ takes what no nearer
//!   ╲  B                      that a triangle    ■ ■ · ·    fragment has taken, or,
//!   A╲                        covers             ■ ■ ■ ·    with opacity α, α of it
//! ```
//!
//! The samples are the pixel centers of a picture with four times as many pixels along each side, so
//! they follow the same pixel rule. Each fragment knows the least and greatest nearness of its samples
//! (zmin, zmax). Fragments of which none begins before another ends, or which share no sample, are in
//! the same order all over the pixel: masks say it all. Else faces may cross within the pixel, and
//! each sample sorts its fragments by depth. (Carpenter estimates a share from zmin and zmax there;
//! the planes are still at hand here, so nothing need be estimated, and opaque shares always
//! equal a picture with 16 times the pixels.)
//!
//! Source: German notes, "A-Buffer"; lecture notes on visibility (Slovak), end of section 2.1: lists
//! of all that covers a pixel, for transparency. Carpenter 1984.
//! Good for: smooth borders, glass. Keeps the fragments of one strip.

use super::NOTHING;
use super::depth::Depth;
use super::raster::{Raster, RowStrip, columns};

/// Samples along each side of a pixel.
pub const SIDE: u32 = 4;

const SAMPLES: u32 = SIDE * SIDE;

/// What part of a pixel's light comes from a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// Number in the raster.
    pub triangle: u32,
    /// From 0 to 1; the rest, up to 1, is background.
    pub weight: f64,
}

/// The part of a triangle in a pixel.
#[derive(Clone, Copy)]
struct PixelFragment {
    triangle: u32,
    /// Bit `4 · row + column` for each sample covered.
    mask: u16,
    farthest: Depth,
    nearest: Depth,
    /// The next fragment of the pixel.
    next: u32,
}

/// Calls `pixel` for each pixel of a strip, row by row, with the shares in it.
///
/// `fine` is the picture with [`SIDE`] times as many pixels along each side, see [`finer`](super::PixelMap::finer);
/// `strip` is one of its strips. Every triangle lets 1 − `opacity` of the light behind it pass.
/// O(samples covered + fragments log fragments).
pub fn solve(fine: &Raster, strip: &RowStrip, opacity: f64, mut pixel: impl FnMut(&[Share])) {
    let width = fine.width() / SIDE;
    let rows = strip.rows.start / SIDE..strip.rows.end / SIDE;
    let mut heads = vec![NOTHING; (width * rows.len() as u32) as usize];
    let mut fragments: Vec<PixelFragment> = Vec::new();
    for &number in strip.triangles {
        collect(fine, strip, number, width, &mut heads, &mut fragments);
    }
    let mut resolver = Resolver { fine, opacity, list: Vec::new(), shares: Vec::new() };
    for row in rows.clone() {
        for column in 0..width {
            resolver.list.clear();
            let mut at = heads[((row - rows.start) * width + column) as usize];
            while let Some(fragment) = fragments.get(at as usize) {
                resolver.list.push(*fragment);
                at = fragment.next;
            }
            pixel(resolver.shares(column, row));
        }
    }
}

/// Adds the fragments of a triangle.
fn collect(
    fine: &Raster,
    strip: &RowStrip,
    number: u32,
    width: u32,
    heads: &mut [u32],
    fragments: &mut Vec<PixelFragment>,
) {
    let triangle = fine.triangle(number);
    let edges = triangle.edges();
    let rows = triangle.rows(&strip.rows);
    if rows.is_empty() {
        return;
    }
    for row in rows.start / SIDE..rows.end.div_ceil(SIDE) {
        let parts: [_; SIDE as usize] =
            std::array::from_fn(|k| columns(&edges, row * SIDE + k as u32, fine.width()));
        let filled = parts.iter().filter(|part| !part.is_empty());
        let (from, to) = filled.fold((u32::MAX, 0), |(from, to), part| {
            (from.min(part.start / SIDE), to.max(part.end.div_ceil(SIDE)))
        });
        for column in from.min(to)..to {
            let mut fragment = PixelFragment {
                triangle: number,
                mask: 0,
                farthest: Depth::NEAREST,
                nearest: Depth::default(),
                next: NOTHING,
            };
            for sample in 0..SAMPLES {
                let (x, y) = (column * SIDE + sample % SIDE, sample / SIDE);
                if parts[y as usize].contains(&x) {
                    let depth = triangle.plane.at(x, row * SIDE + y);
                    fragment.mask |= 1 << sample;
                    fragment.farthest = fragment.farthest.min(depth);
                    fragment.nearest = fragment.nearest.max(depth);
                }
            }
            if fragment.mask != 0 {
                let pixel = ((row - strip.rows.start / SIDE) * width + column) as usize;
                fragment.next = heads[pixel];
                heads[pixel] = fragments.len() as u32;
                fragments.push(fragment);
            }
        }
    }
}

struct Resolver<'a> {
    fine: &'a Raster,
    opacity: f64,
    /// The fragments of the pixel.
    list: Vec<PixelFragment>,
    shares: Vec<Share>,
}

impl Resolver<'_> {
    fn shares(&mut self, column: u32, row: u32) -> &[Share] {
        self.shares.clear();
        self.list.sort_by(|a, b| b.nearest.cmp(&a.nearest).then(a.triangle.cmp(&b.triangle)));
        // How much of the light each sample lets through what is in front so far.
        let mut passing = [1.0; SAMPLES as usize];
        if !self.may_cross() {
            for k in 0..self.list.len() {
                let PixelFragment { triangle, mask, .. } = self.list[k];
                self.take(triangle, mask, &mut passing);
                if passing.iter().all(|&passing| passing == 0.0) {
                    break;
                }
            }
            return &self.shares;
        }
        for sample in 0..SAMPLES {
            let (x, y) = (column * SIDE + sample % SIDE, row * SIDE + sample / SIDE);
            let fine = self.fine;
            let depth = |fragment: &PixelFragment| fine.triangle(fragment.triangle).plane.at(x, y);
            let mask = 1 << sample;
            let mut here: Vec<PixelFragment> =
                self.list.iter().filter(|fragment| fragment.mask & mask != 0).copied().collect();
            here.sort_by(|a, b| depth(b).cmp(&depth(a)).then(a.triangle.cmp(&b.triangle)));
            for fragment in here {
                self.take(fragment.triangle, mask, &mut passing);
                if passing[sample as usize] == 0.0 {
                    break;
                }
            }
        }
        &self.shares
    }

    /// Whether the order of two fragments may differ from sample to sample.
    fn may_cross(&self) -> bool {
        let mut before: u16 = 0;
        let mut farthest = Depth::NEAREST;
        self.list.iter().any(|fragment| {
            let overlaps = before & fragment.mask != 0 && fragment.nearest >= farthest;
            before |= fragment.mask;
            farthest = farthest.min(fragment.farthest);
            overlaps
        })
    }

    /// Gives a triangle its part of the light of the samples.
    fn take(&mut self, triangle: u32, mask: u16, passing: &mut [f64; SAMPLES as usize]) {
        let mut weight = 0.0;
        for (sample, passing) in passing.iter_mut().enumerate() {
            if mask & 1 << sample != 0 {
                weight += *passing * self.opacity;
                *passing *= 1.0 - self.opacity;
            }
        }
        if weight > 0.0 {
            self.shares.push(Share { triangle, weight: weight / f64::from(SAMPLES) });
        }
    }
}
