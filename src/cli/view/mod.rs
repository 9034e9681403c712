//! `hiddenline view`: a page in the browser that shows the real drawing while the user turns the model.
//!
//! ```text
//!   browser ◄─ HTTP on 127.0.0.1 ─► server, on the main thread
//!   page: paper, controls             guard ► routes ► queue
//!   turns the last draft                                 │
//!   until the next is there                           worker: one thread that owns the scene
//!                                                      studio ► the jobs of `draw` and `surface`
//! ```
//!
//! Each request of the page is a command, and is drawn as if it had been typed: so every option of the
//! command line is on the page, and a saved file has the bytes that the command would write.

mod composed;
mod controls;
mod declared;
mod facts;
mod fault;
mod guard;
mod patient;
mod pick;
mod routes;
mod server;
mod studio;
mod watch;
mod wire;
mod worker;

use std::error::Error;
use std::io::Read;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize};

use clap::{ArgMatches, Args, Command};
use tokio::sync::{Notify, broadcast};

pub(super) use self::declared::with_options_of_drawings;
use self::guard::Token;
use self::routes::Shared;
use self::studio::Studio;
use self::worker::Queue;
use super::models::HeldFiles;
use super::{Refused, messages};

const EXAMPLES: &str = "\
Examples:
  hiddenline view bunny.stl
      Turn it in the browser, choose what to draw, and save the drawing.
  hiddenline view part.stl --hidden dashed --page a3 --watch
      Start with these settings, and redraw whenever part.stl is saved.
  hiddenline view --expr \"sin(r)/r\" --x=-12:12 --y=-12:12
      A function surface; you can change the formula on the page.
  hiddenline view --grid heights.tif --no-open --port 8000
      Print the address only.";

/// Turn a model in the browser, with hidden lines removed as you drag
///
/// Serves a page on 127.0.0.1 and opens it. The page shows the drawing that `draw` or `surface` would
/// make, and the command for it. It starts with the options that are given here; all of them can be
/// changed there.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct ViewArgs {
    /// Port on 127.0.0.1 to serve on [default: a free one]
    #[arg(long, value_name = "PORT", help_heading = "Viewer", default_value_t = 0)]
    #[arg(hide_default_value = true)]
    port: u16,
    /// Print the address without opening a browser
    #[arg(long, help_heading = "Viewer")]
    no_open: bool,
    /// Redraw when a displayed file changes
    #[arg(long, help_heading = "Viewer")]
    watch: bool,
    /// Exit when the page is closed
    #[arg(long, help_heading = "Viewer")]
    once: bool,
}

/// Events that a slow page may be behind.
const EVENTS: usize = 64;

/// What is to be done.
pub(super) struct Job {
    args: ViewArgs,
    studio: Studio,
    revision: Arc<AtomicU64>,
}

impl ViewArgs {
    /// Checks what clap cannot, and reads what is shown. `matches` has the options of drawings, which
    /// `program` declares.
    pub(super) fn job(self, mut program: Command, matches: &ArgMatches) -> Result<Job, Refused> {
        let threads = matches.try_get_one::<u16>("threads").ok().flatten();
        if let Some(&threads) = threads {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into());
            pool.build_global().map_err(|error| Refused::Failed(error.into()))?;
        }
        program.build();
        let mut held = std::collections::HashMap::new();
        if reads_stdin(matches) {
            let mut bytes = Vec::new();
            let read = std::io::stdin().lock().read_to_end(&mut bytes);
            read.map_err(|error| Refused::Failed(error.into()))?;
            held.insert(PathBuf::from("-"), bytes);
        }
        let revision = Arc::new(AtomicU64::new(0));
        let mut studio = Studio::new(&program, matches, HeldFiles::new(held), revision.clone())?;
        studio.open().map_err(|fault| Refused::Failed(fault.error.into()))?;
        Ok(Job { args: self, studio, revision })
    }
}

fn reads_stdin(matches: &ArgMatches) -> bool {
    let models = matches.try_get_raw("models").ok().flatten();
    models.into_iter().flatten().any(|model| model == "-")
}

/// Serves the page until a signal, or the end of the page, stops it.
pub(super) fn run(job: Job) -> Result<(), Box<dyn Error>> {
    let Job { args, studio, revision } = job;
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let files = studio.files();
    let (events, _) = broadcast::channel(EVENTS);
    let shared = Arc::new(Shared {
        token: Token::new()?,
        queue: Arc::new(Queue::default()),
        events: events.clone(),
        pages: Arc::new(AtomicUsize::new(0)),
        left: Arc::new(Notify::new()),
    });
    let (queue, reports) = (shared.queue.clone(), events.clone());
    std::thread::Builder::new()
        .name("drawing".to_owned())
        .spawn(move || worker::work(studio, &queue, &reports))?;
    runtime.block_on(async {
        let listener = server::bind(args.port).await;
        let listener = listener.map_err(|error| cannot_serve(args.port, &error))?;
        // The token stands behind the `#`, which browsers send to nobody.
        let address = format!("http://{}/#{}", listener.local_addr()?, shared.token.as_str());
        messages::plain(&address);
        if !args.no_open && open::that_detached(&address).is_err() {
            messages::hint("no browser could be started; open this address in one");
        }
        if args.watch {
            tokio::spawn(watch::watch(files, revision, events));
        }
        Ok(server::serve(listener, shared, args.once).await?)
    })
}

fn cannot_serve(port: u16, error: &std::io::Error) -> String {
    match port {
        0 => format!("cannot serve on 127.0.0.1: {error}"),
        _ => format!("cannot serve on port {port}: {error}; leave out --port for a free one"),
    }
}

/// What clap says, without its advice for the command line.
fn message(error: &clap::Error) -> String {
    let text = error.to_string();
    let text = text.strip_prefix("error: ").unwrap_or(&text);
    let end =
        ["\n\nFor more information", "\n\nUsage:"].iter().filter_map(|end| text.find(end)).min();
    text[..end.unwrap_or(text.len())].trim_end().to_owned()
}
