//! Paths as they are typed.

use std::path::Path;

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
