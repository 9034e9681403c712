//! OBJ by tobj, behind [`obj_filter`](super::obj_filter).

use glam::DVec3;

use super::error::{Fault, Located};
use super::obj_filter::{Filtered, filter};
use super::{Draft, text};
use crate::model::mesh::{MeshError, PolygonSoup};

/// Reads decoded OBJ text.
pub(super) fn read(bytes: &[u8]) -> Result<Draft, Located> {
    let filtered = filter(bytes)?;
    if filtered.n_faces == 0 && looks_binary(bytes) {
        return Err(Fault::NotText("OBJ").into());
    }
    if filtered.n_vertices.max(filtered.n_corners) >= u32::MAX as usize {
        return Err(Fault::Mesh(MeshError::TooLarge).into());
    }
    let mut soup = parse(&filtered)?;
    for (i, &(first, part)) in filtered.runs.iter().enumerate() {
        let end = filtered.runs.get(i + 1).map_or(filtered.n_faces, |run| run.0);
        soup.face_parts.extend(std::iter::repeat_n(part, end - first));
    }
    soup.parts = filtered.parts;
    Ok(Draft {
        unused_vertices: filtered.n_vertices.saturating_sub(soup.positions.len()),
        soup,
        notices: filtered.notices,
        degenerate_faces: filtered.n_degenerate,
        first_degenerate_line: filtered.first_degenerate_line,
        n_lines: filtered.n_lines,
    })
}

fn looks_binary(bytes: &[u8]) -> bool {
    bytes.iter().any(|&byte| byte < b' ' && !text::is_blank(byte) && !text::is_line_end(byte))
}

/// Lets tobj read the reduced text: one object, its vertices in order of their first use.
fn parse(filtered: &Filtered) -> Result<PolygonSoup, Fault> {
    let options = tobj::LoadOptions::default();
    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut filtered.text.as_slice(), &options, no_materials)
        .map_err(|error| Fault::Parser(error.to_string()))?;
    let mut soup = PolygonSoup::default();
    for tobj::Model { mesh, .. } in models {
        let offset = soup.positions.len() as u32;
        let (points, _) = mesh.positions.as_chunks::<3>();
        soup.positions.extend(points.iter().map(|&point| DVec3::from_array(point)));
        if let Some(vertex) = soup.positions.iter().position(|p| !p.is_finite()) {
            return Err(Fault::ElementNotFinite { element: "vertex", index: vertex + 1 });
        }
        let mut end = soup.corners.len() as u32;
        let n_faces = mesh.indices.len() / 3;
        soup.corners.extend(mesh.indices.into_iter().map(|index| index + offset));
        if mesh.face_arities.is_empty() {
            soup.face_starts.extend((1..=n_faces as u32).map(|face| end + 3 * face));
        } else {
            soup.face_starts.extend(mesh.face_arities.iter().map(|arity| {
                end += arity;
                end
            }));
        }
    }
    Ok(soup)
}
