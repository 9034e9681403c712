//! The bytes of a drawing: little-endian numbers of four bytes each, which the page views as arrays without
//! copying.
//!
//! ```text
//!   "HLV1"  seq  flags  groups  strokes  points
//!   groups × (pen, kind, 0, first stroke)          pens as listed in the facts; kinds of `StrokeKind`
//!   (strokes + 1) × first point
//!   points × (x, y), or points × (x, y, z)
//! ```
//!
//! An exact drawing has points on the page, in millimeters from the upper left corner. A draft has points
//! in space, in model units relative to the camera's target.

use hiddenline::stages::draw::turning::TurningLines;
use hiddenline::stages::plot::Plot;

const MAGIC: [u8; 4] = *b"HLV1";
/// The drawing is exact: what would be saved.
const EXACT: u32 = 1;
/// Points are in space.
const IN_SPACE: u32 = 2;

/// The finished plot, one group a layer, in the order in which the pens draw.
pub(super) fn plot(plot: &Plot, seq: u32) -> Vec<u8> {
    let layers = || plot.layers.iter();
    let n_strokes = layers().map(|layer| layer.lines.len()).sum();
    let n_points = layers().map(|layer| layer.lines.n_points()).sum();
    let mut octets = Octets::new(seq, EXACT, layers().count(), n_strokes, n_points);
    let mut first = 0;
    for (pen, layer) in (0..).zip(layers()) {
        octets.words([pen, 0, 0, first]);
        first += layer.lines.len() as u32;
    }
    octets.starts(layers().flat_map(|layer| layer.lines.iter().map(<[_]>::len)));
    for point in layers().flat_map(|layer| layer.lines.iter().flatten()) {
        octets.numbers(point.to_array());
    }
    octets.bytes
}

/// A draft: one group for strokes that one pen draws in a row. `pen` is called with the number of a kind.
pub(super) fn draft(lines: &TurningLines, seq: u32, pen: impl Fn(u32) -> u32) -> Vec<u8> {
    let mut groups: Vec<[u32; 4]> = Vec::new();
    for (stroke, (kind, _)) in (0..).zip(lines.iter()) {
        let kind = kind as u32;
        if groups.last().is_none_or(|last| last[1] != kind) {
            groups.push([pen(kind), kind, 0, stroke]);
        }
    }
    // Strokes of many kinds may alternate; then only the pen counts.
    groups.dedup_by_key(|group| group[0]);
    let mut octets = Octets::new(seq, IN_SPACE, groups.len(), lines.len(), lines.n_points());
    groups.into_iter().for_each(|group| octets.words(group));
    octets.starts(lines.iter().map(|(_, points)| points.len()));
    for point in lines.iter().flat_map(|(_, points)| points) {
        octets.numbers(point.to_array());
    }
    octets.bytes
}

struct Octets {
    bytes: Vec<u8>,
}

impl Octets {
    fn new(seq: u32, flags: u32, groups: usize, strokes: usize, points: usize) -> Self {
        let size = 24 + 16 * groups + 4 * (strokes + 1) + 12 * points;
        let mut octets = Self { bytes: Vec::with_capacity(size) };
        octets.bytes.extend(MAGIC);
        octets.words([seq, flags, groups as u32, strokes as u32, points as u32]);
        octets
    }

    fn words<const N: usize>(&mut self, words: [u32; N]) {
        words.into_iter().for_each(|word| self.bytes.extend(word.to_le_bytes()));
    }

    /// On paper, single precision is off by less than a ten-thousandth of a millimeter.
    fn numbers<const N: usize>(&mut self, numbers: [f64; N]) {
        numbers.into_iter().for_each(|x| self.bytes.extend((x as f32).to_le_bytes()));
    }

    /// Where each stroke begins, and where the last one ends.
    fn starts(&mut self, lengths: impl Iterator<Item = usize>) {
        let mut start = 0;
        self.words([start]);
        for length in lengths {
            start += length as u32;
            self.words([start]);
        }
    }
}
