//! How long the stages take.

use std::ops::AddAssign;
use std::time::Instant;

use serde::Serialize;

/// Wall time of each stage in seconds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Reading, parsing and welding.
    pub read: f64,
    /// The edge table and, once per scene, intersection lines.
    pub topology: f64,
    /// All that depends on the view but not on visibility.
    pub classify: f64,
    /// The engine with its index.
    pub visibility: f64,
    /// Chaining and filtering.
    pub strokes: f64,
    /// Finishing lines on paper.
    pub drafting: f64,
    /// Joining and ordering strokes for the pen.
    pub order: f64,
    /// Page and file.
    pub write: f64,
    /// From start to end.
    pub total: f64,
}

impl Seconds {
    /// The time of all stages together, without what lies between them.
    pub fn sum(&self) -> f64 {
        let Self {
            read,
            topology,
            classify,
            visibility,
            strokes,
            drafting,
            order,
            write,
            total: _,
        } = self;
        read + topology + classify + visibility + strokes + drafting + order + write
    }
}

impl AddAssign for Seconds {
    fn add_assign(&mut self, more: Self) {
        self.read += more.read;
        self.topology += more.topology;
        self.classify += more.classify;
        self.visibility += more.visibility;
        self.strokes += more.strokes;
        self.drafting += more.drafting;
        self.order += more.order;
        self.write += more.write;
        self.total += more.total;
    }
}

/// Does `work` and adds its wall time to `seconds`.
pub fn timed<T>(seconds: &mut f64, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *seconds += start.elapsed().as_secs_f64();
    result
}
