//! 3MF, the format that slicers save: a ZIP archive with the model as XML.
//!
//! ```text
//!  archive ─► .model parts ─► build items ─► objects: meshes, or components of other objects
//!                             transforms     transforms, nested
//! ```
//!
//! The crates for 3MF bring more than 30 dependencies for what amounts to two XML elements, vertices
//! and triangles. The archive is opened by `zip`, the XML by `roxmltree`, which refuses documents that
//! define entities.
//!
//! It reads the core specification and what slicers use beyond it: objects in separate parts (`p:path` of
//! the production extension), base materials and color groups. Slices, beams, textures and supports painted
//! on triangles are ignored.

mod archive;
mod part;

use std::collections::{BTreeSet, HashMap};

use glam::DAffine3;

use super::Parsed;
use super::error::{Fault, Located};
use super::parts::PartTable;
use super::warning::Notice;
use crate::model::mesh::{MeshError, MeshPart};
use archive::Archive;
use part::{Component, ModelPart, Object, Triangle};

/// The deepest nesting of components.
const DEEPEST: usize = 64;

/// The most triangles that components may make for each byte of XML, and how many are always allowed.
const TRIANGLES_PER_BYTE: u64 = 4;
const FREE_TRIANGLES: u64 = 1 << 23;

/// The most objects that are visited, however empty.
const MOST_VISITS: u64 = 1 << 20;

/// Whether bytes are a ZIP archive with a 3MF model in it.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04")
        && Archive::open(bytes).is_ok_and(|mut a| a.root_part().is_ok())
}

/// Reads an archive.
pub(super) fn read(bytes: &[u8]) -> Result<Parsed, Located> {
    read_archive(bytes).map_err(Into::into)
}

fn read_archive(bytes: &[u8]) -> Result<Parsed, Fault> {
    let mut archive = Archive::open(bytes)?;
    let root = archive.root_part()?;
    let mut builder = Builder {
        archive,
        parts: HashMap::new(),
        parsed: Parsed::default(),
        table: PartTable::default(),
        n_bytes: 0,
        n_triangles: 0,
        n_visits: 0,
    };
    builder.load(&root)?;
    let Some(model) = builder.parts.get(&root) else { return Err(Fault::Empty) };
    builder.parsed.unit_mm = Some(model.unit_mm);
    let items = model.items.clone();
    for item in &items {
        builder.add(&root, item, DAffine3::IDENTITY, &mut Vec::new())?;
    }
    let Builder { mut parsed, table, parts, .. } = builder;
    let extensions: BTreeSet<&str> =
        parts.values().flat_map(|part| part.extensions.iter().copied()).collect();
    let notice = |name: &str| Notice::Extension { name: name.to_owned() };
    parsed.notices.extend(extensions.into_iter().map(notice));
    parsed.set_parts(table);
    Ok(parsed)
}

/// Puts build items into what the file holds.
struct Builder<'a> {
    archive: Archive<'a>,
    /// The model parts read so far, by their names.
    parts: HashMap<String, ModelPart>,
    parsed: Parsed,
    table: PartTable,
    /// Bytes of XML read so far.
    n_bytes: u64,
    n_triangles: u64,
    n_visits: u64,
}

impl Builder<'_> {
    /// Reads a part unless it has been read.
    fn load(&mut self, name: &str) -> Result<(), Fault> {
        if !self.parts.contains_key(name) {
            let text = self.archive.read(name)?;
            self.n_bytes += text.len() as u64;
            self.parts.insert(name.to_owned(), ModelPart::parse(&text, name)?);
        }
        Ok(())
    }

    /// Adds the object that a build item or a component refers to; `path` lists the objects on the way there.
    fn add(
        &mut self,
        from: &str,
        component: &Component,
        outer: DAffine3,
        path: &mut Vec<(String, u32)>,
    ) -> Result<(), Fault> {
        self.n_visits += 1;
        if path.len() >= DEEPEST || self.n_visits > MOST_VISITS {
            return Err(Fault::TooManyInstances);
        }
        let name = component.path.as_deref().unwrap_or(from).to_owned();
        self.load(&name)?;
        let place = (name, component.object);
        if path.contains(&place) {
            return Err(Fault::ThreeMf(format!("object {} contains itself", place.1)));
        }
        let (name, id) = &place;
        let object = self.parts.get(name).and_then(|part| part.objects.get(id));
        let Some(object) = object else {
            return Err(Fault::ThreeMf(format!("there is no object {id} in {name}")));
        };
        let transform = outer * component.transform;
        let components = object.components.clone();
        self.add_mesh(name, *id, transform)?;
        if !components.is_empty() {
            let name = name.clone();
            path.push(place);
            for component in &components {
                self.add(&name, component, transform, path)?;
            }
            path.pop();
        }
        Ok(())
    }

    fn add_mesh(&mut self, name: &str, id: u32, transform: DAffine3) -> Result<(), Fault> {
        let Some(part) = self.parts.get(name) else { return Ok(()) };
        let Some(object) = part.objects.get(&id) else { return Ok(()) };
        self.n_triangles += (object.triangles.len() + object.positions.len()) as u64;
        if self.n_triangles > FREE_TRIANGLES + TRIANGLES_PER_BYTE * self.n_bytes {
            return Err(Fault::TooManyInstances);
        }
        let soup = &mut self.parsed.soup;
        let first = soup.positions.len();
        let n_corners = soup.corners.len() + 3 * object.triangles.len();
        if n_corners.max(first + object.positions.len()) >= u32::MAX as usize {
            return Err(Fault::Mesh(MeshError::TooLarge));
        }
        // The identity must keep coordinates bit for bit.
        soup.positions.extend(object.positions.iter().map(|&p| transform.transform_point3(p)));
        let is_mirrored = transform.matrix3.determinant() < 0.0;
        for triangle in &object.triangles {
            let [a, b, c] = triangle.corners.map(|corner| first as u32 + corner);
            soup.push_face(&if is_mirrored { [a, c, b] } else { [a, b, c] });
            soup.face_parts.push(self.table.index(&mesh_part(part, object, triangle)));
        }
        Ok(())
    }
}

/// What a triangle belongs to: its own material, or that of its object.
fn mesh_part(part: &ModelPart, object: &Object, triangle: &Triangle) -> MeshPart {
    let property = triangle.property.or(object.property);
    let material = property.and_then(|property| part.materials.get(&property));
    MeshPart {
        group: object.name.clone(),
        material: material.map_or(String::new(), |material| material.name.clone()),
        color: material.and_then(|material| material.color),
        model: 0,
    }
}
