//! Paths as typed.

use std::path::{Path, PathBuf};

/// Whether a path stands for standard input or standard output.
pub(super) fn is_dash(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// What a picture of a file is called: its name, without folders.
pub(super) fn title(path: &Path) -> String {
    if is_dash(path) {
        return "standard input".to_owned();
    }
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// The folder that a file is to be created in, if it is not there.
pub(super) fn missing_folder(path: &Path) -> Option<PathBuf> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty())?;
    (!folder.is_dir()).then(|| folder.to_owned())
}
