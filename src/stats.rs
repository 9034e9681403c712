//! What a run counted and how long its stages took.

use std::time::Instant;

use serde::Serialize;

use crate::engines::face::FaceWork;
use crate::model::scene::Scene;

/// Counts and times of one run, serialized with fixed key names.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Stats {
    /// Name of the engine that drew.
    pub engine: &'static str,
    /// Threads that worked.
    pub threads: usize,
    /// Distinct vertices, after cleaning.
    pub vertices: usize,
    /// Faces, after cleaning.
    pub faces: usize,
    /// Triangles that these faces consist of, before clipping.
    pub triangles: usize,
    /// Distinct edges of these faces, before clipping.
    pub edges: usize,
    /// Lines of intersection, before any are selected for drawing.
    pub intersections: usize,
    /// Edges and lines of intersection selected for drawing.
    pub drawn_edges: usize,
    /// Strokes of the drawing.
    pub strokes: usize,
    /// Points of all strokes.
    pub points: usize,
    /// Most memory that was resident at once; 0 where the system does not tell.
    pub peak_bytes: u64,
    /// Wall time of the stages.
    pub seconds: Seconds,
    /// What the engine counted.
    pub counts: Counts,
    /// What the pens do, before and after the strokes were joined and ordered; none where there
    /// are no pens.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plot: Option<PlotStats>,
}

/// What the pens do before and after joining and ordering.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct PlotStats {
    /// As the strokes came.
    pub before: PenWork,
    /// As they are written.
    pub after: PenWork,
}

/// What the pens do.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct PenWork {
    /// Strokes.
    pub strokes: usize,
    /// Way with the pen down in meters.
    pub down_m: f64,
    /// Way with the pen up between strokes in meters.
    pub up_m: f64,
    /// Times the pen is raised.
    pub lifts: usize,
    /// Estimated minutes.
    pub minutes: f64,
}

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
    /// The pen's path.
    pub order: f64,
    /// Page and file.
    pub write: f64,
    /// From start to end.
    pub total: f64,
}

/// What the engine counted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Pairs of segment and triangle that were tested.
    pub candidate_pairs: u64,
    /// Predicates that the floating-point filter could not decide.
    pub exact_predicates: u64,
    /// Crossings of drawn segments with cutting edges that were tested.
    pub contour_crossings: u64,
    /// Edges that an engine handed to a more careful one.
    pub fallback_edges: u64,
    /// Edges whose counts contradict others; anything but zero is a fault of the program.
    pub checksum_failures: u64,
    /// Sight lines along which all layers were counted.
    pub sight_lines: u64,
    /// Pairs of triangles whose boxes touch, tested for lines of intersection.
    pub intersection_pairs: u64,
    /// What the face engine counted, where areas are filled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fill: Option<FaceWork>,
}

impl Stats {
    /// Counts what the scene is made of.
    pub fn count(&mut self, scene: &Scene) {
        self.vertices = scene.mesh().positions().len();
        self.faces = scene.mesh().n_faces();
        self.triangles = scene.triangles().len();
        self.edges = scene.topology().edges().len();
        self.intersections = scene.intersections().lines().len();
        self.counts.intersection_pairs = scene.intersections().n_pairs();
    }
}

/// Does `work` and adds its wall time to `seconds`.
pub fn timed<T>(seconds: &mut f64, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *seconds += start.elapsed().as_secs_f64();
    result
}

/// The most memory this process ever had resident, in bytes; 0 where the system does not tell.
pub fn peak_bytes() -> u64 {
    std::fs::read_to_string("/proc/self/status").map_or(0, |status| peak_in_status(&status))
}

/// Finds `VmHWM:   1234 kB` in Linux's process status.
fn peak_in_status(status: &str) -> u64 {
    status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))
        .and_then(|value| value.trim().strip_suffix("kB"))
        .and_then(|kilobytes| kilobytes.trim().parse::<u64>().ok())
        .map_or(0, |kilobytes| kilobytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::peak_in_status;

    #[test]
    fn peak_memory_is_read_from_the_process_status() {
        assert_eq!(peak_in_status("Name:\tx\nVmHWM:\t    2048 kB\nVmRSS: 1 kB\n"), 2 << 20);
        assert_eq!(peak_in_status("Name:\tx\n"), 0);
    }
}
