//! Colors of materials: the diffuse ones of the MTL files that an OBJ file names.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::text;

/// Colors by the names of materials, and what could not be read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MaterialColors {
    /// Red, green and blue of `Kd`, taken as they are.
    pub colors: BTreeMap<String, [u8; 3]>,
    /// A sentence for each file that is missing or no good.
    pub warnings: Vec<String>,
}

/// The MTL files that an OBJ file names, whether they are there or not; other files and standard
/// input name none. Reads the whole file.
pub fn material_files(path: &Path) -> Vec<PathBuf> {
    let is_obj = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj"));
    if !is_obj {
        return Vec::new();
    }
    let Ok(bytes) = std::fs::read(path) else { return Vec::new() };
    let decoded = text::decode(&bytes);
    let records = decoded.split(|&byte| text::is_line_end(byte));
    let mut names: Vec<String> = records
        .filter_map(|record| record.trim_ascii().strip_prefix(b"mtllib"))
        .filter(|rest| rest.first().is_some_and(|&byte| text::is_blank(byte)))
        .map(|rest| String::from_utf8_lossy(rest.trim_ascii()).into_owned())
        .collect();
    names.sort();
    names.dedup();
    let folder = path.parent().unwrap_or(Path::new(""));
    names.iter().map(|name| folder.join(name)).collect()
}

/// Reads the colors for the materials of an OBJ file; other files and standard input have none.
///
/// A file that is missing or no good is a warning, not an error: the model is there without it.
pub fn material_colors(path: &Path) -> MaterialColors {
    let mut found = MaterialColors::default();
    for beside in material_files(path) {
        let read = std::fs::read(&beside).map_err(|error| error.to_string()).and_then(|bytes| {
            tobj::load_mtl_buf(&mut bytes.as_slice()).map_err(|error| error.to_string())
        });
        match read {
            Ok((materials, _)) => {
                for material in materials {
                    let Some(color) = material.diffuse else { continue };
                    let byte = |part: f64| (part * 255.0).round().clamp(0.0, 255.0) as u8;
                    found.colors.insert(material.name, color.map(byte));
                }
            }
            Err(error) => found.warnings.push(format!(
                "{}: {error}; its materials have the color of --paint",
                beside.display()
            )),
        }
    }
    found
}
