//! The A-buffer: the share of each triangle in a pixel; anti-aliased, and transparent on request.
//!
//! ```text
//!   a pixel's 16 samples      a fragment: mask   · · · ·    front to back:
//!                             of the samples     ■ · · ·    ■ takes the samples that no
//!   ╲  B                      that a triangle    ■ ■ · ·    nearer fragment took, or with
//!   A╲                        covers             ■ ■ ■ ·    opacity α, the part α of them
//! ```
//!
//! The samples are the pixel centers of a picture with four times as many pixels along each side, so
//! they follow the same pixel rule. Each fragment knows the least and greatest nearness of its samples
//! (zmin, zmax), and fragments are taken front to back:
//!
//! * Two fragments that share no sample, or with disjoint depth ranges, have the same order in the whole
//!   pixel.
//! * For any other two, a *priority mask* P says in which of the shared samples the first one is nearer.
//!   They act on each other by `A' = A ∧ (¬B ∨ P)` and `B' = B ∧ ¬(A ∧ P)`: the higher mask is what a
//!   fragment keeps in front of the other, the lower mask what remains behind it.
//!
//! Carpenter estimates P from zmin and zmax, since he keeps no planes. Here the planes are known, so P is
//! exact, and opaque shares always equal a picture with 16 times the pixels. zmin and zmax still show when
//! no mask is needed. With glass, fragments behind are not dropped; they wait for their turn.
//!
//! Source: German notes, "A-Buffer"; lecture notes on visibility (Slovak), end of section 2.1: lists
//! of everything that covers a pixel, for transparency. Carpenter 1984.
//! Coherence: face coherence (one fragment stands for up to 16 samples) and depth coherence (zmin and
//! zmax order most fragments).
//! Good for: smooth borders, glass. Keeps the fragments of one strip.

use super::NOTHING;
use super::depth::Depth;
use super::raster::{Raster, RowStrip, columns};

/// Samples along each side of a pixel.
pub const SIDE: u32 = 4;

const SAMPLES: u32 = SIDE * SIDE;

/// Pixels with more fragments than this that may cross are sorted sample by sample: priority masks
/// cost the square of their number.
const MOST_MASKED: usize = 48;

/// The part of a pixel's light that comes from a triangle.
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
    let mut resolver =
        Resolver { fine, opacity, list: Vec::new(), lower: Vec::new(), shares: Vec::new() };
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
    /// For each fragment the priority masks of all others over it.
    lower: Vec<u16>,
    shares: Vec<Share>,
}

impl Resolver<'_> {
    fn shares(&mut self, column: u32, row: u32) -> &[Share] {
        self.shares.clear();
        self.list.sort_by(|a, b| b.nearest.cmp(&a.nearest).then(a.triangle.cmp(&b.triangle)));
        // How much light reaches each sample through the fragments in front so far.
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
        if self.list.len() > MOST_MASKED {
            self.sort_samples(column, row, &mut passing);
            return &self.shares;
        }
        self.lower.clear();
        for k in 0..self.list.len() {
            for j in 0..self.list.len() {
                let priority = self.in_front_of(j, k, (column, row));
                self.lower.push(priority);
            }
        }
        // In rounds: each fragment takes the samples where everything in front of it is done.
        let n = self.list.len();
        let mut left: Vec<u16> = self.list.iter().map(|fragment| fragment.mask).collect();
        while left.iter().any(|&mask| mask != 0) {
            let before = left.clone();
            for k in 0..n {
                let in_front = &self.lower[k * n..(k + 1) * n];
                let blocked = in_front.iter().zip(&before).fold(0, |all, (p, left)| all | p & left);
                let higher = before[k] & !blocked;
                left[k] &= !higher;
                self.take(self.list[k].triangle, higher, &mut passing);
            }
            if before == left {
                break;
            }
        }
        &self.shares
    }

    /// The same without masks: sorts the fragments of each sample.
    fn sort_samples(&mut self, column: u32, row: u32, passing: &mut [f64; SAMPLES as usize]) {
        for sample in 0..SAMPLES {
            let (x, y) = (column * SIDE + sample % SIDE, row * SIDE + sample / SIDE);
            let fine = self.fine;
            let depth = |f: &PixelFragment| fine.triangle(f.triangle).plane.at(x, y);
            let mask = 1 << sample;
            let mut here: Vec<PixelFragment> =
                self.list.iter().filter(|fragment| fragment.mask & mask != 0).copied().collect();
            here.sort_by(|a, b| depth(b).cmp(&depth(a)).then(a.triangle.cmp(&b.triangle)));
            for fragment in here {
                self.take(fragment.triangle, mask, passing);
                if passing[sample as usize] == 0.0 {
                    break;
                }
            }
        }
    }

    /// The priority mask of fragment `j` over fragment `k`: the samples of both in which `j` is nearer. At
    /// equal depths the lower number is nearer.
    fn in_front_of(&self, j: usize, k: usize, (column, row): (u32, u32)) -> u16 {
        let (a, b) = (&self.list[j], &self.list[k]);
        let common = a.mask & b.mask;
        if j == k || common == 0 {
            return 0;
        }
        // zmin and zmax settle it for all samples at once.
        if a.farthest > b.nearest {
            return common;
        }
        if b.farthest > a.nearest {
            return 0;
        }
        let [of_a, of_b] = [a, b].map(|fragment| self.fine.triangle(fragment.triangle).plane);
        let mut priority = 0;
        for sample in (0..SAMPLES).filter(|sample| common & 1 << sample != 0) {
            let (x, y) = (column * SIDE + sample % SIDE, row * SIDE + sample / SIDE);
            let (depth_a, depth_b) = (of_a.at(x, y), of_b.at(x, y));
            if depth_a > depth_b || depth_a == depth_b && a.triangle < b.triangle {
                priority |= 1 << sample;
            }
        }
        priority
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
