//! Views in a table: camera options as columns.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use clap::Parser;
use csv::{ReaderBuilder, StringRecord, Trim};

use crate::cli::Refused;
use crate::cli::camera::{CameraArgs, ViewSource};
use crate::cli::paths::is_dash;
use crate::cli::suggestion::suggestion;

/// The options that may be columns.
const COLUMNS: [&str; 10] = [
    "eye",
    "target",
    "up",
    "azimuth",
    "elevation",
    "distance",
    "view",
    "projection",
    "fov",
    "near",
];

/// A row, as if it had been typed.
#[derive(Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct Row {
    #[command(flatten)]
    camera: CameraArgs,
}

/// Reads the views of a CSV file; options that a row leaves out are those of `typed`.
pub(super) fn read(path: &Path, typed: &CameraArgs) -> Result<Vec<ViewSource>, Refused> {
    let failed =
        |message: String| Refused::Failed(format!("--views {}{message}", path.display()).into());
    let input: Box<dyn Read> = if is_dash(path) {
        Box::new(io::stdin().lock())
    } else {
        Box::new(File::open(path).map_err(|error| failed(format!(": {error}")))?)
    };
    let mut reader = ReaderBuilder::new().comment(Some(b'#')).trim(Trim::All).from_reader(input);
    let headers = reader.headers().map_err(|error| failed(format!(": {error}")))?.clone();
    for name in &headers {
        if !COLUMNS.contains(&name) {
            let hint = suggestion(name, COLUMNS.into_iter());
            return Err(failed(format!(":1: `{name}` is not a camera option{hint}")));
        }
    }
    let mut views = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| failed(format!(": {error}")))?;
        let line = record.position().map_or(0, csv::Position::line);
        let row = row(&headers, &record).map_err(|error| failed(format!(":{line}: {error}")))?;
        views.push(row.or(typed).view_source());
    }
    if views.is_empty() {
        return Err(failed(": no views; add one row per view below the option names".into()));
    }
    Ok(views)
}

/// The options of one row; the error is the first line of what clap says.
fn row(headers: &StringRecord, record: &StringRecord) -> Result<CameraArgs, String> {
    let fields = headers.iter().zip(record).filter(|(_, field)| !field.is_empty());
    let typed = fields.map(|(name, field)| format!("--{name}={field}"));
    Row::try_parse_from(typed).map(|row| row.camera).map_err(|error| {
        let text = error.to_string();
        text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned()
    })
}
