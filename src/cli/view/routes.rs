//! What the server answers: the page's files, drawings, files to save, and events.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use hiddenline::stages::write::Format;
use http_body_util::combinators::BoxBody;
use http_body_util::{BodyExt, Full, channel::Channel};
use hyper::body::{Body, Bytes, Frame, Incoming};
use hyper::header::{self, HeaderValue};
use hyper::{Method, Request, Response, StatusCode};
use serde::Deserialize;
use serde_json::{Value, json};
use tokio::sync::broadcast;
use tokio::time::timeout;

use super::fault::Fault;
use super::guard::{self, FACTS_HEADER, Refusal, Token};
use super::studio::Asked;
use super::worker::{Event, Outcome, Queue, Work};

/// Longest request for a drawing or a file.
const MOST_JSON: u64 = 1 << 16;
/// Largest model that can be dropped on the page.
const MOST_MODEL: u64 = 1 << 30;
/// How long the server waits for the next part of a body.
const PATIENCE: Duration = Duration::from_secs(10);
/// How often an open stream of events says that it is open.
const HEARTBEAT: Duration = Duration::from_secs(15);

const PAGE: &str = include_str!("page/index.html");
const STYLE: &str = include_str!("page/app.css");
/// One script from files of one concern each.
const SCRIPT: &str = concat!(
    "\"use strict\";\n",
    include_str!("page/camera.js"),
    include_str!("page/server.js"),
    include_str!("page/paper.js"),
    include_str!("page/controls.js"),
    include_str!("page/formulas.js"),
    include_str!("page/gestures.js"),
    include_str!("page/app.js"),
);

/// What all connections share.
pub(super) struct Shared {
    pub(super) token: Token,
    pub(super) queue: Arc<Queue>,
    pub(super) events: broadcast::Sender<Event>,
    /// Streams of events that are open: one for each page.
    pub(super) pages: Arc<AtomicUsize>,
    /// Notified when the last page is closed.
    pub(super) left: Arc<tokio::sync::Notify>,
}

pub(super) type Answer = Response<BoxBody<Bytes, Infallible>>;

/// A request for a drawing or a file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AskedJson {
    #[serde(default)]
    seq: u32,
    /// Which page asks; a name that it chose.
    #[serde(default)]
    page: String,
    camera: Option<Value>,
    options: Option<Value>,
    /// `drag` or `exact`.
    want: Option<String>,
    /// A format to save in.
    format: Option<String>,
    pick: Option<[f64; 2]>,
}

/// Answers one request.
pub(super) async fn answer(
    request: Request<Incoming>,
    shared: Arc<Shared>,
) -> Result<Answer, Infallible> {
    let mut answer = match routed(request, &shared).await {
        Ok(answer) => answer,
        Err(Refusal { status, reason }) => {
            let mut answer = json_answer(status, &json!({ "error": reason }));
            // The rest of the body is not read.
            answer.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
            answer
        }
    };
    guard::add_headers(&mut answer);
    Ok(answer)
}

async fn routed(request: Request<Incoming>, shared: &Arc<Shared>) -> Result<Answer, Refusal> {
    let path = request.uri().path().to_owned();
    let limit = if path == "/api/model" { MOST_MODEL } else { MOST_JSON };
    let (version, method) = (request.version(), request.method().clone());
    let (uri, headers) = (request.uri(), request.headers());
    guard::check(version, &method, uri, headers, &shared.token, limit)?;
    let query = |name: &str| {
        let pairs = uri.query().unwrap_or_default().split('&');
        let mut values = pairs.filter_map(|pair| pair.split_once('='));
        values.find(|(key, _)| *key == name).map(|(_, value)| decoded(value)).unwrap_or_default()
    };
    let is_get = method == Method::GET || method == Method::HEAD;
    Ok(match path.as_str() {
        "/" if is_get => text("text/html; charset=utf-8", PAGE),
        "/app.js" if is_get => text("text/javascript; charset=utf-8", SCRIPT),
        "/app.css" if is_get => text("text/css; charset=utf-8", STYLE),
        "/api/events" if method == Method::GET => events(query("page"), shared).await,
        "/api/draw" if method == Method::POST => draw(asked(request).await?, shared).await,
        "/api/file" if method == Method::POST => file(asked(request).await?, shared).await,
        "/api/model" if method == Method::POST => {
            let name = query("name");
            let bytes = body(request.into_body()).await?;
            model(name, bytes, shared).await
        }
        "/" | "/app.js" | "/app.css" | "/api/events" => not_allowed("GET"),
        "/api/draw" | "/api/file" | "/api/model" => not_allowed("POST"),
        _ => json_answer(StatusCode::NOT_FOUND, &json!({ "error": "no such page" })),
    })
}

/// The body, if it is a request that can be understood.
async fn asked(request: Request<Incoming>) -> Result<AskedJson, Refusal> {
    let bytes = body(request.into_body()).await?;
    let malformed = Refusal {
        status: StatusCode::BAD_REQUEST,
        reason: "the body must be JSON with seq, camera, options and want or format",
    };
    serde_json::from_slice(&bytes).map_err(|_| malformed)
}

/// All of a body whose length was checked.
async fn body(mut incoming: Incoming) -> Result<Vec<u8>, Refusal> {
    let slow = Refusal { status: StatusCode::REQUEST_TIMEOUT, reason: "the body did not arrive" };
    let cut = Refusal { status: StatusCode::BAD_REQUEST, reason: "the body ends too early" };
    // A length that is promised is not yet memory.
    let promised = incoming.size_hint().lower().min(1 << 22);
    let mut bytes = Vec::with_capacity(promised as usize);
    while let Some(frame) = timeout(PATIENCE, incoming.frame()).await.map_err(|_| slow)? {
        if let Ok(data) = frame.map_err(|_| cut)?.into_data() {
            bytes.extend_from_slice(&data);
        }
    }
    Ok(bytes)
}

async fn draw(asked: AskedJson, shared: &Shared) -> Answer {
    let AskedJson { seq, page, camera, options, want, pick, .. } = asked;
    let asked = Asked { seq, camera, options, pick_mm: pick };
    let work = match want.as_deref() {
        Some("drag") => Work::Drag(asked),
        Some("exact") => Work::Exact(asked),
        _ => return failed(StatusCode::BAD_REQUEST, &Fault::of("`want` must be drag or exact")),
    };
    match shared.queue.push(&page, work).outcome().await {
        Outcome::Drawn(answer) => {
            let mut response = octets(answer.octets);
            // JSON in ASCII is a header.
            let facts = HeaderValue::from_str(&ascii(&answer.facts.to_string()));
            response.headers_mut().extend(facts.ok().map(|facts| (FACTS_HEADER, facts)));
            response
        }
        outcome => other(outcome),
    }
}

async fn file(asked: AskedJson, shared: &Shared) -> Answer {
    let AskedJson { seq, page, camera, options, format, .. } = asked;
    let known = |name: String| Format::ALL.into_iter().find(|format| format.name() == name);
    let Some(format) = format.and_then(known) else {
        let names = Format::ALL.map(Format::name).join(", ");
        let fault = Fault::of(format!("`format` must be one of {names}"));
        return failed(StatusCode::BAD_REQUEST, &fault);
    };
    let asked = Asked { seq, camera, options, pick_mm: None };
    match shared.queue.push(&page, Work::File(asked, format)).outcome().await {
        Outcome::File { name, bytes } => {
            let mut response = octets(bytes);
            let facts = ascii(&json!({ "name": name }).to_string());
            let facts = HeaderValue::from_str(&facts);
            response.headers_mut().extend(facts.ok().map(|facts| (FACTS_HEADER, facts)));
            response
        }
        outcome => other(outcome),
    }
}

async fn model(name: String, bytes: Vec<u8>, shared: &Shared) -> Answer {
    // Only the name counts: it is shown, and says the format.
    let name = name.rsplit(['/', '\\']).next().unwrap_or_default().to_owned();
    if name.is_empty() || name == "-" || name.chars().any(char::is_control) {
        return failed(StatusCode::BAD_REQUEST, &Fault::of("name the model, as in ?name=part.stl"));
    }
    other(shared.queue.push("", Work::Show(name, bytes)).outcome().await)
}

/// A stream of lines, one JSON object each: first what a page must know, then what happens.
async fn events(page: String, shared: &Arc<Shared>) -> Answer {
    let mut received = shared.events.subscribe();
    let first = match shared.queue.push(&page, Work::Describe).outcome().await {
        Outcome::Described(value) => json!({ "event": "hello", "about": value }),
        outcome => return other(outcome),
    };
    let (mut sender, body) = Channel::new(1);
    let open = Open::new(shared);
    tokio::spawn(async move {
        let _open = open;
        let mut line = Some(first.to_string());
        loop {
            let text = line.take().map_or_else(|| "\n".to_owned(), |line| line + "\n");
            let sent = sender.send(Frame::data(Bytes::from(text)));
            // A reader who takes nothing loses the stream.
            if !timeout(PATIENCE, sent).await.is_ok_and(|sent| sent.is_ok()) {
                return;
            }
            line = loop {
                match timeout(HEARTBEAT, received.recv()).await {
                    Err(_) => break None,
                    Ok(Ok(event)) if event.page.as_ref().is_none_or(|of| *of == page) => {
                        break Some(event.line);
                    }
                    Ok(Ok(_) | Err(broadcast::error::RecvError::Lagged(_))) => {}
                    Ok(Err(broadcast::error::RecvError::Closed)) => return,
                }
            };
        }
    });
    let mut response = Response::new(body.boxed());
    let plain = HeaderValue::from_static("application/x-ndjson; charset=utf-8");
    response.headers_mut().insert(header::CONTENT_TYPE, plain);
    response
}

/// A page that is open.
struct Open {
    pages: Arc<AtomicUsize>,
    left: Arc<tokio::sync::Notify>,
}

impl Open {
    fn new(shared: &Shared) -> Self {
        shared.pages.fetch_add(1, Ordering::AcqRel);
        Self { pages: shared.pages.clone(), left: shared.left.clone() }
    }
}

impl Drop for Open {
    fn drop(&mut self) {
        self.pages.fetch_sub(1, Ordering::AcqRel);
        self.left.notify_one();
    }
}

/// Answers that say that there is nothing else to give.
fn other(outcome: Outcome) -> Answer {
    match outcome {
        Outcome::Failed(fault) => failed(StatusCode::UNPROCESSABLE_ENTITY, &fault),
        Outcome::Replaced => failed(StatusCode::CONFLICT, &Fault::of("a newer request arrived")),
        Outcome::TooMany => {
            failed(StatusCode::SERVICE_UNAVAILABLE, &Fault::of("too many requests are waiting"))
        }
        Outcome::Described(value) => json_answer(StatusCode::OK, &value),
        Outcome::Drawn(_) | Outcome::File { .. } => {
            failed(StatusCode::INTERNAL_SERVER_ERROR, &Fault::of("an answer to another request"))
        }
    }
}

fn failed(status: StatusCode, fault: &Fault) -> Answer {
    json_answer(status, &json!(fault))
}

fn not_allowed(method: &'static str) -> Answer {
    let mut answer =
        json_answer(StatusCode::METHOD_NOT_ALLOWED, &json!({ "error": format!("use {method}") }));
    answer.headers_mut().insert(header::ALLOW, HeaderValue::from_static(method));
    answer
}

fn json_answer(status: StatusCode, value: &Value) -> Answer {
    let mut answer = text("application/json", value.to_string());
    *answer.status_mut() = status;
    answer
}

fn octets(bytes: Vec<u8>) -> Answer {
    text("application/octet-stream", bytes)
}

fn text(kind: &'static str, content: impl Into<Bytes>) -> Answer {
    let mut answer = Response::new(Full::new(content.into()).boxed());
    answer.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(kind));
    answer
}

/// JSON without characters beyond ASCII, which headers do not carry.
fn ascii(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for c in json.chars() {
        if c.is_ascii() {
            text.push(c);
        } else {
            let mut units = [0; 2];
            c.encode_utf16(&mut units).iter().for_each(|unit| text += &format!("\\u{unit:04x}"));
        }
    }
    text
}

/// A value of a query without its percent signs.
fn decoded(value: &str) -> String {
    let mut bytes = Vec::with_capacity(value.len());
    let mut rest = value.as_bytes();
    while let [first, after @ ..] = rest {
        let hex = |digit: u8| char::from(digit).to_digit(16);
        match (first, after) {
            (b'%', [high, low, after @ ..]) if hex(*high).is_some() && hex(*low).is_some() => {
                let value = hex(*high).unwrap_or(0) * 16 + hex(*low).unwrap_or(0);
                bytes.push(value as u8);
                rest = after;
            }
            _ => {
                bytes.push(*first);
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
