//! Visible parts of segments.

/// A visible part of a segment. Where a margin hides it, there is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    /// Where it begins, as a parameter along the segment in space.
    pub(super) t0: f64,
    /// Where it ends.
    pub(super) t1: f64,
    /// Whether the light reaches it.
    pub(super) is_lit: bool,
    /// Whether it is dark enough to be drawn.
    pub(super) is_drawn: bool,
}

/// The visible parts of all segments in one flat array, in their order.
#[derive(Debug, Default)]
pub(super) struct Intervals {
    all: Vec<Interval>,
    ends: Vec<u32>,
}

impl Intervals {
    /// Appends the visible parts of the next segment.
    pub(super) fn push(&mut self, parts: &[Interval]) {
        self.all.extend_from_slice(parts);
        self.ends.push(self.all.len() as u32);
    }

    /// Appends all segments of `other`.
    pub(super) fn append(&mut self, other: &Self) {
        let before = self.all.len() as u32;
        self.all.extend_from_slice(&other.all);
        self.ends.extend(other.ends.iter().map(|end| before + end));
    }

    /// The visible parts of a segment, in order.
    pub(super) fn of(&self, segment: usize) -> &[Interval] {
        let start = if segment == 0 { 0 } else { self.ends[segment - 1] };
        &self.all[start as usize..self.ends[segment] as usize]
    }
}
