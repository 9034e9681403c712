//! A draft, and where its ink is.

use std::cell::OnceCell;

use crate::strokes::draft::Draft;

use super::Paper;
use super::near::SegmentGrid;

/// A draft with its segments sorted into cells, for searches within a pen's width.
///
/// They are sorted when they are first searched, and again after the draft was changed.
pub(super) struct Inked<'a> {
    draft: Draft,
    paper: &'a Paper,
    grid: OnceCell<SegmentGrid>,
}

impl<'a> Inked<'a> {
    pub(super) fn new(draft: Draft, paper: &'a Paper) -> Self {
        Self { draft, paper, grid: OnceCell::new() }
    }

    pub(super) fn draft(&self) -> &Draft {
        &self.draft
    }

    pub(super) fn paper(&self) -> &'a Paper {
        self.paper
    }

    /// The segments of the draft by cells.
    pub(super) fn grid(&self) -> &SegmentGrid {
        self.grid.get_or_init(|| self.paper.grid(&self.draft, self.paper.pen))
    }

    /// Puts a changed draft in place of this one.
    pub(super) fn change(&mut self, draft: Draft) {
        *self = Self::new(draft, self.paper);
    }

    pub(super) fn into_draft(self) -> Draft {
        self.draft
    }
}
