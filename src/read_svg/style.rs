//! Presentation: the few properties that decide what a pen draws, from attributes, style sheets and
//! `style`, in ascending order of precedence.

use std::collections::BTreeMap;
use std::rc::Rc;
use std::str::FromStr;

use roxmltree::Node;
use svgtypes::{Length, LengthListParser, LengthUnit, Paint};

use super::css::{Declaration, StyleSheet, declarations, with_variables, without_comments};
use super::dash_array::DashArray;
use super::region::FillRule;

/// Properties in effect for an element that its children inherit.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Style {
    /// Whether the element and its children are shown at all: `display`, and `opacity` above 0.
    pub(super) displayed: bool,
    visible: bool,
    /// The product of all `opacity` around the element.
    opacity: f64,
    color: String,
    stroke: Ink,
    fill: Ink,
    /// Which rule fills the element's area.
    pub(super) fill_rule: FillRule,
    /// Which rule fills the element's area where it clips.
    pub(super) clip_rule: FillRule,
    /// In user units.
    pub(super) stroke_width: f64,
    dashes: Vec<Length>,
    dash_offset: Length,
    /// CSS variables, without their two dashes.
    variables: Rc<BTreeMap<String, String>>,
}

/// What a stroke or a fill is painted with.
#[derive(Debug, Clone, PartialEq)]
struct Ink {
    /// `None` for no paint.
    color: Option<String>,
    /// Opacity of the paint.
    alpha: f64,
    /// `stroke-opacity` or `fill-opacity`.
    opacity: f64,
}

impl Ink {
    fn shows(&self) -> bool {
        self.color.is_some() && self.alpha > 0.0 && self.opacity > 0.0
    }

    fn set(&mut self, value: &str, around: &Self, current: &str) {
        (self.color, self.alpha) = match Paint::from_str(value) {
            Ok(Paint::None) => (None, 1.0),
            Ok(Paint::Inherit) => (around.color.clone(), around.alpha),
            Ok(Paint::Color(color)) => (Some(hex(color)), f64::from(color.alpha) / 255.0),
            Ok(Paint::CurrentColor) => (Some(current.to_owned()), 1.0),
            // Gradients and patterns.
            Ok(_) => (Some("#000000".to_owned()), 1.0),
            Err(_) => match color_of(value) {
                Some(color) => (Some(hex(color)), f64::from(color.alpha) / 255.0),
                // As everywhere in CSS, an invalid value has no effect.
                None => return,
            },
        };
    }
}

/// Properties of an element that its children do not inherit.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct OwnStyle {
    /// CSS `transform`, which replaces the attribute.
    pub(super) transform: Option<String>,
    /// `transform-origin`, as a property or an attribute.
    pub(super) transform_origin: Option<String>,
    /// `transform-box: fill-box`: origin and percentages are of the element's own box.
    pub(super) turns_in_own_box: bool,
    /// `clip-path`.
    pub(super) clip_path: Option<String>,
    /// Whether there is a `mask`.
    pub(super) has_mask: bool,
    /// `overflow: visible`, for pictures within pictures.
    pub(super) overflows: bool,
    /// `vector-effect: non-scaling-stroke`.
    pub(super) keeps_stroke_width: bool,
    /// Attributes of shapes that are set by CSS: `d`, `cx`, `width` and so on.
    pub(super) geometry: Vec<(String, String)>,
}

/// Attributes of shapes that are properties in CSS.
const GEOMETRY: [&str; 10] = ["d", "cx", "cy", "r", "rx", "ry", "x", "y", "width", "height"];

impl Default for Style {
    fn default() -> Self {
        let black = Some("#000000".to_owned());
        Self {
            displayed: true,
            visible: true,
            opacity: 1.0,
            color: "#000000".to_owned(),
            stroke: Ink { color: None, alpha: 1.0, opacity: 1.0 },
            fill: Ink { color: black, alpha: 1.0, opacity: 1.0 },
            fill_rule: FillRule::NonZero,
            clip_rule: FillRule::NonZero,
            stroke_width: 1.0,
            dashes: Vec::new(),
            dash_offset: Length::zero(),
            variables: Rc::default(),
        }
    }
}

impl Style {
    /// Whether a shape's outline is drawn: it has a stroke, or a fill that shows where it is.
    pub(super) fn is_seen(&self) -> bool {
        self.visible && (self.has_stroke() || self.fill.shows())
    }

    /// Whether the shape counts when it clips others, where paint does not matter.
    pub(super) fn is_visible(&self) -> bool {
        self.visible
    }

    /// Whether a pen follows the shape's outline because it has a stroke.
    pub(super) fn has_stroke(&self) -> bool {
        self.stroke.shows() && self.stroke_width > 0.0
    }

    /// Whether nothing shows through the shape's fill.
    pub(super) fn is_opaque(&self) -> bool {
        let all = self.opacity * self.fill.alpha * self.fill.opacity;
        self.visible && self.fill.color.is_some() && all >= 1.0
    }

    /// Color of the pen: the stroke's, or else the fill's.
    pub(super) fn pen_color(&self) -> String {
        let ink = if self.has_stroke() { &self.stroke } else { &self.fill };
        ink.color.clone().unwrap_or_else(|| "#000000".to_owned())
    }

    /// The dashes of the stroke; percentages are of `diagonal`.
    pub(super) fn dash_array(&self, diagonal: f64) -> Option<DashArray> {
        let lengths: Option<Vec<f64>> =
            self.dashes.iter().map(|&length| user_units(length, diagonal)).collect();
        let offset = user_units(self.dash_offset, diagonal).unwrap_or(0.0);
        DashArray::new(lengths?, offset)
    }

    fn set(&mut self, own: &mut OwnStyle, name: &str, value: &str, around: &Self) {
        let value = value.trim();
        let inherits = value == "inherit";
        match name {
            "display" if !inherits => self.displayed = around.displayed && value != "none",
            "visibility" if !inherits => self.visible = value == "visible",
            "opacity" => {
                if let Some(opacity) = number(value) {
                    self.opacity = around.opacity * opacity;
                }
            }
            "color" => {
                if let Some(color) = color_of(value) {
                    self.color = hex(color);
                }
            }
            "stroke" => self.stroke.set(value, &around.stroke, &self.color),
            "fill" => self.fill.set(value, &around.fill, &self.color),
            "stroke-opacity" => {
                self.stroke.opacity = number(value).unwrap_or(around.stroke.opacity)
            }
            "fill-opacity" => self.fill.opacity = number(value).unwrap_or(around.fill.opacity),
            "fill-rule" => self.fill_rule = fill_rule(value).unwrap_or(around.fill_rule),
            "clip-rule" => self.clip_rule = fill_rule(value).unwrap_or(around.clip_rule),
            "stroke-width" => {
                if let Ok(length) = Length::from_str(value)
                    && let Some(width) = user_units(length, 0.0)
                    && width >= 0.0
                {
                    self.stroke_width = width;
                }
            }
            "stroke-dasharray" if value == "none" => self.dashes.clear(),
            "stroke-dasharray" if !inherits => {
                let lengths: Result<Vec<Length>, _> = LengthListParser::from(value).collect();
                if let Ok(lengths) = lengths {
                    self.dashes = lengths;
                }
            }
            "stroke-dashoffset" => {
                self.dash_offset = Length::from_str(value).unwrap_or(around.dash_offset)
            }
            "transform-box" => own.turns_in_own_box = matches!(value, "fill-box" | "content-box"),
            "transform-origin" => own.transform_origin = Some(value.to_owned()),
            "clip-path" => own.clip_path = Some(value.to_owned()).filter(|value| value != "none"),
            "mask" => own.has_mask = value != "none",
            "overflow" => own.overflows = value == "visible",
            "vector-effect" => own.keeps_stroke_width = value.contains("non-scaling-stroke"),
            _ => {}
        }
    }

    /// Takes the CSS variables that are set among `declarations`, in ascending order of precedence.
    fn set_variables<'a>(&mut self, declarations: impl Iterator<Item = (&'a str, &'a str)>) {
        let variable = |(name, value)| Some((str::strip_prefix(name, "--")?, value));
        let set: Vec<_> = declarations.filter_map(variable).collect();
        if set.is_empty() {
            return;
        }
        let mut variables = BTreeMap::clone(&self.variables);
        let mut length: usize =
            variables.iter().map(|(name, value)| name.len() + value.len()).sum();
        for (name, value) in set {
            let value = with_variables(value, &variables).into_owned();
            length += name.len() + value.len();
            if length > MAX_VARIABLES {
                break;
            }
            variables.insert(name.to_owned(), value.trim().to_owned());
        }
        self.variables = Rc::new(variables);
    }

    fn set_from_css(&mut self, own: &mut OwnStyle, css: &Declaration<'_>, around: &Self) {
        let value = with_variables(css.value, &self.variables.clone()).into_owned();
        // Names of properties are the same in any letter case.
        match css.name.to_ascii_lowercase().as_str() {
            "transform" => own.transform = Some(value),
            name if GEOMETRY.contains(&name) => {
                own.geometry.push((name.to_owned(), value.trim().to_owned()));
            }
            name => self.set(own, name, &value, around),
        }
    }
}

/// The most bytes of the variables of an element; further ones are unknown.
const MAX_VARIABLES: usize = 1 << 18;

/// A color, also with its opacity after a slash, as in `rgb(255 0 0 / 50%)`.
fn color_of(text: &str) -> Option<svgtypes::Color> {
    if let Ok(color) = svgtypes::Color::from_str(text) {
        return Some(color);
    }
    let (opaque, alpha) = text.trim().strip_suffix(')')?.rsplit_once('/')?;
    let mut color = svgtypes::Color::from_str(&format!("{})", opaque.trim())).ok()?;
    color.alpha = (number(alpha.trim())? * 255.0).round() as u8;
    Some(color)
}

/// A number or a percentage, between 0 and 1.
fn number(text: &str) -> Option<f64> {
    let (text, unit) = text.strip_suffix('%').map_or((text, 1.0), |text| (text, 0.01));
    let value = text.trim().parse::<f64>().ok().filter(|value| value.is_finite())?;
    Some((value * unit).clamp(0.0, 1.0))
}

fn fill_rule(value: &str) -> Option<FillRule> {
    match value {
        "nonzero" => Some(FillRule::NonZero),
        "evenodd" => Some(FillRule::EvenOdd),
        _ => None,
    }
}

fn hex(color: svgtypes::Color) -> String {
    format!("#{:02x}{:02x}{:02x}", color.red, color.green, color.blue)
}

impl StyleSheet<'_> {
    /// The style of `node` inside an element of style `around`.
    pub(super) fn style(&self, node: Node<'_, '_>, around: &Style) -> (Style, OwnStyle) {
        let (mut style, mut own) = (around.clone(), OwnStyle::default());
        let attributes = || node.attributes().filter(|a| a.namespace().is_none());
        let inline = without_comments(node.attribute("style").unwrap_or_default());
        let mut css = self.declarations(node);
        css.extend(declarations(&inline));
        style.set_variables(css.iter().map(|css| (css.name, css.value)));
        // The element's color first, since `currentColor` is that wherever it stands.
        for is_color in [true, false] {
            for attribute in attributes().filter(|a| (a.name() == "color") == is_color) {
                let value =
                    with_variables(attribute.value(), &style.variables.clone()).into_owned();
                style.set(&mut own, attribute.name(), &value, around);
            }
            for important in [false, true] {
                let of_pass = |css: &&Declaration<'_>| {
                    css.important == important && (css.name == "color") == is_color
                };
                for declaration in css.iter().filter(of_pass) {
                    style.set_from_css(&mut own, declaration, around);
                }
            }
        }
        style.displayed &= style.opacity > 0.0;
        (style, own)
    }
}

/// A length in user units, `None` for `auto`; an error if it is not a finite length.
pub(super) fn parse_length(text: &str, of: f64) -> Result<Option<f64>, ()> {
    if text.trim() == "auto" {
        return Ok(None);
    }
    let length = Length::from_str(text.trim()).map_err(|_| ())?;
    user_units(length, of).map(Some).ok_or(())
}

/// CSS pixels; letters are taken as 16 pixels high.
pub(super) fn user_units(length: Length, of: f64) -> Option<f64> {
    let unit = match length.unit {
        LengthUnit::None | LengthUnit::Px => 1.0,
        LengthUnit::Em => 16.0,
        LengthUnit::Ex => 8.0,
        LengthUnit::In => 96.0,
        LengthUnit::Cm => 96.0 / 2.54,
        LengthUnit::Mm => 96.0 / 25.4,
        LengthUnit::Pt => 96.0 / 72.0,
        LengthUnit::Pc => 16.0,
        LengthUnit::Percent => of / 100.0,
    };
    Some(length.number * unit).filter(|value| value.is_finite())
}
