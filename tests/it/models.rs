//! Models made elsewhere: those beside the repository where they are present, else the few in `examples/models`.
//!
//! A clone alone has no `../shared/models`. A test that needs what is missing counts itself with
//! [`not_run`] and ends; `.ci/run` prints how many did.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Once;

use hiddenline::stages::model::mesh::Mesh;
use hiddenline::stages::read::read_file;

const SHARED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/models");
const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/models");

/// A cow of 2 930 vertices and 5 856 triangles, in every clone.
pub(crate) const SPOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/models/spot.obj");

/// The folder of all models; counts the test as not run if it is missing.
pub(crate) fn folder() -> Option<PathBuf> {
    let folder = PathBuf::from(SHARED);
    if folder.is_dir() {
        return Some(folder);
    }
    not_run(&format!("{SHARED} is missing"));
    None
}

/// The mesh of one model; counts the test as not run if there is no such file.
pub(crate) fn get(name: &str) -> Option<Mesh> {
    let example = Path::new(EXAMPLES).join(name);
    let path = if example.is_file() { example } else { folder()?.join(name) };
    Some(read_file(&path, None).unwrap().mesh)
}

/// The paths of all OBJ and STL models in order, and the least number that a full run has.
///
/// Without the folder these are the examples, and the test counts as not run.
pub(crate) fn all() -> (Vec<PathBuf>, usize) {
    let (folder, least) = match folder() {
        Some(folder) => (folder, 21),
        None => (PathBuf::from(EXAMPLES), 2),
    };
    let entries = folder.read_dir().unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "obj" || e == "stl"));
    paths.sort();
    (paths, least)
}

/// The last part of a path.
pub(crate) fn name(path: &Path) -> String {
    path.file_name().unwrap().to_string_lossy().into_owned()
}

/// Counts the running test as not run, or run in part, in a file that `.ci/run` reads.
pub(crate) fn not_run(reason: &str) {
    static SAID: Once = Once::new();
    // Not `eprintln`, which is captured.
    SAID.call_once(|| {
        let _ = writeln!(std::io::stderr(), "some tests do not run in full: {reason}");
    });
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("not-run");
    let mut file = OpenOptions::new().create(true).append(true).open(path).unwrap();
    let thread = std::thread::current();
    let line = format!("{}: {reason}\n", thread.name().unwrap_or("a test"));
    file.write_all(line.as_bytes()).unwrap();
}
