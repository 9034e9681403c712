//! What the page shows of a drawing besides its strokes: camera, page and pens.

use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::page::{Page, PageOptions, PenRole, PenRule, Placement};
use hiddenline::stages::plot::{Pen, Plot};
use hiddenline::stages::strokes::StrokeKind;
use serde::Serialize;
use serde_json::{Value, json};

/// Where a drawing is seen from, and where it is on paper.
pub(super) struct Placed {
    pub(super) camera: Camera,
    pub(super) page: PageOptions,
    pub(super) sheet: Page,
}

/// A pen of a drawing.
#[derive(Serialize)]
pub(super) struct PenFacts<'a> {
    pub(super) number: u32,
    pub(super) name: &'a str,
    pub(super) width: f64,
    pub(super) color: &'a str,
}

/// What both kinds of answers tell.
pub(super) fn facts(seq: u32, placed: &Placed, pens: &[PenFacts]) -> Value {
    let Placed { camera, page, sheet } = placed;
    let (projection, fov) = match camera.projection() {
        Projection::Perspective { fov_deg, .. } => ("perspective", Some(fov_deg)),
        Projection::Orthographic => ("orthographic", None),
    };
    let (placement, value) = match page.placement {
        Placement::Fit => ("fit", None),
        Placement::Scale { mm_per_unit } => ("scale", Some(mm_per_unit)),
        Placement::FieldOfView => ("fov", None),
        Placement::ViewHeight { model_units } => ("height", Some(model_units)),
    };
    let map = sheet.page_from_image;
    json!({
        "seq": seq,
        "exact": false,
        "camera": {
            "eye": camera.eye().to_array(),
            "target": camera.target().to_array(),
            "up": camera.up().to_array(),
            "projection": projection,
            "fov": fov,
        },
        "page": {
            "width": sheet.paper.width_mm,
            "height": sheet.paper.height_mm,
            "margin": sheet.margin_mm,
            "description": sheet.paper.description(),
            "placement": placement,
            "value": value,
            "scale": map.matrix2.x_axis.x,
            "origin": map.translation.to_array(),
        },
        "pens": pens,
    })
}

pub(super) fn extend(facts: &mut Value, more: Value) {
    if let (Value::Object(facts), Value::Object(more)) = (facts, more) {
        facts.extend(more);
    }
}

pub(super) fn pens_of(plot: &Plot) -> Vec<PenFacts<'_>> {
    let facts = plot.layers.iter().map(|layer| PenFacts {
        number: layer.number,
        name: &layer.name,
        width: layer.pen.width_mm,
        color: &layer.pen.color,
    });
    facts.collect()
}

/// The pens of visible lines, and for each kind of line which of them draws it.
pub(super) fn pens_by_kind(rules: &[PenRule], width_mm: f64) -> (Vec<PenRule>, Vec<u32>) {
    let usual = || PenRule {
        drawn: PenRole::Visible,
        number: 1,
        pen: Pen { width_mm, ..Default::default() },
        controls: Default::default(),
    };
    let of = |role| rules.iter().rev().find(|rule| rule.drawn == role);
    let mut pens = vec![of(PenRole::Visible).cloned().unwrap_or_else(usual)];
    let by_kind = StrokeKind::ALL.map(|kind| match of(PenRole::Kind(kind)) {
        Some(rule) => {
            pens.push(rule.clone());
            pens.len() as u32 - 1
        }
        None => 0,
    });
    (pens, by_kind.to_vec())
}
