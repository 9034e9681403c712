//! A line on the terminal that shows the current stage, and its progress if known, once the work takes more
//! than a second.

use std::cell::Cell;
use std::io::IsTerminal;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::JoinHandle;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

const PATIENCE: Duration = Duration::from_secs(1);
/// Steps of the bar.
const STEPS: u64 = 1000;

const WITHOUT_SHARE: &str = "{spinner} {msg} {elapsed}";
const WITH_SHARE: &str = "{spinner} {msg} {bar:30} {percent}% {elapsed}, {eta} left";

/// Called with the stage, and the share of it that is done where that is known.
pub(super) type Listener = Box<dyn Fn(&'static str, Option<f64>)>;

/// Shown until it is dropped.
pub(super) struct Progress {
    bar: ProgressBar,
    waiting: Option<(Sender<()>, JoinHandle<()>)>,
    stage: Cell<&'static str>,
    /// Gets stages and shares done in place of the terminal.
    listener: Option<Listener>,
}

impl Progress {
    /// Shows nothing when `quiet`, or when standard error is not a terminal.
    pub(super) fn new(quiet: bool) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        if quiet || !std::io::stderr().is_terminal() {
            return Self { bar, waiting: None, stage: Cell::new(""), listener: None };
        }
        let (done, is_done) = mpsc::channel::<()>();
        let late = bar.clone();
        let thread = std::thread::spawn(move || {
            if is_done.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                late.set_draw_target(ProgressDrawTarget::stderr());
                late.enable_steady_tick(Duration::from_millis(100));
            }
        });
        let waiting = Some((done, thread));
        let progress = Self { bar, waiting, stage: Cell::new(""), listener: None };
        progress.set_style(WITHOUT_SHARE);
        progress
    }

    /// Tells `listener` instead of the terminal.
    #[cfg(feature = "view")]
    pub(super) fn heard_by(listener: Listener) -> Self {
        let mut progress = Self::new(true);
        progress.listener = Some(listener);
        progress
    }

    /// Shows the current stage.
    pub(super) fn stage(&self, what: &'static str) {
        self.stage.set(what);
        if let Some(listener) = &self.listener {
            listener(what, None);
        }
        self.bar.set_message(what);
        if self.bar.length().is_some() {
            self.bar.unset_length();
            self.set_style(WITHOUT_SHARE);
        }
    }

    /// Shows how much of the stage is done, from 0 to 1, and the time left.
    pub(super) fn share(&self, share: f64) {
        if let Some(listener) = &self.listener {
            listener(self.stage.get(), Some(share));
        }
        if self.waiting.is_none() {
            return;
        }
        if self.bar.length().is_none() {
            self.bar.set_length(STEPS);
            self.bar.reset_eta();
            self.set_style(WITH_SHARE);
        }
        self.bar.set_position((share * STEPS as f64) as u64);
    }

    fn set_style(&self, template: &str) {
        if let Ok(style) = ProgressStyle::with_template(template) {
            self.bar.set_style(style);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((done, thread)) = self.waiting.take() {
            drop(done);
            let _ = thread.join();
        }
        self.bar.finish_and_clear();
    }
}
