//! The answer of the line engines: the spans of every drawn segment, with their quantitative invisibility.

/// A run of a segment with constant quantitative invisibility.
///
/// ```text
///    qi 0    ┆   qi 1  ┆   qi 0
///   ●────────┆┄┄┄┄┄┄┄┄┄┆─────────●
///   t = 0    t0        t1      t = 1
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Where it begins, as a part of the way along the segment in space.
    pub t0: f64,
    /// Where it ends; `t0 ≤ t1`, and equal only when the two ends round to the same number.
    pub t1: f64,
    /// How many triangles cover it, the smaller count of its two sides; 0 is visible.
    pub qi: u32,
    /// Whether a drawn edge that is nearer (or, at the same depth, comes first) has the same image
    /// here, so that drawing this one too would draw the line twice.
    pub doubled: bool,
}

/// Spans of many segments in one flat array, in the order of the segments.
///
/// The spans of a segment follow each other without gaps from where the near plane lets it begin
/// to where it ends; neighbors differ in `qi` or in `doubled`. A segment that the near plane
/// removes, or whose image is a point, has none.
#[derive(Debug, Clone, PartialEq)]
pub struct Visibility {
    spans: Vec<Span>,
    starts: Vec<u32>,
}

impl Default for Visibility {
    fn default() -> Self {
        Self { spans: Vec::new(), starts: vec![0] }
    }
}

impl Visibility {
    /// Appends the spans of the next segment.
    pub fn push(&mut self, spans: &[Span]) {
        self.spans.extend_from_slice(spans);
        self.starts.push(self.spans.len() as u32);
    }

    /// Appends all segments of `other`.
    pub fn append(&mut self, other: &Self) {
        let before = self.spans.len() as u32;
        self.spans.extend_from_slice(&other.spans);
        self.starts.extend(other.starts[1..].iter().map(|start| before + start));
    }

    /// Number of segments.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there are no segments.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The spans of one segment. Panics when there is no such segment.
    pub fn spans(&self, segment: usize) -> &[Span] {
        &self.spans[self.starts[segment] as usize..self.starts[segment + 1] as usize]
    }
}
