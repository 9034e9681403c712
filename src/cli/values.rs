//! Parsers of single values, with messages that say what is expected.

use glam::DVec3;
use hiddenline::draw::LineSelection;
use hiddenline::page::{Dash, parse_length_mm};
use hiddenline::strokes::StrokeKind;

/// A finite number.
pub(super) fn number(text: &str) -> Result<f64, String> {
    let number = text
        .trim()
        .parse::<f64>()
        .map_err(|_| "not a number".to_owned())?;
    if number.is_finite() {
        Ok(number)
    } else {
        Err("the number must be finite".into())
    }
}

/// A finite number above 0.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    number(text).and_then(|x| {
        if x > 0.0 {
            Ok(x)
        } else {
            Err("must be above 0".into())
        }
    })
}

/// A finite number, 0 or above.
pub(super) fn not_negative(text: &str) -> Result<f64, String> {
    number(text).and_then(|x| {
        if x >= 0.0 {
            Ok(x)
        } else {
            Err("must be 0 or above".into())
        }
    })
}

/// Degrees from 0 to 180.
pub(super) fn crease(text: &str) -> Result<f64, String> {
    not_negative(text).and_then(|x| {
        if x <= 180.0 {
            Ok(x)
        } else {
            Err("at most 180".into())
        }
    })
}

/// Degrees between 0 and 180.
pub(super) fn field_of_view(text: &str) -> Result<f64, String> {
    positive(text).and_then(|x| {
        if x < 180.0 {
            Ok(x)
        } else {
            Err("must be below 180".into())
        }
    })
}

/// Three numbers with commas between them.
pub(super) fn vector(text: &str) -> Result<DVec3, String> {
    let numbers = text.split(',').map(number).collect::<Result<Vec<_>, _>>();
    match numbers.as_deref() {
        Ok(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
        _ => Err("give three numbers with commas between them, as in 3,-2,1.5".into()),
    }
}

/// A length in millimetres, 0 or above.
pub(super) fn length(text: &str) -> Result<f64, String> {
    let length = parse_length_mm(text).map_err(|error| error.to_string())?;
    if length >= 0.0 {
        Ok(length)
    } else {
        Err("must be 0 or above".into())
    }
}

/// A length in millimetres, above 0.
pub(super) fn positive_length(text: &str) -> Result<f64, String> {
    length(text).and_then(|x| {
        if x > 0.0 {
            Ok(x)
        } else {
            Err("must be above 0".into())
        }
    })
}

/// Lengths of dash and gap.
pub(super) fn dash(text: &str) -> Result<Dash, String> {
    let both = || "give the lengths of dash and gap in mm, as in 2.5,1.25".to_owned();
    let (dash, gap) = text.split_once(',').ok_or_else(both)?;
    Ok(Dash {
        dash_mm: positive_length(dash)?,
        gap_mm: positive_length(gap)?,
    })
}

/// Length on paper for a unit of length: `1:10`, `2:1`, or a plain factor.
pub(super) fn scale(text: &str) -> Result<f64, String> {
    let (paper, model) = text.split_once(':').unwrap_or((text, "1"));
    let scale = positive(paper).and_then(|paper| Ok(paper / positive(model)?));
    match scale {
        Ok(scale) if scale > 0.0 && scale.is_finite() => Ok(scale),
        _ => Err("give a scale as in 1:10".into()),
    }
}

/// Kinds of line with commas between them.
pub(super) fn lines(text: &str) -> Result<LineSelection, String> {
    text.split(',')
        .try_fold(LineSelection::NONE, |lines, name| {
            Ok(match name.trim() {
                "all" => lines.union(LineSelection::all_edges()),
                "silhouette" => lines.with(StrokeKind::Silhouette),
                "crease" => lines.with(StrokeKind::Crease),
                "boundary" => lines.with(StrokeKind::Boundary),
                "nonmanifold" => lines.with(StrokeKind::Nonmanifold),
                "intersection" => lines.with(StrokeKind::Intersection),
                "mesh" => lines.with(StrokeKind::Mesh),
                other => {
                    return Err(format!(
                        "`{other}` is no kind of line; there are silhouette, crease, boundary, \
                     nonmanifold, intersection, mesh, and all"
                    ));
                }
            })
        })
}
