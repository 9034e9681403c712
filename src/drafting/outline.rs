//! Which parts of the lines are outline: those seen against the background on paper.

use crate::engines::edge::outline::can_be_outline;
use crate::strokes::draft::{Draft, DraftPoint};

use super::Paper;
use super::background::{Background, BackgroundFinder};
use super::edits::between;

/// Stretches along a stroke shorter than this, in millimeters, are like what is around them.
const SHORTEST_MM: f64 = 1.0;

/// Marks the outline and leaves out what is drawn only where it is outline. If `is_cut`, segments are cut
/// where the outline begins or ends; otherwise each is what its first point is.
/// O(ink over the background's cells + triangles).
pub(super) fn mark(
    draft: Draft,
    background: &BackgroundFinder,
    paper: &Paper,
    is_cut: bool,
) -> Draft {
    let background = background.beside(draft.iter());
    let mut marked = Draft::default();
    let mut changes = Vec::new();
    for points in draft.iter() {
        find_changes(points, &background, SHORTEST_MM * paper.mm, &mut changes);
        let mut changes = changes.iter().peekable();
        let mut is_outline = false;
        let mut walked = 0.0;
        for pair in points.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let length = from.at.distance(to.at);
            let mut start = from;
            while let Some(&&at) = changes.peek().filter(|&&&at| at < walked + length || at == 0.0)
            {
                let here = between(from, to, ((at - walked) / length).max(0.0));
                let here = if is_cut { here } else { start };
                push(&mut marked, start, here, is_outline);
                (start, is_outline) = (here, !is_outline);
                changes.next();
            }
            push(&mut marked, start, to, is_outline);
            walked += length;
        }
        marked.end_stroke();
    }
    marked
}

/// Adds a segment, or ends the stroke where it is left out.
fn push(draft: &mut Draft, from: DraftPoint, to: DraftPoint, is_outline: bool) {
    if from.at == to.at {
        return;
    }
    let mut mark = from.mark;
    mark.outline = is_outline && can_be_outline(mark.kind);
    if mark.only_outline && !mark.outline {
        draft.end_stroke();
        return;
    }
    draft.push(DraftPoint { mark, ..from });
    draft.push(DraftPoint { mark, ..to });
}

/// How far along a stroke it begins or ceases to be outline, in turn, beginning with a stretch that is not.
fn find_changes(
    points: &[DraftPoint],
    background: &Background,
    shortest: f64,
    changes: &mut Vec<f64>,
) {
    changes.clear();
    let (mut walked, mut is_outline) = (0.0, false);
    for pair in points.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let length = from.at.distance(to.at);
        background.for_each_sample(from.at, to.at, |t, is_beside| {
            let is_beside = is_beside && can_be_outline(from.mark.kind);
            if is_beside != is_outline {
                changes.push(walked + t * length);
                is_outline = is_beside;
            }
        });
        walked += length;
    }
    if is_outline {
        changes.push(walked);
    }
    // Short gaps first, then what is short without them: an outline is rather kept than lost.
    close(changes, 1, shortest, walked);
    close(changes, 0, shortest, walked);
}

/// Removes pairs of changes that enclose a short stretch: gaps with `first` 1, parts with 0.
fn close(changes: &mut Vec<f64>, first: usize, shortest: f64, whole: f64) {
    let mut kept = 0;
    let mut i = 0;
    while i < changes.len() {
        let is_open = i % 2 == first % 2;
        let next = changes.get(i + 1).copied();
        match next {
            // A part as long as the stroke stays, however short that is.
            Some(end) if is_open && end - changes[i] < shortest.min(0.5 * whole) => i += 2,
            _ => {
                changes[kept] = changes[i];
                kept += 1;
                i += 1;
            }
        }
    }
    changes.truncate(kept);
}
