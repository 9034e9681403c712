//! glTF 2.0, as `.gltf` with its buffers or as one `.glb` file.
//!
//! ```text
//!  container ─► JSON + buffers ─► nodes of the scene ─► primitives of their meshes ─► soup
//!                                  transforms            accessors
//! ```
//!
//! The data model is that of the gltf project (gltf-json). Its reader (gltf) is not used: it refuses
//! files for flaws that concern no geometry, and panics where an accessor reaches beyond its buffer.
//! Here every index, offset and count is checked before it is used.
//!
//! glTF is made y-up and in meters. Positions are turned to z-up, (x, y, z) to (x, −z, y), which is
//! exact. So are the identity, quarter turns, and scaling by powers of two.
//!
//! Skins, morph targets, cameras, animations and textures are ignored: the model is drawn at rest.

mod accessor;
mod container;

use std::path::Path;

use glam::{DAffine3, DMat3, DMat4, DVec3};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;
use gltf_json::{Index, Material, Node, Root, Scene};

use super::Parsed;
use super::error::{Fault, Located};
use super::parts::{PartTable, color_of_parts};
use super::warning::Notice;
use crate::model::mesh::{MeshError, MeshPart};
use accessor::Accessors;

/// Whether bytes are a GLB file, or JSON that is glTF.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    container::looks_like(bytes)
}

/// Reads either kind. `folder` is where buffers may be; without it only those within the file are read.
pub(super) fn read(bytes: &[u8], folder: Option<&Path>) -> Result<Parsed, Located> {
    read_root(bytes, folder).map_err(Into::into)
}

fn read_root(bytes: &[u8], folder: Option<&Path>) -> Result<Parsed, Fault> {
    let (root, chunk) = container::open(bytes)?;
    check_extensions(&root)?;
    let buffers = container::buffers(&root, chunk, folder)?;
    let mut builder = Builder {
        root: &root,
        accessors: Accessors::new(&root, &buffers),
        parsed: Parsed { unit_mm: Some(1000.0), ..Parsed::default() },
        parts: PartTable::default(),
        n_points: 0,
        n_leftover: 0,
    };
    builder.add_scene()?;
    let Builder { mut parsed, parts, n_points, n_leftover, .. } = builder;
    if root.extensions_used.iter().any(|name| name == INSTANCES) {
        parsed.notices.push(Notice::Extension { name: INSTANCES.to_owned() });
    }
    if n_leftover > 0 {
        parsed.notices.push(Notice::LeftoverIndices { count: n_leftover });
    }
    if n_points > 0 {
        parsed.notices.push(Notice::Points { count: n_points, first_line: None });
    }
    parsed.set_parts(parts);
    Ok(parsed)
}

/// Many copies of one mesh by a list of their transforms.
const INSTANCES: &str = "EXT_mesh_gpu_instancing";

/// Refuses files that require an extension that changes the geometry.
fn check_extensions(root: &Root) -> Result<(), Fault> {
    const HARMLESS: [&str; 4] =
        ["KHR_mesh_quantization", "KHR_lights_punctual", "KHR_node_visibility", "EXT_texture_webp"];
    const HARMLESS_KINDS: [&str; 3] = ["KHR_materials_", "KHR_texture_", "MSFT_texture_"];
    for extension in &root.extensions_required {
        let is_harmless = HARMLESS.contains(&extension.as_str())
            || HARMLESS_KINDS.iter().any(|kind| extension.starts_with(kind));
        if !is_harmless {
            return Err(Fault::RequiredExtension(super::text::shown(extension.as_bytes())));
        }
    }
    Ok(())
}

/// Puts a scene's meshes into what the file holds.
struct Builder<'a> {
    root: &'a Root,
    accessors: Accessors<'a>,
    parsed: Parsed,
    parts: PartTable,
    /// Points that are left out.
    n_points: usize,
    /// Indices that make no whole triangle or line.
    n_leftover: usize,
}

impl Builder<'_> {
    /// Adds the nodes of the default scene, or of the first one, or all there are.
    fn add_scene(&mut self) -> Result<(), Fault> {
        let root = self.root;
        let scene: Option<&Scene> = match root.scene {
            Some(scene) => Some(root.get(scene).ok_or_else(|| missing("scene", scene.value()))?),
            None => root.scenes.first(),
        };
        let roots = match scene {
            Some(scene) => scene.nodes.clone(),
            None => self.nodes_without_parent(),
        };
        let z_up = DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y));
        let mut seen = vec![false; root.nodes.len()];
        let mut stack: Vec<(Index<Node>, DAffine3)> =
            roots.into_iter().rev().map(|node| (node, z_up)).collect();
        while let Some((index, parent)) = stack.pop() {
            let node = root.get(index).ok_or_else(|| missing("node", index.value()))?;
            if std::mem::replace(&mut seen[index.value()], true) {
                return Err(Fault::Gltf(format!("node {} is in the scene twice", index.value())));
            }
            let transform = parent * transform(node);
            self.add_mesh(node, transform)?;
            let children = node.children.iter().flatten().rev();
            stack.extend(children.map(|&child| (child, transform)));
        }
        Ok(())
    }

    fn nodes_without_parent(&self) -> Vec<Index<Node>> {
        let mut is_child = vec![false; self.root.nodes.len()];
        for child in self.root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
            if let Some(is_child) = is_child.get_mut(child.value()) {
                *is_child = true;
            }
        }
        let without = (0..).zip(is_child).filter(|(_, is_child)| !is_child);
        without.map(|(node, _)| Index::new(node)).collect()
    }

    fn add_mesh(&mut self, node: &Node, transform: DAffine3) -> Result<(), Fault> {
        let Some(index) = node.mesh else { return Ok(()) };
        let mesh = self.root.get(index).ok_or_else(|| missing("mesh", index.value()))?;
        let group = node.name.as_ref().or(mesh.name.as_ref()).cloned().unwrap_or_default();
        for primitive in &mesh.primitives {
            let material = match primitive.material {
                Some(index) => {
                    let material = self.root.get(index);
                    let material = material.ok_or_else(|| missing("material", index.value()))?;
                    Some((index.value(), material))
                }
                None => None,
            };
            let part = MeshPart {
                group: group.clone(),
                material: material.map_or(String::new(), |(i, material)| name_of(i, material)),
                color: material.and_then(|(_, material)| color_of(material)),
                model: 0,
            };
            self.add_primitive(primitive, &part, transform)?;
        }
        Ok(())
    }

    fn add_primitive(
        &mut self,
        primitive: &Primitive,
        part: &MeshPart,
        transform: DAffine3,
    ) -> Result<(), Fault> {
        let of = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let Some(positions) = of(Semantic::Positions) else { return Ok(()) };
        let positions = self.accessors.vectors(positions)?;
        let normals = match of(Semantic::Normals) {
            Some(normals) => Some(self.accessors.vectors(normals)?),
            None => None,
        };
        let indices = match primitive.indices {
            Some(indices) => self.accessors.indices(indices)?,
            None => (0..positions.len() as u32).collect(),
        };
        if let Some(&index) = indices.iter().find(|&&i| i as usize >= positions.len()) {
            let index = index.to_string();
            return Err(Fault::MissingVertex { index, vertices: positions.len() });
        }
        // Primitives often share one long list of positions, so only those in use are taken.
        let mut used = indices.clone();
        used.sort_unstable();
        used.dedup();
        let soup = &mut self.parsed.soup;
        let first = soup.positions.len();
        let n_corners = soup.corners.len() + 3 * indices.len() + 2 * soup.wires.len();
        if n_corners.max(first + used.len()) >= u32::MAX as usize {
            return Err(Fault::Mesh(MeshError::TooLarge));
        }
        soup.positions
            .extend(used.iter().map(|&i| transform.transform_point3(positions[i as usize])));
        let vertex = |index: u32| (first + used.binary_search(&index).unwrap_or_default()) as u32;
        let mode = match primitive.mode {
            Checked::Valid(mode) => mode,
            Checked::Invalid => return Err(Fault::Gltf("a primitive of unknown mode".to_owned())),
        };
        self.n_leftover += match mode {
            Mode::Triangles => indices.len() % 3,
            Mode::Lines => indices.len() % 2,
            _ => 0,
        };
        match mode {
            Mode::Points => self.n_points += indices.len(),
            Mode::Lines => {
                let (pairs, _) = indices.as_chunks::<2>();
                soup.wires.extend(pairs.iter().map(|ends| ends.map(vertex)));
            }
            Mode::LineStrip | Mode::LineLoop => {
                let closing = match (mode, indices.first(), indices.last()) {
                    (Mode::LineLoop, Some(&first), Some(&last)) => Some([last, first]),
                    _ => None,
                };
                let pairs = indices.windows(2).map(|pair| [pair[0], pair[1]]).chain(closing);
                soup.wires.extend(pairs.map(|ends| ends.map(vertex)));
            }
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan => {
                let face_part = self.parts.index(part);
                // A mirrored body would be inside out.
                let is_mirrored = transform.matrix3.determinant() < 0.0;
                let to_world = transform.matrix3.inverse().transpose();
                let has_normals = normals.as_ref().is_some_and(|n| n.len() == positions.len());
                if has_normals {
                    soup.corner_normals.resize(soup.corners.len(), [0.0; 3]);
                }
                for [a, b, c] in triangles(mode, &indices) {
                    let corners = if is_mirrored { [a, c, b] } else { [a, b, c] };
                    soup.push_face(&corners.map(vertex));
                    soup.face_parts.push(face_part);
                    if let Some(normals) = normals.as_ref().filter(|_| has_normals) {
                        soup.corner_normals.extend(corners.map(|corner| {
                            let normal = (to_world * normals[corner as usize]).normalize_or_zero();
                            normal.to_array().map(|c| c as f32)
                        }));
                    }
                }
                if !has_normals && !soup.corner_normals.is_empty() {
                    soup.corner_normals.resize(soup.corners.len(), [0.0; 3]);
                }
            }
        }
        Ok(())
    }
}

/// The triangles of a primitive, all wound alike.
fn triangles(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => {
            let windows = indices.windows(3).enumerate();
            windows
                .map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] })
                .collect()
        }
        Mode::TriangleFan => match indices.split_first() {
            Some((&hub, rim)) => rim.windows(2).map(|w| [hub, w[0], w[1]]).collect(),
            None => Vec::new(),
        },
        _ => indices.as_chunks::<3>().0.to_vec(),
    }
}

/// The transform of a node into its parent.
fn transform(node: &Node) -> DAffine3 {
    if let Some(matrix) = node.matrix {
        return DAffine3::from_mat4(DMat4::from_cols_array(&matrix.map(f64::from)));
    }
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let rotation = node.rotation.map_or(DMat3::IDENTITY, |q| rotation(q.0.map(f64::from)));
    let scale = node.scale.map_or(DVec3::ONE, vector);
    let translation = node.translation.map_or(DVec3::ZERO, vector);
    DAffine3 { matrix3: rotation * DMat3::from_diagonal(scale), translation }
}

/// The rotation by a quaternion of any length but zero. Products of single precision numbers are exact
/// in double precision, so turns by quarters come out exact even where √½ is rounded.
fn rotation([x, y, z, w]: [f64; 4]) -> DMat3 {
    let squared = x * x + y * y + z * z + w * w;
    if !(squared.is_finite() && squared > 0.0) {
        return DMat3::IDENTITY;
    }
    let column = |a: f64, b: f64, c: f64| DVec3::new(a, b, c) / squared;
    DMat3::from_cols(
        column(w * w + x * x - y * y - z * z, 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)),
        column(2.0 * (x * y - w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z + w * x)),
        column(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), w * w - x * x - y * y + z * z),
    )
}

/// The name of a material; nameless ones are distinguished by number.
fn name_of(index: usize, material: &Material) -> String {
    material.name.clone().unwrap_or_else(|| format!("material {index}"))
}

/// The base color of a material, which glTF keeps linear, as sRGB. A texture would tint it, so then
/// there is none.
fn color_of(material: &Material) -> Option<[u8; 3]> {
    let metallic_roughness = &material.pbr_metallic_roughness;
    let has_texture = metallic_roughness.base_color_texture.is_some();
    let [red, green, blue, _] = metallic_roughness.base_color_factor.0;
    let encoded = |linear: f32| {
        let linear = f64::from(linear);
        if linear <= 0.003_130_8 {
            12.92 * linear
        } else {
            1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
        }
    };
    (!has_texture).then(|| color_of_parts([red, green, blue].map(encoded)))
}

/// A reference to something that does not exist.
fn missing(what: &str, index: usize) -> Fault {
    Fault::Gltf(format!("there is no {what} {index}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_by_rounded_quaternions_are_exact() {
        let half = f64::from(0.5_f32.sqrt());
        let around_x = rotation([half, 0.0, 0.0, half]);
        assert_eq!(around_x * DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.1, -0.3, 0.2));
        let third = rotation([0.5, 0.5, 0.5, 0.5]);
        assert_eq!(third * DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.3, 0.1, 0.2));
    }

    #[test]
    fn strips_alternate_and_fans_share_their_hub() {
        let strip = triangles(Mode::TriangleStrip, &[0, 1, 2, 3]);
        assert_eq!(strip, [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(triangles(Mode::TriangleFan, &[7, 1, 2, 3]), [[7, 1, 2], [7, 2, 3]]);
        assert_eq!(triangles(Mode::Triangles, &[0, 1, 2, 3]), [[0, 1, 2]]);
    }
}
