//! Transforms as attributes and as CSS writes them, with units, about an origin.

use std::str::FromStr;

use kurbo::{Affine, Point};
use svgtypes::{Angle, Length, TransformOrigin};

use super::style::user_units;

/// Reads a `transform` attribute.
pub(super) fn parse_attribute(text: &str) -> Result<Affine, ()> {
    let t = svgtypes::Transform::from_str(text).map_err(|_| ())?;
    Ok(Affine::new([t.a, t.b, t.c, t.d, t.e, t.f]))
}

/// Reads the CSS property `transform`; percentages are of `size`. Transforms in space are an error.
pub(super) fn parse_css(text: &str, size: [f64; 2]) -> Result<Affine, ()> {
    let mut rest = text.trim();
    let mut all = Affine::IDENTITY;
    if rest == "none" {
        return Ok(all);
    }
    while !rest.is_empty() {
        let (name, tail) = rest.split_once('(').ok_or(())?;
        let (arguments, tail) = tail.split_once(')').ok_or(())?;
        rest = tail.trim_start_matches([' ', '\t', '\r', '\n', ',']);
        let arguments: Vec<&str> = arguments
            .split([',', ' ', '\t', '\r', '\n'])
            .filter(|argument| !argument.is_empty())
            .collect();
        all *= function(name.trim(), &arguments, size)?;
    }
    if all.is_finite() { Ok(all) } else { Err(()) }
}

fn function(name: &str, arguments: &[&str], size: [f64; 2]) -> Result<Affine, ()> {
    let length = |text: &str, axis: usize| {
        let length = Length::from_str(text).map_err(|_| ())?;
        user_units(length, size[axis]).ok_or(())
    };
    let angle =
        |text: &str| Angle::from_str(text).map(|a| a.to_degrees().to_radians()).map_err(|_| ());
    let factor = |text: &str| {
        let (text, unit) = text.strip_suffix('%').map_or((text, 1.0), |text| (text, 0.01));
        text.parse::<f64>().map(|value| value * unit).map_err(|_| ())
    };
    let skew = |x: f64, y: f64| Affine::new([1.0, libm::tan(y), libm::tan(x), 1.0, 0.0, 0.0]);
    Ok(match (name, arguments) {
        ("translate", [x]) | ("translateX", [x]) => Affine::translate((length(x, 0)?, 0.0)),
        ("translate", [x, y]) => Affine::translate((length(x, 0)?, length(y, 1)?)),
        ("translateY", [y]) => Affine::translate((0.0, length(y, 1)?)),
        ("scale", [s]) => Affine::scale(factor(s)?),
        ("scale", [x, y]) => Affine::scale_non_uniform(factor(x)?, factor(y)?),
        ("scaleX", [x]) => Affine::scale_non_uniform(factor(x)?, 1.0),
        ("scaleY", [y]) => Affine::scale_non_uniform(1.0, factor(y)?),
        ("rotate" | "rotateZ", [a]) => rotation(angle(a)?),
        ("skew" | "skewX", [x]) => skew(angle(x)?, 0.0),
        ("skew", [x, y]) => skew(angle(x)?, angle(y)?),
        ("skewY", [y]) => skew(0.0, angle(y)?),
        ("matrix", [a, b, c, d, e, f]) => Affine::new([
            factor(a)?,
            factor(b)?,
            factor(c)?,
            factor(d)?,
            length(e, 0)?,
            length(f, 1)?,
        ]),
        _ => return Err(()),
    })
}

/// Not kurbo's, whose sine depends on the machine.
fn rotation(angle: f64) -> Affine {
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    Affine::new([cos, sin, -sin, cos, 0.0, 0.0])
}

/// `transform` about the origin that `transform-origin` gives, from `corner`; percentages are of `size`.
pub(super) fn about_origin(
    transform: Affine,
    origin: &str,
    size: [f64; 2],
    corner: Point,
) -> Result<Affine, ()> {
    let origin = TransformOrigin::from_str(origin).map_err(|_| ())?;
    let x = corner.x + user_units(origin.x_offset, size[0]).ok_or(())?;
    let y = corner.y + user_units(origin.y_offset, size[1]).ok_or(())?;
    Ok(Affine::translate((x, y)) * transform * Affine::translate((-x, -y)))
}
