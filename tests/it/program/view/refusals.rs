//! Who is not answered, and what every answer says to browsers.

use serde_json::json;

use super::{Viewer, exact, message};

#[test]
fn only_requests_that_name_this_machine_as_host_are_answered() {
    let viewer = Viewer::start(&["cube.obj"]);
    let port = viewer.port;
    let get =
        |host: &str| viewer.raw(&message("GET / HTTP/1.1", &[format!("Host: {host}")], b"")).status;
    for own in [format!("127.0.0.1:{port}"), format!("localhost:{port}"), format!("[::1]:{port}")] {
        assert_eq!(get(&own), 200, "{own}");
    }
    // As through `ssh -L 9000:127.0.0.1:port`.
    assert_eq!(get("localhost:9000"), 200);
    for foreign in [
        "127.attacker.example",
        "127.0.0.1.attacker.example",
        "127.0.0.1.attacker.example:80",
        "localhost.attacker.example",
        "attacker.example",
        "attacker.example:80",
        "0.0.0.0",
        "127.0.0.2",
        "127.1",
        "localhost.",
        "::1",
        "[::1",
        "127.0.0.1:",
        "127.0.0.1:80a",
        "a@127.0.0.1",
        ":80",
        "",
    ] {
        assert_eq!(get(foreign), 403, "{foreign:?}");
    }
    assert_eq!(viewer.raw(b"GET / HTTP/1.0\r\n\r\n").status, 403);
    let twice = [format!("Host: 127.0.0.1:{port}"), "Host: attacker.example".to_owned()];
    assert_ne!(viewer.raw(&message("GET / HTTP/1.1", &twice, b"")).status, 200);
    let absolute = [format!("Host: 127.0.0.1:{port}")];
    let line = "GET http://attacker.example/ HTTP/1.1";
    assert_eq!(viewer.raw(&message(line, &absolute, b"")).status, 403);
}

#[test]
fn other_origins_are_refused_even_with_the_token() {
    let viewer = Viewer::start(&["cube.obj"]);
    let body = exact(json!({})).to_string();
    let post = |header: String| {
        let headers = [viewer.token(), header];
        viewer.request("POST /api/draw HTTP/1.1", &headers, body.as_bytes()).status
    };
    let port = viewer.port;
    assert_eq!(post(format!("Origin: http://127.0.0.1:{port}")), 200);
    for origin in [
        "null".to_owned(),
        "http://attacker.example".to_owned(),
        format!("https://127.0.0.1:{port}"),
        format!("http://localhost:{port}"),
        format!("http://127.0.0.1:{}", port ^ 1),
        format!("http://127.0.0.1:{port}.attacker.example"),
        format!("127.0.0.1:{port}"),
    ] {
        assert_eq!(post(format!("Origin: {origin}")), 403, "{origin}");
    }
    assert_eq!(post("Sec-Fetch-Site: same-origin".into()), 200);
    assert_eq!(post("Sec-Fetch-Site: none".into()), 200);
    for site in ["cross-site", "same-site", ""] {
        assert_eq!(post(format!("Sec-Fetch-Site: {site}")), 403, "{site}");
    }
    // The page itself is not for other sites, either.
    let foreign = ["Origin: http://attacker.example".to_owned()];
    assert_eq!(viewer.request("GET / HTTP/1.1", &foreign, b"").status, 403);
}

#[test]
fn without_the_token_nothing_of_the_api_is_answered() {
    let viewer = Viewer::start(&["cube.obj"]);
    let body = exact(json!({})).to_string();
    let wrong = "X-Hiddenline-Token: 00000000000000000000000000000000".to_owned();
    let short = format!("X-Hiddenline-Token: {}", &viewer.token[..31]);
    let in_address = format!("POST /api/draw?{} HTTP/1.1", viewer.token);
    for headers in [vec![], vec![wrong.clone()], vec![short], vec![viewer.token(), wrong]] {
        let reply = viewer.request("POST /api/draw HTTP/1.1", &headers, body.as_bytes());
        assert!([401, 403].contains(&reply.status), "{headers:?}: {}", reply.head);
        for line in
            ["GET /api/events", "POST /api/file", "POST /api/model?name=a.stl", "GET /api/x"]
        {
            let reply = viewer.request(&format!("{line} HTTP/1.1"), &headers, b"");
            assert!([401, 403].contains(&reply.status), "{line} {headers:?}: {}", reply.head);
        }
    }
    assert_eq!(viewer.request(&in_address, &[], body.as_bytes()).status, 401);
    // The token is checked before the body is read: this one never comes.
    let promise = ["Content-Length: 1000".to_owned()];
    assert_eq!(viewer.request("POST /api/draw HTTP/1.1", &promise, b"").status, 401);
    assert_eq!(viewer.draw(&exact(json!({}))).status, 200);
}

#[test]
fn bodies_beyond_the_limit_are_refused_before_they_come() {
    let viewer = Viewer::start(&["cube.obj"]);
    let post = |path: &str, header: &str| {
        let headers = [viewer.token(), header.to_owned()];
        viewer.request(&format!("POST {path} HTTP/1.1"), &headers, b"").status
    };
    assert_eq!(post("/api/draw", "Content-Length: 65537"), 413);
    assert_eq!(post("/api/model?name=a.stl", "Content-Length: 1073741825"), 413);
    assert_eq!(post("/api/draw", "Content-Length: 99999999999999999999999"), 400);
    for coding in ["chunked", "gzip, chunked", "identity"] {
        let status = post("/api/draw", &format!("Transfer-Encoding: {coding}"));
        assert!([400, 411].contains(&status), "{coding}: {status}");
    }
    let both = [viewer.token(), "Transfer-Encoding: chunked".into(), "Content-Length: 5".into()];
    let reply = viewer.request("POST /api/draw HTTP/1.1", &both, b"");
    assert!([400, 411].contains(&reply.status), "{}", reply.head);
    assert_eq!(viewer.draw(&exact(json!({}))).status, 200);
}

#[test]
fn every_answer_tells_browsers_to_keep_to_the_page() {
    let viewer = Viewer::start(&["cube.obj"]);
    let policy = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; \
                  connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
    let replies = [
        (200, viewer.request("GET / HTTP/1.1", &[], b"")),
        (200, viewer.request("GET /app.js HTTP/1.1", &[], b"")),
        (200, viewer.request("GET /app.css HTTP/1.1", &[], b"")),
        (404, viewer.request("GET /nowhere HTTP/1.1", &[], b"")),
        (404, viewer.request("GET /../cube.obj HTTP/1.1", &[], b"")),
        (405, viewer.request("POST / HTTP/1.1", &[], b"")),
        (401, viewer.request("OPTIONS /api/draw HTTP/1.1", &[], b"")),
        (403, viewer.request("GET / HTTP/1.1", &["Origin: http://a.example".into()], b"")),
        (200, viewer.draw(&exact(json!({})))),
        (422, viewer.draw(&exact(json!({ "crease": "x" })))),
    ];
    for (status, reply) in replies {
        assert_eq!(reply.status, status, "{}", reply.head);
        for (name, value) in [
            ("content-security-policy", policy),
            ("x-content-type-options", "nosniff"),
            ("referrer-policy", "no-referrer"),
            ("cross-origin-opener-policy", "same-origin"),
            ("cross-origin-resource-policy", "same-origin"),
            ("cache-control", "no-store"),
        ] {
            assert_eq!(reply.header(name).as_deref(), Some(value), "{name}\n{}", reply.head);
        }
        assert!(!reply.head.to_lowercase().contains("access-control-"), "{}", reply.head);
    }
}

#[test]
fn the_server_listens_on_this_machine_only() {
    let viewer = Viewer::start(&["cube.obj"]);
    // Every other address of the loopback network would answer if it listened everywhere.
    assert!(std::net::TcpStream::connect(("127.0.0.2", viewer.port)).is_err());
}

#[test]
fn a_page_reads_and_writes_no_files() {
    let viewer = Viewer::start(&["cube.obj"]);
    std::fs::write(viewer.path().join("mine.toml"), "x").unwrap();
    let names = || {
        let entries = std::fs::read_dir(viewer.path()).unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    let before = names();
    for option in ["output", "gcode-profile", "camera", "format", "preset", "stats", "threads"] {
        for value in [json!("mine.toml"), json!(true)] {
            let reply = viewer.draw(&exact(json!({ option: value })));
            assert_eq!(reply.status, 422, "{option}");
            assert!(reply.json()["error"].as_str().unwrap().contains(option));
        }
    }
    assert_eq!(viewer.draw(&exact(json!({ "models": "/etc/passwd" }))).status, 422);
    assert_eq!(viewer.draw(&exact(json!({}))).status, 200);
    assert_eq!(names(), before);
}
