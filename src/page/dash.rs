//! Dashed lines as real segments, since plotters know no dash patterns.

use glam::DVec2;

/// A line turns a corner where its direction changes by more than this; dashes start anew there.
const CORNER_DEG: f64 = 30.0;

/// Lengths of dashes and of the gaps between them.
///
/// Every stretch between two corners or ends begins and ends with a dash; both lengths are
/// stretched alike to make that so. A stretch too short for a gap is solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dash {
    /// Length of a dash in millimeters.
    pub dash_mm: f64,
    /// Length of a gap in millimeters. Below 0.7 plotting software may join the dashes again.
    pub gap_mm: f64,
}

impl Default for Dash {
    /// 2.5 mm dashes with gaps of 1.25 mm.
    fn default() -> Self {
        Self { dash_mm: 2.5, gap_mm: 1.25 }
    }
}

impl Dash {
    /// Hands the dashes along a polyline in millimeters to `emit`.
    pub(super) fn for_each_dash(&self, points: &[DVec2], mut emit: impl FnMut(&[DVec2])) {
        let cos_corner = libm::cos(CORNER_DEG.to_radians());
        let is_corner = |before: DVec2, at: DVec2, after: DVec2| {
            let (a, b) = (at - before, after - at);
            a.dot(b) < cos_corner * a.length() * b.length()
        };
        let mut start = 0;
        for (i, three) in points.windows(3).enumerate() {
            if let &[before, at, after] = three
                && is_corner(before, at, after)
            {
                self.dash_stretch(points.get(start..i + 2).unwrap_or_default(), &mut emit);
                start = i + 1;
            }
        }
        self.dash_stretch(points.get(start..).unwrap_or_default(), &mut emit);
    }

    fn dash_stretch(&self, points: &[DVec2], emit: &mut impl FnMut(&[DVec2])) {
        let length: f64 = points.windows(2).map(|s| s[0].distance(s[1])).sum();
        let period = self.dash_mm + self.gap_mm;
        let n_gaps = ((length - self.dash_mm) / period).round();
        if !(n_gaps >= 1.0 && self.gap_mm > 0.0) {
            emit(points);
            return;
        }
        let stretched = length / (n_gaps * period + self.dash_mm);
        let (dash, period) = (self.dash_mm * stretched, period * stretched);

        // `walked` is the length up to the segment's start; `piece` is the dash being drawn.
        let mut walked = 0.0;
        let mut n_begun = 0.0;
        let mut piece: Vec<DVec2> = Vec::new();
        for segment in points.windows(2) {
            let &[from, to] = segment else { continue };
            let segment_length = from.distance(to);
            let at = |s: f64| from.lerp(to, ((s - walked) / segment_length).clamp(0.0, 1.0));
            loop {
                if piece.is_empty() {
                    let begin = n_begun * period;
                    if n_begun > n_gaps || begin >= walked + segment_length {
                        break;
                    }
                    piece.push(at(begin));
                    n_begun += 1.0;
                }
                let end = (n_begun - 1.0) * period + dash;
                // The last dash runs to the end, whatever the sums were rounded to.
                if n_begun > n_gaps || end > walked + segment_length {
                    piece.push(to);
                    break;
                }
                piece.push(at(end));
                emit(&piece);
                piece.clear();
            }
            walked += segment_length;
        }
        emit(&piece);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    fn dashes(points: &[DVec2]) -> Vec<Vec<DVec2>> {
        let mut dashes = Vec::new();
        Dash { dash_mm: 2.0, gap_mm: 1.0 }.for_each_dash(points, |d| dashes.push(d.to_vec()));
        dashes
    }

    #[test]
    fn a_line_begins_and_ends_with_a_dash() {
        let expected = vec![
            vec![dvec2(0.0, 0.0), dvec2(2.0, 0.0)],
            vec![dvec2(3.0, 0.0), dvec2(5.0, 0.0)],
            vec![dvec2(6.0, 0.0), dvec2(8.0, 0.0)],
        ];
        assert_eq!(dashes(&[dvec2(0.0, 0.0), dvec2(8.0, 0.0)]), expected);
    }

    #[test]
    fn a_corner_has_dashes_on_both_sides() {
        let corner = dvec2(5.0, 0.0);
        let all = dashes(&[dvec2(0.0, 0.0), corner, dvec2(5.0, 5.0)]);
        assert_eq!(all.len(), 4);
        assert_eq!(all[1].last(), Some(&corner));
        assert_eq!(all[2].first(), Some(&corner));
    }

    #[test]
    fn dashes_follow_a_gentle_bend() {
        let points: Vec<_> = (0..=40).map(|i| dvec2(f64::from(i) * 0.5, 0.001)).collect();
        let all = dashes(&points);
        assert_eq!(all.len(), 7);
        let drawn: f64 = all.iter().flat_map(|d| d.windows(2)).map(|s| s[0].distance(s[1])).sum();
        assert!((drawn - 14.0).abs() < 1e-9, "{drawn}");
        assert_eq!(all[6].last(), points.last());
    }

    #[test]
    fn a_short_line_is_solid() {
        let line = vec![dvec2(0.0, 0.0), dvec2(2.5, 0.0)];
        assert_eq!(dashes(&line), vec![line]);
    }
}
