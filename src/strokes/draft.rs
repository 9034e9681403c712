//! Strokes before they are finished: polylines that know of each segment why it is drawn.
//!
//! The stages between visibility and the page join, cut and leave out lines. Lines of several kinds go
//! on into each other, so the kind belongs to the segment until the strokes are done.

use glam::DVec2;

use super::{StrokeKind, Strokes};

/// What a segment of a [`Draft`] is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mark {
    /// Why it is drawn.
    pub kind: StrokeKind,
    /// Whether it is drawn only where it is outline.
    pub only_outline: bool,
    /// Whether it is known to be outline.
    pub outline: bool,
    /// Quantitative invisibility; 0 is visible.
    pub qi: u32,
}

/// A point of a stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DraftPoint {
    /// Image coordinates.
    pub at: DVec2,
    /// Pseudo-depth: affine along lines in the image, and larger farther away.
    pub depth: f64,
    /// What the segment from here to the next point is; at the last point, that of the segment before.
    pub mark: Mark,
}

/// Polylines in image coordinates in one flat array.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Draft {
    points: Vec<DraftPoint>,
    /// Where each stroke ends in `points`; it begins where the one before ends.
    ends: Vec<u32>,
}

impl Draft {
    /// Adds a point to the stroke in the making. One at the same place as the last is left out.
    pub fn push(&mut self, point: DraftPoint) {
        let start = self.ends.last().map_or(0, |&end| end as usize);
        match self.points[start..].last_mut() {
            Some(last) if last.at == point.at => last.mark = point.mark,
            _ => self.points.push(point),
        }
    }

    /// Ends the stroke in the making. One of fewer than two points is left out.
    pub fn end_stroke(&mut self) {
        let start = self.ends.last().map_or(0, |&end| end as usize);
        match self.points[start..] {
            [.., before, ref mut last] => {
                last.mark = before.mark;
                self.ends.push(self.points.len() as u32);
            }
            _ => self.points.truncate(start),
        }
    }

    /// Number of strokes.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The points of all strokes, one stroke after the other.
    pub fn points(&self) -> &[DraftPoint] {
        &self.points
    }

    /// The points' numbers of one stroke. Panics when there is no such stroke.
    pub fn range(&self, stroke: usize) -> std::ops::Range<usize> {
        let start = if stroke == 0 { 0 } else { self.ends[stroke - 1] };
        start as usize..self.ends[stroke] as usize
    }

    /// The points of one stroke: two or more; a closed one ends at its first. Panics when there is no
    /// such stroke.
    pub fn stroke(&self, stroke: usize) -> &[DraftPoint] {
        &self.points[self.range(stroke)]
    }

    /// For each point the stroke that it belongs to.
    #[must_use]
    pub fn strokes_of_points(&self) -> Vec<u32> {
        let of_stroke = |stroke| std::iter::repeat_n(stroke as u32, self.range(stroke).len());
        (0..self.len()).flat_map(of_stroke).collect()
    }

    /// The strokes in order.
    pub fn iter(&self) -> impl Iterator<Item = &[DraftPoint]> + Clone {
        (0..self.len()).map(|stroke| self.stroke(stroke))
    }

    /// Appends the strokes of another draft.
    pub fn append(&mut self, other: &Self) {
        let before = self.points.len() as u32;
        self.points.extend_from_slice(&other.points);
        self.ends.extend(other.ends.iter().map(|end| before + end));
    }

    /// Marks nothing as outline.
    pub fn forget_outline(&mut self) {
        self.points.iter_mut().for_each(|point| point.mark.outline = false);
    }

    /// The strokes that are visible, and those that are hidden, by their first points.
    pub fn by_visibility(&self) -> [Self; 2] {
        let mut sides = [Self::default(), Self::default()];
        for points in self.iter() {
            let side = &mut sides[usize::from(points[0].mark.qi > 0)];
            points.iter().for_each(|&point| side.push(point));
            side.end_stroke();
        }
        sides
    }

    /// Ends the strokes wherever `class` changes, and says how each is drawn.
    ///
    /// A closed stroke is cut only there, not where it happens to begin.
    pub fn into_strokes<C: PartialEq>(self, class: impl Fn(Mark) -> C) -> Strokes {
        let mut strokes = Strokes::default();
        for points in self.iter() {
            let last = points.len() - 1;
            let is_round = is_closed(points);
            // A closed stroke goes around: segment `last` is segment 0 again.
            let at = |i: usize| if is_round { &points[i % last] } else { &points[i] };
            let is_change = |i: &usize| class(at(i - 1).mark) != class(at(*i).mark);
            let begin = if is_round { (1..last).find(is_change).unwrap_or(0) } else { 0 };
            let mut start = begin;
            for end in begin + 1..=begin + last {
                if end < begin + last && !is_change(&end) {
                    continue;
                }
                let mark = at(start).mark;
                let run = (start..=end).map(|i| at(i).at);
                if mark.outline {
                    strokes.push_outline(mark.kind, run);
                } else {
                    strokes.push(mark.kind, mark.qi, run);
                }
                start = end;
            }
        }
        strokes
    }
}

/// Length of a stroke.
pub fn length(points: &[DraftPoint]) -> f64 {
    points.windows(2).map(|pair| pair[0].at.distance(pair[1].at)).sum()
}

/// The diagonal of the box around a stroke.
pub fn extent(points: &[DraftPoint]) -> f64 {
    let first = points.first().map_or(DVec2::ZERO, |point| point.at);
    let grow = |(low, high): (DVec2, DVec2), p: &DraftPoint| (low.min(p.at), high.max(p.at));
    let (low, high) = points.iter().fold((first, first), grow);
    low.distance(high)
}

/// Whether a stroke ends where it begins.
pub fn is_closed(points: &[DraftPoint]) -> bool {
    matches!(points, [first, .., last] if first.at == last.at && points.len() > 2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    fn draft(kinds: &[StrokeKind], is_round: bool) -> Draft {
        let mut draft = Draft::default();
        let n = kinds.len();
        for i in 0..=n {
            let angle = i as f64;
            let at = if is_round && i == n { dvec2(1.0, 0.0) } else { DVec2::from_angle(angle) };
            let mark =
                Mark { kind: kinds[i.min(n - 1)], only_outline: false, outline: false, qi: 0 };
            draft.push(DraftPoint { at, depth: 0.0, mark });
        }
        draft.end_stroke();
        draft
    }

    const A: StrokeKind = StrokeKind::Silhouette;
    const B: StrokeKind = StrokeKind::Crease;

    fn split(kinds: &[StrokeKind], is_round: bool) -> Vec<(StrokeKind, usize)> {
        let strokes = draft(kinds, is_round).into_strokes(|mark| mark.kind);
        strokes.iter().map(|stroke| (stroke.kind, stroke.points.len())).collect()
    }

    #[test]
    fn strokes_are_cut_where_their_kind_changes() {
        assert_eq!(split(&[A, A, B, A], false), [(A, 3), (B, 2), (A, 2)]);
        assert_eq!(split(&[A, A, A], false), [(A, 4)]);
    }

    #[test]
    fn closed_strokes_are_not_cut_where_they_begin() {
        assert_eq!(split(&[A, A, B, A], true), [(B, 2), (A, 4)]);
        assert_eq!(split(&[A, A, A], true), [(A, 4)]);
        assert_eq!(split(&[A, B, B], true), [(B, 3), (A, 2)]);
    }

    #[test]
    fn repeated_points_and_single_ones_are_left_out() {
        let mark = Mark { kind: A, only_outline: false, outline: false, qi: 0 };
        let mut draft = Draft::default();
        for x in [0.0, 0.0, 1.0, 1.0] {
            draft.push(DraftPoint { at: dvec2(x, 0.0), depth: 0.0, mark });
        }
        draft.end_stroke();
        draft.push(DraftPoint { at: dvec2(5.0, 0.0), depth: 0.0, mark });
        draft.end_stroke();
        assert_eq!((draft.len(), draft.points().len()), (1, 2));
    }
}
