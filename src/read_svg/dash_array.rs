//! `stroke-dasharray` as pieces of line, since neither plotters nor their software know dashes.

use glam::DVec2;

/// A last dash shorter than this is there by rounding only.
const ROUNDING_MM: f64 = 1e-6;

/// Lengths of dashes and gaps in turn, in user units, and where in them a line begins.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct DashArray {
    lengths: Vec<f64>,
    offset: f64,
}

impl DashArray {
    /// `None` for a solid line: no lengths, all of them zero, or one that is negative.
    pub(super) fn new(mut lengths: Vec<f64>, offset: f64) -> Option<Self> {
        if lengths.len() % 2 == 1 {
            lengths.extend_from_within(..);
        }
        let period: f64 = lengths.iter().sum();
        let is_valid = lengths.iter().all(|&length| length >= 0.0);
        let offset = if offset.is_finite() { offset } else { 0.0 };
        (is_valid && period > 0.0 && period.is_finite()).then_some(Self { lengths, offset })
    }

    /// The same dashes, `factor` times as long.
    pub(super) fn scaled(mut self, factor: f64) -> Self {
        self.lengths.iter_mut().for_each(|length| *length *= factor);
        self.offset *= factor;
        self
    }

    /// Number of dashes on a line of this length, about.
    pub(super) fn n_dashes(&self, length: f64) -> f64 {
        length / self.period() * (self.lengths.len() / 2) as f64 + 1.0
    }

    fn period(&self) -> f64 {
        self.lengths.iter().sum()
    }

    /// Hands the dashes of a polyline to `emit`, in order. `length_of` gives the length of a step on
    /// the page in user units. Where a closed line begins within a dash, that dash is one piece.
    pub(super) fn for_each_dash(
        &self,
        line: &[DVec2],
        length_of: impl Fn(DVec2) -> f64,
        mut emit: impl FnMut(&[DVec2]),
    ) {
        let (mut index, mut left) = self.start();
        let is_closed = line.len() > 2 && line.first() == line.last();
        let begins_inked = index.is_multiple_of(2);
        let mut head: Option<Vec<DVec2>> = None;
        let mut n_dashes = 0;
        let mut dash: Vec<DVec2> = Vec::new();
        if begins_inked {
            dash.extend(line.first());
        }
        let mut finish = |dash: &mut Vec<DVec2>| {
            if n_dashes == 0 && is_closed && begins_inked {
                head = Some(std::mem::take(dash));
            } else {
                emit(dash);
                dash.clear();
            }
            n_dashes += 1;
        };
        for pair in line.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let length = length_of(to - from);
            let mut walked = 0.0;
            while left <= length - walked {
                walked += left;
                let here = if walked < length { from.lerp(to, walked / length) } else { to };
                if index.is_multiple_of(2) {
                    // A dash of no length is a dot.
                    dash.push(here);
                    finish(&mut dash);
                } else {
                    dash.push(here);
                }
                index = (index + 1) % self.lengths.len();
                left = self.lengths[index];
            }
            left -= length - walked;
            if index.is_multiple_of(2) && dash.last() != Some(&to) {
                dash.push(to);
            }
        }
        // A gap that ends with the line leaves a dash of no length, or of a rounding error's.
        let length: f64 = dash.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let open = (length > ROUNDING_MM).then_some(dash);
        match (open, head) {
            (Some(mut tail), Some(head)) => {
                tail.extend_from_slice(&head[1..]);
                emit(&tail);
            }
            (tail, head) => tail.iter().chain(&head).for_each(|dash| emit(dash)),
        }
    }

    /// Which length a line begins in, and how much of it is left.
    fn start(&self) -> (usize, f64) {
        let mut offset = self.offset.rem_euclid(self.period());
        for (i, &length) in self.lengths.iter().enumerate() {
            // A dash of no length, a dot, begins where the line does.
            if offset < length || (offset == 0.0 && length == 0.0) {
                return (i, length - offset);
            }
            offset -= length;
        }
        (0, self.lengths[0])
    }
}
