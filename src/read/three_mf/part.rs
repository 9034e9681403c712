//! One `.model` part: its unit, objects, materials and build items.

use std::collections::{BTreeSet, HashMap};

use glam::{DAffine3, DVec3};
use roxmltree::{Document, Node};

use crate::read::error::Fault;
use crate::read::text::{number, shown};

/// The most elements and attributes of a document.
const MOST_NODES: u32 = 1 << 28;

/// The contents of a part.
pub(super) struct ModelPart {
    /// Millimeters in its unit of length.
    pub(super) unit_mm: f64,
    pub(super) objects: HashMap<u32, Object>,
    /// By the number of their group, and their place within it.
    pub(super) materials: HashMap<(u32, u32), Material>,
    pub(super) items: Vec<Component>,
    /// Extensions that it requires, that add to the shape, and that are not read.
    pub(super) extensions: BTreeSet<&'static str>,
}

/// A mesh, or an assembly of other objects.
#[derive(Default)]
pub(super) struct Object {
    pub(super) name: String,
    pub(super) property: Option<(u32, u32)>,
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<Triangle>,
    pub(super) components: Vec<Component>,
}

pub(super) struct Triangle {
    pub(super) corners: [u32; 3],
    /// The group and number of its material, if it has its own.
    pub(super) property: Option<(u32, u32)>,
}

/// A reference to an object, and how it is placed.
#[derive(Clone)]
pub(super) struct Component {
    pub(super) object: u32,
    /// The part that holds it; `None` for the one that refers to it.
    pub(super) path: Option<String>,
    pub(super) transform: DAffine3,
}

pub(super) struct Material {
    pub(super) name: String,
    pub(super) color: Option<[u8; 3]>,
}

/// A fault, and where in the text of the part it is.
struct Placed {
    at: usize,
    fault: Fault,
}

/// A fault of `node`.
fn at(node: Node<'_, '_>, fault: Fault) -> Placed {
    Placed { at: node.range().start, fault }
}

/// The extensions of 3MF that add to the shape and are not read, by the ends of their namespaces.
const SHAPING: [(&str, &str); 5] = [
    ("/beamlattice/2017/02", "Beam Lattice"),
    ("/balls/2020/07", "Beam Lattice"),
    ("/slice/2015/07", "Slice"),
    ("/booleanoperations/2023/07", "Boolean Operations"),
    ("/volumetric/2022/01", "Volumetric"),
];

impl ModelPart {
    /// Reads the XML of a part; `name` is for messages.
    pub(super) fn parse(text: &str, name: &str) -> Result<Self, Fault> {
        let options = roxmltree::ParsingOptions { nodes_limit: MOST_NODES, ..Default::default() };
        let document = Document::parse_with_options(text, options)
            .map_err(|error| Fault::ThreeMf(format!("part {name}: {error}")))?;
        let placed = |placed: Placed| Fault::InPart {
            part: name.to_owned(),
            line: document.text_pos_at(placed.at).row,
            fault: Box::new(placed.fault),
        };
        Self::of(document.root_element()).map_err(placed)
    }

    fn of(root: Node<'_, '_>) -> Result<Self, Placed> {
        let mut part = Self {
            unit_mm: unit_mm(root)?,
            objects: HashMap::new(),
            materials: HashMap::new(),
            items: Vec::new(),
            extensions: extensions(root),
        };
        let resources = children(root, "resources").flat_map(|resources| resources.children());
        for resource in resources.filter(Node::is_element) {
            let id = || index(resource, "id");
            match resource.tag_name().name() {
                "object" => {
                    part.objects.insert(id()?, object(resource)?);
                }
                "basematerials" => part.add_materials(id()?, resource, "base", "displaycolor"),
                "colorgroup" => part.add_materials(id()?, resource, "color", "color"),
                _ => {}
            }
        }
        for build in children(root, "build") {
            part.items = children(build, "item").map(component).collect::<Result<_, _>>()?;
        }
        Ok(part)
    }

    fn add_materials(&mut self, group: u32, resource: Node<'_, '_>, tag: &str, color: &str) {
        for (number, node) in (0..).zip(children(resource, tag)) {
            let color = node.attribute(color).and_then(hex_color);
            let name = node.attribute("name").unwrap_or_default().to_owned();
            self.materials.insert((group, number), Material { name, color });
        }
    }
}

/// Children of a name, in whatever namespace.
fn children<'a, 'input: 'a>(
    node: Node<'a, 'input>,
    name: &str,
) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children().filter(move |child| child.tag_name().name() == name)
}

/// The extensions in [`SHAPING`] that a model requires.
fn extensions(model: Node<'_, '_>) -> BTreeSet<&'static str> {
    let required = model.attribute("requiredextensions").unwrap_or_default().split_whitespace();
    let spaces: Vec<&str> =
        required.filter_map(|prefix| model.lookup_namespace_uri(Some(prefix))).collect();
    let is_required = |end: &str| spaces.iter().any(|space| space.ends_with(end));
    SHAPING.iter().filter(|(end, _)| is_required(end)).map(|(_, name)| *name).collect()
}

fn unit_mm(model: Node<'_, '_>) -> Result<f64, Placed> {
    Ok(match model.attribute("unit") {
        Some("micron") => 0.001,
        None | Some("millimeter") => 1.0,
        Some("centimeter") => 10.0,
        Some("inch") => 25.4,
        Some("foot") => 304.8,
        Some("meter") => 1000.0,
        Some(other) => {
            let unit = shown(other.as_bytes());
            return Err(at(model, Fault::ThreeMf(format!("`{unit}` is not a unit of 3MF"))));
        }
    })
}

fn object(node: Node<'_, '_>) -> Result<Object, Placed> {
    let mut object = Object {
        name: node.attribute("name").unwrap_or_default().to_owned(),
        property: match (node.attribute("pid"), node.attribute("pindex")) {
            (Some(_), Some(_)) => Some((index(node, "pid")?, index(node, "pindex")?)),
            _ => None,
        },
        ..Object::default()
    };
    for mesh in children(node, "mesh") {
        for vertex in children(mesh, "vertices").flat_map(|list| children(list, "vertex")) {
            let coordinate = |name| value(vertex, name);
            let position = DVec3::new(coordinate("x")?, coordinate("y")?, coordinate("z")?);
            object.positions.push(position);
        }
        let n_vertices = object.positions.len();
        for triangle in children(mesh, "triangles").flat_map(|list| children(list, "triangle")) {
            let corners = ["v1", "v2", "v3"].map(|name| index(triangle, name));
            let [a, b, c] = corners;
            let corners = [a?, b?, c?];
            if let Some(corner) = corners.iter().find(|&&corner| corner as usize >= n_vertices) {
                let index = corner.to_string();
                return Err(at(triangle, Fault::MissingVertex { index, vertices: n_vertices }));
            }
            // The first corner's color counts for all of the triangle.
            let property = match triangle.attribute("p1") {
                None => None,
                Some(_) => {
                    let group = match (triangle.attribute("pid"), object.property) {
                        (Some(_), _) => Some(index(triangle, "pid")?),
                        (None, of_object) => of_object.map(|(group, _)| group),
                    };
                    let number = index(triangle, "p1")?;
                    group.map(|group| (group, number))
                }
            };
            object.triangles.push(Triangle { corners, property });
        }
    }
    for list in children(node, "components") {
        let components = children(list, "component").map(component);
        object.components.extend(components.collect::<Result<Vec<_>, _>>()?);
    }
    Ok(object)
}

fn component(node: Node<'_, '_>) -> Result<Component, Placed> {
    let path = node.attributes().find(|attribute| attribute.name() == "path");
    Ok(Component {
        object: index(node, "objectid")?,
        path: path.map(|path| path.value().trim_start_matches('/').to_owned()),
        transform: node
            .attribute("transform")
            .map_or(Ok(DAffine3::IDENTITY), transform)
            .map_err(|fault| at(node, fault))?,
    })
}

/// Twelve numbers: the images of the three axes, then the translation.
fn transform(text: &str) -> Result<DAffine3, Fault> {
    let numbers: Vec<f64> = text
        .split_ascii_whitespace()
        .map(|word| number(word.as_bytes()))
        .collect::<Result<_, _>>()?;
    let numbers: [f64; 12] = numbers.try_into().map_err(|numbers: Vec<f64>| {
        Fault::TooFewNumbers { record: "transform", needed: 12, found: numbers.len() }
    })?;
    Ok(DAffine3::from_cols_array(&numbers))
}

fn value(node: Node<'_, '_>, name: &'static str) -> Result<f64, Placed> {
    number(attribute(node, name)?.trim().as_bytes()).map_err(|fault| at(node, fault))
}

fn index(node: Node<'_, '_>, name: &'static str) -> Result<u32, Placed> {
    let text = attribute(node, name)?;
    text.trim().parse().map_err(|_| at(node, Fault::BadIndex(shown(text.as_bytes()))))
}

fn attribute<'a>(node: Node<'a, '_>, name: &'static str) -> Result<&'a str, Placed> {
    let lacks =
        || Fault::ThreeMf(format!("an element `{}` lacks `{name}`", node.tag_name().name()));
    node.attribute(name).ok_or_else(|| at(node, lacks()))
}

/// `#RRGGBB` or `#RRGGBBAA`.
fn hex_color(text: &str) -> Option<[u8; 3]> {
    let digits = text.trim().strip_prefix('#')?;
    let is_color = matches!(digits.len(), 6 | 8) && digits.bytes().all(|b| b.is_ascii_hexdigit());
    let number = u32::from_str_radix(digits.get(..6).filter(|_| is_color)?, 16).ok()?;
    let [_, red, green, blue] = number.to_be_bytes();
    Some([red, green, blue])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_are_six_or_eight_digits() {
        assert_eq!(hex_color("#FF8000"), Some([255, 128, 0]));
        assert_eq!(hex_color(" #ff800080 "), Some([255, 128, 0]));
        for text in ["", "#", "FF8000", "#F80", "#GG0000", "#+f8000", "#é123"] {
            assert_eq!(hex_color(text), None, "{text}");
        }
    }
}
