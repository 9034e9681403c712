//! Which level curves are drawn: their heights, which of them are index lines, and how the heights are
//! written.

use super::error::{MAX_LEVELS, SurfaceError};
use super::options::{Levels, SurfaceLines};
use crate::surface::{AxisScale, SampledSurface};

/// Every n-th level is an index line if levels have a step, by default.
const DEFAULT_INDEX_EVERY: u16 = 5;

/// About this many levels are drawn if only a round step is wanted.
const LEVELS_WANTED: f64 = 12.0;

/// Heights of levels are written with at most this many decimals: beyond that, digits are rounding.
const MOST_DECIMALS: usize = 9;

/// Most levels that a legend lists one by one.
const MOST_LISTED: usize = 5;

/// A level curve's height.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Level {
    /// In model units, as drawn.
    drawn: f64,
    /// Before any scaling.
    height: f64,
    is_index: bool,
}

/// The levels of a drawing, in rising order of their heights as drawn; each height once.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct LevelSet {
    levels: Vec<Level>,
    decimals: usize,
    /// The distance between neighbors before any scaling, if it is always the same.
    step: Option<f64>,
    /// Every so many levels are index lines, if any are.
    index_every: Option<u16>,
}

impl LevelSet {
    /// The levels that `lines` ask for on this surface.
    ///
    /// # Errors
    /// There would be more than [`MAX_LEVELS`].
    pub(super) fn new(
        lines: &SurfaceLines,
        surface: &SampledSurface,
    ) -> Result<Self, SurfaceError> {
        let Some(levels) = &lines.levels else { return Ok(Self::default()) };
        let (low, high) = surface.bounds();
        let scale = surface.scales()[2];
        let every = lines.index_every.map(usize::from);
        let is_nth = |k: usize| every.is_some_and(|every| k.is_multiple_of(every.max(1)));
        let mut set = match levels {
            Levels::Count(count) => {
                let n = f64::from(*count) + 1.0;
                let level = |k: u16| {
                    let drawn = low.z + (high.z - low.z) * f64::from(k) / n;
                    let height = scale.value(drawn);
                    Level { drawn, height, is_index: is_nth(usize::from(k) - 1) }
                };
                let step = (scale.value(high.z) - scale.value(low.z)) / n;
                let decimals = (2.0 - step.abs().log10().floor()).clamp(0.0, MOST_DECIMALS as f64);
                let decimals = if decimals.is_nan() { 0 } else { decimals as usize };
                let step = Some(step.abs()).filter(|_| !scale.is_log);
                let levels = (1..=*count).map(level).collect();
                Self { levels, decimals, step, index_every: lines.index_every }
            }
            Levels::At(heights) => {
                let mut heights = heights.clone();
                heights.sort_by(f64::total_cmp);
                heights.dedup();
                let of = |(k, &height): (usize, &f64)| Level {
                    drawn: scale.drawn(height),
                    height,
                    is_index: is_nth(k),
                };
                let decimals = heights.iter().map(|height| decimals(*height)).max().unwrap_or(0);
                let levels = heights.iter().enumerate().map(of).collect();
                Self { levels, decimals, step: None, index_every: lines.index_every }
            }
            Levels::Every { step, offset } => {
                let every = lines.index_every.unwrap_or(DEFAULT_INDEX_EVERY);
                Self::stepped((low.z, high.z), scale, (*step, *offset), Some(every))?
            }
            Levels::Round => {
                let range = (scale.value(high.z) - scale.value(low.z)).abs();
                let step = round_step(range);
                Self::stepped((low.z, high.z), scale, (step, 0.0), lines.index_every)?
            }
        };
        set.levels.retain(|level| level.drawn.is_finite());
        set.levels.sort_by(|a, b| (a.drawn + 0.0).total_cmp(&(b.drawn + 0.0)));
        set.levels.dedup_by(|a, b| a.drawn == b.drawn);
        if set.levels.len() > MAX_LEVELS {
            return Err(SurfaceError::TooManyLevels(set.levels.len() as f64));
        }
        Ok(set)
    }

    /// The multiples of a step between two heights as drawn.
    fn stepped(
        (low, high): (f64, f64),
        scale: AxisScale,
        (step, offset): (f64, f64),
        index_every: Option<u16>,
    ) -> Result<Self, SurfaceError> {
        let number = |drawn: f64| (scale.value(drawn) - offset) / step;
        let (one, other) = (number(low), number(high));
        let (first, last) = (one.min(other).ceil(), one.max(other).floor());
        if !(first.is_finite() && last.is_finite()) {
            return Ok(Self::default());
        }
        let n = last - first + 1.0;
        if n > MAX_LEVELS as f64 {
            return Err(SurfaceError::TooManyLevels(n));
        }
        let level = |k: usize| {
            let number = first + k as f64;
            let height = offset + number * step;
            let is_index = index_every.is_some_and(|every| number % f64::from(every.max(1)) == 0.0);
            Level { drawn: scale.drawn(height), height, is_index }
        };
        let levels = (0..n.max(0.0) as usize).map(level).collect();
        let decimals = decimals(step).max(decimals(offset));
        Ok(Self { levels, decimals, step: Some(step), index_every })
    }

    /// Which levels these are, in words, as in a legend.
    pub(super) fn described(&self) -> String {
        let Some(step) = self.step else {
            let texts = (1..=self.levels.len() as u16).map(|number| self.text(number));
            return match self.levels.len() {
                n @ 1..=MOST_LISTED => {
                    let word = if n == 1 { "level" } else { "levels" };
                    format!("{word} {}", texts.collect::<Vec<_>>().join(", "))
                }
                _ => "levels".to_owned(),
            };
        };
        let number = |step: f64| format!("{:.2e}", step).parse().unwrap_or(step).to_string();
        let heavy = self.index_every.filter(|_| self.has_index());
        let heavy = heavy.map(|every| format!(", heavy {}", number(step * f64::from(every))));
        format!("interval {}{}", number(step), heavy.unwrap_or_default())
    }

    /// The heights as drawn.
    pub(super) fn heights(&self) -> Vec<f64> {
        self.levels.iter().map(|level| level.drawn).collect()
    }

    /// Whether the level of this number, counted from 1 for the lowest, is an index line.
    pub(super) fn is_index(&self, number: u16) -> bool {
        let level = usize::from(number).checked_sub(1).and_then(|k| self.levels.get(k));
        level.is_some_and(|level| level.is_index)
    }

    /// Whether any level is an index line.
    pub(super) fn has_index(&self) -> bool {
        self.levels.iter().any(|level| level.is_index)
    }

    /// Whether the level of this number has a height below 0.
    pub(super) fn is_negative(&self, number: u16) -> bool {
        let level = usize::from(number).checked_sub(1).and_then(|k| self.levels.get(k));
        level.is_some_and(|level| level.height < 0.0)
    }

    /// The height of the level of this number, as it is written; empty if there is no such level.
    pub(super) fn text(&self, number: u16) -> String {
        let level = usize::from(number).checked_sub(1).and_then(|k| self.levels.get(k));
        let Some(level) = level else { return String::new() };
        let text = format!("{:.*}", self.decimals, level.height);
        let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
        if is_zero { text.replace('-', "") } else { text.replace('-', "−") }
    }
}

/// The least number of decimals that write a number, up to [`MOST_DECIMALS`].
fn decimals(number: f64) -> usize {
    let text = format!("{number:.MOST_DECIMALS$}");
    text.trim_end_matches('0').split('.').nth(1).map_or(0, str::len)
}

/// A step of 1, 2 or 5 times a power of ten, of which about [`LEVELS_WANTED`] fit into a range.
fn round_step(range: f64) -> f64 {
    let power = libm::floor(libm::log10(range / LEVELS_WANTED)) as i32;
    let steps = [1.0, 2.0, 5.0, 10.0].map(|digit| {
        // Dividing is correctly rounded where multiplying by 0.1 is not.
        let ten = 10f64.powi(power.abs());
        if power < 0 { digit / ten } else { digit * ten }
    });
    let off = |step: &f64| libm::log(range / step / LEVELS_WANTED).abs();
    steps.into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Grid, Surface};

    fn set(levels: Levels, index_every: Option<u16>, heights: [f64; 2]) -> LevelSet {
        let [low, high] = heights;
        let grid = Grid::new(vec![0.0, 1.0], vec![0.0, 1.0], vec![low, high, high, low]);
        let surface = Surface::grid(grid.expect("a grid")).sample().expect("samples");
        let lines = SurfaceLines { levels: Some(levels), index_every, ..SurfaceLines::default() };
        LevelSet::new(&lines, &surface).expect("levels")
    }

    fn texts(set: &LevelSet) -> Vec<String> {
        (1..=set.levels.len() as u16).map(|k| set.text(k)).collect()
    }

    #[test]
    fn the_level_at_zero_has_no_sign() {
        // 0.3 − 3 · 0.1 is not 0 but for rounding.
        let scale = AxisScale::DATA;
        let set = LevelSet::stepped((-0.35, 0.35), scale, (0.1, 0.3), None).expect("levels");
        let texts: Vec<String> = (1..=7).map(|number| set.text(number)).collect();
        assert_eq!(texts, ["−0.3", "−0.2", "−0.1", "0.0", "0.1", "0.2", "0.3"]);
    }

    #[test]
    fn steps_hit_their_multiples_and_index_lines_are_multiples_of_the_step() {
        let found = set(Levels::Every { step: 5.0, offset: 0.0 }, None, [-11.0, 31.0]);
        let expected = ["−10", "−5", "0", "5", "10", "15", "20", "25", "30"];
        assert_eq!(texts(&found), expected);
        let index: Vec<u16> = (1..10).filter(|k| found.is_index(*k)).collect();
        assert_eq!(index.iter().map(|k| found.text(*k)).collect::<Vec<_>>(), ["0", "25"]);
        assert!(found.is_negative(1) && !found.is_negative(3));
        let found = set(Levels::Every { step: 0.25, offset: 0.1 }, Some(2), [0.0, 1.0]);
        assert_eq!(texts(&found), ["0.10", "0.35", "0.60", "0.85"]);
        assert!(found.is_index(1) && !found.is_index(2) && found.is_index(3));
    }

    #[test]
    fn round_steps_give_between_8_and_20_levels() {
        for high in [1e-7, 0.003, 0.9, 1.0, 1.9, 2.1, 4.9, 7.0, 99.0, 101.0, 86.0, 5e6] {
            let found = set(Levels::Round, None, [0.0, high]);
            let n = found.levels.len();
            assert!((8..=20).contains(&n), "{high}: {n}");
            assert!(!found.has_index());
        }
    }

    #[test]
    fn lists_take_the_first_the_sixth_and_so_on_as_index_lines() {
        let list = Levels::At(vec![7.0, 1.0, 2.0, 3.5, 4.0, 5.0, 6.0, 1.0]);
        let found = set(list, Some(5), [0.0, 8.0]);
        assert_eq!(texts(&found), ["1.0", "2.0", "3.5", "4.0", "5.0", "6.0", "7.0"]);
        assert_eq!((1..8).filter(|k| found.is_index(*k)).collect::<Vec<_>>(), [1, 6]);
    }

    #[test]
    fn too_many_levels_are_refused() {
        let grid = Grid::new(vec![0.0, 1.0], vec![0.0, 1.0], vec![0.0, 1.0, 1.0, 0.0]);
        let surface = Surface::grid(grid.expect("a grid")).sample().expect("samples");
        let levels = Some(Levels::Every { step: 1e-9, offset: 0.0 });
        let lines = SurfaceLines { levels, ..SurfaceLines::default() };
        assert!(matches!(LevelSet::new(&lines, &surface), Err(SurfaceError::TooManyLevels(_))));
    }
}
