//! Who may talk to the server: requests from the page itself, and no others.
//!
//! A page of any site that is open in the same browser can send requests to 127.0.0.1, and a name that
//! an attacker owns can be made to point there. So a request must name this machine as its host, must not
//! come from another origin, and must know the token that only the address of the page holds.

use std::fmt::Write as _;

use hyper::header::{self, HeaderMap, HeaderName, HeaderValue};
use hyper::{Method, Response, StatusCode, Uri, Version};
use subtle::ConstantTimeEq;

/// The header that carries the token. Being of our own, it also makes browsers ask before they send it
/// for another site, which is never answered with yes.
pub(super) const TOKEN_HEADER: HeaderName = HeaderName::from_static("x-hiddenline-token");
/// The header that carries facts about a drawing, as JSON.
pub(super) const FACTS_HEADER: HeaderName = HeaderName::from_static("x-hiddenline-stats");

const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; \
                      connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// A secret of 128 random bits, as 32 hexadecimal digits.
pub(super) struct Token(String);

impl Token {
    /// A new secret from the system's random numbers.
    pub(super) fn new() -> Result<Self, getrandom::Error> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes)?;
        let mut text = String::with_capacity(32);
        for byte in bytes {
            // Writing into a string does not fail.
            let _ = write!(text, "{byte:02x}");
        }
        Ok(Self(text))
    }

    pub(super) fn as_str(&self) -> &str {
        &self.0
    }

    /// Compares in a time that says nothing about where the two differ.
    fn is(&self, given: &[u8]) -> bool {
        self.0.as_bytes().ct_eq(given).into()
    }
}

/// A request that is refused, whatever its body says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Refusal {
    pub(super) status: StatusCode,
    pub(super) reason: &'static str,
}

const fn refusal(status: StatusCode, reason: &'static str) -> Refusal {
    Refusal { status, reason }
}

/// Checks where a request comes from and, for what begins with `/api/`, the token and the body's length.
/// The body is not looked at.
pub(super) fn check(
    version: Version,
    method: &Method,
    uri: &Uri,
    headers: &HeaderMap,
    token: &Token,
    limit: u64,
) -> Result<(), Refusal> {
    let host = host(version, uri, headers)?;
    if let Some(origin) = only(headers, &header::ORIGIN)? {
        let own = origin.as_bytes().strip_prefix(b"http://");
        if !own.is_some_and(|name| name.eq_ignore_ascii_case(host.as_bytes())) {
            return Err(refusal(StatusCode::FORBIDDEN, "the request comes from another origin"));
        }
    }
    let site = only(headers, &HeaderName::from_static("sec-fetch-site"))?;
    if site.is_some_and(|site| !matches!(site.as_bytes(), b"same-origin" | b"none")) {
        return Err(refusal(StatusCode::FORBIDDEN, "the request comes from another site"));
    }
    if uri.path().starts_with("/api/") {
        let given = only(headers, &TOKEN_HEADER)?;
        if !given.is_some_and(|given| token.is(given.as_bytes())) {
            return Err(refusal(
                StatusCode::UNAUTHORIZED,
                "the token is missing or wrong: open the address that hiddenline printed",
            ));
        }
    }
    if headers.contains_key(header::TRANSFER_ENCODING) {
        return Err(refusal(StatusCode::LENGTH_REQUIRED, "the length of the body is missing"));
    }
    let length = match only(headers, &header::CONTENT_LENGTH)? {
        None => 0,
        Some(length) => length.to_str().ok().and_then(|text| text.parse().ok()).unwrap_or(u64::MAX),
    };
    if length > limit {
        return Err(refusal(StatusCode::PAYLOAD_TOO_LARGE, "the body is too long"));
    }
    if length > 0 && method != Method::POST {
        return Err(refusal(StatusCode::BAD_REQUEST, "only POST requests have a body"));
    }
    Ok(())
}

/// The host that a request names, if it is this machine. The name must be equal to one of three: what
/// merely begins like an address of this machine may be anyone's.
fn host<'a>(version: Version, uri: &Uri, headers: &'a HeaderMap) -> Result<&'a str, Refusal> {
    const FOREIGN: Refusal =
        refusal(StatusCode::FORBIDDEN, "the host must be 127.0.0.1, localhost or [::1]");
    if version > Version::HTTP_11 || uri.authority().is_some_and(|a| !is_own(a.as_str())) {
        return Err(FOREIGN);
    }
    let host = only(headers, &header::HOST)?.and_then(|host| host.to_str().ok());
    host.filter(|host| is_own(host)).ok_or(FOREIGN)
}

fn is_own(host: &str) -> bool {
    let (name, port) = match host.rsplit_once(':') {
        // The last colon of `[::1]` belongs to the name.
        Some((name, port)) if !port.ends_with(']') => (name, Some(port)),
        _ => (host, None),
    };
    let is_port = |port: &str| !port.is_empty() && port.bytes().all(|b| b.is_ascii_digit());
    port.is_none_or(is_port)
        && (name == "127.0.0.1" || name.eq_ignore_ascii_case("localhost") || name == "[::1]")
}

/// The value of a header that may be given only once.
fn only<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Result<Option<&'a HeaderValue>, Refusal> {
    let mut values = headers.get_all(name).iter();
    let value = values.next();
    match values.next() {
        Some(_) => Err(refusal(StatusCode::FORBIDDEN, "a header is given twice")),
        None => Ok(value),
    }
}

/// Adds the headers that every answer has: nothing but the page's own files is loaded, nobody may frame
/// it, and nothing is kept. There is deliberately none that lets other origins in.
pub(super) fn add_headers<B>(answer: &mut Response<B>) {
    let headers = answer.headers_mut();
    for (name, value) in [
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
        (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
        (header::CACHE_CONTROL, "no-store"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
}
