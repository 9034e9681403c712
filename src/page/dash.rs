//! Dashed lines as real segments, since plotters have no dash patterns.
//!
//! ```text
//!   end              corner
//!    ━━━━  ━━━━  ━━━━  ━━┓      A stroke is cut at its corners. Each stretch begins and ends with a
//!                        ┃      dash, half of one at a corner, and all lengths of a stretch are
//!                                stretched alike to make that so.
//! ```

use std::collections::HashMap;

use glam::DVec2;

/// A line turns a corner where its direction changes by more than this, in degrees.
const CORNER_DEG: f64 = 30.0;

/// A visible line ends where a hidden one begins if they are this close, in millimeters, …
const SAME_END_MM: f64 = 0.05;

/// … and continues into it if the turn is at most this, in degrees.
const STRAIGHT_DEG: f64 = 15.0;

/// Closed lines without corners have at least this many gaps.
const FEWEST_GAPS: f64 = 3.0;

/// Lengths of dashes and of the gaps between them.
///
/// A stretch too short for a gap is solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dash {
    /// Length of a dash in millimeters.
    pub dash_mm: f64,
    /// Length of a gap in millimeters. Below 0.7 plotting software may join the dashes again.
    pub gap_mm: f64,
}

impl Dash {
    /// Dashes of 12 and gaps of 3 pen widths: the dashed line of ISO 128.
    pub fn of_pen(width_mm: f64) -> Self {
        Self { dash_mm: 12.0 * width_mm, gap_mm: 3.0 * width_mm }
    }

    /// Passes the dashes along a polyline in millimeters to `emit`.
    ///
    /// `goes_on` says whether a visible line continues from the first and from the last point: there the
    /// stroke has a gap, which shows where the line becomes hidden.
    pub(super) fn for_each_dash(
        &self,
        points: &[DVec2],
        goes_on: [bool; 2],
        mut emit: impl FnMut(&[DVec2]),
    ) {
        let [Some(first), Some(last)] = [points.first(), points.last()] else { return };
        if !(self.gap_mm > 0.0 && self.dash_mm > 0.0) {
            emit(points);
            return;
        }
        let is_closed = first == last && points.len() > 3;
        let corners = corners(points, is_closed);
        // A closed stroke begins at a corner if it has one.
        let turned: Vec<DVec2>;
        let (points, corners) = match corners.first() {
            Some(&corner) if is_closed && corner > 0 => {
                let n = points.len() - 1;
                turned = (0..=n).map(|i| points[(i + corner) % n]).collect();
                (&turned[..], self::corners(&turned, true))
            }
            _ => (points, corners),
        };
        let along = lengths(points);
        let whole = along[along.len() - 1];
        let mut dashes: Vec<(f64, f64)> = Vec::new();
        if is_closed && corners.is_empty() {
            self.around(whole, &mut dashes);
        } else {
            let ends = corners.iter().map(|&i| along[i]).filter(|&at| at > 0.0 && at < whole);
            let mut start = 0.0;
            for end in ends.chain([whole]) {
                let part = |is_end: bool, goes_on: bool| match (is_end && !is_closed, goes_on) {
                    (true, true) => 0.0,
                    (true, false) => 1.0,
                    (false, _) => 0.5,
                };
                let parts = [part(start == 0.0, goes_on[0]), part(end == whole, goes_on[1])];
                self.stretch(start, end, parts, &mut dashes);
                start = end;
            }
        }
        // Half dashes on both sides of a corner are one.
        dashes.dedup_by(|next, last| {
            let touches = next.0 <= last.1;
            if touches {
                last.1 = next.1;
            }
            touches
        });
        let mut piece = Vec::new();
        for &(from, to) in &dashes {
            cut(points, &along, from, to, &mut piece);
            emit(&piece);
        }
    }

    /// Adds the dashes of a stretch whose first and last dash have these parts of a dash's length.
    fn stretch(&self, start: f64, end: f64, parts: [f64; 2], dashes: &mut Vec<(f64, f64)>) {
        let length = end - start;
        let [first, last] = parts.map(|part| part * self.dash_mm);
        let period = self.dash_mm + self.gap_mm;
        let n_gaps = ((length - first - last + self.dash_mm) / period).round().max(0.0);
        if n_gaps == 0.0 {
            dashes.push((start, end));
            return;
        }
        let unstretched = first + last + n_gaps * self.gap_mm + (n_gaps - 1.0) * self.dash_mm;
        let stretched = length / unstretched;
        let n = n_gaps as u64;
        for k in 0..=n {
            // The dash before gap k ends where that begins.
            let gap_at = |k: u64| start + stretched * (first + k as f64 * period);
            let from = if k == 0 { start } else { gap_at(k - 1) + stretched * self.gap_mm };
            // The last dash runs to the end, whatever the sums were rounded to.
            let to = if k == n { end } else { gap_at(k) };
            if to > from && !(k == 0 && first == 0.0 || k == n && last == 0.0) {
                dashes.push((from, to));
            }
        }
    }

    /// Adds the dashes of a closed stroke without corners, all alike; it begins within one.
    fn around(&self, length: f64, dashes: &mut Vec<(f64, f64)>) {
        let n = (length / (self.dash_mm + self.gap_mm)).round().max(FEWEST_GAPS);
        let period = length / n;
        let gap = period * self.gap_mm / (self.dash_mm + self.gap_mm);
        let half = 0.5 * (period - gap);
        dashes.push((0.0, half));
        for k in 1..n as u64 {
            dashes.push((k as f64 * period - half, k as f64 * period + half));
        }
        dashes.push((length - half, length));
    }
}

/// The numbers of the points at which a polyline turns a corner; of a closed one the first may be among
/// them.
fn corners(points: &[DVec2], is_closed: bool) -> Vec<usize> {
    let cos_corner = libm::cos(CORNER_DEG.to_radians());
    let is_corner = |before: DVec2, at: DVec2, after: DVec2| {
        let (a, b) = (at - before, after - at);
        a.dot(b) < cos_corner * a.length() * b.length()
    };
    let n = points.len();
    let first = (is_closed && is_corner(points[n - 2], points[0], points[1])).then_some(0);
    let inner = points.windows(3).enumerate();
    let inner = inner.filter(|(_, p)| is_corner(p[0], p[1], p[2])).map(|(i, _)| i + 1);
    first.into_iter().chain(inner).collect()
}

/// How far each point is along a polyline.
fn lengths(points: &[DVec2]) -> Vec<f64> {
    let mut sum = 0.0;
    let further = points.windows(2).map(|pair| {
        sum += pair[0].distance(pair[1]);
        sum
    });
    std::iter::once(0.0).chain(further).collect()
}

/// The part of a polyline between two lengths along it.
fn cut(points: &[DVec2], along: &[f64], from: f64, to: f64, piece: &mut Vec<DVec2>) {
    piece.clear();
    let at = |i: usize, s: f64| {
        let t = (s - along[i]) / (along[i + 1] - along[i]);
        if t <= 0.0 {
            points[i]
        } else if t >= 1.0 {
            points[i + 1]
        } else {
            points[i].lerp(points[i + 1], t)
        }
    };
    let segment = |s: f64| along.partition_point(|&a| a <= s).clamp(1, points.len() - 1) - 1;
    piece.push(at(segment(from), from));
    let inner = along.partition_point(|&a| a <= from)..along.partition_point(|&a| a < to);
    piece.extend_from_slice(points.get(inner).unwrap_or_default());
    piece.push(at(along.partition_point(|&a| a < to).clamp(1, points.len() - 1) - 1, to));
}

/// Where visible lines end, and in which direction.
#[derive(Default)]
pub(super) struct VisibleEnds {
    cells: HashMap<[i64; 2], Vec<(DVec2, DVec2)>>,
}

impl VisibleEnds {
    /// Adds both ends of a visible stroke in millimeters, unless it is closed.
    pub(super) fn add(&mut self, points: &[DVec2]) {
        let n = points.len();
        if n < 2 || points[0] == points[n - 1] {
            return;
        }
        for (end, before) in [(points[0], points[1]), (points[n - 1], points[n - 2])] {
            let out = (end - before).normalize_or_zero();
            self.cells.entry(cell(end)).or_default().push((end, out));
        }
    }

    /// Whether a visible line continues into a stroke that begins at `first` toward `second`.
    pub(super) fn go_on(&self, first: DVec2, second: DVec2) -> bool {
        let direction = (second - first).normalize_or_zero();
        let cos_straight = libm::cos(STRAIGHT_DEG.to_radians());
        let [x, y] = cell(first);
        let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [x + dx, y + dy]));
        around.filter_map(|cell| self.cells.get(&cell)).flatten().any(|&(end, out)| {
            end.distance(first) <= SAME_END_MM && out.dot(direction) >= cos_straight
        })
    }
}

fn cell(point: DVec2) -> [i64; 2] {
    (point / SAME_END_MM).floor().to_array().map(|x| x as i64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    const OPEN: [bool; 2] = [false; 2];

    fn dashes(points: &[DVec2], goes_on: [bool; 2]) -> Vec<Vec<DVec2>> {
        let mut dashes = Vec::new();
        let dash = Dash { dash_mm: 2.0, gap_mm: 1.0 };
        dash.for_each_dash(points, goes_on, |d| dashes.push(d.to_vec()));
        dashes
    }

    fn length(dashes: &[Vec<DVec2>]) -> f64 {
        dashes.iter().flat_map(|d| d.windows(2)).map(|s| s[0].distance(s[1])).sum()
    }

    #[test]
    fn a_line_begins_and_ends_with_a_dash() {
        let expected = vec![
            vec![dvec2(0.0, 0.0), dvec2(2.0, 0.0)],
            vec![dvec2(3.0, 0.0), dvec2(5.0, 0.0)],
            vec![dvec2(6.0, 0.0), dvec2(8.0, 0.0)],
        ];
        assert_eq!(dashes(&[dvec2(0.0, 0.0), dvec2(8.0, 0.0)], OPEN), expected);
    }

    #[test]
    fn a_line_that_goes_on_from_a_visible_one_begins_with_a_gap() {
        let expected =
            vec![vec![dvec2(1.0, 0.0), dvec2(3.0, 0.0)], vec![dvec2(4.0, 0.0), dvec2(6.0, 0.0)]];
        assert_eq!(dashes(&[dvec2(0.0, 0.0), dvec2(6.0, 0.0)], [true, false]), expected);
        let expected = vec![vec![dvec2(1.0, 0.0), dvec2(3.0, 0.0)]];
        assert_eq!(dashes(&[dvec2(0.0, 0.0), dvec2(4.0, 0.0)], [true, true]), expected);
    }

    #[test]
    fn a_corner_has_half_a_dash_on_both_sides_drawn_as_one() {
        let corner = dvec2(5.0, 0.0);
        let all = dashes(&[dvec2(0.0, 0.0), corner, dvec2(5.0, 5.0)], OPEN);
        let bent = vec![dvec2(4.0, 0.0), corner, dvec2(5.0, 1.0)];
        let near = |a: &[DVec2], b: &[DVec2]| {
            a.len() == b.len() && a.iter().zip(b).all(|(p, q)| p.distance(*q) < 0.5)
        };
        assert_eq!(all.len(), 3);
        assert!(near(&all[1], &bent), "{:?}", all[1]);
        assert_eq!(all[1][1], corner);
    }

    #[test]
    fn a_square_has_a_dash_at_every_corner_and_a_circle_has_equal_dashes() {
        let square: Vec<DVec2> = [(0, 0), (9, 0), (9, 9), (0, 9), (0, 0)]
            .map(|(x, y)| dvec2(x.into(), y.into()))
            .to_vec();
        let all = dashes(&square, OPEN);
        for corner in &square {
            assert!(all.iter().flatten().any(|p| p == corner));
        }
        let circle: Vec<DVec2> = (0..=90)
            .map(|k| if k == 90 { 0 } else { k })
            .map(|k| DVec2::from_angle(f64::from(k) * 4f64.to_radians()) * 10.0)
            .collect();
        let all = dashes(&circle, OPEN);
        let whole = length(&[circle]);
        let n_gaps = (whole / 3.0).round();
        assert_eq!(all.len() as f64, n_gaps + 1.0);
        assert!((length(&all) - whole * 2.0 / 3.0).abs() < 1e-9);
        let each: Vec<f64> =
            all[1..all.len() - 1].iter().map(|d| length(std::slice::from_ref(d))).collect();
        assert!(each.iter().all(|d| (d - whole / n_gaps * 2.0 / 3.0).abs() < 1e-9), "{each:?}");
    }

    #[test]
    fn a_closed_line_has_the_same_dashes_wherever_it_begins() {
        let corners = [(0, 0), (20, 0), (20, 12), (0, 12)].map(|(x, y)| dvec2(x.into(), y.into()));
        let around = |first: usize, part: f64| {
            let mut points: Vec<DVec2> = (0..4).map(|k| corners[(first + k) % 4]).collect();
            if part > 0.0 {
                let start = points[3].lerp(points[0], part);
                points.insert(0, start);
            }
            points.push(points[0]);
            let all = dashes(&points, OPEN);
            let is_inked = |p: DVec2| {
                let mut pairs = all.iter().flat_map(|dash| dash.windows(2));
                pairs.any(|pair| {
                    let way = pair[0].distance(p) + p.distance(pair[1]);
                    way < pair[0].distance(pair[1]) + 1e-9
                })
            };
            let sides = (0..4).map(|k| (corners[k], corners[(k + 1) % 4]));
            let places = sides
                .flat_map(|(a, b)| (0..200).map(move |k| a.lerp(b, (f64::from(k) + 0.37) / 200.0)));
            places.map(is_inked).collect::<Vec<bool>>()
        };
        let expected = around(0, 0.0);
        for (first, part) in (0..4).flat_map(|first| [(first, 0.0), (first, 0.3), (first, 0.5)]) {
            assert_eq!(around(first, part), expected, "{first} {part}");
        }
    }

    #[test]
    fn a_small_ring_has_three_gaps_at_least() {
        for radius in [0.3, 0.7, 1.1, 1.4] {
            let angle = |k: u32| f64::from(k % 60) * 6f64.to_radians();
            let ring: Vec<DVec2> = (0..=60).map(|k| DVec2::from_angle(angle(k)) * radius).collect();
            let all = dashes(&ring, OPEN);
            // The first and the last dash are one.
            assert_eq!(all.len(), 4, "{radius}");
            let whole = length(&[ring]);
            assert!((length(&all) - whole * 2.0 / 3.0).abs() < 1e-9, "{radius}");
        }
    }

    #[test]
    fn dashes_follow_a_gentle_bend() {
        let points: Vec<_> = (0..=40).map(|i| dvec2(f64::from(i) * 0.5, 0.001)).collect();
        let all = dashes(&points, OPEN);
        assert_eq!(all.len(), 7);
        assert!((length(&all) - 14.0).abs() < 1e-9);
        assert_eq!(all[6].last(), points.last());
    }

    #[test]
    fn a_short_line_is_solid() {
        let line = vec![dvec2(0.0, 0.0), dvec2(2.4, 0.0)];
        assert_eq!(dashes(&line, OPEN), vec![line]);
    }

    #[test]
    fn only_a_visible_line_that_runs_straight_on_counts() {
        let mut ends = VisibleEnds::default();
        ends.add(&[dvec2(0.0, 0.0), dvec2(5.0, 0.0)]);
        assert!(ends.go_on(dvec2(5.02, 0.01), dvec2(9.0, 0.5)));
        assert!(!ends.go_on(dvec2(5.0, 0.0), dvec2(5.0, 4.0)));
        assert!(!ends.go_on(dvec2(5.1, 0.0), dvec2(9.0, 0.0)));
    }
}
