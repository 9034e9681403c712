//! The statistics of `--stats`: counts of a run, and how long its stages took.

use std::borrow::Cow;

use hiddenline::stages::drafting::Drafted;
use hiddenline::stages::draw::surface::Certificate;
use hiddenline::stages::draw::{DrawOutput, MeshSize};
use hiddenline::stages::engines::face::FaceWork;
use hiddenline::stages::optimize::estimate::PenWork;
use hiddenline::stages::timing::Seconds;
use serde::Serialize;

/// Counts and times of one run, serialized with fixed key names.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub(super) struct Stats {
    /// Name of the engine that drew.
    pub(super) engine: Cow<'static, str>,
    /// Number of threads.
    pub(super) threads: usize,
    /// Distinct vertices, after cleaning.
    pub(super) vertices: usize,
    /// Faces, after cleaning.
    pub(super) faces: usize,
    /// Triangles that these faces consist of, before clipping.
    pub(super) triangles: usize,
    /// Distinct edges of these faces, before clipping.
    pub(super) edges: usize,
    /// Intersection lines, before any are selected for drawing.
    pub(super) intersections: usize,
    /// Edges and intersection lines selected for drawing.
    pub(super) drawn_edges: usize,
    /// Strokes of the drawing.
    pub(super) strokes: usize,
    /// Points of all strokes.
    pub(super) points: usize,
    /// Peak resident memory in bytes; 0 if the system does not say.
    pub(super) peak_bytes: u64,
    /// Wall time of the stages.
    pub(super) seconds: Seconds,
    /// Counts of the engine.
    pub(super) counts: Counts,
    /// What refining curved parts did; none unless they were refined.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) smoothed: Option<SmoothedStats>,
    /// What finishing the lines on paper did; none for lines that stay as they are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) drafted: Option<DraftedStats>,
    /// How close the lines of a surface are to its formulas; none if that is not proved.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) certified: Option<Certified>,
    /// The work of the pens, before and after strokes were joined and ordered; none without pens.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) plot: Option<PlotStats>,
}

/// What refining curved parts did.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub(super) struct SmoothedStats {
    /// Triangles before and after.
    pub(super) triangles: [usize; 2],
    /// Greatest distance of the refined facets from the curved surface, in millimeters on paper.
    pub(super) farthest_mm: f64,
}

/// What finishing the lines on paper did; lengths in millimeters.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub(super) struct DraftedStats {
    /// Ends that were joined to others.
    joined: usize,
    /// The widest gap that was bridged: no ink was added or moved farther.
    farthest_mm: f64,
    /// Short strokes that were left out, and their length.
    dropped: usize,
    dropped_mm: f64,
    /// Ink that was left out since it lay on other ink.
    overlap_mm: f64,
    /// Ink that was left out where lines crowded each other.
    thinned_mm: f64,
    /// The share of the ink within a pen width of other ink, before lines are thinned.
    crowded_share: f64,
}

impl From<Drafted> for DraftedStats {
    fn from(drafted: Drafted) -> Self {
        Self {
            joined: drafted.n_joined,
            farthest_mm: drafted.farthest_mm,
            dropped: drafted.n_dropped,
            dropped_mm: drafted.dropped_mm,
            overlap_mm: drafted.overlap_mm,
            thinned_mm: drafted.thinned_mm,
            crowded_share: drafted.crowded_share,
        }
    }
}

/// How close the lines of a surface are to its formulas.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub(super) struct Certified {
    /// Greatest distance of a certified chord from the function, in millimeters on paper.
    bound_mm: f64,
    /// Chords of drawn lines.
    lines: usize,
    /// How many of these are not certified.
    uncertified_lines: usize,
    /// Cells between lines.
    cells: usize,
    /// How many of these are not certified.
    uncertified_cells: usize,
    /// Places on drawn lines where the surface is torn open.
    tears: usize,
    /// How often formulas were enclosed.
    jets: usize,
}

impl From<Certificate> for Certified {
    fn from(certificate: Certificate) -> Self {
        Self {
            bound_mm: certificate.bound_mm,
            lines: certificate.chords,
            uncertified_lines: certificate.uncertified_chords,
            cells: certificate.cells,
            uncertified_cells: certificate.uncertified_cells,
            tears: certificate.tears,
            jets: certificate.jets,
        }
    }
}

/// The work of the pens before and after joining and ordering.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub(super) struct PlotStats {
    /// Before joining and ordering.
    pub(super) before: PenWork,
    /// As written.
    pub(super) after: PenWork,
}

/// Counts of the engine.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub(super) struct Counts {
    /// Pairs of segment and triangle that were tested.
    pub(super) candidate_pairs: u64,
    /// Predicates that the floating-point filter could not decide.
    pub(super) exact_predicates: u64,
    /// Crossings of drawn segments with cutting edges that were tested.
    pub(super) contour_crossings: u64,
    /// Edges that an engine handed to a more careful one.
    pub(super) fallback_edges: u64,
    /// Edges whose counts contradict others; anything but zero is a fault of the program.
    pub(super) checksum_failures: u64,
    /// Sight lines along which all layers were counted.
    pub(super) sight_lines: u64,
    /// Triangles of closed bodies that were not tested, since they face away from the eye.
    pub(super) back_faces: u64,
    /// Edges between two such triangles, hidden without a test.
    pub(super) back_edges: u64,
    /// Triangles that were not tested, since they hide nothing visible.
    pub(super) culled_triangles: u64,
    /// Drawn edges that were not tested, since they certainly lie behind a surface.
    pub(super) culled_edges: u64,
    /// Pairs of triangles whose boxes touch, tested for intersection lines.
    pub(super) intersection_pairs: u64,
    /// Counts of the face engine, if areas are filled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) fill: Option<FaceWork>,
}

impl Stats {
    /// Adds the counts of drawing lines.
    pub(super) fn add(&mut self, drawn: &DrawOutput) {
        self.engine = drawn.engine.into();
        self.drawn_edges = drawn.n_lines;
        self.strokes = drawn.drawing.len();
        self.points = drawn.drawing.n_points();
        self.seconds += drawn.seconds;
        self.counts.candidate_pairs = drawn.counts.candidate_pairs;
        self.counts.contour_crossings = drawn.counts.contour_crossings;
        self.counts.fallback_edges = drawn.counts.fallback_edges;
        self.counts.checksum_failures = drawn.counts.checksum_failures;
        self.counts.sight_lines = drawn.counts.sight_lines;
        self.counts.back_faces = drawn.counts.back_faces;
        self.counts.back_edges = drawn.counts.back_edges;
        self.counts.culled_triangles = drawn.counts.culled_triangles;
        self.counts.culled_edges = drawn.counts.culled_edges;
        self.counts.exact_predicates = drawn.n_exact;
    }

    /// Adds the size of the mesh that is drawn.
    pub(super) fn count(&mut self, size: MeshSize) {
        self.vertices = size.vertices;
        self.faces = size.faces;
        self.triangles = size.triangles;
        self.edges = size.edges;
        self.intersections = size.intersections;
        self.counts.intersection_pairs = size.intersection_pairs;
    }
}

/// Peak resident memory of this process in bytes; 0 if the system does not say.
pub(super) fn peak_bytes() -> u64 {
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
