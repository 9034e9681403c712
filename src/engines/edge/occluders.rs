//! The triangles that hide something.

use crate::classify::ViewedScene;
use crate::predicates::{Kept, Sign};
use rayon::prelude::*;

/// Triangles that cover something and lie wholly beyond the near plane, less those culled.
///
/// Triangles that the near plane cuts are none of them: they are tested one by one.
#[derive(Debug)]
pub(super) struct Occluders {
    list: Vec<u32>,
    contains: Vec<bool>,
    are_culled: bool,
}

impl Occluders {
    /// All occluders of a view. O(triangles), in parallel.
    pub(super) fn new(view: &ViewedScene) -> Self {
        let contains: Vec<bool> = view
            .triangle_turns()
            .par_iter()
            .zip(0..view.scene().triangles().len() as u32)
            .with_min_len(4096)
            .map(|(&turn, triangle)| turn != Sign::Zero && view.kept(triangle) == Kept::All)
            .collect();
        Self { list: numbers(&contains), contains, are_culled: false }
    }

    /// Those of the occluders that `keep` says.
    pub(super) fn culled(&self, keep: impl Fn(u32) -> bool + Sync) -> Self {
        let is_kept = |(i, &is): (usize, &bool)| is && keep(i as u32);
        let contains: Vec<bool> = self.contains.par_iter().enumerate().map(is_kept).collect();
        Self { list: numbers(&contains), contains, are_culled: true }
    }

    /// Whether some may have been culled.
    pub(super) fn are_culled(&self) -> bool {
        self.are_culled
    }

    /// The occluders in rising order.
    pub(super) fn list(&self) -> &[u32] {
        &self.list
    }

    /// Whether a triangle is an occluder.
    #[inline]
    pub(super) fn contains(&self, triangle: u32) -> bool {
        self.contains[triangle as usize]
    }
}

/// The places where `contains` holds.
fn numbers(contains: &[bool]) -> Vec<u32> {
    let numbered = contains.par_iter().enumerate();
    numbered.filter_map(|(i, &is)| is.then_some(i as u32)).collect()
}
