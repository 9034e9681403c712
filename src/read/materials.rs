//! Colors of an OBJ file's materials: where its MTL files are, and what they say.
//!
//! Names in `mtllib` often come from other systems, with backslashes, letters in the wrong case, or
//! folders that do not exist here. The file is found all the same if it is next to the model.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::mtl::{read_materials, words_of_name};
use super::text;

/// Materials that are used and not defined of which each has its own warning.
const MOST_UNDEFINED: usize = 3;

/// Colors by the names of materials, and what could not be read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MaterialColors {
    /// Red, green and blue of `Kd`, taken for sRGB as they are.
    pub colors: BTreeMap<String, [u8; 3]>,
    /// One line for each missing file and faulty record, with file and line number.
    pub warnings: Vec<String>,
}

/// The MTL files that an OBJ file names, whether they exist or not; none for other files and
/// standard input. Reads the whole file.
pub fn material_files(path: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = named_materials(path)
        .libraries
        .into_iter()
        .flat_map(|library| {
            let found = library.files(path);
            let as_named = || vec![folder(path).join(&library.names)];
            if found.is_empty() { as_named() } else { found }
        })
        .collect();
    files.sort();
    files.dedup();
    files
}

/// Reads the colors of the materials of an OBJ file; other files and standard input have none.
///
/// A missing file or a faulty line is a warning, not an error: the model can be drawn without it.
pub fn material_colors(path: &Path) -> MaterialColors {
    let mut found = MaterialColors::default();
    let (mut seen, mut defined) = (Vec::new(), BTreeSet::new());
    let NamedMaterials { libraries, uses } = named_materials(path);
    let mut is_any_missing = false;
    for library in libraries {
        let files = library.files(path);
        if files.is_empty() {
            is_any_missing = true;
            found.warnings.push(format!(
                "{}:{}: the material file `{}` was not found; its materials have no color",
                path.display(),
                library.line,
                text::shown(library.names.as_bytes()),
            ));
        }
        for file in files {
            if seen.contains(&file) {
                continue;
            }
            match std::fs::read(&file) {
                Ok(bytes) => {
                    let materials = read_materials(&bytes);
                    found.colors.extend(materials.colors);
                    defined.extend(materials.names);
                    let warnings = materials.warnings.into_iter();
                    found.warnings.extend(
                        warnings.map(|(line, what)| format!("{}:{line}: {what}", file.display())),
                    );
                }
                Err(error) => found.warnings.push(format!(
                    "{}: cannot be read: {error}; its materials have no color",
                    file.display()
                )),
            }
            seen.push(file);
        }
    }
    if !seen.is_empty() && !is_any_missing {
        let undefined: Vec<_> = uses.iter().filter(|(name, _)| !defined.contains(*name)).collect();
        found.warnings.extend(undefined.iter().take(MOST_UNDEFINED).map(|(name, line)| {
            format!(
                "{}:{line}: the material `{}` is not in the material file; its faces have no color",
                path.display(),
                text::shown(name.as_bytes())
            )
        }));
        if let (Some(last), Some(more)) =
            (found.warnings.last_mut(), undefined.len().checked_sub(MOST_UNDEFINED + 1))
        {
            *last = format!("{last} ({} more like this)", more + 1);
        }
    }
    found
}

/// A `mtllib` record: its line, and the names after the keyword.
struct Library {
    line: usize,
    names: String,
}

/// What an OBJ file says of materials.
#[derive(Default)]
struct NamedMaterials {
    /// The `mtllib` records, each text once.
    libraries: Vec<Library>,
    /// The materials that `usemtl` names, with the line of the first use.
    uses: BTreeMap<String, usize>,
}

/// The material files and materials that an OBJ file names; other files name none.
fn named_materials(path: &Path) -> NamedMaterials {
    let mut named = NamedMaterials::default();
    let is_obj = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj"));
    if !is_obj {
        return named;
    }
    let Ok(bytes) = std::fs::read(path) else { return named };
    let decoded = text::decode(&bytes);
    let mut words = text::Words::new(&decoded, None);
    loop {
        let line = words.line();
        match words.next_on_line() {
            Some(b"mtllib") => {
                let names = text::name(words.rest_of_line());
                if !names.is_empty() && named.libraries.iter().all(|other| other.names != names) {
                    named.libraries.push(Library { line, names });
                }
            }
            Some(b"usemtl") => {
                let name = words_of_name(&mut words);
                if !name.is_empty() {
                    named.uses.entry(name).or_insert(line);
                }
            }
            _ => {}
        }
        if !words.skip_line() {
            return named;
        }
    }
}

impl Library {
    /// The files that exist: the one named by the whole text, or those named by its words.
    fn files(&self, path: &Path) -> Vec<PathBuf> {
        let folder = folder(path);
        let uncommented = self.names.split(" #").next().unwrap_or_default().trim();
        for whole in [self.names.as_str(), uncommented, uncommented.trim_matches('"')] {
            if let Some(file) = find(folder, whole) {
                return vec![file];
            }
        }
        uncommented.split_whitespace().filter_map(|word| find(folder, word)).collect()
    }
}

fn folder(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// Finds a file from `folder` by its name: first as written, then with slashes for backslashes and in
/// any letter case, and finally in `folder` itself, ignoring the folders in the name.
fn find(folder: &Path, name: &str) -> Option<PathBuf> {
    let as_named = folder.join(name);
    if as_named.is_file() {
        return Some(as_named);
    }
    let name = name.replace('\\', "/");
    let steps: Vec<&str> =
        name.split('/').filter(|step| !step.is_empty() && *step != ".").collect();
    let last = steps.last()?;
    walk(folder, &steps).or_else(|| walk(folder, &[last]))
}

/// Follows a path step by step, each in any letter case.
fn walk(folder: &Path, steps: &[&str]) -> Option<PathBuf> {
    let mut at = folder.to_owned();
    for step in steps {
        let next = at.join(step);
        at = if next.exists() { next } else { in_any_case(&at, step)? };
    }
    at.is_file().then_some(at)
}

/// The entry of a folder whose name differs from `name` in letter case only; of several the first by
/// name.
fn in_any_case(folder: &Path, name: &str) -> Option<PathBuf> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let wanted = name.to_lowercase();
    let entries = std::fs::read_dir(folder).ok()?.flatten();
    let alike =
        entries.filter(|entry| entry.file_name().to_string_lossy().to_lowercase() == wanted);
    alike.map(|entry| folder.join(entry.file_name())).min()
}
