//! Which parts of each segment are drawn: seen, lit or not, and dark enough.

use rayon::prelude::*;

use super::cut::{GROUND, HatchSegment};
use super::families::{Families, rank};
use super::gap::Gaps;
use super::interval::{Interval, Intervals};
use super::options::HatchLevels;
use super::tone::{Sample, Tones};
use super::{Lit, Seen};
use crate::classify::{ViewSegments, ViewedScene};
use crate::engines::visibility::Span;

/// Tones are followed along a segment in steps of this length on paper.
const TONE_STEP_MM: f64 = 4.0;

/// But never in more steps than this.
const MOST_STEPS: f64 = 64.0;

/// Segments that one piece of parallel work does.
const CHUNK: usize = 1024;

/// All segments with what is known of them.
pub(super) struct Pieces<'a> {
    pub(super) view: &'a ViewedScene<'a>,
    pub(super) segments: &'a ViewSegments,
    pub(super) hatched: &'a [HatchSegment],
    pub(super) families: &'a Families,
    pub(super) tones: &'a Tones<'a>,
    pub(super) levels: HatchLevels,
    pub(super) mm_per_image_unit: f64,
    /// Whether every line is wanted, whatever the tone.
    pub(super) every_line: bool,
}

impl Pieces<'_> {
    /// The visible parts of all segments. O(segments), in parallel.
    pub(super) fn intervals<'l>(
        &self,
        seen: &Seen,
        gaps: Option<&Gaps>,
        lit: impl Fn(usize) -> Lit<'l> + Sync,
    ) -> Intervals {
        let parts: Vec<Intervals> = (0..self.hatched.len().div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let mut part = Intervals::default();
                let last = ((chunk + 1) * CHUNK).min(self.hatched.len());
                let (mut by_light, mut by_tone) = (Vec::new(), Vec::new());
                for i in chunk * CHUNK..last {
                    by_light.clear();
                    for span in seen.spans(i).iter().filter(|span| span.qi == 0) {
                        split_by_light(span, &lit(i), &mut by_light);
                    }
                    by_tone.clear();
                    match self.every_line {
                        true => by_tone.extend_from_slice(&by_light),
                        false => self.by_tone(i, &by_light, &mut by_tone),
                    }
                    if let Some(gaps) = gaps {
                        let ends = self.segments.ends(i).map(|end| self.view.image()[end as usize]);
                        gaps.cut(ends, &mut by_tone);
                    }
                    part.push(&by_tone);
                }
                part
            })
            .collect();
        let mut whole = Intervals::default();
        parts.iter().for_each(|part| whole.append(part));
        whole
    }

    /// Splits visible parts of a segment where a line begins or ends to be dark enough.
    fn by_tone(&self, i: usize, parts: &[Interval], found: &mut Vec<Interval>) {
        if parts.is_empty() {
            return;
        }
        let segment = &self.hatched[i];
        let family = &self.families.all[segment.family as usize];
        let rank = rank(self.levels, segment.line);
        let n_steps = self.n_steps(i);
        let samples: Vec<Sample> =
            (0..=n_steps).map(|k| self.sample(i, k as f64 / n_steps as f64)).collect();
        for part in parts {
            let mut push = |t0: f64, t1: f64, is_drawn: bool| match found.last_mut() {
                Some(last) if t0 > part.t0 && last.t1 == t0 && last.is_drawn == is_drawn => {
                    last.t1 = t1;
                }
                _ => found.push(Interval { t0, t1, is_drawn, ..*part }),
            };
            let mut at = part.t0;
            for k in 0..n_steps {
                let (from, to) = (k as f64 / n_steps as f64, (k + 1) as f64 / n_steps as f64);
                let ends = [&samples[k], &samples[k + 1]];
                let Some(drawn) = self.tones.drawn_part(family, rank, ends, part.is_lit) else {
                    continue;
                };
                let whole = |s: f64| if s == 1.0 { to } else { from + (to - from) * s };
                let (t0, t1) = (whole(drawn[0]).max(part.t0), whole(drawn[1]).min(part.t1));
                if t0 >= t1 {
                    continue;
                }
                if t0 > at {
                    push(at, t0, false);
                }
                push(t0, t1, true);
                at = t1;
            }
            if at < part.t1 {
                push(at, part.t1, false);
            }
        }
    }

    /// In how many steps the tone along a segment is followed.
    fn n_steps(&self, i: usize) -> usize {
        let segment = &self.hatched[i];
        let length = self.length_mm(i, 0.0, 1.0);
        let steps = (length / TONE_STEP_MM).ceil().clamp(1.0, MOST_STEPS);
        if steps.is_nan() || segment.at[0] == GROUND && length < TONE_STEP_MM {
            return 1;
        }
        steps as usize
    }

    fn sample(&self, i: usize, t: f64) -> Sample {
        let HatchSegment { family, at, .. } = self.hatched[i];
        let family = &self.families.all[family as usize];
        let [a, b] = self.segments.ends(i).map(|end| self.segments.points()[end as usize]);
        let point = a.lerp(b, t);
        let triangle = at[usize::from(t > 0.5)];
        if triangle == GROUND {
            return self.tones.ground_sample(family, point);
        }
        let turn = self.view.triangle_turns()[triangle as usize];
        self.tones.sample(family, triangle, point, turn)
    }

    /// The image of a point of a segment.
    pub(super) fn image(&self, i: usize, t: f64) -> glam::DVec2 {
        let [a, b] = self.segments.ends(i).map(|end| self.view.image()[end as usize]);
        // Ends are taken as they are, so that joined pieces share the very point.
        if t == 0.0 {
            a.image()
        } else if t == 1.0 {
            b.image()
        } else {
            a.towards(b, t).image()
        }
    }

    /// The length of a part of a segment on paper.
    pub(super) fn length_mm(&self, i: usize, t0: f64, t1: f64) -> f64 {
        self.image(i, t0).distance(self.image(i, t1)) * self.mm_per_image_unit
    }
}

/// Appends the parts of a visible span, lit and not.
fn split_by_light(span: &Span, lit: &Lit, parts: &mut Vec<Interval>) {
    let part = |t0, t1, is_lit| Interval { t0, t1, is_lit, is_drawn: false };
    let spans = match lit {
        Lit::Everywhere => return parts.push(part(span.t0, span.t1, true)),
        Lit::Nowhere => return parts.push(part(span.t0, span.t1, false)),
        Lit::Where(spans) => spans,
    };
    let mut start = span.t0;
    for dark in spans.iter().filter(|dark| dark.qi > 0) {
        let (t0, t1) = (dark.t0.max(span.t0), dark.t1.min(span.t1));
        if t0 >= t1 {
            continue;
        }
        if t0 > start {
            parts.push(part(start, t0, true));
        }
        parts.push(part(t0, t1, false));
        start = t1;
    }
    if start < span.t1 {
        parts.push(part(start, span.t1, true));
    }
}
