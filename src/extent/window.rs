//! Clipping polylines to a rectangle (Liang and Barsky's parametric clipping).

use glam::DVec2;

/// A rectangle that polylines are clipped to.
pub(crate) struct Window {
    /// Lowest corner.
    pub(crate) low: DVec2,
    /// Highest corner.
    pub(crate) high: DVec2,
    /// Points outside by less than this are moved onto the border.
    pub(crate) slack: f64,
}

impl Window {
    /// Calls `emit` with each piece of a polyline within the window; returns whether anything was cut.
    ///
    /// A closed polyline that begins inside is not torn apart at its first point.
    pub(crate) fn crop(&self, points: &mut [DVec2], mut emit: impl FnMut(&[DVec2])) -> bool {
        let (low, high) = (self.low - self.slack, self.high + self.slack);
        if points.iter().all(|p| p.cmpge(low).all() && p.cmple(high).all()) {
            for p in points.iter_mut() {
                *p = p.clamp(self.low, self.high);
            }
            emit(points);
            return false;
        }
        let mut pieces: Vec<Vec<DVec2>> = Vec::new();
        let mut connected = false;
        for segment in points.windows(2) {
            let &[from, to] = segment else { continue };
            let Some((t0, t1)) = self.part_inside(from, to) else {
                connected = false;
                continue;
            };
            let at = |t: f64, whole: f64, end: DVec2| {
                let p = if t == whole { end } else { from + (to - from) * t };
                p.clamp(self.low, self.high)
            };
            if !(connected && t0 == 0.0) {
                pieces.push(vec![at(t0, 0.0, from)]);
            }
            if let Some(piece) = pieces.last_mut() {
                piece.push(at(t1, 1.0, to));
            }
            connected = t1 == 1.0;
        }
        let closed = points.len() > 2 && points.first() == points.last();
        if closed && connected && pieces.len() > 1 {
            let begins_inside = match points {
                [first, second, ..] => {
                    self.part_inside(*first, *second).is_some_and(|(t0, _)| t0 == 0.0)
                }
                _ => false,
            };
            if begins_inside {
                let first = pieces.remove(0);
                if let Some(last) = pieces.last_mut() {
                    last.extend_from_slice(first.get(1..).unwrap_or_default());
                }
            }
        }
        for piece in &pieces {
            emit(piece);
        }
        true
    }

    /// Where a segment enters and leaves the window with its slack, as parameters from 0 to 1.
    pub(crate) fn part_inside(&self, from: DVec2, to: DVec2) -> Option<(f64, f64)> {
        let (low, high) = (self.low - self.slack, self.high + self.slack);
        let along = to - from;
        if !along.is_finite() {
            return None;
        }
        let (mut t0, mut t1) = (0.0_f64, 1.0_f64);
        for axis in 0..2 {
            if along[axis] == 0.0 {
                if from[axis] < low[axis] || from[axis] > high[axis] {
                    return None;
                }
                continue;
            }
            let enter = (low[axis] - from[axis]) / along[axis];
            let leave = (high[axis] - from[axis]) / along[axis];
            t0 = t0.max(enter.min(leave));
            t1 = t1.min(enter.max(leave));
        }
        (t0 < t1).then_some((t0, t1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    fn pieces(points: &[DVec2]) -> Vec<Vec<DVec2>> {
        let window = Window { low: DVec2::ZERO, high: DVec2::splat(10.0), slack: 0.0 };
        let mut pieces = Vec::new();
        window.crop(&mut points.to_vec(), |piece| pieces.push(piece.to_vec()));
        pieces
    }

    #[test]
    fn a_line_through_the_window_keeps_its_middle() {
        let expected = vec![vec![dvec2(0.0, 5.0), dvec2(10.0, 5.0)]];
        assert_eq!(pieces(&[dvec2(-10.0, 5.0), dvec2(20.0, 5.0)]), expected);
    }

    #[test]
    fn a_line_past_the_window_is_dropped() {
        assert_eq!(pieces(&[dvec2(-10.0, 11.0), dvec2(20.0, 11.0)]), Vec::<Vec<DVec2>>::new());
        assert_eq!(pieces(&[dvec2(-10.0, 5.0), dvec2(5.0, 25.0)]), Vec::<Vec<DVec2>>::new());
    }

    #[test]
    fn a_polyline_that_leaves_and_returns_is_two_pieces() {
        let points = [dvec2(5.0, 2.0), dvec2(15.0, 2.0), dvec2(15.0, 8.0), dvec2(5.0, 8.0)];
        let expected =
            vec![vec![dvec2(5.0, 2.0), dvec2(10.0, 2.0)], vec![dvec2(10.0, 8.0), dvec2(5.0, 8.0)]];
        assert_eq!(pieces(&points), expected);
    }

    #[test]
    fn a_closed_polyline_stays_joined_at_its_first_point() {
        let first = dvec2(5.0, 2.0);
        let points = [first, dvec2(15.0, 2.0), dvec2(15.0, 8.0), dvec2(5.0, 8.0), first];
        let expected = vec![vec![dvec2(10.0, 8.0), dvec2(5.0, 8.0), first, dvec2(10.0, 2.0)]];
        assert_eq!(pieces(&points), expected);
    }

    #[test]
    fn rounding_does_not_crop_a_line_along_the_border() {
        let window = Window { low: DVec2::ZERO, high: DVec2::splat(10.0), slack: 0.0005 };
        let mut points = [dvec2(2.0, 10.000_000_1), dvec2(8.0, 10.000_000_1)];
        let mut pieces = Vec::new();
        assert!(!window.crop(&mut points, |piece| pieces.push(piece.to_vec())));
        assert_eq!(pieces, vec![vec![dvec2(2.0, 10.0), dvec2(8.0, 10.0)]]);
    }
}
