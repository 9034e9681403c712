//! A legend: which line stands for what.
//!
//! ```text
//!            gap
//!    ┌──────┐ ┆                        A column beside the drawing, its top at the top, or rows above or
//!    │      │ ┆ ────────  sin x cos y  below it. All that is drawn lies in the box around it, so that
//!    │      │ ┆ ─ ─ ─ ─   plane        nothing touches the legend.
//!    └──────┘ ┆ 10 mm   2
//! ```

use glam::{DVec2, dvec2};

use super::font::text;
use super::text_block::{TextBlock, wrapped};
use crate::strokes::{StrokeKind, Strokes, SurfacePart};

/// Length of a sample of a line, in millimeters on paper.
const SAMPLE_MM: f64 = 10.0;

/// Gap between a sample and its text, in millimeters on paper.
const SAMPLE_GAP_MM: f64 = 2.0;

/// Gap between the drawing and the legend, as a multiple of the height of text.
const GAP: f64 = 2.0;

/// Gap between two entries side by side, as a multiple of the height of text.
const BETWEEN: f64 = 3.0;

/// Gap between two entries one below the other, as a multiple of the height of text.
const BELOW: f64 = 0.8;

/// Text of a column is broken into lines no longer than this part of the drawing's width, if it has blanks.
const LONGEST: f64 = 0.4;

/// Most lines of a text.
const MOST_LINES: usize = 3;

/// Where a legend is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum LegendPlace {
    /// Right of the drawing, at its top.
    #[default]
    Right,
    /// Left of it, at its top.
    Left,
    /// Above it.
    Top,
    /// Below it.
    Bottom,
}

impl LegendPlace {
    /// All of them, in the order of the documentation.
    pub const ALL: [Self; 4] = [Self::Left, Self::Right, Self::Top, Self::Bottom];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Left => "left",
            Self::Top => "top",
            Self::Bottom => "bottom",
        }
    }
}

/// An entry of a legend: sample lines and their text.
#[derive(Debug, Clone, PartialEq)]
pub struct LegendEntry {
    /// The text of the entry.
    pub text: String,
    /// The kinds and parts of the sample lines, side by side.
    pub samples: Vec<(StrokeKind, SurfacePart)>,
    /// Lengths of dashes and gaps in turn, in millimeters on paper; empty for a solid line.
    pub dashes: &'static [f64],
}

/// The strokes of a legend beside, above or below the box from `low` to `high` in the image. `text_height`
/// is in units of the image, and `mm` of these are a millimeter on paper.
pub fn legend(
    entries: &[LegendEntry],
    place: LegendPlace,
    (low, high): (DVec2, DVec2),
    text_height: f64,
    mm: f64,
) -> Strokes {
    let is_column = matches!(place, LegendPlace::Right | LegendPlace::Left);
    let sample = (SAMPLE_MM + SAMPLE_GAP_MM) * mm;
    let width_of = |line: &str| text(line, text_height).1;
    let longest = if is_column { LONGEST * (high.x - low.x) } else { high.x - low.x - sample };
    let blocks: Vec<TextBlock> = entries
        .iter()
        .map(|entry| {
            let lines = wrapped(&entry.text, longest, MOST_LINES, width_of);
            TextBlock::new(lines, text_height, DVec2::X)
        })
        .collect();
    // The samples stand at the height of the middle of each text.
    let size = |block: &TextBlock| {
        let [left, right, below, above] =
            [-DVec2::X, DVec2::X, -DVec2::Y, DVec2::Y].map(|way| block.reach(way));
        (sample + left + right, above.max(0.0), below.max(0.0))
    };
    let width = |block: &TextBlock| size(block).0;
    let widest = blocks.iter().map(width).fold(0.0, f64::max);
    let columns = if is_column { 0.0 } else { (high.x - low.x).max(widest) };
    // The left end of each entry and its middle, from the upper left corner of the legend.
    let mut places = Vec::new();
    let (mut at, mut row) = (DVec2::ZERO, Vec::new());
    let mut rows = Vec::new();
    for (k, block) in blocks.iter().enumerate() {
        if !row.is_empty() && at.x + width(block) > columns {
            rows.push(std::mem::take(&mut row));
            at.x = 0.0;
        }
        row.push((k, at.x));
        at.x += width(block) + BETWEEN * text_height;
    }
    rows.push(row);
    for row in rows {
        let reach = |of: fn((f64, f64, f64)) -> f64| {
            row.iter().map(|(k, _)| of(size(&blocks[*k]))).fold(0.0, f64::max)
        };
        let (above, below) = (reach(|size| size.1), reach(|size| size.2));
        at.y -= above;
        places.extend(row.iter().map(|(_, x)| dvec2(*x, at.y)));
        at.y -= below + BELOW * text_height;
    }
    let depth = -at.y - BELOW * text_height;
    let gap = GAP * text_height;
    let corner = match place {
        LegendPlace::Right => dvec2(high.x + gap, high.y),
        LegendPlace::Left => dvec2(low.x - gap - widest, high.y),
        LegendPlace::Top => dvec2(low.x, high.y + gap + depth),
        LegendPlace::Bottom => dvec2(low.x, low.y - gap),
    };
    let mut strokes = Strokes::default();
    for ((entry, mut block), at) in entries.iter().zip(blocks).zip(places) {
        let at = corner + at;
        block.anchor = at + dvec2(sample + block.reach(-DVec2::X), 0.0);
        let share = SAMPLE_MM / entry.samples.len().max(1) as f64;
        for (k, (kind, part)) in entry.samples.iter().enumerate() {
            for [from, to] in pattern(share, entry.dashes) {
                let ends = [from, to].map(|x| at + dvec2((k as f64 * share + x) * mm, 0.0));
                strokes.push_part(*kind, *part, ends);
            }
        }
        block.draw(StrokeKind::Text, &mut strokes);
    }
    strokes
}

/// The parts of a line that a pattern of dashes and gaps leaves.
fn pattern(length: f64, dashes: &[f64]) -> Vec<[f64; 2]> {
    if dashes.is_empty() {
        return vec![[0.0, length]];
    }
    let mut parts = Vec::new();
    let mut at = 0.0;
    for pair in dashes.chunks(2).cycle() {
        parts.push([at, (at + pair[0]).min(length)]);
        at += pair.iter().sum::<f64>();
        if at >= length {
            return parts;
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACES: [LegendPlace; 4] = LegendPlace::ALL;

    fn entry(text: &str) -> LegendEntry {
        let part = SurfacePart { sheet: 1, ..SurfacePart::default() };
        LegendEntry { text: text.to_owned(), samples: vec![(StrokeKind::Grid, part)], dashes: &[] }
    }

    /// The box around strokes of a kind.
    fn around(strokes: &Strokes, kind: StrokeKind) -> Vec<[DVec2; 2]> {
        let of = strokes.iter().filter(|stroke| stroke.kind == kind);
        of.map(|s| s.points.iter().fold([s.points[0]; 2], |[a, b], p| [a.min(*p), b.max(*p)]))
            .collect()
    }

    #[test]
    fn legends_touch_neither_the_drawing_nor_their_own_samples() {
        let texts = ["sin(x)·cos(y)", "plane", "a much longer name of many words", "y_{0}", "Å"];
        let entries = texts.map(entry);
        for (place, width) in PLACES.into_iter().flat_map(|p| [40.0, 120.0].map(|w| (p, w))) {
            let (low, high) = (dvec2(-7.0, -20.0), dvec2(-7.0 + width, 30.0));
            let strokes = legend(&entries, place, (low, high), 3.0, 1.0);
            let samples = around(&strokes, StrokeKind::Grid);
            assert_eq!(samples.len(), entries.len());
            let texts = around(&strokes, StrokeKind::Text);
            let (least, most) = strokes.bounds().expect("strokes");
            let clear = match place {
                LegendPlace::Right => least.x - high.x,
                LegendPlace::Left => low.x - most.x,
                LegendPlace::Top => least.y - high.y,
                LegendPlace::Bottom => low.y - most.y,
            };
            assert!((clear - 6.0).abs() < 1.0, "{place:?}: {clear}");
            let is_column = matches!(place, LegendPlace::Right | LegendPlace::Left);
            if is_column {
                assert!((most.y - high.y).abs() < 1e-9, "{place:?}: {}", most.y);
            }
            for [a, b] in &samples {
                assert!((b.x - a.x - 10.0).abs() < 1e-9 && a.y == b.y);
                for [c, d] in &texts {
                    let gap = (*c - *b).max(*a - *d).max_element();
                    assert!(gap >= 1.5 - 1e-9, "{place:?}: {gap}");
                }
            }
            for (k, [a, b]) in samples.iter().enumerate() {
                for [c, d] in &samples[k + 1..] {
                    assert!((*c - *b).max(*a - *d).max_element() > 3.0, "{place:?}");
                }
            }
        }
    }

    #[test]
    fn samples_of_one_entry_are_side_by_side() {
        let of = |n: u16| (StrokeKind::Grid, SurfacePart { sheet: n, ..SurfacePart::default() });
        let samples = (1..=4).map(of).collect();
        let entry = LegendEntry { text: "all of them".to_owned(), samples, dashes: &[] };
        let strokes = legend(&[entry], LegendPlace::Right, (DVec2::ZERO, DVec2::ONE), 3.0, 0.5);
        let samples = around(&strokes, StrokeKind::Grid);
        // Each takes a quarter of 10 mm.
        assert_eq!(samples.len(), 4);
        let from = samples[0][0];
        for (k, sample) in (0..).zip(samples) {
            let at = [k, k + 1].map(|k| from + dvec2(1.25 * f64::from(k), 0.0));
            let off = sample[0].distance(at[0]).max(sample[1].distance(at[1]));
            assert!(off < 1e-12, "{k}: {sample:?}");
        }
    }

    #[test]
    fn dashes_fill_a_sample() {
        assert_eq!(pattern(10.0, &[]), [[0.0, 10.0]]);
        assert_eq!(pattern(10.0, &[4.0, 1.0]), [[0.0, 4.0], [5.0, 9.0]]);
        let dots = pattern(10.0, &[4.0, 1.0, 1.0, 1.0]);
        assert_eq!(dots, [[0.0, 4.0], [5.0, 6.0], [7.0, 10.0]]);
        assert_eq!(pattern(10.0, &[1.0, 1.0]).len(), 5);
    }
}
