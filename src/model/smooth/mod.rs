//! Smooth surfaces: a mesh refined until its facets look like the curved surface on paper.
//!
//! ```text
//!        ╲      ╱             An edge between faces of one smooth part is split where its middle is
//!    ●────●────●              farther from the curved surface than the tolerance. The new vertex
//!         │ sagitta           depends on the edge alone, so both faces have the same one: no cracks.
//!   ●───────────●
//! ```
//!
//! The curved surface bulges over an edge as a circle does, so circles, cylinders and spheres become round.
//! PN triangles (Vlachos et al., *Curved PN Triangles*, 2001) have the same form with a factor of one instead
//! of `bulge`'s, and miss a circle.
//!
//! The refined mesh is a mesh like any other: all decisions are exact for its vertices.

mod fans;
mod midpoint;
mod refine;

use crate::model::mesh::{Mesh, MeshError, PolygonSoup};
use crate::model::triangulate::triangulate;

use self::fans::Corners;
use self::refine::Refinement;

/// The maximum number of rounds of splitting. Each splits the edges that need it, and makes new ones across
/// triangles.
const MAX_ROUNDS: usize = 12;

/// Refinement stops before there are more triangles than this.
const MAX_TRIANGLES: usize = 4_000_000;

/// Which parts of a mesh are smooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SmoothParts {
    /// Parts that are smooth according to the model's vertex normals; none in models without normals.
    ByNormals,
    /// Faces that meet at this angle in degrees or less; where the model has vertex normals, they decide.
    Below(f64),
}

/// What refinement did.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Smoothed {
    /// Triangles before and after; equal when nothing is curved.
    pub triangles: [usize; 2],
    /// The largest remaining distance between an edge midpoint and the curved surface, in model units.
    pub farthest: f64,
    /// Whether refinement stopped at the limit of triangles.
    pub is_cut_short: bool,
}

/// Refines the smooth parts of a mesh to a tolerance in model units.
///
/// Flat faces stay as they are, and a mesh without curved parts is returned unchanged. Every round takes
/// O(triangles log triangles).
///
/// # Errors
/// The refined mesh is too large.
pub fn smooth(
    mesh: &Mesh,
    parts: SmoothParts,
    tolerance: f64,
) -> Result<(Mesh, Smoothed), MeshError> {
    let (triangles, faces) = triangulate(mesh);
    let before = triangles.len();
    let unchanged = || (mesh.clone(), Smoothed { triangles: [before; 2], ..Smoothed::default() });
    if parts == SmoothParts::ByNormals && mesh.corner_normals().is_empty() || before == 0 {
        return Ok(unchanged());
    }
    let corners = Corners::new(mesh, &triangles, &faces, parts);
    let mut refinement = Refinement::new(mesh.positions().to_vec(), triangles, faces, corners);
    let mut smoothed = Smoothed { triangles: [before; 2], ..Smoothed::default() };
    for round in 0..=MAX_ROUNDS {
        let split = refinement.measure(tolerance);
        smoothed.farthest = split.farthest;
        if split.n_edges == 0 || round == MAX_ROUNDS {
            break;
        }
        if refinement.n_triangles() + split.n_triangles > MAX_TRIANGLES {
            smoothed.is_cut_short = true;
            break;
        }
        refinement.split();
    }
    smoothed.triangles[1] = refinement.n_triangles();
    if !refinement.is_refined() {
        return Ok((mesh.clone(), smoothed));
    }
    Ok((refined_mesh(mesh, &refinement)?, smoothed))
}

/// The mesh with its refined triangles; faces none of whose edges was split stay whole.
fn refined_mesh(mesh: &Mesh, refinement: &Refinement) -> Result<Mesh, MeshError> {
    let mut soup = PolygonSoup {
        positions: refinement.positions().to_vec(),
        parts: mesh.parts().to_vec(),
        wires: mesh.wires().to_vec(),
        coordinate_error: Some(mesh.coordinate_error()),
        ..PolygonSoup::default()
    };
    for (face, triangles) in refinement.by_face() {
        let whole = mesh.face(face);
        let part = mesh.face_parts().get(face as usize);
        if triangles.len() + 2 == whole.len() {
            soup.push_face(whole);
            soup.face_parts.extend(part);
        } else {
            for triangle in triangles {
                soup.push_face(triangle);
                soup.face_parts.extend(part);
            }
        }
    }
    Ok(Mesh::new(soup)?.0)
}
