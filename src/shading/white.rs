//! Hidden lines removed by painting over them: faces filled with white from far to near, the edges of
//! each drawn on top of it.
//!
//! ```text
//!   far face    + edges       + near face    + edges
//!    ░░░░░       ┌───┐         ┌───┐          ┌───┐
//!    ░░░░░       │   │         │ ░░░░░        │ ┌───┐      each face erases the edges
//!    ░░░░░       └───┘         └─░░░░░        └─│   │      that it hides
//!                                ░░░░░          └───┘
//! ```
//!
//! What remains visible is the drawing of [`draw`](crate::draw): the same edges, found without computing
//! visibility along any line. It is a picture, not a set of strokes: hidden edges are still there beneath
//! the white.
//!
//! Source: lecture notes on visibility (Slovak), section 5, the first of its two ways to remove hidden
//! lines.
//!
//! Cannot: draw lines that are not edges of a painted face, such as those in which faces cross.

use glam::DVec2;

use crate::camera::Camera;
use crate::classify::{LineSelection, ViewedScene};
use crate::engines::face::painting::{PaintedPiece, Ring};
use crate::engines::face::{FaceOptions, Prepared};
use crate::plot::{FillLayer, Fills};
use crate::predicates::Sign;
use crate::shading::fill::{FillError, Filled};

/// The paper.
const WHITE: [u8; 3] = [0xff; 3];

/// A picture, and how many lines it lacks.
#[derive(Debug, Clone, PartialEq)]
pub struct PaintedOver {
    /// White areas, each with the edges on its border as outlines.
    pub filled: Filled,
    /// Selected lines that are on no painted face: wires, lines in which faces cross, bends, and edges
    /// of faces seen edge-on. They are left out.
    pub n_left_out: usize,
}

/// Paints faces white from far to near, each with those of its edges that `lines` selects.
///
/// Of edges selected as outline only, nothing is drawn. `crease_deg` is in degrees. O(fragments) after
/// the engine.
///
/// # Errors
/// [`FillError::NotPaintedOver`] for an engine whose areas are side by side; errors of the engine.
pub fn paint_over(
    prepared: &Prepared,
    camera: &Camera,
    options: &FaceOptions,
    lines: LineSelection,
    crease_deg: f64,
) -> Result<PaintedOver, FillError> {
    let (painting, work) = prepared.solve(camera, options)?;
    let engine = work.engine();
    if painting.is_disjoint {
        return Err(FillError::NotPaintedOver(engine.name()));
    }
    let view = ViewedScene::new(prepared.scene(), camera, lines, crease_deg);
    let mut is_drawn = vec![false; prepared.scene().n_lines()];
    let mut n_left_out = 0;
    for drawn in view.selected() {
        let is_whole = !view.is_only_outline(drawn.edge);
        is_drawn[drawn.edge as usize] = is_whole && is_on_painted_face(&view, drawn.edge);
        n_left_out += usize::from(is_whole && !is_drawn[drawn.edge as usize]);
    }
    let mut fills = Fills::default();
    for piece in painting.pieces() {
        let rings = piece.rings().map(|ring| ring.points.iter().copied());
        fills.push_outlined(WHITE, rings, outlines(&piece, &is_drawn));
    }
    let layers = vec![FillLayer { name: "white".into(), color: WHITE, fills }];
    let n_pieces = painting.len();
    let filled = Filled { layers, engine, is_disjoint: false, n_pieces, work: Some(work) };
    Ok(PaintedOver { filled, n_left_out })
}

/// Whether a line is an edge of a face that is not seen edge-on.
fn is_on_painted_face(view: &ViewedScene, line: u32) -> bool {
    let topology = view.scene().topology();
    (line as usize) < topology.edges().len()
        && topology.uses(line).iter().any(|along| view.facing(along.face()) != Sign::Zero)
}

/// The parts of a piece's border that are on drawn lines.
fn outlines(piece: &PaintedPiece, is_drawn: &[bool]) -> Vec<Vec<DVec2>> {
    let mut outlines = Vec::new();
    for ring in piece.rings() {
        push_runs(&ring, is_drawn, &mut outlines);
    }
    outlines
}

/// Joins drawn sides that follow each other.
fn push_runs(ring: &Ring, is_drawn: &[bool], outlines: &mut Vec<Vec<DVec2>>) {
    let n = ring.points.len();
    // NO_LINE is beyond all lines.
    let is_drawn = |side: usize| is_drawn.get(ring.lines[side] as usize) == Some(&true);
    // Start after a gap, so that no run is split where the ring begins.
    let first = (0..n).find(|&side| !is_drawn(side)).map_or(0, |gap| gap + 1);
    let mut run: Vec<DVec2> = Vec::new();
    for side in (first..first + n).map(|side| side % n) {
        if !is_drawn(side) {
            if !run.is_empty() {
                outlines.push(std::mem::take(&mut run));
            }
            continue;
        }
        if run.is_empty() {
            run.push(ring.points[side]);
        }
        run.push(ring.points[(side + 1) % n]);
    }
    if !run.is_empty() {
        outlines.push(run);
    }
}
