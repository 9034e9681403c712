//! Level curves on the base of the box around a surface.
//!
//! ```text
//!      ╭╮             The curves of the surface, straight below on the face that the box stands on. Like
//!     ╭╯╰╮            other lines there they hide nothing, and the surface may hide them.
//!   ┌─────────┐
//!    ╲ (◯) ╲
//! ```

use glam::DVec3;

use super::around::visible_parts;
use crate::axes::Wire;
use crate::camera::Camera;
use crate::model::scene::Scene;
use crate::strokes::{StrokeKind, Strokes};
use crate::surface::LevelCurve;

/// The visible parts of level curves on the base at height `z`, chained along each curve, or one stroke for
/// each piece if they are to be `separate`.
pub(super) fn base_levels(
    curves: &[LevelCurve],
    z: f64,
    scene: &Scene,
    camera: &Camera,
    separate: bool,
) -> Strokes {
    let segments: Vec<Wire> = curves
        .iter()
        .flat_map(|curve| curve.points.windows(2))
        .map(|pair| Wire { ends: [0, 1].map(|k| pair[k].with_z(z)), kind: StrokeKind::LevelBase })
        .collect();
    let mut parts = visible_parts(&segments, scene, camera).into_iter().zip(&segments);
    let mut strokes = Strokes::default();
    for curve in curves {
        let mut stroke = Vec::new();
        let mut end = |stroke: &mut Vec<_>| {
            strokes.push_part(StrokeKind::LevelBase, curve.part, stroke.drain(..));
        };
        for (parts, wire) in parts.by_ref().take(curve.points.len() - 1) {
            let at = |t: f64| camera.image(DVec3::lerp(wire.ends[0], wire.ends[1], t));
            for &[from, to] in &parts {
                if separate || from > 0.0 || stroke.is_empty() {
                    end(&mut stroke);
                    stroke.push(at(from));
                }
                stroke.push(at(to));
            }
            if parts.last().is_none_or(|part| part[1] < 1.0) {
                end(&mut stroke);
            }
        }
        end(&mut stroke);
    }
    strokes
}
