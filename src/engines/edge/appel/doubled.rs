//! Drawn edges that may have the same image over some length.
//!
//! Edges on one line of the image have the same angle and the same distance from a center. Both are divided
//! into narrow bins, each edge goes into all bins it may belong to, and edges in one bin whose boxes
//! overlap are candidate pairs. Very short edges, whose angle means little, are found by position instead.
//! Nothing is decided here: candidates may turn out to be none.

use super::super::index::{ImageIndex, Visitor};
use super::super::rounding::{Place, Rounding};
use super::super::segment::Segment;
use super::box_join::grouped;
use crate::classify::ViewedScene;
use crate::groups::Groups;
use crate::predicates::Sign;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Bins over half a turn and over the width of the image. Many, so that edges that are not on one
/// line rarely meet in a bin.
const BINS: f64 = (1 << 22) as f64;

/// Edges whose angle or distance is less certain than this part of a bin are looked up by place.
const WIDEST: f64 = 0.5;

/// Angle and distance of an edge's line in bins, with what they may be off.
struct Line {
    angle: f64,
    distance: f64,
    angle_error: f64,
    distance_error: f64,
}

impl Line {
    fn new(segment: &Segment, rounding: &Rounding, center: DVec2, radius: f64) -> Option<Self> {
        let [a, b] = segment.image.map(|point| point - center);
        let size = segment.image.iter().map(|p| p.abs().element_sum()).fold(0.0, f64::max);
        let error = 4.0 * rounding.image_error(size);
        let (direction, length) = (b - a, (b - a).length());
        // Half a turn makes the same line.
        let turned = direction.y < 0.0 || (direction.y == 0.0 && direction.x < 0.0);
        let direction = if turned { -direction } else { direction } / length;
        let angle_error = 2.0 * error / length;
        let reach = a.length().max(b.length());
        let line = Self {
            angle: libm::atan2(direction.y, direction.x) / PI * BINS,
            distance: direction.perp_dot(a) / (2.0 * radius) * BINS,
            angle_error: angle_error / PI * BINS + BINS * 8.0 * f64::EPSILON,
            distance_error: (error + 2.0 * angle_error * reach) / (2.0 * radius) * BINS
                + BINS * 8.0 * f64::EPSILON,
        };
        (line.angle_error < WIDEST && line.distance_error < WIDEST).then_some(line)
    }

    /// Calls `f` with each bin that the line may be in.
    fn for_bins(&self, mut f: impl FnMut(u64)) {
        let mut put = |angle: f64, distance: f64| {
            let range =
                |x: f64, error: f64| (x - error).floor() as i64..=(x + error).floor() as i64;
            for i in range(angle, self.angle_error) {
                for j in range(distance, self.distance_error) {
                    f((i as u64) << 32 | u64::from(j as u32));
                }
            }
        };
        put(self.angle, self.distance);
        // Beyond half a turn the same lines follow, with distances on the other side.
        if self.angle - self.angle_error < 0.0 {
            put(self.angle + BINS, -self.distance);
        }
        if self.angle + self.angle_error >= BINS {
            put(self.angle - BINS, -self.distance);
        }
    }
}

/// For each of `segments` those that may be on the same line of the image. Expected O(n log n); in
/// parallel.
pub(super) fn partners(
    view: &ViewedScene,
    rounding: &Rounding,
    segments: &[Option<Segment>],
) -> Groups {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for point in segments.iter().flatten().flat_map(|segment| segment.image) {
        (low, high) = (low.min(point), high.max(point));
    }
    let center = 0.5 * (low + high);
    let radius = (high - low).length().max(f64::MIN_POSITIVE);

    let mut filled = Filter::new(segments.len());
    let mut loose = Vec::new();
    let lines: Vec<Option<Line>> = segments
        .par_iter()
        .map(|segment| Line::new(segment.as_ref()?, rounding, center, radius))
        .collect();
    for (i, line) in lines.iter().enumerate() {
        match line {
            Some(line) => line.for_bins(|bin| filled.add(bin)),
            None if segments[i].is_some() => loose.push(i as u32),
            None => {}
        }
    }
    let mut members: Vec<(u64, u32)> = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let Some(line) = line else { continue };
        line.for_bins(|bin| {
            if filled.has_several(bin) {
                members.push((bin, i as u32));
            }
        });
    }
    members.par_sort_unstable();
    let bins: Vec<&[(u64, u32)]> = members.chunk_by(|a, b| a.0 == b.0).collect();
    let mut pairs: Vec<(u32, u32)> = bins
        .par_iter()
        .filter(|bin| bin.len() > 1)
        .flat_map_iter(|bin| pairs_in_bin(view, segments, rounding, bin))
        .collect();
    pairs.extend(pairs_by_place(view, rounding, segments, &loose));
    pairs.par_sort_unstable();
    pairs.dedup();
    grouped(segments.len(), pairs)
}

/// Which bins hold several edges, by a hash; now and then it says so of one with a single edge.
struct Filter {
    counts: Vec<u8>,
    shift: u32,
}

impl Filter {
    fn new(n: usize) -> Self {
        let bits = (8 * n.max(1)).next_power_of_two().trailing_zeros();
        Self { counts: vec![0; 1 << bits], shift: 64 - bits }
    }

    fn slot(&self, bin: u64) -> usize {
        // Fibonacci hashing: the high bits of a product with 2^64 over the golden ratio.
        ((bin ^ bin >> 29).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> self.shift) as usize
    }

    fn add(&mut self, bin: u64) {
        let slot = self.slot(bin);
        self.counts[slot] = self.counts[slot].saturating_add(1);
    }

    fn has_several(&self, bin: u64) -> bool {
        self.counts[self.slot(bin)] > 1
    }
}

/// Both orders of each pair in a bin that shares a part of a line.
fn pairs_in_bin(
    view: &ViewedScene,
    segments: &[Option<Segment>],
    rounding: &Rounding,
    bin: &[(u64, u32)],
) -> Vec<(u32, u32)> {
    let members: Vec<(u32, &Segment)> =
        bin.iter().filter_map(|&(_, i)| segments[i as usize].as_ref().map(|s| (i, s))).collect();
    let extent =
        members.iter().map(|(_, s)| (s.image[1] - s.image[0]).abs()).fold(DVec2::ZERO, DVec2::max);
    let axis = usize::from(extent.y > extent.x);
    let mut spans: Vec<(f64, f64, u32, &Segment)> = members
        .into_iter()
        .map(|(i, s)| {
            let [a, b] = s.image.map(|p| p[axis]);
            let size = s.image.iter().map(|p| p.abs().element_sum()).fold(0.0, f64::max);
            let error = rounding.image_error(size);
            (a.min(b) - error, a.max(b) + error, i, s)
        })
        .collect();
    spans.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
    let mut pairs = Vec::new();
    for (n, &(_, end, i, first)) in spans.iter().enumerate() {
        for &(_, _, j, second) in spans[n + 1..].iter().take_while(|span| span.0 <= end) {
            if !run_apart(first, second) && are_in_line(view, first, second) {
                pairs.extend([(i, j), (j, i)]);
            }
        }
    }
    pairs
}

/// Pairs with an edge of `loose`, found by their boxes in the image.
fn pairs_by_place(
    view: &ViewedScene,
    rounding: &Rounding,
    segments: &[Option<Segment>],
    loose: &[u32],
) -> Vec<(u32, u32)> {
    let mut pairs = Vec::new();
    if loose.is_empty() {
        return pairs;
    }
    let wanted = loose.iter().filter_map(|&i| segments[i as usize].as_ref());
    let index = ImageIndex::of_items(view, wanted, segments.len(), None, |i| {
        segments[i as usize].as_ref().map_or(Place::Nowhere, |segment| {
            let bounds = rounding.bounds(segment.image, segment.depth);
            Place::Within(bounds.with_all_nearer().reaching(f64::INFINITY))
        })
    });
    let mut visitor = Visitor::new(Some(&index));
    for &i in loose {
        let Some(segment) = &segments[i as usize] else { continue };
        let bounds = index.bounds_of(segment);
        // Clipped by the near plane or not, an edge goes through all of its points.
        let corners = |_| [];
        visitor.any_within(&index, view, segment, &bounds, corners, |j| {
            if j != i
                && let Some(other) = &segments[j as usize]
                && are_in_line(view, segment, other)
            {
                pairs.extend([(i, j), (j, i)]);
            }
            false
        });
    }
    pairs
}

/// Whether two edges certainly share one end only and leave it to opposite sides.
fn run_apart(first: &Segment, second: &Segment) -> bool {
    (0..2).any(|i| {
        (0..2).any(|j| {
            let [a, b] = [first.image[i], first.image[1 - i]];
            let [p, q] = [second.image[j], second.image[1 - j]];
            let (out, other) = (b - a, q - p);
            // On one line, two long arms with a right angle between them at most is out of the
            // question, so the sign of a product of this size is beyond doubt.
            first.ends[i] == second.ends[j] && out.dot(other) < -0.5 * out.length() * other.length()
        })
    })
}

/// Whether the lines through two edges have one image, exactly.
fn are_in_line(view: &ViewedScene, first: &Segment, second: &Segment) -> bool {
    let ([a, b], sight) = (first.ends, view.sight());
    let plane = sight.sight_plane(a, b);
    second.ends.iter().all(|&x| sight.turn_at(&plane, a, b, x).1 == Sign::Zero)
}
