//! A drawn line as the engines see it: its ends, its part beyond the near plane, and its image.

use crate::classify::ViewedScene;
use crate::predicates::Cut;
use glam::DVec2;

/// An edge or other line, clipped by the near plane, with its rounded image for quick rejection.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    /// Its number among the lines of the scene.
    pub edge: u32,
    /// Its endpoints, in the direction of the parameter.
    pub ends: [u32; 2],
    /// Where the kept part begins.
    pub from: Cut,
    /// Where the kept part ends.
    pub to: Cut,
    /// Rounded images of the kept part's ends.
    pub image: [DVec2; 2],
    /// Rounded depths of the kept part's ends, along the direction of view.
    pub depth: [f64; 2],
}

impl Segment {
    /// The part of a line that the near plane keeps; `None` when nothing of it is left.
    pub(super) fn new(view: &ViewedScene, edge: u32) -> Option<Self> {
        let ends = view.line(edge);
        let sight = view.sight();
        let [from, to] = match view.near_plane_cuts() {
            true => sight.kept_of_segment(ends)?,
            false => [Cut::START, Cut::END],
        };
        let points = ends.map(|end| view.image()[end as usize]);
        let points = [from.t, to.t].map(|t| points[0].towards(points[1], t));
        Some(Self {
            edge,
            ends,
            from,
            to,
            image: points.map(|point| point.image()),
            depth: points.map(|point| point.depth),
        })
    }
}
