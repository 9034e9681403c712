//! Areas on the page: mapped, and cropped at the margins.

use glam::{DAffine2, DVec2};

use crate::engines::face::painting::NO_LINE;
use crate::engines::face::region::{Region, SnapGrid};
use crate::extent::window::Window;
use crate::plot::Fills;

/// The areas on the page, and whether any was cropped.
pub(super) fn placed(
    fills: &Fills,
    map: &DAffine2,
    window: &Window,
    seam_mm: f64,
) -> (Fills, bool) {
    let mut result = Fills::default();
    result.seam_mm = seam_mm;
    let mut cropped = false;
    let (low, high) = (window.low - window.slack, window.high + window.slack);
    for area in fills.iter() {
        let rings: Vec<Vec<DVec2>> = area
            .rings()
            .map(|ring| ring.iter().map(|&p| map.transform_point2(p)).collect())
            .collect();
        let points = || rings.iter().flatten();
        if points().all(|p| p.cmpge(low).all() && p.cmple(high).all()) {
            let clamp = |p: &DVec2| p.clamp(window.low, window.high);
            let outlines =
                area.outlines().map(|line| line.iter().map(|&p| clamp(&map.transform_point2(p))));
            let outlines = outlines.map(Iterator::collect);
            result.push_outlined(
                area.color,
                rings.iter().map(|ring| ring.iter().map(clamp)),
                outlines,
            );
            continue;
        }
        cropped = true;
        let nothing = (window.low, window.high);
        let (low, high) = points().fold(nothing, |(low, high), p| (low.min(*p), high.max(*p)));
        let grid = SnapGrid::new(low, high);
        let on_grid = |p: &DVec2| (grid.snap(*p), NO_LINE);
        let region = Region::of_rings(rings.iter().map(|ring| ring.iter().map(on_grid)));
        let (a, b) = (window.low, window.high);
        let corners = [a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)];
        let inside = region.within(&Region::of_rings([corners.iter().map(on_grid)]));
        for part in inside.parts() {
            let point = |from: DVec2| grid.point(from).clamp(window.low, window.high);
            result.push(
                area.color,
                part.iter()
                    .map(|ring| ring.iter().map(|side| point(side.from)).collect::<Vec<_>>()),
            );
        }
        let mut outlines = Vec::new();
        for outline in area.outlines() {
            let mut line: Vec<DVec2> = outline.iter().map(|&p| map.transform_point2(p)).collect();
            window.crop(&mut line, |piece| outlines.push(piece.to_vec()));
        }
        // Over all parts: an area without rings.
        result.push_outlined(area.color, [] as [Vec<DVec2>; 0], outlines);
    }
    (result, cropped)
}
