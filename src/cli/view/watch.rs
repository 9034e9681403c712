//! Watches the displayed files, a few times a second: when one changes, pages redraw.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, SystemTime};

use serde_json::json;
use tokio::sync::broadcast;
use tokio::time::sleep;

use super::worker::Event;

/// How often files are looked at.
const INTERVAL: Duration = Duration::from_millis(250);

/// What tells that a file has changed.
type Stamp = Option<(SystemTime, u64)>;

fn stamp(path: &Path) -> Stamp {
    let found = std::fs::metadata(path).ok()?;
    Some((found.modified().ok()?, found.len()))
}

/// Counts changes in `revision` and tells all pages of them, forever. A file that is still being written
/// counts once it is the same for two looks.
pub(super) async fn watch(
    files: Vec<PathBuf>,
    revision: Arc<AtomicU64>,
    events: broadcast::Sender<Event>,
) {
    let look = || -> Vec<Stamp> { files.iter().map(|path| stamp(path)).collect() };
    let mut known = look();
    let mut last = known.clone();
    loop {
        sleep(INTERVAL).await;
        let now = look();
        // Programs that save by renaming have no file for a moment.
        if now == last && now != known && now.iter().all(Option::is_some) {
            known.clone_from(&now);
            revision.fetch_add(1, Ordering::AcqRel);
            let line = json!({ "event": "changed" }).to_string();
            let _ = events.send(Event { page: None, line });
        }
        last = now;
    }
}
