//! A draft, with an index of which strokes are near each other.

use std::sync::OnceLock;

use crate::strokes::draft::Draft;

use super::Paper;
use super::edits::Ends;
use super::near::SegmentGrid;
use super::near_ends::SegmentsNearEnds;

/// An end this near to a stroke lies on it.
pub(super) const ON_STROKE_MM: f64 = 0.02;

/// A draft with its segments by place, for searches within a pen width.
///
/// They are sorted when they are first searched, and again after the draft was changed.
pub(super) struct Inked<'a> {
    draft: Draft,
    paper: &'a Paper,
    /// How far ends that are joined may be from each other.
    joint: f64,
    grid: OnceLock<SegmentGrid>,
    near_ends: OnceLock<SegmentsNearEnds>,
}

impl<'a> Inked<'a> {
    pub(super) fn new(draft: Draft, paper: &'a Paper, joint: f64) -> Self {
        Self { draft, paper, joint, grid: OnceLock::new(), near_ends: OnceLock::new() }
    }

    pub(super) fn draft(&self) -> &Draft {
        &self.draft
    }

    pub(super) fn paper(&self) -> &'a Paper {
        self.paper
    }

    pub(super) fn joint(&self) -> f64 {
        self.joint
    }

    /// The segments of the draft by cells.
    pub(super) fn grid(&self) -> &SegmentGrid {
        self.grid.get_or_init(|| self.paper.grid(&self.draft, self.paper.pen))
    }

    /// The segments within a pen width, or within [`ON_STROKE_MM`], of each end.
    pub(super) fn near_ends(&self, ends: &Ends) -> &SegmentsNearEnds {
        let reach = self.paper.pen.max(ON_STROKE_MM * self.paper.mm);
        self.near_ends.get_or_init(|| SegmentsNearEnds::new(&self.draft, ends, self.paper, reach))
    }

    /// Puts a changed draft in place of this one.
    pub(super) fn change(&mut self, draft: Draft) {
        *self = Self::new(draft, self.paper, self.joint);
    }

    pub(super) fn into_draft(self) -> Draft {
        self.draft
    }
}
