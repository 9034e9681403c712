//! Where results go: a file that appears completely or not at all, or standard output.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::paths::missing_folder;

const BUFFER_BYTES: usize = 1 << 18;

/// Writes to standard output.
pub(super) fn write_to_stdout<E: From<io::Error>>(
    write: impl FnOnce(&mut dyn Write) -> Result<(), E>,
) -> Result<(), E> {
    let mut out = BufWriter::with_capacity(BUFFER_BYTES, io::stdout().lock());
    write(&mut out)?;
    Ok(out.flush()?)
}

/// Writes beside `path` and renames, so that `path` is as before until all is written.
///
/// Links are followed. Devices and the like are written to directly.
pub(super) fn write_to_file<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> Result<(), E>,
) -> Result<(), E> {
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let existing = fs::metadata(&target).ok();
    if existing.as_ref().is_some_and(|metadata| !metadata.is_file() && !metadata.is_dir()) {
        let mut out = BufWriter::new(fs::File::create(&target)?);
        write(&mut out)?;
        return Ok(out.flush()?);
    }
    if existing.as_ref().is_some_and(fs::Metadata::is_dir) {
        return Err(io::Error::from(io::ErrorKind::IsADirectory).into());
    }
    let beside = create_beside(&target, existing.as_ref())?;
    let mut out = BufWriter::with_capacity(BUFFER_BYTES, beside);
    write(&mut out)?;
    let beside = out.into_inner().map_err(io::IntoInnerError::into_error)?;
    beside.persist(&target).map_err(|error| error.error)?;
    Ok(())
}

/// A new file in the folder of `target`, with the permissions of the file it will replace.
fn create_beside(target: &Path, existing: Option<&fs::Metadata>) -> io::Result<NamedTempFile> {
    let folder = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => PathBuf::from("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".hiddenline-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // What any program requests that creates a file; the umask is taken off by the system.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    // The error would name the temporary file, which nobody knows.
    let file = builder.tempfile_in(&folder).map_err(|error| match missing_folder(target) {
        Some(folder) => io::Error::new(
            io::ErrorKind::NotFound,
            format!("folder {} does not exist", folder.display()),
        ),
        None => error.kind().into(),
    })?;
    if let Some(metadata) = existing {
        fs::set_permissions(file.path(), metadata.permissions())?;
    }
    Ok(file)
}
