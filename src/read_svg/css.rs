//! CSS text: comments, rules, declarations and variables.
//!
//! Selectors are those of simplecss. Rules and declarations are split here, since that crate drops the rest
//! of a rule at a variable or at parentheses within parentheses. Here a declaration that is not
//! understood costs nothing but itself, as CSS says.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::rc::Rc;

use roxmltree::Node;
use simplecss::{AttributeOperator, Element, PseudoClass, Selector};

/// The longest value that variables may grow to.
const MAX_VALUE: usize = 10_000;

/// A property and its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Declaration<'a> {
    pub(super) name: &'a str,
    pub(super) value: &'a str,
    pub(super) important: bool,
}

/// The declarations of a rule, or of a `style` attribute, without comments.
pub(super) fn declarations(text: &str) -> impl Iterator<Item = Declaration<'_>> {
    split(text, b';').filter_map(|declaration| {
        let (name, value) = declaration.split_once(':')?;
        let (name, value) = (name.trim(), value.trim());
        let plain = value.strip_suffix("important").map(str::trim_end);
        let plain = plain.and_then(|value| value.strip_suffix('!')).map(str::trim_end);
        let value = (plain.unwrap_or(value), plain.is_some());
        let is_name = !name.is_empty() && !name.contains(char::is_whitespace);
        let (value, important) = value;
        is_name.then_some(Declaration { name, value, important }).filter(|d| !d.value.is_empty())
    })
}

/// CSS without its comments, and without the marks that hide it from old browsers.
pub(super) fn without_comments(css: &str) -> Cow<'_, str> {
    if !css.contains("/*") && !css.contains("<!--") {
        return css.into();
    }
    let (mut plain, mut rest) = (String::with_capacity(css.len()), css);
    while let Some((before, after)) = rest.split_once("/*") {
        plain.push_str(before);
        plain.push(' ');
        rest = after.split_once("*/").map_or("", |(_, after)| after);
    }
    plain.push_str(rest);
    plain.replace("<!--", " ").replace("-->", " ").into()
}

/// The text of all `<style>` elements, without comments.
pub(super) fn style_text(root: Node<'_, '_>) -> String {
    let styles = root.descendants().filter(|node| {
        node.tag_name().name() == "style"
            && is_for_screens(node.attribute("media").unwrap_or_default())
    });
    let texts: Vec<Cow<'_, str>> =
        styles.filter_map(|node| node.text()).map(without_comments).collect();
    texts.join("\n")
}

/// The rules of all style sheets, in ascending order of precedence.
pub(super) struct StyleSheet<'a> {
    rules: Vec<Rule<'a>>,
}

struct Rule<'a> {
    selects: Selects<'a>,
    /// Those of one block, which many selectors may share.
    declarations: Rc<[Declaration<'a>]>,
}

enum Selects<'a> {
    /// `:root`, which simplecss does not know.
    Root,
    Elements(Selector<'a>),
}

impl Selects<'_> {
    fn specificity(&self) -> [u8; 3] {
        match self {
            Self::Root => [0, 1, 0],
            Self::Elements(selector) => selector.specificity(),
        }
    }

    fn matches(&self, node: Node<'_, '_>) -> bool {
        match self {
            Self::Root => node.parent_element().is_none(),
            Self::Elements(selector) => selector.matches(&XmlNode(node)),
        }
    }
}

impl<'a> StyleSheet<'a> {
    /// The rules of [`style_text`], those for screens included; other at-rules than `@media` are skipped.
    pub(super) fn new(text: &'a str) -> Self {
        let mut rules = Vec::new();
        add_rules(text, &mut rules, 0);
        rules.sort_by_cached_key(|rule| rule.selects.specificity());
        Self { rules }
    }

    /// Number of rules.
    pub(super) fn len(&self) -> usize {
        self.rules.len()
    }

    /// Number of declarations, counted for each selector.
    pub(super) fn n_declarations(&self) -> usize {
        self.rules.iter().map(|rule| rule.declarations.len()).sum()
    }

    /// What the rules declare for `node`, in ascending order of precedence.
    pub(super) fn declarations(&self, node: Node<'_, '_>) -> Vec<Declaration<'a>> {
        let matching = self.rules.iter().filter(|rule| rule.selects.matches(node));
        matching.flat_map(|rule| rule.declarations.iter()).copied().collect()
    }
}

/// The deepest nesting of at-rules.
const DEEPEST: usize = 8;

fn add_rules<'a>(text: &'a str, rules: &mut Vec<Rule<'a>>, depth: usize) {
    let mut rest = text.trim_start();
    while !rest.is_empty() {
        let stops: &[u8] = if rest.starts_with('@') { b"{;" } else { b"{" };
        let head_end = end_of(rest, stops);
        let head = &rest[..head_end];
        rest = &rest[head_end..];
        if let Some(after) = rest.strip_prefix('{') {
            let body_end = end_of(after, b"}");
            let body = &after[..body_end];
            if let Some(media) = head.strip_prefix("@media") {
                if is_for_screens(media) && depth < DEEPEST {
                    add_rules(body, rules, depth + 1);
                }
            } else if !head.starts_with('@') {
                let declarations: Rc<[_]> = declarations(body).collect();
                let parse = |selector: &'a str| match selector.trim() {
                    ":root" => Some(Selects::Root),
                    selector => Selector::parse(selector).map(Selects::Elements),
                };
                rules.extend(
                    split(head, b',')
                        .filter_map(parse)
                        .map(|selects| Rule { selects, declarations: declarations.clone() }),
                );
            }
            rest = &after[body_end..];
        }
        rest = rest.get(1..).unwrap_or_default().trim_start();
    }
}

/// Whether a list of media includes screens, as viewers show drawings; conditions never hold.
fn is_for_screens(media: &str) -> bool {
    let is_screen =
        |name: &str| name.eq_ignore_ascii_case("screen") || name.eq_ignore_ascii_case("all");
    media.trim().is_empty() || media.split(',').any(|name| is_screen(name.trim()))
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

/// `value` with its `var(--name, otherwise)` replaced. An unknown variable stays, which makes the value
/// invalid. `variables` have no dashes before their names.
pub(super) fn with_variables<'a>(
    value: &'a str,
    variables: &BTreeMap<String, String>,
) -> Cow<'a, str> {
    const VAR: &str = "var(";
    let mut value = Cow::Borrowed(value);
    // Innermost ones begin last.
    while let Some(start) = value.rfind(VAR) {
        let (before, rest) = value.split_at(start);
        let inner = &rest[VAR.len()..];
        let end = end_of(inner, b")");
        let after = inner.get(end + 1..).unwrap_or_default();
        let inner = &inner[..end];
        let (name, otherwise) = inner.split_once(',').map_or((inner, None), |(n, o)| (n, Some(o)));
        let name = name.trim().trim_start_matches("--");
        let known = variables.get(name).map(String::as_str).or(otherwise);
        let Some(known) = known.filter(|known| !known.contains(VAR)) else { break };
        let replaced = format!("{before}{}{after}", known.trim());
        if replaced.len() > MAX_VALUE {
            break;
        }
        value = Cow::Owned(replaced);
    }
    value
}

/// The parts of a text between separators, but for those in quotes or brackets.
fn split(text: &str, separator: u8) -> impl Iterator<Item = &str> {
    let mut rest = Some(text);
    std::iter::from_fn(move || {
        let text = rest?;
        let end = end_of(text, &[separator]);
        rest = text.get(end + 1..);
        Some(&text[..end])
    })
}

/// Where the first of some ASCII bytes stands that is not in quotes or brackets; the length if there is none.
fn end_of(text: &str, stops: &[u8]) -> usize {
    let mut depth = 0_usize;
    let mut quote = None;
    for (at, &byte) in text.as_bytes().iter().enumerate() {
        match (quote, byte) {
            (Some(open), byte) if open == byte => quote = None,
            (Some(_), _) => {}
            (None, byte) if depth == 0 && stops.contains(&byte) => return at,
            (None, b'"' | b'\'') => quote = Some(byte),
            (None, b'(' | b'[' | b'{') => depth += 1,
            (None, b')' | b']' | b'}') => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_bad_declaration_costs_no_other() {
        let text = "a:1;; b ;c: d(e;(f) g) ! important;h i: 2;j: 'k;l'; --m:3;n:";
        let found: Vec<_> = declarations(text).map(|d| (d.name, d.value, d.important)).collect();
        let expected = [
            ("a", "1", false),
            ("c", "d(e;(f) g)", true),
            ("j", "'k;l'", false),
            ("--m", "3", false),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn rules_end_where_their_braces_do() {
        let text = "<!-- a, b.c /* } */ { x: 1 } @media print { a { x: 2 } } @media screen, \
                    print { k { l: 6 } } @media (width) { k { x: 7 } } @import 'y'; \
                    :root{z:(3)} d {e:'}';f:4} g { h: 5";
        let text = without_comments(text);
        let sheet = StyleSheet::new(&text);
        let mut found: Vec<_> =
            sheet.rules.iter().flat_map(|rule| rule.declarations.iter()).collect();
        found.sort_by_key(|declaration| declaration.name);
        let found: Vec<_> = found.iter().map(|d| (d.name, d.value)).collect();
        let expected = [
            ("e", "'}'"),
            ("f", "4"),
            ("h", "5"),
            ("l", "6"),
            ("x", "1"),
            ("x", "1"),
            ("z", "(3)"),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn variables_are_replaced_from_inside_and_never_without_end() {
        let variables = BTreeMap::from(
            [("a", "1"), ("b", "x(2)"), ("self", "var(--self)")]
                .map(|(name, value)| (name.to_owned(), value.to_owned())),
        );
        let replaced = |value: &str| with_variables(value, &variables).into_owned();
        assert_eq!(replaced("var(--a) var(--b)"), "1 x(2)");
        assert_eq!(replaced("f(var(--none, var( --a )))"), "f(1)");
        assert_eq!(replaced("var(--none)"), "var(--none)");
        assert_eq!(replaced("var(--self)"), "var(--self)");
        assert_eq!(replaced("var(--a"), "1");
    }
}
