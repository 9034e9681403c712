//! Layers: which groups they are, what each pen draws, and which number it has.

use std::collections::BTreeMap;

use glam::DVec2;
use roxmltree::Node;

use super::region::{ClipRegion, Keep};
use crate::plot::{Layer, Pen, Polylines};

const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";

/// The groups directly under the root that are layers, with their labels: those that Inkscape marks
/// as such, or else all with an `id`, as Illustrator and others write them. Layers within layers are apart
/// only if their label begins with `%`, since machines do not draw those.
pub(super) fn layer_labels<'a, 'input>(root: Node<'a, 'input>) -> Vec<(Node<'a, 'input>, String)> {
    let groups = || root.children().filter(|node| node.tag_name().name() == "g");
    let is_marked = |node: &Node<'_, '_>| node.attribute((INKSCAPE, "groupmode")) == Some("layer");
    if groups().any(|group| is_marked(&group)) {
        let label = |group: Node<'_, '_>| {
            let label = group.attribute((INKSCAPE, "label")).or(group.attribute("id"));
            label.unwrap_or_default().to_owned()
        };
        let top = groups().filter(is_marked);
        // Of layers within layers, only those that are never plotted are apart.
        let guides = root.descendants().filter(|node| {
            node.parent_element() != Some(root) && is_marked(node) && label(*node).starts_with('%')
        });
        return top.chain(guides).map(|group| (group, label(group))).collect();
    }
    let labeled = |group: Node<'a, 'input>| {
        let label = group.attribute((INKSCAPE, "label")).or(group.attribute("data-name"));
        let label = label.map(str::to_owned).or_else(|| group.attribute("id").map(unescaped));
        label.map(|label| (group, label))
    };
    groups().filter_map(labeled).collect()
}

/// Illustrator writes characters that names of elements cannot have as `_x20_`.
fn unescaped(id: &str) -> String {
    let mut text = String::with_capacity(id.len());
    let mut rest = id;
    while let Some((before, tail)) = rest.split_once("_x") {
        text.push_str(before);
        let decoded = tail.split_once('_').and_then(|(code, after)| {
            let c = u32::from_str_radix(code, 16).ok().and_then(char::from_u32)?;
            Some((c, after))
        });
        match decoded {
            Some((c, after)) => {
                text.push(c);
                rest = after;
            }
            None => {
                text.push_str("_x");
                rest = tail;
            }
        }
    }
    text + rest
}

/// What one pen draws, before it has a number.
pub(super) struct PenLines {
    /// Label of the layer; `None` outside of all.
    label: Option<String>,
    pen: Pen,
    lines: Polylines,
    /// Which shape of the file each line is of.
    shapes: Vec<u32>,
}

impl PenLines {
    pub(super) fn new(label: Option<String>, pen: Pen) -> Self {
        Self { label, pen, lines: Polylines::default(), shapes: Vec::new() }
    }

    pub(super) fn push(&mut self, line: &[DVec2], shape: u32) {
        let n = self.lines.len();
        self.lines.push(line.iter().copied());
        if self.lines.len() > n {
            self.shapes.push(shape);
        }
    }

    /// Cuts away what lies below areas. `covers` holds areas with the number of the shape that each
    /// is the fill of, in drawing order: it hides the shapes before it.
    pub(super) fn hide_below(&mut self, covers: &[(u32, ClipRegion)]) {
        let mut kept = Polylines::default();
        for (line, &shape) in self.lines.iter().zip(&self.shapes) {
            let first = covers.partition_point(|&(number, _)| number <= shape);
            let mut pieces = vec![line.to_vec()];
            for (_, region) in &covers[first..] {
                let mut left = Vec::with_capacity(pieces.len());
                for piece in &pieces {
                    region.cut(piece, Keep::Outside, |part| left.push(part.to_vec()));
                }
                pieces = left;
                if pieces.is_empty() {
                    break;
                }
            }
            pieces.into_iter().for_each(|piece| kept.push(piece));
        }
        self.lines = kept;
    }
}

/// Gives each pen the number its label begins with, or the next one that is free. Numbers of labels
/// come first and in order. Layers of one color whose labels begin with the same number share a pen; of
/// other colors the first has it.
pub(super) fn numbered(mut pens: Vec<PenLines>) -> Vec<Layer> {
    pens.retain(|pen| !pen.lines.is_empty());
    let label_number = |pen: &PenLines| pen.label.as_deref().and_then(label_number);
    pens.sort_by_key(|pen| label_number(pen).unwrap_or(u32::MAX));
    let mut colors: BTreeMap<u32, String> = BTreeMap::new();
    for pen in &pens {
        if let Some(number) = label_number(pen) {
            colors.entry(number).or_insert_with(|| pen.pen.color.clone());
        }
    }
    let mut free = (1..).filter(|number| !colors.contains_key(number));
    let mut layers: Vec<Layer> = Vec::with_capacity(pens.len());
    for pen in pens {
        let own = label_number(&pen).filter(|number| colors.get(number) == Some(&pen.pen.color));
        let number = own.or_else(|| free.next()).unwrap_or(u32::MAX);
        let name = match &pen.label {
            Some(label) => label_name(label),
            None => pen.pen.color.trim_start_matches('#').to_owned(),
        };
        let n_alike = layers
            .iter()
            .filter(|layer| layer.number == number)
            .filter(|layer| layer.name.strip_prefix(&*name).is_some_and(is_count))
            .count();
        let name = if n_alike == 0 { name } else { format!("{name}-{}", n_alike + 1) };
        layers.push(Layer {
            number,
            name,
            label: pen.label,
            pen: pen.pen,
            lines: pen.lines,
            ..Layer::default()
        });
    }
    layers
}

/// Nothing, or what tells layers of one name apart.
fn is_count(rest: &str) -> bool {
    rest.is_empty() || rest.strip_prefix('-').is_some_and(|n| n.bytes().all(|c| c.is_ascii_digit()))
}

/// The number at the start of a label, after `%` and `!`.
fn label_number(label: &str) -> Option<u32> {
    let label = label.trim_start_matches(['%', '!', ' ']);
    let n_digits = label.find(|c: char| !c.is_ascii_digit()).unwrap_or(label.len());
    label[..n_digits].parse().ok().filter(|&number| number > 0)
}

/// What a label says besides control characters and number, as a word.
fn label_name(label: &str) -> String {
    let label = label.trim_start_matches(['%', '!', ' ']);
    let rest = match label_number(label) {
        Some(_) => label.trim_start_matches(|c: char| c.is_ascii_digit()),
        None => label,
    };
    let words = rest.split_whitespace().filter(|word| !is_control(word));
    let name = words.collect::<Vec<_>>().join("-");
    let word = |c: char| if c.is_alphanumeric() || c == '_' || c == '-' { c } else { '-' };
    let name: String = name.chars().map(word).collect();
    if name.is_empty() { "lines".to_owned() } else { name }
}

/// `+S40`, `+H60` or `+D500`: speed, pen height and delay for AxiDraw.
fn is_control(word: &str) -> bool {
    let mut letters = word.chars();
    letters.next() == Some('+')
        && letters.next().is_some_and(|c| "SHDshd".contains(c))
        && letters.all(|c| c.is_ascii_digit())
}
