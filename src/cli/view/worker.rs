//! The thread that draws. It owns what is shown; requests wait for it in a queue, in which a newer
//! request of a page for a drawing takes the place of an older one.
//!
//! ```text
//!   page 1 ─ drag 7, drag 8 ─┐        drag 7 still waits when drag 8 comes: it is
//!   page 2 ─ file ───────────┼─► ▤▤   answered with "replaced", and is never drawn
//!                            └─ wanted? ─► draw
//! ```
//!
//! A request whose connection is closed is not drawn, and one that is being drawn ends at the next stage.

use std::cell::Cell;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use hiddenline::stages::write::Format;
use serde_json::{Value, json};
use tokio::sync::{broadcast, oneshot};

use super::fault::Fault;
use super::studio::{Answer, Asked, Studio};

/// Most requests that wait. There are not more connections.
const MOST_WAITING: usize = 64;
/// Progress is reported no more often.
const PROGRESS: Duration = Duration::from_millis(100);

/// What is to be done.
pub(super) enum Work {
    Drag(Asked),
    Exact(Asked),
    File(Asked, Format),
    /// A model that was dropped on the page, with its name.
    Show(String, Vec<u8>),
    /// What a page must know first.
    Describe,
}

impl Work {
    fn is_drawing(&self) -> bool {
        matches!(self, Self::Drag(_) | Self::Exact(_))
    }
}

/// What came of it.
pub(super) enum Outcome {
    Drawn(Answer),
    File {
        name: String,
        bytes: Vec<u8>,
    },
    Described(Value),
    Failed(Fault),
    /// A newer request of the same page came before this one was begun.
    Replaced,
    TooMany,
}

struct Task {
    page: String,
    work: Work,
    wanted: Arc<AtomicBool>,
    answer: oneshot::Sender<Outcome>,
}

/// A place in the queue; dropping it says that nobody waits for the answer any more.
pub(super) struct Ticket {
    wanted: Arc<AtomicBool>,
    answer: oneshot::Receiver<Outcome>,
}

impl Ticket {
    /// Waits for the answer.
    pub(super) async fn outcome(mut self) -> Outcome {
        let lost =
            |_| Outcome::Failed(Fault::of("the drawing failed; this is a bug in hiddenline"));
        (&mut self.answer).await.unwrap_or_else(lost)
    }
}

impl Drop for Ticket {
    fn drop(&mut self) {
        self.wanted.store(false, Ordering::Release);
    }
}

/// What happens without being requested: lines for one page, or for all.
#[derive(Debug, Clone)]
pub(super) struct Event {
    /// `None` is every page.
    pub(super) page: Option<String>,
    pub(super) line: String,
}

/// Requests on their way to the thread that draws.
#[derive(Default)]
pub(super) struct Queue {
    tasks: Mutex<VecDeque<Task>>,
    is_filled: Condvar,
}

impl Queue {
    fn tasks(&self) -> MutexGuard<'_, VecDeque<Task>> {
        self.tasks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a request of a page.
    pub(super) fn push(&self, page: &str, work: Work) -> Ticket {
        let (answer, receiver) = oneshot::channel();
        let wanted = Arc::new(AtomicBool::new(true));
        let ticket = Ticket { wanted: wanted.clone(), answer: receiver };
        let mut tasks = self.tasks();
        if work.is_drawing() {
            let is_older = |task: &Task| task.page == page && task.work.is_drawing();
            if let Some(at) = tasks.iter().position(is_older)
                && let Some(older) = tasks.remove(at)
            {
                // Whoever asked may be gone.
                let _ = older.answer.send(Outcome::Replaced);
            }
        }
        if tasks.len() >= MOST_WAITING {
            let _ = answer.send(Outcome::TooMany);
            return ticket;
        }
        tasks.push_back(Task { page: page.to_owned(), work, wanted, answer });
        self.is_filled.notify_one();
        ticket
    }

    fn next(&self) -> Task {
        let mut tasks = self.tasks();
        loop {
            if let Some(task) = tasks.pop_front() {
                return task;
            }
            tasks = self.is_filled.wait(tasks).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// Thrown where a drawing is given up.
struct GivenUp;

/// Works on requests, forever.
pub(super) fn work(mut studio: Studio, queue: &Queue, events: &broadcast::Sender<Event>) {
    loop {
        let Task { page, work, wanted, answer } = queue.next();
        if !wanted.load(Ordering::Acquire) {
            continue;
        }
        let done =
            catch_unwind(AssertUnwindSafe(|| outcome(&mut studio, work, &page, &wanted, events)));
        if let Ok(outcome) = done {
            let _ = answer.send(outcome);
        }
        // Otherwise the request was given up, or there is a bug: whoever waits gets an answer that
        // says so. What was being drawn is read again.
    }
}

fn outcome(
    studio: &mut Studio,
    work: Work,
    page: &str,
    wanted: &Arc<AtomicBool>,
    events: &broadcast::Sender<Event>,
) -> Outcome {
    let listener = || {
        let (wanted, events, page) = (wanted.clone(), events.clone(), page.to_owned());
        let reported = Cell::new(Instant::now());
        Box::new(move |stage: &'static str, share: Option<f64>| {
            if !wanted.load(Ordering::Acquire) {
                resume_unwind(Box::new(GivenUp));
            }
            if reported.get().elapsed() > PROGRESS {
                reported.set(Instant::now());
                let event = json!({ "event": "progress", "stage": stage, "share": share });
                let _ = events.send(Event { page: Some(page.clone()), line: event.to_string() });
            }
        })
    };
    let outcome = match work {
        Work::Drag(asked) => studio.drag(&asked).map(Outcome::Drawn),
        Work::Exact(asked) => studio.exact(&asked, listener()).map(Outcome::Drawn),
        Work::File(asked, format) => studio
            .file(&asked, format, listener())
            .map(|(name, bytes)| Outcome::File { name, bytes }),
        Work::Show(name, bytes) => studio.show(name, bytes).map(|()| {
            let line = json!({ "event": "shown" }).to_string();
            let _ = events.send(Event { page: None, line });
            Outcome::Described(studio.description())
        }),
        Work::Describe => Ok(Outcome::Described(studio.description())),
    };
    outcome.unwrap_or_else(Outcome::Failed)
}
