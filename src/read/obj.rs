//! OBJ by tobj, behind [`obj_filter`](super::obj_filter).

use glam::DVec3;

use super::error::{Fault, Located};
use super::obj_filter::{Filtered, filter};
use super::watch::Watch;
use super::{Parsed, text};
use crate::model::mesh::{MeshError, PolygonSoup};

/// The share of the time that the first pass takes.
const SHARE_OF_FILTER: f64 = 0.5;

/// Reads decoded OBJ text.
pub(super) fn read(bytes: &[u8], watch: Watch<'_>) -> Result<Parsed, Located> {
    let filtered = filter(bytes, &watch.up_to(SHARE_OF_FILTER))?;
    if filtered.n_faces == 0 && filtered.n_segments == 0 && looks_binary(bytes) {
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
    soup.corner_normals = filtered.normals.of_corners();
    let mut parsed = Parsed {
        unused_vertices: filtered.n_vertices.saturating_sub(soup.positions.len()),
        notices: filtered.notices,
        degenerate_faces: filtered.n_degenerate,
        first_degenerate_line: filtered.first_degenerate_line,
        ..Parsed::default()
    };
    // Those that come back are in use: the filter gave each its number in place of a coordinate.
    let unsound = soup.positions.iter().find(|position| !position.is_finite());
    if let Some((line, fault)) =
        unsound.and_then(|position| filtered.unsound.into_iter().nth(position.y as usize))
    {
        return Err(Located::at(line, fault));
    }
    parsed.soup = soup;
    Ok(parsed)
}

fn looks_binary(bytes: &[u8]) -> bool {
    bytes.iter().any(|&byte| byte < b' ' && !text::is_blank(byte) && !text::is_line_end(byte))
}

/// Lets tobj read the reduced text: one object, its vertices in order of their first use. Faces of two
/// corners are segments.
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
        let mut corners = mesh.indices.into_iter().map(|index| index + offset);
        if mesh.face_arities.is_empty() {
            soup.corners.extend(corners);
            let n_corners = soup.corners.len() as u32;
            soup.face_starts.extend((1..=n_corners / 3).map(|face| 3 * face));
            continue;
        }
        for arity in mesh.face_arities {
            if arity == 2 {
                if let (Some(from), Some(to)) = (corners.next(), corners.next()) {
                    soup.wires.push([from, to]);
                }
            } else {
                soup.corners.extend(corners.by_ref().take(arity as usize));
                soup.face_starts.push(soup.corners.len() as u32);
            }
        }
    }
    Ok(soup)
}
