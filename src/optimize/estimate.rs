//! Pen-down and pen-up travel, and the time a plot takes.
//!
//! The motion model of plotter drivers: along a stroke the pen accelerates and brakes evenly up to a
//! speed limit. At corners it slows down to a speed at which rounding the corner by a small deviation
//! would not exceed the acceleration (Jeon 2011, the junction deviation of GRBL):
//!
//! ```text
//!    v = √( a · δ · s / (1 − s) ),   s = sin(θ / 2),   θ the angle between the two segments
//!
//!  speed  ╭────────╮      ╭──╮        straight on, θ = 180°: no limit
//!        ╱          ╲____╱    ╲       back, θ = 0: the pen stops
//!       ╱                      ╲
//!      start      corner      end
//! ```
//!
//! Each stroke and each pen-up move starts and ends at rest.

use glam::DVec2;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::plot::{Plot, Polylines};

/// How a machine moves; millimeters and seconds.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Speed limit with the pen down, mm/s.
    pub down_speed: f64,
    /// Acceleration with the pen down, mm/s².
    pub down_acceleration: f64,
    /// Deviation δ that sets the speed at corners, mm.
    pub corner: f64,
    /// Speed limit with the pen up, mm/s.
    pub up_speed: f64,
    /// Acceleration with the pen up, mm/s².
    pub up_acceleration: f64,
    /// Seconds to raise the pen.
    pub raise: f64,
    /// Seconds to lower it.
    pub lower: f64,
}

impl Motion {
    /// The defaults of saxi 0.15.
    pub const SAXI: Self = Self {
        down_speed: 50.0,
        down_acceleration: 200.0,
        corner: 0.127,
        up_speed: 200.0,
        up_acceleration: 400.0,
        raise: 0.12,
        lower: 0.12,
    };
    /// An AxiDraw V3 at the speeds its software sets by default: 25 and 75 of 110 percent of
    /// 8.698 in/s, 75 percent of 40 and 60 in/s², and 126 ms for 30 percent of servo travel.
    pub const AXIDRAW: Self = Self {
        down_speed: 50.2,
        down_acceleration: 762.0,
        corner: 0.02,
        up_speed: 150.6,
        up_acceleration: 1143.0,
        raise: 0.126,
        lower: 0.126,
    };
    /// A hobby machine run by GRBL with a servo pen: 1500 and 5000 mm/min, GRBL's default
    /// junction deviation, and the dwells of the profile `grbl-servo`.
    pub const GRBL: Self = Self {
        down_speed: 25.0,
        down_acceleration: 250.0,
        corner: 0.01,
        up_speed: 83.3,
        up_acceleration: 250.0,
        raise: 0.15,
        lower: 0.15,
    };
    /// Names for [`Motion::named`].
    pub const NAMES: [&'static str; 3] = ["saxi", "axidraw", "grbl"];

    /// A machine by name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "saxi" => Some(Self::SAXI),
            "axidraw" => Some(Self::AXIDRAW),
            "grbl" => Some(Self::GRBL),
            _ => None,
        }
    }
}

impl Default for Motion {
    fn default() -> Self {
        Self::SAXI
    }
}

/// Travel and time of a plot.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TravelEstimate {
    /// Number of strokes; the pen is raised after each.
    pub strokes: usize,
    /// Pen-down travel in millimeters.
    pub down_mm: f64,
    /// Pen-up travel between strokes in millimeters, without the trips from and to home.
    pub up_mm: f64,
    /// Times the pen is raised.
    pub lifts: usize,
    /// Seconds from the first stroke to the last lift; changing pens not counted.
    pub seconds: f64,
}

/// A [`TravelEstimate`] in the units of messages and statistics.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct PenWork {
    /// Strokes.
    pub strokes: usize,
    /// Length drawn in meters.
    pub down_m: f64,
    /// Pen-up travel between strokes in meters.
    pub up_m: f64,
    /// Times the pen is raised.
    pub lifts: usize,
    /// Estimated minutes.
    pub minutes: f64,
}

impl TravelEstimate {
    /// Minutes from the first stroke to the last lift.
    pub fn minutes(&self) -> f64 {
        self.seconds / 60.0
    }

    /// The same in meters and minutes.
    pub fn work(&self) -> PenWork {
        PenWork {
            strokes: self.strokes,
            down_m: self.down_mm / 1000.0,
            up_m: self.up_mm / 1000.0,
            lifts: self.lifts,
            minutes: self.minutes(),
        }
    }
}

/// Estimates a whole plot, layer after layer.
pub fn estimate(plot: &Plot, motion: &Motion) -> TravelEstimate {
    let mut sum = TravelEstimate::default();
    let mut last = None;
    for layer in plot.plotted_layers() {
        add_lines(&mut sum, &mut last, &layer.lines, motion);
    }
    sum
}

/// Estimates one pen's strokes.
pub fn estimate_lines(lines: &Polylines, motion: &Motion) -> TravelEstimate {
    let mut sum = TravelEstimate::default();
    add_lines(&mut sum, &mut None, lines, motion);
    sum
}

fn add_lines(
    sum: &mut TravelEstimate,
    last: &mut Option<DVec2>,
    lines: &Polylines,
    motion: &Motion,
) {
    let lines: Vec<&[DVec2]> = lines.iter().collect();
    // The pen rests between strokes, so each is estimated on its own; sums are in stroke order.
    let down: Vec<(f64, f64)> = lines
        .par_iter()
        .map_init(SpeedProfile::default, |profile, line| {
            let (length, seconds) = profile.follow(line, motion);
            (length, motion.lower + seconds + motion.raise)
        })
        .collect();
    for (line, (way, seconds)) in lines.iter().zip(down) {
        let (Some(&first), Some(&end)) = (line.first(), line.last()) else {
            continue;
        };
        if let Some(from) = last.replace(end) {
            let way = from.distance(first);
            sum.up_mm += way;
            sum.seconds += ramp_seconds(way, 0.0, 0.0, motion.up_speed, motion.up_acceleration);
        }
        sum.strokes += 1;
        sum.lifts += 1;
        sum.down_mm += way;
        sum.seconds += seconds;
    }
}

/// Lengths of a stroke's segments and speeds at its points: scratch space, reused for all strokes.
#[derive(Default)]
struct SpeedProfile {
    lengths: Vec<f64>,
    /// Squares of speeds, which grow linearly with distance at constant acceleration.
    squares: Vec<f64>,
}

impl SpeedProfile {
    /// The length of a stroke, and the seconds to draw it from rest to rest.
    fn follow(&mut self, line: &[DVec2], motion: &Motion) -> (f64, f64) {
        let Self { lengths, squares } = self;
        let gain = 2.0 * motion.down_acceleration;
        lengths.clear();
        lengths.extend(line.windows(2).map(|p| p[0].distance(p[1])));
        squares.clear();
        squares.push(0.0);
        squares.extend(line.windows(3).zip(lengths.windows(2)).map(|(p, length)| {
            let across = length[0] * length[1];
            let cosine = (p[1] - p[0]).dot(p[2] - p[1]) / across;
            corner_speed_squared(if across > 0.0 { cosine } else { 1.0 }, motion)
        }));
        squares.push(0.0);
        // Reachable from the previous point, and slow enough to reach the next one.
        for (i, length) in lengths.iter().enumerate() {
            squares[i + 1] = squares[i + 1].min(squares[i] + gain * length);
        }
        for (i, length) in lengths.iter().enumerate().rev() {
            squares[i] = squares[i].min(squares[i + 1] + gain * length);
        }
        let mut from = 0.0;
        let mut seconds = 0.0;
        for (length, square) in lengths.iter().zip(&squares[1..]) {
            let to = square.sqrt();
            let limit = motion.down_speed;
            seconds += ramp_seconds(*length, from, to, limit, motion.down_acceleration);
            from = to;
        }
        (lengths.iter().sum::<f64>() + 0.0, seconds)
    }
}

/// Square of the speed at which the pen may pass a corner; 1 is straight on.
fn corner_speed_squared(cosine: f64, motion: &Motion) -> f64 {
    let limit = motion.down_speed * motion.down_speed;
    let sine = ((1.0 + cosine).max(0.0) / 2.0).sqrt();
    if sine < 1.0 {
        (motion.down_acceleration * motion.corner * sine / (1.0 - sine)).min(limit)
    } else {
        limit
    }
}

/// Seconds to cover a distance from one speed to another, reaching the limit if it is long enough.
fn ramp_seconds(way: f64, from: f64, to: f64, limit: f64, acceleration: f64) -> f64 {
    let peak = ((from * from + to * to) / 2.0 + acceleration * way).sqrt();
    if peak <= limit {
        return (2.0 * peak - from - to).max(0.0) / acceleration;
    }
    let ramps = (2.0 * limit * limit - from * from - to * to) / (2.0 * acceleration);
    (2.0 * limit - from - to) / acceleration + (way - ramps) / limit
}
