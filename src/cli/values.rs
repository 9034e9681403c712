//! Parsers of single values, with messages that say what is expected.

use std::ffi::OsStr;
use std::time::Duration;

use clap::builder::{PossibleValue, TypedValueParser};
use clap::{Arg, Command};
use glam::DVec3;
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::model::smooth::SmoothParts;
use hiddenline::stages::optimize::Effort;
use hiddenline::stages::page::{Dash, LayerControls, PenRole, parse_length_mm};
use hiddenline::stages::shading::preview::LARGEST_SIDE;
use hiddenline::stages::strokes::{GridFamily, StrokeKind};

use super::suggestion::suggestion;

/// What `--levels` stands for without a value.
pub(super) const ROUND_STEP: &str = "round";

/// What `--legend` stands for without a value.
pub(super) const USUAL_PLACE: &str = "right";

/// Texts with commas between them; `\,` is a comma in a text.
pub(super) fn with_commas(text: &str) -> Vec<String> {
    let mut texts = vec![String::new()];
    let mut characters = text.chars().peekable();
    while let Some(character) = characters.next() {
        let last = texts.len() - 1;
        match character {
            '\\' if characters.peek() == Some(&',') => {
                characters.next();
                texts[last].push(',');
            }
            ',' => texts.push(String::new()),
            _ => texts[last].push(character),
        }
    }
    texts
}

/// A finite number.
pub(super) fn number(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().map_err(|_| "not a number".to_owned())?;
    if number.is_finite() { Ok(number) } else { Err("the number must be finite".into()) }
}

/// A finite number above 0.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    number(text).and_then(|x| if x > 0.0 { Ok(x) } else { Err("must be above 0".into()) })
}

/// A finite number, 0 or more.
pub(super) fn not_negative(text: &str) -> Result<f64, String> {
    number(text).and_then(|x| if x >= 0.0 { Ok(x) } else { Err("must be 0 or more".into()) })
}

/// Degrees from 0 to 180.
pub(super) fn crease(text: &str) -> Result<f64, String> {
    not_negative(text)
        .and_then(|x| if x <= 180.0 { Ok(x) } else { Err("must be at most 180".into()) })
}

/// Which parts of a model are smooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Smooth {
    Off,
    Parts(SmoothParts),
}

/// `off`, `auto`, or degrees from 0 to 180.
pub(super) fn smooth(text: &str) -> Result<Smooth, String> {
    match text {
        "off" => Ok(Smooth::Off),
        "auto" => Ok(Smooth::Parts(SmoothParts::ByNormals)),
        _ => match crease(text) {
            Ok(degrees) => Ok(Smooth::Parts(SmoothParts::Below(degrees))),
            Err(_) => Err("expected off, auto, or an angle from 0 to 180 degrees".into()),
        },
    }
}

/// Degrees between 0 and 180.
pub(super) fn field_of_view(text: &str) -> Result<f64, String> {
    positive(text).and_then(|x| if x < 180.0 { Ok(x) } else { Err("must be below 180".into()) })
}

/// Three numbers with commas between them.
pub(super) fn vector(text: &str) -> Result<DVec3, String> {
    let numbers = text.split(',').map(number).collect::<Result<Vec<_>, _>>();
    match numbers.as_deref() {
        Ok(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
        _ => Err("expected three numbers separated by commas, as in 3,-2,1.5".into()),
    }
}

/// Three numbers with commas between them that are not all zero.
pub(super) fn direction(text: &str) -> Result<DVec3, String> {
    vector(text)
        .and_then(|v| if v == DVec3::ZERO { Err("0,0,0 is not a direction".into()) } else { Ok(v) })
}

/// A length in millimeters, 0 or more.
pub(super) fn length(text: &str) -> Result<f64, String> {
    let length = parse_length_mm(text).map_err(|error| error.to_string())?;
    if length >= 0.0 { Ok(length) } else { Err("must be 0 or more".into()) }
}

/// A length in millimeters, above 0.
pub(super) fn positive_length(text: &str) -> Result<f64, String> {
    let length = parse_length_mm(text).map_err(|error| error.to_string())?;
    if length > 0.0 { Ok(length) } else { Err("must be above 0".into()) }
}

/// A length in millimeters, above 0, or in meters as in `10m`.
pub(super) fn distance(text: &str) -> Result<f64, String> {
    let meters =
        text.trim().strip_suffix('m').filter(|t| t.ends_with(|c: char| c != 'm' && c != 'c'));
    match meters {
        Some(meters) => positive(meters).map(|meters| meters * 1000.0),
        None => positive_length(text),
    }
}

/// Lengths of dash and gap.
pub(super) fn dash(text: &str) -> Result<Dash, String> {
    let both = || "expected dash and gap lengths in mm, as in 2.5,1.25".to_owned();
    let (dash, gap) = text.split_once(',').ok_or_else(both)?;
    Ok(Dash { dash_mm: positive_length(dash)?, gap_mm: positive_length(gap)? })
}

/// Length on paper for a unit of length: `1:10`, `2:1`, or a plain factor.
pub(super) fn scale(text: &str) -> Result<f64, String> {
    let (paper, model) = text.split_once(':').unwrap_or((text, "1"));
    let scale = positive(paper).and_then(|paper| Ok(paper / positive(model)?));
    match scale {
        Ok(scale) if scale > 0.0 && scale.is_finite() => Ok(scale),
        _ => Err("expected a scale such as 1:10".into()),
    }
}

/// What [`lines`] knows.
const KINDS_OF_LINE: [&str; 11] = [
    "silhouette",
    "crease",
    "boundary",
    "nonmanifold",
    "intersection",
    "wire",
    "material",
    "mesh",
    "outline",
    "shadow",
    "all",
];

/// Takes what [`lines`] takes, and lists the names for completions and for the viewer.
#[derive(Clone)]
pub(super) struct KindsOfLine;

impl TypedValueParser for KindsOfLine {
    type Value = LineSelection;

    fn parse_ref(
        &self,
        command: &Command,
        arg: Option<&Arg>,
        value: &OsStr,
    ) -> Result<LineSelection, clap::Error> {
        let parse: fn(&str) -> Result<LineSelection, String> = lines;
        parse.parse_ref(command, arg, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(KINDS_OF_LINE.into_iter().map(PossibleValue::new)))
    }
}

/// Kinds of line with commas between them.
fn lines(text: &str) -> Result<LineSelection, String> {
    text.split(',').try_fold(LineSelection::NONE, |lines, name| {
        Ok(match name.trim() {
            "all" => lines.union(LineSelection::all_edges()),
            "silhouette" => lines.with(StrokeKind::Silhouette),
            "crease" => lines.with(StrokeKind::Crease),
            "boundary" => lines.with(StrokeKind::Boundary),
            "nonmanifold" => lines.with(StrokeKind::Nonmanifold),
            "intersection" => lines.with(StrokeKind::Intersection),
            "wire" => lines.with(StrokeKind::Wire),
            "material" => lines.with(StrokeKind::Material),
            "mesh" => lines.with(StrokeKind::Mesh),
            "outline" => lines.with_outline(),
            "shadow" => lines.with(StrokeKind::Shadow),
            other => {
                let hint = suggestion(other, KINDS_OF_LINE.into_iter());
                return Err(format!("unknown line kind `{other}`{hint}"));
            }
        })
    })
}

/// How long to search for a short way: a name, or seconds as in `10s`.
pub(super) fn effort(text: &str) -> Result<Effort, String> {
    match text.trim() {
        "none" => Ok(Effort::None),
        "fast" => Ok(Effort::Fast),
        "best" => Ok(Effort::Best),
        other => {
            let seconds = other.strip_suffix('s').and_then(|seconds| seconds.parse::<f64>().ok());
            seconds
                .filter(|seconds| *seconds > 0.0)
                .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
                .map(Effort::Within)
                .ok_or_else(|| "expected none, fast, best, or a time limit such as 10s".to_owned())
        }
    }
}

/// A pen as it is typed: what it draws, its number, and what else is said of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PenText {
    pub(super) drawn: PenRole,
    pub(super) number: u32,
    pub(super) width_mm: Option<f64>,
    /// `#rrggbb`.
    pub(super) color: Option<String>,
    /// Layer controls for AxiDraw's software.
    pub(super) controls: LayerControls,
}

/// A pen as `visible=1:0.3mm:black`; width and color may be left out.
pub(super) fn pen(text: &str) -> Result<PenText, String> {
    let example = || "expected a pen such as visible=1:0.3mm:black".to_owned();
    let (drawn, rest) = text.split_once('=').ok_or_else(example)?;
    let is_control = |part: &&str| *part == "pause" || part.contains('=');
    let (controls, parts): (Vec<&str>, Vec<&str>) =
        rest.split(':').map(str::trim).partition(is_control);
    let mut parts = parts.into_iter();
    let number = parts.next().unwrap_or_default().parse().ok();
    let number = number.filter(|n| (1..=1000).contains(n));
    let pen = PenText {
        drawn: drawn_by_pen(drawn.trim())?,
        number: number.ok_or("pens have numbers from 1 to 1000, as in visible=1:0.3mm:black")?,
        width_mm: parts.next().filter(|w| !w.is_empty()).map(positive_length).transpose()?,
        color: parts.next().filter(|c| !c.is_empty()).map(color).transpose()?,
        controls: layer_controls(&controls)?,
    };
    if parts.next().is_some() { Err(example()) } else { Ok(pen) }
}

/// What follows the color of a pen, as `speed=30` and `pause`.
fn layer_controls(parts: &[&str]) -> Result<LayerControls, String> {
    let mut controls = LayerControls::default();
    for part in parts {
        let (name, value) = part.split_once('=').unwrap_or((part, ""));
        let number = |low: u32, high: u32| {
            let value = value.trim().parse().ok().filter(|n| (low..=high).contains(n));
            value
                .map(Some)
                .ok_or_else(|| format!("`{part}`: expected a number from {low} to {high}"))
        };
        match name.trim() {
            "pause" => controls.pause = true,
            "speed" => controls.speed = number(1, 110)?,
            "height" => controls.height = number(0, 100)?,
            "delay" => controls.delay_ms = number(0, 100_000)?,
            _ => return Err(format!("`{part}`: expected speed=, height=, delay= or pause")),
        }
    }
    Ok(controls)
}

/// What pens can be given for, with the first of the hidden levels.
pub(super) fn pen_roles() -> impl Iterator<Item = PenRole> {
    let hidden = [PenRole::Hidden, PenRole::HiddenLevel(1)];
    let visible = [PenRole::Visible, PenRole::Outline, PenRole::Underside];
    let families = GridFamily::ALL.map(PenRole::Family);
    let roles = hidden.into_iter().chain(visible).chain(StrokeKind::ALL.map(PenRole::Kind));
    roles.chain(families).chain([PenRole::Sheet(1)])
}

fn drawn_by_pen(name: &str) -> Result<PenRole, String> {
    let level = name.strip_prefix("hidden").and_then(|level| level.parse().ok());
    if let Some(level @ 1..=99) = level {
        return Ok(PenRole::HiddenLevel(level));
    }
    let (sheet, line) = name.split_once('.').unwrap_or((name, ""));
    let sheet = sheet.strip_prefix("sheet").and_then(|sheet| sheet.parse().ok());
    if let Some(sheet @ 1..) = sheet {
        return match (line, drawn_by_pen(line)) {
            ("", _) => Ok(PenRole::Sheet(sheet)),
            (_, Ok(PenRole::Kind(kind))) => Ok(PenRole::KindOfSheet(sheet, kind)),
            (_, Ok(PenRole::Family(family))) => Ok(PenRole::FamilyOfSheet(sheet, family)),
            (_, Ok(_)) => Err(format!("`{line}` is not a line kind of a sheet")),
            (_, Err(error)) => Err(error),
        };
    }
    if name == "border" {
        return Ok(PenRole::Kind(StrokeKind::Boundary));
    }
    pen_roles().find(|drawn| drawn.name() == name).ok_or_else(|| {
        let names: Vec<_> = pen_roles().map(PenRole::name).collect();
        let names = names.iter().map(AsRef::as_ref);
        format!("unknown line kind `{name}`{}", suggestion(name, names))
    })
}

/// The bytes of a color by name or as `#rgb`, `#rrggbb`, `rgb(…)`.
pub(super) fn rgb(text: &str) -> Result<[u8; 3], String> {
    let color: svgtypes::Color =
        text.parse().map_err(|_| format!("`{text}` is not a color; use a name or #rrggbb"))?;
    Ok([color.red, color.green, color.blue])
}

/// Columns and rows of a picture.
pub(super) fn picture_size(text: &str) -> Result<(u32, u32), String> {
    let side = |text: &str| text.trim().parse().ok().filter(|n| (1..=LARGEST_SIDE).contains(n));
    let (width, height) = text.split_once(['x', 'X']).unwrap_or((text, text));
    side(width).zip(side(height)).ok_or_else(|| {
        format!("expected WIDTHxHEIGHT, each from 1 to {LARGEST_SIDE}, as in 1200x900")
    })
}

/// A part of the whole, from 0 to 1.
pub(super) fn part(text: &str) -> Result<f64, String> {
    not_negative(text).and_then(|x| if x <= 1.0 { Ok(x) } else { Err("must be at most 1".into()) })
}

/// A color by name or as `#rgb`, `#rrggbb`, `rgb(…)`; the result is `#rrggbb`.
fn color(text: &str) -> Result<String, String> {
    let [red, green, blue] = rgb(text)?;
    Ok(format!("#{red:02x}{green:02x}{blue:02x}"))
}
