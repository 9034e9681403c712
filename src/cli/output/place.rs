//! Whether the output file may be written.

use std::fs;
use std::path::Path;

use crate::cli::Refused;
use crate::cli::paths::{is_dash, missing_folder};

/// Refuses an output that would replace one of the files that are read, whatever it is called there,
/// and one in a folder that does not exist.
///
/// Found out before anything is computed. Where files are linked, the real ones are compared.
pub(in crate::cli) fn check_place<P: AsRef<Path>>(
    output: Option<&Path>,
    inputs: impl IntoIterator<Item = P>,
) -> Result<(), Refused> {
    let Some(output) = output else { return Ok(()) };
    let failed = |message: String| Refused::Failed(message.into());
    let Ok(target) = fs::canonicalize(output) else {
        return missing_folder(output).map_or(Ok(()), |folder| {
            let (output, folder) = (output.display(), folder.display());
            Err(failed(format!("cannot write {output}: folder {folder} does not exist")))
        });
    };
    let is_target = |input: &Path| fs::canonicalize(input).is_ok_and(|input| input == target);
    for input in inputs {
        let input = input.as_ref();
        if !is_dash(input) && is_target(input) {
            return Err(failed(format!(
                "cannot write {}: {} is an input file and would be replaced; use another -o FILE",
                output.display(),
                input.display()
            )));
        }
    }
    Ok(())
}
