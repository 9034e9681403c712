//! Presentation: the few properties that decide what a pen draws, from attributes, style sheets
//! and `style`, in that order of strength.

use std::str::FromStr;

use roxmltree::Node;
use simplecss::{AttributeOperator, DeclarationTokenizer, Element, PseudoClass};
use svgtypes::{Length, LengthUnit, Paint};

/// Properties in effect for an element.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Style {
    /// Whether the element and its children are shown at all.
    pub(super) displayed: bool,
    visible: bool,
    stroke: Option<String>,
    filled: bool,
    fill: Option<String>,
    /// In user units.
    pub(super) stroke_width: f64,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            displayed: true,
            visible: true,
            stroke: None,
            filled: true,
            fill: None,
            stroke_width: 1.0,
        }
    }
}

impl Style {
    /// Whether a shape's outline is drawn: it has a stroke, or a fill that shows where it is.
    pub(super) fn is_seen(&self) -> bool {
        self.visible && (self.stroke.is_some() || self.filled)
    }

    /// Color of the pen: the stroke's, or else the fill's.
    pub(super) fn color(&self) -> String {
        let color = self.stroke.as_ref().or(self.fill.as_ref());
        color.map_or_else(|| "#000000".to_owned(), Clone::clone)
    }

    fn set(&mut self, name: &str, value: &str, around: &Self) {
        let value = value.trim();
        match name {
            "display" if value != "inherit" => self.displayed = value != "none",
            "visibility" if value != "inherit" => self.visible = value == "visible",
            "stroke" => match Paint::from_str(value) {
                Ok(Paint::None) => self.stroke = None,
                Ok(Paint::Inherit) => self.stroke.clone_from(&around.stroke),
                Ok(Paint::Color(color)) => self.stroke = Some(hex(color)),
                Ok(_) => self.stroke = Some("#000000".to_owned()),
                // As everywhere in CSS, what cannot be read has no effect.
                Err(_) => {}
            },
            "fill" => match Paint::from_str(value) {
                Ok(Paint::None) => (self.filled, self.fill) = (false, None),
                Ok(Paint::Inherit) => {
                    (self.filled, self.fill) = (around.filled, around.fill.clone());
                }
                Ok(Paint::Color(color)) => (self.filled, self.fill) = (true, Some(hex(color))),
                Ok(_) => (self.filled, self.fill) = (true, None),
                Err(_) => {}
            },
            "stroke-width" => {
                if let Ok(length) = Length::from_str(value)
                    && let Some(width) = user_units(length, 0.0)
                    && width >= 0.0
                {
                    self.stroke_width = width;
                }
            }
            _ => {}
        }
    }
}

fn hex(color: svgtypes::Color) -> String {
    format!("#{:02x}{:02x}{:02x}", color.red, color.green, color.blue)
}

/// The rules of all `<style>` elements.
pub(super) struct StyleSheet<'a> {
    rules: simplecss::StyleSheet<'a>,
}

impl<'a> StyleSheet<'a> {
    pub(super) fn new(root: Node<'a, '_>) -> Self {
        let mut rules = simplecss::StyleSheet::new();
        for node in root.descendants().filter(|node| node.tag_name().name() == "style") {
            rules.parse_more(node.text().unwrap_or_default());
        }
        Self { rules }
    }

    /// Number of rules.
    pub(super) fn len(&self) -> usize {
        self.rules.rules.len()
    }

    /// The style of `node` inside an element of style `around`.
    pub(super) fn style(&self, node: Node<'_, '_>, around: &Style) -> Style {
        let mut style = around.clone();
        for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
            style.set(attribute.name(), attribute.value(), around);
        }
        let matching = self.rules.rules.iter().filter(|rule| rule.selector.matches(&XmlNode(node)));
        for declaration in matching.flat_map(|rule| &rule.declarations) {
            style.set(declaration.name, declaration.value, around);
        }
        if let Some(text) = node.attribute("style") {
            for declaration in DeclarationTokenizer::from(text) {
                style.set(declaration.name, declaration.value, around);
            }
        }
        style
    }
}

struct XmlNode<'a, 'input: 'a>(Node<'a, 'input>);

impl Element for XmlNode<'_, '_> {
    fn parent_element(&self) -> Option<Self> {
        self.0.parent_element().map(XmlNode)
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.0.prev_sibling_element().map(XmlNode)
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.0.tag_name().name() == name
    }

    fn attribute_matches(&self, name: &str, operator: AttributeOperator<'_>) -> bool {
        self.0.attribute(name).is_some_and(|value| operator.matches(value))
    }

    fn pseudo_class_matches(&self, class: PseudoClass<'_>) -> bool {
        class == PseudoClass::FirstChild && self.0.prev_sibling_element().is_none()
    }
}

/// A length attribute in user units, `None` if absent or `auto`; an error if it is no finite
/// length.
pub(super) fn length_attribute(node: Node<'_, '_>, name: &str, of: f64) -> Result<Option<f64>, ()> {
    let Some(text) = node.attribute(name).map(str::trim) else { return Ok(None) };
    if text == "auto" {
        return Ok(None);
    }
    let length = Length::from_str(text).map_err(|_| ())?;
    user_units(length, of).map(Some).ok_or(())
}

/// CSS pixels; letters are taken as 16 pixels high.
fn user_units(length: Length, of: f64) -> Option<f64> {
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
